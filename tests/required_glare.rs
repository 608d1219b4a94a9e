//! `[[require]]` on figures of a view: every index of the table, judged in its worst direction, with the
//! reason where a viewpoint has none.

mod beside_views;
mod common;
mod projects;
mod task_luminances;

use gershun::glare::index::INDICES;
use gershun::outcome::{Outcome, Requirement, Verdict};
use gershun::project::{LoadOptions, load};
use gershun::report::{Colour, Lang, Options, Style, csv::Dialect, files, junit, sarif, table};
use gershun::solve::Effort;
use projects::{folder, run};

/// A room lit at one end; the eye at the other looks at the lamps, aside, and at the wall behind it.
const ROOM: &str = "[scene]\nbox = { size = [6, 4, 2.8], floor = 0.3, walls = 0.5, ceiling = 0.8 }\n\
    [luminaires.A]\nlambert = { flux = 3000 }\narea = { rect = [1.2, 0.3] }\n\
    [[place]]\nluminaire = \"A\"\nat = [4.5, 1.0, 2.7]\n[[place]]\nluminaire = \"A\"\nat = [4.5, 3.0, 2.7]\n\
    [[viewpoint]]\nname = \"Seat\"\neye = [1, 2, 1.2]\nsweep = { from = 0, to = 180, step = 90 }\n";

/// What this room does not tell of its observers: too little of its ceiling shines, it has no area and no road.
const NEVER: [&str; 3] = ["GGR", "GR", "f_TI"];

fn require(key: &str, bound: &str) -> String {
    format!("[[require]]\nviewpoint = \"Seat\"\nquantity = \"{key}\"\n{bound}\n")
}

fn judged(requirements: &str) -> Outcome {
    run(&format!("{ROOM}{requirements}"), &[], 64, Effort::default())
}

fn of<'a>(outcome: &'a Outcome, key: &str) -> &'a Requirement {
    let mut all = outcome.requirements.iter();
    all.find(|r| r.quantity.key() == key).unwrap_or_else(|| panic!("{key} is required"))
}

/// Values of a figure in the three directions, as the observers' table has them.
fn values(outcome: &Outcome, key: &str) -> Vec<f64> {
    let views = outcome.rooms[0].viewpoints.iter();
    views
        .filter_map(|view| match key {
            "UGR" => view.ugr.as_ref().ok().map(|ugr| ugr.value),
            _ => view.indices.iter().find(|index| index.key == key)?.estimate.as_ref().ok().map(|e| e.value),
        })
        .collect()
}

/// Catches: an index refused, taken of another direction than the worst, of another index, judged the wrong
/// way round, or an undefined one passed in silence.
#[test]
fn every_index_of_the_table_can_be_required_and_its_worst_direction_is_judged() {
    let all: String = INDICES.iter().map(|index| require(index.key, "max = 1e9")).collect();
    let outcome = judged(&all);
    assert_eq!(outcome.requirements.len(), INDICES.len());
    let mut limits = String::new();
    for index in INDICES {
        let found = of(&outcome, index.key);
        if NEVER.contains(&index.key) {
            assert_eq!(found.verdict, Verdict::Undefined, "{}", index.key);
            assert!(found.value.as_ref().is_err_and(|why| why.reason.len() > 10), "{}", index.key);
            continue;
        }
        let each = values(&outcome, index.key);
        let most = each.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let value = *found.value.as_ref().unwrap_or_else(|why| panic!("{}: {why}", index.key));
        assert_eq!(value.to_bits(), most.to_bits(), "{}: {each:?}", index.key);
        assert!(found.lo_joint <= value && value <= found.hi_joint, "{}", index.key);
        // Where nothing glares all are comfortable, without doubt.
        assert!(found.hi_joint > found.lo_joint || index.key == "VCP", "{} has an interval", index.key);
        assert_eq!(found.verdict, Verdict::Pass, "{}", index.key);
        assert!(found.note.contains("L_b = E_ind/π"), "{}: {}", index.key, found.note);
        // Between the best and the worst direction: nothing but the worst decides.
        let least = each.iter().copied().fold(f64::INFINITY, f64::min);
        let several = most - least > 0.1 * most.abs();
        let between = if several { 0.5 * (least + most) } else { most - 0.5 * most.abs() };
        limits += &require(index.key, &format!("max = {between}"));
    }
    let outcome = judged(&limits);
    for requirement in &outcome.requirements {
        assert_eq!(requirement.verdict, Verdict::Fail, "{}", requirement.quantity.key());
    }
}

/// Catches: a lower limit met by the best direction, an eye that sees no lamp taken for one without light.
#[test]
fn a_lower_limit_is_held_by_the_least_direction() {
    let outcome = judged(&require("E_v", "min = 1"));
    let each = values(&outcome, "E_v");
    let [least, most] =
        [f64::min as fn(f64, f64) -> f64, f64::max].map(|of| each.iter().copied().reduce(of).unwrap());
    assert!(most > 1.2 * least, "{each:?}");
    let [below, between] = [0.6 * least, 0.5 * (least + most)]
        .map(|limit| of(&judged(&require("E_v", &format!("min = {limit}"))), "E_v").verdict);
    assert_eq!((below, between), (Verdict::Pass, Verdict::Fail));
}

