//! The 13 numbers between LM-63's tilt data and its angles. The field after the ballast factor is
//! a factor up to 1995, reserved in 2002 and the kind of the file in 2019.

use super::ies_goniometer::Goniometer;
use super::numbers::{DAMAGED, MAX_VALUES, Number, Numbers, count, positive};
use super::{Fault, Finding, Lm63Version};

const FOOT_M: f64 = 0.3048;

/// The 13 numbers between the tilt data and the angles.
pub(super) struct Head {
    lamps: f64,
    lumens: f64,
    pub(super) lumens_line: usize,
    multiplier: f64,
    n_gamma: Number,
    n_plane: Number,
    pub(super) goniometer: Goniometer,
    units: f64,
    width: f64,
    length: f64,
    height: f64,
    pub(super) size_line: usize,
    ballast: f64,
    ballast_lamp: Number,
    pub(super) power_w: f64,
    pub(super) power_line: usize,
}

impl Head {
    pub(super) fn read(numbers: &mut Numbers) -> Result<Self, Fault> {
        let lamps = numbers.next("the number of lamps")?.value;
        let lumens = numbers.next("the lumens per lamp")?;
        let multiplier = positive(numbers.next("the candela multiplier")?, "the candela multiplier")?;
        let n_gamma = numbers.next("the number of vertical angles")?;
        let n_plane = numbers.next("the number of horizontal angles")?;
        let kind = numbers.next("the photometric type")?;
        let goniometer = goniometer(kind)?;
        let units = numbers.next("the units of length")?;
        let width = numbers.next("the luminous width")?;
        let length = numbers.next("the luminous length")?.value;
        let height = numbers.next("the luminous height")?.value;
        let ballast = positive(numbers.next("the ballast factor")?, "the ballast factor")?;
        let ballast_lamp = numbers.next("the ballast-lamp factor")?;
        let power = numbers.next("the input watts")?;
        Ok(Self {
            lamps,
            lumens: lumens.value,
            lumens_line: lumens.line,
            multiplier,
            n_gamma,
            n_plane,
            goniometer,
            units: units.value,
            width: width.value,
            length,
            height,
            size_line: width.line,
            ballast,
            ballast_lamp,
            power_w: power.value,
            power_line: power.line,
        })
    }

    pub(super) fn counts(&self, lines: &[&str]) -> Result<(usize, usize), Fault> {
        let n_gamma = count(self.n_gamma, "vertical angles", 2)?;
        let n_plane = count(self.n_plane, "horizontal angles", 1)?;
        // Every value takes a digit and a separator.
        let holds = lines.iter().map(|line| line.len() + 1).sum::<usize>() / 2 + 1;
        if n_gamma.saturating_mul(n_plane) > holds.min(MAX_VALUES) {
            let message =
                format!("{n_gamma} vertical times {n_plane} horizontal angles are more than the file holds");
            return Err(Fault::new(self.n_gamma.line, message, DAMAGED));
        }
        Ok((n_gamma, n_plane))
    }

    pub(super) fn factor(&self, version: Lm63Version, findings: &mut Vec<Finding>) -> f64 {
        let ballast_lamp = self.ballast_lamp.value;
        if version <= Lm63Version::Y1995 && ballast_lamp > 0.0 {
            return self.multiplier * self.ballast * ballast_lamp;
        }
        if version != Lm63Version::Y2019 && (ballast_lamp - 1.0).abs() > 1e-9 {
            let message = format!("the field after the ballast factor is {ballast_lamp}, expected 1");
            let consequence = format!(
                "not applied; where it is meant as a factor, every illuminance is {ballast_lamp} times as high"
            );
            findings.push(Finding::new("reserved-field", self.ballast_lamp.line, message, consequence));
        }
        self.multiplier * self.ballast
    }

    /// (width, length, height) in metres.
    pub(super) fn size_m(&self) -> Result<[f64; 3], Fault> {
        let unit_m = match self.units {
            1.0 => FOOT_M,
            2.0 => 1.0,
            other => {
                let message = format!("units of length {other}, expected 1 (feet) or 2 (metres)");
                return Err(Fault::new(self.size_line, message, DAMAGED));
            }
        };
        Ok([self.width, self.length, self.height].map(|size| size * unit_m))
    }

    pub(super) fn lamp_flux_lm(&self, findings: &mut Vec<Finding>) -> Option<f64> {
        if self.lumens > 0.0 && self.lamps > 0.0 {
            return Some(self.lamps * self.lumens);
        }
        if (self.lumens + 1.0).abs() > 1e-9 {
            let message = format!("{} lamps of {} lm", self.lamps, self.lumens);
            let consequence = "read as absolute photometry (−1 lm): the candelas stand as they are";
            findings.push(Finding::new("lamp-lumens", self.lumens_line, message, consequence));
        }
        None
    }
}

fn goniometer(kind: Number) -> Result<Goniometer, Fault> {
    match kind.value {
        1.0 => Ok(Goniometer::C),
        2.0 => Ok(Goniometer::B),
        3.0 => Ok(Goniometer::A),
        other => {
            let message = format!("photometric type {other}, expected 1 (C), 2 (B) or 3 (A)");
            Err(Fault::new(kind.line, message, DAMAGED))
        }
    }
}
