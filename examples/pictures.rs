//! What fast pictures are worth: illuminance of the eye by their fisheyes, and the luminance of blocks of
//! 10 × 10 pixels, against unbiased answers; Sobolev's plates seen by three cameras from one field. Writes
//! CSV, figures and a page to reports/pictures:
//!
//!     cargo run --release --example pictures
#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;
mod figure;
#[path = "../tests/plates/mod.rs"]
mod plates;

use std::error::Error;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use figure::{Figure, Series};
use gershun::estimate::Estimate;
use gershun::image::{Projection, View};
use gershun::measure::weights;
use gershun::project::{LoadOptions, Project, load};
use gershun::query::{Demand, Kernel, Receiver};
use gershun::report::Lang;
use gershun::report::picture::{Album, Format, Shot, Way, files};
use gershun::solve::picture::{Detail, Exposure, expose, omissions, render, replicate};
use gershun::solve::{Effort, Method, PARTS, Sheet, prepare};
use glam::DVec3;
use plates::Plates;

const FOLDER: &str = "reports/pictures";
/// Edge of a block, pixels.
const EDGE: usize = 10;
/// Independent replicates of every block in the unbiased pictures.
const REPLICATES: u64 = 4096;

fn main() -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(FOLDER)?;
    let eyes = eyes()?;
    let blocks = blocks()?;
    let plates = plates()?;
    let text = format!(
        "# Fast pictures against unbiased answers\n\nA picture without `--blocks` has no interval, so this page measures what it is worth. Made by `cargo run --release --example pictures`; seed 1.\n\n{eyes}\n{blocks}\n{plates}\n{WORDS}"
    );
    std::fs::write(format!("{FOLDER}/README.md"), &text)?;
    println!("{text}");
    Ok(())
}

const WORDS: &str = include_str!("pictures_words.md");

fn example(name: &str) -> Result<Project, String> {
    load(Path::new(&format!("scenes/{name}")), &LoadOptions::default())
        .map_err(|errors| format!("{errors:?}"))
}

/// Illuminance of an eye by the solver.
fn lx(sheets: &[Sheet], row: usize, weights: &[f64]) -> Estimate {
    let span = row * weights.len() * PARTS..(row + 1) * weights.len() * PARTS;
    let of_sheet = |sheet: &Sheet| {
        let channels = sheet.values[span.clone()].chunks(PARTS);
        channels.zip(weights).map(|(parts, weight)| weight * parts.iter().sum::<f64>()).sum()
    };
    Estimate::from_blocks(&sheets.iter().map(of_sheet).collect::<Vec<f64>>())
}

/// E_v by fisheyes of every viewpoint.
fn eyes() -> Result<String, Box<dyn Error>> {
    let mut csv = String::from("scene,viewpoint,solver_lx,solver_se_lx,picture_percent,preview_percent\n");
    let mut table = String::from(
        "## Illuminance of the eye\n\nE_v as the sum over an angular fisheye of 600 × 600 pixels, against the solver's answer at the same place (values in [eyes.csv](eyes.csv)).\n\n| scene | viewpoint | solver | picture | preview |\n|---|---|---|---|---|\n",
    );
    for name in ["office", "classroom", "warehouse", "hall"] {
        let project = example(name)?;
        let world = &project.worlds[0];
        let weights = weights(world, &project.light_scenes[0], &world.rooms[0], false);
        let eye = |eye: DVec3, normal: DVec3| Receiver {
            point: eye,
            lift: DVec3::ZERO,
            kernels: vec![Kernel::Planar { normal }],
        };
        let receivers =
            world.viewpoints.iter().map(|viewpoint| eye(viewpoint.eye, viewpoint.directions[0])).collect();
        let demand = Demand { receivers, ..Demand::default() };
        let effort = Effort { gather: 128, walks: 64, opening_points: 16, ..Effort::default() };
        let sheets = common::sheets(&world.scene, &demand, Method::Links, effort, 5, 4096);
        let exposure = expose(&world.scene, 1);
        for (row, viewpoint) in world.viewpoints.iter().enumerate() {
            let truth = lx(&sheets, row, &weights);
            let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
            let view = View::new(projection, viewpoint.eye, viewpoint.directions[0], DVec3::Z)?;
            let percent = [Detail::Exact, Detail::Stored].map(|detail| {
                let (image, _) = render(&exposure.picture(&weights, detail), &view, [600, 600], &|_| {});
                image.illuminance_lx().map_or(f64::NAN, |lx| 100.0 * (lx / truth.value - 1.0))
            });
            writeln!(
                csv,
                "{name},{},{},{},{},{}",
                viewpoint.name, truth.value, truth.se, percent[0], percent[1]
            )?;
            writeln!(
                table,
                "| {name} | {} | {:.2} ± {:.2} lx | {:+.2} % | {:+.2} % |",
                viewpoint.name, truth.value, truth.se, percent[0], percent[1]
            )?;
        }
    }
    std::fs::write(format!("{FOLDER}/eyes.csv"), csv)?;
    Ok(table)
}

