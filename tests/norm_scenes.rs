//! The three rooms that are judged by a norm from end to end: their photometric files are what the
//! generator makes, and every number of their reference reports follows from the point values by
//! arithmetic that shares no line with the library.
#![expect(clippy::unwrap_used, reason = "a test that cannot read its files fails")]

use std::collections::BTreeMap;
use std::path::PathBuf;

#[path = "../examples/make_scenes/main.rs"]
#[allow(dead_code, reason = "the generator's main is not run here")]
mod make_scenes;

const REPORTS: [&str; 4] = ["classroom-sanpin", "classroom-sp-52", "sports-hall", "warehouse"];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Catches: a file edited by hand, a generator changed without a new run, a flux that is not the rated one.
#[test]
fn committed_luminaires_are_what_the_generator_makes() {
    for lamp in &make_scenes::LAMPS {
        let committed = std::fs::read_to_string(root().join("scenes").join(lamp.path)).unwrap();
        assert!(
            committed == lamp.ies(),
            "{} differs: run cargo run --release --example make_scenes",
            lamp.path
        );
        let flux_lm = lamp.flux_of_text_lm();
        assert!((flux_lm / lamp.flux_lm - 1.0).abs() < 1e-3, "{}: {flux_lm} lm", lamp.path);
        let efficacy = lamp.flux_lm / lamp.power_w;
        assert!((90.0..200.0).contains(&efficacy), "{}: {efficacy} lm/W is not plausible", lamp.path);
    }
}

/// A table: a row as header → cell.
type Rows = Vec<BTreeMap<String, String>>;

fn table(report: &str, name: &str) -> Rows {
    let text = std::fs::read_to_string(root().join("reports").join(report).join(name)).unwrap();
    let mut lines = text.lines().map(cells);
    let header = lines.next().unwrap();
    lines
        .map(|row| {
            assert_eq!(row.len(), header.len(), "{report}/{name}: a row of another length");
            header.iter().cloned().zip(row).collect()
        })
        .collect()
}

/// Cells of a line; quotes around a cell with commas, doubled within it.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                cell.push('"');
                letters.next();
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(std::mem::take(&mut cell)),
            other => cell.push(other),
        }
    }
    cells.push(cell);
    cells
}

fn number(row: &BTreeMap<String, String>, key: &str) -> f64 {
    row[key].parse().unwrap_or(f64::NAN)
}

