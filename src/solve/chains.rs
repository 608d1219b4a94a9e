//! Chains of light: particles leave luminaires and luminous surfaces with the distribution of what
//! these emit, and every surface they meet becomes a vertex with the flux that arrives there.
//! One block's chains are shared by all of its receivers. A newcomer's mistake: absorption ends a
//! chain and leaves its flux as it is; only very bright surfaces take from the flux instead.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::flux::{FluxSource, sources};
use super::{Counts, Prepared};
use crate::material::Bsdf;
use crate::rng::{Rng, Stratified};
use crate::scene::Scene;
use crate::sphere;

/// Surfaces after which a chain is cut and counted: only a cage without absorption gets here.
const MOST_BOUNCES: u32 = 100_000;
/// Surfaces with a greater albedo take from the flux of a chain …
const BRIGHT: f64 = 0.9;
/// … until this share is left, since chains whose number of vertices is a matter of chance would be
/// the largest error there: at an albedo of 0.999 the number of vertices varies as much as its mean.
const LEFT: f64 = 0.1;

/// What chains start from, by channel.
#[derive(Debug)]
pub(super) struct Origins {
    channels: Vec<Origin>,
    flux_lm: f64,
}

/// The luminaires, or the luminous triangles, of one channel.
#[derive(Debug)]
struct Origin {
    sources: Vec<FluxSource>,
    /// Cumulative flux, lm.
    flux_lm: Vec<f64>,
}

/// Light that arrived at a surface, or that a luminous surface sends out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    /// Position, m.
    pub point: DVec3,
    /// Unit normal on the side of arrival (of emission).
    pub normal: DVec3,
    /// Triangle.
    pub triangle: u32,
    /// Channel of the scene.
    pub channel: usize,
    /// Flux that arrives, lm; what a luminous surface emits at the start of a chain.
    pub flux_lm: f64,
    /// Unit direction the light came from; `None` at the start on a luminous surface.
    pub from: Option<DVec3>,
    /// f in 1/sr on the side of arrival and on the other, where it is the same for all directions.
    pub even: Option<[f64; 2]>,
}

impl Origins {
    /// Collects the sources of a scene.
    pub(super) fn new(scene: &Scene) -> Self {
        let mut channels: Vec<Origin> =
            scene.channels.iter().map(|_| Origin { sources: Vec::new(), flux_lm: Vec::new() }).collect();
        for source in sources(scene) {
            if source.flux_lm > 0.0 {
                let origin = &mut channels[source.channel];
                origin.flux_lm.push(origin.flux() + source.flux_lm);
                origin.sources.push(source);
            }
        }
        let flux_lm = channels.iter().map(Origin::flux).sum();
        Self { channels, flux_lm }
    }
}

impl Origin {
    fn flux(&self) -> f64 {
        self.flux_lm.last().copied().unwrap_or(0.0)
    }
}

impl Vertex {
    /// Luminous intensity towards the unit `direction` in cd, W f cos θ, with the scattering function
    /// f held at or below `cap` times that of a diffuse surface of the same albedo.
    pub(super) fn intensity_cd(&self, scene: &Scene, direction: DVec3, cap: f64) -> f64 {
        let cos = self.normal.dot(direction);
        if let Some([same, other]) = self.even {
            return self.flux_lm * if cos > 0.0 { same * cos } else { -other * cos };
        }
        let Some(from) = self.from else { return 0.0 };
        let normal = if cos > 0.0 { self.normal } else { -self.normal };
        let into = sphere::frame(normal).transpose();
        self.flux_lm * capped(scene.bsdf(self.triangle), into * from, into * direction, cap) * cos.abs()
    }
}

/// f on both sides in 1/sr of a surface whose scattering is diffuse and nothing else.
pub(super) fn even(bsdf: &Bsdf) -> Option<[f64; 2]> {
    let (reflectance, transmittance) = bsdf.diffuse();
    let more = |cos: f64| bsdf.albedo(cos) - reflectance - transmittance > 1e-12;
    let glossy = bsdf.specular(1.0).is_some() || more(1.0) || more(0.5) || more(0.05);
    (!glossy).then_some([reflectance * FRAC_1_PI, transmittance * FRAC_1_PI])
}

