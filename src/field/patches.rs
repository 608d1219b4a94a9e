//! Patches: large triangles are divided, small ones of one surface that lie near each other and
//! face alike are joined. Every patch has two sides: `2·patch` in front, `2·patch + 1` behind.

use std::collections::BTreeMap;

use glam::DVec3;

use super::Place;
use crate::geometry::mesh::Mesh;
use crate::scene::Scene;

/// Marks a node whose four children follow each other; the rest of the number is the first of them.
const SPLIT: u32 = 1 << 31;
/// Smallest patch that is split further, as a share of its triangle's edge.
const SMALLEST_EDGE: f64 = 1e-4;

/// A division of the mesh.
#[derive(Clone, Debug)]
pub struct Patches {
    /// Per triangle: first node, and number of divisions of each edge.
    of_triangle: Vec<(u32, u32)>,
    /// Per node: its patch, or where its children are.
    nodes: Vec<u32>,
    /// Per patch: range in `members`, and its node.
    ranges: Vec<(u32, u32, u32)>,
    members: Vec<Member>,
    /// Patches that were split, in this order.
    splits: Vec<u32>,
}

/// A part of a triangle that belongs to a patch.
#[derive(Clone, Copy, Debug)]
struct Member {
    triangle: u32,
    part: Part,
    /// Area within the patch up to here, m².
    cumulative_m2: f64,
    /// First corner of the triangle and its edges to the others, m; its unit normal. Kept here since places
    /// are drawn by the million, each on another patch.
    corner: DVec3,
    edges: [DVec3; 2],
    normal: DVec3,
}

impl Member {
    fn new(mesh: &Mesh, triangle: u32, part: Part, cumulative_m2: f64) -> Self {
        let [a, b, c] = mesh.corners(triangle as usize);
        let (normal, _) = mesh.normal_and_area(triangle as usize);
        Self { triangle, part, cumulative_m2, corner: a, edges: [b - a, c - a], normal }
    }

    /// The place at weights within the part.
    fn at(&self, local: [f64; 2]) -> DVec3 {
        let [s, t] = self.part.at(local);
        self.corner + self.edges[0] * s + self.edges[1] * t
    }
}

/// An affine map from weights within a part to weights of the triangle's second and third corner.
#[derive(Clone, Copy, Debug)]
struct Part {
    origin: [f64; 2],
    edges: [[f64; 2]; 2],
}

impl Part {
    const WHOLE: Self = Self { origin: [0.0; 2], edges: [[1.0, 0.0], [0.0, 1.0]] };

    /// Part `index` of an edge divided `divisions` times.
    fn of(index: u32, divisions: u32) -> Self {
        if divisions == 1 { Self::WHOLE } else { Self::WHOLE.inner(index, divisions) }
    }

    fn at(&self, [s, t]: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|k| self.origin[k] + self.edges[0][k] * s + self.edges[1][k] * t)
    }

    fn inner(&self, index: u32, divisions: u32) -> Self {
        let origin = self.at(within(index, divisions, [0.0, 0.0]));
        let ends = [[1.0, 0.0], [0.0, 1.0]].map(|end| self.at(within(index, divisions, end)));
        Self { origin, edges: ends.map(|end| [end[0] - origin[0], end[1] - origin[1]]) }
    }
}

impl Patches {
    /// Divides so that a patch has about `area_m2`; triangles for which `keep` is false (specular
    /// ones) get no patch of their own and must not be looked up.
    pub fn new(mesh: &Mesh, area_m2: f64, keep: impl Fn(usize) -> bool) -> Self {
        let mut patches = Self {
            of_triangle: vec![(u32::MAX, 1); mesh.triangles.len()],
            nodes: Vec::new(),
            ranges: Vec::new(),
            members: Vec::new(),
            splits: Vec::new(),
        };
        let mut joined: BTreeMap<(u32, [i64; 3], [i8; 3]), Vec<usize>> = BTreeMap::new();
        let cell_m = area_m2.sqrt();
        for index in (0..mesh.triangles.len()).filter(|&index| keep(index)) {
            let (normal, area) = mesh.normal_and_area(index);
            if area > 0.5 * area_m2 {
                let divisions = (area / area_m2).sqrt().ceil().max(1.0) as u32;
                patches.of_triangle[index] = (patches.nodes.len() as u32, divisions);
                let share_m2 = area / f64::from(divisions * divisions);
                for part in 0..divisions * divisions {
                    patches.add(mesh, index as u32, Part::of(part, divisions), share_m2);
                }
            } else {
                let centre = mesh.corners(index).iter().sum::<glam::DVec3>() / 3.0;
                let cell = (centre / cell_m).to_array().map(|x| x.floor() as i64);
                let facing = normal.to_array().map(|x| (x * 1.4).round() as i8);
                joined.entry((mesh.triangles[index].surface, cell, facing)).or_default().push(index);
            }
        }
        for group in joined.values() {
            let (first, patch) = (patches.members.len() as u32, patches.ranges.len() as u32);
            let node = patches.nodes.len() as u32;
            let mut total = 0.0;
            for &index in group {
                patches.of_triangle[index] = (patches.nodes.len() as u32, 1);
                patches.nodes.push(patch);
                total += mesh.normal_and_area(index).1;
                patches.members.push(Member::new(mesh, index as u32, Part::WHOLE, total));
            }
            patches.ranges.push((first, patches.members.len() as u32, node));
        }
        patches
    }