/// Point values of a quantity on an area under a light scene.
fn on_points(points: &Rows, area: &str, scene: &str, quantity: &str) -> Vec<f64> {
    let here = |row: &&BTreeMap<String, String>| {
        row["area"] == area && row["light_scene"] == scene && row["quantity"] == quantity
    };
    points.iter().filter(here).map(|row| number(row, "value")).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A statistic of point values; `task` are those of E_h on the task area.
fn statistic(values: &[f64], name: &str, task: &[f64]) -> f64 {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    match name {
        "mean" => mean(values),
        "min" => least,
        "max" => most,
        "U0" => least / mean(values),
        "Ud" => least / most,
        "mean/task" => mean(values) / mean(task),
        other => panic!("unknown statistic {other}"),
    }
}

/// UGR = 8 lg(0.25/L_b · Σ L² ω / P²) of the sources in one direction, which the table lists for those
/// that count most; `None` if it lists not all of them.
fn ugr_of_sources(sources: &Rows, view: &BTreeMap<String, String>) -> Option<f64> {
    let keys = ["viewpoint", "light_scene", "azimuth_deg", "tilt_deg"];
    let own: Vec<_> =
        sources.iter().filter(|source| keys.iter().all(|key| source[*key] == view[*key])).collect();
    let sum: f64 = own
        .iter()
        .map(|s| {
            let (l, p) = (number(s, "luminance_cd_m2"), number(s, "position_index"));
            l * l * number(s, "solid_angle_sr") / (p * p)
        })
        .sum();
    let share: f64 = own.iter().map(|s| number(s, "share")).sum();
    (share > 0.999_999).then(|| 8.0 * (0.25 / number(view, "L_b_cd_m2") * sum).log10())
}

/// Catches: a mean over other points than those printed, a uniformity by the wrong quotient, a limit
/// compared the wrong way round, a verdict that its own interval contradicts, a silent requirement.
#[test]
fn every_requirement_of_the_reports_follows_from_their_points() {
    for report in REPORTS {
        let (check, points) = (table(report, "check.csv"), table(report, "points.csv"));
        let (views, sources) = (table(report, "viewpoints.csv"), table(report, "glare_sources.csv"));
        let mut recomputed = 0;
        for row in &check {
            let (subject, scene, quantity) = (&row["subject"], &row["light_scene"], &row["quantity"]);
            let at = format!("{report}: {subject} {quantity} {}", row["statistic"]);
            if row["value"].is_empty() {
                assert!(!row["undefined"].is_empty(), "{at}: neither a value nor a reason");
                assert!(["not_assessed", "undefined"].contains(&row["outcome"].as_str()), "{at}");
                continue;
            }
            let value = number(row, "value");
            let values = on_points(&points, subject, scene, quantity);
            let expected = if !values.is_empty() {
                let tasks = ["Court", subject];
                let task = tasks
                    .iter()
                    .map(|area| on_points(&points, area, scene, "E_h"))
                    .find(|values| !values.is_empty())
                    .unwrap_or_default();
                Some(statistic(&values, &row["statistic"], &task))
            } else if quantity == "UGR" && row["note"].starts_with("table method") {
                // The worst of all types and directions of the room, on which the norm decides.
                let own = views.iter().filter(|v| v["room"] == *subject && v["index"] == "UGR_table");
                own.map(|view| number(view, "value")).reduce(f64::max)
            } else if quantity == "UGR" {
                let own: Vec<_> = views
                    .iter()
                    .filter(|v| v["viewpoint"] == *subject && v["light_scene"] == *scene)
                    .collect();
                own.iter().map(|view| number(view, "value")).fold(None, |worst: Option<f64>, value| {
                    Some(worst.map_or(value, |known| known.max(value)))
                })
            } else {
                None
            };
            if let Some(expected) = expected {
                assert!(
                    (value - expected).abs() <= 1e-9 * expected.abs(),
                    "{at}: {value}, points say {expected}"
                );
                recomputed += 1;
            } else {
                // What is declared stands in no point.
                assert!(["R_a", "pulsation"].contains(&quantity.as_str()), "{at} is recomputed by nothing");
            }
            verdict(row, &at);
        }
        assert!(recomputed >= 3, "{report}: {recomputed} recomputed");
        let mut shown = 0;
        for view in views.iter().filter(|view| view["index"] == "UGR" && !view["value"].is_empty()) {
            if let Some(ugr) = ugr_of_sources(&sources, view) {
                assert!((ugr - number(view, "value")).abs() < 1e-6, "{report}: {view:?}: {ugr}");
                shown += 1;
            }
        }
        assert!(shown > 0, "{report}: no viewpoint was recomputed from its sources");
    }
}

/// The verdict that value, joint interval and limit give.
fn verdict(row: &BTreeMap<String, String>, at: &str) {
    let (value, limit) = (number(row, "value"), number(row, "limit"));
    let (lo, hi) = (number(row, "lo_joint"), number(row, "hi_joint"));
    let complies = |x: f64| if row["bound"] == "min" { x >= limit } else { x <= limit };
    let outcome = row["outcome"].as_str();
    if outcome == "declared" {
        assert!(complies(value), "{at}: declared and not met");
        return;
    }
    assert!(lo <= value && value <= hi, "{at}: {value} lies outside of its own interval");
    let expected = match (row["at_the_limit"].as_str(), complies(lo), complies(hi)) {
        ("yes", ..) => {
            if complies(value) {
                "pass"
            } else {
                "fail"
            }
        }
        (_, true, true) => "pass",
        (_, false, false) => "fail",
        _ => "undecided",
    };
    assert_eq!(outcome, expected, "{at}");
}

/// Catches: the arithmetic above that could not fail. Points off by a thousandth must be noticed.
#[test]
fn points_off_by_a_thousandth_would_be_noticed() {
    let points = table(REPORTS[0], "points.csv");
    let check = table(REPORTS[0], "check.csv");
    let row = check.iter().find(|row| row["subject"] == "Desks" && row["statistic"] == "mean").unwrap();
    let values = on_points(&points, "Desks", &row["light_scene"], "E_h");
    let off: Vec<f64> = values.iter().map(|value| 1.001 * value).collect();
    let found = number(row, "value");
    assert!((mean(&values) - found).abs() <= 1e-9 * found);
    assert!((mean(&off) - found).abs() > 1e-9 * found);
}

/// Catches: power of a type counted once instead of for every luminaire, the wrong area, a mean that is
/// not that of the task areas.
#[test]
fn the_power_of_a_room_is_that_of_its_luminaires() {
    for (report, installed_w, area_m2) in [
        ("classroom-sanpin", 9.0 * 14.0 + 3.0 * 38.0, 54.0),
        ("sports-hall", 32.0 * 150.0, 36.0 * 22.0),
        ("warehouse", 15.0 * 75.0 + 12.0 * 52.0, 30.0 * 18.0),
    ] {
        let text = std::fs::read_to_string(root().join("reports").join(report).join("result.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let power = &json["rooms"][0]["power"];
        let of = |key: &str| power[key].as_f64().unwrap();
        assert!((of("installed_w") - installed_w).abs() < 1e-9, "{report}: {power}");
        assert!((of("density_w_m2") - installed_w / area_m2).abs() < 1e-9, "{report}: {power}");
        // A light scene at less than full output is set against its own power.
        let scene_w = power["scene_w"].as_f64().unwrap_or(installed_w);
        let expected = scene_w / area_m2 / of("mean_lx") * 100.0;
        assert!((of("density_w_m2_100lx") - expected).abs() < 1e-9, "{report}: {power}");
        if report == "classroom-sanpin" {
            let desks = on_points(&table(report, "points.csv"), "Desks", "all", "E_h");
            assert!((of("mean_lx") - mean(&desks)).abs() < 1e-9 * mean(&desks));
        }
    }
}

/// Catches: reasons in the scenes' README that the reports do not bear out.
#[test]
fn the_scenes_comply_or_fail_as_their_readme_says() {
    let outcome = |report: &str| {
        let text = std::fs::read_to_string(root().join("reports").join(report).join("result.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        json["verdict"].as_str().unwrap().to_owned()
    };
    let said =
        |scene: &str| std::fs::read_to_string(root().join("scenes").join(scene).join("README.md")).unwrap();
    for (scene, report, verdict) in [
        ("classroom", "classroom-sanpin", "pass"),
        ("classroom", "classroom-sp-52", "fail"),
        ("sports-hall", "sports-hall", "pass"),
        ("warehouse", "warehouse", "fail"),
    ] {
        assert_eq!(outcome(report), verdict, "{report}");
        let line = format!("`reports/{report}`: **{verdict}**");
        assert!(said(scene).contains(&line), "scenes/{scene}/README.md does not say {line}");
    }
}
