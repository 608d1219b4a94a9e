//! One unbiased replicate of every answer: direct light, gather rays into the frozen field L̃, and
//! residual walks that add what the field gets wrong:
//!
//!   Ŷ = direct + (1/n) Σ c_i L̃(q_i) + (1/m) Σ c_j Σ_v R_v,   R = L_direct + a·L̃(next) − L̃(here)
//!
//! Walks survive each vertex with probability a (its albedo), less often where the field is darker than at their
//! start, with a weight that makes up for it, to their end; the sum telescopes, so the mean is the truth whatever the
//! field is (Kollig & Keller's idea with a stored control).
//!
//! Everything above is about *diffuse* luminance. Mirrors, panes and glossy lobes belong to the way
//! from one diffuse place to the next: a look along a ray returns all places it leads to, each of
//! weight 1 on average times what reflects it there, and the luminaires met or reflected on the way.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::beacons::{Beacons, Branch, Chances};
use super::highlights::{self, Bundle};
use super::look::{Landing, Sight, add_direct, add_emission, look};
use super::survival::survival;
use super::{PARTS, Part, Prepared, Sheet, lifted, turn};
use crate::field::LuminanceField;
use crate::query::{Kernel, Ray, Receiver};
use crate::rng::{Rng, Stratified};
use crate::scene::BodiesMet;
use crate::sphere;

/// Steps after which a walk is cut and counted: only a sealed cavity without absorption gets here.
const MOST_STEPS: u32 = 100_000;

/// Points of every opening in each block where a kernel has edges.
const EDGE_POINTS: u32 = 16;

/// Lobe rays of gather rays and walks survive as often as their lobe reflects …
pub(super) const ANALOG: f64 = 1.0;
/// … but lines of sight follow each lobe down to this weight: a highlight is what they ask for.
pub(super) const SIGHT: f64 = 0.02;

/// Buffers reused from receiver to receiver.
pub(super) struct Desk {
    /// Luminance per channel seen by the current ray.
    pub(super) seen: Vec<f64>,
    /// Residual of the current walk per channel.
    pub(super) residual: Vec<f64>,
    /// Openings and landings met on the way.
    pub(super) sight: Sight,
    /// Places from which the current walk still has to go on, each with where it began.
    pending: Vec<[Landing; 2]>,
    /// Where the walk goes on from its current place.
    onward: Vec<Landing>,
    /// Highlights about the receiver or the current place.
    bundles: Vec<Bundle>,
    /// Chances of bright patches at the receiver.
    chances: Chances,
}

impl Desk {
    pub(super) fn new(channels: usize) -> Self {
        Self {
            seen: vec![0.0; channels],
            residual: vec![0.0; channels],
            sight: Sight::new(channels),
            pending: Vec::new(),
            onward: Vec::new(),
            bundles: Vec::new(),
            chances: Chances::default(),
        }
    }
}

