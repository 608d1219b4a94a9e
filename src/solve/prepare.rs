//! Building the frozen field: direct light on patches, a sparse Monte Carlo transport operator of
//! *links* (for each patch side, where cosine-distributed rays end), and Gauss–Seidel sweeps on it.
//! Links do not depend on luminaires; every channel uses the same ones.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use rayon::prelude::*;

use super::Effort;
use super::aims::{AIMED, Aims};
use super::beacons::{Evenness, shining};
use super::covered::{Cavities, Cover, place, sees_glow};
use super::gaps::Gaps;
use super::highlights::{self, Highlights};
use super::look::{Landing, Sight, Way, add_direct, add_emission, look};
use super::refine::refine;
use super::sweep::{Collected, sweep, variances};
use crate::emitters::Emitters;
use crate::field::{LuminanceField, Patches, Reached};
use crate::rng::{Rng, Stratified};
use crate::sphere;

/// Default number of patches on large surfaces: patch area = lit surface area / this.
const PATCHES: f64 = 1500.0;
/// Samples of direct light per patch side.
const DIRECT_SAMPLES: u32 = 4;
/// … and beside an opening, of which a part may lie behind the patch's plane.
const NEAR_SAMPLES: u32 = 32;
/// A patch lies beside an opening up to so many of its radii.
const NEAR: f64 = 3.0;
/// One link in this many is doubled by a ray about the highlights that may be seen from its place.
const GLINTS: u32 = 4;
/// Dark sides of what is shown have one in this many links.
const SPARED: u32 = 32;
/// Places that are tried on partly covered sides of what is shown.
const SPOTS: u32 = 32;

/// Direct light of one patch side, and where its random numbers go on.
struct FirstLight {
    /// Luminance that luminaires and their images make here, per channel.
    direct: Vec<f64>,
    /// Whether any sample saw a luminaire.
    lit: bool,
    rng: Rng,
}

/// A field, and what pictures want to know of it.
pub(super) struct Parts {
    pub field: LuminanceField,
    /// The part of it that luminaires and their images make at first hand.
    pub direct: LuminanceField,
    /// Per patch side.
    pub reached: Vec<Reached>,
    /// How much of it is covered, per patch side.
    pub covers: Vec<Cover>,
    /// Where something lies right before a patch.
    pub gaps: Gaps,
    /// Of the sum over channels, from the scatter of links, per patch side; for a trial only.
    pub variances: Vec<f64>,
}

/// Builds the field from stream 0 of `seed`; with it the gaps in which it counts as dark.
pub(super) fn field(
    emitters: &Emitters,
    highlights: &Highlights,
    effort: &Effort,
    seed: u64,
) -> (LuminanceField, Gaps) {
    let patches = mesh(emitters, effort);
    let making = Making {
        purpose: Purpose::Control,
        links: effort.links,
        links_of: &[],
        seed,
        stream: 0,
        covers: &[],
    };
    let Parts { field, gaps, .. } = parts(emitters, highlights, patches, &making);
    (field, gaps)
}

/// What a field is built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To take noise from answers that are right whatever it holds.
    Control,
    /// To find where patches should be split, with the variances of what it holds.
    Trial,
    /// To be shown.
    Shown,
}

impl Purpose {
    /// What is shown has links that are aimed at bright places in every scene, spares those of dark sides,
    /// and tries fewer places of partly covered ones.
    fn is_seen(self) -> bool {
        match self {
            Self::Control => false,
            Self::Trial | Self::Shown => true,
        }
    }
}

/// How a field is built.
#[derive(Clone, Copy, Debug)]
pub(super) struct Making<'a> {
    pub purpose: Purpose,
    /// Links of a patch side …
    pub links: u32,
    /// … if it is not told otherwise here.
    pub links_of: &'a [u32],
    pub seed: u64,
    pub stream: u64,
    /// Covers of patch sides that are known before; what is missing is probed.
    pub covers: &'a [Option<Cover>],
}

