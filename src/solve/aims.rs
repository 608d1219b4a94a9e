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
    /// For each of equal parts of [0, 1) the side to which its beginning belongs: where the search starts.
    guide: Vec<u32>,
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
        let cumulative: Vec<f64> = cumulative.into_iter().map(|sum| sum / total).collect();
        let mut side = 0;
        let guide = (0..cumulative.len())
            .map(|part| {
                let begins = part as f64 / cumulative.len() as f64;
                while side + 1 < cumulative.len() && cumulative[side] <= begins {
                    side += 1;
                }
                side as u32
            })
            .collect();
        Some(Self { cumulative, guide, per_m2 })
    }

    /// The side with a choice in [0, 1): the first whose sum is greater.
    fn chosen(&self, choice: f64) -> usize {
        let last = self.cumulative.len() - 1;
        let part = ((choice * self.guide.len() as f64) as usize).min(last);
        // Rounding may put a choice into the part after its own.
        let mut side = self.guide[part.saturating_sub(1)] as usize;
        while side < last && self.cumulative[side] <= choice {
            side += 1;
        }
        side
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
        let side = self.chosen(choice);
        let place = patches.place(side, u);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// Catches: a guide that starts beyond the side that it should find, at sides without light too.
    #[test]
    fn the_guide_finds_what_a_search_finds() {
        let mut mesh = crate::geometry::mesh::Mesh::default();
        let floor = mesh.add_surface("floor", 0, false);
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]];
        mesh.add_quad(corners.map(|[x, y]| glam::DVec3::new(x, y, 0.0)), floor);
        let patches = Patches::new(&mesh, 0.01, |_| true);
        let mut rng = Rng::new(1, 1, 1);
        let lit: Vec<f64> = (0..patches.sides())
            .map(|side| if side % 3 == 0 { 0.0 } else { rng.uniform().powi(20) })
            .collect();
        let aims = Aims::new(&patches, |side| lit[side]).expect("there is light");
        let parts = aims.guide.len();
        let edges =
            (0..parts).flat_map(|k| [k as f64 / parts as f64, (k as f64 + 1.0 - 1e-12) / parts as f64]);
        let sums = aims.cumulative.iter().flat_map(|sum| [*sum, sum.next_down()]);
        let random = (0..20_000).map(|_| rng.uniform());
        for choice in edges.chain(sums).chain(random).filter(|choice| *choice < 1.0) {
            let searched = aims.cumulative.partition_point(|sum| *sum <= choice).min(parts - 1);
            assert_eq!(aims.chosen(choice), searched, "{choice}");
        }
    }
}
