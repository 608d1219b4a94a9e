//! Surface materials. Both sides of a surface reflect alike; `reflectance` is the diffuse part.
//! The set of models is closed: a new one is a variant here and a line in the law tests below.

mod ggx;
mod lobe;
pub mod pane;
mod phong;
mod phong_paper;
mod ward;

use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

pub use ggx::Ggx;
pub use lobe::Lobe;
pub use pane::Pane;
pub use phong::Phong;
pub use phong_paper::PhongPaper;
pub use ward::Ward;

/// A named material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name as in the project file or glTF.
    pub name: String,
    /// How it scatters light.
    pub bsdf: Bsdf,
}

/// The closed set of scattering models. Luminous values, no colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Perfectly diffuse reflection, f = ρ/π.
    Lambert {
        /// ρ, 0 … 1.
        reflectance: f64,
    },
    /// Diffuse reflection and diffuse transmission.
    Opal {
        /// ρ, 0 … 1.
        reflectance: f64,
        /// τ, ρ + τ ≤ 1.
        transmittance: f64,
    },
    /// Ideal mirror with a constant reflectance.
    Mirror {
        /// ρ, 0 … 1.
        reflectance: f64,
    },
    /// A clear pane drawn as one surface; see [`Pane`].
    Glass(Pane),
    /// Diffuse reflection under a glossy lobe, which is added to it.
    Glossy {
        /// ρ of the diffuse part.
        reflectance: f64,
        /// The lobe; ρ + its albedo ≤ 1.
        lobe: Lobe,
    },
    /// A diffuse surface that also emits: luminous ceilings, screens, bright windows.
    Emitter {
        /// Emitted luminance of both sides, cd/m².
        luminance_cd_m2: f64,
        /// Diffuse reflectance of the surface itself.
        reflectance: f64,
    },
}

/// A direction drawn from a [`Bsdf`], in the local frame (z = normal on the incident side).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampled {
    /// Unit direction of the scattered light.
    pub direction: DVec3,
    /// f |cos| / p: what the path's weight is multiplied with.
    pub weight: f64,
    /// Whether the direction is the only one possible (mirror, clear glass).
    pub specular: bool,
}

impl Bsdf {
    /// Whether some incident light is absorbed for every direction.
    pub fn absorbs(&self) -> bool {
        match *self {
            Self::Lambert { reflectance }
            | Self::Mirror { reflectance }
            | Self::Emitter { reflectance, .. } => reflectance < 1.0,
            Self::Opal { reflectance, transmittance } => reflectance + transmittance < 1.0,
            Self::Glass(pane) => pane.absorbs(),
            // Every lobe loses what would leave below the horizon or between facets.
            Self::Glossy { .. } => self.albedo(0.5) < 1.0,
        }
    }

    /// Diffuse reflectance and diffuse transmittance; zero for purely specular models.
    pub fn diffuse(&self) -> (f64, f64) {
        match *self {
            Self::Lambert { reflectance }
            | Self::Emitter { reflectance, .. }
            | Self::Glossy { reflectance, .. } => (reflectance, 0.0),
            Self::Opal { reflectance, transmittance } => (reflectance, transmittance),
            Self::Mirror { .. } | Self::Glass(_) => (0.0, 0.0),
        }
    }

    /// Specular reflectance and transmittance at |cos| of incidence; `None` for models without a delta lobe.
    pub fn specular(&self, cos: f64) -> Option<(f64, f64)> {
        match *self {
            Self::Mirror { reflectance } => Some((reflectance, 0.0)),
            Self::Glass(pane) => Some((pane.reflectance(cos), pane.transmittance(cos))),
            Self::Lambert { .. } | Self::Opal { .. } | Self::Emitter { .. } | Self::Glossy { .. } => None,
        }
    }

    /// The glossy lobe, if there is one.
    pub fn lobe(&self) -> Option<&Lobe> {
        match self {
            Self::Glossy { lobe, .. } => Some(lobe),
            Self::Lambert { .. }
            | Self::Opal { .. }
            | Self::Mirror { .. }
            | Self::Glass(_)
            | Self::Emitter { .. } => None,
        }
    }

