//! Whether anything may stand between two groups of points: one descent of the hierarchy instead of a ray
//! for each pair. A *yes, clear* is certain; everything in doubt is *no*.
//!
//! The shaft between two boxes is bounded by planes along two axes at a time (Haines & Wallace 1991); what
//! lies outside of one of them cannot stand in between.

use glam::DVec3;

use super::wide::{EMPTY, LANES, LEAF, Node, Pack, WIDTH};
use super::{Tracer, is_blind};

/// All of the shaft has normal · x ≤ limit.
#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    limit: f64,
    /// The same about the tracer's centre.
    normal32: [f32; 3],
    limit32: f32,
}

const MOST: usize = 20;

/// The box of some points.
#[derive(Clone, Copy)]
struct Bounds {
    lo: DVec3,
    hi: DVec3,
}

impl Bounds {
    fn of(points: &[DVec3]) -> Option<Self> {
        let first = *points.first()?;
        let grow = |b: Self, p: &DVec3| Self { lo: b.lo.min(*p), hi: b.hi.max(*p) };
        Some(points.iter().fold(Self { lo: first, hi: first }, grow))
    }

    /// Largest normal · x.
    fn most(&self, normal: DVec3) -> f64 {
        0.5 * (normal.dot(self.lo + self.hi) + normal.abs().dot(self.hi - self.lo))
    }
}

impl Tracer {
    /// Whether every line from one of `from` to one of `to` is free of triangles, surfaces in `blind` left
    /// out. `facing` are normals of surfaces on which `from` or `to` lies, towards the other.
    pub fn is_clear(&self, from: &[DVec3], to: &[DVec3], facing: &[DVec3], blind: &[u32]) -> bool {
        let (Some(a), Some(b)) = (Bounds::of(from), Bounds::of(to)) else { return true };
        let mut planes = Vec::with_capacity(MOST);
        let mut add = |normal: DVec3, limit: f64| {
            planes.push(Plane {
                normal,
                limit,
                normal32: normal.as_vec3().to_array(),
                limit32: (limit - normal.dot(self.centre)) as f32,
            });
        };
        for &normal in facing {
            let least = from.iter().chain(to).map(|p| normal.dot(*p)).fold(f64::INFINITY, f64::min);
            add(-normal, -least);
        }
        for normal in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z] {
            add(normal, a.most(normal).max(b.most(normal)));
        }
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            for (si, sj) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                let outer = |bounds: &Bounds, axis: usize, sign: f64| {
                    if sign > 0.0 { bounds.hi[axis] } else { bounds.lo[axis] }
                };
                let along = [outer(&b, i, si) - outer(&a, i, si), outer(&b, j, sj) - outer(&a, j, sj)];
                let mut normal = DVec3::ZERO;
                (normal[i], normal[j]) = (along[1], -along[0]);
                let Some(normal) = normal.try_normalize() else { continue };
                let normal = if normal[i] * si + normal[j] * sj < 0.0 { -normal } else { normal };
                add(normal, a.most(normal).max(b.most(normal)));
            }
        }
        let mut stack = vec![0u32];
        while let Some(next) = stack.pop() {
            if next & LEAF != 0 {
                if self.in_shaft(&self.packs[(next & !LEAF) as usize], &planes, blind) {
                    return false;
                }
                continue;
            }
            let node = &self.nodes[next as usize];
            let outside = outside(node, &planes);
            let inside = node.child.iter().zip(outside).filter(|(child, out)| **child != EMPTY && !out);
            stack.extend(inside.map(|(child, _)| *child));
        }
        true
    }

    /// Whether a triangle of a pack may stand in the shaft.
    fn in_shaft(&self, pack: &Pack, planes: &[Plane], blind: &[u32]) -> bool {
        (0..LANES).any(|lane| {
            let corners = [0, 1, 2].map(|vertex| {
                let corner = &pack.corner[vertex];
                DVec3::new(corner[0][lane], corner[1][lane], corner[2][lane])
            });
            let beyond = |plane: &Plane| corners.iter().all(|p| plane.normal.dot(*p) >= plane.limit);
            pack.id[lane] != EMPTY && !is_blind(blind, self, pack.id[lane]) && !planes.iter().any(beyond)
        })
    }
}

/// Which of the eight boxes lie beyond a plane. The boxes' padding is far above f32 rounding.
fn outside(node: &Node, planes: &[Plane]) -> [bool; WIDTH] {
    let mut outside = [false; WIDTH];
    for plane in planes {
        let mut nearest = [0f32; WIDTH];
        for axis in 0..3 {
            let n = plane.normal32[axis];
            let edge = if n >= 0.0 { &node.lo[axis] } else { &node.hi[axis] };
            for lane in 0..WIDTH {
                nearest[lane] += n * edge[lane];
            }
        }
        for lane in 0..WIDTH {
            outside[lane] |= nearest[lane] > plane.limit32;
        }
    }
    outside
}
