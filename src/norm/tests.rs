//! Tests of the bundled norms: what their rows limit, derive and leave unknown.

use super::*;

fn en() -> Standard {
    let (name, text) = bundled()[0];
    Standard::parse(text, name).unwrap_or_else(|error| panic!("{error}"))
}

fn limit_of(limits: &[Limit], zone: Zone, statistic: Statistic) -> Option<(Bound, Verified)> {
    limits
        .iter()
        .find(|limit| limit.zone == zone && limit.statistic == statistic)
        .map(|limit| (limit.bound, limit.verified))
}

/// Catches: a file of the folder that nobody can choose, a broken one, a value called verified
/// without a source.
#[test]
fn every_file_of_the_folder_is_bundled_parses_under_its_own_name_and_names_its_sources() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("standards");
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    let mut names: Vec<String> = bundled().iter().map(|(name, _)| (*name).to_owned()).collect();
    files.sort();
    names.sort();
    assert_eq!(files, names);
    for (name, text) in bundled() {
        let standard = Standard::parse(text, name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(standard.id, *name);
        assert!(!standard.edition.is_empty() && !standard.note.is_empty(), "{name}");
        for row in &standard.rows {
            let at = format!("{name} {}", row.reference);
            assert_eq!(standard.row(&row.reference), Some(row), "{at} is not reachable");
            assert!(!row.limits.is_empty() && !row.task.is_empty(), "{at}");
            let verified = row.limits.iter().any(|limit| limit.verified != Verified::Unverified);
            assert!(!verified || !row.sources.is_empty(), "{at} is verified by nobody");
        }
    }
}

/// Catches: a row of an indoor norm that lost one of its columns: it would be passed in silence.
#[test]
fn a_column_without_a_value_is_known_to_be_unknown() {
    let standard = en();
    let (_, text) = bundled().iter().find(|(id, _)| *id == "en-12464-1-2021").unwrap();
    let text: toml::Value = toml::from_str(text).unwrap();
    for (row, text) in standard.rows.iter().zip(text["row"].as_array().unwrap()) {
        assert_eq!(text["ref"].as_str().unwrap(), row.reference);
        let open = text.get("unregulated").and_then(toml::Value::as_array);
        let is_open = |name: &str| open.is_some_and(|open| open.iter().any(|one| one.as_str() == Some(name)));
        let known = |name: &str| row.unknown.iter().any(|unknown| unknown.column == name) || is_open(name);
        for (name, zone, statistic) in [
            ("em", Zone::Task, Statistic::Mean),
            ("u0", Zone::Task, Statistic::U0),
            ("ugr", Zone::Room, Statistic::Value),
            ("ra", Zone::Declared, Statistic::Value),
            ("em_walls", Zone::Walls, Statistic::Mean),
        ] {
            let limited = limit_of(&row.limits, zone, statistic).is_some();
            assert!(limited != known(name), "{} {name}", row.reference);
        }
    }
    assert!(standard.row("34.2").unwrap().unknown.is_empty());
    let unknown = &standard.row("13.8").unwrap().unknown;
    let names: Vec<&str> = unknown.iter().map(|unknown| unknown.column.as_str()).collect();
    assert_eq!(names, ["em_cylindrical", "em_walls", "em_ceiling"]);
}

