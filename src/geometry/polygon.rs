//! Plan outlines: orientation, containment, triangulation. Outlines are simple (no
//! self-intersection) and closed implicitly; everything that fills them wants counter-clockwise.

use super::DVec2;

/// Signed area in m², positive counter-clockwise: ½ Σ (x_i y_{i+1} − x_{i+1} y_i).
pub fn signed_area_m2(outline: &[DVec2]) -> f64 {
    let origin = outline.first().copied().unwrap_or_default();
    0.5 * edges(outline).map(|(a, b)| (a - origin).perp_dot(b - origin)).sum::<f64>()
}

/// Whether a point lies inside, or within `tolerance_m` of the outline.
pub fn contains(outline: &[DVec2], point: DVec2, tolerance_m: f64) -> bool {
    let mut inside = false;
    for (a, b) in edges(outline) {
        if distance_to_segment_m(point, a, b) <= tolerance_m {
            return true;
        }
        if (a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y) {
            inside = !inside;
        }
    }
    inside
}

/// Index of the first edge that touches another edge it does not follow; `None` for a simple outline.
pub fn crossing(outline: &[DVec2]) -> Option<usize> {
    let n = outline.len();
    let edge = |i: usize| (outline[i], outline[(i + 1) % n]);
    for i in 0..n {
        let (a, b) = edge(i);
        if !((b - a).length() > 1e-9) {
            return Some(i);
        }
        let (_, c) = edge((i + 1) % n);
        if (b - a).perp_dot(c - b).abs() < 1e-12 && (b - a).dot(c - b) < 0.0 {
            return Some(i); // it turns back on itself
        }
        for j in i + 2..n {
            let (c, d) = edge(j);
            if (j + 1) % n != i && segments_touch(a, b, c, d) {
                return Some(i);
            }
        }
    }
    None
}

/// Ear clipping of a simple counter-clockwise outline; triangles index into it. `None` if no ear is
/// found, which only happens to outlines that are not simple.
pub fn triangulate(outline: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let mut left: Vec<usize> = (0..outline.len()).collect();
    let mut triangles = Vec::with_capacity(outline.len().saturating_sub(2));
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n).find(|&i| {
            let corner = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
            let [a, b, c] = corner.map(|v| outline[v]);
            let blocked = |&v: &usize| !corner.contains(&v) && in_triangle(outline[v], a, b, c);
            (b - a).perp_dot(c - b) > 0.0 && !left.iter().any(blocked)
        });
        // A vertex on a straight edge is no ear but can leave once its neighbours lie in line.
        let straight = || {
            (0..n).find(|&i| {
                let [a, b, c] = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]].map(|v| outline[v]);
                (b - a).perp_dot(c - b).abs() <= 1e-12 * (c - a).length_squared()
            })
        };
        let (i, keep) = match ear {
            Some(i) => (i, true),
            None => (straight()?, false),
        };
        if keep {
            triangles.push([(i + n - 1) % n, i, (i + 1) % n].map(|v| left[v] as u32));
        }
        left.remove(i);
    }
    if left.len() == 3 {
        triangles.push([left[0] as u32, left[1] as u32, left[2] as u32]);
    }
    Some(triangles)
}

/// Edges with their end points.
pub fn edges(outline: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = outline.iter().cycle().skip(1);
    outline.iter().copied().zip(next.copied())
}

fn in_triangle(p: DVec2, a: DVec2, b: DVec2, c: DVec2) -> bool {
    (b - a).perp_dot(p - a) >= 0.0 && (c - b).perp_dot(p - b) >= 0.0 && (a - c).perp_dot(p - c) >= 0.0
}

fn distance_to_segment_m(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let length2 = (b - a).length_squared();
    let t = if length2 > 0.0 { ((p - a).dot(b - a) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (p - (a + t * (b - a))).length()
}

fn segments_touch(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let (s1, s2) = (side(a, b, c), side(a, b, d));
    let (s3, s4) = (side(c, d, a), side(c, d, b));
    if s1 * s2 < 0.0 && s3 * s4 < 0.0 {
        return true;
    }
    [(c, a, b), (d, a, b), (a, c, d), (b, c, d)]
        .into_iter()
        .any(|(p, q, r)| distance_to_segment_m(p, q, r) < 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(points: &[[f64; 2]]) -> Vec<DVec2> {
        points.iter().map(|&p| DVec2::from_array(p)).collect()
    }

    #[test]
    fn triangles_of_a_concave_outline_fill_it_once() {
        for points in [
            &[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 5.0], [0.0, 5.0]][..],
            &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]][..],
        ] {
            let outline = outline(points);
            let triangles = triangulate(&outline).unwrap();
            let area: f64 = triangles
                .iter()
                .map(|t| {
                    let corners = t.map(|v| outline[v as usize]);
                    let area = signed_area_m2(&corners);
                    assert!(area > 0.0, "a flipped triangle would be counted twice");
                    area
                })
                .sum();
            assert!((area - signed_area_m2(&outline)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_bow_tie_is_no_room() {
        assert!(crossing(&outline(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])).is_some());
        assert!(crossing(&outline(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])).is_none());
    }

    #[test]
    fn containment_honours_the_tolerance() {
        let square = outline(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert!(contains(&square, DVec2::new(0.5, 0.5), 0.0));
        assert!(contains(&square, DVec2::new(1.005, 0.5), 0.01));
        assert!(!contains(&square, DVec2::new(1.02, 0.5), 0.01));
    }
}
