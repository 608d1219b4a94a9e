//! Guth's position index P: how much a source disturbs less, the farther it is from the line of
//! sight. Two models live side by side, the table of CIE 117 (norm UGR) and Levin's formula
//! (luminance images); they differ by up to 10 %, 0.7 UGR, so a result must name its model.

use glam::DVec3;

use crate::units::Undefined;

/// Largest P that Levin's formula may return.
pub const LEVIN_CAP: f64 = 16.0;

/// Step of the table in H/R and in T/R.
const STEP: f64 = 0.1;

/// Largest T/R of the table.
const T_OVER_R_MAX: f64 = 3.0;

/// Rounding allowed before a source at eye level counts as below the line of sight.
const LEVEL: f64 = 1e-9;

/// P of CIE 117:1995, table 4.1: one row per T/R = 0.0, 0.1 … 3.0, one value per H/R = 0.0, 0.1 …
/// The void cells all lie at the ends of the rows, so a short row is a row with void cells. The
/// value 7.50 at T/R 2.7, H/R 0.6 stands as printed though it breaks the order of its neighbours.
#[rustfmt::skip]
const TABLE: [&[f64]; 31] = [
    &[1.00, 1.26, 1.53, 1.90, 2.35, 2.86, 3.50, 4.20, 5.00, 6.00, 7.00, 8.10, 9.25, 10.35, 11.70, 13.15, 14.70, 16.20],
    &[1.05, 1.22, 1.46, 1.80, 2.20, 2.75, 3.40, 4.10, 4.80, 5.80, 6.80, 8.00, 9.10, 10.30, 11.60, 13.00, 14.60, 16.10],
    &[1.12, 1.30, 1.50, 1.80, 2.20, 2.66, 3.18, 3.88, 4.60, 5.50, 6.50, 7.60, 8.75, 9.85, 11.20, 12.70, 14.00, 15.70],
    &[1.22, 1.38, 1.60, 1.97, 2.25, 2.70, 3.25, 3.90, 4.60, 5.45, 6.45, 7.40, 8.40, 9.50, 10.85, 12.10, 13.70, 15.00],
    &[1.32, 1.47, 1.70, 1.96, 2.35, 2.80, 3.30, 3.90, 4.60, 5.40, 6.40, 7.30, 8.30, 9.40, 10.60, 11.90, 13.20, 14.60, 16.00],
    &[1.43, 1.60, 1.82, 2.10, 2.48, 2.91, 3.40, 3.98, 4.70, 5.50, 6.40, 7.30, 8.30, 9.40, 10.50, 11.75, 13.00, 14.40, 15.70],
    &[1.55, 1.72, 1.98, 2.30, 2.65, 3.10, 3.60, 4.10, 4.80, 5.50, 6.40, 7.35, 8.40, 9.40, 10.50, 11.70, 13.00, 14.10, 15.40],
    &[1.70, 1.88, 2.12, 2.48, 2.87, 3.30, 3.78, 4.30, 4.88, 5.60, 6.50, 7.40, 8.50, 9.50, 10.50, 11.70, 12.85, 14.00, 15.20],
    &[1.82, 2.00, 2.32, 2.70, 3.08, 3.50, 3.92, 4.50, 5.10, 5.75, 6.60, 7.50, 8.60, 9.50, 10.60, 11.75, 12.80, 14.00, 15.10],
    &[1.96, 2.20, 2.54, 2.90, 3.30, 3.70, 4.20, 4.75, 5.30, 6.00, 6.75, 7.70, 8.70, 9.65, 10.75, 11.80, 12.90, 14.00, 15.00, 16.00],
    &[2.11, 2.40, 2.75, 3.10, 3.50, 3.91, 4.40, 5.00, 5.60, 6.20, 7.00, 7.90, 8.80, 9.75, 10.80, 11.90, 12.95, 14.00, 15.00, 16.00],
    &[2.30, 2.55, 2.92, 3.30, 3.72, 4.20, 4.70, 5.25, 5.80, 6.55, 7.20, 8.15, 9.00, 9.90, 10.95, 12.00, 13.00, 14.00, 15.00, 16.00],
    &[2.40, 2.75, 3.12, 3.50, 3.90, 4.35, 4.85, 5.50, 6.05, 6.70, 7.50, 8.30, 9.20, 10.00, 11.02, 12.10, 13.10, 14.00, 15.00, 16.00],
    &[2.55, 2.90, 3.30, 3.70, 4.20, 4.65, 5.20, 5.70, 6.30, 7.00, 7.70, 8.55, 9.35, 10.20, 11.20, 12.25, 13.20, 14.00, 15.00, 16.00],
    &[2.70, 3.10, 3.50, 3.90, 4.35, 4.85, 5.35, 5.85, 6.50, 7.25, 8.00, 8.70, 9.50, 10.40, 11.40, 12.40, 13.25, 14.05, 15.00, 16.00],
    &[2.85, 3.15, 3.65, 4.10, 4.55, 5.00, 5.50, 6.20, 6.80, 7.50, 8.20, 8.85, 9.70, 10.55, 11.50, 12.50, 13.30, 14.05, 15.02, 16.00],
    &[2.95, 3.40, 3.80, 4.25, 4.75, 5.20, 5.75, 6.30, 7.00, 7.65, 8.40, 9.00, 9.80, 10.80, 11.75, 12.60, 13.40, 14.20, 15.10, 16.00],
    &[3.10, 3.55, 4.00, 4.50, 4.90, 5.40, 5.95, 6.50, 7.20, 7.80, 8.50, 9.20, 10.00, 10.85, 11.85, 12.75, 13.45, 14.20, 15.10, 16.00],
    &[3.25, 3.70, 4.20, 4.65, 5.10, 5.60, 6.10, 6.75, 7.40, 8.00, 8.65, 9.35, 10.10, 11.00, 11.90, 12.80, 13.50, 14.20, 15.10, 16.00],
    &[3.43, 3.86, 4.30, 4.75, 5.20, 5.70, 6.30, 6.90, 7.50, 8.17, 8.80, 9.50, 10.20, 11.00, 12.00, 12.82, 13.55, 14.20, 15.10, 16.00],
    &[3.50, 4.00, 4.50, 4.90, 5.35, 5.80, 6.40, 7.10, 7.70, 8.30, 8.90, 9.60, 10.40, 11.10, 12.00, 12.85, 13.60, 14.30, 15.10, 16.00],
    &[3.60, 4.17, 4.65, 5.05, 5.50, 6.00, 6.60, 7.20, 7.82, 8.45, 9.00, 9.75, 10.50, 11.20, 12.10, 12.90, 13.70, 14.35, 15.10, 16.00],
    &[3.75, 4.25, 4.72, 5.20, 5.60, 6.10, 6.70, 7.35, 8.00, 8.55, 9.15, 9.85, 10.60, 11.30, 12.10, 12.90, 13.70, 14.40, 15.15, 16.00],
    &[3.85, 4.35, 4.80, 5.25, 5.70, 6.22, 6.80, 7.40, 8.10, 8.65, 9.30, 9.90, 10.70, 11.40, 12.20, 12.95, 13.70, 14.40, 15.20, 16.00],
    &[3.95, 4.40, 4.90, 5.35, 5.80, 6.30, 6.90, 7.50, 8.20, 8.80, 9.40, 10.00, 10.80, 11.50, 12.25, 13.00, 13.75, 14.45, 15.20, 16.00],
    &[4.00, 4.50, 4.96, 5.40, 5.85, 6.40, 6.95, 7.55, 8.25, 8.85, 9.50, 10.05, 10.85, 11.55, 12.30, 13.00, 13.80, 14.50, 15.25, 16.00],
    &[4.07, 4.55, 5.05, 5.47, 5.95, 6.46, 7.00, 7.65, 8.35, 8.95, 9.55, 10.10, 10.90, 11.60, 12.32, 13.00, 13.80, 14.50, 15.25, 16.00],
    &[4.10, 4.60, 5.10, 5.53, 6.00, 6.50, 7.50, 7.70, 8.40, 9.00, 9.60, 10.16, 10.92, 11.63, 12.35, 13.00, 13.80, 14.50, 15.25, 16.00],
    &[4.15, 4.62, 5.15, 5.56, 6.05, 6.55, 7.08, 7.73, 8.45, 9.05, 9.65, 10.20, 10.95, 11.65, 12.35, 13.00, 13.80, 14.50, 15.25, 16.00],
    &[4.20, 4.65, 5.17, 5.60, 6.07, 6.57, 7.12, 7.75, 8.50, 9.10, 9.70, 10.23, 10.95, 11.65, 12.35, 13.00, 13.80, 14.50, 15.25, 16.00],
    &[4.22, 4.67, 5.20, 5.65, 6.12, 6.60, 7.15, 7.80, 8.55, 9.12, 9.70, 10.23, 10.95, 11.65, 12.35, 13.00, 13.80, 14.50, 15.25, 16.00],
];

