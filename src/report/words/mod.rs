//! The words of every report. A word is looked up here and nowhere else, so a language is one
//! column of [`table::TERMS`]; sentences of solver and loader are looked up by [`said`].

mod faults;
mod findings;
mod indices;
mod lamp;
mod places;
mod rules;
mod sentences;
mod table;

pub use findings::found;
pub use indices::index_name;
pub use lamp::lamp_word;
pub use places::{description, place_name, source_label};
pub use rules::rule_words;
pub use sentences::said;
pub use table::{TERMS, Term};

use std::borrow::Cow;

use crate::norm::{Light, State};
use crate::outcome::Condition;
use crate::outcome::Verdict;
use crate::project::AreaKind;
use crate::quantity::{Property, Quantity, Statistic, Unmeasured};

/// A report language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lang {
    /// English.
    En,
    /// Russian.
    Ru,
}

impl Lang {
    /// The language of a code `en` or `ru`; `None` for anything else.
    pub fn parse(code: &str) -> Option<Self> {
        match code {
            "en" => Some(Self::En),
            "ru" => Some(Self::Ru),
            _ => None,
        }
    }

    /// ISO 639-1 code.
    pub fn code(self) -> &'static str {
        match self {
            Self::En => "en",
            Self::Ru => "ru",
        }
    }

    /// The language's own name.
    pub fn name(self) -> &'static str {
        match self {
            Self::En => "English",
            Self::Ru => "Русский",
        }
    }
}

/// A term in a language.
pub fn word(lang: Lang, term: Term) -> &'static str {
    let (_, english, russian) = TERMS[term as usize];
    match lang {
        Lang::En => english,
        Lang::Ru => russian,
    }
}

/// A term whose `{}` are replaced, in order, by `parts`.
pub fn phrase(lang: Lang, term: Term, parts: &[&str]) -> String {
    let mut text = String::new();
    let mut pieces = word(lang, term).split("{}");
    text.push_str(pieces.next().unwrap_or_default());
    for (index, piece) in pieces.enumerate() {
        text.push_str(parts.get(index).copied().unwrap_or_default());
        text.push_str(piece);
    }
    text
}

/// A verdict on one requirement.
pub fn verdict(lang: Lang, verdict: Verdict) -> &'static str {
    word(
        lang,
        match verdict {
            Verdict::Pass => Term::Pass,
            Verdict::Fail => Term::Fail,
            Verdict::Undecided => Term::Undecided,
            Verdict::Undefined => Term::Undefined,
            Verdict::Declared => Term::Declared,
            Verdict::NotAssessed => Term::NotAssessed,
        },
    )
}

/// What an area is in the sense of the norm.
pub fn area_kind(lang: Lang, kind: AreaKind) -> &'static str {
    word(
        lang,
        match kind {
            AreaKind::Task => Term::TaskArea,
            AreaKind::Surrounding => Term::SurroundingArea,
            AreaKind::Background => Term::BackgroundArea,
            AreaKind::Surface => Term::SurfaceArea,
            AreaKind::Volume => Term::VolumeArea,
        },
    )
}

/// The full name of a quantity.
pub fn quantity(lang: Lang, quantity: Quantity) -> String {
    let name = word(
        lang,
        match quantity {
            Quantity::Horizontal => Term::Horizontal,
            Quantity::Vertical { .. } => Term::Vertical,
            Quantity::Normal => Term::Normal,
            Quantity::Cylindrical => Term::Cylindrical,
            Quantity::Semicylindrical { .. } => Term::Semicylindrical,
            Quantity::Hemispherical => Term::Hemispherical,
            Quantity::Spherical => Term::Spherical,
            Quantity::Modelling => Term::Modelling,
            Quantity::Luminance { .. } => Term::Luminance,
            Quantity::Ugr => Term::Ugr,
            Quantity::Intensity => Term::Intensity,
            Quantity::ColourRendering => Term::ColourRendering,
            Quantity::DiscomfortIndex => Term::DiscomfortIndex,
            Quantity::OfView { key, .. } => return format!("{} {key}", index_name(lang, key)),
            Quantity::Declared(Property::Pulsation) => Term::Pulsation,
            Quantity::Declared(Property::PstLm) => Term::PstLm,
            Quantity::Declared(Property::Svm) => Term::Svm,
            Quantity::NotComputed(Unmeasured::GlareRating) => Term::GlareRating,
            Quantity::NotComputed(Unmeasured::DaylightFactor) => Term::DaylightFactor,
            Quantity::NotComputed(Unmeasured::DaylightGlare) => Term::DaylightGlare,
        },
    );
    match direction(quantity) {
        Some(direction) => format!("{name} {direction}"),
        None => name.to_owned(),
    }
}

