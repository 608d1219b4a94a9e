//! Polygons in their plane: inside, distance to the edges, crossing edges.

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
