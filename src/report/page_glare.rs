//! Glare in a room's chapter: the table method, observers, and what they see.

use super::glare;
use super::markup::{grid, list};
use super::number;
use super::words::{self, Lang, Term, phrase, word};
use super::xml::{escape, put};
use crate::outcome::{Card, Interval, UgrTableOutcome, ViewpointOutcome};
use crate::quantity::{Quantity, Statistic};
use crate::units::Undefined;

/// Glare sources listed for each observer.
const SOURCES: usize = 5;
/// Width of a card's picture, px.
const PICTURE_PX: f64 = 240.0;

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
    html.push_str(&roses(views, lang));
    for view in views.iter().filter(|view| !view.sources.is_empty()) {
        html.push_str(&sources(view, lang));
    }
    html
}

/// A rose of UGR for every observer that looks in several directions: spokes from 10 to 30, the
/// circles at 19 and 25, the worst direction bold and in words.
fn roses(views: &[ViewpointOutcome], lang: Lang) -> String {
    let mut html = String::new();
    let mut start = 0;
    while start < views.len() {
        let same = |view: &&ViewpointOutcome| view.name == views[start].name;
        let of_name: Vec<&ViewpointOutcome> = views[start..].iter().take_while(same).collect();
        start += of_name.len();
        let mut scenes: Vec<&str> = of_name.iter().map(|view| view.light_scene.as_str()).collect();
        scenes.sort_unstable();
        scenes.dedup();
        for scene in scenes {
            let sweep: Vec<(f64, f64)> = of_name
                .iter()
                .filter(|view| view.light_scene == scene)
                .filter_map(|view| Some((view.azimuth_deg, view.ugr.as_ref().ok()?.value)))
                .collect();
            if let (true, Some(worst)) = (sweep.len() > 2, sweep.iter().max_by(|a, b| a.1.total_cmp(&b.1))) {
                html.push_str(&rose(of_name[0], scene, &sweep, *worst, lang));
            }
        }
    }
    html
}

fn rose(view: &ViewpointOutcome, scene: &str, sweep: &[(f64, f64)], worst: (f64, f64), lang: Lang) -> String {
    let radius = |ugr: f64| 60.0 * ((ugr - 10.0) / 20.0).clamp(0.0, 1.0);
    let mut svg = String::from("<svg viewBox=\"-70 -70 140 140\" width=\"180\" height=\"180\">");
    for level in [19.0, 25.0] {
        put(
            &mut svg,
            format_args!(
                "<circle r=\"{}\" fill=\"none\" stroke=\"#bbb\" stroke-width=\"0.5\"/>",
                radius(level)
            ),
        );
    }
    for &(azimuth_deg, ugr) in sweep {
        let (sin, cos) = azimuth_deg.to_radians().sin_cos();
        let bold = if ugr >= worst.1 { 2.5 } else { 1.0 };
        put(
            &mut svg,
            format_args!(
                "<line x1=\"0\" y1=\"0\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"#333\" stroke-width=\"{bold}\"/>",
                radius(ugr) * cos,
                -radius(ugr) * sin
            ),
        );
    }
    svg.push_str("</svg>");
    format!(
        "<figure>{svg}<figcaption class=\"note\">{} — {}: {} {}, {}°</figcaption></figure>\n",
        escape(&view.name),
        escape(scene),
        words::symbol(lang, Quantity::Ugr, Statistic::Max).text(),
        number::fixed(lang, worst.1, 1),
        number::fixed(lang, worst.0, 0),
    )
}

/// The indices that observers ask for beside UGR, a line each.
fn further(views: &[ViewpointOutcome], lang: Lang) -> String {
    let mut rows = Vec::new();
    for view in views {
        for index in &view.indices {
            let decimals = match index.unit.as_str() {
                "1" if index.key.contains("GP") => 3,
                "1" if index.key.contains('/') => 2,
                _ => 1,
            };
            let name = words::index_name(lang, &index.key);
            let (value, interval, reason) = match &index.estimate {
                Ok(estimate) => (
                    format!("<b>{}</b>", number::fixed(lang, estimate.value, decimals)),
                    span(lang, *estimate, decimals),
                    String::new(),
                ),
                Err(undefined) => ("—".into(), "—".into(), escape(&words::said(lang, &undefined.reason))),
            };
            let notes = index.notes.iter().map(|note| escape(&words::said(lang, note))).chain([reason]);
            let unit = if index.unit == "1" { "" } else { &index.unit };
            rows.push(vec![
                format!(
                    "{}<br/><span class=\"note\">{}</span>",
                    escape(&view.name),
                    escape(&view.light_scene)
                ),
                format!("{}°", number::fixed(lang, view.azimuth_deg, 1)),
                format!("{} <span class=\"note\">{}</span>", escape(&index.key), escape(name)),
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
        .enumerate()
        .map(|(number, source)| {
            let number = if view.card.is_some() { format!("{}. ", number + 1) } else { String::new() };
            vec![
                number + &escape(&words::source_label(lang, &source.label)),
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
    let mut html = view.card.as_ref().map_or(String::new(), |card| self::card(view, card, lang));
    html.push_str(&grid("lrrrrr", &head, &rows));
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

/// The card's picture, and what would help.
fn card(view: &ViewpointOutcome, card: &Card, lang: Lang) -> String {
    let mut lines = view.ugr.as_ref().map_or(Vec::new(), |ugr| glare::remedies(card, ugr, lang));
    lines.push(word(lang, Term::CardPicture).to_owned());
    let lines = lines.iter().map(|line| escape(line)).collect::<Vec<_>>().join(" ");
    format!(
        "<figure>{}<figcaption class=\"note\"><b>{}</b> {lines}</figcaption></figure>\n",
        glare::picture_svg(card, view.background_cd_m2, PICTURE_PX),
        escape(&view.name),
    )
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
