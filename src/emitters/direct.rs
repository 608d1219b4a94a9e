//! Unshadowed illuminance by a luminaire: Lambert's contour formula where it applies, error-controlled
//! product Gauss quadrature over the opening elsewhere.

use std::f64::consts::PI;

use glam::DVec3;

use super::{Emitters, Source};
use crate::photometry::Opening;
use crate::query::Kernel;

/// Largest error of the unshadowed light of an observer's or receiver's luminaires, as a share of
/// their illuminance; tests/quadrature.rs measures it on tabulated luminaires.
pub const TOLERANCE: f64 = 5e-4;
/// The quadrature splits while its two rules differ by more than this share of a luminaire's light.
const AGREEMENT: f64 = 1e-4;
/// Nearer than this many opening radii the opening is split at least once: two coarse rules may
/// agree by chance across a bend of the intensity table.
const NEAR: f64 = 16.0;
const DEEPEST: u32 = 7;
/// Within half of its radius an opening is first split to pieces no larger than their distance: a rule over a
/// larger one may miss the bright spot that the receiver sees. Down to 2⁻¹⁶ of its edge.
const CLOSE: u32 = 16;

/// Two- and three-point Gauss–Legendre nodes and weights on [0, 1].
const GAUSS2: [(f64, f64); 2] = [(0.211_324_865_405_187_13, 0.5), (0.788_675_134_594_812_9, 0.5)];
const GAUSS3: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Illuminance in lx at `point` by `kernel` from a luminaire, as if nothing stood between.
///
/// There is no switch to the point law, at any distance. It would be allowed where it changes a
/// luminaire's light by less than 1e-4, and tests/quadrature.rs measures how often that is: for 8 % of the
/// pairs of point and luminaire in a hall of 100 × 60 m with 600 panels. The bend
/// of an intensity table matters farther out than the size does. Finding out costs five intensities where
/// integrating costs thirteen, so a switch made the hall's direct light dearer, 0.27 s for 0.21 s.
pub fn unshadowed(emitters: &Emitters, source: &Source, point: DVec3, kernel: &Kernel) -> f64 {
    if source.is_behind(point) {
        return 0.0;
    }
    let value = |u: [f64; 2]| {
        let arrival = emitters.arrival(source, point, u);
        arrival.normal_lx * kernel.response(arrival.direction)
    };
    if source.is_point() {
        return value([0.5, 0.5]);
    }
    let luminaire = emitters.luminaire(source);
    if let (Some(flux_lm), Kernel::Planar { normal }) = (luminaire.kind.distribution.lambert_flux(), kernel)
        && luminaire.kind.opening.is_polygon()
    {
        let corners = luminaire.kind.opening.outline();
        let beam = -source.world_from_luminaire.z_axis;
        if beam.dot(point - source.position) <= 0.0 {
            return 0.0;
        }
        let luminance = flux_lm * luminaire.dim / (PI * source.area_m2);
        let corners: Vec<DVec3> =
            corners.iter().map(|&p| source.position + source.world_from_luminaire * p - point).collect();
        return luminance * contour(&corners, *normal);
    }
    let place = source.place(point);
    let close = source.position.distance(point) < 2.0 * source.radius_m;
    let cut = matches!(kernel, Kernel::Planar { normal }
        if normal.dot(source.position - point).abs() < source.radius_m);
    let near = u32::from(source.position.distance(point) < NEAR * source.radius_m);
    let pieces = luminaire.kind.opening.pieces();
    if pieces > 0 {
        // Piece by piece, since a rule across an edge would see a jump.
        let least = if cut { 4 } else { near };
        let shone = |piece: usize| {
            let at = |u: [f64; 2]| source.opening.shine_of_piece(piece, place, u).map(|shine| shine.at);
            integral(least, &Nearby { close, place, at: &at }, &|u| {
                let shine = source.opening.shine_of_piece(piece, place, u);
                let arrival = shine.and_then(|shine| emitters.arrival_from(source, point, shine, |_| true));
                arrival.map_or(0.0, |arrival| arrival.normal_lx * kernel.response(arrival.direction))
            })
        };
        return (0..pieces).map(shone).sum();
    }
    if let (true, Kernel::Planar { normal }) = (cut, kernel) {
        return across_horizon(emitters, source, point, *normal, &value);
    }
    let at = |u: [f64; 2]| Some(source.opening.plane_point(u));
    integral(near, &Nearby { close, place, at: &at }, &value)
}

/// The receiver beside the surface that is integrated.
struct Nearby<'a, At: Fn([f64; 2]) -> Option<DVec3>> {
    /// Near enough to look closer.
    close: bool,
    /// The receiver, luminaire frame.
    place: DVec3,
    /// The point of the surface, luminaire frame.
    at: &'a At,
}

