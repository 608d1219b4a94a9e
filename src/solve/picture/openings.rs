//! Openings in a pixel: one whose outline the pixel cuts counts by the share of the pixel that it fills.
//! Looked at in pixels' centres alone, a row of narrow luminaires along a line of sight is all there or
//! not at all, and with it some percent of the eye's illuminance.

use glam::DVec3;

use super::direct::Points;
use super::{Path, Picture, STREAM};
use crate::geometry::trace::Hit;
use crate::rng::Rng;

/// Places of a pixel at which an outline in it is looked for.
const PLACES: u32 = 16;
/// First item of the random numbers that shift them; below are tiles.
const ITEM: u64 = 1 << 40;

/// The pyramid of lines of sight through a pixel's corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    /// The eye, or its image in the mirrors on the way, m.
    from: DVec3,
    corners: [DVec3; 4],
    /// Number of the pixel.
    number: u64,
}

impl Beam {
    /// The beam of a pixel from the lines of sight through its corners; `None` at the edge of the
    /// projection.
    pub(super) fn of_pixel(eye: DVec3, corners: [Option<DVec3>; 4], number: u64) -> Option<Self> {
        let [Some(a), Some(b), Some(c), Some(d)] = corners else { return None };
        Some(Self { from: eye, corners: [a, b, c, d], number })
    }

    /// The beam behind a mirror in the plane through `point`.
    pub(super) fn reflected(&self, point: DVec3, normal: DVec3) -> Self {
        let turned = |d: DVec3| d - 2.0 * d.dot(normal) * normal;
        Self { from: point + turned(self.from - point), corners: self.corners.map(turned), ..*self }
    }

    /// Half its width at a distance of 1 m, m.
    fn width(&self, direction: DVec3) -> f64 {
        self.corners.iter().map(|corner| corner.distance(direction)).fold(0.0, f64::max)
    }

    /// A direction in it.
    fn direction(&self, [x, y]: [f64; 2]) -> DVec3 {
        let [a, b, c, d] = self.corners;
        ((a * (1.0 - x) + b * x) * (1.0 - y) + (c * (1.0 - x) + d * x) * y).normalize()
    }
}

impl Picture<'_> {
    /// Luminance of all openings along a ray before what it meets, cd/m². A luminaire's own housing does
    /// not hide its opening.
    pub(super) fn openings(&self, ray: (DVec3, DVec3), hit: Option<&Hit>, path: &Path) -> f64 {
        let scene = self.emitters.scene;
        if path.openings.is_empty() {
            return 0.0;
        }
        let width = path.beam.map(|beam| beam.width(ray.1));
        let mut sum = 0.0;
        for &index in path.openings {
            let source = &self.emitters.sources[index];
            if path.bodies.shut(&scene.luminaires[index]) {
                continue;
            }
            let weight = self.weights[source.channel];
            if let (Some(beam), Some(width)) = (&path.beam, width) {
                let towards = source.position - beam.from;
                let along_m = towards.dot(ray.1);
                let aside_m = (towards - along_m * ray.1).length();
                if aside_m > 1.000_001 * source.radius_m + width * towards.length() {
                    continue;
                }
                let met = |d: &DVec3| self.emitters.along(source, beam.from, *d).is_some();
                if !(met(&ray.1) && beam.corners.iter().all(met)) {
                    sum += weight * self.in_part(index, beam, ray.0);
                    continue;
                }
            }
            if let Some((luminance, distance_m)) = self.emitters.opening_along(index, ray.0, ray.1) {
                sum += weight * luminance * self.emitters.uncovered(index, ray, distance_m, hit);
            }
        }
        sum
    }

    /// Mean luminance that an opening gives a pixel which it does not fill. The places differ from pixel
    /// to pixel, so that outlines along rows of pixels lose nothing on the mean.
    fn in_part(&self, index: usize, beam: &Beam, origin: DVec3) -> f64 {
        let (emitters, tracer) = (self.emitters, &self.emitters.scene.tracer);
        let source = &emitters.sources[index];
        let mut sum = 0.0;
        let points = Points { shift: Rng::new(self.seed, STREAM, ITEM + beam.number).uniforms() };
        for k in 0..PLACES {
            let direction = beam.direction(points.point(k));
            let Some((_, arrival)) = emitters.along(source, beam.from, direction) else { continue };
            // Behind a mirror the line starts where that of the pixel's centre does.
            let direction = (beam.from + direction * arrival.distance_m - origin).normalize_or_zero();
            let Some((luminance, distance_m)) = emitters.opening_along(index, origin, direction) else {
                continue;
            };
            let hit = tracer.closest(origin, direction, &[]);
            sum += luminance * emitters.uncovered(index, (origin, direction), distance_m, hit.as_ref());
        }
        sum / f64::from(PLACES)
    }
}
