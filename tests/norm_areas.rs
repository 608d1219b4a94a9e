//! Areas as norms take them: the side on which they are measured, those that are made from a room's outline,
//! the state in which an upper limit is judged.

mod projects;

use std::process::Command;

use gershun::outcome::{Bound, Outcome, Requirement, Verdict};
use gershun::quantity::Statistic;
use gershun::solve::Effort;
use projects::{folder, run};

/// A black box of 6 × 4 × 3 m with one luminaire aside of its middle, so that no two places are lit alike.
fn black(norm: &str, luminaire: &str, rest: &str) -> Outcome {
    let text = format!(
        "[project]\nname = \"Box\"\n[scene]\nbox = {{ size = [6, 4, 3], floor = 0, walls = 0, ceiling = 0 }}\n\
         [luminaires.A]\npoint = {{ flux = 20000 }}\n{luminaire}\n[[place]]\nluminaire = \"A\"\nat = [2, 1.7, 2.8]\n\
         [norm]\nstandard = \"{norm}\"\n{rest}"
    );
    run(&text, &[], 2, Effort { particles: 16, ..Effort::default() })
}

fn of<'a>(outcome: &'a Outcome, subject: &str, statistic: Statistic) -> &'a Requirement {
    let mut found = outcome.requirements.iter().filter(|r| r.subject == subject && r.statistic == statistic);
    found.next().unwrap_or_else(|| panic!("no {statistic:?} of {subject}: {:?}", outcome.requirements))
}

fn area(name: &str, shape: &str) -> String {
    format!("[[area]]\nname = \"{name}\"\ngrid = {{ count = [3, 3] }}\n{shape}\n")
}

fn value(outcome: &Outcome, subject: &str) -> f64 {
    *of(outcome, subject, Statistic::Mean).value.as_ref().expect("it is lit")
}

/// Catches: a drawing table measured on its underside, a board on the side of the wall, a floor from below it, and
/// all that because of the order in which somebody listed edges or corners.
#[test]
fn the_order_of_edges_and_corners_does_not_choose_the_side() {
    let pairs = [
        (
            "tilted",
            "rect = { origin = [1, 1, 0.75], u = [1.6, 0, 0], v = [0, 0.8, 0.4] }",
            "rect = { origin = [1, 1, 0.75], u = [0, 0.8, 0.4], v = [1.6, 0, 0] }",
        ),
        (
            "board",
            "rect = { origin = [0.02, 1, 1], u = [0, 2, 0], v = [0, 0, 1] }",
            "rect = { origin = [0.02, 1, 1], u = [0, 0, 1], v = [0, 2, 0] }",
        ),
        (
            "floor",
            "rect = { origin = [1, 1, 0], u = [4, 0, 0], v = [0, 2, 0] }",
            "rect = { origin = [1, 1, 0], u = [0, 2, 0], v = [4, 0, 0] }",
        ),
        (
            "easel",
            "polygon = [[1, 1, 0.75], [2.6, 1, 0.75], [2.6, 1.8, 1.15], [1, 1.8, 1.15]]",
            "polygon = [[1, 1.8, 1.15], [2.6, 1.8, 1.15], [2.6, 1, 0.75], [1, 1, 0.75]]",
        ),
        (
            "poster",
            "polygon = [[0.02, 1, 1], [0.02, 3, 1], [0.02, 3, 2], [0.02, 1, 2]]",
            "polygon = [[0.02, 1, 2], [0.02, 3, 2], [0.02, 3, 1], [0.02, 1, 1]]",
        ),
    ];
    let areas = pairs.map(|(name, one, other)| area(name, one) + &area(&format!("{name}, turned"), other));
    let outcome = black("en-12464-1-2021", "", &format!("row = \"34.2\"\n{}", areas.concat()));
    for (name, ..) in pairs {
        let (one, other) = (value(&outcome, name), value(&outcome, &format!("{name}, turned")));
        assert!(one > 20.0 && (one / other - 1.0).abs() < 1e-9, "{name}: {one} and {other} lx");
    }
}

