//! What one photometric file says: its figures, its faults, its UGR table. Pure: bytes in, data
//! out. C counts as in EULUMDAT for *every* format here: C0 across the opening's length, C90 along
//! it; an LM-63 file's own 0° plane is C90.

pub mod beam;
pub mod convert;
pub mod flux;
pub mod info;
pub mod installed;
pub mod lint;
pub mod luminance;
mod nodes;
pub mod outdoor;
pub mod rules;
pub mod spacing;
pub mod ugr;

pub use info::{Info, info};
pub use rules::{RULES, Rule, Severity, rule};

use crate::photometry::{Finding, Part, Photometry, PhotometryError, parse, unpack};

/// One luminaire of a file, with everything that was found about it.
#[derive(Clone, Debug)]
pub struct Lamp {
    /// File, and for containers the part of it.
    pub file: String,
    /// What the file says.
    pub photometry: Photometry,
    /// Oddities of parsing and of [`lint::check`], by line.
    pub findings: Vec<Finding>,
}

/// Reads a photometric file and looks for its faults; a container may hold several luminaires.
///
/// # Errors
/// Where the file cannot be used at all.
pub fn read(bytes: &[u8], file: &str) -> Result<Vec<Lamp>, PhotometryError> {
    let one = |part: &Part| {
        let mut lamp = read_one(&part.bytes, &part.name)?;
        if !part.emitters.is_empty() {
            let message = format!("used by the emitters {}", part.emitters.join(", "));
            let consequence = "the product may set another flux per emitter, which is not read";
            lamp.findings.push(Finding::new("emitter", None, message, consequence));
        }
        Ok(lamp)
    };
    unpack(bytes, file)?.iter().map(one).collect()
}

fn read_one(bytes: &[u8], file: &str) -> Result<Lamp, PhotometryError> {
    let photometry = parse(bytes, file)?;
    let mut findings = photometry.findings.clone();
    findings.extend(lint::check(bytes, &photometry));
    // Stable: those without a line stay in their order, behind the others.
    findings.sort_by_key(|finding| finding.line.unwrap_or(usize::MAX));
    Ok(Lamp { file: file.to_owned(), photometry, findings })
}

/// A file that cannot be used, as a finding.
pub fn unreadable(error: &PhotometryError) -> Finding {
    let consequence = format!("the file cannot be used; {}", error.hint);
    Finding::new(error.code, Some(error.line).filter(|line| *line > 0), &error.message, consequence)
}

/// The C angle of an azimuth of the luminaire frame, degrees: C90 lies along +x.
pub fn c_deg(azimuth_deg: f64) -> f64 {
    (azimuth_deg + 90.0).rem_euclid(360.0)
}

/// The azimuth of the luminaire frame of a C angle, degrees.
pub fn azimuth_deg(c_deg: f64) -> f64 {
    c_deg - 90.0
}
