//! Bad projects: each mistake must be reported with its file, its line and words that help, and
//! several mistakes must come in one run. A loader that stops early or panics fails here.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use gershun::geometry::DVec3;
use gershun::material::Bsdf;
use gershun::plan::Subject;
use gershun::project::{AreaShape, Diagnostic, Goal, LoadOptions, Project, load};
use gershun::quantity::Quantity;

const GOOD: &str = r#"[project]
name = "Office"

[scene]
box = { size = [8, 5, 2.8], floor = 0.2, walls = 0.5, ceiling = 0.7 }

[luminaires.A]
lambert = { flux = 3600 }
area = { rect = [1.2, 0.3] }
maintenance = 0.8

[[place]]
luminaire = "A"
field = { rows = 2, columns = 3, height = 2.8 }

[[area]]
name = "Desk"
rect = { origin = [1, 1, 0.75], u = [2, 0, 0], v = [0, 1, 0] }

[[area]]
name = "Board"
kind = "surface"
surface = "Wall_N"

[[viewpoint]]
name = "Seat"
eye = [4, 1, 1.2]
sweep = { from = 0, to = 345, step = 15 }
"#;

fn load_in(folder: &Path, text: &str) -> Result<Project, Vec<Diagnostic>> {
    fs::write(folder.join("project.toml"), text).expect("a temporary file");
    load(folder, &LoadOptions::default())
}

fn load_text(text: &str) -> Result<Project, Vec<Diagnostic>> {
    load_in(tempfile::tempdir().expect("a temporary folder").path(), text)
}

/// GOOD with one passage replaced.
fn good_but(old: &str, new: &str) -> String {
    assert!(GOOD.contains(old), "{old}");
    GOOD.replacen(old, new, 1)
}

#[test]
fn the_good_project_loads() {
    let project = load_text(GOOD).unwrap_or_else(|errors| panic!("{}", all(&errors)));
    assert_eq!(project.worlds.len(), 1);
    let world = &project.worlds[0];
    assert_eq!(world.rooms[0].name, "Office");
    assert_eq!(world.rooms[0].luminaires, [0, 1, 2, 3, 4, 5]);
    let reflectances = world.rooms[0].reflectances;
    for (found, given) in reflectances.iter().zip([0.7, 0.5, 0.2]) {
        assert!((found - given).abs() < 1e-12);
    }
    assert_eq!(world.viewpoints[0].directions.len(), 24);
    assert_eq!(project.light_scenes[0].name, "all");
    assert_eq!(project.accuracy.goal, Goal::Relative(0.005));
    assert_eq!(project.inputs.len(), 1);
    let first = world.scene.luminaires[0].position;
    assert!((first - DVec3::new(8.0 / 6.0, 1.25, 2.8)).length() < 1e-12);
    assert!((world.scene.luminaires[0].kind.flux_lm - 3600.0).abs() < 1e-6);
    let AreaShape::Surface { u, v, origin, .. } = world.areas[1].shape else {
        panic!("the board is a surface");
    };
    assert!((u.cross(v) - DVec3::new(0.0, -22.4, 0.0)).length() < 1e-9);
    assert!((origin.y - 5.0).abs() < 1e-9);
}

fn all(errors: &[Diagnostic]) -> String {
    let lines: Vec<String> = errors.iter().map(ToString::to_string).collect();
    lines.join("\n")
}

struct Bad {
    fault: &'static str,
    text: String,
    /// Expected (file ending, line, fragment of message or hint).
    expected: &'static [(&'static str, usize, &'static str)],
}

fn bad(
    fault: &'static str,
    old: &str,
    new: &str,
    expected: &'static [(&'static str, usize, &'static str)],
) -> Bad {
    Bad { fault, text: good_but(old, new), expected }
}

