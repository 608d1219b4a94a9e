//! `[[viewpoint]]` → observers. A sweep turns the line of sight about
//! the vertical; without a direction the line of sight is +x, so its angles are azimuths.

use std::ops::Range;

use glam::{DMat3, DVec3};
use toml::Spanned;

use super::areas::light_scene_index;
use super::draft::{Draft, Located, locate};
use super::given::{given, ground};
use super::viewpoint_list;
use crate::glare::index::{self, INDICES, parse};
use crate::glare::luminances::FIELD_HALF_ANGLES_DEG;
use crate::glare::source::Given;
use crate::project::context::Context;
use crate::project::schema::{At, File, SweepSection, ViewpointSection};
use crate::project::{LightScene, Task, Viewpoint};
use crate::sphere::{azimuth_tilt_deg, rounded_deg};

/// Directions one sweep may have.
const MAX_DIRECTIONS: f64 = 3600.0;

/// Adds all observers to their worlds.
pub fn add(file: &File, drafts: &mut [Draft], light_scenes: &[LightScene], context: &mut Context) {
    for section in &file.viewpoints {
        let span = section.span();
        let section = section.get_ref();
        let light_scene = light_scene_index(section.light_scene.as_ref(), light_scenes, context);
        let mut indices = indices(&section.indices, context);
        if !context.finite(section.eye.get_ref(), &section.eye.span()) {
            continue;
        }
        let eye = DVec3::from_array(*section.eye.get_ref());
        let Some(lines) = directions(section, eye, &span, context) else {
            continue;
        };
        let (directions, azimuths_deg): (Vec<DVec3>, Vec<f64>) = lines.into_iter().unzip();
        let Some(task) = task_of(section, eye, &directions, context) else { continue };
        let Some(given) = given(section, context) else { continue };
        let Some(ground) = ground(section, drafts, context) else { continue };
        if section.task.is_some() || section.task_deg.is_some() {
            with_task(&mut indices);
        }
        let name_span = section.name.span();
        let viewpoint = Viewpoint {
            name: section.name.get_ref().clone(),
            room: 0,
            eye,
            directions,
            azimuths_deg,
            indices,
            light_scene,
            highlights: section.highlights.as_ref().is_none_or(|wanted| *wanted.get_ref()),
            task,
            area: ground.area,
            area_reflectance: ground.reflectance,
            given: Given { ground: ground.given, ..given },
            written: Some(context.place(&section.eye.span())),
        };
        let mut report = |context: &mut Context, message: String| {
            context.error(&name_span, message, "");
        };
        insert(viewpoint, drafts, context, &mut report);
    }
    viewpoint_list::add(file, drafts, light_scenes, context);
}

/// Adds an observer to the room that it lies in.
pub(super) fn insert(
    mut viewpoint: Viewpoint,
    drafts: &mut [Draft],
    context: &mut Context,
    report: &mut dyn FnMut(&mut Context, String),
) {
    let name = &viewpoint.name;
    if name.trim().is_empty() {
        report(context, "the viewpoint's name is empty".to_owned());
        return;
    }
    let taken = |draft: &Draft| draft.viewpoints.iter().any(|other| other.name == *name);
    if drafts.iter().any(taken) {
        report(context, format!("a second viewpoint \"{name}\""));
        return;
    }
    match locate(drafts, viewpoint.eye) {
        Located::In(world, room) => {
            let elsewhere = |area: usize| drafts[world].areas.get(area).is_none_or(|area| area.room != room);
            if viewpoint.area.is_some_and(elsewhere) {
                report(context, format!("the area of viewpoint \"{name}\" lies in another room"));
                return;
            }
            viewpoint.room = room;
            drafts[world].viewpoints.push(viewpoint);
        }
        Located::Outside if drafts.is_empty() => {}
        Located::Outside => report(context, format!("viewpoint \"{name}\" lies outside of every room")),
        Located::Ambiguous(rooms) => {
            report(context, format!("viewpoint \"{name}\" lies in more than one room: {rooms}"));
        }
    }
}

/// Keys of the indices named, in their order.
pub fn indices(names: &[At<String>], context: &mut Context) -> Vec<&'static str> {
    let mut keys = Vec::new();
    for name in names {
        if let Some(index) = parse(name.get_ref()) {
            keys.push(index.key);
        } else {
            let known: Vec<&str> = INDICES.iter().map(|index| index.key).collect();
            let message = format!("\"{}\" is no index that can be computed", name.get_ref());
            context.error(&name.span(), message, &format!("there are: {}", known.join(", ")));
        }
    }
    keys
}

/// Which of a task's numbers is wrong.
pub(super) enum Wrong {
    Place,
    Opening,
}

