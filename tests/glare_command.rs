//! `gershun glare` as a user calls it: what it refuses, what its outputs hold, and that their shape follows from
//! what was asked. Catches options that are taken and not heeded, notes that one of the formats drops, maps that
//! vanish.

use std::path::Path;
use std::process::Command;

use gershun::image::{LuminanceImage, Projection, View, write_hdr};
use glam::DVec3;

/// A room lit by a wall that is far too large for UGR to hold, one eye on its axis, one that turns.
const ROOM: &str = r#"[project]
name = "e"
[scene]
box = { size = [8, 6, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }
[materials]
Wall_E = { emit = 1500 }
"#;
const EYES: &str = r#"[[viewpoint]]
name = "W"
eye = [0.5, 3, 1.2]
direction = [1, 0, 0]
indices = ["DGP", "GGR"]
[[viewpoint]]
name = "round"
eye = [4, 3, 1.2]
sweep = { from = 0, to = 315, step = 45 }
[lists]
viewpoints = "views.csv"
"#;
const LIST: &str = "name,x,y,z,azimuth,tilt\nlisted,4,2,1.2,225,30\n";
const MAP: &str = r#"[[glare_map]]
name = "map"
rect = { origin = [2, 2, 1.2], u = [2, 0, 0], v = [0, 1, 0] }
step = 1
directions = 2
indices = ["DGP"]
"#;

fn gershun(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_gershun")).args(arguments).output().expect("it runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().expect("a code"), text(&output.stdout), text(&output.stderr))
}

fn project(parts: &[&str]) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("project.toml"), parts.concat()).expect("written");
    std::fs::write(folder.path().join("views.csv"), LIST).expect("written");
    let path = folder.path().display().to_string();
    (folder, path)
}

/// A fisheye of 100 pixels with one bright disc straight ahead that is too large for UGR to hold; `view` says
/// whether the file knows its view.
fn picture(folder: &Path, name: &str, knows: bool) -> String {
    disc(folder, name, knows, DVec3::Y)
}

/// The same with the disc in another direction.
fn disc(folder: &Path, name: &str, knows: bool, towards: DVec3) -> String {
    let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let view = View::new(projection, DVec3::ZERO, DVec3::Y, DVec3::Z).expect("a view");
    let luminance = |index: usize| {
        let at = [(index % 100) as f64 + 0.5, (index / 100) as f64 + 0.5];
        view.direction([100, 100], at).map_or(0.0, |direction| {
            if direction.angle_between(towards).to_degrees() < 15.0 { 5000.0 } else { 100.0 }
        })
    };
    let image = LuminanceImage::new(100, 100, knows.then_some(view), (0..10_000).map(luminance).collect());
    let path = folder.join(name);
    std::fs::write(&path, write_hdr(&image)).expect("written");
    path.display().to_string()
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).expect("JSON")
}

fn rows(text: &str) -> Vec<Vec<(String, String)>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().expect("a header").clone();
    let row = |record: csv::StringRecord| {
        header.iter().zip(&record).map(|(key, cell)| (key.to_owned(), cell.to_owned())).collect()
    };
    reader.records().map(|record| row(record.expect("a row"))).collect()
}

fn cell<'a>(row: &'a [(String, String)], key: &str) -> &'a str {
    row.iter().find(|(known, _)| known == key).map_or("", |(_, cell)| cell)
}

/// Catches: a view that is taken for 45° × 45° whatever is written, or forgets the file's own.
#[test]
fn a_view_is_what_was_written_or_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let (knows, knows_not) = (picture(folder.path(), "a.hdr", true), picture(folder.path(), "b.hdr", false));
    for image in [&knows, &knows_not] {
        for view in ["rubbish", "", "angular 180", "-vf x.vf", "-vta -vh180 -vv180", "-vta -vh 180 -vv"] {
            let (code, out, err) = gershun(&["glare", "--image", image, "--view", view]);
            assert!(code == 2 && out.is_empty() && err.contains("hint: "), "\"{view}\": {code} {err}");
        }
    }
    for (view, missing) in [("-vta -vv 180", "-vh"), ("-vh 170 -vv 170", "-vt")] {
        let (code, _, err) = gershun(&["glare", "--image", &knows_not, "--view", view]);
        assert!(code == 2 && err.contains(&format!("{missing} is missing")), "{err}");
    }
    let value = |arguments: &[&str]| {
        let (code, out, err) = gershun(&[&["glare", "--format", "json"], arguments].concat());
        assert_eq!(code, 0, "{err}");
        let json = json(&out);
        assert!(json["notes"].to_string().contains("-vta") || arguments.len() < 4, "{json}");
        json["indices"]["E_v"]["value"].as_f64().expect("E_v")
    };
    let own = value(&["--image", &knows]);
    let whole = value(&["--view", "-vta -vh 180 -vv 180", "--image", &knows_not]);
    assert!((own / whole - 1.0).abs() < 1e-9, "{own} {whole}");
    // Half the angle a pixel: the same disc and background in the middle of a dark field.
    let narrower = value(&["--view", "-vh 90 -vv 90", "--image", &knows]);
    assert!(narrower < 0.8 * own && narrower > 0.2 * own, "{narrower} {own}");
}

