//! The discomfort index M of older Russian norms, from UGR. M is not a blinding index P, which has no
//! such relation.

/// M = 10^((UGR + 4.8)/16), the inverse of UGR = 16 lg M − 4.8 (GOST 33392, SP 52.13330).
pub fn index_m(ugr: f64) -> f64 {
    10f64.powf((ugr + 4.8) / 16.0)
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
