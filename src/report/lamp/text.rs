//! `lamp info` for people. C0 lies across the opening's length in every format, so that an LM-63 and
//! an EULUMDAT file of one luminaire read alike.

use super::super::number::{figures, fixed};
use super::super::words::Lang;
use super::super::xml::{printable, put};
use super::{Batch, format_name, lint};
use crate::lamp::info::{Info, info};
use crate::lamp::luminance::GAMMAS_DEG;
use crate::lamp::{Lamp, rules};
use crate::photometry::{Format, Opening, Symmetry};
use crate::units::Undefined;

const LANG: Lang = Lang::En;

/// All luminaires, one block each.
pub fn info_text(batch: &[Batch]) -> String {
    let block = |file: &Batch| match &file.read {
        Ok(lamps) => lamps.iter().map(block).collect::<Vec<_>>().join("\n"),
        Err(finding) => lint::one(&file.file, finding, rules::severity(finding.code)),
    };
    batch.iter().map(block).collect::<Vec<_>>().join("\n")
}

fn block(lamp: &Lamp) -> String {
    let info = info(lamp);
    let mut text = format!("{}\n", printable(&lamp.file));
    let mut row = |name: &str, value: String| put(&mut text, format_args!("  {name:<14}{value}\n"));
    row("luminaire", printable(&info.description));
    row("format", format(info.format));
    row("flux", flux(&info));
    row("output ratio", output_ratio(&info));
    row("power", power(&info));
    row(
        "I_max",
        format!(
            "{} cd at C{} γ {}° ({} cd/klm)",
            figures(LANG, info.i_max.cd, 4),
            info.i_max.c_deg,
            info.i_max.gamma_deg,
            figures(LANG, 1000.0 * info.i_max.cd / info.flux_integrated_lm, 3)
        ),
    );
    row("opening", opening(info.opening));
    row("symmetry", symmetry(info.symmetry).to_owned());
    row("beam (50 %)", planes(&info.beam_deg));
    row("field (10 %)", planes(&info.field_deg));
    row("CIE flux code", flux_code(&info));
    row("spacing S/h", spacing(&info));
    zones(&info, &mut text);
    luminances(&info, &mut text);
    if !lamp.findings.is_empty() {
        text.push_str("  findings\n");
    }
    for finding in &lamp.findings {
        let line = finding.line.map_or(String::new(), |line| format!("line {line}, "));
        let severity = rules::severity(finding.code).key();
        let (code, message) = (finding.code, printable(&finding.to_string()));
        put(&mut text, format_args!("    {severity}[{code}]: {line}{message}\n"));
    }
    text
}

fn format(format: Format) -> String {
    let name = format_name(format);
    match format {
        Format::Eulumdat => name.to_owned(),
        Format::Lm63 { .. } => format!("{name} (its 0° plane, along the length, is C90 here)"),
    }
}

fn lumens(lm: f64) -> String {
    if lm >= 100.0 { fixed(LANG, lm, 0) } else { figures(LANG, lm, 3) }
}

fn flux(info: &Info) -> String {
    let rated = info.flux_rated_lm.map_or("none rated".to_owned(), |lm| format!("{} lm rated", lumens(lm)));
    format!(
        "{} lm by exact integration · {} lm by the zonal rule · {rated}",
        lumens(info.flux_integrated_lm),
        lumens(info.flux_zonal_lm)
    )
}

fn output_ratio(info: &Info) -> String {
    let percent = |part: f64| format!("{} %", fixed(LANG, 100.0 * part, 1));
    let down = format!("{} of the flux down", percent(info.down_share));
    let source = if info.format == Format::Eulumdat { " stated" } else { "" };
    let lor = info.lor.map_or("LOR not stated".to_owned(), |lor| format!("LOR {}{source}", percent(lor)));
    match (info.dlor, info.ulor) {
        (Some(dlor), Some(ulor)) => {
            format!("{lor} · DLOR {} · ULOR {} · {down}", percent(dlor), percent(ulor))
        }
        _ => format!("{lor} · {down}"),
    }
}

fn power(info: &Info) -> String {
    match (info.power_w, info.efficacy_lm_per_w) {
        (Some(watts), Some(efficacy)) => {
            format!("{} W · {} lm/W", figures(LANG, watts, 3), figures(LANG, efficacy, 3))
        }
        _ => "not stated".to_owned(),
    }
}

