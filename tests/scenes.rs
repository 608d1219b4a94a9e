//! The example scenes are what their generator makes, and fit together.
#![expect(clippy::unwrap_used, reason = "a test that cannot read its files fails")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::Value;

#[path = "../examples/make_office/main.rs"]
#[expect(dead_code, reason = "the generator's main is not run here")]
mod make_office;

use make_office::{check, photometry, room};

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

fn glb_json() -> Value {
    let bytes = std::fs::read(scenes().join("office/office.glb")).unwrap();
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(&bytes[0..4], b"glTF");
    assert_eq!(word(4), 2, "version");
    assert_eq!(word(8), bytes.len(), "length in the header");
    assert_eq!(&bytes[16..20], b"JSON");
    let binary = 20 + word(12);
    assert_eq!(&bytes[binary + 4..binary + 8], b"BIN\0");
    assert_eq!(binary + 8 + word(binary), bytes.len(), "two chunks fill the file");
    serde_json::from_slice(&bytes[20..binary]).unwrap()
}

fn read_project(scene: &str) -> toml::Table {
    let text = std::fs::read_to_string(scenes().join(scene).join("project.toml")).unwrap();
    text.parse().unwrap()
}

/// Catches: files that were edited by hand, or a generator changed without a new run.
#[test]
fn committed_files_are_what_the_generator_makes() {
    let (_, files) = make_office::make();
    for file in files {
        let committed = std::fs::read(scenes().join("office").join(file.name)).unwrap();
        assert!(
            committed == file.bytes,
            "{} differs: run cargo run --release --example make_office",
            file.name
        );
    }
}

/// Catches: indices out of range, accessors beyond their views, missing bounds: whatever the glTF
/// crate validates.
#[test]
fn office_is_valid_gltf() {
    let bytes = std::fs::read(scenes().join("office/office.glb")).unwrap();
    let office = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = office.blob.as_deref().unwrap();
    for primitive in office.meshes().flat_map(|mesh| mesh.primitives()) {
        let reader = primitive.reader(|_| Some(blob));
        let vertices = reader.read_positions().unwrap().len() as u32;
        let indices = reader.read_indices().unwrap().into_u32();
        assert!(indices.into_iter().all(|index| index < vertices));
    }
}

/// Catches: a node without its mesh, a mesh written once per node instead of shared.
#[test]
fn office_has_about_five_thousand_triangles_with_instances() {
    let json = glb_json();
    let triangles_of = |mesh: &Value| -> u64 {
        let primitives = json["meshes"][mesh.as_u64().unwrap() as usize]["primitives"].as_array();
        let indices = primitives.unwrap().iter().map(|p| p["indices"].as_u64().unwrap());
        indices.map(|accessor| json["accessors"][accessor as usize]["count"].as_u64().unwrap() / 3).sum()
    };
    let nodes = json["nodes"].as_array().unwrap();
    let meshes: Vec<&Value> = nodes.iter().filter_map(|node| node.get("mesh")).collect();
    let expanded: u64 = meshes.iter().map(|mesh| triangles_of(mesh)).sum();
    assert!((4500..=5500).contains(&expanded), "{expanded}");
    assert_eq!(expanded as usize, make_office::make().0);
    let distinct = json["meshes"].as_array().unwrap().len();
    assert!(meshes.len() >= distinct + 25, "{} nodes share {distinct} meshes", meshes.len());
}

/// Catches: Z-up coordinates written into the Y-up file, or y mirrored.
#[test]
fn file_is_y_up_and_right_handed() {
    let json = glb_json();
    let bounds = |name: &str| {
        let nodes = json["nodes"].as_array().unwrap();
        let node = nodes.iter().find(|node| node["name"] == name).unwrap();
        let mesh = &json["meshes"][node["mesh"].as_u64().unwrap() as usize];
        let position = mesh["primitives"][0]["attributes"]["POSITION"].as_u64().unwrap();
        let accessor = &json["accessors"][position as usize];
        ["min", "max"].map(|key| {
            let corner = accessor[key].as_array().unwrap().iter();
            corner.map(|x| x.as_f64().unwrap()).collect::<Vec<_>>()
        })
    };
    let close = |a: &[f64], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    let [low, high] = bounds("Wall_N");
    assert!(close(&low, [0.0, 0.0, -5.0]) && close(&high, [8.0, 2.8, -5.0]));
    let [low, high] = bounds("Ceiling");
    assert!(close(&low, [0.0, 2.8, -5.0]) && close(&high, [8.0, 2.8, 0.0]));
}