/// The mesh on which a field is built: even, or split where direct light varies.
pub(super) fn mesh(emitters: &Emitters, effort: &Effort) -> Patches {
    let scene = emitters.scene;
    let patch_m2 = effort.patch_m2.unwrap_or_else(|| scene.scattering_m2() / PATCHES).max(1e-12);
    let mut patches = Patches::of_scene(scene, patch_m2);
    if effort.adaptive {
        refine(emitters, &mut patches);
    }
    patches
}

/// [`field`] with its parts, on patches that are given.
pub(super) fn parts(
    emitters: &Emitters,
    highlights: &Highlights,
    patches: Patches,
    making: &Making,
) -> Parts {
    let scene = emitters.scene;
    let Making { purpose, seed, stream, .. } = *making;
    let channels = scene.channels.len();
    let emitted = shining(scene, &patches);
    let glow = Aims::new(&patches, |side| emitted[side]);
    let (lights, lit): (Vec<FirstLight>, Vec<bool>) = (0..patches.sides())
        .into_par_iter()
        .map(|side| {
            let rng = Rng::new(seed, stream, side as u64);
            let light = match making.covers.get(side) {
                Some(Some(Cover::Dark)) => FirstLight { direct: vec![0.0; channels], lit: false, rng },
                _ => first_light(emitters, &patches, glow.as_ref(), side, rng),
            };
            let lit = light.lit;
            (light, lit)
        })
        .unzip();
    let sent = |side: usize| lights[side].direct.iter().sum::<f64>() + emitted[side];
    // Links of answers' fields are aimed where few patches make most of the light, or where any shines of itself.
    let aimed = purpose.is_seen() || glow.is_some() || Evenness::of(&patches, sent).is_uneven;
    let aims = if aimed { Aims::new(&patches, sent) } else { None };
    let gaps = Gaps::new(scene, &patches, [seed, stream]);
    let mut cavities = Cavities {
        emitters,
        patches: &patches,
        glow: glow.as_ref(),
        gaps: &gaps,
        lit: &lit,
        covers: Vec::new(),
    };
    cavities.probe(making.covers, [seed, stream]);
    let links = Links { cavities: &cavities, highlights, aims: aims.as_ref(), making };
    let collected: Vec<Collected> =
        lights.into_par_iter().enumerate().map(|(side, light)| collect(&links, side, light)).collect();
    let covers = cavities.covers;
    let mut field = LuminanceField::dark(patches, channels);
    let mut direct = field.clone();
    for (side, entry) in collected.iter().enumerate() {
        field.at_mut(side).copy_from_slice(&entry.first);
        direct.at_mut(side).copy_from_slice(&entry.direct);
    }
    sweep(emitters, &mut field, &collected);
    let variances = match purpose {
        Purpose::Trial => variances(emitters, &field, &collected),
        Purpose::Control | Purpose::Shown => Vec::new(),
    };
    let reached = collected.into_iter().map(|entry| entry.reached).collect();
    Parts { field, direct, reached, covers, gaps, variances }
}

