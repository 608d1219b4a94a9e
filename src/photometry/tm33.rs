//! ANSI/IES TM-33 (XML), by the schema of ATLA S001 that is published with it: TM-33-18 (root `IESTM33`),
//! TM-33-23 (`IESTM33-22`), and the root `LuminaireOpticalData` that other writers use. The trap: the face
//! towards h = 0 measures length × height there, so h = 0 lies *across* the length, as in EULUMDAT.

use roxmltree::{Document, Node};

use super::ies_goniometer::{Goniometer, resampled};
use super::numbers::{Number, shortened};
use super::planes::{Plane, close_circle, mirrored};
use super::tm33_opening::opening;
use super::tm33_table::{Table, table};
use super::{Fault, Finding, Format, IntensityDistribution, Photometry, Places, Symmetry};

pub(super) const DAMAGED: &str = "the file is damaged: get it from its manufacturer again";
/// Azimuth of the luminaire frame minus h.
const TURN_DEG: f64 = -90.0;
/// Elements beside the luminous intensities, and what they hold.
const IGNORED: [(&str, &str); 11] = [
    ("EmitterSpectral", "emitter spectra"),
    ("SpectralDistribution", "emitter spectra"),
    ("AngularSpectral", "angular spectra"),
    ("AngularColor", "angular colours"),
    ("RadiantData", "radiant intensities"),
    ("PhotonData", "photon intensities"),
    ("IllumData", "illuminances"),
    ("IrradData", "irradiances"),
    ("PFDData", "photon flux densities"),
    ("SpecIrradData", "spectral irradiances"),
    ("Channels", "channel multipliers"),
];

/// The root elements.
pub(super) fn recognises(text: &str) -> bool {
    text.trim_start().starts_with('<')
        && (text.contains("<LuminaireOpticalData") || text.contains("<IESTM33"))
}

/// A document and where its lines begin.
pub(super) struct Xml {
    starts: Vec<usize>,
}

impl Xml {
    fn of(text: &str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self { starts: std::iter::once(0).chain(ends.map(|(at, _)| at + 1)).collect() }
    }

    /// The line of a node.
    pub(super) fn line(&self, node: Node) -> usize {
        self.starts.partition_point(|start| *start <= node.range().start)
    }

    /// A number among the children; `None` where there is none.
    pub(super) fn number(&self, node: Node, name: &'static str) -> Result<Option<f64>, Fault> {
        let Some(child) = children(node, name).next() else { return Ok(None) };
        self.parsed(child, child.text().unwrap_or_default(), name).map(Some)
    }

    /// A finite number.
    pub(super) fn parsed(&self, node: Node, text: &str, what: &str) -> Result<f64, Fault> {
        let value = text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| {
            Fault::new(self.line(node), format!("{what}: '{}' is no number", shortened(text)), DAMAGED)
        })
    }
}

/// What one emitter gives.
struct Emitted {
    distribution: IntensityDistribution,
    places: Places,
    rated_lm: Option<f64>,
    relative: bool,
    watts: Option<f64>,
    ra: Option<f64>,
}

pub(super) fn read(text: &str) -> Result<Photometry, Fault> {
    let document = Document::parse(text)
        .map_err(|error| Fault::new(error.pos().row as usize, format!("no XML: {error}"), DAMAGED))?;
    let xml = Xml::of(text);
    let root = document.root_element();
    let emitters: Vec<Node> = children(root, "Emitter").filter(|node| intensities(*node).is_some()).collect();
    if emitters.is_empty() {
        let hint = "only luminous intensities (cd) are read";
        return Err(Fault::new(xml.line(root), "no emitter has luminous intensities", hint));
    }
    let mut findings = Vec::new();
    let mut parts = Vec::new();
    for emitter in &emitters {
        parts.push(emitted(&xml, root, *emitter, &mut findings)?);
    }
    let opening = opening(&xml, root, &emitters, &mut findings)?;
    findings.extend(ignored(&xml, root));
    let distribution = sum(&xml, root, &parts)?;
    if let [_, second, ..] = emitters[..] {
        let message = format!("{} emitters are added into one distribution", emitters.len());
        let consequence = "they shine from one place: illuminance nearer than about ten times their distance from \
                           each other, and the glare of each, are approximate";
        findings.push(Finding::new("emitters-added", xml.line(second), message, consequence));
    }
    if Symmetry::of(&distribution, 1e-3) != Symmetry::Rotational {
        let message = "h = 0° is taken across the luminaire's length, as the schema names its faces";
        let consequence = "where the maker means LM-63's 0° plane, all planes are turned by 90°: crosswise and endwise \
                           are exchanged; set `rotate`";
        findings.push(Finding::new("plane-orientation", xml.line(root), message, consequence));
    }
    let total = |of: fn(&Emitted) -> Option<f64>| parts.iter().map(of).sum::<Option<f64>>();
    let rated_flux_lm = total(|part| part.rated_lm);
    Ok(Photometry {
        format: Format::Tm33,
        description: description(root),
        opening,
        rated_flux_lm,
        lamp_flux_lm: rated_flux_lm.filter(|_| parts.iter().all(|part| part.relative)),
        lor: None,
        power_w: total(|part| part.watts),
        colour_rendering: parts.iter().filter_map(|part| part.ra).reduce(f64::min),
        distribution,
        places: Places {
            opening: Some(xml.line(children(root, "Luminaire").next().unwrap_or(root))),
            ..parts.swap_remove(0).places
        },
        findings,
    })
}

