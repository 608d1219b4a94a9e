//! What an image shows an eye that looks along its centre: directions, solid angles and luminances
//! of the pixels in front of the eye. What lies behind it lights no eye and is not in the field.

use glam::DVec3;

use super::luminances::{FIELD_HALF_ANGLES_DEG, Zones};
use crate::image::LuminanceImage;
use crate::units::{Nits, Undefined};

/// A pixel in front of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Row × width + column in the image.
    pub index: u32,
    /// Unit direction: to the right, up and ahead of the eye.
    pub direction: DVec3,
    /// Solid angle, sr.
    pub solid_angle_sr: f64,
    /// ∫ cos θ dω, sr.
    pub projected_sr: f64,
    /// Luminance, cd/m².
    pub luminance: f64,
}

/// All pixels in front of the eye, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Field {
    /// The pixels.
    pub pixels: Vec<Pixel>,
    /// Columns and rows of the image.
    pub size: [usize; 2],
    /// For each column the direction of its pixel in the middle row (below the centre where the number of
    /// rows is even); `None` outside the projection.
    pub level: Vec<Option<DVec3>>,
    /// Pixels that are no number or negative: left out.
    pub bad_pixels: usize,
    /// Pixels that a mask hides.
    pub masked_pixels: usize,
}

impl Field {
    /// The field of an image; pixels that are 0 in `mask`, an image of the same size, are hidden.
    ///
    /// # Errors
    /// The image has no view, the mask has another size, or a pixel that the eye sees is infinite: what was too
    /// bright for the file is the brightest source, and without it every figure would be too low.
    pub fn of(image: &LuminanceImage, mask: Option<&LuminanceImage>) -> Result<Self, Undefined> {
        let view = image.view.ok_or_else(|| {
            Undefined::because("the image does not say where its pixels look (no VIEW that can be used)")
        })?;
        if let Some(mask) = mask
            && mask.size() != image.size()
        {
            let sizes = [mask.size(), image.size()].map(|[width, height]| format!("{width} × {height}"));
            return Err(Undefined::because(format!(
                "the mask has {} pixels, the image {}",
                sizes[0], sizes[1]
            )));
        }
        let size = image.size();
        let of_eye = |at: [f64; 2]| {
            let direction = view.direction(size, at)?;
            Some(DVec3::from_array([view.right(), view.up(), view.forward()].map(|axis| direction.dot(axis))))
        };
        let middle = (image.height / 2) as f64 + 0.5;
        let level = (0..image.width).map(|column| of_eye([column as f64 + 0.5, middle])).collect();
        let mut field = Self { size, level, ..Self::default() };
        let mut infinite = 0;
        for row in 0..image.height {
            for column in 0..image.width {
                let index = row * image.width + column;
                let Some(direction) = of_eye([column as f64 + 0.5, row as f64 + 0.5]) else { continue };
                if !(direction.z > 0.0) {
                    continue;
                }
                if mask.is_some_and(|mask| !(mask.luminance_cd_m2[index] > 0.0)) {
                    field.masked_pixels += 1;
                    continue;
                }
                let luminance = image.luminance_cd_m2[index];
                infinite += usize::from(luminance > f64::MAX);
                if !(luminance.is_finite() && luminance >= 0.0) {
                    field.bad_pixels += 1;
                    continue;
                }
                let [solid_angle_sr, projected_sr] = view.solid_angles_sr(size, [column, row]);
                field.pixels.push(Pixel {
                    index: index as u32,
                    direction,
                    solid_angle_sr,
                    projected_sr,
                    luminance,
                });
            }
        }
        if infinite > 0 {
            return Err(Undefined::because(format!(
                "{infinite} pixel(s) before the eye are infinite: a source was too bright for the file (half precision ends at 65504), so no figure can be computed; write it in single precision, or mask what must not count"
            )));
        }
        Ok(field)
    }

    /// Solid angle of the whole field, sr; 2π where an image shows everything in front of the eye.
    pub fn solid_angle_sr(&self) -> f64 {
        self.pixels.iter().map(|pixel| pixel.solid_angle_sr).sum()
    }

