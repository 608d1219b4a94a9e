//! Light sources of a CAD file as luminaires: listed and dark by default, lit on demand.

use std::path::Path;

use gershun::project::{LoadOptions, Project, load};
use glam::DVec3;

const IES: &str = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n400 200 0\n";

/// Without padding: a whole number of threes.
fn base64(bytes: &[u8]) -> String {
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    assert!(bytes.len().is_multiple_of(3));
    let of_three = |three: &[u8]| {
        let bits = three.iter().fold(0u32, |bits, byte| bits << 8 | u32::from(*byte));
        [18, 12, 6, 0].map(|shift| char::from(digits[(bits >> shift & 63) as usize]))
    };
    bytes.chunks(3).flat_map(of_three).collect()
}

/// A 4 × 4 m floor and lights 3 m above it: a spot that looks down (−Z turned to −Y), a point, a sun, a profile.
fn gltf() -> String {
    let floor: Vec<u8> =
        [[-2f32, 0., -2.], [2., 0., -2.], [2., 0., 2.], [-2., 0., -2.], [2., 0., 2.], [-2., 0., 2.]]
            .iter()
            .flatten()
            .flat_map(|value| value.to_le_bytes())
            .collect();
    let base64 = base64(&floor);
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

/// Catches: lights that are called alike taken for one type, with one's flux and one's table for both.
#[test]
fn lights_of_one_name_that_shine_unlike_are_two_types() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = "[luminaires.Lamp]\npoint = { flux = 100 }\n[[place]]\nluminaire = \"Lamp\"\nat = [0, 0, 1]\n";
    let same = gltf().replace("\"Bulb\"", "\"Lamp\"").replace("\"Spot\"", "\"Lamp\"");
    let project = project(folder.path(), &format!("lights = true\n{own}"), &same).expect("loads");
    let luminaires = &project.worlds[0].scene.luminaires;
    let said: Vec<(&str, &str)> =
        luminaires.iter().map(|l| (l.kind.name.as_str(), l.group.as_str())).collect();
    let expected = [("Lamp", "Lamp"), ("Lamp (2)", "Lamp"), ("Lamp (3)", "Lamp"), ("Photo", "Photo")];
    assert_eq!(said, expected);
    assert_eq!(project.worlds[0].scene.channels.len(), 4, "each is solved on its own");
}

/// A file of 900 cd towards its 0° plane and 100 cd elsewhere at 45°, its length a multiple of 3.
fn one_sided() -> String {
    let file = IES.replace("3 1 1 2", "3 5 1 2").replace(
        "\n0\n400 200 0\n",
        "\n0 90 180 270 360\n300 900 0\n300 100 0\n300 100 0\n300 100 0\n300 900 0\n",
    );
    let padding = (3 - file.len() % 3) % 3;
    file + &" ".repeat(padding)
}

