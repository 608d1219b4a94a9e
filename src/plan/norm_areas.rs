//! The areas that a norm implies for a room that lists none: working plane, volumes, ceiling, walls.

use glam::{DVec2, DVec3};

use crate::grid::{GridRule, width};
use crate::norm::{Plane, Zone};
use crate::project::{AreaKind, AreaShape, AreaSpec, Project, Room};
use crate::scene::Scene;

/// Areas for a room that lists none: the whole working plane, a volume at eye height, walls, ceiling.
pub(super) fn norm_areas(project: &Project, scene: &Scene, room: &Room, index: usize) -> Vec<AreaSpec> {
    let Some(norm) = &project.norm else { return Vec::new() };
    let Some(reference) = room.row.as_ref().or(norm.row.as_ref()) else { return Vec::new() };
    let Some(row) = norm.standard.row(reference) else { return Vec::new() };
    let standard = &norm.standard;
    let application = &standard.application;
    let plane_m = row.plane_m.unwrap_or(application.working_plane_m.value);
    let flat = |height_m: f64| -> Vec<DVec3> {
        room.footprint.iter().map(|p| DVec3::new(p.x, p.y, room.floor_m + height_m)).collect()
    };
    let spec = |name: &str, kind, shape, border_m| AreaSpec {
        name: format!("{} · {name}", room.name),
        kind,
        of: None,
        room: index,
        row: None,
        modified: None,
        light_scene: None,
        shape,
        rule: GridRule::En,
        border_m,
        quantities: Vec::new(),
        written: None,
    };
    let narrow = width(&room.footprint, &[]);
    let norms_m = row.border_m.unwrap_or(application.border_m.value);
    let border_m = if narrow > 3.0 * norms_m { norms_m } else { 0.0 };
    let mut areas = Vec::new();
    // A vertical plane lies where the board or the rack is, a court where it is marked: nobody can make it from
    // the outline.
    if row.plane == Plane::Horizontal && !row.part_of_room {
        let plane = AreaShape::Polygon(flat(plane_m));
        areas.push(spec("working plane", AreaKind::Task, plane, border_m));
    }
    if standard.regulates(Zone::Cylindrical) {
        let heights = application.eye_heights_m(row.posture);
        for height_m in &heights {
            let name = if heights.len() > 1 { format!("volume {height_m} m") } else { "volume".to_owned() };
            areas.push(spec(&name, AreaKind::Volume, AreaShape::Polygon(flat(*height_m)), border_m));
        }
    }
    if standard.regulates(Zone::Ceiling) {
        let ceiling = AreaShape::Polygon(flat(room.height_m).into_iter().rev().collect());
        areas.push(spec("ceiling", AreaKind::Surface, ceiling, 0.0));
    }
    if !standard.regulates(Zone::Walls) {
        return areas;
    }
    let count = room.footprint.len();
    let names = wall_names(scene, room);
    for (number, &a) in room.footprint.iter().enumerate() {
        let b = room.footprint[(number + 1) % count];
        let origin = DVec3::new(b.x, b.y, room.floor_m);
        let shape = AreaShape::Rect { origin, u: (a - b).extend(0.0), v: DVec3::Z * room.height_m };
        areas.push(spec(&names[number], AreaKind::Surface, shape, 0.0));
    }
    areas
}

/// Names of the walls in the order of the footprint: those of the surfaces that stand there, since
/// materials and areas call them so; numbers where a surface is several walls, as CAD files have it.
pub(super) fn wall_names(scene: &Scene, room: &Room) -> Vec<String> {
    let count = room.footprint.len();
    let mesh = &scene.mesh;
    let found: Vec<Option<&str>> = (0..count)
        .map(|number| {
            let (a, b) = (room.footprint[number], room.footprint[(number + 1) % count]);
            let along = (b - a).normalize_or_zero();
            let stands_there = |&wall: &u32| {
                let mut own = (0..mesh.triangles.len()).filter(|&t| mesh.triangles[t].surface == wall);
                own.any(|triangle| {
                    mesh.corners(triangle).iter().all(|corner| {
                        let p = DVec2::new(corner.x, corner.y) - a;
                        let t = p.dot(along);
                        p.perp_dot(along).abs() < 0.01 && t > -0.01 && t < (b - a).length() + 0.01
                    })
                })
            };
            let wall = room.walls.iter().copied().find(stands_there)?;
            Some(mesh.surfaces[wall as usize].name.as_str())
        })
        .collect();
    let unique = |name: &str| found.iter().filter(|other| **other == Some(name)).count() == 1;
    if let Some(names) = found.iter().copied().collect::<Option<Vec<&str>>>()
        && names.iter().all(|name| unique(name))
    {
        return names.into_iter().map(str::to_owned).collect();
    }
    (1..=count).map(|number| format!("wall {number}")).collect()
}
