//! Patch values as a smooth function of place, for pictures: patch edges must not show. Every patch
//! side carries a value and a gradient fitted to its neighbours; a place gets the mean of what the
//! patches around it predict, with weights that fall to nothing at a distance in proportion to the
//! patch. Where small patches lie beside large ones, the small ones know better.
//!
//! Neighbours face alike, lie in nearly the same plane and see each other, so light does not leak
//! through walls. Where a patch is partly covered its stored value is a mean over the covered part
//! too: that is a bias of the field which smoothing spreads but does not remove.

use glam::DVec3;
use rayon::prelude::*;

use super::Patches;
use super::neighbours::{Place, REACH, neighbours};
use crate::geometry::trace::Tracer;

/// Keeps the fit of a gradient from following noise where neighbours are few.
const STIFFNESS: f64 = 0.2;
/// The same where a patch is compared with its neighbours: next to nothing, for slopes must not count.
const HARDLY_STIFF: f64 = 1e-3;
/// Edge of half a square, in the distance of its farthest corner.
const ACROSS: f64 = 0.94;
/// Neighbours that a patch is compared with, at least.
const FEWEST: usize = 6;

/// A smooth function on all patch sides.
#[derive(Clone, Debug)]
pub struct Smooth {
    sides: Vec<Side>,
    /// Neighbours of all sides, one after the other; each side is its own first neighbour.
    neighbours: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Side {
    centre: DVec3,
    facing: DVec3,
    reach_m: f64,
    /// Root of its area, at most its edge, m.
    weight_m: f64,
    value: f64,
    gradient: DVec3,
    first: u32,
    last: u32,
}

/// How far a side's value is from what its neighbours predict.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misfit {
    /// Value minus prediction.
    pub difference: f64,
    /// Variance of the difference.
    pub variance: f64,
}

impl Smooth {
    /// Fits a function to one value per patch side. `kind` tells sides that must not be mixed apart;
    /// those for which it is `None` stay by themselves. `part` says where the middle of a side is to
    /// which only a part of the patch belongs, and a place that does belong.
    pub fn new(
        tracer: &Tracer,
        patches: &Patches,
        values: &[f64],
        kind: impl Fn(usize) -> Option<u32> + Sync,
        part: impl Fn(usize) -> Option<[DVec3; 2]> + Sync,
    ) -> Self {
        let count = patches.sides();
        let total_m2: f64 = (0..count).step_by(2).map(|side| patches.area_m2(side)).sum();
        let mean_m = (2.0 * total_m2 / count.max(1) as f64).sqrt();
        let places: Vec<Place> = (0..count)
            .into_par_iter()
            .map(|side| {
                let (middle, front) = patches.centre(side);
                let [centre, clear] = part(side).unwrap_or([middle; 2]);
                let facing = front.normalize_or_zero() * if side.is_multiple_of(2) { 1.0 } else { -1.0 };
                // Triangles that are joined may lie farther apart than their area tells.
                let extent_m = (ACROSS * patches.radius_m(side, middle)).min(mean_m);
                let edge_m = patches.area_m2(side).sqrt().max(extent_m).max(f64::MIN_POSITIVE);
                Place { centre, clear, facing, edge_m, kind: kind(side) }
            })
            .collect();
        let near = neighbours(&places, tracer);
        let mut smooth = Self { sides: Vec::with_capacity(count), neighbours: Vec::new() };
        for (side, (place, near)) in places.iter().zip(near).enumerate() {
            let first = smooth.neighbours.len() as u32;
            smooth.neighbours.extend(near);
            smooth.sides.push(Side {
                centre: place.centre,
                facing: place.facing,
                reach_m: REACH * place.edge_m,
                weight_m: patches.area_m2(side).sqrt().min(place.edge_m),
                value: values[side],
                gradient: DVec3::ZERO,
                first,
                last: smooth.neighbours.len() as u32,
            });
        }
        smooth.fit_all();
        smooth
    }

    /// Another function on the same sides.
    #[must_use]
    pub fn with(&self, values: &[f64]) -> Self {
        let mut other = self.clone();
        for (side, value) in other.sides.iter_mut().zip(values) {
            side.value = *value;
        }
        other.fit_all();
        other
    }

