//! Calculation grids: EN 12464-1's spacing rule, points of an area, exclusion by furniture. The
//! grid keeps its topology (rows × columns) so that drawings can place isolines.

use glam::DVec3;

/// Points of an area with their order.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Lower left corner of the *whole* area (border included), m.
    pub origin: DVec3,
    /// Full edge along the columns, m (unit direction × length).
    pub edge_u: DVec3,
    /// Full edge along the rows, m.
    pub edge_v: DVec3,
    /// Unit normal on which E_n is measured.
    pub normal: DVec3,
    /// Number of points along `edge_u`; 0 for a free list of points.
    pub columns: usize,
    /// Number of points along `edge_v`; 0 for a free list of points.
    pub rows: usize,
    /// Spacing along `edge_u` and `edge_v`, m; zero for a free list.
    pub spacing_m: [f64; 2],
    /// Border left out on all four sides, m.
    pub border_m: f64,
    /// Points in order of rows, then columns.
    pub points: Vec<GridPoint>,
    /// Outline of the area for drawings, closed implicitly, m.
    pub outline: Vec<DVec3>,
}

/// A point of a grid.
#[derive(Clone, Debug)]
pub struct GridPoint {
    /// Row index (0 at `origin`), or 0 for a free list.
    pub row: usize,
    /// Column index (0 at `origin`), or the index of a free list.
    pub column: usize,
    /// Position, m.
    pub position: DVec3,
    /// Unit normal at the point.
    pub normal: DVec3,
    /// Why the point is left out, if it is.
    pub excluded: Option<Exclusion>,
}

/// Why a grid point is not evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exclusion {
    /// It lies inside a closed piece of furniture.
    InsideFurniture,
    /// It lies outside a polygonal area.
    OutsideArea,
    /// It lies in another area that is judged on its own (a task area in its surrounding).
    InOtherArea,
}

/// How the points of an area are laid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GridRule {
    /// EN 12464-1: p = 0.2 · 5^(lg d), p ≤ 10 m.
    En,
    /// Square cells of about this edge, m.
    Step(f64),
    /// Columns along u, rows along v.
    Count([usize; 2]),
}
