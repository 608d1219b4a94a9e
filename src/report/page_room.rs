//! The chapter of one room: what it is, what hangs in it, and what was found there.

use super::markup::{grid, pairs, subheading, symbol};
use super::number;
use super::page_glare::{observers, span, ugr_table};
use super::plan::{Subject, grid_facts, statistic_of};
use super::words::{self, Lang, Term, phrase, word};
use super::xml::{escape, put};
use crate::outcome::{FluxBalance, Interval, Outcome, RoomOutcome, TypeOutcome};
use crate::quantity::Statistic;

/// A room's chapter; `drawings` are SVG elements.
pub fn room(outcome: &Outcome, room: &RoomOutcome, lang: Lang, drawings: &[String]) -> String {
    let mut html = format!("<h2>{} {}</h2>\n", escape(&room.number), escape(&room.name));
    html.push_str(&geometry(room, lang));
    if !room.types.is_empty() {
        html.push_str(&subheading(lang, Term::LuminaireSchedule));
        html.push_str(&schedule(&room.types, lang));
    }
    if !room.areas.is_empty() {
        html.push_str(&subheading(lang, Term::Areas));
        html.push_str(&areas(outcome, room, lang));
    }
    for drawing in drawings {
        put(&mut html, format_args!("<figure>{drawing}</figure>\n"));
    }
    if !room.ugr_table.is_empty() {
        html.push_str(&subheading(lang, Term::UgrTable));
        html.push_str(&ugr_table(&room.ugr_table, lang));
    }
    if !room.viewpoints.is_empty() {
        html.push_str(&subheading(lang, Term::Observers));
        html.push_str(&observers(&room.viewpoints, lang));
    }
    if !room.flux.is_empty() {
        html.push_str(&subheading(lang, Term::FluxBalance));
        for balance in &room.flux {
            html.push_str(&flux(balance, lang));
        }
    }
    html
}

fn geometry(room: &RoomOutcome, lang: Lang) -> String {
    let corners = room.footprint.len();
    let area_m2 = (0..corners)
        .map(|i| room.footprint[i].perp_dot(room.footprint[(i + 1) % corners]))
        .sum::<f64>()
        .abs()
        / 2.0;
    let density = room.power.as_ref().map_or(String::new(), |power| {
        let unit = word(lang, Term::UnitPowerDensity);
        let own = format!("{} {unit}", number::fixed(lang, power.density_w_m2, 2));
        let by_light = power.density_w_m2_100lx.map(|density| number::fixed(lang, density, 2));
        by_light.map_or(own.clone(), |per| {
            format!("{own}; {}", phrase(lang, Term::PowerPerLight, &[&per, &escape(&power.light_scene)]))
        })
    });
    let dimming = room.dimming.as_ref().map_or(String::new(), |dimming| {
        let term = match (dimming.factor <= 1.0, dimming.others_pass) {
            (true, true) => Term::DimTo,
            (true, false) => Term::DimToBut,
            (false, _) => Term::FluxMissing,
        };
        let factor = number::figures(lang, dimming.factor, 3);
        phrase(lang, term, &[&factor, &escape(&words::place_name(lang, &dimming.subject))])
    });
    let by_group = room.dimming.as_ref().and_then(|dimming| dimming.groups.as_ref());
    let by_group = by_group.map_or(String::new(), |groups| {
        let each = groups
            .groups
            .iter()
            .map(|own| format!("{} {}", escape(&own.group), number::figures(lang, own.factor, 3)));
        let term = if groups.of == "power" { Term::DimGroupsPower } else { Term::DimGroupsFlux };
        phrase(lang, term, &[&each.collect::<Vec<_>>().join(", "), &number::percent(lang, groups.share)])
    });
    let metres = |length| format!("{} {}", number::metres(lang, length), word(lang, Term::UnitMetre));
    let [ceiling, walls, floor] = room.reflectances.map(|reflectance| number::fixed(lang, reflectance, 2));
    pairs(&[
        (
            word(lang, Term::FloorArea),
            format!("{} {}", number::fixed(lang, area_m2, 2), word(lang, Term::UnitSquareMetre)),
        ),
        (word(lang, Term::ClearHeight), metres(room.height_m)),
        (word(lang, Term::FloorLevel), metres(room.floor_m)),
        (word(lang, Term::Reflectances), format!("{ceiling} / {walls} / {floor}")),
        (word(lang, Term::RowOfNorm), room.row.as_deref().map_or(String::new(), escape)),
        (word(lang, Term::PowerDensity), density),
        (word(lang, Term::Dimming), dimming),
        (word(lang, Term::DimGroups), by_group),
    ])
}

