//! Mistakes of a user's file: collected, with the place and a hint, and printed the way a compiler
//! prints them. Columns count characters, from 1.

use std::fmt;
use std::ops::Range;

/// One mistake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// File as the user wrote it.
    pub file: String,
    /// Line from 1; 0 where the whole file is meant.
    pub line: usize,
    /// Column from 1.
    pub column: usize,
    /// The source line, empty where there is none.
    pub source_line: String,
    /// Number of characters to underline.
    pub width: usize,
    /// What is wrong.
    pub message: String,
    /// What to do, may be empty.
    pub hint: String,
}

/// A place in a file of the user's, kept for mistakes that only a later step can find.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place(Diagnostic);

impl Place {
    /// The byte range `span` of `text`, which is the content of `file`.
    pub fn new(file: &str, text: &str, span: Range<usize>) -> Self {
        Self(Diagnostic::at(file, text, span, String::new(), String::new()))
    }

    /// A line of `text`, counted from 1.
    pub fn line(file: &str, text: &str, line: usize) -> Self {
        Self(Diagnostic::at_line(file, text, line, String::new(), ""))
    }

    /// A mistake at this place.
    pub fn mistake(&self, message: String, hint: String) -> Diagnostic {
        Diagnostic { message, hint, ..self.0.clone() }
    }
}

impl Diagnostic {
    /// A mistake at a byte range of `text`.
    pub fn at(file: &str, text: &str, span: Range<usize>, message: String, hint: String) -> Self {
        let start = floor_boundary(text, span.start);
        let end = floor_boundary(text, span.end).max(start);
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let source_line = text[line_start..].lines().next().unwrap_or_default();
        let column = text[line_start..start].chars().count() + 1;
        let last = end.min(line_start + source_line.len()).max(start);
        Self {
            file: file.to_owned(),
            line: text[..start].matches('\n').count() + 1,
            column,
            source_line: source_line.to_owned(),
            width: text[start..last].chars().count().max(1),
            message,
            hint,
        }
    }

    /// A mistake in a line of `text`, counted from 1.
    pub fn at_line(file: &str, text: &str, line: usize, message: String, hint: &str) -> Self {
        let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
        let length = text[start..].lines().next().map_or(0, str::len);
        Self::at(file, text, start..start + length, message, hint.to_owned())
    }

    /// A mistake of a whole file.
    pub fn file(file: &str, message: String, hint: String) -> Self {
        Self {
            file: file.to_owned(),
            line: 0,
            column: 0,
            source_line: String::new(),
            width: 0,
            message,
            hint,
        }
    }
}

impl Diagnostic {
    /// The same, told as what may well be a mistake and is allowed.
    pub fn as_warning(&self) -> String {
        self.to_string().replacen("error", "warning", 1)
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "error: {}", self.message)?;
        if self.line == 0 {
            write!(f, " --> {}", self.file)?;
            if !self.hint.is_empty() {
                write!(f, "\n  = hint: {}", self.hint)?;
            }
            return Ok(());
        }
        let number = self.line.to_string();
        let margin = " ".repeat(number.len());
        let source = self.source_line.replace('\t', " ");
        let indent = " ".repeat(self.column - 1);
        let carets = "^".repeat(self.width);
        writeln!(f, "{margin}--> {}:{}:{}", self.file, self.line, self.column)?;
        writeln!(f, "{margin} |")?;
        writeln!(f, "{number} | {source}")?;
        write!(f, "{margin} | {indent}{carets}")?;
        if !self.hint.is_empty() {
            write!(f, "\n{margin} = hint: {}", self.hint)?;
        }
        Ok(())
    }
}

/// `did you mean "x"?`, or the list of what there is.
pub fn suggestion<'a>(wrong: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let mut known: Vec<&str> = known.into_iter().collect();
    known.dedup();
    let near = known
        .iter()
        .map(|name| (edit_distance(wrong, name), *name))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, name)| *distance <= 1 + name.chars().count() / 4);
    match near {
        Some((_, name)) => format!("did you mean \"{name}\"?"),
        None if known.is_empty() => String::new(),
        None => {
            let shown: Vec<&str> = known.iter().take(20).copied().collect();
            let dots = if known.len() > 20 { ", …" } else { "" };
            format!("there is: {}{dots}", shown.join(", "))
        }
    }
}

/// Levenshtein distance, ASCII case ignored.
fn edit_distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.to_ascii_lowercase().chars().collect();
    let b: Vec<char> = b.to_ascii_lowercase().chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let replace = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = replace.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

fn floor_boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_caret_stands_under_the_word_even_after_umlauts() {
        let text = "a = 1\nö = \"über\" # x\n";
        let start = text.find("\"ü").unwrap();
        let diagnostic =
            Diagnostic::at("p.toml", text, start..start + "\"über\"".len(), "no".into(), "try".into());
        let expected = "error: no\n --> p.toml:2:5\n  |\n2 | ö = \"über\" # x\n  |     ^^^^^^\n  = hint: try";
        assert_eq!(diagnostic.to_string(), expected);
    }

    /// Catches: a warning that calls itself an error, or loses its place.
    #[test]
    fn a_warning_is_printed_like_a_mistake() {
        let warned = Diagnostic::at("p.toml", "a = 1\n", 0..1, "no error".into(), String::new());
        assert_eq!(warned.as_warning(), "warning: no error\n --> p.toml:1:1\n  |\n1 | a = 1\n  | ^");
    }

    #[test]
    fn near_names_are_suggested_and_far_ones_listed() {
        assert_eq!(suggestion("flor", ["floor", "walls"]), "did you mean \"floor\"?");
        assert_eq!(suggestion("zzz", ["floor", "walls"]), "there is: floor, walls");
        assert_eq!(suggestion("zzz", []), "");
    }
}
