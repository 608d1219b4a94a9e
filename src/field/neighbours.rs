//! Which patch sides may speak for each other's places: they face alike, lie in nearly one plane and see
//! each other. Patches may differ much in size, so sides are sorted into cells by size and place, and a
//! pair is found from the smaller of its two.

use glam::DVec3;
use rayon::prelude::*;

use crate::geometry::trace::Tracer;

/// Reach of a patch, in its own edges.
pub(super) const REACH: f64 = 1.7;
/// A gradient is fitted to what lies within this many edges.
const FITTED: f64 = 2.7;
/// Farthest place of a patch from its centre, in edges: the corner of half a square.
const CORNER: f64 = 1.06;
/// Neighbours' normals agree to this cosine.
const ALIKE: f64 = 0.9;
/// They lie this near to one plane, in units of the larger reach.
const FLAT: f64 = 0.2;
/// Height over the surfaces at which they see each other, in edges: small unevenness does not part them.
const LIFT: f64 = 0.1;
/// Edge of a cell, in the smallest edges of the size that it holds: pairs of that size, the largest edge of
/// which is twice the smallest, lie in cells that touch.
const CELL: f64 = 2.0 * (REACH + CORNER);

/// A patch side as others see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Middle of the part that counts, m.
    pub centre: DVec3,
    /// A place of it from which others are looked for, m.
    pub clear: DVec3,
    /// Unit normal.
    pub facing: DVec3,
    /// Size, m.
    pub edge_m: f64,
    /// Sides of different kinds do not mix; `None` stays alone.
    pub kind: Option<u32>,
}

/// Neighbours of every side: itself first, the others by their numbers.
pub(super) fn neighbours(sides: &[Place], tracer: &Tracer) -> Vec<Vec<u32>> {
    let cells = Cells::new(sides);
    let pairs: Vec<Vec<Pair>> =
        (0..sides.len()).into_par_iter().map(|side| pairs(side, sides, &cells, tracer)).collect();
    let mut near: Vec<Vec<u32>> = (0..sides.len()).map(|side| vec![side as u32]).collect();
    for (side, pairs) in pairs.into_iter().enumerate() {
        for Pair { other, speaks, listens } in pairs {
            if listens {
                near[side].push(other);
            }
            if speaks {
                near[other as usize].push(side as u32);
            }
        }
    }
    near.par_iter_mut().for_each(|near| near[1..].sort_unstable());
    near
}

/// Two sides of which one at least may speak for the other.
struct Pair {
    other: u32,
    /// The first for places of the other.
    speaks: bool,
    /// The other for places of the first.
    listens: bool,
}

/// Pairs of a side with those that are larger, or as large and of a greater number.
fn pairs(side: usize, sides: &[Place], cells: &Cells, tracer: &Tracer) -> Vec<Pair> {
    let own = &sides[side];
    let mut found = Vec::new();
    if own.kind.is_none() {
        return found;
    }
    let near = |a: &Place, b: &Place, distance_m: f64| {
        distance_m <= (REACH * b.edge_m + CORNER * a.edge_m).max(FITTED * a.edge_m)
    };
    for other_index in cells.around(own, side as u32) {
        let other = &sides[other_index as usize];
        if other.kind != own.kind {
            continue;
        }
        let away = other.centre - own.centre;
        let distance_m = away.length();
        let (listens, speaks) = (near(own, other, distance_m), near(other, own, distance_m));
        let flat_m = FLAT * REACH * own.edge_m.max(other.edge_m);
        let alike = own.facing.dot(other.facing) > ALIKE
            && own.facing.dot(away).abs() < flat_m
            && other.facing.dot(away).abs() < flat_m;
        if !(listens || speaks) || !alike {
            continue;
        }
        let lift_m = LIFT * own.edge_m.min(other.edge_m);
        let (from, to) = (own.clear + own.facing * lift_m, other.clear + other.facing * lift_m);
        let towards = to - from;
        let span_m = towards.length();
        let blocked = span_m > 0.0
            && tracer.closest(from, towards / span_m, &[]).is_some_and(|hit| hit.distance_m < span_m);
        if !blocked {
            found.push(Pair { other: other_index, speaks, listens });
        }
    }
    found
}

/// Sides sorted into cells of space, those of each size in cells of their own.
struct Cells {
    /// Sizes that occur, from the smallest: each holds edges from 2ⁿ to 2ⁿ⁺¹ m.
    sizes: Vec<i32>,
    /// Cells that hold sides, in order, with the first of their members.
    filled: Vec<(i32, [i64; 3], u32)>,
    members: Vec<u32>,
}

