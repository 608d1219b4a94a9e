//! Where indirect light bends more within a patch than a smooth function through its neighbours can follow,
//! patches are split before the field for pictures is solved: near a bright spot, in corners, behind legs.
//! What a trial solution with few links has in noise does not count as a bend.

use rayon::prelude::*;

use super::exposure::{LINKS, smoothed};
use crate::field::Patches;
use crate::scene::Scene;
use crate::solve::covered::Cover;
use crate::solve::prepare::Parts;

/// Largest part of a side's light by which its neighbours may miss it. That is a prediction over more than an
/// edge; pictures interpolate over less, and err by about a quarter of it.
const TOLERANCE: f64 = 0.07;
/// A difference counts from this many of its standard errors on.
const CERTAIN: f64 = 2.5;
/// Light below this share of the scene's mean is measured by this share instead.
const FAINT: f64 = 0.05;
/// Largest number of patches, in those before.
const MOST: usize = 2;
/// A side gets as many links as leave this share of its light as noise, but no fewer than [`FEWEST`] and no
/// more than [`LINKS`].
const NOISE: f64 = 0.03;
const FEWEST: u32 = 192;

/// What a trial tells about how to solve a field that is to be seen.
pub(super) struct Plan {
    pub patches: Patches,
    /// Covers of patch sides that were not split.
    pub covers: Vec<Option<Cover>>,
    /// Links of every patch side.
    pub links: Vec<u32>,
}

/// Splits patches by the solution of a trial of so many links on them.
pub(super) fn plan(scene: &Scene, trial: Parts, trial_links: u32) -> Plan {
    let Parts { field, direct, reached, covers, variances, .. } = trial;
    let mut patches = field.patches().clone();
    let sum = |values: &[f64]| values.iter().sum::<f64>();
    let albedo = |side: usize| {
        let (reflectance, transmittance) = scene.bsdf(patches.triangle(side)).diffuse();
        reflectance + transmittance
    };
    let sides = 0..patches.sides();
    // Per unit of reflectance, as pictures show it.
    let (mut light, mut noise) = (vec![0.0; patches.sides()], vec![0.0; patches.sides()]);
    let (mut flux, mut lit_m2) = (0.0, 0.0);
    for side in sides.clone().filter(|&side| albedo(side) > 0.0) {
        light[side] = (sum(field.at(side)) - sum(direct.at(side))).max(0.0) / albedo(side);
        noise[side] = variances[side] / albedo(side).powi(2);
        if light[side] > 0.0 {
            flux += patches.area_m2(side) * light[side];
            lit_m2 += patches.area_m2(side);
        }
    }
    let least = if lit_m2 > 0.0 { FAINT * flux / lit_m2 } else { f64::MIN_POSITIVE };
    let smooth = smoothed(scene, &patches, &reached, &light);
    let bend = |side: usize| {
        let misfit = smooth.misfit(side, &noise)?;
        let certain = misfit.difference.abs() > CERTAIN * misfit.variance.sqrt();
        certain.then(|| misfit.difference.abs() / (light[side] + least))
    };
    let bends: Vec<f64> = sides.clone().into_par_iter().map(|side| bend(side).unwrap_or(0.0)).collect();
    let mut open: Vec<(f64, usize)> =
        (0..patches.len()).map(|patch| (bends[2 * patch].max(bends[2 * patch + 1]), patch)).collect();
    let mut links: Vec<u32> = sides
        .clone()
        .map(|side| {
            let wanted = f64::from(trial_links) * noise[side] / (NOISE * (light[side] + least)).powi(2);
            wanted.clamp(f64::from(FEWEST), f64::from(LINKS)) as u32
        })
        .collect();
    let mut covers: Vec<Option<Cover>> = covers.into_iter().map(Some).collect();
    let most = MOST * patches.len();
    while patches.len() < most {
        open.retain(|(bend, _)| *bend > TOLERANCE);
        // The worst first; equals in the order of their numbers.
        open.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        open.truncate((most - patches.len()).div_ceil(3));
        let mut next = Vec::new();
        for (bend, patch) in open {
            let Some(parts) = patches.split(&scene.mesh, patch) else { continue };
            covers.resize(patches.sides(), None);
            covers[2 * patch..2 * patch + 2].fill(None);
            // Parts need as many links as the whole did.
            let own = [links[2 * patch], links[2 * patch + 1]];
            (links.len()..patches.sides()).for_each(|side| links.push(own[side % 2]));
            // A bend is in proportion to the square of the size.
            let left = bend / parts.len() as f64;
            next.extend(parts.into_iter().map(|part| (left, part)));
        }
        if next.is_empty() {
            break;
        }
        open = next;
    }
    Plan { patches, covers, links }
}