fn first_light(
    emitters: &Emitters,
    patches: &Patches,
    glow: Option<&Aims>,
    side: usize,
    mut rng: Rng,
) -> FirstLight {
    let scene = emitters.scene;
    let mut direct = vec![0.0; scene.channels.len()];
    let (reflectance, transmittance) = scene.bsdf(patches.triangle(side)).diffuse();
    if !(reflectance + transmittance > 0.0) {
        return FirstLight { direct, lit: false, rng };
    }
    let mut scratch = Vec::new();
    let sequence = Stratified::new(&mut rng);
    let (middle, _) = patches.centre(side);
    let extent_m = patches.area_m2(side).sqrt();
    let beside = emitters.sources.iter().any(|source| {
        !source.is_point() && source.position.distance(middle) < NEAR * source.radius_m + extent_m
    });
    let samples = if beside { NEAR_SAMPLES } else { DIRECT_SAMPLES };
    for sample in 0..samples {
        let at = place(patches, side, sequence.point(sample, &mut rng));
        add_direct(emitters, &at, f64::INFINITY, &mut rng, &mut scratch, &mut direct);
    }
    for value in &mut direct {
        *value /= f64::from(samples);
    }
    let shone_on = |glow: &Aims, rng: &mut Rng| {
        (0..DIRECT_SAMPLES).any(|sample| {
            let at = place(patches, side, sequence.point(sample, rng));
            sees_glow(glow, emitters, patches, &at, rng)
        })
    };
    let lit = direct.iter().any(|value| *value > 0.0) || glow.is_some_and(|glow| shone_on(glow, &mut rng));
    FirstLight { direct, lit, rng }
}

/// What links of all patch sides have in common.
struct Links<'a> {
    cavities: &'a Cavities<'a>,
    highlights: &'a Highlights,
    aims: Option<&'a Aims>,
    making: &'a Making<'a>,
}

impl Links<'_> {
    /// Number of links of a side. What nothing shows needs none but for those who think otherwise.
    fn count(&self, side: usize) -> u32 {
        let making = self.making;
        let wanted = making.links_of.get(side).copied().unwrap_or(making.links);
        let is_spared = making.purpose.is_seen() && self.cavities.covers[side] == Cover::Dark;
        if is_spared { wanted / SPARED } else { wanted }
    }

    /// Places of a partly covered side that light reaches, out of [`SPOTS`].
    fn spots(&self, side: usize, places: Stratified, rng: &mut Rng, sight: &mut Sight) -> Vec<Landing> {
        let patches = self.cavities.patches;
        let tried = (0..SPOTS).map(|spot| place(patches, side, places.point(spot, rng)));
        let tried: Vec<Landing> = tried.collect();
        tried.into_iter().filter(|at| self.cavities.is_reached(at, side, rng, sight)).collect()
    }
}

