//! Whatever is found in a photometric file has its translation.

use super::*;

/// Where findings and errors of photometric files are worded.
const SOURCES: &[&str] = &[
    include_str!("../../glare/ugr_table.rs"),
    include_str!("../../lamp/beam.rs"),
    include_str!("../../lamp/flux.rs"),
    include_str!("../../lamp/lint.rs"),
    include_str!("../../lamp/luminance.rs"),
    include_str!("../../lamp/mod.rs"),
    include_str!("../../lamp/nodes.rs"),
    include_str!("../../lamp/outdoor.rs"),
    include_str!("../../lamp/spacing.rs"),
    include_str!("../../lamp/ugr.rs"),
    include_str!("../../photometry/findings.rs"),
    include_str!("../../photometry/gldf.rs"),
    include_str!("../../photometry/grid.rs"),
    include_str!("../../photometry/ies.rs"),
    include_str!("../../photometry/ies_goniometer.rs"),
    include_str!("../../photometry/ies_head.rs"),
    include_str!("../../photometry/ies_opening.rs"),
    include_str!("../../photometry/ldt.rs"),
    include_str!("../../photometry/ldt_head.rs"),
    include_str!("../../photometry/mod.rs"),
    include_str!("../../photometry/odd_angle.rs"),
    include_str!("../../photometry/numbers.rs"),
    include_str!("../../photometry/tm33.rs"),
    include_str!("../../photometry/tm33_opening.rs"),
    include_str!("../../photometry/tm33_table.rs"),
];

/// Said to programmers, not a sentence, or said with its count.
const NOT_TOLD: &[&str] = &[
    "emitter spectra",
    "angular spectra",
    "angular colours",
    "radiant intensities",
    "photon intensities",
    "photon flux densities",
    "spectral irradiances",
    "channel multipliers",
    "there is at least one step",
    "the caller looked",
    "there is at least one emitter",
    "{}:{}: {}\\n  hint: {}",
];

/// String literals of the program part of a source that read like words, `{…}` as `{}`.
fn literals(source: &str) -> Vec<String> {
    let code = source.split("#[cfg(test)]").next().unwrap_or_default();
    let code: String =
        code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut found = Vec::new();
    let mut rest = code.as_str();
    while let Some(start) = rest.find('"') {
        let body = &rest[start + 1..];
        let mut end = 0;
        while !body[end..].starts_with('"') {
            end += if body[end..].starts_with('\\') {
                2
            } else {
                body[end..].chars().next().map_or(1, char::len_utf8)
            };
        }
        let joined = body[..end].split("\\\n").map(str::trim_start).collect::<String>();
        let (mut text, mut depth) = (String::new(), 0);
        for c in joined.replace("\\\"", "\"").chars() {
            depth += i32::from(c == '{');
            if depth == 0 || (depth == 1 && c == '{') {
                text.push(c);
            }
            if c == '}' {
                text.push(c);
                depth -= 1;
            }
        }
        let word = |word: &str| word.len() > 2 && word.bytes().all(|byte| byte.is_ascii_lowercase());
        if text.contains(' ') && text.split(|c: char| !c.is_alphanumeric()).any(word) {
            found.push(text);
        }
        rest = &body[end + 1..];
    }
    found
}

/// Catches: a finding or an error that a Russian reader would get in English; a pattern that nobody says.
#[test]
fn whatever_is_found_has_its_translation() {
    let said: Vec<String> = SOURCES.iter().flat_map(|source| literals(source)).collect();
    assert!(said.len() > 150, "{}", said.len());
    let known =
        |text: &str| FINDINGS.iter().chain(FAULTS).chain(SENTENCES).any(|(english, _)| *english == text);
    let missing: Vec<&String> =
        said.iter().filter(|text| !known(text) && !NOT_TOLD.contains(&text.as_str())).collect();
    assert!(missing.is_empty(), "no translation of {missing:#?}");
    let whole = SOURCES.concat();
    for (english, russian) in FINDINGS.iter().chain(FAULTS) {
        let longest = english.split("{}").max_by_key(|piece| piece.len()).unwrap_or_default();
        let longest = longest.trim_matches([' ', ':']);
        assert!(said.iter().any(|text| text == english) || whole.contains(longest), "nobody says {english}");
        assert_eq!(english.matches("{}").count(), russian.matches("{}").count(), "{english}");
    }
}

/// Catches: what a file says translated or given a decimal comma; a sentence within a sentence left out.
#[test]
fn quotes_stay_and_parts_are_looked_up() {
    let ru = |text| found(Lang::Ru, text).into_owned();
    assert_eq!(
        ru("expected the intensity at 22.5°, γ 45°, found '1.5x lower'"),
        "ожидалось: сила света (22,5°, γ 45°); найдено «1.5x lower»"
    );
    assert_eq!(
        ru("Ē is 5.7 % lower than the rated flux suggests; set `flux` to choose"),
        "Ē на 5,7 % ниже, чем следует из заявленного потока; выбрать поток можно ключом `flux`"
    );
    assert_eq!(found(Lang::En, "the file is empty"), "the file is empty");
}
