//! Glare from a kept field: the same as unbiased values within what its list of approximations says, and
//! never with an interval.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use gershun::field::store::StoredField;
use gershun::observe::stored::observe_stored;
use gershun::observe::{CONVENTIONS, Observed, Sheets, observe};
use gershun::project::{LoadOptions, Project, load};
use gershun::solve::picture::expose;

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

fn project(folder: &Path) -> Project {
    load(folder, &LoadOptions::default()).unwrap_or_else(|errors| panic!("{errors:?}"))
}

fn fields(project: &Project) -> Vec<StoredField> {
    project.worlds.iter().map(|world| expose(&world.scene, 1).into_stored()).collect()
}

/// Largest difference in UGR and relative difference in L_b; the unbiased values must tell so small ones.
fn differences(stored: &[Observed], unbiased: &[Observed]) -> [f64; 2] {
    assert_eq!(stored.len(), unbiased.len());
    let mut most = [0.0f64; 2];
    for (own, truth) in stored.iter().zip(unbiased) {
        let (Ok(ugr), Ok(known)) = (&own.ugr, &truth.ugr) else {
            assert_eq!(own.ugr.is_err(), truth.ugr.is_err(), "{}", own.viewpoint);
            continue;
        };
        assert!(5.0 * known.se < 2.0 * WITHIN_UGR, "{}: {}", own.viewpoint, known.se);
        most[0] = most[0].max((ugr.value - known.value).abs());
        most[1] = most[1].max((own.background_cd_m2 / truth.background_cd_m2 - 1.0).abs());
    }
    most
}

/// What the list of approximations says of UGR and L_b.
const WITHIN_UGR: f64 = 0.15;
const WITHIN_L_B: f64 = 0.04;
const BLOCKS: usize = 384;

/// Catches: a field looked up in another order or light scene, emission or direct light counted twice, an
/// interval that nothing stands for. The list says 0.15 UGR and 4 %.
#[test]
fn values_from_a_kept_field_are_what_the_list_of_approximations_says() {
    for name in ["office", "hall", "classroom"] {
        let project = project(&scene(name));
        let unbiased = observe(&project, &CONVENTIONS[..1], BLOCKS);
        let stored = observe_stored(&project, fields(&project), Sheets::None);
        let [ugr, l_b] = differences(&stored, &unbiased);
        println!("{name}: {} views, UGR within {ugr:.3}, L_b within {:.1} %", stored.len(), 100.0 * l_b);
        assert!(ugr <= WITHIN_UGR && l_b <= WITHIN_L_B, "{name}");
        for view in &stored {
            assert!(view.approximations.iter().any(|said| said.contains("no interval")));
            let mut all = view.indices.iter().map(|index| &index.estimate).chain([&view.ugr]).flatten();
            assert!(all.all(|estimate| estimate.se.is_nan() && estimate.lo.is_nan() && estimate.hi.is_nan()));
        }
    }
}

/// A room with an observer.
fn room(walls: f64) -> String {
    format!(
        "[scene]\nbox = {{ size = [5, 4, 2.8], floor = 0.2, walls = {walls}, ceiling = 0.7 }}\n\
         [luminaires.A]\nlambert = {{ flux = 3000 }}\narea = {{ rect = [1.2, 0.3] }}\n\
         [[place]]\nluminaire = \"A\"\nfield = {{ rows = 2, columns = 2, height = 2.8 }}\n\
         [[viewpoint]]\nname = \"V\"\neye = [0.5, 2, 1.2]\ndirection = [1, 0, 0]\n"
    )
}

/// The broken twin: the field of a room with surfaces a fifth darker is told apart.
#[test]
fn the_field_of_a_darker_room_is_told_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("project.toml"), room(0.4)).expect("written");
    let other = project(folder.path());
    std::fs::write(folder.path().join("project.toml"), room(0.5)).expect("written");
    let own = project(folder.path());
    let stored = observe_stored(&own, fields(&other), Sheets::None);
    assert!(!stored.is_empty(), "the box has an observer");
    let [ugr, l_b] = differences(&stored, &observe(&own, &CONVENTIONS[..1], BLOCKS));
    assert!(ugr > WITHIN_UGR || l_b > WITHIN_L_B, "{ugr} {l_b}");
}

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gershun")).args(arguments).output().expect("it runs")
}

/// Catches: a field of another scene taken, values that look as if they had an interval, a list of
/// approximations that nobody is shown.
#[test]
fn the_command_says_no_interval_and_refuses_a_field_of_another_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    std::fs::write(folder.path().join("project.toml"), room(0.5)).expect("written");
    let of_hall = scene("hall").display().to_string();
    assert!(run(&["solve", "-q", &out, "--out", &out]).status.success());
    let told = |format: &str| {
        let output = run(&["glare", &out, "--field", &out, "--format", format]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"))
    };
    let [text, _] = told("human");
    assert!(text.contains("(no interval)") && text.contains("looked up in the stored field"), "{text}");
    let json: serde_json::Value = serde_json::from_str(&told("json")[0]).expect("JSON");
    let estimate = &json[0]["indices"][0]["estimate"];
    assert!(estimate["value"].as_f64().is_some() && estimate["lo"].is_null(), "{estimate}");
    assert!(json[0]["approximations"].as_array().is_some_and(|said| said.len() >= 2));
    let [csv, said] = told("csv");
    assert!(csv.lines().nth(1).is_some_and(|line| line.contains(",,,")), "{csv}");
    assert!(said.contains("no interval"), "{said}");
    let refused = run(&["glare", &of_hall, "--field", &out]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("another scene"));
}
