//! Maps of glare: a table of every eye and direction, and a plan in which each eye's cell has the
//! colour of its worst direction and a small rose of all directions.

use super::super::ReportError;
use super::super::number::fixed;
use super::super::words::Lang;
use super::super::xml::{escape, put};
use crate::observe::map::{MapMethod, Mapped, approximations};
use crate::outcome::Interval;
use crate::units::Undefined;

const LANG: Lang = Lang::En;
/// Steps of UGR by which cells are coloured, as norms use them.
const STEPS: [f64; 6] = [13.0, 16.0, 19.0, 22.0, 25.0, 28.0];
/// Colour below the first step, between the steps, above the last.
const COLOURS: [&str; 7] = ["#e8f3ec", "#c5e3cf", "#f4efb8", "#f9d48a", "#f0a35e", "#dd6a4a", "#b5353b"];
/// Width of the drawing, px.
const WIDTH: f64 = 900.0;
const MARGIN: f64 = 30.0;

/// A row for every eye, direction and index.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn map_csv(map: &Mapped) -> Result<String, ReportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header = "map,light_scene,x_m,y_m,z_m,azimuth_deg,index,value,se,lo,hi,worst,undefined";
    writer.write_record(header.split(','))?;
    // What look-ups scatter by says nothing of what the field errs by.
    let holds = matches!(map.method, MapMethod::Unbiased(_));
    for eye in &map.eyes {
        let worst = eye.worst().map(|(number, _)| number);
        for (number, (ugr, further)) in eye.views.iter().enumerate() {
            let indices = further.iter().map(|index| (index.key.as_str(), &index.estimate));
            for (key, estimate) in std::iter::once(("UGR", ugr)).chain(indices) {
                let [value, se, lo, hi, undefined] = cells(estimate, holds);
                writer.write_record([
                    map.name.clone(),
                    map.light_scene.clone(),
                    eye.position.x.to_string(),
                    eye.position.y.to_string(),
                    eye.position.z.to_string(),
                    map.azimuths_deg[number].to_string(),
                    key.to_owned(),
                    value,
                    se,
                    lo,
                    hi,
                    (worst == Some(number)).to_string(),
                    undefined,
                ])?;
            }
        }
    }
    let bytes = writer.into_inner().expect("a vector takes any bytes");
    Ok(String::from_utf8(bytes).expect("only text was written"))
}

fn cells(estimate: &Result<Interval, Undefined>, holds: bool) -> [String; 5] {
    match estimate {
        Ok(interval) if !holds => {
            let mut cells = [const { String::new() }; 5];
            cells[0] = interval.value.to_string();
            cells
        }
        Ok(interval) => {
            let [value, se, lo, hi] =
                [interval.value, interval.se, interval.lo, interval.hi].map(|number| number.to_string());
            [value, se, lo, hi, String::new()]
        }
        Err(undefined) => {
            let mut cells = [const { String::new() }; 5];
            cells[4].clone_from(&undefined.reason);
            cells
        }
    }
}

/// One paragraph for the terminal.
pub fn map_text(map: &Mapped) -> String {
    let mut text = format!(
        "{} in {}: {} eyes at {} m, {} directions, light scene {}\n",
        map.name,
        map.room,
        map.eyes.len(),
        fixed(LANG, map.eyes.first().map_or(0.0, |eye| eye.position.z), 2),
        map.azimuths_deg.len(),
        map.light_scene,
    );
    let worst = map.eyes.iter().filter_map(|eye| Some((eye, eye.worst()?)));
    if let Some((eye, (direction, ugr))) = worst.max_by(|a, b| a.1.1.total_cmp(&b.1.1)) {
        put(
            &mut text,
            format_args!(
                "  worst UGR {} at ({}, {}) looking along {}°\n",
                fixed(LANG, ugr, 1),
                fixed(LANG, eye.position.x, 2),
                fixed(LANG, eye.position.y, 2),
                fixed(LANG, map.azimuths_deg[direction], 0),
            ),
        );
    }
    put(&mut text, format_args!("  convention: {}; initial flux\n", map.convention));
    for sentence in approximations(map) {
        put(&mut text, format_args!("  approximate: {sentence}\n"));
    }
    text
}

