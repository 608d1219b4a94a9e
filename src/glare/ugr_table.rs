//! UGR by the table method of CIE 117 and CIE 190: standard rooms, a regular grid of luminaires, an
//! observer at mid-wall. "Crosswise" looks *across* the luminaires' length, "endwise" along it. The
//! spacing matters: from SHR 1 to 0.25 a diffuse luminaire gains 0.2, a narrow beam 4 and more.

use glam::DVec3;

use super::position_index::cie117_at;
use super::source::{Extent, GlareSource};
use super::ugr::{LARGE_SOURCE_M2, ugr_by_luminance};
use super::wall_luminance::{direct_flux, transfer_factors, wall_luminance};
use crate::units::{Nits, Undefined};

/// Room sizes (X, Y) in units of H: X across the line of sight, Y along it.
pub const ROOMS: [(f64, f64); 19] = [
    (2.0, 2.0),
    (2.0, 3.0),
    (2.0, 4.0),
    (2.0, 6.0),
    (2.0, 8.0),
    (2.0, 12.0),
    (4.0, 2.0),
    (4.0, 3.0),
    (4.0, 4.0),
    (4.0, 6.0),
    (4.0, 8.0),
    (4.0, 12.0),
    (8.0, 4.0),
    (8.0, 6.0),
    (8.0, 8.0),
    (8.0, 12.0),
    (12.0, 4.0),
    (12.0, 6.0),
    (12.0, 8.0),
];

/// Reflectances of ceiling, walls and floor.
pub const REFLECTANCES: [[f64; 3]; 5] =
    [[0.7, 0.5, 0.2], [0.7, 0.3, 0.2], [0.5, 0.5, 0.2], [0.5, 0.3, 0.2], [0.3, 0.3, 0.2]];

/// Height of the luminaires above the eye, m.
const H_M: f64 = 2.0;

/// Luminaires are left out from this γ on, degrees.
const GAMMA_MAX_DEG: f64 = 85.0;

/// Upward share of the flux above which a luminaire counts as indirect; customary, not normative.
const UPWARD_SHARE_MAX: f64 = 0.65;

/// Largest deviation from symmetry about either axis, as a share of the largest intensity; ours, so
/// that goniometer noise passes and a wall washer does not.
const ASYMMETRY_MAX: f64 = 0.10;

/// A luminaire as the method sees it; directions are units in the luminaire frame (γ = 0 is −z, the
/// opening's length lies along +x).
pub struct TableInput<'a> {
    /// Intensity along a direction, cd.
    pub intensity_cd: &'a dyn Fn(DVec3) -> f64,
    /// Luminous area projected along a direction, m².
    pub projected_area_m2: &'a dyn Fn(DVec3) -> f64,
    /// Flux between two γ in degrees, lm.
    pub zonal_flux_lm: &'a dyn Fn(f64, f64) -> f64,
    /// Flux of the luminaire, lm.
    pub flux_lm: f64,
}

/// Five values, one per reflectance set, of one room and viewing direction.
pub type TableRow = [Result<f64, Undefined>; 5];

/// The table for the flux of its input; another flux Φ adds 8 lg(Φ/Φ0), see [`flux_correction`].
#[derive(Clone, Debug, PartialEq)]
pub struct UgrTable {
    /// Spacing of the luminaires in units of H.
    pub shr: f64,
    /// Rooms (X, Y) in units of H.
    pub rooms: [(f64, f64); 19],
    /// Ceiling, walls, floor.
    pub reflectances: [[f64; 3]; 5],
    /// Line of sight across the luminaires' length.
    pub crosswise: [TableRow; 19],
    /// Line of sight along the luminaires' length.
    pub endwise: [TableRow; 19],
}

/// What the table says about one room.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomUgr {
    /// Line of sight across the luminaires' length.
    pub crosswise: Result<f64, Undefined>,
    /// Line of sight along the luminaires' length.
    pub endwise: Result<f64, Undefined>,
    /// Reflectance set of the table that was taken.
    pub reflectances: [f64; 3],
    /// Where the room had to be fitted to the table, in words.
    pub notes: Vec<String>,
}

/// Direction of sight in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sight {
    Crosswise,
    Endwise,
}

/// ΔUGR = 8 lg(Φ/Φ0) of a luminaire with the same distribution and the flux Φ instead of Φ0.
pub fn flux_correction(flux_lm: f64, table_flux_lm: f64) -> f64 {
    8.0 * (flux_lm / table_flux_lm).log10()
}

