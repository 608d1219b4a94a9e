//! The discomfort index M of older Russian norms, on the scale on which they bound it. It is not
//! measured on its own here: it is UGR by another name, M = 10^((UGR + 4.8)/16).

use super::source::Sight;
use super::ugr::ugr;
use crate::units::Undefined;

/// M = 10^((UGR + 4.8)/16), from UGR = 16 lg M − 4.8, the relation by which Russian practice carries
/// limits of M over to UGR. Since 8 lg 0.25 = −4.82 this is M = (Σ L²ω/P² / L_b)^0.5. The older method
/// itself weighs positions by a table of its own; that table is not computed.
///
/// # Errors
/// As for [`ugr`].
pub fn discomfort_m(sight: &Sight) -> Result<f64, Undefined> {
    Ok(10f64.powf((ugr(&sight.sources, sight.background)? + 4.8) / 16.0))
}
