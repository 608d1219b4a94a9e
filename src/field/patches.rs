//! Patches: large triangles are divided, small ones of one surface that lie near each other and
//! face alike are joined. Every patch has two sides: `2·patch` in front, `2·patch + 1` behind.

use std::collections::BTreeMap;

use glam::DVec3;

use super::Place;
use crate::geometry::mesh::Mesh;
use crate::scene::Scene;

/// A division of the mesh.
#[derive(Clone, Debug)]
pub struct Patches {
    /// Per triangle: first patch, and number of divisions of each edge.
    of_triangle: Vec<(u32, u32)>,
    /// Per patch: range in `members`.
    ranges: Vec<(u32, u32)>,
    /// Triangle, index of the part within it, cumulative area within the patch, m².
    members: Vec<(u32, u32, f64)>,
}

impl Patches {
    /// Divides so that a patch has about `area_m2`; triangles for which `keep` is false (specular
    /// ones) get no patch of their own and must not be looked up.
    pub fn new(mesh: &Mesh, area_m2: f64, keep: impl Fn(usize) -> bool) -> Self {
        let mut of_triangle = vec![(u32::MAX, 1); mesh.triangles.len()];
        let mut ranges = Vec::new();
        let mut members = Vec::new();
        let mut joined: BTreeMap<(u32, [i64; 3], [i8; 3]), Vec<usize>> = BTreeMap::new();
        let cell_m = area_m2.sqrt();
        for index in (0..mesh.triangles.len()).filter(|&index| keep(index)) {
            let (normal, area) = mesh.normal_and_area(index);
            if area > 0.5 * area_m2 {
                let divisions = (area / area_m2).sqrt().ceil().max(1.0) as u32;
                of_triangle[index] = (ranges.len() as u32, divisions);
                for part in 0..divisions * divisions {
                    members.push((index as u32, part, area / f64::from(divisions * divisions)));
                    ranges.push((members.len() as u32 - 1, members.len() as u32));
                }
            } else {
                let centre = mesh.corners(index).iter().sum::<glam::DVec3>() / 3.0;
                let cell = (centre / cell_m).to_array().map(|x| x.floor() as i64);
                let facing = normal.to_array().map(|x| (x * 1.4).round() as i8);
                joined.entry((mesh.triangles[index].surface, cell, facing)).or_default().push(index);
            }
        }
        for group in joined.values() {
            let first = members.len() as u32;
            let mut total = 0.0;
            for &index in group {
                of_triangle[index] = (ranges.len() as u32, 1);
                total += mesh.normal_and_area(index).1;
                members.push((index as u32, 0, total));
            }
            ranges.push((first, members.len() as u32));
        }
        Self { of_triangle, ranges, members }
    }

    /// Divides the surfaces of a scene that have a diffuse part.
    pub fn of_scene(scene: &Scene, area_m2: f64) -> Self {
        Self::new(&scene.mesh, area_m2, |triangle| scene.bsdf(triangle as u32).specular(1.0).is_none())
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
        let part = if divisions == 1 { 0 } else { part_at(barycentric, divisions) };
        2 * (first + part) as usize + usize::from(!front)
    }

    /// The other side of the same patch.
    pub fn opposite(side: usize) -> usize {
        side ^ 1
    }

    /// One triangle of a patch side (all share surface and material).
    pub fn triangle(&self, side: usize) -> u32 {
        self.members[self.ranges[side / 2].0 as usize].0
    }

    /// Area of a patch, m².
    pub fn area_m2(&self, side: usize) -> f64 {
        let (first, last) = self.ranges[side / 2];
        debug_assert!(last > first, "a patch has members");
        self.members[last as usize - 1].2
    }

    /// Area-weighted centre of a patch, m, and mean normal of its front (not normalised).
    pub fn centre(&self, mesh: &Mesh, side: usize) -> (DVec3, DVec3) {
        let (first, last) = self.ranges[side / 2];
        let (mut centre, mut facing, mut before) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for &(triangle, part, cumulative) in &self.members[first as usize..last as usize] {
            let [a, b, c] = mesh.corners(triangle as usize);
            let divisions = self.of_triangle[triangle as usize].1;
            let [s, t] = within(part, divisions, [1.0 / 3.0; 2]);
            let area = cumulative - before;
            before = cumulative;
            centre += (a + (b - a) * s + (c - a) * t) * area;
            facing += mesh.normal_and_area(triangle as usize).0 * area;
        }
        (centre / before, facing / before)
    }

    /// A place on the patch, uniform in area.
    pub fn place(&self, mesh: &Mesh, side: usize, u: [f64; 3]) -> Place {
        let (first, last) = self.ranges[side / 2];
        let members = &self.members[first as usize..last as usize];
        let target = u[0] * members[members.len() - 1].2;
        let chosen = members.partition_point(|member| member.2 <= target).min(members.len() - 1);
        let (triangle, part, _) = members[chosen];
        let [a, b, c] = mesh.corners(triangle as usize);
        let divisions = self.of_triangle[triangle as usize].1;
        let root = u[1].sqrt();
        let local = [root * (1.0 - u[2]), root * u[2]];
        let [s, t] = if divisions == 1 { local } else { within(part, divisions, local) };
        Place { point: a + (b - a) * s + (c - a) * t, normal: mesh.normal_and_area(triangle as usize).0 }
    }
}

/// Index of the part at weights (s, t) of the second and third corner: strips of constant s, in
/// each strip upright and inverted parts alternate along t.
fn part_at([s, t]: [f64; 2], divisions: u32) -> u32 {
    let n = f64::from(divisions);
    let strip = ((s * n) as u32).min(divisions - 1);
    let cell = ((t * n) as u32).min(divisions - 1 - strip);
    let inverted =
        (s * n - f64::from(strip)) + (t * n - f64::from(cell)) > 1.0 && cell + strip + 1 < divisions;
    strip * (2 * divisions - strip) + 2 * cell + u32::from(inverted)
}

/// Weights in the triangle of the weights `local` in one part.
fn within(part: u32, divisions: u32, local: [f64; 2]) -> [f64; 2] {
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
        let patches = Patches::new(&mesh, 0.05, |_| true);
        let total: f64 = (0..patches.len()).map(|patch| patches.area_m2(2 * patch)).sum();
        assert!((total - 6.0003).abs() < 1e-9, "{total}");
        assert_eq!(
            patches.side_at(2, [0.1, 0.1], true),
            patches.side_at(4, [0.1, 0.1], true),
            "near neighbours join"
        );
        assert_ne!(patches.side_at(2, [0.1, 0.1], true), patches.side_at(6, [0.1, 0.1], true));
        let mut rng = Rng::new(1, 1, 1);
        for side in 0..patches.sides() {
            for _ in 0..20 {
                let place = patches.place(&mesh, side, rng.uniforms());
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
