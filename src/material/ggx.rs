//! Microfacets with the GGX distribution, for glTF's metallic-roughness materials. glTF weakens the
//! diffuse part with the angle, which one stored number a side cannot; here the diffuse part stays
//! constant and the *lobe's* grazing reflectance is what it leaves: F90 = 1 − ρ_d.

use std::f64::consts::PI;

use glam::DVec3;

use super::Bsdf;
use super::lobe::{Albedo, Lobe};

/// f = F D G₂ / (4 cos θ_i cos θ_o) with the GGX distribution D, Smith's height-correlated G₂
/// (Heitz 2014, JCGT 3(2)) and Schlick's F = F0 + (F90 − F0)(1 − wo·h)⁵. Albedo ≤ F90 ≤ 1 − ρ_d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    f0: f64,
    pub(super) f90: f64,
    alpha: f64,
    albedo: Albedo,
}

/// Normal reflectance of a dielectric with refractive index 1.5, as glTF assumes it.
const DIELECTRIC: f64 = 0.04;
/// Smaller roughness is taken as this one: glTF writes 0 for "smooth", a lobe needs some width.
const SMOOTHEST: f64 = 1e-3;

impl Ggx {
    /// A lobe from normal and grazing reflectance and `alpha` > 0.
    pub fn new(f0: f64, f90: f64, alpha: f64) -> Self {
        let bare = Self { f0, f90, alpha, albedo: Albedo::of(|_, _| None) };
        Self { albedo: Albedo::of(|wo, u| bare.sample(wo, u)), ..bare }
    }

    fn fresnel(&self, cos: f64) -> f64 {
        self.f0 + (self.f90 - self.f0) * (1.0 - cos).clamp(0.0, 1.0).powi(5)
    }

    /// Smith's Λ = (√(1 + α² tan²θ) − 1)/2.
    fn masking(&self, w: DVec3) -> f64 {
        let tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
        0.5 * ((1.0 + self.alpha * self.alpha * tan2).sqrt() - 1.0)
    }

    fn distribution(&self, h: DVec3) -> f64 {
        let a2 = self.alpha * self.alpha;
        // 1 + cos²(α² − 1) written without cancellation.
        let t = (h.x * h.x + h.y * h.y) + h.z * h.z * a2;
        a2 / (PI * t * t)
    }

    pub(super) fn f(&self, wi: DVec3, wo: DVec3) -> f64 {
        let h = (wi + wo).normalize_or_zero();
        let both = 1.0 / (1.0 + self.masking(wi) + self.masking(wo));
        self.fresnel(wo.dot(h)) * self.distribution(h) * both / (4.0 * wi.z * wo.z)
    }

    /// Visible normals: p = G₁(wo) D(h) / (4 cos θ_o).
    pub(super) fn pdf(&self, wi: DVec3, wo: DVec3) -> f64 {
        let h = (wi + wo).normalize_or_zero();
        self.distribution(h) / ((1.0 + self.masking(wo)) * 4.0 * wo.z)
    }

    /// Visible normals by spherical caps (Dupuy & Benyoub 2023); weight F G₂/G₁ ≤ 1.
    pub(super) fn sample(&self, wo: DVec3, u: [f64; 2]) -> Option<(DVec3, f64)> {
        let stretched = DVec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        let z = (1.0 - u[0]) * (1.0 + stretched.z) - stretched.z;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let (s, c) = (2.0 * PI * u[1]).sin_cos();
        let cap = DVec3::new(radius * c, radius * s, z) + stretched;
        let h = DVec3::new(self.alpha * cap.x, self.alpha * cap.y, cap.z).normalize_or_zero();
        let across = wo.dot(h);
        let wi = 2.0 * across * h - wo;
        if !(wi.z > 0.0 && across > 0.0) {
            return None;
        }
        let (i, o) = (self.masking(wi), self.masking(wo));
        Some((wi, self.fresnel(across) * (1.0 + o) / (1.0 + i + o)))
    }

    pub(super) fn albedo(&self, cos: f64) -> f64 {
        self.albedo.at(cos)
    }
}

impl Bsdf {
    /// A glTF metallic-roughness material from the luminance Y of its base colour: α = roughness²,
    /// F0 = 0.04 (1 − m) + Y m, diffuse ρ_d = 0.96 (1 − m) Y, F90 = 1 − ρ_d (glTF 2.0, appendix B, but
    /// for F90 and the constant diffuse part).
    pub fn metallic_roughness(luminance: f64, metallic: f64, roughness: f64) -> Self {
        let reflectance = (1.0 - DIELECTRIC) * (1.0 - metallic) * luminance;
        let f0 = DIELECTRIC * (1.0 - metallic) + luminance * metallic;
        let alpha = (roughness * roughness).max(SMOOTHEST);
        Self::Glossy { reflectance, lobe: Lobe::Ggx(Ggx::new(f0, 1.0 - reflectance, alpha)) }
    }
}
