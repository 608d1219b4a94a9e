//! False colours for luminances: a logarithmic scale and colours of even perceptual steps (viridis,
//! van der Walt & Smith 2015, CC0), also for the colour-blind. Dark means little light.

use rayon::prelude::*;

use super::ReportError;
use super::canvas::Rgb;

/// Every tenth of the scale.
const VIRIDIS: [Rgb; 11] = [
    [68, 1, 84],
    [72, 36, 117],
    [65, 68, 135],
    [53, 95, 141],
    [42, 120, 142],
    [33, 145, 140],
    [34, 168, 132],
    [68, 191, 112],
    [122, 209, 81],
    [189, 223, 38],
    [253, 231, 37],
];
/// Colours of a picture: as many as eight bits of a component can tell apart.
const RAMP: usize = 1024;
/// Pixels that are coloured together.
const PART: usize = 1 << 13;
/// What lies outside of the projection.
const OUTSIDE: Rgb = [255, 255, 255];

/// Range of a logarithmic scale, cd/m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Luminance of the darkest colour.
    pub low: f64,
    /// Luminance of the brightest colour.
    pub high: f64,
}

impl Scale {
    /// The range from the darkest hundredth to the brightest thousandth of the pixels, widened to
    /// 1, 2 or 5 times a power of ten and to at least two decades' ends.
    pub fn of(luminances: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = luminances.filter(|value| *value > 0.0 && value.is_finite()).collect();
        if values.is_empty() {
            return Self { low: 0.1, high: 1000.0 };
        }
        let last = values.len() - 1;
        let mut at = |share: f64| {
            *values.select_nth_unstable_by((last as f64 * share).round() as usize, f64::total_cmp).1
        };
        let high = step_from(at(0.999), true);
        let low = step_from(at(0.01), false).max(high * 1e-6).min(high / 10.0);
        Self { low, high }
    }

    /// Position of a luminance on the scale, 0 … 1.
    pub fn position(self, luminance: f64) -> f64 {
        if !(luminance > self.low) {
            return 0.0;
        }
        ((luminance / self.low).ln() / (self.high / self.low).ln()).min(1.0)
    }

    /// The values to write on the scale: 1, 2 and 5 of every decade, or 1 only where that is too much.
    pub fn marks(self) -> Vec<f64> {
        let decades = (self.high / self.low).log10();
        let steps: &[f64] = if decades > 3.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let first = self.low.log10().floor() as i32;
        let last = self.high.log10().ceil() as i32;
        let all = (first..=last).flat_map(|decade| steps.iter().map(move |step| step * 10f64.powi(decade)));
        all.filter(|mark| *mark > self.low * 0.999 && *mark < self.high * 1.001).collect()
    }
}

/// The next of 1, 2, 5 × 10^k at or beyond `value`.
fn step_from(value: f64, up: bool) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0];
    let mantissa = value / decade;
    let found = if up {
        steps.iter().copied().find(|step| *step >= mantissa * (1.0 - 1e-9))
    } else {
        steps.iter().rev().copied().find(|step| *step <= mantissa * (1.0 + 1e-9))
    };
    found.unwrap_or(if up { 10.0 } else { 1.0 }) * decade
}

/// Colour at a position of the scale.
pub fn colour(position: f64) -> Rgb {
    let along = position.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let first = (along as usize).min(VIRIDIS.len() - 2);
    let rest = along - first as f64;
    std::array::from_fn(|k| {
        let (a, b) = (f64::from(VIRIDIS[first][k]), f64::from(VIRIDIS[first + 1][k]));
        (a + (b - a) * rest).round() as u8
    })
}

/// Colours of a picture row by row; `inside` says which pixels belong to it.
pub fn colours(luminances: &[f64], scale: Scale, inside: impl Fn(usize) -> bool + Sync) -> Vec<u8> {
    let ramp: [Rgb; RAMP] = std::array::from_fn(|k| colour(k as f64 / (RAMP - 1) as f64));
    let mut pixels = vec![0; 3 * luminances.len()];
    let parts = pixels.par_chunks_mut(3 * PART).zip(luminances.par_chunks(PART)).enumerate();
    parts.for_each(|(part, (pixels, luminances))| {
        for (index, (pixel, &luminance)) in pixels.chunks_exact_mut(3).zip(luminances).enumerate() {
            let shown = || ramp[(scale.position(luminance) * (RAMP - 1) as f64).round() as usize];
            pixel.copy_from_slice(&if inside(part * PART + index) { shown() } else { OUTSIDE });
        }
    });
    pixels
}

