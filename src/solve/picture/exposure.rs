//! The field that pictures are taken from. A trial solution shows where patches should be split and how many
//! links each needs; then it is solved anew.

use super::bends::{Plan, plan};
use super::{Detail, Picture, direct};
use crate::emitters::Emitters;
use crate::field::store::{Made, StoredField};
use crate::field::{Patches, Reached, Smooth};
use crate::material::Bsdf;
use crate::scene::Scene;
use crate::solve::Effort;
use crate::solve::highlights::Highlights;
use crate::solve::prepare::{self, Making, Purpose, parts};

/// Patches of the field on large surfaces before some are split, and most links of a side: more than a
/// sheet needs, for here the field is what is seen.
const PATCHES: f64 = 6000.0;
pub(super) const LINKS: u32 = 768;
/// Links of the trial solution by which patches are split, and its stream.
const TRIAL_LINKS: u32 = 48;
const TRIAL: u64 = u64::MAX - 6;

/// A field made for pictures, for every channel.
#[derive(Debug)]
pub struct Exposure<'s> {
    emitters: Emitters<'s>,
    stored: StoredField,
}

/// Builds the field for pictures of a scene.
pub fn expose(scene: &Scene, seed: u64) -> Exposure<'_> {
    let emitters = Emitters::new(scene);
    let patch_m2 = (scene.scattering_m2() / PATCHES).max(1e-12);
    let effort = Effort { patch_m2: Some(patch_m2), ..Effort::default() };
    let highlights = Highlights::new(&emitters);
    let patches = prepare::mesh(&emitters, &effort);
    let trial = Making {
        purpose: Purpose::Trial,
        links: TRIAL_LINKS,
        links_of: &[],
        seed,
        stream: TRIAL,
        covers: &[],
    };
    let trial = parts(&emitters, &highlights, patches, &trial);
    let Plan { patches, covers, links: links_of } = plan(scene, trial, TRIAL_LINKS);
    let purpose = Purpose::Shown;
    let shown = Making { purpose, links: LINKS, links_of: &links_of, seed, stream: 0, covers: &covers };
    let shown = parts(&emitters, &highlights, patches, &shown);
    let made = Made { seed, links: LINKS, patch_m2 };
    let stored = StoredField { made, field: shown.field, direct: shown.direct, reached: shown.reached };
    Exposure { emitters, stored }
}

/// A smooth function through values per unit of reflectance of all patch sides.
pub(super) fn smoothed(scene: &Scene, patches: &Patches, reached: &[Reached], values: &[f64]) -> Smooth {
    // Per unit of reflectance opaque surfaces differ by place only, opals by material too.
    let kind = |side: usize| {
        let triangle = patches.triangle(side);
        let (reflectance, transmittance) = scene.bsdf(triangle).diffuse();
        match scene.bsdf(triangle) {
            _ if !(reflectance + transmittance > 0.0) || reached[side].is_dark() => None,
            Bsdf::Opal { .. } => {
                let surface = scene.mesh.triangles[triangle as usize].surface;
                Some(1 + scene.mesh.surfaces[surface as usize].material as u32)
            }
            _ => Some(0),
        }
    };
    let part = |side: usize| reached[side].middle();
    Smooth::new(&scene.tracer, patches, values, kind, part)
}

/// Pictures of a scene from its field as it was stored.
pub fn from_store(scene: &Scene, stored: StoredField) -> Exposure<'_> {
    Exposure { emitters: Emitters::new(scene), stored }
}

impl Exposure<'_> {
    /// The field, to be stored.
    pub fn stored(&self) -> &StoredField {
        &self.stored
    }

    /// [`Exposure::stored`], kept.
    pub fn into_stored(self) -> StoredField {
        self.stored
    }

    /// The field with a factor for each channel, for pictures of this detail.
    pub fn picture(&self, weights: &[f64], detail: Detail) -> Picture<'_> {
        let scene = self.emitters.scene;
        let weighted = |values: &[f64]| values.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>();
        let patches = self.stored.field.patches();
        let stored: Vec<f64> =
            (0..patches.sides()).map(|side| weighted(self.stored.field.at(side))).collect();
        let albedo = |side: usize| {
            let (reflectance, transmittance) = scene.bsdf(patches.triangle(side)).diffuse();
            reflectance + transmittance
        };
        let per_albedo =
            |side: usize, value: f64| if albedo(side) > 0.0 { value / albedo(side) } else { 0.0 };
        let indirect = (detail == Detail::Exact).then(|| {
            let of_side =
                |side: usize| per_albedo(side, stored[side] - weighted(self.stored.direct.at(side)));
            let values: Vec<f64> = (0..patches.sides()).map(of_side).collect();
            smoothed(scene, patches, &self.stored.reached, &values)
        });
        let whole = indirect.as_ref().filter(|_| scene.has_lobes()).map(|indirect| {
            let values: Vec<f64> = (0..stored.len()).map(|side| per_albedo(side, stored[side])).collect();
            indirect.with(&values)
        });
        let shines = |index: &usize| {
            let source = &self.emitters.sources[*index];
            weights[source.channel] > 0.0 && !source.is_point()
        };
        Picture {
            detail,
            emitters: &self.emitters,
            field: &self.stored.field,
            weights: weights.to_vec(),
            lamps: direct::lamps(&self.emitters, weights),
            openings: (0..scene.luminaires.len()).filter(shines).collect(),
            stored,
            indirect,
            whole,
            seed: self.stored.made.seed,
        }
    }
}
