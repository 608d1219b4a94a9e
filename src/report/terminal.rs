//! The table of `check` for a terminal. Columns are aligned by characters, not bytes; colour is
//! added after alignment so that escape codes do not count as width.

use super::sentence::{
    Naming, Sentence, Tally, is_at_the_limit, is_own, is_unverified, overall, room_verdict, sentence,
};
use super::words::{self, Lang, Term, phrase, word};
use super::xml::put;
use crate::outcome::{OTHER_PLANE, Outcome, Requirement, Verdict};

/// Above this many rooms the table has one line per room and lists only what does not pass.
const ROOMS_IN_FULL: usize = 12;

/// How the table is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Language.
    pub lang: Lang,
    /// Whether verdicts are coloured with ANSI codes.
    pub colour: Colour,
}

/// Use of ANSI codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Plain text.
    Plain,
    /// ANSI codes.
    Ansi,
}

/// The table, its footnotes, and the line that names the verdict of the whole.
pub fn table(outcome: &Outcome, style: Style) -> String {
    let naming = Naming::of(outcome);
    let mut text = String::new();
    let brief = outcome.rooms.len() > ROOMS_IN_FULL;
    if brief {
        text.push_str(&rooms(outcome, style));
    }
    let listed: Vec<&Requirement> = outcome
        .requirements
        .iter()
        .filter(|r| !brief || matches!(r.verdict, Verdict::Fail | Verdict::Undecided | Verdict::Undefined))
        .collect();
    if !listed.is_empty() {
        if brief {
            text.push('\n');
        }
        text.push_str(&requirements(&listed, naming, style));
        text.push_str(&footnotes(&listed, style.lang));
        text.push('\n');
    }
    let line = overall(style.lang, outcome);
    text.push_str(&paint(&line, outcome.verdict(), style.colour));
    text.push('\n');
    text
}

fn requirements(listed: &[&Requirement], naming: Naming, style: Style) -> String {
    let lang = style.lang;
    let head = [
        Term::Requirement,
        Term::Where,
        Term::Required,
        Term::Value,
        Term::IntervalWord,
        Term::VerdictColumn,
    ]
    .map(|term| word(lang, term).to_owned());
    let mut rows = vec![(head, None)];
    for requirement in listed {
        let Sentence { symbol, place, required, value, interval, verdict, .. } =
            sentence(lang, requirement, naming);
        // Beside requirements of a norm one's own must not be taken for another of its limits.
        let mark = match requirement {
            own if is_own(own) && listed.iter().any(|other| !is_own(other)) => "*",
            of_norm if is_unverified(of_norm) => "°",
            _ => "",
        };
        let mut verdict = verdict.to_owned();
        if is_at_the_limit(requirement) {
            verdict = format!("{verdict}, {}", word(lang, Term::AtTheLimit));
        }
        if let Some(blocks) = requirement.blocks_needed {
            let needed = phrase(lang, Term::BlocksNeeded, &[&blocks.to_string()]);
            verdict = format!("{verdict}: {needed}");
        }
        if let Err(undefined) = &requirement.value
            && !undefined.reason.is_empty()
        {
            verdict = format!("{verdict}: {}", words::said(lang, &undefined.reason));
        }
        let cells = [symbol.text(), place, format!("{required}{mark}"), value, interval, verdict]
            .map(|cell| one_line(&cell));
        rows.push((cells, Some(requirement.verdict)));
    }
    aligned(&rows, [false, false, false, true, true, false], style.colour)
}

fn rooms(outcome: &Outcome, style: Style) -> String {
    let lang = style.lang;
    let head = [
        word(lang, Term::RoomWord).to_owned(),
        word(lang, Term::RequirementsCount).to_owned(),
        word(lang, Term::VerdictColumn).to_owned(),
    ];
    let mut rows = vec![(head, None)];
    for room in &outcome.rooms {
        let tally = Tally::of(outcome.requirements.iter().filter(|r| r.room == room.name));
        let name =
            if room.number.is_empty() { room.name.clone() } else { format!("{} {}", room.number, room.name) };
        let verdict = tally.verdict();
        let said = room_verdict(lang, tally).to_owned();
        rows.push(([one_line(&name), format!("{}/{}", tally.pass, tally.judged()), said], verdict));
    }
    aligned(&rows, [false, true, false], style.colour)
}

/// Pads every column but the last to its widest cell, counted in characters.
fn aligned<const N: usize>(
    rows: &[([String; N], Option<Verdict>)],
    right: [bool; N],
    colour: Colour,
) -> String {
    let mut widths = [0; N];
    for (cells, _) in rows {
        for (width, cell) in widths.iter_mut().zip(cells) {
            *width = (*width).max(cell.chars().count());
        }
    }
    let mut text = String::new();
    for (cells, verdict) in rows {
        for (column, cell) in cells.iter().enumerate() {
            let pad = " ".repeat(widths[column] - cell.chars().count());
            if column + 1 == N {
                text.push_str(&paint(cell, *verdict, colour));
            } else if right[column] {
                put(&mut text, format_args!("{pad}{cell}  "));
            } else {
                put(&mut text, format_args!("{cell}{pad}  "));
            }
        }
        text.push('\n');
    }
    text
}