    /// A new patch on a new node.
    fn add(&mut self, mesh: &Mesh, triangle: u32, part: Part, area_m2: f64) {
        let (member, node) = (self.members.len() as u32, self.nodes.len() as u32);
        self.nodes.push(self.ranges.len() as u32);
        self.ranges.push((member, member + 1, node));
        self.members.push(Member::new(mesh, triangle, part, area_m2));
    }

    /// Divides the surfaces of a scene that have a diffuse part.
    pub fn of_scene(scene: &Scene, area_m2: f64) -> Self {
        Self::new(&scene.mesh, area_m2, |triangle| scene.bsdf(triangle as u32).specular(1.0).is_none())
    }

    /// Splits a patch: a part of one triangle into four of a quarter of its area, joined triangles into
    /// two groups. It becomes the first of them, the others are appended. What is tiny stays whole: `None`.
    pub fn split(&mut self, mesh: &Mesh, patch: usize) -> Option<Vec<usize>> {
        let (first, last, _) = self.ranges[patch];
        if last - first > 1 {
            let next = self.halve(mesh, patch);
            self.splits.push(patch as u32);
            return Some(vec![patch, next]);
        }
        let Member { triangle, part, cumulative_m2, .. } = self.members[first as usize];
        let edge = part.edges[0][0].abs().max(part.edges[0][1].abs());
        let full = self.nodes.len() + 4 > SPLIT as usize;
        if edge < SMALLEST_EDGE || full {
            return None;
        }
        let base = self.nodes.len() as u32;
        let node = self.ranges[patch].2;
        self.nodes[node as usize] = SPLIT | base;
        let area_m2 = 0.25 * cumulative_m2;
        self.nodes.push(patch as u32);
        self.ranges[patch].2 = base;
        let own = &mut self.members[first as usize];
        (own.part, own.cumulative_m2) = (part.inner(0, 2), area_m2);
        let next = self.ranges.len();
        for index in 1..4 {
            self.add(mesh, triangle, part.inner(index, 2), area_m2);
        }
        self.splits.push(patch as u32);
        Some(vec![patch, next, next + 1, next + 2])
    }

