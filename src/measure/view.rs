//! Glare at an observer: sources from the luminaires themselves (never from pixels), background
//! from the indirect vertical illuminance at the eye, initial flux.

use glam::DVec3;

use super::{Answers, Gauged};
use crate::emitters::{Emitters, Seen};
use crate::estimate::{Estimate, quantile};
use crate::glare::position_index::{cie117_table, levin_iwata};
use crate::glare::source::{Extent, GlareSource};
use crate::glare::ugr::{ugr, validity};
use crate::outcome::GlareSourceOutcome;
use crate::scene::Channel;
use crate::solve::Part;
use crate::units::{Nits, Undefined};

/// How the numbers were made, printed with every UGR.
pub const CONVENTION: &str = "visible part, mean luminance; position index CIE 117 table (Iwata–Osterhaus below the line of sight); L_b = E_ind/π";

/// Glare of one observer in one direction under one light scene.
#[derive(Clone, Debug)]
pub struct Glare {
    /// UGR.
    pub ugr: Gauged,
    /// Background luminance, cd/m².
    pub background_cd_m2: f64,
    /// Illuminance at the eye, direct light included, lx, initial flux.
    pub e_v_lx: f64,
    /// Sources, the most glaring first.
    pub sources: Vec<GlareSourceOutcome>,
    /// Validity notes.
    pub notes: Vec<String>,
}

/// UGR of the observer at `eye` that looks along `gaze`. `seen` are the sources visible from the
/// eye, `row` answers the illuminance on the plane of the eye, `weights` are initial.
pub fn glare(
    answers: &Answers,
    emitters: &Emitters,
    seen: &[Seen],
    gaze: DVec3,
    row: usize,
    weights: &[f64],
    alpha: f64,
) -> Glare {
    let background = Estimate::from_blocks(&answers.part(row, weights, Part::Indirect));
    let e_v_lx = Estimate::from_blocks(&answers.total(row, weights)).value;
    let background_cd_m2 = background.value / std::f64::consts::PI;
    let mut notes = Vec::new();
    let (mut sources, mut labels, mut variance_of_sum, mut terms) = (Vec::new(), Vec::new(), 0.0, Vec::new());
    for one in seen {
        let source = &emitters.sources[one.source];
        let weight = weights[source.channel];
        if !(weight > 0.0) || !(one.direction.dot(gaze) > 0.0) || !(one.normal_lx.value > 0.0) {
            continue;
        }
        let Some(position_index) = position(gaze, one.direction, &mut notes) else { continue };
        let area = one.solid_angle_sr.value;
        let glaring = GlareSource {
            luminance: Nits(weight * one.luminance_cd_m2().unwrap_or(0.0)),
            solid_angle_sr: area,
            position_index,
            off_axis_deg: one.direction.dot(gaze).clamp(-1.0, 1.0).acos().to_degrees(),
            eye_lx: weight * one.normal_lx.value * one.direction.dot(gaze),
            extent: Some(Extent {
                projected_area_m2: one.projected_area_m2,
                intensity_cd: weight * one.normal_lx.value * one.distance_m * one.distance_m,
                distance_m: one.distance_m,
            }),
        };
        // L²ω = X²/ω with X = ∫L dω: relative variance at most (2 σ_X/X + σ_ω/ω)².
        let relative = 2.0 * one.normal_lx.se / one.normal_lx.value
            + if area > 0.0 { one.solid_angle_sr.se / area } else { 0.0 };
        let term = ugr(&[glaring], Nits(0.25)).map_or(0.0, |index| 10f64.powf(index / 8.0));
        variance_of_sum += (term * relative) * (term * relative);
        terms.push(term);
        labels.push(label(emitters, one.source));
        sources.push((glaring, one.visible_fraction));
    }
    let total: f64 = terms.iter().sum();
    let physical: Vec<GlareSource> = sources.iter().map(|(source, _)| *source).collect();
    notes.extend(validity(&physical));
    let value = if luminous_surface(emitters, weights) {
        Err(Undefined::because("the scene has luminous surfaces, which are not yet counted as glare sources"))
    } else {
        ugr(&physical, Nits(background_cd_m2))
    };
    let gauged = match value {
        Err(reason) => Gauged::undefined(reason),
        Ok(value) => {
            let relative = (background.se / background.value).hypot(variance_of_sum.sqrt() / total);
            let se = 8.0 / std::f64::consts::LN_10 * relative;
            let half =
                if se > 0.0 { quantile(1.0 - 0.5 * alpha, background.n.saturating_sub(1)) * se } else { 0.0 };
            Gauged { value: Ok(value), se, lo: value - half, hi: value + half, place: None }
        }
    };
    let mut listed: Vec<GlareSourceOutcome> = sources
        .iter()
        .zip(labels)
        .zip(&terms)
        .map(|(((source, visible), label), term)| GlareSourceOutcome {
            label,
            luminance_cd_m2: source.luminance.0,
            solid_angle_sr: source.solid_angle_sr,
            position_index: source.position_index,
            visible_fraction: *visible,
            share: term / total,
        })
        .collect();
    listed.sort_by(|a, b| b.share.total_cmp(&a.share));
    notes.sort();
    notes.dedup();
    Glare { ugr: gauged, background_cd_m2, e_v_lx, sources: listed, notes }
}

/// P of the CIE 117 table; below the line of sight, where the table has none, Iwata–Osterhaus; `None`
/// in the table's void cells: such a source is ignored.
fn position(gaze: DVec3, direction: DVec3, notes: &mut Vec<String>) -> Option<f64> {
    let up = if gaze.z.abs() > 0.999 { DVec3::Y } else { DVec3::Z };
    if let Ok(index) = cie117_table(gaze, up, direction) {
        return Some(index);
    }
    let view_up = (up - gaze * up.dot(gaze)).normalize();
    if direction.dot(view_up) < 0.0 {
        notes.push("a source lies below the line of sight: Iwata–Osterhaus position index".into());
        return Some(levin_iwata(gaze, up, direction));
    }
    None
}

fn luminous_surface(emitters: &Emitters, weights: &[f64]) -> bool {
    let channels = emitters.scene.channels.iter().zip(weights);
    channels.into_iter().any(|(channel, weight)| *weight > 0.0 && matches!(channel, Channel::Surfaces { .. }))
}

fn label(emitters: &Emitters, index: usize) -> String {
    let source = &emitters.sources[index];
    let luminaire = emitters.luminaire(source);
    let image = if source.mirror.is_some() { ", mirrored" } else { "" };
    format!("{} #{} ({}{image})", luminaire.kind.name, source.luminaire + 1, luminaire.group)
}
