//! Experimental statistics of luminance gradients as text, rows and JSON; marked so everywhere.

use serde::Serialize;

use super::super::number::{figures, fixed};
use super::super::words::Lang;
use super::super::xml::put;
use crate::glare::gradient::{EDGES, Gradient};
use crate::units::Undefined;

const LANG: Lang = Lang::En;
/// Unit of all figures.
pub(super) const UNIT: &str = "decades/deg";

/// A block for people.
pub(super) fn text(found: &Result<Gradient, Undefined>) -> String {
    let mut text =
        String::from("  EXPERIMENTAL, in no norm and no verdict: gradient of lg L, decades per degree\n");
    let found = match found {
        Ok(found) => found,
        Err(undefined) => return format!("{text}    - {undefined}\n"),
    };
    for (name, value) in figures_of(found) {
        put(&mut text, format_args!("    {:<15}{:>9}\n", name, figures(LANG, value, 3)));
    }
    for (class, share) in EDGES.windows(2).zip(&found.histogram) {
        let class = match class {
            [from, to] if to.is_finite() => format!("{from} to {to}"),
            [from, ..] => format!("from {from}"),
            [] => String::new(),
        };
        put(&mut text, format_args!("    {class:<15}{:>7} % of the field\n", fixed(LANG, 100.0 * share, 1)));
    }
    put(
        &mut text,
        format_args!(
            "    over {}°, weighted by solid angle: {} sr evaluated, {} sr at the rim or dark left out\n",
            found.scale_deg,
            figures(LANG, found.evaluated_sr, 3),
            figures(LANG, found.left_out_sr, 3)
        ),
    );
    for note in &found.notes {
        put(&mut text, format_args!("    note: {note}\n"));
    }
    text
}

/// Names and values of the figures.
pub(super) fn figures_of(found: &Gradient) -> [(&'static str, f64); 3] {
    [("mean", found.mean), ("rms", found.rms), ("95th percentile", found.percentile_95)]
}

/// The object for machines.
#[derive(Serialize)]
pub(super) struct Experimental<'a> {
    /// Said in the file itself.
    standing: &'static str,
    unit: &'static str,
    scale_deg: Option<f64>,
    mean: Option<f64>,
    rms: Option<f64>,
    percentile_95: Option<f64>,
    histogram: Vec<Class>,
    evaluated_sr: Option<f64>,
    left_out_sr: Option<f64>,
    reason: Option<&'a str>,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Class {
    from: f64,
    /// `null` for the last one, which is open.
    to: Option<f64>,
    share: f64,
}

/// As an object.
pub(super) fn object(found: &Result<Gradient, Undefined>) -> Experimental<'_> {
    let known = found.as_ref().ok();
    let class = |(edges, share): (&[f64], &f64)| Class {
        from: edges[0],
        to: Some(edges[1]).filter(|edge| edge.is_finite()),
        share: *share,
    };
    Experimental {
        standing: "experimental",
        unit: UNIT,
        scale_deg: known.map(|found| found.scale_deg),
        mean: known.map(|found| found.mean),
        rms: known.map(|found| found.rms),
        percentile_95: known.map(|found| found.percentile_95),
        histogram: known
            .map_or(Vec::new(), |found| EDGES.windows(2).zip(&found.histogram).map(class).collect()),
        evaluated_sr: known.map(|found| found.evaluated_sr),
        left_out_sr: known.map(|found| found.left_out_sr),
        reason: found.as_ref().err().map(|undefined| undefined.reason.as_str()),
        notes: known.map_or(&[], |found| &found.notes),
    }
}
