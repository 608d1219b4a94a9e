//! A requirement and the verdict of the whole in words: what terminal, page, junit and sarif say
//! alike. Every interval here is the joint one, by which the verdict was given.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::number;
use super::words::{self, Lang, Symbol, Term, phrase, word};
use crate::outcome::{Bound, NormOutcome, Outcome, Requirement, SET_ASIDE, Verdict};
use crate::quantity::Quantity;

/// The cells of one requirement.
#[derive(Clone, Debug)]
pub struct Sentence {
    /// Symbol of quantity and statistic.
    pub symbol: Symbol,
    /// Room, subject and light scene, as far as they are needed to tell requirements apart.
    pub place: String,
    /// Bound, limit and unit.
    pub required: String,
    /// Value and unit, or "—".
    pub value: String,
    /// Joint numerical interval, "—" where there is no value, "no interval" where none is known.
    pub interval: String,
    /// The verdict's word.
    pub verdict: &'static str,
    /// Margin to the limit, positive when it complies.
    pub margin: String,
}

/// What must be said of a place: whether rooms and light scenes need naming.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Naming {
    /// Name the room.
    pub room: bool,
    /// Name the light scene.
    pub light_scene: bool,
    /// Name the row of the norm.
    pub row: bool,
}

impl Naming {
    /// Rooms are named if there are several, light scenes if requirements use several, rows if two ask alike
    /// of one thing.
    pub fn of(outcome: &Outcome) -> Self {
        let mut clauses = BTreeMap::new();
        let mut of_norm =
            outcome.requirements.iter().filter(|r| r.standard != PROJECT && !r.clause.is_empty());
        let row = of_norm.any(|r| {
            let asked = (&r.room, &r.subject, &r.light_scene, r.quantity.key(), r.statistic.key());
            *clauses.entry(asked).or_insert(&r.clause) != &r.clause
        });
        let first = outcome.requirements.first().map(|r| r.light_scene.as_str());
        Self {
            row,
            room: outcome.rooms.len() > 1,
            light_scene: outcome.requirements.iter().any(|r| Some(r.light_scene.as_str()) != first),
        }
    }
}

/// Limit and whether it is a lower one.
pub fn bound(bound: Bound) -> (f64, bool) {
    match bound {
        Bound::Min(limit) => (limit, true),
        Bound::Max(limit) => (limit, false),
    }
}

/// Whether the verdict was given within the indifference margin; a declared value is not computed,
/// so that it equals its limit means nothing.
pub fn is_at_the_limit(requirement: &Requirement) -> bool {
    requirement.at_the_limit && requirement.verdict != Verdict::Declared
}

/// Whether the limit was not checked against the text of its norm.
pub fn is_unverified(requirement: &Requirement) -> bool {
    requirement.verified == "unverified"
}

/// Whether it is the project's own requirement, not the norm's.
pub fn is_own(requirement: &Requirement) -> bool {
    requirement.standard == PROJECT
}

/// Whether the project sets the limit aside by one of its own.
pub fn is_set_aside(requirement: &Requirement) -> bool {
    requirement.value.as_ref().is_err_and(|undefined| undefined.reason.starts_with(SET_ASIDE))
}

/// A requirement in words.
pub fn sentence(lang: Lang, requirement: &Requirement, naming: Naming) -> Sentence {
    let (quantity, statistic) = (requirement.quantity, requirement.statistic);
    let (limit, is_minimum) = bound(requirement.bound);
    let unit = number::unit(lang, quantity, statistic);
    let limit_text = if limit.is_finite() {
        let limit_text = number::limit(lang, quantity, statistic, limit);
        let term = if is_minimum { Term::AtLeast } else { Term::AtMost };
        phrase(lang, term, &[&format!("{limit_text}{unit}")])
    } else {
        "—".into()
    };
    let (value, interval) = match &requirement.value {
        Ok(value) => {
            let shown = number::value_beside(lang, quantity, statistic, *value, limit);
            (format!("{shown}{unit}"), interval(lang, requirement))
        }
        Err(_) => ("—".into(), "—".into()),
    };
    Sentence {
        symbol: words::symbol(lang, quantity, statistic),
        place: place(lang, requirement, naming),
        required: limit_text,
        value,
        interval,
        verdict: words::verdict(lang, requirement.verdict),
        margin: margin(lang, requirement),
    }
}

