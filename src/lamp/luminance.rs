//! Mean luminance of the opening at steep angles, from where luminaires dazzle.

use glam::DVec3;

use super::azimuth_deg;
use crate::photometry::{Photometry, Symmetry};
use crate::units::{Nits, Undefined};

/// γ of the table's columns, degrees.
pub const GAMMAS_DEG: [f64; 5] = [45.0, 55.0, 65.0, 75.0, 85.0];

/// Step of the table's rows in C, degrees.
const C_STEP_DEG: u32 = 15;

/// The luminances of one half-plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// C, degrees.
    pub c_deg: f64,
    /// At [`GAMMAS_DEG`].
    pub luminances: [Result<Nits, Undefined>; 5],
}

/// L(C,γ) = I(C,γ)/A_proj(C,γ).
///
/// # Errors
/// The opening shows no area in this direction.
pub fn luminance(photometry: &Photometry, c_deg: f64, gamma_deg: f64) -> Result<Nits, Undefined> {
    let azimuth = azimuth_deg(c_deg);
    let (sin, cos) = gamma_deg.to_radians().sin_cos();
    let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
    let area_m2 = photometry.opening.projected_area_m2(DVec3::new(sin * cos_a, sin * sin_a, -cos));
    if !(area_m2 > 0.0) {
        return Err(Undefined::because("no luminous area is seen from there"));
    }
    Ok(Nits(photometry.distribution.intensity_at(azimuth, gamma_deg) / area_m2))
}

/// Rows in steps of 15°, as many as the symmetry leaves different.
pub fn table(photometry: &Photometry, symmetry: Symmetry) -> Vec<Row> {
    let (first, last) = match symmetry {
        Symmetry::Rotational => (0, 0),
        Symmetry::Quadrant => (0, 90),
        Symmetry::AboutLength => (90, 270),
        Symmetry::AboutWidth => (0, 180),
        Symmetry::None => (0, 345),
    };
    let row = |c: u32| {
        let c_deg = f64::from(c % 360);
        Row { c_deg, luminances: GAMMAS_DEG.map(|gamma| luminance(photometry, c_deg, gamma)) }
    };
    (first..=last).step_by(C_STEP_DEG as usize).map(row).collect()
}
