//! A clear pane as one surface, from its normal transmittance. A newcomer's mistake: the tabled
//! transmittance of a pane includes both Fresnel surfaces and what is absorbed between them.

/// A plane-parallel pane of clear glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pane {
    /// Refractive index.
    index: f64,
    /// Internal transmittance at normal incidence, surfaces excluded.
    internal: f64,
}

/// Refractive index of soda-lime glass.
const SODA_LIME: f64 = 1.52;

impl Pane {
    /// A pane of soda-lime glass without absorption (normal transmittance 0.9176).
    #[cfg(test)]
    pub(super) const CLEAR: Self = Self { index: SODA_LIME, internal: 1.0 };

    /// The pane with transmittance `normal_transmittance` (0 … 1) at normal incidence.
    ///
    /// With the Fresnel reflectance r of one surface and internal transmittance τ:
    /// T = (1−r)² τ / (1 − r² τ²), solved for τ at n = 1.52. A pane that passes more than soda-lime
    /// glass can (0.918) is taken as free of absorption with the index that gives T = (1−r)/(1+r).
    pub fn new(normal_transmittance: f64) -> Self {
        let t = normal_transmittance;
        let r = fresnel(1.0, SODA_LIME)[0];
        let clearest = (1.0 - r) / (1.0 + r);
        if t > clearest {
            let root = ((1.0 - t) / (1.0 + t)).sqrt();
            return Self { index: (1.0 + root) / (1.0 - root), internal: 1.0 };
        }
        let q = (1.0 - r) * (1.0 - r);
        let internal = if t > 0.0 { 2.0 * t / (q + (q * q + 4.0 * t * t * r * r).sqrt()) } else { 0.0 };
        Self { index: SODA_LIME, internal }
    }

    /// Transmittance at |cos| of incidence, mean of both polarisations.
    pub fn transmittance(&self, cos: f64) -> f64 {
        self.at(cos).0
    }

    /// Reflectance at |cos| of incidence, mean of both polarisations.
    pub fn reflectance(&self, cos: f64) -> f64 {
        self.at(cos).1
    }

    /// Whether any light is absorbed inside.
    pub fn absorbs(&self) -> bool {
        self.internal < 1.0
    }

    fn at(&self, cos: f64) -> (f64, f64) {
        let sin_inside_squared = (1.0 - cos * cos) / (self.index * self.index);
        let path = 1.0 / (1.0 - sin_inside_squared).sqrt();
        let tau = self.internal.powf(path);
        let (mut passed, mut reflected) = (0.0, 0.0);
        for r in fresnel(cos, self.index) {
            let t = (1.0 - r) * (1.0 - r) * tau / (1.0 - r * r * tau * tau).max(f64::MIN_POSITIVE);
            passed += 0.5 * t;
            reflected += 0.5 * (r + r * tau * t);
        }
        (passed, reflected)
    }
}

/// Fresnel reflectance of one surface for s and p polarisation at |cos| of incidence in air.
fn fresnel(cos: f64, index: f64) -> [f64; 2] {
    let cos_inside = (1.0 - (1.0 - cos * cos) / (index * index)).sqrt();
    let s = (cos - index * cos_inside) / (cos + index * cos_inside);
    let p = (index * cos - cos_inside) / (index * cos + cos_inside);
    [s * s, p * p]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_transmittance_is_given_back() {
        for t in [0.0, 0.1, 0.5, 0.88, 0.9, 0.917, 0.95, 1.0] {
            assert!((Pane::new(t).transmittance(1.0) - t).abs() < 1e-12, "{t}");
        }
    }

    #[test]
    fn a_clear_pane_loses_nothing_and_blocks_at_grazing() {
        for cos in [1e-6, 0.1, 0.5, 1.0] {
            let pane = Pane::CLEAR;
            assert!((pane.transmittance(cos) + pane.reflectance(cos) - 1.0).abs() < 1e-12);
        }
        assert!(Pane::CLEAR.transmittance(1e-6) < 1e-4);
        // n = 1.52 at 60°: r_s = 0.18255, r_p = 0.00181 → T = ½ Σ (1−r)/(1+r) = 0.8438.
        assert!((Pane::CLEAR.transmittance(0.5) - 0.8438).abs() < 1e-3, "{}", Pane::CLEAR.transmittance(0.5));
    }
}
