//! Norms applied to whole projects: what is asked, of what, and what is said where nothing can be
//! judged. Catches limits that vanish in silence, planes and zones mixed up, a context that changes the
//! wrong number.

mod projects;

use std::path::Path;
use std::process::Command;

use gershun::outcome::{Bound, Outcome, Requirement, Verdict};
use gershun::project::{LoadOptions, load};
use gershun::quantity::{Quantity, Statistic};
use gershun::solve::Effort;
use projects::{folder, run};

/// A room of 8 × 5 × 2.8 m with a desk, and what a test adds.
fn room(norm: &str, rest: &str) -> String {
    format!(
        "[project]\nname = \"Room\"\n[scene]\nbox = {{ size = [8, 5, 2.8], floor = 0.2, walls = 0.5, ceiling = 0.7 }}\n\
         [luminaires.A]\nlambert = {{ flux = 6000 }}\narea = {{ rect = [1.2, 0.3] }}\n\
         [[place]]\nluminaire = \"A\"\nfield = {{ rows = 2, columns = 3, height = 2.79 }}\n\
         [norm]\nstandard = \"{norm}\"\n{rest}"
    )
}

const DESK: &str =
    "[[area]]\nname = \"Desk\"\nrect = { origin = [3, 2, 0.75], u = [1.6, 0, 0], v = [0, 0.8, 0] }\n";

fn solved(text: &str) -> Outcome {
    run(text, &[], 32, Effort::default())
}

fn of<'a>(outcome: &'a Outcome, subject: &str, statistic: Statistic) -> Vec<&'a Requirement> {
    let wanted = |r: &&Requirement| r.subject == subject && r.statistic == statistic;
    outcome.requirements.iter().filter(wanted).collect()
}

