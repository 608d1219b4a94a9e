//! The glossy part of a surface that a ray arrives at. Nothing of it is stored: luminaires are
//! reflected here and now, by points drawn on their openings *and* by the drawn lobe ray, each weighted
//! by how likely it is to find the other's light (Veach & Guibas 1995, balance heuristic), so that
//! neither a sharp lobe nor a small lamp makes the estimate fluctuate; all other light is where the
//! lobe ray goes.

use glam::DVec3;

use super::look::{Landing, Sight};
use crate::emitters::{Arrival, Emitters};
use crate::material::Lobe;
use crate::rng::Rng;
use crate::sphere;

/// Shadow rays that a look by one lobe spends on average at most.
const SHADOW_RAYS: f64 = 1.0;

/// A ray that goes on from a glossy surface.
pub(super) struct Onward {
    pub origin: DVec3,
    pub direction: DVec3,
    /// Share of the luminance along it that counts.
    pub weight: f64,
}

/// One look by a lobe.
struct Look<'a> {
    lobe: &'a Lobe,
    triangle: u32,
    origin: DVec3,
    /// Local direction to the eye.
    to_eye: DVec3,
    weight: f64,
    least: f64,
}

impl Look<'_> {
    /// f cos and the density with which a lobe ray goes that way *and* survives its roulette.
    fn towards(&self, local: DVec3) -> (f64, f64) {
        let f_cos = self.lobe.f(local, self.to_eye) * local.z;
        let density = self.lobe.pdf(local, self.to_eye);
        (f_cos, density.min(self.weight * f_cos / self.least))
    }
}

/// Adds the luminaires that the lobe reflects towards the eye to `sight.met`, and draws where the
/// ray goes on; rays of weight below `least` survive in proportion.
pub(super) fn scatter(
    emitters: &Emitters,
    lobe: &Lobe,
    landing: &Landing,
    least: f64,
    rng: &mut Rng,
    sight: &mut Sight,
) -> Option<Onward> {
    scatter_at(emitters, lobe, landing, [least, SHADOW_RAYS], |_, rng| rng.uniforms(), rng, sight)
}

/// [`scatter`] with `points` for the place on each opening (`Some`, by source) and for the lobe ray
/// (`None`), and with a number of shadow rays.
pub(super) fn scatter_at(
    emitters: &Emitters,
    lobe: &Lobe,
    landing: &Landing,
    [least, shadow_rays]: [f64; 2],
    points: impl Fn(Option<usize>, &mut Rng) -> [f64; 2],
    rng: &mut Rng,
    sight: &mut Sight,
) -> Option<Onward> {
    let world = sphere::frame(landing.normal);
    let look = Look {
        lobe,
        triangle: landing.triangle,
        origin: landing.origin(emitters.scene, true),
        to_eye: world.transpose() * landing.to_eye,
        weight: landing.weight,
        least,
    };
    if !(look.to_eye.z > 0.0) {
        return None;
    }
    add_lamps(emitters, &look, world, shadow_rays, &points, rng, sight);
    let (local, share) = lobe.sample(look.to_eye, points(None, rng))?;
    let weight = landing.weight * share;
    let survival = (weight / least).min(1.0);
    if rng.uniform() >= survival {
        return None;
    }
    let weight = weight / survival;
    let direction = world * local;
    let (_, found) = look.towards(local);
    for source in &emitters.sources {
        if !emitters.lights(source, look.triangle) {
            continue;
        }
        let Some((luminance, arrival)) = emitters.along(source, look.origin, direction) else { continue };
        let passed = emitters.passed(source, look.origin, &arrival);
        let drawn = emitters.chance(source) * emitters.density(source, &arrival);
        sight.met[source.channel] += weight * luminance * passed * found / (found + drawn);
    }
    Some(Onward { origin: look.origin, direction, weight })
}

/// Points on openings, and point sources, which no ray can hit.
fn add_lamps(
    emitters: &Emitters,
    look: &Look,
    world: glam::DMat3,
    shadow_rays: f64,
    points: &impl Fn(Option<usize>, &mut Rng) -> [f64; 2],
    rng: &mut Rng,
    sight: &mut Sight,
) {
    let scratch: &mut Vec<(usize, f64, Arrival, bool)> = &mut sight.scratch;
    scratch.clear();
    let mut total = 0.0;
    for (index, source) in emitters.sources.iter().enumerate() {
        if !(emitters.may_show(source, look.origin) && emitters.lights(source, look.triangle)) {
            continue;
        }
        let considered = emitters.chance(source);
        if considered < 1.0 && rng.uniform() >= considered {
            continue;
        }
        let above = |direction: DVec3| world.z_axis.dot(direction) > 0.0;
        let u = points(Some(index), rng);
        let Some(arrival) = emitters.arrival_if(source, look.origin, u, above) else { continue };
        let (f_cos, found) = look.towards(world.transpose() * arrival.direction);
        let mut luminance = look.weight * arrival.normal_lx * f_cos / considered;
        if !source.is_point() {
            let drawn = considered * emitters.density(source, &arrival);
            luminance *= drawn / (drawn + found);
        }
        if luminance > 0.0 && luminance.is_finite() {
            total += luminance;
            scratch.push((index, luminance, arrival, true));
        }
    }
    for (index, luminance, arrival, _) in scratch.iter() {
        let chance = (shadow_rays * luminance / total).min(1.0);
        if chance < 1.0 && rng.uniform() >= chance {
            continue;
        }
        let source = &emitters.sources[*index];
        sight.met[source.channel] += luminance * emitters.passed(source, look.origin, arrival) / chance;
    }
}
