//! Light sources of a CAD file as luminaires: listed and dark by default, lit on demand.

use std::path::Path;

use gershun::project::{LoadOptions, Project, load};
use glam::DVec3;

const IES: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n400 200 0\n";

/// A 4 × 4 m floor and lights 3 m above it: a spot that looks down (−Z turned to −Y), a point, a sun, a profile.
fn gltf() -> String {
    let floor: Vec<u8> =
        [[-2f32, 0., -2.], [2., 0., -2.], [2., 0., 2.], [-2., 0., -2.], [2., 0., 2.], [-2., 0., 2.]]
            .iter()
            .flatten()
            .flat_map(|value| value.to_le_bytes())
            .collect();
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let base64: String = floor
        .chunks(3)
        .flat_map(|three| {
            let bits = three.iter().fold(0u32, |bits, byte| bits << 8 | u32::from(*byte));
            [18, 12, 6, 0].map(|shift| char::from(digits[(bits >> shift & 63) as usize]))
        })
        .collect();
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1,2,3,4]}}],
"extensionsUsed":["KHR_lights_punctual","EXT_lights_ies"],
"extensions":{{"KHR_lights_punctual":{{"lights":[
 {{"name":"Spot","type":"spot","intensity":1000,"range":10,"spot":{{"innerConeAngle":0.3,"outerConeAngle":0.7}}}},
 {{"name":"Bulb","type":"point","intensity":50,"color":[0,1,0]}},
 {{"name":"Sun","type":"directional","intensity":80000}}]}},
 "EXT_lights_ies":{{"lights":[{{"name":"Photo","uri":"lamp.ies"}}]}}}},
"nodes":[{{"mesh":0,"name":"Floor"}},
 {{"translation":[0,3,0],"rotation":[-0.70710678,0,0,0.70710678],"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}},
 {{"translation":[1,2.5,0.5],"extensions":{{"KHR_lights_punctual":{{"light":1}}}}}},
 {{"extensions":{{"KHR_lights_punctual":{{"light":2}}}}}},
 {{"translation":[-1,3,0],"rotation":[-0.70710678,0,0,0.70710678],"extensions":{{"EXT_lights_ies":{{"light":0,"multiplier":2}}}}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}],
"materials":[{{"name":"Paint","pbrMetallicRoughness":{{"baseColorFactor":[0.3,0.3,0.3,1]}}}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[-2,0,-2],"max":[2,0,2]}}],
"bufferViews":[{{"buffer":0,"byteLength":72}}],
"buffers":[{{"byteLength":72,"uri":"data:application/octet-stream;base64,{base64}"}}]}}"#
    )
}

fn project(folder: &Path, scene: &str, gltf: &str) -> Result<Project, String> {
    let text = format!("[scene]\nfile = \"hall.gltf\"\n{scene}\n");
    for (name, bytes) in [("project.toml", text.as_str()), ("hall.gltf", gltf), ("lamp.ies", IES)] {
        std::fs::write(folder.join(name), bytes).expect("written");
    }
    load(folder, &LoadOptions::default())
        .map_err(|diagnostics| diagnostics.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
}

/// Catches: lights that shine unasked, or vanish without a word.
#[test]
fn without_being_asked_they_are_listed_and_dark() {
    let folder = tempfile::tempdir().expect("a folder");
    let project = project(folder.path(), "", &gltf()).expect("loads");
    assert!(project.worlds[0].scene.luminaires.is_empty());
    let told = project.biases.join("\n");
    assert!(
        told.contains("4 light sources of hall.gltf are ignored") && told.contains("Spot, Bulb, Sun, Photo"),
        "{told}"
    );
}

/// Catches: Y up left as it is, −Z not the beam, cone angles taken as full ones, a multiplier or colour
/// forgotten, a sun as a lamp, a range that cuts silently.
#[test]
fn on_demand_they_are_luminaires() {
    let folder = tempfile::tempdir().expect("a folder");
    let project = project(folder.path(), "lights = true", &gltf()).expect("loads");
    let luminaires = &project.worlds[0].scene.luminaires;
    let names: Vec<&str> = luminaires.iter().map(|luminaire| luminaire.group.as_str()).collect();
    assert_eq!(names, ["Spot", "Bulb", "Photo"]);
    let [spot, bulb, photo] = &luminaires[..] else { panic!("three") };
    assert!((spot.position - DVec3::new(0.0, 0.0, 3.0)).length() < 1e-6);
    assert!((bulb.position - DVec3::new(1.0, -0.5, 2.5)).length() < 1e-6);
    for down in [spot, photo] {
        assert!((down.beam_axis() - DVec3::NEG_Z).length() < 1e-6, "{}", down.beam_axis());
    }
    let cd = |luminaire: &gershun::luminaire::Luminaire, gamma| {
        luminaire.kind.distribution.intensity_at(0.0, gamma)
    };
    assert!((cd(spot, 0.0) - 1000.0).abs() < 1e-9 && (cd(spot, 17.0) - 1000.0).abs() < 1e-9);
    assert!(cd(spot, 40.2).abs() < 1e-9 && cd(spot, 30.0) > 10.0);
    assert!((cd(bulb, 150.0) - 0.7152 * 50.0).abs() < 1e-9);
    assert!((cd(photo, 45.0) - 400.0).abs() < 1e-9);
    let told = project.biases.join("\n");
    for part in ["range of 10 m is ignored", "\"Sun\"", "directional"] {
        assert!(told.contains(part), "{told}");
    }
}

/// Catches: a broken light that stops a project that does not use it, or passes in one that does.
#[test]
fn broken_lights_matter_only_where_they_shine() {
    let folder = tempfile::tempdir().expect("a folder");
    let broken = gltf().replace("\"type\":\"spot\"", "\"type\":\"disco\"");
    assert!(project(folder.path(), "", &broken).is_ok());
    let error = project(folder.path(), "lights = true", &broken).expect_err("broken");
    assert!(error.contains("disco") && error.contains("\"Spot\""), "{error}");
    let none = gltf()
        .replace("\"extensions\":{\"KHR_lights_punctual\":{\"light\"", "\"extras\":{\"was\":{\"light\"");
    let none =
        none.replace("\"extensions\":{\"EXT_lights_ies\":{\"light\"", "\"extras\":{\"was\":{\"light\"");
    let error = project(folder.path(), "lights = true", &none).expect_err("no lights");
    assert!(error.contains("no light sources"), "{error}");
}
