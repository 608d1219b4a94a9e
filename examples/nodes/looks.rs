//! Where the study looks, and what is truly seen there.

use gershun::estimate::Estimate;
use gershun::field::nodal::Spot;
use gershun::material::{Lobe, Phong};
use gershun::query::Demand;
use gershun::rng::Rng;
use gershun::scene::Scene;
use gershun::solve::nodal::{NodeRays, reflected};
use gershun::solve::{Effort, Method, Prepared, prepare};
use glam::DVec3;
use rayon::prelude::*;

use crate::common::{glossy, lambert, panel, room};

pub const SIZE: DVec3 = DVec3::new(6.0, 4.0, 2.8);
/// Height of the panel over the floor, m: the nearest that light comes from, d in the law.
pub const HEIGHT_M: f64 = 2.79;
const PANEL_M: f64 = 0.6;
/// Diffuse reflectance of the floor and its lobe's.
const FLOOR: [f64; 2] = [0.2, 0.3];
/// Independent estimates that a reference is made of, and rays of each.
const BLOCKS: u64 = 64;
const RAYS: u32 = 64;

/// The room of the study on directions, its floor glossy; a Lambertian floor without exponent.
pub fn scene(exponent: Option<u32>) -> Scene {
    let floor = match exponent {
        Some(n) => glossy("floor", FLOOR[0], Lobe::Phong(Phong::new(FLOOR[1], f64::from(n)))),
        None => lambert("floor", FLOOR[0]),
    };
    let materials = vec![floor, lambert("walls", 0.5), lambert("ceiling", 0.7)];
    let lamp = panel(4000.0, PANEL_M, DVec3::new(0.5 * SIZE.x, 0.5 * SIZE.y, HEIGHT_M));
    Scene::new(room(SIZE), materials, vec![lamp]).expect("the scene is valid")
}

/// A scene ready for look-ups; every seed has a field of patches of its own.
pub fn prepared(scene: &Scene, gather: u32, seed: u64) -> Prepared<'_> {
    static NOTHING: Demand = Demand { receivers: Vec::new(), rays: Vec::new(), flux: false };
    prepare(scene, &NOTHING, Method::Links, Effort { gather, ..Effort::default() }, seed)
}

/// A place on the floor with a direction in which it is seen (local, which on the floor is the world's up to a turn).
#[derive(Clone, Copy)]
pub struct Look {
    pub spot: Spot,
    pub point: DVec3,
    pub to_eye: DVec3,
}

/// Luminance by where light comes from: all, and without what comes straight from the panel.
pub type Lights = [f64; 2];

/// What is truly seen, by two independent halves.
pub struct Reference {
    pub halves: [Vec<Lights>; 2],
    /// Standard error of the mean of both.
    pub se: Vec<Lights>,
}

impl Reference {
    pub fn mean(&self, look: usize, light: usize) -> f64 {
        0.5 * (self.halves[0][look][light] + self.halves[1][look][light])
    }

    /// The first looks alone.
    pub fn first(&self, looks: usize) -> Self {
        let halves = [0, 1].map(|half| self.halves[half][..looks].to_vec());
        Self { halves, se: self.se[..looks].to_vec() }
    }

    pub fn largest(&self, light: usize) -> f64 {
        (0..self.se.len()).map(|look| self.mean(look, light)).fold(0.0, f64::max)
    }
}

/// `places` random places on the floor, 10 cm and more from walls, each seen from `directions` directions: every
/// second one uniform in solid angle, the others about the mirror image of a point of the panel, as far from it as
/// the lobe is wide. Not nearer to the surface than five degrees.
pub fn looks(scene: &Scene, exponent: u32, places: u64, directions: u64) -> Vec<Look> {
    let least = 5f64.to_radians().sin();
    let mut all = Vec::new();
    for place in 0..places {
        let mut rng = Rng::new(11, 1, place);
        let [u, v] = rng.uniforms();
        let margin_m = 0.1;
        let point = DVec3::new(
            margin_m + u * (SIZE.x - 2.0 * margin_m),
            margin_m + v * (SIZE.y - 2.0 * margin_m),
            0.0,
        );
        let hit = scene.tracer.closest(point + DVec3::Z, DVec3::NEG_Z, &[]).expect("the floor");
        let spot = Spot { triangle: hit.triangle, barycentric: hit.barycentric, front: hit.front };
        let into = gershun::sphere::frame(DVec3::Z).transpose();
        for number in 0..directions {
            let mut rng = Rng::new(11, 2 + place, number);
            let to_eye = loop {
                let [a, b, c, d] = rng.uniforms();
                let direction = if number % 2 == 0 {
                    let w = gershun::sphere::uniform_sphere([a, b]);
                    DVec3::new(w.x, w.y, w.z.abs())
                } else {
                    let centre = DVec3::new(0.5 * SIZE.x, 0.5 * SIZE.y, HEIGHT_M);
                    let lamp = centre + PANEL_M * DVec3::new(a - 0.5, b - 0.5, 0.0) - point;
                    let mirrored = DVec3::new(-lamp.x, -lamp.y, lamp.z).normalize();
                    let cos = (1.0 - c).powf(1.0 / f64::from(exponent + 1));
                    let (sin, turn) = ((1.0 - cos * cos).sqrt(), std::f64::consts::TAU * d);
                    let local = DVec3::new(sin * turn.cos(), sin * turn.sin(), cos);
                    gershun::sphere::frame(mirrored) * local
                };
                if direction.z > least {
                    break into * direction;
                }
            };
            all.push(Look { spot, point, to_eye });
        }
    }
    all
}

