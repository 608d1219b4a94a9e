//! The head of an EULUMDAT file: sizes, lamp sets and what they claim. Lines count from 1, as in
//! the format's description; length lies along C90–C270.

use super::numbers::{Comma, DAMAGED, Number, count, parse, shortened};
use super::planes::{Plane, spread};
use super::{Fault, Finding, IntensityDistribution, Opening};

const MM: f64 = 0.001;
/// Lines before the lamp sets.
const HEAD_LINES: usize = 26;
const SET_LINES: usize = 6;
/// Lines of which a part of a number would change a size, a count or the light.
const ALONE: [usize; 17] = [3, 4, 6, 13, 14, 15, 16, 17, 18, 19, 20, 21, 23, 24, 26, 27, 29];

/// The first lamp set.
pub(super) struct Lamps {
    pub(super) flux_lm: f64,
    /// cd per stored number.
    pub(super) cd_per_value: f64,
    pub(super) absolute: bool,
    pub(super) power_w: Option<f64>,
    pub(super) colour_rendering: Option<f64>,
    /// Lines up to the end of the last set.
    pub(super) end: usize,
}

/// The lines before the numbers proper, numbered from 1.
pub(super) struct Head<'a> {
    pub(super) lines: &'a [&'a str],
    pub(super) findings: Vec<Finding>,
}