    fn fit_all(&mut self) {
        let gradients: Vec<DVec3> =
            (0..self.sides.len()).into_par_iter().map(|side| self.fit(side)).collect();
        for (side, gradient) in self.sides.iter_mut().zip(gradients) {
            side.gradient = gradient;
        }
    }

    fn around(&self, side: usize) -> &[u32] {
        &self.neighbours[self.sides[side].first as usize..self.sides[side].last as usize]
    }

    /// The value at a place of a patch side.
    pub fn at(&self, side: usize, place: DVec3) -> f64 {
        // The patch itself always counts a little, so that there is always something to go by.
        let own = &self.sides[side];
        let least = 1e-6 * own.weight_m / (own.reach_m * own.reach_m);
        let (mut sum, mut weights) = (own.value * least, least);
        for &other in self.around(side) {
            let other = &self.sides[other as usize];
            let reach_squared = other.reach_m * other.reach_m;
            let away = place - other.centre;
            let left = 1.0 - away.length_squared() / reach_squared;
            if left > 0.0 {
                let weight = other.weight_m / (other.reach_m * reach_squared) * left * left;
                sum += weight * (other.value + other.gradient.dot(away));
                weights += weight;
            }
        }
        sum / weights
    }

    /// Gradient in the plane of a side by least squares over its neighbours.
    fn fit(&self, side: usize) -> DVec3 {
        let own = &self.sides[side];
        let frame = crate::sphere::frame(own.facing);
        let (mut xx, mut xy, mut yy, mut xv, mut yv, mut total) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for (other, x, y, weight) in self.seen_from(side) {
            let v = self.sides[other].value - own.value;
            xx += weight * x * x;
            xy += weight * x * y;
            yy += weight * y * y;
            xv += weight * x * v;
            yv += weight * y * v;
            total += weight;
        }
        let stiff = STIFFNESS * total * own.reach_m * own.reach_m * 0.25;
        let (xx, yy) = (xx + stiff, yy + stiff);
        let determinant = xx * yy - xy * xy;
        if !(determinant > 0.0) {
            return DVec3::ZERO;
        }
        let x = (xv * yy - yv * xy) / determinant;
        let y = (yv * xx - xv * xy) / determinant;
        frame.x_axis * x + frame.y_axis * y
    }

    /// Neighbours of a side, itself first, with their place in its plane and their weight.
    fn seen_from(&self, side: usize) -> impl Iterator<Item = (usize, f64, f64, f64)> {
        let own = &self.sides[side];
        let frame = crate::sphere::frame(own.facing);
        self.around(side).iter().filter_map(move |&number| {
            let other = &self.sides[number as usize];
            let away = other.centre - own.centre;
            let left = 1.0 - away.length_squared() / (4.0 * own.reach_m * own.reach_m);
            let weight = other.weight_m.min(own.reach_m / REACH) * left * left;
            (left > 0.0).then(|| (number as usize, away.dot(frame.x_axis), away.dot(frame.y_axis), weight))
        })
    }

