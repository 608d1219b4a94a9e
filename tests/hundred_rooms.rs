//! A building of a hundred rooms, judged. Catches: a room lost or judged twice, light or areas of one
//! room counted in another, declarations that hold for the first room only, an exit code that hides
//! one failing room.

mod projects;

use std::collections::BTreeSet;
use std::fmt::Write;
use std::process::Command;

use gershun::solve::Effort;
use serde_json::Value;

const ROOMS: usize = 100;
/// The room with a hundredth of the light.
const DARK: usize = 37;

/// Rooms of 2.5 … 6 m in a row of ten each, 10 m apart; types A and B alternate.
fn building(dark: Option<usize>) -> String {
    let mut text = "[project]\nname = \"Building\"\n\
        [luminaires.A]\nlambert = { flux = 5000 }\narea = { rect = [1.2, 0.3] }\n\
        [luminaires.B]\nlambert = { flux = 4500 }\narea = { disc = 0.6 }\nmaintenance = 0.85\n\
        [declared]\nA = { ra = 90 }\nB = { ra = 90 }\n"
        .to_owned();
    for index in 0..ROOMS {
        let (x, y) = (10.0 * (index % 10) as f64, 10.0 * (index / 10) as f64);
        let (length, width) = (2.5 + 0.35 * (index % 11) as f64, 2.5 + 0.5 * (index % 7) as f64);
        let height = 2.5 + 0.1 * (index % 5) as f64;
        let (right, top) = (x + length, y + width);
        let llmf = 0.95 - 0.01 * (index % 3) as f64;
        let kind = ["A", "B"][index % 2];
        let (rows, columns) = ((width / 1.6).ceil(), (length / 1.6).ceil());
        let dim = if dark == Some(index) { 0.01 } else { 1.0 };
        write!(
            text,
            "[[room]]\nname = \"R{index:03}\"\nnumber = \"{}.{:02}\"\n\
             footprint = [[{x}, {y}], [{right}, {y}], [{right}, {top}], [{x}, {top}]]\nheight = {height}\n\
             reflectances = {{ floor = 0.2, walls = 0.5, ceiling = 0.7 }}\nmf = {{ llmf = {llmf} }}\n\
             [[place]]\nluminaire = \"{kind}\"\ndim = {dim}\n\
             field = {{ room = \"R{index:03}\", rows = {rows}, columns = {columns}, height = {height} }}\n\
             [[area]]\nname = \"Desk {index:03}\"\nrow = \"34.2\"\n\
             rect = {{ origin = [{}, {}, 0.75], u = [1, 0, 0], v = [0, 1, 0] }}\n",
            index / 10 + 1,
            index % 10 + 1,
            x + 0.5 * length - 0.5,
            y + 0.5 * width - 0.5,
        )
        .expect("a String takes everything");
    }
    text + "[norm]\nstandard = \"en-12464-1-2021\"\nrow = \"34.2\"\n"
}

fn check(text: &str, arguments: &[&str]) -> (Option<i32>, Value) {
    let folder = projects::folder(text, &[]);
    let out = folder.path().join("out");
    let start = std::time::Instant::now();
    let output = Command::new(env!("CARGO_BIN_EXE_gershun"))
        .args(["check", "--format", "json", "--out"])
        .arg(&out)
        .args(arguments)
        .arg(folder.path())
        .output()
        .expect("the program starts");
    eprintln!("{ROOMS} rooms: {:.1} s, {arguments:?}", start.elapsed().as_secs_f64());
    let errors = String::from_utf8_lossy(&output.stderr);
    let result = serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{e}\n{errors}"));
    (output.status.code(), result)
}

fn list<'v>(value: &'v Value, key: &str) -> &'v [Value] {
    value[key].as_array().expect("a list")
}

/// Mean E_h of every room's desk, by the library with little effort: only ratios matter.
fn desk_means(text: &str) -> Vec<f64> {
    let effort = Effort { patch_m2: Some(1.0), links: 8, particles: 16, ..Effort::default() };
    let outcome = projects::run(text, &[], 2, effort);
    let means = outcome.values.iter().filter(|v| v.quantity == "E_h" && v.statistic == "mean");
    means.map(|v| v.estimate.as_ref().expect("a value").value).collect()
}

#[test]
fn every_room_is_there_judged_by_its_own_light() {
    let (code, result) = check(&building(Some(DARK)), &["--blocks", "4"]);
    assert_eq!(code, Some(1), "one dark room fails the building");
    let names: Vec<&str> = list(&result, "rooms").iter().map(|r| r["name"].as_str().unwrap()).collect();
    let expected: Vec<String> = (0..ROOMS).map(|index| format!("R{index:03}")).collect();
    assert_eq!(names, expected, "every room once, in the project's order");
    let requirements = list(&result, "requirements");
    let judged: BTreeSet<&str> = requirements.iter().map(|r| r["room"].as_str().unwrap()).collect();
    assert_eq!(judged.len(), ROOMS);
    for requirement in requirements.iter().filter(|r| r["quantity"] == "R_a") {
        assert_eq!(requirement["outcome"], "declared", "R_a is declared for every type: {requirement}");
    }
    let desk = format!("Desk {DARK:03}");
    let failing = requirements.iter().filter(|r| r["subject"] == desk && r["outcome"] == "fail");
    assert!(failing.clone().any(|r| r["quantity"] == "E_h" && r["statistic"] == "mean"), "{desk} is dark");
}

#[test]
fn dimming_one_room_changes_no_other() {
    let (before, after) = (desk_means(&building(None)), desk_means(&building(Some(DARK))));
    assert_eq!((before.len(), after.len()), (ROOMS, ROOMS));
    for (index, (a, b)) in before.iter().zip(&after).enumerate() {
        assert!((100.0..5000.0).contains(a), "room {index}: {a} lx");
        let factor = if index == DARK { 0.01 } else { 1.0 };
        assert!((b / a / factor - 1.0).abs() < 1e-9, "room {index}: {a} lx, {b} lx");
    }
}
