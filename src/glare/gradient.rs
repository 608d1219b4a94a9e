//! Luminance-gradient statistics of an image: how steeply the logarithm of luminance changes over the
//! field of view. **Experimental**: no norm and no published index stands behind these figures, they have
//! no limits, and no verdict uses them.
//!
//! Differences are taken over a fixed *angle*, not over pixels: so neither the resolution nor the projection
//! of an image matters while its pixels are small against that angle.

use glam::DVec3;

use crate::image::{LuminanceImage, View};
use crate::sphere;
use crate::units::Undefined;

/// The angle over which luminances are compared unless another is asked for, degrees.
pub const SCALE_DEG: f64 = 1.0;
/// Edges of the histogram's classes, decades per degree; the last class is open.
pub const EDGES: [f64; 8] = [0.0, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, f64::INFINITY];
/// Share of pixels below which the percentile lies.
const PERCENTILE: f64 = 0.95;

/// Statistics of |∇ lg L| over the field of view, weighted by solid angle, decades per degree.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// Angle over which luminances were compared, degrees.
    pub scale_deg: f64,
    /// Mean.
    pub mean: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// Value that 95 % of the field do not exceed.
    pub percentile_95: f64,
    /// Share of the field in each class between [`EDGES`].
    pub histogram: [f64; EDGES.len() - 1],
    /// Solid angle of the field that was evaluated, sr.
    pub evaluated_sr: f64,
    /// Solid angle in front of the eye that was not: at the rim, or dark, sr.
    pub left_out_sr: f64,
    /// What a reader must know.
    pub notes: Vec<String>,
}

