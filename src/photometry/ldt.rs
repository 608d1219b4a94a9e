//! EULUMDAT, one value per line. Its C0 plane lies *across* the luminaire, its length along
//! C90–C270: in the luminaire frame C90 is +x and C0 is −y, azimuth = C − 90°. Intensities are
//! per 1000 lm of the lamps, so LOR is contained in them and is not applied again.

use super::ldt_head::Head;
use super::numbers::{
    Comma, DAMAGED, MAX_VALUES, Number, Numbers, check_gamma_range, count, parse, shortened,
};
use super::odd_angle::odd_angle;
use super::planes::{Plane, close_circle, mirrored, spread};
use super::{Fault, Finding, Format, Photometry, Places};

/// Azimuth of the luminaire frame minus C.
const TURN_DEG: f64 = -90.0;
const DIRECT_RATIOS: usize = 10;

/// A symmetry 0 … 4 in line 3 and counts in lines 4 and 6.
pub(super) fn recognises(lines: &[&str]) -> bool {
    let number = |line: usize| lines.get(line - 1).and_then(|text| parse(text.trim(), Comma::DecimalPoint));
    let symmetry = number(3).is_some_and(|isym| isym.fract().abs() < 1e-9 && (0.0..=4.0).contains(&isym));
    symmetry && number(4).is_some() && number(6).is_some()
}

pub(super) fn read(lines: &[&str]) -> Result<Photometry, Fault> {
    let mut head = Head { lines, findings: Vec::new() };
    let symmetry = Symmetry::read(head.required(3, "the symmetry Isym")?)?;
    let n_plane = count(head.required(4, "the number of C planes")?, "C planes", 1)?;
    let n_gamma = count(head.required(6, "the number of γ angles")?, "γ angles", 2)?;
    let stored = n_plane.min(symmetry.stored(n_plane));
    if stored.saturating_mul(n_gamma) > lines.iter().map(|line| line.len()).sum::<usize>().min(MAX_VALUES) {
        let message = format!("{n_plane} C planes of {n_gamma} γ angles are more than the file holds");
        return Err(Fault::new(4, message, DAMAGED));
    }
    head.check_gaps()?;
    let opening = head.opening();
    let lamps = head.lamps()?;

    let mut numbers = Numbers::new(lines, lamps.end, Comma::DecimalPoint);
    for k in 1..=DIRECT_RATIOS {
        numbers.next(format_args!("direct ratio {k} of {DIRECT_RATIOS}"))?;
    }
    let angles = numbers.angles("C", n_plane)?;
    if angles[0].value < 0.0 || angles[n_plane - 1].value > 360.0 {
        let message = format!("C runs from {}° to {}°", angles[0].value, angles[n_plane - 1].value);
        return Err(Fault::new(angles[0].line, message, DAMAGED));
    }
    let gammas = numbers.angles("γ", n_gamma)?;
    check_gamma_range(&gammas)?;
    head.findings.extend(odd_angle("C", &angles, true));
    head.findings.extend(odd_angle("γ", &gammas, false));
    let data_line = numbers.line + 1;
    let planes =
        read_planes(&mut numbers, symmetry, &angles, &gammas, lamps.cd_per_value, &mut head.findings)?;
    if let Some((line, token)) = numbers.rest() {
        let message = format!("text after the last intensity, from '{}'", shortened(token));
        let consequence = "ignored; if the counts of planes are wrong, every intensity may be shifted";
        head.findings.push(Finding::new("trailing-data", line, message, consequence));
    }
    head.check_light_source_type(&planes);
    let places = Places {
        flux: Some(29),
        output_ratio: Some(23),
        power: Some(32),
        opening: Some(16),
        gammas: Some([gammas[0].line, gammas[n_gamma - 1].line]),
        ..Places::default()
    }
    .with_planes(&planes, TURN_DEG);
    let gammas = gammas.iter().map(|gamma| gamma.value).collect();
    let distribution = close_circle(planes, gammas, TURN_DEG)
        .map_err(|error| Fault::new(data_line, error.to_string(), DAMAGED))?;
    head.check_down_share(&distribution);
    let lor = head.optional(23).filter(|percent| *percent > 0.0).map(|percent| 0.01 * percent);
    Ok(Photometry {
        format: Format::Eulumdat,
        description: head.description(),
        distribution,
        opening,
        rated_flux_lm: lor.map(|lor| lor * lamps.flux_lm),
        lamp_flux_lm: (!lamps.absolute).then_some(lamps.flux_lm),
        lor,
        power_w: lamps.power_w,
        colour_rendering: lamps.colour_rendering,
        places,
        findings: head.findings,
    })
}

