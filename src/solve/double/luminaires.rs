//! First-order light of a seen place: next-event estimation of every luminaire and image, each by one
//! point of its opening, weighted by the balance heuristic against the ray that is drawn from the
//! place's scattering function. A point source has no opening that a ray could hit: it has weight 1.

use super::follow::Met;
use super::{Desk, Seen};
use crate::emitters::{Arrival, Source};
use crate::rng::Rng;
use crate::solve::Prepared;

/// Density in 1/sr with which next-event estimation draws a direction towards an opening.
fn opening_density(distance_m: f64, cos: f64, area_m2: f64) -> f64 {
    distance_m * distance_m / (area_m2 * cos)
}

/// Weight of an opening met by a ray of `density` that next-event estimation finds too.
pub(super) fn ray_share(density: f64, met: &Met) -> f64 {
    if met.sealed {
        return 0.0;
    }
    let sum = density + opening_density(met.distance_m, met.cos, met.area_m2);
    if sum.is_finite() { density / sum } else { 0.0 }
}

/// Adds the luminance of a seen place by light straight from luminaires and their images, × `weight`.
pub(super) fn add_luminaires(
    prepared: &Prepared,
    seen: &Seen,
    weight: f64,
    shadow_rays: f64,
    rng: &mut Rng,
    desk: &mut Desk,
) {
    let emitters = &prepared.emitters;
    let (above, below) = (seen.origin(prepared, true), seen.origin(prepared, false));
    let into = seen.frame.transpose();
    desk.lit.clear();
    let mut total = 0.0;
    for (index, source) in emitters.sources.iter().enumerate() {
        let shows = emitters.may_show(source, above) || emitters.may_show(source, below);
        if !(shows && emitters.lights(source, seen.triangle)) {
            continue;
        }
        let considered = emitters.chance(source);
        if considered < 1.0 && rng.uniform() >= considered {
            continue;
        }
        let u = rng.uniforms();
        let mut scattering = 0.0;
        let mut wanted = |direction: glam::DVec3, front: bool| {
            let wi = into * direction;
            scattering = if (wi.z > 0.0) == front { seen.f(prepared, wi) * wi.z.abs() } else { 0.0 };
            scattering > 0.0
        };
        // Directions are taken from the lifted origin that the shadow ray uses: from the surface
        // itself the ray would end behind a plate in which the opening lies.
        let (arrival, front) = match emitters.arrival_if(source, above, u, |d| wanted(d, true)) {
            Some(arrival) => (arrival, true),
            None => match emitters.arrival_if(source, below, u, |d| wanted(d, false)) {
                Some(arrival) => (arrival, false),
                None => continue,
            },
        };
        let wi = into * arrival.direction;
        let light = arrival.normal_lx * scattering / considered
            * light_share(prepared, source, &arrival, seen.bsdf.pdf(wi, seen.wo));
        if light > 0.0 && light.is_finite() {
            total += light;
            desk.lit.push((index, light, arrival, front));
        }
    }
    for (index, light, arrival, front) in &desk.lit {
        let chance = (shadow_rays * light / total).min(1.0);
        if chance < 1.0 && rng.uniform() >= chance {
            continue;
        }
        let source = &emitters.sources[*index];
        let passed = emitters.passed(source, if *front { above } else { below }, arrival);
        desk.seen[source.channel] += weight * light * passed / chance;
    }
}

/// Weight of a sampled opening against a ray drawn with `density` in the same direction.
fn light_share(prepared: &Prepared, source: &Source, arrival: &Arrival, density: f64) -> f64 {
    let emitters = &prepared.emitters;
    let luminaire = emitters.luminaire(source);
    if !(source.area_m2 > 0.0) || !luminaire.body.is_empty() {
        return 1.0;
    }
    let axis = luminaire.world_from_luminaire.z_axis;
    let axis = source.mirror.map_or(axis, |mirror| emitters.mirrors[mirror].reflection() * axis);
    let by_light = opening_density(arrival.distance_m, axis.dot(arrival.direction).abs(), source.area_m2);
    if by_light.is_finite() { by_light / (by_light + density) } else { 1.0 }
}
