//! Measured half-planes → the full circle. Mirroring happens in the file's own angle; only the
//! last step turns it into the azimuth of the luminaire frame.

use std::sync::Arc;

use super::{DistributionError, IntensityDistribution};

/// Angles closer than this are the same plane, degrees.
const SAME_DEG: f64 = 1e-6;

/// One half-plane: its angle in degrees and the intensities along γ.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub(super) angle_deg: f64,
    pub(super) cd: Vec<f64>,
    /// Where they stand in the file.
    pub(super) lines: Arc<[usize]>,
}

/// The planes and their mirror images: I(C) = I(2 axis − C).
pub(super) fn mirrored(planes: Vec<Plane>, axis_deg: f64) -> Vec<Plane> {
    let image = |plane: &Plane| Plane { angle_deg: 2.0 * axis_deg - plane.angle_deg, ..plane.clone() };
    let images: Vec<Plane> = planes.iter().map(image).collect();
    planes.into_iter().chain(images).collect()
}

/// Planes around the circle in any order, where the first of several at one angle counts; a single
/// plane is rotated. The azimuth in the luminaire frame is the plane's angle plus `turn_deg`. A
/// plane at azimuth 0 is interpolated where there is none: the interpolant stays as it was.
pub(super) fn close_circle(
    mut planes: Vec<Plane>,
    gammas_deg: Vec<f64>,
    turn_deg: f64,
) -> Result<IntensityDistribution, DistributionError> {
    for plane in &mut planes {
        let azimuth = (plane.angle_deg + turn_deg).rem_euclid(360.0);
        let at_seam = azimuth.min(360.0 - azimuth) < SAME_DEG;
        plane.angle_deg = if at_seam { 0.0 } else { azimuth };
    }
    planes.sort_by(|a, b| a.angle_deg.total_cmp(&b.angle_deg));
    planes.dedup_by(|next, kept| next.angle_deg - kept.angle_deg < SAME_DEG);
    let (Some(first), Some(last)) = (planes.first(), planes.last()) else {
        return Err(DistributionError::Size { what: "planes", expected: 1, found: 0 });
    };
    let at_zero = if first.angle_deg > 0.0 {
        let before = 360.0 - last.angle_deg;
        let share = before / (before + first.angle_deg);
        let interpolated = last.cd.iter().zip(&first.cd).map(|(a, b)| a + share * (b - a)).collect();
        if planes.len() == 1 { first.cd.clone() } else { interpolated }
    } else {
        first.cd.clone()
    };
    if planes.len() == 1 {
        planes.clear();
    }
    if planes.first().is_none_or(|plane| plane.angle_deg > 0.0) {
        planes.insert(0, Plane { angle_deg: 0.0, cd: at_zero.clone(), lines: [].into() });
    }
    planes.push(Plane { angle_deg: 360.0, cd: at_zero, lines: [].into() });
    let (azimuths, cd) = planes.into_iter().map(|plane| (plane.angle_deg, plane.cd)).unzip();
    IntensityDistribution::from_grid(azimuths, gammas_deg, cd)
}

/// Largest difference between planes at one γ, as a part of the largest intensity.
pub(super) fn spread<'a>(planes: impl IntoIterator<Item = &'a Plane> + Clone) -> f64 {
    let peak = planes.clone().into_iter().flat_map(|plane| &plane.cd).copied().fold(0.0, f64::max);
    let mut lowest: Vec<f64> = Vec::new();
    let mut highest: Vec<f64> = Vec::new();
    for plane in planes {
        lowest.resize(plane.cd.len(), f64::INFINITY);
        highest.resize(plane.cd.len(), 0.0);
        for (i, cd) in plane.cd.iter().enumerate() {
            lowest[i] = lowest[i].min(*cd);
            highest[i] = highest[i].max(*cd);
        }
    }
    let widest = highest.iter().zip(&lowest).map(|(high, low)| high - low).fold(0.0, f64::max);
    if peak > 0.0 { widest / peak } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(angle_deg: f64, cd: f64) -> Plane {
        Plane { angle_deg, cd: vec![cd, cd], lines: [].into() }
    }

    /// Catches: a turn in the wrong direction, a seam left open, a changed interpolant at 0°.
    #[test]
    fn circle_is_closed_and_turned() {
        let gammas = || vec![0.0, 90.0];
        let c_planes = vec![plane(0.0, 10.0), plane(80.0, 20.0), plane(100.0, 40.0), plane(180.0, 10.0)];
        let d = close_circle(c_planes, gammas(), -90.0).expect("closed");
        let at = |azimuth: f64| d.intensity_at(azimuth, 45.0);
        for (azimuth, cd) in [(270.0, 10.0), (350.0, 20.0), (10.0, 40.0), (0.0, 30.0), (90.0, 10.0)] {
            assert!((at(azimuth) - cd).abs() < 1e-9, "{azimuth}: {}", at(azimuth));
        }
        let round = close_circle(vec![plane(0.0, 7.0)], gammas(), -90.0).expect("rotated");
        assert!(round.is_rotationally_symmetric());
    }

    /// Catches: a mirror about the wrong plane.
    #[test]
    fn mirror_images_lie_opposite() {
        let planes = mirrored(vec![plane(270.0, 1.0), plane(330.0, 2.0), plane(450.0, 3.0)], 90.0);
        let d = close_circle(planes, vec![0.0, 90.0], 0.0).expect("closed");
        assert!((d.intensity_at(210.0, 1.0) - 2.0).abs() < 1e-9);
        assert!((d.intensity_at(90.0, 1.0) - 3.0).abs() < 1e-9);
    }
}
