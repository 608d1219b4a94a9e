//! One drawing for each area, light scene and quantity: false colours, isolines, values, what
//! stands and hangs there, and the facts without which none of it can be judged.

use super::canvas::Canvas;
use super::number;
use super::plan_sheet::{CORNER, Drawing, WIDTH, WINDOW};
use super::plan_view::View;
use super::words::{Lang, Term, phrase, word};
use crate::outcome::{AreaOutcome, Outcome, PointField, Requirement, RoomOutcome};
use crate::quantity::Statistic;

#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// Everything.
    pub outcome: &'a Outcome,
    /// The room.
    pub room: &'a RoomOutcome,
    /// The area in it.
    pub area: &'a AreaOutcome,
    /// The values on it.
    pub field: &'a PointField,
}

/// Subjects of all drawings in project order.
pub fn subjects(outcome: &Outcome) -> impl Iterator<Item = Subject<'_>> {
    outcome.rooms.iter().flat_map(move |room| {
        room.areas
            .iter()
            .flat_map(move |area| area.fields.iter().map(move |field| Subject { outcome, room, area, field }))
    })
}

/// Names and contents of all drawings.
pub fn files(outcome: &Outcome, lang: Lang) -> Vec<(String, String)> {
    let mut used: Vec<String> = Vec::new();
    let mut files = Vec::new();
    for subject in subjects(outcome) {
        let mut parts = vec![subject.area.name.as_str(), subject.field.light_scene.as_str()];
        if outcome.rooms.len() > 1 {
            parts.insert(0, &subject.room.name);
        }
        let key = subject.field.quantity.key();
        parts.push(&key);
        let stem = parts.into_iter().map(file_name).collect::<Vec<_>>().join("-");
        let mut name = format!("{stem}.svg");
        let mut number = 1;
        while used.contains(&name.to_lowercase()) {
            number += 1;
            name = format!("{stem}-{number}.svg");
        }
        used.push(name.to_lowercase());
        files.push((name, draw(subject, lang)));
    }
    files
}

/// A name as part of a file name on any system: three parts stay below 255 bytes.
pub(super) fn file_name(name: &str) -> String {
    let mut kept = String::new();
    for c in name.chars() {
        if kept.len() + c.len_utf8() > 60 {
            break;
        }
        kept.push(if c.is_alphanumeric() || matches!(c, '-' | '_') { c } else { '_' });
    }
    if kept.is_empty() { "_".into() } else { kept }
}

/// A drawing as one SVG element.
pub fn draw(subject: Subject<'_>, lang: Lang) -> String {
    let view = View::of(subject.room, subject.area, CORNER, WINDOW);
    let foot = view.end()[1];
    let mut drawing = Drawing {
        canvas: Canvas::new(WIDTH, foot + 86.0),
        subject,
        lang,
        values: values(subject),
        limit: limit(subject),
        view,
        taken: Vec::new(),
    };
    drawing.title_block();
    drawing.window();
    drawing.axes();
    drawing.legend();
    let title = format!("{} · {} · {}", subject.room.name, subject.area.name, subject.field.quantity.key());
    drawing.canvas.finish(&title)
}

fn values(subject: Subject<'_>) -> Vec<Option<f64>> {
    let points = subject.field.points.iter();
    points.map(|point| point.map(|point| point.value).filter(|value| value.is_finite())).collect()
}

/// The requirement on the mean of what is drawn, else on its minimum.
fn limit(subject: Subject<'_>) -> Option<&Requirement> {
    let of = |statistic| {
        subject.outcome.requirements.iter().find(|r| {
            r.room == subject.room.name
                && r.subject == subject.area.name
                && r.light_scene == subject.field.light_scene
                && r.quantity == subject.field.quantity
                && r.statistic == statistic
        })
    };
    of(Statistic::Mean).or_else(|| of(Statistic::Min))
}

/// Grid as N × M and its spacing, or the number of listed points.
pub fn grid_facts(lang: Lang, area: &AreaOutcome) -> String {
    let grid = &area.grid;
    if grid.columns == 0 {
        return phrase(lang, Term::FreePoints, &[&grid.points.len().to_string()]);
    }
    let [u, v] = grid.spacing_m.map(|spacing| number::fixed(lang, spacing, 2));
    let metre = word(lang, Term::UnitMetre);
    format!("{} {} × {}, p = {u} × {v}\u{a0}{metre}", word(lang, Term::GridWord), grid.columns, grid.rows)
}

/// `MF = 0.80`, or the range over the room's luminaire types.
pub fn maintenance(lang: Lang, room: &RoomOutcome) -> Option<String> {
    let factors = room.types.iter().map(|kind| kind.maintenance_factor);
    let low = factors.clone().reduce(f64::min)?;
    let high = factors.reduce(f64::max)?;
    let text = |factor| number::fixed(lang, factor, 2);
    let range = if text(low) == text(high) { text(low) } else { format!("{}…{}", text(low), text(high)) };
    Some(format!("MF = {range}"))
}