/// Catches: a room without a lamp in sight that fails, or passes by 0.
#[test]
fn without_a_source_in_any_direction_there_is_no_verdict_but_a_reason() {
    let away = ROOM.replace("sweep = { from = 0, to = 180, step = 90 }", "direction = [-1, 0, 0]");
    let outcome = run(&format!("{away}{}", require("DGI", "max = 22")), &[], 32, Effort::default());
    let found = of(&outcome, "DGI");
    assert_eq!(found.verdict, Verdict::Undefined);
    assert_eq!(found.value.as_ref().unwrap_err().reason, "no light source is visible");
}

/// Catches: a lamp nearly overhead, for which the table of CIE 117 has no P, that vanishes from indices which
/// have no table, so that a requirement on them passes; a UGR that counts it.
#[test]
fn what_ugr_ignores_still_counts_for_other_indices() {
    let text = "[scene]\nbox = { size = [8, 6, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n\
                [luminaires.A]\nlambert = { flux = 3600 }\narea = { rect = [0.2, 0.2] }\n\
                [[place]]\nluminaire = \"A\"\nat = [4.2, 3, 2.9]\n\
                [[viewpoint]]\nname = \"Seat\"\neye = [3.5, 2.4, 1.2]\ndirection = [1, 0, 0]\n\
                indices = [\"L_veil_SH\", \"E_dir\", \"DGP\"]\n";
    let outcome = run(&format!("{text}{}", require("L_veil_SH", "max = 0.05")), &[], 32, Effort::default());
    let value = |key: &str| values(&outcome, key)[0];
    let towards = glam::DVec3::new(0.7, 0.6, 1.7).normalize();
    let theta_deg = towards.x.acos().to_degrees();
    let expected = 10.0 * value("E_dir") / (theta_deg * theta_deg);
    assert!(
        value("E_dir") > 60.0 && (value("L_veil_SH") / expected - 1.0).abs() < 0.02,
        "{}",
        value("L_veil_SH")
    );
    assert_eq!(of(&outcome, "L_veil_SH").verdict, Verdict::Fail);
    let view = outcome.rooms[0].viewpoints.first().unwrap();
    let reason = &view.ugr.as_ref().unwrap_err().reason;
    assert!(reason.starts_with("all visible sources lie where the CIE 117 table"), "{reason}");
}

/// Catches: an index that the reports of machines or people leave out, or name as another quantity.
#[test]
fn reports_name_the_index() {
    let outcome = judged(&(require("DGP", "max = 0.35") + &require("L_b", "max = 1")));
    let printed = table(&outcome, Style { lang: Lang::En, colour: Colour::Plain });
    assert!(["DGP", "L_b", "≤ 0.35 "].iter().all(|said| printed.contains(said)), "{printed}");
    let options = Options { languages: vec![Lang::En, Lang::Ru], dialect: Dialect::Standard };
    let written = files(&outcome, &options).expect("a report");
    let text = |name: &str| {
        let (_, bytes) = written.iter().find(|(known, _)| known == name).unwrap_or_else(|| panic!("{name}"));
        String::from_utf8(bytes.clone()).expect("UTF-8")
    };
    let json: serde_json::Value = serde_json::from_str(&text("result.json")).expect("JSON");
    for (row, [key, verdict]) in [["DGP", "pass"], ["L_b", "fail"]].into_iter().enumerate() {
        let required = &json["requirements"][row];
        assert_eq!(required["quantity"], key);
        assert_eq!(required["outcome"], verdict);
        assert_eq!([&required["standard"], &required["clause"]], ["project", "[[require]]"]);
        let line = format!(",{key},value,max,");
        assert!(text("check.csv").lines().any(|row| row.contains(&line) && row.contains(verdict)), "{key}");
    }
    assert_eq!(json["requirements"][1]["unit"], "cd/m²");
    assert!(text("viewpoints.csv").contains("DGP"), "each direction stands in the observers' table");
    // A table of luminances, ratios and percentages must say which is which.
    let table = text("viewpoints.csv");
    let unit = |key: &str| {
        let mut rows = table.lines().filter(|row| row.contains(key));
        rows.next().and_then(|row| row.rsplit(',').next()).map(str::to_owned)
    };
    assert!(table.lines().next().is_some_and(|header| header.ends_with(",unit")));
    assert_eq!((unit(",L_b,").as_deref(), unit(",DGP,").as_deref()), (Some("cd/m²"), Some("1")));
    let page = text("report.html");
    assert!(page.contains("daylight glare probability DGP"));
    assert!(page.contains("вероятность дискомфорта от дневного света DGP"));
    assert!(junit(&outcome).contains("L_b") && sarif(&outcome).contains("L_b"));
}