/// Catches: a material without photometric data, or one that nothing uses.
#[test]
fn project_lists_the_materials_of_the_model() {
    let json = glb_json();
    let materials = json["materials"].as_array().unwrap();
    let used: BTreeSet<&str> = materials.iter().map(|m| m["name"].as_str().unwrap()).collect();
    let project = read_project("office");
    let listed: BTreeSet<&str> =
        project["materials"].as_table().unwrap().keys().map(String::as_str).collect();
    assert_eq!(used, listed);
    assert!(materials.iter().all(|m| m.as_object().unwrap().len() == 1), "names only");
}

/// Catches: an area, viewpoint or placement that names what does not exist.
#[test]
fn names_in_the_office_project_exist() {
    let json = glb_json();
    let nodes = json["nodes"].as_array().unwrap();
    let node = |name: &str| nodes.iter().any(|node| node["name"] == name);
    let project = read_project("office");
    let list = |key: &str| project[key].as_array().unwrap().iter();
    let text = |entry: &toml::Value, key: &str| Some(entry.get(key)?.as_str()?.to_owned());
    let areas: Vec<String> = list("area").map(|area| text(area, "name").unwrap()).collect();
    let distinct: BTreeSet<&String> = areas.iter().collect();
    assert_eq!(areas.len(), distinct.len(), "area names are unique");
    for area in list("area") {
        assert!(text(area, "surface").is_none_or(|name| node(&name)), "{area}");
        assert!(text(area, "of").is_none_or(|name| areas.contains(&name)), "{area}");
    }
    for room in list("room") {
        assert!(text(room, "node").is_none_or(|name| node(&name)), "{room}");
    }
    let mut groups = BTreeSet::new();
    for place in list("place") {
        let luminaire = text(place, "luminaire").unwrap();
        let file = project["luminaires"][&luminaire]["file"].as_str().unwrap();
        assert!(scenes().join("office").join(file).exists(), "{file}");
        groups.insert(text(place, "group").unwrap());
    }
    for (name, scene) in project["light_scenes"].as_table().unwrap() {
        for group in scene.as_table().unwrap().keys() {
            assert!(groups.contains(group), "{name}: {group}");
        }
    }
    assert!(read_project("box").contains_key("scene"));
}

/// The broken twins: each must be found by the generator's own checks.
#[test]
fn faulty_models_are_rejected() {
    let says = |model, words: &str| {
        let faults = check::faults(&model);
        assert!(faults.iter().any(|fault| fault.contains(words)), "{faults:?}");
    };
    assert_eq!(check::faults(&room::office()), Vec::<String>::new());

    let mut open = room::office();
    let desk = open.meshes.iter_mut().find(|mesh| mesh.name == "Desk").unwrap();
    desk.parts[0].shape.triangles.pop();
    says(open, "not shared");

    let mut inside_out = room::office();
    let desk = inside_out.meshes.iter_mut().find(|mesh| mesh.name == "Desk").unwrap();
    for triangle in &mut desk.parts[0].shape.triangles {
        triangle.reverse();
    }
    says(inside_out, "inwards");

    let mut outside = room::office();
    let plant = outside.nodes.iter_mut().find(|node| node.name == "Plant").unwrap();
    plant.at.x += 0.3;
    says(outside, "pokes out");

    let mut standing = room::office();
    let bin = standing.nodes.iter_mut().find(|node| node.name == "Bin").unwrap();
    bin.at.z -= 0.001;
    says(standing, "share a plane");

    let mut doorless = room::office();
    doorless.nodes.retain(|node| node.name != "Door_Leaf");
    says(doorless, "escapes");
}

/// Catches: the multiplier, the lamp flux or a symmetry forgotten in the check of the flux itself.
#[test]
fn photometric_files_integrate_to_their_rated_flux() {
    let panel_lm = photometry::flux_of(&photometry::panel_ldt());
    assert!((panel_lm / 3800.0 - 1.0).abs() < 1e-3, "{panel_lm}");
    let louvre_lm = photometry::flux_of(&photometry::louvre_ies());
    assert!((louvre_lm / 3000.0 - 1.0).abs() < 1e-3, "{louvre_lm}");
    let more = photometry::panel_ldt().replace("\r\n3800\r\n", "\r\n3900\r\n");
    assert!((photometry::flux_of(&more) / panel_lm - 3900.0 / 3800.0).abs() < 1e-9);
    let twice = photometry::louvre_ies().replace("\r\n1 3000 1 ", "\r\n1 3000 2 ");
    assert!((photometry::flux_of(&twice) / louvre_lm - 2.0).abs() < 1e-9);
    let bent = photometry::louvre_ies().replace(" 1736.5 ", " 3736.5 ");
    assert!((photometry::flux_of(&bent) / louvre_lm - 1.0).abs() > 1e-3);
}
