//! The part of JSON Schema that our schemas use.

use serde_json::Value as Json;

/// What of `value`, called `name`, violates the schema. Panics on a word of the schema that it does not know.
pub fn violations(schema: &Json, value: &Json, name: &str) -> Vec<String> {
    let mut found = Vec::new();
    collect(schema, schema, value, name, &mut found);
    found
}

fn collect(schema: &Json, root: &Json, value: &Json, at: &str, found: &mut Vec<String>) {
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
    for word in schema.as_object().expect("a schema in the form that ours have").keys() {
        assert!(KNOWN.contains(&word.as_str()), "{at}: the check does not know {word}");
    }
    if let Some(target) = schema["$ref"].as_str() {
        return collect(
            &root["$defs"][target.strip_prefix("#/$defs/").expect("a schema in the form that ours have")],
            root,
            value,
            at,
            found,
        );
    }
    let types: Vec<&str> = match &schema["type"] {
        Json::String(one) => vec![one],
        Json::Array(some) => some.iter().filter_map(Json::as_str).collect(),
        _ => panic!("{at}: a schema without type"),
    };
    let is = |kind: &&str| match *kind {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("{at}: {other}"),
    };
    if !types.iter().any(is) {
        found.push(format!("{at}: {value} is no {}", types.join(" or ")));
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
            collect(items, root, element, &format!("{at}[{index}]"), found);
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
                Some(property) => collect(property, root, element, &format!("{at}.{key}"), found),
                None => found.push(format!("{at}: {key} is not in the schema")),
            }
        }
    }
}
