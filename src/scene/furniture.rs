//! Whether a place lies inside closed furniture, where nobody can be and nothing is lit, or in a surface.

use glam::DVec3;

use super::Scene;

/// Surfaces closer than this share a plane, m.
const TOUCHING_M: f64 = 1e-6;

/// Whether a point lies inside closed furniture: along every direction
/// * it leaves more solids than it enters, by the sides of the faces: so solids that overlap count right; or
/// * it crosses one and the same surface that closes round a solid an odd number of times: so faces whose corners
///   run either way and faces that are there twice, once for each side, count right.
///
/// Several directions guard against open sheets; on a surface those into it are left out, so that a cabinet sunk
/// into a wall hides the wall's points. A solid of several materials needs faces that look outwards.
pub fn inside_furniture(scene: &Scene, place: DVec3, normal: DVec3, on_surface: bool) -> bool {
    let at = place + if on_surface { normal * 1e-4 } else { DVec3::ZERO };
    let mut leaves = true;
    // Closed surfaces that every direction so far crosses an odd number of times.
    let mut around: Option<Vec<u32>> = None;
    for axis in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
        if on_surface && axis.dot(normal) <= -0.5 {
            continue;
        }
        // Slightly off the axes, so that the rays do not run along faces.
        let direction = (axis + DVec3::new(1.3e-3, 2.7e-3, 3.9e-3)).normalize();
        let into = direction.dot(normal);
        let outward = on_surface && into < 0.0;
        let crossed = crossings(scene, at, if outward { direction - 2.0 * into * normal } else { direction });
        leaves &= crossed.iter().map(|(_, front)| if *front { -1 } else { 1 }).sum::<i32>() > 0;
        let odd = odd_surfaces(scene, &crossed, around.as_deref());
        if !leaves && odd.is_empty() {
            return false;
        }
        around = Some(odd);
    }
    true
}

/// Whether a point lies in a surface, or nearer to one than 0.01 mm: rays from it then start on either side by
/// rounding.
pub fn in_a_surface(scene: &Scene, place: DVec3) -> bool {
    const REACH_M: f64 = 1e-5;
    // No plane runs along all three; slightly off the axes, so that none runs along edges.
    [DVec3::X, DVec3::Y, DVec3::Z].into_iter().any(|axis| {
        let direction = (axis + DVec3::new(1.3e-3, 2.7e-3, 3.9e-3)).normalize();
        let origin = place - REACH_M * direction;
        scene.tracer.closest(origin, direction, &[]).is_some_and(|hit| hit.distance_m < 2.0 * REACH_M)
    })
}

/// Closed surfaces crossed an odd number of times, of those in `among`.
fn odd_surfaces(scene: &Scene, crossed: &[(u32, bool)], among: Option<&[u32]>) -> Vec<u32> {
    let mut surfaces: Vec<u32> = crossed.iter().map(|(surface, _)| *surface).collect();
    surfaces.sort_unstable();
    let odd = surfaces.chunk_by(|one, other| one == other).filter(|run| run.len() % 2 == 1);
    let odd = odd.map(|run| run[0]).filter(|surface| among.is_none_or(|among| among.contains(surface)));
    odd.filter(|surface| scene.is_closed(*surface)).collect()
}