/// f(wi, wo), 1/sr, at or below `cap` times albedo/π. The albedo is that of `wo`, which both ways of
/// finding a path know before they know `wi`.
pub(super) fn capped(bsdf: &Bsdf, wi: DVec3, wo: DVec3, cap: f64) -> f64 {
    let f = bsdf.f(wi, wo);
    if cap.is_finite() { f.min(cap * bsdf.albedo(wo.z) * FRAC_1_PI) } else { f }
}

/// The chains of block `stream`: every vertex, chain after chain. Each channel has at least one chain.
pub(super) fn block(prepared: &Prepared, stream: u64, counts: &mut Counts) -> Vec<Vertex> {
    let scene = prepared.scene;
    let mut vertices = Vec::new();
    let Some(origins) = &prepared.origins else { return vertices };
    let mut rng = Rng::new(prepared.seed, stream, 1 << 42);
    for (channel, origin) in origins.channels.iter().enumerate() {
        let flux_lm = origin.flux();
        if !(flux_lm > 0.0) {
            continue;
        }
        let share = f64::from(prepared.effort.local.chains) * flux_lm / origins.flux_lm;
        let chains = share.round().max(1.0) as u32;
        let (places, directions) = (Stratified::new(&mut rng), Stratified::new(&mut rng));
        let turn = rng.uniform();
        for chain in 0..chains {
            // Systematic choice: luminaire by flux, equal chances over the runs.
            let at = (f64::from(chain) + turn) / f64::from(chains) * flux_lm;
            let chosen = origin.flux_lm.partition_point(|sum| *sum <= at).min(origin.sources.len() - 1);
            let source = &origin.sources[chosen];
            let index = chain % 65_536;
            let start = source.start(scene, places.point(index, &mut rng), directions.point(index, &mut rng));
            let weight = flux_lm / f64::from(chains);
            if let Some((triangle, normal)) = source.surface(scene) {
                let (point, even) = (start.0, Some([FRAC_1_PI, 0.0]));
                vertices.push(Vertex { point, normal, triangle, channel, flux_lm: weight, from: None, even });
            }
            follow(scene, source, start, channel, weight, &mut rng, &mut vertices, counts);
        }
    }
    vertices
}

#[allow(clippy::too_many_arguments, reason = "one chain has this much state; a struct would only rename it")]
fn follow(
    scene: &Scene,
    source: &FluxSource,
    (mut origin, mut direction): (DVec3, DVec3),
    channel: usize,
    started_lm: f64,
    rng: &mut Rng,
    vertices: &mut Vec<Vertex>,
    counts: &mut Counts,
) {
    let (mut blind, _) = source.body(scene);
    let mut flux_lm = started_lm;
    for _ in 0..MOST_BOUNCES {
        counts.rays += 1;
        let Some(hit) = scene.tracer.closest(origin, direction, blind) else {
            counts.escaped += 1;
            return;
        };
        let face = scene.tracer.normal(hit.triangle);
        let normal = if hit.front { face } else { -face };
        let point = origin + direction * hit.distance_m;
        let bsdf = scene.bsdf(hit.triangle);
        if bsdf.specular(1.0).is_none() {
            let (triangle, from) = (hit.triangle, Some(-direction));
            let even = even(bsdf);
            vertices.push(Vertex { point, normal, triangle, channel, flux_lm, from, even });
        }
        let frame = sphere::frame(normal);
        let Some(next) = bsdf.sample(frame.transpose() * -direction, rng.uniforms()) else { return };
        let fades = next.weight > BRIGHT && flux_lm > LEFT * started_lm;
        let survival = if fades { 1.0 } else { next.weight.min(1.0) };
        if rng.uniform() >= survival {
            return;
        }
        flux_lm *= next.weight / survival;
        if !next.specular || next.direction.z > 0.0 {
            blind = &[];
        }
        let lift = scene.tracer.offset_m();
        origin = point + normal * if next.direction.z > 0.0 { lift } else { -lift };
        direction = frame * next.direction;
    }
    counts.cut += 1;
}
