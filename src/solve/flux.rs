//! Flux balance by its own tally: particles leave the luminaires with the distribution of their
//! intensity and are followed until absorbed. Every particle is accounted for, so emitted =
//! absorbed + escaped + lost holds in each block and the lost share is measured, not assumed.

use glam::DVec3;

use super::{Counts, FluxSheet, Prepared};
use crate::rng::{Rng, Stratified};
use crate::scene::{Channel, Scene};
use crate::sphere;

const MOST_BOUNCES: u32 = 100_000;

/// The tally of block `stream`.
pub(super) fn block(prepared: &Prepared, stream: u64, counts: &mut Counts) -> FluxSheet {
    let scene = prepared.scene;
    let channels = scene.channels.len();
    let surfaces = scene.mesh.surfaces.len();
    let mut sheet = FluxSheet {
        incident: vec![0.0; surfaces * channels],
        absorbed: vec![0.0; surfaces * channels],
        escaped: vec![0.0; channels],
        emitted: vec![0.0; channels],
        omitted: vec![0.0; channels],
    };
    let mut rng = Rng::new(prepared.seed, stream, 1 << 41);
    let sources = sources(scene);
    let total: f64 = sources.iter().map(|source| source.flux_lm).sum();
    if !(total > 0.0) {
        return sheet;
    }
    for source in &sources {
        sheet.emitted[source.channel] += source.flux_lm;
        // At least one particle from each source keeps every channel unbiased.
        let share = f64::from(prepared.effort.particles) * source.flux_lm / total;
        let particles = share.ceil().max(1.0) as u32;
        let (places, directions) = (Stratified::new(&mut rng), Stratified::new(&mut rng));
        let flux_lm = source.flux_lm / f64::from(particles);
        for particle in 0..particles {
            let index = particle % 65_536;
            let start = source.start(scene, places.point(index, &mut rng), directions.point(index, &mut rng));
            let mut tally = Tally { sheet: &mut sheet, channel: source.channel, channels, flux_lm };
            follow(prepared, source, start, &mut rng, &mut tally, counts);
        }
    }
    sheet
}

struct Tally<'a> {
    sheet: &'a mut FluxSheet,
    channel: usize,
    channels: usize,
    flux_lm: f64,
}

/// A luminaire, or one side of a triangle of an emitting surface.
#[derive(Debug)]
pub(super) struct FluxSource {
    /// Channel of the scene.
    pub channel: usize,
    /// Emitted flux, lm.
    pub flux_lm: f64,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Luminaire(usize),
    Triangle { index: usize, front: bool },
}

/// Everything that emits: luminaires first, then both sides of every luminous triangle.
pub(super) fn sources(scene: &Scene) -> Vec<FluxSource> {
    let mut sources: Vec<FluxSource> = scene
        .luminaires
        .iter()
        .enumerate()
        .map(|(index, lamp)| FluxSource {
            channel: scene.channel_of[index],
            flux_lm: lamp.kind.flux_lm * lamp.dim,
            kind: Kind::Luminaire(index),
        })
        .collect();
    for index in 0..scene.mesh.triangles.len() {
        let emitted = scene.bsdf(index as u32).emitted();
        let material = scene.mesh.surfaces[scene.mesh.triangles[index].surface as usize].material;
        if let (true, Some(channel)) =
            (emitted > 0.0, scene.channels.iter().position(|c| *c == Channel::Surfaces { material }))
        {
            let flux_lm = std::f64::consts::PI * emitted * scene.mesh.normal_and_area(index).1;
            for front in [true, false] {
                sources.push(FluxSource { channel, flux_lm, kind: Kind::Triangle { index, front } });
            }
        }
    }
    sources
}

