//! The JSON Schema of norm files against every bundled file and broken ones, and against the loader: a key
//! that one of them knows and the other does not would mislead an editor.
#![expect(clippy::unwrap_used, reason = "a test that cannot read its files fails")]

use std::process::Command;

use common::violations;
use serde_json::Value as Json;

#[path = "common/schema.rs"]
mod common;

fn schema() -> Json {
    let output = Command::new(env!("CARGO_BIN_EXE_gershun")).args(["schema", "norm"]).output().unwrap();
    assert!(output.status.success());
    serde_json::from_slice(&output.stdout).unwrap()
}

fn check(text: &str) -> Vec<String> {
    let value: toml::Value = toml::from_str(text).unwrap();
    violations(&schema(), &serde_json::to_value(value).unwrap(), "norm")
}

/// Catches: a key of a bundled file that the schema forgot, a range other than the loader's.
#[test]
fn every_bundled_norm_follows_the_schema() {
    for (name, text) in gershun::norm::bundled() {
        assert_eq!(check(text), Vec::<String>::new(), "{name}");
    }
    assert_eq!(check("id = \"house\"\nrow = [{ ref = \"1\", em = 300 }]\n"), Vec::<String>::new());
}

/// Catches: a schema that lets everything through; what it refuses the loader refuses too.
#[test]
fn broken_norms_do_not() {
    for (text, wrong) in [
        ("id = \"house\"\n[[row]]\nref = \"1\"\nemm = 300\n", vec!["norm.row[0]: emm is not in the schema"]),
        (
            "id = \"house\"\n[application]\nugr_method = { value = \"guess\" }\n[[row]]\nem = -3\nu0 = 1.4\n",
            vec![
                "norm.application.ugr_method.value: \"guess\" is not allowed",
                "norm.row[0].em: -3 is out of range",
                "norm.row[0].u0: 1.4 is out of range",
                "norm.row[0]: ref is missing",
            ],
        ),
        (
            "id = \"\"\nrow = []\n",
            vec!["norm.id: \"\" has the wrong length", "norm.row: [] has the wrong length"],
        ),
    ] {
        let mut found = check(text);
        found.sort();
        assert_eq!(found, wrong);
        assert!(gershun::norm::Standard::parse(text, "house.toml").is_err(), "{text}");
    }
}

/// Catches: a key that the loader reads and the schema does not know, or the other way round. The loader
/// lists what there is beside a misspelt key.
#[test]
fn schema_and_loader_know_the_same_keys() {
    let schema = schema();
    let listed = |text: &str| -> Vec<String> {
        let error = gershun::norm::Standard::parse(text, "house.toml").unwrap_err().mistakes.remove(0);
        let mut keys: Vec<String> =
            error.hint.strip_prefix("there is: ").unwrap().split(", ").map(str::to_owned).collect();
        keys.sort();
        keys
    };
    let known = |place: &Json| -> Vec<String> {
        let mut keys: Vec<String> = place["properties"].as_object().unwrap().keys().cloned().collect();
        keys.sort();
        keys
    };
    let row = &schema["$defs"]["row"];
    assert_eq!(listed("id = \"x\"\nxyz = 1\n"), known(&schema));
    assert_eq!(listed("id = \"x\"\n[[row]]\nref = \"1\"\nxyz = 1\n"), known(row));
    assert_eq!(listed("id = \"x\"\n[application]\nxyz = 1\n"), known(&schema["properties"]["application"]));
    let limit = "id = \"x\"\n[[row]]\nref = \"1\"\n[[row.limit]]\nzone = \"task\"\nxyz = 1\n";
    assert_eq!(listed(limit), known(&row["properties"]["limit"]["items"]));
    let intensity = "id = \"x\"\n[[row]]\nref = \"1\"\nintensity = { xyz = 1 }\n";
    assert_eq!(listed(intensity), known(&row["properties"]["intensity"]));
}
