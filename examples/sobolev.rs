//! Sobolev's problem, a point source between two diffuse plates: illuminance of the lower plate by
//! every method against the exact solution. Writes CSV, a figure and a page to reports/sobolev:
//!
//!     cargo run --release --example sobolev
#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../tests/common/mod.rs"]
mod common;
mod figure;
#[path = "../tests/plates/mod.rs"]
mod plates;

use std::error::Error;
use std::fmt::Write as _;

use common::{cpu_seconds, planar, row, sheets};
use figure::{Figure, Series};
use gershun::estimate::Estimate;
use gershun::query::Demand;
use gershun::solve::{Effort, LocalEffort, Method};
use glam::DVec3;
use plates::{Plates, place};

const PLACES: [f64; 8] = [0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0];
const ALPHA: f64 = 0.05;

fn main() -> Result<(), Box<dyn Error>> {
    let local = LocalEffort { chains: 64, connections: 64.0, returns: 16, ..LocalEffort::default() };
    let links = Effort { gather: 64, walks: 16, ..Effort::default() };
    let methods = [
        ("links", Method::Links, links, 16_384),
        ("local", Method::Local, Effort { local, ..Effort::default() }, 65_536),
        ("path", Method::Path, Effort { paths: 64, ..Effort::default() }, 16_384),
    ];
    let mut csv = String::from(
        "source_height,rho1,rho2,r,exact_lx,finite_discs_share,method,value_lx,lo_lx,hi_lx,difference_percent\n",
    );
    let mut table = String::new();
    let mut drawn: Vec<Series> = Vec::new();
    let (mut outside, mut compared) = (0, 0);
    for (rho, radius) in [([0.5, 0.5], 30.0), ([0.8, 0.2], 30.0), ([0.8, 0.8], 30.0)] {
        let plates = Plates { source: 0.5, rho };
        let scene = plates.scene(radius);
        let truth: Vec<f64> = PLACES.iter().map(|&r| plates.exact(place(r).length())).collect();
        let at: Vec<f64> = PLACES.iter().map(|&r| place(r).length()).collect();
        let cut: Vec<f64> =
            plates.discs(radius, &at).iter().zip(&truth).map(|(disc, exact)| disc / exact - 1.0).collect();
        let receivers = PLACES.map(|r| planar(place(r), DVec3::Z)).to_vec();
        let demand = Demand { receivers, ..Demand::default() };
        for (name, method, effort, blocks) in methods {
            let before = cpu_seconds();
            let sheets = sheets(&scene, &demand, method, effort, 1, blocks);
            let seconds = cpu_seconds() - before;
            let (mut worst, mut resolution) = (0f64, 0f64);
            let mut points = Vec::new();
            for (index, r) in PLACES.into_iter().enumerate() {
                let estimate = Estimate::from_blocks(&row(&sheets, index, 1));
                let (lo, hi) = estimate.interval(ALPHA);
                let exact = truth[index];
                let percent = 100.0 * (estimate.value / exact - 1.0);
                outside += usize::from(exact < lo || exact > hi);
                compared += 1;
                worst = worst.max((estimate.value - exact).abs() / estimate.se);
                resolution = resolution.max(100.0 * estimate.se / exact);
                points.push([r, percent, 50.0 * (hi - lo) / exact]);
                writeln!(
                    csv,
                    "{},{},{},{r},{exact},{:e},{name},{},{lo},{hi},{percent}",
                    plates.source, rho[0], rho[1], cut[index], estimate.value
                )?;
            }
            let truncated = cut.iter().fold(0f64, |w, c| w.max(c.abs()));
            writeln!(
                table,
                "| {} / {} | {name} | {worst:.2} | {resolution:.2} % | {seconds:.0} s | {truncated:.1e} |",
                rho[0], rho[1]
            )?;
            println!("{rho:?} {name}: worst {worst:.2} se, se up to {resolution:.2} %, {seconds:.1} CPU-s");
            if drawn.len() < methods.len() {
                drawn.push(Series { name: name.into(), points, line: false });
            }
        }
    }
    let svg = Figure {
        title: "Difference from the exact solution, ρ₁ = ρ₂ = 0.5, 95 % intervals",
        axes: ["distance r / h", "difference, %"],
        log: [false, false],
        series: &drawn,
    }
    .svg();
    let curves: Vec<Series> = [[0.5, 0.5], [0.8, 0.2], [0.8, 0.8], [0.99, 0.99]]
        .map(|rho| {
            let plates = Plates { source: 0.5, rho };
            let points = (0..=100).map(|k| 0.05 * f64::from(k)).map(|r| [r, plates.exact(r), 0.0]).collect();
            Series { name: format!("ρ {} / {}", rho[0], rho[1]), points, line: true }
        })
        .into();
    let exact = Figure {
        title: "Illuminance of the lower plate, source of 1 cd at half the gap, h = 1 m",
        axes: ["distance r / h", "E, lx"],
        log: [false, true],
        series: &curves,
    }
    .svg();
    let text = format!(
        "# Sobolev's problem\n\nA point source of 1 cd between two parallel diffuse plates, gap h = 1 m, source half-way. Its illuminance is known exactly (Hankel's transform; formula in `tests/plates`), so it shows what a method's interval is worth. Made by `cargo run --release --example sobolev`; all values are in [sobolev.csv](sobolev.csv).\n\n![exact solution](exact.svg)\n\n![differences](differences.svg)\n\n| ρ₁ / ρ₂ | method | largest difference, standard errors | largest standard error | CPU | discs instead of planes |\n|---|---|---|---|---|---|\n{table}\nOf {compared} nominal 95 % intervals {outside} do not contain the exact value. Eight distances r = 0 … 5 h on the lower plate.\n\nThe scene has discs of radius 30 h where the problem has infinite planes. The last column is the largest relative change that this makes at the eight places, by a quadrature solution of the discs (conjugate gradients on rings); it is far below the resolution, so no correction is made. The open rim lets light escape, which each run reports.\n"
    );
    std::fs::create_dir_all("reports/sobolev")?;
    std::fs::write("reports/sobolev/sobolev.csv", csv)?;
    std::fs::write("reports/sobolev/differences.svg", svg)?;
    std::fs::write("reports/sobolev/exact.svg", exact)?;
    std::fs::write("reports/sobolev/README.md", &text)?;
    println!("{text}");
    Ok(())
}
