//! The largest luminous intensity of a placed luminaire in a zone about the vertical.

use glam::DVec3;

use crate::luminaire::Luminaire;

/// Step along the borders of the zone, degrees.
const STEP_DEG: f64 = 0.25;

/// Largest initial intensity in cd, `dim` included, over all azimuths between two angles from straight
/// down. What is interpolated bilinearly has its maximum at a node or on the border of the zone, an ideal
/// Lambertian emitter on its axis or on the border; the border is tried in steps of a quarter degree.
pub fn peak_cd(luminaire: &Luminaire, [from_deg, to_deg]: [f64; 2]) -> f64 {
    let distribution = &luminaire.kind.distribution;
    let own = |direction: DVec3| luminaire.world_from_luminaire.transpose() * direction;
    let mut peak_cd = 0.0f64;
    let turns = (360.0 / STEP_DEG) as usize;
    for (tilt_deg, turn) in [from_deg, to_deg].into_iter().flat_map(|t| (0..turns).map(move |turn| (t, turn)))
    {
        let (sin, cos) = tilt_deg.to_radians().sin_cos();
        let (s, c) = (turn as f64 * STEP_DEG).to_radians().sin_cos();
        peak_cd = peak_cd.max(distribution.intensity_along(own(DVec3::new(sin * c, sin * s, -cos))));
    }
    let mut within = |leaving: DVec3, cd: f64| {
        let tilt_deg = (-(luminaire.world_from_luminaire * leaving).z).clamp(-1.0, 1.0).acos().to_degrees();
        if (from_deg - 1e-9..=to_deg + 1e-9).contains(&tilt_deg) {
            peak_cd = peak_cd.max(cd);
        }
    };
    within(DVec3::NEG_Z, distribution.intensity_at(0.0, 0.0));
    if let Some((azimuths_deg, gammas_deg)) = distribution.grid() {
        for &gamma_deg in gammas_deg {
            for &azimuth_deg in azimuths_deg {
                let (sin, cos) = gamma_deg.to_radians().sin_cos();
                let (s, c) = azimuth_deg.to_radians().sin_cos();
                let leaving = DVec3::new(sin * c, sin * s, -cos);
                within(leaving, distribution.intensity_at(azimuth_deg, gamma_deg));
            }
        }
    }
    peak_cd * luminaire.dim
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::luminaire::{LuminaireType, Maintenance, orientation};
    use crate::photometry::{IntensityDistribution, Opening};
    use crate::units::Lumens;

    fn placed(distribution: IntensityDistribution, aim: DVec3) -> Luminaire {
        let kind = LuminaireType {
            name: "A".into(),
            description: String::new(),
            flux_lm: distribution.flux().0,
            distribution,
            opening: Opening::Point,
            rated_flux_lm: None,
            power_w: None,
            maintenance: Maintenance::NEW,
            emergency: None,
            file: String::new(),
            declared_ra: None,
        };
        Luminaire {
            kind: Arc::new(kind),
            position: DVec3::ZERO,
            world_from_luminaire: orientation(aim, 0.0),
            group: "A".into(),
            dim: 0.5,
            body: Vec::new(),
        }
    }

    /// Catches: a zone measured from the luminaire's axis and not from the vertical, a peak between two
    /// steps of a lattice, planes left out, `dim` forgotten.
    #[test]
    fn the_zone_is_about_the_vertical_and_no_peak_is_missed() {
        let lambert = || IntensityDistribution::lambert(Lumens(std::f64::consts::PI * 100.0));
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        close(peak_cd(&placed(lambert(), DVec3::NEG_Z), [60.0, 90.0]), 0.5 * 100.0 * 0.5);
        close(peak_cd(&placed(lambert(), DVec3::NEG_Z), [0.0, 180.0]), 0.5 * 100.0);
        // Aimed 60.1° off the vertical the axis itself lies in the zone.
        let aim = DVec3::new(60.1f64.to_radians().sin(), 0.0, -60.1f64.to_radians().cos());
        close(peak_cd(&placed(lambert(), aim), [60.0, 90.0]), 0.5 * 100.0);
        // A spike in one plane at γ = 73.3°, 40 cd, half a degree wide; and 500 cd straight down.
        let gammas = vec![0.0, 50.0, 73.0, 73.3, 73.6, 180.0];
        let plane = |peak: f64| vec![500.0, 0.0, 0.0, peak, 0.0, 0.0];
        let grid =
            |azimuths: Vec<f64>, cd| IntensityDistribution::from_grid(azimuths, gammas.clone(), cd).unwrap();
        let spike = grid(vec![0.0, 100.1, 360.0], vec![plane(1.0), plane(40.0), plane(1.0)]);
        close(peak_cd(&placed(spike.clone(), DVec3::NEG_Z), [60.0, 90.0]), 0.5 * 40.0);
        // Upside down the spike lies at 106.7° and nothing but its own light counts there.
        close(peak_cd(&placed(spike.clone(), DVec3::Z), [60.0, 90.0]), 0.0);
        close(peak_cd(&placed(spike, DVec3::Z), [90.0, 125.0]), 0.5 * 40.0);
    }
}