    /// Emitted luminance, cd/m².
    pub fn emitted(&self) -> f64 {
        match *self {
            Self::Emitter { luminance_cd_m2, .. } => luminance_cd_m2,
            _ => 0.0,
        }
    }

    /// f(wi, wo) in 1/sr in the local frame, delta lobes excluded; wo.z > 0.
    pub fn f(&self, wi: DVec3, wo: DVec3) -> f64 {
        let (reflectance, transmittance) = self.diffuse();
        let diffuse = if wi.z > 0.0 { reflectance } else { transmittance } * FRAC_1_PI;
        diffuse + self.lobe().map_or(0.0, |lobe| lobe.f(wi, wo))
    }

    /// Density in 1/sr with which [`Bsdf::sample`] draws `wi`; 0 for delta lobes. Where a glossy lobe
    /// reaches below the horizon it integrates to the probability that anything is drawn.
    pub fn pdf(&self, wi: DVec3, wo: DVec3) -> f64 {
        let (reflectance, transmittance) = self.diffuse();
        if let Some(lobe) = self.lobe() {
            let share = self.share_of_lobe(lobe, wo.z);
            return share * lobe.pdf(wi, wo) + (1.0 - share) * wi.z.max(0.0) * FRAC_1_PI;
        }
        let total = reflectance + transmittance;
        if !(total > 0.0) {
            return 0.0;
        }
        let share = if wi.z > 0.0 { reflectance } else { transmittance } / total;
        share * wi.z.abs() * FRAC_1_PI
    }

    /// Draws a direction for light that leaves along `wo` (wo.z > 0); `None` where nothing is reflected.
    pub fn sample(&self, wo: DVec3, u: [f64; 3]) -> Option<Sampled> {
        if let Some((reflected, passed)) = self.specular(wo.z) {
            let total = reflected + passed;
            if !(total > 0.0) {
                return None;
            }
            let reflect = u[0] * total < reflected;
            let direction = if reflect { DVec3::new(-wo.x, -wo.y, wo.z) } else { -wo };
            return Some(Sampled { direction, weight: total, specular: true });
        }
        if let Some(lobe) = self.lobe() {
            if !(self.albedo(wo.z) > 0.0) {
                return None;
            }
            let direction = if u[0] < self.share_of_lobe(lobe, wo.z) {
                lobe.sample(wo, [u[1], u[2]])?.0
            } else {
                crate::sphere::cosine_hemisphere([u[1], u[2]])
            };
            let weight = self.f(direction, wo) * direction.z / self.pdf(direction, wo);
            return Some(Sampled { direction, weight, specular: false });
        }
        let (reflectance, transmittance) = self.diffuse();
        let total = reflectance + transmittance;
        if !(total > 0.0) {
            return None;
        }
        let mut direction = crate::sphere::cosine_hemisphere([u[1], u[2]]);
        if u[0] * total >= reflectance {
            direction.z = -direction.z;
        }
        Some(Sampled { direction, weight: total, specular: false })
    }

    /// Directional-hemispherical reflectance plus transmittance at |cos| of incidence.
    pub fn albedo(&self, cos: f64) -> f64 {
        let (reflectance, transmittance) = self.diffuse();
        let (mirrored, passed) = self.specular(cos).unwrap_or((0.0, 0.0));
        reflectance + transmittance + mirrored + passed + self.lobe().map_or(0.0, |lobe| lobe.albedo(cos))
    }

    /// Probability with which [`Bsdf::sample`] draws from the lobe.
    fn share_of_lobe(&self, lobe: &Lobe, cos: f64) -> f64 {
        let glossy = lobe.albedo(cos);
        let total = self.diffuse().0 + glossy;
        if total > 0.0 { glossy / total } else { 0.0 }
    }
}

#[cfg(test)]
mod laws;
