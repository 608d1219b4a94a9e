//! LM-63's size codes → [`Opening`]. What a sign means changed in 2002; *width* lies across the 0°
//! plane (frame y), *length* along it (frame x).

use std::f64::consts::FRAC_PI_4;

use super::{Finding, Lm63Version, Opening};

/// The codes of LM-63: a negative size is a diameter. `-+-` and `+--` are ellipsoids in 1995 and
/// horizontal cylinders from 2002; `-0-` is a sphere in 1995 and an upright disc from 2002.
pub(super) fn opening(
    [w, l, h]: [f64; 3],
    version: Lm63Version,
    line: usize,
    findings: &mut Vec<Finding>,
) -> Opening {
    let sign = |size: f64| {
        if size > 0.0 {
            '+'
        } else if size < 0.0 {
            '-'
        } else {
            '0'
        }
    };
    let code: String = [w, l, h].map(sign).iter().collect();
    let since_2002 = version >= Lm63Version::Y2002;
    let rect = |length_m: f64, width_m: f64, side_x_m: f64, side_y_m: f64| Opening::Rect {
        length_m,
        width_m,
        side_x_m,
        side_y_m,
    };
    let (w_abs, l_abs, h_abs) = (w.abs(), l.abs(), h.abs());
    // The disc of an ellipse's area; a single size stands for both.
    let diameter_m = if w_abs * l_abs > 0.0 { (w_abs * l_abs).sqrt() } else { w_abs.max(l_abs) };
    let round = (w_abs - l_abs).abs() < 1e-9 || w_abs * l_abs < 1e-18;
    let disc = |height_m: f64| Opening::Disc { diameter_m, height_m };
    let (opening, approximated) = match code.as_str() {
        "000" => (Opening::Point, None),
        "++0" | "+++" => (rect(l, w, h, h), None),
        "-00" | "--0" | "0-0" | "-0+" | "--+" | "0-+" if round => (disc(h), None),
        "--0" | "--+" | "-+0" | "-++" | "+-0" | "+-+" => (disc(h), Some("an ellipse as a disc of its area")),
        "0+-" => (rect(l, h_abs, FRAC_PI_4 * h_abs, h_abs), Some("a horizontal cylinder as a box")),
        "+0-" => (rect(h_abs, w, h_abs, FRAC_PI_4 * h_abs), Some("a horizontal cylinder as a box")),
        "-+-" if since_2002 => {
            (rect(l, w_abs, FRAC_PI_4 * h_abs, h_abs), Some("a horizontal cylinder as a box"))
        }
        "+--" if since_2002 => {
            (rect(l_abs, w, h_abs, FRAC_PI_4 * h_abs), Some("a horizontal cylinder as a box"))
        }
        "-0-" if since_2002 => {
            (rect(0.0, w_abs, FRAC_PI_4 * h_abs, 0.0), Some("an upright disc as an upright edge"))
        }
        "-0-" | "---" | "0--" | "-+-" | "+--" => {
            (disc(FRAC_PI_4 * h_abs), Some("an ellipsoid as an upright cylinder of its side area"))
        }
        "+0+" => (rect(0.0, w, h, 0.0), Some("an upright rectangle as an upright edge")),
        "0++" => (rect(l, 0.0, 0.0, h), Some("an upright rectangle as an upright edge")),
        "++-" => (rect(l, w, 0.0, 0.0), Some("a rectangle of negative height as a flat one")),
        _ => (Opening::Point, Some("a line as a point")),
    };
    if let Some(how) = approximated {
        let message = format!(
            "luminous opening {w:.3} × {l:.3} × {h:.3} m (width, length, height) is taken as the nearest known shape, \
             {how}"
        );
        let consequence = "luminance and UGR are approximate, illuminance is not affected";
        findings.push(Finding::new("opening-approximated", line, message, consequence));
    }
    opening
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(size: [f64; 3], version: Lm63Version) -> (Opening, usize) {
        let mut findings = Vec::new();
        (opening(size, version, 7, &mut findings), findings.len())
    }

    /// Catches: width and length swapped, a diameter taken as a width, a silent approximation.
    #[test]
    fn exact_shapes_need_no_finding() {
        let (y1995, y2002) = (Lm63Version::Y1995, Lm63Version::Y2002);
        let rect =
            |height: f64| Opening::Rect { length_m: 1.2, width_m: 0.3, side_x_m: height, side_y_m: height };
        assert_eq!(seen([0.0; 3], y1995), (Opening::Point, 0));
        assert_eq!(seen([0.3, 1.2, 0.0], y2002), (rect(0.0), 0));
        assert_eq!(seen([0.3, 1.2, 0.05], y1995), (rect(0.05), 0));
        for size in [[-0.2, 0.0, 0.1], [-0.2, -0.2, 0.1], [0.0, -0.2, 0.1]] {
            assert_eq!(seen(size, y2002), (Opening::Disc { diameter_m: 0.2, height_m: 0.1 }, 0));
        }
    }

    /// Catches: a code that is read by the other edition's table; an unannounced substitute.
    #[test]
    fn other_shapes_say_so() {
        let (y1995, y2002) = (Lm63Version::Y1995, Lm63Version::Y2002);
        let area =
            |opening: Opening, x: f64, y: f64, z: f64| opening.projected_area_m2(glam::DVec3::new(x, y, z));
        let (sphere, said) = seen([-0.2, 0.0, -0.2], y1995);
        assert_eq!(said, 1);
        assert!((area(sphere, 1.0, 0.0, 0.0) - area(sphere, 0.0, 0.0, -1.0)).abs() < 1e-12);
        let (tube_2002, _) = seen([-0.1, 2.0, -0.1], y2002);
        let (tube_1995, _) = seen([0.0, 2.0, -0.1], y1995);
        assert_eq!(tube_2002, tube_1995);
        assert!((area(tube_2002, 0.0, 1.0, 0.0) - 0.2).abs() < 1e-12);
        assert!((area(tube_2002, 1.0, 0.0, 0.0) - FRAC_PI_4 * 0.01).abs() < 1e-12);
        let (spheroid, _) = seen([-0.1, 2.0, -0.1], y1995);
        assert!(matches!(spheroid, Opening::Disc { .. }));
        for code in 0..27 {
            let size = [code / 9, code / 3 % 3, code % 3].map(|sign| 0.4 * (f64::from(sign) - 1.0));
            for version in [y1995, y2002] {
                let (opening, said) = seen(size, version);
                assert!(opening.area_m2() >= 0.0 && said <= 1, "{size:?}");
            }
        }
    }
}
