//! Runs `gershun body`: points → luminance bodies → files.

use std::path::Path;

use gershun::observe::body::{AskedBody, LuminanceBody, luminance_body};
use gershun::project::{Project, suggestion};
use gershun::report::Lang;
use gershun::report::body::{body_csv, body_line, body_note, body_svg};
use gershun::report::{make_folder, write_file};
use glam::DVec3;

use crate::args_body::Body;
use crate::commands_run::{LateBar, folder, folder_name, light_scene, open, spoken};
use crate::{COMPLIES, complain, remark, say};

/// Runs the command.
pub fn run(arguments: &Body) -> u8 {
    let project = match open(&arguments.project, &arguments.run) {
        Ok(project) => project,
        Err(code) => return code,
    };
    let wanted = match wanted(&project, arguments) {
        Ok(wanted) => wanted,
        Err(message) => return complain(&message),
    };
    let lang = spoken(arguments.lang, &project.info.language);
    let folder = folder(arguments.out.as_deref(), &project.info.name).join("bodies");
    let mut lines = String::new();
    for asked in &wanted {
        let bar = LateBar::new(arguments.run.quiet, "blocks");
        let body =
            luminance_body(&project, asked, &|done| bar.show(done, asked.blocks as usize, &asked.name));
        bar.clear();
        if let Err(error) = write(&folder, lang, &body) {
            return complain(&error);
        }
        lines.push_str(&body_line(lang, &body));
        if let Some(note) = body_note(lang, &body) {
            remark(&format!("{}: {note}", body.name));
        }
    }
    if arguments.run.quiet {
        return COMPLIES;
    }
    let printed = say(&lines);
    remark(&format!("bodies: {}", folder.display()));
    printed
}

/// `NAME.csv` and `NAME.svg`.
fn write(folder: &Path, lang: Lang, body: &LuminanceBody) -> Result<(), String> {
    make_folder(folder).map_err(|error| error.to_string())?;
    let table = body_csv(body).map_err(|error| error.to_string())?;
    let name = folder_name(&body.name);
    for (extension, text) in [("csv", table), ("svg", body_svg(lang, body))] {
        let path = folder.join(format!("{}.{extension}", name.display()));
        write_file(&path, text.as_bytes()).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// The named point or viewpoints; all viewpoints where none is named.
fn wanted(project: &Project, arguments: &Body) -> Result<Vec<AskedBody>, String> {
    let asked = arguments.light_scene.as_ref().map(|name| light_scene(project, name)).transpose()?;
    let (step_deg, blocks) = (arguments.step, arguments.blocks);
    if let Some(at) = arguments.at {
        let point = DVec3::from_array(at);
        let inside = |world: usize, room: usize| project.worlds[world].rooms[room].contains(point);
        let rooms = |world: usize| (0..project.worlds[world].rooms.len()).map(move |room| [world, room]);
        let place = (0..project.worlds.len()).flat_map(rooms).find(|&[world, room]| inside(world, room));
        let place = place.ok_or_else(|| {
            format!("{at:?} lies in no room of the project\n  hint: coordinates are the project's, in metres")
        })?;
        let name = format!("{} {} {}", at[0], at[1], at[2]);
        return Ok(vec![AskedBody { name, place, point, light_scene: asked.unwrap_or(0), step_deg, blocks }]);
    }
    let all: Vec<AskedBody> = project
        .worlds
        .iter()
        .enumerate()
        .flat_map(|(world, contents)| contents.viewpoints.iter().map(move |viewpoint| (world, viewpoint)))
        .map(|(world, viewpoint)| AskedBody {
            name: viewpoint.name.clone(),
            place: [world, viewpoint.room],
            point: viewpoint.eye,
            light_scene: asked.or(viewpoint.light_scene).unwrap_or(0),
            step_deg,
            blocks,
        })
        .collect();
    if all.is_empty() {
        return Err("the project has no viewpoint\n  hint: name a point with --at x,y,z".to_owned());
    }
    for name in &arguments.viewpoint {
        if !all.iter().any(|body| body.name == *name) {
            let hint = suggestion(name, all.iter().map(|body| body.name.as_str()));
            return Err(format!("no viewpoint \"{name}\"\n  hint: {hint}"));
        }
    }
    let chosen =
        |body: &AskedBody| arguments.viewpoint.is_empty() || arguments.viewpoint.contains(&body.name);
    Ok(all.into_iter().filter(chosen).collect())
}
