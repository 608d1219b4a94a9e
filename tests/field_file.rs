//! The stored field as a file: the same pictures without solving, and only for the scene it belongs to.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use gershun::field::store::{FieldFile, StoreError, to_bytes};
use gershun::project::{LoadOptions, Project, load};
use gershun::scene::Scene;
use gershun::solve::picture::expose;

fn scenes(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

fn project(folder: &Path) -> Project {
    load(folder, &LoadOptions::default()).expect("an example that loads")
}

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gershun")).args(arguments).output().expect("it runs")
}

fn stored(project: &Project) -> Vec<u8> {
    let scene = &project.worlds[0].scene;
    let exposure = expose(scene, 1);
    to_bytes(&[("Room".to_owned(), scene, exposure.stored())]).expect("its own field")
}

fn open(bytes: &[u8], scene: &Scene) -> Result<(), StoreError> {
    FieldFile::parse(bytes)?.fields(&[("Room".to_owned(), scene)]).map(|_| ())
}

/// Catches: a value lost on the way to the file or back, patches numbered otherwise; a field that is
/// solved again although one was given.
#[test]
fn pictures_from_a_kept_field_are_those_of_a_fresh_one() {
    let folder = tempfile::tempdir().expect("tempdir");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let office = scenes("office").display().to_string();
    let solved = run(&["solve", "-q", &office, "--out", &path("kept")]);
    assert!(solved.status.success(), "{}", String::from_utf8_lossy(&solved.stderr));
    let shot = ["view", "-q", "--format", "exr", "--size", "64x64", "--camera", "Seat 1", &office, "--out"];
    let taken = |out: &str, more: &[&str]| -> Vec<u8> {
        let output = run(&[&shot[..], &[&path(out)], more].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let views = fs::read_dir(folder.path().join(out).join("views")).expect("a folder");
        let exr = views
            .map(|entry| entry.expect("an entry").path())
            .find(|path| path.extension() == Some("exr".as_ref()));
        fs::read(exr.expect("a picture")).expect("readable")
    };
    let (fresh, kept) = (taken("fresh", &[]), taken("again", &["--field", &path("kept")]));
    assert!(fresh == kept, "the kept field gives another picture");
    // Broken twin: the field of another seed.
    assert!(run(&["solve", "-q", &office, "--seed", "2", "--out", &path("other")]).status.success());
    assert!(fresh != taken("else", &["--field", &path("other")]), "the file is not looked at");
    // The record names the seed of the field that was looked at, not the project's.
    for (out, seed) in [("again", 1), ("else", 2)] {
        let record = fs::read(folder.path().join(out).join("views/views.json")).expect("a record");
        let record: serde_json::Value = serde_json::from_slice(&record).expect("JSON");
        assert_eq!(record["seed"], seed);
    }
}

/// Catches: a field used for a scene it does not belong to; one refused for what does not matter to it.
#[test]
fn a_field_belongs_to_its_scene() {
    let folder = tempfile::tempdir().expect("tempdir");
    let text = fs::read_to_string(scenes("box").join("project.toml")).expect("an example");
    let changed = |name: &str, from: &str, to: &str| -> Project {
        assert!(text.contains(from), "{from} is not in the example");
        let folder = folder.path().join(name);
        fs::create_dir_all(&folder).expect("a folder");
        fs::write(folder.join("project.toml"), text.replacen(from, to, 1)).expect("written");
        project(&folder)
    };
    let own = changed("own", "[norm]", "[norm]");
    let bytes = stored(&own);
    assert_eq!(open(&bytes, &own.worlds[0].scene), Ok(()));
    let viewpoint = "[[viewpoint]]\nname = \"New\"\neye = [1, 1, 1.2]\ndirection = [1, 0, 0]\n\n[norm]";
    let seen = changed("viewpoint", "[norm]", viewpoint);
    assert_eq!(open(&bytes, &seen.worlds[0].scene), Ok(()), "a new viewpoint needs no new solve");
    for (name, from, to) in [
        ("size", "size = [5,", "size = [5.01,"),
        ("walls", "walls = 0.5", "walls = 0.51"),
        ("lamp", "height = 2.799", "height = 2.79"),
    ] {
        let other = changed(name, from, to);
        let error = open(&bytes, &other.worlds[0].scene).expect_err(name);
        assert!(matches!(error, StoreError::OtherScene(_)), "{name}: {error}");
    }
}

/// Catches: a panic, or values that shift silently, on files that were cut or altered.
#[test]
fn damaged_files_are_refused() {
    let project = project(&scenes("box"));
    let (bytes, scene) = (stored(&project), &project.worlds[0].scene);
    assert_eq!(open(&bytes, scene), Ok(()));
    let header = 8 + u64::from_le_bytes(std::array::from_fn(|k| bytes[k])) as usize;
    for at in (0..header).step_by(11).chain((header..bytes.len()).step_by(bytes.len() / 16)) {
        assert!(open(&bytes[..at], scene).is_err(), "cut at {at}");
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << (at % 8);
        // A header may be altered where it only names things.
        let result = open(&flipped, scene);
        assert!(at < header || result == Err(StoreError::Checksum), "byte {at}: {result:?}");
    }
    let text = String::from_utf8_lossy(&bytes[8..header]).into_owned();
    // Patches so small that there would be billions of them.
    let area =
        text.split("patch_m2\\\":\\\"").nth(1).and_then(|rest| rest.split('\\').next()).expect("an area");
    let tiny = format!("1e-{}9", "0".repeat(area.len() - 4));
    let at = 8 + text.find(area).expect("an area");
    let mut altered = bytes.clone();
    altered[at..at + area.len()].copy_from_slice(tiny.as_bytes());
    let result = open(&altered, scene);
    assert!(matches!(result, Err(StoreError::Malformed(_))), "{area} → {tiny}: {result:?}");
}

/// Catches: a layout that the description does not tell; a mean over the patches that is not the
/// field's own. Reads the file as docs/field-file.md says, without the library that wrote it.
#[test]
fn the_file_is_what_its_description_says() {
    let project = project(&scenes("box"));
    let bytes = stored(&project);
    let length = u64::from_le_bytes(std::array::from_fn(|k| bytes[k])) as usize;
    let header: serde_json::Value = serde_json::from_slice(&bytes[8..8 + length]).expect("JSON");
    let head: serde_json::Value =
        serde_json::from_str(header["__metadata__"]["gershun"].as_str().expect("a text")).expect("JSON");
    assert_eq!(head["version"], 1);
    assert_eq!(head["worlds"][0]["channels"].as_array().map(Vec::len), Some(1));
    let floats = |name: &str| -> (Vec<usize>, Vec<f64>) {
        let entry = &header[format!("world0.{name}")];
        assert_eq!(entry["dtype"], "F64");
        let list = |key: &str| -> Vec<usize> {
            let numbers = entry[key].as_array().expect("numbers");
            numbers.iter().map(|n| n.as_u64().expect("a number") as usize).collect()
        };
        let [from, to] = list("data_offsets")[..] else { panic!("two offsets") };
        let data = &bytes[8 + length + from..8 + length + to];
        let values = data.chunks(8).map(|chunk| f64::from_le_bytes(std::array::from_fn(|k| chunk[k])));
        (list("shape"), values.collect())
    };
    let (shape, points) = floats("point_m");
    let (_, normals) = floats("normal");
    let (_, areas) = floats("area_m2");
    let (wide, luminance) = floats("luminance_cd_m2");
    let (_, direct) = floats("direct_cd_m2");
    assert_eq!((shape[1], wide[0], wide[1], wide[2]), (3, shape[0], 2, 1));
    let scene = &project.worlds[0].scene;
    let whole: f64 = (0..scene.mesh.triangles.len()).map(|t| scene.mesh.normal_and_area(t).1).sum();
    assert!((areas.iter().sum::<f64>() / whole - 1.0).abs() < 1e-9);
    // The floor's middle is lit from above: in front, not behind, and not by direct light alone.
    let middle = (0..shape[0])
        .filter(|&k| normals[3 * k + 2] > 0.99)
        .min_by(|&a, &b| {
            let off = |k: usize| (points[3 * k] - 2.5).hypot(points[3 * k + 1] - 2.0);
            off(a).total_cmp(&off(b))
        })
        .expect("a floor");
    assert!(luminance[2 * middle] > direct[2 * middle] && direct[2 * middle] > 1.0);
    assert!(luminance[2 * middle + 1].abs() < 1e-12, "the floor is lit from below");
}
