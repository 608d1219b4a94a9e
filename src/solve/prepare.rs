//! Building the frozen field: direct light on patches, a sparse Monte Carlo transport operator of
//! *links* (for each patch side, where cosine-distributed rays end), and Gauss–Seidel sweeps on it.
//! Links do not depend on luminaires; every channel uses the same ones.

use rayon::prelude::*;

use super::look::{Landing, add_direct, add_emission, follow};
use super::{Counts, Effort};
use crate::emitters::Emitters;
use crate::field::{LuminanceField, Patches};
use crate::rng::{Rng, Stratified};
use crate::sphere;

/// Default number of patches on large surfaces: patch area = lit surface area / this.
const PATCHES: f64 = 1500.0;
/// Samples of direct light per patch side.
const DIRECT_SAMPLES: u32 = 4;
/// Sweeps end when the stored flux changes by less than this share …
const SETTLED: f64 = 1e-3;
/// … or after this many: at a reflectance near 1 the rest is left to the residual.
const MOST_SWEEPS: u32 = 100;
const NOWHERE: u32 = u32::MAX;

/// What one patch side receives.
struct Collected {
    /// The part of `first` that luminaires and their images make here.
    direct: Vec<f64>,
    /// Luminance that direct light and emitting surfaces make here, per channel.
    first: Vec<f64>,
    /// Where its links end: patch sides, or `NOWHERE`.
    links: Vec<u32>,
}

/// Builds the field from stream 0 of `seed`.
pub(super) fn field(emitters: &Emitters, effort: &Effort, seed: u64) -> LuminanceField {
    parts(emitters, effort, seed).0
}

/// The field, and the part of it that luminaires and their images make at first hand.
pub(super) fn parts(emitters: &Emitters, effort: &Effort, seed: u64) -> (LuminanceField, LuminanceField) {
    let scene = emitters.scene;
    let diffuse = |triangle: usize| scene.bsdf(triangle as u32).specular(1.0).is_none();
    let area_m2: f64 = (0..scene.mesh.triangles.len())
        .filter(|&t| diffuse(t))
        .map(|t| scene.mesh.normal_and_area(t).1)
        .sum();
    let patch_m2 = effort.patch_m2.unwrap_or(area_m2 / PATCHES).max(1e-12);
    let patches = Patches::new(&scene.mesh, patch_m2, diffuse);
    let channels = scene.channels.len();
    let collected: Vec<Collected> = (0..patches.sides())
        .into_par_iter()
        .map(|side| collect(emitters, &patches, effort, side, &mut Rng::new(seed, 0, side as u64)))
        .collect();
    let mut field = LuminanceField::dark(patches, channels);
    let mut direct = field.clone();
    for (side, entry) in collected.iter().enumerate() {
        field.at_mut(side).copy_from_slice(&entry.first);
        direct.at_mut(side).copy_from_slice(&entry.direct);
    }
    sweep(emitters, &mut field, &collected);
    (field, direct)
}

fn collect(emitters: &Emitters, patches: &Patches, effort: &Effort, side: usize, rng: &mut Rng) -> Collected {
    let scene = emitters.scene;
    let channels = scene.channels.len();
    let triangle = patches.triangle(side);
    let (reflectance, transmittance) = scene.bsdf(triangle).diffuse();
    let mut first = vec![0.0; channels];
    let mut scratch = Vec::new();
    let mut counts = Counts::default();
    let total = reflectance + transmittance;
    if !(total > 0.0) {
        return Collected { direct: first.clone(), first, links: Vec::new() };
    }
    let landing = |u: [f64; 3]| {
        let place = patches.place(&scene.mesh, side, u);
        let front = side.is_multiple_of(2);
        let normal = if front { place.normal } else { -place.normal };
        Landing { point: place.point, normal, triangle, barycentric: [0.0; 2], front }
    };
    let sequence = Stratified::new(rng);
    for sample in 0..DIRECT_SAMPLES {
        let at = landing(sequence.point(sample, rng));
        add_direct(emitters, &at, f64::INFINITY, rng, &mut scratch, &mut first);
    }
    for value in &mut first {
        *value /= f64::from(DIRECT_SAMPLES);
    }
    let direct = first.clone();
    let (places, directions) = (Stratified::new(rng), Stratified::new(rng));
    let mut links = Vec::with_capacity(effort.links as usize);
    let mut met = vec![0.0; channels];
    for link in 0..effort.links {
        let at = landing(places.point(link, rng));
        let [choice, u, v] = directions.point(link, rng);
        // An opal gathers from both sides in the ratio of reflectance to transmittance.
        let same_side = choice * total < reflectance;
        let facing = if same_side { at.normal } else { -at.normal };
        let direction = sphere::frame(facing) * sphere::cosine_hemisphere([u, v]);
        let landed = follow(emitters, at.origin(scene, same_side), direction, rng, &mut counts, &mut met);
        links.push(landed.map_or(NOWHERE, |l| {
            add_emission(scene, l.triangle, &mut met, 1.0);
            patches.side_at(l.triangle, l.barycentric, l.front) as u32
        }));
    }
    for (value, met) in first.iter_mut().zip(&met) {
        *value += met * total / f64::from(effort.links.max(1));
    }
    Collected { direct, first, links }
}

/// L(side) = first + (ρ + τ)/n Σ L(link), in place, in a fixed order.
fn sweep(emitters: &Emitters, field: &mut LuminanceField, collected: &[Collected]) {
    let scene = emitters.scene;
    let channels = scene.channels.len();
    let factor: Vec<f64> = collected
        .iter()
        .enumerate()
        .map(|(side, entry)| {
            let (reflectance, transmittance) = scene.bsdf(field.patches().triangle(side)).diffuse();
            (reflectance + transmittance) / entry.links.len().max(1) as f64
        })
        .collect();
    let mut sums = vec![0.0; channels];
    for _ in 0..MOST_SWEEPS {
        let (mut change, mut whole) = (0.0, 0.0);
        for (side, entry) in collected.iter().enumerate() {
            if entry.links.is_empty() {
                continue;
            }
            sums.fill(0.0);
            for &link in entry.links.iter().filter(|&&link| link != NOWHERE) {
                for (sum, value) in sums.iter_mut().zip(field.at(link as usize)) {
                    *sum += value;
                }
            }
            let area = field.patches().area_m2(side);
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
