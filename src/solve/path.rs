//! An independent check: plain path tracing from every receiver with next-event estimation of one
//! luminaire at random (at glossy surfaces weighted with hits of openings) and of one luminous surface
//! (weighted with hits of it), Russian roulette, and no stored field, no splitting. It shares scene, tracer, scattering
//! models and response kernels with the links method, and the images of *points* in mirrors, which no path can hit.

use glam::DVec3;

use super::{Counts, PARTS, Part, Prepared, Sheet, lifted};
use crate::geometry::trace::Hit;
use crate::query::{Kernel, Ray};
use crate::rng::Rng;
use crate::scene::{BodiesMet, Channel, Scene};
use crate::sphere;

/// Block `stream` of a `Path` solution.
pub(super) fn block(prepared: &Prepared, stream: u64) -> Sheet {
    let (scene, demand) = (prepared.scene, prepared.demand);
    let channels = scene.channels.len();
    let paths = prepared.effort.paths;
    let mut values = vec![0.0; demand.rows() * channels * PARTS];
    let mut counts = Counts::default();
    let glows = Glows::new(scene);
    let mut row = 0;
    // Items of this stream are disjoint from those of the links method: the two stay independent.
    let item = |index: usize| (1 << 40) + index as u64;
    for (index, receiver) in demand.receivers.iter().enumerate() {
        let mut rng = Rng::new(prepared.seed, stream, item(index));
        let origin = lifted(scene, receiver.point, receiver.lift);
        for kernel in &receiver.kernels {
            let out = &mut values[row * channels * PARTS..(row + 1) * channels * PARTS];
            for _ in 0..paths {
                lamp_light(scene, origin, kernel, 1.0 / f64::from(paths), &mut rng, out);
                mirrored_points(
                    prepared,
                    |_| origin,
                    &mut rng,
                    |channel, direction, lx| {
                        out[channel * PARTS + Part::Image as usize] +=
                            lx * kernel.response(direction) / f64::from(paths);
                    },
                );
                if let Some(glow) = glows.one(scene, &mut rng, |_| origin) {
                    let share = glow.density / (glow.density + kernel.pdf(glow.direction));
                    let value = glow.lx * kernel.response(glow.direction) * share / f64::from(paths);
                    out[glow.channel * PARTS + Part::Indirect as usize] += value;
                }
                let direction = kernel.sample(rng.uniforms());
                let density = kernel.pdf(direction);
                if density > 0.0 {
                    let weight = kernel.response(direction) / density / f64::from(paths);
                    let start = Start { origin, direction, weight, sees_lamps: false, drawn: Some(density) };
                    trace(prepared, &glows, start, &mut rng, &mut counts, out);
                }
            }
            row += 1;
        }
    }
    for (index, Ray { point, direction }) in demand.rays.iter().enumerate() {
        let mut rng = Rng::new(prepared.seed, stream, item(demand.receivers.len() + index));
        let out = &mut values[row * channels * PARTS..(row + 1) * channels * PARTS];
        for _ in 0..paths {
            let (origin, direction, weight) = (*point, *direction, 1.0 / f64::from(paths));
            let start = Start { origin, direction, weight, sees_lamps: true, drawn: None };
            trace(prepared, &glows, start, &mut rng, &mut counts, out);
        }
        row += 1;
    }
    Sheet { values, flux: None, counts }
}

/// One luminaire at random, one point of its opening, straight or through panes.
fn lamp_light(scene: &Scene, at: DVec3, kernel: &Kernel, weight: f64, rng: &mut Rng, out: &mut [f64]) {
    if let Some(lit) = one_lamp(scene, rng, at, |_| at) {
        out[lit.channel * PARTS + Part::Direct as usize] += lit.lx * kernel.response(lit.direction) * weight;
    }
}

/// Light of one luminaire chosen at random.
struct Lit {
    /// Normal illuminance times the number of luminaires, lx.
    lx: f64,
    direction: DVec3,
    luminaire: usize,
    channel: usize,
    /// Density in 1/sr with which this direction was chosen; infinite for a point.
    density: f64,
}

