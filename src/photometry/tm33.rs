//! ANSI/IES TM-33 (XML): TM-33-18 (ATLA S001, root `LuminaireOpticalData`) and TM-33-23 (root
//! `IESTM33-22`), as far as they are openly documented. One distribution of type C is read; spectra are
//! not. Its horizontal 0° plane is taken as LM-63's: *along* the luminaire (+x).

use roxmltree::{Document, Node};

use super::numbers::{MAX_VALUES, shortened};
use super::planes::{Plane, close_circle, mirrored};
use super::{Fault, Finding, Format, Opening, Photometry, Places};

const DAMAGED: &str = "the file is damaged: get it from its manufacturer again";
/// Angles closer than this are one, degrees.
const SAME_DEG: f64 = 1e-6;
const MM: f64 = 1e-3;

/// The two root elements.
pub(super) fn recognises(text: &str) -> bool {
    text.trim_start().starts_with('<')
        && (text.contains("<LuminaireOpticalData") || text.contains("<IESTM33-"))
}

pub(super) fn read(text: &str) -> Result<Photometry, Fault> {
    let document = Document::parse(text)
        .map_err(|error| Fault::new(error.pos().row as usize, format!("no XML: {error}"), DAMAGED))?;
    let root = document.root_element();
    let mut findings = Vec::new();
    let emitters: Vec<Node> = children(root, "Emitter").filter(|node| intensities(*node).is_some()).collect();
    let [emitter] = emitters[..] else {
        let message = format!("{} emitters with luminous intensities, one is needed", emitters.len());
        let hint = "export each emitter as a file of its own, or the luminaire as a whole";
        return Err(Fault::new(line(root), message, hint));
    };
    let data = intensities(emitter).expect("filtered above");
    check_kind(data)?;
    let (gammas_deg, planes) = table(data, &mut findings)?;
    let factor = scale(emitter, data)?;
    let planes = planes
        .into_iter()
        .map(|plane| Plane { cd: plane.cd.into_iter().map(|cd| cd * factor).collect(), ..plane });
    let planes = expanded(planes.collect(), stated(data, "Symm").or(stated(data, "SymmType")), line(data))?;
    let first_line = line(data);
    let places = Places { gammas: Some([first_line; 2]), ..Places::default() }.with_planes(&planes, 0.0);
    let distribution = close_circle(planes, gammas_deg, 0.0)
        .map_err(|error| Fault::new(line(data), error.to_string(), DAMAGED))?;
    let quantity = number(emitter, "Quantity")?.filter(|n| *n > 0.0).unwrap_or(1.0);
    let lumens = number(emitter, "RatedLumens")?.filter(|lm| *lm > 0.0).map(|lm| lm * quantity);
    let watts = number(emitter, "InputWattage")?.or(number(emitter, "InputWatts")?);
    let ra = children(emitter, "ColorRendering").find_map(|node| number(node, "Ra").ok().flatten());
    Ok(Photometry {
        format: Format::Tm33,
        description: description(root),
        opening: opening(root, &mut findings)?,
        rated_flux_lm: lumens,
        lamp_flux_lm: lumens.filter(|_| stated(data, "AbsolutePhotometry") == Some("false")),
        lor: None,
        power_w: watts.filter(|watts| *watts > 0.0),
        colour_rendering: ra.filter(|ra| (0.0..=100.0).contains(ra)),
        distribution,
        places,
        findings,
    })
}

fn line(node: Node) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

fn children<'a, 'd: 'a>(node: Node<'a, 'd>, name: &'static str) -> impl Iterator<Item = Node<'a, 'd>> {
    node.children().filter(move |child| child.tag_name().name() == name)
}

fn text_of<'a>(node: Node<'a, '_>, name: &'static str) -> Option<&'a str> {
    let child = node.children().find(|child| child.tag_name().name() == name)?;
    child.text().map(str::trim).filter(|text| !text.is_empty())
}

/// Stated beside the intensities, or one level above: the editions differ.
fn stated<'a>(data: Node<'a, '_>, name: &'static str) -> Option<&'a str> {
    let above = data.parent_element().filter(|node| node.tag_name().name() == "LuminousData");
    text_of(data, name).or_else(|| text_of(above?, name))
}