fn opening(opening: Opening) -> String {
    let m = |size: f64| fixed(LANG, size, 3);
    match opening {
        Opening::Point => "none: a point".to_owned(),
        Opening::Rect { length_m, width_m, side_x_m, side_y_m } => {
            let sides = if side_x_m > 0.0 || side_y_m > 0.0 {
                format!(", luminous sides {} m (ends), {} m (long sides)", m(side_x_m), m(side_y_m))
            } else {
                String::new()
            };
            format!("rectangle {} × {} m (length × width){sides}", m(length_m), m(width_m))
        }
        Opening::Sided { length_m, width_m, sides_m: [c90, c180, c270, c0] } => format!(
            "rectangle {} × {} m (length × width), luminous sides C0 {} · C90 {} · C180 {} · C270 {} m",
            m(length_m),
            m(width_m),
            m(c0),
            m(c90),
            m(c180),
            m(c270)
        ),
        Opening::Disc { diameter_m, height_m } => {
            let side =
                if height_m > 0.0 { format!(", luminous height {} m", m(height_m)) } else { String::new() };
            format!("disc ⌀ {} m{side}", m(diameter_m))
        }
        Opening::Ellipse { length_m, width_m, height_m } => {
            let side =
                if height_m > 0.0 { format!(", luminous height {} m", m(height_m)) } else { String::new() };
            format!("ellipse {} × {} m (length × width){side}", m(length_m), m(width_m))
        }
        Opening::Ellipsoid { length_m, width_m, height_m } => {
            if (length_m - width_m).abs().max((length_m - height_m).abs()) < 1e-9 {
                return format!("sphere ⌀ {} m", m(length_m));
            }
            format!(
                "ellipsoid {} × {} × {} m (length × width × height)",
                m(length_m),
                m(width_m),
                m(height_m)
            )
        }
        Opening::Tube { length_m, width_m, height_m, across } => {
            let way = if across { "across (along C0–C180)" } else { "along C90–C270" };
            format!(
                "lying cylinder, {} m {way}, ⌀ {} × {} m (level × upright)",
                m(length_m),
                m(width_m),
                m(height_m)
            )
        }
        Opening::Upright { width_m, height_m, across, round } => {
            let shape = if round { "ellipse" } else { "rectangle" };
            let faces = if across { "C0 and C180" } else { "C90 and C270" };
            format!("upright {shape} {} × {} m (width × height) facing {faces}", m(width_m), m(height_m))
        }
    }
}

fn symmetry(symmetry: Symmetry) -> &'static str {
    match symmetry {
        Symmetry::Rotational => "about the vertical axis",
        Symmetry::Quadrant => "about both planes",
        Symmetry::AboutLength => "about C90–C270",
        Symmetry::AboutWidth => "about C0–C180",
        Symmetry::None => "none",
    }
}

fn or_reason(value: &Result<f64, Undefined>, show: impl Fn(f64) -> String) -> String {
    value.as_ref().map_or_else(|undefined| format!("— ({undefined})"), |value| show(*value))
}

fn planes([c0, c90]: &[Result<f64, Undefined>; 2]) -> String {
    let degrees =
        |value: &Result<f64, Undefined>| or_reason(value, |value| format!("{}°", fixed(LANG, value, 1)));
    format!("C0–C180 {} · C90–C270 {}", degrees(c0), degrees(c90))
}

fn flux_code(info: &Info) -> String {
    match &info.flux_code {
        Ok(code) => code.map(|part| fixed(LANG, part, 0)).join(" "),
        Err(undefined) => format!("— ({undefined})"),
    }
}

fn spacing(info: &Info) -> String {
    let ratio = |value: &Result<f64, Undefined>| or_reason(value, |value| fixed(LANG, value, 2));
    let spacing = &info.spacing;
    if let (Err(undefined), Err(_)) = (&spacing.across, &spacing.along) {
        return format!("— ({undefined})");
    }
    format!(
        "C0 {} · C90 {} · diagonal {}",
        ratio(&spacing.across),
        ratio(&spacing.along),
        ratio(&spacing.diagonal)
    )
}

fn zones(info: &Info, text: &mut String) {
    text.push_str("  zonal flux, lm\n");
    for (half, zones) in info.zones_lm.chunks(9).enumerate() {
        let name = |k: usize| format!("{}–{}°", 90 * half + 10 * k, 90 * half + 10 * (k + 1));
        let heads: Vec<String> = (0..9).map(|k| format!("{:>9}", name(k))).collect();
        let values: Vec<String> = zones.iter().map(|lm| format!("{:>9}", fixed(LANG, *lm, 1))).collect();
        put(text, format_args!("  {}\n  {}\n", heads.concat(), values.concat()));
    }
}

fn luminances(info: &Info, text: &mut String) {
    if info.opening == Opening::Point {
        return;
    }
    text.push_str("  luminance, cd/m²\n");
    let heads: Vec<String> =
        GAMMAS_DEG.iter().map(|gamma| format!("{:>11}", format!("γ {gamma}°"))).collect();
    put(text, format_args!("  {:>9}{}\n", "", heads.concat()));
    for row in &info.luminances {
        let name =
            if info.symmetry == Symmetry::Rotational { "all C".into() } else { format!("C{}", row.c_deg) };
        let cell = |value: &Result<crate::units::Nits, Undefined>| {
            format!("{:>11}", value.as_ref().map_or("—".into(), |nits| figures(LANG, nits.0, 3)))
        };
        put(text, format_args!("  {name:>9}{}\n", row.luminances.iter().map(cell).collect::<String>()));
    }
}
