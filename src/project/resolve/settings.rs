//! Everything of a project that is no geometry: names, norm, light scenes, requirements,
//! declarations, accuracy.

use super::areas::light_scene_index;
use super::draft::{Draft, room_named, room_names};
use crate::glare::index;
use crate::material::Bsdf;
use crate::norm::{self, Standard};
use crate::project::choices::GoalChoice;
use crate::project::context::Context;
use crate::project::diagnostics::{Diagnostic, suggestion};
use crate::project::schema::{At, File, ModifiedSection, ProjectSection, RequireSection};
use crate::project::{
    Accuracy, Compare, CustomRequirement, CustomSubject, Declared, Goal, Info, LightScene, Modification, Norm,
};
use crate::quantity::{Quantity, SPELLINGS, Statistic};

/// Languages a report can be written in.
const LANGUAGES: &[&str] = &["en", "ru"];
/// Keys of [`Statistic`].
const STATISTICS: &[&str] = &["mean", "min", "max", "U0", "Ud", "mean/task", "value"];

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
            context.in_range(factor, 0.0, f64::INFINITY, "a factor");
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

/// `[[require]]` → requirements of the worlds they concern.
pub fn requirements(file: &File, drafts: &mut [Draft], light_scenes: &[LightScene], context: &mut Context) {
    for section in &file.requirements {
        let span = section.span();
        let section = section.get_ref();
        let light_scene = light_scene_index(section.light_scene.as_ref(), light_scenes, context);
        let quantity = required_quantity(section, context);
        let statistic = section.statistic.as_ref().map(|key| {
            let statistic = Statistic::parse(key.get_ref());
            if statistic.is_none() {
                let hint = suggestion(key.get_ref(), STATISTICS.iter().copied());
                let message = format!("unknown statistic \"{}\"", key.get_ref());
                context.error(&key.span(), message, &hint);
            }
            statistic
        });
        let bounds = [&section.min, &section.max];
        for bound in bounds.into_iter().flatten() {
            context.finite(&[*bound.get_ref()], &bound.span());
        }
        if bounds.into_iter().all(Option::is_none) {
            context.missing(&span, "a requirement needs `min` or `max`", "");
        }
        let subject = subject(section, &span, file, drafts, context);
        let (Some((world, subject)), Some(quantity)) = (subject, quantity) else {
            continue;
        };
        if !suits(subject, quantity, &section.quantity, context) {
            continue;
        }
        let quantity = match (subject, index::parse(section.quantity.get_ref())) {
            (CustomSubject::Viewpoint(_), Some(of_view)) if quantity != Quantity::Ugr => {
                Quantity::OfView { key: of_view.key, unit: of_view.unit }
            }
            _ => quantity,
        };
        let statistic = statistic.unwrap_or(Some(match (subject, quantity) {
            (CustomSubject::Viewpoint(_), _) => Statistic::Value,
            (_, quantity) if quantity.is_single() => Statistic::Value,
            (CustomSubject::Room(_) | CustomSubject::Area(_), _) => Statistic::Mean,
        }));
        let Some(statistic) = statistic else { continue };
        let single = quantity.is_single();
        if let (Some(key), true) = (&section.statistic, single != (statistic == Statistic::Value)) {
            let message = format!("no statistic \"{}\" of {}", key.get_ref(), section.quantity.get_ref());
            let hint = if single { "leave it out" } else { "there is: mean, min, max, U0, Ud, mean/task" };
            context.error(&key.span(), message, hint);
            continue;
        }
        drafts[world].requirements.push(CustomRequirement {
            subject,
            quantity,
            statistic,
            min: section.min.as_ref().map(|min| *min.get_ref()),
            max: section.max.as_ref().map(|max| *max.get_ref()),
            light_scene,
        });
    }
}

/// The quantity that a requirement names; of a viewpoint also a row of the table of indices.
fn required_quantity(section: &RequireSection, context: &mut Context) -> Option<Quantity> {
    let name = section.quantity.get_ref();
    let of_view = index::parse(name).map(|row| Quantity::OfView { key: row.key, unit: row.unit });
    let quantity = Quantity::parse(name).or(of_view);
    if quantity.is_none() {
        let message = format!("unknown quantity \"{name}\"");
        let hint = if section.viewpoint.is_some() {
            suggestion(name, indices_of_views())
        } else {
            suggestion(name, SPELLINGS.iter().copied())
        };
        context.error(&section.quantity.span(), message, &hint);
    }
    quantity
}

