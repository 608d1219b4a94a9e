//! Pieces of HTML that are XML too: headings, tables, lists. Arguments named html or cells are
//! markup already; everything else is escaped here.

use super::words::{Lang, Symbol, Term, word};
use super::xml::{escape, put};
use crate::outcome::Verdict;

/// A level-two heading.
pub fn heading(lang: Lang, term: Term) -> String {
    format!("<h2>{}</h2>\n", word(lang, term))
}

/// A level-three heading.
pub fn subheading(lang: Lang, term: Term) -> String {
    format!("<h3>{}</h3>\n", word(lang, term))
}

/// A table; cells are HTML. A column is right-aligned where its letter in `align` is `r`, kept on
/// one line where it is `w`, and wide and broken anywhere, as names may need it, where it is `a`. A
/// row of one cell heads those that follow; one of two cells belongs to the row before it, its second cell under all
/// columns but the first.
pub fn grid(align: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    let class = |column: usize| match align.as_bytes().get(column) {
        Some(b'r') => " class=\"n\"",
        Some(b'w') => " class=\"w\"",
        Some(b'a') => " class=\"a\"",
        _ => "",
    };
    let mut html = String::from("<table><thead><tr>");
    for (column, cell) in head.iter().enumerate() {
        let class = if class(column).contains('n') { " style=\"text-align:right\"" } else { "" };
        put(&mut html, format_args!("<th{class}>{cell}</th>"));
    }
    html.push_str("</tr></thead><tbody>\n");
    for (number, row) in rows.iter().enumerate() {
        if let [title] = row.as_slice() {
            let columns = head.len();
            put(
                &mut html,
                format_args!("<tr class=\"group\"><td class=\"a\" colspan=\"{columns}\">{title}</td></tr>\n"),
            );
            continue;
        }
        if let ([first, below], true) = (row.as_slice(), head.len() > 2) {
            let columns = head.len() - 1;
            put(
                &mut html,
                format_args!(
                    "<tr><td>{first}</td><td class=\"note\" colspan=\"{columns}\">{below}</td></tr>\n"
                ),
            );
            continue;
        }
        let is_held = head.len() > 2 && rows.get(number + 1).is_some_and(|next| next.len() == 2);
        html.push_str(if is_held { "<tr class=\"held\">" } else { "<tr>" });
        for (column, cell) in row.iter().enumerate() {
            put(&mut html, format_args!("<td{}>{cell}</td>", class(column)));
        }
        html.push_str("</tr>\n");
    }
    html.push_str("</tbody></table>\n");
    html
}

/// Terms and what they are; both HTML.
pub fn pairs(rows: &[(&str, String)]) -> String {
    let mut html = String::from("<dl>");
    for (term, text) in rows.iter().filter(|(_, text)| !text.is_empty()) {
        put(&mut html, format_args!("<dt>{term}</dt><dd>{text}</dd>"));
    }
    html.push_str("</dl>\n");
    html
}

/// A symbol with its index set below the line.
pub fn symbol(symbol: &Symbol) -> String {
    let below = |text: &str| {
        let mut html = String::new();
        for (index, part) in text.split('_').enumerate() {
            if index == 0 {
                html.push_str(&escape(part));
                continue;
            }
            let end = part.find(|c: char| !c.is_alphanumeric() && c != ',').unwrap_or(part.len());
            put(&mut html, format_args!("<sub>{}</sub>{}", escape(&part[..end]), escape(&part[end..])));
        }
        html
    };
    let index =
        if symbol.index.is_empty() { String::new() } else { format!("<sub>{}</sub>", escape(&symbol.index)) };
    format!("{}{index}{}", below(&symbol.letter), below(&symbol.rest))
}

/// A bulleted list of HTML.
pub fn list(items: impl Iterator<Item = String>) -> String {
    let mut html = String::from("<ul>");
    for item in items {
        put(&mut html, format_args!("<li>{item}</li>"));
    }
    html.push_str("</ul>\n");
    html
}

/// CSS class of a verdict.
pub fn class_of(verdict: Option<Verdict>) -> &'static str {
    match verdict {
        Some(Verdict::Pass) => "pass",
        Some(Verdict::Fail) => "fail",
        Some(Verdict::Undecided | Verdict::Undefined) => "open",
        Some(Verdict::Declared | Verdict::NotAssessed) | None => "idle",
    }
}