/// Catches: an option that is accepted and does nothing.
#[test]
fn options_of_the_other_kind_are_refused() {
    let (_folder, path) = project(&[ROOM, EYES]);
    let image = picture(Path::new(&path), "a.hdr", true);
    for option in [
        &["--position-index", "table"][..],
        &["--age", "60"],
        &["--low-light"],
        &["--dgp", "published"],
        &["--threshold", "1500"],
        &["--threshold-factor", "5"],
        &["--search-radius", "0.1"],
        &["--peak", "none"],
        &["--mask", &image],
        &["--measured-ev", "100"],
        &["--task", "50,50,0.6"],
        &["--check", "a.png"],
        &["--view", "-vta"],
        &["--band", "0.1"],
        &["--experimental"],
        &["--ceiling-coverage", "0.3"],
        &["--ground", "200,0.25"],
        &["--road", "1"],
    ] {
        let (code, out, err) = gershun(&[&["glare", &path], option].concat());
        let says = format!("{} is for images", option[0]);
        assert!(code == 2 && out.is_empty() && err.contains(&says) && err.contains("hint"), "{code} {err}");
    }
    for option in [
        &["--compare-methods"][..],
        &["--out", &path],
        &["--blocks", "64"],
        &["--unbiased"],
        &["--field", &path],
        &["--seed", "7"],
        &["--lang", "ru"],
        &["--allow-outside"],
    ] {
        let (code, out, err) = gershun(&[&["glare", "--image", &image], option].concat());
        let says = format!("{} is for a project", option[0]);
        assert!(code == 2 && out.is_empty() && err.contains(&says) && err.contains("hint"), "{code} {err}");
    }
    let (code, _, err) = gershun(&["glare"]);
    assert!(code == 2 && err.contains("gershun glare PROJECT") && err.contains("--image"), "{err}");
}

/// Catches: an object where an array is promised because one image of two is missing; notes of an image that
/// stand in one format only.
#[test]
fn the_shape_follows_from_what_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = picture(folder.path(), "a.hdr", true);
    let told = |images: &[&str]| {
        let (code, out, _) = gershun(&[&["glare", "--format", "json", "--image"], images].concat());
        (code, if out.is_empty() { serde_json::Value::Null } else { json(&out) })
    };
    assert!(told(&[&image]).1.is_object());
    let (code, found) = told(&[&image, "missing.hdr"]);
    assert_eq!((code, found.as_array().map(Vec::len)), (2, Some(1)));
    let (code, found) = told(&["missing.hdr", "absent.hdr"]);
    assert_eq!((code, found.as_array().map(Vec::len)), (2, Some(0)));
    let one = told(&[&image]).1;
    let notes: Vec<&str> = one["indices"]["UGR"]["notes"]
        .as_array()
        .into_iter()
        .chain(one["notes"].as_array())
        .flatten()
        .filter_map(serde_json::Value::as_str)
        .collect();
    assert!(notes.iter().any(|note| note.contains("0.1 sr")), "{one}");
    let table = rows(&gershun(&["glare", "--format", "csv", "--image", &image]).1);
    let ugr = table.iter().find(|row| cell(row, "index") == "UGR").expect("a row");
    assert!(notes.iter().all(|note| cell(ugr, "notes").contains(note)), "{}", cell(ugr, "notes"));
    // A check picture as PNG has its numbers too: the SVG's raster is the same picture without them.
    let [png, svg] = ["c.png", "c.svg"].map(|name| folder.path().join(name).display().to_string());
    for check in [&png, &svg] {
        assert_eq!(gershun(&["glare", "--image", &image, "--check", check]).0, 0);
    }
    let svg = std::fs::read_to_string(&svg).expect("written");
    assert!(svg.contains(">1</text>"));
    let inside = svg.split("base64,").nth(1).and_then(|rest| rest.split('"').next()).expect("a raster");
    let numbered = std::fs::read(&png).expect("written");
    assert_eq!(inside.trim_end_matches('=').len() * 3 / 4, numbered.len());
    assert_ne!(inside, base64(&numbered));
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for triple in bytes.chunks(3) {
        let word = (0..3).fold(0u32, |word, index| word << 8 | u32::from(*triple.get(index).unwrap_or(&0)));
        for digit in 0..4 {
            let known = digit <= triple.len();
            text.push(if known { char::from(DIGITS[(word >> (18 - 6 * digit)) as usize & 63]) } else { '=' });
        }
    }
    text
}

