//! Pieces of the surface of a luminous body and how they are seen: every map here is uniform in the
//! area *projected towards the onlooker*, not in the surface's own area, so that the limb of a sphere
//! takes no more points than it shows.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::sphere;

/// A piece of a convex body that holds the origin; it shines outwards only.
#[derive(Clone, Copy, Debug)]
pub(super) enum Face {
    /// A rectangle or ellipse with half-axes `a` and `b` at right angles, facing `normal`.
    Plane { centre: DVec3, a: DVec3, b: DVec3, normal: DVec3, round: bool },
    /// The side of an elliptic cylinder about the origin: half its axis, and half-axes of its section.
    Mantle { axis: DVec3, a: DVec3, b: DVec3 },
    /// An ellipsoid about the origin with semi-axes along the frame's axes.
    Ellipsoid { semi: DVec3 },
}

/// Where a body is seen from: a unit direction from its centre and a distance in m, which may be
/// infinite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Onlooker {
    pub direction: DVec3,
    pub distance_m: f64,
}

impl Onlooker {
    /// At a point of the luminaire frame.
    pub(super) fn at(point: DVec3) -> Self {
        let distance_m = point.length();
        Self { direction: point / distance_m, distance_m }
    }

    /// In a direction, infinitely far away.
    pub(super) fn far(direction: DVec3) -> Self {
        Self { direction, distance_m: f64::INFINITY }
    }
}

impl Face {
    /// Area in m² projected along a unit direction, of the side that faces it.
    /// Ellipsoid π abc |w/s|; mantle of half-axes a, b and length l: 2 l √((b w_a)² + (a w_b)²).
    pub(super) fn projected_area_m2(&self, toward: DVec3) -> f64 {
        match *self {
            Self::Plane { normal, .. } => self.plane_area_m2() * normal.dot(toward).max(0.0),
            Self::Mantle { axis, a, b } => {
                4.0 * axis.length() * a.cross(b).length() * section(a, b, toward).length()
            }
            Self::Ellipsoid { semi } => PI * semi.element_product() * (toward / semi).length(),
        }
    }

    /// Area of a plane piece, m²; 0 for a curved one.
    pub(super) fn plane_area_m2(&self) -> f64 {
        match *self {
            Self::Plane { a, b, round, .. } => {
                let shape = if round { PI } else { 4.0 };
                shape * a.length() * b.length()
            }
            Self::Mantle { .. } | Self::Ellipsoid { .. } => 0.0,
        }
    }

    /// The part of [`Face::projected_area_m2`] that is seen from where the onlooker is: from nearby a
    /// sphere shows less than half of itself. 0 where it is hidden.
    pub(super) fn visible_m2(&self, eye: Onlooker) -> f64 {
        let whole_m2 = self.projected_area_m2(eye.direction);
        match *self {
            Self::Plane { centre, normal, .. } => {
                let seen = normal.dot(eye.direction) - normal.dot(centre) / eye.distance_m > 0.0;
                if seen { whole_m2 } else { 0.0 }
            }
            Self::Mantle { a, b, .. } => whole_m2 * cap(section(a, b, eye.direction).length(), eye).sqrt(),
            Self::Ellipsoid { semi } => whole_m2 * cap((eye.direction / semi).length(), eye),
        }
    }

    /// A point of the visible part, uniform in projected area, and the outward normal there.
    pub(super) fn visible_point(&self, eye: Onlooker, u: [f64; 2]) -> (DVec3, DVec3) {
        match *self {
            Self::Plane { normal, .. } => (self.plane_point(u), normal),
            Self::Mantle { axis, a, b } => {
                let towards = section(a, b, eye.direction);
                let (e, reach) = (towards.normalize(), cap(towards.length(), eye).sqrt());
                let sine = (2.0 * u[0] - 1.0) * reach;
                let y = e * (1.0 - sine * sine).sqrt() + e.perp() * sine;
                let normal = a * (y.x / a.length_squared()) + b * (y.y / b.length_squared());
                (a * y.x + b * y.y + axis * (2.0 * u[1] - 1.0), normal.normalize())
            }
            Self::Ellipsoid { semi } => {
                let towards = eye.direction / semi;
                let radius = (u[0] * cap(towards.length(), eye)).sqrt();
                let (sin, cos) = (TAU * u[1]).sin_cos();
                let local = DVec3::new(radius * cos, radius * sin, (1.0 - radius * radius).max(0.0).sqrt());
                let y = sphere::frame(towards.normalize()) * local;
                (semi * y, (y / semi).normalize())
            }
        }
    }

