//! The glossy lobe of a surface, without its diffuse part. A lobe is reciprocal, loses what would
//! leave below the horizon, and is drawn for the light that leaves along `wo`: `sample` may draw
//! nothing, and `pdf` integrates to the probability that it draws something.

use glam::DVec3;

use super::{Ggx, Phong, PhongPaper, Ward};

/// The closed set of lobes, in the local frame (z = normal on the side of both directions).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    /// Energy-conserving Phong lobe.
    Phong(Phong),
    /// Modified Phong lobe, which loses energy at grazing incidence.
    PhongPaper(PhongPaper),
    /// Isotropic Ward lobe, bounded.
    Ward(Ward),
    /// Microfacets with the GGX distribution.
    Ggx(Ggx),
}

impl Lobe {
    /// f(wi, wo) in 1/sr; 0 unless both lie above the surface.
    pub fn f(&self, wi: DVec3, wo: DVec3) -> f64 {
        if !(wi.z > 0.0 && wo.z > 0.0) {
            return 0.0;
        }
        match self {
            Self::Phong(lobe) => lobe.f(wi, wo),
            Self::PhongPaper(lobe) => lobe.f(wi, wo),
            Self::Ward(lobe) => lobe.f(wi, wo),
            Self::Ggx(lobe) => lobe.f(wi, wo),
        }
    }

    /// Density in 1/sr with which [`Lobe::sample`] draws `wi`.
    pub fn pdf(&self, wi: DVec3, wo: DVec3) -> f64 {
        if !(wi.z > 0.0 && wo.z > 0.0) {
            return 0.0;
        }
        match self {
            Self::Phong(lobe) => lobe.pdf(wi, wo),
            Self::PhongPaper(lobe) => lobe.pdf(wi, wo),
            Self::Ward(lobe) => lobe.pdf(wi, wo),
            Self::Ggx(lobe) => lobe.pdf(wi, wo),
        }
    }

    /// Draws the direction from which light comes that leaves along `wo`, with its weight
    /// f cos / p; `None` where it would come from below the surface.
    pub fn sample(&self, wo: DVec3, u: [f64; 2]) -> Option<(DVec3, f64)> {
        let drawn = match self {
            Self::Phong(lobe) => lobe.sample(wo, u),
            Self::PhongPaper(lobe) => lobe.sample(wo, u),
            Self::Ward(lobe) => lobe.sample(wo, u),
            Self::Ggx(lobe) => lobe.sample(wo, u),
        };
        drawn.filter(|&(wi, weight)| wi.z > 0.0 && weight > 0.0)
    }

    /// Directional-hemispherical reflectance at cos of incidence, ∫ f cos dω (tabulated).
    pub fn albedo(&self, cos: f64) -> f64 {
        match self {
            Self::Phong(lobe) => lobe.albedo(cos),
            Self::PhongPaper(lobe) => lobe.albedo(cos),
            Self::Ward(lobe) => lobe.albedo(cos),
            Self::Ggx(lobe) => lobe.albedo(cos),
        }
    }

    /// Exponent n of the Phong lobe cosⁿα ≈ exp(−nα²/2) that is about as wide near normal incidence.
    pub fn sharpness(&self) -> f64 {
        match self {
            Self::Phong(lobe) => lobe.exponent,
            Self::PhongPaper(lobe) => lobe.exponent,
            // Half vectors turn by half the angle: exp(−tan²(α/2)/a²).
            Self::Ward(lobe) => 0.5 / (lobe.alpha * lobe.alpha),
            Self::Ggx(lobe) => 0.5 / (lobe.alpha * lobe.alpha),
        }
    }
}

/// Intervals of the table of albedos.
const INTERVALS: usize = 24;
/// Points of a Fibonacci lattice from which an entry is averaged, and its generator.
const LATTICE: [u32; 2] = [10_946, 6_765];
/// The first entry stands for grazing incidence.
const GRAZING: f64 = 1e-6;

/// Albedo against cos θ, at cos θ = (k/24)²: dense near grazing, where it changes fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Albedo([f64; INTERVALS + 1]);

impl Albedo {
    /// Averages the weights of a sampler over a regular set of its random numbers.
    pub(super) fn of(sample: impl Fn(DVec3, [f64; 2]) -> Option<(DVec3, f64)>) -> Self {
        let mut table = [0.0; INTERVALS + 1];
        for (k, entry) in table.iter_mut().enumerate() {
            let cos = (k as f64 / INTERVALS as f64).powi(2).max(GRAZING);
            let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            for i in 0..LATTICE[0] {
                let of = |n: u32| (f64::from(n % LATTICE[0]) + 0.5) / f64::from(LATTICE[0]);
                if let Some((wi, weight)) = sample(wo, [of(i), of(i * LATTICE[1])])
                    && wi.z > 0.0
                {
                    *entry += weight / f64::from(LATTICE[0]);
                }
            }
        }
        Self(table)
    }

    /// Largest entry.
    pub(super) fn largest(&self) -> f64 {
        self.0.iter().copied().fold(0.0, f64::max)
    }

    /// All entries times `factor`.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self(self.0.map(|entry| entry * factor))
    }

    /// The albedo at cos θ, by cubic interpolation (Catmull–Rom) in √cos θ.
    pub(super) fn at(&self, cos: f64) -> f64 {
        let place = cos.clamp(0.0, 1.0).sqrt() * INTERVALS as f64;
        let k = (place as usize).min(INTERVALS - 1);
        let t = place - k as f64;
        let (a, b) = (self.0[k], self.0[k + 1]);
        let before = if k > 0 { self.0[k - 1] } else { 2.0 * a - b };
        let after = if k + 2 <= INTERVALS { self.0[k + 2] } else { 2.0 * b - a };
        let (da, db) = (0.5 * (b - before), 0.5 * (after - a));
        let s = 1.0 - t;
        a * (1.0 + 2.0 * t) * s * s + da * t * s * s + b * t * t * (3.0 - 2.0 * t) - db * t * t * s
    }
}

/// The mirror direction of a direction.
pub(super) fn mirrored(wo: DVec3) -> DVec3 {
    DVec3::new(-wo.x, -wo.y, wo.z)
}
