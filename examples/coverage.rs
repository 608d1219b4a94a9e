//! How often the 95 % intervals contain the truth: 1 000 seeds of the office, 64 blocks each, at
//! places chosen beforehand, by every method. The truth is the mean over all seeds, whose own error
//! is 1/32 of one run's; the methods' truths are compared with each other. Writes CSV and a table to
//! reports/coverage:
//!
//!     cargo run --release --example coverage [SEEDS [METHOD …]]
#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use common::cpu_seconds;
use gershun::emitters::sighted_from;
use gershun::estimate::{Estimate, Pair};
use gershun::grid::{GridRule, rectangle};
use gershun::measure::glare_sources::Convention;
use gershun::measure::{Answers, view, weights};
use gershun::project::{LoadOptions, load};
use gershun::query::{Demand, Kernel, Ray, Receiver};
use gershun::solve::{Effort, LocalEffort, Method, answer, prepare};
use glam::DVec3;
use rayon::prelude::*;

const BLOCKS: u64 = 64;
const ALPHA: f64 = 0.05;

/// One run's value and interval of each quantity.
type Run = Vec<(f64, f64, f64)>;

/// Name, method and effort of a block. Double answers receivers as local does, from the same streams:
/// only its luminance is of its own.
fn methods() -> [(&'static str, Method, Effort); 4] {
    let links = Effort { patch_m2: Some(0.25), ..Effort::default() };
    let local = Effort {
        local: LocalEffort { chains: 32, connections: 32.0, returns: 4, ..LocalEffort::default() },
        ..Effort::default()
    };
    let path = Effort { paths: 8, ..Effort::default() };
    [
        ("links", Method::Links, links),
        ("local", Method::Local, local),
        ("double", Method::Double, local),
        ("path", Method::Path, path),
    ]
}

fn main() -> Result<(), Box<dyn Error>> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(1000), |text| text.parse())?;
    let wanted: Vec<String> = std::env::args().skip(2).collect();
    let project = load(Path::new("scenes/office"), &LoadOptions::default())
        .map_err(|_| "scenes/office does not load")?;
    let world = &project.worlds[0];
    let planar = |point: DVec3, normal: DVec3| Receiver {
        point,
        lift: normal,
        kernels: vec![Kernel::Planar { normal }],
    };
    let desk = rectangle(
        DVec3::new(1.59, 1.69, 0.75),
        DVec3::X * 1.6,
        DVec3::Y * 0.6,
        DVec3::Z,
        GridRule::En,
        0.0,
        None,
    )?;
    let gaze = DVec3::Y;
    let eye = DVec3::new(4.0, 1.6, 1.2);
    let mut receivers = vec![
        planar(DVec3::new(3.0, 2.5, 0.0), DVec3::Z),
        planar(DVec3::new(0.05, 0.05, 0.0), DVec3::Z),
        planar(DVec3::new(8.0, 0.6, 1.2), DVec3::NEG_X),
        planar(eye, gaze),
        planar(DVec3::new(0.005, 0.005, 0.0), DVec3::Z),
    ];
    receivers.extend(desk.points.iter().map(|point| planar(point.position, DVec3::Z)));
    let wall = Ray { point: eye, direction: (DVec3::new(0.0, 4.2, 1.6) - eye).normalize() };
    let demand = Demand { receivers, rays: vec![wall], flux: false };
    let names = [
        "E floor, middle",
        "E floor, 5 cm from two walls",
        "E wall, beside the glass",
        "Ē desk",
        "U0 contrast, desk corner",
        "UGR",
        "E floor, 5 mm from two walls",
        "L of a wall, cd/m²",
    ];
    let light = weights(world, &project.light_scenes[0], &world.rooms[0], false);
    let one = |method: Method, effort: Effort, seed: u64| -> Run {
        let prepared = prepare(&world.scene, &demand, method, effort, seed);
        let sheets: Vec<_> = (0..BLOCKS).map(|block| answer(&prepared, block)).collect();
        let answers = Answers::of(&sheets, &world.scene);
        let mut run = Run::new();
        let mut add = |blocks: &[f64]| {
            let estimate = Estimate::from_blocks(blocks);
            let (lo, hi) = estimate.interval(ALPHA);
            run.push((estimate.value, lo, hi));
        };
        for row in 0..3 {
            add(&answers.total(row, &light));
        }
        let points: Vec<Vec<f64>> = (5..demand.rows() - 1).map(|row| answers.total(row, &light)).collect();
        let mean: Vec<f64> = (0..BLOCKS as usize)
            .map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64)
            .collect();
        add(&mean);
        let pair = Pair::from_blocks(&points[0], &mean);
        let (lo, hi) = pair.ratio_interval(ALPHA);
        run.push((pair.ratio().value, lo, hi));
        let sighted = sighted_from(prepared.emitters(), eye, seed, true);
        let eye_light = view::EyeLight::of_row(&answers, 3, &light);
        let asked = view::Asked {
            gaze,
            indices: &[],
            convention: Convention::default(),
            zones: Err("no task"),
            given: gershun::glare::source::Given::default(),
        };
        let glare = view::glare(&eye_light, prepared.emitters(), &sighted, &asked, &light, ALPHA).ugr;
        run.push((glare.value.unwrap_or(f64::NAN), glare.lo, glare.hi));
        for row in [4, demand.rows() - 1] {
            let estimate = Estimate::from_blocks(&answers.total(row, &light));
            let (lo, hi) = estimate.interval(ALPHA);
            run.push((estimate.value, lo, hi));
        }
        run
    };
    report(seeds, &names, &wanted, &one)
}

