//! A glare map of the office, 1 000 eyes × 8 directions: time after the solve, and the largest error of
//! UGR against unbiased values of many blocks. `cargo run --release --example glare_map`

#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use gershun::observe::map::{MappedEye, USUAL, field_effort, mend_for, swift_eyes, unbiased_eyes};
use gershun::project::{LoadOptions, Project, load};
use gershun::query::Demand;
use gershun::solve::{Effort, Method, prepare};

const MAP: &str =
    "\n[[glare_map]]\nrect = { origin = [0, 0, 1.2], u = [8, 0, 0], v = [0, 5, 0] }\nstep = 0.2\n";

fn main() {
    let reference_blocks = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(128);
    let folder = tempfile::tempdir().expect("a folder");
    for entry in std::fs::read_dir("scenes/office").expect("the office").flatten() {
        std::fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("copied");
    }
    let path = folder.path().join("project.toml");
    let text = std::fs::read_to_string(&path).expect("text") + MAP;
    std::fs::write(&path, text).expect("written");
    let project = load(folder.path(), &LoadOptions::default()).expect("loads");
    let world = &project.worlds[0];
    let reference = reference(&project, reference_blocks);
    let (demand, map) = (Demand::default(), &world.glare_maps[0]);
    let (cpu, wall) = (common::cpu_seconds(), Instant::now());
    let seed = project.accuracy.seed;
    let prepared = prepare(&world.scene, &demand, Method::Links, field_effort(&world.scene), seed);
    let mended = mend_for(map, &prepared, &USUAL);
    println!(
        "field and its mending: {:.2} CPU-s, {:.2} s",
        common::cpu_seconds() - cpu,
        wall.elapsed().as_secs_f64()
    );
    let (cpu, wall) = (common::cpu_seconds(), Instant::now());
    let eyes = swift_eyes(&project, world, map, &prepared, &mended, &USUAL);
    println!("map: {:.2} CPU-s, {:.2} s", common::cpu_seconds() - cpu, wall.elapsed().as_secs_f64());
    compare(&eyes, &reference);
}

type Values = Vec<Vec<Option<[f64; 2]>>>;

/// Unbiased values by blocks with many rays each.
fn reference(project: &Project, blocks: usize) -> Values {
    let world = &project.worlds[0];
    let effort = Effort { gather: 256, walks: 64, links: 128, ..field_effort(&world.scene) };
    let of_eye = |eye: &MappedEye| {
        eye.views.iter().map(|(ugr, _)| ugr.as_ref().ok().map(|ugr| [ugr.value, ugr.se])).collect()
    };
    unbiased_eyes(project, world, blocks, effort)[0].iter().map(of_eye).collect()
}

/// UGR below this is no glare.
const FLOOR: f64 = 10.0;

fn compare(eyes: &[MappedEye], reference: &Values) {
    let mut errors = Vec::new();
    let (mut undefined, mut covered) = (0, 0);
    for (eye, truth) in eyes.iter().zip(reference) {
        for (direction, ((ugr, _), truth)) in eye.views.iter().zip(truth).enumerate() {
            let own = ugr.as_ref().map_or([0.0; 2], |ugr| [ugr.value, ugr.se]);
            let truth = truth.unwrap_or_default();
            undefined += usize::from((own[0] == 0.0) != (truth[0] == 0.0));
            let error = own[0].max(FLOOR) - truth[0].max(FLOOR);
            covered += usize::from(error.abs() < 2.0 * own[1].hypot(truth[1]));
            errors.push((error, truth[0], truth[1], own[1], eye.position, direction));
        }
    }
    let n = errors.len() as f64;
    let mean = errors.iter().map(|e| e.0).sum::<f64>() / n;
    let rms = (errors.iter().map(|e| e.0 * e.0).sum::<f64>() / n).sqrt();
    errors.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    println!(
        "  {} values, mean error {mean:.4}, rms {rms:.4}, largest {:.3}; {undefined} defined in one only; {covered} covered",
        errors.len(),
        errors[0].0
    );
    for (error, truth, se, own, at, direction) in errors.iter().take(6) {
        println!("    {error:.3} of {truth:.2} ± {se:.3} (own se {own:.3}) at {at} direction {direction}");
    }
}
