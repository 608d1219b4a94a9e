//! Whole projects for tests: text and files in a temporary folder, run through the library, and the
//! numbers looked up by name.
#![allow(dead_code, reason = "each test binary uses a part")]

use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use gershun::outcome::{Interval, Outcome, PointValue};
use gershun::project::{LoadOptions, load};
use gershun::solve::Effort;
use gershun::{Settings, Watch};
use tempfile::TempDir;

/// A file beside the project.
pub type File = (String, Vec<u8>);

/// A folder with a project and its files.
pub fn folder(text: &str, files: &[File]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("project.toml"), text).expect("a temporary file");
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).expect("a temporary file");
    }
    folder
}

/// Runs a project with exactly `blocks` blocks.
pub fn run(text: &str, files: &[File], blocks: usize, effort: Effort) -> Outcome {
    run_folder(folder(text, files).path(), blocks, effort)
}

/// Runs the project in a folder.
pub fn run_folder(path: &Path, blocks: usize, effort: Effort) -> Outcome {
    let project = load(path, &LoadOptions::default()).unwrap_or_else(|errors| {
        panic!("{}", errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    });
    let settings = Settings { exact_blocks: Some(vec![blocks]), effort, ..Settings::default() };
    let interrupted = AtomicBool::new(false);
    gershun::run(&project, &settings, &Watch { progress: &|_| {}, interrupted: &interrupted })
        .unwrap_or_else(|error| panic!("{error}"))
}

/// All points of a quantity on an area under a light scene.
pub fn points(outcome: &Outcome, area: &str, quantity: &str, light_scene: &str) -> Vec<PointValue> {
    let mut areas = outcome.rooms.iter().flat_map(|room| &room.areas);
    let area = areas.find(|entry| entry.name == area).unwrap_or_else(|| panic!("no area {area}"));
    let mut fields = area.fields.iter();
    let field = fields
        .find(|field| field.quantity.key() == quantity && field.light_scene == light_scene)
        .unwrap_or_else(|| panic!("no {quantity} under {light_scene}"));
    field.points.iter().flatten().copied().collect()
}

/// The only point of an area under the light scene that stands alone.
pub fn point(outcome: &Outcome, area: &str, quantity: &str) -> PointValue {
    point_in(outcome, area, quantity, "all")
}

/// The only point of an area under a light scene.
pub fn point_in(outcome: &Outcome, area: &str, quantity: &str, light_scene: &str) -> PointValue {
    let points = points(outcome, area, quantity, light_scene);
    assert_eq!(points.len(), 1, "{area} has one point");
    points[0]
}

/// UGR of a viewpoint under a light scene.
pub fn ugr(outcome: &Outcome, viewpoint: &str, light_scene: &str) -> Interval {
    let mut views = outcome.rooms.iter().flat_map(|room| &room.viewpoints);
    let view = views
        .find(|view| view.name == viewpoint && view.light_scene == light_scene)
        .unwrap_or_else(|| panic!("no viewpoint {viewpoint} under {light_scene}"));
    view.ugr.clone().unwrap_or_else(|reason| panic!("{viewpoint}: {reason:?}"))
}

/// An area of one point that looks up; `quantities` as in the project file.
pub fn spot(name: &str, at: [f64; 3], quantities: &str) -> String {
    facing(name, at, [[0.25, 0.0, 0.0], [0.0, 0.25, 0.0]], quantities)
}

/// An area of one point with the normal u × v.
pub fn facing(name: &str, at: [f64; 3], [u, v]: [[f64; 3]; 2], quantities: &str) -> String {
    let origin = [0, 1, 2].map(|i| at[i] - 0.5 * (u[i] + v[i]));
    format!(
        "[[area]]\nname = \"{name}\"\nrect = {{ origin = {origin:?}, u = {u:?}, v = {v:?} }}\n\
         grid = {{ count = [1, 1] }}\nquantities = [{quantities}]\n"
    )
}

/// A plane sheet of a glTF scene: node name, material name, corners (counter-clockwise in front).
pub type Sheet = (&'static str, &'static str, [[f64; 3]; 4]);

/// The six sheets of a room from the origin, looking inwards, of material `shell`.
pub fn shell(size: [f64; 3]) -> Vec<Sheet> {
    let [x, y, z] = size;
    vec![
        ("Floor", "shell", [[0., 0., 0.], [x, 0., 0.], [x, y, 0.], [0., y, 0.]]),
        ("Ceiling", "shell", [[0., 0., z], [0., y, z], [x, y, z], [x, 0., z]]),
        ("Wall_S", "shell", [[0., 0., 0.], [0., 0., z], [x, 0., z], [x, 0., 0.]]),
        ("Wall_N", "shell", [[0., y, 0.], [x, y, 0.], [x, y, z], [0., y, z]]),
        ("Wall_W", "shell", [[0., 0., 0.], [0., y, 0.], [0., y, z], [0., 0., z]]),
        ("Wall_E", "shell", [[x, 0., 0.], [x, 0., z], [x, y, z], [x, y, 0.]]),
    ]
}

/// A horizontal square sheet that looks up.
pub fn square(name: &'static str, material: &'static str, centre: [f64; 3], half: f64) -> Sheet {
    let [x, y, z] = centre;
    let (a, b, c, d) = (x - half, x + half, y - half, y + half);
    (name, material, [[a, c, z], [b, c, z], [b, d, z], [a, d, z]])
}

/// scene.gltf and scene.bin of some sheets (two triangles each, split along corners 0–2).
pub fn gltf(sheets: &[Sheet]) -> Vec<File> {
    let mut materials: Vec<&str> = Vec::new();
    let mut binary = Vec::new();
    let (mut nodes, mut meshes, mut accessors, mut views) = (vec![], vec![], vec![], vec![]);
    for (index, (name, material, corners)) in sheets.iter().enumerate() {
        if !materials.contains(material) {
            materials.push(material);
        }
        let material = materials.iter().position(|m| m == material).expect("just added");
        for corner in [0, 1, 2, 0, 2, 3] {
            let [x, y, z] = corners[corner];
            for value in [x, z, -y] {
                binary.extend((value as f32).to_le_bytes());
            }
        }
        nodes.push(format!(r#"{{"name":"{name}","mesh":{index}}}"#));
        meshes.push(format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{index}}},"material":{material}}}]}}"#
        ));
        accessors.push(format!(r#"{{"bufferView":{index},"componentType":5126,"type":"VEC3","count":6}}"#));
        views.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":72}}"#, 72 * index));
    }
    let materials: Vec<String> = materials.iter().map(|name| format!(r#"{{"name":"{name}"}}"#)).collect();
    let roots: Vec<String> = (0..sheets.len()).map(|index| index.to_string()).collect();
    let mut text = String::new();
    write!(
        text,
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{}],"materials":[{}],"accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{},"uri":"scene.bin"}}]}}"#,
        roots.join(","),
        nodes.join(","),
        meshes.join(","),
        materials.join(","),
        accessors.join(","),
        views.join(","),
        binary.len(),
    )
    .expect("a String takes everything");
    vec![("scene.gltf".into(), text.into_bytes()), ("scene.bin".into(), binary)]
}

/// The house test of a Monte Carlo answer: enough blocks, able to fail, and right.
pub fn agrees(value: f64, se: f64, truth: f64, resolve: f64) -> Result<(), String> {
    if !(5.0 * se <= resolve * truth.abs()) {
        return Err(format!("cannot resolve {resolve}: {value} ± {se}, truth {truth}"));
    }
    // Exact answers (se = 0) still carry rounding and the lift off a surface.
    if !((value - truth).abs() <= (5.0 * se).max(2e-8 * truth.abs())) {
        return Err(format!("{value} ± {se} is not {truth}"));
    }
    Ok(())
}

/// [`agrees`] or panics with `what`.
pub fn check(what: &str, value: f64, se: f64, truth: f64, resolve: f64) {
    if let Err(reason) = agrees(value, se, truth, resolve) {
        panic!("{what}: {reason}");
    }
}