/// P of the CIE 117 table for a source in `direction` (any length), seen along `line_of_sight`.
///
/// R is the source's offset along the line of sight, H the offset along `up` (made perpendicular
/// to the line of sight), T the offset sideways; P is bilinear in H/R and T/R. Outside the table
/// the method ignores a source: behind the eye, T/R > 3, and the void cells. Below the line of
/// sight the table has no values and none are made up by mirroring: a caller that must not lose
/// such a source takes [`levin_iwata`] and says so.
///
/// # Errors
/// The reason why the source is ignored.
pub fn cie117_table(line_of_sight: DVec3, up: DVec3, direction: DVec3) -> Result<f64, Undefined> {
    let Some([h, r, t]) = view_coordinates(line_of_sight, up, direction) else {
        return Err(Undefined::because("the up vector is parallel to the line of sight"));
    };
    if !(r > 0.0) {
        return Err(Undefined::because("the source is not in front of the eye"));
    }
    let h_over_r = h / r;
    if h_over_r < -LEVEL {
        return Err(Undefined::because(
            "the source is below the line of sight, where the CIE 117 table has no values",
        ));
    }
    cie117_at(h_over_r.max(0.0), (t / r).abs())
}

/// P of the CIE 117 table at H/R ≥ 0 and T/R ≥ 0, bilinear.
///
/// # Errors
/// The reason why a source there is ignored.
pub fn cie117_at(h_over_r: f64, t_over_r: f64) -> Result<f64, Undefined> {
    if !(h_over_r >= 0.0 && t_over_r >= 0.0) {
        return Err(Undefined::because("H/R and T/R must not be negative"));
    }
    if t_over_r > T_OVER_R_MAX + LEVEL {
        return Err(Undefined::because("the source is too far to the side for the CIE 117 table (T/R > 3)"));
    }
    let (row, row_part) = cell(t_over_r.min(T_OVER_R_MAX), TABLE.len());
    let (column, column_part) = cell(h_over_r, usize::MAX);
    let mut index = 0.0;
    for (t, t_weight) in [(row, 1.0 - row_part), (row + 1, row_part)] {
        for (h, h_weight) in [(column, 1.0 - column_part), (column + 1, column_part)] {
            let weight = t_weight * h_weight;
            if weight > 0.0 {
                let value = TABLE[t].get(h).ok_or_else(|| {
                    Undefined::because(
                        "the source is too far above the line of sight for the CIE 117 table (void cell)",
                    )
                })?;
                index += weight * value;
            }
        }
    }
    Ok(index)
}

