//! Eight-wide nodes and packs of four triangles: their layout in memory, the two tests on them, and
//! how obvhs' binary tree is collapsed to them. Boxes are f32 and only ever cull too little.

use glam::DVec3;
use obvhs::bvh2::Bvh2;

use crate::geometry::mesh::Mesh;

/// Children of a node.
pub(super) const WIDTH: usize = 8;
/// Triangles of a pack.
pub(super) const LANES: usize = 4;
/// No child, no triangle.
pub(super) const EMPTY: u32 = u32::MAX;
/// Marks a child that is a pack.
pub(super) const LEAF: u32 = 1 << 31;

/// Eight children: boxes by axis, and what they are (node index, `LEAF | pack index`, or `EMPTY`).
#[derive(Clone)]
#[repr(align(64))]
pub(super) struct Node {
    pub(super) lo: [[f32; WIDTH]; 3],
    pub(super) hi: [[f32; WIDTH]; 3],
    pub(super) child: [u32; WIDTH],
}

/// Four triangles: `corner[vertex][axis][lane]`; unused lanes have id `EMPTY`.
#[derive(Clone)]
#[repr(align(32))]
pub(super) struct Pack {
    pub(super) corner: [[[f64; LANES]; 3]; 3],
    pub(super) id: [u32; LANES],
}

/// What of a ray follows from its direction alone: many rays may share it.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// Unit direction.
    pub direction: DVec3,
    shear: [f64; 3],
    axes: [usize; 3],
    inverse32: [f32; 3],
}

/// A ray prepared for Woop's test and for the slab test.
pub(super) struct Prepared {
    pub(super) origin: [f64; 3],
    pub(super) shear: [f64; 3],
    pub(super) axes: [usize; 3],
    pub(super) origin32: [f32; 3],
    pub(super) inverse32: [f32; 3],
}

/// A collapsed tree.
pub(super) struct Wide {
    pub(super) nodes: Vec<Node>,
    pub(super) packs: Vec<Pack>,
    /// Depth of the tree.
    pub(super) deepest: usize,
}

/// Collapses the binary tree to eight-wide nodes, opening the largest child first.
pub(super) fn collapse(bvh: &Bvh2, mesh: &Mesh) -> Wide {
    let (mut nodes, mut packs) = (Vec::new(), Vec::new());
    let mut deepest = 1;
    nodes.push(Node::EMPTY);
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
                nodes[target].lo[axis][lane] = source.aabb.min[axis];
                nodes[target].hi[axis][lane] = source.aabb.max[axis];
            }
            nodes[target].child[lane] = if source.prim_count == 0 {
                nodes.push(Node::EMPTY);
                let index = nodes.len() - 1;
                work.push((index, child, depth + 1));
                index as u32
            } else {
                let first = source.first_index as usize;
                let members = &bvh.primitive_indices[first..first + source.prim_count as usize];
                packs.push(Pack::new(mesh, members));
                LEAF | (packs.len() - 1) as u32
            };
        }
    }
    Wide { nodes, packs, deepest }
}

/// Prepares a ray; boxes are relative to `centre`.
pub(super) fn prepare(origin: DVec3, centre: DVec3, direction: DVec3) -> Prepared {
    Course::new(direction).from(origin, centre)
}

impl Course {
    /// Along a unit direction.
    #[inline]
    pub fn new(direction: DVec3) -> Self {
        let d = direction.to_array();
        let z = if d[0].abs() > d[1].abs() {
            if d[0].abs() > d[2].abs() { 0 } else { 2 }
        } else if d[1].abs() > d[2].abs() {
            1
        } else {
            2
        };
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        let inverse = |d: f64| {
            let d = d as f32;
            1.0 / if d.abs() < 1e-20 { 1e-20f32.copysign(d) } else { d }
        };
        Self {
            direction,
            shear: [d[x] / d[z], d[y] / d[z], 1.0 / d[z]],
            axes: [x, y, z],
            inverse32: d.map(inverse),
        }
    }

    /// A ray from `origin`; boxes are relative to `centre`.
    #[inline]
    pub(super) fn from(&self, origin: DVec3, centre: DVec3) -> Prepared {
        let o = origin.to_array();
        Prepared {
            origin: self.axes.map(|axis| o[axis]),
            shear: self.shear,
            axes: self.axes,
            origin32: (origin - centre).as_vec3().to_array(),
            inverse32: self.inverse32,
        }
    }
}

impl Node {
    pub(super) const EMPTY: Self =
        Self { lo: [[f32::INFINITY; WIDTH]; 3], hi: [[f32::NEG_INFINITY; WIDTH]; 3], child: [EMPTY; WIDTH] };
}

impl Pack {
    pub(super) fn new(mesh: &Mesh, members: &[u32]) -> Self {
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
pub(super) fn slabs(node: &Node, ray: &Prepared, limit: f32) -> ([f32; WIDTH], [bool; WIDTH]) {
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
pub(super) fn meet(pack: &Pack, ray: &Prepared) -> ([f64; LANES], [f64; LANES], [f64; LANES], [bool; LANES]) {
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