/// Letters of a type's name that fit beside the other columns of the schedule.
const LONG_NAME: usize = 12;

fn schedule(types: &[TypeOutcome], lang: Lang) -> String {
    let dash = || "—".to_owned();
    let row = |kind: &TypeOutcome| {
        let rated = kind.rated_flux_lm.filter(|rated| *rated > 0.0);
        let rated = rated.map_or_else(dash, |rated| {
            let ratio = number::fixed(lang, kind.flux_lm / rated, 3);
            format!("{}{}", number::fixed(lang, rated, 0), below(&ratio))
        });
        vec![
            format!("<b>{}</b>", escape(&kind.name)),
            format!(
                "{}{}",
                escape(&words::description(lang, &kind.description, &kind.file)),
                below(&escape(&kind.file))
            ),
            kind.count.to_string(),
            number::fixed(lang, kind.flux_lm, 0),
            rated,
            kind.power_w.map_or_else(dash, |power| number::fixed(lang, power, 1)),
            maintenance(lang, kind),
        ]
    };
    let mut rows: Vec<Vec<String>> = types.iter().map(row).collect();
    if types.len() > 1 {
        let count: usize = types.iter().map(|kind| kind.count).sum();
        let flux_lm: f64 = types.iter().map(|kind| kind.flux_lm * kind.count as f64).sum();
        let power_w: Option<f64> =
            types.iter().map(|kind| kind.power_w.map(|power| power * kind.count as f64)).sum();
        rows.push(vec![
            word(lang, Term::Total).to_owned(),
            String::new(),
            count.to_string(),
            number::fixed(lang, flux_lm, 0),
            String::new(),
            power_w.map_or_else(dash, |power| number::fixed(lang, power, 1)),
            String::new(),
        ]);
    }
    let rated = format!("{}{}", word(lang, Term::FluxRated), below(word(lang, Term::FluxRatio)));
    let factor =
        format!("{}{}", word(lang, Term::MaintenanceFactor), below(word(lang, Term::MaintenanceSplit)));
    let head = [
        word(lang, Term::TypeWord),
        word(lang, Term::Description),
        word(lang, Term::CountWord),
        word(lang, Term::FluxUsed),
        &rated,
        word(lang, Term::Power),
        &factor,
    ];
    // A short name stays on its line, a long one must not push the numbers off the page.
    let long = types.iter().any(|kind| kind.name.chars().count() > LONG_NAME);
    grid(if long { "aarrrrr" } else { "warrrrr" }, &head, &rows)
}

/// A second, smaller line in a cell.
fn below(html: &str) -> String {
    format!("<br/><span class=\"note\">{html}</span>")
}

/// MF and its factors; in Russian with the reserve factor beside them.
fn maintenance(lang: Lang, kind: &TypeOutcome) -> String {
    let factor = kind.maintenance_factor;
    let split = kind.maintenance.map(|factor| number::fixed(lang, factor, 2)).join("·");
    let reserve = match lang {
        Lang::Ru if factor > 0.0 => format!(" (Кз = {})", number::fixed(lang, 1.0 / factor, 2)),
        Lang::En | Lang::Ru => String::new(),
    };
    format!("{}{reserve}{}", number::fixed(lang, factor, 2), below(&split))
}

