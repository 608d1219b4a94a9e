//! The contract with scripts, through the program itself: bad input ends with code 2, names file and
//! line on standard error, prints nothing on standard output and leaves the output folder alone.
//! Catches: a mistake that panics, is computed all the same, or is told without its place.

mod projects;

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Output};

use projects::{File, folder, gltf, shell, square};

const GOOD: &str = r#"[project]
name = "Office"

[scene]
box = { size = [4, 3, 2.5], floor = 0.2, walls = 0.5, ceiling = 0.7 }

[luminaires.A]
lambert = { flux = 3600 }
area = { rect = [1.2, 0.3] }

[[place]]
luminaire = "A"
at = [2, 1.5, 2.5]

[light_scenes]
full = { A = 1.0 }

[[area]]
name = "Desk"
rect = { origin = [1, 1, 0.75], u = [1, 0, 0], v = [0, 1, 0] }
grid = { count = [2, 2] }

[[viewpoint]]
name = "Seat"
eye = [1, 1, 1.2]
direction = [1, 0, 0]

[norm]
standard = "en-12464-1-2021"
row = "34.2"
"#;

fn gershun(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gershun")).args(arguments).output().expect("the program starts")
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// What is wrong with the way a project was refused; empty if nothing.
fn complaints(project: &str, files: &[File], place: &str, says: &str, more: &[&str]) -> String {
    let folder = folder(project, files);
    let out = folder.path().join("out");
    let mut arguments = vec!["check", "--blocks", "2", "--out", text(&out)];
    arguments.extend(more);
    arguments.push(text(folder.path()));
    let output = gershun(&arguments);
    let mut wrong = String::new();
    let told = errors(&output);
    let mut demand = |holds: bool, what: &str| {
        if !holds {
            writeln!(wrong, "   {what}").expect("a String takes everything");
        }
    };
    demand(output.status.code() == Some(2), &format!("exit code {:?}", output.status.code()));
    demand(output.stdout.is_empty(), "something on standard output");
    demand(!out.exists(), "something was written");
    demand(told.contains(place), &format!("\"{place}\" is not named"));
    demand(told.contains(says), &format!("\"{says}\" is not said"));
    demand(!told.contains("panicked"), "it panicked");
    if wrong.is_empty() { wrong } else { format!("{wrong}{told}\n") }
}

/// GOOD with a passage replaced; the mistake stands on the line that holds `at`.
struct Case {
    fault: &'static str,
    old: &'static str,
    new: &'static str,
    at: &'static str,
    says: &'static str,
}

const fn case(
    fault: &'static str,
    old: &'static str,
    new: &'static str,
    at: &'static str,
    says: &'static str,
) -> Case {
    Case { fault, old, new, at, says }
}

const DESK: &str = "origin = [1, 1, 0.75], u = [1, 0, 0]";

const CASES: &[Case] = &[
    case("unknown key", "flux = 3600", "fluxx = 3600", "fluxx", "did you mean \"flux\""),
    case("unknown section", "[light_scenes]", "[light_scene]", "[light_scene]", "unknown section"),
    case("syntax", "name = \"Desk\"", "name = Desk", "name = Desk", ""),
    case("missing luminaire file", "lambert = { flux = 3600 }", "file = \"no.ldt\"", "no.ldt", "cannot read"),
    case("absolute path", "lambert = { flux = 3600 }", "file = \"/etc/passwd\"", "passwd", "--allow-outside"),
    case("reflectance < 0", "floor = 0.2", "floor = -0.2", "-0.2", "0 … 1"),
    case("reflectance > 1", "walls = 0.5", "walls = 1.5", "1.5, ceiling", "0 … 1"),
    case("NaN", "floor = 0.2", "floor = nan", "nan", "NaN"),
    case("infinite size", "size = [4, 3", "size = [inf, 3", "inf", ""),
    case("NaN flux", "flux = 3600", "flux = nan", "nan", ""),
    case("NaN at", "at = [2, 1.5, 2.5]", "at = [nan, 1.5, 2.5]", "nan", "finite"),
    case(
        "sum > 1",
        "[luminaires.A]",
        "[materials]\nFloor = { opal = { reflectance = 0.7, transmittance = 0.4 } }\n[luminaires.A]",
        "opal",
        "exceed 1",
    ),
    case(
        "limit that is no number",
        "[norm]",
        "[[require]]\narea = \"Desk\"\nquantity = \"E_h\"\nmin = nan\n[norm]",
        "min = nan",
        "a limit must be a finite number",
    ),
    case("area without a name", "name = \"Desk\"", "name = \"\"", "name = \"\"", "name is empty"),
    case("viewpoint without a name", "name = \"Seat\"", "name = \" \"", "name = \" \"", "name is empty"),
    case(
        "room without a name",
        "[luminaires.A]",
        "[[room]]\nname = \"\"\n[luminaires.A]",
        "name = \"\"",
        "name is empty",
    ),
    case("factor in percent", "full = { A = 1.0 }", "full = { A = 60 }", "A = 60", "60 % is 0.6"),
    case("zero-size area", DESK, "origin = [1, 1, 0.75], u = [0, 0, 0]", "u = [0, 0, 0]", "no size"),
    case("NaN area", DESK, "origin = [1, 1, nan], u = [1, 0, 0]", "nan", "finite"),
    case("area outside", DESK, "origin = [9, 1, 0.75], u = [1, 0, 0]", "[9, 1", "outside"),
    case("area half outside", DESK, "origin = [3.5, 1, 0.75], u = [1, 0, 0]", "[3.5, 1", "outside"),
    case("surface without data", ", ceiling = 0.7", "", "box =", "no photometric data"),
    case("unknown luminaire", "luminaire = \"A\"", "luminaire = \"B\"", "\"B\"", "no luminaire \"B\""),
    case("unknown group", "full = { A = 1.0 }", "full = { row-9 = 1.0 }", "row-9", "row-9"),
    case("luminaire outside", "at = [2, 1.5, 2.5]", "at = [2, 9, 2.5]", "[[place]]", "outside of every room"),
    case("norm row", "row = \"34.2\"", "row = \"99.99\"", "99.99", "99.99"),
    case("unknown norm", "\"en-12464-1-2021\"", "\"en-12464-1-2020\"", "2020", "did you mean"),
    case("area's row", "name = \"Desk\"", "name = \"Desk\"\nrow = \"99.99\"", "99.99", "99.99"),
    case(
        "viewpoint inside nothing",
        "eye = [1, 1, 1.2]",
        "eye = [1, 1, 7]",
        "\"Seat\"",
        "outside of every room",
    ),
    case("looks nowhere", "direction = [1, 0, 0]", "direction = [0, 0, 0]", "direction", "no direction"),
    case(
        "reflectance 1 all round",
        "floor = 0.2, walls = 0.5, ceiling = 0.7",
        "floor = 1, walls = 1, ceiling = 1",
        "box =",
        "no finite solution",
    ),
    case(
        "points far away",
        "rect = { origin = [1, 1, 0.75], u = [1, 0, 0], v = [0, 1, 0] }\ngrid = { count = [2, 2] }",
        "points = \"none.csv\"",
        "none.csv",
        "cannot read",
    ),
];

#[test]
fn mistakes_in_the_project_are_refused_with_their_line() {
    let mut failures = String::new();
    for Case { fault, old, new, at, says } in CASES {
        assert!(GOOD.contains(old), "{fault}: {old}");
        let project = GOOD.replacen(old, new, 1);
        let line = project.lines().position(|line| line.contains(at)).expect("the line of the mistake") + 1;
        let wrong = complaints(&project, &[], &format!("project.toml:{line}:"), says, &[]);
        if !wrong.is_empty() {
            write!(failures, "== {fault}\n{wrong}").expect("a String takes everything");
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

/// A glTF text with one triangle of `count` vertices in `buffer`.
fn triangle(buffer: &str, count: u32) -> File {
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"name":"N"}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{count}}}],"bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":"{buffer}"}}]}}"#
    );
    ("scene.gltf".into(), text.into_bytes())
}

