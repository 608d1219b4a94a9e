//! `[[require]]` → requirements beyond the norm's: what they limit, where, and whether that can be decided.

use super::areas::light_scene_index;
use super::draft::{Draft, room_named, room_names};
use crate::glare::index;
use crate::project::context::Context;
use crate::project::diagnostics::suggestion;
use crate::project::schema::{At, File, RequireSection};
use crate::project::{CustomRequirement, CustomSubject, Instead, LightScene};
use crate::quantity::{Quantity, SPELLINGS, Statistic};

/// Keys of [`Statistic`].
const STATISTICS: &[&str] = &["mean", "min", "max", "U0", "Ud", "mean/task", "value"];

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
            if !bound.get_ref().is_finite() {
                let message = format!("a limit must be a finite number, found {}", bound.get_ref());
                context.error(&bound.span(), message, "leave out what has no limit");
            }
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
            instead: instead(section, file, context),
        });
    }
}

/// Why a requirement holds instead of the norm's.
fn instead(section: &RequireSection, file: &File, context: &mut Context) -> Option<Instead> {
    let reason = section.instead.as_ref()?;
    if reason.get_ref().trim().is_empty() {
        let hint = "instead = \"agreed with the client on 3 May\": it stands in the report";
        context.error(&reason.span(), "a limit of the norm is set aside without a reason", hint);
    } else if file.norm.is_none() {
        let hint = "leave `instead` out, or name a norm: [norm] standard = \"…\"";
        context.error(&reason.span(), "there is no norm whose limit could be set aside", hint);
    }
    Some(Instead { reason: reason.get_ref().trim().to_owned(), written: context.place(&reason.span()) })
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
        CustomSubject::Room(_)
            if of_view && matches!(quantity, Quantity::OfView { .. } | Quantity::NotComputed(_)) =>
        {
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
