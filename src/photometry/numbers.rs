//! Numbers of a photometric file, each with its line. The separators are the format's: a comma ends
//! a number in LM-63 and is a decimal point in EULUMDAT.

use std::fmt::Display;

use super::Fault;
use super::planes::Plane;

/// More angles or intensities than any measurement has.
pub(super) const MAX_VALUES: usize = 4_000_000;
/// The usual hint.
pub(super) const DAMAGED: &str =
    "the file is damaged or was edited by hand: get it from its manufacturer again";

/// A number of the file and the line it stands in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    pub(super) value: f64,
    pub(super) line: usize,
}

/// What a comma is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Comma {
    Separator,
    DecimalPoint,
}

/// The numbers from some line on, in order.
pub(super) struct Numbers<'a> {
    tokens: Vec<(usize, &'a str)>,
    position: usize,
    comma: Comma,
    /// Line of the last number taken.
    pub(super) line: usize,
}

impl<'a> Numbers<'a> {
    pub(super) fn new(lines: &[&'a str], first: usize, comma: Comma) -> Self {
        let separates = |c: char| c.is_whitespace() || (c == ',' && comma == Comma::Separator);
        let of_line = |(index, line): (usize, &&'a str)| {
            line.split(separates).filter(|token| !token.is_empty()).map(move |token| (index + 1, token))
        };
        let tokens = lines.iter().enumerate().skip(first).flat_map(of_line).collect();
        Self { tokens, position: 0, comma, line: first }
    }

    pub(super) fn next(&mut self, what: impl Display) -> Result<Number, Fault> {
        let Some((line, token)) = self.tokens.get(self.position).copied() else {
            return Err(Fault::new(self.line, format!("the file ends before {what}"), DAMAGED));
        };
        (self.line, self.position) = (line, self.position + 1);
        let message = || format!("expected {what}, found '{}'", shortened(token));
        let value = parse(token, self.comma).ok_or_else(|| Fault::new(line, message(), DAMAGED))?;
        Ok(Number { value, line })
    }

    /// How many numbers follow before the end or something else.
    pub(super) fn left(&self) -> usize {
        self.tokens[self.position..]
            .iter()
            .take_while(|(_, token)| parse(token, self.comma).is_some())
            .count()
    }

    /// The first token not taken yet, with its line.
    pub(super) fn rest(&self) -> Option<(usize, &'a str)> {
        self.tokens.get(self.position).copied()
    }

    /// `count` rising angles.
    pub(super) fn angles(&mut self, name: &str, count: usize) -> Result<Vec<Number>, Fault> {
        let mut angles: Vec<Number> = Vec::new();
        for k in 1..=count {
            let next = self.next(format_args!("{name} {k} of {count}"))?;
            if let Some(previous) = angles.last().filter(|previous| !(next.value > previous.value)) {
                let message = format!("{name} must rise, found {}° after {}°", next.value, previous.value);
                let hint = "check the counts of angles in the file's head, and the angles themselves";
                return Err(Fault::new(next.line, message, hint).coded("angle-order"));
            }
            angles.push(next);
        }
        Ok(angles)
    }

    /// The intensities of one plane times `factor`.
    pub(super) fn plane(
        &mut self,
        name: &str,
        angle_deg: f64,
        gammas: &[Number],
        factor: f64,
    ) -> Result<Plane, Fault> {
        let mut cd = Vec::with_capacity(gammas.len());
        let mut lines = Vec::with_capacity(gammas.len());
        for gamma in gammas {
            let intensity = self.next(format_args!("the intensity at {name}, γ {}°", gamma.value))?;
            if intensity.value < 0.0 {
                let message =
                    format!("the intensity at {name}, γ {}° is negative: {}", gamma.value, intensity.value);
                return Err(Fault::new(intensity.line, message, DAMAGED).coded("negative-intensity"));
            }
            cd.push(intensity.value * factor);
            lines.push(intensity.line);
        }
        Ok(Plane { angle_deg, cd, lines: lines.into() })
    }
}

/// A finite number.
pub(super) fn parse(token: &str, comma: Comma) -> Option<f64> {
    let value: Option<f64> = match comma {
        Comma::DecimalPoint if token.contains(',') => token.replace(',', ".").parse().ok(),
        Comma::DecimalPoint | Comma::Separator => token.parse().ok(),
    };
    value.filter(|value| value.is_finite())
}

/// The beginning of a text, fit for a message.
pub(super) fn shortened(text: &str) -> String {
    text.chars().take(24).collect()
}

/// A factor that must exceed 0.
pub(super) fn positive(number: Number, what: &str) -> Result<f64, Fault> {
    if number.value > 0.0 {
        return Ok(number.value);
    }
    Err(Fault::new(number.line, format!("{what} is {}, expected a number > 0", number.value), DAMAGED))
}

/// A count from `least` up.
pub(super) fn count(number: Number, what: &str, least: usize) -> Result<usize, Fault> {
    let value = number.value;
    if value.fract().abs() > 0.0 || value < least as f64 || value > MAX_VALUES as f64 {
        let message = format!("{value} {what}, expected a whole number from {least}");
        return Err(Fault::new(number.line, message, DAMAGED));
    }
    Ok(value as usize)
}

/// γ of type C lies within 0 … 180.
pub(super) fn check_gamma_range(gammas: &[Number]) -> Result<(), Fault> {
    let (first, last) = (gammas[0], gammas[gammas.len() - 1]);
    if first.value >= 0.0 && last.value <= 180.0 {
        return Ok(());
    }
    let message = format!("γ runs from {}° to {}°", first.value, last.value);
    let hint = "type C counts γ from 0° (down) to 180°; negative angles belong to types A and B";
    Err(Fault::new(first.line, message, hint))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a comma read as the other format's, a line number lost over wrapped lines.
    #[test]
    fn commas_and_lines() {
        let lines = ["head", "1,5 2", "", "x"];
        let mut list = Numbers::new(&lines, 1, Comma::Separator);
        assert_eq!(list.left(), 3);
        let values = [(); 3].map(|()| list.next("a number").expect("three numbers").value);
        assert!((values[1] - 5.0).abs() < 1e-12 && list.line == 2);
        let fault = list.next("a number").expect_err("no number");
        assert_eq!((fault.line, fault.message.as_str()), (4, "expected a number, found 'x'"));
        let mut list = Numbers::new(&lines, 1, Comma::DecimalPoint);
        assert!((list.next("a number").expect("1.5").value - 1.5).abs() < 1e-12);
    }

    /// Catches: NaN and infinity, which Rust parses happily.
    #[test]
    fn only_finite_numbers() {
        for token in ["NaN", "inf", "-infinity", "1e999", "", "1.2.3", "1,2,3"] {
            assert_eq!(parse(token, Comma::DecimalPoint), None, "{token}");
        }
    }

    /// Catches: falling and repeated angles.
    #[test]
    fn angles_rise() {
        let lines = ["0 45", "40"];
        let fault = Numbers::new(&lines, 0, Comma::Separator).angles("γ", 3).expect_err("falls");
        assert_eq!((fault.line, fault.message.as_str()), (2, "γ must rise, found 40° after 45°"));
    }
}