/// A point on the opening of a random luminaire.
fn one_lamp(
    scene: &Scene,
    rng: &mut Rng,
    near: DVec3,
    origin_towards: impl Fn(DVec3) -> DVec3,
) -> Option<Lit> {
    let count = scene.luminaires.len();
    if count == 0 {
        return None;
    }
    let chosen = ((rng.uniform() * count as f64) as usize).min(count - 1);
    let lamp = &scene.luminaires[chosen];
    let place = lamp.world_from_luminaire.transpose() * (near - lamp.position);
    let shine = lamp.kind.opening.shine(place, rng.uniforms())?;
    let from = lamp.position + lamp.world_from_luminaire * shine.at;
    let at = origin_towards(from);
    let distance_m = from.distance(at);
    let direction = (from - at) / distance_m;
    let local = lamp.world_from_luminaire.transpose() * -direction;
    let intensity_cd = lamp.kind.distribution.intensity_along(local) * lamp.dim;
    if !(intensity_cd > 0.0 && distance_m > 0.0) {
        return None;
    }
    let reach = distance_m - 2.0 * scene.tracer.offset_m();
    let passed = scene.tracer.transmittance(at, direction, reach, &lamp.body);
    let per_sr = distance_m * distance_m;
    let lx = shine.weight * intensity_cd / per_sr * passed * count as f64;
    let density = per_sr / (shine.weight * lamp.kind.opening.seen_m2(local)) / count as f64;
    Some(Lit { lx, direction, luminaire: chosen, channel: scene.channel_of[chosen], density })
}

/// Light of point sources by one mirror: channel, direction and normal illuminance of every image that is seen.
fn mirrored_points(
    prepared: &Prepared,
    origin_towards: impl Fn(DVec3) -> DVec3,
    rng: &mut Rng,
    mut add: impl FnMut(usize, DVec3, f64),
) {
    let emitters = &prepared.emitters;
    for source in emitters.sources.iter().filter(|source| source.mirror.is_some() && source.is_point()) {
        let origin = origin_towards(source.position);
        let considered = emitters.chance(source);
        if !emitters.may_show(source, origin) || (considered < 1.0 && rng.uniform() >= considered) {
            continue;
        }
        if let Some(arrival) = emitters.arrival_if(source, origin, [0.5; 2], |_| true) {
            let passed = emitters.passed(source, origin, &arrival);
            if passed > 0.0 {
                add(source.channel, arrival.direction, arrival.normal_lx * passed / considered);
            }
        }
    }
}

/// Luminance of the luminaires that a ray from a glossy surface meets straight or through panes,
/// shared with [`one_lamp`], which finds the same light: the density of each over the sum of both.
fn glossy_lamps(
    scene: &Scene,
    surface: u32,
    origin: DVec3,
    direction: DVec3,
    density: f64,
    weight: f64,
    out: &mut [f64],
) {
    let count = scene.luminaires.len() as f64;
    for (index, lamp) in scene.luminaires.iter().enumerate() {
        let into = lamp.world_from_luminaire.transpose();
        let (o, d) = (into * (origin - lamp.position), into * direction);
        let Some(met) = lamp.kind.opening.along(o, d) else { continue };
        if lamp.body.contains(&surface) {
            continue;
        }
        let reach = met.distance_m - 2.0 * scene.tracer.offset_m();
        let passed = scene.tracer.transmittance(origin, direction, reach, &lamp.body);
        let luminance = lamp.kind.distribution.intensity_along(-d) * lamp.dim / met.projected_m2;
        let by_lamp = met.distance_m * met.distance_m / (met.weight * met.projected_m2) / count;
        out[scene.channel_of[index] * PARTS + Part::Indirect as usize] +=
            weight * luminance * passed * density / (density + by_lamp);
    }
}

/// How a path begins.
struct Start {
    origin: DVec3,
    direction: DVec3,
    weight: f64,
    /// The ray comes from an eye or a reflection, so openings count.
    sees_lamps: bool,
    /// Density of the direction, 1/sr, where [`Glows::one`] was asked at the origin too; `None`: it was not.
    drawn: Option<f64>,
}

