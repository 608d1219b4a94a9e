//! The shell of a room from its outline: floor, ceiling, walls with openings. Wall i runs from
//! corner i to corner i + 1, counter-clockwise; all fronts face into the room.

use glam::{DVec2, DVec3};

use crate::geometry::mesh::{Mesh, Triangle};
use crate::geometry::polygon;

/// A room to be built.
pub struct Plan<'a> {
    /// Counter-clockwise outline.
    pub outline: &'a [DVec2],
    pub floor_m: f64,
    pub height_m: f64,
    /// Name and material of floor, ceiling and each wall.
    pub floor: (&'a str, usize),
    pub ceiling: (&'a str, usize),
    pub walls: &'a [(String, usize)],
    pub openings: &'a [Opening],
}

/// A rectangle of another material in a wall.
#[derive(Clone, Debug)]
pub struct Opening {
    pub name: String,
    pub wall: usize,
    /// Distance along the wall from its first corner and height above the floor, m.
    pub from: DVec2,
    pub to: DVec2,
    pub material: usize,
}

/// Surfaces of a room's shell with their areas there, m². A surface may belong to several parts.
#[derive(Clone, Debug, Default)]
pub struct Shell {
    pub floor: Vec<(u32, f64)>,
    pub ceiling: Vec<(u32, f64)>,
    pub walls: Vec<(u32, f64)>,
}

/// `Wall_S`, `Wall_E`, `Wall_N`, `Wall_W` of an axis-aligned rectangle (N = +y), else `Wall_1` ….
pub fn wall_names(outline: &[DVec2]) -> Vec<String> {
    let along: Vec<DVec2> = polygon::edges(outline).map(|(a, b)| (b - a).normalize()).collect();
    let compass = |direction: &DVec2| {
        [(DVec2::X, "Wall_S"), (DVec2::Y, "Wall_E"), (DVec2::NEG_X, "Wall_N"), (DVec2::NEG_Y, "Wall_W")]
            .into_iter()
            .find(|(axis, _)| direction.dot(*axis) > 1.0 - 1e-9)
            .map(|(_, name)| name.to_owned())
    };
    if along.len() == 4
        && let Some(names) = along.iter().map(compass).collect::<Option<Vec<_>>>()
    {
        return names;
    }
    (1..=outline.len()).map(|i| format!("Wall_{i}")).collect()
}

/// Adds the room to the mesh; `None` if the outline cannot be triangulated.
pub fn build(mesh: &mut Mesh, plan: &Plan) -> Option<Shell> {
    let triangles = polygon::triangulate(plan.outline)?;
    let mut shell = Shell::default();
    let top_m = plan.floor_m + plan.height_m;
    for (z, (name, material), upward, list) in
        [(plan.floor_m, plan.floor, true, &mut shell.floor), (top_m, plan.ceiling, false, &mut shell.ceiling)]
    {
        let surface = mesh.add_surface(name, material, false);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(plan.outline.iter().map(|p| p.extend(z)));
        for &[a, b, c] in &triangles {
            let corners = if upward { [a, b, c] } else { [a, c, b] };
            mesh.triangles.push(Triangle { vertices: corners.map(|v| first + v), surface });
        }
        list.push((surface, 0.0));
    }
    for (index, (a, b)) in polygon::edges(plan.outline).enumerate() {
        let (name, material) = &plan.walls[index];
        let surface = mesh.add_surface(name.clone(), *material, false);
        shell.walls.push((surface, 0.0));
        let holes: Vec<&Opening> = plan.openings.iter().filter(|o| o.wall == index).collect();
        let length = (b - a).length();
        let axes = (a.extend(plan.floor_m), (b - a).normalize());
        let columns = cuts(length, holes.iter().flat_map(|o| [o.from.x, o.to.x]));
        let rows = cuts(plan.height_m, holes.iter().flat_map(|o| [o.from.y, o.to.y]));
        for s in columns.windows(2) {
            for z in rows.windows(2) {
                let middle = DVec2::new(0.5 * (s[0] + s[1]), 0.5 * (z[0] + z[1]));
                let open = |o: &&Opening| middle.cmpgt(o.from).all() && middle.cmplt(o.to).all();
                if !holes.iter().any(open) {
                    add_cell(mesh, axes, [s[0], z[0]], [s[1], z[1]], surface);
                }
            }
        }
        for hole in holes {
            let surface = mesh.add_surface(hole.name.clone(), hole.material, false);
            shell.walls.push((surface, 0.0));
            add_cell(mesh, axes, hole.from.to_array(), hole.to.to_array(), surface);
        }
    }
    let areas = mesh.surface_areas_m2();
    for part in [&mut shell.floor, &mut shell.ceiling, &mut shell.walls] {
        for (surface, area_m2) in part {
            *area_m2 = areas[*surface as usize];
        }
    }
    Some(shell)
}

/// A rectangle of a wall that starts at `origin`; seen from the room the wall's direction runs leftwards.
fn add_cell(mesh: &mut Mesh, (origin, along): (DVec3, DVec2), from: [f64; 2], to: [f64; 2], surface: u32) {
    let at = |s: f64, z: f64| origin + (along * s).extend(z);
    let corners = [at(from[0], from[1]), at(from[0], to[1]), at(to[0], to[1]), at(to[0], from[1])];
    mesh.add_quad(corners, surface);
}

fn cuts(length: f64, inner: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut cuts: Vec<f64> =
        inner.filter(|at| *at > 1e-9 && *at < length - 1e-9).chain([0.0, length]).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_room_with_a_window_is_closed_and_faces_inwards() {
        let outline = [[0.0, 0.0], [5.0, 0.0], [5.0, 3.0], [0.0, 3.0]].map(DVec2::from_array);
        let names = wall_names(&outline);
        assert_eq!(names, ["Wall_S", "Wall_E", "Wall_N", "Wall_W"]);
        let walls: Vec<(String, usize)> = names.into_iter().map(|name| (name, 0)).collect();
        let opening = Opening {
            name: "Window".into(),
            wall: 1,
            from: DVec2::new(0.5, 1.0),
            to: DVec2::new(2.5, 2.0),
            material: 1,
        };
        let mut mesh = Mesh::default();
        let plan = Plan {
            outline: &outline,
            floor_m: 1.0,
            height_m: 2.5,
            floor: ("Floor", 0),
            ceiling: ("Ceiling", 0),
            walls: &walls,
            openings: &[opening],
        };
        let shell = build(&mut mesh, &plan).unwrap();
        let areas = mesh.surface_areas_m2();
        assert!((areas[shell.walls[1].0 as usize] - (3.0 * 2.5 - 2.0)).abs() < 1e-9);
        assert!((areas.iter().sum::<f64>() - (2.0 * 15.0 + 16.0 * 2.5)).abs() < 1e-9);
        // A hole or a flipped face would change the enclosed volume ⅓ Σ p·n A (negative: inward).
        let volume: f64 = (0..mesh.triangles.len())
            .map(|i| {
                let (normal, area) = mesh.normal_and_area(i);
                mesh.corners(i)[0].dot(normal) * area / 3.0
            })
            .sum();
        assert!((volume + 5.0 * 3.0 * 2.5).abs() < 1e-9, "{volume}");
    }
}