/// Index of the lower table line and the fraction towards the next one; a value within rounding of
/// a line lies on it, so that a void neighbour does not count.
fn cell(ratio: f64, lines: usize) -> (usize, f64) {
    let position = ratio / STEP;
    let nearest = position.round();
    if (position - nearest).abs() < LEVEL {
        return ((nearest as usize).min(lines - 1), 0.0);
    }
    (position.floor() as usize, position.fract())
}

/// P after Levin (1975), the continuous form of Guth's data above the line of sight:
/// P = exp{[35.2 − 0.31889 τ − 1.22 e^(−2τ/9)]·10⁻³ σ + [21 + 0.26667 τ − 0.002963 τ²]·10⁻⁵ σ²},
/// at most [`LEVIN_CAP`]. σ: angle from the line of sight; τ: angle from *vertical up* in the view
/// plane; both in degrees.
pub fn levin(sigma_deg: f64, tau_deg: f64) -> f64 {
    let linear = (35.2 - 0.31889 * tau_deg - 1.22 * (-2.0 * tau_deg / 9.0).exp()) * 1e-3;
    let square = (21.0 + 0.26667 * tau_deg - 0.002963 * tau_deg * tau_deg) * 1e-5;
    (linear * sigma_deg + square * sigma_deg * sigma_deg).exp().min(LEVIN_CAP)
}

