//! Findings of photometric files: for people, as JSON, and as SARIF for code review tools.

use serde::Serialize;
use serde_json::json;

use super::super::ReportError;
use super::super::words::{Lang, found, lamp_word, rule_words};
use super::super::xml::{printable, put};
use super::Batch;
use super::json::Found;
use crate::lamp::{RULES, Severity, rules};
use crate::photometry::Finding;

/// All findings with the name of their luminaire, in order.
fn findings(batch: &[Batch]) -> impl Iterator<Item = (&str, &Finding)> {
    batch.iter().flat_map(|file| -> Vec<(&str, &Finding)> {
        match &file.read {
            Ok(lamps) => lamps
                .iter()
                .flat_map(|lamp| lamp.findings.iter().map(|finding| (lamp.file.as_str(), finding)))
                .collect(),
            Err(finding) => vec![(file.file.as_str(), finding)],
        }
    })
}

/// One paragraph per finding, then a line that counts them.
pub fn human(batch: &[Batch], lang: Lang) -> String {
    let say = |english: &'static str| lamp_word(lang, english);
    let mut text = String::new();
    let mut counts = [0; 3];
    for (file, finding) in findings(batch) {
        let severity = rules::severity(finding.code);
        counts[severity as usize] += 1;
        text.push_str(&one(file, finding, severity, lang));
    }
    let [notes, warnings, errors] = counts;
    // Russian names the number behind a colon, which needs no plural forms.
    let counted = |n: usize, one: &str, many: &'static str| match lang {
        Lang::En => format!("{n} {}", if n == 1 { one } else { many }),
        Lang::Ru => format!("{many}: {n}"),
    };
    put(
        &mut text,
        format_args!(
            "{}{} {}, {}, {}\n",
            counted(batch.len(), "file", say("files")),
            if lang == Lang::Ru { "," } else { ":" },
            counted(errors, "error", say("errors")),
            counted(warnings, "warning", say("warnings")),
            counted(notes, "note", say("notes"))
        ),
    );
    if errors + warnings + notes > 0 {
        text.push_str(say("`gershun explain CODE` says more about a code"));
        text.push('\n');
    }
    text
}

/// `file:line: severity[code]: message` and what follows from it.
pub(super) fn one(file: &str, finding: &Finding, severity: Severity, lang: Lang) -> String {
    let line = finding.line.map_or(String::new(), |line| format!(":{line}"));
    format!(
        "{}{line}: {}[{}]: {}\n  = {}\n",
        printable(file),
        severity_word(severity, lang),
        finding.code,
        printable(&found(lang, &finding.message)),
        printable(&found(lang, &finding.consequence))
    )
}

/// `error`, `warning`, `note`.
pub(super) fn severity_word(severity: Severity, lang: Lang) -> &'static str {
    let say = |english: &'static str| lamp_word(lang, english);
    match severity {
        Severity::Note => say("note"),
        Severity::Warning => say("warning"),
        Severity::Error => say("error"),
    }
}

/// An array of { file, code, severity, line, message, consequence }.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn json(batch: &[Batch]) -> Result<String, ReportError> {
    #[derive(Serialize)]
    struct Entry<'a> {
        file: &'a str,
        finding: Found<'a>,
    }
    let entries: Vec<Entry> =
        findings(batch).map(|(file, finding)| Entry { file, finding: finding.into() }).collect();
    Ok(serde_json::to_string_pretty(&entries)? + "\n")
}

/// SARIF 2.1.0 with all rules.
pub fn sarif(batch: &[Batch]) -> String {
    let rules: Vec<_> = RULES
        .iter()
        .map(|rule| {
            json!({
                "id": rule.code,
                "shortDescription": { "text": rule.meaning },
                "fullDescription": { "text": rule.explanation },
                "defaultConfiguration": { "level": rule.severity.key() },
            })
        })
        .collect();
    let result = |(file, finding): (&str, &Finding)| {
        let mut location = json!({ "artifactLocation": { "uri": uri(file) } });
        if let Some(line) = finding.line {
            location["region"] = json!({ "startLine": line });
        }
        json!({
            "ruleId": finding.code,
            "level": rules::severity(finding.code).key(),
            "message": { "text": finding.to_string() },
            "locations": [{ "physicalLocation": location }],
        })
    };
    let results: Vec<_> = findings(batch).map(result).collect();
    super::super::sarif::log(&rules, &results)
}

/// A path as a URI reference: what RFC 3986 does not allow in a path is escaped.
fn uri(file: &str) -> String {
    let mut text = String::new();
    for byte in file.replace('\\', "/").bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/!$&'()*+,;=@".contains(&byte) {
            text.push(char::from(byte));
        } else {
            put(&mut text, format_args!("%{byte:02X}"));
        }
    }
    text
}

/// The text of `gershun explain`; `None` for an unknown code.
pub fn explanation(code: &str, lang: Lang) -> Option<String> {
    let rule = crate::lamp::rule(code)?;
    let (meaning, explanation) = rule_words(lang, rule);
    Some(format!("{} ({})\n{meaning}\n\n{explanation}\n", rule.code, severity_word(rule.severity, lang)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn batch() -> Vec<Batch> {
        let finding = Finding::new("angle-order", 7, "γ falls", "refused");
        vec![Batch { file: "a b/ü.ldt".into(), read: Err(finding) }]
    }

    /// Catches: an unreadable file left out of a format, a path that is no URI, counts mixed up.
    #[test]
    fn an_unreadable_file_is_an_error_everywhere() {
        let text = human(&batch(), Lang::En);
        assert!(
            text.starts_with("a b/ü.ldt:7: error[angle-order]: γ falls\n  = refused\n1 file: 1 error, 0"),
            "{text}"
        );
        let log: serde_json::Value = serde_json::from_str(&sarif(&batch())).expect("JSON");
        let result = &log["runs"][0]["results"][0];
        assert_eq!(result["level"], "error");
        let place = &result["locations"][0]["physicalLocation"];
        assert_eq!(
            (place["artifactLocation"]["uri"].as_str(), place["region"]["startLine"].as_u64()),
            (Some("a%20b/%C3%BC.ldt"), Some(7))
        );
        assert_eq!(log["runs"][0]["tool"]["driver"]["rules"].as_array().map(Vec::len), Some(RULES.len()));
        let list: serde_json::Value = serde_json::from_str(&json(&batch()).expect("JSON")).expect("JSON");
        assert_eq!(list[0]["finding"]["severity"], "error");
    }

    /// Catches: a code without an explanation, an invented one explained.
    #[test]
    fn codes_are_explained() {
        assert!(
            explanation("flux-mismatch", Lang::En)
                .is_some_and(|text| text.starts_with("flux-mismatch (warning)\n"))
        );
        assert!(explanation("nonsense", Lang::En).is_none());
    }
}
