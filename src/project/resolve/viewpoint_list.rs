//! The list of viewpoints, a CSV file → observers. One row is one eye in one direction.

use glam::DVec3;

use super::draft::Draft;
use super::given::area_named;
use super::lists::{Row, Table};
use super::viewpoints::{insert, task, with_task};
use crate::glare::index::{INDICES, parse};
use crate::glare::source::Given;
use crate::project::context::Context;
use crate::project::diagnostics::suggestion;
use crate::project::schema::File;
use crate::project::{LightScene, Task, Viewpoint};
use crate::sphere::from_azimuth_tilt;

/// Columns of the list; the first five are needed.
const COLUMNS: &[&str] = &[
    "name",
    "x",
    "y",
    "z",
    "azimuth",
    "tilt",
    "task_x",
    "task_y",
    "task_z",
    "task_deg",
    "indices",
    "light_scene",
    "area",
];

/// Adds the listed observers to their worlds.
pub fn add(file: &File, drafts: &mut [Draft], light_scenes: &[LightScene], context: &mut Context) {
    let list = file.lists.as_ref().and_then(|lists| lists.get_ref().viewpoints.as_ref());
    let Some(table) = list.and_then(|path| Table::read(path, COLUMNS, 5, context)) else { return };
    for row in &table.rows {
        let Some(name) = row.cells[0].clone() else {
            table.error(row, "name is missing".to_owned(), "", context);
            continue;
        };
        let numbers =
            (table.needed3(row, 1, context), table.needed(row, 4, context), table.number(row, 5, context));
        let (Ok(eye), Ok(azimuth_deg), Ok(tilt_deg)) = numbers else { continue };
        let eye = DVec3::from_array(eye);
        let tilt_deg = tilt_deg.unwrap_or(0.0);
        if !(-90.0..=90.0).contains(&tilt_deg) {
            table.error(row, format!("tilt must lie in −90 … 90, found {tilt_deg}"), "", context);
            continue;
        }
        let directions = vec![from_azimuth_tilt(azimuth_deg, tilt_deg)];
        let (Ok(task), Ok(mut indices), Ok(light_scene), Ok(area)) = (
            task_of(&table, row, eye, &directions, context),
            indices(&table, row, context),
            light_scene(&table, row, light_scenes, context),
            area(&table, row, drafts, context),
        ) else {
            continue;
        };
        if task.is_some() {
            with_task(&mut indices);
        }
        let viewpoint = Viewpoint {
            name,
            room: 0,
            eye,
            directions,
            azimuths_deg: vec![azimuth_deg],
            indices,
            light_scene,
            highlights: true,
            task: task.unwrap_or_default(),
            area,
            area_reflectance: None,
            given: Given::default(),
            written: Some(table.place(row)),
        };
        let mut report = |context: &mut Context, message: String| {
            table.error(row, message, "", context);
        };
        insert(viewpoint, drafts, context, &mut report);
    }
}

/// The task of a row, where one of its four cells is filled.
fn task_of(
    table: &Table,
    row: &Row,
    eye: DVec3,
    directions: &[DVec3],
    context: &mut Context,
) -> Result<Option<Task>, ()> {
    let at = if row.cells[6..9].iter().any(Option::is_some) {
        Some(DVec3::from_array(table.needed3(row, 6, context)?))
    } else {
        None
    };
    let opening_deg = table.number(row, 9, context)?;
    if at.is_none() && opening_deg.is_none() {
        return Ok(None);
    }
    task(at, opening_deg, eye, directions).map(Some).map_err(|(_, message, hint)| {
        table.error(row, message, &hint, context);
    })
}

/// Keys of the indices of a row, divided by spaces or semicolons.
fn indices(table: &Table, row: &Row, context: &mut Context) -> Result<Vec<&'static str>, ()> {
    let mut keys = Vec::new();
    let cell = row.cells[10].as_deref().unwrap_or_default();
    for name in cell.split([' ', ';']).filter(|name| !name.is_empty()) {
        let Some(index) = parse(name) else {
            let known: Vec<&str> = INDICES.iter().map(|index| index.key).collect();
            let message = format!("\"{name}\" is no index that can be computed");
            table.error(row, message, &format!("there are: {}", known.join(", ")), context);
            return Err(());
        };
        if !keys.contains(&index.key) {
            keys.push(index.key);
        }
    }
    Ok(keys)
}

fn light_scene(
    table: &Table,
    row: &Row,
    light_scenes: &[LightScene],
    context: &mut Context,
) -> Result<Option<usize>, ()> {
    let Some(name) = &row.cells[11] else { return Ok(None) };
    let found = light_scenes.iter().position(|scene| scene.name == *name);
    found.map(Some).ok_or_else(|| {
        let hint = suggestion(name, light_scenes.iter().map(|scene| scene.name.as_str()));
        table.error(row, format!("no light scene \"{name}\""), &hint, context);
    })
}

fn area(table: &Table, row: &Row, drafts: &[Draft], context: &mut Context) -> Result<Option<usize>, ()> {
    let Some(name) = &row.cells[12] else { return Ok(None) };
    area_named(drafts, name).map(|(_, area)| Some(area)).ok_or_else(|| {
        let known = drafts.iter().flat_map(|draft| &draft.areas);
        let hint = suggestion(name, known.map(|area| area.name.as_str()));
        table.error(row, format!("no area \"{name}\""), &hint, context);
    })
}