/// Which model of P; a result names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PositionModel {
    /// The table of CIE 117, [`cie117_table`]; below the line of sight [`levin_iwata`].
    Table,
    /// [`levin_iwata`] everywhere.
    Levin,
}

/// What a model says of a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Position {
    /// P.
    Index(f64),
    /// P from below the line of sight, where the table has none: Iwata–Osterhaus, to be noted.
    BelowTable(f64),
    /// Where the table has none above the line of sight, and UGR ignores a source: P of [`levin_iwata`] for
    /// the indices that know no table.
    OffTable(f64),
}

impl PositionModel {
    /// In words, for conventions.
    pub fn words(self) -> &'static str {
        match self {
            Self::Table => "position index CIE 117 table (Iwata–Osterhaus below the line of sight)",
            Self::Levin => "position index Levin (Iwata–Osterhaus below the line of sight)",
        }
    }

    /// P of a source in `direction`, seen along `gaze` with `up` upwards.
    pub fn position(self, gaze: DVec3, up: DVec3, direction: DVec3) -> Position {
        match self {
            Self::Levin => Position::Index(levin_iwata(gaze, up, direction)),
            Self::Table => match cie117_table(gaze, up, direction) {
                Ok(index) => Position::Index(index),
                Err(_) if direction.dot(up - gaze * up.dot(gaze)) < 0.0 => {
                    Position::BelowTable(levin_iwata(gaze, up, direction))
                }
                Err(_) => Position::OffTable(levin_iwata(gaze, up, direction)),
            },
        }
    }
}

/// P for every direction: [`levin`] above the line of sight, Iwata and Osterhaus (2010) below it,
/// which is Levin at τ = 90° and σ' = atan(√(x² + (1.15 z)²) / y), y along the line of sight, x
/// sideways, z up. Behind the eye σ goes on growing and P reaches the cap. Where `up` is parallel
/// to the gaze any horizontal axis serves as up: τ has no meaning there.
pub fn levin_iwata(gaze: DVec3, up: DVec3, direction: DVec3) -> f64 {
    let ups = [up, DVec3::Y, DVec3::X];
    let Some([h, r, t]) = ups.into_iter().find_map(|up| view_coordinates(gaze, up, direction)) else {
        // Only a gaze of no length is parallel to both x and y.
        return LEVIN_CAP;
    };
    if h >= 0.0 {
        levin(h.hypot(t).atan2(r).to_degrees(), t.abs().atan2(h).to_degrees())
    } else {
        levin((1.15 * h).hypot(t).atan2(r).to_degrees(), 90.0)
    }
}

