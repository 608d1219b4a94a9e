//! Double local estimation: the luminance of a place that is seen, by connecting it to the vertices
//! of the chains through its own scattering function (Budak et al. 2021),
//!
//!   L_ind(r, l) = 𝔼 Σ_n W_n f(r_n; l_n→r) f(r; l′→l) cos θ_n cos θ_r V / d²        (form A)
//!
//! A narrow lobe at r or r_n, or a small d, makes that heavy-tailed; so each scattering function is
//! held at `LOBE_CAP` times that of a diffuse surface, G at a bound, and one ray drawn from the
//! scattering function at r brings the rest (form B), to its end. First-order light is computed at r
//! by next-event estimation, weighted against that ray where openings can be hit (balance heuristic).

mod follow;
mod luminaires;

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::answer::{mirrored_openings, straight_openings};
use super::chains::{Vertex, capped, even};
use super::local::{arriving_lx, share};
use super::look::add_emission;
use super::{Counts, Method, PARTS, Part, Prepared, SeenForm};
use crate::emitters::Arrival;
use crate::material::Bsdf;
use crate::query::Ray;
use crate::rng::Rng;
use crate::sphere;
use follow::{Arrived, follow};
use luminaires::add_luminaires;

/// Connections take a scattering function up to this times albedo/π: the peak of a Phong lobe of
/// exponent 20, from which on gathering is better.
const LOBE_CAP: f64 = 11.0;
/// A seen place is connected to at most this many vertices, systematically drawn.
const MOST_LINKED: usize = 256;
/// Vertices after which a walk is cut and counted.
const MOST_STEPS: u32 = 100_000;

/// Buffers reused from receiver to receiver.
pub(super) struct Desk<'v> {
    /// The block's chains.
    pub vertices: &'v [Vertex],
    /// Luminance per channel of what is looked at.
    pub seen: Vec<f64>,
    /// Candidates for connection: vertex, its unshaded light, its weight.
    pub linked: Vec<(u32, f64, f64)>,
    /// Candidates of next-event estimation.
    lit: Vec<(usize, f64, Arrival, bool)>,
    pub counts: Counts,
}

impl<'v> Desk<'v> {
    pub(super) fn new(vertices: &'v [Vertex], channels: usize, counts: Counts) -> Self {
        Self { vertices, seen: vec![0.0; channels], linked: Vec::new(), lit: Vec::new(), counts }
    }
}

impl Prepared<'_> {
    /// Largest share of albedo/π that connections take of a scattering function.
    pub(super) fn cap(&self) -> f64 {
        if self.bound_m2.is_finite() { LOBE_CAP } else { f64::INFINITY }
    }
}

/// A place on a surface with a direction in which it is seen, and what of its light is asked for.
struct Seen<'s> {
    point: DVec3,
    normal: DVec3,
    triangle: u32,
    bsdf: &'s Bsdf,
    /// Local frame, z = normal on the side of the eye.
    frame: DMat3,
    /// Direction towards the eye in it.
    wo: DVec3,
    /// Factor of the part of f up to the cap: what the previous connection has left over of it.
    broad: f64,
    /// f is held at this times albedo/π in connections from here; 0: none are made.
    cap: f64,
}

impl<'s> Seen<'s> {
    fn new(prepared: &Prepared<'s>, arrived: &Arrived, broad: f64, cap: f64) -> Self {
        let frame = sphere::frame(arrived.normal);
        Self {
            point: arrived.point,
            normal: arrived.normal,
            triangle: arrived.triangle,
            bsdf: prepared.scene.bsdf(arrived.triangle),
            frame,
            wo: frame.transpose() * arrived.towards_eye,
            broad,
            cap,
        }
    }

    /// The scattering function as far as it is asked for, 1/sr.
    fn f(&self, prepared: &Prepared, wi: DVec3) -> f64 {
        let whole = self.bsdf.f(wi, self.wo);
        if self.broad >= 1.0 {
            return whole;
        }
        whole - (1.0 - self.broad) * capped(self.bsdf, wi, self.wo, prepared.cap())
    }

