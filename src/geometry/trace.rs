//! Ray tracer: closest hit and straight transmittance. The hierarchy is built by obvhs and
//! collapsed to eight-wide nodes; boxes are tested in padded f32 (they only ever cull too little),
//! triangles watertight in f64. So the nearest hit does not depend on SIMD level or visiting order.
//!
//! Watertight test: Woop, Benthin, Wald 2013 (JCGT 2(1)): edge functions of a shared edge are the
//! same numbers with opposite sign for both triangles, so no ray passes between them.
#![allow(clippy::inline_always, reason = "the traversal is compiled once per SIMD level, whole")]

use std::mem::MaybeUninit;

use glam::DVec3;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;

use super::mesh::Mesh;
use crate::material::{Bsdf, Material, Pane};

/// Where a ray met a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the (unit) direction, m.
    pub distance_m: f64,
    /// Triangle index in the mesh.
    pub triangle: u32,
    /// Barycentric weights of the triangle's second and third vertex.
    pub barycentric: [f64; 2],
    /// Whether the front side (counter-clockwise vertices) was met.
    pub front: bool,
}

/// Ray tracer over a mesh, in project coordinates.
pub struct Tracer {
    nodes: Vec<Node>,
    packs: Vec<Pack>,
    normals: Vec<DVec3>,
    surface_of: Vec<u32>,
    /// Per triangle: index into `panes`, or `OPAQUE`.
    pane_of: Vec<u32>,
    panes: Vec<Pane>,
    centre: DVec3,
    offset_m: f64,
    simd: bool,
    /// Largest number of stack entries a traversal can need.
    stack_need: usize,
}

impl std::fmt::Debug for Tracer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Tracer({} triangles, {} nodes)", self.normals.len(), self.nodes.len())
    }
}

const OPAQUE: u32 = u32::MAX;
/// Barycentric weight below which a pane counts as met on an edge: far above rounding, far below size.
const ON_EDGE: f64 = 1e-12;
const WIDTH: usize = 8;
const LANES: usize = 4;
const EMPTY: u32 = u32::MAX;
const LEAF: u32 = 1 << 31;
/// Stack sizes of the traversal: for ordinary trees, and for pathologically deep ones.
const SHALLOW: usize = 88;
const DEEP: usize = 4096;

/// Eight children: boxes by axis, and what they are (node index, `LEAF | pack index`, or `EMPTY`).
#[derive(Clone)]
#[repr(align(64))]
struct Node {
    lo: [[f32; WIDTH]; 3],
    hi: [[f32; WIDTH]; 3],
    child: [u32; WIDTH],
}

/// Four triangles: `corner[vertex][axis][lane]`; unused lanes have id `EMPTY`.
#[derive(Clone)]
#[repr(align(32))]
struct Pack {
    corner: [[[f64; LANES]; 3]; 3],
    id: [u32; LANES],
}

/// A ray prepared for Woop's test and for the slab test.
struct Prepared {
    origin: [f64; 3],
    shear: [f64; 3],
    axes: [usize; 3],
    origin32: [f32; 3],
    inverse32: [f32; 3],
}

/// The SIMD instruction level that the traversal may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Simd {
    /// AVX2 where the machine has it.
    #[default]
    Detect,
    /// The baseline of the build only (results are the same; a test compares them).
    Off,
}

impl Tracer {
    /// Builds the hierarchy. The mesh must be finite and its indices valid (see `Scene::new`).
    pub fn build(mesh: &Mesh, materials: &[Material]) -> Self {
        Self::build_with(mesh, materials, Simd::Detect)
    }

