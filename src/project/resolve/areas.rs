//! `[[area]]` → areas in their rooms. Every shape is checked here, so that `plan` may divide by its
//! edges.

use std::ops::Range;

use glam::{DVec2, DVec3};

use super::area_surface::on_surface;
use super::draft::{Draft, Located, in_room, locate_area, room_named, room_names};
use super::lists::Table;
use super::{settings, zones};
use crate::geometry::polygon;
use crate::grid::GridRule;
use crate::project::choices::AreaGrid;
use crate::project::context::Context;
use crate::project::diagnostics::suggestion;
use crate::project::schema::{AreaSection, At, File, RectSection};
use crate::project::{AreaKind, AreaShape, AreaSpec, LightScene, Norm};
use crate::quantity::{Quantity, SPELLINGS};

/// Smallest edge of an area, m.
const SMALLEST_M: f64 = 1e-3;
/// Most points of a counted grid.
const MAX_POINTS: usize = 1_000_000;

/// Adds all areas to their worlds.
pub fn add(
    file: &File,
    drafts: &mut [Draft],
    light_scenes: &[LightScene],
    norm: Option<&Norm>,
    context: &mut Context,
) {
    let sections = &file.areas;
    let mut surroundings: Vec<(usize, usize, At<String>)> = Vec::new();
    // Zones that the norm draws round a task come after the tasks, wherever they are listed.
    let (drawn, listed): (Vec<&At<AreaSection>>, Vec<&At<AreaSection>>) =
        sections.iter().partition(|section| zones::is_drawn(section.get_ref()));
    for section in listed.into_iter().chain(drawn) {
        let span = section.span();
        let section = section.get_ref();
        let name = section.name.get_ref();
        if name.trim().is_empty() {
            context.error(&section.name.span(), "the area's name is empty", "");
        }
        let taken = |draft: &Draft| draft.areas.iter().any(|other| other.name == *name);
        if drafts.iter().any(taken) {
            let message = format!("a second area \"{name}\"");
            context.error(&section.name.span(), message, "names of areas are unique");
        }
        let light_scene = light_scene_index(section.light_scene.as_ref(), light_scenes, context);
        let quantities = quantities(&section.quantities, context);
        let rule = rule(section.grid.as_ref(), context);
        if let Some(border) = &section.border {
            context.in_range(border, 0.0, f64::INFINITY, "border");
        }
        let kind = section.kind.unwrap_or(AreaKind::Task);
        let wanted = wanted_room(section, drafts, context);
        let placed = if zones::is_drawn(section) {
            zones::around(section, file, drafts, norm, context)
        } else {
            shape(section, &span, drafts, wanted, context)
        };
        let (Some((shape, world, room)), Ok(_)) = (placed, wanted) else {
            continue;
        };
        let own_row = section.row.as_ref().map(At::get_ref).or(drafts[world].rooms[room].row.as_ref());
        let modified = match &section.modified {
            Some(modified) if kind != AreaKind::Task => {
                let message = "only a task area has an illuminance to modify";
                context.error(&modified.span(), message, "the zones round it follow");
                None
            }
            Some(modified) => settings::modification(modified, own_row, file, norm, context),
            None => None,
        };
        if let Some(of) = &section.of {
            surroundings.push((world, drafts[world].areas.len(), of.clone()));
        }
        drafts[world].areas.push(AreaSpec {
            name: name.clone(),
            kind,
            of: None,
            room,
            row: section.row.as_ref().map(|row| row.get_ref().clone()),
            modified,
            light_scene,
            shape,
            rule,
            border_m: section.border.as_ref().map_or(0.0, |border| *border.get_ref()),
            quantities,
            written: Some(context.place(&section.name.span())),
        });
    }
    for (world, index, of) in surroundings {
        let areas = &drafts[world].areas;
        let task = areas.iter().position(|area| area.name == *of.get_ref() && area.kind == AreaKind::Task);
        // A task area with a mistake of its own is not unknown.
        let written = sections.iter().map(At::get_ref).any(|section| {
            section.name.get_ref() == of.get_ref() && section.kind.is_none_or(|kind| kind == AreaKind::Task)
        });
        let lost = file.may_have_lost("area", of.get_ref())
            || written && !areas.iter().any(|area| area.name == *of.get_ref());
        if task.is_none() && !lost {
            let tasks = areas.iter().filter(|area| area.kind == AreaKind::Task);
            let hint = suggestion(of.get_ref(), tasks.map(|area| area.name.as_str()));
            let message = format!("no task area \"{}\" in the same room", of.get_ref());
            context.error(&of.span(), message, &hint);
        }
        drafts[world].areas[index].of = task;
    }
}

