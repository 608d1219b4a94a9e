//! Files, tables and drawings for people and machines; the only code that writes files. Its one
//! input is [`Outcome`] (for single photometric files [`crate::lamp`]'s data), so equal outcomes give
//! equal bytes: no clock, host, thread count or absolute path can enter.

pub mod body;
mod canvas;
pub mod csv;
mod file;
mod folder;
pub mod glare;
mod isolines;
mod json;
mod junit;
pub mod lamp;
mod markup;
pub mod number;
mod page;
mod page_glare;
mod page_requirements;
mod page_room;
pub mod picture;
mod picture_colours;
mod plan;
mod plan_sheet;
mod plan_view;
mod plan_window;
mod provenance;
#[cfg(test)]
mod sample;
mod sarif;
mod sentence;
mod terminal;
pub mod words;
mod xml;

use std::path::{Path, PathBuf};

pub use file::{make_folder, write_file};
pub use junit::junit;
pub use sarif::sarif;
pub use sentence::overall;
pub use terminal::{Colour, Style, table};
pub use words::Lang;

use crate::outcome::Outcome;

/// What the report looks like.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Languages of the page, the first also of the drawings; empty: those of the project.
    pub languages: Vec<Lang>,
    /// Separator and decimal sign of tables.
    pub dialect: csv::Dialect,
}

impl Default for Options {
    fn default() -> Self {
        Self { languages: Vec::new(), dialect: csv::Dialect::Standard }
    }
}

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file or folder could not be made.
    #[error("{path}: {source}")]
    Io {
        /// Where.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A folder stands where a file of the report belongs.
    #[error("{0}: a folder stands where a file of the report belongs; move it away or choose another --out")]
    FolderInTheWay(PathBuf),
    /// A table could not be encoded.
    #[error("table: {0}")]
    Csv(#[from] ::csv::Error),
    /// A result could not be encoded.
    #[error("result: {0}")]
    Json(#[from] serde_json::Error),
    /// A picture could not be encoded.
    #[error("picture: {0}")]
    Picture(String),
}

/// Writes the report into `out` and returns the files written, relative to it. Every file appears
/// whole or not at all; files of a former report that are no longer part of it are removed if
/// nobody has changed them since; files of others are left alone.
///
/// # Errors
/// Where the folder cannot be written; nothing of the report is left behind then, unless the disk
/// fails between two renames.
pub fn write(outcome: &Outcome, out: &Path, options: &Options) -> Result<Vec<PathBuf>, ReportError> {
    folder::replace(out, &files(outcome, options)?)
}

/// All files of the report in the order in which they are written: path with `/`, bytes.
///
/// # Errors
/// Where a table or a result cannot be encoded.
pub fn files(outcome: &Outcome, options: &Options) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let languages = languages(outcome, options);
    let mut files = vec![("result.json".to_owned(), json::result(outcome)?)];
    files.extend(csv::tables(outcome, options.dialect)?);
    for (name, svg) in plan::files(outcome, languages[0]) {
        files.push((format!("plan/{name}"), svg.into_bytes()));
    }
    files.extend(luminaires(outcome, languages[0]));
    files.push(("report.html".to_owned(), page::page(outcome, &languages).into_bytes()));
    let provenance = provenance::provenance(outcome, &files)?;
    files.push((folder::MANIFEST.to_owned(), provenance));
    Ok(files)
}

/// The polar diagram of every luminaire type, once.
fn luminaires(outcome: &Outcome, lang: Lang) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<(String, Vec<u8>)> = Vec::new();
    for kind in outcome.rooms.iter().flat_map(|room| &room.types) {
        let name = format!("luminaires/{}.svg", plan::file_name(&kind.name));
        let dark = !(kind.distribution.flux().0 > 0.0);
        if !dark && !files.iter().any(|(known, _)| known.to_lowercase() == name.to_lowercase()) {
            let svg = lamp::diagram(
                &kind.name,
                &words::description(lang, &kind.description, &kind.file),
                &kind.distribution,
                lang,
            );
            files.push((name, svg.into_bytes()));
        }
    }
    files
}

/// JSON Schema of result.json.
pub fn schema() -> &'static str {
    include_str!("result.schema.json")
}

/// Languages without repetition; never empty.
fn languages(outcome: &Outcome, options: &Options) -> Vec<Lang> {
    let mut languages = Vec::new();
    let of_project = outcome.info.language.iter().filter_map(|code| Lang::parse(code));
    let wanted: Vec<Lang> =
        if options.languages.is_empty() { of_project.collect() } else { options.languages.clone() };
    for lang in wanted {
        if !languages.contains(&lang) {
            languages.push(lang);
        }
    }
    if languages.is_empty() {
        languages.push(Lang::En);
    }
    languages
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_outcomes_give_equal_bytes_that_name_no_place() {
        let options = Options { languages: vec![Lang::En, Lang::Ru], ..Options::default() };
        let first = files(&sample::outcome(), &options).expect("files");
        let second = files(&sample::outcome(), &options).expect("files");
        assert!(first == second);
        let here = env!("CARGO_MANIFEST_DIR");
        for (name, bytes) in &first {
            assert!(!String::from_utf8_lossy(bytes).contains(here), "{name} names a folder of this machine");
        }
    }

    #[test]
    fn every_drawing_and_the_page_are_well_formed() {
        let options = Options { languages: vec![Lang::Ru, Lang::En], ..Options::default() };
        let mut drawings = 0;
        for (name, bytes) in files(&sample::outcome(), &options).expect("files") {
            let text = String::from_utf8(bytes).expect("UTF-8");
            let extension =
                Path::new(&name).extension().and_then(|e| e.to_str()).unwrap_or_default().to_owned();
            if extension == "svg" || extension == "html" {
                let allow = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
                roxmltree::Document::parse_with_options(&text, allow)
                    .unwrap_or_else(|e| panic!("{name}: {e}"));
                drawings += usize::from(extension == "svg");
            }
        }
        let rooms = sample::outcome().rooms;
        let plans: usize = rooms.iter().flat_map(|r| &r.areas).map(|a| a.fields.len()).sum();
        let mut kinds: Vec<&str> = rooms.iter().flat_map(|r| &r.types).map(|t| t.name.as_str()).collect();
        kinds.sort_unstable();
        kinds.dedup();
        assert_eq!(drawings, plans + kinds.len(), "every plan and one polar diagram a luminaire type");
    }

    #[test]
    fn project_languages_count_where_none_is_asked_for() {
        let outcome = sample::outcome();
        assert_eq!(languages(&outcome, &Options::default()), [Lang::Ru, Lang::En]);
        let twice = Options { languages: vec![Lang::En, Lang::En], ..Options::default() };
        assert_eq!(languages(&outcome, &twice), [Lang::En]);
    }

    /// Writes the samples where a person can look at them: `cargo test -- --ignored look`.
    #[test]
    #[ignore = "writes into the folder named by GERSHUN_LOOK"]
    fn look() {
        let folder = std::env::var_os("GERSHUN_LOOK").expect("GERSHUN_LOOK names a folder");
        let options = Options { languages: vec![Lang::En, Lang::Ru], ..Options::default() };
        write(&sample::outcome(), &Path::new(&folder).join("sample"), &options).expect("written");
        write(&sample::hundred_rooms(), &Path::new(&folder).join("hundred"), &options).expect("written");
        for lang in [Lang::En, Lang::Ru] {
            println!("{}", table(&sample::outcome(), Style { lang, colour: Colour::Plain }));
        }
        println!("{}", table(&sample::hundred_rooms(), Style { lang: Lang::En, colour: Colour::Plain }));
    }
}
