//! `surface = "Wall_N"` → the room's side of a plane surface and its bounding rectangle.

use glam::{DVec2, DVec3};

use super::draft::{Draft, Located, locate};
use crate::geometry::mesh::Mesh;
use crate::project::AreaShape;
use crate::project::context::Context;
use crate::project::diagnostics::suggestion;
use crate::project::schema::At;

/// The area of a named surface with its world and room; what is wrong is reported.
pub fn on_surface(
    name: &At<String>,
    drafts: &[Draft],
    wanted: Option<(usize, usize)>,
    context: &mut Context,
) -> Option<(AreaShape, usize, usize)> {
    let wanted_name = name.get_ref();
    let found: Vec<(usize, u32)> = drafts
        .iter()
        .enumerate()
        .filter(|(world, _)| wanted.is_none_or(|(wanted, _)| wanted == *world))
        .flat_map(|(world, draft)| {
            let surfaces = draft.surfaces_named(wanted_name);
            surfaces.into_iter().map(move |surface| (world, surface))
        })
        .collect();
    let (world, surface) = match found[..] {
        [one] => one,
        [] if drafts.is_empty() => return None,
        [] => {
            let known = drafts.iter().flat_map(Draft::surface_names);
            let hint = suggestion(wanted_name, known);
            context.error(&name.span(), format!("no surface \"{wanted_name}\""), &hint);
            return None;
        }
        [..] => {
            let message = format!("{} surfaces answer to \"{wanted_name}\"", found.len());
            let hint = match wanted {
                None if drafts.len() > 1 => "name the area's `room`".to_owned(),
                None | Some(_) => {
                    let names = found.iter().map(|(world, surface)| {
                        drafts[*world].mesh.surfaces[*surface as usize].name.as_str()
                    });
                    suggestion("", names)
                }
            };
            context.error(&name.span(), message, &hint);
            return None;
        }
    };
    let draft = &drafts[world];
    let Some((centre, normal)) = plane_of(&draft.mesh, surface) else {
        let message = format!("the surface \"{wanted_name}\" is not plane within 1 mm");
        context.error(&name.span(), message, "an area needs a plane surface, or `points`");
        return None;
    };
    let own = draft.rooms.iter().position(|room| {
        [&room.walls, &room.ceiling, &room.floor].iter().any(|list| list.contains(&surface))
    });
    let room = match (wanted, own, locate(drafts, centre)) {
        (Some((_, room)), _, _) | (None, Some(room), _) => room,
        (None, None, Located::In(located, room)) if located == world => room,
        (None, None, _) if draft.rooms.len() == 1 => 0,
        (None, None, _) => {
            let message = format!("the surface \"{wanted_name}\" lies outside of every room");
            context.error(&name.span(), message, "name the area's `room`");
            return None;
        }
    };
    let limits = &draft.rooms[room];
    let middle = limits.footprint.iter().sum::<DVec2>() / limits.footprint.len() as f64;
    let middle = middle.extend(limits.floor_m + 0.5 * limits.height_m);
    let normal = if normal.dot(middle - centre) < 0.0 { -normal } else { normal };
    let (origin, u, v) = bounding_rectangle(&draft.mesh, surface, normal);
    let shape = AreaShape::Surface { surface, origin, u, v };
    Some((shape, world, room))
}

/// Centre and unit normal of a plane surface; `None` if it is not plane.
fn plane_of(mesh: &Mesh, surface: u32) -> Option<(DVec3, DVec3)> {
    let own = || (0..mesh.triangles.len()).filter(|&i| mesh.triangles[i].surface == surface);
    let largest = own().max_by(|&a, &b| {
        let area = |i| mesh.normal_and_area(i).1;
        area(a).total_cmp(&area(b))
    })?;
    let (normal, _) = mesh.normal_and_area(largest);
    let origin = mesh.corners(largest)[0];
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for index in own() {
        let corners = mesh.corners(index);
        if corners.iter().any(|p| (p - origin).dot(normal).abs() > 1e-3) {
            return None;
        }
        let (_, area_m2) = mesh.normal_and_area(index);
        sum += corners.iter().sum::<DVec3>() / 3.0 * area_m2;
        total += area_m2;
    }
    Some((sum / total, normal))
}

/// Bounding rectangle with u × v along `normal`; u is horizontal and v points upwards on walls.
fn bounding_rectangle(mesh: &Mesh, surface: u32, normal: DVec3) -> (DVec3, DVec3, DVec3) {
    let (u, v) = if normal.z.abs() < 0.9 {
        let v = (DVec3::Z - normal * normal.z).normalize();
        (v.cross(normal), v)
    } else {
        let u = (DVec3::X - normal * normal.x).normalize();
        (u, normal.cross(u))
    };
    let mut low = DVec2::INFINITY;
    let mut high = DVec2::NEG_INFINITY;
    let mut height = 0.0;
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        if triangle.surface == surface {
            for p in mesh.corners(index) {
                let at = DVec2::new(p.dot(u), p.dot(v));
                low = low.min(at);
                high = high.max(at);
                height = p.dot(normal);
            }
        }
    }
    let origin = u * low.x + v * low.y + normal * height;
    (origin, u * (high.x - low.x), v * (high.y - low.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rectangle_of_a_wall_looks_along_the_given_normal() {
        let mut mesh = Mesh::default();
        let surface = mesh.add_surface("Wall", 0, false);
        let corners = [[1.0, 0.0, 0.0], [5.0, 0.0, 0.0], [5.0, 0.0, 3.0], [1.0, 0.0, 3.0]];
        mesh.add_quad(corners.map(DVec3::from_array), surface);
        for normal in [DVec3::Y, DVec3::NEG_Y] {
            let (origin, u, v) = bounding_rectangle(&mesh, surface, normal);
            assert!((u.cross(v) - 12.0 * normal).length() < 1e-9);
            assert!((v - DVec3::new(0.0, 0.0, 3.0)).length() < 1e-9);
            assert!((origin + 0.5 * (u + v) - DVec3::new(3.0, 0.0, 1.5)).length() < 1e-9);
        }
    }
}