/// The table of a luminaire at a spacing-to-height ratio of 1 (CIE 190's standard conditions), 0.25
/// (catalogues) or another 1/n, for which every room holds whole rows of luminaires.
///
/// # Errors
/// The luminaire is none the method was made for, or the ratio is not 1/n.
pub fn table(input: &TableInput, shr: f64) -> Result<UgrTable, Undefined> {
    applicable(input)?;
    if !(0.1..=1.0).contains(&shr) || (1.0 / shr - (1.0 / shr).round()).abs() > 1e-6 {
        return Err(Undefined::because(format!(
            "the spacing-to-height ratio must be 1, 1/2 … 1/10, not {shr}"
        )));
    }
    let rows = |sight| std::array::from_fn(|room| table_row(input, shr, ROOMS[room], sight));
    Ok(UgrTable {
        shr,
        rooms: ROOMS,
        reflectances: REFLECTANCES,
        crosswise: rows(Sight::Crosswise),
        endwise: rows(Sight::Endwise),
    })
}

/// UGR of a room X·H × Y·H (X across the line of sight) by [`table`] and [`UgrTable::room`].
///
/// # Errors
/// As for [`table`] and [`UgrTable::room`].
pub fn for_room(
    input: &TableInput,
    shr: f64,
    x_over_h: f64,
    y_over_h: f64,
    reflectances: [f64; 3],
) -> Result<RoomUgr, Undefined> {
    table(input, shr)?.room(x_over_h, y_over_h, reflectances)
}

/// Whether the table method may be used for a luminaire at all.
///
/// # Errors
/// The reason why not: no flux, indirect, large, or not symmetric about both its axes.
pub fn applicable(input: &TableInput) -> Result<(), Undefined> {
    let refuse = |why: String| Err(Undefined::because(format!("the UGR table method does not apply: {why}")));
    if !(input.flux_lm > 0.0 && input.flux_lm.is_finite()) {
        return refuse("the luminaire has no flux".into());
    }
    let upward = (input.zonal_flux_lm)(90.0, 180.0) / input.flux_lm;
    if !(upward <= UPWARD_SHARE_MAX) {
        return refuse(format!("{:.0} % of the flux goes up, the luminaire is indirect", 100.0 * upward));
    }
    let area_m2 = (input.projected_area_m2)(DVec3::NEG_Z);
    if area_m2 > LARGE_SOURCE_M2 {
        return refuse(format!("the luminous area of {area_m2:.2} m² is larger than {LARGE_SOURCE_M2} m²"));
    }
    let (mut largest, mut difference) = (0.0f64, 0.0f64);
    for gamma_deg in (5..=85).step_by(5) {
        for azimuth_deg in (0..=90).step_by(15) {
            let (sin, cos) = f64::from(gamma_deg).to_radians().sin_cos();
            let (sin_a, cos_a) = f64::from(azimuth_deg).to_radians().sin_cos();
            let [low, high] = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
                .map(|(x, y)| (input.intensity_cd)(DVec3::new(x * sin * cos_a, y * sin * sin_a, -cos)))
                .into_iter()
                .fold([f64::INFINITY, 0.0], |[low, high], cd| [low.min(cd), f64::max(high, cd)]);
            largest = largest.max(high);
            difference = difference.max(high - low);
        }
    }
    if !(difference <= ASYMMETRY_MAX * largest) {
        let percent = 100.0 * difference / largest;
        return refuse(format!(
            "the intensities on either side of an axis differ by {percent:.0} % of the largest"
        ));
    }
    Ok(())
}

impl UgrTable {
    /// The table's values for a room X·H × Y·H, H being the height of the luminaires above the eye:
    /// linear in Y within the columns of X = 2, 4, 8, 12, then linear in X; the nearest reflectance
    /// set. A size outside a column is moved to its end, and noted.
    ///
    /// # Errors
    /// Sizes or reflectances that are no such numbers.
    pub fn room(&self, x_over_h: f64, y_over_h: f64, reflectances: [f64; 3]) -> Result<RoomUgr, Undefined> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        if !positive(x_over_h)
            || !positive(y_over_h)
            || !reflectances.iter().all(|rho| (0.0..=1.0).contains(rho))
        {
            return Err(Undefined::because("the room needs positive sizes and reflectances between 0 and 1"));
        }
        let mut notes = Vec::new();
        let distance = |set: usize| {
            let pairs = REFLECTANCES[set].into_iter().zip(reflectances);
            pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
        };
        let nearer = |best, set| {
            if distance(set) < distance(best) { set } else { best }
        };
        let set = (1..REFLECTANCES.len()).fold(0, nearer);
        let nearest = REFLECTANCES[set];
        if distance(set) > 1e-6 {
            notes.push(format!("reflectances {} taken for {}", percent(nearest), percent(reflectances)));
        }
        let weights = room_weights(x_over_h, y_over_h, &mut notes);
        let value = |rows: &[TableRow; 19]| {
            weights.iter().try_fold(0.0, |sum, &(room, weight)| Ok(sum + weight * rows[room][set].clone()?))
        };
        Ok(RoomUgr {
            crosswise: value(&self.crosswise),
            endwise: value(&self.endwise),
            reflectances: nearest,
            notes,
        })
    }
}