fn floats(values: [f32; 9]) -> File {
    ("t.bin".into(), values.into_iter().flat_map(f32::to_le_bytes).collect())
}

fn json(nodes: &str) -> File {
    let text =
        format!(r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}]}}"#);
    ("scene.gltf".into(), text.into_bytes())
}

#[test]
fn broken_scenes_are_refused_at_the_line_that_names_them() {
    let flat = || floats([0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    let cases: Vec<(&str, Vec<File>, &str)> = vec![
        ("missing file", vec![], "cannot read"),
        ("empty file", vec![("scene.gltf".into(), vec![])], "not a glTF"),
        ("garbage", vec![("scene.gltf".into(), vec![0, 159, 146, 150, 255, 7, 0, 0])], ""),
        ("half a glb", vec![("scene.gltf".into(), b"glTF\x02\0\0\0\xff\xff\xff\xff".to_vec())], ""),
        ("no triangles", vec![json(r#"{"name":"A"}"#)], "no triangles"),
        (
            "node cycle",
            vec![json(
                r#"{"name":"A","children":[1]},{"name":"B","children":[2]},{"name":"C","children":[1]}"#,
            )],
            "reached twice",
        ),
        ("own child", vec![json(r#"{"name":"A","children":[0]}"#)], "\"A\""),
        ("accessor past its buffer", vec![triangle("t.bin", 4), flat()], "run past"),
        ("absurd count", vec![triangle("t.bin", 4_294_967_295), flat()], "run past"),
        ("percent garbage", vec![triangle("%zz%", 3), flat()], "hexadecimal"),
        ("climbing URI", vec![triangle("%2e%2e/t.bin", 3), flat()], "--allow-outside"),
        ("short buffer", vec![triangle("t.bin", 3), ("t.bin".into(), vec![0; 8])], ""),
        (
            "infinite vertex",
            vec![triangle("t.bin", 3), floats([0., 0., 0., f32::INFINITY, 0., 0., 0., 1., 0.])],
            "not finite",
        ),
        (
            "NaN vertex",
            vec![triangle("t.bin", 3), floats([0., 0., 0., f32::NAN, 0., 0., 0., 1., 0.])],
            "not finite",
        ),
        (
            "degenerate",
            vec![triangle("t.bin", 3), floats([0., 0., 0., 1., 0., 0., 2., 0., 0.])],
            "no triangles",
        ),
        ("no photometric data", gltf(&shell([4.0, 3.0, 2.5])), "no photometric data"),
    ];
    let mut failures = String::new();
    for (fault, files, says) in cases {
        let project = "[project]\nname = \"P\"\n[scene]\nfile = \"scene.gltf\"\n";
        let wrong = complaints(project, &files, "project.toml:4:", says, &[]);
        if !wrong.is_empty() {
            write!(failures, "== {fault}\n{wrong}").expect("a String takes everything");
        }
    }
    // All materials known, but light could never be absorbed: the material's own line.
    let project = "[scene]\nfile = \"scene.gltf\"\n[materials]\nshell = { reflectance = 1 }\n";
    let wrong =
        complaints(project, &gltf(&shell([4.0, 3.0, 2.5])), "project.toml:4:", "no finite solution", &[]);
    assert!(failures.is_empty() && wrong.is_empty(), "{failures}{wrong}");
}

#[test]
fn broken_photometric_files_are_refused_at_their_own_line() {
    let ies = |gammas: &str, data: &str| {
        format!("IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0.5 0.5 0\n1 1 100\n{gammas}\n0\n{data}\n")
            .into_bytes()
    };
    let cases: Vec<(&str, &str, Vec<u8>, &str, &str)> = vec![
        ("falling angles", "a.ies", ies("0 60 30", "100 50 0"), "a.ies:5", "60"),
        ("negative candelas", "a.ies", ies("0 45 90", "100 -50 0"), "a.ies:7", ""),
        ("NaN candelas", "a.ies", ies("0 45 90", "100 nan 0"), "a.ies:7", ""),
        ("too few values", "a.ies", ies("0 45 90", "100 50"), "a.ies:", ""),
        ("no light", "a.ies", ies("0 45 90", "0 0 0"), "a.ies", ""),
        ("empty file", "a.ldt", vec![], "a.ldt", "empty"),
        ("garbage", "a.ldt", vec![0, 159, 146, 150, 0, 255, 10, 13, 0], "a.ldt", ""),
        ("only line ends", "a.ldt", vec![10; 200], "a.ldt", ""),
    ];
    let mut failures = String::new();
    for (fault, name, bytes, place, says) in cases {
        let project = GOOD.replacen("lambert = { flux = 3600 }", &format!("file = \"{name}\""), 1);
        let wrong = complaints(&project, &[(name.into(), bytes)], place, says, &[]);
        if !wrong.is_empty() {
            write!(failures, "== {fault}\n{wrong}").expect("a String takes everything");
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

/// Catches: a run of hours that cannot be written and says nothing, an output folder half replaced.
#[test]
fn an_output_folder_that_cannot_be_written_is_an_error() {
    let folder = folder(GOOD, &[("file".into(), vec![1])]);
    for out in ["file", "file/below"] {
        let out = folder.path().join(out);
        let output = gershun(&["check", "--blocks", "2", "--out", text(&out), text(folder.path())]);
        assert_eq!(output.status.code(), Some(2), "{out:?}: {}", errors(&output));
        assert!(output.stdout.is_empty(), "{out:?}: a result was printed that is not on disk");
        assert!(errors(&output).contains("file"), "{}", errors(&output));
        assert_eq!(std::fs::read(folder.path().join("file")).unwrap(), [1]);
    }
}

/// Catches: a bad argument taken for a default.
#[test]
fn bad_arguments_are_refused_before_anything_is_read() {
    let folder = folder(GOOD, &[]);
    let out = folder.path().join("out");
    let project = text(folder.path());
    let cases: &[(&[&str], &str)] = &[
        (&["--blocks", "1"], "--blocks"),
        (&["--blocks=-4"], "--blocks"),
        (&["--blocks", "many"], "--blocks"),
        (&["--time", "banana"], "banana"),
        (&["--time=-3s"], "-3s"),
        (&["--time", "5 parsecs"], "parsecs"),
        (&["--time", "nan"], "nan"),
        (&["--time", "0s"], "0s"),
        (&["--relative", "2"], "between 0 and 1"),
        (&["--relative", "nan"], "nan"),
        (&["--threads", "0"], "--threads"),
        (&["--memory=-1GiB"], "-1GiB"),
        (&["--format", "xml"], "xml"),
        (&["--method", "guess"], "guess"),
        (&["--frobnicate"], "--frobnicate"),
        (&[project], "--out takes one project"),
    ];
    for (arguments, says) in cases {
        let mut all = vec!["check", "--out", text(&out)];
        all.extend_from_slice(arguments);
        all.push(project);
        let output = gershun(&all);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", errors(&output));
        assert!(errors(&output).contains(says), "{arguments:?}: {}", errors(&output));
        assert!(output.stdout.is_empty() && !out.exists(), "{arguments:?}");
    }
    for arguments in
        [&["check"][..], &["frobnicate"], &["check", "/nowhere/at/all"], &["norm", "show", "none"]]
    {
        let output = gershun(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", errors(&output));
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    let output = gershun(&["new", project]);
    assert_eq!(output.status.code(), Some(2), "an existing folder is not overwritten");
}

/// Catches: a mistake found only by planning that ends in a panic or is told without its place.
#[test]
fn an_area_wholly_inside_furniture_is_refused() {
    let furniture = "[materials]\nWood = { reflectance = 0.4 }\n[[furniture]]\nat = [0.5, 0.5, 0]\nsize = [2, 2, 1]\nmaterial = \"Wood\"\n";
    let wrong = complaints(&(GOOD.to_owned() + furniture), &[], "project.toml:19:8", "inside furniture", &[]);
    assert!(wrong.is_empty(), "{wrong}");
    let border = GOOD.replace("grid = {", "border = 0.6\ngrid = {");
    let wrong = complaints(&border, &[], "project.toml:19:8", "leaves nothing", &[]);
    assert!(wrong.is_empty(), "{wrong}");
}

/// Catches: the first of several projects solved before the mistakes of the second are known.
#[test]
fn mistakes_of_all_projects_come_before_anything_is_solved() {
    let good = folder(GOOD, &[]);
    let bad = folder(&GOOD.replacen("walls", "wals", 1), &[]);
    let here = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_gershun"))
        .args(["check", "--blocks", "2", text(good.path()), text(bad.path())])
        .current_dir(here.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    assert_eq!(std::fs::read_dir(here.path()).unwrap().count(), 0, "something was written");
}

/// A closed grey box judged by one requirement on the mean of E_h, which is about 560 lx.
fn judged(requirement: &str) -> String {
    GOOD.split("[norm]").next().expect("the text before").to_owned()
        + "[[require]]\narea = \"Desk\"\nquantity = \"E_h\"\nstatistic = \"mean\"\n"
        + requirement
        + "\n"
}

fn verdict(requirement: &str, blocks: &str, format: &str) -> (Option<i32>, String, Vec<u8>) {
    let folder = folder(&judged(requirement), &[]);
    let out = folder.path().join("out");
    let output =
        gershun(&["check", "--blocks", blocks, "--format", format, "--out", text(&out), text(folder.path())]);
    let result = std::fs::read(out.join("result.json")).unwrap_or_default();
    (output.status.code(), String::from_utf8(output.stdout).expect("UTF-8"), result)
}

fn mean() -> f64 {
    let (_, _, result) = verdict("min = 1", "64", "json");
    let result: serde_json::Value = serde_json::from_slice(&result).expect("JSON");
    result["requirements"][0]["value"].as_f64().expect("a value")
}

/// Catches: codes swapped, an undecided verdict sold as compliance, formats that do not parse or that
/// tell another verdict than the code.
#[test]
fn exit_codes_and_formats_tell_the_verdict() {
    let mean = mean();
    let (pass, fail) = (format!("min = {}", 0.5 * mean), format!("min = {}", 2.0 * mean));
    // Two blocks have a Student quantile of dozens: 2 % is within the interval.
    let open = format!("min = {}", 1.02 * mean);
    let cases = [("pass", &pass, "64", 0), ("fail", &fail, "64", 1), ("undecided", &open, "2", 3)];
    for (name, requirement, blocks, code) in cases {
        let (found, json, result) = verdict(requirement, blocks, "json");
        assert_eq!(found, Some(code), "{name}: {json}");
        assert_eq!(json.as_bytes(), result, "--format json prints result.json");
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(json["verdict"], name);
        assert_eq!(json["requirements"][0]["outcome"], name);

        let (found, junit, _) = verdict(requirement, blocks, "junit");
        assert_eq!(found, Some(code));
        let document = roxmltree::Document::parse(&junit).unwrap();
        let count = |tag: &str| document.descendants().filter(|node| node.has_tag_name(tag)).count();
        assert_eq!(count("testcase"), 1);
        assert_eq!(count("failure"), usize::from(name == "fail"), "{junit}");
        assert_eq!(
            count("failure") + count("error") + count("skipped"),
            usize::from(name != "pass"),
            "{junit}"
        );

        let (found, sarif, _) = verdict(requirement, blocks, "sarif");
        assert_eq!(found, Some(code));
        let sarif: serde_json::Value = serde_json::from_str(&sarif).unwrap();
        assert_eq!(sarif["version"], "2.1.0");
        assert_eq!(sarif["runs"][0]["results"].as_array().unwrap().len(), usize::from(name != "pass"));

        let (found, table, _) = verdict(requirement, blocks, "human");
        assert_eq!(found, Some(code));
        assert!(table.contains("Desk"), "{table}");
    }
}

/// Catches: nothing required taken for failure, or passed over in silence.
#[test]
fn nothing_required_is_code_0_and_is_said() {
    let folder = folder(GOOD.split("[norm]").next().unwrap(), &[]);
    let out = folder.path().join("out");
    let output = gershun(&["check", "--blocks", "2", "--out", text(&out), text(folder.path())]);
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    let table = String::from_utf8(output.stdout).unwrap().to_lowercase();
    assert!(table.contains("nothing") || table.contains("no requirement"), "{table}");
}

/// Catches: a report written half, or a result that is printed and not the one on disk.
#[test]
fn the_report_is_whole_and_only_its_own_files_are_there() {
    let folder = folder(GOOD, &gltf(&[square("Sheet", "m", [0.0; 3], 1.0)]));
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("notes.txt"), "mine").unwrap();
    let output = gershun(&["check", "-q", "--blocks", "2", "--out", text(&out), text(folder.path())]);
    assert!(output.stdout.is_empty() && output.stderr.is_empty(), "quiet is quiet: {}", errors(&output));
    assert_eq!(std::fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("provenance.json")).unwrap()).unwrap();
    let files = manifest["files"].as_array().unwrap();
    assert!(files.len() >= 5, "{manifest}");
    for file in files {
        assert!(out.join(file["path"].as_str().unwrap()).is_file(), "{file}");
    }
    let beside: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(beside.len(), 4, "project, scene, buffer, out: {beside:?}");
}

/// Catches: names of the code instead of the words the files use, a norm without its short name.
#[test]
fn norms_are_shown_in_the_words_of_their_files() {
    let shown = gershun(&["norm", "show", "en-12464-1-2021", "34.2"]);
    let table = String::from_utf8(shown.stdout).unwrap();
    assert!(table.starts_with("EN 12464-1:2021: "), "{table}");
    for word in ["two-sources", "one-source", "cylindrical", "surrounding"] {
        assert!(table.contains(word), "{word}: {table}");
    }
    // Of the newer edition no limit of this row is unverified.
    let older = String::from_utf8(gershun(&["norm", "show", "en-12464-1-2011", "5.26.2"]).stdout).unwrap();
    assert!(older.lines().any(|line| line.ends_with(" unverified")), "{older}");
    assert!(!table.contains("TwoSources") && !table.contains("Unverified"), "{table}");
    let list = String::from_utf8(gershun(&["norm", "list"]).stdout).unwrap();
    assert!(list.contains("en-12464-1-2021") && list.contains("EN 12464-1:2021"), "{list}");
}

/// Catches: a command that tells a project's mistakes in words of its own, or leaves something behind.
#[test]
fn every_command_refuses_a_wrong_project_in_the_same_words() {
    let folder = folder(&GOOD.replace("34.2", "34.22"), &[]);
    let out = folder.path().join("out");
    let told = |command: &[&str]| {
        let arguments = [command, &["--out", text(&out), text(folder.path())]].concat();
        let output = gershun(&arguments);
        assert_eq!(output.status.code(), Some(2), "{command:?}");
        assert!(output.stdout.is_empty() && !out.exists(), "{command:?} wrote something");
        errors(&output)
    };
    let checked = told(&["check"]);
    assert!(checked.contains("project.toml:30") && !checked.contains("error: error"), "{checked}");
    for command in [&["view"][..], &["solve"], &["body"], &["glare"]] {
        assert_eq!(told(command), checked, "{command:?}");
    }
    let far_field = gershun(&["lamp", "far-field", text(folder.path())]);
    assert_eq!((far_field.status.code(), errors(&far_field)), (Some(2), checked));
}

/// Catches: `--quiet` that is taken and not heeded; errors that it swallows.
#[test]
fn quiet_commands_say_nothing_but_errors() {
    let folder = folder(GOOD, &[]);
    let out = folder.path().join("out");
    let project = text(folder.path());
    for command in
        [&["check", "--blocks", "2", "--undecided", "pass"][..], &["solve"], &["glare", "--blocks", "2"]]
    {
        let loud = gershun(&[command, &["--out", text(&out), project]].concat());
        let quiet = gershun(&[command, &["-q", "--out", text(&out), project]].concat());
        assert_eq!(quiet.status.code(), loud.status.code(), "{command:?}");
        assert!(!loud.stdout.is_empty(), "{command:?} has nothing to be quiet about");
        assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty(), "{command:?}: {}", errors(&quiet));
    }
    let missing = gershun(&["glare", "-q", "--image", "no such.hdr"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(errors(&missing).contains("no such.hdr"));
}