fn number(node: Node, name: &'static str) -> Result<Option<f64>, Fault> {
    let Some(child) = children(node, name).next() else { return Ok(None) };
    parsed(child, child.text().unwrap_or_default(), name).map(Some)
}

fn parsed(node: Node, text: &str, what: &str) -> Result<f64, Fault> {
    let value = text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    value
        .ok_or_else(|| Fault::new(line(node), format!("{what}: '{}' is no number", shortened(text)), DAMAGED))
}

/// The element whose children are the intensities: it has three names in the editions.
fn intensities<'a, 'd>(emitter: Node<'a, 'd>) -> Option<Node<'a, 'd>> {
    let named = |node: &Node| {
        matches!(node.tag_name().name(), "LuminousIntensity" | "IntensityDistribution" | "LuminousData")
    };
    let holds = |node: &Node| node.children().any(|child| is_value(&child));
    emitter.descendants().find(|node| named(node) && holds(node))
}

fn is_value(node: &Node) -> bool {
    matches!(node.tag_name().name(), "IntData" | "IntensityData")
}

fn check_kind(data: Node) -> Result<(), Fault> {
    let kind = stated(data, "PhotometryType").unwrap_or("C");
    if !kind.ends_with('C') {
        let message = format!("photometry of type {}", shortened(kind));
        return Err(Fault::new(
            line(data),
            message,
            "only type C is read from TM-33: export the file as type C",
        ));
    }
    let metric = stated(data, "Metric").unwrap_or("Luminous");
    if metric != "Luminous" {
        let message = format!("intensities are {}, not luminous", shortened(metric));
        return Err(Fault::new(line(data), message, "only luminous intensities (cd) are read"));
    }
    Ok(())
}

/// All values on the grid of their angles; every direction must be there once.
fn table(data: Node, findings: &mut Vec<Finding>) -> Result<(Vec<f64>, Vec<Plane>), Fault> {
    let mut values = Vec::new();
    for node in data.children().filter(is_value) {
        let angle = |short: &'static str, long: &'static str| {
            let text = node.attribute(short).or(node.attribute(long)).unwrap_or_default();
            parsed(node, text, long)
        };
        let (horizontal, vertical) = (angle("h", "horz")?, angle("v", "vert")?);
        let cd = parsed(node, node.text().unwrap_or_default(), "intensity")?;
        if !(0.0..=180.0).contains(&vertical) || !(0.0..=360.0).contains(&horizontal) {
            let message = format!("direction h {horizontal}°, v {vertical}°, expected 0–360° and 0–180°");
            return Err(Fault::new(line(node), message, DAMAGED));
        }
        if !(cd >= 0.0) {
            let message = format!("intensity {cd} cd at h {horizontal}°, v {vertical}° is negative");
            return Err(Fault::new(line(node), message, DAMAGED));
        }
        values.push((horizontal, vertical, cd, line(node)));
    }
    let axis = |of: fn(&(f64, f64, f64, usize)) -> f64| {
        let mut axis: Vec<f64> = values.iter().map(of).collect();
        axis.sort_by(f64::total_cmp);
        axis.dedup_by(|next, kept| *next - *kept < SAME_DEG);
        axis
    };
    let (horizontals, verticals) = (axis(|value| value.0), axis(|value| value.1));
    let cells = horizontals.len().saturating_mul(verticals.len());
    if verticals.len() < 2 || cells > MAX_VALUES || cells > 4 * values.len() + 4096 {
        let message = format!("{} vertical and {} horizontal angles", verticals.len(), horizontals.len());
        return Err(Fault::new(line(data), message, DAMAGED));
    }
    let mut cd = vec![None; cells];
    let mut doubled = 0;
    for (horizontal, vertical, value, line) in &values {
        let at = |axis: &[f64], angle: f64| axis.partition_point(|known| *known < angle - SAME_DEG);
        let cell = &mut cd[at(&horizontals, *horizontal) * verticals.len() + at(&verticals, *vertical)];
        doubled += usize::from(cell.is_some());
        cell.get_or_insert((*value, *line));
    }
    if doubled > 0 {
        let message = format!("{doubled} directions are given twice");
        let consequence = "the first value counts; if the others differ, the distribution is uncertain";
        findings.push(Finding::new("trailing-data", line(data), message, consequence));
    }
    let columns = verticals.len();
    // All planes meet at the poles: writers may store those values once.
    for pole in [0, columns - 1] {
        let is_pole = verticals[pole] < SAME_DEG || verticals[pole] > 180.0 - SAME_DEG;
        let known = (0..horizontals.len()).find_map(|row| cd[row * columns + pole]);
        for row in (0..horizontals.len()).filter(|_| is_pole) {
            cd[row * columns + pole] = cd[row * columns + pole].or(known);
        }
    }
    let mut planes = Vec::new();
    for (row, plane) in horizontals.iter().zip(cd.chunks(columns)) {
        let missing = plane.iter().position(Option::is_none);
        if let Some(missing) = missing {
            let message = format!("no intensity at h {row}°, v {}°", verticals[missing]);
            return Err(Fault::new(line(data), message, DAMAGED));
        }
        let (cd, lines): (_, Vec<usize>) = plane.iter().copied().flatten().unzip();
        planes.push(Plane { angle_deg: *row, cd, lines: lines.into() });
    }
    Ok((verticals, planes))
}