pub(super) fn children<'a, 'd: 'a>(
    node: Node<'a, 'd>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'd>> {
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

/// The element whose children are the luminous intensities: it has three names in the editions.
fn intensities<'a, 'd>(emitter: Node<'a, 'd>) -> Option<Node<'a, 'd>> {
    let named = |node: &Node| {
        matches!(node.tag_name().name(), "LuminousIntensity" | "IntensityDistribution" | "LuminousData")
    };
    let holds = |node: &Node| node.children().any(|child| is_value(&child));
    emitter.descendants().find(|node| named(node) && holds(node))
}

pub(super) fn is_value(node: &Node) -> bool {
    matches!(node.tag_name().name(), "IntData" | "IntensityData")
}

fn emitted(xml: &Xml, root: Node, emitter: Node, findings: &mut Vec<Finding>) -> Result<Emitted, Fault> {
    let data = intensities(emitter).expect("the caller looked");
    let metric = stated(data, "Metric").unwrap_or("Luminous");
    if metric != "Luminous" {
        let message = format!("intensities are {}, not luminous", shortened(metric));
        return Err(Fault::new(xml.line(data), message, "only luminous intensities (cd) are read"));
    }
    let goniometer = goniometer(xml, root, data)?;
    let factor = scale(xml, emitter, data)?;
    let Table { verticals, mut planes } = table(xml, data, goniometer, findings)?;
    for plane in &mut planes {
        plane.cd.iter_mut().for_each(|cd| *cd *= factor);
    }
    let first_line = xml.line(data);
    let power = ["InputWattage", "InputWatts"].into_iter().flat_map(|name| children(emitter, name)).next();
    let rated = ["LuminousFlux", "RatedLumens"]
        .into_iter()
        .find_map(|name| emitter.descendants().find(|node| node.tag_name().name() == name));
    let mut places = Places {
        flux: rated.map(|node| xml.line(node)),
        power: power.map(|node| xml.line(node)),
        gammas: Some([first_line; 2]),
        ..Places::default()
    };
    let fault = |error: super::DistributionError| Fault::new(first_line, error.to_string(), DAMAGED);
    let distribution = if goniometer == Goniometer::C {
        let symmetry = stated(data, "Symm").or(stated(data, "SymmType"));
        let planes = expanded(planes, symmetry, first_line)?;
        places = places.with_planes(&planes, TURN_DEG);
        close_circle(planes, verticals, TURN_DEG).map_err(fault)?
    } else {
        let numbered = |value: f64| Number { value, line: first_line };
        let vertical: Vec<Number> = verticals.into_iter().map(numbered).collect();
        let horizontal: Vec<Number> = planes.iter().map(|plane| numbered(plane.angle_deg)).collect();
        let (distribution, finding) = resampled(goniometer, &vertical, &horizontal, &planes)?;
        findings.extend(finding);
        distribution
    };
    if let Some(tilt) = children(emitter, "TiltAngles").next() {
        let message = "the emitter's flux depends on tilt";
        let consequence = "not applied: mounted at another tilt, flux and illuminance differ";
        findings.push(Finding::new("tilt", xml.line(tilt), message, consequence));
    }
    let quantity = xml.number(emitter, "Quantity")?.filter(|n| *n > 0.0).unwrap_or(1.0);
    let flux = match rated {
        Some(node) => Some(xml.parsed(node, node.text().unwrap_or_default(), "LuminousFlux")?),
        None => None,
    };
    let of_all = rated.is_some_and(|node| node.tag_name().name() == "LuminousFlux");
    let watts = match power {
        Some(node) => Some(xml.parsed(node, node.text().unwrap_or_default(), "InputWattage")?),
        None => None,
    };
    let ra = emitter.descendants().find(|node| node.tag_name().name() == "Ra" && node.text().is_some());
    let ra = ra.and_then(|node| node.text()?.trim().parse::<f64>().ok());
    Ok(Emitted {
        distribution,
        places,
        rated_lm: flux.filter(|lm| *lm > 0.0).map(|lm| if of_all { lm } else { lm * quantity }),
        relative: !of_all && stated(data, "AbsolutePhotometry") == Some("false"),
        watts: watts.filter(|watts| *watts > 0.0),
        ra: ra.filter(|ra| (0.0..=100.0).contains(ra)),
    })
}

