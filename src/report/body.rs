//! Luminance bodies: a table of all directions, and a drawing of three sections.

use super::ReportError;
use super::canvas::{Anchor, Canvas, Lettering, Px, Rgb, Weight};
use super::number::{figures, fixed};
use super::words::Lang;
use crate::observe::body::LuminanceBody;

/// Radius of a section, px.
const RADIUS: f64 = 150.0;
const PANEL: f64 = 360.0;
const TOP: f64 = 96.0;
/// Decades of luminance that a section shows at most.
const DECADES: f64 = 5.0;
const INK: Rgb = [40, 40, 40];
const RULE: Rgb = [205, 205, 205];
const BODY: Rgb = [33, 102, 172];

/// A row for every direction.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn body_csv(body: &LuminanceBody) -> Result<String, ReportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header = "azimuth_deg,elevation_deg,solid_angle_sr,luminance_cd_m2,se_cd_m2";
    writer.write_record(header.split(','))?;
    for (index, cell) in body.cells.iter().enumerate() {
        let ([azimuth, elevation], solid_angle_sr) = body.cell(index);
        let row = [azimuth, elevation, solid_angle_sr, cell.value, cell.se];
        writer.write_record(row.map(|value| value.to_string()))?;
    }
    let bytes = writer.into_inner().expect("a vector takes any bytes");
    Ok(String::from_utf8(bytes).expect("only text was written"))
}

/// One line for the terminal.
pub fn body_line(lang: Lang, body: &LuminanceBody) -> String {
    let vector = glam::DVec3::from_array(body.vector_lx.map(|component| component.value));
    let [azimuth, elevation] = [vector.y.atan2(vector.x), vector.z.atan2(vector.x.hypot(vector.y))]
        .map(|angle| fixed(lang, angle.to_degrees() + 0.0, 0));
    let spherical = body.spherical_lx;
    let length = figures(lang, vector.length(), 3);
    let [value, se] = [spherical.value, spherical.se].map(|lx| figures(lang, lx, 3));
    let ratio = fixed(lang, vector.length() / spherical.value, 2);
    match lang {
        Lang::En => format!(
            "{} · {} · light vector {length} lx towards azimuth {azimuth}°, elevation {elevation}° · mean spherical illuminance {value} ± {se} lx (1 standard error) · vector/scalar {ratio} · {} blocks\n",
            body.name, body.light_scene, body.blocks
        ),
        Lang::Ru => format!(
            "{} · {} · световой вектор {length} лк, азимут {azimuth}°, возвышение {elevation}° · средняя сферическая освещённость {value} ± {se} лк (стандартная ошибка) · вектор/скаляр {ratio} · блоков: {}\n",
            body.name, body.light_scene, body.blocks
        ),
    }
}

/// What is not in a body.
pub fn body_note(lang: Lang, body: &LuminanceBody) -> Option<&'static str> {
    body.lacks_points.then_some(match lang {
        Lang::En => "point sources have no luminance: their direct light is not in the luminance body",
        Lang::Ru => "у точечных источников нет яркости: их прямой свет в тело яркости не входит",
    })
}

