//! A room built from its outline: materials of floor, ceiling and walls, and openings.

use std::ops::Range;

use glam::DVec2;

use super::draft::Draft;
use super::materials::{Lookup, Palette, lambert};
use super::rooms::add_room;
use super::shell::{self, Opening, Plan};
use crate::material::Material;
use crate::project::choices::Surfacing;
use crate::project::context::Context;
use crate::project::diagnostics::suggestion;
use crate::project::schema::{At, RoomSection};

/// What a room is built from.
pub struct Boundary<'a> {
    pub outline: Vec<DVec2>,
    pub floor_m: f64,
    pub height_m: f64,
    pub span: Range<usize>,
    /// Floor, walls, ceiling.
    pub surfacings: [Option<&'a At<Surfacing>>; 3],
    /// Whether [materials] is asked for `Floor`, `Wall_N` … first.
    pub by_name: bool,
}

/// Builds the world of one room.
pub fn walled_draft(
    boundary: &Boundary,
    section: Option<&RoomSection>,
    name: &str,
    palette: &mut Palette,
    context: &mut Context,
) -> Option<Draft> {
    let mut draft = Draft::new(&format!("room \"{name}\""), boundary.span.clone());
    let names = shell::wall_names(&boundary.outline);
    let [floor, walls, ceiling] = boundary.surfacings;
    let mut surfaced = |surface: &str, surfacing: Option<&At<Surfacing>>| {
        let material = surface_material(surface, surfacing, boundary, palette, context);
        // After a mistake the room is still built, so that what lies in it can be checked too.
        draft.material(&material.unwrap_or_else(|| lambert(surface, 0.0)))
    };
    let floor = surfaced("Floor", floor);
    let ceiling = surfaced("Ceiling", ceiling);
    let walls: Vec<(String, usize)> =
        names.iter().map(|name| (name.clone(), surfaced(name, walls))).collect();
    let openings = openings(section, boundary, &names, &mut draft, palette, context);
    let plan = Plan {
        outline: &boundary.outline,
        floor_m: boundary.floor_m,
        height_m: boundary.height_m,
        floor: ("Floor", floor),
        ceiling: ("Ceiling", ceiling),
        walls: &walls,
        openings: &openings,
    };
    let Some(shell) = shell::build(&mut draft.mesh, &plan) else {
        context.error(&boundary.span, "the footprint cannot be filled with triangles", "");
        return None;
    };
    let limits = (boundary.outline.clone(), boundary.floor_m, boundary.height_m);
    add_room(&mut draft, section, name, limits, &shell, context);
    Some(draft)
}

fn surface_material(
    surface: &str,
    surfacing: Option<&At<Surfacing>>,
    boundary: &Boundary,
    palette: &mut Palette,
    context: &mut Context,
) -> Option<Material> {
    if boundary.by_name {
        match palette.find(surface) {
            Lookup::Found(material) => return Some(material),
            Lookup::Wrong => return None,
            Lookup::Absent => {}
        }
    }
    let Some(at) = surfacing else {
        let message = format!("the surface {surface} has no photometric data");
        let hint = "give floor, walls and ceiling in `box`, or an entry in [materials]";
        context.error(&boundary.span, message, hint);
        return None;
    };
    match at.get_ref() {
        Surfacing::Reflectance(value) => {
            let value = toml::Spanned::new(at.span(), *value);
            context.in_range(&value, 0.0, 1.0, "reflectance").then(|| lambert(surface, *value.get_ref()))
        }
        Surfacing::Material(name) => palette.named(&toml::Spanned::new(at.span(), name.clone()), context),
    }
}

fn openings(
    section: Option<&RoomSection>,
    boundary: &Boundary,
    names: &[String],
    draft: &mut Draft,
    palette: &mut Palette,
    context: &mut Context,
) -> Vec<Opening> {
    let mut built: Vec<Opening> = Vec::new();
    for (index, opening) in section.iter().flat_map(|s| &s.openings).enumerate() {
        let opening = opening.get_ref();
        let material = palette.named(&opening.material, context);
        let Some(wall) = names.iter().position(|name| name == opening.wall.get_ref()) else {
            let hint = suggestion(opening.wall.get_ref(), names.iter().map(String::as_str));
            let message = format!("no wall \"{}\"", opening.wall.get_ref());
            context.error(&opening.wall.span(), message, &hint);
            continue;
        };
        let a = boundary.outline[wall];
        let b = boundary.outline[(wall + 1) % boundary.outline.len()];
        let length = (b - a).length();
        let (mut from, mut to) =
            (DVec2::from_array(*opening.from.get_ref()), DVec2::from_array(*opening.to.get_ref()));
        let limit = DVec2::new(length, boundary.height_m) + 1e-9;
        if !(from.cmpge(DVec2::splat(-1e-9)).all() && from.cmplt(to).all() && to.cmple(limit).all()) {
            let message = format!(
                "the opening must lie within the wall of {length} m × {} m, `from` below and before `to`",
                boundary.height_m
            );
            context.error(&opening.from.span(), message, "");
            continue;
        }
        // Compass walls are measured along +x or +y; N and W run the other way.
        if matches!(names[wall].as_str(), "Wall_N" | "Wall_W") {
            (from.x, to.x) = (length - to.x, length - from.x);
        }
        let overlaps =
            |other: &&Opening| other.wall == wall && other.from.cmplt(to).all() && from.cmplt(other.to).all();
        if built.iter().any(|other| overlaps(&other)) {
            context.error(&opening.from.span(), "the opening overlaps another one", "");
            continue;
        }
        let Some(material) = material else { continue };
        built.push(Opening {
            name: format!("{}_opening_{}", names[wall], index + 1),
            wall,
            from: from.max(DVec2::ZERO),
            to,
            material: draft.material(&material),
        });
    }
    built
}
