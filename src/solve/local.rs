//! Local estimation: every vertex of the block's chains is connected to every receiver by the
//! receiver's own response,
//!
//!   E_ind(p) = 𝔼 Σ_n W_n f(r_n; l_n→p) cos θ_n R_p V / d²        (Marchuk; Budak et al. 2021)
//!
//! V being straight transmittance. 1/d² makes this heavy-tailed near surfaces, and light whose last
//! surface before the receiver is a mirror is missed altogether. So only the share
//! s = min(1, b d²/(cos θ_n R)) of a connection is taken, and rays drawn from the receiver's response
//! bring the rest: all that mirrors show, and (1 − s) of what is seen straight or through panes. Both
//! add up to the truth for any b. Direct light is computed as by the links method.

use super::answer::direct;
use super::chains::{self, Vertex};
use super::double::{Desk, answer_ray, light_at};
use super::{Counts, PARTS, Part, Prepared, Sheet, lifted, turn};
use crate::query::Receiver;
use crate::rng::{Rng, Stratified};
use crate::scene::Scene;

/// Effort and variants of local and double local estimation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalEffort {
    /// Chains per block; a channel has at least one.
    pub chains: u32,
    /// Shadow rays from a receiver to the chains' vertices per block on average; those that would add
    /// little are taken more rarely and weighted up. Infinite: every vertex to every receiver.
    pub connections: f64,
    /// Rays per receiver and block for what connections leave out.
    pub returns: u32,
    /// How connections near surfaces are treated.
    pub kernel: LocalKernel,
    /// How what lines of sight meet is treated by the double method.
    pub form: SeenForm,
}

/// The kernel of a connection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocalKernel {
    /// Bounded, the rest made up for: unbiased with finite variance.
    Bounded {
        /// Bound of cos θ cos θ′/(π d²), 1/m²; `None`: (S / 6V)² of the scene's bounding box.
        bound_m2: Option<f64>,
    },
    /// The paper's, unbounded: unbiased where no mirror is, but heavy-tailed near surfaces, where
    /// its intervals are false. For study.
    Plain,
}

/// How the luminance of a surface that a line of sight meets is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeenForm {
    /// By connection where its scattering function is broad, by gathering where it is narrow.
    Auto,
    /// Form A: connection to the chains' vertices through the whole scattering function.
    Connect,
    /// Form B: rays drawn from the scattering function, connection only where they end.
    Gather,
}

impl Default for LocalEffort {
    fn default() -> Self {
        Self {
            chains: 16,
            connections: 16.0,
            returns: 4,
            kernel: LocalKernel::Bounded { bound_m2: None },
            form: SeenForm::Auto,
        }
    }
}

/// Largest G = cos θ cos θ′/d² of a connection in the scene, 1/m².
pub(super) fn bound_m2(scene: &Scene, effort: &LocalEffort) -> f64 {
    let of_scene = || {
        let size = scene.mesh.bounds().map_or(glam::DVec3::ONE, |(low, high)| high - low);
        let surface = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
        let volume = size.x * size.y * size.z;
        // A flat scene has no length of its own but its extent.
        let length_m = if volume > 0.0 { 6.0 * volume / surface } else { size.length() };
        1.0 / (length_m * length_m)
    };
    match effort.kernel {
        LocalKernel::Bounded { bound_m2 } => std::f64::consts::PI * bound_m2.unwrap_or_else(of_scene),
        LocalKernel::Plain => f64::INFINITY,
    }
}

/// The share of a connection that is taken, from its G = cos θ cos θ′/d².
pub(super) fn share(prepared: &Prepared, g_m2: f64) -> f64 {
    if g_m2 > prepared.bound_m2 { prepared.bound_m2 / g_m2 } else { 1.0 }
}

/// Block `stream` of a `Local` or `Double` solution.
pub(super) fn block(prepared: &Prepared, stream: u64) -> Sheet {
    let channels = prepared.scene.channels.len();
    let demand = prepared.demand;
    let mut counts = Counts::default();
    let vertices = chains::block(prepared, stream, &mut counts);
    let mut desk = Desk::new(&vertices, channels, counts);
    let mut values = vec![0.0; demand.rows() * channels * PARTS];
    // Items of this stream are disjoint from those of the other methods: all stay independent.
    let item = |index: usize| (1 << 42) + 1 + index as u64;
    for (index, receiver) in demand.receivers.iter().enumerate() {
        let row = prepared.first_rows[index];
        let span = row * channels * PARTS..(row + receiver.kernels.len()) * channels * PARTS;
        let mut rng = Rng::new(prepared.seed, stream, item(index));
        let out = &mut values[span];
        direct(prepared, receiver, row, &mut rng, out);
        connect(prepared, receiver, &mut rng, &mut desk, out);
        make_up(prepared, receiver, &mut rng, &mut desk, out);
    }
    let first_ray = demand.rows() - demand.rays.len();
    for (index, ray) in demand.rays.iter().enumerate() {
        let row = first_ray + index;
        let mut rng = Rng::new(prepared.seed, stream, item(demand.receivers.len() + index));
        let out = &mut values[row * channels * PARTS..(row + 1) * channels * PARTS];
        answer_ray(prepared, ray, &mut rng, &mut desk, out);
    }
    Sheet { values, flux: None, counts: desk.counts }
}