/// Follows one path.
fn trace(
    prepared: &Prepared,
    glows: &Glows,
    Start { mut origin, mut direction, mut weight, mut sees_lamps, drawn }: Start,
    rng: &mut Rng,
    counts: &mut Counts,
    out: &mut [f64],
) {
    let scene = prepared.scene;
    // Where the way to what is hit began, and the density there; a reflection in a mirror is found by no other.
    let mut drawn = drawn.map(|density| (origin, density));
    let mut reflected_once = false;
    let mut diffuse_seen = false;
    let mut bodies = BodiesMet::default();
    for _ in 0..100_000 {
        counts.rays += 1;
        let hit = scene.tracer.closest(origin, direction, &[]);
        if sees_lamps {
            let part = match (diffuse_seen, reflected_once) {
                (false, false) => Part::Direct,
                (false, true) => Part::Image,
                (true, _) => Part::Indirect,
            };
            add_lamps(scene, (origin, direction), hit.as_ref(), &bodies, weight, part, out);
        }
        let Some(hit) = hit else {
            counts.escaped += 1;
            return;
        };
        let face = scene.tracer.normal(hit.triangle);
        let normal = if hit.front { face } else { -face };
        let point = origin + direction * hit.distance_m;
        let lift = scene.tracer.offset_m();
        let bsdf = scene.bsdf(hit.triangle);
        let share = drawn.map_or(1.0, |(from, density)| {
            density / (density + glows.density(scene, hit.triangle, point - from))
        });
        add_glow(scene, hit.triangle, weight * share, out);
        let frame = sphere::frame(normal);
        let to_eye = frame.transpose() * -direction;
        let next = bsdf.sample(to_eye, rng.uniforms());
        if bsdf.specular(to_eye.z).is_none() {
            diffuse_seen = true;
            let side = |from: DVec3| point + normal * lift * (from - point).dot(normal).signum();
            // A luminaire's own light passes its body and is not reflected by it.
            let surface = scene.tracer.surface(hit.triangle);
            let lit = one_lamp(scene, rng, point, side)
                .filter(|lit| !scene.luminaires[lit.luminaire].body.contains(&surface));
            if let Some(lit) = lit {
                let local = frame.transpose() * lit.direction;
                let share = match bsdf.lobe() {
                    Some(_) if lit.density.is_finite() => {
                        lit.density / (lit.density + bsdf.pdf(local, to_eye))
                    }
                    _ => 1.0,
                };
                let value = bsdf.f(local, to_eye) * local.z.abs() * lit.lx * weight * share;
                out[lit.channel * PARTS + Part::Indirect as usize] += value;
            }
            mirrored_points(prepared, side, rng, |channel, direction, lx| {
                let local = frame.transpose() * direction;
                let value = bsdf.f(local, to_eye) * local.z.abs() * lx * weight;
                out[channel * PARTS + Part::Indirect as usize] += value;
            });
            if let Some(glow) = glows.one(scene, rng, side) {
                let local = frame.transpose() * glow.direction;
                let share = glow.density / (glow.density + bsdf.pdf(local, to_eye));
                let value = bsdf.f(local, to_eye) * local.z.abs() * glow.lx * weight * share;
                out[glow.channel * PARTS + Part::Indirect as usize] += value;
            }
        }
        let Some(next) = next else { return };
        if !next.specular {
            sees_lamps = false;
            drawn = Some((point, bsdf.pdf(next.direction, to_eye)));
            if bsdf.lobe().is_some() {
                let density = bsdf.pdf(next.direction, to_eye);
                let (origin, towards) = (point + normal * lift, frame * next.direction);
                let surface = scene.tracer.surface(hit.triangle);
                glossy_lamps(scene, surface, origin, towards, density, weight * next.weight, out);
            }
        } else if next.direction.z > 0.0 {
            sees_lamps = true;
            drawn = None;
            reflected_once = true;
            bodies.reflected(scene, hit.triangle);
        } else {
            bodies.passed(scene, hit.triangle);
        }
        let survival = next.weight.min(1.0);
        if rng.uniform() >= survival {
            return;
        }
        weight *= next.weight / survival;
        direction = frame * next.direction;
        origin = point + normal * if next.direction.z > 0.0 { lift } else { -lift };
    }
    counts.cut += 1;
}

