//! LM-63 (IES) of 1986 to 2019, types A, B and C. Its 0° plane lies *along* the luminaire (+x), its *width*
//! across it. Candelas are multiplied once each by multiplier, ballast factor and, up to 1995,
//! ballast-lamp factor; later editions put other things into that field.

use super::ies_goniometer::{Goniometer, resampled};
use super::ies_head::Head;
use super::ies_opening::opening;
use super::ies_tilt::is_tilt;
use super::numbers::{Comma, DAMAGED, Numbers, check_gamma_range, count, positive, shortened};
use super::odd_angle::odd_angle;
use super::planes::{Plane, close_circle, mirrored, spread};
use super::{Fault, Finding, Format, Photometry, Places};

/// Editions of LM-63.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lm63Version {
    /// 1986, no header line.
    Y1986,
    /// 1991, `IESNA91`.
    Y1991,
    /// 1995, `IESNA:LM-63-1995`.
    Y1995,
    /// 2002, `IESNA:LM-63-2002`.
    Y2002,
    /// 2019, `IES:LM-63-2019`.
    Y2019,
}

/// An edition line or a TILT line.
pub(super) fn recognises(lines: &[&str]) -> bool {
    let first = lines.iter().map(|line| line.trim()).find(|line| !line.is_empty()).unwrap_or_default();
    first.starts_with("IESNA") || first.starts_with("IES:") || tilt_line(lines).is_some()
}

fn tilt_line(lines: &[&str]) -> Option<usize> {
    lines.iter().position(|line| is_tilt(line))
}

pub(super) fn read(lines: &[&str]) -> Result<Photometry, Fault> {
    let mut findings = Vec::new();
    let version = version(lines, &mut findings);
    let Some(tilt_index) = tilt_line(lines) else {
        return Err(Fault::new(lines.len(), "the file ends before its TILT= line", DAMAGED));
    };
    let mut numbers = Numbers::new(lines, tilt_index + 1, Comma::Separator);
    let tilt = tilt_factor(lines[tilt_index], tilt_index + 1, &mut numbers, &mut findings)?;
    let head = Head::read(&mut numbers)?;
    let (n_gamma, n_plane) = head.counts(lines)?;
    let gammas = numbers.angles(if head.goniometer == Goniometer::C { "γ" } else { "V" }, n_gamma)?;
    if head.goniometer == Goniometer::C {
        check_gamma_range(&gammas)?;
    }
    let angles = numbers.angles("horizontal angle", n_plane)?;
    let factor = head.factor(version, &mut findings) * tilt;
    findings.extend(odd_angle("horizontal angle", &angles, true));
    findings.extend(odd_angle(if head.goniometer == Goniometer::C { "γ" } else { "V" }, &gammas, false));
    let data_line = numbers.line;
    let mut planes = Vec::new();
    for angle in &angles {
        planes.push(numbers.plane(&format!("{}°", angle.value), angle.value, &gammas, factor)?);
    }
    if let Some((line, token)) = numbers.rest() {
        let message = format!("text after the last intensity, from '{}'", shortened(token));
        let consequence = "ignored; if angles were left out of the head, every intensity may be shifted";
        findings.push(Finding::new("trailing-data", line, message, consequence));
    }
    let mut places = Places {
        flux: Some(head.lumens_line),
        power: Some(head.power_line),
        opening: Some(head.size_line),
        gammas: Some([gammas[0].line, gammas[n_gamma - 1].line]),
        ..Places::default()
    };
    let distribution = if head.goniometer == Goniometer::C {
        let planes = expanded(planes, angles[0].line, &mut findings)?;
        places = places.with_planes(&planes, 0.0);
        let gammas = gammas.iter().map(|gamma| gamma.value).collect();
        close_circle(planes, gammas, 0.0)
            .map_err(|error| Fault::new(data_line, error.to_string(), DAMAGED))?
    } else {
        let (distribution, found) = resampled(head.goniometer, &gammas, &angles, &planes)?;
        findings.extend(found);
        distribution
    };
    let opening = opening(head.size_m()?, version, head.size_line, &mut findings);
    let lamp_flux_lm = head.lamp_flux_lm(&mut findings);
    Ok(Photometry {
        format: Format::Lm63 { version },
        description: description(&lines[..tilt_index]),
        distribution,
        opening,
        rated_flux_lm: lamp_flux_lm,
        lamp_flux_lm,
        lor: None,
        power_w: Some(head.power_w).filter(|watts| *watts > 0.0),
        colour_rendering: None,
        places,
        findings,
    })
}

