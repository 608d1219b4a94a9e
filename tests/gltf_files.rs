//! Every glTF at hand, good and hostile: an answer or an error, never a panic, a hang or an absurd
//! allocation. Data is not part of the crate; without it these tests are skipped.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use gershun::geometry::gltf::{GltfError, Imported, import};

#[allow(clippy::print_stdout)] // tells that nothing was tested
fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("GERSHUN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data"), PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: no data folder");
    None
}

fn gltf_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            gltf_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            found.push(path);
        }
    }
}

fn import_file(path: &Path) -> Result<Imported, GltfError> {
    let bytes = std::fs::read(path).expect("listed before");
    let folder = path.parent().expect("in a folder");
    import(&bytes, &mut |uri| std::fs::read(folder.join(uri)).map_err(|error| format!("{uri}: {error}")))
}

#[test]
fn real_files_are_imported() {
    let Some(data) = data() else { return };
    let mut files = Vec::new();
    gltf_files(&data.join("geometry/gltf"), &mut files);
    for path in &files {
        let name = path.file_name().unwrap().to_string_lossy();
        match import_file(path) {
            Ok(imported) => {
                println!(
                    "{name}: {} triangles, {} surfaces, {} nodes, {} degenerate, {:?}",
                    imported.mesh.triangles.len(),
                    imported.mesh.surfaces.len(),
                    imported.nodes.len(),
                    imported.degenerate,
                    imported.biases
                );
                for triangle in &imported.mesh.triangles {
                    assert!(triangle.vertices.iter().all(|&v| (v as usize) < imported.mesh.positions.len()));
                    assert!((triangle.surface as usize) < imported.mesh.surfaces.len());
                }
            }
            Err(error) => println!("{name}: {error}"),
        }
    }
    assert!(files.iter().all(|path| import_file(path).is_ok()));
    println!("{} files imported", files.len());
}

/// Mistakes of the validator's that touch geometry, hierarchy or container.
const FATAL: &[&str] = &[
    "GLB_CHUNK_TOO_BIG",
    "GLB_DUPLICATE_CHUNK",
    "GLB_EMPTY_CHUNK",
    "GLB_INVALID_MAGIC",
    "GLB_INVALID_VERSION",
    "GLB_LENGTH_TOO_SMALL",
    "GLB_UNEXPECTED_BIN_CHUNK",
    "GLB_UNEXPECTED_END_OF_CHUNK_DATA",
    "GLB_UNEXPECTED_END_OF_CHUNK_HEADER",
    "GLB_UNEXPECTED_END_OF_HEADER",
    "GLB_UNEXPECTED_FIRST_CHUNK",
    "INVALID_JSON",
    "SCENE_NON_ROOT_NODE",
    "UNRESOLVED_REFERENCE",
];

#[test]
fn hostile_files_end_in_an_answer_or_an_error() {
    let Some(data) = data() else { return };
    let mut files = Vec::new();
    gltf_files(&data.join("hostile/gltf-validator"), &mut files);
    let validator = files.len();
    gltf_files(&data.join("hostile/assimp"), &mut files);
    let mut outcomes: BTreeMap<bool, usize> = BTreeMap::new();
    let mut missed = Vec::new();
    for (index, path) in files.iter().enumerate() {
        let start = Instant::now();
        let outcome = import_file(path);
        assert!(start.elapsed().as_secs_f64() < 5.0, "{} hangs", path.display());
        *outcomes.entry(outcome.is_ok()).or_default() += 1;
        let name = path.strip_prefix(&data).unwrap().display();
        match &outcome {
            Ok(imported) => println!("ok   {name}: {} triangles", imported.mesh.triangles.len()),
            Err(error) => println!("err  {name}: {error}"),
        }
        if index < validator && outcome.is_ok() {
            let report = std::fs::read_to_string(format!("{}.report.json", path.display()));
            let report = report.unwrap_or_default();
            // Severity 0 is an error; the codes above never come with another.
            if FATAL.iter().any(|code| report.contains(code)) {
                missed.push(name.to_string());
            }
        }
    }
    println!("{} files: {outcomes:?} (true: imported)", files.len());
    assert!(missed.is_empty(), "broken and yet imported: {missed:?}");
}

#[test]
fn flipped_bytes_of_a_good_file_never_panic() {
    let Some(data) = data() else { return };
    let path = data.join("geometry/gltf/trimesh/BoxInterleaved.glb");
    let good = std::fs::read(path).unwrap();
    for at in 0..good.len() {
        for flip in [0x01, 0x04, 0x10, 0x80] {
            let mut bytes = good.clone();
            bytes[at] ^= flip;
            let _ = import(&bytes, &mut |_| Err("no other file".to_owned()));
        }
    }
}
