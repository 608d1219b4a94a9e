//! Projections: pixel ↔ direction, and the solid angle of a pixel by the projection's Jacobian.
//! Images are drawn as the eye sees them: columns run to the eye's right, rows down.
//!
//! Each projection maps a direction at the angle θ from the view direction to the radius r on an
//! image plane; solid angle per area of that plane:
//!
//! | projection | r | dω / dA |
//! |---|---|---|
//! | perspective | tan θ | cos³ θ |
//! | angular fisheye | θ | sin θ / θ |
//! | hemispherical fisheye | sin θ | 1 / cos θ |

use std::f64::consts::PI;

use glam::DVec3;

use super::ImageError;
use super::raster::Raster;

/// How directions become places, with the full angles from edge to edge of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Straight lines stay straight; both angles under 180°.
    Perspective {
        /// Horizontal angle, degrees.
        horizontal_deg: f64,
        /// Vertical angle, degrees.
        vertical_deg: f64,
    },
    /// Distance from the centre is proportional to the angle (equidistant); at most 360°.
    AngularFisheye {
        /// Horizontal angle, degrees.
        horizontal_deg: f64,
        /// Vertical angle, degrees.
        vertical_deg: f64,
    },
    /// Distance from the centre is the sine of the angle (orthographic), at most 180°: equal areas
    /// of the image weigh equally in the illuminance of the eye.
    HemisphericalFisheye {
        /// Horizontal angle, degrees.
        horizontal_deg: f64,
        /// Vertical angle, degrees.
        vertical_deg: f64,
    },
}

impl Projection {
    /// Half the extents of the image plane.
    fn half_extents(self) -> [f64; 2] {
        match self {
            Self::Perspective { horizontal_deg, vertical_deg } => {
                [horizontal_deg, vertical_deg].map(|angle| (0.5 * angle).to_radians().tan())
            }
            Self::AngularFisheye { horizontal_deg, vertical_deg } => {
                [horizontal_deg, vertical_deg].map(|angle| (0.5 * angle).to_radians())
            }
            Self::HemisphericalFisheye { horizontal_deg, vertical_deg } => {
                [horizontal_deg, vertical_deg].map(|angle| (0.5 * angle).to_radians().sin())
            }
        }
    }

    /// Largest angle from the view direction that belongs to the image: a fisheye of 180° or more is
    /// round, a smaller one is the rectangle cut out of a round one.
    fn largest_theta(self) -> f64 {
        match self {
            Self::Perspective { .. } | Self::HemisphericalFisheye { .. } => 0.5 * PI,
            Self::AngularFisheye { horizontal_deg, vertical_deg } => {
                (0.5 * horizontal_deg.max(vertical_deg)).to_radians().clamp(0.5 * PI, PI)
            }
        }
    }

    /// The same angle across, and the height that makes pixels square in an image of `size`. It may
    /// be an angle that the projection does not have; [`View::new`] refuses it then.
    #[must_use]
    pub fn with_square_pixels(self, size: [usize; 2]) -> Self {
        let ratio = size[1] as f64 / size[0] as f64;
        let stretched = |angle: f64, plane: fn(f64) -> f64, back: fn(f64) -> f64| {
            if size[0] == size[1] {
                angle
            } else {
                2.0 * back(plane((0.5 * angle).to_radians()) * ratio).to_degrees()
            }
        };
        match self {
            Self::Perspective { horizontal_deg, .. } => {
                let vertical_deg = stretched(horizontal_deg, f64::tan, f64::atan);
                Self::Perspective { horizontal_deg, vertical_deg }
            }
            Self::AngularFisheye { horizontal_deg, .. } => {
                Self::AngularFisheye { horizontal_deg, vertical_deg: horizontal_deg * ratio }
            }
            Self::HemisphericalFisheye { horizontal_deg, .. } => {
                let vertical_deg = stretched(horizontal_deg, f64::sin, f64::asin);
                Self::HemisphericalFisheye { horizontal_deg, vertical_deg }
            }
        }
    }

    fn check(self) -> Result<(), ImageError> {
        let (angles, most, open) = match self {
            Self::Perspective { horizontal_deg, vertical_deg } => {
                ([horizontal_deg, vertical_deg], 180.0, true)
            }
            Self::AngularFisheye { horizontal_deg, vertical_deg } => {
                ([horizontal_deg, vertical_deg], 360.0, false)
            }
            Self::HemisphericalFisheye { horizontal_deg, vertical_deg } => {
                ([horizontal_deg, vertical_deg], 180.0, false)
            }
        };
        for angle in angles {
            if !(angle > 0.0 && angle <= most && !(open && angle >= most)) {
                let limit = if open { "less than" } else { "at most" };
                return Err(ImageError::View(format!(
                    "an angle of {angle}°: it must be above 0° and {limit} {most}°"
                )));
            }
        }
        Ok(())
    }
}