/// Isym: which planes are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symmetry {
    None,
    Rotational,
    AboutC0,
    AboutC90,
    Both,
}

impl Symmetry {
    fn read(isym: Number) -> Result<Self, Fault> {
        let all = [Self::None, Self::Rotational, Self::AboutC0, Self::AboutC90, Self::Both];
        let found = all.into_iter().enumerate().find(|(k, _)| (isym.value - *k as f64).abs() < 1e-9);
        let message = || format!("symmetry {}, expected 0 … 4", isym.value);
        found.map(|(_, symmetry)| symmetry).ok_or_else(|| Fault::new(isym.line, message(), DAMAGED))
    }

    /// At least so many of `n` planes are stored.
    fn stored(self, n: usize) -> usize {
        match self {
            Self::None => n,
            Self::Rotational => 1,
            Self::AboutC0 | Self::AboutC90 => n / 2 + 1,
            Self::Both => n / 4 + 1,
        }
    }

    /// The stored C angles, in their order in the file: Isym 3 starts at C270.
    fn angles(self, all: &[Number]) -> Result<Vec<f64>, Fault> {
        let all_deg = || all.iter().map(|angle| angle.value);
        let has = |deg: f64| all_deg().any(|angle| (angle - deg).abs() < 1e-6);
        let up_to = |limit: f64| all_deg().filter(move |angle| *angle <= limit + 1e-6);
        let (stored, needed): (Vec<f64>, &[f64]) = match self {
            Self::None => (all_deg().collect(), &[]),
            Self::Rotational => (vec![0.0], &[]),
            Self::AboutC0 => (up_to(180.0).collect(), &[0.0, 180.0]),
            Self::AboutC90 => {
                let late = all_deg().filter(|angle| *angle >= 270.0 - 1e-6 && *angle < 360.0 - 1e-6);
                (late.chain(up_to(90.0)).collect(), &[270.0, 90.0])
            }
            Self::Both => (up_to(90.0).collect(), &[0.0, 90.0]),
        };
        if let Some(missing) = needed.iter().find(|deg| !has(**deg)) {
            let message = format!("the declared symmetry needs a plane at C{missing}, which is not listed");
            return Err(Fault::new(all[0].line, message, "check lines 3 (symmetry) to 5 (step of C)"));
        }
        Ok(stored)
    }

    fn expand(self, planes: Vec<Plane>) -> Vec<Plane> {
        match self {
            Self::None | Self::Rotational => planes,
            Self::AboutC0 => mirrored(planes, 0.0),
            Self::AboutC90 => mirrored(planes, 90.0),
            Self::Both => mirrored(mirrored(planes, 0.0), 90.0),
        }
    }
}

/// All planes in their C angles. Some programs declare a symmetry and store every plane all the
/// same; then all of them are used.
fn read_planes(
    numbers: &mut Numbers,
    symmetry: Symmetry,
    angles: &[Number],
    gammas: &[Number],
    factor: f64,
    findings: &mut Vec<Finding>,
) -> Result<Vec<Plane>, Fault> {
    let mut stored = symmetry.angles(angles)?;
    let complete = stored.len() < angles.len() && numbers.left() == angles.len() * gammas.len();
    if complete {
        stored = angles.iter().map(|angle| angle.value).collect();
    }
    let first_line = numbers.line + 1;
    let mut planes = Vec::new();
    for angle_deg in stored {
        planes.push(numbers.plane(&format!("C{angle_deg}"), angle_deg, gammas, factor)?);
    }
    if !complete {
        return Ok(symmetry.expand(planes));
    }
    let asymmetry = symmetry_error(symmetry, &planes, gammas);
    let message = format!(
        "the file declares a symmetry (line 3) but stores all {} planes, which depart from it by {:.1} % of the \
         largest intensity",
        angles.len(),
        100.0 * asymmetry
    );
    let consequence = "all planes are used; programs that trust the symmetry read others";
    findings.push(Finding::new("asymmetry", first_line, message, consequence));
    Ok(planes)
}