/// A picture and the unbiased luminance of its blocks.
struct Compared {
    /// Errors of the blocks, percent.
    percent: Vec<f64>,
    /// Standard errors of the reference, percent.
    noise: Vec<f64>,
    /// Mean error of the whole picture, and the reference's standard error of that, percent.
    mean: [f64; 2],
}

fn compare(exposure: &Exposure, project: &Project, view: &View, size: [usize; 2]) -> Compared {
    let world = &project.worlds[0];
    let weights = weights(world, &project.light_scenes[0], &world.rooms[0], false);
    let (image, _) = render(&exposure.picture(&weights, Detail::Exact), view, size, &|_| {});
    let demand = Demand::default();
    let effort = Effort { gather: 1, ..Effort::default() };
    let prepared = prepare(&world.scene, &demand, Method::Links, effort, 3);
    let [columns, rows] = size.map(|pixels| pixels / EDGE);
    let mut sums = vec![[0.0; 2]; columns * rows];
    for block in 0..REPLICATES {
        let values = replicate(&prepared, view, [columns, rows], &weights, block);
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum = [sum[0] + value, sum[1] + value * value];
        }
    }
    let n = REPLICATES as f64;
    let (mut percent, mut noise, mut totals) = (Vec::new(), Vec::new(), [0.0; 3]);
    for (index, [sum, squares]) in sums.into_iter().enumerate() {
        let (row, column) = (index / columns, index % columns);
        let pixel = |k: usize| (EDGE * row + k / EDGE) * size[0] + EDGE * column + k % EDGE;
        let found =
            (0..EDGE * EDGE).map(|k| image.luminance_cd_m2[pixel(k)]).sum::<f64>() / (EDGE * EDGE) as f64;
        let truth = sum / n;
        percent.push(100.0 * (found / truth - 1.0));
        let variance = (squares / n - truth * truth).max(0.0) / (n - 1.0);
        noise.push(100.0 * variance.sqrt() / truth);
        totals = [totals[0] + found, totals[1] + truth, totals[2] + variance];
    }
    let mean = [100.0 * (totals[0] / totals[1] - 1.0), 100.0 * totals[2].sqrt() / totals[1]];
    Compared { percent, noise, mean }
}

/// The value below which a share of the sizes lies.
fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted[((sorted.len() - 1) as f64 * share) as usize]
}

fn blocks() -> Result<String, Box<dyn Error>> {
    let shots = [
        ("hall", "Along the hall", [1.0, 3.0, 1.6], [1.0, 0.0, -0.15], 60.0),
        ("hall", "Onto the floor", [4.0, 1.0, 1.6], [1.0, 0.6, -0.6], 60.0),
        ("hall", "Across", [15.0, 0.3, 1.6], [0.2, 1.0, -0.1], 80.0),
        ("office", "From the corner", [7.7, 0.4, 1.7], [-5.2, 2.6, -0.8], 80.0),
    ];
    let size = [300, 200];
    let mut csv = String::from("scene,view,column,row,error_percent,reference_se_percent\n");
    let mut table = format!(
        "## Luminance of blocks of {EDGE} × {EDGE} pixels\n\nPictures of {} × {} pixels without `--blocks` against {REPLICATES} unbiased replicates of every block (values in [blocks.csv](blocks.csv)). The reference's own noise is in the errors; of the picture as a whole its standard error is given.\n\n![errors](blocks.svg)\n\n| scene | view | picture as a whole | mean of the blocks' errors | half of the blocks within | 95 of 100 within | reference's standard error: half, 95 of 100 within |\n|---|---|---|---|---|---|---|\n",
        size[0], size[1]
    );
    let mut series = Vec::new();
    let mut last: Option<(&str, Project)> = None;
    for (name, title, eye, direction, width) in shots {
        if last.as_ref().is_none_or(|(known, _)| *known != name) {
            last = Some((name, example(name)?));
        }
        let Some((_, project)) = &last else { continue };
        let tall = 2.0 * ((0.5f64 * width).to_radians().tan() * 2.0 / 3.0).atan().to_degrees();
        let projection = Projection::Perspective { horizontal_deg: width, vertical_deg: tall };
        let view = View::new(projection, DVec3::from_array(eye), DVec3::from_array(direction), DVec3::Z)?;
        let exposure = expose(&project.worlds[0].scene, 1);
        let Compared { percent, noise, mean: [mean, mean_se] } = compare(&exposure, project, &view, size);
        for (index, (percent, noise)) in percent.iter().zip(&noise).enumerate() {
            let columns = size[0] / EDGE;
            writeln!(csv, "{name},{title},{},{},{percent},{noise}", index % columns, index / columns)?;
        }
        let of_blocks = percent.iter().sum::<f64>() / percent.len() as f64;
        writeln!(
            table,
            "| {name} | {title} | {mean:+.2} ± {mean_se:.2} % | {of_blocks:+.2} % | {:.2} % | {:.2} % | {:.2} %, {:.2} % |",
            quantile(&percent, 0.5),
            quantile(&percent, 0.95),
            quantile(&noise, 0.5),
            quantile(&noise, 0.95)
        )?;
        let points = (1..=100).map(|k| [f64::from(k), quantile(&percent, f64::from(k) / 100.0), 0.0]);
        series.push(Series { name: format!("{name}: {title}"), points: points.collect(), line: true });
    }
    let figure = Figure {
        title: "Errors of blocks of 10 × 10 pixels",
        axes: ["blocks, %", "error within, %"],
        log: [false, true],
        series: &series,
    };
    std::fs::write(format!("{FOLDER}/blocks.svg"), figure.svg())?;
    std::fs::write(format!("{FOLDER}/blocks.csv"), csv)?;
    Ok(table)
}

