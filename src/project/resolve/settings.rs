//! Everything of a project that is no geometry: names, norm, light scenes, declarations,
//! accuracy.

use super::draft::{Draft, room_names};
use crate::material::Bsdf;
use crate::norm::{self, Standard};
use crate::project::choices::GoalChoice;
use crate::project::context::Context;
use crate::project::diagnostics::{Diagnostic, suggestion};
use crate::project::schema::{At, File, ModifiedSection, ProjectSection};
use crate::project::{Accuracy, Compare, Declared, Goal, Info, LightScene, Modification, Norm};

/// Languages a report can be written in.
const LANGUAGES: &[&str] = &["en", "ru"];

/// Head of the report.
pub fn info(section: &ProjectSection, context: &mut Context) -> Info {
    let folder = context.folder.file_name().map(|name| name.to_string_lossy().into_owned());
    let mut language = Vec::new();
    for code in section.language.iter().flat_map(At::get_ref) {
        if LANGUAGES.contains(&code.get_ref().as_str()) {
            language.push(code.get_ref().clone());
        } else {
            let message = format!("no report language \"{}\"", code.get_ref());
            context.error(&code.span(), message, "there is: en, ru");
        }
    }
    if language.is_empty() {
        language.push("en".to_owned());
    }
    if let Some(name) = &section.name
        && name.get_ref().trim().is_empty()
    {
        context.error(&name.span(), "the project's name is empty", "");
    }
    Info {
        name: section
            .name
            .as_ref()
            .map(|name| name.get_ref().clone())
            .or(folder)
            .unwrap_or_else(|| "project".to_owned()),
        client: section.client.clone().unwrap_or_default(),
        revision: section.revision.clone().unwrap_or_default(),
        date: section.date.clone().map_or(String::new(), |date| date.0),
        language,
    }
}

/// The norm, bundled or from a file.
pub fn norm(file: &File, context: &mut Context) -> Option<Norm> {
    let section = file.norm.as_ref()?.get_ref();
    let wanted = section.standard.get_ref();
    let bundled = norm::bundled().iter().find(|(id, _)| id == wanted);
    let text = match bundled {
        Some((_, text)) => (*text).to_owned(),
        None if wanted.contains(['/', '\\']) || wanted.to_ascii_lowercase().ends_with(".toml") => {
            context.read_text(&section.standard)?
        }
        None => {
            let hint = suggestion(wanted, norm::bundled().iter().map(|(id, _)| *id));
            let message = format!("no standard \"{wanted}\"");
            context.error(&section.standard.span(), message, &hint);
            return None;
        }
    };
    let standard = match Standard::parse(&text, wanted) {
        Ok(standard) => standard,
        Err(error) => {
            for mistake in error.mistakes {
                context.diagnostics.push(Diagnostic {
                    file: mistake.file,
                    line: mistake.line,
                    column: mistake.column,
                    width: mistake.width,
                    source_line: mistake.source_line,
                    message: mistake.what,
                    hint: mistake.hint,
                });
            }
            return None;
        }
    };
    let compare = section.compare.unwrap_or(match standard.application.comparison {
        norm::Comparison::Exact => Compare::Exact,
        norm::Comparison::Printed => Compare::Printed,
    });
    Some(Norm { standard, row: section.row.as_ref().map(|row| row.get_ref().clone()), compare })
}

/// Every row that is named anywhere must exist.
pub fn check_rows(file: &File, norm: Option<&Norm>, context: &mut Context) {
    let of_norm = file.norm.iter().filter_map(|norm| norm.get_ref().row.as_ref());
    let of_rooms = file.rooms.iter().filter_map(|room| room.get_ref().row.as_ref());
    let of_areas = file.areas.iter().filter_map(|area| area.get_ref().row.as_ref());
    for row in of_norm.chain(of_rooms).chain(of_areas) {
        match norm {
            // A norm that could not be read was reported already.
            None if file.norm.is_some() || file.may_have_lost("norm", "") => {}
            None => {
                let hint = "[norm] standard = \"en-12464-1-2021\"";
                context.error(&row.span(), "a row needs a norm", hint);
            }
            Some(norm) if norm.standard.row(row.get_ref()).is_some() => {}
            Some(norm) => {
                let rows = norm.standard.rows.iter().map(|row| row.reference.as_str());
                let hint = suggestion(row.get_ref(), rows);
                let message = format!("{} has no row \"{}\"", norm.standard.id, row.get_ref());
                context.error(&row.span(), message, &hint);
            }
        }
    }
}

