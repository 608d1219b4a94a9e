//! `lamp info` for people. C0 lies across the opening's length in every format, so that an LM-63 and
//! an EULUMDAT file of one luminaire read alike.

use rayon::prelude::*;

use super::super::number::{figures, fixed};
use super::super::words::{Lang, found, lamp_word};
use super::super::xml::{printable, put};
use super::opening::shown;
use super::{Batch, decimal, format_name, lint};
use crate::lamp::info::{Info, info};
use crate::lamp::luminance::GAMMAS_DEG;
use crate::lamp::outdoor::{BUG_KNOWN, D_KNOWN, G_GAMMAS_DEG, Known, g_star_known};
use crate::lamp::{Lamp, c_deg, rules};
use crate::photometry::{Format, Opening, Symmetry};
use crate::units::Undefined;

/// All luminaires, one block each.
pub fn info_text(batch: &[Batch], lang: Lang) -> String {
    let block = |file: &Batch| match &file.read {
        Ok(lamps) => lamps.iter().map(|lamp| block(lamp, lang)).collect::<Vec<_>>().join("\n"),
        Err(finding) => lint::one(&file.file, finding, rules::severity(finding.code), lang),
    };
    // The figures of a file are computed where they are printed: thousands of files share the cores.
    batch.par_iter().map(block).collect::<Vec<_>>().join("\n")
}

fn block(lamp: &Lamp, lang: Lang) -> String {
    let info = info(lamp);
    let page = Page { lang, info: &info };
    let say = |english: &'static str| lamp_word(lang, english);
    let mut text = format!("{}\n", printable(&lamp.file));
    let mut row = |name: &str, value: String| put(&mut text, format_args!("  {name:<15}{value}\n"));
    row(say("luminaire"), printable(&info.description));
    row(say("format"), page.format());
    row(say("flux"), page.flux());
    row(say("output ratio"), page.output_ratio());
    row(say("power"), page.power());
    row("I_max", page.largest());
    row(say("opening"), shown(info.opening, lang));
    row(say("symmetry"), page.symmetry().to_owned());
    row(say("beam (50 %)"), page.planes(&info.beam_deg));
    row(say("field (10 %)"), page.planes(&info.field_deg));
    row(say("CIE flux code"), page.flux_code());
    row(say("spacing S/h"), page.spacing());
    row(say("intensity"), page.intensity_class());
    row(say("glare index"), page.glare_index());
    row(say("BUG rating"), page.bug());
    page.zones(&mut text);
    page.luminances(&mut text);
    if !lamp.findings.is_empty() {
        put(&mut text, format_args!("  {}\n", say("findings")));
    }
    for finding in &lamp.findings {
        let line = finding.line.map_or(String::new(), |line| format!("{} {line}, ", say("line")));
        let severity = lint::severity_word(rules::severity(finding.code), lang);
        let told = [&finding.message, &finding.consequence].map(|text| printable(&found(lang, text)));
        put(&mut text, format_args!("    {severity}[{}]: {line}{}\n", finding.code, told.join(": ")));
    }
    text
}

/// The figures of one luminaire in one language.
struct Page<'a> {
    lang: Lang,
    info: &'a Info,
}

