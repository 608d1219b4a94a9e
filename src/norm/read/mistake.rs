//! What is wrong in a norm file, where, and what to do.

/// All mistakes of a norm file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", .mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n\n"))]
pub struct NormError {
    /// At least one, in the order of their discovery.
    pub mistakes: Vec<Mistake>,
}

/// One mistake and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// File as given to the parser.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The line itself.
    pub source_line: String,
    /// Number of characters to underline.
    pub width: usize,
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub hint: String,
}

impl std::fmt::Display for Mistake {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let number = self.line.to_string();
        let margin = " ".repeat(number.len());
        let indent = " ".repeat(self.column.saturating_sub(1));
        writeln!(f, "error: {}", self.what)?;
        writeln!(f, "{margin}--> {}:{}:{}", self.file, self.line, self.column)?;
        writeln!(f, "{margin} |")?;
        writeln!(f, "{number} | {}", self.source_line.replace('\t', " "))?;
        write!(f, "{margin} | {indent}{}", "^".repeat(self.width))?;
        if !self.hint.is_empty() {
            write!(f, "\n{margin} = hint: {}", self.hint)?;
        }
        Ok(())
    }
}

/// What serde calls things, and what a reader of the message does.
const RUST_WORDS: [(&str, &str); 4] = [
    ("expected f64", "expected a number"),
    ("expected a sequence", "expected a list [ ]"),
    ("expected a boolean", "expected true or false"),
    ("expected struct Fact", "expected { value = …, verified = \"…\", source = \"…\" }"),
];

/// serde's message in a user's words, and a hint.
pub(super) fn plainly(message: &str) -> (String, String) {
    let mut message = message.trim().replace('\n', ", ");
    for (rust, plain) in RUST_WORDS {
        message = message.replace(rust, plain);
    }
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match quoted[..] {
        [wrong, ref known @ ..] if message.starts_with("unknown field") => {
            (format!("unknown key \"{wrong}\""), format!("there is: {}", known.join(", ")))
        }
        [missing] if message.starts_with("missing field") => {
            (format!("the key \"{missing}\" is missing"), String::new())
        }
        _ => (message, "compare with a bundled norm: gershun norm show en-12464-1-2021".into()),
    }
}
