//! Photometric files → one domain type, [`IntensityDistribution`]: absolute candelas, expanded to
//! the full sphere, in the luminaire frame. Parsers take bytes and never read files. The trap:
//! LM-63's 0° plane lies *along* the luminaire (+x), EULUMDAT's C0 *across* it (−y).

// `!(x > 0.0)` is meant: such a guard stops NaN too.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

mod body;
mod distribution;
mod emission;
mod face;
mod findings;
mod gldf;
mod grid;
mod ies;
mod ies_goniometer;
mod ies_head;
mod ies_opening;
mod ies_tilt;
mod ies_write;
mod ldt;
mod ldt_head;
mod ldt_write;
mod numbers;
mod odd_angle;
mod opening;
mod opening_sizes;
mod places;
mod planes;
mod spherical_rectangle;
mod symmetry;
mod table;
mod text;
mod tm33;
mod tm33_opening;
mod tm33_table;
mod written;

pub use distribution::IntensityDistribution;
pub use grid::DistributionError;
pub use ies::Lm63Version;
pub use ies_tilt::{tilt_file, with_tilt};
pub use ies_write::to_ies;
pub use ldt_write::to_ldt;
pub use opening::{Met, Opening, Shine};
pub use places::Places;
pub use symmetry::Symmetry;

/// What a photometric file says, checked.
#[derive(Clone, Debug)]
pub struct Photometry {
    /// The format it was recognised as.
    pub format: Format,
    /// Manufacturer and luminaire as the file names them.
    pub description: String,
    /// Absolute intensities in the luminaire frame; every factor of the file is applied.
    pub distribution: IntensityDistribution,
    /// The light-emitting area.
    pub opening: Opening,
    /// EULUMDAT: flux × LOR. LM-63 relative: flux of the lamps. `None` for LM-63 absolute.
    pub rated_flux_lm: Option<f64>,
    /// Flux of the lamps; `None` for absolute photometry.
    pub lamp_flux_lm: Option<f64>,
    /// Light output ratio stated by the file, 0 … 1; LM-63 states none.
    pub lor: Option<f64>,
    /// Connected power, W.
    pub power_w: Option<f64>,
    /// Colour rendering index R_a, or the lower end of its stated group.
    pub colour_rendering: Option<f64>,
    /// Where the file says it.
    pub places: Places,
    /// Oddities that do not prevent a calculation.
    pub findings: Vec<Finding>,
}

/// Photometric file formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// ANSI/IES LM-63, `.ies`.
    Lm63 {
        /// Its edition.
        version: Lm63Version,
    },
    /// EULUMDAT, `.ldt`.
    Eulumdat,
    /// ANSI/IES TM-33, XML.
    Tm33,
}

/// An oddity of a file and what follows from it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Stable word, `flux-mismatch`.
    pub code: &'static str,
    /// Line of the file, from 1, where one line is at fault.
    pub line: Option<usize>,
    /// What was found, with its values.
    pub message: String,
    /// What follows for the results, estimated where it can be.
    pub consequence: String,
}

impl Finding {
    /// A finding at a line (`None`: the whole file).
    pub fn new(
        code: &'static str,
        line: impl Into<Option<usize>>,
        message: impl Into<String>,
        consequence: impl Into<String>,
    ) -> Self {
        Self { code, line: line.into(), message: message.into(), consequence: consequence.into() }
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.message, self.consequence)
    }
}

/// A file that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {message}\n  hint: {hint}")]
pub struct PhotometryError {
    /// Name as given by the caller.
    pub file: String,
    /// Line from 1.
    pub line: usize,
    /// What is wrong, with the values at fault.
    pub message: String,
    /// What to do about it.
    pub hint: String,
    /// Stable word as in [`Finding::code`], `unreadable`.
    pub code: &'static str,
}

/// A parser's error before the file's name is known.
#[derive(Debug)]
struct Fault {
    line: usize,
    message: String,
    hint: &'static str,
    code: &'static str,
}

impl Fault {
    fn new(line: usize, message: impl Into<String>, hint: &'static str) -> Self {
        Self { line, message: message.into(), hint, code: "unreadable" }
    }

    fn coded(self, code: &'static str) -> Self {
        Self { code, ..self }
    }
}

/// One photometric file, by itself or out of a container.
#[derive(Clone, Debug)]
pub struct Part {
    /// The file's name, for a part of a container followed by `/` and the path within.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// Emitters of the container's product that use it.
    pub emitters: Vec<String>,
}

