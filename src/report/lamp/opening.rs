//! A luminous opening in words.

use super::super::number::fixed;
use super::super::words::{Lang, lamp_word};
use crate::photometry::Opening;

/// Shape and sizes, m.
pub fn shown(opening: Opening, lang: Lang) -> String {
    let say = |english: &'static str| lamp_word(lang, english);
    let size = |value: f64| fixed(lang, value, 3);
    let sizes = |values: &[f64]| {
        let sizes: Vec<String> = values.iter().map(|value| size(*value)).collect();
        format!("{} {}", sizes.join(" × "), say("m"))
    };
    let height = |height_m: f64| {
        let said = format!("{} {} {}", say(", luminous height"), size(height_m), say("m"));
        if height_m > 0.0 { said } else { String::new() }
    };
    let plan =
        |length_m: f64, width_m: f64| format!("{} {}", sizes(&[length_m, width_m]), say("(length × width)"));
    match opening {
        Opening::Point => say("none: a point").to_owned(),
        Opening::Rect { length_m, width_m, side_x_m, side_y_m } => {
            let sides = if side_x_m > 0.0 || side_y_m > 0.0 {
                let (ends, long) = (say("(ends)"), say("(long sides)"));
                let [x, y] = [side_x_m, side_y_m].map(|side| sizes(&[side]));
                format!("{} {x} {ends}, {y} {long}", say(", luminous sides"))
            } else {
                String::new()
            };
            format!("{} {}{sides}", say("rectangle"), plan(length_m, width_m))
        }
        Opening::Sided { length_m, width_m, sides_m: [c90, c180, c270, c0] } => format!(
            "{} {}{} C0 {} · C90 {} · C180 {} · C270 {} {}",
            say("rectangle"),
            plan(length_m, width_m),
            say(", luminous sides"),
            size(c0),
            size(c90),
            size(c180),
            size(c270),
            say("m")
        ),
        Opening::Disc { diameter_m, height_m } => {
            format!("{} ⌀ {}{}", say("disc"), sizes(&[diameter_m]), height(height_m))
        }
        Opening::Ellipse { length_m, width_m, height_m } => {
            format!("{} {}{}", say("ellipse"), plan(length_m, width_m), height(height_m))
        }
        Opening::Ellipsoid { length_m, width_m, height_m } => {
            if (length_m - width_m).abs().max((length_m - height_m).abs()) < 1e-9 {
                return format!("{} ⌀ {}", say("sphere"), sizes(&[length_m]));
            }
            let all = sizes(&[length_m, width_m, height_m]);
            format!("{} {all} {}", say("ellipsoid"), say("(length × width × height)"))
        }
        Opening::Tube { length_m, width_m, height_m, across } => {
            let way = if across { say("along C0–C180") } else { say("along C90–C270") };
            let section = sizes(&[width_m, height_m]);
            format!(
                "{}, {} {way}, ⌀ {section} {}",
                say("lying cylinder"),
                sizes(&[length_m]),
                say("(level × upright)")
            )
        }
        Opening::Upright { width_m, height_m, across, round } => {
            let shape = if round { say("ellipse") } else { say("rectangle") };
            let faces = if across { "C0, C180" } else { "C90, C270" };
            let all = sizes(&[width_m, height_m]);
            format!("{} {shape} {all} {} {} {faces}", say("upright"), say("(width × height)"), say("facing"))
        }
    }
}
