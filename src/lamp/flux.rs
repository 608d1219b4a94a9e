//! Flux by zones. The zonal rule is what catalogues and most programs use; it is *not* the integral
//! of the interpolant, which weights the two ends of a zone by their sines.

use std::f64::consts::TAU;

use crate::photometry::IntensityDistribution;
use crate::units::{Lumens, Undefined};

/// Half-angles of the cones of 1/4, 1/2, 3/4 and all of the lower hemisphere's solid angle, CIE 52.
const CODE_CONES_DEG: [f64; 4] = [41.409_622_109_270_86, 60.0, 75.522_487_814_070_08, 90.0];

/// Zonal rule (LM-63, CIE 84): Φ = Σ 2π (cosγ_i − cosγ_{i+1}) · (I_i + I_{i+1})/2 over the tabulated
/// γ, I the mean over azimuth. Exact for the distributions without a table.
pub fn zonal_rule(distribution: &IntensityDistribution) -> Lumens {
    let Some((azimuths, gammas)) = distribution.grid() else {
        return distribution.flux();
    };
    let rotational = distribution.is_rotationally_symmetric();
    let mean_cd = |gamma: f64| {
        if rotational {
            return distribution.intensity_at(azimuths[0], gamma);
        }
        let at = |azimuth: f64| distribution.intensity_at(azimuth, gamma);
        let wedge = |pair: &[f64]| 0.5 * (pair[1] - pair[0]) * (at(pair[0]) + at(pair[1]));
        azimuths.windows(2).map(wedge).sum::<f64>() / 360.0
    };
    let means: Vec<f64> = gammas.iter().map(|gamma| mean_cd(*gamma)).collect();
    let zone = |(gamma, cd): (&[f64], &[f64])| {
        TAU * (gamma[0].to_radians().cos() - gamma[1].to_radians().cos()) * 0.5 * (cd[0] + cd[1])
    };
    Lumens(gammas.windows(2).zip(means.windows(2)).map(zone).sum())
}

/// Flux in the 18 zones of 10°, lm.
pub fn zones_lm(distribution: &IntensityDistribution) -> [f64; 18] {
    std::array::from_fn(|k| distribution.zonal_flux(10.0 * k as f64, 10.0 * (k + 1) as f64).0)
}

/// CIE flux code N1 … N5 in percent, CIE 52: the shares of the downward flux within the cones of
/// π/2, π and 3π/2 sr, the downward share of the flux, and the light output ratio.
///
/// # Errors
/// No flux goes down.
pub fn cie_code(distribution: &IntensityDistribution, lor: Option<f64>) -> Result<[f64; 5], Undefined> {
    let [n1, n2, n3, down] = CODE_CONES_DEG.map(|gamma| distribution.zonal_flux(0.0, gamma).0);
    if !(down > 0.0) {
        return Err(Undefined::because("no light goes down"));
    }
    let lor = lor.unwrap_or(1.0);
    Ok([n1 / down, n2 / down, n3 / down, down / distribution.flux().0, lor].map(|part| 100.0 * part))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cosine(step_deg: usize) -> IntensityDistribution {
        let gammas: Vec<f64> = (0..=90 / step_deg).map(|k| (k * step_deg) as f64).collect();
        let plane: Vec<f64> = gammas.iter().map(|gamma| 1000.0 * gamma.to_radians().cos()).collect();
        IntensityDistribution::from_grid(vec![0.0, 360.0], gammas, vec![plane.clone(), plane]).expect("valid")
    }

    /// Catches: cones by angle instead of solid angle. A Lambertian emitter has 1 − cos²: 7/16, 3/4, 15/16.
    #[test]
    fn flux_code_of_a_lambertian_emitter() {
        let code = cie_code(&IntensityDistribution::lambert(Lumens(1000.0)), Some(0.8)).expect("defined");
        for (found, expected) in code.into_iter().zip([43.75, 75.0, 93.75, 100.0, 80.0]) {
            assert!((found - expected).abs() < 1e-9, "{code:?}");
        }
        assert!(cie_code(&IntensityDistribution::isotropic(Lumens(1.0)), None).is_ok());
    }

    /// Catches: the exact integral reported under the zonal rule's name. For cosγ the rule gives
    /// π Σ (cos²γ_i − cos²γ_{i+1}) = π, whatever the step.
    #[test]
    fn zonal_rule_is_its_own_figure() {
        for step in [5, 10, 30] {
            let d = cosine(step);
            assert!((zonal_rule(&d).0 - 1000.0 * std::f64::consts::PI).abs() < 1e-6);
            assert!(d.flux().0 < 1000.0 * std::f64::consts::PI);
        }
    }

    /// Catches: a zone counted twice or left out.
    #[test]
    fn zones_add_up() {
        let d = cosine(5);
        assert!((zones_lm(&d).iter().sum::<f64>() - d.flux().0).abs() < 1e-9 * d.flux().0);
    }
}
