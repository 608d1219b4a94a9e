//! Calculation grids: EN 12464-1's spacing rule, points of an area, exclusion by furniture. The
//! grid keeps its topology (rows × columns) so that drawings can place isolines; points stand at
//! the centres of their cells, never on the edge of the area.

mod outline;

use glam::{DVec2, DVec3};

use outline::crossing;
pub use outline::{distance_to_outline, inside, is_rectangle, width};

/// Largest number of points of one grid, left-out points included.
pub const MAX_POINTS: usize = 1_000_000;

/// Largest spacing of EN 12464-1, m.
const SPACING_MAX_M: f64 = 10.0;

/// A spacing this close to the luminaires' (as a share of it) counts as coincident.
const COINCIDENCE: f64 = 0.02;

/// Luminaires closer than this along a direction hang in one row, m.
const SAME_ROW_M: f64 = 0.05;

/// Deviation from the plane and from the edge that is taken for rounding, m.
const FLAT_M: f64 = 1e-3;

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

/// How the number of points is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GridRule {
    /// EN 12464-1, see [`spacing_m`].
    En,
    /// The same with a spacing of at most so many metres: the sides alone would take an L-shaped corridor for the
    /// hall round it, and a strip round a task area for the task.
    EnAtMost(f64),
    /// EN 12193: p as in EN 12464-1 with d the longer side, the numbers of points odd.
    EnSports,
    /// Spacing of at most so many metres on both edges.
    Step(f64),
    /// Columns and rows.
    Count([usize; 2]),
}

/// Why there is no grid. Lengths in m.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// An edge or the normal has no length, or a coordinate is not finite.
    #[error(
        "the area has no extent: {what} is zero or not finite; give two edges and a normal of some length"
    )]
    NoExtent {
        /// Which one.
        what: &'static str,
    },
    /// The edges are not perpendicular.
    #[error("the edges of the rectangle meet at {angle_deg:.1}°, not at 90°; use a polygon")]
    Skewed {
        /// Angle between the edges.
        angle_deg: f64,
    },
    /// Nothing is left inside the border.
    #[error("a border of {border_m} m on both sides leaves nothing of {side_m:.3} m; use less than {:.3} m", .side_m / 2.0)]
    Border {
        /// Border asked for.
        border_m: f64,
        /// Shorter side of the area.
        side_m: f64,
    },
    /// A step or a number of points that is none.
    #[error("the grid needs a positive step or at least one row and one column")]
    Rule,
    /// More than [`MAX_POINTS`].
    #[error("the grid would have {columns} × {rows} points, more than {MAX_POINTS}; use a coarser one")]
    TooMany {
        /// Points along u.
        columns: usize,
        /// Points along v.
        rows: usize,
    },
    /// Fewer than three corners.
    #[error("a polygon needs three corners or more, not {corners}")]
    Corners {
        /// How many there are.
        corners: usize,
    },
    /// A corner lies off the plane of the others.
    #[error(
        "corner {corner} lies {distance_m:.3} m off the plane of the polygon; all corners must lie in one plane"
    )]
    NotPlanar {
        /// Which, from 1.
        corner: usize,
        /// How far.
        distance_m: f64,
    },
    /// Two edges cross or touch.
    #[error("edges {first} and {second} of the polygon cross; list the corners in the order of the outline")]
    SelfIntersecting {
        /// One edge, from 1: it begins at the corner of that number.
        first: usize,
        /// The other.
        second: usize,
    },
    /// No point of the grid lies inside.
    #[error(
        "no grid point lies inside the polygon and its border of {border_m} m; use a finer grid or a smaller border"
    )]
    Empty {
        /// Border asked for.
        border_m: f64,
    },
}

/// Largest spacing p = 0.2 · 5^(lg d) ≤ 10 m, EN 12464-1; d is the longer side, or the shorter one
/// if the sides' ratio is 2 or more; all in m.
pub fn spacing_m(one_side_m: f64, other_side_m: f64) -> f64 {
    let (longer, shorter) = (one_side_m.max(other_side_m), one_side_m.min(other_side_m));
    let d_m = if longer >= 2.0 * shorter { shorter } else { longer };
    (0.2 * 5f64.powf(d_m.log10())).min(SPACING_MAX_M)
}

