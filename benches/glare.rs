//! What glare costs once light is solved: a listed viewpoint with its card from a kept field, and a map of
//! 1 000 eyes × 8 directions. The least of several turns, for machines are noisy. `cargo bench --bench glare [PART OF A NAME]`

#![allow(clippy::print_stdout, reason = "a bench prints")]
#![allow(dead_code, reason = "what tests share is more than is timed here")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use gershun::observe::Sheets;
use gershun::observe::map::{USUAL, field_effort, mend_for, swift_eyes};
use gershun::observe::stored::observe_stored;
use gershun::project::Project;
use gershun::query::Demand;
use gershun::solve::picture::expose;
use gershun::solve::{Method, prepare};

const TURNS: usize = 7;
const MAP: &str =
    "\n[[glare_map]]\nrect = { origin = [0, 0, 1.2], u = [8, 0, 0], v = [0, 5, 0] }\nstep = 0.2\n";

fn main() {
    let project = common::office_with(MAP);
    map(&project);
    viewpoint(project);
}

/// One viewpoint in its one direction, its indices and its card.
fn viewpoint(mut project: Project) {
    let seed = project.accuracy.seed;
    let field = expose(&project.worlds[0].scene, seed).into_stored();
    project.worlds[0].viewpoints.truncate(1);
    for (name, sheets) in [("a viewpoint", Sheets::None), ("a viewpoint with its card", Sheets::All)] {
        let mut fields = vec![vec![field.clone()]; TURNS];
        time(name, || observe_stored(&project, fields.pop().expect("one for each turn"), sheets));
    }
}

fn map(project: &Project) {
    let world = &project.worlds[0];
    let (demand, map) = (Demand::default(), &world.glare_maps[0]);
    let seed = project.accuracy.seed;
    let prepared = time("the field of a map", || {
        prepare(&world.scene, &demand, Method::Links, field_effort(&world.scene), seed)
    });
    let mended = time("what walks mend of it", || mend_for(map, &prepared, &USUAL));
    time("a map of 1 000 eyes × 8 directions", || {
        swift_eyes(project, world, map, &prepared, &mended, &USUAL)
    });
}

/// Prints the least CPU and wall time of some turns of a piece of work, and returns what the last made.
fn time<R>(name: &str, mut work: impl FnMut() -> R) -> R {
    let mut least = [f64::INFINITY; 2];
    let mut turn = || {
        let (cpu, wall) = (common::cpu_seconds(), Instant::now());
        let result = std::hint::black_box(work());
        least[0] = least[0].min(common::cpu_seconds() - cpu);
        least[1] = least[1].min(wall.elapsed().as_secs_f64());
        result
    };
    let mut result = turn();
    let wanted = std::env::args().skip(1).find(|arg| !arg.starts_with('-'));
    if wanted.is_none_or(|part| name.contains(&part)) {
        for _ in 1..TURNS {
            result = turn();
        }
    }
    println!("{name}: {:.2} CPU-s, {:.3} s", least[0], least[1]);
    result
}