/// Catches: a profile within the glTF file that is not found, cut wrongly out of its buffer or read from
/// elsewhere; planes turned about the beam against the node; a colour above 1 that adds light; a path out of
/// the project's folder.
#[test]
fn profiles_are_read_from_wherever_they_lie() {
    let file = one_sided();
    let data = format!("data:application/x-ies-lm-63;base64,{}", base64(file.as_bytes()));
    let inline = gltf().replace("\"uri\":\"lamp.ies\"", &format!("\"uri\":\"{data}\""));
    let shifted = format!("xxx{file}");
    let view = gltf()
        .replace("\"uri\":\"lamp.ies\"", "\"bufferView\":1,\"mimeType\":\"application/x-ies-lm-63\"")
        .replace(
            "{\"buffer\":0,\"byteLength\":72}",
            &format!(
                "{{\"buffer\":0,\"byteLength\":72}},{{\"buffer\":1,\"byteOffset\":3,\"byteLength\":{}}}",
                file.len()
            ),
        )
        .replace(
            "\"buffers\":[",
            &format!(
                "\"buffers\":[{{\"byteLength\":{},\"uri\":\"data:;base64,{}\"}},",
                shifted.len(),
                base64(shifted.as_bytes())
            ),
        )
        // The new buffer stands first.
        .replace("\"buffer\":1", "\"buffer\":9")
        .replace("\"buffer\":0", "\"buffer\":1")
        .replace("\"buffer\":9", "\"buffer\":0");
    let outside = gltf().replace("lamp.ies", "sub%20folder/lamp.ies");
    let photo = |gltf: &str, extra: &str| {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::create_dir(folder.path().join("sub folder")).expect("made");
        std::fs::write(folder.path().join("sub folder/lamp.ies"), &file).expect("written");
        let gltf = gltf.replace("\"light\":0,\"multiplier\":2", extra);
        let project = project(folder.path(), "lights = true", &gltf)?;
        let luminaires = &project.worlds[0].scene.luminaires;
        Ok::<_, String>(
            luminaires.iter().find(|luminaire| luminaire.group == "Photo").expect("it hangs").clone(),
        )
    };
    let cd = |luminaire: &gershun::luminaire::Luminaire, toward: [f64; 3]| {
        let local = luminaire.world_from_luminaire.transpose() * DVec3::from_array(toward).normalize();
        luminaire.kind.distribution.intensity_along(local)
    };
    let white = "\"light\":0,\"multiplier\":2,\"color\":[7,1,1]";
    for gltf in [&inline, &view, &outside] {
        let lamp = photo(gltf, white).unwrap_or_else(|error| panic!("{error}"));
        assert!((cd(&lamp, [1.0, 0.0, -1.0]) - 1800.0).abs() < 1e-6, "{}", cd(&lamp, [1.0, 0.0, -1.0]));
        assert!((cd(&lamp, [0.0, 1.0, -1.0]) - 200.0).abs() < 1e-6);
        assert!((cd(&lamp, [0.0, -1.0, -1.0]) - 200.0).abs() < 1e-6);
    }
    // The same node, turned by 90° about its beam: +X of the node now lies towards +y of the project.
    let turned = inline.replace(
        "{\"translation\":[-1,3,0],\"rotation\":[-0.70710678,0,0,0.70710678]",
        "{\"translation\":[-1,3,0],\"rotation\":[-0.5,0.5,0.5,0.5]",
    );
    let lamp = photo(&turned, white).unwrap_or_else(|error| panic!("{error}"));
    assert!((cd(&lamp, [0.0, 1.0, -1.0]) - 1800.0).abs() < 1e-3, "{}", cd(&lamp, [0.0, 1.0, -1.0]));
    assert!((cd(&lamp, [1.0, 0.0, -1.0]) - 200.0).abs() < 1e-3);
    let red = photo(&inline, "\"light\":0,\"color\":[1,0,0]").unwrap_or_else(|error| panic!("{error}"));
    assert!((cd(&red, [1.0, 0.0, -1.0]) - 0.2126 * 900.0).abs() < 1e-6);
    for (broken, what) in [
        (gltf().replace("lamp.ies", "../lamp.ies"), "outside"),
        (gltf().replace("lamp.ies", "https://example.org/lamp.ies"), "only relative and data: URIs"),
        (gltf().replace("lamp.ies", "none.ies"), "none.ies"),
        (
            gltf().replace("\"uri\":\"lamp.ies\"", "\"mimeType\":\"x\""),
            "neither by `uri` nor by `bufferView`",
        ),
        (view.replace("\"bufferView\":1,\"mime", "\"bufferView\":7,\"mime"), "buffer view 7"),
        (view.replace("\"byteOffset\":3", "\"byteOffset\":4"), "runs past buffer"),
        (inline.replace("lm-63;base64,", "lm-63;base64,!"), "base64"),
    ] {
        let error = photo(&broken, white).expect_err(what);
        assert!(error.contains(what) && error.contains("Photo"), "{what}: {error}");
    }
}