/// Luminance at a spot by one estimate.
pub fn seen(prepared: &Prepared, spot: &Spot, to_eye: DVec3, rays: NodeRays, rng: &mut Rng) -> Lights {
    let found = reflected(prepared, spot, to_eye, rays, rng);
    [found.direct[0] + found.indirect[0], found.indirect[0]]
}

/// The truth, without bias.
pub fn reference(scene: &Scene, looks: &[Look]) -> Reference {
    let prepared = prepared(scene, 16, 99);
    let (means, errors): (Vec<[Lights; 2]>, Vec<Lights>) = looks
        .par_iter()
        .enumerate()
        .map(|(number, look)| {
            let blocks: Vec<Lights> = (0..BLOCKS)
                .map(|block| {
                    let mut rng = Rng::new(99, 1 + block, number as u64);
                    seen(&prepared, &look.spot, look.to_eye, NodeRays::walked(RAYS), &mut rng)
                })
                .collect();
            let of = |light: usize, blocks: &[Lights]| {
                Estimate::from_blocks(&blocks.iter().map(|lights| lights[light]).collect::<Vec<f64>>())
            };
            let (first, second) = blocks.split_at(blocks.len() / 2);
            let halves = [first, second].map(|half| [0, 1].map(|light| of(light, half).value));
            (halves, [0, 1].map(|light| of(light, &blocks).se))
        })
        .unzip();
    let halves = [0, 1].map(|half| means.iter().map(|halves| halves[half]).collect());
    Reference { halves, se: errors }
}

/// How far two independent replicas of a field are from the truth, % of the largest luminance.
#[derive(Clone, Copy)]
pub struct Error {
    /// Root mean square of one replica, noise included.
    pub rms: f64,
    /// Largest of their mean, with half the noise's variance.
    pub largest: f64,
    /// Mean square of what interpolation errs: products of independent deviations have no noise on average.
    square: f64,
    /// Its standard error by the scatter over looks.
    square_se: f64,
    /// Root mean square standard error of the reference.
    pub reference: f64,
}

impl Error {
    pub fn of(replicas: &[Vec<Lights>; 2], reference: &Reference, light: usize) -> Self {
        let percent = 100.0 / reference.largest(light);
        let count = reference.se.len();
        let (mut square, mut largest, mut known) = (0.0, 0f64, 0.0);
        let mut products = Vec::with_capacity(count);
        for (look, se) in reference.se.iter().enumerate() {
            let truth = reference.mean(look, light);
            let found = [&replicas[0], &replicas[1]].map(|replica| replica[look][light]);
            square += found.iter().map(|value| (percent * (value - truth)).powi(2)).sum::<f64>() / 2.0;
            largest = largest.max(percent * (0.5 * (found[0] + found[1]) - truth).abs());
            let apart = [0, 1].map(|k| percent * (found[k] - reference.halves[k][look][light]));
            products.push(apart[0] * apart[1]);
            known += (percent * se[light]).powi(2);
        }
        let mean = Estimate::from_blocks(&products);
        Self {
            rms: (square / count as f64).sqrt(),
            largest,
            square: mean.value,
            square_se: mean.se,
            reference: (known / count as f64).sqrt(),
        }
    }

    /// Root mean square of what interpolation errs, if it stands out of the noise.
    pub fn interpolation(&self) -> Option<f64> {
        (self.square > 2.0 * self.square_se).then(|| self.square.sqrt())
    }

    /// The same as text: a value, or what it is below (two standard errors).
    pub fn interpolation_text(&self) -> String {
        match self.interpolation() {
            Some(rms) => format!("{rms:.2}"),
            None => format!("< {:.2}", (self.square.max(0.0) + 2.0 * self.square_se).sqrt()),
        }
    }
}