/// Multiplier and ballast factor, each applied once.
fn scale(emitter: Node, data: Node) -> Result<f64, Fault> {
    let mut factor = 1.0;
    for (node, name) in [(data, "Multiplier"), (emitter, "BallastFactor")] {
        if let Some(value) = number(node, name)? {
            if !(value > 0.0) {
                return Err(Fault::new(line(node), format!("{name} {value} is not positive"), DAMAGED));
            }
            factor *= value;
        }
    }
    Ok(factor)
}

/// Mirror images by the declared symmetry, or where none is declared by the range of the angles.
fn expanded(planes: Vec<Plane>, symmetry: Option<&str>, line: usize) -> Result<Vec<Plane>, Fault> {
    let word: String = symmetry.unwrap_or_default().chars().filter(char::is_ascii_alphanumeric).collect();
    let word = word.to_ascii_lowercase();
    let (first, last) = (planes[0].angle_deg, planes[planes.len() - 1].angle_deg);
    let spans = |from: f64, to: f64| (first - from).abs() < 1e-3 && (last - to).abs() < 1e-3;
    if planes.len() == 1 || word.ends_with("full") {
        return Ok(planes.into_iter().take(1).collect());
    }
    // Programs write all planes of a symmetric luminaire as well: the range decides.
    if last > 180.0 + SAME_DEG && !spans(90.0, 270.0) {
        return Ok(planes);
    }
    if spans(90.0, 270.0) {
        return Ok(mirrored(planes, 90.0));
    }
    if spans(0.0, 90.0) {
        return Ok(mirrored(mirrored(planes, 0.0), 90.0));
    }
    if spans(0.0, 180.0) {
        return Ok(mirrored(planes, 0.0));
    }
    let message = format!("horizontal angles run from {first}° to {last}° (symmetry '{}')", shortened(&word));
    Err(Fault::new(line, message, "type C needs 0°, 0–90°, 0–180°, 90–270° or 0–360°"))
}