/// Largest difference between a direction and its image, as a part of the largest intensity.
fn symmetry_error(symmetry: Symmetry, planes: &[Plane], gammas: &[Number]) -> f64 {
    if symmetry == Symmetry::Rotational {
        return spread(planes);
    }
    let gammas_deg: Vec<f64> = gammas.iter().map(|gamma| gamma.value).collect();
    let Ok(distribution) = close_circle(planes.to_vec(), gammas_deg.clone(), 0.0) else {
        return 0.0;
    };
    let mut widest = 0.0_f64;
    for plane in planes {
        let bare = Plane { angle_deg: plane.angle_deg, cd: Vec::new(), lines: [].into() };
        for image in symmetry.expand(vec![bare]) {
            for (gamma, cd) in gammas_deg.iter().zip(&plane.cd) {
                let mirrored_cd = distribution.intensity_at(image.angle_deg, *gamma);
                widest = widest.max((mirrored_cd - cd).abs());
            }
        }
    }
    let peak = distribution.max_intensity().0;
    if peak > 0.0 { widest / peak } else { 0.0 }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::{Opening, PhotometryError, parse as parse_file};
    use super::*;

    const C_STEP: usize = 45;

    /// Isym `isym`, 8 planes, γ 0 45 90, value of plane k: 500, 100 + 10 k, 0; 2000 lm.
    fn lines(isym: usize) -> Vec<String> {
        let head = format!(
            "Maker;2;{isym};8;45;3;45;rep;Lamp;no;file;date;1300;300;80;1200;200;10;20;30;40;100;90;1;0;1"
        );
        let set = "1;LED;2000;4000;1A/>90;25,5";
        let mut lines: Vec<String> = format!("{head};{set}").split(';').map(str::to_owned).collect();
        lines.extend((0..10).map(|_| "0.5".to_owned()));
        lines.extend((0..8).map(|k| (k * C_STEP).to_string()));
        lines.extend([0, 45, 90].map(|gamma| gamma.to_string()));
        let stored = [8, 1, 5, 5, 3][isym];
        lines.extend(
            (0..stored).flat_map(|k| ["500".to_owned(), (100 + 10 * k).to_string(), "0,0".to_owned()]),
        );
        lines
    }

    pub(in super::super) fn sample() -> String {
        lines(0).join("\r\n") + "\r\n"
    }

    fn read_lines(lines: &[String]) -> Result<Photometry, PhotometryError> {
        parse_file(lines.join("\n").as_bytes(), "x.ldt")
    }

    fn edited(isym: usize, line: usize, text: &str) -> Result<Photometry, PhotometryError> {
        let mut lines = lines(isym);
        text.clone_into(&mut lines[line - 1]);
        read_lines(&lines)
    }

    fn codes(photometry: &Photometry) -> Vec<&'static str> {
        photometry
            .findings
            .iter()
            .map(|finding| finding.code)
            .filter(|code| !code.starts_with("flux-"))
            .collect()
    }

    /// Catches: C0 laid along the lamp, planes of Isym 3 started at C0 or C90, wrong mirrors.
    #[test]
    fn symmetries_in_the_luminaire_frame() {
        // cd at C = 0, 45 … 315 over 2 (2000 lm).
        let by_c = [
            [100, 110, 120, 130, 140, 150, 160, 170],
            [100; 8],
            [100, 110, 120, 130, 140, 130, 120, 110],
            [120, 130, 140, 130, 120, 110, 100, 110],
            [100, 110, 120, 110, 100, 110, 120, 110],
        ];
        for (isym, planes) in by_c.iter().enumerate() {
            let lamp = read_lines(&lines(isym)).expect("sound");
            for (k, value) in planes.iter().enumerate() {
                let azimuth = (k * C_STEP) as f64 - 90.0;
                let cd = lamp.distribution.intensity_at(azimuth, 45.0);
                assert!((cd - 2.0 * f64::from(*value)).abs() < 1e-9, "Isym {isym}, C{}: {cd}", k * C_STEP);
            }
            assert_eq!(lamp.distribution.is_rotationally_symmetric(), isym == 1);
            assert!(codes(&lamp).is_empty(), "{:?}", lamp.findings);
        }
    }

    /// Catches: length across, a side's height on the wrong side, LOR applied to the candelas.
    #[test]
    fn sizes_and_lamps() {
        let lamp = read_lines(&lines(0)).expect("sound");
        let rect = Opening::Sided { length_m: 1.2, width_m: 0.2, sides_m: [0.02, 0.03, 0.04, 0.01] };
        assert_eq!(format!("{:.6?}", lamp.opening), format!("{rect:.6?}"));
        assert_eq!(
            (lamp.lamp_flux_lm, lamp.rated_flux_lm, lamp.power_w),
            (Some(2000.0), Some(1800.0), Some(25.5))
        );
        assert_eq!((lamp.colour_rendering, lamp.description.as_str()), (Some(90.0), "Maker Lamp"));
        let round = edited(0, 17, "0").expect("sound");
        let disc = Opening::Disc { diameter_m: 1.2, height_m: 0.025 };
        assert_eq!(format!("{:.6?}", round.opening), format!("{disc:.6?}"));
        let doubled = edited(0, 24, "2").expect("sound");
        assert!((doubled.distribution.max_intensity().0 - 2000.0).abs() < 1e-9);
        let absolute = edited(0, 27, "-1").expect("sound");
        assert!(
            (absolute.distribution.max_intensity().0 - 1000.0).abs() < 1e-9
                && absolute.lamp_flux_lm.is_none()
        );
    }

    /// Catches: oddities that pass in silence.
    #[test]
    fn oddities_are_found() {
        assert_eq!(codes(&edited(0, 2, "1").expect("usable")), ["asymmetry"]);
        assert_eq!(codes(&edited(0, 22, "40").expect("usable")), ["down-share"]);
        assert_eq!(codes(&edited(0, 25, "15").expect("usable")), ["tilt"]);
        assert_eq!(codes(&edited(0, 24, "0").expect("usable")), ["conversion-factor"]);
        assert_eq!(codes(&edited(0, 16, "").expect("usable")), ["bad-size", "zero-area"]);
        let lamp = edited(0, 3, "2").expect("usable");
        assert_eq!(codes(&lamp), ["asymmetry"]);
        // C45 and C315 differ most: 170 − 110 of 500.
        assert!(lamp.findings[0].message.contains("12.0 %"), "{:?}", lamp.findings);
        let mut trailing = lines(4);
        trailing.push("\u{1a} end".to_owned());
        assert_eq!(codes(&read_lines(&trailing).expect("usable")), ["trailing-data"]);
        let mut sets = lines(4);
        "2".clone_into(&mut sets[25]);
        let second: Vec<String> = ["1", "HIT", "9000", "3000", "80", "100"].map(str::to_owned).to_vec();
        sets.splice(32..32, second);
        let lamp = read_lines(&sets).expect("usable");
        assert_eq!((codes(&lamp), lamp.lamp_flux_lm), (vec!["lamp-sets"], Some(2000.0)));
    }

    /// Catches: damage accepted, or reported without its line and value.
    #[test]
    fn damage_is_named() {
        let error = |line: usize, text: &str| {
            let error = edited(4, line, text).expect_err("damaged");
            (error.line, error.message)
        };
        assert_eq!(error(53, "-5"), (53, "γ must rise, found -5° after 45°".to_owned()));
        assert_eq!(error(45, "45"), (45, "C must rise, found 45° after 45°".to_owned()));
        assert_eq!(error(58, "-0.1"), (58, "the intensity at C45, γ 45° is negative: -0.1".to_owned()));
        assert_eq!(error(58, "1e999").1, "expected the intensity at C45, γ 45°, found '1e999'");
        assert_eq!(error(29, "0").0, 29);
        assert_eq!(error(4, "999999999").0, 4);
        assert_eq!(error(26, "999999999").0, 26);
        assert_eq!(error(6, "1").1, "1 γ angles, expected a whole number from 2");
        let lines = lines(4);
        let short = read_lines(&lines[..lines.len() - 2]).expect_err("short");
        assert_eq!(short.message, "the file ends before the intensity at C90, γ 45°");
    }
}
