//! Glare of a luminance image: every index of the table from the sources that were found in it. The
//! image is taken as it is: it has no numerical error, and the photographer's is not known here.

use super::detect::{Detected, Found, Search, Threshold, detect};
use super::dgp::DgpClass;
use super::field::{Band, Cone, Field};
use super::index::{INDICES, Reading};
use super::luminances::Zones;
use super::position_index::{Position, PositionModel};
use super::source::{Given, Sight};
use crate::image::LuminanceImage;
use crate::units::{Nits, Undefined};

/// Part of the half-space in front of the eye that an image must show for its E_v to be whole.
const WHOLE: f64 = 0.99;

/// How an image is evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// How sources are searched.
    pub search: Search,
    /// Model of the position index.
    pub position: PositionModel,
    /// Observer and forms of the indices.
    pub given: Given,
    /// E_v measured beside the image, lx, in place of the image's own.
    pub measured_e_v_lx: Option<f64>,
    /// Task whose luminance is set against its surround.
    pub task: Option<Cone>,
    /// Half height of the horizontal band whose luminance is asked for, rad.
    pub band_rad: Option<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            search: Search::default(),
            position: PositionModel::Levin,
            given: Given::default(),
            measured_e_v_lx: None,
            task: None,
            band_rad: None,
        }
    }
}

/// A source of the image with its position index; `None` where UGR ignores it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageSource {
    /// What was found.
    pub detected: Detected,
    /// Position index.
    pub position_index: Option<f64>,
}

/// Glare of an image.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageGlare {
    /// Every index of the table; those of a task where one is given.
    pub readings: Vec<Reading>,
    /// The sources.
    pub sources: Vec<ImageSource>,
    /// What was found, pixel by pixel of the field.
    pub found: Found,
    /// Pixels in front of the eye.
    pub field: Field,
    /// What the indices were computed from.
    pub sight: Sight,
    /// Class of DGP by EN 17037, as information.
    pub dgp_class: Option<DgpClass>,
    /// Luminances of task, surround and far field, where a task is given.
    pub zones: Option<Result<Zones, Undefined>>,
    /// The horizontal band, where it is asked for.
    pub band: Option<Result<Band, Undefined>>,
    /// How all this was computed, in words.
    pub convention: String,
    /// What a reader must know: pixels that are no numbers, an image that shows too little.
    pub notes: Vec<String>,
}

/// Evaluates an image for an eye that looks along its centre.
///
/// # Errors
/// The image has no view, the mask does not fit, or the task zone is empty.
pub fn glare_of_image(
    image: &LuminanceImage,
    mask: Option<&LuminanceImage>,
    options: &Options,
) -> Result<ImageGlare, Undefined> {
    let field = Field::of(image, mask)?;
    let found = detect(&field, &options.search)?;
    let mut notes = image.notes.clone();
    notes.extend(field_notes(&field, options.measured_e_v_lx));
    let (mut below, mut ignored) = (0, 0);
    let mut sight = Sight { given: options.given, mean: field.mean(|_| true), ..Sight::default() };
    let mut sources = Vec::with_capacity(found.sources.len());
    for detected in &found.sources {
        let position = options.position.position(glam::DVec3::Z, glam::DVec3::Y, detected.direction);
        let (Position::Index(index) | Position::BelowTable(index) | Position::OffTable(index)) = position;
        let off_table = matches!(position, Position::OffTable(_));
        below += usize::from(matches!(position, Position::BelowTable(_)));
        ignored += usize::from(off_table);
        sight.sources.push(detected.at(index, off_table));
        sight.e_direct_lx += detected.eye_lx;
        let position_index = if off_table { None } else { Some(index) };
        sources.push(ImageSource { detected: *detected, position_index });
    }
    if below > 0 {
        notes.push(format!("{below} source(s) below the line of sight: Iwata–Osterhaus position index"));
    }
    if ignored > 0 {
        notes.push(format!("{ignored} source(s) outside the CIE 117 table: UGR and M leave them out, other indices take P by Levin"));
    }
    sight.e_v_lx = options.measured_e_v_lx.unwrap_or_else(|| field.illuminance_lx());
    sight.background = Nits(sight.e_indirect_lx() / std::f64::consts::PI);
    sight.parts = super::image_parts::parts(&field, &found);
    sight.zones = options.task.map(|task| field.zones(&task));
    // Without a task there is nothing to compare: five rows of the same reason would tell no more.
    let asked = INDICES.iter().filter(|index| index.zones.is_none() || options.task.is_some());
    let readings: Vec<Reading> = asked.map(|index| index.read(&sight)).collect();
    let dgp = super::dgp::dgp(&sight);
    Ok(ImageGlare {
        readings,
        dgp_class: dgp.ok().map(DgpClass::of),
        zones: sight.zones.clone(),
        band: options.band_rad.map(|half_angle_rad| field.band(half_angle_rad)),
        convention: convention(options, found.threshold),
        sources,
        found,
        field,
        sight,
        notes,
    })
}

fn field_notes(field: &Field, measured_e_v_lx: Option<f64>) -> Vec<String> {
    let mut notes = Vec::new();
    if field.bad_pixels > 0 {
        notes.push(format!("{} pixel(s) are negative or no numbers; they are left out", field.bad_pixels));
    }
    if field.masked_pixels > 0 {
        notes.push(format!("{} pixel(s) are hidden by the mask and give no light", field.masked_pixels));
    }
    // By the cosine, as E_v has it: a picture that lacks a thin rim lacks nothing.
    let share = field.pixels.iter().map(|pixel| pixel.projected_sr).sum::<f64>() / std::f64::consts::PI;
    if share < WHOLE && measured_e_v_lx.is_none() {
        notes.push(format!(
            "the image shows {:.1} % of what lights the eye, by the cosine: E_v and L_b are of that part only",
            100.0 * share
        ));
    }
    notes
}

fn convention(options: &Options, threshold: Nits) -> String {
    let threshold = match options.search.threshold {
        Threshold::Absolute(luminance) => format!("threshold {} cd/m²", luminance.0),
        Threshold::TimesMean(factor) => {
            format!("threshold {factor} × mean luminance = {:.1} cd/m²", threshold.0)
        }
        Threshold::TimesTask(factor, _) => {
            format!("threshold {factor} × luminance of the task = {:.1} cd/m²", threshold.0)
        }
    };
    let peak = options
        .search
        .peak
        .map_or("no peaks split off".to_owned(), |peak| format!("peaks split off above {} cd/m²", peak.0));
    let e_v = match options.measured_e_v_lx {
        Some(_) => "E_v measured",
        None => "E_v of the image",
    };
    let dgp = options.given.dgp.words();
    let mut given = String::new();
    if let Some(coverage) = options.given.ceiling_coverage {
        given += &format!("; {coverage} of the ceiling shines");
    }
    if let Some(ground) = options.given.ground {
        given += &format!("; ground of {} lx, reflectance {}", ground.mean_lx, ground.reflectance);
    }
    if let Some(road) = options.given.road {
        given += &format!("; road of {} cd/m²", road.0);
    }
    let low_light = if options.given.low_light { ", low-light factor" } else { "" };
    format!(
        "{threshold}; pixels within {} rad of each other are one source; {peak}; luminance of a source: mean \
         weighted by solid angle; {}; {e_v}; L_b = (E_v - E_dir)/π; {dgp}{low_light}; veil of an eye of {} \
         years, pigment {}{given}",
        0.5 * options.search.radius_rad,
        options.position.words(),
        options.given.age_years.unwrap_or(super::veiling::USUAL_AGE),
        options.given.pigment,
    )
}

#[cfg(test)]
mod tests;
