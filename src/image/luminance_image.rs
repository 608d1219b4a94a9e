//! An image in cd/m², and what an eye at its centre of projection receives.

use rayon::prelude::*;

use super::{Raster, View};

/// Luminances seen through a view.
#[derive(Clone, Debug, PartialEq)]
pub struct LuminanceImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Where the pixels look; `None` if the file does not say, or not in a way that can be used.
    pub view: Option<View>,
    /// Row by row from the upper left, cd/m²; 0 outside the projection.
    pub luminance_cd_m2: Vec<f64>,
    /// Standard error of each pixel in cd/m², where the method states one.
    pub standard_error_cd_m2: Option<Vec<f64>>,
    /// What is to be known about the image: assumptions made in reading, or how it was computed.
    pub notes: Vec<String>,
}

impl LuminanceImage {
    /// An image without remarks.
    pub fn new(width: usize, height: usize, view: Option<View>, luminance_cd_m2: Vec<f64>) -> Self {
        assert_eq!(luminance_cd_m2.len(), width * height, "one luminance a pixel");
        Self { width, height, view, luminance_cd_m2, standard_error_cd_m2: None, notes: Vec::new() }
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Mean luminance in cd/m² of what the projection shows, Σ L ω / Σ ω over the pixels whose centres lie in it;
    /// of all pixels alike without a view.
    pub fn mean_cd_m2(&self) -> f64 {
        let Some(view) = self.view else {
            let sum: f64 = self.luminance_cd_m2.iter().sum();
            return sum / self.luminance_cd_m2.len().max(1) as f64;
        };
        let raster = view.raster(self.size());
        let [light, seen_sr] = self.sums(&raster, |pixel| {
            let is_shown = raster.shows(pixel.map(|place| place as f64 + 0.5));
            if is_shown { raster.solid_angles_sr(pixel)[0] } else { 0.0 }
        });
        if seen_sr > 0.0 { light / seen_sr } else { 0.0 }
    }

    /// Illuminance in lx on the plane of the eye, E_v = Σ L ω cos θ over what lies in front of it;
    /// `None` without a view. It is the whole E_v only if the view sees the whole half-space.
    pub fn illuminance_lx(&self) -> Option<f64> {
        let raster = self.view?.raster(self.size());
        Some(self.sums(&raster, |pixel| raster.solid_angles_sr(pixel)[1])[0])
    }

    /// Σ L w and Σ w over all pixels. Where the axis of the view is the middle of the image, mirrored pixels have
    /// the same w, and one quarter is asked for it.
    fn sums(&self, raster: &Raster, weight: impl Fn([usize; 2]) -> f64 + Sync) -> [f64; 2] {
        let [width, height] = self.size();
        let unlike = |count: usize| if raster.is_centred() { count.div_ceil(2) } else { count };
        let mirror = |index: usize, count: usize| {
            let other = count - 1 - index;
            (raster.is_centred() && other != index).then_some(other)
        };
        let of_row = |row: usize| {
            let lines = [Some(row), mirror(row, height)].into_iter().flatten();
            let lines: Vec<&[f64]> =
                lines.map(|row| &self.luminance_cd_m2[row * width..(row + 1) * width]).collect();
            let mut sums = [0.0; 2];
            for column in 0..unlike(width) {
                let weight = weight([column, row]);
                for place in [Some(column), mirror(column, width)].into_iter().flatten() {
                    for line in &lines {
                        sums[0] += weight * line[place];
                        sums[1] += weight;
                    }
                }
            }
            sums
        };
        let rows: Vec<[f64; 2]> = (0..unlike(height)).into_par_iter().map(of_row).collect();
        rows.iter().fold([0.0; 2], |sum, row| [sum[0] + row[0], sum[1] + row[1]])
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::image::Projection;

    /// Catches: a quarter that is not mirrored, middle rows or columns that count twice, mirrors of an image that
    /// is cut out aside.
    #[test]
    fn the_sums_of_a_quarter_are_those_of_all_pixels() {
        let fisheye = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 140.0 };
        let flat = Projection::Perspective { horizontal_deg: 70.0, vertical_deg: 50.0 };
        for projection in [fisheye, flat] {
            for ([width, height], shift) in
                [([8, 6], [0.0; 2]), ([7, 5], [0.0; 2]), ([1, 3], [0.0; 2]), ([8, 5], [0.25, -0.1])]
            {
                let mut view = View::new(projection, DVec3::ZERO, DVec3::X, DVec3::Z).expect("a view");
                view.shift = shift;
                let raster = view.raster([width, height]);
                let luminance: Vec<f64> = (0..width * height).map(|k| 1.0 + (k * k % 7) as f64).collect();
                let (mut light, mut seen, mut lx) = (0.0, 0.0, 0.0);
                for (index, luminance) in luminance.iter().enumerate() {
                    let pixel = [index % width, index / width];
                    let [plain, projected] = raster.solid_angles_sr(pixel);
                    let is_shown = raster.shows(pixel.map(|place| place as f64 + 0.5));
                    light += if is_shown { luminance * plain } else { 0.0 };
                    seen += if is_shown { plain } else { 0.0 };
                    lx += luminance * projected;
                }
                let image = LuminanceImage::new(width, height, Some(view), luminance);
                let of_image = [image.mean_cd_m2(), image.illuminance_lx().expect("a view")];
                for (value, plain) in of_image.into_iter().zip([light / seen, lx]) {
                    assert!((value / plain - 1.0).abs() < 1e-12, "{width} × {height}: {value} {plain}");
                }
            }
        }
    }
}
