//! Text inside XML and HTML. Names may hold any character, also those that XML forbids.

use std::fmt::{self, Write};

/// Characters that XML 1.0 allows; the others become U+FFFD.
pub fn printable(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\t' | '\n' | '\r' => ' ',
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => '\u{fffd}',
            c => c,
        })
        .collect()
}

/// Text for element content and attribute values in either kind of quotes.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in printable(text).chars() {
        match c {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// Appends formatted text.
pub fn put(text: &mut String, what: fmt::Arguments<'_>) {
    text.write_fmt(what).expect("a string takes any text");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_text_survives_a_parser() {
        let nasty = "a<b & \"c\" 'd' \u{1}\u{ffff}]]> Кабинет";
        let document = format!("<t a=\"{0}\" b='{0}'>{0}</t>", escape(nasty));
        let parsed = roxmltree::Document::parse(&document).expect("well-formed");
        assert_eq!(parsed.root_element().text(), Some(printable(nasty).as_str()));
    }
}