    /// Compares a side with the affine function through its neighbours, itself left out; `variance` are
    /// those of the values. `None` where there are too few neighbours to tell.
    pub fn misfit(&self, side: usize, variance: &[f64]) -> Option<Misfit> {
        let others = || self.seen_from(side).skip(1);
        let own = &self.sides[side];
        let scale_m = own.reach_m;
        let mut m = glam::DMat3::ZERO;
        let mut count = 0;
        for (_, x, y, weight) in others() {
            let row = DVec3::new(1.0, x / scale_m, y / scale_m);
            m += glam::DMat3::from_cols(row * row.x, row * row.y, row * row.z) * weight;
            count += 1;
        }
        if count < FEWEST {
            return None;
        }
        let stiff = HARDLY_STIFF * m.x_axis.x;
        m.y_axis.y += stiff;
        m.z_axis.z += stiff;
        let solved = m.inverse() * DVec3::X;
        if !solved.is_finite() {
            return None;
        }
        let (mut difference, mut scatter) = (own.value, variance[side]);
        for (number, x, y, weight) in others() {
            let share = weight * solved.dot(DVec3::new(1.0, x / scale_m, y / scale_m));
            difference -= share * self.sides[number].value;
            scatter += share * share * variance[number];
        }
        Some(Misfit { difference, variance: scatter })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;

    /// A floor of two quads with a wall between them that stands on their common edge.
    fn floor(wall: bool) -> Mesh {
        let mut mesh = Mesh::default();
        let floor = mesh.add_surface("floor", 0, false);
        for x in [0.0, 2.0] {
            let o = DVec3::X * x;
            mesh.add_quad([o, o + DVec3::X * 2.0, o + DVec3::new(2.0, 3.0, 0.0), o + DVec3::Y * 3.0], floor);
        }
        if wall {
            let surface = mesh.add_surface("wall", 0, false);
            let p = |y: f64, z: f64| DVec3::new(2.0, y, z);
            mesh.add_quad([p(0.0, 0.0), p(3.0, 0.0), p(3.0, 2.0), p(0.0, 2.0)], surface);
        }
        mesh
    }

    fn smooth(mesh: &Mesh, value: impl Fn(DVec3) -> f64) -> (Smooth, Patches) {
        smooth_on(mesh, |_| (), value)
    }

    fn smooth_on(
        mesh: &Mesh,
        split: impl Fn(&mut Patches),
        value: impl Fn(DVec3) -> f64,
    ) -> (Smooth, Patches) {
        let materials = [crate::material::Material {
            name: "a".into(),
            bsdf: crate::material::Bsdf::Lambert { reflectance: 0.5 },
        }];
        let tracer = Tracer::build(mesh, &materials);
        let mut patches = Patches::new(mesh, 0.02, |_| true);
        split(&mut patches);
        let values: Vec<f64> = (0..patches.sides()).map(|side| value(patches.centre(side).0)).collect();
        (Smooth::new(&tracer, &patches, &values, |_| Some(0), |_| None), patches)
    }

    /// Value at the floor's point (x, y).
    fn at(mesh: &Mesh, (smooth, patches): &(Smooth, Patches), x: f64, y: f64) -> f64 {
        for triangle in 0..4 {
            let [a, b, c] = mesh.corners(triangle);
            let g = DVec3::new(x, y, 0.0) - a;
            let n = (b - a).cross(c - a);
            let (s, t) = (g.cross(c - a).dot(n) / n.dot(n), (b - a).cross(g).dot(n) / n.dot(n));
            if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
                return smooth.at(patches.side_at(triangle as u32, [s, t], true), DVec3::new(x, y, 0.0));
            }
        }
        panic!("({x}, {y}) is not on the floor");
    }

    /// Catches: patch edges in a picture; a mean where a slope is asked for.
    #[test]
    fn a_slope_is_kept_and_nothing_jumps() {
        let mesh = floor(false);
        let sloping = smooth(&mesh, |p| 10.0 + 3.0 * p.x - 2.0 * p.y);
        for (x, y) in [(0.7, 1.1), (2.0, 1.5), (3.3, 2.2)] {
            let expected = 10.0 + 3.0 * x - 2.0 * y;
            assert!((at(&mesh, &sloping, x, y) - expected).abs() < 0.02, "{x} {y}");
        }
        let curved = smooth(&mesh, |p| (2.0 * p.x).sin() + p.y * p.y);
        let mut largest: f64 = 0.0;
        for step in 0..4000 {
            let x = 0.0005 + f64::from(step) * 0.000999;
            let jump = at(&mesh, &curved, x + 0.000999, 1.4721) - at(&mesh, &curved, x, 1.4721);
            largest = largest.max(jump.abs());
        }
        // The function itself changes by at most 2e-3 per step; a patch is 0.14 m wide.
        assert!(largest < 6e-3, "a jump of {largest}");
    }

