//! Which estimator buys accuracy where: root mean square error against CPU time of local estimation
//! with the plain and the bounded kernel, of the two forms of double local estimation, of links and of
//! path tracing; for illuminance in the open, 5 cm and 5 mm from a corner, and for the luminance of
//! glossy surfaces. Writes CSV, figures and a page to reports/estimators:
//!
//!     cargo run --release --example estimators
#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;
mod figure;

use std::error::Error;
use std::fmt::Write as _;

use common::{cpu_seconds, glossy, lambert, panel, planar, room, row, sheets};
use figure::{Figure, Series};
use gershun::estimate::Estimate;
use gershun::material::{Lobe, Phong};
use gershun::query::{Demand, Ray};
use gershun::scene::Scene;
use gershun::solve::{Effort, LocalEffort, LocalKernel, Method, SeenForm, answer, prepare};
use glam::DVec3;
use rayon::prelude::*;

const SEEDS: u64 = 24;
const BLOCKS: [u64; 3] = [8, 64, 512];
const SIZE: DVec3 = DVec3::new(4.0, 3.0, 2.8);

struct Question {
    file: &'static str,
    title: String,
    scene: Scene,
    demand: Demand,
    luminance: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut csv =
        String::from("question,estimator,blocks,reference,rms_error_percent,cpu_s,covered_percent\n");
    let mut pages = String::new();
    for question in questions() {
        let effort = Effort { gather: 64, walks: 32, ..Effort::default() };
        let channels = question.scene.channels.len();
        let reference = sheets(&question.scene, &question.demand, Method::Links, effort, 99, 1536);
        let reference = Estimate::from_blocks(&row(&reference, 0, channels));
        writeln!(
            pages,
            "## {}\n\nReference {:.4} ± {:.4}.\n\n![{}]({}.svg)\n\n| estimator | error after {} blocks | CPU | intervals that hold the reference | CPU to 1 % |\n|---|---|---|---|---|",
            question.title,
            reference.value,
            reference.se,
            question.title,
            question.file,
            BLOCKS[BLOCKS.len() - 1]
        )?;
        let mut series = Vec::new();
        for (name, method, effort) in estimators(question.luminance) {
            let mut points = Vec::new();
            let mut last = (0.0, 0.0, 0.0);
            for blocks in BLOCKS {
                let before = cpu_seconds();
                let runs: Vec<Estimate> = (0..SEEDS)
                    .into_par_iter()
                    .map(|seed| {
                        let prepared = prepare(&question.scene, &question.demand, method, effort, seed);
                        let sheets: Vec<_> = (0..blocks).map(|block| answer(&prepared, block)).collect();
                        Estimate::from_blocks(&row(&sheets, 0, channels))
                    })
                    .collect();
                let seconds = (cpu_seconds() - before) / SEEDS as f64;
                let square = runs.iter().map(|run| (run.value / reference.value - 1.0).powi(2)).sum::<f64>();
                let percent = 100.0 * (square / SEEDS as f64).sqrt();
                let holds = |run: &&Estimate| {
                    let (lo, hi) = run.interval(0.05);
                    lo <= reference.value && reference.value <= hi
                };
                let covered = 100.0 * runs.iter().filter(holds).count() as f64 / SEEDS as f64;
                writeln!(
                    csv,
                    "\"{}\",{name},{blocks},{},{percent},{seconds},{covered}",
                    question.title, reference.value
                )?;
                points.push([seconds.max(1e-4), percent, 0.0]);
                last = (percent, seconds, covered);
            }
            let (percent, seconds, covered) = last;
            let line = format!(
                "| {name} | {percent:.2} % | {:.0} ms | {covered:.0} % | {:.0} ms |",
                1e3 * seconds,
                1e3 * seconds * percent * percent
            );
            println!("{}: {line}", question.file);
            writeln!(pages, "{line}")?;
            series.push(Series { name: name.into(), points, line: true });
        }
        pages.push('\n');
        let figure = Figure {
            title: &question.title,
            axes: ["CPU time, s", "rms error, %"],
            log: [true, true],
            series: &series,
        };
        std::fs::create_dir_all("reports/estimators")?;
        std::fs::write(format!("reports/estimators/{}.svg", question.file), figure.svg())?;
    }
    let text = format!(
        "# Estimators compared\n\nRoot mean square error over {SEEDS} seeds against CPU time, one point asked alone, preparation included (links builds its field each time; many points share it). \"CPU to 1 %\" extrapolates the last line with the square root of time; where an estimator has no finite variance – the plain kernel near surfaces – it means little, and the share of nominal 95 % intervals that hold the reference says why. Made by `cargo run --release --example estimators`; values in [estimators.csv](estimators.csv). CPU times are of one run on one machine: only their ratios matter.\n\n{pages}{WORDS}"
    );
    std::fs::write("reports/estimators/estimators.csv", csv)?;
    std::fs::write("reports/estimators/README.md", &text)?;
    Ok(())
}

