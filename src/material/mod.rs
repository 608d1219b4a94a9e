//! Surface materials. Both sides of a surface reflect alike; `reflectance` is the diffuse part.
//! The set of models is closed: a new one is a variant here and a line in the law tests below.

mod pane;

use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

pub use pane::Pane;

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
        }
    }

    /// Diffuse reflectance and diffuse transmittance; zero for purely specular models.
    pub fn diffuse(&self) -> (f64, f64) {
        match *self {
            Self::Lambert { reflectance } | Self::Emitter { reflectance, .. } => (reflectance, 0.0),
            Self::Opal { reflectance, transmittance } => (reflectance, transmittance),
            Self::Mirror { .. } | Self::Glass(_) => (0.0, 0.0),
        }
    }

    /// Specular reflectance and transmittance at |cos| of incidence; `None` for models without a delta lobe.
    pub fn specular(&self, cos: f64) -> Option<(f64, f64)> {
        match *self {
            Self::Mirror { reflectance } => Some((reflectance, 0.0)),
            Self::Glass(pane) => Some((pane.reflectance(cos), pane.transmittance(cos))),
            Self::Lambert { .. } | Self::Opal { .. } | Self::Emitter { .. } => None,
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
    pub fn f(&self, wi: DVec3, _wo: DVec3) -> f64 {
        let (reflectance, transmittance) = self.diffuse();
        if wi.z > 0.0 { reflectance * FRAC_1_PI } else { transmittance * FRAC_1_PI }
    }

    /// Density in 1/sr with which [`Bsdf::sample`] draws `wi`; 0 for delta lobes.
    pub fn pdf(&self, wi: DVec3, _wo: DVec3) -> f64 {
        let (reflectance, transmittance) = self.diffuse();
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
        reflectance + transmittance + mirrored + passed
    }
}

/// Every model once, for the law tests.
#[cfg(test)]
const EXAMPLES: [Bsdf; 6] = [
    Bsdf::Lambert { reflectance: 0.7 },
    Bsdf::Opal { reflectance: 0.4, transmittance: 0.5 },
    Bsdf::Mirror { reflectance: 0.9 },
    Bsdf::Glass(Pane::CLEAR),
    Bsdf::Emitter { luminance_cd_m2: 100.0, reflectance: 0.3 },
    Bsdf::Lambert { reflectance: 0.0 },
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn laws_of_every_model() {
        let direction = |cos: f64, azimuth: f64| {
            let sin = (1.0 - cos * cos).sqrt();
            DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos)
        };
        for bsdf in EXAMPLES {
            let n = 200;
            for cos_o in [0.01, 0.3, 0.9, 1.0] {
                let wo = direction(cos_o, 0.4);
                let (mut energy, mut density) = (0.0, 0.0);
                for i in 0..2 * n {
                    let cos_i = (f64::from(i) + 0.5) / f64::from(n) - 1.0;
                    for j in 0..16 {
                        let wi = direction(cos_i, PI * (f64::from(j) + 0.5) / 8.0);
                        let solid_angle = 2.0 * PI / (f64::from(n) * 16.0);
                        energy += bsdf.f(wi, wo) * cos_i.abs() * solid_angle;
                        density += bsdf.pdf(wi, wo) * solid_angle;
                        if cos_i > 0.0 {
                            assert!(
                                (bsdf.f(wi, wo) - bsdf.f(wo, wi)).abs() < 1e-12,
                                "{bsdf:?} is not reciprocal"
                            );
                        }
                    }
                }
                let (mirrored, passed) = bsdf.specular(cos_o).unwrap_or((0.0, 0.0));
                assert!((energy + mirrored + passed - bsdf.albedo(cos_o)).abs() < 1e-4, "{bsdf:?}: albedo");
                assert!(bsdf.albedo(cos_o) <= 1.0 + 1e-12, "{bsdf:?} gains energy");
                let (rho, tau) = bsdf.diffuse();
                let expected = if rho + tau > 0.0 { 1.0 } else { 0.0 };
                assert!((density - expected).abs() < 1e-4, "{bsdf:?}: pdf integrates to {density}");
            }
        }
    }

    #[test]
    fn sampling_follows_the_density() {
        for bsdf in EXAMPLES {
            let wo = DVec3::new(0.6, 0.0, 0.8);
            let (mut mean_weight, mut mean_cos, n) = (0.0, 0.0, 40_000);
            for i in 0..n {
                let u = [0, 1, 2].map(|d| f64::from(sobol_burley::sample(i, d, 9)));
                if let Some(s) = bsdf.sample(wo, u) {
                    mean_weight += s.weight / f64::from(n);
                    mean_cos += s.weight * s.direction.z / f64::from(n);
                    assert!((s.direction.length() - 1.0).abs() < 1e-12);
                }
            }
            assert!((mean_weight - bsdf.albedo(0.8)).abs() < 1e-9, "{bsdf:?}");
            // First moment of cos: ∫ f cos² over the upper minus the lower hemisphere = 2/3 (ρ − τ).
            let (rho, tau) = bsdf.diffuse();
            let (mirrored, passed) = bsdf.specular(0.8).unwrap_or((0.0, 0.0));
            let expected = 2.0 / 3.0 * (rho - tau) + 0.8 * (mirrored - passed);
            assert!((mean_cos - expected).abs() < 2e-3, "{bsdf:?}: {mean_cos} is not {expected}");
        }
    }
}
