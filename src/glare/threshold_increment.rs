//! Threshold increment f_TI: by how many percent a target's contrast must rise to stay visible. It
//! is *disability* glare and knows no position index.

use super::source::{Sight, positive};
use super::veiling::over_sources;
use crate::units::Undefined;

/// Why there is no f_TI where nobody says how bright the road is.
pub const NO_ROAD: &str = "the road's mean luminance L_av is not given";

/// Angles from the line of sight within which a luminaire counts, degrees.
pub const ANGLES_DEG: [f64; 2] = [0.1, 60.0];
/// Age for which EN 13201-3 has f_TI, years: 9.86 [1 + (23/66.4)⁴] = 10.0.
pub const STANDARD_AGE: f64 = 23.0;
/// Below this angle the small-angle form holds, degrees.
const SMALL_ANGLE_DEG: f64 = 1.5;
/// Road luminance above which the other formula holds, cd/m².
const BRIGHT_ROAD: f64 = 5.0;
/// Least road luminance, cd/m².
const DARKEST_ROAD: f64 = 0.05;

/// L_v of EN 13201-3:2015, cd/m²: Σ E_k · 9.86/θ² [1 + (A/66.4)⁴] for 1.5° < θ ≤ 60°, E_k {10/θ³ +
/// 5/θ² [1 + (A/62.5)⁴]} for 0.1° < θ ≤ 1.5°; A: age. Sources farther out do not count.
///
/// # Errors
/// A source within 0.1° of the line of sight.
pub fn veiling_en_13201(sight: &Sight) -> Result<f64, Undefined> {
    let age = sight.given.age_years.unwrap_or(STANDARD_AGE);
    over_sources(sight, ANGLES_DEG[0], |theta| {
        if theta <= SMALL_ANGLE_DEG {
            10.0 / theta.powi(3) + 5.0 / (theta * theta) * (1.0 + (age / 62.5).powi(4))
        } else if theta <= ANGLES_DEG[1] {
            9.86 / (theta * theta) * (1.0 + (age / 66.4).powi(4))
        } else {
            0.0
        }
    })
}

/// f_TI = 65 L_v/L_av^0.8 for 0.05 < L_av ≤ 5 cd/m², 95 L_v/L_av^1.05 above, %; EN 13201-3:2015.
///
/// # Errors
/// The road's luminance is not given or not above 0.05 cd/m², or as [`veiling_en_13201`].
pub fn threshold_increment(sight: &Sight) -> Result<f64, Undefined> {
    let road = sight.given.road.ok_or_else(|| Undefined::because(NO_ROAD))?;
    let road = positive(road.0, "the road is dark")?;
    if !(road > DARKEST_ROAD) {
        return Err(Undefined::because("f_TI is defined above a road luminance of 0.05 cd/m² only"));
    }
    let veiling = veiling_en_13201(sight)?;
    Ok(if road <= BRIGHT_ROAD { 65.0 * veiling / road.powf(0.8) } else { 95.0 * veiling / road.powf(1.05) })
}

/// What makes f_TI doubtful here.
pub fn validity(sight: &Sight) -> Vec<String> {
    let far = sight.sources.iter().filter(|source| source.off_axis_deg > ANGLES_DEG[1]).count();
    if far == 0 { Vec::new() } else { vec![format!("{far} source(s) beyond 60° are left out")] }
}
