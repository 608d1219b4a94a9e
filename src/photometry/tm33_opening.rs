//! The luminous opening of TM-33: emission areas on the faces of a box, in mm. Length lies along h = 90°,
//! so the faces towards h = 0 and 180° measure length × height.

use roxmltree::Node;

use super::tm33::{Xml, children};
use super::{Fault, Finding, Opening};

const MM: f64 = 1e-3;

/// One luminous area on a face: extents and the place of its centre, m.
struct Area {
    size_m: [f64; 2],
    centre_m: [f64; 2],
    round: bool,
    line: usize,
}

impl Area {
    fn area_m2(&self) -> f64 {
        let [a, b] = self.size_m;
        a * b * if self.round { 0.25 * std::f64::consts::PI } else { 1.0 }
    }
}

/// From the emission areas; where there are none, from `LuminousOpening` or the luminaire's own size.
pub(super) fn opening(
    xml: &Xml,
    root: Node,
    emitters: &[Node],
    findings: &mut Vec<Finding>,
) -> Result<Opening, Fault> {
    let level = ["Length", "Width"];
    let bottom = areas(xml, emitters, "BottomFace", "BottomArea", level)?;
    let top = areas(xml, emitters, "TopFace", "TopArea", level)?;
    let upright = [
        ("C90Face", "C90Area", "Width"),
        ("C180Face", "C180Area", "Length"),
        ("C270Face", "C270Area", "Width"),
        ("C0Face", "C0Area", "Length"),
    ];
    let mut sides_m2 = [0.0; 4];
    for (side, (face, area, edge)) in sides_m2.iter_mut().zip(upright) {
        *side = areas(xml, emitters, face, area, [edge, "Height"])?.iter().map(Area::area_m2).sum();
    }
    let (level, from_top) = if bottom.is_empty() { (top, true) } else { (bottom, !top.is_empty()) };
    if level.is_empty() {
        return named(xml, root, findings);
    }
    if from_top {
        let message = "luminous areas on top of the luminaire";
        let consequence = "an opening is seen from below here: the luminance from above is undefined";
        findings.push(Finding::new("opening-approximated", level[0].line, message, consequence));
    }
    let plan = around(&level);
    let (all_m2, around_m2) = (level.iter().map(Area::area_m2).sum::<f64>(), plan.area_m2());
    // Areas that fill the rectangle, or lie upon each other, are it.
    if let [_, second, ..] = &level[..]
        && all_m2 > 0.0
        && all_m2 < 0.999 * around_m2
    {
        let message = format!(
            "{} luminous areas of {all_m2:.4} m² in all are taken as the rectangle around them, {around_m2:.4} m²",
            level.len()
        );
        let consequence = format!(
            "luminance is {:.2} times that of the areas themselves, UGR lower by {:.1}",
            all_m2 / around_m2,
            8.0 * (around_m2 / all_m2).log10()
        );
        findings.push(Finding::new("opening-approximated", second.line, message, consequence));
    }
    let [length_m, width_m] = plan.size_m;
    if !(length_m > 0.0 && width_m > 0.0) {
        return Ok(Opening::Point);
    }
    let edges_m = [width_m, length_m, width_m, length_m];
    let heights: [f64; 4] = std::array::from_fn(|side| sides_m2[side] / edges_m[side]);
    let height_m = 0.25 * heights.iter().sum::<f64>();
    Ok(match (plan.round, (length_m - width_m).abs() < 1e-9) {
        (true, true) => Opening::Disc { diameter_m: length_m, height_m },
        (true, false) => Opening::Ellipse { length_m, width_m, height_m },
        (false, _) => Opening::sided(length_m, width_m, heights),
    })
}

fn areas(
    xml: &Xml,
    emitters: &[Node],
    face: &'static str,
    area: &'static str,
    edges: [&'static str; 2],
) -> Result<Vec<Area>, Fault> {
    let nodes = emitters.iter().flat_map(|emitter| children(*emitter, "EmissionAreas"));
    let nodes = nodes.flat_map(|areas| children(areas, face)).flat_map(|face| children(face, area));
    let one = |node: Node| {
        let length = |name: &'static str| Ok(xml.number(node, name)?.unwrap_or(0.0) * MM);
        let offset = |edge: &'static str| match edge {
            "Length" => length("LengthOffset"),
            "Width" => length("WidthOffset"),
            _ => length("HeightOffset"),
        };
        let round = children(node, "Circular")
            .filter_map(|node| node.text())
            .any(|text| matches!(text.trim(), "true" | "1"));
        Ok(Area {
            size_m: [length(edges[0])?.max(0.0), length(edges[1])?.max(0.0)],
            centre_m: [offset(edges[0])?, offset(edges[1])?],
            round,
            line: xml.line(node),
        })
    };
    nodes.map(one).collect()
}

/// The rectangle around areas on one face; a lone area is itself.
fn around(areas: &[Area]) -> Area {
    let ends = |axis: usize| {
        areas.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], area| {
            let (centre, half) = (area.centre_m[axis], 0.5 * area.size_m[axis]);
            [low.min(centre - half), high.max(centre + half)]
        })
    };
    let [[x0, x1], [y0, y1]] = [ends(0), ends(1)];
    Area {
        size_m: [x1 - x0, y1 - y0],
        centre_m: [0.5 * (x0 + x1), 0.5 * (y0 + y1)],
        round: areas.len() == 1 && areas[0].round,
        line: areas[0].line,
    }
}

/// `LuminousOpening` of some writers, else the luminaire's dimensions, which are no opening.
fn named(xml: &Xml, root: Node, findings: &mut Vec<Finding>) -> Result<Opening, Fault> {
    let Some(luminaire) = children(root, "Luminaire").next() else { return Ok(Opening::Point) };
    let of = |node: Node, name: &'static str| Ok(xml.number(node, name)?.unwrap_or(0.0).max(0.0) * MM);
    if let Some(node) = children(luminaire, "LuminousOpening").next() {
        let diameter_m = of(node, "Diameter")?;
        if diameter_m > 0.0 {
            return Ok(Opening::Disc { diameter_m, height_m: 0.0 });
        }
        let (length_m, width_m) = (of(node, "Length")?, of(node, "Width")?);
        if length_m > 0.0 && width_m > 0.0 {
            return Ok(Opening::rect(length_m, width_m));
        }
    }
    let Some(size) = children(luminaire, "Dimensions").next() else { return Ok(Opening::Point) };
    let (length_m, width_m) = (of(size, "Length")?, of(size, "Width")?);
    let opening = match (length_m > 0.0, width_m > 0.0) {
        (true, true) => Opening::rect(length_m, width_m),
        (true, false) | (false, true) => Opening::Disc { diameter_m: length_m.max(width_m), height_m: 0.0 },
        (false, false) => return Ok(Opening::Point),
    };
    let message = format!(
        "the luminaire's own size of {length_m:.3} × {width_m:.3} m is taken as its luminous opening"
    );
    let consequence = "luminance and UGR are too low where less of it shines; set `area`";
    findings.push(Finding::new("opening-approximated", xml.line(size), message, consequence));
    Ok(opening)
}
