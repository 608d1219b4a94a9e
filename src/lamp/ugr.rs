//! The UGR table of one file, for the flux that its intensities add up to.

use crate::glare::ugr_table::{TableInput, UgrTable, table};
use crate::photometry::Photometry;
use crate::units::Undefined;

/// The table of CIE 117 and CIE 190 at a spacing-to-height ratio; see [`crate::glare::ugr_table`].
///
/// # Errors
/// The luminaire is none that the method was made for, it has no luminous area, or the ratio is not
/// 1/n.
pub fn ugr_table(photometry: &Photometry, shr: f64) -> Result<UgrTable, Undefined> {
    let distribution = &photometry.distribution;
    if !(photometry.opening.area_m2() > 0.0) {
        return Err(Undefined::because(
            "no luminous area, so no luminance and no UGR; see `gershun explain zero-area`",
        ));
    }
    let input = TableInput {
        intensity_cd: &|direction| distribution.intensity_along(direction),
        projected_area_m2: &|direction| photometry.opening.projected_area_m2(direction),
        zonal_flux_lm: &|from, to| distribution.zonal_flux(from, to).0,
        flux_lm: distribution.flux().0,
    };
    table(&input, shr)
}
