//! TOML text → [`File`], collecting every mistake: each table is deserialized on its own, and an
//! unknown key is reported, taken out, and the table read again.

use std::ops::Range;

use serde::de::{DeserializeOwned, IntoDeserializer};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::context::Context;
use super::diagnostics::suggestion;
use super::schema::{At, File, LightSceneEntry, Named};

type Value<'i> = Spanned<DeValue<'i>>;
/// Section and name of an entry that could not be read.
type Lost = (&'static str, Option<At<String>>);

/// Top-level tables.
const SECTIONS: &[&str] = &[
    "project",
    "scene",
    "materials",
    "luminaires",
    "room",
    "furniture",
    "place",
    "light_scenes",
    "area",
    "viewpoint",
    "lists",
    "glare_map",
    "camera",
    "norm",
    "require",
    "declared",
    "accuracy",
];

/// Parses the project file; what could not be read is left out and reported.
pub fn read(text: &str, context: &mut Context) -> File {
    let mut file = File::default();
    let (document, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        for error in errors {
            let span = error.span().unwrap_or_default();
            context.error(&span, error.message().trim().to_owned(), "");
        }
        file.rooms_lost = true;
        return file;
    }
    for (key, value) in document.into_inner() {
        let span = key.span();
        match key.get_ref().as_ref() {
            "project" => file.project = table(value, context).unwrap_or_default(),
            "scene" => {
                file.scene = spanned(value, context);
                file.rooms_lost |= file.scene.is_none();
            }
            "materials" => file.materials = named("materials", value, &mut file.lost, context),
            "luminaires" => file.luminaires = named("luminaires", value, &mut file.lost, context),
            "room" => {
                let count = value.get_ref().as_array().map_or(1, |rooms| rooms.len());
                file.rooms = list("room", value, &span, &mut file.lost, context);
                file.rooms_lost |= file.rooms.len() < count;
            }
            "furniture" => file.furniture = list("furniture", value, &span, &mut file.lost, context),
            "place" => file.places = list("place", value, &span, &mut file.lost, context),
            "light_scenes" => {
                file.has_light_scenes = true;
                file.light_scenes = light_scenes(value, context);
            }
            "area" => file.areas = list("area", value, &span, &mut file.lost, context),
            "viewpoint" => file.viewpoints = list("viewpoint", value, &span, &mut file.lost, context),
            "lists" => file.lists = spanned(value, context),
            "glare_map" => file.glare_maps = list("glare_map", value, &span, &mut file.lost, context),
            "camera" => file.cameras = list("camera", value, &span, &mut file.lost, context),
            "norm" => {
                file.norm = spanned(value, context);
                if file.norm.is_none() {
                    file.lost.push(("norm", None));
                }
            }
            "require" => file.requirements = list("require", value, &span, &mut file.lost, context),
            "declared" => file.declared = named("declared", value, &mut file.lost, context),
            "accuracy" => file.accuracy = table(value, context).unwrap_or_default(),
            other => {
                let hint = suggestion(other, SECTIONS.iter().copied());
                context.error(&span, format!("unknown section \"{other}\""), &hint);
            }
        }
    }
    file
}

/// Reads one table, reporting all its unknown keys and at most one other mistake.
fn table<T: DeserializeOwned>(mut value: Value<'_>, context: &mut Context) -> Option<T> {
    let span = value.span();
    let mut meant: Vec<String> = Vec::new();
    loop {
        let error = match T::deserialize(value.clone().into_deserializer()) {
            Ok(read) => return Some(read),
            Err(error) => error,
        };
        let place = error.span().unwrap_or(span.clone());
        let (message, hint) = explain(error.message());
        // A key that was misspelt is missing too; once is enough.
        let missing = error.message().strip_prefix("missing field `").and_then(|rest| rest.split('`').next());
        if missing.is_some_and(|key| meant.contains(&format!("did you mean \"{key}\"?"))) {
            return None;
        }
        context.error(&place, message, &hint);
        meant.push(hint);
        let unknown = error.message().starts_with("unknown field");
        if unknown {
            context.misspelt.push(span.clone());
        }
        if !unknown || !remove_key(value.get_mut(), &place) {
            return None;
        }
    }
}

fn spanned<T: DeserializeOwned>(value: Value<'_>, context: &mut Context) -> Option<At<T>> {
    let span = value.span();
    table(value, context).map(|read| Spanned::new(span, read))
}

fn named<T: DeserializeOwned>(
    section: &'static str,
    value: Value<'_>,
    lost: &mut Vec<Lost>,
    context: &mut Context,
) -> Vec<Named<T>> {
    let mut read = Vec::new();
    for (name, value) in entries(value, context) {
        match spanned(value, context) {
            Some(entry) => read.push((name, entry)),
            None => lost.push((section, Some(name))),
        }
    }
    read
}

fn list<T: DeserializeOwned>(
    section: &'static str,
    value: Value<'_>,
    key: &Range<usize>,
    lost: &mut Vec<Lost>,
    context: &mut Context,
) -> Vec<At<T>> {
    let items = match value.into_inner() {
        DeValue::Array(items) => items,
        DeValue::Table(_) => {
            let message = "this section is a list".to_owned();
            context.error(key, message, "write it with double brackets: [[…]]");
            lost.push((section, None));
            return Vec::new();
        }
        other => {
            let message = format!("expected a list of tables, found {}", other.type_str());
            context.error(key, message, "");
            lost.push((section, None));
            return Vec::new();
        }
    };
    let mut read = Vec::new();
    for item in items {
        let name = name_of(&item);
        match spanned(item, context) {
            Some(entry) => read.push(entry),
            None => lost.push((section, name)),
        }
    }
    read
}

/// The name under which an entry of a list would be known.
fn name_of(item: &Value<'_>) -> Option<At<String>> {
    let name = item.get_ref().as_table()?.get("name")?;
    Some(Spanned::new(name.span(), name.get_ref().as_str()?.to_owned()))
}

fn light_scenes(value: Value<'_>, context: &mut Context) -> Vec<LightSceneEntry> {
    let mut scenes = Vec::new();
    for (name, groups) in entries(value, context) {
        let factors = entries(groups, context)
            .into_iter()
            .filter_map(|(group, factor)| Some((group, spanned::<f64>(factor, context)?)))
            .collect();
        scenes.push((name, factors));
    }
    scenes
}

fn entries<'i>(value: Value<'i>, context: &mut Context) -> Vec<(At<String>, Value<'i>)> {
    let span = value.span();
    match value.into_inner() {
        DeValue::Table(entries) => entries
            .into_iter()
            .map(|(key, value)| {
                let name = key.get_ref().to_string();
                (Spanned::new(key.span(), name), value)
            })
            .collect(),
        other => {
            let message = format!("expected a table, found {}", other.type_str());
            context.error(&span, message, "");
            Vec::new()
        }
    }
}

