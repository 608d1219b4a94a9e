//! Looking along a ray: through mirrors and panes to the first surface that has a diffuse part, on
//! along the lobes of glossy ones, and the light of luminaires met on the way. Direct light at a
//! diffuse vertex.

use glam::DVec3;

use super::Counts;
use super::lobe::scatter;
use crate::emitters::{Arrival, Emitters};
use crate::geometry::trace::Hit;
use crate::rng::Rng;
use crate::scene::{BodiesMet, Channel, Scene};

/// Specular bounces after which a walk is cut and counted: only a cage of perfect mirrors gets here.
const MOST_BOUNCES: u32 = 10_000;

/// What a look along a ray found: its luminance is `met` and the sum of weight times diffuse luminance
/// (and emission) over the landings.
#[derive(Debug, Default)]
pub(super) struct Sight {
    /// Luminance per channel of luminaires that next-event estimation at the ray's origin leaves out.
    pub met: Vec<f64>,
    /// Where the ray arrived; more than one only behind glossy surfaces.
    pub landings: Vec<Landing>,
    /// Rays traced so far.
    pub counts: Counts,
    /// Luminaires considered at one place: source, luminance, arrival, side.
    pub scratch: Vec<(usize, f64, Arrival, bool)>,
}

impl Sight {
    /// Nothing seen yet.
    pub fn new(channels: usize) -> Self {
        Self { met: vec![0.0; channels], ..Self::default() }
    }
}

/// How a ray came to a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Nothing was between.
    Clear,
    /// Straight, through panes.
    Panes,
    /// By mirrors, or not along a ray.
    Turned,
}

/// A place with a diffuse part that a ray arrived at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landing {
    /// Share of its luminance that counts.
    pub weight: f64,
    /// Unit direction back along the ray.
    pub to_eye: DVec3,
    /// Position on the surface, m.
    pub point: DVec3,
    /// Unit normal on the side of arrival.
    pub normal: DVec3,
    /// Triangle.
    pub triangle: u32,
    /// Barycentric weights.
    pub barycentric: [f64; 2],
    /// Whether the triangle's front was met.
    pub front: bool,
    /// How the ray came there.
    pub way: Way,
}

impl Landing {
    /// Origin of rays that leave on the side of arrival (`same_side`) or the other.
    pub fn origin(&self, scene: &Scene, same_side: bool) -> DVec3 {
        let lift = scene.tracer.offset_m();
        self.point + self.normal * if same_side { lift } else { -lift }
    }
}

/// Looks along a ray. At a glossy surface it lands *and*, as often as the lobe reflects, goes on:
/// L = L_diffuse + L_lobe, the second estimated by [`scatter`]. Rays on lobes whose weight falls below
/// `least` survive in proportion: with `least` = 1 they are as rare as their reflectance, with less
/// they are more frequent and lighter.
pub(super) fn look(
    emitters: &Emitters,
    origin: DVec3,
    direction: DVec3,
    least: f64,
    rng: &mut Rng,
    sight: &mut Sight,
) {
    sight.met.fill(0.0);
    sight.landings.clear();
    let (mut origin, mut direction, mut weight) = (origin, direction, 1.0);
    for _ in 0..MOST_BOUNCES {
        let Some(landing) = follow(emitters, origin, direction, weight, rng, sight) else { return };
        sight.landings.push(landing);
        let Some(lobe) = emitters.scene.bsdf(landing.triangle).lobe() else { return };
        let Some(onward) = scatter(emitters, lobe, &landing, least, rng, sight) else { return };
        (origin, direction, weight) = (onward.origin, onward.direction, onward.weight);
    }
    sight.counts.cut += 1;
}

/// Follows specular surfaces to one that is not. Reflection or transmission is drawn at random and
/// absorption is analog, so the weight never changes; `None` is light that is lost or absent.
/// Openings met after specular reflections that no image covers add their luminance to `met`
/// (cd/m² per channel): what was done at the ray's origin owns all others.
pub(super) fn follow(
    emitters: &Emitters,
    origin: DVec3,
    direction: DVec3,
    weight: f64,
    rng: &mut Rng,
    Sight { met, counts, .. }: &mut Sight,
) -> Option<Landing> {
    let scene = emitters.scene;
    let (mut origin, mut direction) = (origin, direction);
    let mut reflections = 0;
    let mut owned = true;
    let mut bodies = BodiesMet::default();
    for bounce in 0..MOST_BOUNCES {
        counts.rays += 1;
        let hit = scene.tracer.closest(origin, direction, &[]);
        if !owned {
            add_openings(emitters, (origin, direction), hit.as_ref(), &bodies, weight, met);
        }
        let Some(hit) = hit else {
            counts.escaped += 1;
            return None;
        };
        let point = origin + direction * hit.distance_m;
        let front = scene.tracer.normal(hit.triangle);
        let normal = if hit.front { front } else { -front };
        let cos = -direction.dot(normal);
        let Some((reflected, passed)) = scene.bsdf(hit.triangle).specular(cos) else {
            return Some(Landing {
                weight,
                to_eye: -direction,
                point,
                normal,
                triangle: hit.triangle,
                barycentric: hit.barycentric,
                front: hit.front,
                way: match (bounce, reflections) {
                    (0, _) => Way::Clear,
                    (_, 0) => Way::Panes,
                    _ => Way::Turned,
                },
            });
        };
        let choice = rng.uniform();
        let lift = scene.tracer.offset_m();
        if choice < reflected {
            direction += 2.0 * cos * normal;
            origin = point + normal * lift;
            reflections += 1;
            bodies.reflected(scene, hit.triangle);
            owned = reflections == 1 && emitters.imaged[hit.triangle as usize];
        } else if choice < reflected + passed {
            origin = point - normal * lift;
            bodies.passed(scene, hit.triangle);
        } else {
            return None;
        }
    }
    counts.cut += 1;
    None
}

