//! A norm in words: how it is applied, what each column means, what a row asks for. Every value
//! stands with its standing, so that a reader sees what the file knows and what it does not.

use std::fmt::Write;

use super::application::{Application, Comparison, Fact, GridChoice, LevelOf, Light, State, UgrMethod};
use super::{Bound, Plane, Posture, Row, Standard, Zone};
use crate::quantity::Quantity;

/// What each column of a row means.
pub const COLUMN_WORDS: [(&str, &str); 11] = [
    ("em", "illuminance on the task, lx, at least; which statistic stands above"),
    ("em_modified", "the illuminance for difficult conditions, lx; applied where a room says why"),
    ("u0", "uniformity E_min / mean on the task, at least"),
    ("ugr", "UGR of the room, at most"),
    ("m", "discomfort index M = 10^((UGR + 4.8)/16) of the room, at most"),
    ("gr", "glare rating R_G, at most; at observers of the norm's own, which are not laid: not assessed"),
    ("ra", "colour rendering index R_a, at least; declared, never computed"),
    ("kp", "pulsation of the illuminance, %, at most; declared, never computed"),
    ("em_cylindrical", "mean cylindrical illuminance at eye height, lx, at least"),
    ("em_walls", "mean illuminance on every wall, lx, at least"),
    ("em_ceiling", "mean illuminance on the ceiling, lx, at least"),
];

/// How a norm is applied and what its columns mean.
pub fn explain(standard: &Standard) -> String {
    let mut text = standard.head();
    application(&mut text, &standard.application);
    text.push_str("\nColumns\n");
    let used = |name: &str| standard.rows.iter().any(|row| has_column(row, name));
    for (name, meaning) in COLUMN_WORDS.iter().filter(|(name, _)| used(name)) {
        line(&mut text, &format!("{name:<15} {meaning}"));
    }
    if standard.rows.iter().any(|row| !row.unknown.is_empty()) {
        line(&mut text, "A column that the norm has and this file does not know is \"not assessed\".");
    }
    text.push_str("\nStanding of a value: two-sources, one-source (both of this edition), or unverified.\n");
    text
}

/// What a row asks for, in which zone, and how well that is known.
pub fn explain_row(standard: &Standard, row: &Row) -> String {
    let mut text = standard.head();
    let clause = if row.clause.is_empty() { String::new() } else { format!(" ({})", row.clause) };
    let _ = writeln!(text, "\n{}", format!("{}{clause}  {}", row.reference, row.called()).trim_end());
    let height = row.plane_m.unwrap_or(standard.application.working_plane_m.value);
    let plane = match (row.plane, row.plane_name.as_str()) {
        (Plane::Horizontal, "") => format!("horizontal plane at {height} m"),
        (Plane::Vertical, "") => "vertical plane".to_owned(),
        (Plane::Horizontal, name) => format!("horizontal plane {name} at {height} m"),
        (Plane::Vertical, name) => format!("vertical plane {name}"),
    };
    line(&mut text, &plane);
    if row.part_of_room {
        line(&mut text, "a part of the room: the project lists it as an area, its outline does not tell it");
    } else if let Some(border_m) = row.border_m {
        line(&mut text, &format!("border left out at walls: {border_m} m"));
    }
    if row.limits.iter().any(|limit| limit.zone == Zone::Cylindrical) {
        let heights: Vec<String> = standard
            .application
            .eye_heights_m(row.posture)
            .iter()
            .map(|height| format!("{height} m"))
            .collect();
        line(&mut text, &format!("cylindrical illuminance at {}", heights.join(" and ")));
    }
    for limit in standard.requirements(row) {
        line(
            &mut text,
            &limit_line(limit.zone, limit.quantity, limit.statistic.key(), limit.bound, limit.verified.key()),
        );
    }
    if let Some((lx, verified)) = row.modified_lx {
        line(&mut text, &format!("modified illuminance {lx} lx, {}: where a room says why", verified.key()));
    }
    if let Some(intensity) = &row.intensity {
        let steps = intensity.by_height_cd.iter();
        let steps: Vec<String> = steps.map(|[from_m, cd]| format!("from {from_m} m: {cd}")).collect();
        let zone = format!("{}° to {}°", intensity.from_deg, intensity.to_deg);
        let standing = intensity.verified.key();
        line(
            &mut text,
            &format!("intensity {zone} from straight down, cd: {} ({standing})", steps.join(", ")),
        );
    }
    for reason in &row.not_judged {
        line(&mut text, &format!("not assessed: {reason}"));
    }
    for unknown in &row.unknown {
        let quantity = format!("{} {}", unknown.quantity.key(), unknown.statistic.key());
        line(&mut text, &format!("{:<12} {quantity:<16} not in this file: not assessed", unknown.zone.key()));
    }
    if !row.note.is_empty() {
        line(&mut text, &format!("note: {}", row.note));
    }
    for source in &row.sources {
        line(&mut text, &format!("source: {source}"));
    }
    text
}