/// The plan.
pub fn map_svg(map: &Mapped) -> String {
    let points = map.footprint.iter().copied().chain(map.eyes.iter().map(|eye| eye.position.truncate()));
    let (mut low, mut high) = (glam::DVec2::INFINITY, glam::DVec2::NEG_INFINITY);
    for point in points {
        (low, high) = (low.min(point), high.max(point));
    }
    let scale = (WIDTH - 2.0 * MARGIN) / (high.x - low.x).max(1e-9);
    let legend_px = 64.0 + 14.0 * approximations(map).len() as f64;
    let height = (high.y - low.y) * scale + 2.0 * MARGIN + legend_px;
    let px = |x: f64, y: f64| [MARGIN + (x - low.x) * scale, MARGIN + (high.y - y) * scale];
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.1}\" font-family=\"sans-serif\" \
         font-size=\"11\">\n<title>{}: worst UGR of {} directions</title>\n",
        escape(&map.name),
        map.azimuths_deg.len()
    );
    let [u, v] = map.spacing;
    for eye in &map.eyes {
        let corner = |a: f64, b: f64| {
            let at = eye.position + a * u + b * v;
            let [x, y] = px(at.x, at.y);
            format!("{x:.1},{y:.1}")
        };
        let corners = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)].join(" ");
        let colour =
            eye.worst().map_or("#ffffff", |(_, ugr)| COLOURS[STEPS.partition_point(|step| *step <= ugr)]);
        put(&mut svg, format_args!("<polygon points=\"{corners}\" fill=\"{colour}\"/>\n"));
        rose(map, eye, &px, u.length().min(v.length()) * scale, &mut svg);
    }
    let outline: Vec<String> = map
        .footprint
        .iter()
        .map(|point| {
            let [x, y] = px(point.x, point.y);
            format!("{x:.1},{y:.1}")
        })
        .collect();
    put(
        &mut svg,
        format_args!(
            "<polygon points=\"{}\" fill=\"none\" stroke=\"#222\" stroke-width=\"2\"/>\n",
            outline.join(" ")
        ),
    );
    legend(map, height - legend_px + 6.0, scale, &mut svg);
    svg.push_str("</svg>\n");
    svg
}

/// A spoke for each direction, as long as UGR lies above 10, full at 30; the worst is bold.
fn rose(
    map: &Mapped,
    eye: &crate::observe::map::MappedEye,
    px: &impl Fn(f64, f64) -> [f64; 2],
    cell_px: f64,
    svg: &mut String,
) {
    let [x, y] = px(eye.position.x, eye.position.y);
    let worst = eye.worst().map(|(number, _)| number);
    for (number, (ugr, _)) in eye.views.iter().enumerate() {
        let Ok(ugr) = ugr else { continue };
        let length = 0.45 * cell_px * ((ugr.value - 10.0) / 20.0).clamp(0.02, 1.0);
        let (sin, cos) = map.azimuths_deg[number].to_radians().sin_cos();
        let width = if worst == Some(number) { 1.6 } else { 0.6 };
        put(
            svg,
            format_args!(
                "<line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"#333\" stroke-width=\"{width}\"/>\n",
                x + length * cos,
                y - length * sin
            ),
        );
    }
}

/// The steps' colours, a scale bar (`scale`: px a metre), and what the map shows.
fn legend(map: &Mapped, y: f64, scale: f64, svg: &mut String) {
    for (step, colour) in COLOURS.iter().enumerate() {
        let x = MARGIN + 70.0 * step as f64;
        let label = match step {
            0 => format!("< {}", STEPS[0]),
            6 => format!(">= {}", STEPS[5]),
            step => format!("{}-{}", STEPS[step - 1], STEPS[step]),
        };
        put(
            svg,
            format_args!(
                "<rect x=\"{x}\" y=\"{y:.1}\" width=\"14\" height=\"12\" fill=\"{colour}\" stroke=\"#999\"/><text \
                 x=\"{}\" y=\"{:.1}\">{}</text>\n",
                x + 18.0,
                y + 10.0,
                escape(&label)
            ),
        );
    }
    let bar_x = MARGIN + 70.0 * COLOURS.len() as f64 + 20.0;
    put(
        svg,
        format_args!(
            "<path d=\"M{bar_x:.1} {:.1}h{scale:.1}\" stroke=\"#222\" stroke-width=\"2\"/><text x=\"{:.1}\" y=\"{:.1}\">1 m</text>\n",
            y + 6.0,
            bar_x + scale + 6.0,
            y + 10.0
        ),
    );
    let named = format!(
        "{} in {}: UGR, worst of {} directions, eyes at {} m, every {} m; spokes from 10 to 30; light scene {}; initial flux",
        map.name,
        map.room,
        map.azimuths_deg.len(),
        fixed(LANG, map.eyes.first().map_or(0.0, |eye| eye.position.z), 2),
        fixed(LANG, map.spacing[0].length(), 2),
        map.light_scene
    );
    let white = "White: nothing glares (see the table), or nobody can be there: inside furniture, outside of the room.";
    let lines = [named.as_str(), white, map.convention.as_str()].into_iter().chain(approximations(map));
    for (line, text) in lines.enumerate() {
        put(
            svg,
            format_args!(
                "<text x=\"{MARGIN}\" y=\"{:.1}\">{}</text>\n",
                y + 28.0 + 14.0 * line as f64,
                escape(text)
            ),
        );
    }
}
