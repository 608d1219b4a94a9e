//! The light-emitting surface of a luminaire: flat, or a convex body with the position at its centre.
//! Its *length* lies along +x of the luminaire frame, whatever a file format calls its axes. A flat one
//! faces −z; a body shines all around.
//!
//! Every point that is seen from a direction ω shines alike, L(ω) = I(ω)/A_p(ω), with A_p the projected
//! area. So a body gives ∫ L cosθ dA/d² over what is seen of it, and light that leaves in a direction
//! leaves from its outline in that direction: [`Opening::shine`], [`Opening::leaving`] and
//! [`Opening::along`] are the same light for a desk, a particle and an eye.

use glam::DVec3;

use super::body::Body;
use super::face::{Face, Onlooker};
use super::spherical_rectangle::SphericalRectangle;

/// The light-emitting surface of a luminaire, centred on its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opening {
    /// Far-field photometry only: all light leaves from one point.
    Point,
    /// A rectangle facing −z, or a box where it has luminous sides, whose top shines as well.
    Rect {
        /// Along the frame's x, m.
        length_m: f64,
        /// Along the frame's y, m.
        width_m: f64,
        /// Luminous height of the sides facing ±x, m.
        side_x_m: f64,
        /// Luminous height of the sides facing ±y, m.
        side_y_m: f64,
    },
    /// A box whose opposite sides differ.
    Sided {
        /// Along the frame's x, m.
        length_m: f64,
        /// Along the frame's y, m.
        width_m: f64,
        /// Luminous heights of the sides facing +x, +y, −x, −y, m.
        sides_m: [f64; 4],
    },
    /// A disc facing −z, or an upright cylinder when it has a luminous height.
    Disc {
        /// Diameter, m.
        diameter_m: f64,
        /// Luminous height, m.
        height_m: f64,
    },
    /// An ellipse facing −z, or an upright elliptic cylinder when it has a luminous height.
    Ellipse {
        /// Diameter along the frame's x, m.
        length_m: f64,
        /// Diameter along the frame's y, m.
        width_m: f64,
        /// Luminous height, m.
        height_m: f64,
    },
    /// An ellipsoid; a sphere where its diameters are equal.
    Ellipsoid {
        /// Diameter along the frame's x, m.
        length_m: f64,
        /// Diameter along the frame's y, m.
        width_m: f64,
        /// Diameter along the frame's z, m.
        height_m: f64,
    },
    /// A lying cylinder, its ends included.
    Tube {
        /// Along its axis, m.
        length_m: f64,
        /// Level diameter, m.
        width_m: f64,
        /// Upright diameter, m.
        height_m: f64,
        /// Its axis lies along y instead of x.
        across: bool,
    },
    /// An upright rectangle or ellipse that shines to both sides.
    Upright {
        /// Level edge, m.
        width_m: f64,
        /// Upright edge, m.
        height_m: f64,
        /// It faces ±y instead of ±x.
        across: bool,
        /// An ellipse.
        round: bool,
    },
}

/// A point of an opening that shines on a place.
#[derive(Clone, Copy, Debug)]
pub struct Shine {
    /// The point, luminaire frame, m.
    pub at: DVec3,
    /// Its weight: the mean of weight · I/d² over the unit square is ∫ L dω, and 1 for flat openings.
    pub weight: f64,
}

/// Where a ray meets an opening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Distance along the ray, m.
    pub distance_m: f64,
    /// The projected area A_p in m² by which the intensity towards the origin is to be divided.
    pub projected_m2: f64,
    /// The weight that [`Opening::shine`] gives to this point when seen from the ray's origin.
    pub weight: f64,
}

impl Opening {
    /// A rectangle facing −z.
    pub fn rect(length_m: f64, width_m: f64) -> Self {
        Self::Rect { length_m, width_m, side_x_m: 0.0, side_y_m: 0.0 }
    }

