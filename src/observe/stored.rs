//! The observers of a project from a field that was kept: look-ups in place of a new solution. What a field
//! errs by is not sampled again, so there is no interval; the list of approximations stands for it.

use rayon::prelude::*;

use super::map::from_luminaires;
use super::{Light, Observed, Sheets, of_viewpoint};
use crate::emitters::Sighted;
use crate::estimate::Estimate;
use crate::field::store::StoredField;
use crate::measure::glare_sources::Convention;
use crate::measure::view::EyeLight;
use crate::outcome::Interval;
use crate::project::{Project, World};
use crate::scene::Scene;
use crate::solve::{GlanceEffort, as_stored, glances, prepare_stored};

/// Rays of an eye: their own noise is below a tenth of what the field errs by.
const EFFORT: GlanceEffort = GlanceEffort { replicates: 4, rays: 1024, rough: 0.002, walks: 0 };

/// Why a kept field has no luminances of task and surround: it is looked up for the plane of the eye.
const NO_ZONES: &str =
    "luminances of task and surround are not computed from a kept field: leave `--field` out, or run `check`";

/// The same of the field of view.
const NO_FIELD: &str = "the mean luminance of the field of view is not computed from a kept field: leave `--field` out, or run `check`";

/// All viewpoints of a project in all directions under their own light scene, from one stored field for each
/// world.
pub fn observe_stored(project: &Project, fields: Vec<StoredField>, sheets: Sheets) -> Vec<Observed> {
    let worlds = project.worlds.iter().zip(fields);
    worlds.flat_map(|(world, field)| of_world(project, world, field, sheets)).collect()
}

fn of_world(project: &Project, world: &World, field: StoredField, sheets: Sheets) -> Vec<Observed> {
    let prepared = prepare_stored(&world.scene, field);
    let mended = as_stored(&prepared, EFFORT.replicates);
    let said = approximations(&world.scene);
    let one = |index: usize| -> Vec<Observed> {
        let viewpoint = &world.viewpoints[index];
        let light_scene = &project.light_scenes[viewpoint.light_scene.unwrap_or(0)];
        let weights = crate::measure::weights(world, light_scene, &world.rooms[viewpoint.room], false);
        let gazes = &viewpoint.directions;
        let looked = glances(&prepared, &mended, &[viewpoint.eye], gazes, &weights, &EFFORT);
        let light = |_: usize, number: usize, weights: &[f64], sighted: &Sighted| {
            let blocks: Vec<f64> = looked[0].chunks_exact(gazes.len()).map(|lx| lx[number]).collect();
            EyeLight {
                from_luminaires: from_luminaires(sighted, prepared.emitters(), gazes[number], weights),
                indirect: Estimate::from_blocks(&blocks),
            }
        };
        let zones = |_: usize, _: usize, _: &[f64]| Err(NO_ZONES);
        let field = |_: usize, _: usize, _: &[f64]| Err(NO_FIELD);
        let light = Light { at_eye: light, zones, field };
        let conventions = [Convention::default()];
        let mut found = of_viewpoint(project, world, index, &prepared, &conventions, sheets, &light);
        for view in &mut found {
            view.approximations.clone_from(&said);
            let estimates = view.indices.iter_mut().map(|index| &mut index.estimate);
            for estimate in std::iter::once(&mut view.ugr).chain(estimates).flatten() {
                *estimate = without_interval(*estimate);
            }
            if let Some(sheet) = &mut view.sheet {
                sheet.ugr.clone_from(&view.ugr);
                sheet.indices.clone_from(&view.indices);
            }
        }
        found
    };
    let each: Vec<Vec<Observed>> = (0..world.viewpoints.len()).into_par_iter().map(one).collect();
    each.into_iter().flatten().collect()
}

/// The value alone: the noise of look-ups says nothing of what the field errs by.
fn without_interval(estimate: Interval) -> Interval {
    Interval { se: f64::NAN, lo: f64::NAN, hi: f64::NAN, ..estimate }
}

/// What a field's look-ups approximate, one sentence each.
pub fn approximations(scene: &Scene) -> Vec<String> {
    let mut all = vec![
        "Indirect light is looked up in the stored field, one luminance for each patch: how it varies within a patch, what is hidden of one, and the noise of the field's random links are left. In the example scenes UGR is within 0.15 and L_b within 4 % of unbiased values.",
        "Nothing is sampled again: there is no interval.",
    ];
    if scene.has_lobes() {
        all.push("What glossy surfaces reflect in their lobe is sampled, and finds surfaces as the field has them.");
    }
    all.into_iter().map(str::to_owned).collect()
}
