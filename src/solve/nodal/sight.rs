//! What a line of sight sees of a nodal field: mirrors and panes are followed, since nothing is stored for them, and
//! direct light is added where the nodes do not hold it.

use super::super::answer::{Desk, mirrored_openings, straight_openings};
use super::super::look::{add_emission, follow};
use super::super::{PARTS, Prepared};
use super::{StoredLight, add_diffuse_lamps, add_glossy_lamps};
use crate::field::nodal::{NodalField, Spot};
use crate::query::Ray;
use crate::rng::{Rng, Stratified};
use crate::sphere;

/// Luminance along a ray from the nodal field, cd/m² per channel: mirrors and panes are followed; where only
/// indirect light is stored, direct light is added by `samples` points on each opening and lobe rays. `None` where
/// nodes that it needs were not asked for.
pub fn nodal_luminance(
    prepared: &Prepared,
    field: &NodalField,
    light: StoredLight,
    ray: &Ray,
    samples: u32,
    rng: &mut Rng,
) -> Option<Vec<f64>> {
    let scene = prepared.scene;
    let channels = scene.channels.len();
    let mut desk = Desk::new(channels);
    let mut parts = vec![0.0; channels * PARTS];
    let share = 1.0 / f64::from(samples);
    straight_openings(prepared, ray, &mut parts);
    let mut found = vec![0.0; channels];
    let sequence = Stratified::new(rng);
    for sample in 0..samples {
        mirrored_openings(prepared, ray, rng, share, &mut parts);
        desk.sight.met.fill(0.0);
        let arrived = follow(&prepared.emitters, ray.point, ray.direction, 1.0, rng, &mut desk.sight);
        for (sum, met) in found.iter_mut().zip(&desk.sight.met) {
            *sum += share * met;
        }
        let Some(here) = arrived else { continue };
        add_emission(scene, here.triangle, &mut found, share);
        let spot = Spot { triangle: here.triangle, barycentric: here.barycentric, front: here.front };
        let to_eye = sphere::frame(here.normal).transpose() * here.to_eye;
        // Where direct light has channels of its own they come first: both add up.
        for (number, stored) in field.look(&spot, to_eye)?.luminance.into_iter().enumerate() {
            found[number % channels] += share * stored;
        }
        if light == StoredLight::Indirect {
            add_diffuse_lamps(prepared, &here, share, rng, &mut desk, &mut found);
            let point = sequence.point(sample, rng);
            add_glossy_lamps(prepared, &here, point, share, rng, &mut desk, &mut found);
        }
    }
    for (sum, parts) in found.iter_mut().zip(parts.chunks(PARTS)) {
        *sum += parts.iter().sum::<f64>();
    }
    Some(found)
}
