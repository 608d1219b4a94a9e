//! One unbiased replicate of every answer: direct light, gather rays into the frozen field L̃, and
//! residual walks that add what the field gets wrong:
//!
//!   Ŷ = direct + (1/n) Σ c_i L̃(q_i) + (1/m) Σ c_j Σ_v R_v,   R = L_direct + a·L̃(next) − L̃(here)
//!
//! Walks survive each vertex with probability a (its albedo), to their end; the sum telescopes, so
//! the mean is the truth whatever the field is (Kollig & Keller's idea with a stored control).

use super::look::{Landing, add_direct, add_emission, follow};
use super::{Counts, PARTS, Part, Prepared, Sheet, lifted};
use crate::emitters::Arrival;
use crate::query::{Ray, Receiver};
use crate::rng::{Rng, Stratified};
use crate::sphere;

/// Steps after which a walk is cut and counted: only a sealed cavity without absorption gets here.
const MOST_STEPS: u32 = 100_000;

/// Buffers reused from receiver to receiver.
struct Desk {
    /// Luminance per channel seen by the current ray.
    seen: Vec<f64>,
    /// Residual of the current walk per channel.
    residual: Vec<f64>,
    /// Openings met on the way.
    met: Vec<f64>,
    scratch: Vec<(usize, f64, Arrival, bool)>,
    counts: Counts,
}

/// Block `stream` of a `Links` solution.
pub(super) fn block(prepared: &Prepared, stream: u64) -> Sheet {
    let channels = prepared.scene.channels.len();
    let demand = prepared.demand;
    let mut values = vec![0.0; demand.rows() * channels * PARTS];
    let zero = vec![0.0; channels];
    let mut desk = Desk {
        seen: zero.clone(),
        residual: zero.clone(),
        met: zero,
        scratch: Vec::new(),
        counts: Counts::default(),
    };
    for (index, receiver) in demand.receivers.iter().enumerate() {
        let row = prepared.first_rows[index];
        let span = row * channels * PARTS..(row + receiver.kernels.len()) * channels * PARTS;
        let mut rng = Rng::new(prepared.seed, stream, index as u64);
        answer_receiver(prepared, receiver, row, &mut rng, &mut desk, &mut values[span]);
    }
    let first_ray = demand.rows() - demand.rays.len();
    for (index, ray) in demand.rays.iter().enumerate() {
        let row = first_ray + index;
        let mut rng = Rng::new(prepared.seed, stream, (demand.receivers.len() + index) as u64);
        answer_ray(
            prepared,
            ray,
            &mut rng,
            &mut desk,
            &mut values[row * channels * PARTS..(row + 1) * channels * PARTS],
        );
    }
    Sheet { values, flux: None, counts: desk.counts }
}

/// One ray's answer into one row, for pictures, which have more rays than a sheet should hold.
pub(super) fn one_ray(prepared: &Prepared, ray: &Ray, rng: &mut Rng, row: &mut [f64]) {
    let zero = vec![0.0; prepared.scene.channels.len()];
    let mut desk = Desk {
        seen: zero.clone(),
        residual: zero.clone(),
        met: zero,
        scratch: Vec::new(),
        counts: Counts::default(),
    };
    answer_ray(prepared, ray, rng, &mut desk, row);
}

fn answer_receiver(
    prepared: &Prepared,
    receiver: &Receiver,
    first_row: usize,
    rng: &mut Rng,
    desk: &mut Desk,
    out: &mut [f64],
) {
    direct(prepared, receiver, first_row, rng, out);
    let effort = &prepared.effort;
    let origin = lifted(prepared.scene, receiver.point, receiver.lift);
    let channels = prepared.scene.channels.len();
    let kernels = &receiver.kernels;
    // Whole rounds over the kernels, so that the mixture of their densities has equal weights.
    let rounds = |count: u32| count.next_multiple_of(kernels.len() as u32);
    let gather = rounds(effort.gather);
    let walks = rounds(effort.walks).min(gather);
    let sequence = Stratified::new(rng);
    for sample in 0..gather {
        let turn = sample as usize % kernels.len();
        let direction = kernels[turn].sample(sequence.point(sample, rng));
        let density: f64 =
            kernels.iter().map(|kernel| kernel.pdf(direction)).sum::<f64>() / kernels.len() as f64;
        if !(density > 0.0) {
            continue;
        }
        let landing = look(prepared, origin, direction, rng, desk);
        let walked = sample < walks && landing.is_some();
        if let (true, Some(landing)) = (walked, landing) {
            walk(prepared, landing, rng, desk);
        }
        for (k, kernel) in kernels.iter().enumerate() {
            let weight = kernel.response(direction) / density;
            for channel in 0..channels {
                let mut value = weight * desk.seen[channel] / f64::from(gather);
                if walked {
                    value += weight * desk.residual[channel] / f64::from(walks);
                }
                out[(k * channels + channel) * PARTS + Part::Indirect as usize] += value;
            }
        }
    }
}

