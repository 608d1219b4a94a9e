//! report.html: one file without scripts or anything fetched, for the screen and for A4. It is
//! written as XML too, so that a parser can check it. Two languages stand one after the other; a
//! switch without script shows one, and print shows the first.

use super::markup::{class_of, grid, heading, list, pairs, subheading, symbol};
use super::number;
use super::page_requirements::{remarks, requirements};
use super::page_room;
use super::plan;
use super::sentence::{Naming, Tally, overall_parts, room_verdict, sentence};
use super::words::{self, Lang, Term, phrase, word};
use super::xml::{escape, put};
use crate::outcome::{Bias, Outcome, Requirement, RoomOutcome, Verdict};
use crate::project::Compare;

/// Rooms up to which all details are open and all requirements stand on the first page.
const ROOMS_IN_FULL: usize = 12;
/// Bytes of drawings on the page, over all languages.
const DRAWINGS_BYTES: usize = 6_000_000;

/// The page in the given languages, of which there is at least one.
pub fn page(outcome: &Outcome, languages: &[Lang]) -> String {
    let first = languages[0];
    let mut css = include_str!("page.css").to_owned();
    let mut tabs = String::new();
    let mut switch = String::new();
    for (index, lang) in languages.iter().enumerate() {
        let code = lang.code();
        let checked = if index == 0 { " checked=\"checked\"" } else { "" };
        put(
            &mut switch,
            format_args!(
                "<input class=\"tab\" type=\"radio\" name=\"language\" id=\"show-{code}\"{checked}/>\n"
            ),
        );
        put(&mut tabs, format_args!("<label for=\"show-{code}\">{}</label>", lang.name()));
        put(
            &mut css,
            format_args!(
                "#show-{code}:checked~.lang-{code}{{display:block}}#show-{code}:checked~.tabs label[for=show-{code}]{{background:#20242a;color:#fff}}\n"
            ),
        );
    }
    if languages.len() > 1 {
        put(&mut switch, format_args!("<nav class=\"tabs\">{tabs}</nav>\n"));
    }
    let mut body = String::new();
    for lang in languages {
        let class = if *lang == first { " first" } else { "" };
        let code = lang.code();
        put(
            &mut body,
            format_args!(
                "<main class=\"lang lang-{code}{class}\" lang=\"{code}\">\n{}</main>\n",
                language(outcome, *lang, DRAWINGS_BYTES / languages.len())
            ),
        );
    }
    let title = format!("{} · {}", escape(&outcome.info.name), word(first, Term::Report));
    format!(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"{}\">\n<head>\n<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{title}</title>\n<style>\n{}</style>\n</head>\n<body>\n{switch}{body}</body>\n</html>\n",
        first.code(),
        css,
    )
}

fn language(outcome: &Outcome, lang: Lang, drawings_bytes: usize) -> String {
    let mut html = head(outcome, lang);
    html.push_str(&verdict(outcome, lang));
    let many = outcome.rooms.len() > ROOMS_IN_FULL;
    if outcome.rooms.len() > 1 {
        html.push_str(&rooms(outcome, lang, many));
    }
    let open = |r: &&Requirement| {
        !many
            || class_of(Some(r.verdict)) != "pass"
                && r.verdict != Verdict::Declared
                && r.verdict != Verdict::NotAssessed
    };
    let listed: Vec<&Requirement> = outcome.requirements.iter().filter(open).collect();
    if !listed.is_empty() {
        html.push_str(&heading(lang, Term::Requirements));
        html.push_str(&requirements(lang, &listed, Naming::of(outcome)));
        html.push_str(&remarks(lang, outcome, &listed));
    }
    html.push_str(&details(outcome, lang, many, drawings_bytes));
    html.push_str(&method(outcome, lang));
    put(
        &mut html,
        format_args!(
            "<div class=\"sign\"><div>{}</div><div>{}</div></div>\n",
            word(lang, Term::Signature),
            word(lang, Term::SignatureDate)
        ),
    );
    html
}

fn head(outcome: &Outcome, lang: Lang) -> String {
    let info = &outcome.info;
    let norm = outcome.norm.as_ref().map_or(String::new(), |norm| {
        let compare = match norm.compare {
            Compare::Exact => Term::CompareExact,
            Compare::Printed => Term::ComparePrinted,
        };
        format!("{} ({})", escape(&super::sentence::norm_name(norm)), word(lang, compare))
    });
    format!(
        "<p class=\"over\">{}</p>\n<h1>{}</h1>\n{}",
        word(lang, Term::Report),
        escape(&info.name),
        pairs(&[
            (word(lang, Term::Client), escape(&info.client)),
            (word(lang, Term::Revision), escape(&info.revision)),
            (word(lang, Term::Date), escape(&info.date)),
            (word(lang, Term::Norm), norm),
        ])
    )
}

