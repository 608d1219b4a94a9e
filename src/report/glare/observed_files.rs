//! `gershun glare PROJECT --format json|csv`: an entry for every direction of an observer or of an eye of a
//! map, with what makes its values doubtful.

use serde::Serialize;

use super::super::ReportError;
use super::super::json::IndexRow;
use crate::observe::Observed;
use crate::observe::map::{MapMethod, Mapped, approximations};
use crate::outcome::{GlareSourceOutcome, IndexOutcome, Interval};
use crate::units::Undefined;

/// A line of sight of an observer, or of an eye of a map; a map's eyes have neither name nor background.
#[derive(Serialize)]
struct View<'a> {
    viewpoint: Option<&'a str>,
    /// Only of maps.
    #[serde(skip_serializing_if = "Option::is_none")]
    map: Option<&'a str>,
    light_scene: &'a str,
    eye_m: [f64; 3],
    azimuth_deg: f64,
    tilt_deg: f64,
    convention: String,
    indices: Vec<IndexRow<'a>>,
    background_cd_m2: Option<f64>,
    e_v_lx: Option<f64>,
    worst: bool,
    /// What makes UGR doubtful.
    notes: &'a [String],
    sources: Vec<Glaring<'a>>,
    /// Only where values are not unbiased.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    approximations: Vec<&'a str>,
}

#[derive(Serialize)]
struct Glaring<'a> {
    source: &'a str,
    luminance_cd_m2: f64,
    solid_angle_sr: f64,
    position_index: f64,
    visible_fraction: f64,
    share: f64,
}

impl<'a> From<&'a GlareSourceOutcome> for Glaring<'a> {
    fn from(source: &'a GlareSourceOutcome) -> Self {
        Self {
            source: &source.label,
            luminance_cd_m2: source.luminance_cd_m2,
            solid_angle_sr: source.solid_angle_sr,
            position_index: source.position_index,
            visible_fraction: source.visible_fraction,
            share: source.share,
        }
    }
}

/// The values of a view: UGR first.
fn values<'a>(
    ugr: &'a Result<Interval, Undefined>,
    notes: &'a [String],
    further: &'a [IndexOutcome],
) -> Vec<IndexRow<'a>> {
    let of = |index: &'a IndexOutcome| IndexRow::new(&index.key, &index.unit, &index.estimate, &index.notes);
    std::iter::once(IndexRow::new("UGR", "1", ugr, notes)).chain(further.iter().map(of)).collect()
}

/// All views: of the observers, then of the maps.
fn views<'a>(observed: &'a [Observed], maps: &'a [Mapped]) -> impl Iterator<Item = View<'a>> {
    let of_observers = observed.iter().map(|view| View {
        viewpoint: Some(&view.viewpoint),
        map: None,
        light_scene: &view.light_scene,
        eye_m: view.eye.to_array(),
        azimuth_deg: view.azimuth_deg,
        tilt_deg: view.tilt_deg,
        convention: view.convention.words(),
        indices: values(&view.ugr, &view.notes, &view.indices),
        background_cd_m2: Some(view.background_cd_m2),
        e_v_lx: Some(view.e_v_lx),
        worst: view.worst,
        notes: &view.notes,
        sources: view.sources.iter().map(Glaring::from).collect(),
        approximations: view.approximations.iter().map(String::as_str).collect(),
    });
    of_observers.chain(maps.iter().flat_map(of_map))
}

fn of_map(map: &Mapped) -> impl Iterator<Item = View<'_>> {
    // What look-ups scatter by says nothing of what the field errs by.
    let holds = matches!(map.method, MapMethod::Unbiased(_));
    let values = move |ugr, further| {
        let mut values = values(ugr, &[], further);
        for estimate in values.iter_mut().filter_map(|value| value.estimate.as_mut()).filter(|_| !holds) {
            (estimate.se, estimate.lo, estimate.hi) = (f64::NAN, f64::NAN, f64::NAN);
        }
        values
    };
    map.eyes.iter().flat_map(move |eye| {
        let worst = eye.worst().map(|(number, _)| number);
        eye.views.iter().enumerate().map(move |(number, (ugr, further))| View {
            viewpoint: None,
            map: Some(&map.name),
            light_scene: &map.light_scene,
            eye_m: eye.position.to_array(),
            azimuth_deg: map.azimuths_deg[number],
            tilt_deg: 0.0,
            convention: map.convention.clone(),
            indices: values(ugr, further),
            background_cd_m2: None,
            e_v_lx: None,
            worst: worst == Some(number),
            notes: &[],
            sources: Vec::new(),
            approximations: approximations(map),
        })
    })
}

/// An array of views.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn observed_json(observed: &[Observed], maps: &[Mapped]) -> Result<String, ReportError> {
    let views: Vec<View> = views(observed, maps).collect();
    Ok(serde_json::to_string_pretty(&views)? + "\n")
}

/// A row for every view and index.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn observed_csv(observed: &[Observed], maps: &[Mapped]) -> Result<String, ReportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header = "viewpoint,light_scene,azimuth_deg,tilt_deg,index,convention,value,se,lo,hi,L_b_cd_m2,E_v_lx,worst,undefined,notes,map,x_m,y_m,z_m,unit";
    writer.write_record(header.split(','))?;
    let cell = |number: Option<f64>| {
        number.filter(|number| number.is_finite()).map_or(String::new(), |number| number.to_string())
    };
    for view in views(observed, maps) {
        for value in &view.indices {
            let of = |pick: fn(&Interval) -> f64| cell(value.estimate.as_ref().map(pick));
            writer.write_record([
                view.viewpoint.unwrap_or_default().to_owned(),
                view.light_scene.to_owned(),
                view.azimuth_deg.to_string(),
                view.tilt_deg.to_string(),
                value.index.to_owned(),
                view.convention.clone(),
                of(|estimate| estimate.value),
                of(|estimate| estimate.se),
                of(|estimate| estimate.lo),
                of(|estimate| estimate.hi),
                cell(view.background_cd_m2),
                cell(view.e_v_lx),
                view.worst.to_string(),
                value.undefined.unwrap_or_default().to_owned(),
                value.notes.join("; "),
                view.map.unwrap_or_default().to_owned(),
                view.eye_m[0].to_string(),
                view.eye_m[1].to_string(),
                view.eye_m[2].to_string(),
                value.unit.to_owned(),
            ])?;
        }
    }
    let bytes = writer.into_inner().expect("a vector takes any bytes");
    Ok(String::from_utf8(bytes).expect("only text was written"))
}