impl Cells {
    fn new(sides: &[Place]) -> Self {
        let mut sorted: Vec<(i32, [i64; 3], u32)> = sides
            .iter()
            .enumerate()
            .filter(|(_, side)| side.kind.is_some())
            .map(|(index, side)| {
                let size = Self::size(side.edge_m);
                (size, Self::cell(side.centre, size), index as u32)
            })
            .collect();
        sorted.sort_unstable();
        let mut sizes: Vec<i32> = sorted.iter().map(|(size, ..)| *size).collect();
        sizes.dedup();
        let members: Vec<u32> = sorted.iter().map(|(.., side)| *side).collect();
        let mut filled = Vec::new();
        for (number, (size, cell, _)) in sorted.into_iter().enumerate() {
            if filled.last().is_none_or(|(last, at, _)| (*last, *at) != (size, cell)) {
                filled.push((size, cell, number as u32));
            }
        }
        Self { sizes, filled, members }
    }

    /// Sides in a cell.
    fn within(&self, cell: usize) -> &[u32] {
        let last = self.filled.get(cell + 1).map_or(self.members.len(), |(.., first)| *first as usize);
        &self.members[self.filled[cell].2 as usize..last]
    }

    fn size(edge_m: f64) -> i32 {
        edge_m.log2().floor() as i32
    }

    fn cell(place: DVec3, size: i32) -> [i64; 3] {
        (place / (CELL * f64::from(size).exp2())).to_array().map(|x| x.floor() as i64)
    }

    /// Everything larger than a side in the cells about it, and of its own size what has a greater number.
    fn around<'a>(&'a self, own: &Place, number: u32) -> impl Iterator<Item = u32> + 'a {
        let (own_size, place) = (Self::size(own.edge_m), own.centre);
        self.sizes.iter().filter(move |size| **size >= own_size).flat_map(move |&size| {
            let [x, y, z] = Self::cell(place, size);
            // Cells that differ in z alone lie together.
            (0..9i64).flat_map(move |k| {
                let key = move |z: i64| (size, [x + k % 3 - 1, y + k / 3 - 1, z]);
                let first = self.filled.partition_point(|(size, cell, _)| (*size, *cell) < key(z - 1));
                let row =
                    self.filled[first..].iter().take_while(move |(s, cell, _)| (*s, *cell) <= key(z + 1));
                row.enumerate()
                    .flat_map(move |(number, _)| self.within(first + number).iter().copied())
                    .filter(move |side| size > own_size || *side > number)
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;
    use crate::rng::Rng;

    /// Catches: a pair of unlike sizes that cells do not find, one that is found twice or by one side only.
    #[test]
    fn cells_find_what_comparing_all_finds() {
        let mut mesh = Mesh::default();
        let far = mesh.add_surface("far", 0, false);
        let o = DVec3::new(0.0, 0.0, -9.0);
        mesh.add_quad([o, o + DVec3::X, o + DVec3::new(1.0, 1.0, 0.0), o + DVec3::Y], far);
        let grey = crate::material::Bsdf::Lambert { reflectance: 0.5 };
        let tracer = Tracer::build(&mesh, &[crate::material::Material { name: "a".into(), bsdf: grey }]);
        let mut rng = Rng::new(5, 5, 5);
        let sides: Vec<Place> = (0..600)
            .map(|index| {
                let [x, y, size, z] = rng.uniforms();
                let centre = DVec3::new(8.0 * x - 4.0, 5.0 * y, 0.01 * z);
                let edge_m = 0.03 * (5.0 * size).exp2();
                let kind = (index % 7 > 0).then_some(0);
                Place { centre, clear: centre, facing: DVec3::Z, edge_m, kind }
            })
            .collect();
        let found = neighbours(&sides, &tracer);
        let mut pairs = 0;
        for (index, near) in found.iter().enumerate() {
            let a = &sides[index];
            let mut wanted = vec![index as u32];
            wanted.extend((0..sides.len() as u32).filter(|&other| {
                let b = &sides[other as usize];
                let distance_m = a.centre.distance(b.centre);
                let within = distance_m <= (1.7 * b.edge_m + 1.06 * a.edge_m).max(2.7 * a.edge_m);
                let flat = (a.centre.z - b.centre.z).abs() < 0.2 * 1.7 * a.edge_m.max(b.edge_m);
                other as usize != index && a.kind.is_some() && b.kind.is_some() && within && flat
            }));
            assert_eq!(*near, wanted, "neighbours of {index}");
            pairs += near.len() - 1;
        }
        assert!(pairs > 10_000, "{pairs}");
    }
}
