//! A glare map of the office, 1 000 eyes × 8 directions: time after the solve, and the largest error of
//! UGR against unbiased values of many blocks; the worst eyes are looked at again by so many that the
//! reference's own noise does not count. `cargo run --release --example glare_map [BLOCKS [RAYS WALKS
//! ROUGH]]`

#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use gershun::emitters::{Emitters, Sighted, seen_by_points, shining_in_pieces};
use gershun::observe::map::{
    MappedEye, USUAL, field_effort, mend_for, swift_eyes, unbiased_at, unbiased_eyes,
};
use gershun::project::Project;
use gershun::query::Demand;
use gershun::solve::{Effort, GlanceEffort, Method, prepare};
use glam::DVec3;

const MAP: &str = "\n[[glare_map]]\nrect = { origin = [0, 0, 1.2], u = [8, 0, 0], v = [0, 5, 0] }\nstep = 0.2\nindices = [\"L_b\", \"E_dir\"]\n";

fn main() {
    let reference_blocks = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(128);
    let project = common::office_with(MAP);
    let world = &project.worlds[0];
    let mut reference = reference(&project, reference_blocks);
    let (demand, map) = (Demand::default(), &world.glare_maps[0]);
    let (cpu, wall) = (common::cpu_seconds(), Instant::now());
    let seed = project.accuracy.seed;
    let prepared = prepare(&world.scene, &demand, Method::Links, field_effort(&world.scene), seed);
    let number = |place: usize, usual: u32| {
        std::env::args().nth(place).and_then(|text| text.parse().ok()).unwrap_or(usual)
    };
    let fraction = |place: usize, usual: f64| {
        std::env::args().nth(place).and_then(|text| text.parse().ok()).unwrap_or(usual)
    };
    let effort = GlanceEffort {
        rays: number(2, USUAL.rays),
        walks: number(3, USUAL.walks),
        rough: fraction(4, USUAL.rough),
        ..USUAL
    };
    let mended = mend_for(map, &prepared, &effort);
    println!(
        "field and its mending: {:.2} CPU-s, {:.2} s",
        common::cpu_seconds() - cpu,
        wall.elapsed().as_secs_f64()
    );
    let (cpu, wall) = (common::cpu_seconds(), Instant::now());
    let eyes = swift_eyes(&project, world, map, &prepared, &mended, &effort);
    println!("map: {:.2} CPU-s, {:.2} s", common::cpu_seconds() - cpu, wall.elapsed().as_secs_f64());
    compare(&project, &eyes, &mut reference);
}

/// Unbiased values by blocks with many rays each.
fn reference(project: &Project, blocks: usize) -> Vec<MappedEye> {
    let world = &project.worlds[0];
    let effort = Effort { gather: 256, walks: 64, links: 128, ..field_effort(&world.scene) };
    unbiased_eyes(project, world, blocks, effort).remove(0)
}

/// The same at some eyes with so many blocks and points on openings that its own noise does not count.
fn fine_reference(project: &Project, eyes: &[DVec3]) -> Vec<MappedEye> {
    let world = &project.worlds[0];
    let effort = Effort { gather: 256, walks: 64, links: 128, ..field_effort(&world.scene) };
    let see = |emitters: &Emitters, eye: DVec3| Sighted {
        eye,
        luminaires: seen_by_points(emitters, eye, 77, FINE_POINTS),
        surfaces: shining_in_pieces(emitters, eye, 77, 1e-3),
        glints: None,
    };
    unbiased_at(project, world, &[(&world.glare_maps[0], eyes.to_vec())], FINE_BLOCKS, effort, see).remove(0)
}

/// Blocks of the fine reference, points on each opening in each of 16 replicates, eyes for each turn.
const FINE_BLOCKS: usize = 1024;
const FINE_POINTS: u32 = 2048;
const TURN: usize = 24;
/// UGR below this is no glare.
const FLOOR: f64 = 10.0;

/// UGR with its standard error, L_b and E_dir of a direction; zeros where there is none.
fn figures(eye: &MappedEye, direction: usize) -> [f64; 4] {
    let (ugr, further) = &eye.views[direction];
    let of = |key: &str| {
        let index = further.iter().find(|index| index.key == key);
        index.and_then(|index| Some(index.estimate.as_ref().ok()?.value)).unwrap_or(f64::NAN)
    };
    let ugr = ugr.as_ref().map_or([0.0; 2], |ugr| [ugr.value, ugr.se]);
    [ugr[0], ugr[1], of("L_b"), of("E_dir")]
}

fn error(own: &MappedEye, truth: &MappedEye, direction: usize) -> f64 {
    figures(own, direction)[0].max(FLOOR) - figures(truth, direction)[0].max(FLOOR)
}

fn compare(project: &Project, eyes: &[MappedEye], reference: &mut [MappedEye]) {
    let directions = eyes[0].views.len();
    let mut fine = vec![false; eyes.len()];
    let worst = |reference: &[MappedEye], eye: usize| {
        (0..directions).map(|k| error(&eyes[eye], &reference[eye], k).abs()).fold(0.0, f64::max)
    };
    summary("against the reference of all eyes", eyes, reference);
    // The worst eyes are looked at again until the worst of all is one of those.
    for _ in 0..6 {
        let mut order: Vec<usize> = (0..eyes.len()).collect();
        order.sort_by(|&a, &b| worst(reference, b).total_cmp(&worst(reference, a)));
        if fine[order[0]] {
            break;
        }
        let again: Vec<usize> = order.into_iter().filter(|&eye| !fine[eye]).take(TURN).collect();
        let positions: Vec<DVec3> = again.iter().map(|&eye| eyes[eye].position).collect();
        for (&eye, found) in again.iter().zip(fine_reference(project, &positions)) {
            reference[eye] = found;
            fine[eye] = true;
        }
    }
    let count = fine.iter().filter(|fine| **fine).count();
    summary(&format!("with {count} eyes of a finer reference"), eyes, reference);
}

fn summary(name: &str, eyes: &[MappedEye], reference: &[MappedEye]) {
    let mut all: Vec<(f64, usize, usize)> = Vec::new();
    let mut undefined = 0;
    for (number, (own, truth)) in eyes.iter().zip(reference).enumerate() {
        for direction in 0..own.views.len() {
            undefined += usize::from(own.views[direction].0.is_ok() != truth.views[direction].0.is_ok());
            all.push((error(own, truth, direction), number, direction));
        }
    }
    let n = all.len() as f64;
    let mean = all.iter().map(|e| e.0).sum::<f64>() / n;
    let rms = (all.iter().map(|e| e.0 * e.0).sum::<f64>() / n).sqrt();
    all.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let over = all.iter().filter(|e| e.0.abs() > 0.15).count();
    println!(
        "{name}: {} values, mean error {mean:.4}, rms {rms:.4}, largest {:.3}, {over} above 0.15; {undefined} defined in one only",
        all.len(),
        all[0].0
    );
    for &(error, eye, direction) in all.iter().take(10) {
        let [own, truth] = [&eyes[eye], &reference[eye]].map(|of| figures(of, direction));
        // UGR = 8 lg(0.25 S/L_b): what the background and what the sources account for.
        let by_background = -8.0 * (own[2] / truth[2]).log10();
        println!(
            "    {error:.3} of {:.2} ± {:.3} (own {:.2} ± {:.3}): background {by_background:.3}, sources {:.3}; at {} direction {direction}",
            truth[0],
            truth[1],
            own[0],
            own[1],
            own[0] - truth[0] - by_background,
            eyes[eye].position
        );
    }
}
