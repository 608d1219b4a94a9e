//! Extents of a luminous opening: names and sizes for files, the ball around it, its outline on plan.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Opening;

impl Opening {
    /// Its kind and its sizes in m, by name, for files and lists.
    pub fn sizes(&self) -> (&'static str, Vec<(&'static str, f64)>) {
        match *self {
            Self::Point => ("point", Vec::new()),
            Self::Rect { length_m, width_m, side_x_m, side_y_m } => {
                let sizes = [
                    ("length_m", length_m),
                    ("width_m", width_m),
                    ("side_x_m", side_x_m),
                    ("side_y_m", side_y_m),
                ];
                ("rect", sizes.to_vec())
            }
            Self::Sided { length_m, width_m, sides_m: [east, north, west, south] } => {
                let sides = [("side_east_m", east), ("side_north_m", north), ("side_west_m", west)];
                let mut sizes = vec![("length_m", length_m), ("width_m", width_m)];
                sizes.extend(sides);
                sizes.push(("side_south_m", south));
                ("sided", sizes)
            }
            Self::Disc { diameter_m, height_m } => {
                ("disc", vec![("diameter_m", diameter_m), ("height_m", height_m)])
            }
            Self::Ellipse { length_m, width_m, height_m } => {
                ("ellipse", named([length_m, width_m, height_m]))
            }
            Self::Ellipsoid { length_m, width_m, height_m } => {
                ("ellipsoid", named([length_m, width_m, height_m]))
            }
            Self::Tube { length_m, width_m, height_m, across } => {
                (if across { "tube_across" } else { "tube" }, named([length_m, width_m, height_m]))
            }
            Self::Upright { width_m, height_m, across, round } => {
                let name = match (across, round) {
                    (false, false) => "upright_rect",
                    (true, false) => "upright_rect_across",
                    (false, true) => "upright_ellipse",
                    (true, true) => "upright_ellipse_across",
                };
                (name, vec![("width_m", width_m), ("height_m", height_m)])
            }
        }
    }

    /// Radius in m of a ball about the centre that holds all of it.
    pub fn radius_m(&self) -> f64 {
        let half_diagonal = |x: f64, y: f64, z: f64| 0.5 * DVec3::new(x, y, z).length();
        match *self {
            Self::Point => 0.0,
            Self::Rect { length_m, width_m, side_x_m, side_y_m } => {
                half_diagonal(length_m, width_m, side_x_m.max(side_y_m))
            }
            Self::Sided { length_m, width_m, sides_m } => {
                half_diagonal(length_m, width_m, sides_m.into_iter().fold(0.0, f64::max))
            }
            Self::Disc { diameter_m, height_m } => half_diagonal(diameter_m, 0.0, height_m),
            Self::Ellipse { length_m, width_m, height_m } => {
                half_diagonal(length_m.max(width_m), 0.0, height_m)
            }
            Self::Ellipsoid { length_m, width_m, height_m } => 0.5 * length_m.max(width_m).max(height_m),
            Self::Tube { length_m, width_m, height_m, .. } => {
                half_diagonal(length_m, width_m.max(height_m), 0.0)
            }
            Self::Upright { width_m, height_m, .. } => half_diagonal(width_m, height_m, 0.0),
        }
    }

    /// Whether the opening is exactly the polygon of [`Opening::outline`] (and emits nothing sideways).
    pub fn is_polygon(&self) -> bool {
        matches!(*self, Self::Rect { side_x_m, side_y_m, .. } if !(side_x_m > 0.0 || side_y_m > 0.0))
    }

    /// Corners of the outline on the plan, counter-clockwise seen from +z: four of a rectangle, 32 of a
    /// round one (inscribed), none of a point.
    pub fn outline(&self) -> Vec<DVec3> {
        let (half, round) = match *self {
            Self::Point => return Vec::new(),
            Self::Rect { length_m, width_m, .. } | Self::Sided { length_m, width_m, .. } => {
                ([length_m, width_m], false)
            }
            Self::Disc { diameter_m, .. } => ([diameter_m; 2], true),
            Self::Ellipse { length_m, width_m, .. } | Self::Ellipsoid { length_m, width_m, .. } => {
                ([length_m, width_m], true)
            }
            Self::Tube { length_m, width_m, across: false, .. } => ([length_m, width_m], false),
            Self::Tube { length_m, width_m, across: true, .. } => ([width_m, length_m], false),
            Self::Upright { width_m, across: false, .. } => ([0.0, width_m], false),
            Self::Upright { width_m, across: true, .. } => ([width_m, 0.0], false),
        };
        let [x, y] = half.map(|edge| 0.5 * edge);
        if !round {
            return [(x, y), (-x, y), (-x, -y), (x, -y)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        }
        let corner = |k: i32| {
            let (sin, cos) = (TAU * f64::from(k) / 32.0).sin_cos();
            DVec3::new(x * cos, y * sin, 0.0)
        };
        (0..32).map(corner).collect()
    }
}

fn named(sizes_m: [f64; 3]) -> Vec<(&'static str, f64)> {
    ["length_m", "width_m", "height_m"].into_iter().zip(sizes_m).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BATTEN: Opening = Opening::Rect { length_m: 1.2, width_m: 0.1, side_x_m: 0.02, side_y_m: 0.05 };

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
