//! SVG by plotters' backend: lines, polygons and text. The backend knows whole pixels only, so
//! everything is drawn four times as large as it is shown. Regions with holes and clipping, which
//! the backend lacks, are written as they are.

use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, IntoFont, RGBColor, ShapeStyle, TextStyle};

use super::xml::{self, put};

/// Drawing units per shown pixel.
const FINENESS: f64 = 4.0;

/// A place on the canvas, px from its upper left corner.
pub type Px = [f64; 2];

/// Colour as red, green, blue.
pub type Rgb = [u8; 3];

/// How a text stands at its place.
#[derive(Clone, Copy, Debug)]
pub struct Lettering {
    /// Font size, px.
    pub size: f64,
    /// Where the place is in the text.
    pub anchor: Anchor,
    /// Weight.
    pub weight: Weight,
    /// Colour.
    pub colour: Rgb,
}

/// Horizontal place of a text; vertically it is centred.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The place is the text's start.
    Start,
    /// The place is the text's middle.
    Middle,
    /// The place is the text's end.
    End,
}

/// Weight of a font.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// Normal.
    Normal,
    /// Bold.
    Bold,
}

/// A drawing in progress.
#[derive(Debug)]
pub struct Canvas {
    body: String,
    size: (u32, u32),
}

fn unit(px: f64) -> i32 {
    (px * FINENESS).round() as i32
}

fn coord(place: Px) -> (i32, i32) {
    (unit(place[0]), unit(place[1]))
}

fn style(colour: Rgb, opacity: f64, width_px: f64) -> ShapeStyle {
    let [r, g, b] = colour;
    ShapeStyle {
        color: RGBColor(r, g, b).mix(opacity),
        filled: true,
        stroke_width: unit(width_px).max(1) as u32,
    }
}

impl Canvas {
    /// An empty drawing.
    pub fn new(width_px: f64, height_px: f64) -> Self {
        Self { body: String::new(), size: (unit(width_px) as u32, unit(height_px) as u32) }
    }

    fn ink<E: std::fmt::Debug>(&mut self, draw: impl FnOnce(&mut SVGBackend<'_>) -> Result<(), E>) {
        let mut buffer = String::new();
        let mut backend = SVGBackend::with_string(&mut buffer, self.size);
        draw(&mut backend).expect("drawing into a string cannot fail");
        drop(backend);
        let inner = buffer.split_once('\n').map_or("", |(_, inner)| inner).trim_end();
        let inner = inner.strip_suffix("</svg>").unwrap_or(inner);
        // A name cannot hold these: its quotes are escaped.
        self.body.push_str(
            &inner
                .replace(" opacity=\"1\"", "")
                .replace(" font-family=\"sans-serif\"", "")
                .replace(" \"/>", "\"/>"),
        );
    }

    /// A line through places.
    pub fn line(&mut self, places: &[Px], colour: Rgb, width_px: f64) {
        self.ink(|backend| {
            backend.draw_path(places.iter().copied().map(coord), &style(colour, 1.0, width_px))
        });
    }

    /// A closed line through places.
    pub fn ring(&mut self, places: &[Px], colour: Rgb, width_px: f64) {
        let closed: Vec<Px> = places.iter().chain(places.first()).copied().collect();
        self.line(&closed, colour, width_px);
    }

    /// A filled polygon.
    pub fn polygon(&mut self, places: &[Px], colour: Rgb, opacity: f64) {
        self.ink(|backend| {
            backend.fill_polygon(places.iter().copied().map(coord), &style(colour, opacity, 1.0))
        });
    }

    /// A filled rectangle.
    pub fn rectangle(&mut self, from: Px, to: Px, colour: Rgb, opacity: f64) {
        self.ink(|backend| backend.draw_rect(coord(from), coord(to), &style(colour, opacity, 1.0), true));
    }

    /// A circle, filled or not.
    pub fn circle(&mut self, centre: Px, radius_px: f64, colour: Rgb, fill: bool) {
        self.ink(|backend| {
            backend.draw_circle(coord(centre), unit(radius_px) as u32, &style(colour, 1.0, 1.2), fill)
        });
    }

    /// A line of text.
    pub fn text(&mut self, place: Px, text: &str, lettering: Lettering) {
        let [r, g, b] = lettering.colour;
        // plotters divides by 1.24 on its way to SVG.
        let font = ("sans-serif", (lettering.size * FINENESS).round() * 1.24).into_font();
        let font = match lettering.weight {
            Weight::Normal => font,
            Weight::Bold => font.style(plotters::style::FontStyle::Bold),
        };
        let side = match lettering.anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let colour = RGBColor(r, g, b);
        let style = TextStyle::from(font).color(&colour).pos(Pos::new(side, VPos::Center));
        self.ink(|backend| backend.draw_text(&xml::printable(text), &style, coord(place)));
    }

    /// Regions bounded by rings, by the even-odd rule.
    pub fn regions<'a>(&mut self, rings: impl Iterator<Item = &'a [Px]>, colour: Rgb) {
        let [r, g, b] = colour;
        let data = path_data(rings, "Z");
        if !data.is_empty() {
            put(
                &mut self.body,
                format_args!("<path fill=\"#{r:02X}{g:02X}{b:02X}\" fill-rule=\"evenodd\" d=\"{data}\"/>\n"),
            );
        }
    }