const WORDS: &str = include_str!("estimators_words.md");

fn estimators(luminance: bool) -> Vec<(&'static str, Method, Effort)> {
    let local = |local: LocalEffort| Effort { local, ..Effort::default() };
    let base = LocalEffort::default();
    let plain = LocalEffort { kernel: LocalKernel::Plain, connections: f64::INFINITY, ..base };
    let mut list = if luminance {
        vec![
            ("double, form A", Method::Double, local(LocalEffort { form: SeenForm::Connect, ..base })),
            ("double, form B", Method::Double, local(LocalEffort { form: SeenForm::Gather, ..base })),
            ("double, by lobe", Method::Double, local(base)),
        ]
    } else {
        vec![
            ("local, plain kernel", Method::Local, local(plain)),
            ("local, bounded kernel", Method::Local, local(base)),
        ]
    };
    list.push(("links", Method::Links, Effort::default()));
    list.push(("path", Method::Path, Effort::default()));
    list
}

fn questions() -> Vec<Question> {
    let scene = |floor| {
        let materials = vec![floor, lambert("walls", 0.5), lambert("ceiling", 0.7)];
        let lamps = [[1.0, 1.5], [3.0, 1.5]].map(|[x, y]| panel(3000.0, 0.3, DVec3::new(x, y, 2.799)));
        Scene::new(room(SIZE), materials, lamps.to_vec()).expect("the scene is valid")
    };
    let mut questions = Vec::new();
    for (file, title, x) in [
        ("middle", "Illuminance of the floor, 1.2 m from two walls", 1.2),
        ("near", "Illuminance of the floor, 5 cm from two walls", 0.05),
        ("corner", "Illuminance of the floor, 5 mm from two walls", 0.005),
    ] {
        let receivers = vec![planar(DVec3::new(x, x, 0.0), DVec3::Z)];
        questions.push(Question {
            file,
            title: title.into(),
            scene: scene(lambert("floor", 0.2)),
            demand: Demand { receivers, ..Demand::default() },
            luminance: false,
        });
    }
    // Half-way between the images of the panels: what the lobe shows there is mostly indirect light.
    let eye = DVec3::new(0.5, 1.5, 1.6);
    for (file, exponent) in [("phong5", 5.0), ("phong60", 60.0), ("phong1000", 1000.0)] {
        let floor = glossy("floor", 0.2, Lobe::Phong(Phong::new(0.3, exponent)));
        let rays = vec![Ray { point: eye, direction: (DVec3::new(1.35, 0.6, 0.0) - eye).normalize() }];
        questions.push(Question {
            file,
            title: format!("Luminance of a glossy floor, Phong exponent {exponent}"),
            scene: scene(floor),
            demand: Demand { rays, ..Demand::default() },
            luminance: true,
        });
    }
    questions
}
