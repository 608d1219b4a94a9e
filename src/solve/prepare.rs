//! Building the frozen field: direct light on patches, a sparse Monte Carlo transport operator of
//! *links* (for each patch side, where cosine-distributed rays end), and Gauss–Seidel sweeps on it.
//! Links do not depend on luminaires; every channel uses the same ones.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use rayon::prelude::*;

use super::Effort;
use super::beacons::{Aims, Beacons};
use super::covered::{Cavities, Cover, place};
use super::highlights::{self, Highlights};
use super::look::{Landing, Sight, add_direct, add_emission, look};
use super::refine::refine;
use crate::emitters::Emitters;
use crate::field::{LuminanceField, Patches, Reached};
use crate::rng::{Rng, Stratified};
use crate::sphere;

/// Default number of patches on large surfaces: patch area = lit surface area / this.
const PATCHES: f64 = 1500.0;
/// Samples of direct light per patch side.
const DIRECT_SAMPLES: u32 = 4;
/// One link in this many is doubled by a ray about the highlights that may be seen from its place.
const AIMED: u32 = 4;
/// One link in this many is joined by one to a bright patch, where a few of them make most of the light.
const MARKED: u32 = 2;
/// Sweeps end when the stored flux changes by less than this share …
const SETTLED: f64 = 1e-3;
/// … or after this many; the rest is left to the residual.
const MOST_SWEEPS: u32 = 100;
/// Every so many sweeps the field is scaled to balance: at a reflectance near 1 a sweep brings all
/// places nearer by a thousandth of what they still lack.
const BALANCED: u32 = 8;

/// Direct light of one patch side, and where its random numbers go on.
struct FirstLight {
    /// Luminance that luminaires and their images make here, per channel.
    direct: Vec<f64>,
    /// Whether any sample saw a luminaire.
    lit: bool,
    rng: Rng,
}

/// What one patch side receives.
struct Collected {
    /// The part of `first` that luminaires and their images make here.
    direct: Vec<f64>,
    /// Luminance that direct light and emitting surfaces make here, per channel.
    first: Vec<f64>,
    /// Patch sides where its links end.
    links: Vec<u32>,
    /// Share of each link that counts; empty if all count wholly.
    shares: Vec<f64>,
    /// Number of places from which the links start.
    places: u32,
    /// The part of it that light reaches.
    reached: Reached,
}

impl Collected {
    /// Where the links end, and the share of each that counts.
    fn ends(&self) -> impl Iterator<Item = (usize, f64)> {
        let share = |index: usize| self.shares.get(index).copied().unwrap_or(1.0);
        self.links.iter().enumerate().map(move |(index, &link)| (link as usize, share(index)))
    }
}

/// A field, and what pictures want to know of it.
pub(super) struct Parts {
    pub field: LuminanceField,
    /// The part of it that luminaires and their images make at first hand.
    pub direct: LuminanceField,
    /// Per patch side.
    pub reached: Vec<Reached>,
}

/// Builds the field from stream 0 of `seed`.
pub(super) fn field(
    emitters: &Emitters,
    highlights: &Highlights,
    effort: &Effort,
    seed: u64,
) -> LuminanceField {
    parts(emitters, highlights, effort, seed).field
}

/// [`field`] with its parts.
pub(super) fn parts(emitters: &Emitters, highlights: &Highlights, effort: &Effort, seed: u64) -> Parts {
    let scene = emitters.scene;
    let patch_m2 = effort.patch_m2.unwrap_or_else(|| scene.scattering_m2() / PATCHES).max(1e-12);
    let mut patches = Patches::of_scene(scene, patch_m2);
    if effort.adaptive {
        refine(emitters, &mut patches);
    }
    let channels = scene.channels.len();
    let (lights, lit): (Vec<FirstLight>, Vec<bool>) = (0..patches.sides())
        .into_par_iter()
        .map(|side| {
            let light = first_light(emitters, &patches, side, Rng::new(seed, 0, side as u64));
            let lit = light.lit;
            (light, lit)
        })
        .unzip();
    let cavities = Cavities::new(emitters, &patches, &lit, seed);
    let beacons = Beacons::new(scene, &patches, |side| lights[side].direct.iter().sum());
    let collected: Vec<Collected> = lights
        .into_par_iter()
        .enumerate()
        .map(|(side, light)| collect(&cavities, highlights, &beacons, effort, side, light))
        .collect();
    let mut field = LuminanceField::dark(patches, channels);
    let mut direct = field.clone();
    for (side, entry) in collected.iter().enumerate() {
        field.at_mut(side).copy_from_slice(&entry.first);
        direct.at_mut(side).copy_from_slice(&entry.direct);
    }
    sweep(emitters, &mut field, &collected);
    Parts { field, direct, reached: collected.into_iter().map(|entry| entry.reached).collect() }
}

