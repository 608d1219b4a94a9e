//! Views as Radiance writes them: `VIEW= -vta -vp x y z -vd x y z -vu x y z -vh 180 -vv 180`.
//! Options of several lines cumulate; what no line says has Radiance's default.

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
    /// Adds the options of `text`; unknown ones are passed over, as Radiance does.
    ///
    /// # Errors
    /// [`ImageError::View`] where a number is missing or none.
    pub fn add(&mut self, text: &str) -> Result<(), ImageError> {
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
                _ => {}
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

impl View {
    /// The view as Radiance's options.
    pub fn to_options(&self) -> String {
        let (kind, [horizontal, vertical]) = match self.projection {
            Projection::Perspective { horizontal_deg, vertical_deg } => ('v', [horizontal_deg, vertical_deg]),
            Projection::AngularFisheye { horizontal_deg, vertical_deg } => {
                ('a', [horizontal_deg, vertical_deg])
            }
            Projection::HemisphericalFisheye { horizontal_deg, vertical_deg } => {
                ('h', [horizontal_deg, vertical_deg])
            }
        };
        let mut text = format!("-vt{kind}");
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
}
