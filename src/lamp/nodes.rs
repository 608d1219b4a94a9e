//! Single values out of line: spikes and drop-outs of a table. A narrow beam is no spike: a value
//! counts only if it is out of line along γ *and* around the axis.

use crate::photometry::{Finding, Format, Photometry};

/// Times the largest neighbour that a value must reach to be a spike.
const SPIKE: f64 = 3.0;
/// Neighbours below this share of the largest intensity do not matter.
const DIM: f64 = 0.1;

/// Values that stand alone, as one finding each for spikes and drop-outs.
pub(super) fn check(photometry: &Photometry) -> Vec<Finding> {
    let distribution = &photometry.distribution;
    let Some((azimuths, gammas)) = distribution.grid() else {
        return Vec::new();
    };
    let rotational = distribution.is_rotationally_symmetric();
    let planes = if rotational { 1 } else { azimuths.len() - 1 };
    let peak_cd = distribution.max_intensity().0;
    let cd = |j: usize, i: usize| distribution.intensity_at(azimuths[j % (azimuths.len() - 1)], gammas[i]);
    let (mut spikes, mut gaps) = (Vec::new(), Vec::new());
    for (j, azimuth_deg) in azimuths[..planes].iter().copied().enumerate() {
        for (i, gamma_deg) in gammas.iter().copied().enumerate().take(gammas.len() - 1).skip(1) {
            let mut neighbours = vec![cd(j, i - 1), cd(j, i + 1)];
            if !rotational {
                neighbours.extend([cd(j + planes - 1, i), cd(j + 1, i)]);
            }
            let (low, high) = neighbours
                .iter()
                .fold((f64::INFINITY, 0.0_f64), |(low, high), cd| (low.min(*cd), high.max(*cd)));
            let line = photometry.places.intensity(azimuth_deg, i);
            let place = Place { azimuth_deg, gamma_deg, cd: cd(j, i), usual_cd: 0.5 * (low + high), line };
            // The step to the darkness behind a cut-off is no gap, a lone ray in it is a spike.
            if place.cd > SPIKE * high && place.cd > DIM * peak_cd {
                spikes.push(place);
            } else if low > DIM * peak_cd && SPIKE * place.cd < low {
                gaps.push(place);
            }
        }
    }
    let found = [("spike", spikes, "stand out above"), ("drop-out", gaps, "fall below")];
    found.into_iter().filter_map(|(code, places, verb)| finding(photometry, code, &places, verb)).collect()
}

struct Place {
    azimuth_deg: f64,
    gamma_deg: f64,
    cd: f64,
    usual_cd: f64,
    line: Option<usize>,
}

fn finding(photometry: &Photometry, code: &'static str, places: &[Place], verb: &str) -> Option<Finding> {
    let step = |place: &&Place| (place.cd - place.usual_cd).abs();
    let worst = places.iter().max_by(|a, b| step(a).total_cmp(&step(b)))?;
    let plane = match photometry.format {
        Format::Eulumdat | Format::Tm33 => format!("C{}", super::c_deg(worst.azimuth_deg)),
        Format::Lm63 { .. } => format!("plane {}°", worst.azimuth_deg),
    };
    let message = format!(
        "{} of the intensities {verb} all their neighbours; the worst at {plane}, γ {}°: {:.1} cd among {:.1} cd",
        places.len(),
        worst.gamma_deg,
        worst.cd,
        worst.usual_cd
    );
    let consequence = format!(
        "where this direction meets a surface its illuminance is {:.1} times as high as its surroundings suggest; \
         so is the luminance seen from there",
        worst.cd / worst.usual_cd.max(1e-9 * worst.cd).max(f64::MIN_POSITIVE)
    );
    Some(Finding::new(code, worst.line, message, consequence))
}
