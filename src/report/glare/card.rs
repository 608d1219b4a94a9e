//! The card of a view: a small fisheye picture in grey with its sources outlined and numbered, and, on a
//! sheet of its own, the list of sources and what would help.

use super::super::number::{figures, fixed, percent};
use super::super::words::{self, Lang, Term, phrase, word};
use super::super::xml::{escape, put};
use super::check::base64;
use super::png;
use crate::image::LuminanceImage;
use crate::observe::cards::SHIFT_M;
use crate::outcome::{Card, Interval, Remedy, Shift, ViewpointOutcome};
use crate::quantity::{Quantity, Statistic};

/// Luminances from the background's divided by this to times this go from black to white.
const SPAN: f64 = 16.0;
/// Sources that get a number in the picture and a line in the list.
const NUMBERED: usize = 9;
/// Edge of the picture on a sheet of its own, and the sheet's width, px.
const EDGE: f64 = 360.0;
const WIDTH: f64 = 900.0;
/// Where the list begins, and the ends of its columns, px.
const LIST: f64 = 390.0;
const COLUMNS: [f64; 4] = [680.0, 760.0, 815.0, 885.0];

/// The picture alone, `edge` px wide and high on the page.
pub fn picture_svg(card: &Card, background_cd_m2: f64, edge: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1 1\" width=\"{edge}\" height=\"{edge}\">{}</svg>",
        inner(card, background_cd_m2)
    )
}

/// What is in the picture, in a square of edge 1.
fn inner(card: &Card, background_cd_m2: f64) -> String {
    let picture = &card.picture;
    let mut svg = format!(
        "<image width=\"1\" height=\"1\" href=\"data:image/png;base64,{}\"/><circle cx=\"0.5\" cy=\"0.5\" r=\"0.499\" \
         fill=\"none\" stroke=\"#777\" stroke-width=\"0.003\"/>",
        base64(&grey(picture, background_cd_m2))
    );
    for source in card.sources.iter().rev() {
        let points: Vec<String> = source.outline.iter().map(|[x, y]| format!("{x:.4},{y:.4}")).collect();
        put(
            &mut svg,
            format_args!(
                "<polygon points=\"{}\" fill=\"none\" stroke=\"#e66101\" stroke-width=\"0.006\"/>",
                points.join(" ")
            ),
        );
    }
    for (number, source) in card.sources.iter().enumerate().take(NUMBERED) {
        let [x, y] = source.centre;
        put(
            &mut svg,
            format_args!(
                "<text x=\"{x:.4}\" y=\"{y:.4}\" font-family=\"sans-serif\" font-size=\"0.05\" text-anchor=\"middle\" \
                 dominant-baseline=\"central\" fill=\"#fff\" stroke=\"#000\" stroke-width=\"0.01\" \
                 paint-order=\"stroke\">{}</text>",
                number + 1
            ),
        );
    }
    svg
}

/// Greys by the logarithm of luminance, the background's in the middle.
fn grey(picture: &LuminanceImage, background_cd_m2: f64) -> Vec<u8> {
    let palette: Vec<[u8; 3]> = (0..=255).map(|grey| [grey; 3]).collect();
    let middle = if background_cd_m2 > 0.0 { background_cd_m2 } else { 1.0 };
    let level = |&luminance: &f64| {
        let octaves = (luminance.max(1e-9) / middle).ln() / SPAN.ln();
        (255.0 * (0.5 + 0.5 * octaves).clamp(0.0, 1.0)) as u8
    };
    let pixels: Vec<u8> = picture.luminance_cd_m2.iter().map(level).collect();
    png::encode(picture.width, &pixels, &palette)
}

/// What would help, a sentence each.
pub fn remedies(card: &Card, ugr: &Interval, lang: Lang) -> Vec<String> {
    let now = fixed(lang, ugr.value, 1);
    let then = |remedy: &Remedy| fixed(lang, remedy.ugr, 1);
    let mut lines = Vec::new();
    // Only what shows in the printed digit is worth a sentence.
    let helps = |remedy: &&Remedy| then(remedy) != now && remedy.ugr < ugr.value;
    if let Some(remedy) = card.dimmed.as_ref().filter(helps) {
        lines.push(match &remedy.mirror {
            None => phrase(lang, Term::CardDimmed, &[&remedy.luminaire, &then(remedy), &now]),
            Some(mirror) => phrase(lang, Term::CardImage, &[&remedy.luminaire, mirror, &then(remedy), &now]),
        });
    }
    if let Some(remedy) = card.moved.as_ref().filter(helps) {
        let way = word(
            lang,
            match remedy.shift {
                Some(Shift::Nearer) => Term::ShiftNearer,
                Some(Shift::Right) => Term::ShiftRight,
                Some(Shift::Left) => Term::ShiftLeft,
                Some(Shift::Away) | None => Term::ShiftAway,
            },
        );
        let metres = fixed(lang, SHIFT_M, 1);
        let parts = [remedy.luminaire.as_str(), &metres, way, &then(remedy), &now];
        lines.push(phrase(lang, Term::CardMoved, &parts));
    }
    if !lines.is_empty() {
        lines.push(word(lang, Term::CardGuide).to_owned());
    }
    lines
}

