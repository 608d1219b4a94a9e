//! Puts a report into a folder. All bytes are on disk beside the target before the first of them
//! is renamed into place; the manifest goes last, so it never lists what is not there.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use super::ReportError;
use super::provenance::listed_files;
use crate::digest::sha256;

/// The file that lists all others with their hashes.
pub const MANIFEST: &str = "provenance.json";

/// Replaces the report in `out` by `files` (paths with `/`).
pub fn replace(out: &Path, files: &[(String, Vec<u8>)]) -> Result<Vec<PathBuf>, ReportError> {
    let relative: Vec<PathBuf> = files.iter().map(|(path, _)| path.split('/').collect()).collect();
    for path in &relative {
        let target = out.join(path);
        if target.is_dir() {
            return Err(ReportError::FolderInTheWay(target));
        }
    }
    if out.exists() && !out.is_dir() {
        let source = io::Error::new(io::ErrorKind::NotADirectory, "not a folder");
        return Err(ReportError::Io { path: out.to_owned(), source });
    }
    let staging = Staging::beside(out)?;
    for (path, (_, bytes)) in relative.iter().zip(files) {
        let target = staging.path.join(path);
        make_parent(&target)?;
        fs::write(&target, bytes).map_err(at(&target))?;
    }
    let stale = stale(out, &relative);
    for path in &relative {
        let target = out.join(path);
        make_parent(&target)?;
        fs::rename(staging.path.join(path), &target).map_err(at(&target))?;
    }
    for path in stale {
        fs::remove_file(&path).map_err(at(&path))?;
        if let Some(parent) = path.parent().filter(|parent| *parent != out) {
            // Fails, as it should, unless that was its last file.
            fs::remove_dir(parent).unwrap_or(());
        }
    }
    Ok(relative)
}

/// Files of the former report that are not in the new one and are unchanged since.
fn stale(out: &Path, new: &[PathBuf]) -> Vec<PathBuf> {
    let Ok(manifest) = fs::read(out.join(MANIFEST)) else {
        return Vec::new();
    };
    listed_files(&manifest)
        .into_iter()
        .map(|(path, hash)| (PathBuf::from(path), hash))
        .filter(|(path, _)| path.components().all(|part| matches!(part, Component::Normal(_))))
        .filter(|(path, _)| !new.contains(path))
        .map(|(path, hash)| (out.join(path), hash))
        .filter(|(path, _)| fs::symlink_metadata(path).is_ok_and(|meta| meta.is_file()))
        .filter(|(path, hash)| fs::read(path).is_ok_and(|bytes| sha256(&bytes) == *hash))
        .map(|(path, _)| path)
        .collect()
}

fn make_parent(path: &Path) -> Result<(), ReportError> {
    match path.parent() {
        Some(parent) => fs::create_dir_all(parent).map_err(at(parent)),
        None => Ok(()),
    }
}

fn at(path: &Path) -> impl FnOnce(io::Error) -> ReportError {
    let path = path.to_owned();
    move |source| ReportError::Io { path, source }
}

/// A new folder on the target's file system, removed with whatever is left in it.
struct Staging {
    path: PathBuf,
}

impl Staging {
    fn beside(out: &Path) -> Result<Self, ReportError> {
        let parent = match (out.file_name(), out.parent()) {
            (Some(_), Some(parent)) if parent != Path::new("") => parent.to_owned(),
            (Some(_), _) => PathBuf::from("."),
            (None, _) => out.to_owned(),
        };
        fs::create_dir_all(&parent).map_err(at(&parent))?;
        let name = out.file_name().unwrap_or_default().to_string_lossy().into_owned();
        for attempt in 0..1000 {
            let path = parent.join(format!(".{name}.partial-{attempt}"));
            match fs::create_dir(&path) {
                Ok(()) => return Ok(Self { path }),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(at(&path)(error)),
            }
        }
        let source = io::Error::new(io::ErrorKind::AlreadyExists, "too many unfinished reports beside it");
        Err(ReportError::Io { path: parent, source })
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // Nothing can be done about a folder that cannot be removed; it is hidden and named .partial.
        fs::remove_dir_all(&self.path).unwrap_or(());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Options, sample, write};

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .expect("folder")
            .map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_failing_target_leaves_nothing() {
        let parent = tempfile::tempdir().expect("tempdir");
        let out = parent.path().join("out");
        fs::write(&out, "somebody's file").expect("written");
        write(&sample::outcome(), &out, &Options::default()).expect_err("a file is no folder");
        assert_eq!(names(parent.path()), ["out"]);
        assert_eq!(fs::read_to_string(&out).expect("still there"), "somebody's file");

        let out = parent.path().join("second");
        fs::create_dir_all(out.join("report.html")).expect("folder");
        let error = write(&sample::outcome(), &out, &Options::default()).expect_err("in the way");
        assert!(matches!(error, ReportError::FolderInTheWay(_)));
        assert_eq!(names(parent.path()), ["out", "second"]);
        assert_eq!(names(&out), ["report.html"]);
    }

    #[test]
    fn stale_files_of_ours_go_and_those_of_others_stay() {
        let parent = tempfile::tempdir().expect("tempdir");
        let out = parent.path().join("a/out");
        let first = write(&sample::outcome(), &out, &Options::default()).expect("written");
        assert!(first.iter().all(|path| out.join(path).is_file()));
        fs::write(out.join("notes.txt"), "mine").expect("written");
        let plans = names(&out.join("plan"));
        fs::write(out.join("plan").join(&plans[0]), "edited by hand").expect("written");

        let mut smaller = sample::outcome();
        smaller.rooms.clear();
        write(&smaller, &out, &Options::default()).expect("written");
        assert_eq!(names(&out.join("plan")), plans[..1], "only the edited drawing stays");
        assert!(names(&out).contains(&"notes.txt".to_owned()));
        assert!(!out.join("points.csv").exists());
        assert_eq!(names(&parent.path().join("a")), ["out"], "no unfinished folder stays");
    }

    #[test]
    fn a_manifest_cannot_name_files_outside() {
        let parent = tempfile::tempdir().expect("tempdir");
        let out = parent.path().join("out");
        fs::create_dir(&out).expect("folder");
        fs::write(parent.path().join("victim"), "x").expect("written");
        let manifest = format!(r#"{{"files":[{{"path":"../victim","sha256":"{}"}}]}}"#, sha256(b"x"));
        fs::write(out.join(MANIFEST), manifest).expect("written");
        write(&sample::outcome(), &out, &Options::default()).expect("written");
        assert!(parent.path().join("victim").exists());
    }
}