fn interval(lang: Lang, requirement: &Requirement) -> String {
    let (lo, hi) = (requirement.lo_joint, requirement.hi_joint);
    if requirement.verdict == Verdict::Declared {
        return "—".into();
    }
    let text = |x| number::value(lang, requirement.quantity, requirement.statistic, x);
    if lo.is_finite() && hi > f64::MAX {
        return format!("{}…∞", text(lo));
    }
    if !(lo.is_finite() && hi.is_finite()) {
        return word(lang, Term::NoInterval).into();
    }
    format!("{}…{}", text(lo), text(hi))
}

fn margin(lang: Lang, requirement: &Requirement) -> String {
    match requirement.margin.filter(|margin| margin.is_finite()) {
        None => "—".into(),
        Some(margin) => {
            let sign = if margin > 0.0 { "+" } else { "" };
            let text = if requirement.quantity == Quantity::Ugr {
                number::fixed(lang, margin, 1)
            } else if margin.abs() >= 1.0 {
                format!("{}\u{a0}%", number::fixed(lang, 100.0 * margin, 0))
            } else {
                number::percent(lang, margin)
            };
            format!("{sign}{text}")
        }
    }
}

fn place(lang: Lang, requirement: &Requirement, naming: Naming) -> String {
    let mut parts: Vec<Cow<'_, str>> = Vec::new();
    // Areas that a norm makes are named after their room already.
    let named =
        requirement.subject.strip_prefix(&requirement.room).is_some_and(|rest| rest.starts_with(" · "));
    if naming.room && !named {
        parts.push(requirement.room.as_str().into());
    }
    if requirement.subject != requirement.room || !naming.room {
        parts.push(words::place_name(lang, &requirement.subject));
    }
    if naming.row && requirement.standard != PROJECT && !requirement.clause.is_empty() {
        parts.push(phrase(lang, Term::RowNumber, &[&requirement.clause]).into());
    }
    if naming.light_scene {
        parts.push(requirement.light_scene.as_str().into());
    }
    parts.join(" · ")
}

/// Short name and title: `EN 12464-1:2021, Light and lighting …`; one where both are the same.
pub fn norm_name(norm: &NormOutcome) -> String {
    if norm.title.is_empty() || norm.title == norm.short {
        norm.short.clone()
    } else {
        format!("{}, {}", norm.short, norm.title)
    }
}

/// How many requirements have which verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Certainly complied with.
    pub pass: usize,
    /// Certainly not.
    pub fail: usize,
    /// Undecided, or without a value.
    pub open: usize,
    /// Declared by the user.
    pub declared: usize,
    /// Not assessed.
    pub not_assessed: usize,
}

impl Tally {
    /// Counts verdicts.
    pub fn of<'a>(requirements: impl IntoIterator<Item = &'a Requirement>) -> Self {
        let mut tally = Self::default();
        for requirement in requirements {
            let count = match requirement.verdict {
                Verdict::Pass => &mut tally.pass,
                Verdict::Fail => &mut tally.fail,
                Verdict::Undecided | Verdict::Undefined => &mut tally.open,
                Verdict::Declared => &mut tally.declared,
                Verdict::NotAssessed => &mut tally.not_assessed,
            };
            *count += 1;
        }
        tally
    }

    /// Requirements that were to be judged.
    pub fn judged(self) -> usize {
        self.pass + self.fail + self.open
    }

    /// Fail before open before pass; `None` if nothing was judged.
    pub fn verdict(self) -> Option<Verdict> {
        if self.fail > 0 {
            Some(Verdict::Fail)
        } else if self.open > 0 {
            Some(Verdict::Undecided)
        } else if self.pass > 0 {
            Some(Verdict::Pass)
        } else {
            None
        }
    }
}

/// The verdict of the whole in one line: "complies with EN 12464-1:2021: 14 of 14 requirements pass".
pub fn overall(lang: Lang, outcome: &Outcome) -> String {
    let (head, counts) = overall_parts(lang, outcome);
    match counts {
        Some(counts) => format!("{head}: {counts}"),
        None => head,
    }
}