    /// A PNG image.
    pub fn picture(&mut self, from: Px, to: Px, png: &[u8]) {
        let ((x, y), (right, bottom)) = (coord(from), coord(to));
        let (width, height) = (right - x, bottom - y);
        let data = base64(png);
        put(
            &mut self.body,
            format_args!(
                "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{data}\"/>\n"
            ),
        );
    }

    /// Many lines of one kind.
    pub fn lines<'a>(&mut self, lines: impl Iterator<Item = &'a [Px]>, colour: Rgb, width_px: f64) {
        let [r, g, b] = colour;
        let data = path_data(lines, "");
        if !data.is_empty() {
            let width = unit(width_px);
            put(
                &mut self.body,
                format_args!(
                    "<path fill=\"none\" stroke=\"#{r:02X}{g:02X}{b:02X}\" stroke-width=\"{width}\" d=\"{data}\"/>\n"
                ),
            );
        }
    }

    /// From here to [`Canvas::end_clip`] nothing is shown outside a rectangle.
    pub fn clip(&mut self, from: Px, to: Px) {
        let ((x, y), (right, bottom)) = (coord(from), coord(to));
        let (width, height) = (right - x, bottom - y);
        put(
            &mut self.body,
            format_args!(
                "<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"{x} {y} {width} {height}\" overflow=\"hidden\">\n"
            ),
        );
    }

    /// Ends [`Canvas::clip`].
    pub fn end_clip(&mut self) {
        self.body.push_str("</svg>\n");
    }

    /// The drawing as one SVG element.
    pub fn finish(self, title: &str) -> String {
        let (width, height) = self.size;
        let (shown_width, shown_height) = (f64::from(width) / FINENESS, f64::from(height) / FINENESS);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{shown_width}\" height=\"{shown_height}\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" role=\"img\">\n<title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n{}</svg>\n",
            xml::escape(title),
            self.body
        )
    }
}

fn path_data<'a>(lines: impl Iterator<Item = &'a [Px]>, end: &str) -> String {
    let mut data = String::new();
    for line in lines {
        for (index, place) in line.iter().enumerate() {
            let (x, y) = coord(*place);
            put(&mut data, format_args!("{}{x} {y}", if index == 0 { "M" } else { "L" }));
        }
        data.push_str(end);
    }
    data
}

/// RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let group =
            chunk.iter().fold(0u32, |sum, &byte| sum << 8 | u32::from(byte)) << (8 * (3 - chunk.len()));
        for place in 0..4 {
            let letter = LETTERS[(group >> (18 - 6 * place) & 63) as usize];
            text.push(if place > chunk.len() { '=' } else { char::from(letter) });
        }
    }
    text
}

/// Width of a text, px, by the average width of sans-serif letters.
pub fn text_width(text: &str, size_px: f64) -> f64 {
    0.63 * size_px * text.chars().count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a wrong padding, bits in the wrong order. Examples of RFC 4648.
    #[test]
    fn base64_has_its_examples() {
        for (plain, coded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}
