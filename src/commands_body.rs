//! Runs `gershun body`: points → luminance bodies → files.

use std::path::Path;
use std::time::Duration;

use gershun::observe::body::{AskedBody, LuminanceBody, luminance_body};
use gershun::project::{LoadOptions, Project, load, suggestion};
use gershun::report::Lang;
use gershun::report::body::{body_csv, body_line, body_note, body_svg};
use gershun::report::{make_folder, write_file};
use glam::DVec3;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args_body::Body;
use crate::{BAD_INPUT, COMPLIES, complain, complain_of_all, folder_name, remark, say, use_threads};

/// Runs the command.
pub fn run(arguments: &Body) -> u8 {
    if let Err(code) = use_threads(arguments.threads) {
        return code;
    }
    let options = LoadOptions { allow_outside: arguments.allow_outside, ..LoadOptions::default() };
    let mut project = match load(&arguments.project, &options) {
        Ok(project) => project,
        Err(diagnostics) => {
            complain_of_all(&diagnostics, &arguments.project);
            return BAD_INPUT;
        }
    };
    if let Some(seed) = arguments.seed {
        project.accuracy.seed = seed;
    }
    let wanted = match wanted(&project, arguments) {
        Ok(wanted) => wanted,
        Err(message) => return complain(&message),
    };
    let of_project = project.info.language.first().and_then(|code| Lang::parse(code));
    let lang = arguments.lang.or(of_project).unwrap_or(Lang::En);
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("out").join(folder_name(&project.info.name)));
    let folder = out.join("bodies");
    let mut lines = String::new();
    for asked in &wanted {
        let bar = bar(arguments);
        let body = luminance_body(&project, asked, &|done| show(&bar, done));
        bar.finish_and_clear();
        if let Err(error) = write(&folder, lang, &body) {
            return complain(&error);
        }
        lines.push_str(&body_line(lang, &body));
        if let Some(note) = body_note(lang, &body) {
            remark(&format!("{}: {note}", body.name));
        }
    }
    if arguments.quiet {
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
    let by_name = |name: &String| {
        let known = || project.light_scenes.iter().map(|scene| scene.name.as_str());
        let found = project.light_scenes.iter().position(|scene| scene.name == *name);
        found.ok_or_else(|| format!("no light scene \"{name}\"\n  hint: {}", suggestion(name, known())))
    };
    let asked = arguments.light_scene.as_ref().map(by_name).transpose()?;
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

/// A bar that appears once a body has taken a second.
fn bar(arguments: &Body) -> ProgressBar {
    let bar = ProgressBar::hidden();
    let style = ProgressStyle::with_template("{bar:24} {pos}/{len} blocks · {elapsed}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.set_length(if arguments.quiet { 0 } else { u64::from(arguments.blocks) });
    bar
}

fn show(bar: &ProgressBar, done: usize) {
    let wanted = bar.length() > Some(0) && std::io::IsTerminal::is_terminal(&std::io::stderr());
    if wanted && bar.is_hidden() && bar.elapsed() > Duration::from_secs(1) {
        bar.set_draw_target(ProgressDrawTarget::stderr());
    }
    bar.set_position(done as u64);
}
