//! Same input, seed and number of blocks: the same bytes in every file, on any number of threads and
//! any SIMD level, whatever made the run stop. Catches: a sum over threads in order of arrival, a
//! clock or thread count in a file, a hit that depends on the order of visits, intervals that depend
//! on why a run ended.

mod projects;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

type Files = BTreeMap<PathBuf, Vec<u8>>;

fn collect(folder: &Path, root: &Path, files: &mut Files) {
    for entry in std::fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(&path, root, files);
        } else {
            let name = path.strip_prefix(root).expect("below the root").to_owned();
            files.insert(name, std::fs::read(&path).expect("a readable file"));
        }
    }
}

/// All files that `check` writes.
fn report(project: &Path, arguments: &[&str]) -> Files {
    let out = tempfile::tempdir().expect("a temporary folder");
    let output = Command::new(env!("CARGO_BIN_EXE_gershun"))
        .arg("check")
        .args(arguments)
        .arg("--out")
        .arg(out.path().join("report"))
        .arg(project)
        .output()
        .expect("the program starts");
    let code = output.status.code();
    assert!(matches!(code, Some(0 | 1 | 3)), "{code:?}: {}", String::from_utf8_lossy(&output.stderr));
    let mut files = Files::new();
    collect(&out.path().join("report"), &out.path().join("report"), &mut files);
    assert!(files.len() >= 5, "{:?}", files.keys());
    files
}

fn same(a: &Files, b: &Files, what: &str) {
    assert!(a.keys().eq(b.keys()), "{what}: other files");
    for (name, bytes) in a {
        assert!(*bytes == b[name], "{what}: {} differs", name.display());
    }
}

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

fn on_any_machine(project: &Path) {
    let first = report(project, &["--blocks", "32", "--threads", "1"]);
    same(&first, &report(project, &["--blocks", "32", "--threads", "3"]), "three threads");
    same(&first, &report(project, &["--blocks", "32", "--threads", "2", "--simd", "off"]), "SIMD off");
    // The check can fail: another seed is another result.
    let other = report(project, &["--blocks", "32", "--threads", "2", "--seed", "2"]);
    let result = Path::new("result.json");
    assert!(first[result] != other[result], "the seed has no effect");
}

#[test]
fn box_gives_the_same_bytes_on_any_machine() {
    on_any_machine(&scene("box"));
}

#[test]
fn office_gives_the_same_bytes_on_any_machine() {
    // 17 blocks: one more than a batch, and quick.
    let project = scene("office");
    let first = report(&project, &["--blocks", "17", "--threads", "1"]);
    let other = report(&project, &["--blocks", "17", "--threads", "2", "--simd", "off"]);
    same(&first, &other, "two threads, SIMD off");
}

const ROOMS: &str = r#"[project]
name = "Three rooms"
language = ["ru", "en"]
[luminaires.A]
lambert = { flux = 4000 }
area = { rect = [1.2, 0.3] }
[[room]]
name = "One"
footprint = [[0, 0], [4, 0], [4, 3], [0, 3]]
height = 2.8
reflectances = { floor = 0.2, walls = 0.5, ceiling = 0.7 }
[[room]]
name = "Two"
footprint = [[5, 0], [9, 0], [9, 5], [7, 5], [7, 3], [5, 3]]
height = 3
reflectances = { floor = 0.3, walls = 0.6, ceiling = 0.8 }
mf = { llmf = 0.9, lmf = 0.9, rsmf = 0.95 }
[[room]]
name = "Three"
footprint = [[0, 6], [3, 6], [3, 9], [0, 9]]
height = 2.5
reflectances = { floor = 0.2, walls = 0.3, ceiling = 0.7 }
[[place]]
luminaire = "A"
field = { room = "One", rows = 2, columns = 1, height = 2.8 }
[[place]]
luminaire = "A"
array = { from = [6, 1.5, 3], step = [2, 0, 0], count = 2 }
[[place]]
luminaire = "A"
field = { room = "Three", rows = 1, columns = 1, height = 2.5 }
group = "own"
[light_scenes]
day = { A = 0.5, own = 1 }
night = { A = 0.1 }
[[viewpoint]]
name = "Seat"
eye = [1, 1, 1.2]
sweep = { from = 0, to = 270, step = 90 }
[norm]
standard = "en-12464-1-2021"
row = "34.2"
"#;

#[test]
fn three_rooms_give_the_same_bytes_on_any_machine() {
    on_any_machine(projects::folder(ROOMS, &[]).path());
}

fn blocks(files: &Files) -> String {
    let result: serde_json::Value = serde_json::from_slice(&files[Path::new("result.json")]).expect("JSON");
    let worlds = result["solver"]["blocks_by_world"].as_array().expect("a number of blocks for each world");
    worlds.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
}

/// Catches: anything in the files that tells why a run stopped, joint intervals by another look.
#[test]
fn a_number_of_blocks_repeats_a_run_that_stopped_by_itself() {
    for arguments in
        [&["--time", "1s", "--relative", "0.00001"][..], &["--time", "1ms"], &[], &["--relative", "0.03"]]
    {
        let run = report(&scene("box"), arguments);
        let blocks = blocks(&run);
        println!("{arguments:?}: {blocks} blocks");
        same(&run, &report(&scene("box"), &["--blocks", &blocks]), &format!("{arguments:?}"));
    }
}

/// Catches: rooms that stopped at different numbers of blocks and cannot be repeated.
#[test]
fn a_list_of_blocks_repeats_rooms_that_stopped_apart() {
    let folder = projects::folder(&format!("{ROOMS}[accuracy]\ngoal = {{ relative = 0.03 }}\n"), &[]);
    let run = report(folder.path(), &[]);
    let blocks = blocks(&run);
    println!("blocks by room: {blocks}");
    let numbers: Vec<&str> = blocks.split(',').collect();
    assert!(
        numbers.len() == 3 && numbers.iter().any(|n| *n != numbers[0]),
        "{blocks}: no list is needed here"
    );
    same(&run, &report(folder.path(), &["--blocks", &blocks]), "repeated");
}

/// Catches: absolute paths in a file: the same project elsewhere is the same report.
#[test]
fn a_project_moved_elsewhere_gives_the_same_bytes() {
    let (here, there) = (projects::folder(ROOMS, &[]), projects::folder(ROOMS, &[]));
    let arguments = ["--blocks", "2"];
    same(&report(here.path(), &arguments), &report(&there.path().join("project.toml"), &arguments), "moved");
}