/// `70/50/20`.
fn percent(reflectances: [f64; 3]) -> String {
    reflectances.map(|rho| format!("{:.0}", 100.0 * rho)).join("/")
}

/// Table rooms and their weights for a room between them.
fn room_weights(x: f64, y: f64, notes: &mut Vec<String>) -> Vec<(usize, f64)> {
    let columns = [2.0, 4.0, 8.0, 12.0];
    let mut weights = Vec::new();
    let mut moved = !(columns[0]..=columns[3]).contains(&x);
    for (column, x_weight) in between(&columns, x) {
        let indices: Vec<usize> =
            (0..ROOMS.len()).filter(|&room| (ROOMS[room].0 - columns[column]).abs() < 1e-9).collect();
        let depths: Vec<f64> = indices.iter().map(|&room| ROOMS[room].1).collect();
        moved |= !(depths[0]..=depths[depths.len() - 1]).contains(&y);
        weights
            .extend(between(&depths, y).into_iter().map(|(depth, part)| (indices[depth], x_weight * part)));
    }
    if moved {
        notes.push(format!("room {x:.1} H × {y:.1} H lies outside the table, nearest rooms taken"));
    }
    weights
}

/// The one or two rising `knots` around `value` with their linear weights, none of them zero.
fn between(knots: &[f64], value: f64) -> Vec<(usize, f64)> {
    let last = knots.len() - 1;
    let above = knots.partition_point(|&knot| knot <= value);
    if above == 0 || above > last {
        return vec![(above.min(last), 1.0)];
    }
    let part = (value - knots[above - 1]) / (knots[above] - knots[above - 1]);
    if part > 0.0 { vec![(above - 1, 1.0 - part), (above, part)] } else { vec![(above - 1, 1.0)] }
}

/// The five values of one room: the sources are the same, the background differs.
fn table_row(input: &TableInput, shr: f64, (x, y): (f64, f64), sight: Sight) -> TableRow {
    let spacing_m = shr * H_M;
    let rows = [x, y].map(|size| (size / shr).round() as usize);
    let sources = visible_sources(input, spacing_m, rows, sight);
    let wall_area_m2 = 2.0 * H_M * H_M * (x + y);
    std::array::from_fn(|set| {
        let direct = direct_flux(input.zonal_flux_lm, x, y)?;
        let transfer = transfer_factors(x, y, REFLECTANCES[set]);
        ugr_by_luminance(&sources, wall_luminance(direct, transfer, rows[0] * rows[1], wall_area_m2))
    })
}

/// The luminaires at R = S/2, 3S/2 … ahead and T = ±S/2 … aside that the method counts.
fn visible_sources(input: &TableInput, spacing_m: f64, rows: [usize; 2], sight: Sight) -> Vec<GlareSource> {
    let mut sources = Vec::new();
    for ahead in 0..rows[1] {
        let r_m = (ahead as f64 + 0.5) * spacing_m;
        for aside in 0..rows[0] {
            let t_m = (aside as f64 + 0.5 - rows[0] as f64 / 2.0) * spacing_m;
            let Ok(position_index) = cie117_at(H_M / r_m, (t_m / r_m).abs()) else {
                continue;
            };
            if t_m.hypot(r_m).atan2(H_M).to_degrees() > GAMMA_MAX_DEG {
                continue;
            }
            // From the luminaire to the eye; the luminaire's x axis is its length.
            let to_eye = match sight {
                Sight::Crosswise => DVec3::new(-t_m, -r_m, -H_M),
                Sight::Endwise => DVec3::new(-r_m, t_m, -H_M),
            };
            let (direction, distance_m) = (to_eye.normalize(), to_eye.length());
            let intensity_cd = (input.intensity_cd)(direction);
            let projected_area_m2 = (input.projected_area_m2)(direction);
            let off_axis = r_m / distance_m;
            sources.push(GlareSource {
                luminance: Nits(intensity_cd / projected_area_m2),
                solid_angle_sr: projected_area_m2 / (distance_m * distance_m),
                position_index,
                ugr_share: 1.0,
                off_axis_deg: off_axis.acos().to_degrees(),
                eye_lx: intensity_cd * off_axis / (distance_m * distance_m),
                extent: Some(Extent { projected_area_m2, intensity_cd, distance_m }),
            });
        }
    }
    sources
}

#[cfg(test)]
mod tests;
