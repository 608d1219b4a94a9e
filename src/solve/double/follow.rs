//! A ray through mirrors and panes to the first place that scatters, telling of every opening that it
//! meets on the way and whether next-event estimation finds that opening too.

use glam::DVec3;

use crate::emitters::Emitters;
use crate::rng::Rng;
use crate::scene::BodiesMet;
use crate::solve::Counts;

/// Specular bounces after which a walk is cut and counted: only a cage of perfect mirrors gets here.
const MOST_BOUNCES: u32 = 10_000;

/// The place a ray arrived at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrived {
    /// Position, m.
    pub point: DVec3,
    /// Unit normal on the side of arrival.
    pub normal: DVec3,
    /// Triangle.
    pub triangle: u32,
    /// Unit direction back along the ray.
    pub towards_eye: DVec3,
    /// Length of the way, m.
    pub distance_m: f64,
    /// Mirror reflections on the way; passages through panes do not count.
    pub reflections: u32,
}

/// An opening on the way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    /// Luminaire index.
    pub luminaire: usize,
    /// Luminance in the direction of the ray, cd/m².
    pub luminance: f64,
    /// Length of the way to it, m.
    pub distance_m: f64,
    /// |cos| between ray and opening's normal.
    pub cos: f64,
    /// Area of the opening, m².
    pub area_m2: f64,
    /// Whether the luminaire has a body that only its own light passes: rays do not find all of it,
    /// and next-event estimation stands alone.
    pub sealed: bool,
    /// Whether it is seen straight or by one reflection in an imaged plane (panes on the way
    /// included): then next-event estimation, which samples openings and images, owns it.
    pub owned: bool,
}

/// Follows specular surfaces to a scattering one, reflection or transmission at random, absorption
/// analog: what arrives has weight 1.
pub(super) fn follow(
    emitters: &Emitters,
    origin: DVec3,
    direction: DVec3,
    rng: &mut Rng,
    counts: &mut Counts,
    mut tell: impl FnMut(Met),
) -> Option<Arrived> {
    let scene = emitters.scene;
    let (mut origin, mut direction) = (origin, direction);
    let (mut reflections, mut owned, mut before_m) = (0, true, 0.0);
    let lift = scene.tracer.offset_m();
    let mut bodies = BodiesMet::default();
    for _ in 0..MOST_BOUNCES {
        counts.rays += 1;
        let hit = scene.tracer.closest(origin, direction, &[]);
        for (luminaire, placed) in scene.luminaires.iter().enumerate() {
            if bodies.shut(placed) {
                continue;
            }
            let met = emitters.opening_along(luminaire, origin, direction);
            if let Some((luminance, distance_m)) = met {
                // A luminaire's own body does not hide it.
                let seen = emitters.uncovered(luminaire, (origin, direction), distance_m, hit.as_ref());
                if !(seen > 0.0) {
                    continue;
                }
                let luminance = luminance * seen;
                let cos = placed.world_from_luminaire.z_axis.dot(direction).abs();
                let (area_m2, sealed) = (placed.kind.opening.area_m2(), !placed.body.is_empty());
                let distance_m = before_m + distance_m;
                tell(Met { luminaire, luminance, distance_m, cos, area_m2, sealed, owned });
            }
        }
        let Some(hit) = hit else {
            counts.escaped += 1;
            return None;
        };
        let point = origin + direction * hit.distance_m;
        let front = scene.tracer.normal(hit.triangle);
        let normal = if hit.front { front } else { -front };
        let cos = -direction.dot(normal);
        before_m += hit.distance_m;
        let Some((reflected, passed)) = scene.bsdf(hit.triangle).specular(cos) else {
            let (triangle, towards_eye) = (hit.triangle, -direction);
            return Some(Arrived { point, normal, triangle, towards_eye, distance_m: before_m, reflections });
        };
        let choice = rng.uniform();
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