/// Keys of all that can be required of a viewpoint.
fn indices_of_views() -> impl Iterator<Item = &'static str> {
    index::INDICES.iter().map(|row| row.key)
}

/// Whether a quantity exists where it is required: what nothing could ever decide is a mistake, not
/// a requirement that is left unassessed.
fn suits(subject: CustomSubject, quantity: Quantity, name: &At<String>, context: &mut Context) -> bool {
    let single = quantity.is_single();
    let of_view = index::parse(name.get_ref()).is_some();
    let of_views = || format!("a viewpoint has {}", indices_of_views().collect::<Vec<_>>().join(", "));
    let (what, hint) = match subject {
        CustomSubject::Room(_) if matches!(quantity, Quantity::OfView { .. }) => {
            ("a room", "it is one of a view: name a viewpoint, viewpoint = \"…\"".to_owned())
        }
        CustomSubject::Room(_) if !single => {
            ("a room", "it is measured on areas: name one, area = \"…\"".to_owned())
        }
        CustomSubject::Area(_) if of_view => {
            ("an area", "it is one of a view: name a viewpoint, viewpoint = \"…\"".to_owned())
        }
        CustomSubject::Area(_) if single => ("an area", "require it of a room".to_owned()),
        CustomSubject::Viewpoint(_) if !of_view => ("a viewpoint", of_views()),
        CustomSubject::Room(_) | CustomSubject::Area(_) | CustomSubject::Viewpoint(_) => return true,
    };
    context.error(&name.span(), format!("{} is no quantity of {what}", name.get_ref()), &hint);
    false
}

fn subject(
    section: &RequireSection,
    span: &std::ops::Range<usize>,
    file: &File,
    drafts: &[Draft],
    context: &mut Context,
) -> Option<(usize, CustomSubject)> {
    let (what, name, known, found) = match (&section.room, &section.area, &section.viewpoint) {
        (Some(name), None, None) => {
            let found =
                room_named(drafts, name.get_ref()).map(|(world, index)| (world, CustomSubject::Room(index)));
            ("room", name, room_names(drafts), found)
        }
        (None, Some(name), None) => {
            let list = |draft: &'_ Draft| draft.areas.iter().map(|a| a.name.clone()).collect();
            let found = find(drafts, name.get_ref(), &list);
            let known = drafts.iter().flat_map(|draft| &draft.areas);
            let known = known.map(|area| area.name.as_str()).collect();
            let found = found.map(|(world, index)| (world, CustomSubject::Area(index)));
            ("area", name, known, found)
        }
        (None, None, Some(name)) => {
            let list = |draft: &'_ Draft| draft.viewpoints.iter().map(|v| v.name.clone()).collect();
            let found = find(drafts, name.get_ref(), &list);
            let known = drafts.iter().flat_map(|draft| &draft.viewpoints);
            let known = known.map(|view| view.name.as_str()).collect();
            let found = found.map(|(world, index)| (world, CustomSubject::Viewpoint(index)));
            ("viewpoint", name, known, found)
        }
        _ => {
            let message = "a requirement concerns exactly one of room, area, viewpoint";
            context.missing(span, message, "");
            return None;
        }
    };
    // What was written but has a mistake of its own is not unknown.
    let areas = file.areas.iter().map(|area| &area.get_ref().name);
    let views = file.viewpoints.iter().map(|view| &view.get_ref().name);
    let written = areas.chain(views).any(|known| known.get_ref() == name.get_ref())
        || file.may_have_lost(what, name.get_ref());
    if found.is_none() && !written && !drafts.is_empty() {
        let hint = suggestion(name.get_ref(), known);
        context.error(&name.span(), format!("no {what} \"{}\"", name.get_ref()), &hint);
    }
    found
}

fn find(drafts: &[Draft], name: &str, list: &dyn Fn(&Draft) -> Vec<String>) -> Option<(usize, usize)> {
    drafts.iter().enumerate().find_map(|(world, draft)| {
        let index = list(draft).iter().position(|known| known == name)?;
        Some((world, index))
    })
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