fn version(lines: &[&str], findings: &mut Vec<Finding>) -> Lm63Version {
    let first = lines.iter().map(|line| line.trim()).find(|line| !line.is_empty()).unwrap_or_default();
    if !first.starts_with("IES") {
        return Lm63Version::Y1986;
    }
    let known = [
        ("86", Lm63Version::Y1986),
        ("91", Lm63Version::Y1991),
        ("95", Lm63Version::Y1995),
        ("2002", Lm63Version::Y2002),
        ("02", Lm63Version::Y2002),
        ("2019", Lm63Version::Y2019),
        ("19", Lm63Version::Y2019),
    ];
    let found = known.iter().find(|(ending, _)| first.ends_with(ending)).map(|(_, version)| *version);
    found.unwrap_or_else(|| {
        let message = format!("unknown edition '{}'", shortened(first));
        let consequence =
            "read as LM-63-2002; the opening and the ballast-lamp factor may mean something else";
        findings.push(Finding::new("unknown-edition", 1, message, consequence));
        Lm63Version::Y2002
    })
}

/// The factor of the operating position of the measurement, tilt 0°; 1 without tilt data.
fn tilt_factor(
    tilt: &str,
    line: usize,
    numbers: &mut Numbers,
    findings: &mut Vec<Finding>,
) -> Result<f64, Fault> {
    let value = tilt.split_once('=').map(|(_, value)| value.trim()).unwrap_or_default();
    if value.eq_ignore_ascii_case("NONE") {
        return Ok(1.0);
    }
    if !value.eq_ignore_ascii_case("INCLUDE") {
        let message = format!("tilt data in another file ('{}')", shortened(value));
        return Err(Fault::new(
            line,
            message,
            "put that file beside this one, or paste its data after TILT=INCLUDE",
        ));
    }
    numbers.next("the lamp-to-luminaire geometry")?;
    let pairs = count(numbers.next("the number of tilt angles")?, "tilt angles", 1)?;
    let mut angles = Vec::new();
    for k in 1..=pairs {
        angles.push(numbers.next(format_args!("tilt angle {k} of {pairs}"))?.value);
    }
    let mut factors = Vec::new();
    for k in 1..=pairs {
        factors.push(numbers.next(format_args!("tilt factor {k} of {pairs}"))?);
    }
    let factor = positive(factors[0], "the first tilt factor")?;
    let message =
        format!("the lamp's flux depends on tilt; the first factor, {factor} at {}°, is applied", angles[0]);
    let [low, high] = factors
        .iter()
        .fold([f64::INFINITY, 0.0], |[low, high], k| [low.min(k.value), f64::max(high, k.value)])
        .map(|k| 100.0 * (k / factor - 1.0));
    let consequence =
        format!("mounted at another tilt, flux and illuminance differ by {low:+.0} % to {high:+.0} %");
    findings.push(Finding::new("tilt", line, message, consequence));
    Ok(factor)
}

/// The planes of the file and their mirror images, by the range of the horizontal angles.
fn expanded(planes: Vec<Plane>, line: usize, findings: &mut Vec<Finding>) -> Result<Vec<Plane>, Fault> {
    let is = |a: f64, b: f64| (a - b).abs() < 1e-3;
    let (first, last) = (planes[0].angle_deg, planes[planes.len() - 1].angle_deg);
    if planes.len() == 1 {
        return Ok(planes);
    }
    if is(first, 90.0) && is(last, 270.0) {
        return Ok(mirrored(planes, 90.0));
    }
    let step = last - planes[planes.len() - 2].angle_deg;
    if is(first, 0.0) && is(last, 90.0) {
        return Ok(mirrored(mirrored(planes, 0.0), 90.0));
    }
    if is(first, 0.0) && is(last, 180.0) {
        return Ok(mirrored(planes, 0.0));
    }
    if is(first, 0.0) && is(last, 360.0) {
        let seam = spread([&planes[0], &planes[planes.len() - 1]]);
        if seam > 0.01 {
            let message = format!(
                "the planes at 0° and 360° are one, but differ by {:.1} % of the largest intensity",
                100.0 * seam
            );
            let consequence = "the one at 0° is used: illuminance on that side is uncertain by as much";
            findings.push(Finding::new("open-seam", line, message, consequence));
        }
        return Ok(planes);
    }
    if is(first, 0.0) && last > 180.0 && last + 1.001 * step >= 360.0 && last < 360.0 {
        let consequence = "the one at 0° is used; programs that do not close the circle lose a sector";
        findings.push(Finding::new("open-seam", line, "the plane at 360° is missing", consequence));
        return Ok(planes);
    }
    let message = format!("horizontal angles run from {first}° to {last}°");
    let hint = "type C needs 0°, 0–90°, 0–180°, 90–270° or 0–360°";
    Err(Fault::new(line, message, hint))
}