/// Three pictures of Sobolev's plates from one field, and their luminances against the exact solution.
fn plates() -> Result<String, Box<dyn Error>> {
    let project = example("sobolev")?;
    let world = &project.worlds[0];
    let weights = weights(world, &project.light_scenes[0], &world.rooms[0], false);
    let exposure = expose(&world.scene, 1);
    let picture = exposure.picture(&weights, Detail::Exact);
    let exact = Plates { source: 0.5, rho: [0.5; 2] };
    let step = 0.02;
    let truth: Vec<f64> = (0..=275).map(|k| 1000.0 * exact.exact(step * f64::from(k))).collect();
    let mut shots = Vec::new();
    let mut table = String::from(
        "## Sobolev's plates from three cameras\n\nA point source between two diffuse plates, seen by three cameras from one solution, as in figure 2 of the paper that this program started from. The luminance of a plate within 5 gaps of the source's foot is ρ/π times Sobolev's exact illuminance.\n\n",
    );
    let mut rows = String::from(
        "\n| camera | pixels compared | mean error | half within | 95 of 100 within |\n|---|---|---|---|---|\n",
    );
    for camera in &world.cameras {
        let (image, _) = render(&picture, &camera.view, camera.size, &|_| {});
        let mut percent = Vec::new();
        for (index, luminance) in image.luminance_cd_m2.iter().enumerate() {
            let at = [index % camera.size[0], index / camera.size[0]].map(|k| k as f64 + 0.5);
            let Some(direction) = camera.view.direction(camera.size, at) else { continue };
            let height = if direction.z < 0.0 { 0.0 } else { 1.0 };
            let place = camera.view.eye + direction * ((height - camera.view.eye.z) / direction.z);
            let r = (place - DVec3::new(30.0, 30.0, height)).length();
            if r <= 5.0 {
                let (k, t) = ((r / step) as usize, (r / step).fract());
                let lx = truth[k] * (1.0 - t) + truth[k + 1] * t;
                percent.push(100.0 * (luminance / (0.5 * lx / PI) - 1.0));
            }
        }
        let mean = percent.iter().sum::<f64>() / percent.len() as f64;
        writeln!(
            rows,
            "| {} | {} | {mean:+.2} % | {:.2} % | {:.2} % |",
            camera.name,
            percent.len(),
            quantile(&percent, 0.5),
            quantile(&percent, 0.95)
        )?;
        shots.push(Shot {
            name: camera.name.clone(),
            light_scene: project.light_scenes[0].name.clone(),
            illuminance_lx: image.illuminance_lx(),
            image,
            way: Way::Exact,
            biases: omissions(&world.scene, Detail::Exact),
        });
    }
    let album = Album { project: "sobolev", seed: 1, inputs: &[], shots };
    for (name, bytes) in files(&album, &[Format::Svg], Lang::En)? {
        if let Some(stem) = name.strip_suffix(".svg") {
            let file = format!("sobolev-{}.svg", stem.to_lowercase().replace(' ', "-"));
            writeln!(table, "![{stem}]({file})")?;
            std::fs::write(format!("{FOLDER}/{file}"), bytes)?;
        }
    }
    Ok(table + &rows)
}