/// Modified illuminances of rooms must be possible.
pub fn check_modified(file: &File, norm: Option<&Norm>, context: &mut Context) {
    for room in &file.rooms {
        if let Some(modified) = &room.get_ref().modified {
            modification(modified, room.get_ref().row.as_ref().map(At::get_ref), file, norm, context);
        }
    }
}

/// A modified illuminance; it needs a reason, a row, and a value to go to.
pub fn modification(
    modified: &At<ModifiedSection>,
    row: Option<&String>,
    file: &File,
    norm: Option<&Norm>,
    context: &mut Context,
) -> Option<Modification> {
    let reason = &modified.get_ref().reason;
    if reason.get_ref().trim().is_empty() {
        let hint = "reason = \"visual tasks are critical\"";
        context.error(&reason.span(), "a modified illuminance needs its reason", hint);
    }
    let span = modified.get_ref().steps.as_ref().map_or(modified.span(), At::span);
    let Some(norm) = norm else {
        if file.norm.is_none() && !file.may_have_lost("norm", "") {
            let hint = "[norm] standard = \"en-12464-1-2021\"";
            context.error(&modified.span(), "a modified illuminance needs a norm", hint);
        }
        return None;
    };
    let Some(row) = row.or(norm.row.as_ref()) else {
        let message = "a modified illuminance needs a row to modify";
        context.error(&modified.span(), message, "give the room or the area a row");
        return None;
    };
    // A row that does not exist was reported already.
    let row = norm.standard.row(row)?;
    let steps = modified.get_ref().steps.as_ref().map(|steps| *steps.get_ref());
    if let Err(why) = norm.standard.modified_illuminance(row, steps) {
        context.error(&span, format!("no modified illuminance: {why}"), "");
        return None;
    }
    Some(Modification { steps, reason: reason.get_ref().trim().to_owned() })
}

/// Light scenes; emitting materials are groups too, by their names.
pub fn light_scenes(file: &File, drafts: &[Draft], context: &mut Context) -> Vec<LightScene> {
    if !file.has_light_scenes {
        return vec![LightScene { name: "all".to_owned(), factors: None }];
    }
    let luminaires = drafts.iter().flat_map(|draft| &draft.luminaires);
    let materials = drafts.iter().flat_map(|draft| &draft.materials);
    let emitters = materials.filter(|m| matches!(m.bsdf, Bsdf::Emitter { .. }));
    let mut groups: Vec<&str> = luminaires
        .map(|luminaire| luminaire.group.as_str())
        .chain(emitters.map(|material| material.name.as_str()))
        .collect();
    groups.sort_unstable();
    groups.dedup();
    // After a mistake in the places not all groups are known, and unknown ones prove nothing.
    let complete = context.diagnostics.is_empty();
    let mut scenes = Vec::new();
    for (name, factors) in &file.light_scenes {
        let mut checked = Vec::new();
        for (group, factor) in factors {
            if complete && !groups.contains(&group.get_ref().as_str()) {
                let hint = suggestion(group.get_ref(), groups.iter().copied());
                let message = format!("no luminaire group \"{}\"", group.get_ref());
                context.error(&group.span(), message, &hint);
            }
            check_factor(factor, context);
            checked.push((group.get_ref().clone(), *factor.get_ref()));
        }
        scenes.push(LightScene { name: name.get_ref().clone(), factors: Some(checked) });
    }
    if scenes.is_empty() {
        let hint = "leave the section out for one scene with everything on";
        context.error(&(0..0), "[light_scenes] lists no scene", hint);
    }
    scenes
}

