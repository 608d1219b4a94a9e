//! Checks common to all formats. A finding never changes a number: it says what is odd and what
//! follows for illuminance or glare.

use super::{Finding, Format, Opening, Photometry};

/// All oddities that show in the finished distribution.
pub(super) fn check(photometry: &Photometry) -> Vec<Finding> {
    let checks = [flux, luminous_area, nadir, covered_range, horizon, uplight];
    checks.iter().filter_map(|check| check(photometry)).collect()
}

/// EULUMDAT states the flux itself; LM-63 only an upper bound, the flux of the lamps.
fn flux(photometry: &Photometry) -> Option<Finding> {
    let (rated, integrated) = (photometry.rated_flux_lm?, photometry.distribution.flux().0);
    let deviation = integrated / rated - 1.0;
    let odd = match photometry.format {
        Format::Eulumdat => deviation.abs() > 0.02,
        Format::Lm63 { .. } => deviation > 0.02,
    };
    let message = format!(
        "the intensities add up to {integrated:.1} lm, the file states {rated:.1} lm ({:+.1} %): \
         every illuminance differs by as much depending on which is right; set `flux` to choose",
        100.0 * deviation
    );
    odd.then(|| Finding::new("flux-mismatch", None, message))
}

fn luminous_area(photometry: &Photometry) -> Option<Finding> {
    let horizontal = glam::DVec3::new(0.6, 0.0, -0.8);
    let none = !(photometry.opening.projected_area_m2(horizontal) > 0.0);
    let message = "no luminous area: the luminaire counts as a point, its luminance and glare are undefined; \
                   set `area`";
    none.then(|| Finding::new("zero-area", None, message))
}

fn nadir(photometry: &Photometry) -> Option<Finding> {
    let (azimuths, gammas) = photometry.distribution.grid()?;
    let first = *gammas.first().filter(|gamma| **gamma <= 0.0)?;
    let at_nadir = azimuths.iter().map(|azimuth| photometry.distribution.intensity_at(*azimuth, first));
    let (low, high) = at_nadir.fold((f64::INFINITY, 0.0_f64), |(low, high), cd| (low.min(cd), high.max(cd)));
    let message = format!(
        "γ = 0 is one direction, but its planes say {low:.1} to {high:.1} cd: \
         the illuminance right below is uncertain by as much"
    );
    (high - low > 0.01 * high).then(|| Finding::new("unequal-nadir", None, message))
}

fn covered_range(photometry: &Photometry) -> Option<Finding> {
    let (_, gammas) = photometry.distribution.grid()?;
    let (first, last) = (*gammas.first()?, *gammas.last()?);
    let starts_odd = first > 0.0 && (first - 90.0).abs() > 1e-6;
    if starts_odd {
        let message = format!("γ starts at {first}°: the cone below it is taken as dark");
        return Some(Finding::new("missing-nadir", None, message));
    }
    let ends_odd = (last - 90.0).abs() > 1e-6 && (last - 180.0).abs() > 1e-6;
    let message = format!("γ ends at {last}°: directions beyond are taken as dark");
    ends_odd.then(|| Finding::new("missing-range", None, message))
}

fn is_flat_area(opening: Opening) -> bool {
    opening.is_flat() && opening.area_m2() > 0.0
}

fn horizon(photometry: &Photometry) -> Option<Finding> {
    let distribution = &photometry.distribution;
    let (azimuths, _) = distribution.grid()?;
    let at_horizon =
        azimuths.iter().map(|azimuth| distribution.intensity_at(*azimuth, 90.0)).fold(0.0, f64::max);
    let share = at_horizon / distribution.max_intensity().0;
    let message = format!(
        "{:.1} % of the largest intensity leaves a flat opening edge-on (γ = 90°), where its projected \
         area is 0: luminance and UGR near the horizon are overstated; luminous sides seem to be missing",
        100.0 * share
    );
    (is_flat_area(photometry.opening) && share > 0.005).then(|| Finding::new("horizon-light", None, message))
}

fn uplight(photometry: &Photometry) -> Option<Finding> {
    let distribution = &photometry.distribution;
    let share = distribution.zonal_flux(90.0, 180.0).0 / distribution.flux().0;
    let message = format!(
        "{:.1} % of the flux goes up although the opening is flat and faces down: its luminance seen from \
         above is undefined, illuminance is not affected",
        100.0 * share
    );
    (is_flat_area(photometry.opening) && share > 0.005).then(|| Finding::new("flat-uplight", None, message))
}

#[cfg(test)]
mod tests {
    use super::super::{IntensityDistribution, Lm63Version};
    use super::*;

    fn photometry(plane_0: [f64; 4], plane_180: [f64; 4], gammas: [f64; 4]) -> Photometry {
        let planes = [plane_0, plane_180, plane_0].map(|plane| plane.to_vec()).to_vec();
        let grid = IntensityDistribution::from_grid(vec![0.0, 180.0, 360.0], gammas.to_vec(), planes);
        Photometry {
            format: Format::Lm63 { version: Lm63Version::Y2002 },
            description: String::new(),
            distribution: grid.expect("valid"),
            opening: Opening::Disc { diameter_m: 0.2, height_m: 0.0 },
            rated_flux_lm: None,
            lamp_flux_lm: None,
            lor: None,
            power_w: None,
            colour_rendering: None,
            findings: Vec::new(),
        }
    }

    fn codes(photometry: &Photometry) -> Vec<&'static str> {
        check(photometry).iter().map(|finding| finding.code).collect()
    }

    /// Catches: a check that never fires or fires on a sound downlight.
    #[test]
    fn each_fault_has_its_finding() {
        let (gammas, sound) = ([0.0, 45.0, 90.0, 180.0], [100.0, 60.0, 0.0, 0.0]);
        assert!(codes(&photometry(sound, sound, gammas)).is_empty());
        assert_eq!(codes(&photometry(sound, [90.0, 60.0, 0.0, 0.0], gammas)), ["unequal-nadir"]);
        let up = [100.0, 60.0, 5.0, 5.0];
        assert_eq!(codes(&photometry(up, up, gammas)), ["horizon-light", "flat-uplight"]);
        assert_eq!(codes(&photometry(sound, sound, [10.0, 45.0, 80.0, 90.0])), ["missing-nadir"]);
        assert_eq!(codes(&photometry(sound, sound, [0.0, 45.0, 60.0, 80.0])), ["missing-range"]);
        let mut point = photometry(sound, sound, gammas);
        point.opening = Opening::Point;
        assert_eq!(codes(&point), ["zero-area"]);
    }

    /// Catches: a luminaire's loss (LOR < 1) reported as an error of an LM-63 file.
    #[test]
    fn lamp_flux_is_an_upper_bound_in_lm63() {
        let sound = [100.0, 60.0, 0.0, 0.0];
        let mut lossy = photometry(sound, sound, [0.0, 45.0, 90.0, 180.0]);
        lossy.rated_flux_lm = Some(2.0 * lossy.distribution.flux().0);
        assert!(codes(&lossy).is_empty());
        lossy.format = Format::Eulumdat;
        assert_eq!(codes(&lossy), ["flux-mismatch"]);
        lossy.format = Format::Lm63 { version: Lm63Version::Y2002 };
        lossy.rated_flux_lm = Some(0.5 * lossy.distribution.flux().0);
        assert_eq!(codes(&lossy), ["flux-mismatch"]);
    }
}
