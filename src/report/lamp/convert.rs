//! What a converted file does not hold, in words.

use super::super::number::fixed;
use super::super::words::{Lang, lamp_word};
use super::super::xml::put;
use super::opening::shown;
use crate::lamp::convert::{Dropped, Target};
use crate::photometry::Format;

/// A line for each loss.
pub fn dropped(losses: &[Dropped], lang: Lang) -> String {
    let mark = lamp_word(lang, "dropped");
    let mut text = String::new();
    for loss in losses {
        put(&mut text, format_args!("{mark}: {}\n", clause(loss, lang)));
    }
    text
}

fn clause(loss: &Dropped, lang: Lang) -> String {
    let say = |english: &'static str| lamp_word(lang, english);
    let lumens = |lm: f64| format!("{} {}", fixed(lang, lm, 1), say("lm"));
    match loss {
        Dropped::OutputRatio(lor) => {
            let percent = fixed(lang, 100.0 * lor, 1);
            format!("{} {percent} %: {}", say("light output ratio"), say("LM-63 has no place for it"))
        }
        Dropped::Flux { was_lm, is_lm } => {
            let is = is_lm.map_or_else(|| say("none").to_owned(), lumens);
            format!("{} {}: {} {is}", say("rated flux"), lumens(*was_lm), say("the new file states"))
        }
        Dropped::ColourRendering(ra) => format!("{} R_a {}", say("colour rendering"), fixed(lang, *ra, 0)),
        Dropped::Power => say("power").to_owned(),
        Dropped::Opening { was, is } => format!(
            "{}, {}: {}, {}; {}",
            say("luminous opening"),
            shown(*was, lang),
            say("the new file holds"),
            shown(*is, lang),
            say("so its luminance differs")
        ),
        Dropped::Name { was, is } => format!("{} '{was}': {} '{is}'", say("name"), say("written as")),
        Dropped::NotRead(format, target) => {
            format!("{}: {}", say("not carried over if present"), say(beyond(*format, *target)))
        }
    }
}

fn beyond(format: Format, target: Target) -> &'static str {
    match (format, target) {
        (Format::Eulumdat, Target::Ies) => {
            "size of the luminaire, numbers, date, lamp names, colour, further lamp sets, tilt, direct ratios"
        }
        (Format::Eulumdat, Target::Ldt) => {
            "size of the luminaire, numbers, date, lamp names, colour, further lamp sets, tilt; direct ratios become 0"
        }
        (Format::Tm33, _) => "spectra, colour other than R_a, equipment, custom data, comments",
        (Format::Lm63 { .. }, _) => {
            "keywords other than the names, tilt data, lamp count; all factors become 1"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::photometry::{Lm63Version, Opening};

    /// Catches: a loss told in the other language, or without its figures.
    #[test]
    fn losses_are_told_in_both_languages() {
        let losses = [
            Dropped::OutputRatio(0.705),
            Dropped::Flux { was_lm: 1234.5, is_lm: None },
            Dropped::ColourRendering(80.0),
            Dropped::Power,
            Dropped::Opening { was: Opening::rect(1.2, 0.3), is: Opening::Point },
            Dropped::Name { was: "Büro".into(), is: "B?ro".into() },
            Dropped::NotRead(Format::Lm63 { version: Lm63Version::Y2002 }, Target::Ldt),
            Dropped::NotRead(Format::Eulumdat, Target::Ies),
            Dropped::NotRead(Format::Eulumdat, Target::Ldt),
            Dropped::NotRead(Format::Tm33, Target::Ldt),
        ];
        let english = dropped(&losses, Lang::En);
        assert!(
            english.contains("70.5 %") && english.contains("1.200 × 0.300 m") && english.contains("'B?ro'")
        );
        for line in dropped(&losses, Lang::Ru).lines() {
            let bare: String = line.split('\'').step_by(2).collect();
            let word = |word: &str| word.len() > 2 && word.bytes().all(|byte| byte.is_ascii_lowercase());
            assert!(!bare.split(|c: char| !c.is_alphanumeric()).any(word), "{line}");
            assert!(line.starts_with("не перенесено: "), "{line}");
        }
    }
}
