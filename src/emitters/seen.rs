//! How an eye sees a luminaire: visible solid angle, mean luminance of the visible part, fraction.

use glam::DVec3;

use super::glints::{Glint, glints_from};
use super::shining::{Shining, shining_from};
use super::{Arrival, Emitters};
use crate::estimate::{Estimate, Pair};
use crate::rng::{Rng, Stratified};

/// Replicates from which the errors of visible quantities are taken.
pub(super) const REPLICATES: usize = 16;
/// Points of the opening in each replicate.
const POINTS: u32 = 32;
/// Where less than this share is visible, so few points hit it that their spread says little: it is sampled
/// anew, by this many times the points.
pub(super) const LITTLE: (f64, u32) = (0.25, 8);
/// Pieces of an opening along each of its two parameters.
const PIECES: usize = 8;

/// A luminaire (or its image) as seen from one point, channel at initial flux and full factor.
#[derive(Clone, Debug)]
pub struct Seen {
    /// Index into [`Emitters::sources`].
    pub source: usize,
    /// Unit direction from the eye to the centre of the opening.
    pub direction: DVec3,
    /// Distance to the centre, m.
    pub distance_m: f64,
    /// Solid angle of the visible part, ∫ V dω over the opening, sr; 0 for point sources.
    pub solid_angle_sr: Estimate,
    /// ∫ L dω over the visible part, lx on a plane facing the source: I/d² of what is visible.
    pub normal_lx: Estimate,
    /// Covariance of the two, lx·sr: they come from the same rays.
    pub covariance_lx_sr: f64,
    /// ∫ L d dω over the visible part, d the unit direction from the eye, lx: its part along a normal is
    /// the illuminance on a plane that has all of it in front.
    pub light: DVec3,
    /// Visible share of the unobstructed solid angle (for points: of the light).
    pub visible_fraction: f64,
    /// Projected area of the whole opening towards the eye, m².
    pub projected_area_m2: f64,
    /// I/d² of the opening's centre, hidden or not, lx.
    pub centre_lx: f64,
    /// The visible part in pieces; empty for a point.
    pub pieces: Vec<SeenPiece>,
}

/// A piece of an opening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPiece {
    /// Unit direction from the eye to the middle of its visible part.
    pub direction: DVec3,
    /// Visible solid angle, sr.
    pub visible_sr: f64,
    /// ∫ L dω over it, lx.
    pub normal_lx: f64,
}

/// Everything that shines, as seen from one eye in all directions.
#[derive(Clone, Debug, Default)]
pub struct Sighted {
    /// The eye, m.
    pub eye: DVec3,
    /// Luminaires and their images.
    pub luminaires: Vec<Seen>,
    /// Luminous surfaces and their images.
    pub surfaces: Vec<Shining>,
    /// Highlights in glossy planes; `None` where they were not looked for.
    pub glints: Option<Vec<Glint>>,
}

/// Luminaires and luminous surfaces of which anything is visible from `eye`, and `highlights` if they are
/// wanted. Draws from `seed` only.
pub fn sighted_from(emitters: &Emitters, eye: DVec3, seed: u64, highlights: bool) -> Sighted {
    Sighted {
        eye,
        luminaires: seen_from(emitters, eye, seed),
        surfaces: shining_from(emitters, eye, seed),
        glints: highlights.then(|| glints_from(emitters, eye, seed)),
    }
}

impl Seen {
    /// ω-weighted mean luminance of the visible part, cd/m²; `None` for a point source.
    pub fn luminance_cd_m2(&self) -> Option<f64> {
        (self.solid_angle_sr.value > 0.0).then(|| self.normal_lx.value / self.solid_angle_sr.value)
    }
}

/// All sources of which anything is visible from `eye`, within the half-space of nothing: the
/// caller knows the gaze. Draws from `seed` only, so it repeats exactly.
pub fn seen_from(emitters: &Emitters, eye: DVec3, seed: u64) -> Vec<Seen> {
    (0..emitters.sources.len()).filter_map(|index| seen(emitters, index, eye, seed, POINTS)).collect()
}

/// [`seen_from`] by so many points of every opening in each of 16 replicates, for references.
pub fn seen_by_points(emitters: &Emitters, eye: DVec3, seed: u64, points: u32) -> Vec<Seen> {
    let one =
        |index: usize| sampled(emitters, index, eye, &mut Rng::new(seed, u64::MAX, index as u64), points);
    (0..emitters.sources.len()).filter_map(one).collect()
}