/// The photometric files in `bytes`: itself, or those of a GLDF container.
///
/// # Errors
/// A container that is damaged or names no photometry.
pub fn unpack(bytes: &[u8], file_name: &str) -> Result<Vec<Part>, PhotometryError> {
    if !bytes.starts_with(b"PK") {
        return Ok(vec![Part { name: file_name.to_owned(), bytes: bytes.to_vec(), emitters: Vec::new() }]);
    }
    let parts = gldf::parts(bytes).map_err(|fault| named(fault, file_name))?;
    let part = |part: gldf::Part| Part {
        name: format!("{file_name}/{}", part.name),
        bytes: part.bytes,
        emitters: part.emitters,
    };
    Ok(parts.into_iter().map(part).collect())
}

/// Reads LM-63, EULUMDAT, TM-33 or a GLDF container with one photometry, recognised by content;
/// `file_name` appears in messages only.
///
/// # Errors
/// When the bytes are none of these, or damaged, or describe no usable distribution, or a container
/// holds several photometries.
pub fn parse(bytes: &[u8], file_name: &str) -> Result<Photometry, PhotometryError> {
    if !bytes.starts_with(b"PK") {
        return parse_content(bytes).map_err(|fault| named(fault, file_name));
    }
    match &unpack(bytes, file_name)?[..] {
        [only] => parse_content(&only.bytes).map_err(|fault| named(fault, &only.name)),
        several => {
            let names: Vec<&str> = several.iter().map(|part| part.name.as_str()).collect();
            let message = format!("{} photometries: {}", several.len(), names.join(", "));
            Err(named(Fault::new(1, message, "unpack the one you need and name it"), file_name))
        }
    }
}

fn named(fault: Fault, file_name: &str) -> PhotometryError {
    PhotometryError {
        file: file_name.to_owned(),
        line: fault.line,
        message: fault.message,
        hint: fault.hint.to_owned(),
        code: fault.code,
    }
}

fn parse_content(bytes: &[u8]) -> Result<Photometry, Fault> {
    const EXPORT_AGAIN: &str = "get the photometric file (.ies or .ldt) from its manufacturer again";
    let text = text::decode(bytes);
    if text.trim().is_empty() {
        return Err(Fault::new(1, "the file is empty", EXPORT_AGAIN));
    }
    if text.contains('\0') {
        let hint = "a ULD container must be unpacked: give the .ies or .ldt inside";
        return Err(Fault::new(1, "this is a binary file", hint));
    }
    let lines: Vec<&str> = text.lines().collect();
    let mut photometry = if tm33::recognises(&text) {
        tm33::read(&text)?
    } else if ies::recognises(&lines) {
        ies::read(&lines)?
    } else if ldt::recognises(&lines) {
        ldt::read(&lines)?
    } else {
        let message = "neither LM-63 (no TILT= line) nor EULUMDAT (line 3 is no symmetry 0 … 4) nor TM-33 (no XML of it)";
        return Err(Fault::new(3.min(lines.len()), message, EXPORT_AGAIN));
    };
    if !(photometry.distribution.flux().0 > 0.0) {
        return Err(Fault::new(lines.len(), "every intensity is 0", EXPORT_AGAIN));
    }
    let more = findings::check(&photometry);
    photometry.findings.extend(more);
    Ok(photometry)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a panic on what is no photometry at all, a message without place or hint.
    #[test]
    fn rubbish_is_an_error_with_a_hint() {
        let rubbish: [&[u8]; 6] =
            [b"", b" \r\n\r\n", b"PK\x03\x04", b"\0\xff\xfe\x01", b"hello", b"a\nb\n9\nc\n"];
        for bytes in rubbish {
            let error = parse(bytes, "a.ldt").expect_err("rubbish");
            assert!(
                error.to_string().starts_with("a.ldt:") && error.to_string().contains("\n  hint: "),
                "{error}"
            );
        }
    }

    /// Catches: recognition by extension, so that a renamed file is misread.
    #[test]
    fn content_decides_the_format() {
        let ies = parse(ies::tests::SAMPLE.as_bytes(), "lamp.ldt").expect("LM-63");
        assert_eq!(ies.format, Format::Lm63 { version: Lm63Version::Y1995 });
        let ldt = parse(ldt::tests::sample().as_bytes(), "lamp.ies").expect("EULUMDAT");
        assert_eq!(ldt.format, Format::Eulumdat);
    }

    /// Catches: an index out of range or an overflow on truncated or flipped input.
    #[test]
    fn damaged_files_never_panic() {
        for text in [ies::tests::SAMPLE.to_owned(), ldt::tests::sample(), tm33::tests::SAMPLE.to_owned()] {
            let whole = text.as_bytes();
            for cut in (0..whole.len()).step_by(37) {
                let _ = parse(&whole[..cut], "cut");
            }
            for at in 0..whole.len() {
                for flip in [0x01, 0x08, 0x10, 0x80] {
                    let mut bytes = whole.to_vec();
                    bytes[at] ^= flip;
                    let _ = parse(&bytes, "flipped");
                }
            }
        }
    }
}
