//! The pixels of an image of a view. What is the same for all of them is worked out once, since pictures ask
//! for millions of directions.

use glam::DVec3;

use super::Projection;

/// Points along an edge of a pixel that the edge of a fisheye cuts.
const PARTS: u32 = 16;

/// The pixels of an image of a view.
#[derive(Clone, Copy, Debug)]
pub struct Raster {
    projection: Projection,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    /// Place of the upper left corner on the image plane, and the extents of a pixel there.
    corner: [f64; 2],
    pixel: [f64; 2],
    /// Places beyond this radius lie outside of the projection.
    largest_radius: f64,
    /// Whether the image is not cut out aside.
    is_centred: bool,
}

impl Raster {
    /// From the axes of a view to the right, up and forward, half the extents of its image plane, the part by
    /// which the image is cut out aside, and the image's size.
    pub(super) fn new(
        projection: Projection,
        [right, up, forward]: [DVec3; 3],
        half: [f64; 2],
        shift: [f64; 2],
        size: [usize; 2],
        largest_radius: f64,
    ) -> Self {
        let corner = [(2.0 * shift[0] - 1.0) * half[0], (2.0 * shift[1] + 1.0) * half[1]];
        let pixel = [2.0 * half[0] / size[0] as f64, 2.0 * half[1] / size[1] as f64];
        let is_centred = shift.iter().all(|part| *part == 0.0);
        Self { projection, right, up, forward, corner, pixel, largest_radius, is_centred }
    }

    /// Unit direction of the place `at` (columns from the left edge, rows from the upper one; the
    /// centre of the first pixel is at 0.5, 0.5); `None` outside the projection.
    pub fn direction(&self, at: [f64; 2]) -> Option<DVec3> {
        let [x, y] = self.on_plane(at);
        let (sin_per_radius, cos) = self.bent(length([x, y]))?;
        Some(self.right * (x * sin_per_radius) + self.up * (y * sin_per_radius) + self.forward * cos)
    }

    /// Whether the axis of the view is the middle of the image, so that its quarters are alike.
    pub fn is_centred(&self) -> bool {
        self.is_centred
    }

    /// Whether the place `at` lies within the projection.
    pub fn shows(&self, at: [f64; 2]) -> bool {
        length(self.on_plane(at)) <= self.largest_radius
    }

    /// Solid angle of a pixel in sr, and the same weighted with cos θ (its share of the illuminance
    /// of the eye; 0 behind it). Both are 0 outside the projection.
    ///
    /// ω = ∫ dω/dA dA over the pixel, by the midpoint where the Jacobian is smooth and by 16 × 16
    /// points where the edge of a fisheye cuts the pixel.
    pub fn solid_angles_sr(&self, pixel: [usize; 2]) -> [f64; 2] {
        let corner = pixel.map(|index| index as f64);
        let parts = if self.is_cut(corner) { PARTS } else { 1 };
        let step = 1.0 / f64::from(parts);
        let mut sums = [0.0; 2];
        for row in 0..parts {
            for column in 0..parts {
                let at =
                    [corner[0] + (f64::from(column) + 0.5) * step, corner[1] + (f64::from(row) + 0.5) * step];
                let Some((sin_per_radius, cos)) = self.bent(length(self.on_plane(at))) else { continue };
                // dω/dA and cos θ dω/dA; the latter is finite where the former is not.
                let (plain, projected) = match self.projection {
                    Projection::Perspective { .. } => (cos.powi(3), cos.powi(4)),
                    Projection::AngularFisheye { .. } => (sin_per_radius, sin_per_radius * cos.max(0.0)),
                    Projection::HemisphericalFisheye { .. } => (1.0 / cos.max(1e-6), 1.0),
                };
                sums[0] += plain;
                sums[1] += projected;
            }
        }
        sums.map(|sum| sum * self.pixel[0] * self.pixel[1] * step * step)
    }

    /// Place on the image plane.
    fn on_plane(&self, at: [f64; 2]) -> [f64; 2] {
        [self.corner[0] + at[0] * self.pixel[0], self.corner[1] - at[1] * self.pixel[1]]
    }

    /// sin θ per radius and cos θ at a radius on the image plane; `None` outside the projection.
    fn bent(&self, radius: f64) -> Option<(f64, f64)> {
        if radius > self.largest_radius {
            return None;
        }
        match self.projection {
            Projection::Perspective { .. } => {
                let cos = 1.0 / (1.0 + radius * radius).sqrt();
                Some((cos, cos))
            }
            Projection::AngularFisheye { .. } => {
                let (sin, cos) = radius.sin_cos();
                Some((if radius > 1e-9 { sin / radius } else { 1.0 }, cos))
            }
            Projection::HemisphericalFisheye { .. } => Some((1.0, (1.0 - radius * radius).sqrt())),
        }
    }

    /// Whether the edge of the projection lies within the pixel or near it.
    fn is_cut(&self, corner: [f64; 2]) -> bool {
        let radius = length(self.on_plane(corner.map(|x| x + 0.5)));
        let reach = 0.5 * length(self.pixel);
        // The Jacobian of the hemispherical fisheye is steep for some pixels inwards of its edge.
        let inwards =
            if matches!(self.projection, Projection::HemisphericalFisheye { .. }) { 16.0 } else { 1.0 };
        radius >= self.largest_radius - inwards * reach && radius <= self.largest_radius + reach
    }
}

/// √(x² + y²): image planes have no places so large or small that the squares fail.
fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}