impl FluxSource {
    /// A particle's start and direction from uniform numbers, distributed as the light is.
    pub(super) fn start(&self, scene: &Scene, place: [f64; 2], u: [f64; 3]) -> (DVec3, DVec3) {
        let lift = scene.tracer.offset_m();
        match self.kind {
            Kind::Luminaire(index) => {
                let lamp = &scene.luminaires[index];
                let (local, _) = lamp.kind.distribution.sample_direction(u);
                let direction = lamp.world_from_luminaire * local;
                let at = lamp.position + lamp.world_from_luminaire * lamp.kind.opening.point(place);
                (at + direction * lift, direction)
            }
            Kind::Triangle { index, front } => {
                let [a, b, c] = scene.mesh.corners(index);
                let root = place[0].sqrt();
                let at = a + (b - a) * (root * (1.0 - place[1])) + (c - a) * (root * place[1]);
                let face = scene.mesh.normal_and_area(index).0;
                let normal = if front { face } else { -face };
                (at + normal * lift, sphere::frame(normal) * sphere::cosine_hemisphere([u[0], u[1]]))
            }
        }
    }

    /// Triangle and unit normal of the luminous side; `None` for a luminaire.
    pub(super) fn surface(&self, scene: &Scene) -> Option<(u32, DVec3)> {
        match self.kind {
            Kind::Luminaire(_) => None,
            Kind::Triangle { index, front } => {
                let face = scene.mesh.normal_and_area(index).0;
                Some((index as u32, if front { face } else { -face }))
            }
        }
    }

    /// Surfaces to which the source itself is blind, and whether it is a point.
    pub(super) fn body<'s>(&self, scene: &'s Scene) -> (&'s [u32], bool) {
        match self.kind {
            Kind::Luminaire(index) => {
                let lamp = &scene.luminaires[index];
                (&lamp.body, !(lamp.kind.opening.area_m2() > 0.0))
            }
            Kind::Triangle { .. } => (&[], false),
        }
    }
}

fn follow(
    prepared: &Prepared,
    source: &FluxSource,
    (mut origin, mut direction): (DVec3, DVec3),
    rng: &mut Rng,
    tally: &mut Tally,
    counts: &mut Counts,
) {
    let scene = prepared.scene;
    let (body, point_source) = source.body(scene);
    let mut blind = body;
    // Specular reflections since the source, and whether images cover the way so far.
    let (mut reflections, mut covered) = (0, true);
    let mut straight = true;
    for _ in 0..MOST_BOUNCES {
        counts.rays += 1;
        let Some(hit) = scene.tracer.closest(origin, direction, blind) else {
            counts.escaped += 1;
            tally.sheet.escaped[tally.channel] += tally.flux_lm;
            return;
        };
        let surface = scene.tracer.surface(hit.triangle) as usize;
        let slot = surface * tally.channels + tally.channel;
        tally.sheet.incident[slot] += tally.flux_lm;
        let face = scene.tracer.normal(hit.triangle);
        let normal = if hit.front { face } else { -face };
        let frame = sphere::frame(normal);
        let bsdf = scene.bsdf(hit.triangle);
        let is_specular = bsdf.specular(1.0).is_some();
        if straight && !is_specular {
            straight = false;
            if point_source && !covered {
                tally.sheet.omitted[tally.channel] += tally.flux_lm;
            }
        }
        let next = bsdf.sample(frame.transpose() * -direction, rng.uniforms());
        let Some(next) = next.filter(|next| rng.uniform() < next.weight) else {
            tally.sheet.absorbed[slot] += tally.flux_lm;
            return;
        };
        if next.weight > 1.0 {
            // Some directions of a glossy lobe are drawn less often than they reflect: what the particle
            // gains here it owes to those that were absorbed, so the balance stays exact.
            tally.sheet.absorbed[slot] -= tally.flux_lm * (next.weight - 1.0);
            tally.flux_lm *= next.weight;
        }
        if next.specular && next.direction.z > 0.0 {
            reflections += 1;
            covered = reflections == 1 && prepared.emitters.imaged[hit.triangle as usize];
        }
        if !next.specular || next.direction.z > 0.0 {
            blind = &[];
        }
        let lift = scene.tracer.offset_m();
        origin =
            origin + direction * hit.distance_m + normal * if next.direction.z > 0.0 { lift } else { -lift };
        direction = frame * next.direction;
    }
    counts.cut += 1;
}