/// |∇ lg L| of every pixel in front of the eye:
/// g = √(g_u² + g_v²), g_u = lg( L(ω + δu/2) / L(ω − δu/2) ) / δ,
/// δ the scale, u and v unit tangents of the sphere of directions, perpendicular to each other and to ω; L between
/// pixels is bilinear. A pixel with a place that is dark or outside of the image has none.
///
/// # Errors
/// The image has no view, or nothing in it has a gradient.
pub fn gradient(image: &LuminanceImage, scale_deg: f64) -> Result<Gradient, Undefined> {
    let view = image.view.ok_or_else(|| {
        Undefined::because("the image does not say where its pixels look (no VIEW that can be used)")
    })?;
    let size = image.size();
    // (decades per degree, sr)
    let mut found: Vec<(f64, f64)> = Vec::new();
    let mut left_out_sr = 0.0;
    let mut widest_sr = 0.0f64;
    for row in 0..image.height {
        for column in 0..image.width {
            let at = [column as f64 + 0.5, row as f64 + 0.5];
            let Some(direction) = view.direction(size, at) else { continue };
            let [solid_angle_sr, ahead] = view.solid_angles_sr(size, [column, row]);
            if !(solid_angle_sr > 0.0 && ahead > 0.0) {
                continue;
            }
            widest_sr = widest_sr.max(solid_angle_sr);
            match slope(image, &view, direction, scale_deg) {
                Some(slope) => found.push((slope, solid_angle_sr)),
                None => left_out_sr += solid_angle_sr,
            }
        }
    }
    let evaluated_sr: f64 = found.iter().map(|(_, sr)| sr).sum();
    if !(evaluated_sr > 0.0) {
        return Err(Undefined::because("no two places of the image have luminances to compare"));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mean = found.iter().map(|(g, sr)| g * sr).sum::<f64>() / evaluated_sr;
    let square = found.iter().map(|(g, sr)| g * g * sr).sum::<f64>() / evaluated_sr;
    let mut below_sr = 0.0;
    let percentile_95 = found
        .iter()
        .find(|(_, sr)| {
            below_sr += sr;
            below_sr >= PERCENTILE * evaluated_sr
        })
        .or(found.last())
        .map_or(0.0, |(g, _)| *g);
    let mut histogram = [0.0; EDGES.len() - 1];
    for (slope, sr) in &found {
        let class = EDGES.iter().rposition(|edge| slope >= edge).unwrap_or(0).min(histogram.len() - 1);
        histogram[class] += sr / evaluated_sr;
    }
    let mut notes = vec!["experimental: no norm or published index stands behind these figures".to_owned()];
    let pixel_deg = widest_sr.sqrt().to_degrees();
    if pixel_deg > 0.5 * scale_deg {
        notes.push(format!(
            "pixels of up to {pixel_deg:.2}° are not small against the {scale_deg}° over which luminances are compared"
        ));
    }
    Ok(Gradient {
        scale_deg,
        mean,
        rms: square.sqrt(),
        percentile_95,
        histogram,
        evaluated_sr,
        left_out_sr,
        notes,
    })
}

/// |∇ lg L| at a direction, decades per degree; `None` where a place is dark or outside.
fn slope(image: &LuminanceImage, view: &View, direction: DVec3, scale_deg: f64) -> Option<f64> {
    let half_rad = 0.5 * scale_deg.to_radians();
    let frame = sphere::frame(direction);
    let along = |tangent: DVec3| {
        let place = |sign: f64| {
            let moved = direction * half_rad.cos() + sign * half_rad.sin() * tangent;
            luminance(image, view, moved).map(f64::log10)
        };
        Some((place(1.0)? - place(-1.0)?) / scale_deg)
    };
    Some(along(frame.x_axis)?.hypot(along(frame.y_axis)?))
}

/// Luminance along a direction, bilinear between the centres of pixels, cd/m²; `None` where it is not positive, or
/// one of the four pixels lies outside.
fn luminance(image: &LuminanceImage, view: &View, direction: DVec3) -> Option<f64> {
    let size = image.size();
    let [x, y] = view.place(size, direction)?.map(|place| place - 0.5);
    if !(x >= 0.0 && y >= 0.0 && x <= size[0] as f64 - 1.0 && y <= size[1] as f64 - 1.0) {
        return None;
    }
    let (column, row) = (x.floor() as usize, y.floor() as usize);
    let (right, down) = (x - x.floor(), y - y.floor());
    let mut sum = 0.0;
    for (place, weight) in [
        ([column, row], (1.0 - right) * (1.0 - down)),
        ([column + 1, row], right * (1.0 - down)),
        ([column, row + 1], (1.0 - right) * down),
        ([column + 1, row + 1], right * down),
    ] {
        if weight > 0.0 {
            view.direction(size, [place[0] as f64 + 0.5, place[1] as f64 + 0.5])?;
            sum += weight * image.luminance_cd_m2[place[1] * image.width + place[0]];
        }
    }
    (sum > 0.0 && sum.is_finite()).then_some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Projection;

    const ANGULAR: Projection = Projection::AngularFisheye { horizontal_deg: 120.0, vertical_deg: 120.0 };
    const FLAT: Projection = Projection::Perspective { horizontal_deg: 90.0, vertical_deg: 90.0 };

    /// An image of a luminance that depends on direction (right, up, ahead).
    fn painted(projection: Projection, pixels: usize, luminance: impl Fn(DVec3) -> f64) -> LuminanceImage {
        let view = View::new(projection, DVec3::ZERO, DVec3::Y, DVec3::Z).unwrap();
        let size = [pixels; 2];
        let place = |index: usize| [(index % pixels) as f64 + 0.5, (index / pixels) as f64 + 0.5];
        let values =
            (0..pixels * pixels).map(|index| view.direction(size, place(index)).map_or(0.0, &luminance));
        LuminanceImage::new(pixels, pixels, Some(view), values.collect())
    }

    /// `k` decades per degree away from +z: lg L = k · elevation.
    fn ramp(direction: DVec3, k: f64) -> f64 {
        100.0 * 10f64.powf(k * direction.z.clamp(-1.0, 1.0).asin().to_degrees())
    }

    #[test]
    fn a_ramp_in_angle_has_its_slope_everywhere_in_every_projection_and_resolution() {
        // Catches: pixels taken for angles, a lost Jacobian, natural for decimal logarithms, one axis only.
        for (projection, pixels) in [(ANGULAR, 600), (ANGULAR, 300), (FLAT, 500), (FLAT, 250)] {
            let image = painted(projection, pixels, |direction| ramp(direction, 0.02));
            let found = gradient(&image, SCALE_DEG).unwrap();
            for value in [found.mean, found.rms, found.percentile_95] {
                assert!((value / 0.02 - 1.0).abs() < 0.005, "{projection:?} {pixels}: {found:?}");
            }
            assert!(found.histogram[1] > 0.99, "0.01 to 0.03: {:?}", found.histogram);
            // The twin that counts pixels: 600 and 300 of them across would differ twofold.
            let twin = gradient(&image, 2.0 * SCALE_DEG).unwrap();
            assert!((twin.mean / found.mean - 1.0).abs() < 0.01, "a ramp has no scale");
        }
    }

    #[test]
    fn statistics_are_weighted_by_solid_angle() {
        // Steep within 20° of the axis and flat outside: the share is that of the cap, not of the pixels.
        let steep = |direction: DVec3| {
            let off_deg = direction.y.clamp(-1.0, 1.0).acos().to_degrees();
            10f64.powf(2.0 - 0.2 * off_deg.min(20.0))
        };
        let image = painted(FLAT, 600, steep);
        let found = gradient(&image, SCALE_DEG).unwrap();
        let whole = found.evaluated_sr;
        // A little more than the cap: half of the scale beyond its edge still sees the slope.
        let cap = 2.0 * std::f64::consts::PI * (1.0 - 20f64.to_radians().cos()) / whole;
        let share: f64 = found.histogram[3..].iter().sum();
        assert!((share / cap - 1.0).abs() < 0.06, "{share} {cap}");
        let by_pixels = std::f64::consts::PI * 20f64.to_radians().tan().powi(2) / 4.0;
        assert!((share / by_pixels - 1.0).abs() > 0.2, "the twin that counts pixels, {by_pixels}");
        assert!((found.mean / (0.2 * cap) - 1.0).abs() < 0.03, "{}", found.mean);
        assert!((found.histogram.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn even_fields_have_none_and_dark_ones_no_value() {
        let even = gradient(&painted(ANGULAR, 100, |_| 50.0), SCALE_DEG).unwrap();
        assert!(even.mean.abs() < 1e-12 && even.histogram[0] > 0.999_999);
        assert!(even.notes.iter().any(|note| note.contains("not small")), "1.2° pixels at 1°");
        assert!(gradient(&painted(ANGULAR, 100, |_| 0.0), SCALE_DEG).is_err());
        let mut blind = painted(ANGULAR, 100, |_| 50.0);
        blind.view = None;
        assert!(gradient(&blind, SCALE_DEG).is_err());
    }
}