fn mistakes(text: &str) -> String {
    let folder = folder(text, &[]);
    let errors = load(folder.path(), &LoadOptions::default()).expect_err("a mistake");
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_room_says_why_its_row_asks_for_more_and_only_its_row_does() {
    let modified =
        "[[room]]\nname = \"Office\"\nrow = \"34.2\"\nmodified = { steps = 1, reason = \"small details\" }\n";
    let board = "[[area]]\nname = \"Table\"\nrow = \"34.6\"\nrect = { origin = [1, 1, 0.75], u = [1.6, 0, 0], v = [0, 0.8, 0] }\n";
    let around = "[[area]]\nname = \"Around\"\nkind = \"surrounding\"\nof = \"Desk\"\nrect = { origin = [2.5, 1.5, 0.75], u = [2.6, 0, 0], v = [0, 1.8, 0] }\n";
    let outcome = solved(&room("en-12464-1-2021", &format!("{modified}{DESK}{board}{around}")));
    let desk = of(&outcome, "Desk", Statistic::Mean)[0];
    assert_eq!(desk.bound, Bound::Min(750.0));
    let context = desk.modified.as_ref().expect("it is modified");
    assert_eq!((context.required_lx.to_bits(), context.steps), (500f64.to_bits(), Some(1)));
    assert_eq!(context.reason, "small details");
    let around = of(&outcome, "Around", Statistic::Mean)[0];
    assert_eq!(around.bound, Bound::Min(500.0), "the surrounding follows 750 lx");
    let table = of(&outcome, "Table", Statistic::Mean)[0];
    assert_eq!(
        (table.bound, table.modified.is_some()),
        (Bound::Min(300.0), false),
        "another row keeps its own"
    );
    let uniformity = of(&outcome, "Desk", Statistic::U0)[0];
    assert_eq!((uniformity.bound, uniformity.modified.is_some()), (Bound::Min(0.6), false));
    // Without steps it is the row's own value for difficult conditions.
    let own = modified.replace("steps = 1, ", "");
    let outcome = solved(&room("en-12464-1-2021", &format!("{own}{DESK}")));
    assert_eq!(of(&outcome, "Desk", Statistic::Mean)[0].bound, Bound::Min(1000.0));
}

/// Catches: a modification of one area that others follow, zones that do not follow it, the room's that
/// overrides the area's own.
#[test]
fn an_area_may_say_for_itself_why_it_asks_for_more() {
    let desk = |name: &str, x: f64, rest: &str| {
        format!(
            "[[area]]\nname = \"{name}\"\n{rest}rect = {{ origin = [{x}, 2, 0.75], u = [1.6, 0, 0], v = [0, 0.8, 0] }}\n"
        )
    };
    let own = "modified = { steps = 2, reason = \"inspection\" }\n";
    let zone = "[[area]]\nname = \"Around\"\nkind = \"surrounding\"\nof = \"Bench\"\n";
    let rest = format!(
        "[[room]]\nname = \"Office\"\nrow = \"34.2\"\nmodified = {{ steps = -1, reason = \"large details\" }}\n{}{}{}{zone}",
        desk("Desk", 0.6, ""),
        desk("Bench", 3.0, own),
        desk("Table", 5.6, "row = \"34.6\"\n"),
    );
    let outcome = solved(&room("en-12464-1-2021", &rest));
    let bound = |area: &str| of(&outcome, area, Statistic::Mean)[0].bound;
    assert_eq!(bound("Bench"), Bound::Min(1000.0));
    assert_eq!(bound("Desk"), Bound::Min(300.0), "the room's");
    assert_eq!(bound("Table"), Bound::Min(300.0), "another row keeps its own");
    assert_eq!(bound("Around"), Bound::Min(500.0), "the zone follows its task");
    let why = of(&outcome, "Bench", Statistic::Mean)[0].modified.clone().expect("it is modified");
    assert_eq!((why.reason.as_str(), why.steps), ("inspection", Some(2)));
    let zone = zone.replace("of =", "modified = { steps = 1, reason = \"x\" }\nof =");
    let refused =
        mistakes(&room("en-12464-1-2021", &format!("row = \"34.2\"\n{}{zone}", desk("Bench", 3.0, own))));
    assert!(refused.contains("only a task area has an illuminance to modify"), "{refused}");
    let refused = mistakes(&room("en-12464-1-2021", &desk("Bench", 3.0, own)));
    assert!(refused.contains("needs a row to modify"), "{refused}");
}

/// Catches: zones that nobody assesses printed with the limit of the unmodified row; several limits told as one.
#[test]
fn what_is_not_assessed_round_a_task_follows_the_task_too() {
    let desk = |name: &str, x: f64, rest: &str| {
        format!(
            "[[area]]\nname = \"{name}\"\n{rest}rect = {{ origin = [{x}, 2, 0.75], u = [1.2, 0, 0], v = [0, 0.8, 0] }}\n"
        )
    };
    let own = "modified = { steps = 2, reason = \"inspection\" }\n";
    let limits = |desks: &str| -> Vec<(String, Bound)> {
        let outcome = solved(&room("en-12464-1-2021", &format!("row = \"34.2\"\n{desks}")));
        let zones = outcome.requirements.iter().filter(|r| r.subject.contains("surrounding area"));
        zones.filter(|r| r.statistic == Statistic::Mean).map(|r| (r.subject.clone(), r.bound)).collect()
    };
    let round = |name: &str, lx: f64| (format!("{name} · surrounding area"), Bound::Min(lx));
    let two = [desk("Desk", 1.0, ""), desk("Bench", 5.0, own)].concat();
    assert_eq!(limits(&two), [round("Desk", 300.0), round("Bench", 500.0)]);
    let alike = [desk("Desk", 1.0, own), desk("Bench", 5.0, own)].concat();
    assert_eq!(limits(&alike), [("surrounding area".to_owned(), Bound::Min(500.0))]);
    let plain = [desk("Desk", 1.0, ""), desk("Bench", 5.0, "")].concat();
    assert_eq!(limits(&plain), [("surrounding area".to_owned(), Bound::Min(300.0))]);
}

#[test]
fn a_modification_without_reason_row_or_step_is_refused_in_its_place() {
    let with = |modified: &str, row: &str| {
        mistakes(&room(
            "en-12464-1-2021",
            &format!("[[room]]\nname = \"Office\"\n{row}modified = {modified}\n{DESK}"),
        ))
    };
    let row = "row = \"34.2\"\n";
    assert!(with("{ steps = 1 }", row).contains("the key \"reason\" is missing"));
    assert!(with("{ steps = 1, reason = \" \" }", row).contains("needs its reason"));
    assert!(with("{ steps = 40, reason = \"x\" }", row).contains("leave the norm's scale"));
    assert!(with("{ steps = 1, reason = \"x\" }", "").contains("needs a row to modify"));
    assert!(with("{ reason = \"x\" }", "row = \"12.1\"\n").contains("is not known here"));
}

#[test]
fn what_cannot_be_judged_is_listed_and_never_passes() {
    // A column that the file does not know, a zone without an area, a quantity nobody computes.
    let outcome = solved(&room("en-12464-1-2021", &format!("row = \"13.8\"\n{DESK}")));
    let open: Vec<&Requirement> =
        outcome.requirements.iter().filter(|r| r.verdict == Verdict::NotAssessed).collect();
    let reason = |part: &str| {
        let says =
            |r: &&&Requirement| r.value.as_ref().is_err_and(|undefined| undefined.reason.contains(part));
        open.iter().filter(says).count()
    };
    assert_eq!(reason("no value of em_walls"), 1);
    assert_eq!(reason("no value of em_cylindrical"), 1);
    assert_eq!(reason("lists no surrounding area"), 1, "the desk does not fill the room");
    assert_eq!(reason("lists no background area"), 1);
    assert_eq!(reason("not declared"), 1);
    // A task area that fills the room has nothing around it.
    let whole =
        "[[area]]\nname = \"All\"\nrect = { origin = [0.5, 0.5, 0.75], u = [7, 0, 0], v = [0, 4, 0] }\n";
    let outcome = solved(&room("en-12464-1-2021", &format!("row = \"12.1\"\n{whole}")));
    assert!(of(&outcome, "surrounding area", Statistic::Mean).is_empty());
    // Norms that cannot be judged yet.
    let outcome = solved(&room("en-17037-2018", &format!("row = \"minimum\"\n{DESK}")));
    assert!(!outcome.requirements.is_empty());
    assert!(outcome.requirements.iter().all(|r| r.verdict == Verdict::NotAssessed));
    assert_eq!(outcome.verdict(), None, "nothing was judged");
}

/// Subjects and reasons of what is not assessed and says `part`.
fn unassessed<'a>(outcome: &'a Outcome, part: &str) -> Vec<(&'a str, &'a str)> {
    let open = outcome.requirements.iter().filter(|r| r.verdict == Verdict::NotAssessed);
    open.filter_map(|r| Some((r.subject.as_str(), r.value.as_ref().err()?.reason.as_str())))
        .filter(|(_, reason)| reason.contains(part))
        .collect()
}