/// Index of a light scene; an unknown one is reported.
pub fn light_scene_index(
    name: Option<&At<String>>,
    light_scenes: &[LightScene],
    context: &mut Context,
) -> Option<usize> {
    let name = name?;
    let found = light_scenes.iter().position(|scene| scene.name == *name.get_ref());
    if found.is_none() {
        let known = light_scenes.iter().map(|scene| scene.name.as_str());
        let hint = suggestion(name.get_ref(), known);
        let message = format!("no light scene \"{}\"", name.get_ref());
        context.error(&name.span(), message, &hint);
    }
    found
}

fn quantities(names: &[At<String>], context: &mut Context) -> Vec<Quantity> {
    let mut quantities = Vec::new();
    for name in names {
        match Quantity::parse(name.get_ref()) {
            Some(quantity) if quantity.is_single() => {
                let message = format!("{} is no quantity of an area", name.get_ref());
                context.error(&name.span(), message, "UGR belongs to rooms and viewpoints");
            }
            Some(quantity) => quantities.push(quantity),
            None => {
                let hint = suggestion(name.get_ref(), SPELLINGS.iter().copied());
                let message = format!("unknown quantity \"{}\"", name.get_ref());
                context.error(&name.span(), message, &hint);
            }
        }
    }
    quantities
}

fn rule(grid: Option<&At<AreaGrid>>, context: &mut Context) -> GridRule {
    let Some(grid) = grid else {
        return GridRule::En;
    };
    match *grid.get_ref() {
        AreaGrid::En => GridRule::En,
        AreaGrid::Step(step_m) => {
            context.positive(step_m, &grid.span(), "step");
            GridRule::Step(step_m)
        }
        AreaGrid::Count([n, m]) => {
            if n == 0 || m == 0 || n.saturating_mul(m) > MAX_POINTS {
                let message = format!("a grid has 1 … {MAX_POINTS} points, here {n} × {m}");
                context.error(&grid.span(), message, "");
            }
            GridRule::Count([n, m])
        }
    }
}

fn wanted_room(
    section: &AreaSection,
    drafts: &[Draft],
    context: &mut Context,
) -> Result<Option<(usize, usize)>, ()> {
    let Some(room) = &section.room else {
        return Ok(None);
    };
    let found = room_named(drafts, room.get_ref());
    if found.is_none() && !drafts.is_empty() {
        let hint = suggestion(room.get_ref(), room_names(drafts));
        let message = format!("no room \"{}\"", room.get_ref());
        context.error(&room.span(), message, &hint);
    }
    found.map(Some).ok_or(())
}

/// The shape, and the world and room it lies in.
fn shape(
    section: &AreaSection,
    span: &Range<usize>,
    drafts: &[Draft],
    wanted: Result<Option<(usize, usize)>, ()>,
    context: &mut Context,
) -> Option<(AreaShape, usize, usize)> {
    let shapes = [
        section.rect.is_some(),
        section.polygon.is_some(),
        section.surface.is_some(),
        section.points.is_some(),
    ];
    if shapes.into_iter().filter(|given| *given).count() != 1 {
        let message = format!(
            "area \"{}\" needs exactly one of rect, polygon, surface, points",
            section.name.get_ref()
        );
        let hint = "or, for a surrounding or background, none of them and `of = \"<task area>\"`";
        context.missing(span, message, hint);
        return None;
    }
    if let Some(surface) = &section.surface {
        return on_surface(surface, drafts, wanted.ok()?, context);
    }
    let (shape, corners, place) = if let Some(rect) = &section.rect {
        let (shape, corners) = rectangle(rect, context)?;
        (shape, corners, rect.span())
    } else if let Some(corners) = &section.polygon {
        let points = outline(corners, context)?;
        (AreaShape::Polygon(points.clone()), points, corners.span())
    } else {
        let path = section.points.as_ref()?;
        let points = free_points(path, context)?;
        let positions = points.iter().map(|(position, _)| *position).collect();
        (AreaShape::Points(points), positions, path.span())
    };
    if drafts.is_empty() {
        return None;
    }
    let name = section.name.get_ref();
    let (world, room) = match (wanted.ok()?, locate_area(drafts, &corners)) {
        (Some((world, room)), _) | (None, Located::In(world, room)) => (world, room),
        (None, Located::Outside) => {
            let message = format!("area \"{name}\" lies outside of every room");
            context.error(&place, message, "");
            return None;
        }
        (None, Located::Ambiguous(rooms)) => {
            let message = format!("area \"{name}\" lies in more than one room: {rooms}");
            context.error(&place, message, "name its `room`");
            return None;
        }
    };
    let found = &drafts[world].rooms[room];
    if let Some(corner) = corners.iter().find(|corner| !in_room(found, **corner)) {
        let message = format!(
            "area \"{name}\" reaches outside of room \"{}\" at ({}, {}, {})",
            found.name, corner.x, corner.y, corner.z
        );
        context.error(&place, message, "");
        return None;
    }
    Some((shape, world, room))
}

