//! The light-emitting area of a luminaire. Its *length* lies along +x of the luminaire frame,
//! whatever a file format calls its axes, and it faces −z: only luminous sides shine upwards.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// The light-emitting area of a luminaire, centred on its position, facing −z of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opening {
    /// Far-field photometry only: all light leaves from one point.
    Point,
    /// A rectangle; luminous sides raise the projected area near the horizon.
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
    /// A disc, or a cylinder when it has a luminous height.
    Disc {
        /// Diameter, m.
        diameter_m: f64,
        /// Luminous height, m.
        height_m: f64,
    },
}

impl Opening {
    /// Area of the plane part in m²; 0 for a point.
    pub fn area_m2(&self) -> f64 {
        match *self {
            Self::Point => 0.0,
            Self::Rect { length_m, width_m, .. } => length_m * width_m,
            Self::Disc { diameter_m, .. } => 0.25 * PI * diameter_m * diameter_m,
        }
    }

    /// Area in m² seen from a unit direction of the luminaire frame:
    /// A_p = l·w·|cosγ| + w·h_x·|x| + l·h_y·|y|, disc π d²/4·|cosγ| + d·h·sinγ.
    /// A flat opening is not seen from above (γ > 90°).
    pub fn projected_area_m2(&self, direction: DVec3) -> f64 {
        if self.is_flat() && direction.z > 0.0 {
            return 0.0;
        }
        let sides_m2 = match *self {
            Self::Point => 0.0,
            Self::Rect { length_m, width_m, side_x_m, side_y_m } => {
                width_m * side_x_m * direction.x.abs() + length_m * side_y_m * direction.y.abs()
            }
            Self::Disc { diameter_m, height_m } => diameter_m * height_m * direction.x.hypot(direction.y),
        };
        self.area_m2() * direction.z.abs() + sides_m2
    }

    /// No luminous sides.
    pub fn is_flat(&self) -> bool {
        match *self {
            Self::Point => true,
            Self::Rect { side_x_m, side_y_m, .. } => !(side_x_m > 0.0 || side_y_m > 0.0),
            Self::Disc { height_m, .. } => !(height_m > 0.0),
        }
    }

    /// Area-uniform map of the unit square onto the plane part (z = 0) in the luminaire frame;
    /// a point gives the origin.
    pub fn point(&self, u: [f64; 2]) -> DVec3 {
        match *self {
            Self::Point => DVec3::ZERO,
            Self::Rect { length_m, width_m, .. } => {
                DVec3::new((u[0] - 0.5) * length_m, (u[1] - 0.5) * width_m, 0.0)
            }
            Self::Disc { diameter_m, .. } => {
                let radius_m = 0.5 * diameter_m * u[0].sqrt();
                let (sin, cos) = (TAU * u[1]).sin_cos();
                DVec3::new(radius_m * cos, radius_m * sin, 0.0)
            }
        }
    }

    /// Whether a point of the plane z = 0 of the luminaire frame lies in the opening.
    pub fn contains(&self, at: DVec3) -> bool {
        match *self {
            Self::Point => false,
            Self::Rect { length_m, width_m, .. } => {
                at.x.abs() <= 0.5 * length_m && at.y.abs() <= 0.5 * width_m
            }
            Self::Disc { diameter_m, .. } => at.x.hypot(at.y) <= 0.5 * diameter_m,
        }
    }

    /// Whether the opening is exactly the polygon of [`Opening::outline`] (and emits nothing sideways).
    pub fn is_polygon(&self) -> bool {
        matches!(*self, Self::Rect { side_x_m, side_y_m, .. } if !(side_x_m > 0.0 || side_y_m > 0.0))
    }

    /// Corners of the plane part, counter-clockwise seen from +z: four of a rectangle, 32 of a disc
    /// (inscribed), none of a point.
    pub fn outline(&self) -> Vec<DVec3> {
        match *self {
            Self::Point => Vec::new(),
            Self::Rect { length_m, width_m, .. } => {
                let (x, y) = (0.5 * length_m, 0.5 * width_m);
                [(x, y), (-x, y), (-x, -y), (x, -y)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec()
            }
            Self::Disc { diameter_m, .. } => {
                let corner = |k: i32| {
                    let (sin, cos) = (TAU * f64::from(k) / 32.0).sin_cos();
                    0.5 * diameter_m * DVec3::new(cos, sin, 0.0)
                };
                (0..32).map(corner).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
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
        let sum: f64 = (0..n * n).map(|k| disc.point([at(k / n), at(k % n)]).length_squared()).sum();
        assert!((sum / f64::from(n * n) - 0.5).abs() < 1e-12);
        assert!((BATTEN.point([0.0, 1.0]) - DVec3::new(-0.6, 0.05, 0.0)).length() < 1e-15);
    }

    /// Catches: a clockwise or missing corner.
    #[test]
    fn outline_encloses_the_area() {
        for (opening, loss) in [(BATTEN, 1e-12), (Opening::Disc { diameter_m: 1.0, height_m: 0.0 }, 0.0065)] {
            let corners = opening.outline();
            let next = corners.iter().cycle().skip(1);
            let area: f64 = corners.iter().zip(next).map(|(a, b)| 0.5 * a.cross(*b).z).sum();
            assert!(area <= opening.area_m2() + 1e-12 && area >= opening.area_m2() * (1.0 - loss));
        }
    }
}
