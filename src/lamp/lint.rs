//! Checks that need more than the parser: plausibility of power, planes, single values and bytes.
//! A check states what it would do to the result; none of them changes a number.

use glam::DVec3;

use super::flux::zonal_rule;
use super::nodes;
use crate::photometry::{Finding, Format, IntensityDistribution, Opening, Photometry};

/// Luminous efficacy of real luminaires, lm/W: the best LED luminaires reach 220.
const EFFICACY_LM_PER_W: [f64; 2] = [5.0, 250.0];
/// A mean luminance above that of any lens over an LED, cd/m².
const LUMINANCE_MAX: f64 = 5e7;

/// Findings beyond those of the parser.
pub fn check(bytes: &[u8], photometry: &Photometry) -> Vec<Finding> {
    let mut findings: Vec<Finding> =
        [efficacy, no_power, light_output_ratio, swapped_planes, coarse, luminance]
            .iter()
            .filter_map(|check| check(photometry))
            .collect();
    findings.extend(nodes::check(photometry));
    findings.extend(line_ends(bytes, photometry.format));
    findings.extend(encoding(bytes));
    findings
}

fn efficacy(photometry: &Photometry) -> Option<Finding> {
    let watts = photometry.power_w?;
    let lm = photometry.distribution.flux().0;
    let efficacy = lm / watts;
    let [low, high] = EFFICACY_LM_PER_W;
    let message = format!("{lm:.0} lm from {watts} W are {efficacy:.0} lm/W");
    let consequence = if efficacy > high {
        format!(
            "no luminaire reaches that: the flux is too high by a factor of {:.1} or more, or the power belongs \
                 to a part of it; illuminance, or the energy balance, is wrong by as much",
            efficacy / 200.0
        )
    } else {
        "no luminaire is that poor: the flux is too low (per 1000 lm?) or the power too high; illuminance, or the \
         energy balance, is wrong by as much"
            .to_owned()
    };
    (!(low..=high).contains(&efficacy))
        .then(|| Finding::new("efficacy", photometry.places.power, message, consequence))
}

fn no_power(photometry: &Photometry) -> Option<Finding> {
    let consequence = "efficacy and installed power per area cannot be computed";
    let line = photometry.places.power;
    photometry.power_w.is_none().then(|| Finding::new("no-power", line, "no power is stated", consequence))
}

fn light_output_ratio(photometry: &Photometry) -> Option<Finding> {
    let lor = photometry.lor.filter(|lor| *lor > 1.005)?;
    let message = format!("a light output ratio of {:.1} %", 100.0 * lor);
    let consequence = format!(
        "a luminaire gives no more than its lamps: the rated flux is {:.1} % too high, or the lamps' too low",
        100.0 * (lor - 1.0)
    );
    Some(Finding::new("lor-above-one", photometry.places.output_ratio, message, consequence))
}

/// Towards the horizon only the luminous sides are seen: where they differ between the two axes, so
/// must the intensities, in the same sense.
fn swapped_planes(photometry: &Photometry) -> Option<Finding> {
    const CLEAR: f64 = 2.0;
    let Opening::Rect { length_m, width_m, .. } = photometry.opening else {
        return None;
    };
    let steep = |x: f64, y: f64| {
        let (sin, cos) = 85_f64.to_radians().sin_cos();
        let toward = [DVec3::new(x * sin, y * sin, -cos), DVec3::new(-x * sin, -y * sin, -cos)];
        let cd: f64 = toward.iter().map(|w| photometry.distribution.intensity_along(*w)).sum();
        (cd, photometry.opening.projected_area_m2(toward[0]))
    };
    let ((along_cd, along_m2), (across_cd, across_m2)) = (steep(1.0, 0.0), steep(0.0, 1.0));
    let usual = photometry.distribution.max_intensity().0;
    let seen = along_m2 > 0.0 && across_m2 > 0.0 && along_cd + across_cd > 0.02 * usual;
    let (area_ratio, cd_ratio) = (across_m2 / along_m2, across_cd / along_cd);
    let contradicts =
        (area_ratio > CLEAR && cd_ratio < 1.0 / CLEAR) || (area_ratio < 1.0 / CLEAR && cd_ratio > CLEAR);
    let message = format!(
        "near the horizon the opening of {length_m:.2} × {width_m:.2} m shows {area_ratio:.2} times as much area across \
         its length as along it, but {cd_ratio:.2} times the intensity"
    );
    let consequence = format!(
        "C0 and C90 seem to be swapped: the luminance at 85° along the length comes out {:.1} times as high as with \
         the planes turned by 90°, and UGR changes with it",
        (along_cd / along_m2) / (across_cd / along_m2).max(1e-12)
    );
    (seen && contradicts)
        .then(|| Finding::new("swapped-planes", photometry.places.opening, message, consequence))
}

