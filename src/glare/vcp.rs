//! Visual comfort probability and the discomfort glare rating behind it, North America's method.
//! The exponent falls with the number of sources, so splitting one source in two changes the value.

use statrs::function::erf::erf;

use super::source::{GlareSource, Sight, luminance, positive};
use crate::units::Undefined;

/// Why there is no index where F is not known.
pub const NO_MEAN: &str = "the mean luminance of the field of view is not known";

/// DGR above which nobody is comfortable, and below which all are.
pub const DGR_RANGE: [f64; 2] = [20.0, 750.0];

/// DGR = [Σ 0.5 L Q/(P F^0.44)]^(n^−0.0914), Q = 20.4 ω + 1.52 ω^0.2 − 0.075; F: mean luminance of
/// the field of view, cd/m². Guth 1963, IES RQQ 1966. 0 without sources.
///
/// # Errors
/// The mean luminance is not known or not positive, a source has no position index or luminance.
pub fn dgr(sight: &Sight) -> Result<f64, Undefined> {
    if sight.sources.is_empty() {
        return Ok(0.0);
    }
    let mean = sight.mean.ok_or_else(|| Undefined::because(NO_MEAN))?;
    let field = positive(mean.0, "the field of view is dark")?;
    let mut sum = 0.0;
    for source in &sight.sources {
        let position = positive(source.position_index, "a source has no valid position index")?;
        sum += 0.5 * luminance(source)? * size_factor(source) / (position * field.powf(0.44));
    }
    Ok(sum.max(0.0).powf((sight.sources.len() as f64).powf(-0.0914)))
}

/// Q, which is negative below 3e-7 sr: such a source is a point and counts nothing.
fn size_factor(source: &GlareSource) -> f64 {
    let size_sr = source.solid_angle_sr;
    (20.4 * size_sr + 1.52 * size_sr.powf(0.2) - 0.075).max(0.0)
}

/// VCP = 50 erf[(6.374 − 1.3227 ln DGR)/√2] + 50, %; 0 above DGR 750, 100 below DGR 20.
///
/// # Errors
/// As for [`dgr`].
pub fn vcp(sight: &Sight) -> Result<f64, Undefined> {
    let rating = dgr(sight)?;
    let [comfortable, unbearable] = DGR_RANGE;
    Ok(if rating > unbearable {
        0.0
    } else if rating < comfortable {
        100.0
    } else {
        50.0 * erf((6.374 - 1.3227 * rating.ln()) / std::f64::consts::SQRT_2) + 50.0
    })
}

/// What makes VCP doubtful here: always the same.
pub fn validity(sight: &Sight) -> Vec<String> {
    if sight.sources.is_empty() {
        return Vec::new();
    }
    vec!["VCP was made for lensed ceiling luminaires of uniform luminance, not for windows or lamps".into()]
}
