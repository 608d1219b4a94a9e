//! Great-room glare rating: UGR carried over to sources that fill much of the ceiling. It is the only
//! form of UGR that asks how much of the ceiling shines.

use super::source::{Sight, positive};
use super::ugr::ugr_by_luminance;
use crate::units::Undefined;

/// Share of the ceiling for which GGR was made, CIE 147.
pub const VALID_COVERAGE: [f64; 2] = [0.15, 1.0];

/// GGR = UGR + (1.18 − 0.18/CC) · 8 lg[2.55 (1 + E_d/220)/(1 + E_d/E_i)], CIE 147:2002; CC: share of
/// the ceiling that shines, E_d and E_i: direct and indirect illuminance at the eye, lx.
///
/// # Errors
/// As for UGR; CC is not given or not within 0 to 1; no indirect light.
pub fn ggr(sight: &Sight) -> Result<f64, Undefined> {
    let coverage = sight
        .given
        .ceiling_coverage
        .filter(|coverage| *coverage > 0.0 && *coverage <= 1.0)
        .ok_or_else(|| Undefined::because("the share of the ceiling that shines is not given"))?;
    let ugr = ugr_by_luminance(&sight.sources, sight.background)?;
    let indirect_lx = positive(sight.e_indirect_lx(), "there is no indirect light at the eye")?;
    let direct_lx = sight.e_direct_lx;
    let gain = 2.55 * (1.0 + direct_lx / 220.0) / (1.0 + direct_lx / indirect_lx);
    Ok(ugr + (1.18 - 0.18 / coverage) * 8.0 * gain.log10())
}

/// What makes GGR doubtful here.
pub fn validity(sight: &Sight) -> Vec<String> {
    let [least, most] = VALID_COVERAGE;
    let doubtful = sight.given.ceiling_coverage.filter(|coverage| !(least..=most).contains(coverage));
    doubtful
        .map(|coverage| format!("a ceiling coverage of {coverage} lies outside {least} to {most}"))
        .into_iter()
        .collect()
}