fn footnotes(listed: &[&Requirement], lang: Lang) -> String {
    let mut text = String::new();
    let mut note = |shown: bool, line: String| {
        if shown {
            text.push_str(&line);
            text.push('\n');
        }
    };
    let any = |test: &dyn Fn(&Requirement) -> bool| listed.iter().any(|r| test(r));
    note(any(&is_unverified), format!("° {}", word(lang, Term::UnverifiedMeans)));
    note(any(&is_own) && any(&|r| !is_own(r)), format!("* {}", word(lang, Term::OwnMeans)));
    note(any(&is_at_the_limit), word(lang, Term::AtTheLimitMeans).to_owned());
    note(any(&|r| r.verdict == Verdict::Undecided), word(lang, Term::UndecidedMeans).to_owned());
    for requirement in listed {
        if let Some(modified) = &requirement.modified {
            let (quantity, statistic) = (requirement.quantity, requirement.statistic);
            let unit = super::number::unit(lang, quantity, statistic);
            let from = super::number::limit(lang, quantity, statistic, modified.required_lx);
            let parts = [format!("{from}{unit}"), one_line(&modified.reason)];
            let said = phrase(lang, Term::ModifiedFrom, &[&parts[0], &parts[1]]);
            let symbol = words::symbol(lang, quantity, statistic).text();
            note(
                true,
                format!("{symbol} · {}: {said}", one_line(&words::place_name(lang, &requirement.subject))),
            );
        }
        if let Some(said) = requirement.note.split("; ").find(|part| part.contains(OTHER_PLANE)) {
            let said = words::said(lang, said);
            let symbol = words::symbol(lang, requirement.quantity, requirement.statistic).text();
            let place = one_line(&words::place_name(lang, &requirement.subject));
            note(true, format!("{symbol} · {place}: {said}"));
        }
        if let Some(other) = requirement.other_comparison {
            let subject = format!(
                "{} · {}",
                words::symbol(lang, requirement.quantity, requirement.statistic).text(),
                one_line(&words::place_name(lang, &requirement.subject))
            );
            let said = phrase(lang, Term::OtherComparison, &[words::verdict(lang, other)]);
            note(true, format!("{subject}: {said}"));
        }
    }
    note(any(&|r| r.value.is_ok()), word(lang, Term::ErrorNotice).to_owned());
    text
}

/// Control characters of a name must not reach the terminal.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

fn paint(text: &str, verdict: Option<Verdict>, colour: Colour) -> String {
    let code = match verdict {
        Some(Verdict::Pass) => "32",
        Some(Verdict::Fail) => "1;31",
        Some(Verdict::Undecided | Verdict::Undefined) => "33",
        Some(Verdict::Declared | Verdict::NotAssessed) | None => "2",
    };
    match (colour, verdict) {
        (Colour::Ansi, Some(_)) => format!("\u{1b}[{code}m{text}\u{1b}[0m"),
        (Colour::Ansi | Colour::Plain, _) => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    const PLAIN: Style = Style { lang: Lang::En, colour: Colour::Plain };

    #[test]
    fn the_verdict_column_starts_at_the_same_character_in_every_row() {
        for lang in [Lang::En, Lang::Ru] {
            let text = table(&sample::outcome(), Style { lang, ..PLAIN });
            let head = word(lang, Term::VerdictColumn);
            let first = text.lines().next().expect("a head");
            let at = first.chars().count() - head.chars().count();
            let outcome = sample::outcome();
            for (line, requirement) in text.lines().skip(1).zip(&outcome.requirements) {
                let tail: String = line.chars().skip(at).collect();
                assert!(tail.starts_with(words::verdict(lang, requirement.verdict)), "{line}");
            }
        }
    }

    #[test]
    fn marks_are_explained_and_the_last_line_is_the_verdict() {
        let text = table(&sample::outcome(), PLAIN);
        assert!(text.contains("°") && text.contains("not verified"));
        assert!(text.contains("at the limit") && text.contains("declared") && text.contains("not assessed"));
        assert!(!text.contains("declared, at the limit"), "a declared value lies nowhere: {text}");
        let last = text.lines().last().expect("a line");
        assert!(last.starts_with("does not comply with EN 12464-1:2021: 2 of"), "{last}");
        assert!(!text.contains('\u{1b}'));
        assert!(table(&sample::outcome(), Style { colour: Colour::Ansi, ..PLAIN }).contains("\u{1b}[1;31m"));
    }

    #[test]
    fn a_hundred_rooms_are_one_line_each_and_only_failures_are_listed() {
        let text = table(&sample::hundred_rooms(), PLAIN);
        assert!(text.lines().count() < 125, "{text}");
        assert!(text.contains("EN 12464-1:2021"));
    }

    #[test]
    fn nothing_required_is_said() {
        let mut outcome = sample::outcome();
        outcome.requirements.clear();
        assert_eq!(table(&outcome, PLAIN), "EN 12464-1:2021 is not assessed\n");
        outcome.norm = None;
        assert_eq!(table(&outcome, PLAIN), "nothing was required\n");
    }
}