/// A projection placed in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// How directions become places.
    pub projection: Projection,
    /// Where the eye is, m.
    pub eye: DVec3,
    /// By how much of its width and height the image is cut out to the right and upwards.
    pub shift: [f64; 2],
    direction: DVec3,
    right: DVec3,
    up: DVec3,
}

impl View {
    /// A view from `eye` along `direction`; `up` points upwards in the image as far as it can.
    ///
    /// # Errors
    /// [`ImageError::View`] if an angle does not suit the projection, or up and direction are parallel.
    pub fn new(projection: Projection, eye: DVec3, direction: DVec3, up: DVec3) -> Result<Self, ImageError> {
        projection.check()?;
        let (forward, above) = (direction.normalize_or_zero(), up.normalize_or_zero());
        let right = forward.cross(above);
        if !(eye.is_finite() && right.length() > 1e-6) {
            let message = format!("direction {direction} and up {up} do not make a view");
            return Err(ImageError::View(message));
        }
        let right = right.normalize();
        let up = right.cross(forward);
        Ok(Self { projection, eye, shift: [0.0; 2], direction: forward, right, up })
    }

    /// Unit vector of the centre of view.
    pub fn forward(&self) -> DVec3 {
        self.direction
    }

    /// Unit vector that points upwards in the image.
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Unit vector that points to the right in the image.
    pub fn right(&self) -> DVec3 {
        self.right
    }

    /// [`Raster::direction`] in an image of `size`.
    pub fn direction(&self, size: [usize; 2], at: [f64; 2]) -> Option<DVec3> {
        self.raster(size).direction(at)
    }

    /// Place at which a direction appears; `None` outside the projection. Places beyond `size` are
    /// outside the image.
    pub fn place(&self, size: [usize; 2], direction: DVec3) -> Option<[f64; 2]> {
        let d = direction.normalize_or_zero();
        let [x, y, cos] = [d.dot(self.right), d.dot(self.up), d.dot(self.direction)];
        let sin = x.hypot(y);
        let radius_per_sine = match self.projection {
            Projection::Perspective { .. } => (cos > 1e-12).then(|| 1.0 / cos)?,
            Projection::AngularFisheye { .. } => {
                let theta = sin.atan2(cos);
                if theta > self.projection.largest_theta() + 1e-12 {
                    return None;
                }
                if sin > 1e-12 { theta / sin } else { 1.0 }
            }
            Projection::HemisphericalFisheye { .. } => (cos >= 0.0).then_some(1.0)?,
        };
        let half = self.projection.half_extents();
        let u = 0.5 + 0.5 * x * radius_per_sine / half[0] - self.shift[0];
        let v = 0.5 + 0.5 * y * radius_per_sine / half[1] - self.shift[1];
        Some([u * size[0] as f64, (1.0 - v) * size[1] as f64])
    }

    /// [`Raster::solid_angles_sr`] in an image of `size`.
    pub fn solid_angles_sr(&self, size: [usize; 2], pixel: [usize; 2]) -> [f64; 2] {
        self.raster(size).solid_angles_sr(pixel)
    }

    /// The pixels of an image of `size`.
    pub fn raster(&self, size: [usize; 2]) -> Raster {
        let Self { projection, shift, direction, right, up, .. } = *self;
        let largest_radius = match projection {
            Projection::Perspective { .. } => f64::INFINITY,
            Projection::AngularFisheye { .. } => projection.largest_theta(),
            Projection::HemisphericalFisheye { .. } => 1.0,
        };
        Raster::new(
            projection,
            [right, up, direction],
            projection.half_extents(),
            shift,
            size,
            largest_radius,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn views() -> Vec<(View, [usize; 2])> {
        let view = |projection| {
            View::new(projection, DVec3::ZERO, DVec3::new(1.0, 2.0, -0.3), DVec3::Z).expect("a view")
        };
        vec![
            (view(Projection::Perspective { horizontal_deg: 90.0, vertical_deg: 60.0 }), [90, 52]),
            (view(Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 }), [100, 100]),
            (view(Projection::AngularFisheye { horizontal_deg: 60.0, vertical_deg: 40.0 }), [60, 44]),
            (view(Projection::AngularFisheye { horizontal_deg: 360.0, vertical_deg: 360.0 }), [100, 100]),
            (view(Projection::HemisphericalFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 }), [81, 80]),
        ]
    }