    /// [`Tracer::build`] with an explicit SIMD level.
    pub fn build_with(mesh: &Mesh, materials: &[Material], simd: Simd) -> Self {
        let (lo, hi) = mesh.bounds().unwrap_or((DVec3::ZERO, DVec3::ONE));
        let centre = 0.5 * (lo + hi);
        let size_m = (hi - lo).length().max(1e-6);
        let pad = (size_m * 1e-5) as f32;
        let boxes: Vec<Aabb> = (0..mesh.triangles.len())
            .map(|index| {
                let corners = mesh.corners(index).map(|p| (p - centre).as_vec3a());
                let mut aabb = Aabb::from_points(&corners);
                aabb.min -= glam::Vec3A::splat(pad);
                aabb.max += glam::Vec3A::splat(pad);
                aabb
            })
            .collect();
        let params =
            if boxes.len() < 100_000 { BvhBuildParams::slow_build() } else { BvhBuildParams::medium_build() };
        let params = BvhBuildParams { max_prims_per_leaf: LANES as u32, pre_split: false, ..params };
        let bvh = build_bvh2(&boxes, params, &mut std::time::Duration::default());

        let mut panes: Vec<Pane> = Vec::new();
        let pane_of_material: Vec<u32> = materials
            .iter()
            .map(|material| match material.bsdf {
                Bsdf::Glass(pane) => {
                    panes.push(pane);
                    (panes.len() - 1) as u32
                }
                _ => OPAQUE,
            })
            .collect();
        let mut tracer = Self {
            nodes: Vec::new(),
            packs: Vec::new(),
            normals: (0..mesh.triangles.len()).map(|index| mesh.normal_and_area(index).0).collect(),
            surface_of: mesh.triangles.iter().map(|t| t.surface).collect(),
            pane_of: mesh
                .triangles
                .iter()
                .map(|t| pane_of_material[mesh.surfaces[t.surface as usize].material])
                .collect(),
            panes,
            centre,
            offset_m: size_m * 1e-9,
            simd: simd == Simd::Detect && avx2(),
            stack_need: 0,
        };
        let depth = tracer.collapse(&bvh, mesh);
        tracer.stack_need = (WIDTH - 1) * depth + WIDTH;
        assert!(tracer.stack_need <= DEEP, "obvhs keeps its trees below a depth of a few hundred");
        tracer
    }

    /// Unit normal of the front side of a triangle.
    pub fn normal(&self, triangle: u32) -> DVec3 {
        self.normals[triangle as usize]
    }

    /// Surface of a triangle.
    pub fn surface(&self, triangle: u32) -> u32 {
        self.surface_of[triangle as usize]
    }

    /// How far a ray's origin is lifted off a surface along its normal, m: 1e-9 of the scene's size.
    pub fn offset_m(&self) -> f64 {
        self.offset_m
    }

    /// The nearest triangle along `direction` (unit), surfaces in `blind` left out.
    pub fn closest(&self, origin: DVec3, direction: DVec3, blind: &[u32]) -> Option<Hit> {
        let ray = self.prepare(origin, direction);
        #[cfg(target_arch = "x86_64")]
        if self.simd {
            // SAFETY: `simd` is set only where AVX2 was detected.
            return unsafe { self.closest_avx2(&ray, direction, blind) };
        }
        self.closest_body(&ray, direction, blind)
    }