/// Catches: a minimum read as a mean, a maximum as a minimum, a plane lost.
#[test]
fn the_other_norms_carry_their_own_statistics_senses_and_planes() {
    let read = |name: &str| {
        let (_, text) = bundled().iter().find(|(id, _)| *id == name).unwrap();
        Standard::parse(text, name).unwrap()
    };
    let task = |standard: &Standard, row: &str| {
        let row = standard.row(row).unwrap();
        let own = row.limits.iter().find(|limit| limit.zone == Zone::Task).unwrap();
        (own.quantity, own.statistic, own.bound)
    };
    let sanpin = read("sanpin-1.2.3685-21");
    assert_eq!(task(&sanpin, "15"), (Quantity::Horizontal, Statistic::Mean, Bound::Min(300.0)));
    assert_eq!(task(&sanpin, "15-board"), (Quantity::Normal, Statistic::Mean, Bound::Min(500.0)));
    assert_eq!(task(&sanpin, "17-screen"), (Quantity::Normal, Statistic::Mean, Bound::Max(200.0)));
    assert_eq!(sanpin.row("15-board").unwrap().plane, Plane::Vertical);
    assert_eq!(sanpin.row("15").unwrap().plane_m, Some(0.8));
    let heights = sanpin.application.eye_heights_m(Posture::Both);
    assert!(heights.len() == 1 && (heights[0] - 1.5).abs() < 1e-9);
    assert!(sanpin.application.surrounding.is_none());
    let pulsation = Quantity::Declared(crate::quantity::Property::Pulsation);
    let limits = &sanpin.row("15").unwrap().limits;
    assert!(limits.iter().any(|l| l.quantity == pulsation && l.bound == Bound::Max(10.0)));
    let sp = read("sp-52.13330.2016");
    assert_eq!(task(&sp, "classroom").2, Bound::Min(400.0), "SP and SanPiN differ");
    assert_eq!(task(&sp, "Iб").2, Bound::Min(1250.0), "1 200 lx is no step of its scale");
    let emergency = read("en-1838-2013");
    assert_eq!(task(&emergency, "route-centre"), (Quantity::Horizontal, Statistic::Min, Bound::Min(1.0)));
    assert_eq!(
        (emergency.application.light.value, emergency.application.illuminance_state.value),
        (Light::Direct, State::Emergency)
    );
    let route = emergency.row("route-centre").unwrap().intensity.clone().unwrap();
    let limit_cd = |height_m: f64| format!("{:?}", route.class(height_m).unwrap());
    assert_eq!(limit_cd(2.49), "(0.0, 2.5, 500.0)");
    assert_eq!(limit_cd(2.5), "(2.5, 3.0, 900.0)");
    assert_eq!(limit_cd(12.0), "(4.5, inf, 5000.0)");
    let sports = read("en-12193-2018");
    let limits = sports.requirements(sports.row("basketball-II").unwrap());
    let share = limit_of(&limits, Zone::Surrounding, Statistic::OfTask).unwrap();
    assert_eq!(share, (Bound::Min(0.75), Verified::TwoSources));
    assert!(limit_of(&limits, Zone::Surrounding, Statistic::Mean).is_none());
    assert_eq!(sports.application.grid.value, GridChoice::En12193);
}

/// Catches: a step in the wrong direction, off the scale, or surroundings that do not follow.
#[test]
fn a_modified_illuminance_steps_along_the_scale_and_the_surrounding_follows() {
    let standard = en();
    let office = standard.row("34.2").unwrap();
    let at = |row: &Row, steps: Option<i32>| standard.modified_illuminance(row, steps);
    assert_eq!(at(office, Some(1)), Ok(750.0));
    assert_eq!(at(office, Some(-1)), Ok(300.0));
    assert_eq!(at(office, None), Ok(1000.0), "the row's own modified value is two steps");
    assert!(at(office, Some(30)).unwrap_err().contains("leave the norm's scale"));
    assert!(at(office, Some(-30)).is_err());
    let store = standard.row("12.1").unwrap();
    assert!(at(store, None).unwrap_err().contains("12.1"));
    let limits = standard.requirements_at(office, Some(750.0));
    let limit = |zone, statistic| limit_of(&limits, zone, statistic).unwrap().0;
    assert_eq!(limit(Zone::Task, Statistic::Mean), Bound::Min(750.0));
    assert_eq!(limit(Zone::Surrounding, Statistic::Mean), Bound::Min(500.0));
    assert_eq!(limit(Zone::Walls, Statistic::Mean), Bound::Min(150.0), "walls do not follow");
    let house = Standard::parse("id = \"house\"\nrow = [{ ref = \"1\", em = 300 }]\n", "house").unwrap();
    assert!(house.modified_illuminance(&house.rows[0], Some(1)).is_err(), "no scale, no steps");
}