fn areas(outcome: &Outcome, room: &RoomOutcome, lang: Lang) -> String {
    let mut rows = Vec::new();
    // What all values have in common is said once, below the table.
    let mut states: Vec<String> = Vec::new();
    for field in room.areas.iter().flat_map(|area| &area.fields) {
        let state = words::condition(lang, field.condition);
        if !states.iter().any(|known| *known == state) {
            states.push(state.to_string());
        }
    }
    for area in &room.areas {
        let of =
            area.of.as_ref().map_or(String::new(), |of| format!(" {} {}", word(lang, Term::Of), escape(of)));
        let excluded = area.grid.points.iter().filter(|point| point.excluded.is_some()).count();
        let mut facts = grid_facts(lang, area);
        if area.grid.border_m > 0.0 {
            put(
                &mut facts,
                format_args!(
                    ", {} {} {}",
                    word(lang, Term::Border),
                    number::metres(lang, area.grid.border_m),
                    word(lang, Term::UnitMetre)
                ),
            );
        }
        if excluded > 0 {
            put(&mut facts, format_args!("; {}", phrase(lang, Term::Excluded, &[&excluded.to_string()])));
        }
        let name = format!(
            "{}<br/><span class=\"note\">{}{of}<br/>{facts}</span>",
            escape(&words::place_name(lang, &area.name)),
            words::area_kind(lang, area.kind)
        );
        for (index, field) in area.fields.iter().enumerate() {
            let subject = Subject { outcome, room, area, field };
            let text = |statistic| {
                statistic_of(subject, statistic)
                    .map_or("—".to_owned(), |value| number::value(lang, field.quantity, statistic, value))
            };
            let state = match &states[..] {
                [_] => String::new(),
                _ => format!("<br/><span class=\"note\">{}</span>", words::condition(lang, field.condition)),
            };
            let unit = number::unit(lang, field.quantity, Statistic::Mean);
            let unit = unit.trim_start_matches('\u{a0}');
            let label = symbol(&words::symbol(lang, field.quantity, Statistic::Value));
            rows.push(vec![
                if index == 0 { name.clone() } else { String::new() },
                if unit.is_empty() { label } else { format!("{label}, {unit}") },
                format!("{}{state}", escape(&field.light_scene)),
                text(Statistic::Mean),
                text(Statistic::Min),
                text(Statistic::Max),
                text(Statistic::U0),
            ]);
        }
    }
    let head = [
        Term::Area,
        Term::QuantityWord,
        Term::LightScene,
        Term::Mean,
        Term::Smallest,
        Term::Largest,
        Term::Ugr0,
    ]
    .map(|term| word(lang, term));
    let mut table = grid("awlrrrr", &head, &rows);
    if let [state] = &states[..] {
        put(&mut table, format_args!("<p class=\"note\">{state}</p>\n"));
    }
    table
}

fn flux(balance: &FluxBalance, lang: Lang) -> String {
    let lumen = word(lang, Term::UnitLumen);
    let flux =
        |flux: Interval| format!("{} {lumen} ({})", number::fixed(lang, flux.value, 0), span(lang, flux, 0));
    let share = |share: Interval| {
        let ends = if share.lo.is_finite() && share.hi.is_finite() {
            format!(
                " ({}…{})",
                number::fixed(lang, 100.0 * share.lo, 2),
                number::fixed(lang, 100.0 * share.hi, 2)
            )
        } else {
            String::new()
        };
        format!("{}\u{a0}%{ends}", number::fixed(lang, 100.0 * share.value, 2))
    };
    let mut html = pairs(&[
        (word(lang, Term::LightScene), escape(&balance.light_scene)),
        (word(lang, Term::Emitted), format!("{} {lumen}", number::fixed(lang, balance.emitted_lm, 0))),
        (word(lang, Term::Absorbed), flux(balance.absorbed)),
        (word(lang, Term::Escaped), flux(balance.escaped)),
        (word(lang, Term::Residual), share(balance.residual_share)),
        (word(lang, Term::Utilisation), balance.utilisation.map_or(String::new(), share)),
    ]);
    let rows: Vec<Vec<String>> = balance
        .surfaces
        .iter()
        .map(|surface| {
            vec![
                escape(&surface.surface),
                number::fixed(lang, surface.area_m2, 2),
                number::fixed(lang, surface.incident.value, 0),
                span(lang, surface.incident, 0),
                number::fixed(lang, surface.leaving.value, 0),
                span(lang, surface.leaving, 0),
            ]
        })
        .collect();
    let interval = word(lang, Term::IntervalWord);
    let head = [
        word(lang, Term::SurfaceWord),
        word(lang, Term::AreaOfSurface),
        word(lang, Term::Incident),
        interval,
        word(lang, Term::Leaving),
        interval,
    ];
    html.push_str(&grid("lrrrrr", &head, &rows));
    format!("<div class=\"whole\">{html}</div>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    /// Catches: a long type name that pushes the numbers off the page, a description of ours left in English.
    #[test]
    fn a_long_name_may_break_and_a_built_in_source_is_told_in_the_readers_language() {
        let mut types = sample::outcome().rooms[0].types.clone();
        for kind in &mut types {
            kind.name = "A".into();
        }
        assert!(schedule(&types, Lang::En).contains("<td class=\"w\"><b>A</b>"));
        types[0].name = "Светильник-аварийный-ЛПО-46".into();
        types[0].description = "Isotropic point source".into();
        types[0].file = String::new();
        let html = schedule(&types, Lang::Ru);
        assert!(html.contains("<td class=\"a\"><b>Светильник") && !html.contains("<td class=\"w\"><b>"));
        assert!(html.contains("изотропный точечный источник"), "{html}");
    }
}
