//! The modified Phong lobe as papers on global illumination print it: reciprocal, but what would
//! leave below the horizon *and* the foreshortening of the rest are lost, so it darkens at grazing
//! incidence. For comparison with such papers; [`super::Phong`] is the lobe for planning.

use glam::DVec3;

use super::lobe::Albedo;
use super::phong::{density, draw};

/// f = ρ_s (n+2)/2π · cosⁿα (Lafortune & Willems 1994); its albedo is ρ_s at normal incidence only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongPaper {
    pub(super) specular: f64,
    exponent: f64,
    albedo: Albedo,
}

impl PhongPaper {
    /// A lobe of reflectance `specular` at normal incidence with `exponent` ≥ 0.
    pub fn new(specular: f64, exponent: f64) -> Self {
        let strength = specular * (exponent + 2.0) / (exponent + 1.0);
        let albedo = Albedo::of(|wo, u| draw(wo, exponent, u).map(|wi| (wi, strength * wi.z)));
        Self { specular, exponent, albedo }
    }

    fn strength(&self) -> f64 {
        self.specular * (self.exponent + 2.0) / (self.exponent + 1.0)
    }

    pub(super) fn f(&self, wi: DVec3, wo: DVec3) -> f64 {
        self.strength() * density(wi, wo, self.exponent)
    }

    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3) -> f64 {
        density(wi, wo, self.exponent)
    }

    pub(super) fn sample(&self, wo: DVec3, u: [f64; 2]) -> Option<(DVec3, f64)> {
        draw(wo, self.exponent, u).map(|wi| (wi, self.strength() * wi.z))
    }

    pub(super) fn albedo(&self, cos: f64) -> f64 {
        self.albedo.at(cos)
    }

    /// Mean loss over all incidences of a uniformly lit surface, as a share of ρ_s:
    /// 1 − 2∫ a(cos)/ρ_s cos d(cos).
    pub fn loss(&self) -> f64 {
        let n = 64;
        let lit: f64 = (0..n)
            .map(|k| (f64::from(k) + 0.5) / f64::from(n))
            .map(|cos| 2.0 * self.albedo(cos) * cos / f64::from(n))
            .sum();
        if self.specular > 0.0 { 1.0 - lit / self.specular } else { 0.0 }
    }
}