/// Three sections through the body: radius is the logarithm of luminance.
pub fn body_svg(lang: Lang, body: &LuminanceBody) -> String {
    let (title, sections) = match lang {
        Lang::En => {
            ("Luminance body", ["horizontal, x to the right", "vertical along x", "vertical along y"])
        }
        Lang::Ru => {
            ("Тело яркости", ["горизонтальное, x вправо", "вертикальное вдоль x", "вертикальное вдоль y"])
        }
    };
    let largest = body.cells.iter().map(|cell| cell.value).fold(0.0, f64::max);
    let top = if largest > 0.0 { largest.log10().ceil() } else { 0.0 };
    let smallest =
        body.cells.iter().map(|cell| cell.value).filter(|value| *value > 0.0).fold(largest, f64::min);
    let bottom =
        if smallest > 0.0 { smallest.log10().floor().clamp(top - DECADES, top - 1.0) } else { top - 1.0 };
    let mut canvas = Canvas::new(3.0 * PANEL, TOP + PANEL + 30.0);
    let heading = format!("{title} · {} · {}", body.name, body.light_scene);
    text(&mut canvas, [20.0, 26.0], &heading, 15.0, Anchor::Start, Weight::Bold);
    let line = body_line(lang, body);
    let figures: Vec<&str> = line.trim().split(" · ").skip(2).collect();
    text(&mut canvas, [20.0, 48.0], &figures.join(" · "), 11.0, Anchor::Start, Weight::Normal);
    if let Some(note) = body_note(lang, body) {
        text(&mut canvas, [20.0, 66.0], note, 11.0, Anchor::Start, Weight::Normal);
    }
    for (number, (section, words)) in
        [horizontal(body), vertical(body, 0), vertical(body, 1)].iter().zip(sections).enumerate()
    {
        let centre = [(number as f64 + 0.5) * PANEL, TOP + 0.5 * PANEL];
        text(&mut canvas, [centre[0], TOP - 8.0], words, 12.0, Anchor::Middle, Weight::Normal);
        draw(&mut canvas, centre, section, [bottom, top]);
        rings(&mut canvas, lang, centre, [bottom, top]);
    }
    canvas.finish(&heading)
}

/// Directions around a section, degrees from and to, with their luminance.
type Section = Vec<([f64; 2], f64)>;

/// The mean of the cells just above and just below the horizon.
fn horizontal(body: &LuminanceBody) -> Section {
    let step = 180.0 / body.elevations as f64;
    let value = |row: usize, column: usize| body.cells[row * body.azimuths + column].value;
    let half = body.elevations / 2;
    (0..body.azimuths)
        .map(|column| {
            let from = column as f64 * step;
            ([from, from + step], 0.5 * (value(half - 1, column) + value(half, column)))
        })
        .collect()
}

/// The half-planes of azimuth 0 and 180 (`axis` 0), or 90 and 270, each the mean of the cells beside it.
fn vertical(body: &LuminanceBody, axis: usize) -> Section {
    let step = 180.0 / body.elevations as f64;
    let quarter = body.azimuths / 4;
    let value = |row: usize, column: usize| {
        let [left, right] = [column + body.azimuths - 1, column]
            .map(|c| body.cells[row * body.azimuths + c % body.azimuths].value);
        0.5 * (left + right)
    };
    let (near, far) = (axis * quarter, (axis + 2) * quarter);
    let right = (0..body.elevations).map(|row| {
        let from = row as f64 * step - 90.0;
        ([from, from + step], value(row, near))
    });
    let left = (0..body.elevations).map(|row| {
        let from = 270.0 - row as f64 * step;
        ([from - step, from], value(row, far))
    });
    right.chain(left).collect()
}

fn draw(canvas: &mut Canvas, centre: Px, section: &Section, [bottom, top]: [f64; 2]) {
    for ([from, to], luminance) in section {
        if !(*luminance > 0.0) {
            continue;
        }
        let radius = RADIUS * ((luminance.log10() - bottom) / (top - bottom)).clamp(0.0, 1.0);
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            [centre[0] + radius * cos, centre[1] - radius * sin]
        };
        canvas.polygon(&[centre, at(*from), at(0.5 * (from + to)), at(*to)], BODY, 0.75);
    }
}

fn rings(canvas: &mut Canvas, lang: Lang, centre: Px, [bottom, top]: [f64; 2]) {
    for decade in 1..=(top - bottom).round() as i32 {
        let radius = RADIUS * f64::from(decade) / (top - bottom);
        canvas.circle(centre, radius, RULE, false);
        let value = 10_f64.powf(bottom + f64::from(decade));
        let unit = match lang {
            _ if f64::from(decade) < top - bottom - 0.5 => "",
            Lang::En => " cd/m²",
            Lang::Ru => " кд/м²",
        };
        let label = format!("{}{unit}", figures(lang, value, 1));
        text(
            canvas,
            [centre[0] + 4.0, centre[1] - radius - 6.0],
            &label,
            10.0,
            Anchor::Start,
            Weight::Normal,
        );
    }
}

fn text(canvas: &mut Canvas, place: Px, words: &str, size: f64, anchor: Anchor, weight: Weight) {
    canvas.text(place, words, Lettering { size, anchor, weight, colour: INK });
}
