//! Ray tracer: closest hit and straight transmittance. The hierarchy is built by obvhs and
//! collapsed to eight-wide nodes; boxes are tested in padded f32 (they only ever cull too little),
//! triangles watertight in f64. So the nearest hit does not depend on SIMD level or visiting order.
//!
//! Watertight test: Woop, Benthin, Wald 2013 (JCGT 2(1)): edge functions of a shared edge are the
//! same numbers with opposite sign for both triangles, so no ray passes between them.
#![allow(clippy::inline_always, reason = "the traversal is compiled once per SIMD level, whole")]

mod shaft;
mod wide;

use std::mem::MaybeUninit;

use glam::DVec3;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;

pub use self::wide::Course;
use self::wide::{EMPTY, LANES, LEAF, Node, Pack, Prepared, WIDTH, collapse, meet, prepare, slabs};
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

/// How far rays are lifted off surfaces, as a share of the scene's size.
const LIFT: f64 = 1e-9;
const OPAQUE: u32 = u32::MAX;
/// Barycentric weight below which a pane counts as met on an edge: far above rounding, far below size.
const ON_EDGE: f64 = 1e-12;
/// Stack sizes of the traversal: for ordinary trees, and for pathologically deep ones.
const SHALLOW: usize = 88;
const DEEP: usize = 4096;

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
        let wide = collapse(&bvh, mesh);
        let stack_need = (WIDTH - 1) * wide.deepest + WIDTH;
        assert!(stack_need <= DEEP, "obvhs keeps its trees below a depth of a few hundred");
        Self {
            nodes: wide.nodes,
            packs: wide.packs,
            normals: (0..mesh.triangles.len()).map(|index| mesh.normal_and_area(index).0).collect(),
            surface_of: mesh.triangles.iter().map(|t| t.surface).collect(),
            pane_of: mesh
                .triangles
                .iter()
                .map(|t| pane_of_material[mesh.surfaces[t.surface as usize].material])
                .collect(),
            panes,
            centre,
            offset_m: size_m * LIFT,
            simd: simd == Simd::Detect && avx2(),
            stack_need,
        }
    }

    /// Unit normal of the front side of a triangle.
    pub fn normal(&self, triangle: u32) -> DVec3 {
        self.normals[triangle as usize]
    }

    /// Surface of a triangle.
    pub fn surface(&self, triangle: u32) -> u32 {
        self.surface_of[triangle as usize]
    }

    /// Diagonal of the scene's box, m.
    pub fn size_m(&self) -> f64 {
        self.offset_m / LIFT
    }

    /// How far a ray's origin is lifted off a surface along its normal, m: 1e-9 of the scene's size.
    pub fn offset_m(&self) -> f64 {
        self.offset_m
    }

    /// The nearest triangle along `direction` (unit), surfaces in `blind` left out.
    pub fn closest(&self, origin: DVec3, direction: DVec3, blind: &[u32]) -> Option<Hit> {
        self.closest_on(origin, &Course::new(direction), blind)
    }

    /// [`Tracer::closest`] of one of many rays along a direction.
    #[inline]
    pub fn closest_on(&self, origin: DVec3, course: &Course, blind: &[u32]) -> Option<Hit> {
        let (ray, direction) = (course.from(origin, self.centre), course.direction);
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
        let ray = prepare(origin, self.centre, direction);
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

#[cfg(target_arch = "x86_64")]
fn avx2() -> bool {
    std::arch::is_x86_feature_detected!("avx2")
}

#[cfg(not(target_arch = "x86_64"))]
fn avx2() -> bool {
    false
}

#[cfg(test)]
mod tests;
