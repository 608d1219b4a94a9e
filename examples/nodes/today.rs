//! What the tables compete with: patches that store one number, and lobe rays at every look.

use gershun::query::Ray;
use gershun::rng::Rng;
use gershun::scene::Scene;
use gershun::solve::{PARTS, answer_ray};
use glam::DVec3;

use crate::Row;
use crate::common::cpu_seconds;
use crate::looks::{Error, Lights, Look, Reference, prepared, seen};

/// Rays of a look.
const RAYS: [u32; 5] = [1, 4, 16, 64, 256];
/// Distance of the eye from what it looks at, m: nothing is between, the nearest wall is farther.
const EYE_M: f64 = 0.05;

/// The line of sight of a look at the floor.
pub fn ray(look: &Look) -> Ray {
    let towards = gershun::sphere::frame(DVec3::Z) * look.to_eye;
    Ray { point: look.point + EYE_M * towards, direction: -towards }
}

pub fn measure(exponent: u32, scene: &Scene, looks: &[Look], reference: &Reference, rows: &mut Vec<Row>) {
    for rays in RAYS {
        let prepared = prepared(scene, rays, 31);
        for light in 0..2 {
            let before = cpu_seconds();
            // So many rounds that CPU time can be read off the clock; the first two count.
            let rounds = (1024 / rays).clamp(4, 64);
            let found: Vec<Vec<Lights>> = (0..rounds)
                .map(|round| {
                    let one = |(index, look): (usize, &Look)| {
                        let mut rng = Rng::new(31, u64::from(1 + round), index as u64);
                        if light == 1 {
                            return seen(&prepared, &look.spot, look.to_eye, rays, &mut rng);
                        }
                        let mut sheet = [0.0; PARTS];
                        answer_ray(&prepared, &ray(look), &mut rng, &mut sheet);
                        [sheet.iter().sum(), 0.0]
                    };
                    looks.iter().enumerate().map(one).collect()
                })
                .collect();
            let cpu_s = (cpu_seconds() - before) / (f64::from(rounds) * looks.len() as f64);
            let found = [found[0].clone(), found[1].clone()];
            rows.push(Row {
                part: "today",
                light,
                exponent: Some(exponent),
                way: "patches and lobe rays".into(),
                numbers: rays as usize,
                spacing_m: 0.0,
                nodes: 0,
                rays,
                error: Error::of(&found, reference, light),
                cpu_s,
            });
        }
    }
}