/// An upright area `m` wide on a wall of the room, full height.
fn on_wall(name: &str, from: [f64; 2], along: [f64; 2]) -> String {
    let ([x, y], [u, v]) = (from, along);
    format!(
        "[[area]]\nname = \"{name}\"\nkind = \"surface\"\nrect = {{ origin = [{x}, {y}, 0], u = [{u}, {v}, 0], v = [0, 0, 2.8] }}\n"
    )
}

/// Catches: "walls" taken for assessed because one of them, or a strip of it, has an area.
#[test]
fn every_wall_needs_an_area_of_its_own() {
    let south = on_wall("S", [8.0, 0.0], [-8.0, 0.0]);
    let east = on_wall("E", [8.0, 5.0], [0.0, -5.0]);
    let north = on_wall("N", [0.0, 5.0], [8.0, 0.0]);
    let west = on_wall("W", [0.0, 0.0], [0.0, 5.0]);
    let run = |walls: &str| solved(&room("en-12464-1-2021", &format!("row = \"34.2\"\n{DESK}{walls}")));
    let none = run("");
    assert_eq!(unassessed(&none, "lists no wall"), [("wall", "the project lists no wall in this room")]);
    let one = run(&south);
    assert!(of(&one, "S", Statistic::Mean)[0].value.is_ok(), "the listed wall is judged");
    let named: Vec<&str> =
        unassessed(&one, "no area lies on this wall").iter().map(|(wall, _)| *wall).collect();
    assert_eq!(named, ["Wall_E", "Wall_N", "Wall_W"]);
    let half = on_wall("W", [0.0, 2.0], [0.0, 3.0]);
    let most = run(&format!("{south}{east}{north}{half}"));
    assert_eq!(unassessed(&most, "wall"), [("Wall_W", "areas cover only 60 % of this wall")]);
    let all = run(&format!("{south}{east}{north}{west}"));
    assert_eq!(unassessed(&all, "wall"), []);
    // A window that shows through is no wall; a surface taken by its name is the wall.
    let by_name: String = ["S", "E", "N", "W"]
        .map(|wall| format!("[[area]]\nname = \"{wall}\"\nkind = \"surface\"\nsurface = \"Wall_{wall}\"\n"))
        .concat();
    let window = "[materials]\nPane = { glass = 0.9 }\n[[room]]\nname = \"Room\"\nopenings = [{ wall = \"Wall_S\", from = [1, 0.5], to = [7, 2.5], material = \"Pane\" }]\n";
    let glazed = run(&format!("{by_name}{window}"));
    assert_eq!(unassessed(&glazed, "wall"), []);
}

