//! CIE glare index of Einhorn, the ancestor of UGR; it takes the *total* illuminance at the eye.

use super::source::{Sight, eye_illuminance, square_sum};
use crate::units::Undefined;

/// CGI = 8 lg[2 (1 + E_dir/500)/E_v · Σ L²ω/P²], Einhorn 1979, CIE 55:1983; E in lx on the plane of
/// the eye.
///
/// # Errors
/// No source shines, or E_v is not positive.
pub fn cgi(sight: &Sight) -> Result<f64, Undefined> {
    let sum = square_sum(sight)?;
    Ok(8.0 * (2.0 * (1.0 + sight.e_direct_lx / 500.0) / eye_illuminance(sight)? * sum).log10())
}