    /// A rectangle with luminous heights of the sides facing +x, +y, −x, −y.
    pub fn sided(length_m: f64, width_m: f64, sides_m: [f64; 4]) -> Self {
        let [east, north, west, south] = sides_m;
        if (east - west).abs() > 0.0 || (north - south).abs() > 0.0 {
            Self::Sided { length_m, width_m, sides_m }
        } else {
            Self::Rect { length_m, width_m, side_x_m: east, side_y_m: north }
        }
    }

    /// No extent that could be seen: all light leaves from one point.
    pub fn is_point(&self) -> bool {
        match self.plane() {
            Some(plane) => !(plane.plane_area_m2() > 0.0),
            None => self.body().is_none(),
        }
    }

    /// Area in m² as seen from γ = 0: that of a plane facing down; 0 for a point and an upright plane.
    pub fn area_m2(&self) -> f64 {
        self.projected_area_m2(DVec3::NEG_Z)
    }

    /// Area in m² seen from a unit direction of the luminaire frame, for boxes and upright cylinders
    /// A_p = l·w·|cosγ| + (w·h_x·|cosφ| + l·h_y·|sinφ|)·sinγ and π d²/4·|cosγ| + d·h·sinγ.
    /// A flat opening that faces down is not seen from above (γ > 90°).
    pub fn projected_area_m2(&self, direction: DVec3) -> f64 {
        match (self.plane(), self.body()) {
            (Some(plane), _) if matches!(self, Self::Upright { .. }) => two_sided_m2(&plane, direction),
            (Some(plane), _) => plane.projected_area_m2(direction),
            (None, Some(body)) => body.projected_area_m2(direction),
            (None, None) => 0.0,
        }
    }

    /// A_p in m² by which a ray along ±`direction` that meets the opening divides the intensity; 0 for a
    /// point. Unlike [`Opening::projected_area_m2`] a flat opening is seen from both sides.
    pub fn seen_m2(&self, direction: DVec3) -> f64 {
        match self.plane() {
            Some(plane) => two_sided_m2(&plane, direction),
            None => self.projected_area_m2(direction),
        }
    }

    /// No luminous sides.
    pub fn is_flat(&self) -> bool {
        self.body().is_none()
    }

    /// A point of the opening that shines on `place` (luminaire frame); `None` where nothing of it is
    /// seen from there.
    ///
    /// Flat: uniform by area, weight 1. A body with the visible area V(p), projected along the direction
    /// w of the place p from its centre: uniform in that, so that the weight of a point with normal n
    /// that sends ω to the place is V · (n·ω) / ((n·w) A_p(ω)).
    #[inline]
    pub fn shine(&self, place: DVec3, u: [f64; 2]) -> Option<Shine> {
        match self.body() {
            None => Some(Shine { at: self.plane_point(u), weight: 1.0 }),
            Some(body) => {
                let eye = Onlooker::at(place);
                let seen_m2 = body.visible_m2(eye);
                let (piece, u) = body.choose(&seen_m2, u)?;
                body.shine_of(piece, seen_m2.iter().sum(), place, u)
            }
        }
    }

    /// [`Opening::shine`] for random points: a flat rectangle from near by is uniform in the solid angle Ω that it
    /// fills, a point's weight Ω d²/(A cos θ), so that light right beside it does not scatter without limit.
    #[inline]
    pub fn shine_evenly(&self, place: DVec3, u: [f64; 2]) -> Option<Shine> {
        match self.near(place) {
            Some(near) => {
                let at = near.point(u);
                Some(Shine { at, weight: near.weight(at) })
            }
            None => self.shine(place, u),
        }
    }

    /// Whether all of it lies in the plane z = 0 of the luminaire, and has a size.
    pub fn is_level(&self) -> bool {
        matches!(self, Self::Rect { .. } | Self::Disc { .. } | Self::Ellipse { .. }) && self.pieces() == 0
    }

    /// Number of smooth pieces of a body, of which [`Opening::shine_of_piece`] knows each; 0 if flat.
    pub fn pieces(&self) -> usize {
        self.body().map_or(0, |body| body.count)
    }