/// A source by `points` of its opening in each replicate, more where little is visible.
pub(super) fn seen(emitters: &Emitters, index: usize, eye: DVec3, seed: u64, points: u32) -> Option<Seen> {
    let mut rng = Rng::new(seed, u64::MAX, index as u64);
    let found = sampled(emitters, index, eye, &mut rng, points)?;
    if !found.pieces.is_empty() && found.visible_fraction < LITTLE.0 {
        return sampled(emitters, index, eye, &mut rng, LITTLE.1 * points);
    }
    Some(found)
}

fn sampled(emitters: &Emitters, index: usize, eye: DVec3, rng: &mut Rng, points: u32) -> Option<Seen> {
    let source = &emitters.sources[index];
    if !emitters.may_show(source, eye) {
        return None;
    }
    let points = if source.is_point() { 1 } else { points };
    let mut sequence = Stratified::new(rng);
    let passed = |arrival: &Arrival| emitters.passed(source, eye, arrival);
    by_points(emitters, index, eye, points, passed, |replicate, point| {
        if point == 0 && replicate > 0 {
            sequence = Stratified::new(rng);
        }
        if points == 1 { [0.5, 0.5] } else { sequence.point(point, rng) }
    })
}

/// A source by points of its opening (`place`: of which replicate, and the point's number in it), and what of the
/// light from there has `passed`.
pub(super) fn by_points(
    emitters: &Emitters,
    index: usize,
    eye: DVec3,
    points: u32,
    passed: impl Fn(&Arrival) -> f64,
    mut place_of: impl FnMut(usize, u32) -> [f64; 2],
) -> Option<Seen> {
    let source = &emitters.sources[index];
    let centre = source.position - eye;
    let mut solid = Vec::with_capacity(REPLICATES);
    let mut light = Vec::with_capacity(REPLICATES);
    let mut whole = 0.0;
    let mut passed_sum = 0.0;
    let mut vector = DVec3::ZERO;
    let place = source.place(eye);
    let mut cells = [(DVec3::ZERO, 0.0, 0.0); PIECES * PIECES];
    for replicate in 0..REPLICATES {
        let (mut solid_sr, mut normal_lx) = (0.0, 0.0);
        for point in 0..points {
            let u = place_of(replicate, point);
            let Some(shine) = source.opening.shine(place, u) else { continue };
            let away = place - shine.at;
            let projected_m2 = source.opening.projected_area_m2(away.normalize_or_zero());
            let element_sr = shine.weight * projected_m2 / away.length_squared();
            whole += element_sr;
            let Some(arrival) = emitters.arrival_from(source, eye, shine, |_| true) else { continue };
            let passed = passed(&arrival);
            passed_sum += passed;
            // Behind a pane or in a mirror the source keeps its solid angle and loses luminance.
            solid_sr += if passed > 0.0 { element_sr } else { 0.0 };
            normal_lx += arrival.normal_lx * passed;
            vector += arrival.direction * (arrival.normal_lx * passed);
            if passed > 0.0 {
                let place = u.map(|part| ((part * PIECES as f64) as usize).min(PIECES - 1));
                let cell = &mut cells[place[0] * PIECES + place[1]];
                cell.0 += arrival.direction * element_sr;
                cell.1 += element_sr;
                cell.2 += arrival.normal_lx * passed;
            }
        }
        solid.push(solid_sr / f64::from(points));
        light.push(normal_lx / f64::from(points));
    }
    if !(passed_sum > 0.0) {
        return None;
    }
    let joint = Pair::from_blocks(&light, &solid);
    let solid_angle_sr = Estimate::from_blocks(&solid);
    let count = REPLICATES as f64 * f64::from(points);
    let whole_sr = whole / count;
    Some(Seen {
        source: index,
        direction: centre.normalize_or_zero(),
        distance_m: centre.length(),
        visible_fraction: if whole_sr > 0.0 { solid_angle_sr.value / whole_sr } else { 1.0 },
        solid_angle_sr,
        normal_lx: Estimate::from_blocks(&light),
        covariance_lx_sr: joint.cov,
        light: vector / count,
        projected_area_m2: source.opening.projected_area_m2(place.normalize_or_zero()),
        centre_lx: emitters.luminaire(source).kind.distribution.intensity_along(place.normalize_or_zero())
            * source.dim
            / place.length_squared(),
        pieces: pieces(&cells, count),
    })
}

/// Cells (Σ ω d, Σ ω, Σ ∫ L dω) as pieces; empty ones are none.
fn pieces(cells: &[(DVec3, f64, f64)], count: f64) -> Vec<SeenPiece> {
    let of_cell = |&(direction, visible, light): &(DVec3, f64, f64)| SeenPiece {
        direction: direction.normalize_or_zero(),
        visible_sr: visible / count,
        normal_lx: light / count,
    };
    cells.iter().filter(|(_, visible, _)| *visible > 0.0).map(of_cell).collect()
}