/// The verdict of the whole and, apart from it, its counts. It names the norm only where requirements of the
/// norm decide; where the project's own do, it names those.
pub fn overall_parts(lang: Lang, outcome: &Outcome) -> (String, Option<String>) {
    let tally = Tally::of(&outcome.requirements);
    let of_norm = Tally::of(outcome.requirements.iter().filter(|r| r.standard != PROJECT));
    let set_aside = outcome.requirements.iter().filter(|one| is_set_aside(one)).count();
    let norm = outcome.norm.as_ref().map(|norm| norm.short.as_str());
    let project = word(lang, Term::ProjectRequirements);
    let own = Tally::of(outcome.requirements.iter().filter(|r| r.standard == PROJECT));
    // Whose requirements give the verdict of the whole; those are counted first.
    let norm_decides = of_norm.verdict() == tally.verdict();
    let whose = norm.map(|norm| if norm_decides { norm } else { project });
    let decisive = match norm {
        Some(_) if norm_decides => of_norm,
        Some(_) => own,
        None => tally,
    };
    let with = |named: Term, plain: Term| match whose {
        Some(whose) => phrase(lang, named, &[whose]),
        None => word(lang, plain).to_owned(),
    };
    let total = decisive.judged().to_string();
    let count = |term, number: usize| phrase(lang, term, &[&number.to_string(), &total]);
    let mut counts = Vec::new();
    let head = match tally.verdict() {
        Some(Verdict::Fail) => {
            counts.push(count(Term::FailedOf, decisive.fail));
            if decisive.open > 0 {
                counts.push(count(Term::OpenOf, decisive.open));
            }
            with(Term::FailsWith, Term::FailsAll)
        }
        Some(Verdict::Pass) => {
            counts.push(count(Term::PassedOf, decisive.pass));
            // Nobody signs a norm of which a part was left out: the headline says so, not the small print alone.
            let is_part = norm_decides && norm.is_some() && of_norm.not_assessed > 0;
            let whose = whose.unwrap_or(project);
            match (is_part, set_aside) {
                (true, 0) => phrase(lang, Term::CompliesInPart, &[whose]),
                (true, _) => phrase(lang, Term::CompliesButFor, &[whose, &set_aside.to_string()]),
                (false, _) => phrase(lang, Term::CompliesWith, &[whose]),
            }
        }
        Some(_) => {
            counts.push(count(Term::OpenOf, decisive.open));
            counts.push(count(Term::PassedOf, decisive.pass));
            with(Term::OpenWith, Term::OpenAll)
        }
        None => match norm {
            Some(norm) => phrase(lang, Term::NormNotAssessed, &[norm]),
            None => word(lang, Term::NothingRequired).to_owned(),
        },
    };
    if let Some(norm) = norm {
        let parts = |tally: Tally| [tally.pass, tally.judged()].map(|number| number.to_string());
        if norm_decides && own.judged() > 0 {
            let [pass, all] = parts(own);
            counts.push(phrase(lang, Term::OwnPassed, &[&pass, &all]));
        } else if !norm_decides && of_norm.judged() > 0 {
            let [pass, all] = parts(of_norm);
            counts.push(phrase(lang, Term::NormPassed, &[norm, &pass, &all]));
        }
    }
    if let Some(norm) = norm.filter(|_| of_norm.verdict().is_none() && tally.verdict().is_some()) {
        counts.push(phrase(lang, Term::NormNotAssessed, &[norm]));
    }
    if tally.declared > 0 {
        counts.push(phrase(lang, Term::DeclaredCount, &[&tally.declared.to_string()]));
    }
    if tally.not_assessed > 0 {
        counts.push(phrase(lang, Term::NotAssessedCount, &[&tally.not_assessed.to_string()]));
    }
    if set_aside > 0 {
        counts.push(phrase(lang, Term::SetAsideCount, &[&set_aside.to_string()]));
    }
    (head, (!counts.is_empty()).then(|| counts.join("; ")))
}

/// The `standard` of a `[[require]]`.
const PROJECT: &str = "project";

/// What a room's line says that has a verdict or none.
pub fn room_verdict(lang: Lang, tally: Tally) -> &'static str {
    match tally.verdict() {
        Some(verdict) => words::verdict(lang, verdict),
        None if tally.not_assessed > 0 => word(lang, Term::NotAssessed),
        None => word(lang, Term::NothingRequired),
    }
}