/// Catches: what makes UGR invalid said in the report of `check` alone; sources that JSON lacks; azimuths that come
/// back as 225.00000000000003 or −135; units after the reason why there is no value.
#[test]
fn every_format_says_what_makes_an_index_doubtful() {
    let (folder, path) = project(&[ROOM, EYES]);
    let out = folder.path().join("out").display().to_string();
    let told = |format: &str| {
        let (code, text, err) =
            gershun(&["glare", &path, "--blocks", "2", "--format", format, "--out", &out]);
        assert_eq!(code, 0, "{err}");
        text
    };
    let invalid = "source(s) seen under more than 0.1 sr";
    let text = told("human");
    assert!(text.contains(&format!("note: 1 {invalid}")), "{text}");
    let ggr = text.lines().find(|line| line.trim_start().starts_with("GGR")).expect("a line");
    assert!(ggr.contains("- (") && !ggr.contains(") 1"), "{ggr}");
    let views = json(&told("json"));
    let first = &views[0];
    assert!(first["notes"].to_string().contains(invalid), "{first}");
    assert!(first["indices"][0]["notes"].to_string().contains(invalid));
    let sources = first["sources"].as_array().expect("sources");
    assert!(!sources.is_empty() && sources[0]["solid_angle_sr"].as_f64().is_some_and(|sr| sr > 0.1));
    let table = rows(&told("csv"));
    assert!(
        cell(&table[0], "index") == "UGR" && cell(&table[0], "notes").contains(invalid),
        "{:?}",
        table[0]
    );
    let round: Vec<&str> = table
        .iter()
        .filter(|row| cell(row, "viewpoint") == "round")
        .map(|row| cell(row, "azimuth_deg"))
        .collect();
    assert_eq!(round, ["0", "45", "90", "135", "180", "225", "270", "315"]);
    let listed = table.iter().find(|row| cell(row, "viewpoint") == "listed").expect("a row");
    assert_eq!((cell(listed, "azimuth_deg"), cell(listed, "tilt_deg")), ("225", "30"));
    let card = std::fs::read_to_string(folder.path().join("out/glare_card_1.svg")).expect("a card");
    assert!(card.contains(invalid), "{card}");
}