    /// Share of light that passes straight from `origin` along `direction` over `distance_m`:
    /// 0 behind anything opaque, the product of pane transmittances otherwise.
    pub fn transmittance(&self, origin: DVec3, direction: DVec3, distance_m: f64, blind: &[u32]) -> f64 {
        let ray = self.prepare(origin, direction);
        #[cfg(target_arch = "x86_64")]
        if self.simd {
            // SAFETY: `simd` is set only where AVX2 was detected.
            return unsafe { self.transmittance_avx2(&ray, direction, distance_m, blind) };
        }
        self.transmittance_body(&ray, direction, distance_m, blind)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    unsafe fn closest_avx2(&self, ray: &Prepared, direction: DVec3, blind: &[u32]) -> Option<Hit> {
        self.closest_body(ray, direction, blind)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    unsafe fn transmittance_avx2(
        &self,
        ray: &Prepared,
        direction: DVec3,
        distance_m: f64,
        blind: &[u32],
    ) -> f64 {
        self.transmittance_body(ray, direction, distance_m, blind)
    }

    #[inline(always)]
    fn closest_body(&self, ray: &Prepared, direction: DVec3, blind: &[u32]) -> Option<Hit> {
        let mut nearest = Nearest { tracer: self, blind, reach: f64::INFINITY, found: None };
        self.traverse(ray, &mut nearest);
        nearest.found.map(|(triangle, barycentric)| Hit {
            distance_m: nearest.reach,
            triangle,
            barycentric,
            front: self.normals[triangle as usize].dot(direction) < 0.0,
        })
    }

    #[inline(always)]
    fn transmittance_body(&self, ray: &Prepared, direction: DVec3, distance_m: f64, blind: &[u32]) -> f64 {
        let mut passing =
            Passing { tracer: self, blind, reach: distance_m, direction, passed: 1.0, edges: Vec::new() };
        self.traverse(ray, &mut passing);
        passing.passed
    }

    /// Visits packs whose boxes the ray meets within the visitor's reach, nearest first, until the
    /// visitor has seen enough.
    #[inline(always)]
    fn traverse(&self, ray: &Prepared, visitor: &mut impl Visitor) {
        if self.stack_need <= SHALLOW {
            self.traverse_with::<SHALLOW>(ray, visitor);
        } else {
            self.traverse_with::<DEEP>(ray, visitor);
        }
    }

    #[inline(always)]
    fn traverse_with<const STACK: usize>(&self, ray: &Prepared, visitor: &mut impl Visitor) {
        // Not initialised: clearing it would cost as much as a short traversal.
        let mut stack = [const { MaybeUninit::<(u32, f32)>::uninit() }; STACK];
        let mut depth = 0;
        let mut current = 0u32;
        loop {
            if current & LEAF != 0 {
                if visitor.visit(&self.packs[(current & !LEAF) as usize], ray) {
                    return;
                }
            } else {
                let node = &self.nodes[current as usize];
                let limit = (visitor.reach() * 1.000_001) as f32;
                let (near, met) = slabs(node, ray, limit);
                let first = depth;
                for lane in 0..WIDTH {
                    if met[lane] && node.child[lane] != EMPTY {
                        let mut place = depth;
                        while place > first {
                            // SAFETY: entries below `depth` were written by this loop.
                            let below = unsafe { stack[place - 1].assume_init() };
                            if !(below.1 < near[lane]) {
                                break;
                            }
                            stack[place].write(below);
                            place -= 1;
                        }
                        stack[place].write((node.child[lane], near[lane]));
                        depth += 1;
                    }
                }
            }
            loop {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                // SAFETY: entries below the former `depth` were written above.
                let (next, near) = unsafe { stack[depth].assume_init() };
                if f64::from(near) <= visitor.reach() * 1.000_001 {
                    current = next;
                    break;
                }
            }
        }
    }

    fn prepare(&self, origin: DVec3, direction: DVec3) -> Prepared {
        let d = direction.to_array();
        let z = if d[0].abs() > d[1].abs() {
            if d[0].abs() > d[2].abs() { 0 } else { 2 }
        } else if d[1].abs() > d[2].abs() {
            1
        } else {
            2
        };
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let o = origin.to_array();
        let local = (origin - self.centre).as_vec3();
        let inverse = |d: f64| {
            let d = d as f32;
            1.0 / if d.abs() < 1e-20 { 1e-20f32.copysign(d) } else { d }
        };
        Prepared {
            origin: [o[x], o[y], o[z]],
            shear: [d[x] / d[z], d[y] / d[z], 1.0 / d[z]],
            axes: [x, y, z],
            origin32: local.to_array(),
            inverse32: d.map(inverse),
        }
    }

    /// Collapses the binary tree to eight-wide nodes, opening the largest child first.
    /// Returns the depth of the wide tree.
    fn collapse(&mut self, bvh: &Bvh2, mesh: &Mesh) -> usize {
        let mut deepest = 1;
        self.nodes.push(Node::EMPTY);
        let mut work = vec![(0usize, 0usize, 1usize)];
        while let Some((target, source, depth)) = work.pop() {
            deepest = deepest.max(depth);
            let mut children = vec![source];
            loop {
                let open = children
                    .iter()
                    .enumerate()
                    .filter(|&(_, &c)| bvh.nodes[c].prim_count == 0)
                    .max_by(|a, b| {
                        let area = |c: usize| bvh.nodes[c].aabb.half_area();
                        area(*a.1).total_cmp(&area(*b.1))
                    })
                    .map(|(place, _)| place);
                match open {
                    Some(place) if children.len() < WIDTH => {
                        let first = bvh.nodes[children.swap_remove(place)].first_index as usize;
                        children.extend([first, first + 1]);
                    }
                    _ => break,
                }
            }
            for (lane, &child) in children.iter().enumerate() {
                let source = &bvh.nodes[child];
                for axis in 0..3 {
                    self.nodes[target].lo[axis][lane] = source.aabb.min[axis];
                    self.nodes[target].hi[axis][lane] = source.aabb.max[axis];
                }
                self.nodes[target].child[lane] = if source.prim_count == 0 {
                    self.nodes.push(Node::EMPTY);
                    let index = self.nodes.len() - 1;
                    work.push((index, child, depth + 1));
                    index as u32
                } else {
                    let first = source.first_index as usize;
                    let members = &bvh.primitive_indices[first..first + source.prim_count as usize];
                    self.packs.push(Pack::new(mesh, members));
                    LEAF | (self.packs.len() - 1) as u32
                };
            }
        }
        deepest
    }
}

/// What a traversal does at a leaf.
trait Visitor {
    /// Distance beyond which nothing matters.
    fn reach(&self) -> f64;
    /// Takes in four triangles; true ends the traversal.
    fn visit(&mut self, pack: &Pack, ray: &Prepared) -> bool;
}

/// Looks for the nearest hit; among equal distances the smallest index, whatever the order of visits.
struct Nearest<'a> {
    tracer: &'a Tracer,
    blind: &'a [u32],
    reach: f64,
    found: Option<(u32, [f64; 2])>,
}

impl Visitor for Nearest<'_> {
    #[inline(always)]
    fn reach(&self) -> f64 {
        self.reach
    }