fn verdict(outcome: &Outcome, lang: Lang) -> String {
    let (head, counts) = overall_parts(lang, outcome);
    let mut letters = head.chars();
    let head: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
    format!(
        "<div class=\"verdict {}\"><b>{}</b>{}<p class=\"note\">{} {}</p></div>\n",
        class_of(outcome.verdict()),
        escape(&head),
        counts.map_or(String::new(), |counts| format!("<p>{counts}</p>")),
        word(lang, Term::ErrorNotice),
        word(lang, Term::JointNotice),
    )
}

fn of_room<'a>(outcome: &'a Outcome, room: &'a RoomOutcome) -> impl Iterator<Item = &'a Requirement> + Clone {
    outcome.requirements.iter().filter(|r| r.room == room.name)
}

fn rooms(outcome: &Outcome, lang: Lang, many: bool) -> String {
    let tallies: Vec<Tally> = outcome.rooms.iter().map(|room| Tally::of(of_room(outcome, room))).collect();
    let count = |verdict| tallies.iter().filter(|tally| tally.verdict() == Some(verdict)).count().to_string();
    let line = phrase(
        lang,
        Term::RoomsPassed,
        &[
            &outcome.rooms.len().to_string(),
            &count(Verdict::Pass),
            &count(Verdict::Fail),
            &count(Verdict::Undecided),
        ],
    );
    let rows: Vec<Vec<String>> = outcome
        .rooms
        .iter()
        .zip(&tallies)
        .map(|(room, tally)| room_row(outcome, room, *tally, lang, many))
        .collect();
    let verdict = if many { "" } else { word(lang, Term::VerdictColumn) };
    let tightest = word(lang, if many { Term::Margin } else { Term::Worst });
    let head = [word(lang, Term::RoomWord), "✓", tightest, verdict];
    let mut html = format!(
        "{}<p>{line}</p>\n<div class=\"rooms{}\">",
        heading(lang, Term::Rooms),
        if many { " many" } else { "" }
    );
    let columns = if many { 3 } else { 1 };
    for part in rows.chunks(rows.len().div_ceil(columns).max(1)) {
        html.push_str(&grid("arrw", &head, part));
    }
    html.push_str("</div>\n");
    html
}

/// A room's line: what it passes, its tightest requirement, and a mark where words have no room.
fn room_row(outcome: &Outcome, room: &RoomOutcome, tally: Tally, lang: Lang, many: bool) -> Vec<String> {
    let verdict = tally.verdict();
    let said = match verdict {
        None if many => "–",
        Some(Verdict::Pass) if many => "✓",
        Some(Verdict::Fail) if many => "✗",
        Some(_) if many => "?",
        _ => room_verdict(lang, tally),
    };
    let tightest = of_room(outcome, room)
        .filter_map(|r| r.margin.filter(|margin| margin.is_finite()).map(|margin| (margin, r)))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let tightest = tightest.map_or("—".to_owned(), |(_, r)| {
        let text = sentence(lang, r, Naming { room: false, light_scene: false, row: false });
        format!("{} {}", symbol(&text.symbol), text.margin)
    });
    vec![
        format!("{} {}", escape(&room.number), escape(&room.name)),
        format!("{}/{}", tally.pass, tally.judged()),
        tightest,
        format!("<span class=\"{}\">{said}</span>", class_of(verdict)),
    ]
}

fn details(outcome: &Outcome, lang: Lang, many: bool, mut drawings_bytes: usize) -> String {
    let passes = |room: &&RoomOutcome| Tally::of(of_room(outcome, room)).verdict() == Some(Verdict::Pass);
    let (good, other): (Vec<&RoomOutcome>, Vec<&RoomOutcome>) =
        outcome.rooms.iter().partition(|room| many && passes(room));
    let mut left_out = 0;
    let mut one = |room: &RoomOutcome| {
        let mut drawings = Vec::new();
        for subject in plan::subjects(outcome).filter(|subject| std::ptr::eq(subject.room, room)) {
            let svg = if drawings_bytes > 0 { plan::draw(subject, lang) } else { String::new() };
            if svg.is_empty() || svg.len() > drawings_bytes {
                drawings_bytes = 0;
                left_out += 1;
            } else {
                drawings_bytes -= svg.len();
                drawings.push(svg);
            }
        }
        page_room::room(outcome, room, lang, &drawings)
    };
    let mut html = String::new();
    for room in other {
        put(&mut html, format_args!("<section class=\"chapter\">{}</section>\n", one(room)));
    }
    if !good.is_empty() {
        html.push_str(&heading(lang, Term::DetailsOf));
        for room in good {
            put(
                &mut html,
                format_args!(
                    "<details><summary>{} {}</summary>\n{}</details>\n",
                    escape(&room.number),
                    escape(&room.name),
                    one(room)
                ),
            );
        }
    }
    if left_out > 0 {
        put(
            &mut html,
            format_args!(
                "<p class=\"note\">{}</p>\n",
                phrase(lang, Term::PlansLeftOut, &[&left_out.to_string()])
            ),
        );
    }
    html
}

