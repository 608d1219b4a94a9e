//! `glare --image --format json`: { indices, sources[], convention } with full precision; one image is
//! an object, several are an array.

use std::collections::BTreeMap;

use serde::Serialize;

use super::super::ReportError;
use super::gradient::{Experimental, object};
use super::{Evaluated, right_and_up_deg};
use crate::units::Undefined;

#[derive(Serialize)]
struct Image<'a> {
    file: &'a str,
    indices: BTreeMap<&'a str, Value<'a>>,
    sources: Vec<Source>,
    dgp_class: Option<&'static str>,
    task: Option<Task>,
    band: Option<Band>,
    /// Only where it is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    experimental_luminance_gradient: Option<Experimental<'a>>,
    convention: &'a str,
    notes: &'a [String],
}

#[allow(clippy::struct_field_names, reason = "the keys of the file")]
#[derive(Serialize)]
struct Value<'a> {
    value: Option<f64>,
    unit: &'a str,
    /// Why there is no value.
    reason: Option<&'a str>,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Source {
    number: usize,
    right_deg: f64,
    up_deg: f64,
    off_axis_deg: f64,
    position_index: Option<f64>,
    luminance_cd_m2: f64,
    highest_cd_m2: f64,
    solid_angle_sr: f64,
    eye_lx: f64,
    peak: bool,
}

#[allow(clippy::struct_field_names, reason = "the keys of the file")]
#[derive(Serialize)]
struct Task {
    task_cd_m2: Option<f64>,
    surround_cd_m2: Option<f64>,
    far_cd_m2: Option<f64>,
    task_to_surround: Option<f64>,
    task_to_far: Option<f64>,
    reason: Option<String>,
}

#[derive(Serialize)]
struct Band {
    solid_angle_sr: Option<f64>,
    mean_cd_m2: Option<f64>,
    median_cd_m2: Option<f64>,
    reason: Option<String>,
}

/// The object of one image, or an array where `many` were named, whatever became of them.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn images_json(images: &[Evaluated], many: bool) -> Result<String, ReportError> {
    let entries: Vec<Image> = images.iter().map(entry).collect();
    let text = match entries.as_slice() {
        [only] if !many => serde_json::to_string_pretty(only)?,
        several => serde_json::to_string_pretty(several)?,
    };
    Ok(text + "\n")
}

fn entry(image: &Evaluated) -> Image<'_> {
    let glare = &image.glare;
    let value = |value: &Result<f64, Undefined>| value.as_ref().ok().copied();
    let indices = glare.readings.iter().map(|reading| {
        let entry = Value {
            value: value(&reading.value),
            unit: reading.unit,
            reason: reading.value.as_ref().err().map(|undefined| undefined.reason.as_str()),
            notes: &reading.notes,
        };
        (reading.key, entry)
    });
    let sources = glare.sources.iter().enumerate().map(|(number, source)| {
        let found = &source.detected;
        let [right_deg, up_deg] = right_and_up_deg(found.direction);
        Source {
            number: number + 1,
            right_deg,
            up_deg,
            off_axis_deg: found.at(1.0, false).off_axis_deg,
            position_index: source.position_index,
            luminance_cd_m2: found.luminance.0,
            highest_cd_m2: found.highest.0,
            solid_angle_sr: found.solid_angle_sr,
            eye_lx: found.eye_lx,
            peak: found.is_peak,
        }
    });
    let task = glare.zones.as_ref().map(|zones| {
        let of = |pick: &dyn Fn(&crate::glare::luminances::Zones) -> Option<f64>| {
            zones.as_ref().ok().and_then(pick)
        };
        Task {
            task_cd_m2: of(&|zones| Some(zones.task.0)),
            surround_cd_m2: of(&|zones| Some(zones.surround.0)),
            far_cd_m2: of(&|zones| Some(zones.far.0)),
            task_to_surround: of(&|zones| zones.task_to_surround().ok()),
            task_to_far: of(&|zones| zones.task_to_far().ok()),
            reason: zones.as_ref().err().map(ToString::to_string),
        }
    });
    let band = glare.band.as_ref().map(|band| {
        let of = |pick: &dyn Fn(&crate::glare::field::Band) -> f64| band.as_ref().ok().map(pick);
        Band {
            solid_angle_sr: of(&|band| band.solid_angle_sr),
            mean_cd_m2: of(&|band| band.mean.0),
            median_cd_m2: of(&|band| band.median.0),
            reason: band.as_ref().err().map(ToString::to_string),
        }
    });
    Image {
        file: &image.file,
        indices: indices.collect(),
        sources: sources.collect(),
        dgp_class: glare.dgp_class.map(crate::glare::dgp::DgpClass::words),
        task,
        band,
        experimental_luminance_gradient: image.gradient.as_ref().map(object),
        convention: &glare.convention,
        notes: &glare.notes,
    }
}