/// Key of a verdict in files for machines.
pub fn verdict_key(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "fail",
        Verdict::Undecided => "undecided",
        Verdict::Undefined => "undefined",
        Verdict::Declared => "declared",
        Verdict::NotAssessed => "not_assessed",
    }
}

/// One English line about a requirement, for logs that machines show to people.
pub fn line(requirement: &Requirement) -> String {
    let naming = Naming { room: true, light_scene: true, row: false };
    let text = sentence(Lang::En, requirement, naming);
    let because = match &requirement.value {
        Ok(_) => String::new(),
        Err(undefined) => format!(" ({undefined})"),
    };
    format!(
        "{} · {}: required {}, found {}{because}, numerical interval {}",
        text.symbol.text(),
        text.place,
        text.required,
        text.value,
        text.interval,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    /// Catches: a norm that is said to be complied with, or not, by requirements of the project's own.
    #[test]
    fn the_verdict_of_the_whole_names_those_whose_requirements_decide() {
        use Verdict::{Fail, NotAssessed, Pass, Undecided};
        let all = sample::outcome();
        let judged = |norm: &[Verdict], own: &[Verdict]| {
            let mut outcome = all.clone();
            let one = |standard: &str, verdict: Verdict| Requirement {
                standard: standard.into(),
                verdict,
                ..all.requirements[0].clone()
            };
            outcome.requirements = norm.iter().map(|&v| one("en-12464-1-2021", v)).collect();
            outcome.requirements.extend(own.iter().map(|&v| one("project", v)));
            overall(Lang::En, &outcome)
        };
        let own = "the project's own requirements";
        let norm = "EN 12464-1:2021";
        for (of_norm, of_project, says) in [
            (
                &[Pass][..],
                &[Pass][..],
                format!("complies with {norm}: 1 of 1 requirements pass; {own}: 1 of 1 pass"),
            ),
            (
                &[Pass],
                &[Fail],
                format!("does not comply with {own}: 1 of 1 requirements fail; {norm}: 1 of 1 pass"),
            ),
            (
                &[Fail],
                &[Pass],
                format!("does not comply with {norm}: 1 of 1 requirements fail; {own}: 1 of 1 pass"),
            ),
            (
                &[Undecided],
                &[Pass],
                format!(
                    "compliance with {norm} is not established: 1 of 1 undecided or without value; 0 of 1 requirements pass; {own}: 1 of 1 pass"
                ),
            ),
            (
                &[NotAssessed],
                &[Pass],
                format!(
                    "complies with {own}: 1 of 1 requirements pass; {norm} is not assessed; 1 not assessed"
                ),
            ),
            (
                &[],
                &[Fail],
                format!("does not comply with {own}: 1 of 1 requirements fail; {norm} is not assessed"),
            ),
            (
                &[Pass, Pass],
                &[Undecided, Pass],
                format!(
                    "compliance with {own} is not established: 1 of 2 undecided or without value; 1 of 2 requirements pass; {norm}: 2 of 2 pass"
                ),
            ),
            (
                &[Pass, NotAssessed],
                &[],
                format!("complies with {norm} as far as assessed: 1 of 1 requirements pass; 1 not assessed"),
            ),
            (&[NotAssessed], &[], format!("{norm} is not assessed: 1 not assessed")),
            (&[], &[], format!("{norm} is not assessed")),
        ] {
            assert_eq!(judged(of_norm, of_project), says);
        }
    }

    /// Catches: two lines that differ in their verdict alone, because two rows ask alike of one area.
    #[test]
    fn rows_are_named_where_two_ask_alike() {
        let mut outcome = sample::outcome();
        assert!(!Naming::of(&outcome).row);
        let first = outcome.requirements[0].clone();
        outcome.requirements.push(Requirement { clause: "9.9".into(), ..first });
        let naming = Naming::of(&outcome);
        let places: Vec<String> =
            outcome.requirements.iter().map(|r| sentence(Lang::En, r, naming).place).collect();
        assert!(places.last().is_some_and(|place| place.contains("row 9.9")), "{places:?}");
        assert_ne!(places.first(), places.last());
    }
}
