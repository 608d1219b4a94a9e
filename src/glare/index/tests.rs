//! Indices against evalglare's own values for given sources, closed forms for those it lacks.

use serde_json::Value;

use super::*;
use crate::glare::reference_data;
use crate::glare::source::{DgpForm, GlareSource, Ground};
use crate::units::Nits;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn source(case: &Value) -> GlareSource {
    GlareSource {
        luminance: Nits(number(&case["L_s"])),
        solid_angle_sr: number(&case["omega_sr"]),
        position_index: number(&case["P"]),
        ugr_share: 1.0,
        off_axis_deg: number(&case["theta_deg"]),
        eye_lx: number(&case["E_glare_lx"]),
        extent: None,
    }
}

fn at_eye(pairs: &Value) -> Vec<GlareSource> {
    let source = |pair: &Value| GlareSource {
        luminance: Nits(0.0),
        solid_angle_sr: 0.0,
        position_index: 1.0,
        ugr_share: 1.0,
        off_axis_deg: number(&pair[1]),
        eye_lx: number(&pair[0]),
        extent: None,
    };
    pairs.as_array().unwrap().iter().map(source).collect()
}

fn value(key: &str, sight: &Sight) -> f64 {
    (parse(key).unwrap().value)(sight).unwrap_or_else(|undefined| panic!("{key}: {undefined}"))
}

#[test]
fn indices_agree_with_evalglare_on_its_own_sources() {
    // Catches: E_i for E_v, P unsquared or squared where it must not be, ln for lg, F forgotten, L_b of
    // UGR_exp, and the other set of coefficients of DGP (0.2 % there).
    let Some(text) = reference_data("glare/evalglare_cases.json") else { return };
    let data: Value = serde_json::from_str(&text).unwrap();
    let names = [
        ("dgp", "DGP"),
        ("ugr", "UGR"),
        ("ugp", "UGP"),
        ("ugp2", "UGP2"),
        ("cgi", "CGI"),
        ("dgi", "DGI"),
        ("dgi_mod", "DGI_mod"),
        ("dgr", "DGR"),
        ("vcp", "VCP"),
        ("ugr_exp", "UGR_exp"),
        ("Lveil_cie", "L_veil_SH"),
    ];
    let (mut compared, mut worst) = (0, 0.0f64);
    for case in data["cases"].as_array().unwrap() {
        let inputs = &case["inputs"];
        let mut sight = Sight {
            sources: inputs["sources"].as_array().unwrap().iter().map(source).collect(),
            e_v_lx: number(&inputs["E_v"]),
            e_direct_lx: number(&inputs["E_v_dir"]),
            background: Nits(number(&inputs["L_b"])),
            mean: Some(Nits(number(&inputs["L_avg"]))),
            ..Sight::default()
        };
        sight.given.low_light = inputs["low_light_correction"].as_bool().unwrap();
        for (theirs, ours) in names {
            let expected = number(&case["expected"][theirs]);
            if sight.sources.is_empty() && !["DGP", "VCP", "DGR", "UGP2", "L_veil_SH"].contains(&ours) {
                let undefined = (parse(ours).unwrap().value)(&sight).unwrap_err();
                assert_eq!(undefined.reason, crate::glare::source::NO_SOURCE, "{ours}");
                continue;
            }
            let error = (value(ours, &sight) - expected).abs() / expected.abs().max(1e-6);
            assert!(error < 1e-3, "{} {}: {ours} {expected}", case["case"], case["variant"]);
            (compared, worst) = (compared + 1, worst.max(error));
        }
    }
    println!("{compared} values, worst relative difference {worst:.1e}");
    assert_eq!(compared, 196);
}