/// The bounded share of every vertex's light.
fn connect(prepared: &Prepared, receiver: &Receiver, rng: &mut Rng, desk: &mut Desk, out: &mut [f64]) {
    let scene = prepared.scene;
    let channels = scene.channels.len();
    let origin = lifted(scene, receiver.point, receiver.lift);
    desk.linked.clear();
    let mut total = 0.0;
    let largest = |direction| receiver.kernels.iter().map(|k| k.response(direction)).fold(0.0, f64::max);
    for (index, vertex) in desk.vertices.iter().enumerate() {
        let towards = vertex.point - origin;
        let squared = towards.length_squared();
        let direction = towards / squared.sqrt();
        let response = largest(direction);
        if !(response > 0.0) {
            continue;
        }
        let Some(normal_lx) = arriving_lx(prepared, vertex, direction, squared, response) else { continue };
        total += response * normal_lx;
        desk.linked.push((index as u32, normal_lx, response * normal_lx));
    }
    for &(index, normal_lx, weight) in &desk.linked {
        let chance = (prepared.effort.local.connections * weight / total).min(1.0);
        if chance < 1.0 && rng.uniform() >= chance {
            continue;
        }
        let vertex = &desk.vertices[index as usize];
        let towards = vertex.point - origin;
        let distance_m = towards.length();
        let direction = towards / distance_m;
        let reach = distance_m - 2.0 * scene.tracer.offset_m();
        let lx = normal_lx * scene.tracer.transmittance(origin, direction, reach, &[]) / chance;
        if lx > 0.0 {
            for (k, kernel) in receiver.kernels.iter().enumerate() {
                let slot = (k * channels + vertex.channel) * PARTS + Part::Indirect as usize;
                out[slot] += lx * kernel.response(direction);
            }
        }
    }
}

/// Normal illuminance W f cos θ / d² of a vertex at a place it does not shade, times the share that
/// connections take there; `cos` is the place's own factor (response, cosine).
pub(super) fn arriving_lx(
    prepared: &Prepared,
    vertex: &Vertex,
    direction: glam::DVec3,
    distance_squared: f64,
    cos: f64,
) -> Option<f64> {
    let intensity_cd = vertex.intensity_cd(prepared.scene, -direction, prepared.cap());
    let g_m2 = cos * vertex.normal.dot(direction).abs() / distance_squared;
    let normal_lx = intensity_cd / distance_squared * share(prepared, g_m2);
    (normal_lx > 0.0 && normal_lx.is_finite()).then_some(normal_lx)
}

/// Rays from the receiver for what connections leave out.
fn make_up(prepared: &Prepared, receiver: &Receiver, rng: &mut Rng, desk: &mut Desk, out: &mut [f64]) {
    let scene = prepared.scene;
    let channels = scene.channels.len();
    let origin = lifted(scene, receiver.point, receiver.lift);
    let kernels = &receiver.kernels;
    // Whole rounds over the kernels, so that the mixture of their densities has equal weights.
    let rays = prepared.effort.local.returns.max(1).next_multiple_of(kernels.len() as u32);
    let sequence = Stratified::new(rng);
    for sample in 0..rays {
        let (kernel, place) = turn(sample, rays, kernels.len());
        let direction = kernels[kernel].sample(sequence.point(place, rng));
        let density: f64 =
            kernels.iter().map(|kernel| kernel.pdf(direction)).sum::<f64>() / kernels.len() as f64;
        if !(density > 0.0) {
            continue;
        }
        let response = kernels.iter().map(|kernel| kernel.response(direction)).fold(0.0, f64::max);
        desk.seen.fill(0.0);
        light_at(prepared, origin, direction, response, 1.0, rng, desk);
        for (k, kernel) in kernels.iter().enumerate() {
            let weight = kernel.response(direction) / density / f64::from(rays);
            for (channel, seen) in desk.seen.iter().enumerate() {
                out[(k * channels + channel) * PARTS + Part::Indirect as usize] += weight * seen;
            }
        }
    }
}