/// Catches: the two published examples of EXT_lights_ies read unlike each other, or not at all.
#[test]
fn the_published_examples_agree() {
    let shared = std::env::var("GERSHUN_DATA")
        .unwrap_or_else(|_| format!("{}/../shared/data", env!("CARGO_MANIFEST_DIR")));
    let from = Path::new(&shared).join("geometry/gltf/ext_lights_ies");
    if !from.is_dir() {
        println!("skipped: no {}", from.display());
        return;
    }
    let lumens = ["Example.gltf", "Example_bufferView.gltf"].map(|name| {
        let folder = tempfile::tempdir().expect("a folder");
        for file in [name, "LightProfile.ies"] {
            std::fs::copy(from.join(file), folder.path().join(file)).expect("copied");
        }
        let text = format!(
            "[scene]\nfile = \"{name}\"\nlights = true\n[materials]\nWhite = {{ reflectance = 0.5 }}\n"
        );
        std::fs::write(folder.path().join("project.toml"), text).expect("written");
        let project = load(folder.path(), &LoadOptions::default()).expect("loads");
        project.worlds[0].scene.luminaires[0].kind.distribution.flux().0
    });
    assert!(lumens[0] > 1.0 && (lumens[0] / lumens[1] - 1.0).abs() < 1e-12, "{lumens:?}");
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

/// Catches: a far field that is not written, cannot be read back or loses its flux; a group that is not
/// chosen; a closed room that gives an empty file.
#[test]
fn installed_luminaires_become_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    project(folder.path(), "lights = true", &gltf()).expect("loads");
    let run = |arguments: &[&str]| {
        std::process::Command::new(env!("CARGO_BIN_EXE_gershun"))
            .current_dir(folder.path())
            .args(arguments)
            .output()
            .expect("runs")
    };
    let far =
        run(&["lamp", "far-field", "project.toml", "--group", "Bulb", "--out", "bulb.ldt", "--blocks", "32"]);
    let said = String::from_utf8_lossy(&far.stdout).into_owned();
    assert_eq!(far.status.code(), Some(0), "{said}{}", String::from_utf8_lossy(&far.stderr));
    assert!(said.contains("bulb.ldt") && said.contains("emitted"), "{said}");
    let bytes = std::fs::read(folder.path().join("bulb.ldt")).expect("written");
    let file = gershun::photometry::parse(&bytes, "bulb.ldt").expect("readable");
    // 35.76 cd upwards and ρ/π I Ω cos 30° from the floor, Ω = 1.4386 sr; from below the floor hides it.
    let truth = 35.76 * (1.0 + 0.3 / std::f64::consts::PI * 1.4386 * 30_f64.to_radians().cos());
    let found = file.distribution.intensity_at(0.0, 150.0);
    assert!((found / truth - 1.0).abs() < 0.04, "{found} {truth}");
    assert!(file.distribution.intensity_at(0.0, 0.0) < 0.01);
    let lor = file.lor.expect("a light output ratio");
    assert!((lor - 0.9199).abs() < 0.03, "{lor}");
    let json = run(&["lamp", "far-field", ".", "--group", "Spot", "--format", "json", "--blocks", "32"]);
    let value: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert!(value["lor"]["lo"].as_f64() < value["lor"]["hi"].as_f64(), "{value}");
    let russian = run(&["lamp", "far-field", ".", "--group", "Spot", "--lang", "ru", "--blocks", "32"]);
    let said = String::from_utf8_lossy(&russian.stdout).into_owned();
    assert!(said.contains("стандартная погрешность") && !said.contains("emitted"), "{said}");
    assert_eq!(run(&["lamp", "far-field", ".", "--group", "Nobody"]).status.code(), Some(2));
    assert_eq!(run(&["lamp", "far-field", ".", "--c-step", "7"]).status.code(), Some(2));
    let closed = "[scene]\nbox = { size = [3, 3, 3], floor = 0.2, walls = 0.5, ceiling = 0.7 }\n\
                  [luminaires.A]\npoint = { flux = 100 }\n[[place]]\nluminaire = \"A\"\nat = [1.5, 1.5, 2]\n";
    std::fs::write(folder.path().join("project.toml"), closed).expect("written");
    let dark = run(&["lamp", "far-field", ".", "--blocks", "32"]);
    assert_eq!(dark.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&dark.stderr).contains("no light leaves the scene"));
}
