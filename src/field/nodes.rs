//! Nodes on the scene's triangles between which a field is interpolated: each triangle is divided into
//! cells of about the spacing, cells may be split in four, and nodes are their corners. The mesh of a
//! triangle is that triangle shrunk by a margin: *on* a concave edge the kernel of the neighbouring surface
//! is zero, its limit is not. In the margin the outermost cells go on straight.
//!
//! Triangles share no nodes, not even in one plane: light may jump where surfaces meet.

use std::collections::BTreeMap;

use super::patches::{part_at, within};
use crate::geometry::mesh::Mesh;

/// A cell may be split this often.
pub const DEEPEST: u32 = 12;
/// Lattice steps along an edge of an unsplit cell.
const STEPS: f64 = (1 << DEEPEST) as f64;
/// Largest margin as a share of a triangle's height.
const WIDEST_MARGIN: f64 = 0.05;
/// Corners of a cell in its own weights.
const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// A mesh of nodes.
#[derive(Clone, Debug)]
pub struct Nodes {
    triangles: Vec<Divided>,
    cells: Vec<Cell>,
    places: Vec<Node>,
    numbered: BTreeMap<Node, u32>,
}

/// A triangle of the scene.
#[derive(Clone, Copy, Debug)]
struct Divided {
    /// Its first cell.
    first: u32,
    /// Cells along an edge; none: it has no nodes.
    divisions: u32,
    /// Margin at each corner's opposite edge, as a share of the height.
    margins: [f64; 3],
}

#[derive(Clone, Copy, Debug)]
enum Cell {
    /// Its three nodes.
    Whole([u32; 3]),
    /// Its first child of four.
    Split(u32),
}

/// A node: its place on the lattice of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Node {
    triangle: u32,
    lattice: [u32; 2],
}

