//! Great-room glare rating: UGR carried over to sources that fill much of the ceiling. It is the only
//! form of UGR that asks how much of the ceiling shines.

use super::source::{Sight, positive};
use super::ugr::ugr_by_luminance;
use crate::units::Undefined;

/// Why there is no GGR where nobody says how much of the ceiling shines.
pub const NO_COVERAGE: &str = "the share of the ceiling that shines is not given";

/// Share of the ceiling for which GGR was made, CIE 147.
pub const VALID_COVERAGE: [f64; 2] = [0.15, 1.0];

/// GGR = UGR + (1.18 − 0.18/CC) · 8 lg[2.55 (1 + E_d/220)/(1 + E_d/E_i)], CIE 147:2002; CC: share of
/// the ceiling that shines, E_d and E_i: direct and indirect illuminance at the eye, lx.
///
/// # Errors
/// As for UGR; CC is not given or outside of [`VALID_COVERAGE`]: below it the formula falls without end where CIE 147
/// has UGR; no indirect light.
pub fn ggr(sight: &Sight) -> Result<f64, Undefined> {
    let [least, most] = VALID_COVERAGE;
    let coverage = sight.given.ceiling_coverage.ok_or_else(|| Undefined::because(NO_COVERAGE))?;
    if !(coverage >= least && coverage <= most) {
        return Err(Undefined::because(format!(
            "GGR is made for luminous shares of the ceiling from {least} to {most}, here {coverage:.3}; below them UGR holds"
        )));
    }
    let ugr = ugr_by_luminance(&sight.sources, sight.background)?;
    let indirect_lx = positive(sight.e_indirect_lx(), "there is no indirect light at the eye")?;
    let direct_lx = sight.e_direct_lx;
    let gain = 2.55 * (1.0 + direct_lx / 220.0) / (1.0 + direct_lx / indirect_lx);
    Ok(ugr + (1.18 - 0.18 / coverage) * 8.0 * gain.log10())
}
