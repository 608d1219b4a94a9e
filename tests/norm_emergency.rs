//! EN 1838 by hand: the smallest illuminance on the centre line of an escape route from I cos³γ/h², direct
//! light at emergency output alone, its ratio to the largest, and the luminous intensity towards the eye.

mod projects;

use gershun::outcome::{Bound, Outcome, Requirement, Verdict};
use gershun::quantity::{Quantity, Statistic};
use gershun::solve::Effort;

const ROUTE: &str = include_str!("projects/emergency.toml");

fn solved(text: &str) -> Outcome {
    projects::run(text, &[], 32, Effort::default())
}

fn required(outcome: &Outcome, quantity: Quantity, statistic: Statistic) -> &Requirement {
    let mut all = outcome.requirements.iter();
    all.find(|r| r.quantity == quantity && r.statistic == statistic).expect("it is required")
}

/// E at x on the centre line: Σ I cos³γ/h² of two luminaires of `intensity_cd` at 3 and 9 m, 2.8 m high.
fn by_hand_lx(x_m: f64, intensity_cd: f64) -> f64 {
    let of = |lamp_m: f64| {
        let cos = 2.8 / (x_m - lamp_m).hypot(2.8);
        intensity_cd * cos.powi(3) / (2.8 * 2.8)
    };
    of(3.0) + of(9.0)
}

fn points() -> Vec<f64> {
    (0..24).map(|i| (f64::from(i) + 0.5) * 0.5).collect()
}

/// Catches: reflected light, images in mirrors or other luminaires counted, the mains output, the mean in
/// place of the minimum, the maintenance factor forgotten.
#[test]
fn the_smallest_illuminance_is_that_of_direct_light_at_emergency_output() {
    let outcome = solved(ROUTE);
    let intensity_cd = 1000.0 * 0.02 * 0.8;
    let values: Vec<f64> = points().iter().map(|&x| by_hand_lx(x, intensity_cd)).collect();
    let (least, most) = values.iter().fold((f64::INFINITY, 0.0f64), |(a, b), &v| (a.min(v), b.max(v)));
    let smallest = required(&outcome, Quantity::Horizontal, Statistic::Min);
    let value = *smallest.value.as_ref().expect("a value");
    assert!((value - least).abs() < 1e-5 * least, "{value} is not {least}");
    assert!((smallest.hi_joint - smallest.lo_joint).abs() < 1e-6, "nothing shades: it is exact");
    assert_eq!(
        (smallest.bound, smallest.verdict),
        (Bound::Min(1.0), Verdict::Fail),
        "{least} lx at the ends"
    );
    assert_eq!(smallest.note, "emergency output, maintained, direct light only");
    let ratio = required(&outcome, Quantity::Horizontal, Statistic::Ud);
    let value = *ratio.value.as_ref().expect("a value");
    assert!((value - least / most).abs() < 1e-5 && ratio.verdict == Verdict::Pass, "{value}");
    assert_eq!(ratio.bound, Bound::Min(0.025), "40 : 1");
    // Every point, with nothing reflected in it.
    for (point, expected) in projects::points(&outcome, "Centre line", "E_h", "all").iter().zip(&values) {
        assert!((point.value - expected).abs() < 1e-5 * expected, "{} is not {expected}", point.value);
        assert!(point.indirect.abs() < 1e-12);
    }
    // A mirror along the route changes nothing; twice the output is twice the light, and passes.
    let mirror = format!("{ROUTE}\n[materials]\nWall_N = {{ mirror = 0.9 }}\n");
    let seen = solved(&mirror);
    let value = *required(&seen, Quantity::Horizontal, Statistic::Min).value.as_ref().expect("a value");
    assert!((value - least).abs() < 1e-5 * least, "an image counts: {value}");
    let flux = solved(&ROUTE.replace("emergency = 0.02", "emergency = { flux = 1507.9644737231006 }"));
    let brighter = required(&flux, Quantity::Horizontal, Statistic::Min);
    let value = *brighter.value.as_ref().expect("a value");
    assert!((value - 6.0 * least).abs() < 1e-4 * least && brighter.verdict == Verdict::Pass, "{value}");
}

/// The broken twin of the test above: all light, or the mains output, would be noticed.
#[test]
fn reflected_light_and_mains_output_would_be_noticed() {
    let (_, norm) = gershun::norm::bundled().iter().find(|(id, _)| *id == "en-1838-2013").expect("bundled");
    let least = by_hand_lx(0.25, 16.0);
    for (from, to) in [
        ("light = { value = \"direct\"", "light = { value = \"all\""),
        ("{ value = \"emergency\"", "{ value = \"maintained\""),
    ] {
        assert!(norm.contains(from));
        let house = ("house.toml".to_owned(), norm.replace(from, to).into_bytes());
        let text = ROUTE.replace("\"en-1838-2013\"", "\"house.toml\"");
        let outcome = projects::run(&text, &[house], 32, Effort::default());
        let value =
            *required(&outcome, Quantity::Horizontal, Statistic::Min).value.as_ref().expect("a value");
        assert!(value > 1.5 * least, "{to}: {value} cannot be told from {least}");
    }
}

