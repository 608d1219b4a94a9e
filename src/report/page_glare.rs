//! Glare in a room's chapter: the table method, observers, and what they see.

use super::markup::{grid, list};
use super::number;
use super::words::{self, Lang, Term, phrase, word};
use super::xml::{escape, put};
use crate::outcome::{Interval, UgrTableOutcome, ViewpointOutcome};
use crate::quantity::{Quantity, Statistic};
use crate::units::Undefined;

/// Glare sources listed for each observer.
const SOURCES: usize = 5;

/// UGR of the table method, a line per luminaire type.
pub fn ugr_table(tables: &[UgrTableOutcome], lang: Lang) -> String {
    let text = |value: &Result<f64, Undefined>| match value {
        Ok(value) => number::fixed(lang, *value, 1),
        Err(undefined) => {
            format!("— <span class=\"note\">{}</span>", escape(&words::said(lang, &undefined.reason)))
        }
    };
    let row = |table: &UgrTableOutcome| {
        let notes =
            table.notes.iter().map(|note| escape(&words::said(lang, note))).collect::<Vec<_>>().join("; ");
        vec![
            format!("<b>{}</b>", escape(&table.kind)),
            number::fixed(lang, table.shr, 2),
            text(&table.crosswise),
            text(&table.endwise),
            format!("<span class=\"note\">{notes}</span>"),
        ]
    };
    let head = [
        word(lang, Term::TypeWord),
        "SHR",
        word(lang, Term::Crosswise),
        word(lang, Term::Endwise),
        word(lang, Term::Notes),
    ];
    grid("wrlll", &head, &tables.iter().map(row).collect::<Vec<_>>())
}

/// Observers with their UGR, and the sources of each.
pub fn observers(views: &[ViewpointOutcome], lang: Lang) -> String {
    let row = |view: &ViewpointOutcome| {
        let eye = view.eye.to_array().map(|length| number::metres(lang, length)).join("; ");
        let angle = |degrees| format!("{}°", number::fixed(lang, degrees, 1));
        let ugr = match &view.ugr {
            Ok(ugr) => format!("<b>{}</b>", number::fixed(lang, ugr.value, 1)),
            Err(undefined) => {
                format!("— <span class=\"note\">{}</span>", escape(&words::said(lang, &undefined.reason)))
            }
        };
        let interval = view.ugr.as_ref().map_or("—".to_owned(), |ugr| span(lang, *ugr, 1));
        vec![
            format!("{}<br/><span class=\"note\">{}</span>", escape(&view.name), escape(&view.light_scene)),
            eye,
            format!("{}; {}", angle(view.azimuth_deg), angle(view.tilt_deg)),
            ugr,
            interval,
            number::figures(lang, view.background_cd_m2, 3),
            number::illuminance(lang, view.e_v_lx),
        ]
    };
    let ugr = words::symbol(lang, Quantity::Ugr, Statistic::Value).text();
    let head = [
        word(lang, Term::Observer),
        word(lang, Term::Eye),
        word(lang, Term::LineOfSight),
        &ugr,
        word(lang, Term::NumericalInterval),
        word(lang, Term::BackgroundLuminance),
        word(lang, Term::EyeIlluminance),
    ];
    let mut html = grid("awwlrrr", &head, &views.iter().map(row).collect::<Vec<_>>());
    let mut conventions: Vec<&str> =
        views.iter().map(|view| view.convention.as_str()).filter(|text| !text.is_empty()).collect();
    conventions.dedup();
    for convention in conventions {
        put(
            &mut html,
            format_args!(
                "<p class=\"note\">{}: {}</p>\n",
                word(lang, Term::Convention),
                escape(&words::said(lang, convention))
            ),
        );
    }
    html.push_str(&further(views, lang));
    for view in views.iter().filter(|view| !view.sources.is_empty()) {
        html.push_str(&sources(view, lang));
    }
    html
}

/// The indices that observers ask for beside UGR, a line each.
fn further(views: &[ViewpointOutcome], lang: Lang) -> String {
    let mut rows = Vec::new();
    for view in views {
        for index in &view.indices {
            let decimals = if index.unit == "1" && index.key.contains("GP") { 3 } else { 1 };
            let (value, interval, reason) = match &index.estimate {
                Ok(estimate) => (
                    format!("<b>{}</b>", number::fixed(lang, estimate.value, decimals)),
                    span(lang, *estimate, decimals),
                    String::new(),
                ),
                Err(undefined) => ("—".into(), "—".into(), escape(&undefined.reason)),
            };
            let notes = index.notes.iter().map(|note| escape(note)).chain([reason]);
            let unit = if index.unit == "1" { "" } else { &index.unit };
            rows.push(vec![
                format!(
                    "{}<br/><span class=\"note\">{}</span>",
                    escape(&view.name),
                    escape(&view.light_scene)
                ),
                format!("{}°", number::fixed(lang, view.azimuth_deg, 1)),
                format!("{} <span class=\"note\">{}</span>", escape(&index.key), escape(&index.name)),
                format!("{value} {unit}"),
                interval,
                format!(
                    "<span class=\"note\">{}</span>",
                    notes.filter(|note| !note.is_empty()).collect::<Vec<_>>().join("; ")
                ),
            ]);
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    let head = [
        word(lang, Term::Observer),
        word(lang, Term::LineOfSight),
        word(lang, Term::QuantityWord),
        word(lang, Term::Value),
        word(lang, Term::NumericalInterval),
        word(lang, Term::Notes),
    ];
    grid("awwrll", &head, &rows)
}

fn sources(view: &ViewpointOutcome, lang: Lang) -> String {
    let rows: Vec<Vec<String>> = view
        .sources
        .iter()
        .take(SOURCES)
        .map(|source| {
            vec![
                escape(&source.label),
                number::figures(lang, source.luminance_cd_m2, 3),
                number::figures(lang, source.solid_angle_sr, 3),
                number::fixed(lang, source.position_index, 2),
                number::percent(lang, source.visible_fraction),
                number::percent(lang, source.share),
            ]
        })
        .collect();
    let source = format!(
        "{} — {} <span class=\"note\">{}</span>",
        word(lang, Term::GlareSource),
        escape(&view.name),
        escape(&view.light_scene)
    );
    let head = [
        &source,
        word(lang, Term::SourceLuminance),
        word(lang, Term::SolidAngle),
        word(lang, Term::PositionIndex),
        word(lang, Term::VisibleFraction),
        word(lang, Term::Share),
    ];
    let mut html = grid("lrrrrr", &head, &rows);
    let rest = view.sources.get(SOURCES..).unwrap_or_default();
    if !rest.is_empty() {
        let share = number::percent(lang, rest.iter().map(|source| source.share).sum());
        let text = phrase(lang, Term::MoreSources, &[&rest.len().to_string(), &share]);
        put(&mut html, format_args!("<p class=\"note\">{text}</p>\n"));
    }
    if !view.notes.is_empty() {
        put(
            &mut html,
            format_args!(
                "<div class=\"note\">{}</div>\n",
                list(view.notes.iter().map(|note| escape(&words::said(lang, note))))
            ),
        );
    }
    html
}

/// An interval's ends, or the words for none.
pub fn span(lang: Lang, interval: Interval, decimals: usize) -> String {
    if interval.lo.is_finite() && interval.hi.is_finite() {
        format!(
            "{}…{}",
            number::fixed(lang, interval.lo, decimals),
            number::fixed(lang, interval.hi, decimals)
        )
    } else {
        word(lang, Term::NoInterval).to_owned()
    }
}
