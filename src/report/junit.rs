//! JUnit XML for build servers: a room is a suite, a requirement a case. Undecided and undefined
//! are errors, not failures; declared and not assessed are skipped.

use super::sentence::{Naming, line, overall, sentence};
use super::words::Lang;
use super::xml::{escape, put};
use crate::outcome::{Outcome, Requirement, Verdict};

/// The requirements of an outcome as JUnit XML.
pub fn junit(outcome: &Outcome) -> String {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let counts = counts(&outcome.requirements.iter().collect::<Vec<_>>());
    put(&mut text, format_args!("<testsuites name=\"{}\"{counts}>\n", escape(&outcome.info.name)));
    for room in &outcome.rooms {
        let cases: Vec<&Requirement> = outcome.requirements.iter().filter(|r| r.room == room.name).collect();
        put(
            &mut text,
            format_args!("  <testsuite name=\"{}\"{}>\n", escape(&room.name), self::counts(&cases)),
        );
        for case in cases {
            text.push_str(&self::case(case));
        }
        text.push_str("  </testsuite>\n");
    }
    put(
        &mut text,
        format_args!(
            "  <!-- {} -->\n</testsuites>\n",
            escape(&overall(Lang::En, outcome)).replace("--", "- -")
        ),
    );
    text
}

fn counts(cases: &[&Requirement]) -> String {
    let count = |verdicts: &[Verdict]| cases.iter().filter(|r| verdicts.contains(&r.verdict)).count();
    format!(
        " tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"",
        cases.len(),
        count(&[Verdict::Fail]),
        count(&[Verdict::Undecided, Verdict::Undefined]),
        count(&[Verdict::Declared, Verdict::NotAssessed]),
    )
}

fn case(requirement: &Requirement) -> String {
    let naming = Naming { room: false, light_scene: true, row: false };
    let words = sentence(Lang::En, requirement, naming);
    let message = escape(&line(requirement));
    let inner = match requirement.verdict {
        Verdict::Pass => String::new(),
        Verdict::Fail => format!("<failure message=\"{message}\"/>"),
        Verdict::Undecided | Verdict::Undefined => {
            format!(
                "<error type=\"{}\" message=\"{message}\"/>",
                super::sentence::verdict_key(requirement.verdict)
            )
        }
        Verdict::Declared | Verdict::NotAssessed => {
            format!("<skipped message=\"{}\"/>", words.verdict)
        }
    };
    let name = escape(&format!("{} · {} {}", words.symbol.text(), words.place, words.required));
    let class = escape(&format!("{}.{}", requirement.standard, requirement.clause));
    format!("    <testcase classname=\"{class}\" name=\"{name}\">{inner}</testcase>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn it_is_well_formed_and_every_requirement_is_a_case() {
        let outcome = sample::outcome();
        let text = junit(&outcome);
        let document = roxmltree::Document::parse(&text).expect("well-formed");
        let count = |tag: &str| document.descendants().filter(|n| n.has_tag_name(tag)).count();
        assert_eq!(count("testcase"), outcome.requirements.len());
        assert_eq!(count("failure"), 2);
    }
}
