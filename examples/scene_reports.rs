//! The reference reports of the example scenes that are judged by a norm: tables and result of
//! scenes/classroom (two norms), scenes/sports-hall and scenes/warehouse, into reports/.
//!
//!     cargo run --release --example scene_reports            # writes them
//!     cargo run --release --example scene_reports -- --check # compares byte for byte
//!
//! Bytes are equal for the same binary and the same mathematical functions of the system; on another
//! kind of machine these may differ in the last digit.
#![allow(clippy::print_stdout, reason = "a study prints")]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use gershun::project::{LoadOptions, load};
use gershun::report::{Lang, Options, files};
use gershun::{Settings, Watch, run};

/// Project and the folder of its report below reports/.
const SCENES: [(&str, &str); 4] = [
    ("scenes/classroom/project.toml", "classroom-sanpin"),
    ("scenes/classroom/sp-52.toml", "classroom-sp-52"),
    ("scenes/sports-hall/project.toml", "sports-hall"),
    ("scenes/warehouse/project.toml", "warehouse"),
];

/// What of a report is kept: small, and without drawings.
const KEPT: [&str; 5] = ["check.csv", "points.csv", "viewpoints.csv", "glare_sources.csv", "result.json"];

/// Name and bytes of a file.
type Named = (String, Vec<u8>);

/// Files of one scene's reference report.
fn report(root: &Path, project: &str) -> Result<Vec<Named>, Box<dyn Error>> {
    let project = load(&root.join(project), &LoadOptions::default())
        .map_err(|mistakes| mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))?;
    let never = AtomicBool::new(false);
    let watch = Watch { progress: &|_| {}, interrupted: &never };
    let outcome = run(&project, &Settings::default(), &watch)?;
    let options = Options { languages: vec![Lang::En], ..Options::default() };
    let all = files(&outcome, &options)?;
    Ok(all.into_iter().filter(|(name, _)| KEPT.contains(&name.as_str())).collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let compare = std::env::args().any(|argument| argument == "--check");
    let root = PathBuf::from(".");
    let mut different = Vec::new();
    for (project, folder) in SCENES {
        let folder = root.join("reports").join(folder);
        for (name, bytes) in report(&root, project)? {
            let path = folder.join(&name);
            if compare {
                if std::fs::read(&path).ok().as_deref() != Some(bytes.as_slice()) {
                    different.push(path.display().to_string());
                }
            } else {
                std::fs::create_dir_all(&folder)?;
                std::fs::write(&path, bytes)?;
                println!("{}", path.display());
            }
        }
    }
    if different.is_empty() { Ok(()) } else { Err(format!("differ: {}", different.join(", ")).into()) }
}