/// A factor of a light scene dims and nothing else, like `dim`.
fn check_factor(factor: &At<f64>, context: &mut Context) {
    let value = *factor.get_ref();
    if !(0.0..=1.0).contains(&value) {
        let message = format!("a factor of a light scene must lie in 0 … 1, found {value}");
        let hint = if value > 1.0 && value <= 100.0 {
            format!("{value} % is {}; the flux of a luminaire is its own key `flux`", value / 100.0)
        } else {
            "a group at full output is 1, one that is off 0".to_owned()
        };
        context.error(&factor.span(), message, &hint);
    }
}

/// `[declared]`, per luminaire type or room.
pub fn declared(file: &File, drafts: &[Draft], context: &mut Context) -> Vec<Declared> {
    let mut declared = Vec::new();
    for (name, section) in &file.declared {
        let section = section.get_ref();
        let mut known: Vec<&str> = file.luminaires.iter().map(|(n, _)| n.get_ref().as_str()).collect();
        known.extend(file.lost_names("luminaires").map(|name| name.get_ref().as_str()));
        known.extend(room_names(drafts));
        if !known.contains(&name.get_ref().as_str()) && !drafts.is_empty() {
            let hint = suggestion(name.get_ref(), known);
            let message = format!("no luminaire or room \"{}\"", name.get_ref());
            context.error(&name.span(), message, &hint);
        }
        let mut number = |value: Option<&At<f64>>, high: f64, what: &str| {
            let value = value?;
            context.in_range(value, 0.0, high, what).then_some(*value.get_ref())
        };
        let flicker = section.flicker.as_ref();
        declared.push(Declared {
            subject: name.get_ref().clone(),
            ra: number(section.ra.as_ref(), 100.0, "ra"),
            cct_k: number(section.cct.as_ref(), 100_000.0, "cct"),
            pst_lm: number(flicker.and_then(|f| f.pst_lm.as_ref()), f64::INFINITY, "pst_lm"),
            svm: number(flicker.and_then(|f| f.svm.as_ref()), f64::INFINITY, "svm"),
            pulsation_percent: number(flicker.and_then(|f| f.pulsation.as_ref()), 100.0, "pulsation"),
        });
    }
    declared
}

/// Goal, confidence, seed. Without anything to judge, the goal is a relative error of 0.5 %.
pub fn accuracy(file: &File, context: &mut Context) -> Accuracy {
    let section = &file.accuracy;
    let judged = file.norm.is_some() || !file.requirements.is_empty();
    let goal = match section.goal.as_ref().map(|goal| (goal.get_ref(), goal.span())) {
        None if judged => Goal::Verdict,
        None => Goal::Relative(0.005),
        Some((GoalChoice::Verdict, span)) => {
            if !judged {
                let hint = "add [norm] or [[require]], or goal = { relative = 0.01 }";
                context.error(&span, "there is nothing to judge", hint);
            }
            Goal::Verdict
        }
        Some((GoalChoice::Relative(relative), span)) => {
            if !(*relative > 0.0 && *relative < 1.0) {
                let message = format!("relative must lie between 0 and 1, found {relative}");
                context.error(&span, message, "1 % is 0.01");
            }
            Goal::Relative(*relative)
        }
        Some((GoalChoice::Time(seconds), _)) => Goal::Seconds(*seconds),
    };
    let confidence = section.confidence.as_ref().map_or(0.95, |confidence| {
        let value = *confidence.get_ref();
        if !(0.5..1.0).contains(&value) {
            let message = format!("confidence must lie in 0.5 … 1, found {value}");
            context.error(&confidence.span(), message, "95 % is 0.95");
        }
        value
    });
    Accuracy { goal, confidence, seed: section.seed.unwrap_or(1) }
}