fn rectangle(rect: &At<RectSection>, context: &mut Context) -> Option<(AreaShape, Vec<DVec3>)> {
    let span = rect.span();
    let RectSection { origin, u, v } = rect.get_ref();
    for vector in [origin, u, v] {
        if !context.finite(vector.get_ref(), &vector.span()) {
            return None;
        }
    }
    let [origin, u, v] = [origin, u, v].map(|vector| DVec3::from_array(*vector.get_ref()));
    if !(u.length() >= SMALLEST_M && v.length() >= SMALLEST_M) {
        context.error(&span, "the area has no size", "u and v are its full edges in metres");
        return None;
    }
    if u.dot(v).abs() > 1e-6 * u.length() * v.length() {
        context.error(&span, "u and v must be at right angles", "use `polygon`");
        return None;
    }
    let corners = vec![origin, origin + u, origin + u + v, origin + v];
    Some((AreaShape::Rect { origin, u, v }, corners))
}

fn outline(corners: &At<Vec<[f64; 3]>>, context: &mut Context) -> Option<Vec<DVec3>> {
    let span = corners.span();
    for corner in corners.get_ref() {
        if !context.finite(corner, &span) {
            return None;
        }
    }
    let points: Vec<DVec3> = corners.get_ref().iter().map(|c| DVec3::from_array(*c)).collect();
    let first = points.first().copied().unwrap_or_default();
    // Newell: the sum of the corners' cross products is twice the area along the normal.
    let doubled: DVec3 = points.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum();
    if points.len() < 3 || !(doubled.length() > 2.0 * SMALLEST_M * SMALLEST_M) {
        context.error(&span, "the area has no size", "a polygon needs three corners or more");
        return None;
    }
    let normal = doubled.normalize();
    if points.iter().any(|p| (p - first).dot(normal).abs() > 1e-3) {
        context.error(&span, "the polygon is not plane within 1 mm", "");
        return None;
    }
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let flat: Vec<DVec2> = points.iter().map(|p| DVec2::new(p.dot(u), p.dot(v))).collect();
    if polygon::crossing(&flat).is_some() {
        context.error(&span, "the polygon intersects itself", "");
        return None;
    }
    Some(points)
}

fn free_points(path: &At<String>, context: &mut Context) -> Option<Vec<(DVec3, Option<DVec3>)>> {
    let table = Table::read(path, &["x", "y", "z", "nx", "ny", "nz"], 3, context)?;
    let mut points = Vec::with_capacity(table.rows.len());
    let before = context.diagnostics.len();
    for row in &table.rows {
        let Ok(position) = table.needed3(row, 0, context) else {
            continue;
        };
        let normal = if row.cells[3..].iter().all(Option::is_none) {
            None
        } else {
            let Ok(normal) = table.needed3(row, 3, context) else {
                continue;
            };
            let normal = DVec3::from_array(normal);
            if !(normal.length() > 1e-9) {
                table.error(row, "the normal has no direction".to_owned(), "", context);
                continue;
            }
            Some(normal.normalize())
        };
        points.push((DVec3::from_array(position), normal));
    }
    (context.diagnostics.len() == before).then_some(points)
}