/// Symbol of a quantity under a statistic: its letter, its index, and what follows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// `E`, `Ē`, `U`, …
    pub letter: String,
    /// Index, may be empty.
    pub index: String,
    /// What follows on the line, may be empty.
    pub rest: String,
}

impl Symbol {
    /// On one line of plain text: `E_h,min`.
    pub fn text(&self) -> String {
        if self.index.is_empty() {
            format!("{}{}", self.letter, self.rest)
        } else {
            format!("{}_{}{}", self.letter, self.index, self.rest)
        }
    }
}

/// The symbol of a statistic of a quantity: `Ē_h`, `E_h,min`, `U_0 (E_h)`, `UGR`.
pub fn symbol(lang: Lang, quantity: Quantity, statistic: Statistic) -> Symbol {
    let index = match quantity {
        Quantity::Horizontal => word(lang, Term::IndexHorizontal),
        Quantity::Vertical { .. } => word(lang, Term::IndexVertical),
        Quantity::Normal => word(lang, Term::IndexNormal),
        Quantity::Cylindrical => word(lang, Term::IndexCylindrical),
        Quantity::Semicylindrical { .. } => word(lang, Term::IndexSemicylindrical),
        Quantity::Hemispherical => word(lang, Term::IndexHemispherical),
        Quantity::Spherical => word(lang, Term::IndexSpherical),
        Quantity::Declared(Property::Pulsation) => word(lang, Term::IndexPulsation),
        Quantity::OfView { .. } if quantity.is_luminance_ratio() => "",
        Quantity::OfView { key, .. } => key.split_once('_').map_or("", |(_, index)| index),
        Quantity::Luminance { .. }
        | Quantity::Modelling
        | Quantity::Ugr
        | Quantity::Intensity
        | Quantity::ColourRendering
        | Quantity::DiscomfortIndex
        | Quantity::Declared(_)
        | Quantity::NotComputed(_) => "",
    };
    let letter = letter(quantity, lang);
    let letter = letter.as_str();
    let index = if quantity == Quantity::ColourRendering { "a" } else { index };
    let rest = direction(quantity).map_or_else(String::new, |at| format!(" {at}"));
    let with = |mark: &str| Symbol {
        letter: letter.to_owned(),
        index: if index.is_empty() { mark.to_owned() } else { format!("{index},{mark}") },
        rest: rest.clone(),
    };
    let ratio = |letter: &str, sub: &str| {
        let plain =
            Symbol { letter: self::letter(quantity, lang), index: index.to_owned(), rest: rest.clone() };
        Symbol { letter: letter.to_owned(), index: sub.to_owned(), rest: format!(" ({})", plain.text()) }
    };
    match statistic {
        Statistic::Mean if letter == "E" => Symbol { letter: "Ē".into(), index: index.into(), rest },
        Statistic::Mean => with(word(lang, Term::IndexMean)),
        Statistic::Min => with(word(lang, Term::IndexMin)),
        Statistic::Max => with(word(lang, Term::IndexMax)),
        Statistic::U0 => ratio("U", "0"),
        Statistic::Ud => ratio(word(lang, Term::MinByMax), ""),
        Statistic::OfTask => ratio(word(lang, Term::MeanOfTask), ""),
        Statistic::Value => Symbol { letter: letter.into(), index: index.into(), rest },
    }
}

fn letter(quantity: Quantity, lang: Lang) -> String {
    match quantity {
        Quantity::Modelling => word(lang, Term::ModellingShort),
        Quantity::Ugr => "UGR",
        Quantity::Intensity => "I",
        Quantity::ColourRendering => "R",
        Quantity::Luminance { .. } => "L",
        Quantity::DiscomfortIndex => "M",
        Quantity::OfView { key, .. } if quantity.is_luminance_ratio() => key,
        Quantity::OfView { key, .. } => key.split_once('_').map_or(key, |(letter, _)| letter),
        Quantity::Declared(Property::Pulsation) => word(lang, Term::LetterPulsation),
        Quantity::Declared(property) => property.key(),
        Quantity::NotComputed(quantity) => quantity.key(),
        _ => "E",
    }
    .to_owned()
}

fn direction(quantity: Quantity) -> Option<String> {
    match quantity {
        Quantity::Vertical { azimuth_deg } | Quantity::Semicylindrical { azimuth_deg } => {
            Some(format!("@{azimuth_deg}°"))
        }
        Quantity::Luminance { azimuth_deg, tilt_deg } => Some(format!("@{azimuth_deg}°, {tilt_deg}°")),
        Quantity::Horizontal
        | Quantity::Normal
        | Quantity::Cylindrical
        | Quantity::Hemispherical
        | Quantity::Spherical
        | Quantity::Modelling
        | Quantity::Ugr
        | Quantity::Intensity
        | Quantity::ColourRendering
        | Quantity::DiscomfortIndex
        | Quantity::OfView { .. }
        | Quantity::Declared(_)
        | Quantity::NotComputed(_) => None,
    }
}