    #[inline(always)]
    fn visit(&mut self, pack: &Pack, ray: &Prepared) -> bool {
        let (distance, u, v, hit) = meet(pack, ray);
        for lane in 0..LANES {
            if hit[lane] && distance[lane] <= self.reach {
                let (t, id) = (distance[lane], pack.id[lane]);
                let nearer = t < self.reach || self.found.is_none_or(|(known, _)| id < known);
                if nearer && !is_blind(self.blind, self.tracer, id) {
                    self.reach = t;
                    self.found = Some((id, [u[lane], v[lane]]));
                }
            }
        }
        false
    }
}

/// Multiplies the transmittances of panes on the way; anything opaque ends it. A ray through a common
/// edge meets both triangles of one pane: it counts once.
struct Passing<'a> {
    tracer: &'a Tracer,
    blind: &'a [u32],
    reach: f64,
    direction: DVec3,
    passed: f64,
    /// Distances at which panes were met exactly on an edge; hardly ever any.
    edges: Vec<f64>,
}

impl Visitor for Passing<'_> {
    #[inline(always)]
    fn reach(&self) -> f64 {
        self.reach
    }

    #[inline(always)]
    fn visit(&mut self, pack: &Pack, ray: &Prepared) -> bool {
        let (distance, second, third, hit) = meet(pack, ray);
        for lane in 0..LANES {
            if hit[lane] && distance[lane] < self.reach {
                let id = pack.id[lane];
                if is_blind(self.blind, self.tracer, id) {
                    continue;
                }
                let pane = self.tracer.pane_of[id as usize];
                if pane == OPAQUE {
                    self.passed = 0.0;
                    return true;
                }
                let first = 1.0 - second[lane] - third[lane];
                if first.min(second[lane]).min(third[lane]) < ON_EDGE && self.met_before(distance[lane]) {
                    continue;
                }
                let cos = self.tracer.normals[id as usize].dot(self.direction).abs();
                self.passed *= self.tracer.panes[pane as usize].transmittance(cos);
            }
        }
        false
    }
}

impl Passing<'_> {
    /// Whether a pane was met at this distance before, by the triangle on the other side of an edge.
    #[cold]
    fn met_before(&mut self, distance_m: f64) -> bool {
        let met = self.edges.iter().any(|known| (known - distance_m).abs() <= self.tracer.offset_m);
        if !met {
            self.edges.push(distance_m);
        }
        met
    }
}

#[inline(always)]
fn is_blind(blind: &[u32], tracer: &Tracer, triangle: u32) -> bool {
    !blind.is_empty() && blind.contains(&tracer.surface_of[triangle as usize])
}

impl Node {
    const EMPTY: Self =
        Self { lo: [[f32::INFINITY; WIDTH]; 3], hi: [[f32::NEG_INFINITY; WIDTH]; 3], child: [EMPTY; WIDTH] };
}

impl Pack {
    fn new(mesh: &Mesh, members: &[u32]) -> Self {
        assert!(members.len() <= LANES, "obvhs was asked for at most {LANES} triangles a leaf");
        let mut pack = Self { corner: [[[0.0; LANES]; 3]; 3], id: [EMPTY; LANES] };
        for (lane, &id) in members.iter().enumerate() {
            pack.id[lane] = id;
            for (vertex, corner) in mesh.corners(id as usize).iter().enumerate() {
                for axis in 0..3 {
                    pack.corner[vertex][axis][lane] = corner[axis];
                }
            }
        }
        pack
    }
}