/// A sheet with picture, list and remedies; `None` where the view has no card.
pub fn card_svg(view: &ViewpointOutcome, lang: Lang) -> Option<String> {
    let card = view.card.as_ref()?;
    let symbol = words::symbol(lang, Quantity::Ugr, Statistic::Value).text();
    let ugr = match &view.ugr {
        Ok(ugr) => format!(
            "{symbol} {} ({}…{})",
            fixed(lang, ugr.value, 1),
            fixed(lang, ugr.lo, 1),
            fixed(lang, ugr.hi, 1)
        ),
        Err(undefined) => format!("{symbol} — {}", words::said(lang, &undefined.reason)),
    };
    let eye = view.eye.to_array().map(|metres| fixed(lang, metres, 2)).join("; ");
    let mut lines = Lines { svg: String::new(), y: 24.0 };
    lines.add(18.0, &format!("{} — {}: {}°", view.name, view.light_scene, fixed(lang, view.azimuth_deg, 1)));
    lines.add(16.0, &ugr);
    lines.add(
        12.0,
        &format!(
            "L_b {} cd/m², E_v {} lx; {} {eye}",
            figures(lang, view.background_cd_m2, 3),
            figures(lang, view.e_v_lx, 3),
            word(lang, Term::Eye)
        ),
    );
    lines.y += 6.0;
    let heads = ["L, cd/m²", "ω, sr", "P", "%"].map(str::to_owned);
    lines.row(word(lang, Term::GlareSource), &heads);
    for (number, source) in view.sources.iter().enumerate().take(NUMBERED) {
        lines.row(
            &format!("{}. {}", number + 1, words::source_label(lang, &source.label)),
            &[
                figures(lang, source.luminance_cd_m2, 3),
                figures(lang, source.solid_angle_sr, 3),
                fixed(lang, source.position_index, 2),
                fixed(lang, 100.0 * source.share, 1),
            ],
        );
    }
    if let Some(rest) = view.sources.get(NUMBERED..).filter(|rest| !rest.is_empty()) {
        let share = percent(lang, rest.iter().map(|source| source.share).sum());
        lines.add(12.0, &phrase(lang, Term::MoreSources, &[&rest.len().to_string(), &share]));
    }
    lines.y += 6.0;
    if let Ok(ugr) = &view.ugr {
        for sentence in remedies(card, ugr, lang) {
            lines.add_folded(&sentence);
        }
    }
    for note in &view.notes {
        lines.add_folded(&words::said(lang, note));
    }
    lines.add_folded(&words::said(lang, &view.convention));
    lines.add_folded(word(lang, Term::CardPicture));
    let height = lines.y.max(EDGE + 20.0);
    Some(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.0}\" font-family=\"sans-serif\">\n\
         <title>{}</title>\n<rect width=\"{WIDTH}\" height=\"{height:.0}\" fill=\"#fff\"/>\n\
         <g transform=\"translate(10 10) scale({EDGE})\">{}</g>\n{}</svg>\n",
        escape(&view.name),
        inner(card, view.background_cd_m2),
        lines.svg
    ))
}

/// Lines of text beside the picture.
struct Lines {
    svg: String,
    y: f64,
}

impl Lines {
    fn add(&mut self, size: f64, text: &str) {
        put(
            &mut self.svg,
            format_args!(
                "<text x=\"{LIST}\" y=\"{:.1}\" font-size=\"{size}\">{}</text>\n",
                self.y,
                escape(text)
            ),
        );
        self.y += 1.4 * size;
    }

    /// A sentence in as many lines as it takes.
    fn add_folded(&mut self, text: &str) {
        const MOST: usize = 66;
        let mut line = String::new();
        for word in text.split(' ') {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > MOST {
                self.add(12.0, &line);
                line.clear();
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        self.add(12.0, &line);
    }

    fn row(&mut self, first: &str, rest: &[String; 4]) {
        let y = self.y;
        self.add(12.0, first);
        for (x, text) in COLUMNS.into_iter().zip(rest) {
            put(
                &mut self.svg,
                format_args!(
                    "<text x=\"{x}\" y=\"{y:.1}\" font-size=\"12\" text-anchor=\"end\">{}</text>\n",
                    escape(text)
                ),
            );
        }
    }
}
