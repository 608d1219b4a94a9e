//! Veiling luminance: the stray light in the eye that lies like a veil over what is looked at. All
//! forms take the illuminance at the eye and the angle from the line of sight, in degrees.

use super::source::{AtAngle, Sight};
use crate::units::Undefined;

/// Angles for which the forms hold, degrees: general, age-adjusted, Stiles–Holladay.
pub(super) const VALID_DEG: [[f64; 2]; 3] = [[0.1, 100.0], [3.0, 30.0], [3.0, 30.0]];

/// Age of the observer where none is given, years.
pub const USUAL_AGE: f64 = 25.0;

fn age(sight: &Sight) -> f64 {
    sight.given.age_years.unwrap_or(USUAL_AGE)
}

/// Share of the light from which on it is told that a form does not hold for it.
const TOLD: f64 = 1e-3;

/// L_v = Σ E {10/θ³ + [5/θ² + 0.1 p/θ] [1 + (A/62.5)⁴] + 0.0025 p}, cd/m², CIE 146:2002, general
/// disability glare equation; A: age, p: eye pigment. 0 without sources.
///
/// # Errors
/// A source within 0.1° of the line of sight.
pub fn general(sight: &Sight) -> Result<f64, Undefined> {
    let (age, pigment) = (age(sight), sight.given.pigment);
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
    let aged = 1.0 + (age(sight) / 70.0).powi(4);
    over_sources(sight, VALID_DEG[0][0], |theta| 10.0 * aged / (theta * theta))
}

/// L_v = Σ 10 E/θ², cd/m², Stiles and Holladay; that of evalglare, CIE 112 and CIE 31.
///
/// # Errors
/// A source within 0.1° of the line of sight.
pub fn stiles_holladay(sight: &Sight) -> Result<f64, Undefined> {
    over_sources(sight, VALID_DEG[0][0], |theta| 10.0 / (theta * theta))
}

/// Keys of the indices that weigh light by its angle, so that sources count in parts.
pub const STRAYED: [&str; 5] = ["L_veil", "L_veil_age", "L_veil_SH", "GR", "f_TI"];

/// Σ E k(θ). Of a source that covers the line of sight, what lies within 0.1° of it is what is looked at: it does not
/// stray, and no form holds there. A source of which no more is known than that it lies there has no veil.
pub(super) fn over_sources(
    sight: &Sight,
    least_deg: f64,
    kernel: impl Fn(f64) -> f64,
) -> Result<f64, Undefined> {
    let mut sum = 0.0;
    for light in sight.by_angle() {
        if light.off_axis_deg >= least_deg {
            sum += light.eye_lx * kernel(light.off_axis_deg);
        } else if !light.is_part {
            return Err(Undefined::because("a source lies within 0.1° of the line of sight"));
        }
    }
    Ok(sum)
}

fn outside(sight: &Sight, [least, most]: [f64; 2]) -> Vec<String> {
    let all = sight.by_angle();
    let out = |light: &&AtAngle| !(least..=most).contains(&light.off_axis_deg);
    let mut notes = Vec::new();
    let count = all.iter().filter(|light| !light.is_part).filter(out).count();
    if count > 0 {
        notes.push(format!("{count} source(s) outside {least}° to {most}°, where the form holds"));
    }
    let parts = || all.iter().filter(|light| light.is_part);
    let lx = |light: &AtAngle| light.eye_lx;
    let (beyond, whole) = (parts().filter(out).map(lx).sum::<f64>(), parts().map(lx).sum::<f64>());
    if beyond > TOLD * whole {
        let percent = 100.0 * beyond / whole;
        notes.push(format!(
            "{percent:.1} % of the light of sources that count in parts lies outside {least}° to {most}°, where the form holds"
        ));
    }
    if parts().any(|light| light.off_axis_deg < VALID_DEG[0][0]) {
        notes.push("what a source shows within 0.1° of the line of sight is looked at, does not stray and is left out".into());
    }
    notes
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