    /// Divides joined triangles along the longest extent of their centres; the new patch's number.
    fn halve(&mut self, mesh: &Mesh, patch: usize) -> usize {
        let (first, last, _) = self.ranges[patch];
        let members = &mut self.members[first as usize..last as usize];
        let centre = |triangle: u32| mesh.corners(triangle as usize).iter().sum::<DVec3>() / 3.0;
        let (low, high) =
            members.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), member| {
                (low.min(centre(member.triangle)), high.max(centre(member.triangle)))
            });
        let extent = (high - low).to_array();
        let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
        members.sort_by(|a, b| {
            let along = |member: &Member| centre(member.triangle)[axis];
            along(a).total_cmp(&along(b)).then(a.triangle.cmp(&b.triangle))
        });
        let (half, next) = (members.len() / 2, self.ranges.len());
        for (range, patch) in [(0..half, patch), (half..members.len(), next)] {
            let mut total = 0.0;
            for member in &mut members[range] {
                total += mesh.normal_and_area(member.triangle as usize).1;
                member.cumulative_m2 = total;
                self.nodes[self.of_triangle[member.triangle as usize].0 as usize] = patch as u32;
            }
        }
        let middle = first + half as u32;
        let node = |at: u32| self.of_triangle[self.members[at as usize].triangle as usize].0;
        let (own, other) = (node(first), node(middle));
        self.ranges[patch] = (first, middle, own);
        self.ranges.push((middle, last, other));
        next
    }

    /// Patches that were split, in the order in which that repeats the division.
    pub fn splits(&self) -> &[u32] {
        &self.splits
    }

    /// Number of patches.
    pub fn len(&self) -> usize {
        self.ranges.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    /// Number of patch sides.
    pub fn sides(&self) -> usize {
        2 * self.ranges.len()
    }

    /// Side of the patch at a place of a triangle.
    pub fn side_at(&self, triangle: u32, barycentric: [f64; 2], front: bool) -> usize {
        let (first, divisions) = self.of_triangle[triangle as usize];
        let (part, mut local) =
            if divisions == 1 { (0, barycentric) } else { part_at(barycentric, divisions) };
        let mut node = self.nodes[(first + part) as usize];
        while node & SPLIT != 0 {
            let (part, inner) = part_at(local, 2);
            local = inner;
            node = self.nodes[((node & !SPLIT) + part) as usize];
        }
        2 * node as usize + usize::from(!front)
    }

    /// The other side of the same patch.
    pub fn opposite(side: usize) -> usize {
        side ^ 1
    }

    /// One triangle of a patch side (all share surface and material).
    pub fn triangle(&self, side: usize) -> u32 {
        self.members[self.ranges[side / 2].0 as usize].triangle
    }

    /// Area of a patch, m².
    pub fn area_m2(&self, side: usize) -> f64 {
        let (first, last, _) = self.ranges[side / 2];
        debug_assert!(last > first, "a patch has members");
        self.members[last as usize - 1].cumulative_m2
    }

    /// Area-weighted centre of a patch, m, and mean normal of its front (not normalised).
    pub fn centre(&self, side: usize) -> (DVec3, DVec3) {
        let (first, last, _) = self.ranges[side / 2];
        let (mut centre, mut facing, mut before) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for member in &self.members[first as usize..last as usize] {
            let area = member.cumulative_m2 - before;
            before = member.cumulative_m2;
            centre += member.at([1.0 / 3.0; 2]) * area;
            facing += member.normal * area;
        }
        (centre / before, facing / before)
    }

    /// Corners of the triangles, or of the part of one, that a patch consists of, m.
    pub fn outlines(&self, patch: usize) -> impl Iterator<Item = [DVec3; 3]> {
        let (first, last, _) = self.ranges[patch];
        let members = self.members[first as usize..last as usize].iter();
        members.map(|member| [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|corner| member.at(corner)))
    }

    /// Distance from `centre` to the farthest corner of a patch, m.
    pub fn radius_m(&self, side: usize, centre: DVec3) -> f64 {
        self.outlines(side / 2).flatten().map(|corner| corner.distance(centre)).fold(0.0, f64::max)
    }

    /// Places by which the evenness of a patch is judged: the centres of its quarters, or of up to
    /// `most` of the triangles that it joins, each with its share of the area.
    pub fn samples(&self, mesh: &Mesh, patch: usize, most: usize) -> Vec<(Place, f64)> {
        const CENTRE: [f64; 2] = [1.0 / 3.0; 2];
        let (first, last, _) = self.ranges[patch];
        let members = &self.members[first as usize..last as usize];
        let place = |triangle: u32, [s, t]: [f64; 2]| {
            let [a, b, c] = mesh.corners(triangle as usize);
            let normal = mesh.normal_and_area(triangle as usize).0;
            Place { point: a + (b - a) * s + (c - a) * t, normal }
        };
        if let [Member { triangle, part, .. }] = members {
            return (0..4)
                .map(|quarter| (place(*triangle, part.inner(quarter, 2).at(CENTRE)), 0.25))
                .collect();
        }
        let stride = members.len().div_ceil(most);
        let chosen = members.iter().step_by(stride);
        let area = |member: &Member| mesh.normal_and_area(member.triangle as usize).1;
        let total: f64 = chosen.clone().map(area).sum();
        chosen.map(|member| (place(member.triangle, CENTRE), area(member) / total)).collect()
    }

    /// A place on the patch, uniform in area.
    pub fn place(&self, side: usize, u: [f64; 3]) -> Place {
        let (first, last, _) = self.ranges[side / 2];
        let members = &self.members[first as usize..last as usize];
        let target = u[0] * members[members.len() - 1].cumulative_m2;
        let chosen = members.partition_point(|member| member.cumulative_m2 <= target).min(members.len() - 1);
        let root = u[1].sqrt();
        let place = members[chosen].at([root * (1.0 - u[2]), root * u[2]]);
        Place { point: place, normal: members[chosen].normal }
    }
}