/// Faces of furniture along a ray up to the room's shell: surface, and whether its front is met. Of those in one
/// place each surface counts once; what stands on the floor shares a plane with it.
fn crossings(scene: &Scene, mut origin: DVec3, direction: DVec3) -> Vec<(u32, bool)> {
    const MOST_FACES: usize = 10_000;
    let mut crossed = Vec::new();
    while crossed.len() < MOST_FACES {
        let Some(first) = scene.tracer.closest(origin, direction, &[]) else { break };
        let (mut here, mut ends, mut past_m) = (Vec::new(), false, first.distance_m);
        let mut next = Some(first);
        while let Some(hit) = next.filter(|hit| hit.distance_m < first.distance_m + TOUCHING_M) {
            let surface = scene.tracer.surface(hit.triangle);
            if scene.mesh.surfaces[surface as usize].furniture {
                crossed.push((surface, hit.front));
            } else {
                ends = true;
            }
            here.push(surface);
            past_m = past_m.max(hit.distance_m);
            next = scene.tracer.closest(origin, direction, &here);
        }
        if ends {
            break;
        }
        origin += direction * (past_m + scene.tracer.offset_m());
    }
    crossed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::{Mesh, Triangle};
    use crate::material::{Bsdf, Material};

    /// How a box's faces are wound.
    #[derive(Clone, Copy, PartialEq)]
    enum Winding {
        Outward,
        /// Every other face inward.
        Mixed,
        /// Each face there twice, inward along the other diagonal.
        Doubled,
        /// The same, the inward faces of another surface.
        TwoSurfaces,
    }

    fn add_box(mesh: &mut Mesh, lo: DVec3, hi: DVec3, winding: Winding) {
        let outside = mesh.add_surface("Box", 0, true);
        let inside = if winding == Winding::TwoSurfaces { mesh.add_surface("Box", 0, true) } else { outside };
        for (number, corners) in faces(lo, hi).into_iter().enumerate() {
            let [a, b, c, d] = corners;
            match winding {
                Winding::Mixed if number % 2 == 1 => mesh.add_quad([d, c, b, a], outside),
                Winding::Outward | Winding::Mixed => mesh.add_quad(corners, outside),
                Winding::Doubled | Winding::TwoSurfaces => {
                    mesh.add_quad(corners, outside);
                    mesh.add_quad([a, d, c, b], inside);
                    // The other diagonal, as a fan from another corner.
                    let first = mesh.positions.len() as u32 - 4;
                    let count = mesh.triangles.len();
                    mesh.triangles.truncate(count - 2);
                    for [i, j, k] in [[1, 2, 3], [1, 3, 0]] {
                        let vertices = [first + i, first + j, first + k];
                        mesh.triangles.push(Triangle { vertices, surface: inside });
                    }
                }
            }
        }
    }

    /// Faces of a box, counter-clockwise seen from outside.
    fn faces(lo: DVec3, hi: DVec3) -> [[DVec3; 4]; 6] {
        let p = |x: bool, y: bool, z: bool| {
            DVec3::new(if x { hi.x } else { lo.x }, if y { hi.y } else { lo.y }, if z { hi.z } else { lo.z })
        };
        let (o, i) = (false, true);
        [
            [p(o, o, o), p(o, i, o), p(i, i, o), p(i, o, o)],
            [p(o, o, i), p(i, o, i), p(i, i, i), p(o, i, i)],
            [p(o, o, o), p(i, o, o), p(i, o, i), p(o, o, i)],
            [p(o, i, o), p(o, i, i), p(i, i, i), p(i, i, o)],
            [p(o, o, o), p(o, o, i), p(o, i, i), p(o, i, o)],
            [p(i, o, o), p(i, i, o), p(i, i, i), p(i, o, i)],
        ]
    }

    /// A room of 6 × 4 × 3 m with furniture.
    fn scene(furniture: impl FnOnce(&mut Mesh)) -> Scene {
        let mut mesh = Mesh::default();
        let shell = mesh.add_surface("Room", 0, false);
        for [a, b, c, d] in faces(DVec3::ZERO, DVec3::new(6.0, 4.0, 3.0)) {
            mesh.add_quad([d, c, b, a], shell);
        }
        furniture(&mut mesh);
        let grey = Material { name: "Grey".into(), bsdf: Bsdf::Lambert { reflectance: 0.5 } };
        Scene::new(mesh, vec![grey], Vec::new()).expect("a scene")
    }

    /// Points of a lattice through the room that count as inside.
    fn inside_of(scene: &Scene) -> Vec<DVec3> {
        let mut found = Vec::new();
        for (i, j, k) in (0..12).flat_map(|i| (0..8).flat_map(move |j| (0..6).map(move |k| (i, j, k)))) {
            let at =
                DVec3::new(f64::from(i), f64::from(j), f64::from(k)) * 0.5 + DVec3::new(0.26, 0.27, 0.24);
            if inside_furniture(scene, at, DVec3::Z, false) {
                found.push(at);
            }
        }
        found
    }

    fn within(boxes: &[(DVec3, DVec3)], at: DVec3) -> bool {
        boxes.iter().any(|(lo, hi)| at.cmpgt(*lo).all() && at.cmplt(*hi).all())
    }

    /// Catches: solids told by the sides of faces alone, which exports with doubled or mixed faces have not; faces in
    /// one place counted twice or passed over, where one piece stands on another; solids that overlap counted away.
    #[test]
    fn solids_hide_their_inside_however_their_faces_are_wound() {
        use Winding::{Doubled, Mixed, Outward, TwoSurfaces};
        let v = DVec3::new;
        let cabinet = (v(1.0, 1.0, 0.0), v(2.5, 2.5, 1.0));
        let on_top = (v(1.0, 1.0, 1.0), v(2.5, 2.5, 2.0));
        let apart = (v(3.5, 0.5, 0.5), v(5.0, 3.0, 2.5));
        let across = (v(2.0, 2.0, 0.0), v(4.0, 3.5, 2.0));
        for (boxes, windings) in [
            (vec![cabinet, apart], vec![Outward, Mixed, Doubled, TwoSurfaces]),
            (vec![cabinet, on_top], vec![Outward, Mixed, Doubled]),
            (vec![cabinet, across], vec![Outward, Mixed, Doubled]),
        ] {
            for winding in windings {
                let scene = scene(|mesh| boxes.iter().for_each(|(lo, hi)| add_box(mesh, *lo, *hi, winding)));
                let found = inside_of(&scene);
                assert!(found.len() > 20 && found.iter().all(|at| within(&boxes, *at)), "{found:?}");
                let volume: usize = {
                    let all = (0..12).flat_map(|i| (0..8).flat_map(move |j| (0..6).map(move |k| (i, j, k))));
                    all.map(|(i, j, k)| {
                        v(f64::from(i), f64::from(j), f64::from(k)) * 0.5 + v(0.26, 0.27, 0.24)
                    })
                    .filter(|at| within(&boxes, *at))
                    .count()
                };
                assert_eq!(found.len(), volume, "none is forgotten");
            }
        }
    }

    /// Catches: places under a table or in an open shelf of single sheets taken for the inside of a solid.
    #[test]
    fn open_sheets_hide_nothing() {
        let v = DVec3::new;
        let scene = scene(|mesh| {
            let sheets = mesh.add_surface("Sheets", 0, true);
            // A shelf of three bays without a front, and a screen before it.
            for x in [1.0, 2.0, 3.0, 4.0] {
                mesh.add_quad([v(x, 3.0, 0.1), v(x, 4.0, 0.1), v(x, 4.0, 2.0), v(x, 3.0, 2.0)], sheets);
            }
            for z in [0.1, 2.0] {
                mesh.add_quad([v(1.0, 3.0, z), v(4.0, 3.0, z), v(4.0, 3.9, z), v(1.0, 3.9, z)], sheets);
            }
            mesh.add_quad([v(1.0, 3.9, 0.1), v(4.0, 3.9, 0.1), v(4.0, 3.9, 2.0), v(1.0, 3.9, 2.0)], sheets);
            mesh.add_quad([v(1.0, 1.0, 0.0), v(5.0, 1.0, 0.0), v(5.0, 1.0, 1.6), v(1.0, 1.0, 1.6)], sheets);
            // A table top.
            mesh.add_quad([v(1.0, 1.2, 0.7), v(5.0, 1.2, 0.7), v(5.0, 2.2, 0.7), v(1.0, 2.2, 0.7)], sheets);
        });
        assert_eq!(inside_of(&scene), Vec::<DVec3>::new());
    }
}
