//! Luminance images: where a pixel looks and how much of the sphere it sees, and the two formats
//! they are kept in. Knows no scene: an image may come from a renderer, a camera or this program.
//!
//! A pixel outside the projection (the corners of a fisheye) holds 0 and sees no solid angle.

mod exr;
mod hdr;
mod luminance_image;
mod primaries;
mod projection;
mod raster;
mod view_text;

pub use exr::{read as read_exr, write as write_exr};
pub use hdr::{read as read_hdr, write as write_hdr};
pub use luminance_image::LuminanceImage;
pub use projection::{Projection, View};
pub use raster::Raster;
pub use view_text::asked as asked_view;

/// Most pixels an image may have: at 8 bytes each they fill half a GiB.
pub const MOST_PIXELS: usize = 1 << 26;

/// What is wrong with an image or a view.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// Neither Radiance HDR nor OpenEXR.
    #[error("neither a Radiance picture (#?RADIANCE …) nor an OpenEXR image")]
    Unknown,
    /// A line of the header cannot be understood.
    #[error("line {line} of the header: {message}")]
    Header {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        message: String,
    },
    /// The size is absurd.
    #[error("{width} × {height} pixels: an image has between 1 and {MOST_PIXELS}")]
    Size {
        /// Pixels in a row.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// The pixels end early or contradict themselves.
    #[error("scanline {scanline}: {message}")]
    Scanline {
        /// Scanline in the order of the file, from 0.
        scanline: usize,
        /// What is wrong.
        message: String,
    },
    /// OpenEXR's decoder gave up.
    #[error("OpenEXR: {0}")]
    Exr(String),
    /// No channel holds luminance.
    #[error("no luminance: there are the channels {0}; needed are Y, or R, G and B")]
    Channels(String),
    /// A view that cannot be used.
    #[error("view: {0}")]
    View(String),
    /// A view that a person asks for and that cannot be understood.
    #[error("{message}\n  hint: {hint}")]
    Asked {
        /// What is wrong.
        message: String,
        /// What to write instead.
        hint: String,
    },
}

/// Reads a luminance image, whatever of the two formats it is in.
///
/// # Errors
/// [`ImageError`] says what is wrong with the bytes.
pub fn read(bytes: &[u8]) -> Result<LuminanceImage, ImageError> {
    match bytes {
        [b'#', b'?', ..] => hdr::read(bytes),
        [0x76, 0x2f, 0x31, 0x01, ..] => exr::read(bytes),
        _ => Err(ImageError::Unknown),
    }
}

/// The number of pixels, if it is one that an image may have.
fn checked_size(width: u64, height: u64) -> Result<usize, ImageError> {
    match width.checked_mul(height) {
        Some(pixels) if pixels > 0 && pixels <= MOST_PIXELS as u64 => Ok(pixels as usize),
        _ => Err(ImageError::Size { width, height }),
    }
}
