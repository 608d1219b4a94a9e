//! One file for the user: it appears whole or not at all.

use std::fs;
use std::io;
use std::path::Path;

use super::ReportError;

/// Writes `bytes` to `path`, replacing what is there.
///
/// # Errors
/// Where the folder does not exist or cannot be written; nothing is left behind then.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    let at = |source: io::Error| ReportError::Io { path: path.to_owned(), source };
    if path.is_dir() {
        return Err(ReportError::FolderInTheWay(path.to_owned()));
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let partial = path.with_file_name(format!(".{name}.partial-{}", std::process::id()));
    let written = fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, path));
    written.map_err(|error| {
        // Nothing can be done about a file that cannot be removed; it is hidden and named .partial.
        fs::remove_file(&partial).unwrap_or(());
        at(error)
    })
}

/// Makes a folder and those above it; one that is there is left as it is.
///
/// # Errors
/// Where it cannot be made.
pub fn make_folder(path: &Path) -> Result<(), ReportError> {
    fs::create_dir_all(path).map_err(|source| ReportError::Io { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: half a file, a leftover, a folder overwritten.
    #[test]
    fn whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("tempdir");
        let path = folder.path().join("a.svg");
        write_file(&path, b"one").expect("written");
        write_file(&path, b"two").expect("replaced");
        assert_eq!(fs::read(&path).expect("there"), b"two");
        assert!(write_file(&folder.path().join("none/a.svg"), b"x").is_err());
        assert!(matches!(write_file(folder.path(), b"x"), Err(ReportError::FolderInTheWay(_))));
        assert_eq!(fs::read_dir(folder.path()).expect("folder").count(), 1);
    }
}
