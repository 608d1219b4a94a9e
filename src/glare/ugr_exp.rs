//! UGR_exp, the experimental form for large daylight sources: linear in the sources' luminance.

use super::source::{Sight, eye_illuminance, luminance, positioned_sum, positive};
use crate::units::Undefined;

/// UGR_exp = 8 lg L_a + 8 lg(Σ(Lω/P²)/L_b), L_a = E_v/π, Fisekis and Davies 2003; L_b is always
/// (E_v − E_dir)/π here, whatever other indices take.
///
/// # Errors
/// No source shines, or there is no light at the eye beside the sources.
pub fn ugr_experimental(sight: &Sight) -> Result<f64, Undefined> {
    let sum = positioned_sum(&sight.sources, 2, |source| Ok(luminance(source)? * source.solid_angle_sr))?;
    let pi = std::f64::consts::PI;
    let background = positive(sight.e_indirect_lx() / pi, "the background luminance is not positive")?;
    Ok(8.0 * (eye_illuminance(sight)? / pi).log10() + 8.0 * (sum / background).log10())
}
