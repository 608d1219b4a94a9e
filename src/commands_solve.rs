//! Runs `gershun solve`: the stored field of a project as a file.

use std::path::Path;

use gershun::field::store::{FILE, FieldFile, StoredField, to_bytes};
use gershun::project::{Project, World, read_field};
use gershun::report::{make_folder, write_file};
use gershun::scene::Scene;
use gershun::solve::picture::expose;

use crate::args_solve::Solve;
use crate::commands_run::{LateBar, folder, open};
use crate::{COMPLIES, complain, remark, say};

/// Runs the command.
pub fn run(arguments: &Solve) -> u8 {
    let project = match open(&arguments.project, &arguments.run) {
        Ok(project) => project,
        Err(code) => return code,
    };
    let bar = LateBar::new(arguments.run.quiet, "rooms");
    let mut fields: Vec<StoredField> = Vec::with_capacity(project.worlds.len());
    for world in &project.worlds {
        fields.push(expose(&world.scene, project.accuracy.seed).into_stored());
        bar.show(fields.len(), project.worlds.len(), &world_name(world));
    }
    bar.clear();
    let worlds: Vec<(String, &Scene, &StoredField)> = project
        .worlds
        .iter()
        .zip(&fields)
        .map(|(world, field)| (world_name(world), &world.scene, field))
        .collect();
    let out = folder(arguments.out.as_deref(), &project.info.name);
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
    if arguments.run.quiet {
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
