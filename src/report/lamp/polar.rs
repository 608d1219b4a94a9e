//! The polar diagram of a luminaire: C0–C180 across the length, C90–C270 along it, γ = 0 below.
//! Right of the axis are C0 and C90, left C180 and C270.

use super::super::canvas::{Anchor, Canvas, Lettering, Px, Rgb, Weight};
use super::super::number::{figures, fixed};
use super::super::words::{Lang, lamp_word};
use super::format_name;
use crate::lamp::{Lamp, azimuth_deg, beam};
use crate::photometry::IntensityDistribution;

const SIZE: [f64; 2] = [520.0, 610.0];
const CENTRE: Px = [260.0, 300.0];
const RADIUS: f64 = 200.0;
/// Dark enough for print, distinct for every colour vision, and told apart by width too.
const C0: Rgb = [178, 24, 43];
const C90: Rgb = [33, 102, 172];
const INK: Rgb = [40, 40, 40];
const RULE: Rgb = [205, 205, 205];
const STEP_DEG: f64 = 0.5;

/// The diagram of a photometric file as SVG.
pub fn polar(lamp: &Lamp, lang: Lang) -> String {
    let about = format!("{} · {}", format_name(lamp.photometry.format), lamp.photometry.description);
    diagram(file_name(&lamp.file), &about, &lamp.photometry.distribution, lang)
}

/// The diagram of an intensity distribution that shines at all.
pub fn diagram(name: &str, about: &str, distribution: &IntensityDistribution, lang: Lang) -> String {
    let say = |english: &'static str| lamp_word(lang, english);
    let (peak_cd, flux_lm) = (distribution.max_intensity().0, distribution.flux().0);
    let ring_cd = ring_step(peak_cd);
    let rings = (peak_cd / ring_cd - 1e-9).ceil().max(1.0);
    let px_per_cd = RADIUS / (rings * ring_cd);
    let mut canvas = Canvas::new(SIZE[0], SIZE[1]);
    text(&mut canvas, [20.0, 26.0], name, 15.0, Anchor::Start, Weight::Bold, INK);
    let sub: String = about.chars().take(78).collect();
    text(&mut canvas, [20.0, 46.0], &sub, 11.0, Anchor::Start, Weight::Normal, INK);
    grid(&mut canvas, rings as usize, ring_cd, px_per_cd, flux_lm, lang);
    for (c_deg, colour, width) in [(0.0, C0, 2.2), (90.0, C90, 1.4)] {
        canvas.line(&curve(distribution, c_deg, px_per_cd), colour, width);
    }
    let y = SIZE[1] - 74.0;
    for (k, (c_deg, colour, label)) in
        [(0.0, C0, say("C0–C180, across the length")), (90.0, C90, say("C90–C270, along the length"))]
            .into_iter()
            .enumerate()
    {
        let row = y + 20.0 * k as f64;
        canvas.line(&[[20.0, row], [48.0, row]], colour, if k == 0 { 2.2 } else { 1.4 });
        let angle = beam::angle_deg(distribution, azimuth_deg(c_deg), beam::BEAM).map_or_else(
            |_| say("no beam angle").to_owned(),
            |deg| format!("{} {}°", say("beam (50 %)"), fixed(lang, deg, 1)),
        );
        text(
            &mut canvas,
            [56.0, row],
            &format!("{label}, {angle}"),
            12.0,
            Anchor::Start,
            Weight::Normal,
            INK,
        );
    }
    let total = format!(
        "I_max {} {} = {} {}, {} {} {}",
        figures(lang, peak_cd, 4),
        say("cd"),
        figures(lang, 1000.0 * peak_cd / flux_lm, 3),
        say("cd/klm"),
        say("for the luminaire's"),
        fixed(lang, flux_lm, 0),
        say("lm")
    );
    text(&mut canvas, [20.0, y + 42.0], &total, 12.0, Anchor::Start, Weight::Normal, INK);
    canvas.finish(&format!("{}: {name}", say("Luminous intensity")))
}