/// Catches: a room taken for filled because the bounding box of a task area fills it, a surrounding of one
/// task that passes for all, a zone with a hole, a task of another row, a volume above the heads.
#[test]
fn every_task_area_needs_the_zones_round_it() {
    let run = |rest: &str| solved(&room("en-12464-1-2021", &format!("row = \"34.2\"\n{rest}")));
    // An L whose bounding box is the room: a corner of 4 × 2.5 m is no task area.
    let l = "[[area]]\nname = \"L\"\npolygon = [[0.5, 0.5, 0.75], [7.5, 0.5, 0.75], [7.5, 2.5, 0.75], [4, 2.5, 0.75], [4, 4.5, 0.75], [0.5, 4.5, 0.75]]\n";
    let corner = run(l);
    assert_eq!(unassessed(&corner, "surrounding area").len(), 1, "the corner is near the task");
    let second =
        "[[area]]\nname = \"Corner\"\nrect = { origin = [4, 2.5, 0.75], u = [3.5, 0, 0], v = [0, 2, 0] }\n";
    let filled = run(&format!("{l}{second}"));
    assert_eq!(unassessed(&filled, "surrounding area"), [], "together they fill the room");
    // Two desks, one surrounding.
    let two = format!("{DESK}{}", DESK.replace("\"Desk\"", "\"Far\"").replace("[3, 2,", "[6, 4,"));
    let around = "[[area]]\nname = \"Around\"\nkind = \"surrounding\"\nof = \"Desk\"\n";
    let both = "[[area]]\nname = \"Around both\"\nkind = \"surrounding\"\nof = \"Far\"\n";
    let reason = "the project lists no surrounding area round this task area";
    assert_eq!(
        unassessed(&run(&format!("{two}{around}")), "surrounding area"),
        [("Far · surrounding area", reason)]
    );
    assert_eq!(unassessed(&run(&format!("{two}{around}{both}")), "surrounding area"), []);
    let strip = "[[area]]\nname = \"South of it\"\nkind = \"surrounding\"\nof = \"Desk\"\nrect = { origin = [2.5, 1.5, 0.75], u = [2.6, 0, 0], v = [0, 0.5, 0] }\n";
    let partly = run(&format!("{DESK}{strip}"));
    // 2.6 × 0.5 m of 2.6 × 1.8 m less the desk; a round of 0.5 m has round corners.
    let found = unassessed(&partly, "surrounding area");
    assert!(found.len() == 1 && found[0].1.starts_with("areas cover only 3"), "{found:?}");
    // A task area of another row does not answer for the room's own.
    let other = run(&DESK.replace("rect", "row = \"34.6\"\nrect"));
    assert_eq!(unassessed(&other, "no task area of row 34.2").len(), 1);
    assert_eq!(unassessed(&run(DESK), "no task area").len(), 0);
    // People sit at 1.2 m, and where the desk is.
    let volume = |at: &str| {
        format!(
            "{DESK}[[area]]\nname = \"Space\"\nkind = \"volume\"\nrect = {{ origin = {at}, u = [2, 0, 0], v = [0, 2, 0] }}\n"
        )
    };
    assert_eq!(unassessed(&run(&volume("[2.8, 1.5, 2.2]")), "no volume at 1.2 m").len(), 1);
    let beside = run(&volume("[3.8, 1.5, 1.2]"));
    assert_eq!(
        unassessed(&beside, "volumes"),
        [("Desk · volume", "volumes at 1.2 m lie over only 50 % of this task area")]
    );
    assert_eq!(unassessed(&run(&volume("[2.8, 1.5, 1.2]")), "volume"), []);
}

