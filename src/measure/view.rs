//! Glare at an observer: sources from the luminaires and luminous surfaces themselves (never from
//! pixels), background from the indirect vertical illuminance at the eye, initial flux.

use std::f64::consts::PI;

use glam::DVec3;

use super::glare_sources::{Convention, sources};
use super::stray::parts;
use super::zones::ZoneLight;
use super::{Answers, Gauged};
use crate::emitters::{Emitters, Sighted};
use crate::estimate::{Estimate, quantile};
use crate::glare::index::{Index, parse};
use crate::glare::propagate::{SightError, Spread, standard_error};
use crate::glare::source::{Given, GlareSource, Sight};
use crate::glare::ugr::{ugr, validity};
use crate::glare::veiling::STRAYED;
use crate::outcome::{GlareSourceOutcome, IndexOutcome};
use crate::solve::Part;
use crate::units::{Nits, Undefined};

/// What is asked of a view.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// Unit line of sight.
    pub gaze: DVec3,
    /// Keys of the indices wanted beside UGR.
    pub indices: &'a [&'static str],
    /// How sources and positions are taken.
    pub convention: Convention,
    /// Light of the zones about the task, or why it is not known.
    pub zones: Result<&'a ZoneLight, &'a str>,
    /// What no view tells.
    pub given: Given,
}

/// Glare of one observer in one direction under one light scene.
#[derive(Clone, Debug)]
pub struct Glare {
    /// UGR.
    pub ugr: Gauged,
    /// The indices asked for beside it.
    pub indices: Vec<GaugedIndex>,
    /// Background luminance, cd/m².
    pub background_cd_m2: f64,
    /// Illuminance at the eye, direct light included, lx, initial flux.
    pub e_v_lx: f64,
    /// Sources, the most glaring first.
    pub sources: Vec<GlareSourceOutcome>,
    /// Validity notes.
    pub notes: Vec<String>,
}

/// An index with its interval.
#[derive(Clone, Debug)]
pub struct GaugedIndex {
    /// Its row in the table.
    pub index: &'static Index,
    /// Value and interval.
    pub gauged: Gauged,
    /// What makes it doubtful.
    pub notes: Vec<String>,
}

impl GaugedIndex {
    /// As it stands in the result.
    pub fn outcome(&self) -> IndexOutcome {
        IndexOutcome {
            key: self.index.key.into(),
            name: self.index.name.into(),
            unit: self.index.unit.into(),
            estimate: self.gauged.interval(),
            notes: self.notes.clone(),
        }
    }
}

/// Illuminance on the plane of the eye, lx, initial flux.
#[derive(Clone, Copy, Debug, Default)]
pub struct EyeLight {
    /// Straight from luminaires and from their images.
    pub from_luminaires: Estimate,
    /// All other.
    pub indirect: Estimate,
}

impl EyeLight {
    /// Of a row of the sheets.
    pub fn of_row(answers: &Answers, row: usize, weights: &[f64]) -> Self {
        let parts = [Part::Direct, Part::Image, Part::Indirect].map(|part| answers.part(row, weights, part));
        let [direct, image, indirect] = &parts;
        let from_luminaires: Vec<f64> = direct.iter().zip(image).map(|(a, b)| a + b).collect();
        Self {
            from_luminaires: Estimate::from_blocks(&from_luminaires),
            indirect: Estimate::from_blocks(indirect),
        }
    }
}