fn add_lamps(
    scene: &Scene,
    (origin, direction): (DVec3, DVec3),
    hit: Option<&Hit>,
    bodies: &BodiesMet,
    weight: f64,
    part: Part,
    out: &mut [f64],
) {
    for (index, lamp) in scene.luminaires.iter().enumerate() {
        if bodies.shut(lamp) {
            continue;
        }
        let into = lamp.world_from_luminaire.transpose();
        let (o, d) = (into * (origin - lamp.position), into * direction);
        let Some(met) = lamp.kind.opening.along(o, d) else { continue };
        // The opening may lie *in* the surface that ends the ray; its own body does not hide it.
        let reach = met.distance_m - 2.0 * scene.tracer.offset_m();
        let passed = match hit {
            Some(hit) if hit.distance_m < reach => {
                let own = lamp.body.contains(&scene.tracer.surface(hit.triangle));
                if own { scene.tracer.transmittance(origin, direction, reach, &lamp.body) } else { 0.0 }
            }
            _ => 1.0,
        };
        let intensity_cd = lamp.kind.distribution.intensity_along(-d) * lamp.dim;
        out[scene.channel_of[index] * PARTS + part as usize] +=
            weight * intensity_cd / met.projected_m2 * passed;
    }
}

/// Luminous triangles, chosen by luminance times area; both sides of them shine.
struct Glows {
    /// Triangle, its channel, and luminance times area up to it.
    list: Vec<(u32, usize, f64)>,
    total: f64,
}

/// Light from a point on a luminous surface.
struct Glow {
    direction: DVec3,
    /// Luminance over `density`, straight transmittance included.
    lx: f64,
    channel: usize,
    /// Density with which its direction was chosen, 1/sr.
    density: f64,
}

impl Glows {
    fn new(scene: &Scene) -> Self {
        let (mut list, mut total) = (Vec::new(), 0.0);
        for triangle in 0..scene.mesh.triangles.len() as u32 {
            if let Some(channel) = channel_of(scene, triangle) {
                let (_, area_m2) = scene.mesh.normal_and_area(triangle as usize);
                total += scene.bsdf(triangle).emitted() * area_m2;
                list.push((triangle, channel, total));
            }
        }
        Self { list, total }
    }

    /// A point on one of them, if any can be seen from where it shines to.
    fn one(&self, scene: &Scene, rng: &mut Rng, origin_towards: impl Fn(DVec3) -> DVec3) -> Option<Glow> {
        if !(self.total > 0.0) {
            return None;
        }
        let [choice, u, v] = rng.uniforms();
        let chosen = self.list.partition_point(|(.., up_to)| *up_to <= choice * self.total);
        let (triangle, channel, _) = self.list[chosen.min(self.list.len() - 1)];
        let [a, b, c] = scene.mesh.corners(triangle as usize);
        let root = u.sqrt();
        let from = a + (b - a) * (root * (1.0 - v)) + (c - a) * (root * v);
        let at = origin_towards(from);
        let density = self.density(scene, triangle, from - at);
        let distance_m = from.distance(at);
        let direction = (from - at) / distance_m;
        let reach = distance_m - 2.0 * scene.tracer.offset_m();
        (density > 0.0 && density.is_finite()).then(|| {
            let passed = scene.tracer.transmittance(at, direction, reach, &[]);
            Glow { direction, lx: scene.bsdf(triangle).emitted() * passed / density, channel, density }
        })
    }

    /// Density in 1/sr with which a point of a luminous triangle is chosen that lies `away` from where it is
    /// seen: L/Σ(L A) · d²/cos θ.
    fn density(&self, scene: &Scene, triangle: u32, away: DVec3) -> f64 {
        let emitted = scene.bsdf(triangle).emitted();
        let (normal, _) = scene.mesh.normal_and_area(triangle as usize);
        let squared = away.length_squared();
        let cos = (normal.dot(away) / squared.sqrt()).abs();
        if emitted > 0.0 && cos > 0.0 { emitted / self.total * squared / cos } else { 0.0 }
    }
}

/// Channel of a luminous triangle.
fn channel_of(scene: &Scene, triangle: u32) -> Option<usize> {
    let surface = scene.mesh.triangles[triangle as usize].surface as usize;
    let own = Channel::Surfaces { material: scene.mesh.surfaces[surface].material };
    (scene.bsdf(triangle).emitted() > 0.0)
        .then(|| scene.channels.iter().position(|channel| *channel == own))
        .flatten()
}

fn add_glow(scene: &Scene, triangle: u32, weight: f64, out: &mut [f64]) {
    if let Some(channel) = channel_of(scene, triangle) {
        out[channel * PARTS + Part::Indirect as usize] += scene.bsdf(triangle).emitted() * weight;
    }
}