impl<At: Fn([f64; 2]) -> Option<DVec3>> Nearby<'_, At> {
    /// Whether a square of the unit square is larger than its distance times `factor`.
    fn is_large(&self, [u, v]: [f64; 2], edge: f64, factor: f64) -> bool {
        let point =
            |i: u32, j: u32| (self.at)([u + 0.5 * edge * f64::from(i), v + 0.5 * edge * f64::from(j)]);
        let Some(middle) = point(1, 1) else { return false };
        let (mut radius_m, mut distance_m) = (0.0_f64, f64::INFINITY);
        for k in 0..9 {
            if let Some(at) = point(k / 3, k % 3) {
                radius_m = radius_m.max(at.distance(middle));
                distance_m = distance_m.min(at.distance(self.place));
            }
        }
        // No point of the square is farther from those nine than half of the radius.
        distance_m < (factor + 0.5) * radius_m
    }

    /// The squares of at most their distance, with their depths; none where the whole is no larger.
    fn squares(&self) -> Vec<([f64; 2], f64, u32)> {
        if !(self.close && self.is_large([0.0; 2], 1.0, 0.5)) {
            return Vec::new();
        }
        let (mut done, mut open) = (Vec::new(), vec![([0.0; 2], 1.0, 0)]);
        while let Some((corner, edge, depth)) = open.pop() {
            if depth == CLOSE || !self.is_large(corner, edge, 1.0) {
                done.push((corner, edge, depth));
            } else {
                open.extend(quarters(corner, edge).map(|corner| (corner, 0.5 * edge, depth + 1)));
            }
        }
        done
    }
}

fn quarters([u, v]: [f64; 2], edge: f64) -> [[f64; 2]; 4] {
    let half = 0.5 * edge;
    [[0.0, 0.0], [half, 0.0], [0.0, half], [half, half]].map(|shift| [u + shift[0], v + shift[1]])
}

/// ∫ over the unit square, split at least `least` times, and finely where the receiver is close.
fn integral<At: Fn([f64; 2]) -> Option<DVec3>>(
    least: u32,
    nearby: &Nearby<At>,
    value: &impl Fn([f64; 2]) -> f64,
) -> f64 {
    let squares = nearby.squares();
    if squares.is_empty() {
        let whole = product(&GAUSS3, [0.0, 0.0], 1.0, value);
        return adaptive([0.0, 0.0], 1.0, whole, (whole * AGREEMENT).max(1e-12), [0, least, DEEPEST], value);
    }
    let fine: Vec<f64> =
        squares.iter().map(|(corner, edge, _)| product(&GAUSS3, *corner, *edge, value)).collect();
    let whole: f64 = fine.iter().sum();
    let of_square = |((corner, edge, depth), fine): (&([f64; 2], f64, u32), f64)| {
        let tolerance = (whole * AGREEMENT * edge).max(1e-12);
        adaptive(*corner, *edge, fine, tolerance, [*depth, least, DEEPEST.max(depth + 4)], value)
    };
    squares.iter().zip(fine).map(of_square).sum()
}

/// The receiver's plane cuts the opening: only the part above it counts, and a rule that straddles
/// the cut would miss how much. A flat rectangle is clipped in its own coordinates and the rest
/// integrated triangle by triangle; round ones are split finely.
fn across_horizon(
    emitters: &Emitters,
    source: &Source,
    point: DVec3,
    normal: DVec3,
    value: &impl Fn([f64; 2]) -> f64,
) -> f64 {
    let opening = emitters.luminaire(source).kind.opening;
    let (place, close) = (source.place(point), source.position.distance(point) < 2.0 * source.radius_m);
    let plain = |u: [f64; 2]| Some(opening.plane_point(u));
    if !matches!(opening, Opening::Rect { .. } | Opening::Upright { round: false, .. }) {
        return integral(4, &Nearby { close, place, at: &plain }, value);
    }
    let height = |[u, v]: [f64; 2]| {
        normal.dot(source.position + source.world_from_luminaire * opening.plane_point([u, v]) - point)
    };
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut kept: Vec<[f64; 2]> = Vec::with_capacity(5);
    for (index, &a) in square.iter().enumerate() {
        let b = square[(index + 1) % 4];
        let (ha, hb) = (height(a), height(b));
        if ha >= 0.0 {
            kept.push(a);
        }
        if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
            let t = ha / (ha - hb);
            kept.push([a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]);
        }
    }
    let mut sum = 0.0;
    for corner in 1..kept.len().saturating_sub(1) {
        let (a, b, c) = (kept[0], kept[corner], kept[corner + 1]);
        let (e, f) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        let area = (e[0] * f[1] - e[1] * f[0]).abs();
        // Duffy's map of the unit square onto the triangle; its Jacobian is s times twice the area.
        let onto = |[s, t]: [f64; 2]| [a[0] + s * (e[0] + t * f[0]), a[1] + s * (e[1] + t * f[1])];
        let at = |u: [f64; 2]| plain(onto(u));
        sum += integral(1, &Nearby { close, place, at: &at }, &|[s, t]: [f64; 2]| {
            value(onto([s, t])) * s * area
        });
    }
    sum
}

