//! The luminance body of a point: the luminance that arrives there from every direction, and the two
//! figures A. A. Gershun drew from it (Световое поле, 1936): the light vector and the mean spherical
//! illuminance.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rayon::prelude::*;

use crate::estimate::Estimate;
use crate::measure::weights;
use crate::project::{Project, World};
use crate::query::{Demand, Ray};
use crate::rng::Rng;
use crate::solve::{Effort, Method, PARTS, Prepared, answer_ray, prepare};

/// Where a body is asked for, and how finely.
#[derive(Clone, Debug)]
pub struct AskedBody {
    /// What it is called.
    pub name: String,
    /// World and room of the point.
    pub place: [usize; 2],
    /// The point, m.
    pub point: DVec3,
    /// Light scene.
    pub light_scene: usize,
    /// Edge of a cell in azimuth and elevation, degrees; a divisor of 90.
    pub step_deg: f64,
    /// Blocks, at least 2.
    pub blocks: u32,
}

/// A luminance body.
#[derive(Clone, Debug)]
pub struct LuminanceBody {
    /// What it is called.
    pub name: String,
    /// Light scene.
    pub light_scene: String,
    /// The point, m.
    pub point: DVec3,
    /// Cells along the azimuth, from 0 (+x) towards +y.
    pub azimuths: usize,
    /// Cells along the elevation, from the nadir up.
    pub elevations: usize,
    /// Mean luminance of every cell, cd/m² at initial flux, row by row from the nadir.
    pub cells: Vec<Estimate>,
    /// Light vector ∫ L l dω over the directions l in which light is looked for, lx: it points to where
    /// most of the light comes from, and its component along a normal is E in front less E behind.
    pub vector_lx: [Estimate; 3],
    /// Mean spherical illuminance ∫ L dω / 4, lx.
    pub spherical_lx: Estimate,
    /// Blocks.
    pub blocks: u32,
    /// Whether the light scene has point sources, which have no luminance and are not in the body.
    pub lacks_points: bool,
}

impl LuminanceBody {
    /// Azimuth and elevation of a cell's centre, degrees, and its solid angle, sr.
    pub fn cell(&self, index: usize) -> ([f64; 2], f64) {
        let step_deg = 180.0 / self.elevations as f64;
        let (row, column) = (index / self.azimuths, index % self.azimuths);
        let [azimuth, low] = [(column as f64 + 0.5) * step_deg, row as f64 * step_deg - 90.0];
        let high_deg = low + step_deg;
        let band = high_deg.to_radians().sin() - low.to_radians().sin();
        ([azimuth, low + 0.5 * step_deg], step_deg.to_radians() * band)
    }
}

/// The luminance body of a point: every block draws one ray in every cell, uniform in solid angle.
pub fn luminance_body(project: &Project, asked: &AskedBody, tell: &(dyn Fn(usize) + Sync)) -> LuminanceBody {
    let world: &World = &project.worlds[asked.place[0]];
    let light_scene = &project.light_scenes[asked.light_scene];
    let weights = weights(world, light_scene, &world.rooms[asked.place[1]], false);
    let demand = Demand::default();
    let effort = Effort { gather: 1, ..Effort::default() };
    let prepared = prepare(&world.scene, &demand, Method::Links, effort, project.accuracy.seed);
    let elevations = (180.0 / asked.step_deg).round() as usize;
    let azimuths = 2 * elevations;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let blocks: Vec<Vec<f64>> = (0..u64::from(asked.blocks))
        .into_par_iter()
        .map(|block| {
            let values = replicate(&prepared, asked, [azimuths, elevations], &weights, block);
            tell(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1);
            values
        })
        .collect();
    let estimate = |of: &dyn Fn(&[f64]) -> f64| {
        Estimate::from_blocks(&blocks.iter().map(|values| of(values)).collect::<Vec<f64>>())
    };
    let cells = azimuths * elevations;
    let lacks_points = world.scene.luminaires.iter().enumerate().any(|(index, luminaire)| {
        luminaire.kind.opening.is_point() && weights[world.scene.channel_of[index]] > 0.0
    });
    LuminanceBody {
        name: asked.name.clone(),
        light_scene: light_scene.name.clone(),
        point: asked.point,
        azimuths,
        elevations,
        cells: (0..cells).map(|cell| estimate(&|values| values[cell])).collect(),
        vector_lx: std::array::from_fn(|axis| estimate(&|values| values[cells + axis])),
        spherical_lx: estimate(&|values| values[cells + 3]),
        blocks: asked.blocks,
        lacks_points,
    }
}

/// One block: luminance of the cells, then the light vector and the mean spherical illuminance.
fn replicate(
    prepared: &Prepared,
    asked: &AskedBody,
    [azimuths, elevations]: [usize; 2],
    weights: &[f64],
    block: u64,
) -> Vec<f64> {
    let mut values = Vec::with_capacity(azimuths * elevations + 4);
    let (mut vector, mut all) = (DVec3::ZERO, 0.0);
    let mut sheet = vec![0.0; weights.len() * PARTS];
    let edge = |row: usize| (PI * (row as f64 / elevations as f64 - 0.5)).sin();
    for row in 0..elevations {
        let (low, high) = (edge(row), edge(row + 1));
        let solid_angle_sr = (high - low) * TAU / azimuths as f64;
        for column in 0..azimuths {
            let mut rng = Rng::new(prepared.seed(), block + 1, (row * azimuths + column) as u64);
            let [u, v] = rng.uniforms();
            let (sin_cos, z) =
                ((TAU * (column as f64 + u) / azimuths as f64).sin_cos(), low + (high - low) * v);
            let across = (1.0 - z * z).max(0.0).sqrt();
            let direction = DVec3::new(across * sin_cos.1, across * sin_cos.0, z);
            sheet.fill(0.0);
            answer_ray(prepared, &Ray { point: asked.point, direction }, &mut rng, &mut sheet);
            let channels = sheet.chunks(PARTS).zip(weights);
            let luminance: f64 = channels.map(|(parts, weight)| weight * parts.iter().sum::<f64>()).sum();
            vector += direction * (luminance * solid_angle_sr);
            all += luminance * solid_angle_sr;
            values.push(luminance);
        }
    }
    values.extend(vector.to_array());
    values.push(0.25 * all);
    values
}