impl Head<'_> {
    pub(super) fn text(&self, line: usize) -> &str {
        self.lines.get(line - 1).map(|text| text.trim()).unwrap_or_default()
    }

    pub(super) fn optional(&self, line: usize) -> Option<f64> {
        let token = self.text(line).split_whitespace().next()?;
        parse(token, Comma::DecimalPoint)
    }

    /// Lines that hold one number hold no two: '1 200' is no 1. What decides sizes, counts and light is refused;
    /// elsewhere words may follow a number.
    pub(super) fn check_gaps(&self) -> Result<(), Fault> {
        for line in ALONE {
            let text = self.text(line);
            let numbers = text.split_whitespace().map(|token| parse(token, Comma::DecimalPoint));
            if numbers.take(2).flatten().count() == 2 {
                let message = format!("'{}' is two numbers in a line that holds one", shortened(text));
                let hint = "write it without a space, 1200 and not 1 200";
                return Err(Fault::new(line, message, hint));
            }
        }
        Ok(())
    }

    pub(super) fn required(&self, line: usize, what: &str) -> Result<Number, Fault> {
        if line > self.lines.len() {
            return Err(Fault::new(
                self.lines.len(),
                format!("the file ends before {what} (line {line})"),
                DAMAGED,
            ));
        }
        let message = || format!("expected {what}, found '{}'", shortened(self.text(line)));
        let value = self.optional(line).ok_or_else(|| Fault::new(line, message(), DAMAGED))?;
        Ok(Number { value, line })
    }

    /// A size of the luminous area in m; what is no number ≥ 0 counts as 0.
    fn size_m(&mut self, line: usize) -> f64 {
        if let Some(size_mm) = self.optional(line).filter(|size| *size >= 0.0) {
            return size_mm * MM;
        }
        let message = format!("'{}' is no size in mm", self.text(line));
        let consequence = "taken as 0, which makes the luminous area smaller and its luminance higher";
        self.findings.push(Finding::new("bad-size", line, message, consequence));
        0.0
    }

    /// Length lies along C90–C270 (frame x): the sides seen from C90, C180, C270 and C0 face +x, +y, −x, −y.
    pub(super) fn opening(&mut self) -> Opening {
        let [length_m, width_m] = [16, 17].map(|line| self.size_m(line));
        let [c0, c90, c180, c270] = [18, 19, 20, 21].map(|line| self.size_m(line));
        if !(length_m > 0.0) {
            return Opening::Point;
        }
        self.check_housing(length_m, width_m);
        if width_m > 0.0 {
            return Opening::sided(length_m, width_m, [c90, c180, c270, c0]);
        }
        Opening::Disc { diameter_m: length_m, height_m: 0.25 * (c0 + c90 + c180 + c270) }
    }

    /// An area that is larger than the luminaire, or that fits only when turned by 90°.
    fn check_housing(&mut self, length_m: f64, width_m: f64) {
        // Rounding to a centimetre is common.
        const SLACK_M: f64 = 0.01;
        let housing = [13, 14].map(|line| self.optional(line).filter(|size_mm| *size_mm > 0.0));
        let Some(housing_length_m) = housing[0].map(|size_mm| size_mm * MM) else {
            return;
        };
        // A width of 0 is a round luminaire or a round area.
        let housing_width_m = housing[1].map_or(housing_length_m, |size_mm| size_mm * MM);
        let width_m = if width_m > 0.0 { width_m } else { length_m };
        let fits = |length: f64, width: f64| {
            length <= housing_length_m + SLACK_M && width <= housing_width_m + SLACK_M
        };
        if fits(length_m, width_m) {
            return;
        }
        let message = format!(
            "the luminous area of {length_m:.3} × {width_m:.3} m lies beyond the luminaire of {housing_length_m:.3} × \
             {housing_width_m:.3} m (length × width)"
        );
        if fits(width_m, length_m) {
            let consequence = "it fits when turned by 90°: C0 and C90 are swapped in the dimensions or in the \
                               intensities, so luminance and UGR belong to the other direction of view";
            self.findings.push(Finding::new("swapped-dimensions", 16, message, consequence));
            return;
        }
        let excess = length_m * width_m / (housing_length_m * housing_width_m).max(1e-12);
        let consequence = format!(
            "if the luminaire's size is right, the luminance is up to {excess:.1} times as high as computed"
        );
        self.findings.push(Finding::new("area-beyond-housing", 16, message, consequence));
    }

    pub(super) fn lamps(&mut self) -> Result<Lamps, Fault> {
        let n_sets = count(self.required(26, "the number of lamp sets")?, "lamp sets", 1)?;
        let end = HEAD_LINES.saturating_add(n_sets.saturating_mul(SET_LINES));
        if end > self.lines.len() {
            return Err(Fault::new(26, format!("the file ends within its {n_sets} lamp sets"), DAMAGED));
        }
        if n_sets > 1 {
            let first = HEAD_LINES + 1;
            let message = format!(
                "{n_sets} lamp sets, of which the first is used ('{}', {} lm, {} W)",
                self.text(first + 1),
                self.text(first + 2),
                self.text(first + 5)
            );
            let consequence = self.other_sets(n_sets);
            self.findings.push(Finding::new("lamp-sets", first, message, consequence));
        }
        let absolute = self.required(27, "the number of lamps")?.value < 0.0;
        let flux = self.required(29, "the luminous flux of the lamps")?;
        if !(flux.value > 0.0) {
            let message =
                format!("the luminous flux of the lamps is {} lm, expected a number > 0", flux.value);
            let hint = "intensities are per 1000 lm: write the flux into this line";
            return Err(Fault::new(flux.line, message, hint));
        }
        if self.optional(25).is_some_and(|tilt| tilt.abs() > 0.0) {
            let message = format!("measured at a tilt of {}°", self.text(25));
            let consequence = "not turned back: the beam points elsewhere unless you aim the luminaire";
            self.findings.push(Finding::new("tilt", 25, message, consequence));
        }
        Ok(Lamps {
            flux_lm: flux.value,
            cd_per_value: self.conversion() * flux.value / 1000.0,
            absolute,
            power_w: self.optional(32).filter(|watts| *watts > 0.0),
            colour_rendering: colour_rendering(self.text(31)),
            end,
        })
    }

    /// What choosing another set would change.
    fn other_sets(&self, n_sets: usize) -> String {
        let flux = |set: usize| self.optional(HEAD_LINES + set * SET_LINES + 3).filter(|lm| *lm > 0.0);
        let used = flux(0).unwrap_or_default();
        let others: Vec<f64> = (1..n_sets).filter_map(flux).collect();
        let [low, high] =
            others.iter().fold([f64::INFINITY, 0.0], |[low, high], lm| [low.min(*lm), lm.max(high)]);
        if !(used > 0.0 && high > 0.0) {
            return "another set gives another flux; set `flux` for it".to_owned();
        }
        let [low, high] = [low, high].map(|lm| 100.0 * (lm / used - 1.0));
        format!("another set changes every illuminance by {low:+.0} % to {high:+.0} %; set `flux` for it")
    }

    fn conversion(&mut self) -> f64 {
        if let Some(factor) = self.optional(24).filter(|factor| *factor > 0.0) {
            return factor;
        }
        let message = format!("conversion factor '{}'", self.text(24));
        let consequence = "taken as 1: every illuminance is wrong by the factor that was meant";
        self.findings.push(Finding::new("conversion-factor", 24, message, consequence));
        1.0
    }

    /// Line 2 may declare a light source symmetric about the vertical axis.
    pub(super) fn check_light_source_type(&mut self, planes: &[Plane]) {
        let rotational = self.optional(2).is_some_and(|kind| (kind - 1.0).abs() < 1e-9);
        let spread = spread(planes);
        if rotational && spread > 0.02 {
            let message = format!(
                "line 2 declares symmetry about the vertical axis, but the planes differ by {:.0} % of the largest \
                 intensity",
                100.0 * spread
            );
            let consequence = "the planes are used, so the luminaire's rotation matters";
            self.findings.push(Finding::new("asymmetry", 2, message, consequence));
        }
    }

    pub(super) fn check_down_share(&mut self, distribution: &IntensityDistribution) {
        let Some(stated) = self.optional(22) else {
            return;
        };
        let computed = 100.0 * distribution.zonal_flux(0.0, 90.0).0 / distribution.flux().0;
        if (stated - computed).abs() > 2.0 {
            let message =
                format!("{stated} % of the flux goes down as stated, {computed:.1} % by the intensities");
            let consequence = format!(
                "the intensities are used: direct illuminance is {:+.0} % against the statement; check that the \
                 luminaire is not upside down",
                100.0 * (computed / stated.max(1.0) - 1.0)
            );
            self.findings.push(Finding::new("down-share", 22, message, consequence));
        }
    }

    pub(super) fn description(&self) -> String {
        let parts = [self.text(1), self.text(9)].into_iter().filter(|part| !part.is_empty());
        parts.collect::<Vec<_>>().join(" ")
    }
}

/// R_a as a number, or the lower end of its group (DIN 5035): 1A ≥ 90, 1B ≥ 80, 2A ≥ 70 …
fn colour_rendering(text: &str) -> Option<f64> {
    let groups = [("1A", 90.0), ("1B", 80.0), ("2A", 70.0), ("2B", 60.0), ("3", 40.0), ("4", 20.0)];
    let number = text.split_whitespace().next().and_then(|token| parse(token, Comma::DecimalPoint));
    match number {
        Some(ra) if ra > 4.0 && ra <= 100.0 => Some(ra),
        Some(group) if !(3.0..=4.0).contains(&group) => None,
        _ => groups.iter().find(|(group, _)| text.to_ascii_uppercase().starts_with(group)).map(|(_, ra)| *ra),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: group codes read as R_a = 1.
    #[test]
    fn colour_rendering_groups() {
        let read = ["82", "1B", "1A/>90", "0", "nw", "4", "2b", ""].map(colour_rendering);
        assert_eq!(read, [Some(82.0), Some(80.0), Some(90.0), None, None, Some(20.0), Some(60.0), None]);
    }
}