    fn sums(view: &View, size: [usize; 2]) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for row in 0..size[1] {
            for column in 0..size[0] {
                let [plain, projected] = view.solid_angles_sr(size, [column, row]);
                sums[0] += plain;
                sums[1] += projected;
            }
        }
        sums
    }

    /// Catches: a mirrored or upside-down image, a half-pixel shift, an inverse that is none.
    #[test]
    fn places_and_directions_are_each_others_inverse() {
        for (mut view, size) in views() {
            for shift in [[0.0, 0.0], [0.25, -0.1]] {
                view.shift = shift;
                let mut seen = 0;
                for row in 0..size[1] {
                    for column in 0..size[0] {
                        let at = [column as f64 + 0.3, row as f64 + 0.8];
                        let Some(direction) = view.direction(size, at) else { continue };
                        assert!((direction.length() - 1.0).abs() < 1e-12);
                        let back = view.place(size, direction).expect("seen");
                        assert!((back[0] - at[0]).abs() + (back[1] - at[1]).abs() < 1e-6, "{at:?} {back:?}");
                        seen += 1;
                    }
                }
                assert!(seen > size[0] * size[1] / 2);
            }
        }
        // Who looks north has east at the right and the zenith above.
        let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
        let view = View::new(projection, DVec3::ZERO, DVec3::Y, DVec3::Z).expect("a view");
        let east = view.place([100, 100], DVec3::new(1.0, 1.0, 0.0)).expect("in front");
        assert!((east[0] - 75.0).abs() < 1e-9 && (east[1] - 50.0).abs() < 1e-9, "{east:?}");
        let above = view.place([100, 100], DVec3::new(0.0, 1.0, 1.0)).expect("in front");
        assert!((above[0] - 50.0).abs() < 1e-9 && (above[1] - 25.0).abs() < 1e-9, "{above:?}");
    }

    /// Catches: a wrong Jacobian, pixels of a fisheye's edge counted whole or not at all.
    /// A pyramid of half angles a, b fills 4 asin(sin a sin b) sr.
    #[test]
    fn pixels_fill_the_solid_angle_of_the_projection() {
        let views = views();
        let pyramid = 4.0 * (45f64.to_radians().sin() * 30f64.to_radians().sin()).asin();
        let plain = [Some(pyramid), Some(2.0 * PI), None, Some(4.0 * PI), Some(2.0 * PI)];
        let projected = [None, Some(PI), None, Some(PI), Some(PI)];
        for (index, (view, size)) in views.iter().enumerate() {
            let found = sums(view, *size);
            let fine = sums(view, size.map(|n| 2 * n));
            for (expected, found, fine) in
                [(plain[index], found[0], fine[0]), (projected[index], found[1], fine[1])]
            {
                if let Some(expected) = expected {
                    assert!((found / expected - 1.0).abs() < 3e-3, "view {index}: {found} is not {expected}");
                    assert!((fine / expected - 1.0).abs() < 1e-3, "view {index}: {fine} is not {expected}");
                }
            }
        }
        // Broken twin: the Jacobian of another projection is told apart.
        let angular = View {
            projection: Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 },
            ..views[4].0
        };
        assert!((sums(&angular, [80, 80])[0] - 4.0 * PI).abs() > 1.0);
    }

    /// Catches: a rectangle cut out of a fisheye whose corners are lost, or a wrong angle of it.
    #[test]
    fn a_part_of_a_fisheye_sees_the_same_solid_angle_as_within_the_whole() {
        let (part, size) = views()[2];
        let (whole, _) = views()[1];
        let found = sums(&part, size)[0];
        // The same pixels of a whole fisheye at 1° a pixel: 60 × 40 of 180 × 180.
        let mut expected = 0.0;
        for row in 70..110 {
            for column in 60..120 {
                expected += whole.solid_angles_sr([180, 180], [column, row])[0];
            }
        }
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} is not {expected}");
    }

    /// Catches: views that divide by zero later.
    #[test]
    fn impossible_views_are_refused() {
        let fisheye = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
        assert!(View::new(fisheye, DVec3::ZERO, DVec3::Z, DVec3::Z).is_err());
        assert!(View::new(fisheye, DVec3::ZERO, DVec3::ZERO, DVec3::Z).is_err());
        assert!(View::new(fisheye, DVec3::NAN, DVec3::X, DVec3::Z).is_err());
        for angle in [0.0, -5.0, f64::NAN, 180.0] {
            let flat = Projection::Perspective { horizontal_deg: angle, vertical_deg: 40.0 };
            assert!(View::new(flat, DVec3::ZERO, DVec3::X, DVec3::Z).is_err(), "{angle}");
        }
    }
}