/// The broken twin: where both sides lie in the room the order does choose, or a rack could not be judged on
/// either face.
#[test]
fn an_upright_plane_in_the_room_has_two_sides() {
    let one = area("East", "rect = { origin = [3, 1, 1], u = [0, 2, 0], v = [0, 0, 1] }");
    let other = area("West", "rect = { origin = [3, 1, 1], u = [0, 0, 1], v = [0, 2, 0] }");
    let outcome = black("en-12464-1-2021", "", &format!("row = \"34.2\"\n{one}{other}"));
    assert!(
        value(&outcome, "East").abs() < 1e-9 && value(&outcome, "West") > 20.0,
        "the lamp hangs in the west"
    );
}

/// The other broken twin: who asks for E_n in so many words gets the normal of the edges as they are listed.
#[test]
fn a_side_that_was_chosen_is_kept() {
    let asked = "quantities = [\"E_n\"]\nrect = { origin = [0.02, 1, 1], u = [0, 0, 1], v = [0, 2, 0] }";
    let outcome = black("en-12464-1-2021", "", &format!("row = \"34.2\"\n{}", area("Back", asked)));
    assert!(value(&outcome, "Back").abs() < 1e-9, "it faces the wall");
}

const EMERGENCY: &str = "emergency = { flux = 200 }\nmaintenance = 0.8";

/// Catches: a court taken for the whole hall, an escape route judged without its ends, where it is darkest (0.98 lx
/// were found where the end of the route has 0.75 lx).
#[test]
fn no_area_is_made_for_a_row_that_speaks_of_a_part_of_the_room() {
    let rows = [
        ("en-1838-2013", "route-centre"),
        ("en-1838-2013", "route-band"),
        ("en-1838-2024", "route"),
        ("en-1838-2024", "high-risk"),
        ("en-12193-2018", "basketball-II"),
    ];
    for (norm, row) in rows {
        let outcome = black(norm, EMERGENCY, &format!("row = \"{row}\"\n"));
        assert!(outcome.rooms[0].areas.is_empty(), "{norm} {row}: no areas");
        let judged = [Verdict::Pass, Verdict::Fail];
        let light = outcome.requirements.iter().filter(|r| r.quantity.unit() == "lx");
        assert!(light.clone().all(|r| !judged.contains(&r.verdict)), "{norm} {row}");
        let says = format!("row {row} speaks of a part of the room: list that part as an area");
        assert!(light.filter_map(|r| r.value.as_ref().err()).any(|u| u.reason == says), "{norm} {row}");
    }
    // What speaks of the room is made, with the border of its row.
    let least = |norm: &str, row: &str| {
        let outcome = black(norm, EMERGENCY, &format!("row = \"{row}\"\n"));
        let [area] = &outcome.rooms[0].areas[..] else { panic!("{norm} {row}: one area") };
        let open = area.grid.points.iter().filter(|point| point.excluded.is_none());
        open.map(|point| point.position.x).fold(f64::INFINITY, f64::min)
    };
    assert!(least("en-1838-2013", "open-area") > 0.5 && least("en-1838-2024", "plant-room") < 0.5);
}

/// Catches: a screen that may have 200 lx at most judged at the end of its maintenance interval, when it has least.
#[test]
fn an_upper_limit_is_judged_for_a_new_installation() {
    let screen = area("Screen", "rect = { origin = [3, 1, 0.5], u = [0, 0, 1], v = [0, 2, 0] }");
    let judged = |maintenance: f64| {
        let rest = format!(
            "row = \"17-screen\"\n{screen}[[require]]\narea = \"Screen\"\nquantity = \"E_n\"\nstatistic = \"mean\"\nmin = 1\n"
        );
        let outcome = black("sanpin-1.2.3685-21", &format!("maintenance = {maintenance}"), &rest);
        let found = |bound: Bound| {
            let one = outcome.requirements.iter().find(|r| r.subject == "Screen" && r.bound == bound);
            let one = one.expect("it is required");
            (*one.value.as_ref().expect("it is lit"), one.note.clone())
        };
        (found(Bound::Max(200.0)), found(Bound::Min(1.0)))
    };
    let ((new_lx, _), _) = judged(1.0);
    let ((upper_lx, upper), (lower_lx, lower)) = judged(0.5);
    assert!((upper_lx / new_lx - 1.0).abs() < 1e-9, "{upper_lx} of {new_lx} lx");
    assert!((lower_lx / new_lx - 0.5).abs() < 1e-9, "a lower limit is maintained");
    assert_eq!((upper.as_str(), lower.as_str()), ("initial", "maintained"));
}

