//! The check picture: the image in grey by the logarithm of its luminance, every glare source in a
//! colour of its own, so that one sees what was taken for a source and what was not.

use super::super::xml::{escape, put};
use super::{Evaluated, png};
use crate::glare::of_image::ImageGlare;

/// Colours of the sources, used in turn; told apart by people with any colour vision.
const COLOURS: [[u8; 3]; 8] = [
    [230, 97, 1],
    [94, 60, 153],
    [0, 136, 55],
    [202, 0, 32],
    [5, 113, 176],
    [166, 97, 26],
    [208, 28, 139],
    [77, 172, 38],
];
/// Shades of grey; palette entries from here on are colours.
const GREYS: usize = 128;
/// Shades of each colour, by the luminance within the source.
const SHADES: usize = 16;
/// Decades of luminance below the highest that are told apart.
const DECADES: f64 = 4.0;

/// The picture as PNG, pixel by pixel, with the sources numbered as in the list.
pub fn check_png(image: &Evaluated) -> Vec<u8> {
    let size = image.glare.field.size;
    let mut pixels = pixels(&image.glare);
    let dot = (letter_px(size) / DIGIT[1] as f64).round() as usize;
    for (number, centre) in centres(&image.glare).into_iter().enumerate() {
        write_number(&mut pixels, size, number + 1, centre, dot);
    }
    png::encode(size[0], &pixels, &palette())
}

/// The picture without numbers.
fn bare_png(image: &Evaluated) -> Vec<u8> {
    png::encode(image.glare.field.size[0], &pixels(&image.glare), &palette())
}

/// Height of a number, pixels.
fn letter_px([_, height]: [usize; 2]) -> f64 {
    (height as f64 / 30.0).max(9.0)
}

/// Columns and rows of a digit.
const DIGIT: [usize; 2] = [3, 5];
/// Digits, row by row from the top, three bits each.
const DIGITS: [[u8; DIGIT[1]]; 10] = [
    [7, 5, 5, 5, 7],
    [2, 6, 2, 2, 7],
    [7, 1, 7, 4, 7],
    [7, 1, 7, 1, 7],
    [5, 5, 7, 1, 1],
    [7, 4, 7, 1, 7],
    [7, 4, 7, 5, 7],
    [7, 1, 2, 2, 2],
    [7, 5, 7, 5, 7],
    [7, 5, 7, 1, 7],
];

/// Writes a number in white with a black rim about a place, in dots of so many pixels; what leaves the picture is
/// cut off.
fn write_number(pixels: &mut [u8], size: [usize; 2], number: usize, centre: [f64; 2], dot: usize) {
    let digits: Vec<usize> = number.to_string().bytes().map(|digit| usize::from(digit - b'0')).collect();
    let dots_across = digits.len() * (DIGIT[0] + 1) - 1;
    let corner = |at: f64, dots: usize| (at - (dots * dot) as f64 / 2.0).round();
    let start = [corner(centre[0], dots_across), corner(centre[1], DIGIT[1])];
    let mut fill = |corner: [f64; 2], edge: f64, shade: u8| {
        let [columns, rows] = [0, 1].map(|axis| {
            let within = |at: f64| at.clamp(0.0, size[axis] as f64) as usize;
            within(corner[axis])..within(corner[axis] + edge)
        });
        for row in rows {
            pixels[row * size[0] + columns.start..row * size[0] + columns.end].fill(shade);
        }
    };
    let rim = (dot / 2).max(1) as f64;
    for (shade, wider) in [(0, rim), (GREYS as u8 - 1, 0.0)] {
        for (place, &digit) in digits.iter().enumerate() {
            for (row, bits) in DIGITS[digit].iter().enumerate() {
                for column in (0..DIGIT[0]).filter(|column| bits >> (DIGIT[0] - 1 - column) & 1 == 1) {
                    let x = start[0] + (dot * (place * (DIGIT[0] + 1) + column)) as f64;
                    let y = start[1] + (dot * row) as f64;
                    fill([x - wider, y - wider], dot as f64 + 2.0 * wider, shade);
                }
            }
        }
    }
}

