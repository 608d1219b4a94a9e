//! The discomfort index M of older Russian norms, on the scale on which they bound it. It is not
//! measured on its own here: it is UGR by another name. M is not a blinding index P, which has no such
//! relation.

use super::source::Sight;
use super::ugr::ugr;
use crate::units::Undefined;

/// M = 10^((UGR + 4.8)/16), from UGR = 16 lg M − 4.8 (GOST 33392, SP 52.13330), the relation by which
/// Russian practice carries limits of M over to UGR. Since 8 lg 0.25 = −4.82 this is M = (Σ L²ω/P² / L_b)^0.5.
/// The older method itself weighs positions by a table of its own; that table is not computed.
pub fn index_m(ugr: f64) -> f64 {
    10f64.powf((ugr + 4.8) / 16.0)
}

/// [`index_m`] of what an observer sees.
///
/// # Errors
/// As for [`ugr`].
pub fn discomfort_m(sight: &Sight) -> Result<f64, Undefined> {
    Ok(index_m(ugr(&sight.sources, sight.background)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_steps_of_m_are_those_of_ugr() {
        for (ugr, m) in [(14.0, 15.0), (18.0, 25.0), (21.0, 40.0), (24.0, 60.0), (26.5, 90.0)] {
            let back = 16.0 * f64::log10(m) - 4.8;
            assert!((back - ugr).abs() < 0.5, "M {m}: {back}");
            assert!((index_m(back) - m).abs() < 1e-9 * m);
        }
    }
}
