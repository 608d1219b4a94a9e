//! Configuration factors from a point to rectangles in closed form, and their algebra.

use std::f64::consts::TAU;

/// A rectangle in the plane at distance `distance_m` from the point: [from, to] along two directions,
/// measured from the foot of the perpendicular.
#[derive(Clone, Copy, Debug)]
pub struct Rect {
    pub u: [f64; 2],
    pub v: [f64; 2],
    pub distance_m: f64,
}

/// Sum over the corners of a function that is odd in both coordinates.
fn corners(rect: &Rect, corner: impl Fn(f64, f64) -> f64) -> f64 {
    let [u0, u1] = rect.u;
    let [v0, v1] = rect.v;
    corner(u1, v1) - corner(u0, v1) - corner(u1, v0) + corner(u0, v0)
}

/// The receiving plane is parallel to the rectangle.
pub fn parallel(rect: &Rect) -> f64 {
    let d = rect.distance_m;
    corners(rect, |u, v| {
        let (x, y) = (u / d, v / d);
        let (sx, sy) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
        (x / sx * (y / sx).atan() + y / sy * (x / sy).atan()) / TAU
    })
}

/// The receiving plane is perpendicular and faces +u; the rectangle lies at u ≥ 0.
pub fn perpendicular(rect: &Rect) -> f64 {
    let d = rect.distance_m;
    // ∫∫ d·u/(π r⁴) over a corner rectangle: ½π [atan(v/d) − d/√(u²+d²) atan(v/√(u²+d²))].
    corners(rect, |u, v| {
        let reach = (u * u + d * d).sqrt();
        ((v / d).atan() - d / reach * (v / reach).atan()) / TAU
    })
}

/// The part of `rect` that is hidden behind `screen`, which lies parallel to it and nearer.
pub fn shadow(rect: &Rect, screen: &Rect) -> Rect {
    let scale = rect.distance_m / screen.distance_m;
    let cut = |of: [f64; 2], by: [f64; 2]| {
        let low = of[0].max(by[0] * scale);
        [low, of[1].min(by[1] * scale).max(low)]
    };
    Rect { u: cut(rect.u, screen.u), v: cut(rect.v, screen.v), distance_m: rect.distance_m }
}