/// Why the solver stopped, as far as the reason is one of ours.
pub fn stopped(lang: Lang, reason: &str) -> &str {
    match reason {
        "verdicts certain" => word(lang, Term::StoppedCertain),
        "block limit" => word(lang, Term::StoppedLimit),
        "accuracy reached" => word(lang, Term::StoppedAccuracy),
        "time" => word(lang, Term::StoppedTime),
        "blocks asked for" => word(lang, Term::StoppedAsked),
        "interrupted" => word(lang, Term::StoppedInterrupted),
        _ => reason,
    }
}

/// A remark on how a value came about, as far as it is one of ours.
pub fn note(lang: Lang, note: &str) -> Cow<'_, str> {
    match note {
        "maintained" => word(lang, Term::MaintainedValue).into(),
        "declared, not computed" => word(lang, Term::DeclaredNotComputed).into(),
        "not computed" => word(lang, Term::NotComputed).into(),
        _ => said(lang, note),
    }
}

/// Under which condition of the installation values are given.
pub fn condition(lang: Lang, condition: Condition) -> Cow<'static, str> {
    match (condition.state, condition.light) {
        (State::Maintained, Light::All) => word(lang, Term::MaintainedValues).into(),
        (State::Initial, Light::All) => word(lang, Term::InitialValues).into(),
        (State::Emergency, _) | (_, Light::Direct) => said(lang, condition.note()),
    }
}

/// How well a row of the norm is known: a word for all but two sources.
pub fn verified(lang: Lang, mark: &str) -> &str {
    match mark {
        "two-sources" => word(lang, Term::TwoSources),
        "one-source" => word(lang, Term::OneSource),
        "unverified" => word(lang, Term::Unverified),
        "unknown" => word(lang, Term::UnknownLimit),
        "project" => word(lang, Term::OfProject),
        _ => mark,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symbols and abbreviations that are written alike in both languages.
    const SAME: &[Term] = &[Term::Ugr0];

    #[test]
    fn no_term_is_missing_in_either_language() {
        for (index, (term, english, russian)) in TERMS.iter().enumerate() {
            assert_eq!(index, *term as usize, "{term:?} stands in the wrong place");
            assert!(!english.trim().is_empty() && !russian.trim().is_empty(), "{term:?}");
            assert_eq!(english == russian, SAME.contains(term), "{term:?}: {russian}");
            assert_eq!(
                english.matches("{}").count(),
                russian.matches("{}").count(),
                "{term:?} takes other parts in Russian"
            );
            let cyrillic = russian
                .chars()
                .any(|c| ('а'..='я').contains(&c.to_ascii_lowercase()) || ('А'..='я').contains(&c));
            assert!(cyrillic || SAME.contains(term), "{term:?} is not Russian: {russian}");
        }
    }

    #[test]
    fn what_the_loop_and_the_judge_say_is_translated() {
        // Catches a reason reworded in lib.rs or assemble.rs that a Russian report would print in English.
        let source = concat!(
            include_str!("../../lib.rs"),
            include_str!("../../assemble/gauge.rs"),
            include_str!("../../outcome/room.rs")
        );
        for text in [
            "verdicts certain",
            "accuracy reached",
            "blocks asked for",
            "block limit",
            "time",
            "interrupted",
            "maintained",
            "declared, not computed",
            "not computed",
        ] {
            assert!(source.contains(&format!("\"{text}\"")), "nobody says \"{text}\"");
            assert_ne!(stopped(Lang::Ru, &note(Lang::Ru, text)), text, "not translated");
        }
    }

    #[test]
    fn phrases_take_their_parts_in_order() {
        assert_eq!(phrase(Lang::En, Term::PassedOf, &["2", "14"]), "2 of 14 requirements pass");
    }

    #[test]
    fn symbols_carry_quantity_and_statistic() {
        let text = |q, s| symbol(Lang::En, q, s).text();
        assert_eq!(text(Quantity::Horizontal, Statistic::Mean), "Ē_h");
        assert_eq!(text(Quantity::Vertical { azimuth_deg: 90.0 }, Statistic::Min), "E_v,min @90°");
        assert_eq!(text(Quantity::Cylindrical, Statistic::U0), "U_0 (E_z)");
        assert_eq!(text(Quantity::Ugr, Statistic::Value), "UGR");
        assert_eq!(text(Quantity::ColourRendering, Statistic::Value), "R_a");
        assert_eq!(symbol(Lang::Ru, Quantity::Horizontal, Statistic::Min).text(), "E_г,мин");
    }
}
