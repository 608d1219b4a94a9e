//! Where links are aimed: at places of patches, as often as these send out direct light. A bright spot that
//! few cosine-distributed links find is found by these, and the two share what both find by the balance
//! heuristic (Veach 1997): each counts by how likely it was to be drawn against both.

use std::f64::consts::FRAC_1_PI;

use super::look::Landing;
use crate::emitters::Emitters;
use crate::field::Patches;

/// One link in this many is doubled by one that is aimed.
pub(super) const AIMED: u32 = 3;

/// The distribution of aims over patch sides.
pub(super) struct Aims {
    /// Shares summed up.
    cumulative: Vec<f64>,
    /// Chance of an aim per area of each side, 1/m².
    per_m2: Vec<f64>,
}

/// A link that hit what it was aimed at.
pub(super) struct Aim {
    /// Patch side where it ends.
    pub side: usize,
    /// Its weight, in links.
    pub share: f64,
    /// Triangle where it ends.
    pub triangle: u32,
}

impl Aims {
    /// From the luminance that each side sends out at first hand; `None` in the dark.
    pub(super) fn new(patches: &Patches, luminance: impl Fn(usize) -> f64) -> Option<Self> {
        let mut total = 0.0;
        let cumulative: Vec<f64> = (0..patches.sides())
            .map(|side| {
                total += patches.area_m2(side) * luminance(side);
                total
            })
            .collect();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let per_m2 = (0..patches.sides()).map(|side| luminance(side) / total).collect();
        Some(Self { cumulative: cumulative.into_iter().map(|sum| sum / total).collect(), per_m2 })
    }

    /// Weight in links of a link that came straight to a place from `origin`, leaving with density
    /// `cosine` per solid angle: what aims find too counts less.
    pub(super) fn share(&self, side: usize, distance_m: f64, cos_there: f64, cosine: f64) -> f64 {
        let aimed = self.per_m2[side] * distance_m * distance_m / (cos_there * f64::from(AIMED));
        if aimed > 0.0 { cosine / (cosine + aimed) } else { 1.0 }
    }

    /// A link from a place aimed by `u`: `None` where the place that it is aimed at is not seen.
    pub(super) fn link(
        &self,
        emitters: &Emitters,
        patches: &Patches,
        at: &Landing,
        [choice, u @ ..]: [f64; 4],
    ) -> Option<Aim> {
        let scene = emitters.scene;
        let side = self.cumulative.partition_point(|sum| *sum <= choice).min(self.cumulative.len() - 1);
        let place = patches.place(&scene.mesh, side, u);
        let same_side = at.normal.dot(place.point - at.point) > 0.0;
        let (reflectance, transmittance) = scene.bsdf(at.triangle).diffuse();
        let albedo = if same_side { reflectance } else { transmittance };
        let origin = at.origin(scene, same_side);
        let towards = place.point - origin;
        let distance_m = towards.length();
        if !(albedo > 0.0 && distance_m > 0.0) {
            return None;
        }
        let direction = towards / distance_m;
        let facing = if side.is_multiple_of(2) { place.normal } else { -place.normal };
        let (cos_here, cos_there) = (at.normal.dot(direction).abs(), -facing.dot(direction));
        if !(cos_there > 0.0) {
            return None;
        }
        let hit = scene.tracer.closest(origin, direction, &[])?;
        let met = (hit.distance_m - distance_m).abs() <= 4.0 * scene.tracer.offset_m().max(1e-9 * distance_m)
            && scene.bsdf(hit.triangle).specular(1.0).is_none()
            && patches.side_at(hit.triangle, hit.barycentric, hit.front) == side;
        let cosine = albedo / (reflectance + transmittance) * cos_here * FRAC_1_PI;
        met.then(|| Aim {
            side,
            share: self.share(side, distance_m, cos_there, cosine),
            triangle: hit.triangle,
        })
    }
}