/// Runs every method over all seeds and writes what came of it.
fn report(
    seeds: u64,
    names: &[&str],
    wanted: &[String],
    one: &(dyn Fn(Method, Effort, u64) -> Run + Sync),
) -> Result<(), Box<dyn Error>> {
    let mut csv =
        String::from("method,quantity,seeds,truth,sd_of_runs,mean_half_width,covered_percent,z_to_links\n");
    let mut table = String::new();
    let mut known: Vec<Option<Estimate>> = vec![None; names.len()];
    for (name, method, effort) in methods() {
        if !(wanted.is_empty() || wanted.iter().any(|w| w == name)) {
            continue;
        }
        let before = cpu_seconds();
        let runs: Vec<Run> = (1..=seeds).into_par_iter().map(|seed| one(method, effort, seed)).collect();
        println!("{name}: {:.0} CPU-s", cpu_seconds() - before);
        for (index, quantity) in names.iter().enumerate() {
            if method == Method::Double && !quantity.starts_with('L') {
                continue;
            }
            let values: Vec<f64> = runs.iter().map(|run| run[index].0).collect();
            let truth = Estimate::from_blocks(&values);
            let covered =
                runs.iter().filter(|run| run[index].1 <= truth.value && truth.value <= run[index].2).count();
            let half = runs.iter().map(|run| 0.5 * (run[index].2 - run[index].1)).sum::<f64>() / seeds as f64;
            let sd = truth.se * (seeds as f64).sqrt();
            let percent = 100.0 * covered as f64 / seeds as f64;
            let links = known[index].get_or_insert(truth);
            let z = (truth.value - links.value) / truth.se.hypot(links.se);
            writeln!(csv, "{name},\"{quantity}\",{seeds},{},{sd},{half},{percent},{z}", truth.value)?;
            writeln!(
                table,
                "| {quantity} | {name} | {:.3} | {sd:.3} | {half:.3} | {percent:.1} % | {} |",
                truth.value,
                if method == Method::Links { String::new() } else { format!("{z:+.2}") }
            )?;
        }
    }
    let text = format!(
        "# Coverage of the 95 % intervals\n\n{seeds} seeds of scenes/office, {BLOCKS} blocks each, eight quantities chosen beforehand, by every method. A nominal 95 % interval is accepted between 92.6 and 97.1 %.\nMade by `cargo run --release --example coverage {seeds}`; values in [coverage.csv](coverage.csv).\n\n| quantity | method | truth | sd of runs | mean half width | covered | from links, standard errors |\n|---|---|---|---|---|---|---|\n{table}\nThe truth is the mean over all seeds; illuminances in lx, initial flux, all groups on. The methods' blocks differ in effort, so their widths say nothing about efficiency (reports/estimators does). Double answers receivers as local does. The last column compares truths; UGR and U0 are not linear in the blocks, so that theirs carry each method's own noise bias.\n"
    );
    std::fs::create_dir_all("reports/coverage")?;
    std::fs::write("reports/coverage/coverage.csv", csv)?;
    std::fs::write("reports/coverage/README.md", &text)?;
    println!("{text}");
    Ok(())
}