/// Manufacturer, catalogue number and name, or the first line of a file without keywords.
fn description(header: &[&str]) -> String {
    let value =
        |keyword: &str| header.iter().find_map(|line| line.trim_start().strip_prefix(keyword)).map(str::trim);
    let parts = ["[MANUFAC]", "[LUMCAT]", "[LUMINAIRE]"]
        .into_iter()
        .filter_map(value)
        .filter(|part| !part.is_empty());
    let named = parts.collect::<Vec<_>>().join(" ");
    if !named.is_empty() {
        return named;
    }
    let free =
        header.iter().map(|line| line.trim()).find(|line| !line.is_empty() && !line.starts_with("IES"));
    free.unwrap_or_default().to_owned()
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::{Opening, PhotometryError, parse};
    use super::*;

    /// 2 lamps of 1000 lm, factors 2 · 0.9 · 0.5, quadrant 0 … 90, feet.
    pub(in super::super) const SAMPLE: &str = "IESNA:LM-63-1995\r\n[MANUFAC] Maker\r\n[LUMCAT] L-1\r\nTILT=NONE\r\n\
        2 1000 2.0 3 2 1 1 1.0 4.0 0\r\n0.9 0.5 60\r\n0 45 90\r\n0,90\r\n100 80\r\n0\r\n100, 40 0\r\n";

    fn read_sample(from: &str, to: &str) -> Result<Photometry, PhotometryError> {
        assert!(SAMPLE.contains(from), "{from}");
        parse(SAMPLE.replace(from, to).as_bytes(), "x.ies")
    }

    fn error(from: &str, to: &str) -> (usize, String) {
        let error = read_sample(from, to).expect_err("damaged");
        (error.line, error.message)
    }

    fn codes(photometry: &Photometry) -> Vec<&'static str> {
        photometry.findings.iter().map(|finding| finding.code).collect()
    }

    /// Catches: a factor forgotten or applied twice, 0° laid across, feet taken as metres.
    #[test]
    fn factors_frame_and_feet() {
        let lamp = read_sample("TILT", "TILT").expect("sound");
        let at = |azimuth: f64, gamma: f64| lamp.distribution.intensity_at(azimuth, gamma);
        for (azimuth, cd) in [(0.0, 72.0), (180.0, 72.0), (90.0, 36.0), (270.0, 36.0), (45.0, 54.0)] {
            assert!((at(azimuth, 45.0) - cd).abs() < 1e-9, "{azimuth}: {}", at(azimuth, 45.0));
        }
        let Opening::Rect { length_m, width_m, .. } = lamp.opening else { panic!("{:?}", lamp.opening) };
        assert!((length_m - 1.2192).abs() < 1e-12 && (width_m - 0.3048).abs() < 1e-12);
        assert_eq!((lamp.lamp_flux_lm, lamp.power_w, lamp.lor), (Some(2000.0), Some(60.0), None));
        assert_eq!((lamp.description.as_str(), codes(&lamp)), ("Maker L-1", vec![]));
    }

    /// Catches: the reserved field of 2002 or the generation type of 2019 taken as a factor.
    #[test]
    fn later_editions_have_no_ballast_lamp_factor() {
        let later = read_sample("IESNA:LM-63-1995", "IESNA:LM-63-2002").expect("sound");
        assert!((later.distribution.intensity_at(0.0, 0.0) - 180.0).abs() < 1e-9);
        assert_eq!(codes(&later), ["reserved-field"]);
        let newest = read_sample("IESNA:LM-63-1995", "IES:LM-63-2019").expect("sound");
        assert!((newest.distribution.max_intensity().0 - 180.0).abs() < 1e-9 && codes(&newest).is_empty());
        let oldest = read_sample("IESNA:LM-63-1995\r\n", "").expect("sound");
        assert_eq!(oldest.format, Format::Lm63 { version: Lm63Version::Y1986 });
    }

    /// Catches: absolute photometry scaled by −1 lm, or rated by it.
    #[test]
    fn absolute_photometry() {
        let lamp = read_sample("2 1000", "1 -1").expect("sound");
        assert!((lamp.distribution.max_intensity().0 - 90.0).abs() < 1e-9);
        assert_eq!((lamp.rated_flux_lm, lamp.lamp_flux_lm), (None, None));
    }

    /// Catches: 90 … 270 read as 0 … 180, missing 360° refused, a gap closed silently.
    #[test]
    fn horizontal_ranges() {
        let value = |angles: &str, azimuth: f64| {
            read_sample("0,90", angles).map(|lamp| lamp.distribution.intensity_at(azimuth, 45.0))
        };
        let near = |found: Result<f64, PhotometryError>, cd: f64| (found.expect("sound") - cd).abs() < 1e-9;
        assert!(near(value("90 270", 90.0), 72.0) && near(value("90 270", 270.0), 36.0));
        assert!(near(value("90 270", 0.0), 54.0) && near(value("90 270", 180.0), 54.0));
        assert!(near(value("0 180", 270.0), 54.0) && near(value("0 180", 180.0), 36.0));
        let seam = read_sample("0,90", "0 360").expect("sound");
        assert_eq!(codes(&seam), ["open-seam"]);
        assert!(value("0 45", 0.0).is_err() && value("10 90", 0.0).is_err());
    }

    /// Catches: tilt data taken for the head, the factor applied not at all or for every angle.
    #[test]
    fn tilt_data_is_read_over_lines() {
        let tilt = "TILT=INCLUDE\r\n1\r\n3\r\n0 45\r\n90\r\n0.5 0.8\r\n1.0";
        let lamp = read_sample("TILT=NONE", tilt).expect("sound");
        assert!((lamp.distribution.max_intensity().0 - 45.0).abs() < 1e-9);
        assert_eq!(codes(&lamp), ["tilt"]);
        assert_eq!(error("TILT=NONE", "TILT=lamp.tlt").0, 4);
    }

    /// Catches: damage accepted, or reported without its line and value.
    #[test]
    fn damage_is_named() {
        assert_eq!(error("0 45 90", "0 45 40"), (7, "γ must rise, found 40° after 45°".to_owned()));
        assert_eq!(
            error("3 2 1 1", "3 2 4 1"),
            (5, "photometric type 4, expected 1 (C), 2 (B) or 3 (A)".to_owned())
        );
        assert_eq!(
            error("100, 40 0", "100 -1 0"),
            (11, "the intensity at 90°, γ 45° is negative: -1".to_owned())
        );
        assert_eq!(
            error("100, 40 0", "100"),
            (11, "the file ends before the intensity at 90°, γ 45°".to_owned())
        );
        assert_eq!(error("100 80", "100 x").1, "expected the intensity at 0°, γ 45°, found 'x'");
        assert_eq!(error("100 80", "100 NaN").0, 9);
        assert_eq!(error("2.0 3 2", "2.0 3000 2000").0, 5);
        assert_eq!(error("2.0 3 2", "2.0 1e18 1e18").0, 5);
        assert_eq!(error("2.0 3 2", "0 3 2").1, "the candela multiplier is 0, expected a number > 0");
        assert_eq!(error("1 1 1.0 4.0", "1 3 1.0 4.0").0, 5);
        let trailing = read_sample("100, 40 0", "100 40 0 \x1a 7").expect("tolerated");
        assert_eq!(
            trailing.findings.iter().map(|f| (f.code, f.line)).collect::<Vec<_>>(),
            [("trailing-data", Some(11))]
        );
    }

    /// Catches: bytes beyond ASCII in a keyword refused.
    #[test]
    fn any_encoding_in_keywords() {
        let bytes: Vec<u8> = SAMPLE.bytes().map(|byte| if byte == b'M' { 0xCC } else { byte }).collect();
        let text = SAMPLE.replace("LM-63", "LX-63").replace("[MANUFAC]", "[XANUFAC]");
        assert!(parse(&bytes, "x.ies").is_ok() && parse(text.as_bytes(), "x.ies").is_ok());
    }
}
