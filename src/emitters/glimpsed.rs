//! How an eye sees luminaires where many eyes are asked: an opening in plain sight by quadrature, from
//! a shaft or the rays that tell whether it is; only what is hidden in part is sampled, by points that all
//! eyes share.

use glam::DVec3;

use super::mirror;
use super::seen::{LITTLE, REPLICATES, Seen, SeenPiece, by_points, seen};
use super::shining::shining_coarsely;
use super::{Arrival, Emitters, Sighted, Source};
use crate::estimate::Estimate;
use crate::photometry::Opening;
use crate::rng::{Rng, Stratified};

/// Nodes and weights of Gauss and Legendre on [0, 1].
const GAUSS4: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];
/// Corners of a rectangle, where it begins to be hidden.
const CORNERS: [[f64; 2]; 4] = [[0.001, 0.001], [0.999, 0.001], [0.999, 0.999], [0.001, 0.999]];
/// Points of an opening of another shape.
const POINTS: u32 = 64;
/// Points more of an opening of which none of those was seen.
const HIDDEN_POINTS: u32 = 32;
/// Points in each of the replicates by which an opening that is hidden in part is sampled, and where little
/// of it is visible.
const PART_POINTS: [u32; 2] = [16, 64];
/// An image by a plane that reflects less than this share counts by less than its square in Σ L²ω/P²: it is sampled
/// by so many points.
const FAINT: (f64, u32) = (0.2, 4);
/// Transmittances to an opening in plain sight differ by at most this factor (panes seen aslant).
const ALIKE: f64 = 1.2;

/// Looks out for luminaires and luminous surfaces from many eyes.
#[derive(Debug)]
pub struct Lookout<'e> {
    emitters: &'e Emitters<'e>,
    seed: u64,
    /// Points of the unit square, stratified as a whole: each replicate takes a run of them.
    points: Vec<[f64; 2]>,
    /// For every source, by how much its points are shifted.
    shifts: Vec<[f64; 2]>,
}

impl<'e> Lookout<'e> {
    /// Draws from `seed` only.
    pub fn new(emitters: &'e Emitters<'e>, seed: u64) -> Self {
        let mut rng = Rng::new(seed, u64::MAX, emitters.sources.len() as u64);
        let sequence = Stratified::new(&mut rng);
        let points = (0..PART_POINTS[1] * REPLICATES as u32).map(|point| sequence.point(point, &mut rng));
        Self {
            emitters,
            seed,
            points: points.collect(),
            shifts: (0..emitters.sources.len())
                .map(|i| Rng::new(seed, u64::MAX, i as u64).uniforms())
                .collect(),
        }
    }

    /// Luminaires and luminous surfaces of which anything is visible from `eye`: what hides less than a tenth
    /// of an opening, and neither a corner of it nor one of 16 points, is not noticed.
    pub fn from(&self, eye: DVec3) -> Sighted {
        let all = 0..self.emitters.sources.len();
        Sighted {
            eye,
            luminaires: all.filter_map(|index| self.glimpsed(index, eye)).collect(),
            surfaces: shining_coarsely(self.emitters, eye, self.seed),
            glints: None,
        }
    }

    fn glimpsed(&self, index: usize, eye: DVec3) -> Option<Seen> {
        let (emitters, source) = (self.emitters, &self.emitters.sources[index]);
        if source.is_behind(eye) || !emitters.may_show(source, eye) {
            return None;
        }
        if source.is_point() {
            return seen(emitters, index, eye, self.seed, 1);
        }
        let is_clear = clear(emitters, source, eye)?;
        let mut glimpse = Glimpse::new(emitters, source, eye, is_clear);
        if matches!(source.opening, Opening::Rect { .. }) && source.opening.is_flat() {
            for corner in CORNERS {
                glimpse.add(corner, 0.0);
            }
            for (u, along) in GAUSS4 {
                for (v, across) in GAUSS4 {
                    glimpse.add([u, v], along * across);
                }
            }
        } else {
            for point in 0..POINTS {
                glimpse.add(self.point(index, point), 1.0 / f64::from(POINTS));
            }
        }
        if !(glimpse.most > 0.0) {
            // A strip may show between the nodes.
            let seen_at_all = (0..HIDDEN_POINTS).any(|point| {
                glimpse.add(self.point(index, point), 0.0);
                glimpse.most > 0.0
            });
            if !seen_at_all {
                return None;
            }
        }
        if glimpse.most > ALIKE * glimpse.least {
            return self.partly(index, eye, is_clear);
        }
        Some(glimpse.whole(index))
    }

    /// Point of the opening of a source.
    fn point(&self, index: usize, number: u32) -> [f64; 2] {
        let (point, shift) = (self.points[number as usize], self.shifts[index]);
        std::array::from_fn(|k| (point[k] + shift[k]).fract())
    }

