//! LM-63's size codes → [`Opening`]. What a sign means changed in 2002; *width* lies across the 0°
//! plane (frame y), *length* along it (frame x).

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
    let (w, l, h) = (w.abs(), l.abs(), h.abs());
    let box_of =
        |length_m: f64, width_m: f64, height_m: f64| Opening::sided(length_m, width_m, [height_m; 4]);
    // A single size stands for both.
    let (across, along) = (if w > 0.0 { w } else { l }, if l > 0.0 { l } else { w });
    let ellipse = |height_m: f64| {
        if (across - along).abs() < 1e-9 {
            Opening::Disc { diameter_m: across, height_m }
        } else {
            Opening::Ellipse { length_m: along, width_m: across, height_m }
        }
    };
    let ellipsoid = Opening::Ellipsoid { length_m: along, width_m: across, height_m: h };
    let tube =
        |length_m: f64, width_m: f64, across: bool| Opening::Tube { length_m, width_m, height_m: h, across };
    let upright =
        |width_m: f64, across: bool, round: bool| Opening::Upright { width_m, height_m: h, across, round };
    let (opening, approximated) = match code.as_str() {
        "000" => (Opening::Point, None),
        "++0" | "+++" => (box_of(l, w, h), None),
        "-00" | "--0" | "0-0" | "-0+" | "--+" | "0-+" | "-+0" | "-++" | "+-0" | "+-+" => (ellipse(h), None),
        "0+-" => (tube(l, h, false), None),
        "+0-" => (tube(w, h, true), None),
        "-+-" if since_2002 => (tube(l, w, false), None),
        "+--" if since_2002 => (tube(w, l, true), None),
        "-0-" if since_2002 => (upright(w, false, true), None),
        "0--" if since_2002 => (upright(l, true, true), None),
        "-0-" | "---" | "0--" | "-+-" | "+--" => (ellipsoid, None),
        "+0+" => (upright(w, false, false), None),
        "0++" => (upright(l, true, false), None),
        "++-" => (Opening::rect(l, w), Some("a rectangle of negative height as a flat one")),
        _ => (Opening::Point, Some("a line as a point")),
    };
    if let Some(how) = approximated {
        let message = format!(
            "luminous opening {code} of {w:.3} × {l:.3} × {h:.3} m (width, length, height; − marks a diameter) is no shape \
             of LM-63, so it is taken as the nearest one, {how}"
        );
        let consequence =
            "luminance and UGR are approximate; illuminance nearer than about ten times its size as well";
        findings.push(Finding::new("opening-approximated", line, message, consequence));
    }
    opening
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

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
    fn every_edition_has_its_shapes() {
        let (y1995, y2002) = (Lm63Version::Y1995, Lm63Version::Y2002);
        let area =
            |opening: Opening, x: f64, y: f64, z: f64| opening.projected_area_m2(glam::DVec3::new(x, y, z));
        let (ball, said) = seen([-0.2, 0.0, -0.2], y1995);
        assert_eq!((ball, said), (Opening::Ellipsoid { length_m: 0.2, width_m: 0.2, height_m: 0.2 }, 0));
        assert!((area(ball, 0.6, 0.0, 0.8) - PI * 0.01).abs() < 1e-12);
        let (disc, _) = seen([-0.2, 0.0, -0.2], y2002);
        assert!((area(disc, 1.0, 0.0, 0.0) - PI * 0.01).abs() < 1e-12 && area(disc, 0.0, 1.0, 0.0) < 1e-12);
        let (tube_2002, _) = seen([-0.1, 2.0, -0.1], y2002);
        let (tube_1995, _) = seen([0.0, 2.0, -0.1], y1995);
        assert_eq!(tube_2002, tube_1995);
        assert!((area(tube_2002, 0.0, 1.0, 0.0) - 0.2).abs() < 1e-12);
        assert!((area(tube_2002, 1.0, 0.0, 0.0) - 0.25 * PI * 0.01).abs() < 1e-12);
        let (turned, _) = seen([2.0, -0.1, -0.1], y2002);
        assert!((area(turned, 1.0, 0.0, 0.0) - 0.2).abs() < 1e-12);
        let (spheroid, _) = seen([-0.1, 2.0, -0.1], y1995);
        assert!((area(spheroid, 0.0, 1.0, 0.0) - 0.25 * PI * 0.2).abs() < 1e-12);
        let (oval, said) = seen([-0.1, -0.3, 0.0], y2002);
        assert_eq!((oval, said), (Opening::Ellipse { length_m: 0.3, width_m: 0.1, height_m: 0.0 }, 0));
        let (sign, _) = seen([0.4, 0.0, 0.2], y2002);
        assert!((area(sign, -1.0, 0.0, 0.0) - 0.08).abs() < 1e-12);
        assert_eq!(seen([0.0, 1.0, 0.0], y2002), (Opening::Point, 1));
        for code in 0..27 {
            let size = [code / 9, code / 3 % 3, code % 3].map(|sign| 0.4 * (f64::from(sign) - 1.0));
            for version in [y1995, y2002] {
                let (opening, said) = seen(size, version);
                assert!(opening.area_m2() >= 0.0 && said <= 1, "{size:?}");
            }
        }
    }
}
