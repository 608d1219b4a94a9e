//! The paper's field – nodes × directions – solved and measured: error of the luminance that is looked up against
//! the number of directions in three forms and against the distance between nodes, for all light and for indirect
//! light, with memory and CPU time, beside patches and lobe rays. Writes CSV, drawings and a page to reports/nodes:
//!
//!     cargo run --release --example nodes
#![allow(clippy::print_stdout, reason = "a study prints")]

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "../figure/mod.rs"]
mod figure;
mod floors;
mod looks;
mod page;
mod positions;
mod tables;
mod today;

use std::error::Error as Failure;

use common::cpu_seconds;
use looks::Error;

/// Exponents of the floor's lobe.
const EXPONENTS: [u32; 5] = [1, 10, 30, 100, 1000];
/// Which light, as [`looks::Lights`] has it.
const LIGHTS: [&str; 2] = ["all", "indirect"];

/// One measured configuration.
struct Row {
    part: &'static str,
    light: usize,
    /// None: a floor without lobe.
    exponent: Option<u32>,
    way: String,
    /// Numbers per node and channel; of rays: per look.
    numbers: usize,
    spacing_m: f64,
    /// Nodes on the whole floor.
    nodes: usize,
    /// Rays by which each number was estimated.
    rays: u32,
    error: Error,
    /// CPU for the whole floor's nodes, or of one look where nothing is stored, s.
    cpu_s: f64,
    /// CPU of one look at a field, s; none where it was not measured.
    look_s: f64,
}

impl Row {
    /// Memory of the whole floor's numbers, one channel, bytes.
    fn bytes(&self) -> usize {
        8 * self.numbers * self.nodes
    }
}

fn main() -> Result<(), Box<dyn Failure>> {
    let mut rows = Vec::new();
    let mut largest = Vec::new();
    for exponent in EXPONENTS {
        let before = cpu_seconds();
        let scene = looks::scene(Some(exponent));
        let looks = looks::looks(&scene, exponent, 24, 8);
        let reference = looks::reference(&scene, &looks);
        largest.push((exponent, [0, 1].map(|light| reference.largest(light))));
        positions::measure(exponent, &scene, &looks, &reference, &mut rows);
        today::measure(exponent, &scene, &looks, &reference, &mut rows);
        let after = cpu_seconds();
        tables::directions(exponent, &scene, &mut rows);
        let then = cpu_seconds();
        tables::whole(exponent, &scene, &looks, &reference, &mut rows);
        println!(
            "exponent {exponent}: references and positions {:.0} CPU-s, directions {:.0}, whole fields {:.0}",
            after - before,
            then - after,
            cpu_seconds() - then
        );
    }
    floors::measure(&mut rows);
    println!("all: {:.0} CPU-s", cpu_seconds());
    page::write(&rows, &largest)
}