#[test]
fn outdoor_and_small_source_forms_agree_with_their_closed_forms() {
    let Some(text) = reference_data("glare/formula_cases.json") else { return };
    let data: Value = serde_json::from_str(&text).unwrap();
    let cases = |name: &str| data[name].as_array().unwrap().clone();
    let close = |ours: f64, theirs: &Value, what: &Value| {
        assert!((ours - number(theirs)).abs() < 1e-9 * number(theirs).abs().max(1.0), "{ours}: {what}");
    };
    for case in cases("GR") {
        let mut sight = Sight { sources: at_eye(&case["E_eye_theta"]), ..Sight::default() };
        sight.given.ground =
            Some(Ground { mean_lx: number(&case["E_hav"]), reflectance: number(&case["rho"]) });
        close(value("GR", &sight), &case["GR"], &case);
        close(value("L_veil_SH", &sight), &case["L_vl"], &case);
    }
    for case in cases("TI") {
        let mut sight = Sight { sources: at_eye(&case["E_theta"]), ..Sight::default() };
        sight.given.road = Some(Nits(number(&case["L_av"])));
        sight.given.age_years = Some(number(&case["age"]));
        close(value("f_TI", &sight), &case["fTI_percent"], &case);
    }
    for case in cases("CIE146_general") {
        let pair = serde_json::json!([[case["E_gl"], case["theta"]]]);
        let mut sight = Sight { sources: at_eye(&pair), ..Sight::default() };
        sight.given.age_years = Some(number(&case["age"]));
        sight.given.pigment = number(&case["pigment"]);
        close(value("L_veil", &sight), &case["L_veil"], &case);
    }
    for case in cases("DGPs") {
        let sight = Sight { e_v_lx: number(&case["E_v"]), ..Sight::default() };
        close(value("DGPs", &sight), &case["DGPs"], &case);
    }
    for case in cases("GGR") {
        let mut sight = Sight { sources: Vec::new(), ..Sight::default() };
        for triple in case["sources"].as_array().unwrap() {
            sight.sources.push(GlareSource {
                luminance: Nits(number(&triple[0])),
                solid_angle_sr: number(&triple[1]),
                position_index: number(&triple[2]),
                ugr_share: 1.0,
                off_axis_deg: 30.0,
                eye_lx: 1.0,
                extent: None,
            });
        }
        sight.e_direct_lx = number(&case["E_d"]);
        sight.e_v_lx = sight.e_direct_lx + number(&case["E_i"]);
        sight.background = Nits(number(&case["E_i"]) / std::f64::consts::PI);
        sight.given.ceiling_coverage = Some(number(&case["CC"]));
        close(value("UGR", &sight), &case["UGR"], &case);
        close(value("GGR", &sight), &case["GGR"], &case);
    }
    for case in cases("UGR_small") {
        let extent = crate::glare::source::Extent {
            projected_area_m2: 0.0,
            intensity_cd: number(&case["I_cd"]),
            distance_m: number(&case["r_m"]),
        };
        let point = GlareSource {
            position_index: number(&case["P"]),
            ugr_share: 1.0,
            eye_lx: 1.0,
            extent: Some(extent),
            ..at_eye(&serde_json::json!([[1, 20]]))[0]
        };
        let background = Nits(number(&case["L_b"]));
        let sight = Sight { sources: vec![point], e_v_lx: 200.0, background, ..Sight::default() };
        close(value("UGR", &sight), &case["UGR"], &case);
        // What asks for a luminance says so.
        let undefined = (parse("CGI").unwrap().value)(&sight).unwrap_err();
        assert!(undefined.reason.contains("point source"), "{undefined}");
    }
}

/// One window of 3000 cd/m² and 0.2 sr at P 1.5 under 80 cd/m².
fn window() -> Sight {
    let pi = std::f64::consts::PI;
    let eye_lx = 3000.0 * 0.2 * 0.9;
    Sight {
        sources: vec![GlareSource {
            luminance: Nits(3000.0),
            solid_angle_sr: 0.2,
            position_index: 1.5,
            ugr_share: 1.0,
            off_axis_deg: 25.0,
            eye_lx,
            extent: None,
        }],
        e_v_lx: eye_lx + 80.0 * pi,
        e_direct_lx: eye_lx,
        background: Nits(80.0),
        mean: Some(Nits(200.0)),
        ..Sight::default()
    }
}

