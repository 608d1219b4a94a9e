//! The figures of a photometric file. LOR is what the file *states* where it states one; what the
//! intensities add up to stands beside it.

use super::{Lamp, beam, c_deg, flux, luminance, outdoor, spacing};
use crate::photometry::{Format, IntensityDistribution, Opening, Symmetry};
use crate::units::Undefined;

/// Differences below this share of the largest intensity are no asymmetry.
const SYMMETRY_TOLERANCE: f64 = 1e-3;

/// All figures of one luminaire.
#[derive(Clone, Debug)]
pub struct Info {
    /// Format and edition.
    pub format: Format,
    /// Manufacturer and luminaire as the file names them.
    pub description: String,
    /// Exact integral of the interpolant, lm.
    pub flux_integrated_lm: f64,
    /// By the zonal rule, lm.
    pub flux_zonal_lm: f64,
    /// As the file states it, lm.
    pub flux_rated_lm: Option<f64>,
    /// Stated light output ratio, else integrated flux over the lamps', 0 … 1.
    pub lor: Option<f64>,
    /// Downward flux over the lamps', 0 … 1.
    pub dlor: Option<f64>,
    /// Upward flux over the lamps', 0 … 1.
    pub ulor: Option<f64>,
    /// Downward share of the flux, 0 … 1.
    pub down_share: f64,
    /// Connected power, W.
    pub power_w: Option<f64>,
    /// Integrated flux per power, lm/W.
    pub efficacy_lm_per_w: Option<f64>,
    /// The largest intensity.
    pub i_max: Peak,
    /// The luminous area.
    pub opening: Opening,
    /// The symmetry that the intensities have.
    pub symmetry: Symmetry,
    /// Flux in zones of 10°, lm.
    pub zones_lm: [f64; 18],
    /// Beam angle (50 %) in C0–C180 and C90–C270, degrees.
    pub beam_deg: [Result<f64, Undefined>; 2],
    /// Field angle (10 %) in C0–C180 and C90–C270, degrees.
    pub field_deg: [Result<f64, Undefined>; 2],
    /// CIE flux code, percent.
    pub flux_code: Result<[f64; 5], Undefined>,
    /// Luminances at 45° … 85°.
    pub luminances: Vec<luminance::Row>,
    /// Spacing over mounting height.
    pub spacing: spacing::Spacing,
    /// Classes of road and area luminaires.
    pub outdoor: outdoor::Outdoor,
}

/// An intensity and its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// cd.
    pub cd: f64,
    /// C, degrees.
    pub c_deg: f64,
    /// γ, degrees.
    pub gamma_deg: f64,
}

/// Computes all figures.
pub fn info(lamp: &Lamp) -> Info {
    let photometry = &lamp.photometry;
    let distribution = &photometry.distribution;
    let flux_lm = distribution.flux().0;
    let of_lamps = |lm: f64| photometry.lamp_flux_lm.map(|lamps_lm| lm / lamps_lm);
    let lor = photometry.lor.or_else(|| of_lamps(flux_lm));
    let symmetry = Symmetry::of(distribution, SYMMETRY_TOLERANCE);
    // C0–C180 is the frame's y, C90–C270 its x.
    let in_planes = |share| [-90.0, 0.0].map(|azimuth| beam::angle_deg(distribution, azimuth, share));
    let down_lm = distribution.zonal_flux(0.0, 90.0).0;
    Info {
        format: photometry.format,
        description: photometry.description.clone(),
        flux_integrated_lm: flux_lm,
        flux_zonal_lm: flux::zonal_rule(distribution).0,
        flux_rated_lm: photometry.rated_flux_lm,
        lor,
        dlor: of_lamps(down_lm),
        ulor: of_lamps(distribution.zonal_flux(90.0, 180.0).0),
        down_share: down_lm / flux_lm,
        power_w: photometry.power_w,
        efficacy_lm_per_w: photometry.power_w.map(|watts| flux_lm / watts),
        i_max: peak(distribution),
        opening: photometry.opening,
        symmetry,
        zones_lm: flux::zones_lm(distribution),
        beam_deg: in_planes(beam::BEAM),
        field_deg: in_planes(beam::FIELD),
        flux_code: flux::cie_code(distribution, lor),
        luminances: luminance::table(photometry, symmetry),
        spacing: spacing::criterion(distribution),
        outdoor: outdoor::outdoor(photometry, symmetry),
    }
}

/// The largest intensity, at the node with the smallest C and then γ.
pub fn peak(distribution: &IntensityDistribution) -> Peak {
    let Some((azimuths, gammas)) = distribution.grid() else {
        return Peak { cd: distribution.max_intensity().0, c_deg: 0.0, gamma_deg: 0.0 };
    };
    let mut best = Peak { cd: 0.0, c_deg: 0.0, gamma_deg: 0.0 };
    // From C0 on, so that symmetric luminaires name the same plane in every format.
    let mut planes: Vec<f64> = azimuths.iter().map(|azimuth| c_deg(*azimuth)).collect();
    planes.sort_by(f64::total_cmp);
    if distribution.is_rotationally_symmetric() {
        planes = vec![0.0];
    }
    for c in planes {
        for gamma in gammas {
            let cd = distribution.intensity_at(super::azimuth_deg(c), *gamma);
            if cd > best.cd * (1.0 + 1e-9) {
                best = Peak { cd, c_deg: c, gamma_deg: *gamma };
            }
        }
    }
    Peak { cd: distribution.max_intensity().0, ..best }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lamp::read;

    /// 2 lamps of 1000 lm, asymmetric, 0–90–180–270; LM-63's 0° plane is C90.
    const FILE: &str = "IESNA:LM-63-2002\nTILT=NONE\n2 1000 1 4 5 1 2 0.2 1.2 0\n1 1 40\n0 45 90 180\n\
                        0 90 180 270 360\n400 200 0 0\n400 300 0 0\n400 200 0 0\n400 100 0 0\n400 200 0 0\n";

    /// Catches: C0 along the length, LOR of one lamp, efficacy of the rated flux.
    #[test]
    fn figures_of_a_small_file() {
        let lamps = read(FILE.as_bytes(), "a.ies").expect("sound");
        let info = info(&lamps[0]);
        let flux = info.flux_integrated_lm;
        assert_eq!(info.symmetry, Symmetry::AboutWidth);
        assert!((info.lor.expect("relative") - flux / 2000.0).abs() < 1e-12);
        assert!((info.efficacy_lm_per_w.expect("watts") - flux / 40.0).abs() < 1e-12);
        assert!((info.dlor.expect("relative") - info.lor.expect("relative")).abs() < 1e-12);
        assert_eq!((info.i_max.gamma_deg, info.i_max.cd), (0.0, 400.0));
        let steep = read(FILE.replace("400 300", "400 900").as_bytes(), "a.ies").expect("sound");
        let peak = super::info(&steep[0]).i_max;
        assert_eq!((peak.c_deg, peak.gamma_deg), (180.0, 45.0));
        // C90 is the 0° plane: 200 cd at 45°, seen area 0.24 cos 45°.
        let row = info.luminances.iter().find(|row| (row.c_deg - 90.0).abs() < 1e-9).expect("C90");
        let nits = row.luminances[0].clone().expect("flat opening").0;
        assert!((nits - 200.0 / (0.24 * 45_f64.to_radians().cos())).abs() < 1e-9);
    }
}
