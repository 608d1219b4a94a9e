//! Checks common to all formats. A finding never changes a number: it says what is odd and what
//! follows for illuminance or glare.

use std::f64::consts::TAU;

use super::{Finding, Format, Opening, Photometry};

/// All oddities that show in the finished distribution.
pub(super) fn check(photometry: &Photometry) -> Vec<Finding> {
    let checks = [flux, luminous_area, vast_area, nadir, covered_range, horizon, uplight];
    checks.iter().filter_map(|check| check(photometry)).collect()
}

/// EULUMDAT states the flux itself; LM-63 and relative photometry of TM-33 only an upper bound, the flux of
/// the lamps.
fn flux(photometry: &Photometry) -> Option<Finding> {
    let (rated, integrated) = (photometry.rated_flux_lm?, photometry.distribution.flux().0);
    let deviation = integrated / rated - 1.0;
    let odd = match photometry.format {
        Format::Lm63 { .. } => deviation,
        Format::Tm33 if photometry.lamp_flux_lm.is_some() => deviation,
        Format::Eulumdat | Format::Tm33 => deviation.abs(),
    };
    let message = format!("rated {rated:.0} lm, integrates to {integrated:.0} lm");
    let consequence = format!(
        "Ē is {:.1} % {} than the rated flux suggests; set `flux` to choose",
        100.0 * deviation.abs(),
        if deviation < 0.0 { "lower" } else { "higher" }
    );
    let code = if odd > 0.10 { "flux-contradiction" } else { "flux-mismatch" };
    (odd > 0.02).then(|| Finding::new(code, photometry.places.flux, message, consequence))
}

fn luminous_area(photometry: &Photometry) -> Option<Finding> {
    let oblique = glam::DVec3::new(0.6, 0.0, -0.8);
    let none = !(photometry.opening.projected_area_m2(oblique) > 0.0);
    let consequence =
        "the luminaire counts as a point: its luminance, UGR and glare are undefined; set `area`";
    none.then(|| Finding::new("zero-area", photometry.places.opening, "no luminous area", consequence))
}

/// Luminous areas above this are sizes in a wrong unit, m².
const VAST_M2: f64 = 10.0;

/// Sizes in mm that are declared as metres make a lamp of a whole room: nothing is lit, and nothing glares.
fn vast_area(photometry: &Photometry) -> Option<Finding> {
    let area_m2 = photometry.opening.area_m2();
    let message = format!("a luminous area of {area_m2:.0} m²");
    let nits = photometry.distribution.max_intensity().0 / area_m2;
    let consequence = format!(
        "its luminance is {nits:.1e} cd/m²: UGR and the illuminance near by are far too low; are the sizes in the right unit?"
    );
    (area_m2 > VAST_M2)
        .then(|| Finding::new("implausible-size", photometry.places.opening, message, consequence))
}

fn nadir(photometry: &Photometry) -> Option<Finding> {
    let (azimuths, gammas) = photometry.distribution.grid()?;
    let first = *gammas.first().filter(|gamma| **gamma <= 0.0)?;
    let at_nadir = |azimuth: f64| photometry.distribution.intensity_at(azimuth, first);
    let cds = || azimuths.iter().map(|azimuth| at_nadir(*azimuth));
    let (low, high) = cds().fold((f64::INFINITY, 0.0_f64), |(low, high), cd| (low.min(cd), high.max(cd)));
    // The plane that stands apart from all others.
    let mean = cds().sum::<f64>() / azimuths.len() as f64;
    let apart = |azimuth: &&f64| (at_nadir(**azimuth) - mean).abs();
    let odd = azimuths.iter().rev().max_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    let message = format!("γ = 0 is one direction, but its planes say {low:.1} to {high:.1} cd");
    let consequence =
        format!("the illuminance right below is uncertain by {:.1} %", 100.0 * (high - low) / high);
    (high - low > 0.01 * high)
        .then(|| Finding::new("unequal-nadir", photometry.places.intensity(*odd, 0), message, consequence))
}

