//! `[[glare_map]]` → grids of eyes with lines of sight all round.

use glam::DVec3;

use super::areas::light_scene_index;
use super::draft::{Draft, Located, locate};
use super::viewpoints::indices;
use crate::glare::index::parse;
use crate::project::context::Context;
use crate::project::schema::File;
use crate::project::{GlareMap, LightScene};

/// Directions if none are given.
const DIRECTIONS: u32 = 8;
/// Most directions of an eye.
const MOST_DIRECTIONS: u32 = 360;
/// Most eyes times directions of a map.
const MOST_VIEWS: f64 = 1e6;

/// Adds all maps to their worlds.
pub fn add(file: &File, drafts: &mut [Draft], light_scenes: &[LightScene], context: &mut Context) {
    for (number, section) in file.glare_maps.iter().enumerate() {
        let section = section.get_ref();
        let light_scene = light_scene_index(section.light_scene.as_ref(), light_scenes, context);
        let indices = indices(&section.indices, context);
        for name in &section.indices {
            if parse(name.get_ref()).is_some_and(|index| index.zones.is_some()) {
                let message = format!(
                    "\"{}\" compares a task with what surrounds it, and the eyes of a map have none",
                    name.get_ref()
                );
                context.error(&name.span(), message, "ask for it at a [[viewpoint]]");
            }
        }
        let span = section.rect.span();
        let rect = section.rect.get_ref();
        let finite = [&rect.origin, &rect.u, &rect.v].map(|at| context.finite(at.get_ref(), &at.span()));
        let step_m = *section.step.get_ref();
        if finite.contains(&false) || !context.positive(step_m, &section.step.span(), "step") {
            continue;
        }
        let [origin, u, v] =
            [&rect.origin, &rect.u, &rect.v].map(|corner| DVec3::from_array(*corner.get_ref()));
        let directions = section.directions.as_ref().map_or(DIRECTIONS, |directions| *directions.get_ref());
        if !(1..=MOST_DIRECTIONS).contains(&directions) {
            context.error(&span, format!("a map has 1 … {MOST_DIRECTIONS} directions"), "directions = 8");
            continue;
        }
        if !(u.cross(v).length() > 1e-9) || u.z.abs() + v.z.abs() > 1e-9 {
            context.error(&span, "the map's rectangle must lie flat and have an area", "");
            continue;
        }
        if !(u.length() * v.length() / (step_m * step_m) * f64::from(directions) <= MOST_VIEWS) {
            let message = format!("a map has at most {MOST_VIEWS} eyes times directions");
            context.error(&section.step.span(), message, "take a larger step");
            continue;
        }
        let name = section.name.as_ref().map_or(format!("map {}", number + 1), |name| name.get_ref().clone());
        let taken = |draft: &Draft| draft.glare_maps.iter().any(|other| other.name == name);
        if drafts.iter().any(taken) {
            context.error(&span, format!("a second glare map \"{name}\""), "");
            continue;
        }
        match locate(drafts, origin + 0.5 * (u + v)) {
            Located::In(world, room) => drafts[world].glare_maps.push(GlareMap {
                name,
                room,
                origin,
                edges: [u, v],
                step_m,
                directions,
                indices,
                light_scene,
            }),
            Located::Outside if drafts.is_empty() => {}
            Located::Outside => {
                context.error(&span, format!("the middle of \"{name}\" lies outside of every room"), "");
            }
            Located::Ambiguous(rooms) => {
                context.error(&span, format!("the middle of \"{name}\" lies in several rooms: {rooms}"), "");
            }
        }
    }
}
