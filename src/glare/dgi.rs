//! Daylight glare index for large sources. The position index enters through the solid angle,
//! Ω = ω/P², not through the luminance.

use super::source::{Sight, background, eye_illuminance, luminance, positioned_sum};
use crate::units::Undefined;

/// Solid angles (sr) from which on a source is a window to DGI; Chauvel, Collins, Dogniaux 1982.
pub const VALID_FROM_SR: f64 = 0.01;

/// DGI = 10 lg Σ 0.478 L^1.6 Ω^0.8/(L_b + 0.07 ω^0.5 L), Ω = ω/P²; Hopkinson 1972, Chauvel 1982.
///
/// # Errors
/// No source shines, or the background is not positive.
pub fn dgi(sight: &Sight) -> Result<f64, Undefined> {
    against(sight, background(sight)?)
}

/// DGI_mod: DGI with (E_v/π)^0.85 in place of L_b, Fisekis, Davies, Kolokotroni, Langford 2003.
///
/// # Errors
/// No source shines, or E_v is not positive.
pub fn dgi_modified(sight: &Sight) -> Result<f64, Undefined> {
    against(sight, (eye_illuminance(sight)? / std::f64::consts::PI).powf(0.85))
}

fn against(sight: &Sight, adaptation: f64) -> Result<f64, Undefined> {
    // Ω^0.8 holds P^−1.6, so the sum here is taken without a power of P.
    let sum = positioned_sum(&sight.sources, 0, |source| {
        let luminance = luminance(source)?;
        let seen_sr = source.solid_angle_sr / (source.position_index * source.position_index);
        let contrast = adaptation + 0.07 * source.solid_angle_sr.sqrt() * luminance;
        Ok(0.478 * luminance.powf(1.6) * seen_sr.powf(0.8) / contrast)
    })?;
    Ok(10.0 * sum.log10())
}

/// What makes DGI doubtful here.
pub fn validity(sight: &Sight) -> Vec<String> {
    let small = sight.sources.iter().filter(|source| source.solid_angle_sr < VALID_FROM_SR).count();
    if small == 0 {
        return Vec::new();
    }
    vec![format!("{small} source(s) under {VALID_FROM_SR} sr; DGI was made for windows")]
}