fn covered_range(photometry: &Photometry) -> Option<Finding> {
    let distribution = &photometry.distribution;
    let (azimuths, gammas) = distribution.grid()?;
    let (first, last) = (*gammas.first()?, *gammas.last()?);
    // What the missing part would hold if the nearest measured value went on.
    let lost = |gamma_deg: f64, from_deg: f64, to_deg: f64| {
        let planes = &azimuths[..azimuths.len() - 1];
        let sum: f64 = planes.iter().map(|azimuth| distribution.intensity_at(*azimuth, gamma_deg)).sum();
        let solid_angle_sr = TAU * (from_deg.to_radians().cos() - to_deg.to_radians().cos());
        100.0 * sum / planes.len() as f64 * solid_angle_sr / distribution.flux().0
    };
    let starts_odd = first > 0.0 && (first - 90.0).abs() > 1e-6;
    if starts_odd {
        let consequence = format!(
            "the cone below is taken as dark: up to about {:.1} % of the flux is missing, right under the luminaire",
            lost(first, 0.0, first)
        );
        let line = photometry.places.gammas.map(|[first, _]| first);
        return Some(Finding::new("missing-nadir", line, format!("γ starts at {first}°"), consequence));
    }
    let ends_odd = (last - 90.0).abs() > 1e-6 && (last - 180.0).abs() > 1e-6;
    let end = if last < 90.0 { 90.0 } else { 180.0 };
    let consequence = format!(
        "directions beyond are taken as dark: up to about {:.1} % of the flux is missing",
        lost(last, last, end)
    );
    let line = photometry.places.gammas.map(|[_, last]| last);
    ends_odd.then(|| Finding::new("missing-range", line, format!("γ ends at {last}°"), consequence))
}

fn is_flat_area(opening: Opening) -> bool {
    opening.is_flat() && opening.area_m2() > 0.0
}

fn horizon(photometry: &Photometry) -> Option<Finding> {
    let distribution = &photometry.distribution;
    let (azimuths, gammas) = distribution.grid()?;
    let at = |azimuth: f64| distribution.intensity_at(azimuth, 90.0);
    let brightest = *azimuths.iter().rev().max_by(|a, b| at(**a).total_cmp(&at(**b)))?;
    let at_horizon = at(brightest);
    let from_horizon = gammas.partition_point(|gamma| *gamma < 90.0 - 1e-6);
    let share = at_horizon / distribution.max_intensity().0;
    let message = format!(
        "{:.1} % of the largest intensity ({at_horizon:.1} cd) leaves a flat opening edge-on at γ = 90°",
        100.0 * share
    );
    let nits = at_horizon / (photometry.opening.area_m2() * 85_f64.to_radians().cos());
    let consequence = format!(
        "its projected area is 0 there: luminance and UGR near the horizon are overstated, by some {nits:.0} cd/m² at \
         85°; luminous sides seem to be missing"
    );
    (is_flat_area(photometry.opening) && share > 0.005).then(|| {
        let line = photometry.places.intensity(brightest, from_horizon);
        Finding::new("horizon-light", line, message, consequence)
    })
}

fn uplight(photometry: &Photometry) -> Option<Finding> {
    let distribution = &photometry.distribution;
    let up_lm = distribution.zonal_flux(90.0, 180.0).0;
    let share = up_lm / distribution.flux().0;
    let message = format!(
        "{:.1} % of the flux ({up_lm:.0} lm) goes up although the opening is flat and faces down",
        100.0 * share
    );
    let consequence = if share < 0.05 {
        format!(
            "a flat opening cannot do that: {up_lm:.0} lm reach the ceiling that may be stray light of the measurement"
        )
    } else {
        "the opening describes at most the lower part: luminance from above is undefined, and UGR attributes all light \
         to that area; illuminance is not affected"
            .to_owned()
    };
    (is_flat_area(photometry.opening) && share > 0.005)
        .then(|| Finding::new("flat-uplight", brightest_above(photometry), message, consequence))
}

/// The line of the largest intensity above the horizon.
fn brightest_above(photometry: &Photometry) -> Option<usize> {
    let (azimuths, gammas) = photometry.distribution.grid()?;
    let above = gammas.iter().enumerate().filter(|(_, gamma)| **gamma > 90.0);
    let nodes = above.flat_map(|(i, gamma)| azimuths.iter().map(move |azimuth| (*azimuth, i, *gamma)));
    let cds = nodes.map(|(azimuth, i, gamma)| {
        (photometry.distribution.intensity_at(azimuth, gamma), photometry.places.intensity(azimuth, i))
    });
    cds.reduce(|best, next| if next.0 > best.0 { next } else { best })?.1
}

#[cfg(test)]
mod tests {
    use super::super::{IntensityDistribution, Lm63Version, Places};
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
            places: Places::default(),
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
        assert_eq!(codes(&lossy), ["flux-contradiction"]);
        assert!(check(&lossy)[0].consequence.starts_with("Ē is 50.0 % lower"));
        lossy.format = Format::Lm63 { version: Lm63Version::Y2002 };
        lossy.rated_flux_lm = Some(0.95 * lossy.distribution.flux().0);
        assert_eq!(codes(&lossy), ["flux-mismatch"]);
    }
}