#[test]
fn the_two_forms_of_dgp_differ_as_published() {
    let mut sight = window();
    let theirs = value("DGP", &sight);
    sight.given.dgp = DgpForm::Published;
    let ratio = 3000.0 * 3000.0 * 0.2 / 2.25 / sight.e_v_lx.powf(1.87);
    let published = 5.87e-5 * sight.e_v_lx + 0.0918 * (1.0 + ratio).log10() + 0.16;
    assert!((value("DGP", &sight) - published).abs() < 1e-12);
    assert!((published - theirs - (0.001 - 0.0002 * (1.0 + ratio).log10())).abs() < 1e-12);
}

#[test]
fn the_mistakes_that_others_made_move_the_indices() {
    // Each twin has one known mistake; an index that asks for the figure must notice.
    let sight = window();
    let differs = |key: &str, twin: &Sight| (value(key, &sight) - value(key, twin)).abs() > 1e-3;
    let moved = |change: &dyn Fn(&mut Sight)| {
        let mut twin = sight.clone();
        change(&mut twin);
        twin
    };
    // The sources' own light left in L_b, E_v taken without the sources, P taken as 1, ω halved.
    let total = moved(&|sight| sight.background = Nits(sight.e_v_lx / std::f64::consts::PI));
    assert!(["UGR", "DGI", "UGP", "UGP2", "M"].iter().all(|key| differs(key, &total)));
    let indirect = moved(&|sight| {
        sight.e_v_lx -= sight.e_direct_lx;
        sight.e_direct_lx = 0.0;
    });
    assert!(["DGP", "DGPs", "CGI", "DGI_mod", "UGR_exp", "E_v"].iter().all(|key| differs(key, &indirect)));
    let ahead = moved(&|sight| sight.sources[0].position_index = 1.0);
    let narrow = moved(&|sight| sight.sources[0].solid_angle_sr *= 0.5);
    for key in ["UGR", "DGP", "DGI", "DGI_mod", "CGI", "UGP", "UGP2", "UGR_exp", "DGR", "M"] {
        assert!(differs(key, &ahead) && differs(key, &narrow), "{key}");
    }
}

#[test]
fn nothing_undefined_becomes_a_number() {
    // Catches −∞, NaN and −99 in a dark or empty view.
    let dark = Sight::default();
    let nan = Sight { e_v_lx: f64::NAN, background: Nits(f64::NAN), ..window() };
    let empty = Sight { sources: Vec::new(), ..window() };
    for index in INDICES {
        for sight in [&dark, &nan, &empty, &window()] {
            if let Ok(value) = (index.value)(sight) {
                assert!(value.is_finite(), "{}", index.key);
            }
        }
    }
    for key in ["UGR", "DGI", "CGI", "UGP", "UGR_exp", "M"] {
        assert!((parse(key).unwrap().value)(&empty).is_err(), "{key}");
    }
    assert!(value("VCP", &empty) > 99.9);
    assert!(parse("UGR").unwrap().read(&window()).notes.iter().any(|note| note.contains("0.1 sr")));
    assert!(parse("DGI").unwrap().read(&window()).notes.is_empty());
}

#[test]
fn keys_are_unique_and_russian_m_is_ugr_on_its_own_scale() {
    for (position, index) in INDICES.iter().enumerate() {
        assert!(INDICES[..position].iter().all(|other| other.key != index.key));
        assert!(parse(index.key).is_some());
    }
    // The steps 15 to 90 of M, each with its UGR rounded to an integer.
    for (m, ugr) in [(15.0, 14.0), (25.0, 18.0), (40.0, 21.0), (60.0, 24.0), (90.0, 26.0)] {
        let mut sight = window();
        let scale = (0.5 * (ugr - value("UGR", &sight)) / 8.0 * std::f64::consts::LN_10).exp();
        sight.sources[0].luminance = Nits(3000.0 * scale);
        assert!((value("UGR", &sight) - ugr).abs() < 1e-9);
        assert!((value("M", &sight) / m - 1.0).abs() < 0.08, "{m}: {}", value("M", &sight));
    }
}