    /// The share of one piece in [`Opening::shine`]: the sum over all pieces of the means over the unit
    /// square is the mean of `shine`. `None` where the piece is hidden.
    pub fn shine_of_piece(&self, piece: usize, place: DVec3, u: [f64; 2]) -> Option<Shine> {
        let body = self.body()?;
        let seen_m2 = body.faces[piece].visible_m2(Onlooker::at(place));
        body.shine_of(piece, seen_m2, place, u)
    }

    /// The point from which light leaves in a unit direction, uniform in the area projected along it.
    pub fn leaving(&self, direction: DVec3, u: [f64; 2]) -> DVec3 {
        let Some(body) = self.body() else { return self.plane_point(u) };
        let eye = Onlooker::far(direction);
        let chosen = body.choose(&body.visible_m2(eye), u);
        chosen.map_or(DVec3::ZERO, |(index, u)| body.faces[index].visible_point(eye, u).0)
    }

    /// Where a ray (luminaire frame, unit direction) meets the opening. A flat opening is met from both
    /// sides; from within a body nothing is met.
    pub fn along(&self, origin: DVec3, direction: DVec3) -> Option<Met> {
        if let Some(plane @ Face::Plane { normal, .. }) = self.plane() {
            let t = -origin.dot(normal) / direction.dot(normal);
            let met = t > 0.0 && t.is_finite() && plane.covers(origin + direction * t);
            let projected_m2 = two_sided_m2(&plane, direction);
            return (met && plane.plane_area_m2() > 0.0).then_some(Met {
                distance_m: t,
                projected_m2,
                weight: 1.0,
            });
        }
        let body = self.body()?;
        let entered = |face: &Face| face.entered_at(origin, direction).map(|t| (t, *face));
        let entered = body.faces[..body.count].iter().filter_map(entered);
        let (distance_m, face) = entered.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let normal = face.normal_at(origin + direction * distance_m);
        let seen_m2: f64 = body.visible_m2(Onlooker::at(origin)).iter().sum();
        let weight = body.weight(seen_m2, normal, origin, -direction);
        Some(Met { distance_m, projected_m2: body.projected_area_m2(-direction), weight })
    }

    /// A flat rectangle as it fills the view from a place near by.
    #[inline]
    fn near(&self, place: DVec3) -> Option<SphericalRectangle> {
        match self.plane()? {
            Face::Plane { centre, a, b, round: false, .. } => SphericalRectangle::near(place, centre, a, b),
            _ => None,
        }
    }

    /// The area-uniform point of a flat opening; the origin for a point.
    pub fn plane_point(&self, u: [f64; 2]) -> DVec3 {
        self.plane().map_or(DVec3::ZERO, |plane| plane.plane_point(u))
    }

    /// The one plane of a flat opening.
    #[inline]
    fn plane(&self) -> Option<Face> {
        let level = |length_m: f64, width_m: f64, round: bool| Face::Plane {
            centre: DVec3::ZERO,
            a: DVec3::X * (0.5 * length_m),
            b: DVec3::Y * (0.5 * width_m),
            normal: DVec3::NEG_Z,
            round,
        };
        match *self {
            Self::Rect { length_m, width_m, side_x_m, side_y_m } if !(side_x_m.max(side_y_m) > 0.0) => {
                Some(level(length_m, width_m, false))
            }
            Self::Disc { diameter_m, height_m } if !(height_m > 0.0) => {
                Some(level(diameter_m, diameter_m, true))
            }
            Self::Ellipse { length_m, width_m, height_m } if !(height_m > 0.0) => {
                Some(level(length_m, width_m, true))
            }
            Self::Upright { width_m, height_m, across, round } => {
                let (level, normal) = if across { (DVec3::X, DVec3::Y) } else { (DVec3::Y, DVec3::X) };
                let (a, b) = (level * (0.5 * width_m), DVec3::Z * (0.5 * height_m));
                Some(Face::Plane { centre: DVec3::ZERO, a, b, normal, round })
            }
            _ => None,
        }
    }

