//! `[[viewpoint]]` and the list of viewpoints → observers. A sweep turns the line of sight about
//! the vertical; without a direction the line of sight is +x, so its angles are azimuths.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::areas::light_scene_index;
use super::draft::{Draft, Located, locate};
use super::lists::Table;
use crate::glare::index::{self, INDICES, parse};
use crate::glare::luminances::FIELD_HALF_ANGLES_DEG;
use crate::glare::source::{Given, Ground};
use crate::project::context::Context;
use crate::project::schema::{At, File, GroundSection, SweepSection, ViewpointSection};
use crate::project::{LightScene, Task, Viewpoint};
use crate::sphere::{azimuth_tilt_deg, from_azimuth_tilt, rounded_deg};
use crate::units::Nits;

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
        let Some(task) = task(section, eye, &directions, context) else { continue };
        let Some(given) = given(section, context) else { continue };
        if section.task.is_some() || section.task_deg.is_some() {
            let further = index::of_task().map(|index| index.key).filter(|key| !indices.contains(key));
            indices.extend(further.collect::<Vec<_>>());
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
            given,
            written: Some(context.place(&section.eye.span())),
        };
        let mut report = |context: &mut Context, message: String| {
            context.error(&name_span, message, "");
        };
        insert(viewpoint, drafts, context, &mut report);
    }
    let list = file.lists.as_ref().and_then(|lists| lists.get_ref().viewpoints.as_ref());
    let columns = &["name", "x", "y", "z", "azimuth", "tilt"];
    if let Some(table) = list.and_then(|path| Table::read(path, columns, 5, context)) {
        for row in &table.rows {
            let Some(name) = row.cells[0].clone() else {
                table.error(row, "name is missing".to_owned(), "", context);
                continue;
            };
            let numbers = (
                table.needed3(row, 1, context),
                table.needed(row, 4, context),
                table.number(row, 5, context),
            );
            let (Ok(eye), Ok(azimuth_deg), Ok(tilt_deg)) = numbers else {
                continue;
            };
            let tilt_deg = tilt_deg.unwrap_or(0.0);
            if !(-90.0..=90.0).contains(&tilt_deg) {
                table.error(row, format!("tilt must lie in −90 … 90, found {tilt_deg}"), "", context);
                continue;
            }
            let viewpoint = Viewpoint {
                name,
                room: 0,
                eye: DVec3::from_array(eye),
                directions: vec![from_azimuth_tilt(azimuth_deg, tilt_deg)],
                azimuths_deg: vec![azimuth_deg],
                indices: Vec::new(),
                light_scene: None,
                highlights: true,
                task: Task::default(),
                given: Given::default(),
                written: Some(table.place(row)),
            };
            let mut report = |context: &mut Context, message: String| {
                table.error(row, message, "", context);
            };
            insert(viewpoint, drafts, context, &mut report);
        }
    }
}

fn insert(
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

/// What is looked at. A task that no line of sight has before it is a mistake.
fn task(section: &ViewpointSection, eye: DVec3, directions: &[DVec3], context: &mut Context) -> Option<Task> {
    let mut task = Task::default();
    if let Some(opening) = &section.task_deg {
        task.opening_deg = *opening.get_ref();
        let most_deg = 2.0 * FIELD_HALF_ANGLES_DEG[0];
        if !(task.opening_deg > 0.0 && task.opening_deg < most_deg) {
            let message = format!("task_deg must lie between 0 and {most_deg}, found {}", task.opening_deg);
            let hint = format!(
                "the full opening angle of the task's cone; its surround ends at a cone of {most_deg}°"
            );
            context.error(&opening.span(), message, &hint);
            return None;
        }
    }
    if let Some(place) = &section.task {
        if !context.finite(place.get_ref(), &place.span()) {
            return None;
        }
        let at = DVec3::from_array(*place.get_ref());
        if !((at - eye).length() > 1e-9) {
            context.error(&place.span(), "the task lies in the eye", "task = [x, y, z], the point looked at");
            return None;
        }
        task.at = Some(at);
        if !directions.iter().any(|gaze| gaze.dot(at - eye) > 0.0) {
            let hint = "it must lie within 90° of the line of sight: turn that, or move the task";
            context.error(&place.span(), "the task lies behind the eye", hint);
            return None;
        }
    }
    Some(task)
}

/// Ages of observers, years.
const AGES: [f64; 2] = [1.0, 120.0];

/// What no view tells: GGR asks for the ceiling, GR for the ground, f_TI for the road, veiling luminance for the age.
fn given(section: &ViewpointSection, context: &mut Context) -> Option<Given> {
    let mut given = Given::default();
    let mut ok = true;
    if let Some(age) = &section.age {
        ok &= context.in_range(age, AGES[0], AGES[1], "age");
        given.age_years = *age.get_ref();
    }
    if let Some(coverage) = &section.ceiling_coverage {
        ok &= context.in_range(coverage, f64::MIN_POSITIVE, 1.0, "ceiling_coverage");
        given.ceiling_coverage = Some(*coverage.get_ref());
    }
    if let Some(GroundSection { lx, reflectance }) = &section.ground {
        ok &= context.in_range(lx, 0.0, f64::INFINITY, "lx of the ground");
        ok &= context.in_range(reflectance, 0.0, 1.0, "reflectance of the ground");
        given.ground = Some(Ground { mean_lx: *lx.get_ref(), reflectance: *reflectance.get_ref() });
    }
    if let Some(road) = &section.road {
        ok &= context.in_range(road, 0.0, f64::INFINITY, "road");
        given.road = Some(Nits(*road.get_ref()));
    }
    ok.then_some(given)
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
