//! What glossy places reflect in their lobes: luminaires by points on their openings *and* by lobe rays,
//! each weighted by how likely it is to find the other's light; all other light by where the lobe rays
//! lead, as the field has it there. A few rays a pixel, so this part has noise, which is told.
//!
//! The points of all pixels of a tile are one Owen-scrambled Sobol sequence: those of a pixel are
//! stratified, and those of its neighbours fill the gaps between them.

use super::{Counts, Picture, Seen, Sight, TILE};
use crate::rng::{Rng, Stratified};
use crate::solve::lobe::scatter_at;
use crate::solve::look::{self, look};

/// Looks by the lobe a glossy place and pixel.
const RAYS: u32 = 4;
/// Shadow rays of a look on average at most.
const SHADOW_RAYS: f64 = 2.0;
/// Rays that go on with less than this weight survive in proportion.
const LEAST: f64 = 0.02;

/// Adds the light of lobes: `put` takes pixel, luminance and the square of its standard error.
pub(super) fn add(
    picture: &Picture,
    sights: &[Sight; TILE * TILE],
    rng: &mut Rng,
    counts: &mut Counts,
    mut put: impl FnMut(usize, f64, f64),
) {
    let emitters = picture.emitters;
    let scene = emitters.scene;
    let places: Vec<(usize, &Seen)> = sights
        .iter()
        .enumerate()
        .flat_map(|(pixel, sight)| sight.places.iter().map(move |place| (pixel, place)))
        .filter(|(_, place)| scene.bsdf(place.landing.triangle).lobe().is_some())
        .collect();
    if places.is_empty() {
        return;
    }
    let of_lamps: Vec<Stratified> = emitters.sources.iter().map(|_| Stratified::new(rng)).collect();
    let of_rays = Stratified::new(rng);
    let mut sight = look::Sight::new(scene.channels.len());
    for (number, (pixel, Seen { landing, share })) in places.into_iter().enumerate() {
        let Some(lobe) = scene.bsdf(landing.triangle).lobe() else { continue };
        let (mut sum, mut squares) = (0.0, 0.0);
        for ray in 0..RAYS {
            let index = (number as u32 * RAYS + ray) % (1 << 16);
            let points = |source: Option<usize>, rng: &mut Rng| {
                source.map_or(of_rays, |source| of_lamps[source]).point(index, rng)
            };
            sight.met.fill(0.0);
            let onward = scatter_at(emitters, lobe, landing, [LEAST, SHADOW_RAYS], points, rng, &mut sight);
            let mut value = picture.weighted(&sight.met);
            if let Some(onward) = onward {
                look(emitters, onward.origin, onward.direction, LEAST, rng, &mut sight);
                let stored: f64 =
                    sight.landings.iter().map(|landing| landing.weight * picture.whole(landing)).sum();
                value += onward.weight * (picture.weighted(&sight.met) + stored);
            }
            sum += value;
            squares += value * value;
        }
        let count = f64::from(RAYS);
        let variance = (squares - sum * sum / count).max(0.0) / (count * (count - 1.0));
        put(pixel, share * sum / count, share * share * variance);
    }
    counts.add(sight.counts);
}
