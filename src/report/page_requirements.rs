//! The table of requirements on the page: limit, value, numerical interval, margin, verdict.

use super::markup::{class_of, grid, symbol};
use super::sentence::{Naming, is_at_the_limit, is_unverified, sentence};
use super::words::{self, Lang, Term, phrase, word};
use super::xml::{escape, put};
use crate::outcome::{Outcome, Requirement, Verdict};
use crate::quantity::{Quantity, Statistic};
use std::collections::BTreeMap;

/// The table of requirements, under the names of their rooms if there are several.
pub fn requirements(lang: Lang, listed: &[&Requirement], naming: Naming) -> String {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut room = None;
    for requirement in listed {
        if naming.room && room != Some(&requirement.room) {
            room = Some(&requirement.room);
            rows.push(vec![escape(&requirement.room)]);
        }
        rows.push(row(lang, requirement, naming));
        let known_with_it = known_with_it(lang, requirement);
        if !known_with_it.is_empty() {
            rows.push(vec![String::new(), known_with_it.join("<br/>")]);
        }
    }
    let head = [
        Term::Requirement,
        Term::Where,
        Term::Required,
        Term::Value,
        Term::NumericalInterval,
        Term::Margin,
        Term::VerdictColumn,
    ]
    .map(|term| word(lang, term));
    grid("walrrrw", &head, &rows)
}

fn row(lang: Lang, r: &Requirement, naming: Naming) -> Vec<String> {
    let text = sentence(lang, r, Naming { room: false, row: false, ..naming });
    let place = if r.subject == r.room {
        let scene = if naming.light_scene { format!(" · {}", r.light_scene) } else { String::new() };
        format!("{}{scene}", word(lang, Term::RoomWord))
    } else {
        text.place
    };
    let mark = if is_unverified(r) { "°" } else { "" };
    let name = escape(&words::quantity(lang, r.quantity));
    let verified = escape(words::verified(lang, &r.verified));
    let source = if r.clause.is_empty() { verified } else { format!("{} · {verified}", escape(&r.clause)) };
    vec![
        format!("<span title=\"{name}\">{}</span>", symbol(&text.symbol)),
        escape(&place),
        format!(
            "<span class=\"w\">{}{mark}</span><br/><span class=\"note w\">{source}</span>",
            text.required
        ),
        text.value,
        text.interval,
        text.margin,
        verdict(lang, r),
    ]
}

/// Said once below the table, not in every row.
fn is_maintained(r: &Requirement) -> bool {
    r.note == "maintained"
}

/// The verdict's word.
fn verdict(lang: Lang, r: &Requirement) -> String {
    let mut html =
        format!("<span class=\"{}\">{}</span>", class_of(Some(r.verdict)), words::verdict(lang, r.verdict));
    if is_at_the_limit(r) {
        put(&mut html, format_args!(",<br/>{}", word(lang, Term::AtTheLimit)));
    }
    html
}

/// What must be known with a verdict, below its row.
fn known_with_it(lang: Lang, r: &Requirement) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    lines.extend(r.value.as_ref().err().map(|undefined| escape(&words::said(lang, &undefined.reason))));
    lines.extend((!r.note.is_empty() && !is_maintained(r)).then(|| escape(&words::note(lang, &r.note))));
    lines.extend(r.blocks_needed.map(|blocks| phrase(lang, Term::BlocksNeeded, &[&blocks.to_string()])));
    lines.extend(r.modified.as_ref().map(|modified| {
        let unit = super::number::unit(lang, r.quantity, r.statistic);
        let from = super::number::limit(lang, r.quantity, r.statistic, modified.required_lx);
        phrase(lang, Term::ModifiedFrom, &[&format!("{from}{unit}"), &escape(&modified.reason)])
    }));
    lines.extend(
        r.other_comparison.map(|other| phrase(lang, Term::OtherComparison, &[words::verdict(lang, other)])),
    );
    // All risks stand in result.json; here those of a close verdict, the rest is in the list of biases.
    let close = r.margin.is_some_and(|margin| margin.abs() < CLOSE);
    lines.extend(
        r.at_risk
            .iter()
            .filter(|_| close)
            .map(|risk| format!("{}: {}", word(lang, Term::AtRisk), escape(&words::said(lang, risk)))),
    );
    lines
}

/// Relative margin below which the page says what may cost it.
const CLOSE: f64 = 0.02;

/// What the marks and symbols in the table mean.
pub fn remarks(lang: Lang, outcome: &Outcome, listed: &[&Requirement]) -> String {
    let any = |test: &dyn Fn(&Requirement) -> bool| listed.iter().any(|r| test(r));
    let mut notes = Vec::new();
    if any(&is_unverified) {
        notes.push(format!("° {}", word(lang, Term::UnverifiedMeans)));
    }
    if any(&|r| r.verdict == Verdict::Undecided) {
        notes.push(word(lang, Term::UndecidedMeans).to_owned());
    }
    if any(&is_at_the_limit) {
        notes.push(word(lang, Term::AtTheLimitMeans).to_owned());
    }
    if any(&is_maintained) {
        notes.push(words::note(lang, "maintained").into_owned());
    }
    let quantities: BTreeMap<String, Quantity> = outcome
        .requirements
        .iter()
        .filter(|r| any(&|l| l.quantity == r.quantity))
        .map(|r| (r.quantity.key(), r.quantity))
        .collect();
    let names = quantities.into_values().map(|quantity| {
        format!(
            "{} — {}",
            symbol(&words::symbol(lang, quantity, Statistic::Value)),
            escape(&words::quantity(lang, quantity))
        )
    });
    notes.push(names.collect::<Vec<_>>().join("; "));
    let mut html = String::new();
    for note in notes {
        put(&mut html, format_args!("<p class=\"note\">{note}</p>\n"));
    }
    html
}
