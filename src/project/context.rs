//! What loading carries along: the text that spans point into, mistakes and notes met so far, and
//! the one door through which files are read (inside the project's folder unless allowed).

use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use toml::Spanned;

use super::InputFile;
use super::diagnostics::{Diagnostic, Place};
use crate::digest::sha256;
use crate::geometry::trace::Simd;

/// Largest photometric, CSV or norm file.
pub const SMALL_FILE: u64 = 64 << 20;
/// Largest glTF file or buffer.
pub const LARGE_FILE: u64 = 512 << 20;

/// State of one load.
#[derive(Debug)]
pub struct Context {
    /// Folder of the project file.
    pub folder: PathBuf,
    /// Project file as the user wrote it.
    pub file: String,
    /// Its text.
    pub text: String,
    /// Mistakes so far.
    pub diagnostics: Vec<Diagnostic>,
    /// Places of tables with unknown keys: what seems missing there may only be misspelt.
    pub misspelt: Vec<Range<usize>>,
    /// What is allowed and may well be a mistake.
    pub warnings: Vec<Diagnostic>,
    /// Notes so far.
    pub biases: Vec<String>,
    /// Files read so far.
    pub inputs: Vec<InputFile>,
    /// Whether files outside the folder may be read.
    pub allow_outside: bool,
    /// SIMD level of the tracers that are built.
    pub simd: Simd,
}

impl Context {
    /// Reports a mistake at a place of the project file.
    pub fn error(&mut self, span: &Range<usize>, message: impl Into<String>, hint: &str) {
        let diagnostic =
            Diagnostic::at(&self.file, &self.text, span.clone(), message.into(), hint.to_owned());
        if !self.diagnostics.contains(&diagnostic) {
            self.diagnostics.push(diagnostic);
        }
    }

    /// A place of the project file, for mistakes that only a later step can find.
    pub fn place(&self, span: &Range<usize>) -> Place {
        Place::new(&self.file, &self.text, span.clone())
    }

    /// Reports that something is missing in the table at `span`, unless a key of it was unknown.
    pub fn missing(&mut self, span: &Range<usize>, message: impl Into<String>, hint: &str) {
        if !self.misspelt.contains(span) {
            self.error(span, message, hint);
        }
    }

    /// Reports a mistake in a line of another file.
    pub fn error_in(&mut self, file: &str, text: &str, line: usize, message: String, hint: &str) {
        self.diagnostics.push(Diagnostic::at_line(file, text, line, message, hint));
    }

    /// Warns of what is allowed and may well be a mistake, at a place of the project file; it stands in the
    /// list of biases too.
    pub fn warn(&mut self, span: &Range<usize>, message: impl Into<String>, hint: &str) {
        let message = message.into();
        let warning = Diagnostic::at(&self.file, &self.text, span.clone(), message.clone(), hint.to_owned());
        self.add_warning(warning);
        self.note(message);
    }

    fn add_warning(&mut self, warning: Diagnostic) {
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }

    /// Warns of a line of another file.
    pub fn warn_in(&mut self, file: &str, text: &str, line: usize, message: String, hint: &str) {
        self.note(message.clone());
        self.add_warning(Diagnostic::at_line(file, text, line, message, hint));
    }

    /// Notes something ignored or approximated.
    pub fn note(&mut self, sentence: impl Into<String>) {
        let sentence = sentence.into();
        if !self.biases.contains(&sentence) {
            self.biases.push(sentence);
        }
    }

    /// Reads a file named in the project; on failure the mistake is reported.
    pub fn read(&mut self, path: &Spanned<String>, limit: u64) -> Option<Vec<u8>> {
        match self.read_path(path.get_ref(), limit) {
            Ok(bytes) => Some(bytes),
            Err((message, hint)) => {
                self.error(&path.span(), message, hint);
                None
            }
        }
    }

    /// Reads a UTF-8 text file named in the project.
    pub fn read_text(&mut self, path: &Spanned<String>) -> Option<String> {
        let bytes = self.read(path, SMALL_FILE)?;
        let Ok(text) = String::from_utf8(bytes) else {
            let message = format!("\"{}\" is not UTF-8 text", path.get_ref());
            self.error(&path.span(), message, "");
            return None;
        };
        Some(text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned())
    }

    /// Reads a file relative to the project's folder and records its hash; errors are (message, hint).
    pub fn read_path(&mut self, path: &str, limit: u64) -> Result<Vec<u8>, (String, &'static str)> {
        let outside =
            (format!("\"{path}\" lies outside the project's folder"), "--allow-outside permits that");
        let climbs = Path::new(path)
            .components()
            .any(|part| !matches!(part, Component::Normal(_) | Component::CurDir));
        if climbs && !self.allow_outside {
            return Err(outside);
        }
        let cannot = |error: &std::io::Error| (format!("cannot read \"{path}\": {error}"), "");
        let full = self.folder.join(path).canonicalize().map_err(|error| cannot(&error))?;
        if !self.allow_outside && !full.starts_with(&self.folder) {
            return Err(outside);
        }
        let metadata = full.metadata().map_err(|error| cannot(&error))?;
        if !metadata.is_file() {
            return Err((format!("\"{path}\" is not a file"), ""));
        }
        if metadata.len() > limit {
            let (size, limit) = (metadata.len() >> 20, limit >> 20);
            let message = format!("\"{path}\" has {size} MiB, more than the limit of {limit} MiB");
            return Err((message, ""));
        }
        let bytes = std::fs::read(&full).map_err(|error| cannot(&error))?;
        self.record(path, &bytes);
        Ok(bytes)
    }

    /// Records an input and its hash.
    pub fn record(&mut self, path: &str, bytes: &[u8]) {
        if self.inputs.iter().any(|input| input.path == path) {
            return;
        }
        self.inputs.push(InputFile { path: path.to_owned(), sha256: sha256(bytes) });
    }

    /// A number within a closed range; NaN is outside of every range.
    pub fn in_range(&mut self, value: &Spanned<f64>, low: f64, high: f64, what: &str) -> bool {
        let ok = (low..=high).contains(value.get_ref()) && value.get_ref().is_finite();
        if !ok {
            let message = if high.is_infinite() {
                format!("{what} must be at least {low}, found {}", value.get_ref())
            } else {
                format!("{what} must lie in {low} … {high}, found {}", value.get_ref())
            };
            self.error(&value.span(), message, "");
        }
        ok
    }

    /// A finite number greater than zero.
    pub fn positive(&mut self, value: f64, span: &Range<usize>, what: &str) -> bool {
        let ok = value > 0.0 && value.is_finite();
        if !ok {
            self.error(span, format!("{what} must be greater than 0, found {value}"), "");
        }
        ok
    }

    /// Coordinates that are all finite.
    pub fn finite<const N: usize>(&mut self, values: &[f64; N], span: &Range<usize>) -> bool {
        let ok = values.iter().all(|value| value.is_finite());
        if !ok {
            self.error(span, "coordinates must be finite", "");
        }
        ok
    }
}