/// One limit on one line: zone, quantity, bound, standing.
pub fn limit_line(zone: Zone, quantity: Quantity, statistic: &str, bound: Bound, standing: &str) -> String {
    let bound = match bound {
        Bound::Min(value) => format!(">= {}", round(value)),
        Bound::Max(value) => format!("<= {}", round(value)),
    };
    let quantity = format!("{} {statistic}", quantity.key());
    let zone = zone.key();
    format!("{zone:<12} {quantity:<16} {bound:<9} {standing}")
}

impl Standard {
    /// Name, title, edition and note, what there is of them, on lines of their own.
    pub fn head(&self) -> String {
        let mut text = self.short.clone();
        for (before, part) in [(": ", &self.title), (", edition ", &self.edition), ("\n", &self.note)] {
            if !part.is_empty() {
                let _ = write!(text, "{before}{part}");
            }
        }
        text.push('\n');
        text
    }
}

impl Application {
    /// Eye heights at which cylindrical illuminance is taken for people of this posture, m.
    pub fn eye_heights_m(&self, posture: Posture) -> Vec<f64> {
        let (seated, standing) = (self.eye_height_seated_m.value, self.eye_height_standing_m.value);
        match posture {
            Posture::Seated => vec![seated],
            Posture::Standing => vec![standing],
            Posture::Both if (seated - standing).abs() < 1e-9 => vec![seated],
            Posture::Both => vec![seated, standing],
        }
    }
}

fn application(text: &mut String, rules: &Application) {
    text.push_str("\nApplication\n");
    if let Some(reason) = &rules.not_judged {
        line(text, &format!("nothing of it is judged yet: {reason}"));
    }
    let state = |state: State| match state {
        State::Maintained => "maintained",
        State::Initial => "initial",
        State::Emergency => "at emergency output, maintained",
    };
    fact(text, "illuminance is judged", state(rules.illuminance_state.value), &rules.illuminance_state);
    if rules.illuminance_state.value == State::Maintained {
        let upper = &rules.upper_limit_state;
        fact(text, "upper limits of illuminance are judged", state(upper.value), upper);
    }
    let light = match rules.light.value {
        Light::All => "all light",
        Light::Direct => "direct light only, no reflection",
    };
    fact(text, "illuminance counts", light, &rules.light);
    let level = match rules.illuminance_statistic.value {
        LevelOf::Mean => "the mean over the area",
        LevelOf::Min => "the smallest value of the area",
    };
    fact(text, "em limits", level, &rules.illuminance_statistic);
    fact(text, "working plane", &format!("{} m", rules.working_plane_m.value), &rules.working_plane_m);
    let grid = match rules.grid.value {
        GridChoice::En12464 => {
            "spacing of at most 0.2 · 5^(lg d), 10 m, d the longer side (the shorter at 2:1)"
        }
        GridChoice::En12193 => "spacing 0.2 · 5^(lg d), d the longer side, odd numbers of points",
    };
    fact(text, "grid", grid, &rules.grid);
    fact(text, "border left out at walls", &format!("{} m", rules.border_m.value), &rules.border_m);
    fact(text, "glare is judged", state(rules.ugr_state.value), &rules.ugr_state);
    let method = match rules.ugr_method.value {
        UgrMethod::Table => "table method, CIE 190",
        UgrMethod::Observers => "at the observers of the project",
    };
    fact(text, "UGR method", method, &rules.ugr_method);
    fact(text, "UGR table, spacing to height", &rules.ugr_shr.value.to_string(), &rules.ugr_shr);
    let heights = [&rules.eye_height_seated_m, &rules.eye_height_standing_m];
    for (name, height) in ["eye height, seated", "eye height, standing"].iter().zip(heights) {
        fact(text, name, &format!("{} m", height.value), height);
    }
    let comparison = match rules.comparison {
        Comparison::Exact => "unrounded values",
        Comparison::Printed => "values rounded half up: E to three figures, ratios to 0.01, UGR to 0.1",
    };
    line(text, &format!("comparison: {comparison}; a project may ask for the other"));
    zones(text, rules);
    if let Some(scale) = &rules.illuminance_scale_lx {
        let steps: Vec<String> = scale.value.iter().map(f64::to_string).collect();
        fact(text, "scale of illuminance, lx", &steps.join(" "), scale);
    }
    for beyond in &rules.beyond {
        line(text, &format!("{} is not assessed: {}", beyond.quantity, beyond.reason));
    }
    if let Some(range) = &rules.modelling {
        fact(text, "modelling, recommended", &format!("{:?}", range.value), range);
    }
    if let Some(ranges) = &rules.reflectances {
        let parts = [
            ("ceiling", &ranges.ceiling),
            ("walls", &ranges.walls),
            ("floor", &ranges.floor),
            ("objects", &ranges.objects),
        ];
        for (name, range) in parts {
            fact(text, &format!("reflectance of {name}, recommended"), &format!("{:?}", range.value), range);
        }
    }
}

