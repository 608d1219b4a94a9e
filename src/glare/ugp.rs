//! Unified glare probabilities: UGR's sum on the scale of a share of people.

use super::source::{NO_SOURCE, Sight, background, square_sum};
use crate::units::Undefined;

/// UGP = 0.26 lg(0.25/L_b · Σ L²ω/P²), Hirning, Isoardi, Cowling 2014 (open-plan offices).
///
/// # Errors
/// No source shines, or the background is not positive.
pub fn ugp(sight: &Sight) -> Result<f64, Undefined> {
    Ok(0.26 * (0.25 * square_sum(sight)? / background(sight)?).log10())
}

/// UGP2 = [1 + (2/7) (Σ L²ω/P² / L_b)^(−1/5)]^−10, Hirning, Isoardi, Garcia-Hansen 2017: within 0 to
/// 1, and 0 without a source.
///
/// # Errors
/// The background is not positive, or a source is no physical one.
pub fn ugp2(sight: &Sight) -> Result<f64, Undefined> {
    let background = background(sight)?;
    match square_sum(sight) {
        Err(undefined) if undefined.reason == NO_SOURCE => Ok(0.0),
        sum => Ok((1.0 + 2.0 / 7.0 * (sum? / background).powf(-0.2)).powi(-10)),
    }
}

/// What makes UGP doubtful here: a probability must lie within 0 and 1.
pub fn validity(sight: &Sight) -> Vec<String> {
    let outside = ugp(sight).is_ok_and(|value| !(0.0..=1.0).contains(&value));
    let note = "UGP lies outside 0 to 1: beyond the offices it was fitted to";
    if outside { vec![note.into()] } else { Vec::new() }
}
