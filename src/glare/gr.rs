//! Glare rating for outdoor areas and sports. It weighs angles, not position indices, and every
//! luminaire counts, near the line of sight most.

use super::source::{Sight, positive};
use super::veiling::stiles_holladay;
use crate::units::Undefined;

/// Why there is no GR where nobody says what is illuminated.
pub const NO_GROUND: &str = "the ground's reflectance and mean horizontal illuminance are not given";

/// GR = 27 + 24 lg(L_vl/L_ve^0.9), CIE 112:1994; L_vl = 10 Σ E_eye/θ² from the luminaires, L_ve =
/// 0.035 ρ E_hav/π from the ground.
///
/// # Errors
/// The ground is not given, or no source shines.
pub fn glare_rating(sight: &Sight) -> Result<f64, Undefined> {
    let ground = sight.given.ground.ok_or_else(|| Undefined::because(NO_GROUND))?;
    let from_luminaires = positive(stiles_holladay(sight)?, super::source::NO_SOURCE)?;
    let environment = 0.035 * ground.reflectance * ground.mean_lx / std::f64::consts::PI;
    let environment = positive(environment, "the ground is dark")?;
    Ok(27.0 + 24.0 * (from_luminaires / environment.powf(0.9)).log10())
}

/// What makes GR doubtful here: CIE 112 has it for lines of sight below eye level only.
pub fn validity(sight: &Sight) -> Vec<String> {
    let near = sight.sources.iter().filter(|source| source.off_axis_deg < 1.5).count();
    if near == 0 {
        return Vec::new();
    }
    vec![format!("{near} source(s) nearer than 1.5° to the line of sight, where 10 E/θ² does not hold")]
}
