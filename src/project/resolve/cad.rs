//! The world of a CAD file: materials from project or file, rooms from nodes or from the bounds,
//! and which surfaces are shell and which are furniture.

use glam::{DVec2, DVec3};

use super::draft::Draft;
use super::materials::{Lookup, Palette, lambert};
use super::rooms::add_room;
use super::shell::Shell;
use crate::geometry::gltf::{self, Imported};
use crate::geometry::mesh::Mesh;
use crate::material::{Bsdf, Material};
use crate::project::context::{Context, LARGE_FILE};
use crate::project::diagnostics::suggestion;
use crate::project::schema::{At, RoomSection};

/// How far a wall may stand off the bounding box and still be the room's shell, m.
const SHELL_M: f64 = 0.05;

/// Builds the world of a glTF file.
pub fn draft(
    path: &At<String>,
    rooms: &[&At<RoomSection>],
    project_name: &str,
    palette: &mut Palette,
    context: &mut Context,
) -> Option<Draft> {
    let bytes = context.read(path, LARGE_FILE)?;
    let folder = path.get_ref().rfind(['/', '\\']).map_or("", |at| &path.get_ref()[..=at]);
    let mut read = |relative: &str| {
        context
            .read_path(&format!("{folder}{relative}"), LARGE_FILE)
            .map_err(|(message, hint)| if hint.is_empty() { message } else { format!("{message} ({hint})") })
    };
    let imported = match gltf::import(&bytes, &mut read) {
        Ok(imported) => imported,
        Err(error) => {
            context.error(&path.span(), format!("{}: {error}", path.get_ref()), "");
            return None;
        }
    };
    let Imported { mesh, materials, nodes, lights, biases, .. } = imported;
    for bias in biases {
        context.note(format!("{}: {bias}", path.get_ref()));
    }
    let mut draft = Draft::new(path.get_ref(), path.span());
    draft.cad = true;
    for (index, material) in materials.iter().enumerate() {
        let used = mesh.surfaces.iter().any(|surface| surface.material == index);
        let resolved = match (palette.find(&material.name), material.reflectance) {
            (Lookup::Found(entry), _) => Some(entry),
            (Lookup::Absent, Some(luminance)) => Some(match material.gloss {
                Some([metallic, roughness]) => Material {
                    name: material.name.clone(),
                    bsdf: Bsdf::metallic_roughness(luminance, metallic, roughness),
                },
                None => lambert(&material.name, luminance),
            }),
            (Lookup::Absent, None) if used => {
                let message =
                    format!("material \"{}\" of {} has no photometric data", material.name, path.get_ref());
                let hint = format!("[materials] \"{}\" = {{ reflectance = … }}", material.name);
                context.error(&path.span(), message, &hint);
                None
            }
            (Lookup::Absent | Lookup::Wrong, _) => None,
        };
        // One entry per material of the file keeps the surfaces' indices; a missing one was reported.
        draft.materials.push(resolved.unwrap_or_else(|| lambert(&material.name, 0.0)));
    }
    draft.mesh = mesh;
    draft.nodes = nodes;
    draft.lights = lights;
    let Some((low, high)) = triangle_bounds(&draft.mesh, None) else {
        let message = format!("{} has no triangles", path.get_ref());
        context.error(&path.span(), message, "");
        return None;
    };
    add_rooms(&mut draft, rooms, project_name, (low, high), context);
    Some(draft)
}

fn add_rooms(
    draft: &mut Draft,
    rooms: &[&At<RoomSection>],
    project_name: &str,
    bounds: (DVec3, DVec3),
    context: &mut Context,
) {
    let all: Vec<u32> = (0..draft.mesh.surfaces.len() as u32).collect();
    for surface in &mut draft.mesh.surfaces {
        surface.furniture = true;
    }
    if rooms.is_empty() {
        bounded_room(draft, None, project_name, &all, bounds, context);
    }
    let whole = rooms.iter().filter(|room| room.get_ref().node.is_none());
    for second in whole.skip(1) {
        let message = "two rooms without footprint or node";
        context.error(&second.get_ref().name.span(), message, "give each its `node`");
    }
    for room in rooms {
        let room = room.get_ref();
        let name = room.name.get_ref();
        let Some(node) = &room.node else {
            bounded_room(draft, Some(room), name, &all, bounds, context);
            continue;
        };
        let wanted = node.get_ref();
        let matching: Vec<usize> = (0..draft.nodes.len())
            .filter(|&i| draft.nodes[i].name == *wanted || draft.nodes[i].path == *wanted)
            .collect();
        match matching[..] {
            [index] => {
                let surfaces = draft.nodes[index].surfaces.clone();
                if let Some(bounds) = triangle_bounds(&draft.mesh, Some(&surfaces)) {
                    bounded_room(draft, Some(room), name, &surfaces, bounds, context);
                } else {
                    let message = format!("node \"{wanted}\" has no triangles");
                    context.error(&node.span(), message, "");
                }
            }
            [] => {
                let names = draft.nodes.iter().map(|node| node.name.as_str());
                let hint = suggestion(wanted, names);
                let message = format!("no node \"{wanted}\" in {}", draft.label);
                context.error(&node.span(), message, &hint);
            }
            [first, ..] => {
                let message = format!("{} nodes are named \"{wanted}\"", matching.len());
                let hint = format!("write its path, such as \"{}\"", draft.nodes[first].path);
                context.error(&node.span(), message, &hint);
            }
        }
    }
}