    /// The pieces of an opening that is not flat.
    #[inline]
    fn body(&self) -> Option<Body> {
        let upright = |length_m: f64, width_m: f64, height_m: f64| {
            let (a, b) = (DVec3::X * (0.5 * length_m), DVec3::Y * (0.5 * width_m));
            Body::cylinder(DVec3::Z * (0.5 * height_m), a, b)
        };
        match *self {
            Self::Rect { length_m, width_m, side_x_m, side_y_m } if side_x_m.max(side_y_m) > 0.0 => {
                Some(Body::cuboid(length_m, width_m, [side_x_m, side_y_m, side_x_m, side_y_m]))
            }
            Self::Sided { length_m, width_m, sides_m } => Some(Body::cuboid(length_m, width_m, sides_m)),
            Self::Disc { diameter_m, height_m } if height_m > 0.0 => {
                Some(upright(diameter_m, diameter_m, height_m))
            }
            Self::Ellipse { length_m, width_m, height_m } if height_m > 0.0 => {
                Some(upright(length_m, width_m, height_m))
            }
            Self::Ellipsoid { length_m, width_m, height_m } => {
                let semi = 0.5 * DVec3::new(length_m, width_m, height_m);
                Some(Body { faces: [Face::Ellipsoid { semi }; 6], count: 1 })
            }
            Self::Tube { length_m, width_m, height_m, across } => {
                let (axis, level) = if across { (DVec3::Y, DVec3::X) } else { (DVec3::X, DVec3::Y) };
                let (a, b) = (level * (0.5 * width_m), DVec3::Z * (0.5 * height_m));
                Some(Body::cylinder(axis * (0.5 * length_m), a, b))
            }
            _ => None,
        }
    }
}

/// A plane's projected area from either side, m².
fn two_sided_m2(plane: &Face, direction: DVec3) -> f64 {
    plane.projected_area_m2(direction) + plane.projected_area_m2(-direction)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const BATTEN: Opening = Opening::Rect { length_m: 1.2, width_m: 0.1, side_x_m: 0.02, side_y_m: 0.05 };

    /// Catches: length and width swapped, a side's height multiplied by its own edge.
    #[test]
    fn projected_area_along_the_axes() {
        let area = |direction: DVec3| BATTEN.projected_area_m2(direction);
        assert!((area(DVec3::NEG_Z) - 0.12).abs() < 1e-15);
        assert!((area(DVec3::X) - 0.1 * 0.02).abs() < 1e-15);
        assert!((area(DVec3::NEG_Y) - 1.2 * 0.05).abs() < 1e-15);
        let disc = Opening::Disc { diameter_m: 0.4, height_m: 0.1 };
        let oblique = DVec3::new(0.0, 0.6, -0.8);
        assert!((disc.projected_area_m2(oblique) - (PI * 0.04 * 0.8 + 0.04 * 0.6)).abs() < 1e-15);
    }

    /// Catches: a recessed panel that shines through the ceiling.
    #[test]
    fn flat_openings_are_dark_from_above() {
        let flat = Opening::Rect { length_m: 0.6, width_m: 0.6, side_x_m: 0.0, side_y_m: 0.0 };
        assert!(flat.projected_area_m2(DVec3::Z).abs() < 1e-300);
        assert!(BATTEN.projected_area_m2(DVec3::Z) > 0.1);
        assert!(Opening::Point.projected_area_m2(DVec3::NEG_Z).abs() < 1e-300);
    }

    /// Catches: a disc sampled uniformly in radius (mean r² would be R²/3, not R²/2).
    #[test]
    fn points_are_uniform_by_area() {
        let disc = Opening::Disc { diameter_m: 2.0, height_m: 0.0 };
        let n = 64;
        let at = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
        let sum: f64 = (0..n * n).map(|k| disc.plane_point([at(k / n), at(k % n)]).length_squared()).sum();
        assert!((sum / f64::from(n * n) - 0.5).abs() < 1e-12);
        let panel = Opening::rect(1.2, 0.1);
        assert!((panel.plane_point([0.0, 1.0]) - DVec3::new(-0.6, 0.05, 0.0)).length() < 1e-15);
    }
}