impl Page<'_> {
    fn say(&self, english: &'static str) -> &'static str {
        lamp_word(self.lang, english)
    }

    fn no_value(&self, undefined: &Undefined) -> String {
        format!("— ({})", found(self.lang, &undefined.reason))
    }

    fn or_reason(&self, value: &Result<f64, Undefined>, show: impl Fn(f64) -> String) -> String {
        value.as_ref().map_or_else(|undefined| self.no_value(undefined), |value| show(*value))
    }

    fn lumens(&self, lm: f64) -> String {
        if lm >= 100.0 { fixed(self.lang, lm, 0) } else { self.three(lm) }
    }

    /// Three figures; what sums of rounded numbers leave over is 0.
    fn three(&self, value: f64) -> String {
        const NOTHING: f64 = 1e-9;
        figures(self.lang, if value.abs() < NOTHING { 0.0 } else { value }, 3)
    }

    fn percent(&self, part: f64) -> String {
        format!("{} %", fixed(self.lang, 100.0 * part, 1))
    }

    fn format(&self) -> String {
        let name = format_name(self.info.format);
        match self.info.format {
            Format::Eulumdat | Format::Tm33 => name.to_owned(),
            Format::Lm63 { .. } => {
                format!("{name} ({})", self.say("its 0° plane, along the length, is C90 here"))
            }
        }
    }

    fn flux(&self) -> String {
        let rated = self.info.flux_rated_lm.map_or_else(
            || self.say("none rated").to_owned(),
            |lm| format!("{} {}", self.lumens(lm), self.say("lm rated")),
        );
        format!(
            "{} {} · {} {} · {rated}",
            self.lumens(self.info.flux_integrated_lm),
            self.say("lm by exact integration"),
            self.lumens(self.info.flux_zonal_lm),
            self.say("lm by the zonal rule")
        )
    }

    fn output_ratio(&self) -> String {
        let info = self.info;
        let down = format!("{} {}", self.percent(info.down_share), self.say("of the flux down"));
        let source = if info.format == Format::Eulumdat { self.say(" stated") } else { "" };
        let lor = info.lor.map_or_else(
            || self.say("LOR not stated").to_owned(),
            |lor| format!("{} {}{source}", self.say("LOR"), self.percent(lor)),
        );
        match (info.dlor, info.ulor) {
            (Some(dlor), Some(ulor)) => {
                let (below, above) = (self.say("DLOR"), self.say("ULOR"));
                format!("{lor} · {below} {} · {above} {} · {down}", self.percent(dlor), self.percent(ulor))
            }
            _ => format!("{lor} · {down}"),
        }
    }

    fn power(&self) -> String {
        let (Some(watts), Some(efficacy)) = (self.info.power_w, self.info.efficacy_lm_per_w) else {
            return self.say("not stated").to_owned();
        };
        let [watts, efficacy] = [watts, efficacy].map(|value| figures(self.lang, value, 3));
        format!("{watts} {} · {efficacy} {}", self.say("W"), self.say("lm/W"))
    }

    fn largest(&self) -> String {
        let peak = self.info.i_max;
        format!(
            "{} {} {} C{} γ {}° ({} {})",
            figures(self.lang, peak.cd, 4),
            self.say("cd"),
            self.say("at"),
            decimal(self.lang, peak.c_deg),
            decimal(self.lang, peak.gamma_deg),
            figures(self.lang, 1000.0 * peak.cd / self.info.flux_integrated_lm, 3),
            self.say("cd/klm")
        )
    }

    fn symmetry(&self) -> &'static str {
        match self.info.symmetry {
            Symmetry::Rotational => self.say("about the vertical axis"),
            Symmetry::Quadrant => self.say("about both planes"),
            Symmetry::AboutLength => self.say("about C90–C270"),
            Symmetry::AboutWidth => self.say("about C0–C180"),
            Symmetry::None => self.say("none"),
        }
    }

    fn planes(&self, [c0, c90]: &[Result<f64, Undefined>; 2]) -> String {
        let degrees = |value: &Result<f64, Undefined>| {
            self.or_reason(value, |value| format!("{}°", fixed(self.lang, value, 1)))
        };
        format!("C0–C180 {} · C90–C270 {}", degrees(c0), degrees(c90))
    }

    fn flux_code(&self) -> String {
        match &self.info.flux_code {
            Ok(code) => code.map(|part| fixed(self.lang, part, 0)).join(" "),
            Err(undefined) => self.no_value(undefined),
        }
    }

    fn spacing(&self) -> String {
        let ratio =
            |value: &Result<f64, Undefined>| self.or_reason(value, |value| fixed(self.lang, value, 2));
        let spacing = &self.info.spacing;
        if let (Err(undefined), Err(_)) = (&spacing.across, &spacing.along) {
            return self.no_value(undefined);
        }
        format!(
            "C0 {} · C90 {} · {} {}",
            ratio(&spacing.across),
            ratio(&spacing.along),
            self.say("diagonal"),
            ratio(&spacing.diagonal)
        )
    }

    /// How well the limits of a class are known.
    fn known(&self, known: Known) -> &'static str {
        match known {
            Known::OneSource => self.say("limits from one public source"),
            Known::Unverified => self.say("limits unverified"),
        }
    }

    /// Of use for road and area luminaires only, and short for the others.
    fn intensity_class(&self) -> String {
        let outdoor = &self.info.outdoor;
        let class = format!("G*{}", outdoor.g_star);
        let class = if outdoor.g_star > 0 { class } else { self.say("none of G*1 … G*6").to_owned() };
        let largest: Vec<String> = G_GAMMAS_DEG
            .iter()
            .zip(&outdoor.g_cd_per_klm)
            .map(|(gamma, cd)| format!("≥ {gamma}°: {}", self.three(*cd)))
            .collect();
        format!(
            "{class} {} {}, γ {} (EN 13201-2, {})",
            self.say("by"),
            self.say("cd/klm"),
            largest.join(" · "),
            self.known(g_star_known(outdoor.g_star))
        )
    }

    fn glare_index(&self) -> String {
        let unverified = self.known(D_KNOWN);
        match &self.info.outdoor.glare_index {
            Err(undefined) => self.no_value(undefined),
            Ok((index, class)) => format!(
                "D{class}, I·A^-0.5 {} 85° = {} {}/{} (EN 13201-2, {unverified})",
                self.say("at"),
                self.three(*index),
                self.say("cd"),
                self.say("m")
            ),
        }
    }

    fn bug(&self) -> String {
        let bug = &self.info.outdoor.bug;
        let decided: Vec<String> = bug
            .decided_by
            .iter()
            .map(|(zone, lm)| format!("{zone} {} {}", self.lumens(*lm), self.say("lm")))
            .collect();
        let [b, u, g] = bug.rating;
        let street = if bug.quadrilateral {
            self.say("all quadrants alike").to_owned()
        } else {
            format!("{} C{}", self.say("street towards"), c_deg(bug.front_azimuth_deg))
        };
        let known: Vec<String> = ["B", "U", "G"]
            .into_iter()
            .zip(BUG_KNOWN)
            .map(|(letter, known)| format!("{letter} {}", self.known(known)))
            .collect();
        let (by, known) = (self.say("by"), known.join(", "));
        format!("B{b} U{u} G{g} {by} {}; {street} (TM-15-11: {known})", decided.join(", "))
    }

    fn zones(&self, text: &mut String) {
        put(text, format_args!("  {}\n", self.say("zonal flux, lm")));
        for (half, zones) in self.info.zones_lm.chunks(9).enumerate() {
            let name = |k: usize| format!("{}–{}°", 90 * half + 10 * k, 90 * half + 10 * (k + 1));
            let heads: Vec<String> = (0..9).map(|k| format!("{:>9}", name(k))).collect();
            let values: Vec<String> =
                zones.iter().map(|lm| format!("{:>9}", fixed(self.lang, *lm, 1))).collect();
            put(text, format_args!("  {}\n  {}\n", heads.concat(), values.concat()));
        }
    }

    fn luminances(&self, text: &mut String) {
        if self.info.opening == Opening::Point {
            return;
        }
        put(text, format_args!("  {}\n", self.say("luminance, cd/m²")));
        let heads: Vec<String> =
            GAMMAS_DEG.iter().map(|gamma| format!("{:>11}", format!("γ {gamma}°"))).collect();
        put(text, format_args!("  {:>9}{}\n", "", heads.concat()));
        for row in &self.info.luminances {
            let rotational = self.info.symmetry == Symmetry::Rotational;
            let name = if rotational { self.say("all C").into() } else { format!("C{}", row.c_deg) };
            let cell = |value: &Result<crate::units::Nits, Undefined>| {
                let shown = value.as_ref().map_or("—".into(), |nits| self.three(nits.0));
                format!("{shown:>11}")
            };
            put(text, format_args!("  {name:>9}{}\n", row.luminances.iter().map(cell).collect::<String>()));
        }
    }
}