#[allow(clippy::too_many_lines)] // a table
fn bad_projects() -> Vec<Bad> {
    const P: &str = "project.toml";
    let scene = "box = { size = [8, 5, 2.8], floor = 0.2, walls = 0.5, ceiling = 0.7 }";
    let source = "lambert = { flux = 3600 }\narea = { rect = [1.2, 0.3] }";
    let field = "field = { rows = 2, columns = 3, height = 2.8 }";
    let desk = "rect = { origin = [1, 1, 0.75], u = [2, 0, 0], v = [0, 1, 0] }";
    vec![
        bad(
            "unknown key",
            "maintenance = 0.8",
            "maintenence = 0.8",
            &[(P, 10, "unknown key \"maintenence\""), (P, 10, "did you mean \"maintenance\"")],
        ),
        bad(
            "unknown section",
            "[[viewpoint]]",
            "[[viewpoints]]",
            &[(P, 25, "unknown section"), (P, 25, "did you mean \"viewpoint\"")],
        ),
        bad(
            "two unknown keys in one table",
            "maintenance = 0.8",
            "colour = 1\nweight = 2",
            &[(P, 10, "\"colour\""), (P, 11, "\"weight\"")],
        ),
        bad(
            "unknown key in an inline table",
            "walls = 0.5,",
            "walls = 0.5, wals = 0.5,",
            &[(P, 5, "did you mean \"walls\"")],
        ),
        bad("wrong type", "flux = 3600", "flux = \"much\"", &[(P, 8, "expected f64")]),
        bad("syntax", "maintenance = 0.8", "maintenance = = 0.8", &[(P, 10, "")]),
        bad("missing key", "eye = [4, 1, 1.2]\n", "", &[(P, 25, "\"eye\" is missing")]),
        bad("missing file", source, "file = \"none.ldt\"", &[(P, 8, "cannot read \"none.ldt\"")]),
        bad("missing scene", scene, "file = \"none.glb\"", &[(P, 5, "none.glb")]),
        bad(
            "outside by ..",
            source,
            "file = \"../a.ldt\"",
            &[(P, 8, "outside the project's folder"), (P, 8, "--allow-outside")],
        ),
        bad("outside by an absolute path", source, "file = \"/etc/hostname\"", &[(P, 8, "--allow-outside")]),
        bad("negative reflectance", "floor = 0.2", "floor = -0.2", &[(P, 5, "0 … 1, found -0.2")]),
        bad("NaN reflectance", "floor = 0.2", "floor = nan", &[(P, 5, "found NaN")]),
        bad(
            "sum above 1",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.7, specular = 0.4 }\n[luminaires.A]",
            &[(P, 8, "exceed 1")],
        ),
        bad(
            "glossy without its reflectance",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.7, phong = 50 }\n[luminaires.A]",
            &[(P, 8, "without its reflectance"), (P, 8, "specular = 0.05")],
        ),
        bad(
            "specular without a lobe",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.7, specular = 0.1 }\n[luminaires.A]",
            &[(P, 8, "without the shape"), (P, 8, "phong = 60")],
        ),
        bad(
            "two lobes",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.5, specular = 0.1, phong = 60, ward = 0.1 }\n[luminaires.A]",
            &[(P, 8, "one glossy lobe")],
        ),
        bad(
            "exponent below 1",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.5, specular = 0.1, phong = 0.5 }\n[luminaires.A]",
            &[(P, 8, "1 … 1000000, found 0.5"), (P, 8, "diffuse")],
        ),
        bad(
            "exponent NaN",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.5, specular = 0.1, phong_paper = nan }\n[luminaires.A]",
            &[(P, 8, "found NaN")],
        ),
        bad(
            "exponent of a mirror",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.5, specular = 0.1, phong = 1e9 }\n[luminaires.A]",
            &[(P, 8, "mirror")],
        ),
        bad(
            "roughness 0",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.5, specular = 0.1, ward = 0.0 }\n[luminaires.A]",
            &[(P, 8, "0.001 … 1, found 0"), (P, 8, "mirror")],
        ),
        bad(
            "negative specular",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.5, specular = -0.1, ward = 0.1 }\n[luminaires.A]",
            &[(P, 8, "0 … 1, found -0.1")],
        ),
        bad(
            "glossy without a diffuse part",
            "[luminaires.A]",
            "[materials]\nFloor = { specular = 0.9, ward = 0.1 }\n[luminaires.A]",
            &[(P, 8, "diffuse part"), (P, 8, "bare metal")],
        ),
        bad(
            "glossy glass",
            "[luminaires.A]",
            "[materials]\nFloor = { glass = 0.9, specular = 0.1, ward = 0.1 }\n[luminaires.A]",
            &[(P, 8, "goes with `reflectance` only")],
        ),
        bad(
            "measured glass that gains light",
            "[luminaires.A]",
            "[materials]\nFloor = { glass = { angle = [0, 90], transmittance = [0.8, 0], reflectance = [0.3, 1] } }\n[luminaires.A]",
            &[(P, 8, "no more than 1, found 0.8 and 0.3"), (P, 8, "glass = 0.88")],
        ),
        bad(
            "measured glass with a hole",
            "[luminaires.A]",
            "[materials]\nFloor = { glass = { angle = [0, 90], transmittance = [0.8], reflectance = [0.1, 1] } }\n[luminaires.A]",
            &[(P, 8, "2 angles, 1 transmittances, 2 reflectances")],
        ),
        bad(
            "glossy emitter",
            "[luminaires.A]",
            "[materials]\nFloor = { reflectance = 0.5, emit = 10, specular = 0.1, ward = 0.1 }\n[luminaires.A]",
            &[(P, 8, "goes with `reflectance` only")],
        ),
        bad(
            "opal sum",
            "[luminaires.A]",
            "[materials]\nFloor = { opal = { reflectance = 0.7, transmittance = 0.4 } }\n[luminaires.A]",
            &[(P, 8, "exceed 1")],
        ),
        bad(
            "unused material",
            "[luminaires.A]",
            "[materials]\nFlor = { reflectance = 0.7 }\n[luminaires.A]",
            &[(P, 8, "no such material"), (P, 8, "\"Floor\"")],
        ),
        bad(
            "no absorption",
            scene,
            "box = { size = [8, 5, 2.8], floor = 1, walls = 1, ceiling = 1 }",
            &[(P, 5, "reflects all light")],
        ),
        bad("surface without data", ", ceiling = 0.7", "", &[(P, 5, "Ceiling has no photometric data")]),
        bad("no size", "size = [8, 5, 2.8]", "size = [8, 0, 2.8]", &[(P, 5, "greater than 0")]),
        bad(
            "zero-size area",
            desk,
            "rect = { origin = [1, 1, 0.75], u = [0, 0, 0], v = [0, 1, 0] }",
            &[(P, 18, "no size")],
        ),
        bad(
            "area outside",
            desk,
            "rect = { origin = [11, 1, 0.75], u = [2, 0, 0], v = [0, 1, 0] }",
            &[(P, 18, "\"Desk\" lies outside")],
        ),
        bad(
            "area half outside",
            desk,
            "rect = { origin = [7, 1, 0.75], u = [2, 0, 0], v = [0, 1, 0] }",
            &[(P, 18, "reaches outside")],
        ),
        bad(
            "oblique area",
            desk,
            "rect = { origin = [1, 1, 0.75], u = [2, 0, 0], v = [1, 1, 0] }",
            &[(P, 18, "right angles")],
        ),
        bad("two shapes", desk, "surface = \"Floor\"\npoints = \"p.csv\"", &[(P, 16, "exactly one of")]),
        bad(
            "unknown surface",
            "surface = \"Wall_N\"",
            "surface = \"Wall_Q\"",
            &[(P, 23, "no surface \"Wall_Q\"")],
        ),
        bad(
            "no task",
            "kind = \"surface\"",
            "kind = \"surrounding\"\nof = \"Dask\"",
            &[(P, 23, "did you mean \"Desk\"")],
        ),
        bad(
            "unknown quantity",
            desk,
            "rect = { origin = [1, 1, 0.75], u = [2, 0, 0], v = [0, 1, 0] }\nquantities = [\"E_x\"]",
            &[(P, 19, "unknown quantity")],
        ),
        bad("unknown luminaire", "luminaire = \"A\"", "luminaire = \"B\"", &[(P, 13, "no luminaire \"B\"")]),
        bad("lambert without area", "area = { rect = [1.2, 0.3] }\n", "", &[(P, 8, "needs an `area`")]),
        bad(
            "two sources",
            "lambert = { flux = 3600 }",
            "lambert = { flux = 3600 }\npoint = { flux = 1 }",
            &[(P, 7, "exactly one of")],
        ),
        bad("luminaire outside", field, "at = [9, 1, 2]", &[(P, 12, "outside of every room")]),
        bad(
            "aim and target",
            field,
            "at = [4, 1, 2]\naim = [0, 0, -1]\ntarget = [0, 0, 0]",
            &[(P, 16, "either `aim` or `target`")],
        ),
        bad(
            "array mismatch",
            field,
            "array = { from = [1, 1, 2], step = [1, 0, 0], count = [3, 2] }",
            &[(P, 14, "1 steps for 2 counts")],
        ),
        bad(
            "absurd array",
            field,
            "array = { from = [1, 1, 2], step = [0, 0, 0], count = 4000000000 }",
            &[(P, 14, "an array places")],
        ),
        bad("dim", field, "at = [4, 1, 2]\ndim = 1.5", &[(P, 15, "dim must lie in 0 … 1")]),
        bad(
            "unknown group",
            "[[area]]",
            "[light_scenes]\nfull = { B = 1.0 }\n[[area]]",
            &[(P, 17, "no luminaire group \"B\"")],
        ),
        bad(
            "unknown light scene",
            desk,
            "rect = { origin = [1, 1, 0.75], u = [2, 0, 0], v = [0, 1, 0] }\nlight_scene = \"dusk\"",
            &[(P, 19, "no light scene \"dusk\"")],
        ),
        bad(
            "unknown standard",
            "[[area]]",
            "[norm]\nstandard = \"en-12464-1-2022\"\n[[area]]",
            &[(P, 17, "did you mean \"en-12464-1-2021\"")],
        ),
        bad(
            "unknown row",
            "[[area]]",
            "[norm]\nstandard = \"en-12464-1-2021\"\nrow = \"99.9\"\n[[area]]",
            &[(P, 18, "no row \"99.9\"")],
        ),
        bad("row without norm", "kind = \"surface\"", "row = \"34.2\"", &[(P, 22, "a row needs a norm")]),
        bad(
            "requirement of nothing",
            "[[area]]",
            "[[require]]\narea = \"Dsk\"\nquantity = \"E_h\"\nmin = 500\n[[area]]",
            &[(P, 17, "did you mean \"Desk\"")],
        ),
        bad(
            "requirement without limit",
            "[[area]]",
            "[[require]]\narea = \"Desk\"\nquantity = \"E_h\"\n[[area]]",
            &[(P, 16, "`min` or `max`")],
        ),
        bad(
            "viewpoint outside",
            "eye = [4, 1, 1.2]",
            "eye = [4, 1, 3.2]",
            &[(P, 26, "outside of every room")],
        ),
        bad("endless sweep", "step = 15", "step = 0", &[(P, 28, "a sweep runs upwards")]),
        bad(
            "bow-tie",
            scene,
            "[[room]]\nname = \"R\"\nfootprint = [[0, 0], [1, 1], [1, 0], [0, 1]]\nheight = 3\n[project.x]",
            &[(P, 7, "intersects itself")],
        ),
        bad(
            "NaN footprint",
            "[luminaires.A]",
            "[[room]]\nname = \"R\"\nfootprint = [[0, 0], [nan, 1], [1, 0]]\nheight = 3\n[luminaires.A]",
            &[(P, 9, "finite")],
        ),
        bad(
            "opening beyond its wall",
            "[luminaires.A]",
            "[[room]]\nname = \"R\"\nopenings = [{ wall = \"Wall_S\", from = [7, 1], to = [9, 2], material = \"Glass\" }]\n[materials]\nGlass = { glass = 0.8 }\n[luminaires.A]",
            &[(P, 9, "within the wall")],
        ),
        bad(
            "language",
            "name = \"Office\"",
            "name = \"Office\"\nlanguage = [\"de\"]",
            &[(P, 3, "no report language")],
        ),
        bad(
            "goal",
            "[[area]]",
            "[accuracy]\ngoal = { relative = 2 }\n[[area]]",
            &[(P, 17, "between 0 and 1")],
        ),
        bad("time", "[[area]]", "[accuracy]\ngoal = { time = \"soon\" }\n[[area]]", &[(P, 17, "30s")]),
        Bad { fault: "empty project", text: String::new(), expected: &[(P, 1, "no scene and no room")] },
        Bad {
            fault: "several mistakes at once",
            text: good_but("floor = 0.2", "floor = 2")
                .replace("luminaire = \"A\"", "luminaire = \"C\"")
                .replace("eye = [4, 1, 1.2]", "eye = [40, 1, 1.2]")
                .replace("kind = \"surface\"", "kind = \"surfac\"")
                .replace("maintenance", "maintain"),
            expected: &[
                (P, 5, "found 2"),
                (P, 10, "\"maintain\""),
                (P, 13, "no luminaire \"C\""),
                (P, 22, "unknown value \"surfac\""),
                (P, 26, "outside of every room"),
            ],
        },
    ]
}

