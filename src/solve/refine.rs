//! An adaptive mesh for the field: patches over which direct light varies more than is good for them are
//! split. A point source near a plane, or a hall of which a corner is lit, needs small patches in one
//! place; rooms that are lit evenly keep those they have. It decides noise, never a result.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;
use rayon::prelude::*;

use crate::emitters::{Emitters, Source};
use crate::field::{Patches, Place};

/// A patch is split if the flux that its constant luminance puts in the wrong place exceeds this share
/// of what a patch of the mesh reflects on the mean …
const TOLERANCE: f64 = 0.25;
/// … as long as there are no more than this many times the patches of the even mesh.
const MOST: usize = 3;
/// Places by which a patch that joins triangles is judged.
const SAMPLES: usize = 8;
/// Lamps whose squared distance from its middle is below this many times its area may make a spot on it; a
/// foot this much outside of a triangle, in units of the area, is still within.
const NEAR: f64 = 4.0;
const EDGE: f64 = 1e-9;

/// Splits the patches of an even mesh.
pub(super) fn refine(emitters: &Emitters, patches: &mut Patches) {
    let even = patches.len();
    let most = MOST * even;
    let mut open: Vec<usize> = (0..even).collect();
    let mut limit = None;
    while !open.is_empty() && patches.len() < most {
        let judged: Vec<(f64, f64)> =
            open.par_iter().map(|&patch| misplaced(emitters, patches, patch)).collect();
        let limit = *limit.get_or_insert_with(|| {
            let reflected: f64 = judged.iter().map(|(_, reflected)| reflected).sum();
            TOLERANCE * reflected / even as f64
        });
        let mut wanted: Vec<(f64, usize)> =
            judged.iter().zip(&open).map(|((wrong, _), &patch)| (*wrong, patch)).collect();
        wanted.retain(|(wrong, _)| *wrong > limit);
        // The worst first; equals in the order of their numbers.
        wanted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        wanted.truncate((most - patches.len()).div_ceil(3));
        let mesh = &emitters.scene.mesh;
        open = wanted.iter().filter_map(|&(_, patch)| patches.split(mesh, patch)).flatten().collect();
    }
}

/// Reflected flux of direct light, shadows apart, that a patch of constant luminance shows in the wrong
/// place, and all of it: Σ A_i |L_i − L̄| and Σ A_i L_i over its samples and both sides, up to a factor π.
fn misplaced(emitters: &Emitters, patches: &Patches, patch: usize) -> (f64, f64) {
    let scene = emitters.scene;
    let triangle = patches.triangle(2 * patch);
    let (reflectance, transmittance) = scene.bsdf(triangle).diffuse();
    if !(reflectance + transmittance > 0.0) {
        return (0.0, 0.0);
    }
    let lit: Vec<([f64; 2], f64)> = patches
        .samples(&scene.mesh, patch, SAMPLES)
        .into_iter()
        .map(|(place, share)| (lit_lx(emitters, triangle, place), share))
        .collect();
    let area_m2 = patches.area_m2(2 * patch);
    let spots = spots(emitters, patches, patch);
    let (mut wrong, mut all) = (0.0, 0.0);
    for facing in 0..2 {
        let luminance =
            |lx: &[f64; 2]| FRAC_1_PI * (reflectance * lx[facing] + transmittance * lx[1 - facing]);
        let mean: f64 = lit.iter().map(|(lx, share)| share * luminance(lx)).sum();
        for (lx, spot_m2) in &spots {
            let in_spot = luminance(lx) * spot_m2;
            wrong += in_spot * (1.0 - spot_m2 / area_m2);
            all += in_spot;
        }
        wrong += area_m2 * lit.iter().map(|(lx, share)| share * (luminance(lx) - mean).abs()).sum::<f64>();
        all += area_m2 * mean;
    }
    (wrong, all)
}

/// Spots smaller than the patch that lamps above it make where their perpendicular meets it: illuminance in
/// front and behind there, and the area π d² over which it falls off, m². Samples would miss them.
fn spots(emitters: &Emitters, patches: &Patches, patch: usize) -> Vec<([f64; 2], f64)> {
    let (triangle, area_m2) = (patches.triangle(2 * patch), patches.area_m2(2 * patch));
    let (middle, _) = patches.centre(2 * patch);
    let spot = |source: &Source| {
        let near = (source.position - middle).length_squared() < NEAR * area_m2;
        if !near || source.mirror.is_some() || !emitters.lights(source, triangle) {
            return None;
        }
        patches.outlines(patch).find_map(|[a, b, c]| {
            let normal = (b - a).cross(c - a).normalize();
            let height_m = (source.position - a).dot(normal);
            let spot_m2 = PI * (height_m * height_m).max(source.radius_m * source.radius_m);
            let foot = source.position - normal * height_m;
            let inside =
                |from: DVec3, to: DVec3| (to - from).cross(foot - from).dot(normal) >= -EDGE * area_m2;
            if !(spot_m2 < area_m2 && inside(a, b) && inside(b, c) && inside(c, a)) {
                return None;
            }
            let arrival = emitters.arrival_if(source, foot, [0.5; 2], |_| true)?;
            let lx = arrival.normal_lx * normal.dot(arrival.direction).abs();
            lx.is_finite().then_some((if height_m > 0.0 { [lx, 0.0] } else { [0.0, lx] }, spot_m2))
        })
    };
    emitters.sources.iter().filter_map(spot).collect()
}

/// Illuminance in front and behind from the centres of all openings, nothing standing between, lx.
fn lit_lx(emitters: &Emitters, triangle: u32, place: Place) -> [f64; 2] {
    let mut lit = [0.0; 2];
    for source in emitters.sources.iter().filter(|source| source.mirror.is_none()) {
        if !emitters.lights(source, triangle) {
            continue;
        }
        let Some(arrival) = emitters.arrival_if(source, place.point, [0.5; 2], |_| true) else { continue };
        let cos = place.normal.dot(arrival.direction);
        let lx = arrival.normal_lx * cos.abs();
        if lx.is_finite() {
            lit[usize::from(cos < 0.0)] += lx;
        }
    }
    lit
}
