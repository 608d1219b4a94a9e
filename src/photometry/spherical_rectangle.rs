//! A rectangle as it fills the view from a place: points on it that are uniform in solid angle (C. Ureña, M. Fajardo,
//! A. King, Computer Graphics Forum 32(4), 2013). Points that are uniform by area have no bound there: beside a
//! lamp that touches a ceiling, cosθ cosθ′/d² of one point has no variance.

use std::f64::consts::TAU;

use glam::DVec3;

/// A place is near if it lies within this many lengths of the longer edge from the centre.
const NEAR: f64 = 3.0;
/// Smaller solid angles, sr, are not worth it, and rounding eats them.
const LEAST_SR: f64 = 1e-4;

/// A rectangle and the place from which it is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalRectangle {
    place: DVec3,
    /// Unit vectors along the edges, and across them.
    axes: [DVec3; 3],
    /// Corners along the edges relative to the place, m, and the distance of the plane, ≤ 0.
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    /// cos-like terms of the two level edges' great circles.
    level: [f64; 2],
    /// What the two far angles leave of a full turn, negative.
    offset: f64,
    solid_angle_sr: f64,
}

impl SphericalRectangle {
    /// The rectangle `centre` ± `a` ± `b` from a place near by; `None` from afar, or where it is seen edge-on.
    #[inline]
    pub(super) fn near(place: DVec3, centre: DVec3, a: DVec3, b: DVec3) -> Option<Self> {
        let (half_a, half_b) = (a.length(), b.length());
        let reach = 2.0 * NEAR * half_a.max(half_b);
        if !(half_a > 0.0 && half_b > 0.0 && (place - centre).length_squared() < reach * reach) {
            return None;
        }
        let (along, beside) = (a / half_a, b / half_b);
        let across = along.cross(beside);
        let middle = centre - place;
        let height = middle.dot(across);
        let (z, across) = if height > 0.0 { (-height, -across) } else { (height, across) };
        let x = [middle.dot(along) - half_a, middle.dot(along) + half_a];
        let y = [middle.dot(beside) - half_b, middle.dot(beside) + half_b];
        // Normals of the planes through the place and each edge.
        let normal = |p: DVec3, q: DVec3| p.cross(q).normalize_or_zero();
        let corner = |k: usize, l: usize| DVec3::new(x[k], y[l], z);
        let normals = [
            normal(corner(0, 0), corner(1, 0)),
            normal(corner(1, 0), corner(1, 1)),
            normal(corner(1, 1), corner(0, 1)),
            normal(corner(0, 1), corner(0, 0)),
        ];
        let angle = |k: usize| (-normals[k].dot(normals[(k + 1) % 4])).clamp(-1.0, 1.0).acos();
        let offset = TAU - angle(2) - angle(3);
        let solid_angle_sr = angle(0) + angle(1) - offset;
        (solid_angle_sr > LEAST_SR).then_some(Self {
            place,
            axes: [along, beside, across],
            x,
            y,
            z,
            level: [normals[0].z, normals[2].z],
            offset,
            solid_angle_sr,
        })
    }

    /// The point at `u` of the unit square, uniform in solid angle.
    pub(super) fn point(&self, [u, v]: [f64; 2]) -> DVec3 {
        let [b0, b1] = self.level;
        let turn = u * self.solid_angle_sr + self.offset;
        let slope = (turn.cos() * b0 - b1) / turn.sin();
        let cos = (slope.signum() / slope.hypot(b0)).clamp(-1.0, 1.0);
        let x = (-cos * self.z / (1.0 - cos * cos).sqrt()).clamp(self.x[0], self.x[1]);
        let away = x.hypot(self.z);
        let sine = |y: f64| y / away.hypot(y);
        let (low, high) = (sine(self.y[0]), sine(self.y[1]));
        let s = low + v * (high - low);
        let y = (s * away / (1.0 - s * s).sqrt()).clamp(self.y[0], self.y[1]);
        let [along, beside, across] = self.axes;
        self.place + along * x + beside * y + across * self.z
    }

    /// Density by area of a point that is uniform by area over that of [`SphericalRectangle::point`]:
    /// Ω d³/(A |z|).
    pub(super) fn weight(&self, at: DVec3) -> f64 {
        let area_m2 = (self.x[1] - self.x[0]) * (self.y[1] - self.y[0]);
        let distance_m = at.distance(self.place);
        self.solid_angle_sr * distance_m.powi(3) / (area_m2 * -self.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    /// Catches: points off the rectangle, a solid angle that is not that of its triangles, points that are not
    /// uniform in it (their moments against points by area).
    #[test]
    fn points_are_uniform_in_solid_angle() {
        let (a, b) = (DVec3::new(0.6, 0.0, 0.0), DVec3::new(0.0, 0.0, 0.15));
        let centre = DVec3::new(1.0, 2.0, 3.0);
        for place in
            [[1.1, 1.9, 3.05], [1.0, 2.3, 3.151], [2.0, 1.2, 2.2], [1.3, 2.001, 2.8], [-0.5, 2.6, 3.0]]
        {
            let place = DVec3::from_array(place);
            let near = SphericalRectangle::near(place, centre, a, b).expect("near");
            // tan(Ω/2) = v1·(v2×v3)/(1 + v1·v2 + v2·v3 + v3·v1) of two triangles (Van Oosterom, Strackee 1983).
            let unit = |s: f64, t: f64| (centre + a * s + b * t - place).normalize();
            let triangle = |p: DVec3, q: DVec3, r: DVec3| {
                2.0 * p.dot(q.cross(r)).abs().atan2(1.0 + p.dot(q) + q.dot(r) + r.dot(p))
            };
            let (p, q, r, s) = (unit(-1.0, -1.0), unit(1.0, -1.0), unit(1.0, 1.0), unit(-1.0, 1.0));
            let expected_sr = triangle(p, q, r) + triangle(p, r, s);
            assert!(
                (near.solid_angle_sr / expected_sr - 1.0).abs() < 1e-6,
                "{} {expected_sr}",
                near.solid_angle_sr
            );
            let (mut rng, n) = (Rng::new(1, 2, 3), 200_000);
            let (mut drawn, mut squares, mut by_area) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
            for _ in 0..n {
                let at = near.point(rng.uniforms());
                let local = at - centre;
                assert!(local.y.abs() < 1e-9 && local.x.abs() <= 0.6 + 1e-9 && local.z.abs() <= 0.15 + 1e-9);
                let towards = (at - place).normalize();
                drawn += towards;
                squares += towards * towards;
            }
            // By area, on a fine grid.
            let steps = 1000;
            for k in 0..steps * steps {
                let part = |k: i32| (f64::from(k) + 0.5) / f64::from(steps) * 2.0 - 1.0;
                let at = centre + a * part(k / steps) + b * part(k % steps);
                by_area += (at - place).normalize() / near.weight(at);
            }
            by_area /= f64::from(steps * steps);
            drawn /= f64::from(n);
            let se = (squares / f64::from(n) - drawn * drawn).max(DVec3::ZERO).map(f64::sqrt)
                / f64::from(n).sqrt();
            assert!(
                ((drawn - by_area).abs() - se * 5.0 - DVec3::splat(2e-4)).max_element() < 0.0,
                "{place}: {drawn} drawn, {by_area} by area, ± {se}"
            );
        }
        assert!(SphericalRectangle::near(DVec3::new(1.0, 9.0, 3.0), centre, a, b).is_none(), "from afar");
    }
}
