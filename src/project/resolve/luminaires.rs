//! `[luminaires]` → luminaire types. A type without maintenance of its own takes the room's, so one
//! entry may become several types; the second is named after its room.

use std::sync::Arc;

use super::draft::RoomFactors;
use super::rooms::check_factor;
use crate::geometry::gltf::ProfileFile;
use crate::luminaire::{LuminaireType, Maintenance};
use crate::photometry::{self, IntensityDistribution, Opening};
use crate::project::choices::{EmergencyChoice, Factor, OpeningChoice};
use crate::project::context::{Context, SMALL_FILE};
use crate::project::diagnostics::Diagnostic;
use crate::project::photometric::is_plain;
use crate::project::schema::{At, File, LuminaireSection};
use crate::units::Lumens;

/// An entry of `[luminaires]`.
#[derive(Debug)]
pub struct Kind {
    pub name: String,
    /// `None` after a mistake that was reported.
    base: Option<LuminaireType>,
    own_maintenance: bool,
    /// Nodes of its housing, looked up where it is placed.
    pub body: Vec<At<String>>,
    made: Vec<Arc<LuminaireType>>,
}

impl Kind {
    /// The room's factors that do not hold for this type, since it brings its own.
    pub fn passed_over(&self, factors: &RoomFactors) -> Vec<&'static str> {
        if self.own_maintenance { factors.given() } else { Vec::new() }
    }

    /// The type as it hangs in a room.
    pub fn in_room(&mut self, factors: &RoomFactors, room: &str) -> Option<Arc<LuminaireType>> {
        let base = self.base.as_ref()?;
        let maintenance = if self.own_maintenance {
            base.maintenance
        } else {
            Maintenance {
                llmf: factors.llmf.unwrap_or(1.0),
                lsf: factors.lsf.unwrap_or(1.0),
                lmf: factors.lmf.unwrap_or(1.0),
            }
        };
        if let Some(known) = self.made.iter().find(|k| k.maintenance == maintenance) {
            return Some(known.clone());
        }
        let name = if self.made.is_empty() { base.name.clone() } else { format!("{} ({room})", base.name) };
        let kind = Arc::new(LuminaireType { name, maintenance, ..base.clone() });
        self.made.push(kind.clone());
        Some(kind)
    }
}

impl Kind {
    /// The type of a light source of a CAD file: a point.
    pub fn of_light(name: &str, description: &str, distribution: IntensityDistribution) -> Self {
        let source = Source {
            distribution,
            opening: Opening::Point,
            description: description.to_owned(),
            rated_flux_lm: None,
            power_w: None,
            declared_ra: None,
        };
        Self::of_source(name, source, String::new())
    }

    /// The type under another name.
    pub fn named(mut self, name: String) -> Self {
        if let Some(base) = &mut self.base {
            base.name.clone_from(&name);
        }
        Self { name, ..self }
    }

    fn of_source(name: &str, source: Source, file: String) -> Self {
        let base = LuminaireType {
            name: name.to_owned(),
            flux_lm: source.distribution.flux().0,
            maintenance: Maintenance::NEW,
            emergency: None,
            declared_ra: source.declared_ra,
            description: source.description,
            distribution: source.distribution,
            opening: source.opening,
            rated_flux_lm: source.rated_flux_lm,
            power_w: source.power_w,
            file,
        };
        Self {
            name: name.to_owned(),
            base: Some(base),
            own_maintenance: false,
            body: Vec::new(),
            made: Vec::new(),
        }
    }
}

/// The type of a light source of a CAD file that names a photometric file.
pub fn profile(
    name: &str,
    label: &str,
    stored: &ProfileFile,
    factor: f64,
    cad: &At<String>,
    wanted: &At<bool>,
    context: &mut Context,
) -> Option<Kind> {
    let (file, bytes) = match stored {
        ProfileFile::Bytes(bytes) => (format!("{}#{name}", cad.get_ref()), bytes.clone()),
        ProfileFile::Path(path) => {
            let folder = cad.get_ref().rfind(['/', '\\']).map_or("", |at| &cad.get_ref()[..=at]);
            let file = format!("{folder}{path}");
            match context.read_path(&file, SMALL_FILE) {
                Ok(bytes) => (file, bytes),
                Err((message, hint)) => {
                    context.error(&wanted.span(), format!("{label}: {message}"), hint);
                    return None;
                }
            }
        }
    };
    let mut source = from_bytes(&bytes, &file, context)?;
    source.distribution = source.distribution.scaled(factor);
    if !(source.distribution.flux().0 > 0.0) {
        context.note(format!("{label} is dark"));
        return None;
    }
    Some(Kind::of_source(name, source, file))
}

