//! Spacing criterion of the IES: how far luminaires may stand apart, in mounting heights, before
//! the floor between them receives less than the floor below one of them from that one alone.

use std::f64::consts::SQRT_2;

use crate::photometry::IntensityDistribution;
use crate::units::Undefined;

/// Spacing over mounting height.
#[derive(Clone, Debug, PartialEq)]
pub struct Spacing {
    /// Rows next to each other across the length (C0): two luminaires, each half of the nadir value.
    pub across: Result<f64, Undefined>,
    /// Along the length (C90).
    pub along: Result<f64, Undefined>,
    /// Four luminaires at the corners of a square, each a quarter of the nadir value.
    pub diagonal: Result<f64, Undefined>,
}

/// The two-luminaire criterion in both planes, 2 tanγ with I(γ) cos³γ = I(0)/2, and the
/// four-luminaire one, √2 tanγ with I(γ) cos³γ = I(0)/4 at 45°; IES Lighting Handbook.
pub fn criterion(distribution: &IntensityDistribution) -> Spacing {
    let smaller = |azimuths: &[f64], share: f64, factor: f64| {
        let ratios = azimuths.iter().map(|azimuth| ratio(distribution, *azimuth, share, factor));
        ratios.reduce(|a, b| Ok(a?.min(b?))).unwrap_or_else(|| Err(Undefined::because("no planes")))
    };
    Spacing {
        across: smaller(&[90.0, 270.0], 0.5, 2.0),
        along: smaller(&[0.0, 180.0], 0.5, 2.0),
        diagonal: smaller(&[45.0, 135.0, 225.0, 315.0], 0.25, SQRT_2),
    }
}

fn ratio(
    distribution: &IntensityDistribution,
    azimuth_deg: f64,
    share: f64,
    factor: f64,
) -> Result<f64, Undefined> {
    const STEP_DEG: f64 = 0.25;
    let relative = |gamma_deg: f64| {
        distribution.intensity_at(azimuth_deg, gamma_deg) * gamma_deg.to_radians().cos().powi(3)
    };
    let limit = share * relative(0.0);
    if !(limit > 0.0) {
        return Err(Undefined::because("no light at nadir"));
    }
    let below = |k: &i32| relative(STEP_DEG * f64::from(*k)) < limit;
    let Some(first) = (1..360).find(below) else {
        return Err(Undefined::because("the illuminance does not fall towards the horizon"));
    };
    let (mut low, mut high) = (STEP_DEG * f64::from(first - 1), STEP_DEG * f64::from(first));
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if relative(middle) < limit { high = middle } else { low = middle }
    }
    Ok(factor * low.to_radians().tan())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Lumens;

    /// Catches: cos² or cos⁴ for cos³, tanγ for 2 tanγ. Lambertian: cos⁴γ = 1/2 and 1/4.
    #[test]
    fn closed_form_of_a_lambertian_emitter() {
        let spacing = criterion(&IntensityDistribution::lambert(Lumens(1000.0)));
        let expected = |share: f64, factor: f64| factor * share.powf(0.25).acos().tan();
        for (found, truth) in [
            (spacing.across, expected(0.5, 2.0)),
            (spacing.along, expected(0.5, 2.0)),
            (spacing.diagonal, expected(0.25, SQRT_2)),
        ] {
            assert!((found.expect("defined") - truth).abs() < 1e-9);
        }
    }
}