    /// A source of which a part is visible.
    fn partly(&self, index: usize, eye: DVec3, is_clear: bool) -> Option<Seen> {
        let (emitters, source) = (self.emitters, &self.emitters.sources[index]);
        let by = |points: u32| {
            let passed = |arrival: &Arrival| passed(emitters, source, eye, arrival, is_clear);
            let place = |replicate: usize, point: u32| self.point(index, replicate as u32 * points + point);
            by_points(emitters, index, eye, points, passed, place)
        };
        let towards = (source.position - eye).normalize_or_zero();
        if emitters.reflectance(source, towards) < FAINT.0 {
            return by(FAINT.1);
        }
        match by(PART_POINTS[0]) {
            Some(found) if found.visible_fraction >= LITTLE.0 => Some(found),
            Some(_) | None => by(PART_POINTS[1]),
        }
    }
}

/// Whether nothing stands between an eye and any part of an opening that it may see, but for the edges of an
/// image's plane; `None` where the plane shows nothing of it. A *yes* is certain.
fn clear(emitters: &Emitters, source: &Source, eye: DVec3) -> Option<bool> {
    if !source.opening.is_level() {
        return Some(false);
    }
    let corners = emitters.corners(source);
    let Some(mirror) = source.mirror else {
        let body = &emitters.luminaire(source).body;
        return Some(emitters.scene.tracer.is_clear(&[eye], &corners, &[], body));
    };
    let (plane, here) = (&emitters.mirrors[mirror], [eye; 4]);
    if plane.glimpse(&here, &corners) == mirror::Glimpse::Nothing {
        return None;
    }
    let met = plane.shown(&here, &corners);
    Some(met.is_some_and(|met| emitters.is_clear_by_mirror(source, &[eye], plane.normal, met)))
}

/// [`Emitters::passed`], without rays where nothing stands between.
fn passed(emitters: &Emitters, source: &Source, eye: DVec3, arrival: &Arrival, is_clear: bool) -> f64 {
    if is_clear {
        emitters.reflectance(source, arrival.direction)
    } else {
        emitters.passed(source, eye, arrival)
    }
}

/// What rays to the points of one opening found.
struct Glimpse<'e> {
    emitters: &'e Emitters<'e>,
    source: &'e Source,
    eye: DVec3,
    place: DVec3,
    least: f64,
    most: f64,
    solid_angle_sr: f64,
    normal_lx: f64,
    light: DVec3,
    pieces: Vec<SeenPiece>,
    is_clear: bool,
}

impl<'e> Glimpse<'e> {
    fn new(emitters: &'e Emitters<'e>, source: &'e Source, eye: DVec3, is_clear: bool) -> Self {
        Self {
            emitters,
            source,
            eye,
            place: source.place(eye),
            least: f64::INFINITY,
            most: 0.0,
            solid_angle_sr: 0.0,
            normal_lx: 0.0,
            light: DVec3::ZERO,
            pieces: Vec::new(),
            is_clear,
        }
    }

    /// Adds the point of the opening at `u`.
    fn add(&mut self, u: [f64; 2], weight: f64) {
        let Some(shine) = self.source.opening.shine(self.place, u) else { return };
        let arrival = self.emitters.arrival_from(self.source, self.eye, shine, |_| true);
        let passed = arrival
            .map_or(0.0, |arrival| passed(self.emitters, self.source, self.eye, &arrival, self.is_clear));
        (self.least, self.most) = (self.least.min(passed), self.most.max(passed));
        let Some(arrival) = arrival.filter(|_| passed > 0.0 && weight > 0.0) else { return };
        let away = self.place - shine.at;
        let projected_m2 = self.source.opening.projected_area_m2(away.normalize_or_zero());
        let element_sr = weight * shine.weight * projected_m2 / away.length_squared();
        let light_lx = weight * arrival.normal_lx * passed;
        self.solid_angle_sr += element_sr;
        self.normal_lx += light_lx;
        self.light += light_lx * arrival.direction;
        self.pieces.push(SeenPiece {
            direction: arrival.direction,
            visible_sr: element_sr,
            normal_lx: light_lx,
        });
    }

    /// As one that is wholly in sight.
    fn whole(self, index: usize) -> Seen {
        let towards = self.source.position - self.eye;
        let leaving = self.place.normalize_or_zero();
        let distribution = &self.emitters.luminaire(self.source).kind.distribution;
        let blocks = REPLICATES;
        Seen {
            source: index,
            direction: towards.normalize_or_zero(),
            distance_m: towards.length(),
            solid_angle_sr: Estimate::exact(self.solid_angle_sr, blocks),
            normal_lx: Estimate::exact(self.normal_lx, blocks),
            covariance_lx_sr: 0.0,
            light: self.light,
            visible_fraction: 1.0,
            projected_area_m2: self.source.opening.projected_area_m2(leaving),
            centre_lx: distribution.intensity_along(leaving) * self.source.dim / self.place.length_squared(),
            pieces: self.pieces,
        }
    }
}
