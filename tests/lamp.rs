//! `gershun lamp` as a user runs it.

use std::path::Path;
use std::process::{Command, Output};

const GERSHUN: &str = env!("CARGO_BIN_EXE_gershun");

/// A downlight of 10 W without a fault but CR LF.
const SOUND: &str = "IESNA:LM-63-2002\r\nTILT=NONE\r\n1 -1 1 5 1 1 2 -0.2 -0.2 0\r\n1 1 10\r\n0 22.5 45 67.5 90\r\n0\r\n\
                     400 350 200 60 0\r\n";

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(GERSHUN).current_dir(folder).args(arguments).output().expect("runs")
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("tempdir");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("sound.ies", SOUND);
    write("rated.ies", &SOUND.replace("1 -1 1", "1 100 1").replace("-0.2 -0.2", "0 0"));
    write("order.ies", &SOUND.replace("45 67.5", "67.5 45"));
    folder
}

/// Catches: keys that scripts rely on renamed or reordered, a bad file that ends the batch or
/// goes unnoticed in the exit code.
#[test]
fn info_for_machines() {
    let folder = folder();
    let all =
        run(folder.path(), &["lamp", "info", "--format", "json", "sound.ies", "order.ies", "rated.ies"]);
    assert_eq!(all.status.code(), Some(2));
    let list: Vec<serde_json::Value> = serde_json::from_str(&out(&all)).expect("JSON");
    let names: Vec<_> = list.iter().map(|entry| entry["file"].as_str().unwrap_or_default()).collect();
    assert_eq!(names, ["sound.ies", "order.ies", "rated.ies"]);
    let keys = [
        "file",
        "format",
        "flux_integrated_lm",
        "flux_zonal_lm",
        "flux_rated_lm",
        "lor",
        "power_w",
        "i_max_cd",
        "opening",
        "symmetry",
        "outdoor",
        "findings",
    ];
    for entry in &list {
        assert_eq!(entry.as_object().map(serde_json::Map::len), Some(keys.len()));
        assert!(keys.iter().all(|key| entry.get(key).is_some()), "{entry}");
    }
    let positions: Vec<_> = keys.iter().map(|key| out(&all).find(&format!("\"{key}\""))).collect();
    assert!(positions.is_sorted(), "{positions:?}");
    assert_eq!(list[0]["opening"]["shape"], "disc");
    assert_eq!(list[0]["symmetry"], "rotational");
    assert_eq!(list[1]["findings"][0]["code"], "angle-order");
    assert!(list[1]["i_max_cd"].is_null());
    let fine = run(folder.path(), &["lamp", "info", "sound.ies"]);
    assert_eq!(fine.status.code(), Some(0));
    for part in ["I_max", "beam (50 %)", "CIE flux code", "spacing S/h", "zonal flux", "γ 85°"] {
        assert!(out(&fine).contains(part), "{part}");
    }
}

/// Catches: severities that do not reach the exit code, a finding without line or consequence, a
/// folder or a missing file taken for a clean one.
#[test]
fn lint_and_explain() {
    let folder = folder();
    let code = |arguments: &[&str]| run(folder.path(), arguments).status.code();
    assert_eq!(code(&["lamp", "lint", "sound.ies"]), Some(0));
    assert_eq!(code(&["lamp", "lint", "."]), Some(2));
    assert_eq!(code(&["lamp", "lint", "none.ies", "sound.ies"]), Some(2));
    let bad = run(folder.path(), &["lamp", "lint", "order.ies", "rated.ies"]);
    assert_eq!(bad.status.code(), Some(1));
    let text = out(&bad);
    assert!(
        text.contains("order.ies:5: error[angle-order]: γ must rise, found 45° after 67.5°\n  = "),
        "{text}"
    );
    assert!(
        text.contains("error[flux-contradiction]: rated 100 lm, integrates to ")
            && text.contains("\n  = Ē is ")
    );
    assert!(text.contains("warning[zero-area]"));
    for format in ["json", "sarif"] {
        let printed = out(&run(folder.path(), &["lamp", "lint", "--format", format, "rated.ies"]));
        let value: serde_json::Value = serde_json::from_str(&printed).expect("JSON");
        assert!(value.to_string().contains("flux-contradiction"));
    }
    let russian = out(&run(folder.path(), &["lamp", "lint", "--lang", "ru", "rated.ies"]));
    assert!(russian.contains("ошибка[flux-contradiction]") && russian.contains("файлов: 1"), "{russian}");
    let russian = out(&run(folder.path(), &["lamp", "info", "--lang", "ru", "sound.ies"]));
    assert!(russian.contains("световой поток") && !russian.contains("opening"), "{russian}");
    assert!(out(&run(folder.path(), &["explain", "spike"])).starts_with("spike (warning)\n"));
    let russian = out(&run(folder.path(), &["explain", "--lang", "ru", "spike"]));
    assert!(russian.starts_with("spike (предупреждение)\nОтдельные силы света"), "{russian}");
    let russian = out(&run(folder.path(), &["lamp", "ugr-table", "--lang", "ru", "sound.ies"]));
    assert!(
        russian.contains("потолок") && russian.contains("поперёк") && !russian.contains("walls"),
        "{russian}"
    );
    let russian = run(folder.path(), &["lamp", "ugr-table", "--lang", "ru", "rated.ies"]);
    assert!(String::from_utf8_lossy(&russian.stderr).contains("светящей площади нет"), "{russian:?}");
    assert_eq!(code(&["explain", "spikes"]), Some(2));
}