/// Block `stream` of a `Links` solution.
pub(super) fn block(prepared: &Prepared, stream: u64) -> Sheet {
    let channels = prepared.scene.channels.len();
    let demand = prepared.demand;
    let mut values = vec![0.0; demand.rows() * channels * PARTS];
    let mut desk = Desk::new(channels);
    for (index, receiver) in demand.receivers.iter().enumerate() {
        desk.chances.clone_from(prepared.chances.get(index).unwrap_or(&Chances::default()));
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
    Sheet { values, flux: None, counts: desk.sight.counts }
}

/// One ray's answer into one row, for pictures, which have more rays than a sheet should hold.
pub(super) fn one_ray(prepared: &Prepared, ray: &Ray, rng: &mut Rng, row: &mut [f64]) {
    let mut desk = Desk::new(prepared.scene.channels.len());
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
    let mean_pdf = |direction: DVec3| {
        kernels.iter().map(|kernel| kernel.pdf(direction)).sum::<f64>() / kernels.len() as f64
    };
    let sequence = Stratified::new(rng);
    let (emitters, patches) = (&prepared.emitters, field(prepared).patches());
    let mut bundles = std::mem::take(&mut desk.bundles);
    let chances = std::mem::take(&mut desk.chances);
    let response = |direction| kernels.iter().map(|kernel| kernel.response(direction)).sum();
    prepared.highlights.about(emitters, origin, response, &mut bundles);
    let guided = if bundles.is_empty() { 0 } else { effort.highlights };
    let aimed = if chances.is_empty() { 0 } else { effort.beacons };
    let aimed_walks = aimed.min(walks);
    let guides = if guided > 0 { Stratified::new(rng) } else { sequence };
    let marks = if aimed > 0 { Stratified::new(rng) } else { sequence };
    for sample in 0..gather + guided + aimed {
        let mut target = None;
        let direction = if sample < gather {
            let (kernel, place) = turn(sample, gather, kernels.len());
            kernels[kernel].sample(sequence.point(place, rng))
        } else if sample < gather + guided {
            highlights::draw(&bundles, guides.point(sample - gather, rng))
        } else {
            let u = marks.point(sample - gather - guided, rng);
            let (direction, side) = prepared.beacons.draw(patches, origin, &chances, u);
            target = Some(side);
            direction
        };
        let density = mean_pdf(direction);
        // Σ of the densities of all rays: response / mixture is the weight of a ray however it was drawn.
        let mut mixture = f64::from(gather) * density
            + if guided > 0 { f64::from(guided) * highlights::density(&bundles, direction) } else { 0.0 };
        if !(mixture > 0.0) {
            continue;
        }
        see(prepared, origin, direction, ANALOG, rng, desk);
        if target.is_some_and(|side| !Beacons::came_to(patches, &desk.sight, side)) {
            continue;
        }
        let by_aim = prepared.beacons.density(patches, origin, &chances, &desk.sight);
        mixture += f64::from(aimed) * by_aim;
        // Walks are of the first rays of those that follow the responses, and of those to bright patches.
        let first = if target.is_some() { sample - gather - guided < aimed_walks } else { sample < walks };
        let walked = first && density > 0.0 && !desk.sight.landings.is_empty();
        if walked {
            walk(prepared, rng, desk);
        }
        let walk_density = f64::from(walks) * density + f64::from(aimed_walks) * by_aim;
        for (k, kernel) in kernels.iter().enumerate() {
            let response = kernel.response(direction);
            for channel in 0..channels {
                let mut value = response / mixture * desk.seen[channel];
                if walked {
                    value += response / walk_density * desk.residual[channel];
                }
                out[(k * channels + channel) * PARTS + Part::Indirect as usize] += value;
            }
        }
    }
    desk.bundles = bundles;
    desk.chances = chances;
}

/// Direct light = unshadowed light (exact) − what is kept off (sampled): no noise where nothing shades. By a kernel
/// with edges, which may cut an opening, all of it is sampled.
pub(super) fn direct(
    prepared: &Prepared,
    receiver: &Receiver,
    first_row: usize,
    rng: &mut Rng,
    out: &mut [f64],
) {
    let emitters = &prepared.emitters;
    let channels = prepared.scene.channels.len();
    let origin = lifted(prepared.scene, receiver.point, receiver.lift);
    let points = prepared.effort.opening_points;
    let exact = &prepared.unshadowed[first_row..first_row + receiver.kernels.len()];
    let least = if receiver.kernels.iter().any(Kernel::has_edge) { EDGE_POINTS } else { 1 };
    for (index, source) in emitters.sources.iter().enumerate() {
        let own = source.mirror.is_none();
        if own && exact.iter().all(|row| row.get(index).is_some_and(|lx| !(*lx > 0.0)))
            || !emitters.may_show(source, origin)
        {
            continue;
        }
        let considered = emitters.chance(source);
        if considered < 1.0 && rng.uniform() >= considered {
            continue;
        }
        let sequence = Stratified::new(rng);
        let samples = if source.is_point() { 1 } else { points.max(least) };
        for sample in 0..samples {
            let u = if samples == 1 { rng.uniforms() } else { sequence.point(sample, rng) };
            let responds = |direction| receiver.kernels.iter().any(|kernel| kernel.response(direction) > 0.0);
            let Some(arrival) = emitters.arrival_if(source, origin, u, responds) else { continue };
            let passed = emitters.passed(source, origin, &arrival);
            let part = if own { Part::Direct } else { Part::Image };
            for (k, kernel) in receiver.kernels.iter().enumerate() {
                let lost = if own && !kernel.has_edge() { passed - 1.0 } else { passed / considered };
                if lost == 0.0 {
                    continue;
                }
                let value =
                    lost * arrival.normal_lx * kernel.response(arrival.direction) / f64::from(samples);
                out[(k * channels + source.channel) * PARTS + part as usize] += value;
            }
        }
        if own {
            for (k, row) in exact.iter().enumerate() {
                let exact_lx = row.get(index).copied().unwrap_or(0.0);
                out[(k * channels + source.channel) * PARTS + Part::Direct as usize] += exact_lx;
            }
        }
    }
}

/// Luminance along a ray from diffuse surfaces, by the stored field.
fn answer_ray(prepared: &Prepared, ray: &Ray, rng: &mut Rng, desk: &mut Desk, out: &mut [f64]) {
    let samples = prepared.effort.gather;
    straight_openings(prepared, ray, out);
    for _ in 0..samples {
        see(prepared, ray.point, ray.direction, SIGHT, rng, desk);
        walk(prepared, rng, desk);
        for channel in 0..desk.seen.len() {
            let value = (desk.seen[channel] + desk.residual[channel]) / f64::from(samples);
            out[channel * PARTS + Part::Indirect as usize] += value;
        }
        mirrored_openings(prepared, ray, rng, 1.0 / f64::from(samples), out);
    }
}

/// Openings that a line of sight meets straight or through panes.
pub(super) fn straight_openings(prepared: &Prepared, ray: &Ray, out: &mut [f64]) {
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
pub(super) fn mirrored_openings(prepared: &Prepared, ray: &Ray, rng: &mut Rng, share: f64, out: &mut [f64]) {
    let (scene, emitters) = (prepared.scene, &prepared.emitters);
    if emitters.mirrors.is_empty() {
        return;
    }
    let (mut origin, mut direction, mut reflections) = (ray.point, ray.direction, 0);
    let mut bodies = BodiesMet::default();
    loop {
        let hit = scene.tracer.closest(origin, direction, &[]);
        if reflections == 1 {
            for (luminaire, placed) in scene.luminaires.iter().enumerate() {
                if bodies.shut(placed) {
                    continue;
                }
                if let Some((luminance, distance_m)) = emitters.opening_along(luminaire, origin, direction) {
                    let passed = emitters.uncovered(luminaire, (origin, direction), distance_m, hit.as_ref());
                    out[scene.channel_of[luminaire] * PARTS + Part::Image as usize] +=
                        luminance * passed * share;
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
            bodies.reflected(scene, hit.triangle);
        } else if choice < reflected + passed {
            origin = point - normal * scene.tracer.offset_m();
            bodies.passed(scene, hit.triangle);
        } else {
            return;
        }
    }
}

/// Looks along a ray: fills `desk.seen` with what is met and stored there (emission included).
pub(super) fn see(
    prepared: &Prepared,
    origin: DVec3,
    direction: DVec3,
    least: f64,
    rng: &mut Rng,
    desk: &mut Desk,
) {
    look(&prepared.emitters, origin, direction, least, rng, &mut desk.sight);
    desk.seen.copy_from_slice(&desk.sight.met);
    for landing in &desk.sight.landings {
        add_emission(prepared.scene, landing.triangle, &mut desk.seen, landing.weight);
        for (seen, stored) in desk.seen.iter_mut().zip(stored(prepared, landing)) {
            *seen += landing.weight * stored;
        }
    }
}

/// Walks from the landings in `desk.sight` to the end; fills `desk.residual` with Σ R_v. Light places
/// are walked from in proportion to their weight. `desk.seen` is kept.
pub(super) fn walk(prepared: &Prepared, rng: &mut Rng, desk: &mut Desk) {
    desk.residual.fill(0.0);
    desk.pending.clear();
    for landing in &desk.sight.landings {
        if landing.weight >= 1.0 || rng.uniform() < landing.weight {
            desk.pending.push([Landing { weight: landing.weight.max(1.0), ..*landing }; 2]);
        }
    }
    for _ in 0..MOST_STEPS {
        let Some([here, start]) = desk.pending.pop() else { return };
        step(prepared, here, &start, rng, desk);
    }
    desk.sight.counts.cut += 1;
}

/// One vertex of a walk: adds R = L_direct + a·(what is seen from here) − L̃(here), and decides where
/// the walk goes on. A look that passed glossy surfaces may have landed more than once: it goes on
/// from each place, which multiplies walks no faster than surfaces reflect.
fn step(prepared: &Prepared, here: Landing, start: &Landing, rng: &mut Rng, desk: &mut Desk) {
    let (scene, emitters, effort) = (prepared.scene, &prepared.emitters, &prepared.effort);
    let (reflectance, transmittance) = scene.bsdf(here.triangle).diffuse();
    let albedo = reflectance + transmittance;
    if !(albedo > 0.0) {
        return;
    }
    for (residual, stored) in desk.residual.iter_mut().zip(stored(prepared, &here)) {
        *residual -= here.weight * stored;
    }
    desk.sight.met.fill(0.0);
    add_direct(emitters, &here, effort.shadow_rays, rng, &mut desk.sight.scratch, &mut desk.sight.met);
    for (residual, direct) in desk.residual.iter_mut().zip(&desk.sight.met) {
        *residual += here.weight * direct;
    }
    let mut bundles = std::mem::take(&mut desk.bundles);
    bundles.clear();
    // Density of the directions that reflection and transmission draw, times π.
    let scattered = |direction: DVec3| {
        let cos = here.normal.dot(direction);
        cos.abs() * if cos > 0.0 { reflectance } else { transmittance } / albedo
    };
    if !(transmittance > 0.0) {
        prepared.highlights.about(emitters, here.origin(scene, true), scattered, &mut bundles);
    }
    let patches = field(prepared).patches();
    let chances = prepared.chances_of_side(patches.side_at(here.triangle, here.barycentric, here.front));
    let looks = effort.looks.max(1);
    let guided = u32::from(!bundles.is_empty());
    let aimed = u32::from(!chances.is_empty());
    desk.onward.clear();
    // Looks share the hemisphere evenly; each of them alone follows the cosine, the first included.
    let spread = Stratified::new(rng);
    for number in 0..looks + guided + aimed {
        let mut target = None;
        let mut share = here.weight * albedo / f64::from(looks);
        let direction = if number < looks {
            let [u, v, choice] = spread.point(number, rng);
            let facing = if choice * albedo < reflectance { here.normal } else { -here.normal };
            sphere::frame(facing) * sphere::cosine_hemisphere([u, v])
        } else if number < looks + guided {
            highlights::draw(&bundles, rng.uniforms())
        } else {
            let u = rng.uniforms();
            let (direction, side) = prepared.beacons.draw(patches, here.point, chances, u);
            target = Some(side);
            direction
        };
        let cosine = f64::from(looks) * scattered(direction) * FRAC_1_PI;
        let mut mixture = cosine;
        if guided > 0 {
            mixture += highlights::density(&bundles, direction);
        }
        if guided + aimed > 0 && !(cosine > 0.0) {
            continue;
        }
        let origin = here.origin(scene, here.normal.dot(direction) > 0.0);
        look(emitters, origin, direction, ANALOG, rng, &mut desk.sight);
        if target.is_some_and(|side| !Beacons::came_to(patches, &desk.sight, side)) {
            continue;
        }
        let by_aim = prepared.beacons.density(patches, origin, chances, &desk.sight);
        if guided + aimed > 0 {
            mixture += by_aim;
            share *= cosine / mixture;
        }
        for (residual, met) in desk.residual.iter_mut().zip(&desk.sight.met) {
            *residual += share * met;
        }
        for next in &desk.sight.landings {
            add_emission(scene, next.triangle, &mut desk.residual, share * next.weight);
            for (residual, stored) in desk.residual.iter_mut().zip(stored(prepared, next)) {
                *residual += share * next.weight * stored;
            }
        }
        // The walk goes on along the first look, which follows the cosine, and may branch to a bright patch
        // along the one that was aimed: each with its share of the mixture of the two.
        let one = cosine / f64::from(looks);
        let branch = prepared.beacons.branch(patches, &desk.sight, one / (one + by_aim), albedo);
        let part = match (branch, target) {
            (None, None) => 1.0,
            (None, Some(_)) => continue,
            (Some(Branch { part, .. }), None) => part,
            (Some(Branch { chance, .. }), Some(_)) if !(rng.uniform() < chance) => continue,
            (Some(Branch { part, chance }), Some(_)) => part / chance,
        };
        if number == 0 || target.is_some() {
            let parted = |landing: &Landing| Landing { weight: landing.weight * part, ..*landing };
            desk.onward.extend(desk.sight.landings.iter().map(parted));
        }
    }
    desk.bundles = bundles;
    for next in &desk.onward {
        let whole = here.weight * next.weight * albedo;
        let survives =
            survival(whole / start.weight, albedo, stored(prepared, start), stored(prepared, next));
        if rng.uniform() < survives {
            desk.pending.push([Landing { weight: whole / survives, ..*next }, *start]);
        }
    }
}

/// Luminance stored at a place, per channel; none in a gap.
fn stored<'p>(prepared: &'p Prepared, landing: &Landing) -> &'p [f64] {
    let field = field(prepared);
    let side = field.patches().side_at(landing.triangle, landing.barycentric, landing.front);
    if prepared.gaps.hold(prepared.scene, landing, side) { &[] } else { field.at(side) }
}

fn field<'p>(prepared: &'p Prepared) -> &'p LuminanceField {
    prepared.field.as_ref().expect("the links method always has a field")
}
