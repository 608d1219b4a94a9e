//! Daylight glare probability: the brightness of the whole view counts beside the contrast of its
//! sources, so a view without a source has a value too.

use super::source::{DgpForm, NO_SOURCE, Sight, eye_illuminance, square_sum};
use crate::units::Undefined;

/// Values and illuminances (lx) for which DGP was fitted, Wienold and Christoffersen 2006.
pub const VALID: [f64; 2] = [0.2, 0.8];
/// Illuminance at the eye from which on DGP was fitted, lx.
pub const VALID_FROM_LX: f64 = 380.0;
/// Illuminance at the eye from which on the low-light factor is left out, lx: it is 1 − 2e-9 there.
const LOW_LIGHT_BELOW_LX: f64 = 1000.0;

/// DGP = 5.87e-5 E_v + a lg(1 + Σ L²ω/(E_v^1.87 P²)) + b, at most 1; Wienold and Christoffersen 2006:
/// a = 0.0918, b = 0.16; evalglare: a = 0.092, b = 0.159. Low-light factor, if asked for:
/// e^(0.024 E_v − 4)/(1 + e^(0.024 E_v − 4)). Without a source the logarithm is 0.
///
/// # Errors
/// E_v is not positive, or a source is no physical one.
pub fn dgp(sight: &Sight) -> Result<f64, Undefined> {
    let e_v_lx = eye_illuminance(sight)?;
    let sum = match square_sum(sight) {
        Err(undefined) if undefined.reason == NO_SOURCE => 0.0,
        sum => sum?,
    };
    let (slope, offset) = match sight.given.dgp {
        DgpForm::Evalglare => (0.092, 0.159),
        DgpForm::Published => (0.0918, 0.16),
    };
    let probability = 5.87e-5 * e_v_lx + slope * (1.0 + sum / e_v_lx.powf(1.87)).log10() + offset;
    Ok((probability * low_light(sight, e_v_lx)).min(1.0))
}

fn low_light(sight: &Sight, e_v_lx: f64) -> f64 {
    if sight.given.low_light && e_v_lx < LOW_LIGHT_BELOW_LX {
        1.0 / (1.0 + (4.0 - 0.024 * e_v_lx).exp())
    } else {
        1.0
    }
}

/// DGPs = 6.22e-5 E_v + 0.184, Wienold 2007: DGP of a view without direct sun or its reflections.
///
/// # Errors
/// E_v is not positive.
pub fn dgp_simplified(sight: &Sight) -> Result<f64, Undefined> {
    Ok((6.22e-5 * eye_illuminance(sight)? + 0.184).min(1.0))
}

/// What makes DGP doubtful here.
pub fn validity(sight: &Sight) -> Vec<String> {
    let mut notes = Vec::new();
    let [least, most] = VALID;
    if sight.e_v_lx < VALID_FROM_LX && !sight.given.low_light {
        notes.push(format!(
            "E_v {:.0} lx is below the {VALID_FROM_LX} lx from which on DGP holds",
            sight.e_v_lx
        ));
    }
    if dgp(sight).is_ok_and(|value| !(least..=most).contains(&value)) {
        notes.push(format!("DGP was fitted between {least} and {most}"));
    }
    notes
}

/// Glare classes by which EN 17037 recommends levels of protection: DGP 0.35, 0.40, 0.45.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DgpClass {
    /// At most 0.35: mostly not perceived.
    Imperceptible,
    /// At most 0.40: perceived, mostly not disturbing.
    Perceptible,
    /// At most 0.45: often disturbing.
    Disturbing,
    /// Above 0.45.
    Intolerable,
}

impl DgpClass {
    /// The class of a value.
    pub fn of(dgp: f64) -> Self {
        match dgp {
            x if x <= 0.35 => Self::Imperceptible,
            x if x <= 0.40 => Self::Perceptible,
            x if x <= 0.45 => Self::Disturbing,
            _ => Self::Intolerable,
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Imperceptible => "imperceptible (DGP <= 0.35, EN 17037 high)",
            Self::Perceptible => "perceptible (DGP <= 0.40, EN 17037 medium)",
            Self::Disturbing => "disturbing (DGP <= 0.45, EN 17037 minimum)",
            Self::Intolerable => "intolerable (DGP > 0.45)",
        }
    }
}