/// Glare of the observer that sees `sighted`, with `light` in the eye; `weights` are initial.
pub fn glare(
    light: &EyeLight,
    emitters: &Emitters,
    sighted: &Sighted,
    asked: &Asked,
    weights: &[f64],
    alpha: f64,
) -> Glare {
    let EyeLight { from_luminaires, indirect } = *light;
    let e_v_lx = from_luminaires.value + indirect.value;
    let found = sources(emitters, sighted, asked.gaze, weights, asked.convention, e_v_lx);
    let [surfaces_lx, surfaces_se] = found.surfaces_lx;
    // What comes from a luminous surface or a highlight is not background, though no part of the sheets is it.
    let background_cd_m2 = (indirect.value - surfaces_lx) / PI;
    let sight = Sight {
        sources: found.counted.iter().map(|counted| counted.source).collect(),
        e_v_lx,
        e_direct_lx: from_luminaires.value + surfaces_lx,
        background: Nits(background_cd_m2),
        parts: if asked.indices.iter().any(|key| STRAYED.contains(key)) {
            parts(emitters, sighted, &found.counted, asked.gaze)
        } else {
            Vec::new()
        },
        zones: Some(asked.zones.map(ZoneLight::zones).map_err(Undefined::because)),
        given: asked.given,
        ..Sight::default()
    };
    let error = SightError {
        e_indirect_lx: indirect.se.hypot(surfaces_se),
        e_direct_lx: Some(from_luminaires.se.hypot(surfaces_se)),
        sources: found.counted.iter().map(|counted| counted.error).collect(),
    };
    let skewed = Skewed {
        indirect: indirect.widenings(alpha),
        direct: from_luminaires.widenings(alpha).into_iter().fold(1.0, f64::max),
    };
    let gauge = |index: &Index| match (index.zones, asked.zones) {
        (Some(figure), Ok(zones)) => zones.gauge(figure, alpha),
        _ => gauge(index, &sight, &error, indirect.n, alpha, &skewed),
    };
    let ugr_row = parse("UGR").expect("the table of indices begins with UGR");
    let indices = asked.indices.iter().filter(|key| **key != "UGR").filter_map(|key| parse(key));
    let mut notes = found.notes;
    notes.extend(validity(&sight.sources));
    notes.sort();
    notes.dedup();
    let terms: Vec<f64> = sight.sources.iter().map(term).collect();
    let total: f64 = terms.iter().sum();
    let mut listed: Vec<GlareSourceOutcome> = found
        .counted
        .iter()
        .zip(&terms)
        .filter(|(counted, _)| !counted.source.off_table)
        .map(|(counted, term)| GlareSourceOutcome {
            label: counted.label.clone(),
            luminance_cd_m2: counted.source.luminance.0,
            solid_angle_sr: counted.source.solid_angle_sr,
            position_index: counted.source.position_index,
            visible_fraction: counted.visible_fraction,
            share: term / total,
        })
        .collect();
    listed.sort_by(|a, b| b.share.total_cmp(&a.share));
    Glare {
        ugr: gauge(ugr_row),
        indices: indices
            .map(|index| {
                let gauged = gauge(index);
                let mut notes = if gauged.value.is_ok() { (index.validity)(&sight) } else { Vec::new() };
                notes.extend(index.assumption(&sight.given).filter(|_| gauged.value.is_ok()));
                if !sight.parts.is_empty() && gauged.value.is_ok() && STRAYED.contains(&index.key) {
                    notes.push(IN_PARTS.to_owned());
                }
                if let (Some(_), Ok(zones)) = (index.zones, asked.zones) {
                    notes.extend(zones.words.iter().cloned());
                }
                GaugedIndex { index, gauged, notes }
            })
            .collect(),
        background_cd_m2,
        e_v_lx: sight.e_v_lx,
        sources: listed,
        notes,
    }
}

/// What is said of veiling luminance: an approximation that no interval holds.
const IN_PARTS: &str = "sources with a size count by their parts, each at its own angle, within about 2 %";

/// A source's part of Σ L²ω/P², by intensity where it is small.
fn term(source: &GlareSource) -> f64 {
    ugr(&[*source], Nits(0.25)).map_or(0.0, |index| 10f64.powf(index / 8.0))
}

/// How much farther than Student's intervals reach because blocks are skewed.
struct Skewed {
    /// By the indirect light in the eye: below and above.
    indirect: [f64; 2],
    /// By what comes straight from luminaires, on either side.
    direct: f64,
}

impl Skewed {
    /// Factors below and above for an index: what falls as the light grows reaches the other way.
    fn of(&self, index: &Index, sight: &Sight) -> [f64; 2] {
        let step_lx = 1e-3 * sight.e_v_lx.abs();
        let mut brighter = sight.clone();
        brighter.e_v_lx += step_lx;
        brighter.background = Nits(sight.background.0 + step_lx / PI);
        let rises = match ((index.value)(sight), (index.value)(&brighter)) {
            (Ok(here), Ok(there)) => there >= here,
            _ => true,
        };
        let [below, above] = self.indirect;
        let sides = if rises { [below, above] } else { [above, below] };
        sides.map(|factor| factor.max(self.direct))
    }
}

/// An index with Student's interval about it, wider where the eye's light is skewed.
fn gauge(
    index: &Index,
    sight: &Sight,
    error: &SightError,
    blocks: usize,
    alpha: f64,
    skewed: &Skewed,
) -> Gauged {
    let value = (index.value)(sight);
    let spread =
        value.clone().and_then(|_| standard_error(index.value, sight, error, blocks.saturating_sub(1)));
    match (value, spread) {
        (Err(reason), _) | (Ok(_), Err(reason)) => Gauged::undefined(reason),
        (Ok(value), Ok(Spread { se, degrees })) => {
            let half = if se > 0.0 { quantile(1.0 - 0.5 * alpha, degrees) * se } else { 0.0 };
            let [below, above] = skewed.of(index, sight).map(|factor| factor * half);
            Gauged { value: Ok(value), se, lo: value - below, hi: value + above, place: None }
        }
    }
}
