//! `lamp info --format json`: one object per luminaire, full precision. A file that cannot be read
//! has the same keys, all null but its name and one finding.

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::super::ReportError;
use super::{Batch, format_name};
use crate::lamp::outdoor::{BUG_KNOWN, D_KNOWN, Outdoor, ZONES, g_star_known};
use crate::lamp::{self, Lamp, rules};
use crate::photometry::{Finding, Opening};

#[derive(Serialize, Default)]
struct Entry<'a> {
    file: &'a str,
    format: Option<&'static str>,
    flux_integrated_lm: Option<f64>,
    flux_zonal_lm: Option<f64>,
    flux_rated_lm: Option<f64>,
    lor: Option<f64>,
    power_w: Option<f64>,
    i_max_cd: Option<f64>,
    opening: Option<Shape>,
    symmetry: Option<&'static str>,
    outdoor: Option<Classes>,
    findings: Vec<Found<'a>>,
}

/// Classes of road and area luminaires; `null` is a class that is not met or a value that is undefined.
#[derive(Serialize)]
struct Classes {
    g_star: Option<String>,
    g_cd_per_klm_from_70_80_90_95_deg: [f64; 4],
    glare_index_cd_per_m: Option<f64>,
    d_class: Option<String>,
    bug: String,
    bug_zones_lm: BTreeMap<&'static str, f64>,
    street_c_deg: f64,
    limits: Limits,
}

/// How well the limits of the classes are known.
#[derive(Serialize)]
struct Limits {
    g_star: &'static str,
    d: &'static str,
    b: &'static str,
    u: &'static str,
    g: &'static str,
}

struct Shape(Opening);

impl Serialize for Shape {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (name, sizes) = self.0.sizes();
        let mut map = serializer.serialize_map(Some(1 + sizes.len()))?;
        map.serialize_entry("shape", name)?;
        for (size, m) in sizes {
            map.serialize_entry(size, &m)?;
        }
        map.end()
    }
}

#[derive(Serialize)]
pub(super) struct Found<'a> {
    code: &'a str,
    severity: &'static str,
    line: Option<usize>,
    message: &'a str,
    consequence: &'a str,
}

impl<'a> From<&'a Finding> for Found<'a> {
    fn from(finding: &'a Finding) -> Self {
        Self {
            code: finding.code,
            severity: rules::severity(finding.code).key(),
            line: finding.line,
            message: &finding.message,
            consequence: &finding.consequence,
        }
    }
}

/// The array of all luminaires.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn info(batch: &[Batch]) -> Result<String, ReportError> {
    // The figures of a file are computed where they are printed: thousands of files share the cores.
    let entries: Vec<Entry> = batch.par_iter().flat_map_iter(entries).collect();
    Ok(serde_json::to_string_pretty(&entries)? + "\n")
}

fn entries(file: &Batch) -> Vec<Entry<'_>> {
    match &file.read {
        Ok(lamps) => lamps.iter().map(entry).collect(),
        Err(finding) => {
            vec![Entry { file: &file.file, findings: vec![finding.into()], ..Entry::default() }]
        }
    }
}

fn entry(luminaire: &Lamp) -> Entry<'_> {
    let info = lamp::info(luminaire);
    Entry {
        file: &luminaire.file,
        format: Some(format_name(info.format)),
        flux_integrated_lm: Some(info.flux_integrated_lm),
        flux_zonal_lm: Some(info.flux_zonal_lm),
        flux_rated_lm: info.flux_rated_lm,
        lor: info.lor,
        power_w: info.power_w,
        i_max_cd: Some(info.i_max.cd),
        opening: Some(Shape(info.opening)),
        symmetry: Some(info.symmetry.key()),
        outdoor: Some(classes(&info.outdoor)),
        findings: luminaire.findings.iter().map(Found::from).collect(),
    }
}

fn classes(outdoor: &Outdoor) -> Classes {
    let [b, u, g] = outdoor.bug.rating;
    let index = outdoor.glare_index.as_ref().ok();
    Classes {
        g_star: (outdoor.g_star > 0).then(|| format!("G*{}", outdoor.g_star)),
        g_cd_per_klm_from_70_80_90_95_deg: outdoor.g_cd_per_klm,
        glare_index_cd_per_m: index.map(|(index, _)| *index),
        d_class: index.map(|(_, class)| format!("D{class}")),
        bug: format!("B{b} U{u} G{g}"),
        bug_zones_lm: ZONES.into_iter().zip(outdoor.bug.zones_lm).collect(),
        street_c_deg: lamp::c_deg(outdoor.bug.front_azimuth_deg),
        limits: Limits {
            g_star: g_star_known(outdoor.g_star).key(),
            d: D_KNOWN.key(),
            b: BUG_KNOWN[0].key(),
            u: BUG_KNOWN[1].key(),
            g: BUG_KNOWN[2].key(),
        },
    }
}
