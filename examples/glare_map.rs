//! A glare map of the office, 1 000 eyes × 8 directions: time after the solve, and the largest error of
//! UGR against unbiased values of many blocks. `cargo run --release --example glare_map`

#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use gershun::observe::map::{MappedEye, field_effort, mend_for, swift_eyes, unbiased_eyes};
use gershun::project::{LoadOptions, load};
use gershun::query::Demand;
use gershun::solve::{Effort, GlanceEffort, Method, prepare};

const MAP: &str =
    "\n[[glare_map]]\nrect = { origin = [0, 0, 1.2], u = [8, 0, 0], v = [0, 5, 0] }\nstep = 0.2\n";

fn main() {
    let reference_blocks = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(1024);
    let folder = tempfile::tempdir().expect("a folder");
    for entry in std::fs::read_dir("scenes/office").expect("the office").flatten() {
        std::fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("copied");
    }
    let path = folder.path().join("project.toml");
    let text = std::fs::read_to_string(&path).expect("text") + MAP;
    std::fs::write(&path, text).expect("written");
    let project = load(folder.path(), &LoadOptions::default()).expect("loads");
    let world = &project.worlds[0];
    let started = Instant::now();
    let unbiased = cached(&project, reference_blocks);
    let reference = unbiased;
    println!("reference: {reference_blocks} blocks, {:.1} s", started.elapsed().as_secs_f64());
    for line in std::io::stdin().lines().map_while(Result::ok) {
        let n: Vec<f64> = line.split_whitespace().filter_map(|t| t.parse().ok()).collect();
        let mut field = field_effort(&world.scene);
        field.patch_m2 = field.patch_m2.map(|m2| m2 * 3000.0 / n[0]);
        field.links = n[1] as u32;
        field.looks = n[5] as u32;
        field.shadow_rays = n[6];
        let effort = GlanceEffort { replicates: n[2] as u32, rays: n[3] as u32, walks: n[4] as u32 };
        let demand = Demand::default();
        let (cpu, wall) = (common::cpu_seconds(), Instant::now());
        let prepared = prepare(&world.scene, &demand, Method::Links, field, project.accuracy.seed);
        let mended = mend_for(&world.glare_maps[0], &prepared, &effort);
        let (solved, solved_wall) = (common::cpu_seconds() - cpu, wall.elapsed().as_secs_f64());
        let (cpu, wall) = (common::cpu_seconds(), Instant::now());
        let eyes = swift_eyes(&project, world, &world.glare_maps[0], &prepared, &mended, &effort);
        println!(
            "{n:?}: solve {solved:.2} CPU-s {solved_wall:.2} s; map {:.2} CPU-s {:.2} s",
            common::cpu_seconds() - cpu,
            wall.elapsed().as_secs_f64()
        );
        compare(&eyes, &reference);
    }
}

type Values = Vec<Vec<Option<[f64; 2]>>>;

fn cached(project: &gershun::project::Project, blocks: usize) -> Values {
    let path = format!("target/map_{blocks}_looks.json");
    if let Ok(text) = std::fs::read_to_string(&path) {
        return serde_json::from_str(&text).expect("json");
    }
    let values = fresh(project, blocks);
    std::fs::write(&path, serde_json::to_string(&values).expect("json")).expect("written");
    values
}

fn fresh(project: &gershun::project::Project, blocks: usize) -> Values {
    let world = &project.worlds[0];
    let effort = Effort {
        gather: 256,
        walks: 64,
        links: 128,
        looks: 32,
        shadow_rays: 24.0,
        ..field_effort(&world.scene)
    };
    values(&unbiased_eyes(project, world, blocks, effort)[0])
}

fn values(eyes: &[MappedEye]) -> Values {
    eyes.iter()
        .map(|eye| eye.views.iter().map(|(ugr, _)| ugr.as_ref().ok().map(|u| [u.value, u.se])).collect())
        .collect()
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
