//! Planar specular surfaces and the images of luminaires in them. Light that is reflected exactly
//! once by such a plane is owned by its image; more reflections are found by following rays.

use glam::DVec3;

use super::{Arrival, Emitters, Mirror, Source};
use crate::geometry::trace::Tracer;
use crate::material::Bsdf;
use crate::scene::Scene;

/// At most this many planes get images, and only those with this share of the scene's area; light
/// reflected by others is found by rays that happen to hit an opening (right, but noisier, and lost
/// for point sources, which is measured and listed).
const MOST_PLANES: usize = 12;
const LEAST_SHARE: f64 = 2e-4;

impl Emitters<'_> {
    /// Reflectance of an image's plane along a direction; 1 of a plane of several materials, and of a luminaire
    /// itself.
    pub fn reflectance(&self, source: &Source, direction: DVec3) -> f64 {
        let plane = source.mirror.map(|mirror| &self.mirrors[mirror]).filter(|plane| plane.is_uniform);
        plane.map_or(1.0, |plane| {
            let cos = direction.dot(plane.normal).abs();
            self.scene.bsdf(plane.triangles[0]).specular(cos).map_or(0.0, |(reflectance, _)| reflectance)
        })
    }

    /// Whether nothing stands between places about `facing` and an image all of which they see in `met` of its
    /// plane. A *yes* is certain.
    pub fn is_clear_by_mirror(
        &self,
        source: &Source,
        places: &[DVec3],
        facing: DVec3,
        met: [DVec3; 4],
    ) -> bool {
        let (tracer, body) = (&self.scene.tracer, &self.luminaire(source).body);
        let Some(plane) = source.mirror.map(|mirror| &self.mirrors[mirror]) else { return false };
        let own = |&triangle: &u32| body.contains(&tracer.surface(triangle));
        if !plane.is_uniform || plane.triangles.iter().any(own) {
            return false;
        }
        let side = plane.normal * (places[0].dot(plane.normal) - plane.offset_m).signum();
        let met = met.map(|corner| corner + side * tracer.offset_m());
        let lamp = self.corners(&self.sources[source.luminaire]);
        tracer.is_clear(places, &met, &[facing, side], &[]) && tracer.is_clear(&met, &lamp, &[side], body)
    }

    pub(super) fn passed_by_mirror(
        &self,
        mirror: &Mirror,
        tracer: &Tracer,
        point: DVec3,
        arrival: &Arrival,
        blind: &[u32],
    ) -> f64 {
        let met = arrival.mirrored.or_else(|| mirror.meet(point, arrival.direction, arrival.distance_m));
        let Some((distance_m, triangle)) = met else { return 0.0 };
        // Its own light passes a luminaire's body and is not reflected by it.
        if blind.contains(&tracer.surface(triangle)) {
            return 0.0;
        }
        let cos = arrival.direction.dot(mirror.normal).abs();
        let Some((reflectance, _)) = self.scene.bsdf(triangle).specular(cos) else { return 0.0 };
        let lift = tracer.offset_m();
        // The body lets light pass that has not yet met the mirror.
        let before = tracer.transmittance(point, arrival.direction, distance_m - lift, &[]);
        if !(before * reflectance > 0.0) {
            return 0.0;
        }
        let side = mirror.normal * -arrival.direction.dot(mirror.normal).signum();
        let turned = point + arrival.direction * distance_m + side * lift;
        let onward = arrival.direction - 2.0 * arrival.direction.dot(mirror.normal) * mirror.normal;
        let rest = arrival.distance_m - distance_m - 2.0 * lift;
        reflectance * before * tracer.transmittance(turned, onward, rest, blind)
    }
}

/// Specular planes by size, the largest [`MOST_PLANES`], and for each triangle whether it is in one.
pub(super) fn mirrors(scene: &Scene) -> (Vec<Mirror>, Vec<bool>) {
    let found = planes(scene, MOST_PLANES, |bsdf| bsdf.specular(1.0).is_some());
    let mut imaged = vec![false; scene.mesh.triangles.len()];
    for triangle in found.iter().flat_map(|mirror| &mirror.triangles) {
        imaged[*triangle as usize] = true;
    }
    (found, imaged)
}

/// At most `most` planes of surfaces that `belongs` picks, the largest first.
pub fn planes(scene: &Scene, most: usize, belongs: impl Fn(&Bsdf) -> bool) -> Vec<Mirror> {
    let mesh = &scene.mesh;
    let size_m = mesh.bounds().map_or(1.0, |(lo, hi)| (hi - lo).length());
    let mut found: Vec<(Mirror, f64)> = Vec::new();
    for triangle in 0..mesh.triangles.len() as u32 {
        if !belongs(scene.bsdf(triangle)) {
            continue;
        }
        let (normal, area_m2) = mesh.normal_and_area(triangle as usize);
        let offset_m = normal.dot(mesh.corners(triangle as usize)[0]);
        let same = found.iter().position(|(mirror, _)| {
            let sign = mirror.normal.dot(normal).signum();
            mirror.normal.dot(normal).abs() > 1.0 - 1e-12
                && (offset_m * sign - mirror.offset_m).abs() < 1e-9 * size_m
        });
        match same {
            Some(known) => {
                found[known].0.triangles.push(triangle);
                found[known].1 += area_m2;
            }
            None if found.len() < 4096 => {
                found.push((Mirror::in_plane(normal, offset_m, triangle), area_m2));
            }
            None => {}
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    // Point sources have no opening to be hit: for them every plane counts.
    let has_points = scene.luminaires.iter().any(|luminaire| luminaire.kind.opening.is_point());
    let total_m2: f64 = mesh.surface_areas_m2().iter().sum();
    found.retain(|(_, area_m2)| has_points || *area_m2 >= LEAST_SHARE * total_m2);
    found.truncate(most);
    for (mirror, _) in &mut found {
        mirror.settle(scene);
    }
    found.into_iter().map(|(mirror, _)| mirror).collect()
}
