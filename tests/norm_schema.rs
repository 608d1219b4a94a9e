//! The JSON Schema of norm files against every bundled file and broken ones, and against the loader: a key
//! that one of them knows and the other does not would mislead an editor.
#![expect(clippy::unwrap_used, reason = "a test that cannot read its files fails")]

use std::process::Command;

use serde_json::Value as Json;

/// What violates a schema, in the words that ours uses.
fn violations(schema: &Json, root: &Json, value: &Json, at: &str, found: &mut Vec<String>) {
    const KNOWN: [&str; 16] = [
        "$schema",
        "$defs",
        "title",
        "description",
        "type",
        "enum",
        "required",
        "properties",
        "items",
        "additionalProperties",
        "minimum",
        "maximum",
        "minItems",
        "maxItems",
        "minLength",
        "$ref",
    ];
    for word in schema.as_object().unwrap().keys() {
        assert!(KNOWN.contains(&word.as_str()), "{at}: the check does not know {word}");
    }
    if let Some(target) = schema["$ref"].as_str() {
        return violations(&root["$defs"][target.strip_prefix("#/$defs/").unwrap()], root, value, at, found);
    }
    let fits = match schema["type"].as_str().unwrap() {
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("{at}: {other}"),
    };
    if !fits {
        found.push(format!("{at}: {value} is no {}", schema["type"]));
        return;
    }
    if schema["enum"].as_array().is_some_and(|allowed| !allowed.contains(value)) {
        found.push(format!("{at}: {value} is not allowed"));
    }
    let outside = |key: &str, wrong: fn(f64, f64) -> bool| {
        let (limit, number) = (schema[key].as_f64(), value.as_f64());
        limit.zip(number).is_some_and(|(limit, number)| wrong(number, limit))
    };
    if outside("minimum", |x, least| x < least) || outside("maximum", |x, most| x > most) {
        found.push(format!("{at}: {value} is out of range"));
    }
    let short = |key: &str, length: Option<usize>| {
        schema[key].as_u64().zip(length).map(|(limit, length)| (length as u64, limit))
    };
    let length = value.as_array().map(Vec::len);
    if short("minItems", length).is_some_and(|(length, least)| length < least)
        || short("maxItems", length).is_some_and(|(length, most)| length > most)
        || short("minLength", value.as_str().map(str::len)).is_some_and(|(length, least)| length < least)
    {
        found.push(format!("{at}: {value} has the wrong length"));
    }
    if let (Some(items), Some(elements)) = (schema.get("items"), value.as_array()) {
        for (index, element) in elements.iter().enumerate() {
            violations(items, root, element, &format!("{at}[{index}]"), found);
        }
    }
    if let Some(object) = value.as_object() {
        for key in schema["required"].as_array().into_iter().flatten().filter_map(Json::as_str) {
            if !object.contains_key(key) {
                found.push(format!("{at}: {key} is missing"));
            }
        }
        for (key, element) in object {
            match schema["properties"].get(key) {
                Some(property) => violations(property, root, element, &format!("{at}.{key}"), found),
                None => found.push(format!("{at}: {key} is not in the schema")),
            }
        }
    }
}

fn schema() -> Json {
    let output = Command::new(env!("CARGO_BIN_EXE_gershun")).args(["schema", "norm"]).output().unwrap();
    assert!(output.status.success());
    serde_json::from_slice(&output.stdout).unwrap()
}

fn check(text: &str) -> Vec<String> {
    let value: toml::Value = toml::from_str(text).unwrap();
    let (schema, mut found) = (schema(), Vec::new());
    violations(&schema, &schema, &serde_json::to_value(value).unwrap(), "norm", &mut found);
    found
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