fn zones(text: &mut String, rules: &Application) {
    if let Some(around) = &rules.surrounding {
        fact(text, "surrounding, width", &format!("{} m", around.band_m.value), &around.band_m);
        let steps = around.illuminance_lx.value.iter();
        let steps: Vec<String> = steps.map(|[from, lx]| format!("from {from}: {lx}")).collect();
        fact(text, "surrounding, lx by task", &steps.join(", "), &around.illuminance_lx);
        fact(text, "surrounding, U0", &around.u0.value.to_string(), &around.u0);
    } else if let Some(share) = &rules.surrounding_of_task {
        fact(text, "area around the task, mean of the task's mean", &share.value.to_string(), share);
    } else {
        line(text, "no surrounding zones");
    }
    if let Some(beyond) = &rules.background {
        fact(text, "background, width", &format!("{} m", beyond.width_m.value), &beyond.width_m);
        fact(
            text,
            "background, share of the surrounding",
            &round(beyond.fraction.value).to_string(),
            &beyond.fraction,
        );
        fact(text, "background, U0", &beyond.u0.value.to_string(), &beyond.u0);
    }
    for (name, u0) in
        [("walls", &rules.walls_u0), ("ceiling", &rules.ceiling_u0), ("cylindrical", &rules.cylindrical_u0)]
    {
        if let Some(u0) = u0 {
            fact(text, &format!("{name}, U0"), &u0.value.to_string(), u0);
        }
    }
}

fn has_column(row: &Row, name: &str) -> bool {
    let column = super::text::COLUMNS.iter().find(|column| column.name == name);
    match column {
        None => name == "em_modified" && row.modified_lx.is_some(),
        Some(column) => row.limits.iter().any(|limit| {
            let (zone, quantity, statistic) = column.limits(limit.quantity, limit.statistic);
            zone == limit.zone && quantity == limit.quantity && statistic == limit.statistic
        }),
    }
}

fn fact<T>(text: &mut String, name: &str, value: &str, fact: &Fact<T>) {
    let source = if fact.source.is_empty() { String::new() } else { format!("; {}", fact.source) };
    line(text, &format!("{name}: {value} ({}{source})", fact.verified.key()));
}

fn line(text: &mut String, content: &str) {
    let _ = writeln!(text, "    {content}");
}

/// Derived limits to six figures: a third of 500 lx is no number to print in full.
fn round(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::super::bundled;
    use super::*;

    /// Catches: colons and commas round what a house norm of two lines does not say.
    #[test]
    fn what_is_not_there_leaves_no_punctuation() {
        let house = Standard::parse("id = \"house\"\nrow = [{ ref = \"1\", em = 300 }]\n", "house.toml");
        let house = house.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(house.head(), "house\n");
        assert!(explain_row(&house, &house.rows[0]).starts_with("house\n\n1\n"));
    }

    /// Catches: a rule or a limit that the loader reads and nobody is told of.
    #[test]
    fn every_norm_and_every_row_explains_itself() {
        for (name, text) in bundled() {
            let standard = Standard::parse(text, name).unwrap_or_else(|error| panic!("{error}"));
            let told = explain(&standard);
            for part in ["Application", "grid:", "working plane:", "Columns", "Standing"] {
                assert!(told.contains(part), "{name}: {part} is missing in\n{told}");
            }
            if let Some(reason) = &standard.application.not_judged {
                assert!(told.contains(reason.as_str()));
            }
            for row in &standard.rows {
                let told = explain_row(&standard, row);
                assert!(told.contains(&row.reference) && told.contains(&row.task), "{told}");
                let limits = standard.requirements(row).len();
                assert!(told.matches("<= ").count() + told.matches(">= ").count() >= limits, "{told}");
            }
        }
    }
}