#[test]
fn russian_norms_have_their_own_planes_statistics_and_no_zones() {
    let board = "[[area]]\nname = \"Board\"\nrow = \"15-board\"\nrect = { origin = [0.02, 1, 1], u = [0, 3, 0], v = [0, 0, 1] }\n\
                 [[area]]\nname = \"Flat\"\nrow = \"15-board\"\nrect = { origin = [1, 1, 1.5], u = [1, 0, 0], v = [0, 1, 0] }\n\
                 [[area]]\nname = \"Screen\"\nrow = \"17-screen\"\nrect = { origin = [4, 1, 1], u = [0, 1, 0], v = [0, 0, 0.5] }\n";
    let declared = "[declared]\nA = { ra = 80, flicker = { pulsation = 12 } }\n";
    let text = room("sanpin-1.2.3685-21", &format!("row = \"15\"\n{DESK}{board}{declared}"));
    let outcome = solved(&text);
    let upright = of(&outcome, "Board", Statistic::Mean)[0];
    assert_eq!((upright.quantity, upright.bound), (Quantity::Normal, Bound::Min(500.0)));
    let flat = of(&outcome, "Flat", Statistic::Mean)[0];
    assert_eq!(flat.verdict, Verdict::NotAssessed, "a board is upright");
    let screen = of(&outcome, "Screen", Statistic::Mean)[0];
    assert_eq!((screen.bound, screen.verdict), (Bound::Max(200.0), Verdict::Fail), "200 lx is a maximum");
    assert!(of(&outcome, "surrounding area", Statistic::Mean).is_empty());
    let pulsation: Vec<_> = outcome.requirements.iter().filter(|r| r.quantity.key() == "pulsation").collect();
    assert!(pulsation.iter().any(|r| r.verdict == Verdict::Fail), "12 % declared, 10 % allowed");
    let table = outcome.rooms[0].ugr_table.first().expect("a table");
    assert!((table.shr - 1.0).abs() < 1e-9, "GOST 33392: spacing to height 1");
    assert!(
        outcome.plan.iter().any(|reason| reason.contains("names a plane at 0.80 m")),
        "{:?}",
        outcome.plan
    );
    // The norm's own areas: a plane at 0.8 m and nothing at walls or ceiling.
    let outcome = solved(&room("sanpin-1.2.3685-21", "row = \"15\"\n"));
    let areas = &outcome.rooms[0].areas;
    assert_eq!(areas.iter().filter(|area| area.name.contains("working plane")).count(), 1);
    assert!((areas[0].grid.points[0].position.z - 0.8).abs() < 1e-9);
    assert!(areas.iter().all(|area| !area.name.contains("Wall") && !area.name.contains("ceiling")));
    // A house norm that limits the minimum.
    let house = "id = \"house\"\n[application]\nilluminance_statistic = { value = \"min\" }\n[[row]]\nref = \"1\"\nem = 100\nm = 40\n";
    let folder =
        folder(&room("house.toml", &format!("row = \"1\"\n{DESK}")), &[("house.toml".into(), house.into())]);
    let outcome = projects::run_folder(folder.path(), 32, Effort::default());
    assert_eq!(of(&outcome, "Desk", Statistic::Min)[0].bound, Bound::Min(100.0));
    let m = outcome
        .requirements
        .iter()
        .find(|r| r.quantity == Quantity::DiscomfortIndex)
        .expect("M is asked for");
    let ugr = outcome.rooms[0].ugr_table.iter().flat_map(|t| [&t.crosswise, &t.endwise]).flatten();
    let worst = ugr.copied().fold(f64::NEG_INFINITY, f64::max);
    let expected = 10f64.powf((worst + 4.8) / 16.0);
    assert!((m.value.as_ref().expect("a value") - expected).abs() < 1e-9 * expected);
}

