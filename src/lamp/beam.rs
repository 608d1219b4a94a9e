//! Beam and field angle: the full angle in a plane within which the intensity stays above 50 % and
//! 10 % of the plane's largest. The largest need not lie at nadir: the angle is counted from where
//! it is, to both sides.

use crate::photometry::IntensityDistribution;
use crate::units::Undefined;

/// Share of the largest intensity that bounds the beam.
pub const BEAM: f64 = 0.5;
/// Share of the largest intensity that bounds the field.
pub const FIELD: f64 = 0.1;

/// Full angle in degrees around the largest intensity of a plane (azimuth and azimuth + 180°) in
/// which the intensity exceeds `share` of it.
///
/// # Errors
/// No light in this plane, or the intensity falls nowhere below the share.
pub fn angle_deg(
    distribution: &IntensityDistribution,
    azimuth_deg: f64,
    share: f64,
) -> Result<f64, Undefined> {
    let profile = profile(distribution, azimuth_deg);
    let first_peak =
        (0..profile.len()).fold(0, |best, k| if profile[k].1 > profile[best].1 { k } else { best });
    let (at, largest) = profile[first_peak];
    if !(largest > 0.0) {
        return Err(Undefined::because("no light in this plane"));
    }
    let (count, limit) = (profile.len(), share * largest);
    // To one side: `step` is 1 or count − 1, the way back around.
    let reach = |step: usize, sign: f64| {
        let mut here = first_peak;
        for _ in 0..count {
            let next = (here + step) % count;
            let ((from_deg, from_cd), (to_deg, to_cd)) = (profile[here], profile[next]);
            if to_cd < limit {
                let width = (sign * (to_deg - from_deg)).rem_euclid(360.0);
                let part = (from_cd - limit) / (from_cd - to_cd);
                return Some((sign * (from_deg - at)).rem_euclid(360.0) + part * width);
            }
            here = next;
        }
        None
    };
    match (reach(1, 1.0), reach(count - 1, -1.0)) {
        (Some(right), Some(left)) => Ok(right + left),
        _ => Err(Undefined::because(format!(
            "the intensity falls nowhere below {:.0} % of the largest in this plane",
            100.0 * share
        ))),
    }
}

/// (angle, cd) once around the plane: γ in the half-plane, 360° − γ in the opposite one. Outside the
/// tabulated range the intensity is 0, which is a step at the range's end.
fn profile(distribution: &IntensityDistribution, azimuth_deg: f64) -> Vec<(f64, f64)> {
    let analytic: Vec<f64> = (0..=360).map(|k| 0.5 * f64::from(k)).collect();
    let gammas = distribution.grid().map_or(&analytic[..], |(_, gammas)| gammas);
    let half = |turn: f64| -> Vec<(f64, f64)> {
        let value = |gamma: &f64| (*gamma, distribution.intensity_at(azimuth_deg + turn, *gamma));
        let mut half: Vec<(f64, f64)> = gammas.iter().map(value).collect();
        if let Some(&(first, _)) = half.first().filter(|(first, _)| *first > 0.0) {
            half.insert(0, (first, 0.0));
        }
        if let Some(&(last, _)) = half.last().filter(|(last, _)| *last < 180.0) {
            half.push((last, 0.0));
        }
        half
    };
    let opposite = half(180.0).into_iter().rev().map(|(gamma, cd)| (360.0 - gamma, cd));
    half(0.0).into_iter().chain(opposite).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Lumens;

    fn grid(gammas: &[f64], front: &[f64], back: &[f64]) -> IntensityDistribution {
        let planes = vec![front.to_vec(), back.to_vec(), front.to_vec()];
        IntensityDistribution::from_grid(vec![0.0, 180.0, 360.0], gammas.to_vec(), planes).expect("valid")
    }

    fn angle(d: &IntensityDistribution, share: f64) -> f64 {
        angle_deg(d, 0.0, share).expect("defined")
    }

    /// Catches: half of the angle, or 50 % of the value at nadir instead of the largest.
    #[test]
    fn known_beams() {
        let lambert = IntensityDistribution::lambert(Lumens(1000.0));
        assert!((angle(&lambert, BEAM) - 120.0).abs() < 0.01);
        let spot = grid(&[0.0, 10.0, 20.0, 90.0], &[100.0, 50.0, 0.0, 0.0], &[100.0, 50.0, 0.0, 0.0]);
        assert!((angle(&spot, BEAM) - 20.0).abs() < 1e-9);
        assert!((angle(&spot, FIELD) - 36.0).abs() < 1e-9);
        let tilted = grid(&[0.0, 20.0, 40.0, 90.0], &[40.0, 100.0, 0.0, 0.0], &[40.0, 0.0, 0.0, 0.0]);
        assert!((angle(&tilted, BEAM) - (30.0 - 10.0 / 3.0)).abs() < 1e-9);
    }

    /// Catches: an upward beam cut at the zenith, a table's end extrapolated, an isotropic "beam".
    #[test]
    fn zenith_and_ends() {
        let up = grid(&[90.0, 160.0, 180.0], &[0.0, 50.0, 100.0], &[0.0, 50.0, 100.0]);
        assert!((angle(&up, BEAM) - 40.0).abs() < 1e-9);
        let cut = grid(&[0.0, 30.0], &[100.0, 80.0], &[100.0, 80.0]);
        assert!((angle(&cut, BEAM) - 60.0).abs() < 1e-9);
        assert!(angle_deg(&IntensityDistribution::isotropic(Lumens(1.0)), 0.0, BEAM).is_err());
    }
}