/// Checks all entries and reads their files.
pub fn kinds(file: &File, context: &mut Context) -> Vec<Kind> {
    let read = file.luminaires.iter().map(|(name, section)| Kind {
        name: name.get_ref().clone(),
        base: luminaire_type(name, section, context),
        own_maintenance: section.get_ref().maintenance.is_some(),
        body: section.get_ref().body.clone(),
        made: Vec::new(),
    });
    let lost = file.lost_names("luminaires").map(|name| Kind {
        name: name.get_ref().clone(),
        base: None,
        own_maintenance: false,
        body: Vec::new(),
        made: Vec::new(),
    });
    read.chain(lost).collect()
}

fn luminaire_type(
    name: &At<String>,
    entry: &At<LuminaireSection>,
    context: &mut Context,
) -> Option<LuminaireType> {
    let section = entry.get_ref();
    let maintenance =
        section.maintenance.as_ref().map_or(Some(Maintenance::NEW), |factor| maintenance(factor, context));
    if let Some(ra) = &section.ra {
        context.in_range(ra, 0.0, 100.0, "ra");
    }
    let area = section.area.as_ref().map(|area| opening(area, context));
    let flux =
        section.flux.as_ref().is_none_or(|flux| context.positive(*flux.get_ref(), &flux.span(), "flux"));
    let sources = [section.file.is_some(), section.lambert.is_some(), section.point.is_some()];
    if sources.into_iter().filter(|given| *given).count() != 1 {
        let message = format!("luminaire \"{}\" needs exactly one of file, lambert, point", name.get_ref());
        let several = sources.into_iter().any(|given| given);
        if several || !context.misspelt.contains(&entry.span()) {
            context.error(&name.span(), message, "");
        }
        return None;
    }
    let source = if let Some(file) = &section.file {
        from_file(file, context)
    } else {
        built_in(section, area.is_some(), context)
    };
    let (Some(maintenance), Some(mut source), true) = (maintenance, source, flux) else {
        return None;
    };
    if let Some(area) = area {
        source.opening = area.ok()?.unwrap_or(source.opening);
    }
    if let Some(flux) = &section.flux {
        let factor = flux.get_ref() / source.distribution.flux().0;
        source.distribution = source.distribution.scaled(factor);
    }
    let flux_lm = source.distribution.flux().0;
    let emergency = match &section.emergency {
        Some(choice) => Some(emergency(choice, flux_lm, context)?),
        None => None,
    };
    Some(LuminaireType {
        name: name.get_ref().clone(),
        flux_lm,
        maintenance,
        emergency,
        declared_ra: section.ra.as_ref().map(|ra| *ra.get_ref()).or(source.declared_ra),
        description: source.description,
        distribution: source.distribution,
        opening: source.opening,
        rated_flux_lm: source.rated_flux_lm,
        power_w: source.power_w,
        file: section.file.as_ref().map_or(String::new(), |file| file.get_ref().clone()),
    })
}

struct Source {
    distribution: IntensityDistribution,
    opening: Opening,
    description: String,
    rated_flux_lm: Option<f64>,
    power_w: Option<f64>,
    declared_ra: Option<f64>,
}

fn from_file(file: &At<String>, context: &mut Context) -> Option<Source> {
    let mut bytes = context.read(file, SMALL_FILE)?;
    if let Some(name) = photometry::tilt_file(&bytes).filter(|name| is_plain(name)) {
        let folder = file.get_ref().rfind(['/', '\\']).map_or("", |at| &file.get_ref()[..=at]);
        if let Ok(tilt) = context.read_path(&format!("{folder}{name}"), SMALL_FILE) {
            bytes = photometry::with_tilt(&bytes, &tilt);
        }
    }
    from_bytes(&bytes, file.get_ref(), context)
}

