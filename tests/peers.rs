//! Scene A of the peers as a project: work plane, cylindrical and vertical illuminance against
//! converged references of other programs. The plates of that scene's openings are black.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;
mod projects;

use std::fmt::Write;

use common::{cpu_seconds, data};
use gershun::solve::Effort;

/// Reference rows: x, y, z, E, standard error.
fn reference(name: &str) -> Option<Vec<[f64; 5]>> {
    let text = std::fs::read_to_string(data()?.join("peers").join(name)).ok()?;
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(',').filter_map(|field| field.parse().ok()).collect();
        [numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]]
    };
    Some(text.lines().skip(1).map(row).collect())
}

/// The project; `reflectance` of the walls is what the broken twin changes.
fn project(area: &str, quantity: &str, wall: f64) -> String {
    let mut text = format!(
        "[scene]\nbox = {{ size = [8, 5, 2.8], floor = 0.2, walls = {wall}, ceiling = 0.7 }}\n\
         [materials]\nBlack = {{ reflectance = 0 }}\n\
         [luminaires.A]\nlambert = {{ flux = 3600 }}\narea = {{ rect = [0.6, 0.6] }}\n\
         [[area]]\nname = \"{area}\"\npoints = \"points.csv\"\nquantities = [\"{quantity}\"]\n"
    );
    for x in [4.0 / 3.0, 4.0, 20.0 / 3.0] {
        for y in [1.25, 3.75] {
            let (cx, cy) = (x - 0.3, y - 0.3);
            write!(text, "[[place]]\nluminaire = \"A\"\nat = [{x}, {y}, 2.799]\n").expect("a string");
            write!(
                text,
                "[[furniture]]\nat = [{cx}, {cy}, 2.799]\nsize = [0.6, 0.6, 0.001]\nmaterial = \"Black\"\n"
            )
            .expect("a string");
        }
    }
    text
}

/// Largest error in combined standard errors, and RMS of the relative errors.
fn compare(rows: &[[f64; 5]], quantity: &str, wall: f64, blocks: usize) -> (f64, f64) {
    let mut csv = String::from("x,y,z\n");
    for row in rows {
        writeln!(csv, "{},{},{}", row[0], row[1], row[2]).expect("a string");
    }
    let before = cpu_seconds();
    let effort = Effort { particles: 1, ..Effort::default() };
    let files = [("points.csv".to_owned(), csv.into_bytes())];
    let outcome = projects::run(&project("plane", quantity, wall), &files, blocks, effort);
    let cpu = cpu_seconds() - before;
    let points = projects::points(&outcome, "plane", quantity, "all");
    assert_eq!(points.len(), rows.len(), "every reference point is evaluated");
    let (mut worst, mut square) = (0f64, 0.0);
    for (point, row) in points.iter().zip(rows) {
        worst = worst.max((point.value - row[3]).abs() / point.se.hypot(row[4]));
        square += (point.value / row[3] - 1.0).powi(2) / rows.len() as f64;
    }
    println!(
        "{quantity}, walls {wall}: worst {worst:.2} standard errors, RMS {:.3} %, {cpu:.2} CPU-s",
        100.0 * square.sqrt()
    );
    (worst, square.sqrt())
}

#[test]
fn scene_a_agrees_with_other_programs() {
    let cases = [
        ("A_wp_reference.csv", "E_h", 96),
        ("A_cyl_reference.csv", "E_cyl", 384),
        ("A_vert_reference.csv", "E_v@0", 512),
    ];
    for (file, quantity, blocks) in cases {
        let Some(rows) = reference(file) else {
            println!("skipped: no reference data");
            return;
        };
        let (worst, rms) = compare(&rows, quantity, 0.5, blocks);
        assert!(worst <= 4.0, "{quantity}: {worst} combined standard errors");
        assert!(rms <= 0.005, "{quantity}: RMS {rms}");
        let (twin, twin_rms) = compare(&rows, quantity, 0.52, blocks);
        assert!(twin > 4.0 || twin_rms > 0.005, "{quantity}: walls of 0.52 pass");
    }
}
