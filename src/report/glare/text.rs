//! `glare --image` for people.

use super::super::number::{figures, fixed};
use super::super::words::Lang;
use super::super::xml::{printable, put};
use super::{Evaluated, right_and_up_deg};
use crate::glare::index::{Reading, parse};
use crate::glare::source::positioned_sum;

const LANG: Lang = Lang::En;
/// Sources that are listed; the others are counted.
const SOURCES: usize = 12;

/// All images, one block each.
pub fn images_text(images: &[Evaluated]) -> String {
    images.iter().map(block).collect::<Vec<_>>().join("\n")
}

fn block(image: &Evaluated) -> String {
    let mut text = format!("{}\n", printable(&image.file));
    let glare = &image.glare;
    // Those of a task have a line of their own.
    let of_view = |reading: &&Reading| parse(reading.key).is_none_or(|index| index.zones.is_none());
    for reading in glare.readings.iter().filter(of_view) {
        let (value, remark) = match &reading.value {
            Ok(value) => (shown(reading, *value), reading.notes.join("; ")),
            Err(undefined) => ("-".to_owned(), undefined.reason.clone()),
        };
        let unit = if reading.unit == "1" { "" } else { reading.unit };
        let class = match glare.dgp_class {
            Some(class) if reading.key == "DGP" => class.words(),
            _ => "",
        };
        let remarks: Vec<&str> = [class, &remark].into_iter().filter(|text| !text.is_empty()).collect();
        let line = format!("  {:<11}{value:>9} {unit:<6} {}", reading.key, remarks.join("; "));
        put(&mut text, format_args!("{}\n", line.trim_end()));
    }
    sources(image, &mut text);
    zones(image, &mut text);
    if let Some(gradient) = &image.gradient {
        text.push_str(&super::gradient::text(gradient));
    }
    for note in &glare.notes {
        put(&mut text, format_args!("  note: {}\n", printable(note)));
    }
    put(&mut text, format_args!("  convention: {}\n", glare.convention));
    text
}

fn shown(reading: &Reading, value: f64) -> String {
    match reading.unit {
        "1" if reading.key.starts_with("DGP") || reading.key.starts_with("UGP") => fixed(LANG, value, 3),
        "1" => fixed(LANG, value, 1),
        _ => figures(LANG, value, 4),
    }
}

fn sources(image: &Evaluated, text: &mut String) {
    let glare = &image.glare;
    put(text, format_args!("  {} source(s)\n", glare.sources.len()));
    if glare.sources.is_empty() {
        return;
    }
    let total = positioned_sum(&glare.sight.sources, 2, crate::glare::source::square);
    put(text, format_args!("    no.   right      up     L cd/m²        sr      P    E_v lx   share\n"));
    let weight = |source: &crate::glare::of_image::ImageSource| {
        source.position_index.map_or(0.0, |index| {
            let found = &source.detected;
            found.luminance.0 * found.luminance.0 * found.solid_angle_sr / (index * index)
        })
    };
    let mut order: Vec<usize> = (0..glare.sources.len()).collect();
    order.sort_by(|&a, &b| weight(&glare.sources[b]).total_cmp(&weight(&glare.sources[a])));
    for &number in order.iter().take(SOURCES) {
        let source = &glare.sources[number];
        let [right, up] = right_and_up_deg(source.detected.direction);
        let index = source.position_index.map_or("-".to_owned(), |index| fixed(LANG, index, 2));
        let share = total.as_ref().map_or(0.0, |total| weight(source) / total);
        put(
            text,
            format_args!(
                "    {:<3}{:>7}° {:>6}° {:>11} {:>9} {:>6} {:>9} {:>5} %{}\n",
                number + 1,
                fixed(LANG, right, 1),
                fixed(LANG, up, 1),
                figures(LANG, source.detected.luminance.0, 4),
                figures(LANG, source.detected.solid_angle_sr, 3),
                index,
                figures(LANG, source.detected.eye_lx, 3),
                fixed(LANG, 100.0 * share, 0),
                if source.detected.is_peak { "  peak" } else { "" },
            ),
        );
    }
    if order.len() > SOURCES {
        put(text, format_args!("    and {} more\n", order.len() - SOURCES));
    }
}

fn zones(image: &Evaluated, text: &mut String) {
    match &image.glare.zones {
        None => {}
        Some(Err(undefined)) => put(text, format_args!("  task: {undefined}\n")),
        Some(Ok(zones)) => {
            let ratio = |ratio: Result<f64, _>| ratio.map_or("-".into(), |x| figures(LANG, x, 3));
            put(
                text,
                format_args!(
                    "  task {} cd/m², surround (30°) {}, far field (60°) {}; task : surround {}, task : far {}\n",
                    figures(LANG, zones.task.0, 3),
                    figures(LANG, zones.surround.0, 3),
                    figures(LANG, zones.far.0, 3),
                    ratio(zones.task_to_surround()),
                    ratio(zones.task_to_far()),
                ),
            );
        }
    }
    match &image.glare.band {
        None => {}
        Some(Err(undefined)) => put(text, format_args!("  band: {undefined}\n")),
        Some(Ok(band)) => put(
            text,
            format_args!(
                "  band: {} sr, mean {} cd/m², median {} cd/m²\n",
                figures(LANG, band.solid_angle_sr, 6),
                figures(LANG, band.mean.0, 6),
                figures(LANG, band.median.0, 6),
            ),
        ),
    }
}