/// PNG of 8-bit colours.
pub fn png(
    width: usize,
    height: usize,
    colours: &[u8],
    remarks: &[(&str, &str)],
) -> Result<Vec<u8>, ReportError> {
    let fault = |error: png::EncodingError| ReportError::Picture(error.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    for (key, text) in remarks {
        encoder.add_itxt_chunk((*key).to_owned(), (*text).to_owned()).map_err(fault)?;
    }
    let mut writer = encoder.write_header().map_err(fault)?;
    writer.write_image_data(colours).map_err(fault)?;
    writer.finish().map_err(fault)?;
    Ok(bytes)
}

/// Width of the scale beside a PNG, px.
pub const BAR: usize = 92;

/// A picture with its scale at the right: colours, marks and digits drawn as pixels.
pub fn with_bar(width: usize, height: usize, colours: &[u8], scale: Scale) -> (usize, Vec<u8>) {
    let whole = width + BAR;
    let mut pixels = vec![255u8; whole * height * 3];
    for (row, line) in colours.chunks(width * 3).enumerate() {
        pixels[row * whole * 3..][..line.len()].copy_from_slice(line);
    }
    let mut put = |column: usize, row: usize, rgb: Rgb| {
        if column < whole && row < height {
            pixels[(row * whole + column) * 3..][..3].copy_from_slice(&rgb);
        }
    };
    let (top, bottom) = (24.min(height - 1), height.saturating_sub(10).max(25.min(height - 1)));
    let length = (bottom - top).max(1) as f64;
    for row in top..bottom {
        let position = 1.0 - (row - top) as f64 / length;
        for column in width + 10..width + 28 {
            put(column, row, colour(position));
        }
    }
    letters(&mut put, width + 10, 6, "cd/m2");
    for mark in scale.marks() {
        let row = top + ((1.0 - scale.position(mark)) * length) as usize;
        for column in width + 28..width + 33 {
            put(column, row, [0; 3]);
        }
        let text = if mark >= 1.0 { format!("{mark:.0}") } else { format!("{}", (mark * 1e6).round() / 1e6) };
        letters(&mut put, width + 37, row.saturating_sub(5), &text);
    }
    (whole, pixels)
}

/// Letters of 3 × 5 squares (m: 5 × 5), each square 2 × 2 px.
fn letters(put: &mut impl FnMut(usize, usize, Rgb), column: usize, row: usize, text: &str) {
    let mut left = column;
    for letter in text.chars() {
        let (wide, rows): (usize, [u8; 5]) = match letter {
            '0' => (3, [7, 5, 5, 5, 7]),
            '1' => (3, [2, 6, 2, 2, 7]),
            '2' => (3, [7, 1, 7, 4, 7]),
            '3' => (3, [7, 1, 7, 1, 7]),
            '4' => (3, [5, 5, 7, 1, 1]),
            '5' => (3, [7, 4, 7, 1, 7]),
            '6' => (3, [7, 4, 7, 5, 7]),
            '7' => (3, [7, 1, 1, 1, 1]),
            '8' => (3, [7, 5, 7, 5, 7]),
            '9' => (3, [7, 5, 7, 1, 7]),
            'c' => (3, [0, 7, 4, 4, 7]),
            'd' => (3, [1, 7, 5, 5, 7]),
            'm' => (5, [0, 31, 21, 21, 21]),
            '/' => (3, [1, 1, 2, 4, 4]),
            _ => (1, [0, 0, 0, 0, 1]),
        };
        for (y, bits) in rows.iter().enumerate() {
            for x in (0..wide).filter(|x| bits >> (wide - 1 - x) & 1 == 1) {
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    put(left + 2 * x + dx, row + 2 * y + dy, [0; 3]);
                }
            }
        }
        left += 2 * wide + 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a scale that loses luminaires or is all one colour, marks beside the scale.
    #[test]
    fn the_scale_holds_what_is_seen() {
        let room = (0..10_000).map(|k| if k < 100 { 6000.0 } else { 20.0 + f64::from(k) / 100.0 });
        let scale = Scale::of(room);
        assert_eq!(scale, Scale { low: 20.0, high: 10_000.0 });
        assert_eq!(scale.marks(), [20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10_000.0]);
        assert!((scale.position(20.0) - 0.0).abs() < 1e-12 && (scale.position(1e4) - 1.0).abs() < 1e-12);
        assert!((scale.position((20.0f64 * 1e4).sqrt()) - 0.5).abs() < 1e-12);
        assert_eq!(Scale::of(std::iter::repeat_n(50.0, 100)), Scale { low: 5.0, high: 50.0 });
        assert_eq!(Scale::of([0.0, f64::NAN].into_iter()), Scale { low: 0.1, high: 1000.0 });
    }

    /// Catches: brightness that does not rise with luminance: the colours would then lie.
    #[test]
    fn colours_grow_lighter() {
        let lightness =
            |[r, g, b]: Rgb| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        let steps: Vec<f64> = (0..=100).map(|k| lightness(colour(f64::from(k) / 100.0))).collect();
        assert!(steps.windows(2).all(|pair| pair[1] >= pair[0] - 0.5), "{steps:?}");
        assert_eq!((colour(0.0), colour(1.0)), (VIRIDIS[0], VIRIDIS[10]));
    }

    /// Catches: rows in disorder, a bar over the picture.
    #[test]
    fn a_png_comes_back() {
        let colours: Vec<u8> = (0..40 * 60 * 3).map(|k| (k % 251) as u8).collect();
        let (whole, pixels) = with_bar(40, 60, &colours, Scale { low: 1.0, high: 100.0 });
        let bytes = png(whole, 60, &pixels, &[("Comment", "cd/m²")]).expect("encoded");
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
        let mut back = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut back).expect("pixels");
        assert_eq!(back, pixels);
        assert_eq!(back[whole * 3..][..120], colours[120..240]);
        for (width, height) in [(1, 1), (3, 2)] {
            with_bar(width, height, &vec![0; width * height * 3], Scale { low: 1.0, high: 10.0 });
        }
    }
}