/// The picture as SVG with the sources numbered as in the list.
pub fn check_svg(image: &Evaluated) -> String {
    let [width, height] = image.glare.field.size;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\">\n<title>{}</title>\n<image width=\"{width}\" height=\"{height}\" \
         href=\"data:image/png;base64,{}\"/>\n",
        escape(&image.file),
        base64(&bare_png(image)),
    );
    let size = letter_px([width, height]);
    for (number, [column, row]) in centres(&image.glare).into_iter().enumerate() {
        put(
            &mut svg,
            format_args!(
                "<text x=\"{column:.1}\" y=\"{row:.1}\" font-family=\"sans-serif\" font-size=\"{size:.1}\" \
                 text-anchor=\"middle\" dominant-baseline=\"central\" fill=\"#fff\" stroke=\"#000\" \
                 stroke-width=\"{:.2}\" paint-order=\"stroke\">{}</text>\n",
                size / 6.0,
                number + 1
            ),
        );
    }
    svg.push_str("</svg>\n");
    svg
}

fn palette() -> Vec<[u8; 3]> {
    let mut palette: Vec<[u8; 3]> = (0..GREYS).map(|grey| [(grey * 255 / (GREYS - 1)) as u8; 3]).collect();
    for colour in COLOURS {
        for shade in 0..SHADES {
            let bright = 0.45 + 0.55 * shade as f64 / (SHADES - 1) as f64;
            palette.push(colour.map(|part| (f64::from(part) * bright) as u8));
        }
    }
    palette
}

/// Number in the palette for every pixel of the image; what is not in the field is black.
fn pixels(glare: &ImageGlare) -> Vec<u8> {
    let [width, height] = glare.field.size;
    let mut pixels = vec![0u8; width * height];
    let highest = glare.field.pixels.iter().map(|pixel| pixel.luminance).fold(0.0, f64::max);
    let level = |luminance: f64| {
        let decades = (luminance.max(f64::MIN_POSITIVE) / highest.max(f64::MIN_POSITIVE)).log10();
        (1.0 + decades / DECADES).clamp(0.0, 1.0)
    };
    for (pixel, &label) in glare.field.pixels.iter().zip(&glare.found.labels) {
        let level = level(pixel.luminance);
        pixels[pixel.index as usize] = if label == 0 {
            (level * (GREYS - 1) as f64) as u8
        } else {
            let colour = (label as usize - 1) % COLOURS.len();
            (GREYS + colour * SHADES + (level * (SHADES - 1) as f64) as usize) as u8
        };
    }
    pixels
}

/// Mean place of each source's pixels, in pixels from the upper left.
fn centres(glare: &ImageGlare) -> Vec<[f64; 2]> {
    let width = glare.field.size[0].max(1);
    let mut sums = vec![[0.0f64; 3]; glare.sources.len()];
    for (pixel, &label) in glare.field.pixels.iter().zip(&glare.found.labels).filter(|(_, l)| **l > 0) {
        let sum = &mut sums[label as usize - 1];
        let index = pixel.index as usize;
        sum[0] += (index % width) as f64 + 0.5;
        sum[1] += (index / width) as f64 + 0.5;
        sum[2] += 1.0;
    }
    sums.into_iter().map(|[column, row, count]| [column / count, row / count]).collect()
}

pub(super) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for triple in bytes.chunks(3) {
        let part = |index: usize| triple.get(index).map_or(0, |&byte| u32::from(byte));
        let word = part(0) << 16 | part(1) << 8 | part(2);
        for digit in 0..4 {
            let known = digit <= triple.len();
            let value = (word >> (18 - 6 * digit)) & 63;
            text.push(if known { char::from(DIGITS[value as usize]) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_rfc_4648() {
        for (plain, text) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), text);
        }
    }

    /// Catches: numbers that are missing, mirrored, or written outside of the picture.
    #[test]
    fn numbers_are_written_where_their_sources_are() {
        let size = [20, 12];
        let mut pixels = vec![50; size[0] * size[1]];
        write_number(&mut pixels, size, 41, [10.0, 6.0], 1);
        let white = GREYS as u8 - 1;
        let rows: Vec<String> = pixels
            .chunks(size[0])
            .map(|row| row.iter().map(|&shade| if shade == white { '#' } else { ' ' }).collect::<String>())
            .map(|row| row.trim_end().to_owned())
            .filter(|row| !row.is_empty())
            .collect();
        let left = " ".repeat(7);
        let wanted = ["# #  #", "# # ##", "###  #", "  #  #", "  # ###"].map(|row| format!("{left}{row}"));
        assert_eq!(rows, wanted);
        assert!(pixels.contains(&0), "there is a rim");
        for corner in [[0.0, 0.0], [20.0, 12.0], [-50.0, 600.0]] {
            write_number(&mut pixels, size, 1234, corner, 3);
        }
    }

    #[test]
    fn the_palette_fits_a_byte() {
        assert_eq!(palette().len(), GREYS + COLOURS.len() * SHADES);
        assert!(palette().len() <= 256);
    }
}
