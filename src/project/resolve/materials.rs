//! `[materials]` → scattering models, and which of them were used.

use std::ops::Range;

use crate::material::pane::Table;
use crate::material::{Bsdf, Lobe, Material, Pane, Phong, PhongPaper, Ward};
use crate::project::choices::GlassChoice;
use crate::project::context::Context;
use crate::project::diagnostics::suggestion;
use crate::project::schema::{At, File, MaterialSection};

/// The materials of the project.
#[derive(Debug)]
pub struct Palette {
    entries: Vec<Entry>,
    /// Names that exist in the scene, for hints.
    known: Vec<String>,
}

#[derive(Debug)]
struct Entry {
    name: At<String>,
    /// `None` after a mistake that was reported.
    bsdf: Option<Bsdf>,
    used: bool,
}

/// What [`Palette::find`] found.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "one at a time, while a project is read")]
pub enum Lookup {
    /// No such entry.
    Absent,
    /// An entry with a mistake that was reported.
    Wrong,
    Found(Material),
}

impl Palette {
    /// Checks all entries.
    pub fn new(file: &File, context: &mut Context) -> Self {
        let read = file.materials.iter();
        let read = read.map(|(name, section)| Entry {
            name: name.clone(),
            bsdf: bsdf(section, context),
            used: false,
        });
        let lost = file.lost_names("materials");
        let lost = lost.map(|name| Entry { name: name.clone(), bsdf: None, used: true });
        let entries = read.chain(lost).collect();
        Self { entries, known: Vec::new() }
    }

    /// The entry of this name, marked as used.
    pub fn find(&mut self, name: &str) -> Lookup {
        self.known.push(name.to_owned());
        let mut entries = self.entries.iter_mut();
        let Some(entry) = entries.find(|entry| entry.name.get_ref() == name) else {
            return Lookup::Absent;
        };
        entry.used = true;
        entry.bsdf.map_or(Lookup::Wrong, |bsdf| Lookup::Found(Material { name: name.to_owned(), bsdf }))
    }

    /// The material a place in the file names; an unknown one is reported.
    pub fn named(&mut self, name: &At<String>, context: &mut Context) -> Option<Material> {
        match self.find(name.get_ref()) {
            Lookup::Found(material) => return Some(material),
            Lookup::Wrong => return None,
            Lookup::Absent => {}
        }
        let names = self.entries.iter().map(|entry| entry.name.get_ref().as_str());
        let hint = suggestion(name.get_ref(), names);
        let message = format!("no material \"{}\" in [materials]", name.get_ref());
        context.error(&name.span(), message, &hint);
        None
    }

    /// Place of an entry.
    pub fn span(&self, name: &str) -> Option<Range<usize>> {
        let mut entries = self.entries.iter();
        entries.find(|entry| entry.name.get_ref() == name).map(|entry| entry.name.span())
    }

    /// Reports entries that belong to nothing: they are misspelt.
    pub fn report_unused(&self, context: &mut Context) {
        for entry in self.entries.iter().filter(|entry| !entry.used) {
            let name = entry.name.get_ref();
            let mut known = self.known.clone();
            known.sort();
            known.dedup();
            let hint = suggestion(name, known.iter().map(String::as_str));
            let message = format!("no such material: nothing in the scene uses \"{name}\"");
            context.error(&entry.name.span(), message, &hint);
        }
    }
}

/// A diffuse material.
pub fn lambert(name: &str, reflectance: f64) -> Material {
    Material { name: name.to_owned(), bsdf: Bsdf::Lambert { reflectance } }
}

/// Exponents of a Phong lobe: below 1 it is no highlight, above the largest it is a mirror.
const EXPONENTS: [f64; 2] = [1.0, 1e6];
/// Roughness α of Ward's lobe: from almost a mirror to almost diffuse.
const ROUGHNESSES: [f64; 2] = [0.001, 1.0];

/// Diffuse or total reflectance that counts for a room's means; `None` for panes. Of a glossy surface
/// it is that at normal incidence.
pub fn mean_reflectance(bsdf: &Bsdf) -> Option<f64> {
    match *bsdf {
        Bsdf::Lambert { reflectance }
        | Bsdf::Mirror { reflectance }
        | Bsdf::Emitter { reflectance, .. }
        | Bsdf::Opal { reflectance, .. } => Some(reflectance),
        Bsdf::Glossy { .. } => Some(bsdf.albedo(1.0)),
        Bsdf::Glass(_) => None,
    }
}

