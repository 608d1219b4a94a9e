//! How many directions a node of the field would have to store for a glossy surface, and how near nodes
//! would have to lie: error against number for a θ–φ grid (the paper's), spherical harmonics and an
//! octahedral map, exponents 1 to 1 000, beside lobe rays into the diffuse field, which store nothing.
//! Writes CSV, drawings and a page to reports/directions:
//!
//!     cargo run --release --example directions
#![allow(clippy::print_stdout, reason = "a study prints")]
#![allow(clippy::cast_possible_wrap, reason = "exponents are small")]

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "figure/mod.rs"]
mod figure;

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::path::Path;

use common::{lambert, panel, room};
use figure::{Figure, Series};
use gershun::field::angular::Form;
use gershun::image::{Projection, View};
use gershun::rng::Rng;
use gershun::scene::Scene;
use gershun::solve::picture::{Detail, expose, render};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

const EXPONENTS: [u32; 5] = [1, 10, 30, 100, 1000];
/// Pixels across the hemisphere that the node sees.
const PIXELS: usize = 160;
/// Directions in which representations are compared with the truth.
const TESTS: usize = 2000;
/// Error that counts as good, as a share of the largest luminance.
const GOOD: f64 = 0.01;

/// Light that arrives at a node: direction and luminance times solid angle times cos.
struct Incident {
    name: &'static str,
    light: Vec<(DVec3, f64)>,
}

/// What the node reflects by the lobe (n + 2)/(2π) cos^n, mirror direction against incident.
struct Reflected<'i> {
    incident: &'i Incident,
    exponent: u32,
    /// Cosine below which a lobe is darker than 1e-7 of its peak.
    least: f64,
}

impl<'i> Reflected<'i> {
    fn new(incident: &'i Incident, exponent: u32) -> Self {
        Self { incident, exponent, least: 1e-7f64.powf(1.0 / f64::from(exponent)) }
    }

    /// Luminance along a direction of the upper hemisphere.
    fn along(&self, direction: DVec3) -> f64 {
        let mirrored = DVec3::new(-direction.x, -direction.y, direction.z);
        let factor = f64::from(self.exponent + 2) / TAU;
        let mut sum = 0.0;
        for (from, weight) in &self.incident.light {
            let cos = mirrored.dot(*from);
            if cos > self.least {
                sum += weight * cos.powi(self.exponent as i32);
            }
        }
        factor * sum
    }

    fn along_all(&self, directions: &[DVec3]) -> Vec<f64> {
        directions.par_iter().map(|&direction| self.along(direction)).collect()
    }
}

fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// The truth stored in one form and looked up: how many numbers, and what is found.
fn stored(truth: &Reflected, form: Form, tests: &[DVec3]) -> (usize, Vec<f64>) {
    let numbers = form.store(&truth.along_all(&form.directions()), 1);
    (numbers.len(), tests.iter().map(|&direction| form.look(&numbers, direction)).collect())
}

/// Rays drawn by the lobe (density (n + 1)/(2π) cosⁿ) into what is stored without direction.
fn lobe_rays(
    truth: &Reflected,
    image: &dyn Fn(DVec3) -> f64,
    rays: usize,
    tests: &[DVec3],
) -> (usize, Vec<f64>) {
    let n = f64::from(truth.exponent);
    let values = tests.iter().enumerate().map(|(number, w)| {
        let mut rng = Rng::new(7, 1, number as u64);
        let axis = DVec3::new(-w.x, -w.y, w.z);
        let frame = frame(axis);
        let sequence = gershun::rng::Stratified::new(&mut rng);
        let mut sum = 0.0;
        for ray in 0..rays {
            let [u, v, _] = sequence.point(ray as u32, &mut rng);
            let cos = u.powf(1.0 / (n + 1.0));
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            let from = frame * DVec3::new(sin * (TAU * v).cos(), sin * (TAU * v).sin(), cos);
            if from.z > 0.0 {
                sum += image(from) * from.z;
            }
        }
        sum * (n + 2.0) / ((n + 1.0) * rays as f64)
    });
    (0, values.collect())
}