/// Direct light = unshadowed light (exact) − what is kept off (sampled): no noise where nothing shades.
fn direct(prepared: &Prepared, receiver: &Receiver, first_row: usize, rng: &mut Rng, out: &mut [f64]) {
    let emitters = &prepared.emitters;
    let channels = prepared.scene.channels.len();
    let origin = lifted(prepared.scene, receiver.point, receiver.lift);
    let points = prepared.effort.opening_points;
    let exact = &prepared.unshadowed[first_row..first_row + receiver.kernels.len()];
    for (index, source) in emitters.sources.iter().enumerate() {
        let own = source.mirror.is_none();
        if own && exact.iter().all(|row| !(row[index] > 0.0)) || !emitters.may_show(source, origin) {
            continue;
        }
        let considered = emitters.chance(source);
        if considered < 1.0 && rng.uniform() >= considered {
            continue;
        }
        let sequence = Stratified::new(rng);
        let samples = if source.area_m2 > 0.0 { points } else { 1 };
        for sample in 0..samples {
            let u = if samples == 1 { rng.uniforms() } else { sequence.point(sample, rng) };
            let responds = |direction| receiver.kernels.iter().any(|kernel| kernel.response(direction) > 0.0);
            let Some(arrival) = emitters.arrival_if(source, origin, u, responds) else { continue };
            let passed = emitters.passed(source, origin, &arrival);
            let lost = if own { passed - 1.0 } else { passed / considered };
            if lost == 0.0 {
                continue;
            }
            let part = if own { Part::Direct } else { Part::Image };
            for (k, kernel) in receiver.kernels.iter().enumerate() {
                let value =
                    lost * arrival.normal_lx * kernel.response(arrival.direction) / f64::from(samples);
                out[(k * channels + source.channel) * PARTS + part as usize] += value;
            }
        }
        if own {
            for (k, row) in exact.iter().enumerate() {
                out[(k * channels + source.channel) * PARTS + Part::Direct as usize] += row[index];
            }
        }
    }
}

/// Luminance along a ray from diffuse surfaces, by the stored field.
fn answer_ray(prepared: &Prepared, ray: &Ray, rng: &mut Rng, desk: &mut Desk, out: &mut [f64]) {
    let samples = prepared.effort.gather;
    straight_openings(prepared, ray, out);
    for _ in 0..samples {
        let landing = look(prepared, ray.point, ray.direction, rng, desk);
        desk.residual.fill(0.0);
        if let Some(landing) = landing {
            walk(prepared, landing, rng, desk);
        }
        for channel in 0..desk.seen.len() {
            let value = (desk.seen[channel] + desk.residual[channel]) / f64::from(samples);
            out[channel * PARTS + Part::Indirect as usize] += value;
        }
        mirrored_openings(prepared, ray, rng, 1.0 / f64::from(samples), out);
    }
}

/// Openings that a line of sight meets straight or through panes.
fn straight_openings(prepared: &Prepared, ray: &Ray, out: &mut [f64]) {
    let emitters = &prepared.emitters;
    for luminaire in 0..prepared.scene.luminaires.len() {
        if let Some((luminance, distance_m)) = emitters.opening_along(luminaire, ray.point, ray.direction) {
            let lift = prepared.scene.tracer.offset_m();
            let blind = &prepared.scene.luminaires[luminaire].body;
            let passed =
                prepared.scene.tracer.transmittance(ray.point, ray.direction, distance_m - lift, blind);
            out[prepared.scene.channel_of[luminaire] * PARTS + Part::Direct as usize] += luminance * passed;
        }
    }
}

