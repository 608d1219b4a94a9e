//! Veiling luminance: the stray light in the eye that lies like a veil over what is looked at. All
//! forms take the illuminance at the eye and the angle from the line of sight, in degrees.

use super::source::Sight;
use crate::units::Undefined;

/// Angles for which the forms hold, degrees: general, age-adjusted, Stiles–Holladay.
const VALID_DEG: [[f64; 2]; 3] = [[0.1, 100.0], [3.0, 30.0], [3.0, 30.0]];

/// L_v = Σ E {10/θ³ + [5/θ² + 0.1 p/θ] [1 + (A/62.5)⁴] + 0.0025 p}, cd/m², CIE 146:2002, general
/// disability glare equation; A: age, p: eye pigment. 0 without sources.
///
/// # Errors
/// A source within 0.1° of the line of sight.
pub fn general(sight: &Sight) -> Result<f64, Undefined> {
    let (age, pigment) = (sight.given.age_years, sight.given.pigment);
    over_sources(sight, VALID_DEG[0][0], |theta| {
        let aged = (5.0 / (theta * theta) + 0.1 * pigment / theta) * (1.0 + (age / 62.5).powi(4));
        10.0 / theta.powi(3) + aged + 0.0025 * pigment
    })
}

/// L_v = Σ 10 E/θ² [1 + (A/70)⁴], cd/m², CIE 146:2002, age-adjusted Stiles–Holladay.
///
/// # Errors
/// A source within 0.1° of the line of sight.
pub fn age_adjusted(sight: &Sight) -> Result<f64, Undefined> {
    let aged = 1.0 + (sight.given.age_years / 70.0).powi(4);
    over_sources(sight, VALID_DEG[0][0], |theta| 10.0 * aged / (theta * theta))
}

/// L_v = Σ 10 E/θ², cd/m², Stiles and Holladay; that of evalglare, CIE 112 and CIE 31.
///
/// # Errors
/// A source within 0.1° of the line of sight.
pub fn stiles_holladay(sight: &Sight) -> Result<f64, Undefined> {
    over_sources(sight, VALID_DEG[0][0], |theta| 10.0 / (theta * theta))
}

fn over_sources(sight: &Sight, least_deg: f64, kernel: impl Fn(f64) -> f64) -> Result<f64, Undefined> {
    let mut sum = 0.0;
    for source in &sight.sources {
        if !(source.off_axis_deg >= least_deg) {
            return Err(Undefined::because("a source lies within 0.1° of the line of sight"));
        }
        sum += source.eye_lx * kernel(source.off_axis_deg);
    }
    Ok(sum)
}

fn outside(sight: &Sight, [least, most]: [f64; 2]) -> Vec<String> {
    let angles = sight.sources.iter().map(|source| source.off_axis_deg);
    match angles.filter(|theta| !(least..=most).contains(theta)).count() {
        0 => Vec::new(),
        count => vec![format!("{count} source(s) outside {least}° to {most}°, where the form holds")],
    }
}

/// What makes [`general`] doubtful here.
pub fn validity_general(sight: &Sight) -> Vec<String> {
    outside(sight, VALID_DEG[0])
}

/// What makes [`age_adjusted`] doubtful here.
pub fn validity_age_adjusted(sight: &Sight) -> Vec<String> {
    outside(sight, VALID_DEG[1])
}

/// What makes [`stiles_holladay`] doubtful here.
pub fn validity_stiles_holladay(sight: &Sight) -> Vec<String> {
    outside(sight, VALID_DEG[2])
}
