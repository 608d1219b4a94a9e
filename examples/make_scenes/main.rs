//! Writes the photometric files of `scenes/classroom`, `scenes/sports-hall` and `scenes/warehouse`; run
//! from the crate's root. Intensities follow simple made-up formulas; the flux of the *printed*
//! values, interpolated linearly, is the rated one.

#[path = "../make_office/lm63.rs"]
mod lm63;
#[path = "../make_office/quadrant.rs"]
#[allow(dead_code, reason = "the office uses more of it")]
mod quadrant;

use std::path::Path;

use lm63::Label;
use quadrant::{Quadrant, tabulated};

/// A luminaire of our own making.
pub struct Lamp {
    /// File below `scenes/`.
    pub path: &'static str,
    /// What it is.
    pub title: &'static str,
    /// Rated flux, lm.
    pub flux_lm: f64,
    /// Power, W.
    pub power_w: f64,
    /// Length and width of the luminous opening, m.
    pub opening_m: [f64; 2],
    /// Largest step of γ, degrees.
    pub gamma_step_deg: f64,
    /// Relative intensity along C and γ, radians; C = 0 along the length.
    pub intensity: fn(f64, f64) -> f64,
}

/// All of them.
pub const LAMPS: [Lamp; 5] = [
    Lamp {
        path: "classroom/panel.ies",
        title: "Panel 600 x 600, microprismatic, 14 W",
        flux_lm: 1600.0,
        power_w: 14.0,
        opening_m: [0.565, 0.565],
        gamma_step_deg: 5.0,
        intensity: panel,
    },
    Lamp {
        path: "classroom/board.ies",
        title: "Board luminaire 1200 x 150, batwing, 38 W",
        flux_lm: 4800.0,
        power_w: 38.0,
        opening_m: [1.15, 0.10],
        gamma_step_deg: 2.5,
        intensity: batwing,
    },
    Lamp {
        path: "sports-hall/highbay.ies",
        title: "High-bay 600 x 400, ball-proof, 150 W",
        flux_lm: 21_000.0,
        power_w: 150.0,
        opening_m: [0.55, 0.35],
        gamma_step_deg: 5.0,
        intensity: highbay,
    },
    Lamp {
        path: "warehouse/aisle.ies",
        title: "Aisle luminaire 1500 x 120, 75 W",
        flux_lm: 11_000.0,
        power_w: 75.0,
        opening_m: [1.45, 0.09],
        gamma_step_deg: 2.5,
        intensity: aisle,
    },
    Lamp {
        path: "warehouse/batten.ies",
        title: "Batten 1500 x 150, prismatic, 52 W",
        flux_lm: 7500.0,
        power_w: 52.0,
        opening_m: [1.45, 0.12],
        gamma_step_deg: 5.0,
        intensity: panel,
    },
];

/// A microprismatic cover: its luminance falls to less than half beyond 65°.
fn panel(c: f64, gamma: f64) -> f64 {
    let luminance = 0.25 + 0.75 / (1.0 + (gamma.to_degrees() / 52.0).powi(4));
    luminance * gamma.cos() * (1.0 + 0.03 * (2.0 * c).cos() * gamma.sin().powi(2))
}

/// Two wings across the length, at about 35°, cut off at 60°.
fn batwing(c: f64, gamma: f64) -> f64 {
    let across = c.sin().powi(2);
    let wings = 1.0 + 1.6 * across * (90.0_f64 / 35.0 * gamma).sin().powi(2);
    let cut_off = 1.0 / (1.0 + ((gamma.to_degrees() - 60.0) / 3.0).exp());
    gamma.cos() * wings * cut_off + 0.01 * gamma.cos()
}

/// A wide beam with a soft edge.
fn highbay(_: f64, gamma: f64) -> f64 {
    let edge = 1.0 / (1.0 + ((gamma.to_degrees() - 62.0) / 6.0).exp());
    gamma.cos().powf(0.6) * edge + 0.01 * gamma.cos()
}

/// Narrow across its length, so that light falls into the aisle, and wide along it.
fn aisle(c: f64, gamma: f64) -> f64 {
    let across = c.sin().powi(2);
    let sharp = 1.0 + 5.0 * across;
    let wings = 1.0 + 0.8 * (1.0 - across) * (90.0_f64 / 40.0 * gamma).sin().powi(2);
    gamma.cos().powf(sharp) * wings
}

impl Lamp {
    /// Intensities in cd.
    pub fn quadrant(&self) -> Quadrant {
        Quadrant::sample(15.0, self.gamma_step_deg, self.intensity).scaled_to(self.flux_lm)
    }

    /// LM-63-2002 text.
    pub fn ies(&self) -> String {
        let label = Label {
            catalogue: "none",
            title: self.title,
            flux_lm: self.flux_lm,
            power_w: self.power_w,
            opening_m: self.opening_m,
        };
        lm63::text(&label, &self.quadrant())
    }

    /// Flux in lm of the file's text, read back and summed by the closed form of its interpolant.
    pub fn flux_of_text_lm(&self) -> f64 {
        let text = self.ies();
        let data = text.split("TILT=NONE").nth(1).unwrap_or_default();
        let numbers: Vec<f64> = data.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let (gammas, planes) = (numbers[3] as usize, numbers[4] as usize);
        let (gamma, rest) = numbers[13..].split_at(gammas);
        let (c, values) = rest.split_at(planes);
        numbers[2] * tabulated(c, gamma, values).flux()
    }
}

#[allow(clippy::print_stdout, reason = "a generator says what it wrote")]
fn main() -> std::io::Result<()> {
    for lamp in &LAMPS {
        let path = Path::new("scenes").join(lamp.path);
        std::fs::write(&path, lamp.ies())?;
        println!("{}: {:.0} lm", path.display(), lamp.flux_of_text_lm());
    }
    Ok(())
}
