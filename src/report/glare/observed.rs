//! `gershun glare PROJECT` for people: the observers' glare, and how conventions differ.

use super::super::number::{figures, fixed};
use super::super::words::Lang;
use super::super::xml::{printable, put};
use crate::glare::position_index::PositionModel;
use crate::measure::glare_sources::{Convention, SourceModel};
use crate::observe::Observed;
use crate::outcome::{Interval, UgrTableOutcome};
use crate::units::Undefined;

const LANG: Lang = Lang::En;

/// Every direction of every observer; the worst is marked.
pub fn observed_text(observed: &[Observed]) -> String {
    let mut text = String::new();
    let mut before = "";
    for view in observed {
        if view.viewpoint != before {
            let eye = view.eye.to_array().map(|metres| fixed(LANG, metres, 2)).join(", ");
            put(
                &mut text,
                format_args!("{} at {eye} m, light scene {}\n", printable(&view.viewpoint), view.light_scene),
            );
            before = &view.viewpoint;
        }
        let mark = if view.worst { "  worst direction" } else { "" };
        put(
            &mut text,
            format_args!(
                "  azimuth {:>6}°, tilt {:>5}°: UGR {}; L_b {} cd/m², E_v {} lx{mark}\n",
                fixed(LANG, view.azimuth_deg, 1),
                fixed(LANG, view.tilt_deg, 1),
                estimate(&view.ugr, 1),
                figures(LANG, view.background_cd_m2, 3),
                figures(LANG, view.e_v_lx, 3),
            ),
        );
        for note in &view.notes {
            put(&mut text, format_args!("      note: {note}\n"));
        }
        for index in &view.indices {
            let bare = index.unit == "1" || index.estimate.is_err();
            let unit = if bare { String::new() } else { format!(" {}", index.unit) };
            let notes = index.notes.join("; ");
            let line = format!("      {:<8} {}{unit}  {notes}", index.key, estimate(&index.estimate, 3));
            put(&mut text, format_args!("{}\n", line.trim_end()));
        }
    }
    if let Some(first) = observed.first() {
        put(&mut text, format_args!("convention: {}; initial flux\n", first.convention.words()));
        for said in &first.approximations {
            put(&mut text, format_args!("  {said}\n"));
        }
    }
    text
}

/// UGR of every direction by every convention, and how far they lie apart.
pub fn compared_text(observed: &[Observed]) -> String {
    let mut text = String::new();
    let same = |a: &Observed, b: &Observed| {
        a.viewpoint == b.viewpoint
            && a.azimuth_deg.to_bits() == b.azimuth_deg.to_bits()
            && a.tilt_deg.to_bits() == b.tilt_deg.to_bits()
    };
    for (position, view) in observed.iter().enumerate() {
        if observed[..position].iter().any(|earlier| same(earlier, view)) {
            continue;
        }
        put(
            &mut text,
            format_args!(
                "{}, azimuth {}°, tilt {}°\n",
                printable(&view.viewpoint),
                fixed(LANG, view.azimuth_deg, 1),
                fixed(LANG, view.tilt_deg, 1)
            ),
        );
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for other in observed.iter().filter(|other| same(other, view)) {
            if let Ok(ugr) = &other.ugr {
                (least, most) = (least.min(ugr.value), most.max(ugr.value));
            }
            put(
                &mut text,
                format_args!("  UGR {:<22} {}\n", estimate(&other.ugr, 2), other.convention.words()),
            );
        }
        for note in &view.notes {
            put(&mut text, format_args!("  note: {note}\n"));
        }
        if most > least {
            put(&mut text, format_args!("  conventions differ by up to {}\n", fixed(LANG, most - least, 2)));
        }
        let found: Vec<&Observed> = observed.iter().filter(|other| same(other, view)).collect();
        for reason in reasons(&found) {
            put(&mut text, format_args!("    {reason}\n"));
        }
    }
    text
}

/// UGR of rooms by the table method, to set beside the observers'.
pub fn tables_text(tables: &[(String, Vec<UgrTableOutcome>)]) -> String {
    let mut text = String::new();
    let value = |value: &Result<f64, Undefined>| match value {
        Ok(ugr) => fixed(LANG, *ugr, 2),
        Err(undefined) => format!("- ({undefined})"),
    };
    for (room, tables) in tables {
        put(&mut text, format_args!("{}, table method\n", printable(room)));
        for table in tables {
            put(
                &mut text,
                format_args!(
                    "  UGR {} crosswise, {} endwise   {}, spacing to height {}\n",
                    value(&table.crosswise),
                    value(&table.endwise),
                    printable(&table.kind),
                    fixed(LANG, table.shr, 2)
                ),
            );
        }
    }
    text.push_str(
        "  the table is of a standard room full of one luminaire type at regular spacing, seen from the middle of a \
         wall; it knows neither these places nor what hides them\n",
    );
    text
}

/// Why the values of one view differ, with the figures.
fn reasons(found: &[&Observed]) -> Vec<String> {
    let by = |sources: SourceModel, position: PositionModel| {
        let wanted = Convention { sources, position };
        let view = found.iter().find(|view| view.convention == wanted)?;
        Some(view.ugr.as_ref().ok()?.value)
    };
    let usual = by(SourceModel::Visible, PositionModel::Table);
    let step = |other: Option<f64>, why: &str| {
        let difference = other? - usual?;
        Some(format!("{}: {why}", signed(difference)))
    };
    let mut lines: Vec<String> = [
        step(
            by(SourceModel::Visible, PositionModel::Levin),
            "Levin's formula in place of the table, which ignores sources in its void cells",
        ),
        step(
            by(SourceModel::Subdivided, PositionModel::Table),
            "every part of an opening at its own position; L squared part by part",
        ),
        step(
            by(SourceModel::Centre, PositionModel::Table),
            "intensity and size as from far away: near luminaires are neither",
        ),
    ]
    .into_iter()
    .flatten()
    .collect();
    if let Some((view, image)) = found.iter().find_map(|view| Some((view, view.image.as_ref()?))) {
        let sources = view.sheet.as_ref().map_or(0, |sheet| sheet.sources.len());
        let ugr = match &image.ugr {
            Ok(ugr) => fixed(LANG, *ugr, 2),
            Err(undefined) => format!("- ({undefined})"),
        };
        lines.push(format!(
            "image-based UGR {ugr} in a picture of {} x {} pixels: {} source(s) found where {sources} are known (what \
             lies within 0.1 rad is one, what is under the threshold none), edges averaged in pixels, L_b {} for {} \
             cd/m²",
            image.pixels,
            image.pixels,
            image.found,
            figures(LANG, image.background_cd_m2, 3),
            figures(LANG, view.background_cd_m2, 3),
        ));
        if !image.convention.is_empty() {
            lines.push(format!("  {}", image.convention));
        }
    }
    lines
}

fn signed(difference: f64) -> String {
    let sign = if difference < 0.0 { "" } else { "+" };
    format!("{sign}{}", fixed(LANG, difference, 2))
}

fn estimate(value: &Result<Interval, Undefined>, decimals: usize) -> String {
    match value {
        Ok(ugr) if !ugr.se.is_finite() => format!("{} (no interval)", fixed(LANG, ugr.value, decimals)),
        Ok(ugr) => format!(
            "{} ({}...{})",
            fixed(LANG, ugr.value, decimals),
            fixed(LANG, ugr.lo, decimals),
            fixed(LANG, ugr.hi, decimals)
        ),
        Err(undefined) => format!("- ({undefined})"),
    }
}