/// Grid on the rectangle `origin`, `u_edge`, `v_edge` (full edges) with `border_m` left out on all
/// sides; E_n is measured on `normal`. The sides of the rule are those inside the border.
///
/// EN asks that the grid does not repeat the luminaires' pattern: where a spacing comes within 2 %
/// of `avoid_spacing_m` (luminaire spacing along u and v), that edge gets points until it does not. It does
/// not apply to [`GridRule::Count`], which is taken at its word.
///
/// # Errors
/// No extent, edges not perpendicular, a border that leaves nothing, too many points.
pub fn rectangle(
    origin: DVec3,
    u_edge: DVec3,
    v_edge: DVec3,
    normal: DVec3,
    rule: GridRule,
    border_m: f64,
    avoid_spacing_m: Option<[f64; 2]>,
) -> Result<Grid, GridError> {
    let normal = unit(normal, "the normal")?;
    let (u, v) = (unit(u_edge, "the first edge")?, unit(v_edge, "the second edge")?);
    if !origin.is_finite() {
        return Err(GridError::NoExtent { what: "the origin" });
    }
    let cos = u.dot(v);
    if cos.abs() > 1e-6 {
        return Err(GridError::Skewed { angle_deg: cos.acos().to_degrees() });
    }
    let sides_m = [u_edge.length(), v_edge.length()];
    let side_m = sides_m[0].min(sides_m[1]);
    if !(border_m >= 0.0 && 2.0 * border_m < side_m) {
        return Err(GridError::Border { border_m, side_m });
    }
    let inner_m = sides_m.map(|side| side - 2.0 * border_m);
    let [columns, rows] = counts(inner_m, rule, avoid_spacing_m)?;
    let spacing_m = [inner_m[0] / columns as f64, inner_m[1] / rows as f64];
    let along = |index: usize, spacing: f64| border_m + (index as f64 + 0.5) * spacing;
    let points = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .map(|(row, column)| GridPoint {
            row,
            column,
            position: origin + u * along(column, spacing_m[0]) + v * along(row, spacing_m[1]),
            normal,
            excluded: None,
        })
        .collect();
    let outline = vec![origin, origin + u_edge, origin + u_edge + v_edge, origin + v_edge];
    Ok(Grid {
        origin,
        edge_u: u_edge,
        edge_v: v_edge,
        normal,
        columns,
        rows,
        spacing_m,
        border_m,
        points,
        outline,
    })
}

/// Spacing of positions along a direction if they stand in regular rows; 0 where they do not, m.
pub fn regular_spacing_m(positions: &[DVec3], direction: DVec3) -> f64 {
    let mut along: Vec<f64> = positions.iter().map(|p| p.dot(direction)).collect();
    along.sort_by(f64::total_cmp);
    along.dedup_by(|a, b| (*a - *b).abs() < SAME_ROW_M);
    let gaps: Vec<f64> = along.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mean = gaps.iter().sum::<f64>() / gaps.len().max(1) as f64;
    let regular = gaps.iter().all(|gap| (gap - mean).abs() < COINCIDENCE * mean);
    if regular { mean } else { 0.0 }
}

/// Grid on the polygon's bounding rectangle, whose u runs along the polygon's longest edge. Points
/// outside, or nearer than `border_m` to an edge, are marked [`Exclusion::OutsideArea`]. `avoid` are
/// positions (luminaires) whose regular spacing the grid must not repeat, see [`rectangle`].
///
/// # Errors
/// Fewer than three corners, corners off the plane, crossing edges, no point left, and those of
/// [`rectangle`].
pub fn polygon(
    corners: &[DVec3],
    normal: DVec3,
    rule: GridRule,
    border_m: f64,
    avoid: &[DVec3],
) -> Result<Grid, GridError> {
    let count = corners.len();
    if count < 3 {
        return Err(GridError::Corners { corners: count });
    }
    let facing = unit(normal, "the normal")?;
    let edge = |k: usize| corners[(k + 1) % count] - corners[k];
    // Newell: the sum over the edges is twice the vector area, and no corner is special.
    let area = (0..count)
        .map(|k| (corners[k] - corners[0]).cross(corners[(k + 1) % count] - corners[0]))
        .sum::<DVec3>();
    // The first of equal edges, so that a rectangle keeps the axes of its first edge or second.
    let longer = |a: DVec3, b: DVec3| {
        if b.length() > a.length() * (1.0 + 1e-9) { b } else { a }
    };
    let longest = (0..count).map(edge).fold(DVec3::ZERO, longer);
    let u = unit(longest, "the longest edge")?;
    let plane = unit(area, "the area of the polygon")?;
    for (k, corner) in corners.iter().enumerate() {
        let distance_m = plane.dot(*corner - corners[0]).abs();
        if distance_m.is_nan() || distance_m > FLAT_M {
            return Err(GridError::NotPlanar { corner: k + 1, distance_m });
        }
    }
    let v = if plane.dot(facing) < 0.0 { u.cross(plane) } else { plane.cross(u) };
    let flat: Vec<DVec2> = corners
        .iter()
        .map(|corner| DVec2::new(u.dot(*corner - corners[0]), v.dot(*corner - corners[0])))
        .collect();
    if let Some((first, second)) = crossing(&flat) {
        return Err(GridError::SelfIntersecting { first: first + 1, second: second + 1 });
    }
    let low = flat.iter().copied().reduce(DVec2::min).unwrap_or_default();
    let size = flat.iter().copied().reduce(DVec2::max).unwrap_or_default() - low;
    let origin = corners[0] + u * low.x + v * low.y;
    let avoid_spacing_m = [u, v].map(|axis| regular_spacing_m(avoid, axis));
    let mut grid = rectangle(origin, u * size.x, v * size.y, facing, rule, border_m, Some(avoid_spacing_m))?;
    for point in &mut grid.points {
        let offset = point.position - corners[0];
        let place = DVec2::new(u.dot(offset), v.dot(offset));
        if !inside(&flat, place) || distance_to_outline(&flat, place) < border_m - 1e-9 {
            point.excluded = Some(Exclusion::OutsideArea);
        }
    }
    if grid.points.iter().all(|point| point.excluded.is_some()) {
        return Err(GridError::Empty { border_m });
    }
    grid.outline = corners.to_vec();
    Ok(grid)
}

