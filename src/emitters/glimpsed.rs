//! How an eye sees luminaires where many eyes are asked: an opening in plain sight by quadrature, from
//! the rays that tell whether it is; only what is hidden in part is sampled as [`super::seen_from`] does.

use glam::DVec3;

use super::Emitters;
use super::seen::{Seen, SeenPiece, seen};
use super::shining::shining_coarsely;
use super::{Sighted, Source};
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
/// Points in each of the replicates by which an opening that is hidden in part is sampled.
const PART_POINTS: u32 = 16;
/// Transmittances to an opening in plain sight differ by at most this factor (panes seen aslant).
const ALIKE: f64 = 1.2;

/// Luminaires and luminous surfaces of which anything is visible from `eye`, for maps of many eyes: what
/// hides less than a tenth of an opening, and neither a corner of it nor one of 16 points, is not noticed.
pub fn glimpsed_from(emitters: &Emitters, eye: DVec3, seed: u64) -> Sighted {
    let all = 0..emitters.sources.len();
    Sighted {
        eye,
        luminaires: all.filter_map(|index| glimpsed(emitters, index, eye, seed)).collect(),
        surfaces: shining_coarsely(emitters, eye, seed),
        glints: None,
    }
}

fn glimpsed(emitters: &Emitters, index: usize, eye: DVec3, seed: u64) -> Option<Seen> {
    let source = &emitters.sources[index];
    if !emitters.may_show(source, eye) {
        return None;
    }
    if source.is_point() {
        return seen(emitters, index, eye, seed, 1);
    }
    let mut glimpse = Glimpse::new(emitters, source, eye);
    if matches!(source.opening, Opening::Rect { .. }) && source.opening.is_flat() {
        // An opening is dark from behind, from everywhere on it.
        source.opening.shine(glimpse.place, [0.5, 0.5])?;
        for corner in CORNERS {
            glimpse.add(corner, 0.0);
        }
        for (u, along) in GAUSS4 {
            for (v, across) in GAUSS4 {
                glimpse.add([u, v], along * across);
            }
        }
    } else {
        let mut rng = Rng::new(seed, u64::MAX, index as u64);
        let sequence = Stratified::new(&mut rng);
        for point in 0..POINTS {
            glimpse.add(sequence.point(point, &mut rng), 1.0 / f64::from(POINTS));
        }
    }
    if !(glimpse.most > 0.0) {
        // A strip may show between the nodes.
        let mut rng = Rng::new(seed, u64::MAX, index as u64);
        let sequence = Stratified::new(&mut rng);
        let seen_at_all = (0..HIDDEN_POINTS).any(|point| {
            glimpse.add(sequence.point(point, &mut rng), 0.0);
            glimpse.most > 0.0
        });
        if !seen_at_all {
            return None;
        }
    }
    if glimpse.most > ALIKE * glimpse.least {
        return seen(emitters, index, eye, seed, PART_POINTS);
    }
    Some(glimpse.whole(index))
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
}

impl<'e> Glimpse<'e> {
    fn new(emitters: &'e Emitters<'e>, source: &'e Source, eye: DVec3) -> Self {
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
        }
    }

    /// Adds the point of the opening at `u`.
    fn add(&mut self, u: [f64; 2], weight: f64) {
        let Some(shine) = self.source.opening.shine(self.place, u) else { return };
        let arrival = self.emitters.arrival_from(self.source, self.eye, shine, |_| true);
        let passed = arrival.map_or(0.0, |arrival| self.emitters.passed(self.source, self.eye, &arrival));
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
        let blocks = super::seen::REPLICATES;
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
