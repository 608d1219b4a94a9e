//! A Phong lobe that never gains energy and treats both directions alike. The plain cosⁿα/cos θ
//! lobe does neither; dividing by the *larger* cosine mends both.

use std::f64::consts::PI;

use glam::DVec3;

use super::lobe::{Albedo, mirrored};
use crate::sphere;

/// f = ρ_s · c_n · (n+1)/2π · cosⁿα / max(cos θ_i, cos θ_o), α between wi and the mirror direction of wo
/// (Neumann, Neumann & Szirmay-Kalos 1999, Computer Graphics Forum 18(3)). c_n makes the largest
/// directional albedo equal to ρ_s (it is near (n+2)/(n+1)); towards grazing incidence, where half of
/// the lobe would leave below the horizon, the albedo falls to some ρ_s/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    pub(super) specular: f64,
    exponent: f64,
    /// ρ_s c_n: the largest weight.
    strength: f64,
    albedo: Albedo,
}

impl Phong {
    /// A lobe of reflectance `specular` with `exponent` ≥ 0.
    pub fn new(specular: f64, exponent: f64) -> Self {
        let raw = Albedo::of(|wo, u| draw(wo, exponent, u).map(|wi| (wi, (wi.z / wo.z).min(1.0))));
        let strength = specular / raw.largest();
        Self { specular, exponent, strength, albedo: raw.scaled(strength) }
    }

    pub(super) fn f(&self, wi: DVec3, wo: DVec3) -> f64 {
        self.strength * self.pdf(wi, wo) / wi.z.max(wo.z)
    }

    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3) -> f64 {
        density(wi, wo, self.exponent)
    }

    pub(super) fn sample(&self, wo: DVec3, u: [f64; 2]) -> Option<(DVec3, f64)> {
        draw(wo, self.exponent, u).map(|wi| (wi, self.strength * (wi.z / wo.z).min(1.0)))
    }

    pub(super) fn albedo(&self, cos: f64) -> f64 {
        self.albedo.at(cos)
    }
}

/// (n+1)/2π cosⁿα about the mirror direction.
pub(super) fn density(wi: DVec3, wo: DVec3, exponent: f64) -> f64 {
    let cos = wi.dot(mirrored(wo));
    if cos > 0.0 { (exponent + 1.0) / (2.0 * PI) * cos.min(1.0).powf(exponent) } else { 0.0 }
}

/// A direction above the surface with [`density`].
pub(super) fn draw(wo: DVec3, exponent: f64, u: [f64; 2]) -> Option<DVec3> {
    // 1 − u keeps ln finite; 1 − cos² by expm1 stays exact for the sharpest lobes.
    let ln_cos = (-u[0]).ln_1p() / (exponent + 1.0);
    let (cos, sin) = (ln_cos.exp(), (-(2.0 * ln_cos).exp_m1()).max(0.0).sqrt());
    let (s, c) = (2.0 * PI * u[1]).sin_cos();
    let wi = sphere::frame(mirrored(wo)) * DVec3::new(sin * c, sin * s, cos);
    (wi.z > 0.0).then_some(wi)
}