/// Entry distances of the eight boxes and whether each is met before `limit`.
#[inline(always)]
fn slabs(node: &Node, ray: &Prepared, limit: f32) -> ([f32; WIDTH], [bool; WIDTH]) {
    let mut near = [0f32; WIDTH];
    let mut far = [limit; WIDTH];
    for axis in 0..3 {
        let (o, inverse) = (ray.origin32[axis], ray.inverse32[axis]);
        let (lo, hi) =
            if inverse >= 0.0 { (&node.lo[axis], &node.hi[axis]) } else { (&node.hi[axis], &node.lo[axis]) };
        for lane in 0..WIDTH {
            let enter = (lo[lane] - o) * inverse;
            let leave = (hi[lane] - o) * inverse;
            near[lane] = if enter > near[lane] { enter } else { near[lane] };
            far[lane] = if leave < far[lane] { leave } else { far[lane] };
        }
    }
    let mut met = [false; WIDTH];
    for lane in 0..WIDTH {
        met[lane] = near[lane] <= far[lane];
    }
    (near, met)
}

/// Woop's test on four triangles: distance, weights of the second and third vertex, and hit or not.
#[inline(always)]
fn meet(pack: &Pack, ray: &Prepared) -> ([f64; LANES], [f64; LANES], [f64; LANES], [bool; LANES]) {
    let [kx, ky, kz] = ray.axes;
    let [sx, sy, sz] = ray.shear;
    let mut x = [[0.0; LANES]; 3];
    let mut y = [[0.0; LANES]; 3];
    let mut z = [[0.0; LANES]; 3];
    for vertex in 0..3 {
        let corner = &pack.corner[vertex];
        let (cx, cy, cz) = (&corner[kx], &corner[ky], &corner[kz]);
        for lane in 0..LANES {
            let depth = cz[lane] - ray.origin[2];
            x[vertex][lane] = (cx[lane] - ray.origin[0]) - sx * depth;
            y[vertex][lane] = (cy[lane] - ray.origin[1]) - sy * depth;
            z[vertex][lane] = sz * depth;
        }
    }
    let mut distance = [0.0; LANES];
    let mut second = [0.0; LANES];
    let mut third = [0.0; LANES];
    let mut hit = [false; LANES];
    for lane in 0..LANES {
        let (ax, bx, cx) = (x[0][lane], x[1][lane], x[2][lane]);
        let (ay, by, cy) = (y[0][lane], y[1][lane], y[2][lane]);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        let determinant = u + v + w;
        let inverse = 1.0 / determinant;
        let t = (u * z[0][lane] + v * z[1][lane] + w * z[2][lane]) * inverse;
        let inside = ((u >= 0.0) & (v >= 0.0) & (w >= 0.0)) | ((u <= 0.0) & (v <= 0.0) & (w <= 0.0));
        distance[lane] = t;
        second[lane] = v * inverse;
        third[lane] = w * inverse;
        hit[lane] = inside & (determinant != 0.0) & (t > 0.0) & (pack.id[lane] != EMPTY);
    }
    (distance, second, third, hit)
}

#[cfg(target_arch = "x86_64")]
fn avx2() -> bool {
    std::arch::is_x86_feature_detected!("avx2")
}