fn frame(axis: DVec3) -> DMat3 {
    let (x, y) = axis.any_orthonormal_pair();
    DMat3::from_cols(x, y, axis)
}

struct Line {
    light: &'static str,
    exponent: u32,
    way: &'static str,
    numbers: usize,
    effort: usize,
    rms: f64,
    largest: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let size = PIXELS;
    let materials = vec![lambert("floor", 0.2), lambert("walls", 0.5), lambert("ceiling", 0.7)];
    let lamp = panel(4000.0, 0.6, DVec3::new(3.0, 2.0, 2.79));
    let scene = Scene::new(room(DVec3::new(6.0, 4.0, 2.8)), materials, vec![lamp])?;
    let projection = Projection::HemisphericalFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let view = View::new(projection, DVec3::new(1.5, 1.2, 1e-6), DVec3::Z, DVec3::Y)?;
    let exposure = expose(&scene, 1);
    let picture = render(&exposure.picture(&[1.0], Detail::Exact), &view, [size, size], &|_| ()).0;
    // On this projection a pixel is an equal share of cos dω.
    let share = PI / (0.25 * PI * (size * size) as f64);
    // A pixel of which the panel covers a hundredth is the panel's: pictures smooth its edges, and the
    // room, at 23 cd/m² of the panel's 3 540 and less, would else seem to have bright spots.
    let brightest = 0.01 * picture.luminance_cd_m2.iter().copied().fold(0.0, f64::max);
    let pixel = |k: usize| view.direction([size, size], [(k % size) as f64 + 0.5, (k / size) as f64 + 0.5]);
    let light = |keep: &dyn Fn(f64) -> bool| -> Vec<(DVec3, f64)> {
        let all = picture.luminance_cd_m2.iter().enumerate().filter(|(_, l)| keep(**l));
        all.filter_map(|(k, l)| pixel(k).map(|w| (w, l * share))).collect()
    };
    let fields = [
        Incident { name: "all light", light: light(&|_| true) },
        Incident { name: "indirect light", light: light(&|l| l < brightest) },
    ];
    let indirect = |w: DVec3| -> f64 {
        let [x, y] = [w.dot(view.right()), w.dot(view.up())];
        let at = |t: f64| ((0.5 * (t + 1.0) * size as f64) as usize).min(size - 1);
        let value = picture.luminance_cd_m2[at(-y) * size + at(x)];
        if value < brightest { value } else { 0.0 }
    };
    let mut rng = Rng::new(1, 1, 1);
    let tests: Vec<DVec3> = (0..TESTS)
        .map(|_| {
            let [u, v] = rng.uniforms();
            // Not the last five degrees over the surface, where next to nothing is seen of it.
            direction((1.0 - u * (1.0 - 0.087)).acos(), TAU * v)
        })
        .collect();
    let mut lines = Vec::new();
    for field in &fields {
        for exponent in EXPONENTS {
            let truth = Reflected::new(field, exponent);
            let exact = truth.along_all(&tests);
            let peak = exact.iter().copied().fold(0.0, f64::max);
            let mut add = |way, effort, (numbers, found): (usize, Vec<f64>)| {
                let errors: Vec<f64> = found.iter().zip(&exact).map(|(a, b)| (a - b) / peak).collect();
                let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
                let largest = errors.iter().map(|e| e.abs()).fold(0.0, f64::max);
                lines.push(Line { light: field.name, exponent, way, numbers, effort, rms, largest });
            };
            for steps in [4, 6, 8, 12, 16, 24, 32, 48, 64, 96] {
                add("θ–φ grid", 1, stored(&truth, Form::ThetaPhi { steps }, &tests));
            }
            for order in [2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96] {
                add("spherical harmonics", 1, stored(&truth, Form::Harmonics { order }, &tests));
            }
            for size in [6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192] {
                add("octahedral map", 1, stored(&truth, Form::Octahedral { size }, &tests));
            }
            if field.name == "indirect light" {
                for rays in [4, 16, 64, 256] {
                    add("lobe rays", rays, lobe_rays(&truth, &indirect, rays, &tests));
                }
            }
            println!("{}, exponent {exponent}", field.name);
        }
    }
    write(&lines, &spacing())
}

