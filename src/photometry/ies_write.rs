//! [`Photometry`] → LM-63-2002, type C, metres, all factors 1: the candelas are absolute as written.

use super::written::{Planes, ascii, number};
use super::{Opening, Photometry, Symmetry};

const NAME: usize = 200;
/// Longest line of numbers; the format allows 256 characters.
const LINE: usize = 120;

/// The file's bytes; lines end in CR LF.
pub fn to_ies(photometry: &Photometry) -> Vec<u8> {
    let planes = Planes::of(photometry, 0.0);
    let mut stored = match planes.symmetry {
        Symmetry::None => planes.between(0.0, 360.0),
        Symmetry::Rotational => vec![0.0],
        Symmetry::AboutWidth => planes.between(90.0, 270.0),
        Symmetry::AboutLength => planes.between(0.0, 180.0),
        Symmetry::Quadrant => planes.between(0.0, 90.0),
    };
    if planes.symmetry == Symmetry::None {
        stored.retain(|angle| *angle < 360.0 - 1e-6);
        stored.push(360.0);
    }
    let [width, length, height] = sizes_m(photometry.opening).map(number);
    let (gammas, lumens) =
        (planes.gammas_deg.len(), photometry.lamp_flux_lm.map_or_else(|| "-1".into(), number));
    let mut lines: Vec<String> = vec![
        "IESNA:LM-63-2002".into(),
        "[TEST] not stated".into(),
        "[TESTLAB] not stated".into(),
        "[ISSUEDATE] not stated".into(),
        format!("[MANUFAC] {}", ascii(&photometry.description, NAME)),
        "TILT=NONE".into(),
        format!("1 {lumens} 1 {gammas} {} 1 2 {width} {length} {height}", stored.len()),
        format!("1 1 {}", photometry.power_w.map_or_else(|| "0".into(), number)),
    ];
    wrap(&planes.gammas_deg, &mut lines);
    wrap(&stored, &mut lines);
    for angle in &stored {
        wrap(&planes.intensities(photometry, *angle), &mut lines);
    }
    (lines.join("\r\n") + "\r\n").into_bytes()
}

/// Width, length, height by the codes of 2002; diameters are negative. Sides of several heights become
/// their mean.
fn sizes_m(opening: Opening) -> [f64; 3] {
    match opening {
        Opening::Point => [0.0; 3],
        Opening::Rect { length_m, width_m, side_x_m, side_y_m } => {
            [width_m, length_m, 0.5 * (side_x_m + side_y_m)]
        }
        Opening::Sided { length_m, width_m, sides_m } => {
            [width_m, length_m, 0.25 * sides_m.iter().sum::<f64>()]
        }
        Opening::Disc { diameter_m, height_m } => [-diameter_m, -diameter_m, height_m],
        Opening::Ellipse { length_m, width_m, height_m } => [-width_m, -length_m, height_m],
        Opening::Ellipsoid { length_m, width_m, height_m } => [-width_m, -length_m, -height_m],
        Opening::Tube { length_m, width_m, height_m, across: false } => [-width_m, length_m, -height_m],
        Opening::Tube { length_m, width_m, height_m, across: true } => [length_m, -width_m, -height_m],
        Opening::Upright { width_m, height_m, across, round } => {
            let sign = if round { -1.0 } else { 1.0 };
            let [width, length] = if across { [0.0, sign * width_m] } else { [sign * width_m, 0.0] };
            [width, length, sign * height_m]
        }
    }
}

fn wrap(values: &[f64], lines: &mut Vec<String>) {
    let mut line = String::new();
    for value in values {
        let text = number(*value);
        if !line.is_empty() && line.len() + 1 + text.len() > LINE {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(&text);
    }
    lines.push(line);
}