#[test]
fn sports_have_odd_grids_and_a_total_area_that_is_compared_with_the_court() {
    let court = "row = \"volleyball-III\"\n[[area]]\nname = \"Court\"\nrect = { origin = [1, 1, 0], u = [6, 0, 0], v = [0, 3, 0] }\n\
                 [[area]]\nname = \"Total\"\nkind = \"surrounding\"\nof = \"Court\"\nrect = { origin = [0, 0, 0], u = [8, 0, 0], v = [0, 5, 0] }\n";
    let outcome = solved(&room("en-12193-2018", court));
    for area in &outcome.rooms[0].areas {
        assert!(area.grid.columns % 2 == 1 && area.grid.rows % 2 == 1, "{}", area.name);
        // The total area holds the court.
        assert!(area.grid.points.iter().all(|point| point.excluded.is_none()), "{}", area.name);
    }
    let share = of(&outcome, "Total", Statistic::OfTask)[0];
    let mean = |area: &str| {
        let points = projects::points(&outcome, area, "E_h", "all");
        points.iter().map(|point| point.value).sum::<f64>() / points.len() as f64
    };
    let expected = mean("Total") / mean("Court");
    let value = *share.value.as_ref().expect("a value");
    assert!((value - expected).abs() < 1e-9 && share.lo_joint < value && value < share.hi_joint);
    assert_eq!(share.bound, Bound::Min(0.75));
}

/// Catches: a zone of the wrong width, one that counts the task's own points, one that vanishes.
#[test]
fn a_norm_draws_its_zones_round_a_task() {
    let zones = "[[area]]\nname = \"Around\"\nkind = \"surrounding\"\nof = \"Desk\"\n\
                 [[area]]\nname = \"Beyond\"\nkind = \"background\"\nof = \"Desk\"\n";
    let outcome = solved(&room("en-12464-1-2021", &format!("row = \"34.2\"\n{zones}{DESK}")));
    let area =
        |name: &str| outcome.rooms[0].areas.iter().find(|area| area.name == name).expect("it is there");
    let size = |name: &str| [area(name).grid.edge_u.length(), area(name).grid.edge_v.length()];
    let close = |found: [f64; 2], wanted: [f64; 2]| {
        (found[0] - wanted[0]).abs() < 1e-9 && (found[1] - wanted[1]).abs() < 1e-9
    };
    assert!(close(size("Around"), [2.6, 1.8]), "{:?}", size("Around"));
    // 3.5 m round a desk from (3, 2) to (4.6, 2.8): the walls cut it to 8 × 5 m.
    assert!(close(size("Beyond"), [8.0, 5.0]), "{:?}", size("Beyond"));
    let inside = |name: &str, lo: [f64; 2], hi: [f64; 2]| {
        let points = area(name).grid.points.iter().filter(|point| point.excluded.is_none());
        points
            .filter(|p| {
                p.position.x > lo[0] && p.position.x < hi[0] && p.position.y > lo[1] && p.position.y < hi[1]
            })
            .count()
    };
    assert_eq!(inside("Around", [3.0, 2.0], [4.6, 2.8]), 0, "the task's points are its own");
    assert_eq!(inside("Beyond", [2.5, 1.5], [5.1, 3.3]), 0, "and so are the surrounding's");
    assert_eq!(of(&outcome, "Around", Statistic::Mean)[0].bound, Bound::Min(300.0));
    let Bound::Min(beyond) = of(&outcome, "Beyond", Statistic::Mean)[0].bound else { panic!("a minimum") };
    assert!((beyond - 100.0).abs() < 1e-9);
    // Norms without zones, and tasks that are not there, are told.
    let no_zones = mistakes(&room("sanpin-1.2.3685-21", &format!("row = \"15\"\n{zones}{DESK}")));
    assert!(no_zones.contains("no norm says how wide"), "{no_zones}");
    let lost = mistakes(&room(
        "en-12464-1-2021",
        &format!("row = \"34.2\"\n{}{DESK}", zones.replace("\"Desk\"", "\"Desq\"")),
    ));
    assert!(lost.contains("no task area \"Desq\""), "{lost}");
}