    /// Area-uniform map of the unit square onto a plane piece.
    pub(super) fn plane_point(&self, u: [f64; 2]) -> DVec3 {
        match *self {
            Self::Plane { centre, a, b, round: true, .. } => {
                let radius = u[0].sqrt();
                let (sin, cos) = (TAU * u[1]).sin_cos();
                centre + a * (radius * cos) + b * (radius * sin)
            }
            Self::Plane { centre, a, b, .. } => centre + a * (2.0 * u[0] - 1.0) + b * (2.0 * u[1] - 1.0),
            Self::Mantle { .. } | Self::Ellipsoid { .. } => DVec3::ZERO,
        }
    }

    /// Whether a point of a plane piece's plane lies in it.
    pub(super) fn covers(&self, point: DVec3) -> bool {
        let Self::Plane { centre, a, b, round, .. } = *self else { return false };
        let at = DVec2::new(
            (point - centre).dot(a) / a.length_squared(),
            (point - centre).dot(b) / b.length_squared(),
        );
        if round { at.length_squared() <= 1.0 } else { at.abs().max_element() <= 1.0 }
    }

    /// Outward unit normal at a point of the piece.
    pub(super) fn normal_at(&self, point: DVec3) -> DVec3 {
        match *self {
            Self::Plane { normal, .. } => normal,
            Self::Mantle { a, b, .. } => {
                let y = section(a, b, point);
                (a * (y.x / a.length_squared()) + b * (y.y / b.length_squared())).normalize()
            }
            Self::Ellipsoid { semi } => (point / (semi * semi)).normalize(),
        }
    }

    /// Distance along a ray to where it enters the body through this piece.
    pub(super) fn entered_at(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        match *self {
            Self::Plane { centre, normal, .. } => {
                let t = (centre - origin).dot(normal) / direction.dot(normal);
                (direction.dot(normal) < 0.0 && t > 0.0 && self.covers(origin + direction * t)).then_some(t)
            }
            Self::Mantle { axis, a, b } => {
                let (o, d) = (section(a, b, origin), section(a, b, direction));
                let t = first_root(d.length_squared(), o.dot(d), o.length_squared() - 1.0)?;
                ((origin + direction * t).dot(axis).abs() <= axis.length_squared()).then_some(t)
            }
            Self::Ellipsoid { semi } => {
                let (o, d) = (origin / semi, direction / semi);
                first_root(d.length_squared(), o.dot(d), o.length_squared() - 1.0)
            }
        }
    }
}

/// Coordinates across the axis in which an elliptic cylinder is a unit one.
fn section(a: DVec3, b: DVec3, v: DVec3) -> DVec2 {
    DVec2::new(v.dot(a) / a.length_squared(), v.dot(b) / b.length_squared())
}

/// 1 − 1/q², q the distance in radii of the body made round: the squared sine to which its limb is
/// seen; 0 from within.
fn cap(per_m: f64, eye: Onlooker) -> f64 {
    let q = per_m * eye.distance_m;
    if q > 1.0 { 1.0 - 1.0 / (q * q) } else { 0.0 }
}

/// The smaller root of a t² + 2 b t + c = 0, where it is positive: the way in.
fn first_root(a: f64, b: f64, c: f64) -> Option<f64> {
    let discriminant = b * b - a * c;
    let t = (-b - discriminant.sqrt()) / a;
    (discriminant > 0.0 && t > 0.0).then_some(t)
}
