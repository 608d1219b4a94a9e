//! An image in cd/m², and what an eye at its centre of projection receives.

use rayon::prelude::*;

use super::View;

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
        let raster = self.view.map(|view| view.raster(self.size()));
        let of_pixel = |index: usize| {
            let pixel = [index % self.width, index / self.width];
            match &raster {
                None => 1.0,
                Some(raster) if raster.shows(pixel.map(|place| place as f64 + 0.5)) => {
                    raster.solid_angles_sr(pixel)[0]
                }
                Some(_) => 0.0,
            }
        };
        let solid_angles_sr: Vec<f64> =
            (0..self.luminance_cd_m2.len()).into_par_iter().with_min_len(1 << 12).map(of_pixel).collect();
        let (mut light, mut seen_sr) = (0.0, 0.0);
        for (luminance, solid_angle_sr) in self.luminance_cd_m2.iter().zip(solid_angles_sr) {
            light += luminance * solid_angle_sr;
            seen_sr += solid_angle_sr;
        }
        if seen_sr > 0.0 { light / seen_sr } else { 0.0 }
    }

    /// Illuminance in lx on the plane of the eye, E_v = Σ L ω cos θ over what lies in front of it;
    /// `None` without a view. It is the whole E_v only if the view sees the whole half-space.
    pub fn illuminance_lx(&self) -> Option<f64> {
        let raster = self.view?.raster(self.size());
        let of_row = |row: usize| {
            let line = &self.luminance_cd_m2[row * self.width..(row + 1) * self.width];
            let seen =
                |(column, luminance): (usize, &f64)| luminance * raster.solid_angles_sr([column, row])[1];
            line.iter().enumerate().map(seen).sum::<f64>()
        };
        let rows: Vec<f64> = (0..self.height).into_par_iter().map(of_row).collect();
        Some(rows.iter().sum())
    }
}