/// Adds the luminance of every opening along a ray before what it meets.
fn add_openings(
    emitters: &Emitters,
    ray: (DVec3, DVec3),
    hit: Option<&Hit>,
    bodies: &BodiesMet,
    weight: f64,
    met: &mut [f64],
) {
    for (luminaire, placed) in emitters.scene.luminaires.iter().enumerate() {
        if bodies.shut(placed) {
            continue;
        }
        if let Some((luminance, distance_m)) = emitters.opening_along(luminaire, ray.0, ray.1) {
            met[emitters.scene.channel_of[luminaire]] +=
                weight * luminance * emitters.uncovered(luminaire, ray, distance_m, hit);
        }
    }
}

/// Adds the luminance of an emitting surface to its channel.
pub(super) fn add_emission(scene: &Scene, triangle: u32, channels: &mut [f64], factor: f64) {
    let emitted = scene.bsdf(triangle).emitted();
    if emitted > 0.0 {
        let surface = scene.mesh.triangles[triangle as usize].surface as usize;
        let own = Channel::Surfaces { material: scene.mesh.surfaces[surface].material };
        if let Some(channel) = scene.channels.iter().position(|channel| *channel == own) {
            channels[channel] += emitted * factor;
        }
    }
}

/// Adds one sample of the luminance that direct light makes at a diffuse vertex, cd/m² per channel.
/// Every source is considered; those that can add little are traced with a probability and weighted.
pub(super) fn add_direct(
    emitters: &Emitters,
    landing: &Landing,
    shadow_rays: f64,
    rng: &mut Rng,
    scratch: &mut Vec<(usize, f64, Arrival, bool)>,
    channels: &mut [f64],
) {
    let scene = emitters.scene;
    let (reflectance, transmittance) = scene.bsdf(landing.triangle).diffuse();
    if !(reflectance + transmittance > 0.0) {
        return;
    }
    let (above, below) = (landing.origin(scene, true), landing.origin(scene, false));
    scratch.clear();
    let mut total = 0.0;
    for (index, source) in emitters.sources.iter().enumerate() {
        let shows =
            emitters.may_show(source, above) || (transmittance > 0.0 && emitters.may_show(source, below));
        if !(shows && emitters.lights(source, landing.triangle)) {
            continue;
        }
        let considered = emitters.chance(source);
        if considered < 1.0 && rng.uniform() >= considered {
            continue;
        }
        let u = rng.uniforms();
        // Directions are taken from the lifted origin that the shadow ray uses: from the surface
        // itself the ray would end behind a plate in which the opening lies.
        let on_front = |direction: DVec3| landing.normal.dot(direction) > 0.0;
        let (arrival, albedo) = match emitters.arrival_evenly(source, above, u, on_front) {
            Some(arrival) => (arrival, reflectance),
            None if transmittance > 0.0 => {
                match emitters.arrival_evenly(source, below, u, |direction| !on_front(direction)) {
                    Some(arrival) => (arrival, transmittance),
                    None => continue,
                }
            }
            None => continue,
        };
        let cos = landing.normal.dot(arrival.direction);
        let luminance = arrival.normal_lx * cos.abs() * albedo * std::f64::consts::FRAC_1_PI / considered;
        if luminance > 0.0 && luminance.is_finite() {
            total += luminance;
            scratch.push((index, luminance, arrival, cos > 0.0));
        }
    }
    for (index, luminance, arrival, same_side) in scratch.iter() {
        let chance = (shadow_rays * luminance / total).min(1.0);
        if chance < 1.0 && rng.uniform() >= chance {
            continue;
        }
        let source = &emitters.sources[*index];
        let passed = emitters.passed(source, if *same_side { above } else { below }, arrival);
        channels[source.channel] += luminance * passed / chance;
    }
}
