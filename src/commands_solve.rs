//! Runs `gershun solve`: the stored field of a project as a file.

use std::path::Path;
use std::time::Duration;

use gershun::field::store::{FILE, FieldFile, StoredField, to_bytes};
use gershun::project::{LoadOptions, Project, World, load, read_field};
use gershun::report::{make_folder, write_file};
use gershun::scene::Scene;
use gershun::solve::picture::expose;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args_solve::Solve;
use crate::{BAD_INPUT, COMPLIES, complain, complain_of_all, folder_name, remark, say, use_threads};

/// Runs the command.
pub fn run(arguments: &Solve) -> u8 {
    if let Err(code) = use_threads(arguments.threads) {
        return code;
    }
    let options = LoadOptions { allow_outside: arguments.allow_outside, ..LoadOptions::default() };
    let project = match load(&arguments.project, &options) {
        Ok(project) => project,
        Err(diagnostics) => {
            complain_of_all(&diagnostics, &arguments.project);
            return BAD_INPUT;
        }
    };
    let seed = arguments.seed.unwrap_or(project.accuracy.seed);
    let bar = bar(arguments.quiet, project.worlds.len());
    let mut fields: Vec<StoredField> = Vec::with_capacity(project.worlds.len());
    for world in &project.worlds {
        fields.push(expose(&world.scene, seed).into_stored());
        show(&bar, fields.len());
    }
    bar.finish_and_clear();
    let worlds: Vec<(String, &Scene, &StoredField)> = project
        .worlds
        .iter()
        .zip(&fields)
        .map(|(world, field)| (world_name(world), &world.scene, field))
        .collect();
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("out").join(folder_name(&project.info.name)));
    let path = out.join(FILE);
    let written = to_bytes(&worlds).map_err(|error| error.to_string()).and_then(|bytes| {
        make_folder(&out).map_err(|error| error.to_string())?;
        write_file(&path, &bytes).map_err(|error| error.to_string())?;
        Ok(bytes.len())
    });
    let length = match written {
        Ok(length) => length,
        Err(error) => return complain(&error),
    };
    if arguments.quiet {
        return COMPLIES;
    }
    let lines: Vec<String> = worlds.iter().map(|(name, scene, field)| line(name, scene, field)).collect();
    let printed = say(&lines.concat());
    remark(&format!("field: {} ({:.1} MB)", path.display(), length as f64 * 1e-6));
    printed
}

/// One line per world for the terminal.
fn line(name: &str, scene: &Scene, stored: &StoredField) -> String {
    let (patches, channels) = (stored.field.patches().len(), scene.channels.len());
    let plural = if channels == 1 { "" } else { "s" };
    format!("{name} · {patches} patches · {channels} channel{plural} · {} links a side\n", stored.made.links)
}

/// The rooms of a world.
fn world_name(world: &World) -> String {
    let rooms: Vec<&str> = world.rooms.iter().map(|room| room.name.as_str()).collect();
    rooms.join(", ")
}

/// The stored fields of a project from a file, or from `field.safetensors` in a folder.
pub fn stored(path: &Path, project: &Project) -> Result<Vec<StoredField>, String> {
    let path = if path.is_dir() { path.join(FILE) } else { path.to_owned() };
    let bytes = read_field(&path).map_err(|error| error.to_string())?;
    let scenes: Vec<(String, &Scene)> =
        project.worlds.iter().map(|world| (world_name(world), &world.scene)).collect();
    let fields = FieldFile::parse(&bytes).and_then(|file| file.fields(&scenes));
    fields.map_err(|error| format!("{}: {error}", path.display()))
}

/// A bar that appears once a run has taken a second.
fn bar(quiet: bool, worlds: usize) -> ProgressBar {
    let bar = ProgressBar::hidden();
    let style = ProgressStyle::with_template("{bar:24} {pos}/{len} rooms · {msg}{elapsed}");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.set_length(if quiet { 0 } else { worlds as u64 });
    bar
}

fn show(bar: &ProgressBar, done: usize) {
    let wanted = bar.length() > Some(0) && std::io::IsTerminal::is_terminal(&std::io::stderr());
    if wanted && bar.is_hidden() && bar.elapsed() > Duration::from_secs(1) {
        bar.set_draw_target(ProgressDrawTarget::stderr());
    }
    bar.set_position(done as u64);
}
