//! What the tables compete with: patches that store one number, and lobe rays at every look.

use gershun::query::Ray;
use gershun::rng::Rng;
use gershun::scene::Scene;
use gershun::solve::nodal::NodeRays;
use gershun::solve::{PARTS, answer_ray};
use glam::DVec3;

use crate::Row;
use crate::common::cpu_seconds;
use crate::looks::{Error, Lights, Look, Reference, prepared, seen};

/// Rays of a look, each walked on from, as answers have them …
const RAYS: [u32; 5] = [1, 4, 16, 64, 256];
/// … and none, as pictures do.
const QUICK_RAYS: [u32; 5] = [4, 16, 64, 256, 1024];
/// Their names.
pub const WAYS: [&str; 2] = ["patches and lobe rays, walked on", "patches and lobe rays, as stored"];
/// Distance of the eye from what it looks at, m: nothing is between, the nearest wall is farther.
const EYE_M: f64 = 0.05;

/// The line of sight of a look at the floor.
pub fn ray(look: &Look) -> Ray {
    let towards = gershun::sphere::frame(DVec3::Z) * look.to_eye;
    Ray { point: look.point + EYE_M * towards, direction: -towards }
}

pub fn measure(exponent: u32, scene: &Scene, looks: &[Look], reference: &Reference, rows: &mut Vec<Row>) {
    for rays in RAYS {
        // Two fields of patches, so that their errors show as well.
        let prepared = [31, 32].map(|seed| prepared(scene, rays, seed));
        for light in 0..2 {
            let look = |field: usize, look: &Look, rng: &mut Rng| {
                if light == 1 {
                    return seen(&prepared[field], &look.spot, look.to_eye, NodeRays::walked(rays), rng);
                }
                let mut sheet = [0.0; PARTS];
                answer_ray(&prepared[field], &ray(look), rng, &mut sheet);
                [sheet.iter().sum(), 0.0]
            };
            let (found, cpu_s) = timed(looks, rays, look);
            rows.push(row(exponent, light, WAYS[0], rays, Error::of(&found, reference, light), cpu_s));
        }
    }
    let prepared = [31, 32].map(|seed| prepared(scene, 16, seed));
    for rays in QUICK_RAYS {
        let stored = NodeRays { gather: rays, walks: 0 };
        let look = |field: usize, look: &Look, rng: &mut Rng| {
            seen(&prepared[field], &look.spot, look.to_eye, stored, rng)
        };
        let (found, cpu_s) = timed(looks, rays, look);
        for light in 0..2 {
            rows.push(row(exponent, light, WAYS[1], rays, Error::of(&found, reference, light), cpu_s));
        }
    }
}

fn row(exponent: u32, light: usize, way: &str, rays: u32, error: Error, cpu_s: f64) -> Row {
    Row {
        part: "today",
        light,
        exponent: Some(exponent),
        way: way.into(),
        numbers: rays as usize,
        spacing_m: 0.0,
        nodes: 0,
        rays,
        error,
        cpu_s,
        look_s: 0.0,
    }
}

/// Two rounds of looks, each with a field of its own, and the CPU time of one look by as many rounds as the clock needs.
fn timed(
    looks: &[Look],
    rays: u32,
    look: impl Fn(usize, &Look, &mut Rng) -> Lights,
) -> ([Vec<Lights>; 2], f64) {
    let before = cpu_seconds();
    let rounds = u64::from((256 / rays).clamp(2, 32));
    let mut found: Vec<Vec<Lights>> = Vec::new();
    for round in 0..rounds {
        let one = |(index, place): (usize, &Look)| {
            look((round % 2) as usize, place, &mut Rng::new(31, 1 + round, index as u64))
        };
        found.push(looks.iter().enumerate().map(one).collect());
    }
    let cpu_s = (cpu_seconds() - before) / (rounds as usize * looks.len()) as f64;
    let second = found.swap_remove(1);
    ([found.swap_remove(0), second], cpu_s)
}
