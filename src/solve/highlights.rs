//! Where highlights are to be expected: about the images of luminaires in glossy planes. Directions
//! drawn there are *added* to those drawn by a receiver's response or a surface's cosine, and all are
//! weighted by the mixture of densities, so a wrong guess costs noise and nothing else.

use std::f64::consts::PI;

use glam::DVec3;

use crate::emitters::{Emitters, Mirror, Source, planes};
use crate::material::Bsdf;
use crate::sphere;

/// At most this many planes, the largest.
const MOST_PLANES: usize = 4;
/// Lobes whose peak ρ_s (n+1)/2π is less than this many times a white diffuser's 1/π need no help:
/// their highlights are wide or faint, and the rays would cost more than they save.
const DULL: f64 = 4.0;
/// The bundle of drawn directions is wider than the highlight by the root of this.
const MARGIN: f64 = 1.5;

/// Images of luminaires in glossy planes.
#[derive(Debug, Default)]
pub(super) struct Highlights {
    planes: Vec<Plane>,
}

#[derive(Debug)]
struct Plane {
    mirror: Mirror,
    /// Reflectance and exponent of the lobe.
    specular: f64,
    exponent: f64,
    images: Vec<Source>,
}

/// A bundle of directions about an axis, with the von Mises–Fisher density κ e^{κ(cos − 1)}/2π(1 − e^{−2κ}).
#[derive(Clone, Copy, Debug)]
pub(super) struct Bundle {
    axis: DVec3,
    concentration: f64,
    /// Probability of being chosen, summed over the bundles up to this one.
    up_to: f64,
    share: f64,
}

impl Highlights {
    /// Images in the largest glossy planes.
    pub(super) fn new(emitters: &Emitters) -> Self {
        let scene = emitters.scene;
        let sharp = |bsdf: &Bsdf| {
            bsdf.lobe().is_some_and(|lobe| 0.5 * lobe.albedo(1.0) * (lobe.sharpness() + 1.0) >= DULL)
        };
        let found = planes(scene, MOST_PLANES, sharp).into_iter().filter_map(|plane| {
            let lobe = scene.bsdf(*plane.triangles.first()?).lobe()?;
            let own = &emitters.sources[..scene.luminaires.len()];
            let images = own.iter().map(|source| source.image(&plane, None)).collect();
            Some(Plane { specular: lobe.albedo(1.0), exponent: lobe.sharpness(), images, mirror: plane })
        });
        Self { planes: found.collect() }
    }

    /// Fills `bundles` with what may be seen from `point`, weighted by illuminance and `response`.
    pub(super) fn about(
        &self,
        emitters: &Emitters,
        point: DVec3,
        response: impl Fn(DVec3) -> f64,
        bundles: &mut Vec<Bundle>,
    ) {
        bundles.clear();
        let mut total = 0.0;
        for Plane { mirror: plane, specular, exponent, images } in &self.planes {
            let height_m = (point.dot(plane.normal) - plane.offset_m).abs();
            for image in images {
                if !plane.may_show(point, image.position, image.radius_m) {
                    continue;
                }
                let towards = image.position - point;
                let distance_m = towards.length();
                let axis = towards / distance_m;
                let seen = response(axis);
                if !(seen > 0.0) {
                    continue;
                }
                let lit = emitters.intensity_cd(image, -axis) * specular * seen;
                let share = lit / (distance_m * distance_m);
                if !(share > 0.0 && share.is_finite()) {
                    continue;
                }
                // Turning the ray by ω turns the lobe's mirror direction by ω (1 + d_eye/d_lamp).
                let to_plane_m = height_m / axis.dot(plane.normal).abs();
                let turn = distance_m / (distance_m - to_plane_m).max(1e-3 * distance_m);
                let size = image.radius_m / distance_m;
                let width2 = 1.0 / (exponent * turn * turn) + 0.5 * size * size;
                total += share;
                bundles.push(Bundle { axis, concentration: 1.0 / (MARGIN * width2), up_to: total, share });
            }
        }
        for bundle in bundles.iter_mut() {
            bundle.up_to /= total;
            bundle.share /= total;
        }
    }
}

/// Draws a direction from the mixture of bundles.
pub(super) fn draw(bundles: &[Bundle], u: [f64; 3]) -> DVec3 {
    let chosen = bundles.partition_point(|bundle| bundle.up_to <= u[0]).min(bundles.len() - 1);
    let Bundle { axis, concentration, .. } = bundles[chosen];
    // 1 − cos by expm1 and ln1p: exact for the narrowest bundles too.
    let lost = -(u[1] * (-2.0 * concentration).exp_m1()).ln_1p() / concentration;
    let sin = (lost * (2.0 - lost)).max(0.0).sqrt();
    let (s, c) = (2.0 * PI * u[2]).sin_cos();
    sphere::frame(axis) * DVec3::new(sin * c, sin * s, 1.0 - lost)
}

/// Density of [`draw`], 1/sr.
pub(super) fn density(bundles: &[Bundle], direction: DVec3) -> f64 {
    let one = |bundle: &Bundle| {
        // |a − b|²/2 = 1 − cos without cancellation.
        let lost = 0.5 * (bundle.axis - direction).length_squared();
        let k = bundle.concentration;
        bundle.share * k * (-k * lost).exp() / (-2.0 * PI * (-2.0 * k).exp_m1())
    };
    bundles.iter().map(one).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// Catches: a density that is not that of the draws, or does not integrate to 1.
    #[test]
    fn draws_follow_their_density() {
        let bundle = |axis: DVec3, concentration, up_to, share| Bundle { axis, concentration, up_to, share };
        let bundles = [bundle(DVec3::Z, 30.0, 0.25, 0.25), bundle(DVec3::new(0.6, 0.0, 0.8), 4.0, 1.0, 0.75)];
        let (n, mut rng) = (1000u32, Rng::new(1, 2, 3));
        let (mut whole, mut moment) = (0.0, DVec3::ZERO);
        for i in 0..n * n {
            let at = |k: u32| (f64::from(k) + 0.5) / f64::from(n);
            let d = sphere::uniform_sphere([at(i % n), at(i / n)]);
            let p = density(&bundles, d) * 4.0 * PI / f64::from(n * n);
            whole += p;
            moment += p * d * d.x.max(0.0);
        }
        assert!((whole - 1.0).abs() < 1e-4, "{whole}");
        let draws = 200_000;
        let mut mean = DVec3::ZERO;
        for _ in 0..draws {
            let d = draw(&bundles, rng.uniforms());
            mean += d * d.x.max(0.0) / f64::from(draws);
        }
        assert!((mean - moment).length() < 4e-3, "{mean} is not {moment}");
    }
}