/// A free list of points with their own normals or the default one; it has no rows, no columns and
/// no outline. A normal without length is replaced by the default.
pub fn list(points: &[(DVec3, Option<DVec3>)], default_normal: DVec3) -> Grid {
    let normal = default_normal.normalize_or(DVec3::Z);
    let points: Vec<GridPoint> = points
        .iter()
        .enumerate()
        .map(|(column, (position, own))| GridPoint {
            row: 0,
            column,
            position: *position,
            normal: own.map_or(normal, |own| own.normalize_or(normal)),
            excluded: None,
        })
        .collect();
    Grid {
        origin: points.iter().map(|point| point.position).reduce(DVec3::min).unwrap_or_default(),
        edge_u: DVec3::ZERO,
        edge_v: DVec3::ZERO,
        normal,
        columns: 0,
        rows: 0,
        spacing_m: [0.0; 2],
        border_m: 0.0,
        points,
        outline: Vec::new(),
    }
}

/// Columns and rows for the sides inside the border.
fn counts(
    sides_m: [f64; 2],
    rule: GridRule,
    avoid_spacing_m: Option<[f64; 2]>,
) -> Result<[usize; 2], GridError> {
    let fitted = |step_m: f64| sides_m.map(|side| (side / step_m - 1e-9).ceil().max(1.0) as usize);
    let mut counts = match rule {
        GridRule::En => fitted(spacing_m(sides_m[0], sides_m[1])),
        GridRule::EnAtMost(step_m) if step_m > 0.0 => fitted(spacing_m(sides_m[0], sides_m[1]).min(step_m)),
        GridRule::EnSports => odd_counts(sides_m),
        GridRule::Step(step_m) if step_m > 0.0 => fitted(step_m),
        GridRule::Count(counts) if counts[0] > 0 && counts[1] > 0 => counts,
        GridRule::EnAtMost(_) | GridRule::Step(_) | GridRule::Count(_) => return Err(GridError::Rule),
    };
    let affordable = |counts: [usize; 2]| {
        counts[0]
            .checked_mul(counts[1])
            .filter(|points| *points <= MAX_POINTS)
            .map(|_| counts)
            .ok_or(GridError::TooMany { columns: counts[0], rows: counts[1] })
    };
    counts = affordable(counts)?;
    if matches!(rule, GridRule::Count(_)) {
        return Ok(counts);
    }
    let avoid = |counts: &mut [usize; 2]| {
        for axis in 0..2 {
            let avoid_m = avoid_spacing_m.map_or(0.0, |avoid| avoid[axis]);
            while avoid_m > 0.0 && (sides_m[axis] / counts[axis] as f64 / avoid_m - 1.0).abs() < COINCIDENCE {
                // An odd number stays odd.
                counts[axis] += if rule == GridRule::EnSports { 2 } else { 1 };
            }
        }
    };
    avoid(&mut counts);
    if matches!(rule, GridRule::En | GridRule::EnAtMost(_)) {
        // Cells between 1:2 and 2:1: the coarser edge gets points until they are.
        let cell = |counts: [usize; 2], axis: usize| sides_m[axis] / counts[axis] as f64;
        for (axis, other) in [(0, 1), (1, 0)] {
            if cell(counts, axis) > 2.0 * cell(counts, other) {
                counts[axis] = (sides_m[axis] / (2.0 * cell(counts, other))).ceil() as usize;
            }
        }
        avoid(&mut counts);
    }
    affordable(counts)
}

/// EN 12193: the longer side gets the odd number nearest to d/p, the other side the odd number nearest
/// to its length over the spacing that results.
fn odd_counts(sides_m: [f64; 2]) -> [usize; 2] {
    let odd = |exact: f64| 2 * (0.5 * (exact - 1.0)).round().max(0.0) as usize + 1;
    let longer_m = sides_m[0].max(sides_m[1]);
    let count = odd(longer_m / spacing_m(longer_m, longer_m));
    sides_m.map(|side_m| if side_m >= longer_m { count } else { odd(side_m * count as f64 / longer_m) })
}

fn unit(vector: DVec3, what: &'static str) -> Result<DVec3, GridError> {
    vector.try_normalize().ok_or(GridError::NoExtent { what })
}

#[cfg(test)]
mod tests;
