//! Patch values as a smooth function of place, for pictures: patch edges must not show. Every patch
//! side carries a value and a gradient fitted to its neighbours; a place gets the mean of what the
//! patches around it predict, with weights that fall to nothing at a fixed distance.
//!
//! Neighbours face alike, lie in nearly the same plane and see each other, so light does not leak
//! through walls. Where a patch is partly covered its stored value is a mean over the covered part
//! too: that is a bias of the field which smoothing spreads but does not remove.

use glam::DVec3;
use rayon::prelude::*;

use super::Patches;
use crate::geometry::mesh::Mesh;
use crate::geometry::trace::Tracer;

/// Reach of a patch, in edges of a patch of the mean size.
const REACH: f64 = 1.7;
/// Neighbours' normals agree to this cosine.
const ALIKE: f64 = 0.9;
/// They lie this near to one plane, in units of the reach.
const FLAT: f64 = 0.2;
/// Keeps the fit of a gradient from following noise where neighbours are few.
const STIFFNESS: f64 = 0.2;

/// A smooth function on all patch sides.
#[derive(Clone, Debug)]
pub struct Smooth {
    reach_m: f64,
    sides: Vec<Side>,
    /// Neighbours of all sides, one after the other; each side is its own first neighbour.
    neighbours: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Side {
    centre: DVec3,
    /// A place of it from which others are looked for.
    clear: DVec3,
    facing: DVec3,
    weight: f64,
    value: f64,
    gradient: DVec3,
    first: u32,
    last: u32,
}

impl Smooth {
    /// Fits a function to one value per patch side. `kind` tells sides that must not be mixed apart;
    /// those for which it is `None` stay by themselves. `part` says where the middle of a side is to
    /// which only a part of the patch belongs, and a place that does belong.
    pub fn new(
        mesh: &Mesh,
        tracer: &Tracer,
        patches: &Patches,
        values: &[f64],
        kind: impl Fn(usize) -> Option<u32> + Sync,
        part: impl Fn(usize) -> Option<[DVec3; 2]>,
    ) -> Self {
        let count = patches.sides();
        let total_m2: f64 = (0..count).step_by(2).map(|side| patches.area_m2(side)).sum();
        let edge_m = (2.0 * total_m2 / count.max(1) as f64).sqrt();
        let reach_m = REACH * edge_m;
        let mut sides: Vec<Side> = (0..count)
            .map(|side| {
                let (middle, front) = patches.centre(mesh, side);
                let [centre, clear] = part(side).unwrap_or([middle; 2]);
                let facing = front.normalize_or_zero() * if side.is_multiple_of(2) { 1.0 } else { -1.0 };
                let weight = patches.area_m2(side).sqrt().min(edge_m);
                let value = values[side];
                Side { centre, clear, facing, weight, value, gradient: DVec3::ZERO, first: 0, last: 0 }
            })
            .collect();
        let cells = Cells::new(&sides, 2.0 * reach_m);
        let near: Vec<Vec<u32>> = (0..count)
            .into_par_iter()
            .map(|side| neighbours(side, &sides, &cells, reach_m, edge_m, tracer, &kind))
            .collect();
        let mut neighbours = Vec::new();
        for (side, near) in near.into_iter().enumerate() {
            sides[side].first = neighbours.len() as u32;
            neighbours.extend(near);
            sides[side].last = neighbours.len() as u32;
        }
        let mut smooth = Self { reach_m, sides, neighbours };
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
        let (mut sum, mut weights) = (self.sides[side].value * 1e-6, 1e-6);
        let reach_squared = self.reach_m * self.reach_m;
        for &other in self.around(side) {
            let other = &self.sides[other as usize];
            let away = place - other.centre;
            let left = 1.0 - away.length_squared() / reach_squared;
            if left > 0.0 {
                let weight = other.weight * left * left;
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
        for &other in self.around(side) {
            let other = &self.sides[other as usize];
            let away = other.centre - own.centre;
            let left = 1.0 - away.length_squared() / (4.0 * self.reach_m * self.reach_m);
            if !(left > 0.0) {
                continue;
            }
            let weight = other.weight * left * left;
            let (x, y, v) = (away.dot(frame.x_axis), away.dot(frame.y_axis), other.value - own.value);
            xx += weight * x * x;
            xy += weight * x * y;
            yy += weight * y * y;
            xv += weight * x * v;
            yv += weight * y * v;
            total += weight;
        }
        let stiff = STIFFNESS * total * self.reach_m * self.reach_m * 0.25;
        let (xx, yy) = (xx + stiff, yy + stiff);
        let determinant = xx * yy - xy * xy;
        if !(determinant > 0.0) {
            return DVec3::ZERO;
        }
        let x = (xv * yy - yv * xy) / determinant;
        let y = (yv * xx - xv * xy) / determinant;
        frame.x_axis * x + frame.y_axis * y
    }
}

fn neighbours(
    side: usize,
    sides: &[Side],
    cells: &Cells,
    reach_m: f64,
    edge_m: f64,
    tracer: &Tracer,
    kind: &(impl Fn(usize) -> Option<u32> + Sync),
) -> Vec<u32> {
    let own = &sides[side];
    let mut near = vec![side as u32];
    let Some(own_kind) = kind(side) else { return near };
    let furthest_m = reach_m + edge_m;
    for other_index in cells.around(own.centre) {
        let other = &sides[other_index as usize];
        let away = other.centre - own.centre;
        let distance_m = away.length();
        let alike = own.facing.dot(other.facing) > ALIKE
            && own.facing.dot(away).abs() < FLAT * reach_m
            && other.facing.dot(away).abs() < FLAT * reach_m;
        if other_index as usize == side
            || distance_m > furthest_m
            || !alike
            || kind(other_index as usize) != Some(own_kind)
        {
            continue;
        }
        // Seen from a little above the surfaces: small unevenness does not part them.
        let lift_m = 0.1 * edge_m;
        let (from, to) = (own.clear + own.facing * lift_m, other.clear + other.facing * lift_m);
        let towards = to - from;
        let span_m = towards.length();
        let blocked = span_m > 0.0
            && tracer.closest(from, towards / span_m, &[]).is_some_and(|hit| hit.distance_m < span_m);
        if !blocked {
            near.push(other_index);
        }
    }
    near
}

/// Sides sorted into cells of space.
struct Cells {
    size_m: f64,
    sorted: Vec<([i64; 3], u32)>,
}

impl Cells {
    fn new(sides: &[Side], size_m: f64) -> Self {
        let mut sorted: Vec<([i64; 3], u32)> = Vec::with_capacity(sides.len());
        for (index, side) in sides.iter().enumerate() {
            sorted.push((Self::cell(side.centre, size_m), index as u32));
        }
        sorted.sort_unstable();
        Self { size_m, sorted }
    }

    fn cell(place: DVec3, size_m: f64) -> [i64; 3] {
        (place / size_m).to_array().map(|x| x.floor() as i64)
    }

    /// Everything in the cell of a place and the 26 around it, in a fixed order.
    fn around(&self, place: DVec3) -> impl Iterator<Item = u32> + '_ {
        let [x, y, z] = Self::cell(place, self.size_m);
        (0..27i64).flat_map(move |k| {
            let cell = [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1];
            let first = self.sorted.partition_point(|(other, _)| *other < cell);
            self.sorted[first..].iter().take_while(move |(other, _)| *other == cell).map(|(_, side)| *side)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let materials = [crate::material::Material {
            name: "a".into(),
            bsdf: crate::material::Bsdf::Lambert { reflectance: 0.5 },
        }];
        let tracer = Tracer::build(mesh, &materials);
        let patches = Patches::new(mesh, 0.02, |_| true);
        let values: Vec<f64> = (0..patches.sides()).map(|side| value(patches.centre(mesh, side).0)).collect();
        (Smooth::new(mesh, &tracer, &patches, &values, |_| Some(0), |_| None), patches)
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