/// Catches: an opaque screen that does not shade, a pane that does, a pane whose transmittance is lost.
#[test]
fn screens_shade_and_panes_on_the_way_count() {
    // A sheet over the middle of the route, between its luminaires and the floor below x = 6 … 6.5 m.
    let above = |material: &str| {
        format!(
            "{ROUTE}\n[materials]\nSheet = {{ {material} }}\n[[furniture]]\nat = [0.5, 0.5, 1.5]\nsize = [5.5, 1, 0.02]\nmaterial = \"Sheet\"\n"
        )
    };
    let at =
        |outcome: &Outcome, index: usize| projects::points(outcome, "Centre line", "E_h", "all")[index].value;
    let dark = solved(&above("reflectance = 0.8"));
    let far_lx = 16.0 * (2.8 / 6.25f64.hypot(2.8)).powi(3) / (2.8 * 2.8);
    // x = 2.75 m: the near luminaire stands above the sheet, the far one shines past its end.
    assert!((at(&dark, 5) - far_lx).abs() < 1e-5 * far_lx, "{} beside the screen", at(&dark, 5));
    // x = 2.25 m: both are hidden.
    assert!(at(&dark, 4) < 1e-9, "{} under a screen", at(&dark, 4));
    let clear = solved(&above("glass = 0.9"));
    let open_lx = by_hand_lx(2.25, 16.0);
    // Two panes: at most 0.9², less for the slanted rays of the far luminaire.
    let seen = at(&clear, 4);
    assert!(seen < 0.81 * open_lx * 1.0001 && seen > 0.5 * open_lx, "{seen} of {open_lx}");
}

/// Catches: a limit of the wrong mounting height, the mains intensity, intensities outside of the zone.
#[test]
fn the_intensity_towards_the_eye_is_limited_by_the_mounting_height() {
    let at = |height_m: f64, share: f64| {
        let text = ROUTE
            .replace("2.8]", &format!("{height_m}]"))
            .replace("emergency = 0.02", &format!("emergency = {share}"))
            .replace("12, 2, 3]", "12, 2, 6]");
        let outcome = solved(&text);
        let own = required(&outcome, Quantity::Intensity, Statistic::Max);
        assert_eq!(own.subject, "E", "the other luminaire is dark in an emergency");
        (own.bound, *own.value.as_ref().expect("a value"), own.verdict)
    };
    for (height_m, limit_cd) in
        [(2.4, 500.0), (2.5, 900.0), (2.8, 900.0), (3.0, 1600.0), (4.49, 3500.0), (5.0, 5000.0)]
    {
        let (bound, value, verdict) = at(height_m, 0.7);
        assert_eq!(bound, Bound::Max(limit_cd), "{height_m} m");
        assert!((value - 700.0).abs() < 1e-6, "initial, at emergency output: {value}");
        assert_eq!(verdict, if limit_cd > 700.0 { Verdict::Pass } else { Verdict::Fail });
    }
}

/// Catches: a building without emergency lighting that passes, or whose darkness is not explained.
#[test]
fn without_emergency_output_it_is_dark_and_that_is_said() {
    let outcome = solved(&ROUTE.replace("emergency = 0.02", "#"));
    let own = required(&outcome, Quantity::Horizontal, Statistic::Min);
    assert_eq!((own.value.clone().map(f64::to_bits), own.verdict), (Ok(0f64.to_bits()), Verdict::Fail));
    assert!(outcome.plan.iter().any(|reason| reason.contains("dark in an emergency")), "{:?}", outcome.plan);
    let folder = projects::folder(&ROUTE.replace("emergency = 0.02", "emergency = 1.2"), &[]);
    let errors = gershun::project::load(folder.path(), &gershun::project::LoadOptions::default())
        .expect_err("too much");
    assert!(errors[0].message.contains("emergency output is 1.200") && errors[0].line == 12, "{errors:?}");
}

/// Catches: an intensity judged under a light scene in which the luminaire is off, or at another level.
#[test]
fn the_intensity_is_that_of_the_scene_in_which_the_route_is_judged() {
    let text = ROUTE
        .replace("[norm]", "[light_scenes]\nday = { N = 1.0 }\nnight = { E = 0.5 }\n\n[norm]")
        .replace("name = \"Centre line\"", "name = \"Centre line\"\nlight_scene = \"night\"");
    let outcome = solved(&text);
    let own = required(&outcome, Quantity::Intensity, Statistic::Max);
    assert_eq!(own.light_scene, "night");
    let value = *own.value.as_ref().expect("a value");
    assert!((value - 1000.0 * 0.02 * 0.5).abs() < 1e-9, "{value}");
}