/// Index of the part at weights (s, t) of the second and third corner, and the weights within it: strips
/// of constant s, in each strip upright and inverted parts alternate along t.
pub(super) fn part_at([s, t]: [f64; 2], divisions: u32) -> (u32, [f64; 2]) {
    let n = f64::from(divisions);
    let strip = ((s * n) as u32).min(divisions - 1);
    let cell = ((t * n) as u32).min(divisions - 1 - strip);
    let (u, v) = (s * n - f64::from(strip), t * n - f64::from(cell));
    let inverted = u + v > 1.0 && cell + strip + 1 < divisions;
    let local = if inverted { [1.0 - u, 1.0 - v] } else { [u, v] };
    (strip * (2 * divisions - strip) + 2 * cell + u32::from(inverted), local)
}

/// Weights in the triangle of the weights `local` in one part.
pub(super) fn within(part: u32, divisions: u32, local: [f64; 2]) -> [f64; 2] {
    let strip =
        (0..divisions).take_while(|&strip| strip * (2 * divisions - strip) <= part).last().unwrap_or(0);
    let rest = part - strip * (2 * divisions - strip);
    let (cell, inverted) = (rest / 2, rest % 2 == 1);
    let n = f64::from(divisions);
    let (s, t) = (f64::from(strip), f64::from(cell));
    if inverted {
        [(s + 1.0 - local[0]) / n, (t + 1.0 - local[1]) / n]
    } else {
        [(s + local[0]) / n, (t + local[1]) / n]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn places_lie_on_their_patch_and_parts_have_equal_area() {
        let mut mesh = Mesh::default();
        let wall = mesh.add_surface("wall", 0, false);
        mesh.add_quad([DVec3::ZERO, DVec3::X * 3.0, DVec3::new(3.0, 2.0, 0.0), DVec3::Y * 2.0], wall);
        let small = mesh.add_surface("small", 0, true);
        for shift in [0.0, 0.02, 0.9] {
            let o = DVec3::new(shift, 0.0, 1.0);
            mesh.add_quad(
                [o, o + DVec3::X * 0.01, o + DVec3::new(0.01, 0.01, 0.0), o + DVec3::Y * 0.01],
                small,
            );
        }
        let mut patches = Patches::new(&mesh, 0.05, |_| true);
        let total: f64 = (0..patches.len()).map(|patch| patches.area_m2(2 * patch)).sum();
        assert!((total - 6.0003).abs() < 1e-9, "{total}");
        assert_eq!(
            patches.side_at(2, [0.1, 0.1], true),
            patches.side_at(4, [0.1, 0.1], true),
            "near neighbours join"
        );
        assert_ne!(patches.side_at(2, [0.1, 0.1], true), patches.side_at(6, [0.1, 0.1], true));
        // Some are split, and some of their parts again.
        let before = patches.len();
        for patch in [0, 7, 3, 0, before + 1, before + 4] {
            assert!(patches.split(&mesh, patch).is_some());
        }
        assert_eq!((patches.len(), patches.splits().len()), (before + 18, 6));
        // Those that join triangles are divided among them, and then like others.
        let joined = patches.side_at(2, [0.1, 0.1], true) / 2;
        let parts = patches.split(&mesh, joined).expect("it joins four triangles");
        assert_eq!(parts, [joined, before + 18]);
        assert!(patches.split(&mesh, joined).is_some_and(|parts| parts.len() == 2));
        assert!(patches.split(&mesh, joined).is_some_and(|parts| parts.len() == 4));
        let total: f64 = (0..patches.len()).map(|patch| patches.area_m2(2 * patch)).sum();
        assert!((total - 6.0003).abs() < 1e-9, "{total}");
        for side in 0..patches.sides() {
            let share: f64 = patches.samples(&mesh, side / 2, 8).iter().map(|(_, share)| share).sum();
            assert!((share - 1.0).abs() < 1e-12, "{share}");
        }
        let mut rng = Rng::new(1, 1, 1);
        for side in 0..patches.sides() {
            for _ in 0..20 {
                let place = patches.place(side, rng.uniforms());
                // Find the triangle and weights again by brute force.
                let found = (0..mesh.triangles.len()).any(|index| {
                    let [a, b, c] = mesh.corners(index);
                    let (e, f, g) = (b - a, c - a, place.point - a);
                    let n = e.cross(f);
                    let (s, t) = (g.cross(f).dot(n) / n.dot(n), e.cross(g).dot(n) / n.dot(n));
                    let on = s >= -1e-12 && t >= -1e-12 && s + t <= 1.0 + 1e-12 && g.dot(n).abs() < 1e-12;
                    on && patches.side_at(index as u32, [s, t], side % 2 == 0) == side
                });
                assert!(found, "side {side}: {:?}", place.point);
            }
        }
    }
}
