//! SARIF 2.1.0 for code review tools: requirements that fail or stay open are results.

use serde_json::json;

use super::sentence::{line, verdict_key};
use crate::outcome::{Outcome, Requirement, Verdict};

/// The failed and open requirements of an outcome as SARIF.
pub fn sarif(outcome: &Outcome) -> String {
    let results: Vec<_> = outcome.requirements.iter().filter_map(result).collect();
    let rules = vec![
        rule("fail", "A requirement is certainly not met."),
        rule("undecided", "The limit lies within the numerical uncertainty."),
        rule("undefined", "The value that is limited does not exist."),
    ];
    log(&rules, &results)
}

/// A log of one run.
pub(super) fn log(rules: &[serde_json::Value], results: &[serde_json::Value]) -> String {
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": env!("CARGO_PKG_NAME"),
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "results": results,
        }],
    });
    format!("{log:#}\n")
}

pub(super) fn rule(id: &str, text: &str) -> serde_json::Value {
    json!({ "id": id, "shortDescription": { "text": text } })
}

fn result(requirement: &Requirement) -> Option<serde_json::Value> {
    let level = match requirement.verdict {
        Verdict::Fail => "error",
        Verdict::Undecided | Verdict::Undefined => "warning",
        Verdict::Pass | Verdict::Declared | Verdict::NotAssessed => return None,
    };
    Some(json!({
        "ruleId": verdict_key(requirement.verdict),
        "level": level,
        "message": { "text": line(requirement) },
        "locations": [{ "logicalLocations": [{
            "name": requirement.subject,
            "fullyQualifiedName": format!("{}/{}", requirement.room, requirement.subject),
        }]}],
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn only_failed_and_open_requirements_are_results() {
        let outcome = sample::outcome();
        let log: serde_json::Value = serde_json::from_str(&sarif(&outcome)).expect("JSON");
        let results = log["runs"][0]["results"].as_array().expect("results");
        let open = |v| matches!(v, Verdict::Fail | Verdict::Undecided | Verdict::Undefined);
        assert_eq!(results.len(), outcome.requirements.iter().filter(|r| open(r.verdict)).count());
        assert!(results.iter().all(|r| r["message"]["text"].is_string()));
    }
}
