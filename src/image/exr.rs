//! OpenEXR images. The pixels are decoded by a library; before it takes memory, the header's sizes
//! are checked here, and what it cannot decode (subsampled or deep channels) is said.
//!
//! Luminance is channel `Y`, or R, G and B weighted by the file's chromaticities; `whiteLuminance`
//! is the luminance of R = G = B = 1.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use ::exr::block::UncompressedBlock;
use ::exr::block::reader::ChunksReader;
use ::exr::meta::MetaData;
use ::exr::meta::attribute::{AttributeValue, ChannelDescription, Chromaticities, SampleType, Text};
use ::exr::meta::header::Header;
use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage, f16,
};

use super::primaries::{REC_709, shares};
use super::view_text::Options;
use super::{ImageError, LuminanceImage, MOST_PIXELS, checked_size};

/// Header attribute that keeps the view, in Radiance's words.
const VIEW: &str = "radianceView";
/// Said of images without an absolute scale.
const NO_LUMINANCE: &str = "the file states no whiteLuminance: its values are taken as cd/m²";
/// Most channels that are decoded: more than any renderer's passes.
const MOST_CHANNELS: usize = 1024;
/// Most bytes of one block before it is decompressed.
const LARGEST_BLOCK: usize = 1 << 29;

/// Where luminance stands in a layer.
struct Source {
    layer: usize,
    /// Channels and their weights in cd/m² per unit.
    weights: Vec<(usize, f64)>,
    standard_error: Option<(usize, f64)>,
    notes: Vec<String>,
}

/// Reads an OpenEXR image; pixels that are no numbers become 0 and are counted in the notes.
///
/// # Errors
/// [`ImageError`] where the file is damaged, too large, or has no luminance.
pub fn read(bytes: &[u8]) -> Result<LuminanceImage, ImageError> {
    // The library asserts where a damaged file contradicts itself; that is an error of the file.
    catch_unwind(AssertUnwindSafe(|| decode(bytes)))
        .unwrap_or_else(|_| Err(ImageError::Exr("the decoder gave up on a damaged file".into())))
}

fn fault(error: ::exr::error::Error) -> ImageError {
    match error {
        ::exr::error::Error::NotSupported(what) => ImageError::Exr(format!("not supported: {what}")),
        ::exr::error::Error::Invalid(what) => ImageError::Exr(format!("invalid: {what}")),
        ::exr::error::Error::Io(what) => ImageError::Exr(format!("the file ends early ({})", what.kind())),
        ::exr::error::Error::Aborted => ImageError::Exr("stopped".into()),
    }
}

fn decode(bytes: &[u8]) -> Result<LuminanceImage, ImageError> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(fault)?;
    for header in &meta.headers {
        check(header)?;
    }
    let source = source(&meta)?;
    let header = &meta.headers[source.layer];
    let display = header.shared_attributes.display_window;
    let (width, height) = (display.size.0, display.size.1);
    let pixels = checked_size(width as u64, height as u64)?;
    let mut luminance = vec![0.0; pixels];
    let mut standard_error = source.standard_error.map(|_| vec![0.0; pixels]);

    let reader = ::exr::block::read(Cursor::new(bytes), false).map_err(fault)?;
    let mut chunks = reader.all_chunks(false).map_err(fault)?;
    let shift = [
        i64::from(header.own_attributes.layer_position.0) - i64::from(display.position.0),
        i64::from(header.own_attributes.layer_position.1) - i64::from(display.position.1),
    ];
    let mut decoded = 0;
    while let Some(chunk) = chunks.next() {
        let chunk = chunk.map_err(fault)?;
        if chunk.layer_index != source.layer {
            continue;
        }
        let block = UncompressedBlock::decompress_chunk(chunk, chunks.meta_data(), false).map_err(fault)?;
        if block.index.level.0 != 0 || block.index.level.1 != 0 {
            continue;
        }
        decoded += block.index.pixel_size.area();
        for line in block.lines(&header.channels) {
            let channel = line.location.channel;
            let (target, weight) = if let Some(&(_, weight)) =
                source.weights.iter().find(|(index, _)| *index == channel)
            {
                (Some(&mut luminance), weight)
            } else if let Some((_, weight)) = source.standard_error.filter(|(index, _)| *index == channel) {
                (standard_error.as_mut(), weight)
            } else {
                continue;
            };
            let Some(target) = target else { continue };
            let Some(row) = within(line.location.position.1, shift[1], height) else { continue };
            for (step, value) in samples(line.value, header.channels.list[channel].sample_type).enumerate() {
                if let Some(column) = within(line.location.position.0 + step, shift[0], width) {
                    target[row * width + column] += weight * value;
                }
            }
        }
    }
    if decoded < header.layer_size.area() {
        let missing = header.layer_size.area() - decoded;
        return Err(ImageError::Exr(format!("{missing} pixels are missing")));
    }
    let mut notes = source.notes;
    if header.layer_size != display.size || shift != [0, 0] {
        notes.push(format!(
            "the data window ({} × {} at {}, {}) is not the display window ({width} × {height}): what lies outside of it is cut off, what is missing is dark",
            header.layer_size.0, header.layer_size.1, shift[0], shift[1]
        ));
    }
    count_non_numbers(&luminance, width, &mut notes);
    let name = Text::from(VIEW);
    let attributes = [&header.own_attributes.other, &header.shared_attributes.other];
    let mut view = None;
    if let Some(AttributeValue::Text(text)) = attributes.iter().find_map(|other| other.get(&name)) {
        let mut options = Options::default();
        let read = options.add(&text.to_string()).and_then(|()| options.view());
        view = read.map_err(|error| notes.push(error.to_string())).ok();
    } else {
        notes.push("the file says nothing about its view".into());
    }
    let image = LuminanceImage::new(width, height, view, luminance);
    Ok(LuminanceImage { standard_error_cd_m2: standard_error, notes, ..image })
}