/// 1, 2 or 5 times a power of ten, for three to six rings.
fn ring_step(peak_cd: f64) -> f64 {
    let raw = (peak_cd / 5.0).max(f64::MIN_POSITIVE);
    let power = 10_f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|factor| factor * power >= raw * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

fn place(angle_deg: f64, radius_px: f64) -> Px {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    [CENTRE[0] + radius_px * sin, CENTRE[1] + radius_px * cos]
}

fn grid(canvas: &mut Canvas, rings: usize, ring_cd: f64, px_per_cd: f64, flux_lm: f64, lang: Lang) {
    let say = |english: &'static str| lamp_word(lang, english);
    let circle = |radius: f64| (0..=120).map(|k| place(3.0 * f64::from(k), radius)).collect::<Vec<Px>>();
    let circles: Vec<Vec<Px>> = (1..=rings).map(|k| circle(k as f64 * ring_cd * px_per_cd)).collect();
    let spokes: Vec<Vec<Px>> = (0..24).map(|k| vec![CENTRE, place(15.0 * f64::from(k), RADIUS)]).collect();
    canvas.lines(circles.iter().chain(&spokes).map(Vec::as_slice), RULE, 0.8);
    for k in 0..12 {
        let angle = 30.0 * f64::from(k);
        let gamma = if angle > 180.0 { 360.0 - angle } else { angle };
        text(
            canvas,
            place(angle, RADIUS + 18.0),
            &format!("{gamma}°"),
            11.0,
            Anchor::Middle,
            Weight::Normal,
            INK,
        );
    }
    for k in 1..=rings {
        let cd = k as f64 * ring_cd;
        let per_klm = figures(lang, 1000.0 * cd / flux_lm, 3);
        let label = format!("{} {} ({per_klm} {})", figures(lang, cd, 3), say("cd"), say("cd/klm"));
        // Along 105°, where few luminaires shine.
        let at = place(105.0, cd * px_per_cd);
        if k == rings {
            text(
                canvas,
                [SIZE[0] - 20.0, 70.0],
                &format!("{} {label}", say("outer ring")),
                11.0,
                Anchor::End,
                Weight::Normal,
                INK,
            );
        }
        text(canvas, at, &figures(lang, cd, 3), 10.0, Anchor::Middle, Weight::Normal, INK);
    }
}

/// The half-plane C to the right and C + 180° to the left, as one closed line.
fn curve(distribution: &IntensityDistribution, c_deg: f64, px_per_cd: f64) -> Vec<Px> {
    let count = (180.0 / STEP_DEG) as i32;
    let half = |turn: f64, sign: f64| {
        let at = move |k: i32| {
            let gamma = STEP_DEG * f64::from(k);
            let cd = distribution.intensity_at(azimuth_deg(c_deg + turn), gamma);
            place(sign * gamma, cd * px_per_cd)
        };
        (0..=count).map(at).collect::<Vec<Px>>()
    };
    let (right, left) = (half(0.0, 1.0), half(180.0, -1.0));
    left.into_iter().rev().chain(right).collect()
}

fn text(canvas: &mut Canvas, at: Px, text: &str, size: f64, anchor: Anchor, weight: Weight, colour: Rgb) {
    canvas.text(at, text, Lettering { size, anchor, weight, colour });
}

/// The last part of a path, so that drawings name no folder.
fn file_name(file: &str) -> &str {
    file.rsplit(['/', '\\']).next().unwrap_or(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lamp::read;

    /// Catches: a drawing that is no XML, names a folder, or lacks a plane, a unit or the beam angle.
    #[test]
    fn drawing_is_well_formed() {
        let file = "IESNA:LM-63-2002\n[MANUFAC] A<b & co\nTILT=NONE\n1 -1 1 3 1 1 2 -0.2 -0.2 0\n1 1 10\n0 45 90\n0\n400 200 0\n";
        let lamps = read(file.as_bytes(), "secret/folder/a.ies").expect("sound");
        let svg = polar(&lamps[0], Lang::En);
        roxmltree::Document::parse(&svg).expect("well-formed");
        for part in ["C0–C180", "C90–C270", "beam (50 %) 90.0°", "cd/klm", "400"] {
            assert!(svg.contains(part), "{part}");
        }
        assert!(!svg.contains("secret"));
        let russian = polar(&lamps[0], Lang::Ru);
        assert!(russian.contains("поперёк") && !russian.contains("along"), "{russian}");
    }

    /// Catches: too few or too many rings.
    #[test]
    fn rings_are_round_numbers() {
        for (peak, step) in [(400.0, 100.0), (1.0, 0.2), (18030.0, 5000.0), (999.0, 200.0)] {
            assert!((ring_step(peak) / step - 1.0).abs() < 1e-9, "{peak}: {}", ring_step(peak));
        }
    }
}