/// Catches: rooms and reflectance sets exchanged, a luminaire without area given a table.
#[test]
fn ugr_table_as_csv() {
    let folder = folder();
    let table = run(folder.path(), &["lamp", "ugr-table", "--format", "csv", "--shr", "0.25", "sound.ies"]);
    assert_eq!(table.status.code(), Some(0));
    let text = out(&table);
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows.len(), 20);
    assert!(rows[0].starts_with("x_h,y_h,crosswise_70_50_20,crosswise_70_30_20,"));
    assert!(rows[1].starts_with("2,2,") && rows[19].starts_with("12,8,"));
    assert!(rows.iter().all(|row| row.split(',').count() == 12));
    assert_eq!(run(folder.path(), &["lamp", "ugr-table", "rated.ies"]).status.code(), Some(2));
    assert_eq!(
        run(folder.path(), &["lamp", "ugr-table", "--shr", "0.3", "sound.ies"]).status.code(),
        Some(2)
    );
}

/// Catches: a drawing or a conversion that is not written whole, the input overwritten, losses
/// that nobody is told of.
#[test]
fn polar_and_convert() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let drawn = run(folder.path(), &["lamp", "polar", "sound.ies", "--out", "a.svg"]);
    assert_eq!(drawn.status.code(), Some(0));
    let svg = std::fs::read_to_string(path("a.svg")).expect("written");
    assert!(svg.starts_with("<svg") && svg.contains("C90–C270"));
    assert_eq!(out(&run(folder.path(), &["lamp", "polar", "sound.ies"])), svg);
    let told = run(folder.path(), &["lamp", "convert", "sound.ies", "new.ldt"]);
    assert_eq!(told.status.code(), Some(0));
    assert!(out(&told).starts_with("new.ldt\n") && out(&told).contains("dropped: "));
    assert_eq!(run(folder.path(), &["lamp", "lint", "new.ldt"]).status.code(), Some(0));
    let russian = out(&run(folder.path(), &["lamp", "convert", "--lang", "ru", "sound.ies", "ru.ldt"]));
    assert!(russian.contains("не перенесено: ") && !russian.contains("dropped"), "{russian}");
    for arguments in [["sound.ies", "sound.ies"], ["sound.ies", "a.txt"], ["order.ies", "b.ldt"]] {
        let refused = run(folder.path(), &["lamp", "convert", arguments[0], arguments[1]]);
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}");
    }
    assert_eq!(std::fs::read_to_string(path("sound.ies")).expect("still there"), SOUND);
    assert!(!path("b.ldt").exists() && !path("a.txt").exists());
}

/// Catches: a table without its column `file` because one of two files failed; a file that cannot be opened missing
/// from a list for programs; an SVG written into a file that is called a PNG.
#[test]
fn the_shape_of_what_is_printed_follows_from_what_is_named() {
    let folder = folder();
    let heads = |files: &[&str]| {
        let table = run(folder.path(), &[&["lamp", "ugr-table", "--format", "csv"], files].concat());
        (table.status.code(), out(&table).lines().next().unwrap_or_default().starts_with("file,"))
    };
    assert_eq!(heads(&["sound.ies"]), (Some(0), false));
    assert_eq!(heads(&["sound.ies", "sound.ies"]), (Some(0), true));
    for failing in ["rated.ies", "order.ies", "nofile.ies"] {
        assert_eq!(heads(&["sound.ies", failing]), (Some(2), true), "{failing}");
    }
    for command in ["info", "lint"] {
        let listed = run(folder.path(), &["lamp", command, "--format", "json", "sound.ies", "nofile.ies"]);
        assert_eq!(listed.status.code(), Some(2));
        let list: Vec<serde_json::Value> = serde_json::from_str(&out(&listed)).expect("JSON");
        let last = list.last().expect("an entry");
        assert_eq!(last["file"], "nofile.ies", "{command}: {last}");
        assert!(last.to_string().contains("cannot be opened"), "{last}");
        assert!(String::from_utf8_lossy(&listed.stderr).contains("nofile.ies"));
    }
    let drawn = run(folder.path(), &["lamp", "polar", "sound.ies", "--out", "a.png"]);
    assert!(drawn.status.code() == Some(2) && !folder.path().join("a.png").exists());
    assert!(String::from_utf8_lossy(&drawn.stderr).contains("hint: name a file .svg"));
}

/// Catches: what a sum of rounded numbers leaves over, printed with all its zeros.
#[test]
fn nothing_is_printed_as_nothing() {
    let folder = folder();
    let told = out(&run(folder.path(), &["lamp", "info", "sound.ies"]));
    assert!(!told.contains("0.000000"), "{told}");
}