/// A place of the data window in the display window.
fn within(place: usize, shift: i64, count: usize) -> Option<usize> {
    let shifted = i64::try_from(place).ok()? + shift;
    usize::try_from(shifted).ok().filter(|&shifted| shifted < count)
}

/// Refuses what would exhaust memory or cannot be decoded.
fn check(header: &Header) -> Result<(), ImageError> {
    if header.deep {
        return Err(ImageError::Exr("deep images are not supported".into()));
    }
    let display = header.shared_attributes.display_window.size;
    for size in [header.layer_size, display] {
        checked_size(size.0 as u64, size.1 as u64)?;
    }
    let channels = header.channels.list.len();
    if channels > MOST_CHANNELS || header.max_block_byte_size() > LARGEST_BLOCK {
        return Err(ImageError::Exr(format!(
            "{channels} channels in blocks of {} bytes are more than can be meant",
            header.max_block_byte_size()
        )));
    }
    if header.chunk_count > MOST_PIXELS {
        return Err(ImageError::Exr(format!("{} blocks are more than can be meant", header.chunk_count)));
    }
    if let Some(channel) = header.channels.list.iter().find(|channel| channel.sampling.area() != 1) {
        return Err(ImageError::Exr(format!(
            "not supported: channel {} has fewer pixels than the image",
            channel.name
        )));
    }
    Ok(())
}

/// Finds luminance: in plain channel names first, in those of a layer (`layer.Y`) next.
fn source(meta: &MetaData) -> Result<Source, ImageError> {
    for plain in [true, false] {
        for (layer, header) in meta.headers.iter().enumerate() {
            let find =
                |name: &str| header.channels.list.iter().position(|channel| is_named(channel, name, plain));
            let attributes = &header.own_attributes;
            let white = attributes.white_luminance.map(f64::from).filter(|white| *white > 0.0);
            let unit = white.unwrap_or(1.0);
            let mut notes: Vec<String> = if white.is_some() { vec![] } else { vec![NO_LUMINANCE.into()] };
            let weights = if let Some(index) = find("Y") {
                vec![(index, unit)]
            } else if let (Some(r), Some(g), Some(b)) = (find("R"), find("G"), find("B")) {
                let given = header.shared_attributes.chromaticities.as_ref();
                let shares = given.and_then(|given| shares(pairs(given)));
                if given.is_some() && shares.is_none() {
                    notes.push("the chromaticities are impossible: Rec. 709 is taken".into());
                }
                let [red, green, blue] = shares.unwrap_or(REC_709);
                vec![(r, red * unit), (g, green * unit), (b, blue * unit)]
            } else {
                continue;
            };
            let standard_error = find("se").map(|index| (index, unit));
            return Ok(Source { layer, weights, standard_error, notes });
        }
    }
    let names = meta.headers.iter().flat_map(|header| &header.channels.list).take(16);
    let names: Vec<String> = names.map(|channel| channel.name.to_string()).collect();
    Err(ImageError::Channels(names.join(", ")))
}

fn is_named(channel: &ChannelDescription, name: &str, plain: bool) -> bool {
    let full = channel.name.to_string();
    if plain { full == name } else { full.rsplit('.').next() == Some(name) }
}

fn pairs(c: &Chromaticities) -> [[f64; 2]; 4] {
    [c.red, c.green, c.blue, c.white].map(|pair| [f64::from(pair.0), f64::from(pair.1)])
}

/// Samples of a decoded line, which the library leaves in the byte order of the machine.
fn samples(bytes: &[u8], kind: SampleType) -> impl Iterator<Item = f64> + '_ {
    bytes.chunks_exact(kind.bytes_per_sample()).map(move |bytes| match (kind, bytes) {
        (SampleType::F16, [a, b]) => f16::from_ne_bytes([*a, *b]).to_f64(),
        (SampleType::F32, [a, b, c, d]) => f64::from(f32::from_ne_bytes([*a, *b, *c, *d])),
        (SampleType::U32, [a, b, c, d]) => f64::from(u32::from_ne_bytes([*a, *b, *c, *d])),
        _ => f64::NAN,
    })
}

