//! Reads photometric files, images and stored fields that are named on the command line, outside of any project.

use std::path::{Component, Path, PathBuf};

use super::context::SMALL_FILE;
use crate::photometry::{tilt_file, with_tilt};

/// Largest image file, bytes: 64 million pixels of three times four bytes.
const LARGEST_IMAGE: u64 = 768 << 20;

/// Why a named file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// A folder was named.
    #[error("{0} is a folder\n  hint: name its files, for example {0}/*.{1} or {0}/*.{2}")]
    Folder(PathBuf, &'static str, &'static str),
    /// Larger than any file of its kind.
    #[error("{path} has {mib} MiB, more than the limit of {limit_mib} MiB")]
    Large {
        /// The file.
        path: PathBuf,
        /// Its size.
        mib: u64,
        /// What is allowed.
        limit_mib: u64,
    },
    /// The system refused.
    #[error("cannot read {path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

/// Whether two paths name one existing file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// The bytes of a photometric file, with the data of the file that its `TILT=` line names, if that lies
/// beside it.
///
/// # Errors
/// A folder, a file that is too large, or one that cannot be read.
pub fn read_photometry(path: &Path) -> Result<Vec<u8>, ReadError> {
    let bytes = read_named(path, SMALL_FILE, ["ldt", "ies"])?;
    let beside = tilt_file(&bytes).filter(|name| is_plain(name)).map(|name| path.with_file_name(name));
    let tilt = beside.and_then(|beside| read_named(&beside, SMALL_FILE, ["ldt", "ies"]).ok());
    Ok(tilt.map_or(bytes.clone(), |tilt| with_tilt(&bytes, &tilt)))
}

/// A file's name without any folder.
pub(super) fn is_plain(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None)) && !name.contains('\\')
}

/// The bytes of a luminance image.
///
/// # Errors
/// A folder, a file that is too large, or one that cannot be read.
pub fn read_image(path: &Path) -> Result<Vec<u8>, ReadError> {
    read_named(path, LARGEST_IMAGE, ["hdr", "exr"])
}

/// A file of stored fields, mapped: nobody should write to it while it is used.
///
/// # Errors
/// A folder, or a file that cannot be read.
pub fn read_field(path: &Path) -> Result<memmap2::Mmap, ReadError> {
    let io = |source| ReadError::Io { path: path.to_owned(), source };
    let file = std::fs::File::open(path).map_err(io)?;
    // SAFETY: the mapping is private to this process and read-only. Another program that shortens the
    // file meanwhile ends this one, as with every mapped file; that is told in the documentation.
    unsafe { memmap2::Mmap::map(&file) }.map_err(io)
}

fn read_named(path: &Path, limit: u64, [one, other]: [&'static str; 2]) -> Result<Vec<u8>, ReadError> {
    let io = |source| ReadError::Io { path: path.to_owned(), source };
    let metadata = path.metadata().map_err(io)?;
    if metadata.is_dir() {
        return Err(ReadError::Folder(path.to_owned(), one, other));
    }
    if metadata.len() > limit {
        let (mib, limit_mib) = (metadata.len() >> 20, limit >> 20);
        return Err(ReadError::Large { path: path.to_owned(), mib, limit_mib });
    }
    std::fs::read(path).map_err(io)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: tilt data beside a file that are not found, or read from elsewhere.
    #[test]
    fn tilt_data_lie_beside_their_file() {
        let folder = tempfile::tempdir().expect("tempdir");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
        std::fs::create_dir(folder.path().join("lamps")).expect("made");
        let file = "TILT=a.tlt\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n8 0\n";
        write("lamps/in.ies", file);
        write("lamps/out.ies", &file.replace("a.tlt", "../a.tlt"));
        write("a.tlt", "1 1 0 9");
        let read = |name: &str| String::from_utf8(read_photometry(&folder.path().join(name)).expect("read"));
        assert_eq!(read("lamps/in.ies").expect("text"), file);
        write("lamps/a.tlt", "1 1 0 0.5");
        assert!(read("lamps/in.ies").expect("text").starts_with("TILT=INCLUDE\n1 1 0 0.5 1 -1 1"));
        assert!(read("lamps/out.ies").expect("text").starts_with("TILT=../a.tlt"));
    }

    /// Catches: a folder reported as "is a directory" without a way out.
    #[test]
    fn a_folder_gets_a_hint() {
        let folder = tempfile::tempdir().expect("tempdir");
        let error = read_photometry(folder.path()).expect_err("a folder").to_string();
        assert!(error.contains("*.ldt"), "{error}");
        assert!(matches!(read_photometry(&folder.path().join("none")), Err(ReadError::Io { .. })));
    }
}