/// Takes the key at `place` out of a table or of the tables within it.
fn remove_key(value: &mut DeValue<'_>, place: &Range<usize>) -> bool {
    match value {
        DeValue::Table(table) => {
            let found = table.keys().find(|key| key.span() == *place).cloned();
            if let Some(key) = found {
                table.remove(&key);
                return true;
            }
            table.iter_mut().any(|(_, inner)| remove_key(inner.get_mut(), place))
        }
        DeValue::Array(items) => items.iter_mut().any(|inner| remove_key(inner.get_mut(), place)),
        DeValue::String(_)
        | DeValue::Integer(_)
        | DeValue::Float(_)
        | DeValue::Boolean(_)
        | DeValue::Datetime(_) => false,
    }
}

/// Puts serde's words into a user's: message and hint.
fn explain(message: &str) -> (String, String) {
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    if let (Some(rest), [wrong, known @ ..]) = (message.strip_prefix("unknown "), &quoted[..]) {
        let what = if rest.starts_with("field") { "key" } else { "value" };
        let hint = suggestion(wrong, known.iter().copied());
        return (format!("unknown {what} \"{wrong}\""), hint);
    }
    if let (true, [missing, ..]) = (message.starts_with("missing field"), &quoted[..]) {
        return (format!("the key \"{missing}\" is missing"), String::new());
    }
    // "expected struct RoomSection" is our word, not the user's.
    let message = match message.split_once("expected struct ") {
        Some((found, _)) => format!("{found}expected a table {{ … }}"),
        None => message.trim().to_owned(),
    };
    let number = message.contains("floating point") || message.contains("integer");
    let hint = match quoted[..] {
        [number_text, ..] if number && message.ends_with("expected a string") => {
            format!("write it in quotes: \"{number_text}\"")
        }
        _ => String::new(),
    };
    (message, hint)
}