#[cfg(not(target_arch = "x86_64"))]
fn avx2() -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lambert() -> Vec<Material> {
        vec![Material { name: "grey".into(), bsdf: Bsdf::Lambert { reflectance: 0.5 } }]
    }

    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*state >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A closed box with `cells`² quads a wall, turned about an odd axis and shifted by `shift`.
    fn closed_box(cells: usize, shift: DVec3) -> (Mesh, DVec3) {
        let turn = glam::DMat3::from_axis_angle(DVec3::new(0.3, -0.5, 0.8).normalize(), 0.7);
        let mut mesh = Mesh::default();
        let surface = mesh.add_surface("box", 0, false);
        let n = cells as u32 + 1;
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0.0), (axis, 1.0)]) {
            let first = mesh.positions.len() as u32;
            for i in 0..n {
                for j in 0..n {
                    let mut p = [0.0; 3];
                    p[axis] = side;
                    p[(axis + 1) % 3] = f64::from(i) / cells as f64;
                    p[(axis + 2) % 3] = f64::from(j) / cells as f64;
                    mesh.positions.push(turn * DVec3::from_array(p) + shift);
                }
            }
            for i in 0..cells as u32 {
                for j in 0..cells as u32 {
                    let a = first + i * n + j;
                    for vertices in [[a, a + n, a + n + 1], [a, a + n + 1, a + 1]] {
                        mesh.triangles.push(super::super::mesh::Triangle { vertices, surface });
                    }
                }
            }
        }
        (mesh, turn * DVec3::splat(0.5) + shift)
    }

    #[test]
    fn no_ray_leaves_a_closed_box_even_along_edges_and_far_from_the_origin() {
        for shift in [DVec3::ZERO, DVec3::new(1000.0, -2000.0, 30.0)] {
            let (mesh, centre) = closed_box(7, shift);
            let tracer = Tracer::build(&mesh, &lambert());
            let mut state = 1;
            let mut missed = 0;
            for index in 0..mesh.triangles.len() {
                let [a, b, c] = mesh.corners(index);
                for (p, q) in [(a, b), (b, c), (c, a), (a, a)] {
                    for _ in 0..20 {
                        let target = p.lerp(q, random(&mut state));
                        missed +=
                            i32::from(tracer.closest(centre, (target - centre).normalize(), &[]).is_none());
                    }
                }
            }
            assert_eq!(missed, 0, "rays aimed at edges and vertices must not leak, shift {shift}");
        }
    }

    #[test]
    fn a_lifted_origin_neither_hits_its_own_surface_nor_leaves() {
        let (mesh, _) = closed_box(3, DVec3::new(1e3, 1e3, 0.0));
        let tracer = Tracer::build(&mesh, &lambert());
        let mut state = 7;
        let centre = mesh.positions.iter().sum::<DVec3>() / mesh.positions.len() as f64;
        for index in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(index);
            for _ in 0..200 {
                let (u, v) = (random(&mut state), random(&mut state));
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let inward =
                    tracer.normal(index as u32) * (centre - a).dot(tracer.normal(index as u32)).signum();
                let origin = a + (b - a) * u + (c - a) * v + inward * tracer.offset_m();
                let direction =
                    DVec3::new(random(&mut state) - 0.5, random(&mut state) - 0.5, random(&mut state) - 0.5)
                        .normalize();
                let direction = direction * direction.dot(inward).signum();
                let hit = tracer.closest(origin, direction, &[]).expect("a closed box");
                assert_ne!(hit.triangle as usize, index);
            }
        }
    }

    #[test]
    fn simd_level_and_visiting_order_do_not_change_any_hit() {
        let mut mesh = Mesh::default();
        let surface = mesh.add_surface("soup", 0, false);
        let mut state = 3;
        let mut point = || DVec3::new(random(&mut state), random(&mut state), random(&mut state));
        for _ in 0..3000 {
            let corner = point();
            let first = mesh.positions.len() as u32;
            mesh.positions.extend([corner, corner + 0.1 * point(), corner + 0.1 * point()]);
            mesh.triangles
                .push(super::super::mesh::Triangle { vertices: [first, first + 1, first + 2], surface });
        }
        let fast = Tracer::build_with(&mesh, &lambert(), Simd::Detect);
        let plain = Tracer::build_with(&mesh, &lambert(), Simd::Off);
        for _ in 0..5000 {
            let (origin, aim) = (point(), point());
            let direction = (aim - origin).normalize();
            let hit = fast.closest(origin, direction, &[]);
            assert_eq!(hit, plain.closest(origin, direction, &[]));
            // Brute force over all triangles: the hierarchy must not lose a hit.
            let ray = fast.prepare(origin, direction);
            let nearest = (0..3000u32)
                .filter_map(|id| {
                    let (t, _, _, ok) = meet(&Pack::new(&mesh, &[id]), &ray);
                    ok[0].then_some(t[0])
                })
                .fold(f64::INFINITY, f64::min);
            assert_eq!(hit.map_or(f64::INFINITY, |h| h.distance_m).to_bits(), nearest.to_bits());
            let open = fast.transmittance(origin, direction, 0.5, &[]);
            assert_eq!(open.to_bits(), plain.transmittance(origin, direction, 0.5, &[]).to_bits());
            assert_eq!(open < 0.5, nearest < 0.5);
        }
    }
}
