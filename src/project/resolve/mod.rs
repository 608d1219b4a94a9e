//! Schema → worlds. The order matters to users: rooms first, then what lies in them, so that every
//! later mistake can name the room. Nothing is built before the whole file was looked at.

mod area_surface;
mod areas;
mod bodies;
mod cad;
mod cameras;
mod draft;
mod eyes;
mod furniture;
mod given;
mod glare_maps;
mod lights;
mod lists;
mod luminaires;
mod materials;
mod places;
mod required;
mod rooms;
mod settings;
mod shell;
mod viewpoint_list;
mod viewpoints;
mod walled;
mod zones;

use super::context::Context;
use super::schema::File;
use super::{Project, World};
use crate::scene::{Scene, SceneError};
use draft::Draft;
use materials::Palette;

/// Resolves a file; mistakes go into the context, and `None` means there are some.
pub fn resolve(file: &File, context: &mut Context) -> Option<Project> {
    let info = settings::info(&file.project, context);
    let mut palette = Palette::new(file, context);
    let mut drafts = rooms::drafts(file, &info.name, &mut palette, context);
    let footprints = file.rooms.iter().filter(|room| room.get_ref().footprint.is_some());
    let expected = usize::from(file.scene.is_some()) + footprints.count();
    let rooms_complete = !file.rooms_lost && drafts.len() == expected;
    if !rooms_complete {
        // Where a room is missing, "outside of every room" and the like would be false alarms.
        drafts.clear();
    }
    let norm = settings::norm(file, context);
    settings::check_rows(file, norm.as_ref(), context);
    settings::check_modified(file, norm.as_ref(), context);
    furniture::add(&file.furniture, &mut drafts, &mut palette, context);
    if rooms_complete {
        palette.report_unused(context);
    }
    let kinds = luminaires::kinds(file, context);
    places::add(file, kinds, &mut drafts, context);
    lights::add(file.scene.as_ref(), &mut drafts, context);
    let light_scenes = settings::light_scenes(file, &drafts, context);
    areas::add(file, &mut drafts, &light_scenes, norm.as_ref(), context);
    viewpoints::add(file, &mut drafts, &light_scenes, context);
    glare_maps::add(file, &mut drafts, &light_scenes, context);
    required::requirements(file, &mut drafts, &light_scenes, context);
    let declared = settings::declared(file, &drafts, context);
    let accuracy = settings::accuracy(file, context);
    cameras::add(file, &mut drafts, context);
    if !file.glare_maps.is_empty() {
        context.note("glare maps are computed by `gershun glare`, not by check");
    }
    if !context.diagnostics.is_empty() {
        return None;
    }
    for draft in &drafts {
        if draft.luminaires.is_empty() && !draft.emits() {
            context.note(format!("nothing emits light in {}", draft.label));
        }
    }
    let worlds: Vec<Option<World>> =
        drafts.into_iter().map(|draft| world(draft, &palette, context)).collect();
    Some(Project {
        info,
        worlds: worlds.into_iter().collect::<Option<_>>()?,
        light_scenes,
        norm,
        declared,
        accuracy,
        biases: std::mem::take(&mut context.biases),
        warnings: std::mem::take(&mut context.warnings),
        inputs: std::mem::take(&mut context.inputs),
    })
}

fn world(draft: Draft, palette: &Palette, context: &mut Context) -> Option<World> {
    match Scene::new_with(draft.mesh, draft.materials, draft.luminaires, context.simd) {
        Ok(scene) => {
            bodies::check(&scene, context);
            eyes::check(&scene, &draft.rooms, &draft.viewpoints, context);
            Some(World {
                scene,
                rooms: draft.rooms,
                areas: draft.areas,
                viewpoints: draft.viewpoints,
                glare_maps: draft.glare_maps,
                cameras: draft.cameras,
                requirements: draft.requirements,
            })
        }
        Err(error) => {
            let span = match &error {
                SceneError::NoAbsorption(name) => palette.span(name),
                SceneError::NoTriangles | SceneError::NotFinite { .. } | SceneError::TooLarge(_) => None,
            };
            context.error(&span.unwrap_or(draft.span), error.to_string(), "");
            None
        }
    }
}