#[test]
fn every_mistake_is_reported_in_its_place() {
    let mut failures = String::new();
    for case in bad_projects() {
        let Err(errors) = load_text(&case.text) else {
            writeln!(failures, "== {}: loaded", case.fault).unwrap();
            continue;
        };
        for (file, line, fragment) in case.expected {
            let hit = errors.iter().any(|error| {
                error.file.ends_with(file) && error.line == *line && error.to_string().contains(fragment)
            });
            if !hit {
                writeln!(failures, "== {}: no {file}:{line} \"{fragment}\" in\n{}", case.fault, all(&errors))
                    .unwrap();
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

#[test]
fn broken_files_beside_the_project_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let falling = "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 3 1 1 2 0.5 0.5 0\n1 1 100\n0 60 30\n0\n100 50 0\n";
    let node = |extra: &str| {
        format!(r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],{extra}}}"#)
    };
    let triangle = |buffer: &str, count: u32| {
        node(&format!(
            r#""nodes":[{{"mesh":0,"name":"N"}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{count}}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":"{buffer}"}}]"#
        ))
    };
    let floats = |values: [f32; 9]| -> Vec<u8> { values.into_iter().flat_map(f32::to_le_bytes).collect() };
    let good = floats([0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    let flat = floats([0., 0., 0., 1., 0., 0., 2., 0., 0.]);
    let wild = floats([0., 0., 0., f32::INFINITY, 0., 0., 0., 1., 0.]);
    fs::write(folder.path().join("t.bin"), good).unwrap();
    fs::write(folder.path().join("flat.bin"), flat).unwrap();
    fs::write(folder.path().join("wild.bin"), wild).unwrap();
    let cases: Vec<(&str, Vec<u8>, &str)> = vec![
        ("falling.ies", falling.into(), ""),
        ("empty.ldt", Vec::new(), "empty"),
        ("garbage.ldt", vec![0, 159, 146, 150, 0, 255], ""),
        ("empty.gltf", Vec::new(), "not a glTF"),
        (
            "garbage.glb",
            b"glTF\x02\0\0\0\xff\xff\xff\xff".to_vec(),
            "announces",
        ),
        (
            "cycle.gltf",
            node(r#""nodes":[{"name":"A","children":[1]},{"name":"B","children":[0]}]"#).into(),
            "\"A\" is a root of the scene and a child of node \"B\"",
        ),
        (
            "loop.gltf",
            node(r#""nodes":[{"name":"A","children":[1]},{"name":"B","children":[2]},{"name":"C","children":[1]}]"#).into(),
            "\"B\" is reached twice",
        ),
        (
            "nothing.gltf",
            node(r#""nodes":[{"name":"A"}]"#).into(),
            "no triangles",
        ),
        ("past.gltf", triangle("t.bin", 4).into(), "run past"),
        (
            "absurd.gltf",
            triangle("t.bin", 4_000_000_000).into(),
            "run past",
        ),
        ("percent.gltf", triangle("%zz.bin", 3).into(), "hexadecimal"),
        (
            "climb.gltf",
            triangle("../t.bin", 3).into(),
            "--allow-outside",
        ),
        (
            "climb2.gltf",
            triangle("%2e%2e/t.bin", 3).into(),
            "--allow-outside",
        ),
        ("lost.gltf", triangle("lost.bin", 3).into(), "lost.bin"),
        (
            "wild.gltf",
            triangle("wild.bin", 3).into(),
            "\"N\" is not finite",
        ),
        ("flat.gltf", triangle("flat.bin", 3).into(), "no triangles"),
        (
            "bare.gltf",
            triangle("t.bin", 3).into(),
            "material \"default\" of bare.gltf has no photometric data",
        ),
    ];
    for (name, bytes, fragment) in cases {
        fs::write(folder.path().join(name), &bytes).unwrap();
        let is_scene = Path::new(name).extension().is_some_and(|e| e == "gltf" || e == "glb");
        let text = if is_scene {
            format!("[scene]\nfile = \"{name}\"\n")
        } else {
            good_but("lambert = { flux = 3600 }", &format!("file = \"{name}\""))
        };
        let Err(errors) = load_in(folder.path(), &text) else {
            panic!("{name} must be refused");
        };
        let hit = errors.iter().any(|error| {
            let place = if is_scene { "project.toml" } else { name };
            error.file.ends_with(place) && error.line > 0 && error.to_string().contains(fragment)
        });
        assert!(hit, "{name}: {}", all(&errors));
    }
}

#[test]
fn a_material_in_the_project_completes_a_file_and_wins_over_it() {
    let folder = tempfile::tempdir().unwrap();
    let floats: Vec<u8> =
        [0f32, 0., 0., 4., 0., 0., 0., 3., 1.].into_iter().flat_map(f32::to_le_bytes).collect();
    fs::write(folder.path().join("t.bin"), floats).unwrap();
    let file = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"name":"N"}],"materials":[{"name":"Paint","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1]}}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"t.bin"}]}"#;
    fs::write(folder.path().join("a.gltf"), file).unwrap();
    for (materials, expected) in [("", 0.5), ("[materials]\nPaint = { reflectance = 0.25 }", 0.25)] {
        let text = format!("[scene]\nfile = \"a.gltf\"\n{materials}\n");
        let project = load_in(folder.path(), &text).unwrap_or_else(|e| panic!("{}", all(&e)));
        let scene = &project.worlds[0].scene;
        assert_eq!(scene.materials[0].bsdf, Bsdf::Lambert { reflectance: expected });
        // Y up became Z up: the file's third coordinate is −y of the project.
        assert!((scene.mesh.positions[2] - DVec3::new(0.0, -1.0, 3.0)).length() < 1e-6);
        assert_eq!(project.inputs.len(), 3);
    }
}

#[cfg(unix)]
#[test]
fn a_symbolic_link_does_not_lead_outside() {
    let outer = tempfile::tempdir().unwrap();
    fs::write(outer.path().join("secret.ldt"), "x").unwrap();
    let inner = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(outer.path().join("secret.ldt"), inner.path().join("a.ldt")).unwrap();
    let text = good_but("lambert = { flux = 3600 }", "file = \"a.ldt\"");
    let errors = load_in(inner.path(), &text).unwrap_err();
    assert!(errors[0].to_string().contains("--allow-outside"), "{}", all(&errors));
    let allowed =
        load(inner.path(), &LoadOptions { allow_outside: true, ..LoadOptions::default() }).unwrap_err();
    assert!(!all(&allowed).contains("--allow-outside"), "{}", all(&allowed));
}

#[test]
fn footprint_rooms_openings_furniture_lists_and_maintenance_come_together() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("places.csv"),
        "luminaire,x,y,z,dim,group\nA,1,1,2.5,0.5,north\nA,11,1,2.5,,\n",
    )
    .unwrap();
    fs::write(folder.path().join("views.csv"), "name,x,y,z,azimuth\nSeat,1,1,1.2,90\n").unwrap();
    let text = r#"
[project]
date = 2026-01-31
[[room]]
name = "L"
footprint = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]
height = 3
reflectances = { floor = 0.2, walls = 0.5, ceiling = "Sky" }
openings = [{ wall = "Wall_1", from = [1, 1], to = [3, 2], material = "Glass" }]
mf = { llmf = 0.9, rsmf = 0.95 }
[[room]]
name = "Box"
footprint = [[10, 0], [10, 3], [14, 3], [14, 0]]
height = 3
reflectances = { floor = 0.2, walls = 0.5, ceiling = 0.7 }
[materials]
Glass = { glass = 0.88 }
Sky = { emit = 2000, reflectance = 0.8 }
Wood = { reflectance = 0.4 }
[[furniture]]
at = [1, 1, 0]
size = [1, 0.5, 0.7]
material = "Wood"
rotate = 30
[luminaires.A]
point = { flux = 1000 }
[lists]
places = "places.csv"
viewpoints = "views.csv"
[light_scenes]
full = { north = 1.0, A = 1.0, Sky = 1.0 }
[[area]]
name = "West"
surface = "Wall_W"
[[camera]]
name = "c"
eye = [1, 1, 1]
target = [2, 1, 1]
fisheye = "hemispherical"
size = [10, 10]
"#;
    let project = load_in(folder.path(), text).unwrap_or_else(|e| panic!("{}", all(&e)));
    assert_eq!(project.worlds.len(), 2);
    assert_eq!(project.info.date, "2026-01-31");
    let [first, second] = &project.worlds[..] else { panic!() };
    assert_eq!(first.scene.luminaires[0].kind.name, "A");
    assert!((first.scene.luminaires[0].kind.maintenance.factor() - 0.9).abs() < 1e-12);
    assert_eq!(second.scene.luminaires[0].kind.name, "A (Box)");
    assert!((first.rooms[0].rsmf - 0.95).abs() < 1e-12);
    let furniture = first.scene.mesh.surfaces.iter().filter(|s| s.furniture).count();
    assert_eq!(furniture, 1);
    assert_eq!(first.scene.channels.len(), 2);
    assert_eq!(second.areas[0].name, "West");
    let cameras: Vec<_> = project.worlds.iter().flat_map(|world| &world.cameras).collect();
    assert_eq!((cameras[0].name.as_str(), cameras[0].size, cameras.len()), ("c", [10, 10], 1));
    assert_eq!(cameras[0].view.forward(), glam::DVec3::X);
    assert_eq!(project.inputs.len(), 3);

    fs::write(folder.path().join("places.csv"), "luminaire,x,y,z\nA,1,1,2.5\nA,1,one,2.5\n").unwrap();
    let errors = load_in(folder.path(), text).unwrap_err();
    assert!(errors.iter().any(|e| e.file == "places.csv" && e.line == 3), "{}", all(&errors));
}

#[test]
fn flipped_bytes_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = GOOD.as_bytes();
    for at in 0..bytes.len() {
        for flip in [0x01, 0x10, 0x80] {
            let mut damaged = bytes.to_vec();
            damaged[at] ^= flip;
            fs::write(folder.path().join("project.toml"), &damaged).unwrap();
            if let Err(errors) = load(folder.path(), &LoadOptions::default()) {
                assert!(!errors.is_empty(), "a refusal without a reason");
                let _ = all(&errors);
            }
        }
    }
}

#[test]
fn the_shell_of_a_cad_room_is_told_from_its_furniture() {
    let data = std::env::var_os("GERSHUN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data"), Into::into);
    let Ok(bytes) = fs::read(data.join("geometry/gltf/bevy/CornellBox.glb")) else {
        println!("skipped: no data folder");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cornell.glb"), bytes).unwrap();
    for room in ["", "[[room]]\nname = \"Box\"\nnode = \"cornell.box\"\n"] {
        let text = format!("[scene]\nfile = \"cornell.glb\"\n{room}");
        let project = load_in(folder.path(), &text).unwrap_or_else(|e| panic!("{}", all(&e)));
        let world = &project.worlds[0];
        let mesh = &world.scene.mesh;
        let furniture: Vec<&str> = mesh
            .surfaces
            .iter()
            .filter(|surface| surface.furniture)
            .map(|surface| surface.name.as_str())
            .collect();
        println!("{:?} {:?} {:?}", world.rooms[0], furniture, project.biases);
        assert!(furniture.contains(&"large.box") && furniture.contains(&"small.box"));
        assert!(!furniture.contains(&"cornell.box.cbox.Material.002"));
        // Y = 0.4 with a written roughness: 0.96 Y diffuse and a lobe of 0.04 less what facets hide.
        for part in [0, 2] {
            let reflectance = world.rooms[0].reflectances[part];
            assert!((0.414..0.424).contains(&reflectance), "{reflectance}");
        }
    }
}

#[test]
fn one_mistake_does_not_raise_false_alarms() {
    let requirement = "\n[[require]]\narea = \"Desk\"\nquantity = \"E_h\"\nmin = 500\n";
    for (old, new) in [
        ("size = [8, 5, 2.8]", "size = [8, 5]"),
        ("box = {", "file = \"none.glb\" #"),
        ("u = [2, 0, 0]", "u = [0, 0, 0]"),
        ("lambert = { flux = 3600 }", "file = \"none.ldt\""),
        // What could not be read at all is not missing where it is referred to.
        ("maintenance = 0.8", "maintenance = \"good\""),
        ("name = \"Desk\"\nrect", "name = \"Desk\"\nborder = \"wide\"\nrect"),
        ("name = \"Desk\"\nrect", "nmae = \"Desk\"\nrect"),
        ("eye = [4, 1, 1.2]", "eye = [4, 1]"),
        ("[scene]", "[materials]\nFloor = 0.3\n[scene]"),
        // A misspelt key explains why the right one is not there.
        ("lambert = {", "lambret = {"),
        ("field = {", "feild = {"),
        ("rect = { origin", "rekt = { origin"),
        ("[scene]", "[materials]\nFloor = { reflectanse = 0.3 }\n[scene]"),
        ("sweep = {", "swep = {"),
        // Nothing is known of a file that is not TOML.
        ("luminaire = \"A\"", "luminaire = \"A"),
        ("[scene]", "[norm]\nstandard = 12464\n[[room]]\nname = \"R\"\nrow = \"34.2\"\n[scene]"),
    ] {
        let requirement = requirement.to_owned()
            + "[[require]]\nviewpoint = \"Seat\"\nquantity = \"UGR\"\nmax = 19\n[declared]\nA = { ra = 80 }\n"
            + "[light_scenes]\nday = { A = 1 }\n"
            + "[[area]]\nname = \"Round\"\nkind = \"surrounding\"\nof = \"Desk\"\n"
            + "rect = { origin = [0, 0, 0.75], u = [4, 0, 0], v = [0, 3, 0] }\n";
        let errors = load_text(&(good_but(old, new) + &requirement)).unwrap_err();
        assert_eq!(errors.len(), 1, "{}", all(&errors));
        println!("{}\n", errors[0]);
    }
}

#[test]
fn a_requirement_is_judged_like_the_norm_by_the_scene_and_the_table_of_its_subject() {
    let text = good_but("name = \"Seat\"", "name = \"Seat\"\nlight_scene = \"late\"")
        + "\n[light_scenes]\nday = { A = 1 }\nlate = { A = 0.5 }\n"
        + "[[require]]\nviewpoint = \"Seat\"\nquantity = \"UGR\"\nmax = 19\n"
        + "[[require]]\nviewpoint = \"Seat\"\nquantity = \"UGR\"\nmax = 19\nlight_scene = \"day\"\n"
        + "[[require]]\nroom = \"Office\"\nquantity = \"UGR\"\nmax = 19\n";
    let with_norm = text.clone() + "[norm]\nstandard = \"en-12464-1-2021\"\nrow = \"34.2\"\n";
    for text in [text, with_norm] {
        let project = load_text(&text).unwrap_or_else(|e| panic!("{}", all(&e)));
        let plan = gershun::plan::plan(&project, &project.worlds[0]).unwrap();
        let required = &plan.rooms[0].requirements;
        let own: Vec<_> = required.iter().filter(|r| r.standard == "project").collect();
        assert_eq!(own.iter().map(|r| r.light_scene).collect::<Vec<_>>(), [1, 0, 0]);
        for table in required.iter().filter(|r| r.quantity == Quantity::Ugr && r.subject_name == "Office") {
            assert!(matches!(table.subject, Subject::UgrTable(0.25)), "{table:?}");
        }
    }
}

#[test]
fn what_no_value_could_ever_decide_is_a_mistake_and_not_left_unassessed() {
    for (requirement, message) in [
        ("room = \"Office\"\nquantity = \"E_h\"", "E_h is no quantity of a room"),
        ("area = \"Desk\"\nquantity = \"UGR\"", "UGR is no quantity of an area"),
        ("viewpoint = \"Seat\"\nquantity = \"E_cyl\"", "E_cyl is no quantity of a viewpoint"),
        ("area = \"Desk\"\nquantity = \"E_h\"\nstatistic = \"value\"", "no statistic \"value\" of E_h"),
        ("viewpoint = \"Seat\"\nquantity = \"UGR\"\nstatistic = \"mean\"", "no statistic \"mean\" of UGR"),
    ] {
        let text = format!("{GOOD}\n[[require]]\n{requirement}\nmin = 1\n");
        let errors = load_text(&text).unwrap_err();
        assert_eq!(errors.len(), 1, "{}", all(&errors));
        assert!(errors[0].message.contains(message) && errors[0].line > 0, "{}", errors[0]);
    }
}

#[test]
fn walls_that_the_norm_asks_for_are_called_like_their_surfaces() {
    let walls = |room: &str| -> Vec<String> {
        let text = format!("{room}\n[norm]\nstandard = \"en-12464-1-2021\"\nrow = \"34.2\"\n");
        let project = load_text(&text).unwrap_or_else(|e| panic!("{}", all(&e)));
        let plan = gershun::plan::plan(&project, &project.worlds[0]).unwrap();
        let names = plan.rooms[0].areas.iter().map(|area| area.name.clone());
        names.filter(|name| name.to_lowercase().contains("wall")).collect()
    };
    let rest = "reflectances = { floor = 0.2, walls = 0.5, ceiling = 0.7 }";
    // Clockwise, from the north-east: names follow the compass, not the order of writing.
    let hall = format!(
        "[materials]\nWin = {{ glass = 0.9 }}\n[[room]]\nname = \"Hall\"\nheight = 3\n{rest}\n\
         footprint = [[6, 4], [6, 0], [0, 0], [0, 4]]\n\
         openings = [{{ wall = \"Wall_S\", from = [1, 1], to = [3, 2], material = \"Win\" }}]"
    );
    let mut found = walls(&hall);
    found.sort();
    assert_eq!(found, ["Hall · Wall_E", "Hall · Wall_N", "Hall · Wall_S", "Hall · Wall_W"]);
    let corner = format!(
        "[[room]]\nname = \"L\"\nheight = 3\n{rest}\n\
         footprint = [[0, 0], [8, 0], [8, 4], [4, 4], [4, 8], [0, 8]]"
    );
    let expected: Vec<String> = (1..=6).map(|number| format!("L · Wall_{number}")).collect();
    assert_eq!(walls(&corner), expected);
}

/// Catches: a camera that would divide by zero or exhaust memory later, or a mistake without its place.
#[test]
fn cameras_are_checked() {
    let folder = tempfile::tempdir().expect("tempdir");
    let with = |camera: &str| {
        let shell = "size = [4, 4, 3], floor = 0.2, walls = 0.5, ceiling = 0.7";
        let text = format!("[scene]\nbox = {{ {shell} }}\n[[camera]]\nname = \"c\"\n{camera}\n");
        load_in(folder.path(), &text)
    };
    let good =
        with("eye = [1, 1, 1]\ndirection = [0, 0, -1]\nfov = 90\nsize = [200, 100]").expect("a camera");
    let camera = &good.worlds[0].cameras[0];
    assert_eq!(camera.view.up(), glam::DVec3::Y);
    let gershun::image::Projection::Perspective { horizontal_deg, vertical_deg } = camera.view.projection
    else {
        panic!("{:?}", camera.view.projection)
    };
    // Square pixels: half the width is half the tangent.
    assert!((horizontal_deg - 90.0).abs() < 1e-12 && (vertical_deg - 53.130_102_354).abs() < 1e-6);
    for (camera, message) in [
        ("eye = [1, 1, 1]", "looks nowhere"),
        ("eye = [1, 1, 1]\ndirection = [1, 0, 0]\ntarget = [2, 2, 2]", "either"),
        ("eye = [1, 1, 1]\ndirection = [0, 0, 0]", "do not make a view"),
        ("eye = [1, 1, 1]\ndirection = [1, 0, 0]\nup = [1, 0, 0]", "do not make a view"),
        ("eye = [1, 1, 1]\ndirection = [1, 0, 0]\nfov = 180", "180"),
        ("eye = [1, 1, 1]\ndirection = [1, 0, 0]\nsize = [20000, 20000]", "pixels"),
        ("eye = [1, 1, 1]\ndirection = [1, 0, 0]\nsize = [0, 10]", "pixels"),
        ("eye = [9, 1, 1]\ndirection = [1, 0, 0]", "outside of every room"),
        ("eye = [1, 1, 1]\ndirection = [1, 0, 0]\nfisheye = \"square\"", "square"),
    ] {
        let errors = with(camera).expect_err(camera);
        assert_eq!(errors.len(), 1, "{}", all(&errors));
        assert!(all(&errors).contains(message), "{camera}: {}", all(&errors));
    }
}

/// Catches: an eye in a cupboard or in a wall that reads darkness as its answer, a mistake in a list without its line.
#[test]
fn an_eye_inside_furniture_or_a_wall_is_refused_with_its_line() {
    let room = |eye: &str| {
        format!(
            "[scene]\nbox = {{ size = [4, 3, 2.5], floor = 0.2, walls = 0.5, ceiling = 0.7 }}\n\
             [materials]\nWood = {{ reflectance = 0.4 }}\n[luminaires.A]\npoint = {{ flux = 1000 }}\n\
             [[place]]\nluminaire = \"A\"\nat = [2, 1.5, 2.4]\n\
             [[furniture]]\nat = [1, 1, 0]\nsize = [1, 0.5, 1.8]\nmaterial = \"Wood\"\n{eye}"
        )
    };
    let seat =
        |eye: &str| room(&format!("[[viewpoint]]\nname = \"Seat\"\neye = {eye}\ndirection = [0, 1, 0]\n"));
    for (eye, what) in [
        ("[1.5, 1.2, 1.2]", "the eye of viewpoint \"Seat\" lies inside furniture"),
        ("[4.004, 1.2, 1.2]", "the eye of viewpoint \"Seat\" lies in a wall"),
        ("[3, 1.2, -0.003]", "the eye of viewpoint \"Seat\" lies in a wall, the floor"),
        ("[4, 1.2, 1.2]", "the eye of viewpoint \"Seat\" lies in a surface"),
        ("[1.5, 1.2, 1.8]", "the eye of viewpoint \"Seat\" lies in a surface"),
    ] {
        let text = seat(eye);
        let errors = load_text(&text).unwrap_err();
        assert_eq!(errors.len(), 1, "{}", all(&errors));
        let line = 1 + text.lines().position(|line| line.starts_with("eye")).expect("it is written");
        assert!(errors[0].line == line && errors[0].message.contains(what), "{}", errors[0]);
        assert!(errors[0].hint.contains("move the eye"), "{}", errors[0]);
    }
    // Beside and above it there is room.
    for eye in ["[1.5, 0.9, 1.2]", "[1.5, 1.2, 1.801]", "[3.999, 1.2, 1.2]"] {
        assert!(load_text(&seat(eye)).is_ok(), "{eye}");
    }
    let list = room("[lists]\nviewpoints = \"views.csv\"\n");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let rows = "name,x,y,z,azimuth,tilt\nFree,3,2,1.2,90,0\nShut,1.5,1.2,1.2,90,0\n";
    fs::write(folder.path().join("views.csv"), rows).expect("a temporary file");
    let errors = load_in(folder.path(), &list).unwrap_err();
    assert_eq!(
        (errors.len(), errors[0].file.as_str(), errors[0].line),
        (1, "views.csv", 3),
        "{}",
        all(&errors)
    );
}