/// Catches: a mistake without its line, without the names that would do.
#[test]
fn an_unknown_index_is_refused_with_its_line_and_the_known_ones() {
    for (key, hint) in
        [("DGPx", "did you mean \"DGP\"?"), ("glare", "there is: UGR, DGP"), ("E_cyl", "UGR, DGP")]
    {
        let text = format!("{ROOM}{}", require(key, "max = 1"));
        let line = 1 + text.lines().position(|line| line.contains(key)).expect("it is written");
        let errors = load(folder(&text, &[]).path(), &LoadOptions::default()).unwrap_err();
        assert_eq!(errors.len(), 1, "{key}: {errors:?}");
        assert_eq!(errors[0].line, line, "{}", errors[0]);
        assert!(errors[0].hint.contains(hint), "{}", errors[0]);
    }
    // GR and DGP are names of norms' quantities too, which a room of one's own cannot be held to either.
    for key in ["DGI", "GR", "DGP"] {
        let of_room =
            format!("[[room]]\nname = \"R\"\n[[require]]\nroom = \"R\"\nquantity = \"{key}\"\nmax = 22\n");
        let text = format!("{ROOM}{of_room}");
        let errors = load(folder(&text, &[]).path(), &LoadOptions::default()).unwrap_err();
        assert!(errors[0].hint.contains("name a viewpoint"), "{}", errors[0]);
    }
}

/// Catches: what a viewpoint is given not handed to its indices, or to the wrong one; a form with other light in it.
#[test]
fn what_no_view_tells_can_be_given() {
    let given = "age = 60\nceiling_coverage = 0.4\nground = { lx = 300, reflectance = 0.2 }\nroad = 2\n";
    let keys = ["UGR", "GGR", "GR", "f_TI", "L_veil_SH", "L_veil_age"];
    let text = format!("{ROOM}indices = {keys:?}\n{given}");
    let outcome = run(&text, &[], 64, Effort::default());
    let view = &outcome.rooms[0].viewpoints[0];
    let index = |key: &str| {
        let found = view.indices.iter().find(|index| index.key == key).expect("it was asked for");
        *found.estimate.as_ref().unwrap_or_else(|why| panic!("{key}: {why}"))
    };
    let ugr = view.ugr.as_ref().expect("two lamps are seen").value;
    let indirect_lx = std::f64::consts::PI * view.background_cd_m2;
    let direct_lx = view.e_v_lx - indirect_lx;
    let gain = 2.55 * (1.0 + direct_lx / 220.0) / (1.0 + direct_lx / indirect_lx);
    let ggr = |coverage: f64| ugr + (1.18 - 0.18 / coverage) * 8.0 * gain.log10();
    assert!((index("GGR").value - ggr(0.4)).abs() < 1e-9, "{} is not {}", index("GGR").value, ggr(0.4));
    assert!((index("GGR").value - ggr(0.5)).abs() > 1e-3, "another ceiling passes");
    let environment = 0.035 * 0.2 * 300.0 / std::f64::consts::PI;
    let gr = 27.0 + 24.0 * (index("L_veil_SH").value / environment.powf(0.9)).log10();
    assert!((index("GR").value - gr).abs() < 1e-9, "{} is not {gr}", index("GR").value);
    // 10 Σ E/θ² (1 + (A/70)⁴) against 9.86 Σ E/θ² (1 + (A/66.4)⁴): all angles are below 60°.
    let aged = index("L_veil_age").value / (1.0 + (60.0f64 / 70.0).powi(4));
    let veil = 0.986 * aged * (1.0 + (60.0f64 / 66.4).powi(4));
    let increment = 65.0 * veil / 2f64.powf(0.8);
    assert!(
        (index("f_TI").value / increment - 1.0).abs() < 1e-9,
        "{} is not {increment}",
        index("f_TI").value
    );
    for key in keys.into_iter().skip(1) {
        let interval = index(key);
        assert!(interval.lo < interval.value && interval.value < interval.hi, "{key}: {interval:?}");
    }
}

/// Catches: a share above 1 or an age of nobody taken as it stands.
#[test]
fn what_is_given_wrongly_is_refused_with_its_line() {
    for (line, message) in [
        ("age = 0", "age must lie in 1 … 120, found 0"),
        ("ceiling_coverage = 1.5", "found 1.5"),
        ("ground = { lx = 300, reflectance = 2 }", "reflectance of the ground must lie in 0 … 1, found 2"),
        ("ground = { lx = -1, reflectance = 0.2 }", "lx of the ground must be at least 0, found -1"),
        ("road = nan", "road must be at least 0"),
        ("ceiling_coverage = 0.1", "ceiling_coverage must lie in 0.15 … 1, found 0.1"),
        ("ground = { lx = 300 }", "the ground is not known"),
        ("ground = {}", "the ground is not known"),
        ("ground = { area = \"Nowhere\" }", "no area \"Nowhere\""),
        ("ground = { area = \"Nowhere\", lx = 300 }", "give either `area` or `lx`"),
    ] {
        let text = format!("{ROOM}{line}\n");
        let errors = load(folder(&text, &[]).path(), &LoadOptions::default()).expect_err("refused");
        assert_eq!((errors.len(), errors[0].line), (1, text.lines().count()), "{line}: {errors:?}");
        assert!(errors[0].message.contains(message), "{}", errors[0]);
    }
}