/// H, R, T of a direction in the eye's frame; `None` where `up` is parallel to the line of sight.
fn view_coordinates(line_of_sight: DVec3, up: DVec3, direction: DVec3) -> Option<[f64; 3]> {
    let ahead = line_of_sight.try_normalize()?;
    let side = ahead.cross(up.try_normalize()?);
    if !(side.length() > 1e-9) {
        return None;
    }
    let side = side.normalize();
    Some([direction.dot(side.cross(ahead)), direction.dot(ahead), direction.dot(side)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::glare::reference_data;

    #[test]
    fn both_models_agree_with_the_reference_cases() {
        // Catches τ and σ swapped, radians, τ from the horizontal, values made up below the line of sight.
        let Some(text) = reference_data("glare/position_index_cases.csv") else {
            return;
        };
        let mut cases = 0;
        for line in text.lines().skip(1) {
            let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
            // The cases look along +y, x to the right, z up.
            let direction = DVec3::new(fields[2], fields[3], fields[4]);
            let table = cie117_table(DVec3::Y, DVec3::Z, direction);
            if fields[9].is_nan() {
                assert!(table.is_err(), "{line}");
            } else {
                assert!((table.unwrap() - fields[9]).abs() < 2e-4, "{line}");
            }
            let formula = levin_iwata(DVec3::Y, DVec3::Z, direction);
            assert!((formula - fields[10]).abs() < 2e-4 * fields[10], "{line}: {formula}");
            cases += 1;
        }
        assert_eq!(cases, 14);
    }

    #[test]
    fn the_table_is_met_at_its_cells_and_bilinear_between() {
        // Catches rows and columns swapped, and a lookup that is off by a line.
        let p = |h, t| cie117_at(h, t).unwrap();
        assert!((p(0.0, 0.0) - 1.0).abs() < 1e-12);
        assert!((p(1.9, 3.0) - 16.0).abs() < 1e-12);
        assert!((p(1.0, 0.3) - 6.45).abs() < 1e-9);
        let middle = (1.00 + 1.26 + 1.05 + 1.22) / 4.0;
        assert!((p(0.05, 0.05) - middle).abs() < 1e-12);
    }

    #[test]
    fn sources_outside_the_table_are_ignored_not_extrapolated() {
        assert!(cie117_at(1.7, 0.0).is_ok());
        for (h, t) in [(1.75, 0.0), (1.8, 0.3), (1.85, 0.4), (1.91, 2.0), (2.0, 1.0), (0.0, 3.01)] {
            assert!(cie117_at(h, t).is_err(), "H/R {h}, T/R {t}");
        }
        assert!(cie117_table(DVec3::X, DVec3::Z, DVec3::new(-1.0, 0.0, 0.1)).is_err());
        assert!(cie117_table(DVec3::X, DVec3::Z, DVec3::new(1.0, 0.0, -0.01)).is_err());
        assert!(cie117_table(DVec3::Z, DVec3::Z, DVec3::X).is_err());
    }

    #[test]
    fn the_models_do_not_depend_on_the_frame_and_see_left_as_right() {
        // Catches world axes used in place of the eye's own.
        let gaze = DVec3::new(1.0, 2.0, 0.0).normalize();
        let side = DVec3::new(2.0, -1.0, 0.0).normalize();
        for sign in [1.0, -1.0] {
            let direction = gaze * 2.0 + DVec3::Z * 0.7 + side * 0.9 * sign;
            let local = DVec3::new(0.9, 2.0, 0.7);
            let table = cie117_table(gaze, DVec3::Z, direction).unwrap();
            assert!((table - cie117_table(DVec3::Y, DVec3::Z, local).unwrap()).abs() < 1e-9);
            let formula = levin_iwata(gaze, DVec3::Z, direction);
            assert!((formula - levin_iwata(DVec3::Y, DVec3::Z, local)).abs() < 1e-9);
        }
    }

    #[test]
    fn levin_is_one_on_the_axis_and_capped_far_away() {
        assert!((levin(0.0, 45.0) - 1.0).abs() < 1e-12);
        assert!((levin(89.0, 0.0) - LEVIN_CAP).abs() < 1e-12);
        assert!((levin_iwata(DVec3::X, DVec3::Z, DVec3::NEG_X) - LEVIN_CAP).abs() < 1e-12);
        assert!(levin_iwata(DVec3::Z, DVec3::Z, DVec3::new(1.0, 0.0, 1.0)).is_finite());
    }
}