fn first_light(emitters: &Emitters, patches: &Patches, side: usize, mut rng: Rng) -> FirstLight {
    let scene = emitters.scene;
    let mut direct = vec![0.0; scene.channels.len()];
    let (reflectance, transmittance) = scene.bsdf(patches.triangle(side)).diffuse();
    if !(reflectance + transmittance > 0.0) {
        return FirstLight { direct, lit: false, rng };
    }
    let mut scratch = Vec::new();
    let sequence = Stratified::new(&mut rng);
    for sample in 0..DIRECT_SAMPLES {
        let at = place(emitters, patches, side, sequence.point(sample, &mut rng));
        add_direct(emitters, &at, f64::INFINITY, &mut rng, &mut scratch, &mut direct);
    }
    for value in &mut direct {
        *value /= f64::from(DIRECT_SAMPLES);
    }
    let lit = direct.iter().any(|value| *value > 0.0);
    FirstLight { direct, lit, rng }
}

fn collect(
    cavities: &Cavities,
    highlights: &Highlights,
    beacons: &Beacons,
    effort: &Effort,
    side: usize,
    FirstLight { mut direct, mut rng, .. }: FirstLight,
) -> Collected {
    let (emitters, patches, rng) = (cavities.emitters, cavities.patches, &mut rng);
    let scene = emitters.scene;
    let channels = scene.channels.len();
    let (reflectance, transmittance) = scene.bsdf(patches.triangle(side)).diffuse();
    let total = reflectance + transmittance;
    let cover = cavities.covers[side];
    if !(total > 0.0) {
        let (first, reached) = (direct.clone(), Reached::Whole);
        return Collected { direct, first, links: Vec::new(), shares: Vec::new(), places: 0, reached };
    }
    let mut sight = Sight::new(channels);
    let (places, directions) = (Stratified::new(rng), Stratified::new(rng));
    let mut bundles = Vec::new();
    let mut links = Vec::with_capacity(effort.links as usize);
    let (mut shares, mut aims) = (Vec::new(), Aims::default());
    let mut met = vec![0.0; channels];
    let mut taken = Vec::new();
    for link in 0..effort.links {
        let at = place(emitters, patches, side, places.point(link, rng));
        if cover == Cover::Partial {
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
        let aimed = if link % AIMED == 0 && !bundles.is_empty() {
            Some(highlights::draw(&bundles, rng.uniforms()))
        } else {
            None
        };
        for (number, direction) in aimed.into_iter().chain([direction]).enumerate() {
            let cosine = facing.dot(direction).max(0.0) * FRAC_1_PI;
            let by_aim = highlights::density(&bundles, direction) / f64::from(AIMED);
            let share = if bundles.is_empty() { 1.0 } else { cosine / (cosine + by_aim) };
            if number == 0 && aimed.is_some() && !(share > 0.0) {
                continue;
            }
            look(emitters, origin, direction, 1.0, rng, &mut sight);
            for (sum, value) in met.iter_mut().zip(&sight.met) {
                *sum += share * value;
            }
        }
        // Density of the directions that reflection and transmission draw, times π.
        let scattered = |direction: DVec3| {
            let cos = at.normal.dot(direction);
            cos.abs() * if cos > 0.0 { reflectance } else { transmittance } / total
        };
        beacons.about(at.point, scattered, 1, &mut aims);
        let mut end = |sight: &Sight, share: f64| {
            // A link through a glossy surface ends on its diffuse part and once more where its lobe leads.
            for landing in &sight.landings {
                add_emission(scene, landing.triangle, &mut met, share * landing.weight);
                links.push(patches.side_at(landing.triangle, landing.barycentric, landing.front) as u32);
                if !beacons.is_empty() {
                    shares.push(share);
                }
            }
        };
        let share = |direction: DVec3, sight: &Sight| {
            let by_aim = beacons.density(patches, at.point, &aims, sight) / f64::from(MARKED);
            let drawn = scattered(direction) * FRAC_1_PI;
            if by_aim > 0.0 { drawn / (drawn + by_aim) } else { 1.0 }
        };
        end(&sight, share(direction, &sight));
        if link % MARKED == 0 && !aims.is_empty() {
            let (direction, target) = beacons.draw(emitters, patches, at.point, &aims, rng.uniforms());
            let origin = at.origin(scene, at.normal.dot(direction) > 0.0);
            look(emitters, origin, direction, 1.0, rng, &mut sight);
            if Beacons::came_to(patches, &sight, target) {
                end(&sight, share(direction, &sight));
            }
        }
    }
    let (places, reached) = match cover {
        Cover::Clear => (effort.links, Reached::Whole),
        Cover::Dark => (effort.links, Reached::Dark),
        Cover::Partial => {
            direct = direct_at(emitters, &taken, rng);
            let points: Vec<DVec3> = taken.iter().map(|at| at.point).collect();
            (taken.len() as u32, Reached::part(&points, effort.links))
        }
    };
    let mut first = direct.clone();
    for (value, met) in first.iter_mut().zip(&met) {
        *value += met * total / f64::from(places.max(1));
    }
    Collected { direct, first, links, shares, places, reached }
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

/// L(side) = first + (ρ + τ)/n Σ L(link), in place, in a fixed order.
fn sweep(emitters: &Emitters, field: &mut LuminanceField, collected: &[Collected]) {
    let scene = emitters.scene;
    let channels = scene.channels.len();
    let factor: Vec<f64> = (0..collected.len())
        .map(|side| {
            let (reflectance, transmittance) = scene.bsdf(field.patches().triangle(side)).diffuse();
            (reflectance + transmittance) / f64::from(collected[side].places.max(1))
        })
        .collect();
    let mut sums = vec![0.0; channels];
    for number in 1..=MOST_SWEEPS {
        if number.is_multiple_of(BALANCED) {
            balance(field, collected, &factor);
        }
        let (mut change, mut whole) = (0.0, 0.0);
        for (side, entry) in collected.iter().enumerate() {
            if entry.links.is_empty() {
                continue;
            }
            sums.fill(0.0);
            for (link, share) in entry.ends() {
                for (sum, value) in sums.iter_mut().zip(field.at(link)) {
                    *sum += share * value;
                }
            }
            let area = field.patches().area_m2(side) * entry.reached.share();
            let stored = field.at_mut(side);
            for ((stored, first), sum) in stored.iter_mut().zip(&entry.first).zip(&sums) {
                let next = first + factor[side] * sum;
                change += (next - *stored).abs() * area;
                whole += next * area;
                *stored = next;
            }
        }
        if change <= SETTLED * whole {
            break;
        }
    }
}

/// Scales each channel so that the flux fed in equals what the field loses,
/// Σ A first = Σ A (L − (ρ + τ)/n Σ L(link)); the truth is left as it is.
fn balance(field: &mut LuminanceField, collected: &[Collected], factor: &[f64]) {
    let channels = collected.first().map_or(0, |entry| entry.first.len());
    for channel in 0..channels {
        let (mut fed, mut lost) = (0.0, 0.0);
        for (side, entry) in collected.iter().enumerate() {
            let sum: f64 = entry.ends().map(|(link, share)| share * field.at(link)[channel]).sum();
            let area = field.patches().area_m2(side) * entry.reached.share();
            fed += area * entry.first[channel];
            lost += area * (field.at(side)[channel] - factor[side] * sum);
        }
        if lost > 0.0 && (fed / lost).is_finite() {
            (0..collected.len()).for_each(|side| field.at_mut(side)[channel] *= fed / lost);
        }
    }
}
