//! Photometric files → one domain type, [`IntensityDistribution`]: absolute candelas, expanded to
//! the full sphere, in the luminaire frame. Parsers take bytes and never read files.

use glam::DVec3;

/// Placeholder of the skeleton.
#[derive(Clone, Debug)]
pub struct IntensityDistribution {}

impl IntensityDistribution {
    /// I in cd along a unit direction of the luminaire frame (γ = 0 is −z, azimuth from +x to +y).
    pub fn intensity_along(&self, _direction: DVec3) -> f64 {
        unreachable!("skeleton")
    }
}

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