/// Leaving out every second γ shows how much the table's step matters: the error of linear
/// interpolation grows with the square of the step, so what is left is a third of the change.
fn coarse(photometry: &Photometry) -> Option<Finding> {
    let distribution = &photometry.distribution;
    let (azimuths, gammas) = distribution.grid()?;
    if gammas.len() < 5 || gammas.len() % 2 == 0 {
        return None;
    }
    let half: Vec<f64> = gammas.iter().copied().step_by(2).collect();
    let plane =
        |azimuth: &f64| half.iter().map(|gamma| distribution.intensity_at(*azimuth, *gamma)).collect();
    let coarser: IntensityDistribution = IntensityDistribution::from_grid(
        azimuths.to_vec(),
        half.clone(),
        azimuths.iter().map(plane).collect(),
    )
    .ok()?;
    let left = 100.0 * (zonal_rule(&coarser).0 / zonal_rule(distribution).0 - 1.0) / 3.0;
    let widest = gammas.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let message = format!("γ in steps of up to {widest}° is coarse for this beam");
    let consequence = format!(
        "the flux is uncertain by about {:.1} % from interpolation alone, the illuminance in the beam by more",
        left.abs()
    );
    let line = photometry.places.gammas.map(|[first, _]| first);
    (left.abs() > 1.0).then(|| Finding::new("coarse-angles", line, message, consequence))
}

fn luminance(photometry: &Photometry) -> Option<Finding> {
    let area_m2 = photometry.opening.area_m2();
    let cd = photometry.distribution.intensity_at(0.0, 0.0);
    let nits = cd / area_m2;
    let message = format!("{cd:.0} cd at nadir from {:.2} cm²", 1e4 * area_m2);
    let consequence =
        format!("a luminance of {nits:.1e} cd/m²: UGR is far too high; are the sizes in the right unit?");
    (area_m2 > 0.0 && nits > LUMINANCE_MAX)
        .then(|| Finding::new("implausible-luminance", photometry.places.opening, message, consequence))
}

/// CR LF belongs to DOS and to LM-63's own text; it is reported because some readers keep the CR.
fn line_ends(bytes: &[u8], format: Format) -> Option<Finding> {
    let count = |pattern: &[u8]| bytes.windows(pattern.len()).filter(|part| *part == pattern).count();
    let (pairs, feeds) = (count(b"\r\n"), count(b"\n"));
    if pairs == 0 {
        return None;
    }
    if pairs < feeds {
        let message = format!("{pairs} lines end in CR LF, {} in LF alone", feeds - pairs);
        let consequence =
            "read alike here; the file was edited or joined by hand, so look at its values twice";
        let lines = bytes.split_inclusive(|byte| *byte == b'\n');
        let odd = lines.take_while(|line| line.ends_with(b"\r\n")).count() + 1;
        return Some(Finding::new("mixed-line-ends", odd, message, consequence));
    }
    let message = match format {
        Format::Lm63 { .. } => "lines end in CR LF, as LM-63 asks for",
        Format::Eulumdat | Format::Tm33 => "lines end in CR LF",
    };
    let consequence = "no effect here; readers that keep the CR may misread the last number of a line";
    Some(Finding::new("crlf", 1, message, consequence))
}

fn encoding(bytes: &[u8]) -> Option<Finding> {
    let first = bytes.iter().position(|byte| *byte >= 0x80)?;
    let line = bytes[..first].split(|byte| *byte == b'\n').count();
    let message = "a name holds characters beyond ASCII, whose encoding the format does not state";
    let consequence = "names may be shown wrongly, numbers are not affected";
    Some(Finding::new("encoding", line, message, consequence))
}
