//! Sources of an image by the angles of their pixels, for veiling luminance: a window or a luminous ceiling has no
//! one angle, and its centre may err by any factor.

use std::collections::BTreeMap;

use glam::DVec3;

use super::detect::Found;
use super::field::{Field, Pixel};
use super::source::StrayPart;
use super::veiling::VALID_DEG;

/// Nearer to the line of sight than so many times its width, a pixel counts by its own parts.
const NEAR: f64 = 8.0;
/// Parts of such a pixel along each side.
const SIDE: u32 = 16;
/// Rings in which the light of a source is summed: angles of one ring differ by so much of themselves.
const RING: f64 = 0.005;

/// The light of every source by rings about the line of sight, each at its mean angle. A source that lies within
/// the least angle of the forms altogether has none: no more is known of it than that it is looked at.
pub(super) fn parts(field: &Field, found: &Found) -> Vec<StrayPart> {
    let least_deg = VALID_DEG[0][0];
    // (source, ring) to (light, light times angle); ring 0 is what lies within the least angle.
    let mut rings: BTreeMap<(usize, u32), [f64; 2]> = BTreeMap::new();
    for (pixel, label) in field.pixels.iter().zip(&found.labels) {
        let Some(source) = (*label as usize).checked_sub(1) else { continue };
        by_angle(pixel, |off_axis_deg, lx| {
            let ring = if off_axis_deg < least_deg {
                0
            } else {
                1 + ((off_axis_deg / least_deg).ln() / RING.ln_1p()) as u32
            };
            let sums = rings.entry((source, ring)).or_default();
            sums[0] += lx;
            sums[1] += lx * off_axis_deg;
        });
    }
    let mut parts = Vec::with_capacity(rings.len());
    let mut strays = vec![false; found.sources.len()];
    for ((source, ring), [lx, lx_deg]) in rings {
        let whole = found.sources[source].eye_lx;
        if lx > 0.0 && whole > 0.0 {
            parts.push(StrayPart { source, off_axis_deg: lx_deg / lx, share: lx / whole });
            strays[source] |= ring > 0;
        }
    }
    parts.retain(|part| strays[part.source]);
    parts
}

/// The light of a pixel by its angle from the line of sight; near it a pixel is a square of even luminance.
fn by_angle(pixel: &Pixel, mut take: impl FnMut(f64, f64)) {
    let lx = pixel.luminance * pixel.projected_sr;
    let off_axis = |direction: DVec3| direction.angle_between(DVec3::Z);
    let (angle, width) = (off_axis(pixel.direction), pixel.solid_angle_sr.sqrt());
    if angle >= NEAR * width {
        take(angle.to_degrees(), lx);
        return;
    }
    let (right, up) = pixel.direction.any_orthonormal_pair();
    let place = |index: u32| ((f64::from(index) + 0.5) / f64::from(SIDE) - 0.5) * width;
    for row in 0..SIDE {
        for column in 0..SIDE {
            let direction = pixel.direction + right * place(column) + up * place(row);
            take(off_axis(direction).to_degrees(), lx / f64::from(SIDE * SIDE));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::of_image::{Options, glare_of_image};
    use super::super::veiling::stiles_holladay;
    use super::*;
    use crate::image::{LuminanceImage, Projection, View};

    const BRIGHT: f64 = 5000.0;

    /// Σ 10 E/θ² of a disc by rings, of which it covers an arc that is known: ∫ 10/θ² L cos θ sin θ 2φ dθ, in degrees.
    fn veil(radius_deg: f64, aside_deg: f64) -> f64 {
        let (radius, aside) = (radius_deg.to_radians(), aside_deg.to_radians());
        let (from, to) = ((aside_deg - radius_deg).max(0.1).to_radians(), radius + aside);
        let n = 100_000;
        let step = (to - from) / f64::from(n);
        let ring = |k: i32| {
            let angle = from + (f64::from(k) + 0.5) * step;
            let arc = (radius.cos() - angle.cos() * aside.cos()) / (angle.sin() * aside.sin());
            let half_arc = arc.clamp(-1.0, 1.0).acos();
            10.0 / angle.to_degrees().powi(2) * BRIGHT * angle.cos() * angle.sin() * 2.0 * half_arc * step
        };
        (0..n).map(ring).sum()
    }

    fn disc(radius_deg: f64, aside_deg: f64) -> LuminanceImage {
        let size = [600, 600];
        let fisheye = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
        let view = View::new(fisheye, DVec3::ZERO, DVec3::Y, DVec3::Z).expect("a view");
        let (sin, cos) = aside_deg.to_radians().sin_cos();
        let centre = DVec3::new(sin, cos, 0.0);
        let luminance = |index: usize| {
            let at = [(index % size[0]) as f64 + 0.5, (index / size[0]) as f64 + 0.5];
            let inside = |d: DVec3| d.angle_between(centre).to_degrees() < radius_deg;
            view.direction(size, at).map_or(0.0, |d| if inside(d) { BRIGHT } else { 50.0 })
        };
        LuminanceImage::new(size[0], size[1], Some(view), (0..size[0] * size[1]).map(luminance).collect())
    }

    /// Catches: the light of a large source taken from its centre (27 times too much, or half of it).
    #[test]
    fn the_veil_of_a_large_source_is_that_of_its_parts() {
        for (radius_deg, aside_deg) in [(10.0, 0.6), (11.0, 14.0), (2.0, 20.0)] {
            let glare = glare_of_image(&disc(radius_deg, aside_deg), None, &Options::default());
            let mut sight = glare.expect("it has a view").sight;
            assert_eq!(sight.sources.len(), 1);
            let (found, truth) = (stiles_holladay(&sight).expect("a veil"), veil(radius_deg, aside_deg));
            assert!((found / truth - 1.0).abs() < 0.02, "{radius_deg}° at {aside_deg}°: {found} for {truth}");
            sight.parts.clear();
            let centred = stiles_holladay(&sight).expect("a veil");
            assert!(radius_deg < 5.0 || (centred / truth - 1.0).abs() > 0.3, "twin: {centred} for {truth}");
        }
    }

    /// Catches: no veil, said with certainty, of a lamp that is looked at.
    #[test]
    fn a_source_on_the_line_of_sight_alone_has_no_veil_that_is_known() {
        let mut image = disc(0.0, 5.0);
        let view = image.view.expect("a view");
        let narrow = Projection::Perspective { horizontal_deg: 2.0, vertical_deg: 2.0 };
        image.view = View::new(narrow, view.eye, view.forward(), view.up()).ok();
        for (row, column) in [(299, 299), (299, 300), (300, 299), (300, 300)] {
            image.luminance_cd_m2[row * 600 + column] = 1e7;
        }
        let sight = glare_of_image(&image, None, &Options::default()).expect("a view").sight;
        assert_eq!((sight.sources.len(), sight.parts.len()), (1, 0));
        assert!(stiles_holladay(&sight).is_err());
    }
}