/// A statistic as measured; computed from the points where it was not asked for.
pub fn statistic_of(subject: Subject<'_>, statistic: Statistic) -> Option<f64> {
    let key = subject.field.quantity.key();
    let measured = subject.outcome.values.iter().find(|value| {
        value.room == subject.room.name
            && value.subject == subject.area.name
            && value.light_scene == subject.field.light_scene
            && value.quantity == key
            && value.statistic == statistic.key()
    });
    if let Some(measured) = measured {
        return measured.estimate.as_ref().ok().map(|estimate| estimate.value);
    }
    let known: Vec<f64> = values(subject).into_iter().flatten().collect();
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    let min = known.iter().copied().reduce(f64::min)?;
    let max = known.iter().copied().reduce(f64::max)?;
    match statistic {
        Statistic::Mean => Some(mean),
        Statistic::Min => Some(min),
        Statistic::Max => Some(max),
        Statistic::U0 => (mean > 0.0).then(|| min / mean),
        Statistic::Ud => (max > 0.0).then(|| min / max),
        Statistic::OfTask | Statistic::Value => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plan_view::Sight;
    use crate::report::sample;

    #[test]
    fn names_of_files_hold_no_separator_and_differ() {
        let mut outcome = sample::outcome();
        let mut twin = outcome.rooms[0].areas[0].clone();
        twin.name = twin.name.replace('<', ">");
        outcome.rooms[0].areas.push(twin);
        outcome.rooms[0].name = "室".repeat(300);
        let files = files(&outcome, Lang::En);
        let mut names: Vec<String> = files.iter().map(|(name, _)| name.to_lowercase()).collect();
        assert!(names.iter().all(|name| !name.contains(['/', '\\', '<', '"', ':'])), "{names:?}");
        assert!(names.iter().all(|name| name.len() < 256), "{names:?}");
        names.sort();
        names.dedup();
        assert_eq!(names.len(), files.len());
    }

    #[test]
    fn the_limit_is_one_bold_line_and_text_is_text() {
        let outcome = sample::outcome();
        let subject = subjects(&outcome).next().expect("one");
        let svg = draw(subject, Lang::En);
        let document = roxmltree::Document::parse(&svg).expect("well-formed");
        let bold =
            |n: &roxmltree::Node<'_, '_>| n.attribute("stroke") == Some("#B01826") && n.has_tag_name("path");
        assert_eq!(document.descendants().filter(bold).count(), 1);
        let texts: Vec<&str> = document
            .descendants()
            .filter(|n| n.has_tag_name("text"))
            .filter_map(|n| n.text())
            .map(str::trim)
            .collect();
        assert!(texts.iter().any(|t| t.starts_with("min ")) && texts.iter().any(|t| t.starts_with("max ")));
        assert!(texts.contains(&"500") && texts.contains(&"C0") && texts.contains(&"x, m"));
        assert!(svg.len() < 120_000, "{} bytes", svg.len());
    }

    /// Catches: names that the opening or the arrow strikes through, long ones cut to a few letters, titles that run
    /// off the frame.
    #[test]
    fn names_stand_beside_their_luminaires_and_titles_fit() {
        let mut outcome = sample::outcome();
        let name = "Светильник ЛПО";
        for luminaire in &mut outcome.rooms[0].luminaires {
            luminaire.kind = name.into();
        }
        outcome.rooms[0].name = "Коридор эвакуационного выхода первого этажа, ".repeat(3);
        let subject = subjects(&outcome).next().expect("one");
        let view = View::of(subject.room, subject.area, CORNER, WINDOW);
        let svg = draw(subject, Lang::Ru);
        let document = roxmltree::Document::parse(&svg).expect("well-formed");
        let texts = || document.descendants().filter(|n| n.has_tag_name("text"));
        let number = |n: &roxmltree::Node<'_, '_>, key: &str| {
            n.attribute(key).and_then(|text| text.parse::<f64>().ok()).expect("a number") / 4.0
        };
        let mut found = 0;
        for text in texts().filter(|n| n.text().is_some_and(|text| text.trim() == name)) {
            let (x, y) = (number(&text, "x"), number(&text, "y"));
            for luminaire in &outcome.rooms[0].luminaires {
                let ys = luminaire.outline.iter().map(|at| view.px(*at)[1]);
                let (low, high) = ys.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
                let [centre, _] = view.px(luminaire.position);
                let clear = (x - centre).abs() > 20.0 || y < low - 3.0 || y > high + 3.0;
                assert!(clear, "{name} at {x} {y} is struck through: {low}…{high}");
            }
            found += 1;
        }
        assert!(found >= 3, "{found} names");
        let title = texts().find(|n| n.text().is_some_and(|text| text.contains("Коридор"))).expect("a title");
        let letters = title.text().map_or(0, |text| text.trim().chars().count()) as f64;
        // Bold Cyrillic of the widest font in the list takes 0.62 of its size on the average.
        let width = 12.0 + 0.62 * number(&title, "font-size") * letters;
        assert!(width < WIDTH && letters > 90.0, "{letters} letters, {width} px");
    }

    #[test]
    fn a_point_at_the_right_of_a_wall_is_drawn_at_the_right() {
        let outcome = sample::outcome();
        let wall = subjects(&outcome).find(|s| s.area.grid.normal.z.abs() < 0.1).expect("a wall");
        let view = View::of(wall.room, wall.area, CORNER, WINDOW);
        assert_eq!(view.sight, Sight::Elevation);
        // The north wall seen from the south: east is right, up is up.
        let at = |x, z| view.px(glam::DVec3::new(x, wall.area.grid.origin.y, z));
        assert!(at(5.0, 1.0)[0] > at(1.0, 1.0)[0] && at(1.0, 2.0)[1] < at(1.0, 1.0)[1]);
    }
}
