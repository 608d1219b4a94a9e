//! [`Photometry`] → EULUMDAT. Intensities keep ten significant digits, more than the six characters
//! of the format's description, so that nothing is lost on the way to LM-63 and back.

use super::written::{Planes, ascii, number};
use super::{Opening, Photometry, Symmetry};

/// C of the luminaire frame's azimuth 0: C90 lies along +x.
const TURN_DEG: f64 = 90.0;
const NAME: usize = 78;

/// The file's bytes; lines end in CR LF. The ten direct ratios, which nobody needs today, are 0.
pub fn to_ldt(photometry: &Photometry) -> Vec<u8> {
    let planes = Planes::of(photometry, TURN_DEG);
    let flux_lm = photometry.distribution.flux().0;
    let lamps_lm = photometry.lamp_flux_lm.unwrap_or(flux_lm);
    let down = photometry.distribution.zonal_flux(0.0, 90.0).0 / flux_lm;
    let (isym, stored) = match planes.symmetry {
        Symmetry::None => (0, planes.all_deg.clone()),
        Symmetry::Rotational => (1, vec![0.0]),
        Symmetry::AboutWidth => (2, planes.between(0.0, 180.0)),
        Symmetry::AboutLength => (3, planes.between(270.0, 450.0)),
        Symmetry::Quadrant => (4, planes.between(0.0, 90.0)),
    };
    let [length, width, c0, c90, c180, c270] = sizes_m(photometry.opening).map(|size| number(1000.0 * size));
    let name = ascii(&photometry.description, NAME);
    let kind = if planes.symmetry == Symmetry::Rotational { 1 } else { 3 };
    let set_count = if photometry.lamp_flux_lm.is_some() { 1 } else { -1 };
    let lor = photometry.lor.unwrap_or(flux_lm / lamps_lm);
    let text = String::new;
    let mut lines: Vec<String> = vec![
        text(),
        kind.to_string(),
        isym.to_string(),
        planes.all_deg.len().to_string(),
        step(&planes.all_deg),
        planes.gammas_deg.len().to_string(),
        step(&planes.gammas_deg),
        text(),
        name,
        text(),
        text(),
        text(),
        // The luminaire itself: no smaller than its luminous area.
        length.clone(),
        width.clone(),
        "0".into(),
        length,
        width,
        c0,
        c90,
        c180,
        c270,
        number(100.0 * down),
        number(100.0 * lor),
        "1".into(),
        "0".into(),
        "1".into(),
        set_count.to_string(),
        text(),
        number(lamps_lm),
        text(),
        photometry.colour_rendering.map_or_else(text, number),
        photometry.power_w.map_or_else(|| "0".into(), number),
    ];
    lines.extend(std::iter::repeat_n("0".to_owned(), 10));
    lines.extend(planes.all_deg.iter().chain(&planes.gammas_deg).map(|angle| number(*angle)));
    for c_deg in stored {
        let per_klm = |cd: f64| number(cd * 1000.0 / lamps_lm);
        lines.extend(planes.intensities(photometry, c_deg).into_iter().map(per_klm));
    }
    (lines.join("\r\n") + "\r\n").into_bytes()
}

/// Length, width (0 for a disc), luminous heights towards C0, C90, C180, C270 (frame −y, +x, +y, −x).
/// Shapes that the format does not know become the box or cylinder that shows as much from below and
/// from the sides.
fn sizes_m(opening: Opening) -> [f64; 6] {
    match opening {
        Opening::Rect { length_m, width_m, side_x_m, side_y_m } => {
            [length_m, width_m, side_y_m, side_x_m, side_y_m, side_x_m]
        }
        Opening::Sided { length_m, width_m, sides_m: [east, north, west, south] } => {
            [length_m, width_m, south, east, north, west]
        }
        Opening::Disc { diameter_m, height_m } => [diameter_m, 0.0, height_m, height_m, height_m, height_m],
        Opening::Ellipse { length_m, width_m, height_m } => {
            box_like([length_m, width_m], opening.area_m2(), [width_m * height_m, length_m * height_m])
        }
        Opening::Ellipsoid { length_m, width_m, .. }
        | Opening::Tube { length_m, width_m, across: false, .. }
        | Opening::Tube { length_m: width_m, width_m: length_m, across: true, .. } => {
            let sides = [glam::DVec3::X, glam::DVec3::Y].map(|from| opening.projected_area_m2(from));
            box_like([length_m, width_m], opening.area_m2(), sides)
        }
        // No place for an upright plane; a thin box would be given a front that the plane has not.
        Opening::Point | Opening::Upright { .. } => [0.0; 6],
    }
}

/// A box of these proportions on plan, with the areas that are seen from below and along x and y.
fn box_like([length_m, width_m]: [f64; 2], below_m2: f64, [along_x_m2, along_y_m2]: [f64; 2]) -> [f64; 6] {
    let shrink = (below_m2 / (length_m * width_m)).sqrt();
    let (length_m, width_m) = (shrink * length_m, shrink * width_m);
    let (side_x_m, side_y_m) = (along_x_m2 / width_m, along_y_m2 / length_m);
    [length_m, width_m, side_y_m, side_x_m, side_y_m, side_x_m]
}

/// The step of evenly spaced angles, else 0.
fn step(angles: &[f64]) -> String {
    let first = angles.windows(2).next().map_or(0.0, |pair| pair[1] - pair[0]);
    let even = angles.windows(2).all(|pair| (pair[1] - pair[0] - first).abs() < 1e-6);
    if even { number(first) } else { "0".into() }
}