/// Type C unless the intensities or the equipment name another.
fn goniometer(xml: &Xml, root: Node, data: Node) -> Result<Goniometer, Fault> {
    let of_equipment = || {
        let equipment = children(root, "Equipment").next()?;
        let device = equipment.children().find(|node| text_of(*node, "Type").is_some())?;
        text_of(device, "Type")
    };
    let kind = stated(data, "PhotometryType").or_else(of_equipment).unwrap_or("C");
    match kind.chars().rev().find(|c| !c.is_whitespace()) {
        Some('A') => Ok(Goniometer::A),
        Some('B') => Ok(Goniometer::B),
        Some('C') => Ok(Goniometer::C),
        _ => {
            let message = format!("photometry of type '{}'", shortened(kind));
            Err(Fault::new(xml.line(data), message, "types A, B and C are read: export the file as type C"))
        }
    }
}

/// Multiplier and ballast factor, each applied once.
fn scale(xml: &Xml, emitter: Node, data: Node) -> Result<f64, Fault> {
    let mut factor = 1.0;
    for (node, name) in [(data, "Multiplier"), (emitter, "BallastFactor")] {
        if let Some(value) = xml.number(node, name)? {
            if !(value > 0.0) {
                return Err(Fault::new(xml.line(node), format!("{name} {value} is not positive"), DAMAGED));
            }
            factor *= value;
        }
    }
    Ok(factor)
}

/// Mirror images by the range of the angles: programs write all planes of a symmetric luminaire as well.
fn expanded(planes: Vec<Plane>, symmetry: Option<&str>, line: usize) -> Result<Vec<Plane>, Fault> {
    let word: String = symmetry.unwrap_or_default().chars().filter(char::is_ascii_alphanumeric).collect();
    let word = word.to_ascii_lowercase();
    let (first, last) = (planes[0].angle_deg, planes[planes.len() - 1].angle_deg);
    let spans = |from: f64, to: f64| (first - from).abs() < 1e-3 && (last - to).abs() < 1e-3;
    if planes.len() == 1 || word.ends_with("full") {
        return Ok(planes.into_iter().take(1).collect());
    }
    if spans(90.0, 270.0) {
        return Ok(mirrored(planes, 90.0));
    }
    if last > 180.0 + 1e-6 {
        return Ok(planes);
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

/// The emitters' distributions, added on all of their angles; each is linear between its own.
fn sum(xml: &Xml, root: Node, parts: &[Emitted]) -> Result<IntensityDistribution, Fault> {
    let [first, others @ ..] = parts else { unreachable!("there is at least one emitter") };
    if others.is_empty() {
        return Ok(first.distribution.clone());
    }
    let grids: Vec<_> = parts.iter().filter_map(|part| part.distribution.grid()).collect();
    let ends = |gammas: &[f64]| [gammas[0], gammas[gammas.len() - 1]];
    let apart = |(_, gammas): &&(&[f64], &[f64])| {
        let ([from, to], [from_0, to_0]) = (ends(gammas), ends(grids[0].1));
        (from - from_0).abs() > 1e-6 || (to - to_0).abs() > 1e-6
    };
    if grids.iter().any(|grid| apart(&grid)) {
        let hint = "export each emitter as a file of its own, or the luminaire as a whole";
        return Err(Fault::new(xml.line(root), "the emitters do not cover the same angles", hint));
    }
    let union = |mut angles: Vec<f64>| {
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|next, kept| *next - *kept < 1e-6);
        angles
    };
    let azimuths = union(grids.iter().flat_map(|grid| grid.0.to_vec()).collect());
    let gammas = union(grids.iter().flat_map(|grid| grid.1.to_vec()).collect());
    let at = |azimuth: f64, gamma: f64| -> f64 {
        parts.iter().map(|part| part.distribution.intensity_at(azimuth, gamma)).sum()
    };
    let plane = |azimuth: f64| gammas.iter().map(|gamma| at(azimuth, *gamma)).collect::<Vec<f64>>();
    let mut cd: Vec<Vec<f64>> =
        azimuths[..azimuths.len() - 1].iter().map(|azimuth| plane(*azimuth)).collect();
    cd.push(cd[0].clone());
    IntensityDistribution::from_grid(azimuths, gammas, cd)
        .map_err(|error| Fault::new(xml.line(root), error.to_string(), DAMAGED))
}

/// What else the file holds, counted.
fn ignored(xml: &Xml, root: Node) -> Option<Finding> {
    let found = |(name, what): &(&'static str, &'static str)| {
        let count = root.descendants().filter(|node| node.tag_name().name() == *name).count();
        (count > 0).then(|| format!("{what}: {count}"))
    };
    let told: Vec<String> = IGNORED.iter().filter_map(found).collect();
    let first =
        root.descendants().find(|node| IGNORED.iter().any(|(name, _)| node.tag_name().name() == *name))?;
    let message = format!("not read: {}", told.join("; "));
    let consequence =
        "light is computed from the luminous intensities alone; nothing depends on the colour of light";
    Some(Finding::new("ignored-data", xml.line(first), message, consequence))
}

fn description(root: Node) -> String {
    let Some(header) = children(root, "Header").next() else { return String::new() };
    let parts = ["Manufacturer", "CatalogNumber", "Description"].map(|name| text_of(header, name));
    parts.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
#[path = "tm33_tests.rs"]
pub(super) mod tests;