    /// The part of [`Seen::f`] that connections from here take.
    fn connected(&self, f: f64) -> f64 {
        if self.cap.is_finite() { f.min(self.cap * self.bsdf.albedo(self.wo.z) / PI) } else { f }
    }

    /// Origin of rays that leave on the side of the eye or the other.
    fn origin(&self, prepared: &Prepared, same_side: bool) -> DVec3 {
        let lift = prepared.scene.tracer.offset_m();
        self.point + self.normal * if same_side { lift } else { -lift }
    }
}

/// Adds to `desk.seen` what a place at `origin` with response `cos` in `direction` needs from there
/// beside its connections, times `weight`: light of mirrors whole, the left-over share of the rest.
pub(super) fn light_at(
    prepared: &Prepared,
    origin: DVec3,
    direction: DVec3,
    cos: f64,
    weight: f64,
    rng: &mut Rng,
    desk: &mut Desk,
) {
    let Some(arrived) = look(prepared, origin, direction, None, weight, rng, desk) else { return };
    let left_over = 1.0 - connected_share(prepared, &arrived, direction, cos);
    walk(prepared, &arrived, left_over, weight, prepared.cap(), rng, desk);
}

/// The share of a place's light that connections bring to where a ray towards it started.
fn connected_share(prepared: &Prepared, arrived: &Arrived, direction: DVec3, cos: f64) -> f64 {
    if arrived.reflections > 0 {
        return 0.0;
    }
    share(prepared, cos * arrived.normal.dot(direction).abs() / (arrived.distance_m * arrived.distance_m))
}

/// Follows a ray to a place, adding openings that next-event estimation does not own (and, where
/// `density` of the ray is given, its share of those that it does).
fn look(
    prepared: &Prepared,
    origin: DVec3,
    direction: DVec3,
    density: Option<f64>,
    weight: f64,
    rng: &mut Rng,
    desk: &mut Desk,
) -> Option<Arrived> {
    let (scene, seen) = (prepared.scene, &mut desk.seen);
    follow(&prepared.emitters, origin, direction, rng, &mut desk.counts, |opening| {
        let share = if opening.owned {
            density.map_or(0.0, |density| luminaires::ray_share(density, &opening))
        } else {
            1.0
        };
        seen[scene.channel_of[opening.luminaire]] += share * weight * opening.luminance;
    })
}

/// Adds to `desk.seen` the luminance of a place, emission and all, times `weight`; only `broad` of
/// its emission and of its scattering function up to the cap. `cap` is that of connections from it.
fn walk(
    prepared: &Prepared,
    arrived: &Arrived,
    broad: f64,
    weight: f64,
    cap: f64,
    rng: &mut Rng,
    desk: &mut Desk,
) {
    let (mut arrived, mut broad, mut weight, mut cap) = (*arrived, broad, weight, cap);
    for _ in 0..MOST_STEPS {
        // A diffuse place is left with the probability that connections did not bring it.
        if broad < 1.0 && even(prepared.scene.bsdf(arrived.triangle)).is_some() {
            if rng.uniform() >= broad {
                return;
            }
            broad = 1.0;
        }
        add_emission(prepared.scene, arrived.triangle, &mut desk.seen, weight * broad);
        let seen = Seen::new(prepared, &arrived, broad, cap);
        let shadow_rays = prepared.effort.shadow_rays;
        add_luminaires(prepared, &seen, weight, shadow_rays, rng, desk);
        connect(prepared, &seen, weight, shadow_rays, rng, desk);
        let Some((next, left_over, factor)) = scatter(prepared, &seen, weight, rng, desk) else { return };
        let survival = factor.min(1.0);
        if rng.uniform() >= survival {
            return;
        }
        weight *= factor / survival;
        (arrived, broad, cap) = (next, left_over, prepared.cap());
    }
    desk.counts.cut += 1;
}

