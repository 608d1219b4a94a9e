//! Every bundled scene in Russian. Catches: a sentence of solver or loader that was never translated,
//! or whose translation no longer matches what is said.

use std::path::{Path, PathBuf};
use std::process::Command;

/// So many words of Latin letters in a row are a sentence, not a name.
const SENTENCE: usize = 5;

fn projects(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("scenes are there").flatten() {
        let path = entry.path();
        if path.is_dir() {
            projects(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(path);
        }
    }
}

/// The page's text, without styles, drawings, hashes and tags.
fn text_of(page: &str) -> String {
    let mut text = String::new();
    let mut rest = page;
    while let Some(at) = rest.find('<') {
        text.push_str(&rest[..at]);
        text.push('|');
        let skipped = ["style", "svg", "code"].into_iter().find(|tag| rest[at + 1..].starts_with(tag));
        let end = match skipped {
            Some(tag) => {
                let close = format!("</{tag}>");
                rest[at..].find(&close).map_or(rest.len(), |end| at + end + close.len())
            }
            None => rest[at..].find('>').map_or(rest.len(), |end| at + end + 1),
        };
        rest = &rest[end..];
    }
    text
}

/// How the maker of the bundled photometric files is called in the luminaire schedule.
const MAKER: &str = "gershun example scenes";

/// Runs of Latin words that are long enough to be a sentence.
fn latin_sentences(text: &str) -> Vec<String> {
    let mut sentences = Vec::new();
    for cell in text.split('|') {
        let mut run: Vec<&str> = Vec::new();
        for word in cell.split_whitespace().chain([""]) {
            let bare = word.trim_matches(|c: char| c.is_ascii_punctuation());
            if bare.chars().all(|c| c.is_ascii_alphabetic() || c == '-') && !bare.is_empty() {
                run.push(word);
            } else {
                let said = run.join(" ");
                if run.len() >= SENTENCE && !said.starts_with(MAKER) {
                    sentences.push(said);
                }
                run.clear();
            }
        }
    }
    sentences
}

#[test]
fn no_sentence_of_a_russian_report_is_english() {
    let mut found = Vec::new();
    for folder in ["scenes", "tests/projects"] {
        projects(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut found);
    }
    assert!(found.len() >= 2, "{found:?}");
    found.sort();
    for project in found {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("out");
        let output = Command::new(env!("CARGO_BIN_EXE_gershun"))
            .args(["check", "--quiet", "--lang", "ru", "--blocks", "2", "--out"])
            .arg(&out)
            .arg(&project)
            .output()
            .expect("the program starts");
        let page = std::fs::read_to_string(out.join("report.html"))
            .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)));
        let text = text_of(&page);
        assert!(text.chars().any(|c| ('а'..='я').contains(&c)), "no Russian in {}", project.display());
        let english = latin_sentences(&text);
        assert!(english.is_empty(), "{}: {english:#?}", project.display());
    }
}

#[test]
fn an_english_sentence_is_found() {
    let page = "<p>Поле <b>Every surface stores one number a side</b></p><svg>a b c d e f g</svg>";
    assert_eq!(latin_sentences(&text_of(page)), ["Every surface stores one number a side"]);
}
