//! A zone of the field of view: what lies between two cones about a direction, as far as it lies before the eye.
//! Its response is the same everywhere in it, so E/π is its mean luminance, and it ends at a sharp edge: what the
//! edge cuts must be sampled, since a quadrature that straddles it would miss how much lies inside.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use glam::DVec3;

use crate::sphere;

/// Directions between two angles from an axis and before the plane of an eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zone {
    axis: DVec3,
    front: DVec3,
    /// Squared chords of the outer and the inner angle, 4 sin²(θ/2) = 2 − 2 cos θ: they tell small angles apart, and
    /// none is below that of the axis itself, where a product of unit vectors may exceed 1.
    chords2: [f64; 2],
    /// Solid angle of what lies before the eye, sr.
    size_sr: f64,
    /// Whether the eye's plane cuts some of it off.
    cut: bool,
}

impl Zone {
    /// Directions from `from_deg` to `to_deg` of the unit `axis`, as far as they lie on the side of the unit `front`;
    /// `None` where nothing of them does.
    pub fn new(axis: DVec3, front: DVec3, [from_deg, to_deg]: [f64; 2]) -> Option<Self> {
        let aside_rad = axis.angle_between(front);
        let size_sr =
            cap_before_sr(to_deg.to_radians(), aside_rad) - cap_before_sr(from_deg.to_radians(), aside_rad);
        let chords2 = [to_deg, from_deg].map(|deg: f64| 4.0 * (0.5 * deg.to_radians()).sin().powi(2));
        let cut = aside_rad + to_deg.to_radians() > 0.5 * PI;
        (size_sr > 0.0).then_some(Self { axis, front, chords2, size_sr, cut })
    }

    /// Solid angle of what lies before the eye, sr.
    pub fn size_sr(&self) -> f64 {
        self.size_sr
    }

    /// Whether the plane of the eye cuts some of it off.
    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// Whether a unit direction lies in it.
    pub fn contains(&self, direction: DVec3) -> bool {
        self.is_between(direction) && (!self.cut || self.front.dot(direction) > 0.0)
    }

    fn is_between(&self, direction: DVec3) -> bool {
        let [outer, inner] = self.chords2;
        (inner..=outer).contains(&self.axis.distance_squared(direction))
    }

    /// π over its solid angle in it, 0 elsewhere.
    pub(super) fn response(&self, direction: DVec3) -> f64 {
        if self.contains(direction) { PI / self.size_sr } else { 0.0 }
    }

    /// Uniform between the cones, what lies behind the eye included.
    pub(super) fn pdf(&self, direction: DVec3) -> f64 {
        let [outer, inner] = self.chords2;
        if self.is_between(direction) { FRAC_1_PI / (outer - inner) } else { 0.0 }
    }

    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        let [outer, inner] = self.chords2;
        // 1 − cos θ, uniform between the cones.
        let rise = 0.5 * (outer + u * (inner - outer));
        let sin = (rise * (2.0 - rise)).max(0.0).sqrt();
        let (s, c) = (TAU * v).sin_cos();
        sphere::frame(self.axis) * DVec3::new(sin * c, sin * s, 1.0 - rise)
    }
}

/// Solid angle in sr of the part of a cone with this half-angle β < 90° that lies on one side of a plane through its
/// apex, its axis at the angle α from the plane's normal. Cut by the plane,
///
///   Ω = 2π − 2 arccos(cos α / sin β) − 2 cos β arccos(−cot α cot β)
///
/// (two spherical caps of which one is a hemisphere, by Gauss and Bonnet).
fn cap_before_sr(half_rad: f64, aside_rad: f64) -> f64 {
    if !(half_rad > 0.0) || aside_rad - half_rad >= 0.5 * PI {
        return 0.0;
    }
    let (sin, cos) = half_rad.sin_cos();
    if aside_rad + half_rad <= 0.5 * PI {
        return TAU * 2.0 * (0.5 * half_rad).sin().powi(2);
    }
    let (sin_aside, cos_aside) = aside_rad.sin_cos();
    let edge = (cos_aside / sin).clamp(-1.0, 1.0).acos();
    let azimuth = (-cos_aside * cos / (sin_aside * sin)).clamp(-1.0, 1.0).acos();
    TAU - 2.0 * edge - 2.0 * cos * azimuth
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a wrong part behind the eye, a hole that is not taken out, the angle for the half-angle.
    #[test]
    fn solid_angles_are_those_of_a_count_of_directions() {
        let axis = DVec3::new(0.48, 0.6, 0.64);
        for aside_deg in [0.0f64, 20.0, 45.0, 75.0, 90.0, 110.0] {
            let front = sphere::frame(axis)
                * DVec3::new(aside_deg.to_radians().sin(), 0.0, aside_deg.to_radians().cos());
            for angles_deg in [[0.0, 25.0], [10.0, 30.0], [30.0, 60.0]] {
                let (n, mut count) = (1500u32, 0u32);
                for i in 0..n {
                    for j in 0..n {
                        let u = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(n));
                        let d = sphere::uniform_sphere(u);
                        let angle_deg = axis.angle_between(d).to_degrees();
                        let inside = angle_deg >= angles_deg[0] && angle_deg <= angles_deg[1];
                        count += u32::from(inside && front.dot(d) > 0.0);
                    }
                }
                let counted_sr = f64::from(count) * 4.0 * PI / f64::from(n * n);
                let zone = Zone::new(axis, front, angles_deg);
                let size_sr = zone.map_or(0.0, |zone| zone.size_sr());
                assert!(
                    (size_sr - counted_sr).abs() < 1e-3,
                    "{aside_deg}° {angles_deg:?}: {size_sr} {counted_sr}"
                );
            }
        }
        let whole = Zone::new(DVec3::Z, DVec3::Z, [0.0, 60.0]).map(|zone| zone.size_sr());
        assert!(whole.is_some_and(|sr| (sr - PI).abs() < 1e-12), "a cone of 120° is π: {whole:?}");
    }

    /// Catches: what lies on the axis itself counted as within the inner cone, a cone that is too narrow for cosines.
    #[test]
    fn a_cone_holds_its_axis_and_what_is_drawn_in_it_however_narrow_it_is() {
        let inner = |angle_deg: f64| if angle_deg < 1.0 { 0.99 } else { 0.999_999 };
        for k in 0..200u32 {
            let axis =
                sphere::uniform_sphere([f64::from(k) / 200.0, f64::from(k) * 0.618_034 % 1.0]).normalize();
            for angle_deg in [1e-6, 1e-3, 5.0, 60.0] {
                let zone = Zone::new(axis, axis, [0.0, angle_deg]).expect("it is in sight");
                assert!(zone.contains(axis), "{axis} {angle_deg}°");
                assert!((zone.pdf(axis) * zone.size_sr() - 1.0).abs() < 1e-9, "{axis} {angle_deg}°");
                let drawn = zone.sample([1.0 - inner(angle_deg), 0.3]);
                assert!(zone.contains(drawn), "{axis} {angle_deg}°: {drawn}");
                let angle = axis.cross(drawn).length().asin().to_degrees();
                assert!(angle > 0.9 * angle_deg && angle <= angle_deg, "{angle}° of {angle_deg}°");
            }
        }
    }
}