fn description(root: Node) -> String {
    let Some(header) = children(root, "Header").next() else { return String::new() };
    let parts = ["Manufacturer", "CatalogNumber", "Description"].map(|name| text_of(header, name));
    parts.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// The editions do not agree on where the luminous opening is described, so the luminaire's own
/// dimensions stand for it.
fn opening(root: Node, findings: &mut Vec<Finding>) -> Result<Opening, Fault> {
    let size = children(root, "Luminaire").find_map(|luminaire| children(luminaire, "Dimensions").next());
    let Some(size) = size else { return Ok(Opening::Point) };
    let edge = |name: &'static str| Ok(number(size, name)?.unwrap_or(0.0).max(0.0) * MM);
    let (length_m, width_m) = (edge("Length")?, edge("Width")?);
    let opening = match (length_m > 0.0, width_m > 0.0) {
        (true, true) => Opening::rect(length_m, width_m),
        (true, false) | (false, true) => Opening::Disc { diameter_m: length_m.max(width_m), height_m: 0.0 },
        (false, false) => return Ok(Opening::Point),
    };
    let message = format!(
        "the luminaire's own size of {length_m:.3} × {width_m:.3} m is taken as its luminous opening"
    );
    let consequence = "luminance and UGR are too low where less of it shines; set `area`";
    findings.push(Finding::new("opening-approximated", line(size), message, consequence));
    Ok(opening)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::{PhotometryError, parse};
    use super::*;

    pub(in super::super) const SAMPLE: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<IESTM33-22>
  <Version>1.1</Version>
  <Header><Manufacturer>Maker</Manufacturer><CatalogNumber>T-1</CatalogNumber></Header>
  <Luminaire><Dimensions><Length>1200</Length><Width>300</Width><Height>80</Height></Dimensions></Luminaire>
  <Emitter>
    <Quantity>1</Quantity><RatedLumens>390</RatedLumens><InputWattage>4</InputWattage>
    <ColorRendering><Ra>82</Ra></ColorRendering>
    <LuminousData>
      <PhotometryType>CIE _ C</PhotometryType><Metric>Luminous</Metric><SymmType>Symm _ Quad</SymmType>
      <LuminousIntensity>
        <Multiplier>2</Multiplier>
        <IntData h="0" v="0">50</IntData><IntData h="0" v="45">50</IntData><IntData h="0" v="90">0</IntData>
        <IntData h="90" v="0">50</IntData><IntData h="90" v="45">20</IntData><IntData h="90" v="90">0</IntData>
      </LuminousIntensity>
    </LuminousData>
  </Emitter>
</IESTM33-22>
"#;

    fn edited(from: &str, to: &str) -> Result<Photometry, PhotometryError> {
        assert!(SAMPLE.contains(from), "{from}");
        parse(SAMPLE.replace(from, to).as_bytes(), "x.xml")
    }

    /// Catches: a multiplier forgotten, planes not mirrored, 0° laid across, millimetres as metres.
    #[test]
    fn factors_frame_and_sizes() {
        let lamp = edited("T-1", "T-1").expect("sound");
        let at = |azimuth: f64| lamp.distribution.intensity_at(azimuth, 45.0);
        for (azimuth, cd) in [(0.0, 100.0), (180.0, 100.0), (90.0, 40.0), (270.0, 40.0), (225.0, 70.0)] {
            assert!((at(azimuth) - cd).abs() < 1e-9, "{azimuth}: {}", at(azimuth));
        }
        assert_eq!(lamp.opening, Opening::rect(1.2, 0.3));
        assert_eq!((lamp.format, lamp.description.as_str()), (Format::Tm33, "Maker T-1"));
        assert_eq!(
            (lamp.power_w, lamp.colour_rendering, lamp.rated_flux_lm),
            (Some(4.0), Some(82.0), Some(390.0))
        );
    }

    /// Catches: the older edition's names unknown, values at the pole demanded once per plane.
    #[test]
    fn the_older_edition_reads_alike() {
        let older = SAMPLE
            .replace("IESTM33-22>", "LuminaireOpticalData>")
            .replace("LuminousIntensity>", "IntensityDistribution>")
            .replace("IntData", "IntensityData")
            .replace(" h=", " horz=")
            .replace(" v=", " vert=")
            .replace(r#"<IntensityData horz="90" vert="0">50</IntensityData>"#, "");
        let [a, b] = [SAMPLE, &older].map(|text| parse(text.as_bytes(), "x.xml").expect("sound"));
        assert!((a.distribution.flux().0 - b.distribution.flux().0).abs() < 1e-9);
    }

    /// Catches: radiant intensities as candelas, type B as C, a hole in the table, several emitters as
    /// one, a panic on damage.
    #[test]
    fn what_cannot_be_read_is_refused_with_its_line() {
        for (from, to, what) in [
            ("CIE _ C", "CIE _ B", "type"),
            (">Luminous<", ">Radiant<", "luminous"),
            (r#"<IntData h="90" v="45">20</IntData>"#, "", "no intensity"),
            (r#"v="45">20"#, r#"v="45">-20"#, "negative"),
            (r#"v="45">20"#, r#"v="45">x"#, "no number"),
            ("</IESTM33-22>", "", "XML"),
            ("<Multiplier>2", "<Multiplier>0", "not positive"),
            ("Emitter>", "Emiter>", "0 emitters"),
        ] {
            let error = edited(from, to).expect_err(what);
            assert!(error.to_string().contains(what) && error.line > 0, "{error}");
        }
    }
}