/// What is looked at. A task that no line of sight has before it is a mistake: which number, what is wrong, a hint.
pub(super) fn task(
    at: Option<DVec3>,
    opening_deg: Option<f64>,
    eye: DVec3,
    directions: &[DVec3],
) -> Result<Task, (Wrong, String, String)> {
    let most_deg = 2.0 * FIELD_HALF_ANGLES_DEG[0];
    let opening_deg = opening_deg.unwrap_or(Task::default().opening_deg);
    if !(opening_deg > 0.0 && opening_deg < most_deg) {
        let message = format!("task_deg must lie between 0 and {most_deg}, found {opening_deg}");
        let hint =
            format!("the full opening angle of the task's cone; its surround ends at a cone of {most_deg}°");
        return Err((Wrong::Opening, message, hint));
    }
    let Some(place) = at else { return Ok(Task { at, opening_deg }) };
    if !((place - eye).length() > 1e-9) {
        let hint = "task = [x, y, z], the point looked at".to_owned();
        return Err((Wrong::Place, "the task lies in the eye".into(), hint));
    }
    if !directions.iter().any(|gaze| gaze.dot(place - eye) > 0.0) {
        let hint = "it must lie within 90° of the line of sight: turn that, or move the task".to_owned();
        return Err((Wrong::Place, "the task lies behind the eye".into(), hint));
    }
    Ok(Task { at, opening_deg })
}

/// The task of a section; its mistakes are reported.
fn task_of(
    section: &ViewpointSection,
    eye: DVec3,
    directions: &[DVec3],
    context: &mut Context,
) -> Option<Task> {
    let place = section.task.as_ref();
    if place.is_some_and(|place| !context.finite(place.get_ref(), &place.span())) {
        return None;
    }
    let at = place.map(|place| DVec3::from_array(*place.get_ref()));
    let opening_deg = section.task_deg.as_ref().map(|opening| *opening.get_ref());
    match task(at, opening_deg, eye, directions) {
        Ok(task) => Some(task),
        Err((wrong, message, hint)) => {
            let span = match wrong {
                Wrong::Place => section.task.as_ref().map(Spanned::span),
                Wrong::Opening => section.task_deg.as_ref().map(Spanned::span),
            };
            context.error(&span.unwrap_or(section.name.span()), message, &hint);
            None
        }
    }
}

/// The indices of a task join those asked for.
pub(super) fn with_task(indices: &mut Vec<&'static str>) {
    let further = index::of_task().map(|index| index.key).filter(|key| !indices.contains(key));
    indices.extend(further.collect::<Vec<_>>());
}

/// Lines of sight with their azimuths in degrees: those of a sweep as it is written where nothing else sets its
/// beginning.
fn directions(
    section: &ViewpointSection,
    eye: DVec3,
    span: &Range<usize>,
    context: &mut Context,
) -> Option<Vec<(DVec3, f64)>> {
    let (ahead, place) = match (&section.direction, &section.target, &section.sweep) {
        (Some(_), Some(target), _) => {
            context.error(&target.span(), "give either `direction` or `target`", "");
            return None;
        }
        (Some(direction), None, _) => (DVec3::from_array(*direction.get_ref()), direction.span()),
        (None, Some(target), _) => (DVec3::from_array(*target.get_ref()) - eye, target.span()),
        (None, None, Some(sweep)) => (DVec3::X, sweep.span()),
        (None, None, None) => {
            let hint = "direction = [x, y, z], target = [x, y, z] or sweep = { from, to, step }";
            context.missing(span, "the viewpoint looks nowhere", hint);
            return None;
        }
    };
    if !(ahead.length() > 1e-9 && ahead.is_finite()) {
        context.error(&place, "the line of sight has no direction", "");
        return None;
    }
    let ahead = ahead.normalize();
    let Some(sweep) = &section.sweep else {
        return Some(vec![(ahead, azimuth_tilt_deg(ahead)[0])]);
    };
    let SweepSection { from, to, step } = sweep.get_ref();
    let (from, to, step) = (*from.get_ref(), *to.get_ref(), *step.get_ref());
    let steps = ((to - from) / step + 1e-9).floor();
    if !(step > 0.0 && (0.0..MAX_DIRECTIONS).contains(&steps)) {
        let message = format!("a sweep runs upwards in at most {MAX_DIRECTIONS} steps");
        context.error(&sweep.span(), message, "for example { from = 0, to = 345, step = 15 }");
        return None;
    }
    Some(
        (0..=steps as u32)
            .map(|i| {
                let angle_deg = from + f64::from(i) * step;
                let sight = DMat3::from_rotation_z(angle_deg.to_radians()) * ahead;
                // Only without a direction are the angles of a sweep azimuths as somebody wrote them.
                let written = section.direction.is_none() && section.target.is_none();
                (sight, if written { rounded_deg(angle_deg) } else { azimuth_tilt_deg(sight)[0] })
            })
            .collect(),
    )
}
