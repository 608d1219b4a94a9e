//! Views as Radiance writes them: `VIEW= -vta -vp x y z -vd x y z -vu x y z -vh 180 -vv 180`.
//! Options of several lines of a file cumulate; what no line says has Radiance's default. What a person
//! writes is read strictly ([`asked`]): there, nothing is passed over and nothing is guessed.

use std::fmt::Write;

use glam::DVec3;

use super::{ImageError, Projection, View};

/// The options of a view as far as they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    kind: u8,
    eye: DVec3,
    direction: DVec3,
    up: DVec3,
    angles_deg: [f64; 2],
    shift: [f64; 2],
}

impl Default for Options {
    /// Radiance's defaults: perspective from the origin along +y, z up, 45° × 45°.
    fn default() -> Self {
        Self {
            kind: b'v',
            eye: DVec3::ZERO,
            direction: DVec3::Y,
            up: DVec3::Z,
            angles_deg: [45.0; 2],
            shift: [0.0; 2],
        }
    }
}

impl Options {
    /// The options of a view.
    fn of(view: &View) -> Self {
        let (kind, angles_deg) = letter_and_angles(view.projection);
        Self { kind, eye: view.eye, direction: view.forward(), up: view.up(), angles_deg, shift: view.shift }
    }

    /// Adds the options of `text`; unknown ones are passed over, as Radiance does.
    ///
    /// # Errors
    /// [`ImageError::View`] where a number is missing or none.
    pub fn add(&mut self, text: &str) -> Result<(), ImageError> {
        self.take(text, |_| Ok(()))
    }

    /// Adds the options of `text`; of one that is unknown, `unknown` says what is to be done.
    fn take(
        &mut self,
        text: &str,
        unknown: impl Fn(&str) -> Result<(), ImageError>,
    ) -> Result<(), ImageError> {
        let mut words = text.split_ascii_whitespace();
        while let Some(word) = words.next() {
            let mut number = || {
                let value = words.next().and_then(|word| word.parse::<f64>().ok());
                value
                    .filter(|value| value.is_finite())
                    .ok_or_else(|| ImageError::View(format!("{word} lacks a number")))
            };
            match word.as_bytes() {
                [b'-', b'v', b't', kind] => self.kind = *kind,
                b"-vp" => self.eye = DVec3::new(number()?, number()?, number()?),
                b"-vd" => self.direction = DVec3::new(number()?, number()?, number()?),
                b"-vu" => self.up = DVec3::new(number()?, number()?, number()?),
                b"-vh" => self.angles_deg[0] = number()?,
                b"-vv" => self.angles_deg[1] = number()?,
                b"-vs" => self.shift[0] = number()?,
                b"-vl" => self.shift[1] = number()?,
                // Where Radiance clips before and behind changes no direction.
                b"-vo" | b"-va" => _ = number()?,
                _ => unknown(word)?,
            }
        }
        Ok(())
    }

    /// The view that the options describe.
    ///
    /// # Errors
    /// [`ImageError::View`] for projections that are not supported, and impossible ones.
    pub fn view(&self) -> Result<View, ImageError> {
        let [horizontal_deg, vertical_deg] = self.angles_deg;
        let projection = match self.kind {
            b'v' => Projection::Perspective { horizontal_deg, vertical_deg },
            b'a' => Projection::AngularFisheye { horizontal_deg, vertical_deg },
            b'h' => Projection::HemisphericalFisheye { horizontal_deg, vertical_deg },
            kind => {
                let name = match kind {
                    b'l' => "parallel",
                    b'c' => "cylindrical",
                    b's' => "planisphere",
                    _ => "unknown",
                };
                return Err(ImageError::View(format!(
                    "the {name} projection -vt{} is not supported; perspective (-vtv), angular (-vta) and hemispherical (-vth) fisheyes are",
                    char::from(kind)
                )));
            }
        };
        let mut view = View::new(projection, self.eye, self.direction, self.up)?;
        view.shift = self.shift;
        Ok(view)
    }
}

/// The view that a person asks for with `text`; `base`, the file's own, has what `text` leaves out.
/// Without a base the projection and both angles must be there.
///
/// # Errors
/// [`ImageError::Asked`] with a hint for words that are no option, numbers that are missing, and a view
/// that is not said; [`ImageError::View`] for projections that are not supported, and impossible ones.
pub fn asked(text: &str, base: Option<&View>) -> Result<View, ImageError> {
    let wrong = |message: String, hint: &str| ImageError::Asked { message, hint: hint.into() };
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    if words.is_empty() {
        return Err(wrong("no option of a view is given".into(), EXAMPLE));
    }
    let mut options = base.map_or_else(Options::default, Options::of);
    options
        .take(text, |word| {
            let joined = ["-vp", "-vd", "-vu", "-vh", "-vv", "-vs", "-vl", "-vo", "-va"]
                .into_iter()
                .find(|option| word.len() > 3 && word.starts_with(option));
            Err(match joined {
                Some(option) => {
                    let hint = format!("a space stands before a number: {option} {}", &word[3..]);
                    wrong(format!("\"{word}\" is no option of a view"), &hint)
                }
                None if word == "-vf" => {
                    wrong("-vf names a file, which is not read".into(), "write the file's options themselves")
                }
                None => wrong(format!("\"{word}\" is no option of a view"), EXAMPLE),
            })
        })
        .map_err(|error| match error {
            ImageError::View(message) => ImageError::Asked { message, hint: EXAMPLE.into() },
            other => other,
        })?;
    if base.is_none() {
        let given = |option: &str| words.iter().any(|word| word.starts_with(option));
        let missing: Vec<&str> = ["-vt", "-vh", "-vv"].into_iter().filter(|option| !given(option)).collect();
        if !missing.is_empty() {
            let message = format!("the file has no view of its own, and {} is missing", missing.join(", "));
            return Err(wrong(message, EXAMPLE));
        }
    }
    options.view()
}