fn from_bytes(bytes: &[u8], file: &str, context: &mut Context) -> Option<Source> {
    match photometry::parse(bytes, file) {
        Ok(photometry) => {
            for finding in &photometry.findings {
                let line = finding.line.map_or(String::new(), |line| format!(":{line}"));
                context.note(format!("{file}{line}: {finding}"));
            }
            Some(Source {
                distribution: photometry.distribution,
                opening: photometry.opening,
                description: photometry.description,
                rated_flux_lm: photometry.rated_flux_lm,
                power_w: photometry.power_w,
                declared_ra: photometry.colour_rendering,
            })
        }
        Err(error) => {
            let text = String::from_utf8_lossy(bytes);
            let first = text.lines().nth(error.line.saturating_sub(1));
            let source_line: String =
                first.unwrap_or_default().chars().filter(|c| !c.is_control()).take(120).collect();
            context.diagnostics.push(Diagnostic {
                file: error.file,
                line: error.line,
                column: 1,
                width: source_line.chars().count().max(1),
                source_line,
                message: error.message,
                hint: error.hint,
            });
            None
        }
    }
}

fn built_in(section: &LuminaireSection, has_area: bool, context: &mut Context) -> Option<Source> {
    let is_lambert = section.lambert.is_some();
    let entry = section.lambert.as_ref().or(section.point.as_ref())?;
    let flux = &entry.get_ref().flux;
    let mut ok = context.positive(*flux.get_ref(), &flux.span(), "flux");
    if let Some(second) = &section.flux {
        context.error(&second.span(), "the flux is given twice", "leave one out");
        ok = false;
    }
    if let (true, Some(area)) = (!is_lambert, &section.area) {
        context.error(&area.span(), "a point has no area", "use `lambert`");
        ok = false;
    }
    if is_lambert && !has_area {
        let hint = "area = { rect = [length, width] } or { disc = diameter }";
        context.error(&entry.span(), "a Lambertian source needs an `area`", hint);
        ok = false;
    }
    if let (true, Some(area)) = (is_lambert, &section.area)
        && *area.get_ref() == OpeningChoice::File
    {
        context.error(&area.span(), "there is no file whose area could be taken", "");
        ok = false;
    }
    let lumens = Lumens(*flux.get_ref());
    ok.then(|| Source {
        distribution: if is_lambert {
            IntensityDistribution::lambert(lumens)
        } else {
            IntensityDistribution::isotropic(lumens)
        },
        opening: Opening::Point,
        description: if is_lambert { "Lambertian source" } else { "Isotropic point source" }.to_owned(),
        rated_flux_lm: None,
        power_w: None,
        declared_ra: None,
    })
}

/// `None`: the file's own area; `Err` after a reported mistake.
fn opening(area: &At<OpeningChoice>, context: &mut Context) -> Result<Option<Opening>, ()> {
    let edges: &[f64] = match area.get_ref() {
        OpeningChoice::File => &[],
        OpeningChoice::Rect(edges) => edges,
        OpeningChoice::Disc(diameter) => std::slice::from_ref(diameter),
    };
    for edge in edges {
        if !context.positive(*edge, &area.span(), "an edge of the area") {
            return Err(());
        }
    }
    Ok(match *area.get_ref() {
        OpeningChoice::File => None,
        OpeningChoice::Rect([length_m, width_m]) => {
            Some(Opening::Rect { length_m, width_m, side_x_m: 0.0, side_y_m: 0.0 })
        }
        OpeningChoice::Disc(diameter_m) => Some(Opening::Disc { diameter_m, height_m: 0.0 }),
    })
}

/// Share of the flux that is left in an emergency.
fn emergency(choice: &At<EmergencyChoice>, flux_lm: f64, context: &mut Context) -> Option<f64> {
    let share = match *choice.get_ref() {
        EmergencyChoice::Share(share) => share,
        EmergencyChoice::Flux(lm) => lm / flux_lm,
    };
    if share > 0.0 && share <= 1.0 {
        return Some(share);
    }
    let message = format!("the emergency output is {share:.3} of the flux of {flux_lm:.0} lm");
    context.error(
        &choice.span(),
        message,
        "a share above 0 and at most 1, or { flux = lm }; leave it out where it is dark",
    );
    None
}

fn maintenance(factor: &At<Factor>, context: &mut Context) -> Option<Maintenance> {
    let maintenance = match *factor.get_ref() {
        Factor::Whole(whole) => Maintenance { llmf: whole, ..Maintenance::NEW },
        Factor::Parts { llmf, lsf, lmf } => Maintenance { llmf, lsf, lmf },
    };
    let Maintenance { llmf, lsf, lmf } = maintenance;
    for value in [llmf, lsf, lmf] {
        if !check_factor(&At::new(factor.span(), value), "maintenance", context) {
            return None;
        }
    }
    Some(maintenance)
}