/// Says how many NaN and infinities there are and where the first one: what they mean is not decided here.
fn count_non_numbers(values: &[f64], width: usize, notes: &mut Vec<String>) {
    let (mut count, mut first, mut negative) = (0usize, 0, 0usize);
    for (index, value) in values.iter().enumerate() {
        negative += usize::from(*value < 0.0 && value.is_finite());
        if !value.is_finite() {
            if count == 0 {
                first = index;
            }
            count += 1;
        }
    }
    if count > 0 {
        let (column, row) = (first % width, first / width);
        notes.push(format!(
            "{count} pixels are no finite number, the first one in column {column} of row {row}"
        ));
    }
    if negative > 0 {
        notes.push(format!("{negative} pixels are negative"));
    }
}

/// Writes luminances in cd/m² as channel `Y` and their standard errors as `se`, both in single
/// precision, without loss otherwise. `whiteLuminance` is 1, the view stands in attribute `radianceView`.
///
/// # Errors
/// [`ImageError::Exr`] if the library cannot encode the image.
pub fn write(image: &LuminanceImage) -> Result<Vec<u8>, ImageError> {
    let channel = |name: &str, values: &[f64]| {
        AnyChannel::new(name, FlatSamples::F32(values.iter().map(|&value| value as f32).collect()))
    };
    let mut channels = vec![channel("Y", &image.luminance_cd_m2)];
    channels.extend(image.standard_error_cd_m2.as_ref().map(|values| channel("se", values)));
    let attributes = LayerAttributes {
        software_name: Some(Text::from(concat!("gershun ", env!("CARGO_PKG_VERSION")))),
        white_luminance: Some(1.0),
        comments: (!image.notes.is_empty())
            .then(|| Text::new_or_none(ascii(&image.notes.join("\n"))))
            .flatten(),
        ..LayerAttributes::default()
    };
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let layer = Layer::new((image.width, image.height), attributes, Encoding::SMALL_FAST_LOSSLESS, channels);
    let mut whole = Image::from_layer(layer);
    // The only entry of this map: its order would not be the same in every run.
    if let Some(view) = image.view {
        whole
            .attributes
            .other
            .insert(Text::from(VIEW), AttributeValue::Text(Text::from(view.to_options().as_str())));
    }
    let mut bytes = Cursor::new(Vec::new());
    whole.write().non_parallel().to_buffered(&mut bytes).map_err(fault)?;
    Ok(bytes.into_inner())
}

/// Texts of a header have one byte a character.
fn ascii(text: &str) -> String {
    text.replace('²', "2").replace(['–', '—', '−'], "-").chars().filter(char::is_ascii).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Projection, View};
    use glam::DVec3;

    fn sample() -> LuminanceImage {
        let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
        let view = View::new(projection, DVec3::new(1.0, 2.0, 1.2), DVec3::X, DVec3::Z).expect("a view");
        let luminance: Vec<f64> = (0..21 * 13).map(|k| f64::from(k) * 0.5).collect();
        let mut image = LuminanceImage::new(21, 13, Some(view), luminance);
        image.standard_error_cd_m2 = Some(vec![0.25; 21 * 13]);
        image.notes.push("no interval – 3 cd/m²".into());
        image
    }

    /// Catches: rows turned around, a lost view or error channel, bytes that differ from run to run.
    #[test]
    fn what_is_written_comes_back() {
        let image = sample();
        let bytes = write(&image).expect("encoded");
        assert_eq!(bytes, write(&image).expect("encoded"));
        let back = read(&bytes).expect("own bytes");
        assert_eq!(back.notes, Vec::<String>::new());
        assert_eq!(back.view, image.view);
        assert_eq!(back.standard_error_cd_m2, image.standard_error_cd_m2);
        assert_eq!(back.luminance_cd_m2, image.luminance_cd_m2);
    }

    /// Catches: a panic or endless memory on damaged bytes.
    #[test]
    fn flipped_bytes_end_in_an_image_or_an_error() {
        let bytes = write(&sample()).expect("encoded");
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1 << (at % 8);
            let _ = read(&damaged);
            if at % 7 == 0 {
                assert!(read(&bytes[..at]).is_err(), "cut at {at}");
            }
        }
    }

    /// Catches: NaN in a luminance image, or its silent loss.
    #[test]
    fn pixels_that_are_no_numbers_are_counted() {
        let mut image = LuminanceImage::new(9, 8, None, vec![1.0; 72]);
        image.luminance_cd_m2[20] = f64::NAN;
        image.luminance_cd_m2[30] = f64::INFINITY;
        image.luminance_cd_m2[31] = -1.0;
        let back = read(&write(&image).expect("encoded")).expect("own bytes");
        assert!(back.luminance_cd_m2[20].is_nan() && back.luminance_cd_m2[30] > 1e300);
        let notes = back.notes.join("; ");
        assert!(
            notes.contains("2 pixels are no finite number") && notes.contains("column 2 of row 2"),
            "{notes}"
        );
        assert!(notes.contains("1 pixels are negative"), "{notes}");
    }
}