    /// Catches: a coarse patch that speaks where fine ones lie, a slope bent where sizes meet, a jump there.
    #[test]
    fn patches_of_unlike_size_join() {
        let mesh = floor(false);
        let split = |patches: &mut Patches| {
            let near = |patches: &Patches, side: usize| patches.centre(side).0.x < 1.0;
            for _ in 0..2 {
                for patch in (0..patches.len()).filter(|&patch| near(patches, 2 * patch)).collect::<Vec<_>>()
                {
                    patches.split(&mesh, patch);
                }
            }
        };
        let sloping = smooth_on(&mesh, split, |p| 10.0 + 3.0 * p.x - 2.0 * p.y);
        for (x, y) in [(0.5, 1.1), (0.9, 1.3), (1.0, 1.5), (1.1, 2.2), (3.3, 2.2)] {
            let expected = 10.0 + 3.0 * x - 2.0 * y;
            assert!((at(&mesh, &sloping, x, y) - expected).abs() < 0.02, "{x} {y}");
        }
        // A wave that only the fine patches resolve (their edges are 0.035 m, the others 0.14 m).
        let wave = |p: DVec3| (12.0 * p.x).sin();
        let fine = smooth_on(&mesh, split, wave);
        let largest = |from: f64, to: f64| {
            let at = |k: i32| from + (to - from) * f64::from(k) / 400.0;
            let off = |k: i32| (along(&mesh, &fine, at(k)) - (12.0 * at(k)).sin()).abs();
            (0..400).map(off).fold(0.0, f64::max)
        };
        assert!(largest(0.2, 0.7) < 0.03, "{}", largest(0.2, 0.7));
        assert!(largest(1.5, 3.0) > 0.2, "the coarse ones should fail: {}", largest(1.5, 3.0));
        let step = |k: i32| along(&mesh, &fine, 0.6 + 0.0005 * f64::from(k));
        let jump = (0..1600).map(|k| (step(k + 1) - step(k)).abs()).fold(0.0, f64::max);
        // The wave itself changes by 6e-3 a step.
        assert!(jump < 0.02, "a jump of {jump}");
    }

    fn along(mesh: &Mesh, function: &(Smooth, Patches), x: f64) -> f64 {
        at(mesh, function, x, 1.4721)
    }

    /// Catches: a misfit that counts slopes or leaves bends out, or a wrong variance of it.
    #[test]
    fn bends_do_not_fit_and_slopes_do() {
        let mesh = floor(false);
        let misfits = |value: fn(DVec3) -> f64| -> Vec<f64> {
            let (smooth, patches) = smooth(&mesh, value);
            let variance = vec![1.0; patches.sides()];
            let inner = |side: usize| {
                let p = patches.centre(side).0;
                p.x > 0.5 && p.x < 3.5 && p.y > 0.5 && p.y < 2.5
            };
            (0..patches.sides())
                .filter(|&side| inner(side))
                .map(|side| {
                    let misfit = smooth.misfit(side, &variance).expect("there are neighbours");
                    // Its own and a share of the others, of which some ten count.
                    assert!((1.02..1.5).contains(&misfit.variance), "{}", misfit.variance);
                    misfit.difference
                })
                .collect()
        };
        let most = |all: &[f64]| all.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        assert!(most(&misfits(|p| 10.0 + 3.0 * p.x - 2.0 * p.y)) < 0.01);
        // z = x²: below its neighbours by the mean square of their distance along x.
        let bent = misfits(|p| p.x * p.x);
        assert!(bent.iter().all(|d| (-0.06..-0.005).contains(d)), "{bent:?}");
        let (smooth, patches) = smooth(&mesh, |_| 1.0);
        let lone = (0..patches.sides()).filter(|&side| smooth.around(side).len() <= FEWEST);
        lone.for_each(|side| assert!(smooth.misfit(side, &vec![0.0; patches.sides()]).is_none()));
    }

    /// Catches: light that leaks under a wall.
    #[test]
    fn a_wall_parts_its_sides() {
        let mesh = floor(true);
        let lit = |p: DVec3| if p.x < 2.0 { 0.0 } else { 100.0 };
        assert!(at(&mesh, &smooth(&mesh, lit), 1.99, 1.5) < 1e-9);
        // Broken twin: without the wall the light does spread.
        let open = floor(false);
        assert!(at(&open, &smooth(&open, lit), 1.99, 1.5) > 20.0);
    }
}
