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
            "materials" => file.materials = named(value, context),
            "luminaires" => file.luminaires = named(value, context),
            "room" => {
                let count = value.get_ref().as_array().map_or(1, |rooms| rooms.len());
                file.rooms = list(value, &span, context);
                file.rooms_lost |= file.rooms.len() < count;
            }
            "furniture" => file.furniture = list(value, &span, context),
            "place" => file.places = list(value, &span, context),
            "light_scenes" => {
                file.has_light_scenes = true;
                file.light_scenes = light_scenes(value, context);
            }
            "area" => file.areas = list(value, &span, context),
            "viewpoint" => file.viewpoints = list(value, &span, context),
            "lists" => file.lists = spanned(value, context),
            "glare_map" => file.glare_maps = list(value, &span, context),
            "camera" => file.cameras = list(value, &span, context),
            "norm" => file.norm = spanned(value, context),
            "require" => file.requirements = list(value, &span, context),
            "declared" => file.declared = named(value, context),
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
    loop {
        let error = match T::deserialize(value.clone().into_deserializer()) {
            Ok(read) => return Some(read),
            Err(error) => error,
        };
        let place = error.span().unwrap_or(span.clone());
        let (message, hint) = explain(error.message());
        context.error(&place, message, &hint);
        let unknown = error.message().starts_with("unknown field");
        if !unknown || !remove_key(value.get_mut(), &place) {
            return None;
        }
    }
}

fn spanned<T: DeserializeOwned>(value: Value<'_>, context: &mut Context) -> Option<At<T>> {
    let span = value.span();
    table(value, context).map(|read| Spanned::new(span, read))
}

fn named<T: DeserializeOwned>(value: Value<'_>, context: &mut Context) -> Vec<Named<T>> {
    entries(value, context)
        .into_iter()
        .filter_map(|(name, value)| Some((name, spanned(value, context)?)))
        .collect()
}

fn list<T: DeserializeOwned>(value: Value<'_>, key: &Range<usize>, context: &mut Context) -> Vec<At<T>> {
    match value.into_inner() {
        DeValue::Array(items) => items.into_iter().filter_map(|item| spanned(item, context)).collect(),
        DeValue::Table(_) => {
            let message = "this section is a list".to_owned();
            context.error(key, message, "write it with double brackets: [[…]]");
            Vec::new()
        }
        other => {
            let message = format!("expected a list of tables, found {}", other.type_str());
            context.error(key, message, "");
            Vec::new()
        }
    }
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
    (message, String::new())
}