fn bsdf(section: &At<MaterialSection>, context: &mut Context) -> Option<Bsdf> {
    let MaterialSection { reflectance, specular, mirror, glass, opal, emit, .. } = section.get_ref();
    let before = context.diagnostics.len();
    let whole = section.span();
    for (value, name) in [(reflectance, "reflectance"), (specular, "specular"), (mirror, "mirror")] {
        if let Some(value) = value {
            context.in_range(value, 0.0, 1.0, name);
        }
    }
    if let (Some(diffuse), Some(specular)) = (reflectance, specular) {
        let sum = diffuse.get_ref() + specular.get_ref();
        if sum > 1.0 + 1e-9 {
            let message = format!("reflectance + specular must not exceed 1, they make {sum}");
            context.error(&specular.span(), message, "");
        }
    }
    let pane = glass.as_ref().and_then(|glass| pane(glass, context));
    let lobe = lobe(section.get_ref(), context);
    if let Some(emit) = emit {
        context.in_range(emit, 0.0, f64::INFINITY, "emit");
    }
    if let Some(opal) = opal {
        let opal = opal.get_ref();
        context.in_range(&opal.reflectance, 0.0, 1.0, "reflectance");
        context.in_range(&opal.transmittance, 0.0, 1.0, "transmittance");
        let sum = opal.reflectance.get_ref() + opal.transmittance.get_ref();
        if sum > 1.0 + 1e-9 {
            let message = format!("reflectance + transmittance must not exceed 1, they make {sum}");
            context.error(&opal.transmittance.span(), message, "");
        }
    }
    if context.diagnostics.len() > before {
        return None;
    }
    if let Some(lobe) = lobe {
        let alone = [mirror, emit].into_iter().flatten().next().map(At::span);
        let alone = alone.or(glass.as_ref().map(At::span)).or(opal.as_ref().map(At::span));
        if let Some(span) = alone {
            context.error(
                &span,
                "a glossy lobe goes with `reflectance` only",
                "leave out specular and its lobe, or this",
            );
            return None;
        }
        let Some(reflectance) = reflectance else {
            context.missing(
                &whole,
                "a glossy surface needs the reflectance of its diffuse part",
                "reflectance = 0 for a bare metal",
            );
            return None;
        };
        return Some(Bsdf::Glossy { reflectance: *reflectance.get_ref(), lobe });
    }
    match (reflectance, mirror, pane, opal, emit) {
        (Some(reflectance), None, None, None, None) => {
            Some(Bsdf::Lambert { reflectance: *reflectance.get_ref() })
        }
        (None, Some(mirror), None, None, None) => Some(Bsdf::Mirror { reflectance: *mirror.get_ref() }),
        (None, None, Some(pane), None, None) => Some(Bsdf::Glass(pane)),
        (None, None, None, Some(opal), None) => Some(Bsdf::Opal {
            reflectance: *opal.get_ref().reflectance.get_ref(),
            transmittance: *opal.get_ref().transmittance.get_ref(),
        }),
        (reflectance, None, None, None, Some(emit)) => Some(Bsdf::Emitter {
            luminance_cd_m2: *emit.get_ref(),
            reflectance: reflectance.as_ref().map_or(0.0, |value| *value.get_ref()),
        }),
        _ => {
            context.missing(
                &whole,
                "a material is exactly one of reflectance, mirror, glass, opal, emit",
                "only `emit` may be given together with `reflectance`",
            );
            None
        }
    }
}

/// A pane from its normal transmittance, or as measured.
fn pane(glass: &At<GlassChoice>, context: &mut Context) -> Option<Pane> {
    let table = match glass.get_ref() {
        GlassChoice::Normal(transmittance) if (0.0..=1.0).contains(transmittance) => {
            return Some(Pane::new(*transmittance));
        }
        GlassChoice::Normal(transmittance) => Err(format!("glass must lie in 0 … 1, found {transmittance}")),
        GlassChoice::Measured { angle, transmittance, reflectance } => {
            let counts = [angle.len(), transmittance.len(), reflectance.len()];
            if counts == [angle.len(); 3] {
                let row = |k: usize| [angle[k], transmittance[k], reflectance[k]];
                Table::new(&(0..angle.len()).map(row).collect::<Vec<_>>())
            } else {
                let [angles, passed, reflected] = counts;
                Err(format!(
                    "{angles} angles, {passed} transmittances, {reflected} reflectances: there must be as many of each"
                ))
            }
        }
    };
    match table {
        Ok(table) => Some(Pane::Measured(table)),
        Err(message) => {
            let hint = "glass = 0.88 at normal incidence, or { angle = [0, 30, 60, 90], transmittance = [0.7, 0.68, 0.5, 0], reflectance = [0.12, 0.12, 0.2, 1] }";
            context.error(&glass.span(), message, hint);
            None
        }
    }
}

/// The lobe of `specular` with exactly one of `phong`, `phong_paper` and `ward`.
fn lobe(section: &MaterialSection, context: &mut Context) -> Option<Lobe> {
    let MaterialSection { specular, phong, phong_paper, ward, .. } = section;
    let mut shapes = [phong, phong_paper, ward].into_iter().flatten();
    let (specular, shape) = match (specular, shapes.next()) {
        (None, None) => return None,
        (Some(specular), None) => {
            context.error(
                &specular.span(),
                "`specular` without the shape of its lobe",
                "add `phong = 60` (exponent) or `ward = 0.12` (roughness); a perfect mirror is { mirror = … }",
            );
            return None;
        }
        (None, Some(shape)) => {
            context.error(
                &shape.span(),
                "a glossy lobe without its reflectance",
                "add `specular = 0.05`; `reflectance` is the diffuse part",
            );
            return None;
        }
        (Some(specular), Some(shape)) => (*specular.get_ref(), shape),
    };
    if let Some(second) = shapes.next() {
        let hint = "keep one of phong, phong_paper and ward";
        context.error(&second.span(), "a surface has one glossy lobe", hint);
        return None;
    }
    let value = *shape.get_ref();
    let ([low, high], what) =
        if ward.is_some() { (ROUGHNESSES, "roughness of ward") } else { (EXPONENTS, "exponent of phong") };
    if !(low..=high).contains(&value) {
        let message = format!("{what} must lie in {low} … {high}, found {value}");
        let sharp = if ward.is_some() { value < low } else { value > high };
        let hint =
            if sharp { "a sharper surface is { mirror = … }" } else { "a duller surface is diffuse" };
        context.error(&shape.span(), message, hint);
        return None;
    }
    if !(0.0..=1.0).contains(&specular) {
        return None;
    }
    Some(match (phong, phong_paper) {
        (Some(_), _) => Lobe::Phong(Phong::new(specular, value)),
        (None, Some(_)) => Lobe::PhongPaper(PhongPaper::new(specular, value)),
        (None, None) => Lobe::Ward(Ward::new(specular, value)),
    })
}