/// ∫ over a square of the unit square, split until the two rules agree to `tolerance`.
fn adaptive(
    corner: [f64; 2],
    edge: f64,
    fine: f64,
    tolerance: f64,
    [depth, least, deepest]: [u32; 3],
    value: &impl Fn([f64; 2]) -> f64,
) -> f64 {
    let coarse = product(&GAUSS2, corner, edge, value);
    if depth >= least && ((fine - coarse).abs() <= tolerance || depth == deepest) {
        return fine;
    }
    let half = 0.5 * edge;
    let quarters = quarters(corner, edge).map(|corner| (corner, product(&GAUSS3, corner, half, value)));
    quarters
        .iter()
        .map(|&(corner, fine)| {
            adaptive(corner, half, fine, 0.5 * tolerance, [depth + 1, least, deepest], value)
        })
        .sum()
}

fn product(rule: &[(f64, f64)], corner: [f64; 2], edge: f64, value: &impl Fn([f64; 2]) -> f64) -> f64 {
    let mut sum = 0.0;
    for (x, wx) in rule {
        for (y, wy) in rule {
            sum += wx * wy * value([corner[0] + edge * x, corner[1] + edge * y]);
        }
    }
    sum * edge * edge
}

/// Lambert's formula: E/L = ½ |Σ Γ_i · n| of a polygon seen from the origin on a plane with unit
/// `normal`, the polygon clipped at the horizon first. In sr·cos: E = L × this.
pub fn contour(corners: &[DVec3], normal: DVec3) -> f64 {
    let clipped = clip(corners, normal);
    let mut sum = 0.0;
    for (index, &a) in clipped.iter().enumerate() {
        let b = clipped[(index + 1) % clipped.len()];
        let cross = a.cross(b);
        let length = cross.length();
        if length > 0.0 {
            sum += length.atan2(a.dot(b)) / length * cross.dot(normal);
        }
    }
    0.5 * sum.abs()
}

/// The part of a polygon above the horizon n · p ≥ 0 (Sutherland–Hodgman).
fn clip(corners: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (index, &a) in corners.iter().enumerate() {
        let b = corners[(index + 1) % corners.len()];
        let (ha, hb) = (a.dot(normal), b.dot(normal));
        if ha >= 0.0 {
            kept.push(a);
        }
        if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
            kept.push(a + (b - a) * (ha / (ha - hb)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(u: f64, v: f64, height: f64, shift: DVec3) -> Vec<DVec3> {
        [[0.0, 0.0], [u, 0.0], [u, v], [0.0, v]].map(|[x, y]| DVec3::new(x, y, height) + shift).to_vec()
    }

    #[test]
    fn contour_gives_the_tabled_form_factors() {
        // Parallel and perpendicular rectangle over a corner point, E = π L F (closed forms).
        let f = |corners: &[DVec3], normal| contour(corners, normal) / PI;
        assert!((f(&rectangle(1.0, 1.0, 1.0, DVec3::ZERO), DVec3::Z) - 0.138_531_605_995).abs() < 1e-11);
        assert!((f(&rectangle(2.0, 1.0, 3.0, DVec3::ZERO), DVec3::Z) - 0.052_267_808_794).abs() < 1e-11);
        let upright = |a: f64, b: f64, c: f64| {
            [[0.0, 0.0], [b, 0.0], [b, a], [0.0, a]].map(|[y, z]| DVec3::new(c, y, z)).to_vec()
        };
        assert!((f(&upright(1.0, 1.0, 1.0), DVec3::Z) - 0.055_734_197_003).abs() < 1e-11);
        assert!((f(&upright(1.0, 1.0, 1e-9), DVec3::Z) - 0.249_999_999_716).abs() < 1e-9);
    }

    #[test]
    fn contour_clips_at_the_horizon() {
        let wall = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[y, z]| DVec3::new(1.0, y, z));
        assert!((contour(&wall, DVec3::Z) - 0.350_188_287_714).abs() < 1e-11);
        assert!(contour(&wall, DVec3::NEG_X).abs() < 1e-15, "a source behind the plane gives nothing");
    }
}