#[test]
fn the_rows_of_en_12464_1_carry_their_corrections() {
    let standard = en();
    let em = |reference: &str| standard.row(reference).and_then(Row::illuminance).map(|limit| limit.bound);
    assert_eq!(em("34.2"), Some(Bound::Min(500.0)));
    assert_eq!(em("12.1"), Some(Bound::Min(200.0)), "100 lx is the 2011 edition");
    assert_eq!(em("34.5"), None, "split into 34.5.1 and 34.5.2");
    assert!(em("34.5.1").is_some() && em("34.5.2").is_some());
    assert_eq!(em("13.1"), Some(Bound::Min(200.0)), "20 lx is a row of the 2011 edition");
    assert_eq!(em("13.6"), Some(Bound::Min(75.0)), "200 lx is the 2011 edition");
    let ra = |reference| limit_of(&standard.row(reference).unwrap().limits, Zone::Declared, Statistic::Value);
    assert_eq!(ra("12.2").unwrap().0, Bound::Min(80.0));
    assert_eq!(standard.row("9.1").unwrap().plane_m, Some(0.0));
    assert_eq!(standard.row("34.2").unwrap().plane_m, None);
    assert_eq!(standard.row("34.2").unwrap().modified_lx, Some((1000.0, Verified::OneSource)));
}

#[test]
fn an_office_brings_its_derived_limits_with_the_weakest_standing() {
    let standard = en();
    let limits = standard.requirements(standard.row("34.2").unwrap());
    let limit = |zone, statistic| limit_of(&limits, zone, statistic).unwrap();
    assert_eq!(limit(Zone::Task, Statistic::Mean), (Bound::Min(500.0), Verified::TwoSources));
    assert_eq!(limit(Zone::Task, Statistic::U0), (Bound::Min(0.6), Verified::TwoSources));
    assert_eq!(limit(Zone::Room, Statistic::Value), (Bound::Max(19.0), Verified::TwoSources));
    assert_eq!(limit(Zone::Surrounding, Statistic::Mean), (Bound::Min(300.0), Verified::OneSource));
    assert_eq!(limit(Zone::Surrounding, Statistic::U0).0, Bound::Min(0.4));
    assert_eq!(limit(Zone::Background, Statistic::Mean).1, Verified::OneSource);
    let (Bound::Min(background_lx), _) = limit(Zone::Background, Statistic::Mean) else {
        panic!("a minimum")
    };
    assert!((background_lx - 100.0).abs() < 1e-9, "{background_lx}");
    assert_eq!(limit(Zone::Walls, Statistic::Mean), (Bound::Min(150.0), Verified::OneSource));
    for zone in [Zone::Walls, Zone::Ceiling, Zone::Cylindrical] {
        assert_eq!(limit(zone, Statistic::U0).0, Bound::Min(0.1));
    }
    // A row without wall columns must not grow wall limits.
    let store = standard.requirements(standard.row("13.8").unwrap());
    assert!(limit_of(&store, Zone::Walls, Statistic::U0).is_none());
}

#[test]
fn the_surrounding_steps_down_by_one() {
    let standard = en();
    for (task_lx, expected_lx) in [
        (1000.0, 500.0),
        (750.0, 500.0),
        (749.0, 300.0),
        (500.0, 300.0),
        (300.0, 200.0),
        (200.0, 150.0),
        (150.0, 150.0),
        (50.0, 50.0),
    ] {
        assert_eq!(standard.surrounding_illuminance(task_lx), Some(expected_lx));
    }
}

#[test]
fn a_standard_of_one_row_works_and_derives_nothing() {
    let text = "id = \"house\"\nrow = [{ ref = \"1\", em = 300 }]\n";
    let standard = Standard::parse(text, "house.toml").unwrap();
    let limits = standard.requirements(standard.row("1").unwrap());
    assert_eq!(limits.len(), 1);
    assert_eq!(limits[0].bound, Bound::Min(300.0));
    assert_eq!(standard.surrounding_illuminance(500.0), None);
    assert_eq!(standard.application, Application::default());
    assert_eq!(standard.short, "house", "a norm without a short name is called by its id");
    assert_eq!(en().short, "EN 12464-1:2021");
}