    /// E_v = Σ L ω cos θ, lx.
    pub fn illuminance_lx(&self) -> f64 {
        self.pixels.iter().map(|pixel| pixel.luminance * pixel.projected_sr).sum()
    }

    /// Mean luminance weighted by solid angle; `None` where no pixel passes.
    pub fn mean(&self, passes: impl Fn(&Pixel) -> bool) -> Option<Nits> {
        let (mut light, mut size) = (0.0, 0.0);
        for pixel in self.pixels.iter().filter(|pixel| passes(pixel)) {
            light += pixel.luminance * pixel.solid_angle_sr;
            size += pixel.solid_angle_sr;
        }
        (size > 0.0).then(|| Nits(light / size))
    }

    /// Mean luminances of a task, its surround within 30° and the far field within 60° of it.
    ///
    /// # Errors
    /// A zone holds no pixel.
    pub fn zones(&self, task: &Cone) -> Result<Zones, Undefined> {
        let angle_deg = |pixel: &Pixel| angle(task.direction, pixel.direction).to_degrees();
        let [near, far] = FIELD_HALF_ANGLES_DEG;
        let none = |zone: &str| Undefined::because(format!("no pixel of the image lies in the {zone}"));
        let mean = |zone: &str, passes: &dyn Fn(&Pixel) -> bool| self.mean(passes).ok_or_else(|| none(zone));
        Ok(Zones {
            task: mean("task", &|pixel| task.contains(pixel.direction))?,
            surround: mean("surround of the task", &|pixel| {
                !task.contains(pixel.direction) && angle_deg(pixel) <= near
            })?,
            far: mean("far field", &|pixel| {
                !task.contains(pixel.direction) && angle_deg(pixel) > near && angle_deg(pixel) <= far
            })?,
        })
    }

    /// Statistics of the horizontal band of all pixels within `half_angle_rad` of the pixel that lies in
    /// their column in the middle row: so evalglare's option `-B` counts, by its published statistics.
    ///
    /// # Errors
    /// The band holds no pixel.
    pub fn band(&self, half_angle_rad: f64) -> Result<Band, Undefined> {
        let level = |pixel: &Pixel| self.level.get(pixel.index as usize % self.size[0]).copied().flatten();
        let near = |pixel: &&Pixel| {
            level(pixel).is_some_and(|level| angle(level, pixel.direction) <= half_angle_rad)
        };
        let within: Vec<&Pixel> = self.pixels.iter().filter(near).collect();
        let mut sorted: Vec<f64> = within.iter().map(|pixel| pixel.luminance).collect();
        sorted.sort_by(f64::total_cmp);
        let solid_angle_sr: f64 = within.iter().map(|pixel| pixel.solid_angle_sr).sum();
        let light: f64 = within.iter().map(|pixel| pixel.luminance * pixel.solid_angle_sr).sum();
        let median = sorted.get(sorted.len() / 2).copied();
        let median = median.ok_or_else(|| Undefined::because("no pixel lies in the band"))?;
        Ok(Band { solid_angle_sr, mean: Nits(light / solid_angle_sr), median: Nits(median) })
    }
}

/// A horizontal band of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Its solid angle, sr.
    pub solid_angle_sr: f64,
    /// Mean luminance weighted by solid angle.
    pub mean: Nits,
    /// Median over pixels.
    pub median: Nits,
}

/// A cone of directions, such as a task zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Its axis: to the right, up and ahead of the eye.
    pub direction: DVec3,
    /// Full opening angle, rad.
    pub opening_rad: f64,
}

impl Cone {
    /// Whether a direction lies in it.
    pub fn contains(&self, direction: DVec3) -> bool {
        angle(self.direction, direction) <= 0.5 * self.opening_rad
    }
}

/// Angle between unit vectors, rad; exact for small ones, where an arc cosine is not.
pub fn angle(a: DVec3, b: DVec3) -> f64 {
    2.0 * (0.5 * (a - b).length()).min(1.0).asin()
}