/// What a whole view looks like.
const EXAMPLE: &str =
    "a view says its projection and its angles in degrees, for example \"-vta -vh 180 -vv 180\"";

/// Radiance's letter of a projection, and its angles in degrees, across and upright.
fn letter_and_angles(projection: Projection) -> (u8, [f64; 2]) {
    match projection {
        Projection::Perspective { horizontal_deg, vertical_deg } => (b'v', [horizontal_deg, vertical_deg]),
        Projection::AngularFisheye { horizontal_deg, vertical_deg } => (b'a', [horizontal_deg, vertical_deg]),
        Projection::HemisphericalFisheye { horizontal_deg, vertical_deg } => {
            (b'h', [horizontal_deg, vertical_deg])
        }
    }
}

impl View {
    /// The view as Radiance's options.
    pub fn to_options(&self) -> String {
        let (kind, [horizontal, vertical]) = letter_and_angles(self.projection);
        let mut text = format!("-vt{}", char::from(kind));
        for (option, v) in [("-vp", self.eye), ("-vd", self.forward()), ("-vu", self.up())] {
            let _ = write!(text, " {option} {} {} {}", plain(v.x), plain(v.y), plain(v.z));
        }
        let _ = write!(text, " -vh {horizontal} -vv {vertical} -vs {} -vl {}", self.shift[0], self.shift[1]);
        text
    }
}

/// No minus before a zero, and no more digits than a view needs.
fn plain(value: f64) -> f64 {
    let rounded = (value * 1e9).round() / 1e9;
    if rounded == 0.0 { 0.0 } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(lines: &[&str]) -> Result<View, ImageError> {
        let mut options = Options::default();
        for line in lines {
            options.add(line)?;
        }
        options.view()
    }

    /// Catches: options that replace instead of adding up, defaults other than Radiance's.
    #[test]
    fn options_add_up_over_lines_and_come_back() {
        let view = read(&["-vta -vp 1 2 1.2 -vh 182 -vv 182", "-vd 0 -1 0 -zz 3"]).expect("a view");
        assert_eq!(view.eye, DVec3::new(1.0, 2.0, 1.2));
        assert_eq!(view.forward(), DVec3::NEG_Y);
        assert_eq!(
            view.projection,
            Projection::AngularFisheye { horizontal_deg: 182.0, vertical_deg: 182.0 }
        );
        assert_eq!(read(&[&view.to_options()]).expect("its own words"), view);
        let default = read(&[]).expect("a view");
        assert_eq!(default.projection, Projection::Perspective { horizontal_deg: 45.0, vertical_deg: 45.0 });
        assert_eq!((default.forward(), default.up()), (DVec3::Y, DVec3::Z));
    }

    /// Catches: a projection silently taken for another.
    #[test]
    fn other_projections_are_named_and_refused() {
        for (text, name) in
            [("-vtl", "parallel"), ("-vtc", "cylindrical"), ("-vts", "planisphere"), ("-vtz", "unknown")]
        {
            let error = read(&[text]).expect_err("unsupported").to_string();
            assert!(error.contains(name) && error.contains(text), "{error}");
        }
        assert!(read(&["-vp 1 2"]).is_err());
        assert!(read(&["-vh nan"]).is_err());
        assert!(read(&["-vth -vh 190"]).is_err());
        assert!(read(&["-vd 0 0 1"]).is_err());
    }

    /// Catches: rubbish, a missing space or number, or a file's name taken for Radiance's 45° × 45° in silence;
    /// a part of a view that forgets the projection of the file; a whole that is guessed.
    #[test]
    fn what_a_person_asks_for_is_read_strictly() {
        let fisheye = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
        let base = View::new(fisheye, DVec3::new(1.0, 2.0, 1.2), DVec3::X, DVec3::Z).expect("a view");
        for text in [
            "rubbish",
            "",
            "  ",
            "angular 180",
            "-vf x.vf",
            "-vta -vh180 -vv180",
            "-vta -vh 180 -vv",
            "-vta -vh 180 -vv 1b0",
            "-vtaa -vh 180 -vv 180",
            "-vt -vh 180 -vv 180",
            "-vta -vh 180 180",
        ] {
            for base in [None, Some(&base)] {
                let error = asked(text, base).expect_err(text).to_string();
                assert!(error.contains("\n  hint: "), "{text}: {error}");
            }
        }
        for (text, missing) in [("-vta -vv 180", "-vh"), ("-vh 170 -vv 170", "-vt"), ("-vta", "-vh, -vv")] {
            let error = asked(text, None).expect_err(text).to_string();
            assert!(error.contains(&format!("and {missing} is missing")), "{error}");
        }
        let part = asked("-vh 170 -vv 170", Some(&base)).expect("a part");
        let narrower = Projection::AngularFisheye { horizontal_deg: 170.0, vertical_deg: 170.0 };
        assert_eq!((part.projection, part.eye, part.forward()), (narrower, base.eye, DVec3::X));
        let whole = asked("-vta -vv 180 -vh 180 -vo 0 -va 0", None).expect("a view");
        assert_eq!((whole.projection, whole.forward()), (fisheye, DVec3::Y));
        assert!(asked("-vtc -vh 180 -vv 180", None).is_err());
    }
}