/// Openings seen by exactly one reflection in an imaged plane, which `follow` leaves to images.
fn mirrored_openings(prepared: &Prepared, ray: &Ray, rng: &mut Rng, share: f64, out: &mut [f64]) {
    let (scene, emitters) = (prepared.scene, &prepared.emitters);
    if emitters.mirrors.is_empty() {
        return;
    }
    let (mut origin, mut direction, mut reflections) = (ray.point, ray.direction, 0);
    loop {
        let hit = scene.tracer.closest(origin, direction, &[]);
        if reflections == 1 {
            for luminaire in 0..scene.luminaires.len() {
                if let Some((luminance, distance_m)) = emitters.opening_along(luminaire, origin, direction)
                    && distance_m - 2.0 * scene.tracer.offset_m()
                        < hit.map_or(f64::INFINITY, |hit| hit.distance_m)
                {
                    out[scene.channel_of[luminaire] * PARTS + Part::Image as usize] += luminance * share;
                }
            }
        }
        let Some(hit) = hit else { return };
        let front = scene.tracer.normal(hit.triangle);
        let normal = if hit.front { front } else { -front };
        let cos = -direction.dot(normal);
        let Some((reflected, passed)) = scene.bsdf(hit.triangle).specular(cos) else { return };
        let point = origin + direction * hit.distance_m;
        let choice = rng.uniform();
        if choice < reflected {
            reflections += 1;
            if reflections > 1 || !emitters.imaged[hit.triangle as usize] {
                return;
            }
            direction += 2.0 * cos * normal;
            origin = point + normal * scene.tracer.offset_m();
        } else if choice < reflected + passed {
            origin = point - normal * scene.tracer.offset_m();
        } else {
            return;
        }
    }
}

/// Looks along a ray: fills `desk.seen` with the stored luminance there (emission included).
fn look(
    prepared: &Prepared,
    origin: glam::DVec3,
    direction: glam::DVec3,
    rng: &mut Rng,
    desk: &mut Desk,
) -> Option<Landing> {
    desk.met.fill(0.0);
    let landing = follow(&prepared.emitters, origin, direction, rng, &mut desk.counts, &mut desk.met);
    desk.seen.copy_from_slice(&desk.met);
    if let Some(landing) = &landing {
        add_emission(prepared.scene, landing.triangle, &mut desk.seen, 1.0);
        for (seen, stored) in desk.seen.iter_mut().zip(stored(prepared, landing)) {
            *seen += stored;
        }
    }
    landing
}

/// Walks from a landing to its end; fills `desk.residual` with Σ R_v. `desk.seen` is kept.
fn walk(prepared: &Prepared, start: Landing, rng: &mut Rng, desk: &mut Desk) {
    let scene = prepared.scene;
    desk.residual.fill(0.0);
    let mut here = start;
    for _ in 0..MOST_STEPS {
        let (reflectance, transmittance) = scene.bsdf(here.triangle).diffuse();
        let albedo = reflectance + transmittance;
        for (residual, stored) in desk.residual.iter_mut().zip(stored(prepared, &here)) {
            *residual -= stored;
        }
        if !(albedo > 0.0) {
            return;
        }
        let effort = &prepared.effort;
        add_direct(&prepared.emitters, &here, effort.shadow_rays, rng, &mut desk.scratch, &mut desk.residual);
        let looks = effort.looks.max(1);
        let share = albedo / f64::from(looks);
        let mut onward = None;
        for number in 0..looks {
            let same_side = rng.uniform() * albedo < reflectance;
            let facing = if same_side { here.normal } else { -here.normal };
            let direction = sphere::frame(facing) * sphere::cosine_hemisphere(rng.uniforms());
            desk.met.fill(0.0);
            let origin = here.origin(scene, same_side);
            let next = follow(&prepared.emitters, origin, direction, rng, &mut desk.counts, &mut desk.met);
            for (residual, met) in desk.residual.iter_mut().zip(&desk.met) {
                *residual += share * met;
            }
            if let Some(next) = &next {
                add_emission(scene, next.triangle, &mut desk.residual, share);
                for (residual, stored) in desk.residual.iter_mut().zip(stored(prepared, next)) {
                    *residual += share * stored;
                }
            }
            if number == 0 {
                onward = next;
            }
        }
        let Some(next) = onward else { return };
        if rng.uniform() >= albedo {
            return;
        }
        here = next;
    }
    desk.counts.cut += 1;
}

fn stored<'p>(prepared: &'p Prepared, landing: &Landing) -> &'p [f64] {
    let field = prepared.field.as_ref().expect("the links method always has a field");
    field.at(field.patches().side_at(landing.triangle, landing.barycentric, landing.front))
}
