//! What `lamp far-field` prints: fluxes with their intervals, and how exact the table is.

use serde::Serialize;

use super::super::ReportError;
use super::super::number::{figures, fixed};
use super::super::words::{Lang, lamp_word};
use super::super::xml::put;
use crate::estimate::{Estimate, quantile};
use crate::lamp::c_deg;
use crate::solve::far_field::FarField;

#[derive(Serialize)]
struct Figure {
    value: f64,
    se: f64,
    lo: f64,
    hi: f64,
}

#[derive(Serialize)]
struct Node {
    c_deg: f64,
    gamma_deg: f64,
    cd: f64,
    se: f64,
}

#[derive(Serialize)]
struct Listing {
    emitted_lm: f64,
    escaped_lm: Figure,
    lor: Figure,
    blurred_lm: Figure,
    table_lm: Figure,
    blocks: usize,
    nodes: Vec<Node>,
}

/// A line per figure.
pub fn text(field: &FarField, lang: Lang) -> String {
    let say = |english: &'static str| lamp_word(lang, english);
    let percent = |lm: f64| format!("{} %", fixed(lang, 100.0 * lm / field.emitted_lm, 2));
    let lumens = |value: Estimate| {
        format!("{} ± {} {}", figures(lang, value.value, 5), figures(lang, half(value), 2), say("lm"))
    };
    let mut text = String::new();
    let mut row = |name: &str, value: String| put(&mut text, format_args!("  {name:<14}{value}\n"));
    let escaped = field.escaped_lm;
    row(say("emitted"), format!("{} {}", figures(lang, field.emitted_lm, 5), say("lm")));
    let share = format!("({} ± {})", percent(escaped.value), percent(half(escaped)));
    row(say("leaves"), format!("{} {share}", lumens(escaped)));
    row(say("table"), format!("{}, {}", lumens(field.table_lm), say("interpolated")));
    row(
        say("exactness"),
        format!(
            "{} {} % {} ({}: {}, {}: {})",
            say("standard error"),
            figures(lang, 100.0 * field.error(), 2),
            say("of the largest intensity, rms"),
            say("directions"),
            field.cd.iter().map(Vec::len).sum::<usize>(),
            say("blocks"),
            escaped.n
        ),
    );
    if field.mirrored_lm.value > 0.0 {
        let told = say("leave by a mirror: their directions are blurred by one step of the table");
        row(say("blurred"), format!("{} {told}", percent(field.mirrored_lm.value)));
    }
    text
}

/// Half of the 95 % interval.
fn half(value: Estimate) -> f64 {
    if value.se > 0.0 { quantile(0.975, value.n.saturating_sub(1)) * value.se } else { 0.0 }
}

/// All nodes with their errors.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn json(field: &FarField) -> Result<String, ReportError> {
    let shown = |value: Estimate, unit: f64| Figure {
        value: value.value / unit,
        se: value.se / unit,
        lo: (value.value - half(value)) / unit,
        hi: (value.value + half(value)) / unit,
    };
    let nodes = field.azimuths_deg.iter().zip(&field.cd).flat_map(|(azimuth, plane)| {
        let node = move |(gamma, cd): (&f64, &Estimate)| Node {
            c_deg: c_deg(*azimuth),
            gamma_deg: *gamma,
            cd: cd.value,
            se: cd.se,
        };
        field.gammas_deg.iter().zip(plane).map(node)
    });
    let table = Listing {
        emitted_lm: field.emitted_lm,
        escaped_lm: shown(field.escaped_lm, 1.0),
        lor: shown(field.escaped_lm, field.emitted_lm),
        blurred_lm: shown(field.mirrored_lm, 1.0),
        table_lm: shown(field.table_lm, 1.0),
        blocks: field.escaped_lm.n,
        nodes: nodes.collect(),
    };
    Ok(serde_json::to_string_pretty(&table)? + "\n")
}