impl Nodes {
    /// Divides the triangles that `keep` names into cells whose longest edge is at most √2 · `spacing_m`, so that
    /// halves of squares have legs of that length; `inset_m` from the edges.
    pub fn new(mesh: &Mesh, spacing_m: f64, inset_m: f64, keep: impl Fn(usize) -> bool) -> Self {
        let mut nodes = Self {
            triangles: Vec::with_capacity(mesh.triangles.len()),
            cells: Vec::new(),
            places: Vec::new(),
            numbered: BTreeMap::new(),
        };
        for index in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(index);
            let edges = [b.distance(c), c.distance(a), a.distance(b)];
            let area_m2 = mesh.normal_and_area(index).1;
            let longest_m = edges.into_iter().fold(0.0, f64::max);
            let kept = keep(index);
            let divisions =
                if kept { (longest_m / (2f64.sqrt() * spacing_m)).ceil().max(1.0) as u32 } else { 0 };
            let margins = edges.map(|edge_m| (0.5 * inset_m * edge_m / area_m2).min(WIDEST_MARGIN));
            nodes.triangles.push(Divided { first: nodes.cells.len() as u32, divisions, margins });
            for part in 0..divisions * divisions {
                let corners = CORNERS.map(|corner| {
                    let steps = f64::from(divisions) * STEPS;
                    let at = if divisions == 1 { corner } else { within(part, divisions, corner) };
                    nodes.node(index as u32, at.map(|share| share * steps))
                });
                nodes.cells.push(Cell::Whole(corners));
            }
        }
        nodes
    }

    /// The number of the node at a place of a triangle's lattice, new if need be.
    fn node(&mut self, triangle: u32, lattice: [f64; 2]) -> u32 {
        let node = Node { triangle, lattice: lattice.map(|step| step.round() as u32) };
        let next = self.places.len() as u32;
        let number = *self.numbered.entry(node).or_insert(next);
        if number == next {
            self.places.push(node);
        }
        number
    }

    /// Number of nodes; each has two sides.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Triangle of a node, and its weights of the second and third corner.
    pub fn place(&self, node: usize) -> (u32, [f64; 2]) {
        let Node { triangle, lattice } = self.places[node];
        let Divided { divisions, margins, .. } = self.triangles[triangle as usize];
        let rest = 1.0 - margins.iter().sum::<f64>();
        let share = |axis: usize| {
            let on_mesh = f64::from(lattice[axis]) / (f64::from(divisions) * STEPS);
            margins[axis + 1] + rest * on_mesh
        };
        (triangle, [share(0), share(1)])
    }

    /// The three nodes about a place of a triangle with their barycentric weights.
    pub fn around(&self, triangle: u32, [s, t]: [f64; 2]) -> Option<[(usize, f64); 3]> {
        let Divided { first, divisions, margins } = self.triangles[triangle as usize];
        if divisions == 0 {
            return None;
        }
        let rest = 1.0 - margins.iter().sum::<f64>();
        let mut local = [(s - margins[1]) / rest, (t - margins[2]) / rest];
        let mut cell = first;
        if divisions > 1 {
            let (part, inner) = part_at(local, divisions);
            (cell, local) = (first + part, inner);
        }
        loop {
            match self.cells[cell as usize] {
                Cell::Split(first) => {
                    let (part, inner) = part_at(local, 2);
                    (cell, local) = (first + part, inner);
                }
                Cell::Whole([a, b, c]) => {
                    let [u, v] = local;
                    return Some([(a as usize, 1.0 - u - v), (b as usize, u), (c as usize, v)]);
                }
            }
        }
    }

    /// Cells that are not split.
    pub fn whole_cells(&self) -> Vec<usize> {
        let whole = |cell: &usize| matches!(self.cells[*cell], Cell::Whole(_));
        (0..self.cells.len()).filter(whole).collect()
    }

    /// The ends of each edge of a cell, and a node half-way between them, new if need be; none if it is split.
    pub fn middles(&mut self, cell: usize) -> Vec<([usize; 2], usize)> {
        let Cell::Whole(corners) = self.cells[cell] else { return Vec::new() };
        let mut all = Vec::with_capacity(3);
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let (one, other) = (self.places[corners[a] as usize], self.places[corners[b] as usize]);
            let lattice =
                [0, 1].map(|axis| 0.5 * (f64::from(one.lattice[axis]) + f64::from(other.lattice[axis])));
            let middle = self.node(one.triangle, lattice);
            all.push(([corners[a] as usize, corners[b] as usize], middle as usize));
        }
        all
    }

    /// Splits a cell in four; the children's numbers.
    pub fn split(&mut self, cell: usize) -> Vec<usize> {
        let Cell::Whole(corners) = self.cells[cell] else { return Vec::new() };
        let [a, b, c] = corners.map(|corner| self.places[corner as usize]);
        let first = self.cells.len();
        for part in 0..4 {
            let nodes = CORNERS.map(|corner| {
                let [s, t] = within(part, 2, corner);
                let lattice = [0, 1].map(|axis| {
                    let [a, b, c] = [a, b, c].map(|node| f64::from(node.lattice[axis]));
                    a + s * (b - a) + t * (c - a)
                });
                self.node(a.triangle, lattice)
            });
            self.cells.push(Cell::Whole(nodes));
        }
        self.cells[cell] = Cell::Split(first as u32);
        (first..first + 4).collect()
    }

    /// Drops nodes that no whole cell has; the former numbers of those that are left.
    pub fn drop_unused(&mut self) -> Vec<usize> {
        let mut used = vec![false; self.places.len()];
        for cell in &self.cells {
            if let Cell::Whole(corners) = cell {
                for &corner in corners {
                    used[corner as usize] = true;
                }
            }
        }
        let kept: Vec<usize> = (0..used.len()).filter(|&node| used[node]).collect();
        let mut renumbered = vec![u32::MAX; used.len()];
        for (number, &former) in kept.iter().enumerate() {
            renumbered[former] = number as u32;
        }
        for cell in &mut self.cells {
            if let Cell::Whole(corners) = cell {
                *corners = corners.map(|corner| renumbered[corner as usize]);
            }
        }
        self.places = kept.iter().map(|&former| self.places[former]).collect();
        self.numbered = self.places.iter().enumerate().map(|(k, node)| (*node, k as u32)).collect();
        kept
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::rng::Rng;

    const INSET_M: f64 = 1e-3;

    /// A sheet of 2 m × 1 m, divided, some cells split and some of their children again.
    fn sheet() -> (Mesh, Nodes) {
        let mut mesh = Mesh::default();
        let surface = mesh.add_surface("sheet", 0, false);
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        mesh.add_quad([p(0.0, 0.0), p(2.0, 0.0), p(2.0, 1.0), p(0.0, 1.0)], surface);
        let mut nodes = Nodes::new(&mesh, 0.4, INSET_M, |_| true);
        for cell in [0, 5, 17] {
            let children = nodes.split(cell);
            nodes.split(children[1]);
        }
        (mesh, nodes)
    }

    fn point(mesh: &Mesh, (triangle, [s, t]): (u32, [f64; 2])) -> DVec3 {
        let [a, b, c] = mesh.corners(triangle as usize);
        a + (b - a) * s + (c - a) * t
    }

    /// Largest error of interpolating `function` at 1 000 places, edges and corners included.
    fn worst(function: impl Fn(DVec3) -> f64, turn: usize) -> f64 {
        let (mesh, nodes) = sheet();
        let mut rng = Rng::new(1, 1, 1);
        let mut worst = 0f64;
        for k in 0..1000 {
            let [u, v, w] = rng.uniforms();
            let (u, v) = if k % 10 == 0 { (u.round(), v) } else { (u, v * (1.0 - u)) };
            let place = (u32::from(w < 0.5), [u, if k % 10 == 0 { v * (1.0 - u) } else { v }]);
            let around = nodes.around(place.0, place.1).expect("the sheet has nodes");
            let weight = |k: usize| around[(k + turn) % 3].1;
            let terms = (0..3).map(|k| weight(k) * function(point(&mesh, nodes.place(around[k].0))));
            worst = worst.max((terms.sum::<f64>() - function(point(&mesh, place))).abs());
        }
        worst
    }

    /// Catches: weights given to the wrong nodes, children in another order than look-ups expect, margins that
    /// move a node and not the look-up.
    #[test]
    fn what_is_linear_in_position_is_interpolated_exactly() {
        let linear = |p: DVec3| 3.0 + 2.0 * p.x - 5.0 * p.y;
        assert!(worst(linear, 0) < 1e-12, "{}", worst(linear, 0));
        assert!(worst(linear, 1) > 0.1, "turned weights pass");
        assert!(worst(|p| p.x * p.x, 0) > 1e-3, "a parabola passes for a line");
    }

    /// Catches: nodes on the edge, margins at the wrong edge, cells longer than asked for.
    #[test]
    fn nodes_lie_within_the_margin_and_as_near_as_asked() {
        let (mesh, nodes) = sheet();
        for node in 0..nodes.len() {
            let p = point(&mesh, nodes.place(node));
            let from_edge = p.x.min(2.0 - p.x).min(p.y).min(1.0 - p.y);
            assert!(from_edge > INSET_M - 1e-12, "{p} is {from_edge} m from an edge");
        }
        // Where the sheet's edges meet at a right angle of one triangle.
        let corner = DVec3::new(2.0, 0.0, 0.0);
        let nearest = (0..nodes.len()).map(|n| point(&mesh, nodes.place(n)).distance(corner));
        assert!((nearest.fold(f64::INFINITY, f64::min) - INSET_M * 2f64.sqrt()).abs() < 1e-9);
        let unsplit = Nodes::new(&mesh, 0.4, INSET_M, |_| true);
        for cell in unsplit.whole_cells() {
            let Cell::Whole(corners) = unsplit.cells[cell] else { continue };
            let [a, b, c] = corners.map(|corner| point(&mesh, unsplit.place(corner as usize)));
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            assert!(longest <= 0.4 * 2f64.sqrt() + 1e-12, "{longest}");
        }
    }

    /// Catches: neighbours that do not share their nodes, middles that are other nodes than the children's.
    #[test]
    fn cells_share_nodes_and_unused_ones_are_dropped() {
        let mut mesh = Mesh::default();
        let surface = mesh.add_surface("sheet", 0, false);
        mesh.add_quad([DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y], surface);
        let mut nodes = Nodes::new(&mesh, 0.25, INSET_M, |triangle| triangle == 0);
        assert_eq!((nodes.len(), nodes.whole_cells().len()), (15, 16));
        assert!(nodes.around(1, [0.2, 0.2]).is_none(), "the other triangle has none");
        let middles = nodes.middles(3);
        assert_eq!(nodes.len(), 18);
        nodes.middles(9);
        assert_eq!(nodes.split(3).len(), 4);
        assert!(nodes.middles(3).is_empty(), "a split cell has no middles");
        let kept = nodes.drop_unused();
        assert_eq!(nodes.len(), 18, "the middles of the cell that was split");
        assert!(middles.iter().all(|(_, node)| kept.contains(node)));
        assert_eq!(nodes.whole_cells().len(), 19);
    }
}