/// One ray drawn from the scattering function of a place: what it meets, the share of that which
/// connections have not brought, and the factor of the path's weight. Openings met are added.
fn scatter(
    prepared: &Prepared,
    seen: &Seen,
    weight: f64,
    rng: &mut Rng,
    desk: &mut Desk,
) -> Option<(Arrived, f64, f64)> {
    let sampled = seen.bsdf.sample(seen.wo, rng.uniforms())?;
    let wi = sampled.direction;
    let whole = seen.bsdf.f(wi, seen.wo);
    let f = seen.f(prepared, wi);
    if !(f > 0.0 && whole > 0.0) {
        return None;
    }
    let factor = sampled.weight * f / whole;
    let direction = seen.frame * wi;
    let origin = seen.origin(prepared, wi.z > 0.0);
    let density = Some(seen.bsdf.pdf(wi, seen.wo));
    let next = look(prepared, origin, direction, density, weight * factor, rng, desk)?;
    let taken = connected_share(prepared, &next, direction, wi.z.abs()) * seen.connected(f) / f;
    Some((next, 1.0 - taken, factor))
}

/// Adds the connections of a place to the chains' vertices.
fn connect(prepared: &Prepared, seen: &Seen, weight: f64, shadow_rays: f64, rng: &mut Rng, desk: &mut Desk) {
    let scene = prepared.scene;
    if !(seen.cap > 0.0) {
        return;
    }
    let stride = desk.vertices.len().div_ceil(MOST_LINKED).max(1);
    let first = if stride > 1 { (rng.uniform() * stride as f64) as usize } else { 0 };
    desk.linked.clear();
    let mut total = 0.0;
    let into = seen.frame.transpose();
    for (index, vertex) in desk.vertices.iter().enumerate().skip(first).step_by(stride) {
        let towards = vertex.point - seen.point;
        let squared = towards.length_squared();
        let wi = into * (towards / squared.sqrt());
        let f = seen.connected(seen.f(prepared, wi));
        let cos = wi.z.abs();
        if !(f * cos > 0.0) {
            continue;
        }
        let Some(normal_lx) = arriving_lx(prepared, vertex, towards / squared.sqrt(), squared, cos) else {
            continue;
        };
        let luminance = normal_lx * cos * f * stride as f64;
        total += luminance;
        desk.linked.push((index as u32, luminance, wi.z));
    }
    for &(index, luminance, height) in &desk.linked {
        let chance = (shadow_rays * luminance / total).min(1.0);
        if chance < 1.0 && rng.uniform() >= chance {
            continue;
        }
        let vertex = &desk.vertices[index as usize];
        let origin = seen.origin(prepared, height > 0.0);
        let towards = vertex.point - origin;
        let distance_m = towards.length();
        let reach = distance_m - 2.0 * scene.tracer.offset_m();
        let passed = scene.tracer.transmittance(origin, towards / distance_m, reach, &[]);
        desk.seen[vertex.channel] += weight * luminance * passed / chance;
    }
}

/// Luminance along a line of sight.
pub(super) fn answer_ray(prepared: &Prepared, ray: &Ray, rng: &mut Rng, desk: &mut Desk, out: &mut [f64]) {
    straight_openings(prepared, ray, out);
    let samples = prepared.effort.local.returns.max(1);
    let share = 1.0 / f64::from(samples);
    let cap = match (prepared.method, prepared.effort.local.form) {
        (Method::Double, SeenForm::Auto) => prepared.cap(),
        (Method::Double, SeenForm::Connect) => f64::INFINITY,
        // Local estimation proper knows receivers only: what is not diffuse is gathered.
        _ => 0.0,
    };
    desk.seen.fill(0.0);
    for _ in 0..samples {
        if let Some(arrived) = look(prepared, ray.point, ray.direction, None, share, rng, desk) {
            let diffuse = even(prepared.scene.bsdf(arrived.triangle)).is_some();
            let gathers = prepared.effort.local.form == SeenForm::Gather;
            let cap = if diffuse && !gathers { prepared.cap() } else { cap };
            walk(prepared, &arrived, 1.0, share, cap, rng, desk);
        }
        mirrored_openings(prepared, ray, rng, share, out);
    }
    for (channel, seen) in desk.seen.iter().enumerate() {
        out[channel * PARTS + Part::Indirect as usize] += seen;
    }
}