fn collect(common: &Links, side: usize, FirstLight { mut direct, mut rng, .. }: FirstLight) -> Collected {
    let Links { cavities, highlights, aims, making } = *common;
    let (emitters, patches, rng) = (cavities.emitters, cavities.patches, &mut rng);
    let scene = emitters.scene;
    let channels = scene.channels.len();
    let (reflectance, transmittance) = scene.bsdf(patches.triangle(side)).diffuse();
    let total = reflectance + transmittance;
    let cover = cavities.covers[side];
    if !(total > 0.0) {
        let first = direct.clone();
        return Collected { direct, first, ..Collected::without_links(Reached::Whole) };
    }
    let mut sight = Sight::new(channels);
    let (places, directions) = (Stratified::new(rng), Stratified::new(rng));
    let mut bundles = Vec::new();
    let count = common.count(side);
    let mut links = Vec::with_capacity(count as usize);
    let mut shares = Vec::new();
    let mut met_squares = 0.0;
    let partial = making.purpose.is_seen() && cover == Cover::Partial;
    let spots = if partial { common.spots(side, places, rng, &mut sight) } else { Vec::new() };
    if partial && spots.is_empty() {
        let first = direct.clone();
        return Collected { direct, first, ..Collected::without_links(Reached::Dark) };
    }
    let aimed_places = aims.map(|aims| (aims, Stratified::new(rng)));
    let mut met = vec![0.0; channels];
    let mut taken = Vec::new();
    for link in 0..count {
        let again = spots.get(link as usize % spots.len().max(1)).copied();
        let at = again.unwrap_or_else(|| place(patches, side, places.point(link, rng)));
        if cover == Cover::Partial && again.is_none() {
            if !cavities.is_reached(&at, side, rng, &mut sight) {
                continue;
            }
            taken.push(at);
        }
        let [choice, u, v] = directions.point(link, rng);
        // An opal gathers from both sides in the ratio of reflectance to transmittance.
        let same_side = choice * total < reflectance;
        let facing = if same_side { at.normal } else { -at.normal };
        let direction = sphere::frame(facing) * sphere::cosine_hemisphere([u, v]);
        // What lobes reflect of luminaires is looked for about their highlights too.
        let origin = at.origin(scene, same_side);
        highlights.about(emitters, origin, |direction| facing.dot(direction), &mut bundles);
        let is_aimed = link % GLINTS == 0 && !bundles.is_empty();
        let aimed = is_aimed.then(|| highlights::draw(&bundles, rng.uniforms()));
        for (number, direction) in aimed.into_iter().chain([direction]).enumerate() {
            let cosine = facing.dot(direction).max(0.0) * FRAC_1_PI;
            let by_aim = highlights::density(&bundles, direction) / f64::from(GLINTS);
            let share = if bundles.is_empty() { 1.0 } else { cosine / (cosine + by_aim) };
            if number == 0 && aimed.is_some() && !(share > 0.0) {
                continue;
            }
            look(emitters, origin, direction, 1.0, rng, &mut sight);
            for (sum, value) in met.iter_mut().zip(&sight.met) {
                *sum += share * value;
            }
            met_squares += (share * sight.met.iter().sum::<f64>()).powi(2);
        }
        // A link through a glossy surface ends on its diffuse part and once more where its lobe leads.
        for (number, landing) in sight.landings.iter().enumerate() {
            let end = patches.side_at(landing.triangle, landing.barycentric, landing.front);
            let mut share = 1.0;
            if let (Some(aims), 0, true) = (aims, number, landing.way == Way::Clear) {
                let albedo = if same_side { reflectance } else { transmittance };
                let cosine = albedo / total * facing.dot(direction).max(0.0) * FRAC_1_PI;
                let cos_there = landing.normal.dot(landing.to_eye);
                share = aims.share(end, origin.distance(landing.point), cos_there, cosine);
            }
            add_emission(scene, landing.triangle, &mut met, share * landing.weight);
            if cavities.gaps.hold(scene, landing, end) {
                continue;
            }
            links.push(end as u32);
            if aims.is_some() {
                shares.push(share);
            }
        }
        if let (Some((aims, points)), true) = (&aimed_places, link % AIMED == 0)
            && let Some(aim) = aims.link(emitters, patches, &at, points.point(link / AIMED, rng))
        {
            add_emission(scene, aim.triangle, &mut met, aim.share);
            links.push(aim.side as u32);
            shares.push(aim.share);
        }
    }
    let (places, reached) = match cover {
        Cover::Clear => (count, Reached::Whole),
        Cover::Dark => (count, Reached::Dark),
        Cover::Partial => {
            let (lit, tried, places) =
                if partial { (&spots, SPOTS, count) } else { (&taken, count, taken.len() as u32) };
            direct = direct_at(emitters, lit, rng);
            let points: Vec<DVec3> = lit.iter().map(|at| at.point).collect();
            (places, Reached::part(&points, tried))
        }
    };
    let mut first = direct.clone();
    for (value, met) in first.iter_mut().zip(&met) {
        *value += met * total / f64::from(places.max(1));
    }
    Collected { direct, first, links, shares, met_squares, places, reached }
}

/// Mean luminance that direct light makes at some of the places.
fn direct_at(emitters: &Emitters, places: &[Landing], rng: &mut Rng) -> Vec<f64> {
    let mut direct = vec![0.0; emitters.scene.channels.len()];
    let count = places.len().min(DIRECT_SAMPLES as usize);
    let mut scratch = Vec::new();
    for number in 0..count {
        let at = &places[number * places.len() / count];
        add_direct(emitters, at, f64::INFINITY, rng, &mut scratch, &mut direct);
    }
    for value in &mut direct {
        *value /= count.max(1) as f64;
    }
    direct
}
