//! Polygons in their plane: inside, distance to the edges, crossing edges, how wide they are.

use std::collections::BinaryHeap;

use glam::DVec2;

/// Even–odd rule.
pub fn inside(corners: &[DVec2], place: DVec2) -> bool {
    let mut inside = false;
    for (k, a) in corners.iter().enumerate() {
        let b = corners[(k + 1) % corners.len()];
        if (a.y > place.y) != (b.y > place.y) && place.x < a.x + (place.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

/// Distance to the nearest edge, in the unit of the corners.
pub fn distance_to_outline(corners: &[DVec2], place: DVec2) -> f64 {
    let distance = |k: usize| {
        let (a, edge) = (corners[k], corners[(k + 1) % corners.len()] - corners[k]);
        let part = ((place - a).dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (place - a - edge * part).length()
    };
    (0..corners.len()).map(distance).fold(f64::INFINITY, f64::min)
}

/// Whether four corners make a rectangle, however it is turned.
pub fn is_rectangle(outline: &[DVec2]) -> bool {
    let &[a, b, c, d] = outline else { return false };
    (b - a - (c - d)).length() < 1e-6 * (b - a).length()
        && (b - a).dot(d - a).abs() < 1e-6 * (b - a).length() * (d - a).length()
}

/// Width of an area: the diameter of the largest circle in it, to 2 %, in the unit of the corners. `holes` do
/// not belong to it. A rectangle's is its shorter side, an L-shaped corridor's is the corridor's, that of a
/// strip round a task area about the strip's; 0 where nothing is left.
pub fn width(outline: &[DVec2], holes: &[Vec<DVec2>]) -> f64 {
    if let (&[a, b, _, d], [], true) = (outline, holes, is_rectangle(outline)) {
        return (b - a).length().min((d - a).length());
    }
    // How deep a place lies inside, negative outside.
    let depth = |place: DVec2| {
        let is_in = inside(outline, place) && !holes.iter().any(|hole| inside(hole, place));
        let edges = holes.iter().map(|hole| distance_to_outline(hole, place));
        let distance = edges.fold(distance_to_outline(outline, place), f64::min);
        if is_in { distance } else { -distance }
    };
    let low = outline.iter().copied().reduce(DVec2::min).unwrap_or_default();
    let size = outline.iter().copied().reduce(DVec2::max).unwrap_or_default() - low;
    let square = |centre: DVec2, half: f64| Square { most: depth(centre) + half * 2f64.sqrt(), centre, half };
    let mut open = BinaryHeap::from([square(low + 0.5 * size, 0.5 * size.max_element())]);
    let (mut best, mut looked_at) = (0.0, 0);
    // The square that may hold the deepest place is quartered, until none can be deeper by much.
    while let Some(Square { most, centre, half }) = open.pop() {
        best = f64::max(best, depth(centre));
        looked_at += 1;
        if !(most > best * 1.02 && half > 1e-4 * size.max_element()) || looked_at > MOST_SQUARES {
            break;
        }
        let quarter = 0.5 * half;
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            open.push(square(centre + quarter * DVec2::new(x, y), quarter));
        }
    }
    2.0 * best
}

/// Squares after which the search for the largest circle ends with what it has.
const MOST_SQUARES: usize = 100_000;

/// A square of places, and how deep one of them may lie at most.
struct Square {
    most: f64,
    centre: DVec2,
    half: f64,
}

impl PartialEq for Square {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Square {}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.most.total_cmp(&other.most)
    }
}

/// The first two edges that cross, or touch without being neighbours.
pub(super) fn crossing(corners: &[DVec2]) -> Option<(usize, usize)> {
    let count = corners.len();
    let ends = |k: usize| (corners[k], corners[(k + 1) % count]);
    let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    for first in 0..count {
        for second in first + 2..count {
            if first == 0 && second == count - 1 {
                continue;
            }
            let ((a, b), (c, d)) = (ends(first), ends(second));
            let boxes_meet = a.min(b).cmple(c.max(d)).all() && c.min(d).cmple(a.max(b)).all();
            let straddle = side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0;
            if boxes_meet && straddle {
                return Some((first, second));
            }
        }
    }
    None
}