/// Catches: an index that asks for what no image shows and does not say how to give it, a given number not heeded or
/// taken for another, one that is none taken in silence.
#[test]
fn what_no_image_shows_can_be_given() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = disc(folder.path(), "a.hdr", true, DVec3::new(0.4, 0.9, 0.1).normalize());
    let told = |options: &[&str]| {
        let (code, out, err) =
            gershun(&[&["glare", "--format", "json", "--image", &image], options].concat());
        assert_eq!(code, 0, "{err}");
        json(&out)
    };
    let bare = told(&[]);
    for (key, what, option) in [
        ("GGR", "share of the ceiling that shines", "--ceiling-coverage SHARE"),
        ("GR", "mean horizontal illuminance", "--ground LX,RHO"),
        ("f_TI", "mean luminance L_av", "--road L"),
    ] {
        let reason = bare["indices"][key]["reason"].as_str().expect("a reason");
        assert!(reason.contains(what) && reason.contains(option), "{key}: {reason}");
    }
    let given = told(&["--ceiling-coverage", "0.4", "--ground", "200,0.25", "--road", "2", "--age", "40"]);
    let value =
        |key: &str| given["indices"][key]["value"].as_f64().unwrap_or_else(|| panic!("{key}: {given}"));
    let source = &given["sources"][0];
    let of_source = |key: &str| source[key].as_f64().expect("a number");
    let (lx, theta_deg) = (of_source("eye_lx"), of_source("off_axis_deg"));
    assert_eq!(given["sources"].as_array().map(Vec::len), Some(1));
    // CC 0.4: 1.18 − 0.18/0.4 = 0.73; E_d of the source, E_i of the rest.
    let (e_d, e_i) = (value("E_dir"), value("E_v") - value("E_dir"));
    let ggr = value("UGR") + 0.73 * 8.0 * (2.55 * (1.0 + e_d / 220.0) / (1.0 + e_d / e_i)).log10();
    assert!((value("GGR") - ggr).abs() < 1e-9, "{} is not {ggr}", value("GGR"));
    let environment = 0.035 * 0.25 * 200.0 / std::f64::consts::PI;
    // A disc of 15° veils by its parts: more than from its centre.
    let veil = value("L_veil_SH");
    assert!(veil > 1.2 * 10.0 * lx / theta_deg.powi(2), "{veil}");
    let gr = 27.0 + 24.0 * (veil / environment.powf(0.9)).log10();
    assert!((value("GR") - gr).abs() < 1e-9, "{} is not {gr}", value("GR"));
    let aged = 0.986 * (1.0 + (40.0f64 / 66.4).powi(4));
    let f_ti = 65.0 * aged * veil / 2f64.powf(0.8);
    assert!((value("f_TI") - f_ti).abs() < 1e-9, "{} is not {f_ti}", value("f_TI"));
    // EN 13201-3 has an eye of 23 years, whatever age other forms take: 9.86 [1 + (23/66.4)⁴] = 10.002.
    let young = told(&["--road", "2"]);
    let of_young = young["indices"]["f_TI"]["value"].as_f64().expect("f_TI");
    let f_ti = 65.0 * 1.000_194 * veil / 2f64.powf(0.8);
    assert!((of_young / f_ti - 1.0).abs() < 1e-5, "{of_young} is not {f_ti}");
    // Below a share of 0.15 there is UGR, and no GGR however well it is given.
    let little = told(&["--ceiling-coverage", "0.1"]);
    let reason = little["indices"]["GGR"]["reason"].as_str().expect("a reason");
    assert!(reason.contains("from 0.15 to 1, here 0.100"), "{reason}");
    for (option, text) in [
        ("--ceiling-coverage", "1.2"),
        ("--ceiling-coverage", "0"),
        ("--ground", "200"),
        ("--ground", "200,1.5"),
        ("--ground", "-1,0.2"),
        ("--road", "0"),
    ] {
        let (code, out, err) = gershun(&["glare", "--image", &image, &format!("{option}={text}")]);
        assert!(code == 2 && out.is_empty() && err.contains(option), "{option} {text}: {code} {err}");
    }
    assert!(
        given["convention"].as_str().is_some_and(|said| said.contains("ground of 200 lx, reflectance 0.25"))
    );
}

/// Catches: maps that JSON and CSV leave out, so that a project with maps alone is `[]` and fine; a project with maps
/// that is said to have none.
#[test]
fn maps_stand_in_every_format() {
    for (parts, observers) in [(&[ROOM, MAP][..], 0), (&[ROOM, EYES, MAP], 10)] {
        let (_folder, path) = project(parts);
        let (code, text, err) = gershun(&["glare", &path, "--blocks", "2", "--format", "json"]);
        assert_eq!(code, 0, "{err}");
        let views = json(&text);
        let views = views.as_array().expect("an array");
        let of_map: Vec<_> = views.iter().filter(|view| view["map"] == "map").collect();
        assert_eq!((views.len() - of_map.len(), of_map.len() % 2), (observers, 0));
        assert!(of_map.len() >= 4 && of_map[0]["viewpoint"].is_null());
        let estimate = &of_map[0]["indices"][0]["estimate"];
        assert!(estimate["value"].as_f64().is_some() && estimate["lo"].is_null(), "{}", of_map[0]);
        assert!(of_map[0]["approximations"].as_array().is_some_and(|said| !said.is_empty()));
        let (code, text, err) = gershun(&["glare", &path, "--blocks", "2", "--format", "csv"]);
        assert!(code == 0 && err.contains("map: Indirect light is looked up"), "{err}");
        let table = rows(&text);
        let in_map = table.iter().filter(|row| cell(row, "map") == "map");
        assert_eq!(in_map.count(), 2 * of_map.len(), "UGR and DGP");
    }
    let (_folder, path) = project(&[ROOM, MAP]);
    let (code, _, err) = gershun(&["glare", &path, "--compare-methods"]);
    assert!(code == 2 && err.contains("no viewpoint; glare maps are left out: conventions"), "{err}");
    let (_folder, path) = project(&[ROOM]);
    let (code, _, err) = gershun(&["glare", &path]);
    assert!(code == 2 && err.contains("no viewpoint and no glare map"), "{err}");
}
