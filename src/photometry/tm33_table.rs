//! The luminous intensities of TM-33: single values with their angles, in any order → a grid. Every
//! direction must be there once, and the counts in the head must be right.

use roxmltree::Node;

use super::ies_goniometer::Goniometer;
use super::numbers::MAX_VALUES;
use super::planes::Plane;
use super::tm33::{DAMAGED, Xml, is_value};
use super::{Fault, Finding};

/// Angles closer than this are one, degrees.
const SAME_DEG: f64 = 1e-6;

/// Vertical angles, and a plane for each horizontal one.
pub(super) struct Table {
    pub(super) verticals: Vec<f64>,
    pub(super) planes: Vec<Plane>,
}

/// One intensity.
struct Value {
    horizontal: f64,
    vertical: f64,
    cd: f64,
    line: usize,
}

/// All values on the grid of their angles.
pub(super) fn table(
    xml: &Xml,
    data: Node,
    goniometer: Goniometer,
    findings: &mut Vec<Finding>,
) -> Result<Table, Fault> {
    let values = values(xml, data, goniometer)?;
    let axis = |of: fn(&Value) -> f64| {
        let mut axis: Vec<f64> = values.iter().map(of).collect();
        axis.sort_by(f64::total_cmp);
        axis.dedup_by(|next, kept| *next - *kept < SAME_DEG);
        axis
    };
    let (horizontals, verticals) = (axis(|value| value.horizontal), axis(|value| value.vertical));
    check_counts(xml, data, [values.len(), horizontals.len(), verticals.len()])?;
    let cells = horizontals.len().saturating_mul(verticals.len());
    if verticals.len() < 2 || cells > MAX_VALUES || cells > 4 * values.len() + 4096 {
        let message = format!("{} vertical and {} horizontal angles", verticals.len(), horizontals.len());
        return Err(Fault::new(xml.line(data), message, DAMAGED));
    }
    let mut cd = vec![None; cells];
    let mut doubled = 0;
    for value in &values {
        let at = |axis: &[f64], angle: f64| axis.partition_point(|known| *known < angle - SAME_DEG);
        let row = at(&horizontals, value.horizontal);
        let cell = &mut cd[row * verticals.len() + at(&verticals, value.vertical)];
        doubled += usize::from(cell.is_some());
        cell.get_or_insert((value.cd, value.line));
    }
    if doubled > 0 {
        let message = format!("{doubled} directions are given twice");
        let consequence = "the first value counts; if the others differ, the distribution is uncertain";
        findings.push(Finding::new("trailing-data", xml.line(data), message, consequence));
    }
    let columns = verticals.len();
    if goniometer == Goniometer::C {
        share_poles(&mut cd, &verticals);
    }
    let mut planes = Vec::new();
    for (row, plane) in horizontals.iter().zip(cd.chunks(columns)) {
        if let Some(missing) = plane.iter().position(Option::is_none) {
            let message = format!("no intensity at h {row}°, v {}°", verticals[missing]);
            return Err(Fault::new(xml.line(data), message, DAMAGED));
        }
        let (cd, lines): (_, Vec<usize>) = plane.iter().copied().flatten().unzip();
        planes.push(Plane { angle_deg: *row, cd, lines: lines.into() });
    }
    Ok(Table { verticals, planes })
}

fn values(xml: &Xml, data: Node, goniometer: Goniometer) -> Result<Vec<Value>, Fault> {
    let (across, up) = match goniometer {
        Goniometer::A => (-180.0..=180.0, -90.0..=90.0),
        Goniometer::B => (-90.0..=90.0, -90.0..=90.0),
        Goniometer::C => (0.0..=360.0, 0.0..=180.0),
    };
    let mut values = Vec::new();
    for node in data.children().filter(is_value) {
        let angle = |names: [&'static str; 3]| {
            let text = names.iter().find_map(|name| node.attribute(*name)).unwrap_or_default();
            xml.parsed(node, text, names[1])
        };
        let horizontal = angle(["h", "horz", "horizontal"])?;
        let vertical = angle(["v", "vert", "vertical"])?;
        let (cd, line) = (xml.parsed(node, node.text().unwrap_or_default(), "intensity")?, xml.line(node));
        if !up.contains(&vertical) || !across.contains(&horizontal) {
            let message = format!(
                "direction h {horizontal}°, v {vertical}°, expected {}–{}° and {}–{}°",
                across.start(),
                across.end(),
                up.start(),
                up.end()
            );
            return Err(Fault::new(line, message, DAMAGED));
        }
        if !(cd >= 0.0) {
            let message = format!("intensity {cd} cd at h {horizontal}°, v {vertical}° is negative");
            return Err(Fault::new(line, message, DAMAGED).coded("negative-intensity"));
        }
        values.push(Value { horizontal, vertical, cd, line });
    }
    Ok(values)
}

/// The counts that the file states: a value that was lost or doubled shows in them.
fn check_counts(xml: &Xml, data: Node, found: [usize; 3]) -> Result<(), Fault> {
    for (name, found) in ["NumberMeasured", "NumberHorz", "NumberVert"].into_iter().zip(found) {
        if let Some(stated) = xml.number(data, name)?.filter(|stated| (stated - found as f64).abs() > 0.0) {
            let message = format!("{name} is {stated}, but {found} are there");
            return Err(Fault::new(xml.line(data), message, DAMAGED));
        }
    }
    Ok(())
}

/// All planes of type C meet at the poles: writers may store those values once.
fn share_poles(cd: &mut [Option<(f64, usize)>], verticals: &[f64]) {
    let columns = verticals.len();
    for pole in [0, columns - 1] {
        let is_pole = verticals[pole] < SAME_DEG || verticals[pole] > 180.0 - SAME_DEG;
        let known = cd.chunks(columns).find_map(|plane| plane[pole]);
        for plane in cd.chunks_mut(columns).filter(|_| is_pole) {
            plane[pole] = plane[pole].or(known);
        }
    }
}
