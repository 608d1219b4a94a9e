//! provenance.json: what repeats the run, and which files it wrote. It names the numbers that decide
//! the bytes (seed, blocks, inputs) and no machine; it also is the manifest by which a later run
//! knows its own files.

use rayon::prelude::*;
use serde::Serialize;

use super::ReportError;
use super::json::{VERSION, bytes};
use crate::digest::sha256;
use crate::outcome::Outcome;
use crate::project::InputFile;

#[derive(Serialize)]
struct ProvenanceFile<'a> {
    version: u32,
    program: &'static str,
    program_version: &'static str,
    seed: u64,
    method: &'a str,
    blocks_by_world: &'a [usize],
    inputs: &'a [InputFile],
    files: Vec<FileRow>,
}

#[derive(Serialize)]
struct FileRow {
    path: String,
    sha256: String,
}

/// The bytes of provenance.json: what repeats the run, and the files it wrote with their hashes.
pub fn provenance(outcome: &Outcome, files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, ReportError> {
    bytes(&ProvenanceFile {
        version: VERSION,
        program: env!("CARGO_PKG_NAME"),
        program_version: env!("CARGO_PKG_VERSION"),
        seed: outcome.solver.seed,
        method: &outcome.solver.method,
        blocks_by_world: &outcome.solver.blocks_by_world,
        inputs: &outcome.inputs,
        files: files
            .iter()
            .map(|(path, bytes)| FileRow { path: path.clone(), sha256: sha256(bytes) })
            .collect(),
    })
}

#[derive(Serialize)]
struct Manifest {
    files: Vec<FileRow>,
}

/// A manifest only: the files of a folder with their hashes.
pub fn manifest(files: &[(String, Vec<u8>)]) -> Result<Vec<u8>, ReportError> {
    let row = |(path, bytes): &(String, Vec<u8>)| FileRow { path: path.clone(), sha256: sha256(bytes) };
    bytes(&Manifest { files: files.par_iter().map(row).collect() })
}

/// Paths and hashes that a provenance.json lists; empty if it is not one of ours.
pub fn listed_files(provenance: &[u8]) -> Vec<(String, String)> {
    let Ok(file) = serde_json::from_slice::<serde_json::Value>(provenance) else {
        return Vec::new();
    };
    let rows = file["files"].as_array().map(Vec::as_slice).unwrap_or_default();
    rows.iter()
        .filter_map(|row| Some((row["path"].as_str()?.to_owned(), row["sha256"].as_str()?.to_owned())))
        .collect()
}