fn bounded_room(
    draft: &mut Draft,
    section: Option<&RoomSection>,
    name: &str,
    surfaces: &[u32],
    (low, high): (DVec3, DVec3),
    context: &mut Context,
) {
    if (high - low).min_element() < 0.1 {
        context.note(format!(
            "room \"{name}\": the geometry is flat, {:.3} m × {:.3} m × {:.3} m",
            high.x - low.x,
            high.y - low.y,
            high.z - low.z
        ));
    }
    let mut shell = shell_of(&draft.mesh, surfaces, (low, high), false);
    if shell.floor.is_empty() && shell.walls.is_empty() && shell.ceiling.is_empty() {
        shell = shell_of(&draft.mesh, surfaces, (low, high), true);
        if !shell.floor.is_empty() {
            context
                .note(format!("room \"{name}\": faces of the shell look outwards; both sides reflect alike"));
        }
    }
    for &(surface, _) in shell.floor.iter().chain(&shell.ceiling).chain(&shell.walls) {
        draft.mesh.surfaces[surface as usize].furniture = false;
    }
    let footprint = vec![
        DVec2::new(low.x, low.y),
        DVec2::new(high.x, low.y),
        DVec2::new(high.x, high.y),
        DVec2::new(low.x, high.y),
    ];
    let boundary = (footprint, low.z, high.z - low.z);
    add_room(draft, section, name, boundary, &shell, context);
}

/// Surfaces of which more than half lies on the bounds and looks inwards (or, `either_side`, outwards
/// too). A surface that is floor and walls at once is listed under both.
fn shell_of(mesh: &Mesh, surfaces: &[u32], (low, high): (DVec3, DVec3), either_side: bool) -> Shell {
    const FLOOR: usize = 0;
    const CEILING: usize = 1;
    const WALLS: usize = 2;
    let planes = [
        (FLOOR, DVec3::Z, low),
        (CEILING, DVec3::NEG_Z, high),
        (WALLS, DVec3::X, low),
        (WALLS, DVec3::NEG_X, high),
        (WALLS, DVec3::Y, low),
        (WALLS, DVec3::NEG_Y, high),
    ];
    let mut areas = vec![([0.0; 3], 0.0); mesh.surfaces.len()];
    for index in 0..mesh.triangles.len() {
        let (normal, area_m2) = mesh.normal_and_area(index);
        let corners = mesh.corners(index);
        let (parts, total) = &mut areas[mesh.triangles[index].surface as usize];
        *total += area_m2;
        let on = planes.iter().find(|(_, inward, at)| {
            let cos = normal.dot(*inward);
            let faces = cos > 0.9 || (either_side && cos < -0.9);
            faces && corners.iter().all(|p| (p - at).dot(*inward).abs() < SHELL_M)
        });
        if let Some((part, _, _)) = on {
            parts[*part] += area_m2;
        }
    }
    let mut shell = Shell::default();
    for &surface in surfaces {
        let (parts, total) = areas[surface as usize];
        if parts.iter().sum::<f64>() <= 0.5 * total {
            continue;
        }
        for (part, list) in
            [(FLOOR, &mut shell.floor), (CEILING, &mut shell.ceiling), (WALLS, &mut shell.walls)]
        {
            if parts[part] > 0.05 * total {
                list.push((surface, parts[part]));
            }
        }
    }
    shell
}

/// Bounds of the triangles of some surfaces, or of all.
fn triangle_bounds(mesh: &Mesh, surfaces: Option<&[u32]>) -> Option<(DVec3, DVec3)> {
    let mut bounds: Option<(DVec3, DVec3)> = None;
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        if surfaces.is_none_or(|surfaces| surfaces.binary_search(&triangle.surface).is_ok()) {
            for p in mesh.corners(index) {
                let (low, high) = bounds.unwrap_or((p, p));
                bounds = Some((low.min(p), high.max(p)));
            }
        }
    }
    bounds
}