/// Catches: an area on another plane than its row's that is judged without a word beside the verdict.
#[test]
fn a_verdict_on_another_plane_says_so() {
    let level = |z: f64| format!("rect = {{ origin = [1, 1, {z}], u = [2, 0, 0], v = [0, 2, 0] }}");
    let board = |z: f64| {
        format!("row = \"15-board\"\nrect = {{ origin = [0.02, 1, {z}], u = [0, 2, 0], v = [0, 0, 1] }}")
    };
    let areas = [("Floor", level(0.0)), ("Desk", level(0.8)), ("Low", board(0.3)), ("Board", board(1.0))];
    let areas = areas.map(|(name, shape)| area(name, &shape)).concat();
    let outcome = black("sanpin-1.2.3685-21", "", &format!("row = \"15\"\n{areas}"));
    let note = |name: &str| of(&outcome, name, Statistic::Mean).note.clone();
    assert_eq!(note("Floor"), "maintained; area at 0.00 m, the row names a plane at 0.80 m");
    assert_eq!(note("Low"), "maintained; area at 0.80 m, the row names a plane at 1.50 m");
    assert_eq!([note("Desk"), note("Board")], ["maintained", "maintained"]);
}

/// Catches: one's own requirement taken for a limit of the norm, a plane that only the report tells of.
#[test]
fn the_table_marks_what_the_norm_does_not_say() {
    let text = "[scene]\nbox = { size = [6, 4, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n\
                [luminaires.A]\npoint = { flux = 20000 }\n[[place]]\nluminaire = \"A\"\nat = [2, 1.7, 2.8]\n\
                [norm]\nstandard = \"sanpin-1.2.3685-21\"\nrow = \"15\"\n\
                [[area]]\nname = \"Floor\"\nrect = { origin = [1, 1, 0], u = [2, 0, 0], v = [0, 2, 0] }\n\
                [[require]]\narea = \"Floor\"\nquantity = \"E_h\"\nstatistic = \"mean\"\nmin = 30\n";
    let folder = folder(text, &[]);
    let said = |text: &str| {
        std::fs::write(folder.path().join("project.toml"), text).expect("a file");
        let command =
            [env!("CARGO_BIN_EXE_gershun"), "check", "--accuracy", "draft", "--lang", "en", "--out"];
        let mut command = command.map(std::ffi::OsString::from).to_vec();
        command.extend([folder.path().join("out").into(), folder.path().into()]);
        let output = Command::new(&command[0]).args(&command[1..]).output().expect("it runs");
        String::from_utf8(output.stdout).expect("text")
    };
    let table = said(text);
    let own: Vec<&str> = table.lines().filter(|line| line.contains("lx*")).collect();
    assert!(own.len() == 1 && own[0].contains("≥ 30"), "{table}");
    assert!(table.contains("\n* the project's own requirement"), "{table}");
    assert!(table.contains("Floor: area at 0.00 m, the row names a plane at 0.80 m"), "{table}");
    // Without a norm all requirements are the project's own: nothing to mark.
    let alone = text.replace("[norm]\nstandard = \"sanpin-1.2.3685-21\"\nrow = \"15\"\n", "");
    assert!(said(&alone).contains("≥ 30") && !said(&alone).contains('*'), "{}", said(&alone));
}