fn method(outcome: &Outcome, lang: Lang) -> String {
    let solver = &outcome.solver;
    let count = |number: f64| number::fixed(lang, number, 0);
    let mut html = format!("<section class=\"chapter\">{}", heading(lang, Term::Method));
    html.push_str(&pairs(&[
        (word(lang, Term::SolverWord), escape(&solver.method)),
        (word(lang, Term::Blocks), count(solver.blocks as f64)),
        (word(lang, Term::Confidence), number::fixed(lang, solver.confidence, 2)),
        (word(lang, Term::Seed), solver.seed.to_string()),
        (word(lang, Term::Triangles), count(solver.triangles as f64)),
        (word(lang, Term::LuminairesWord), count(solver.luminaires as f64)),
        (
            word(lang, Term::Rays),
            format!("{}; {}", count(solver.rays as f64), count(solver.lost_rays as f64)),
        ),
    ]));
    put(&mut html, format_args!("<p><b>{}</b></p>\n", word(lang, Term::ErrorNotice)));
    html.push_str(&subheading(lang, Term::Biases));
    if outcome.biases.is_empty() {
        put(&mut html, format_args!("<p>{}</p>\n", word(lang, Term::NoBiases)));
    } else {
        let item = |bias: &Bias| {
            let what = bias.what.trim_end_matches('.');
            let (what, effect) = (words::said(lang, what), words::said(lang, &bias.effect));
            format!("{}. {}: {}", escape(&what), word(lang, Term::Effect), escape(&effect))
        };
        html.push_str(&list(outcome.biases.iter().map(item)));
    }
    if !outcome.plan.is_empty() {
        html.push_str(&subheading(lang, Term::PlanReasons));
        html.push_str(&list(outcome.plan.iter().map(|reason| escape(&words::said(lang, reason)))));
    }
    if !outcome.inputs.is_empty() {
        html.push_str(&subheading(lang, Term::Inputs));
        let rows: Vec<Vec<String>> = outcome
            .inputs
            .iter()
            .map(|input| vec![escape(&input.path), format!("<code>{}</code>", escape(&input.sha256))])
            .collect();
        html.push_str(&grid("al", &[word(lang, Term::FileWord), "SHA-256"], &rows));
    }
    html.push_str("</section>\n");
    html
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn the_page_is_self_contained_and_says_what_an_interval_is() {
        for lang in [Lang::En, Lang::Ru] {
            let html = page(&sample::outcome(), &[lang]);
            assert!(
                !html.contains("<script")
                    && !html.contains("src=")
                    && !html.contains("@import")
                    && !html.contains("url(")
            );
            assert!(html.contains(word(lang, Term::ErrorNotice)));
            assert!(html.contains("<svg") && html.contains(&"ab".repeat(32)));
            assert!(!html.contains("<R&D>"));
        }
    }

    #[test]
    fn a_russian_page_holds_no_english_heading() {
        let html = page(&sample::outcome(), &[Lang::Ru]);
        for term in
            [Term::Requirements, Term::LuminaireSchedule, Term::FluxBalance, Term::Observers, Term::Biases]
        {
            assert!(!html.contains(&format!(">{}<", word(Lang::En, term))), "{term:?}");
            assert!(html.contains(word(Lang::Ru, term)), "{term:?}");
        }
    }

    #[test]
    fn a_hundred_rooms_stay_within_the_budget_and_hide_what_passes() {
        let html = page(&sample::hundred_rooms(), &[Lang::En, Lang::Ru]);
        assert!(html.len() < DRAWINGS_BYTES + 4_000_000, "{}", html.len());
        assert_eq!(html.matches("<details>").count(), 2 * 90);
    }
}