/// Exit code of `check` with arguments.
fn exit(project: &Path, arguments: &[&str]) -> Option<i32> {
    let out = tempfile::tempdir().expect("a temporary folder");
    let mut command = Command::new(env!("CARGO_BIN_EXE_gershun"));
    command.arg("check").arg("-q").arg("--out").arg(out.path().join("report")).args(arguments).arg(project);
    command.output().expect("the program starts").status.code()
}

#[test]
fn a_script_chooses_what_undecided_means() {
    // Two blocks leave a mean undecided between wide limits.
    let text = room("en-12464-1-2021", DESK);
    let points = projects::points(&run(&text, &[], 2, Effort::default()), "Desk", "E_h", "all");
    let value = points.iter().map(|point| point.value).sum::<f64>() / points.len() as f64;
    let limit = format!("{text}[[require]]\narea = \"Desk\"\nquantity = \"E_h\"\nmin = {}\n", value * 1.0001);
    let outcome = run(&limit, &[], 2, Effort::default());
    let own = outcome.requirements.iter().find(|r| r.standard == "project").expect("required");
    let folder = folder(&limit, &[]);
    let two = |policy: &str| exit(folder.path(), &["--blocks", "2", "--undecided", policy]);
    if own.verdict == Verdict::Undecided {
        assert!(own.blocks_needed.is_some_and(|blocks| blocks > 2));
        assert_eq!([two("3"), two("fail"), two("pass")], [Some(3), Some(1), Some(0)]);
    } else {
        panic!("two blocks decided {own:?}");
    }
    // A requirement without a value is not nearly met: no policy lets it pass.
    let dark = text.replace("[norm]\nstandard = \"en-12464-1-2021\"\n", "")
        + "[[viewpoint]]\nname = \"Up\"\neye = [4, 2, 1.2]\ndirection = [0, 0, -1]\n[[require]]\nviewpoint = \"Up\"\nquantity = \"UGR\"\nmax = 19\n";
    let folder = projects::folder(&dark, &[]);
    assert_eq!(exit(folder.path(), &["--blocks", "32", "--undecided", "pass"]), Some(3));
}

#[test]
fn every_row_of_every_norm_can_be_shown_and_explained() {
    let gershun = |arguments: &[&str]| {
        let output =
            Command::new(env!("CARGO_BIN_EXE_gershun")).args(arguments).output().expect("the program starts");
        (output.status.code(), String::from_utf8(output.stdout).expect("UTF-8"), output.stderr)
    };
    let (code, list, _) = gershun(&["norm", "list"]);
    assert_eq!(code, Some(0));
    for line in list.lines() {
        let name = line.split_whitespace().next().expect("a name");
        let (code, rows, _) = gershun(&["norm", "show", name]);
        assert_eq!(code, Some(0), "{name}");
        let standard =
            gershun::norm::bundled().iter().find(|(id, _)| *id == name).expect("listed norms are bundled");
        let standard = gershun::norm::Standard::parse(standard.1, name).expect("parses");
        for row in &standard.rows {
            assert!(rows.contains(&format!("\n{}  {}", row.reference, row.area)), "{name} {}", row.reference);
        }
        // One row through the program, all through the library (see norm/explain.rs).
        let last = &standard.rows[standard.rows.len() - 1].reference;
        for command in ["show", "explain"] {
            assert_eq!(gershun(&["norm", command, name, last]).0, Some(0), "{name} {last}");
        }
        assert_eq!(gershun(&["norm", "explain", name]).0, Some(0), "{name}");
    }
    let (code, _, errors) = gershun(&["norm", "show", "en-12464-1-2021", "34.22"]);
    assert_eq!(code, Some(2));
    assert!(String::from_utf8_lossy(&errors).contains("did you mean \"34.2\"?"));
}