/// Relative error of the luminance half-way between two nodes at `spacing` (in distances to a point of
/// light) in the direction that sees its highlight there: (cosⁿ of half the angle between the nodes)
/// averaged, against 1. The largest spacing that stays below [`GOOD`], for each exponent.
fn spacing() -> Vec<(u32, f64, f64)> {
    EXPONENTS
        .into_iter()
        .map(|exponent| {
            let error = |s: f64| {
                // Nodes at ±s/2; the eye mirrors the point of light at 0.
                let angle = (0.5 * s).atan();
                1.0 - angle.cos().powi(exponent as i32)
            };
            let (mut low, mut high) = (0.0, 4.0);
            for _ in 0..60 {
                let middle: f64 = 0.5 * (low + high);
                if error(middle) < GOOD { low = middle } else { high = middle }
            }
            (exponent, low, low * f64::from(exponent).sqrt())
        })
        .collect()
}

fn write(lines: &[Line], spacing: &[(u32, f64, f64)]) -> Result<(), Box<dyn Error>> {
    let folder = Path::new("reports/directions");
    std::fs::create_dir_all(folder)?;
    let mut csv =
        String::from("light,exponent,way,numbers_stored,rays_per_look,rms_of_peak,largest_of_peak\n");
    for line in lines {
        let Line { light, exponent, way, numbers, effort, rms, largest } = line;
        writeln!(csv, "{light},{exponent},{way},{numbers},{effort},{rms:.3e},{largest:.3e}")?;
    }
    std::fs::write(folder.join("directions.csv"), csv)?;
    let ways = ["θ–φ grid", "spherical harmonics", "octahedral map"];
    let mut table = String::new();
    for light in ["all light", "indirect light"] {
        for exponent in EXPONENTS {
            write!(table, "| {light} | {exponent} |")?;
            for way in ways {
                let good =
                    lines.iter().filter(|l| l.light == light && l.exponent == exponent && l.way == way);
                let least = good.clone().filter(|l| l.largest <= GOOD).map(|l| l.numbers).min();
                let best = good.map(|l| l.largest).fold(f64::INFINITY, f64::min);
                match least {
                    Some(numbers) => write!(table, " {numbers} |")?,
                    None => write!(table, " more ({:.1} % left) |", 100.0 * best)?,
                }
            }
            let rays =
                lines.iter().filter(|l| l.light == light && l.exponent == exponent && l.way == "lobe rays");
            let list: Vec<String> = rays.map(|l| format!("{:.2}", 100.0 * l.rms)).collect();
            writeln!(table, " {} |", if list.is_empty() { "–".to_owned() } else { list.join(", ") })?;
        }
    }
    let mut nodes = String::new();
    for (exponent, s, law) in spacing {
        writeln!(nodes, "| {exponent} | {s:.3} d | {law:.2} |")?;
    }
    for (file, light) in [("all.svg", "all light"), ("indirect.svg", "indirect light")] {
        let series: Vec<Series> = [10u32, 100]
            .into_iter()
            .flat_map(|exponent| ways.into_iter().map(move |way| (exponent, way)))
            .map(|(exponent, way)| Series {
                name: format!("{way}, n = {exponent}"),
                points: lines
                    .iter()
                    .filter(|l| l.light == light && l.exponent == exponent && l.way == way)
                    .map(|l| [l.numbers as f64, 100.0 * l.largest, 0.0])
                    .collect(),
                line: true,
            })
            .collect();
        let figure = Figure {
            title: &format!("Largest error of reflected luminance: {light}"),
            axes: ["numbers stored per node", "% of the largest luminance"],
            log: [true, true],
            series: &series,
        };
        std::fs::write(folder.join(file), figure.svg())?;
    }
    let words = include_str!("directions_words.md");
    let text = words.replace("{table}", table.trim_end()).replace("{nodes}", nodes.trim_end());
    std::fs::write(folder.join("README.md"), text)?;
    println!("{table}\n{nodes}");
    Ok(())
}
