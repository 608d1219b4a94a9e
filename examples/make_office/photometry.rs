//! The two photometric files. Intensities follow simple made-up formulas, scaled so that the flux
//! of the *printed* values, interpolated linearly, is the rated one.

use std::fmt::Write;

/// Luminous intensities of one quadrant, planes first.
pub struct Quadrant {
    pub c_deg: Vec<f64>,
    pub gamma_deg: Vec<f64>,
    pub intensity: Vec<Vec<f64>>,
}

impl Quadrant {
    fn sample(c_step: f64, gamma_step: f64, intensity: impl Fn(f64, f64) -> f64) -> Self {
        let angles =
            |step: f64| -> Vec<f64> { (0..=(90.0 / step) as u32).map(|k| f64::from(k) * step).collect() };
        let (c_deg, gamma_deg) = (angles(c_step), angles(gamma_step));
        let plane = |&c: &f64| {
            let along = gamma_deg.iter();
            along.map(|&gamma| intensity(c.to_radians(), gamma.to_radians()).max(0.0)).collect()
        };
        let intensity = c_deg.iter().map(plane).collect();
        Self { c_deg, gamma_deg, intensity }
    }

    /// Scales to `flux` and rounds to one decimal.
    fn scaled_to(mut self, flux: f64) -> Self {
        let factor = flux / self.flux();
        for value in self.intensity.iter_mut().flatten() {
            *value = (*value * factor * 10.0).round() / 10.0;
        }
        self
    }

    /// Φ = 4 ∫∫ I sinγ dγ dC of the bilinear interpolant over the quadrant, in closed form.
    pub fn flux(&self) -> f64 {
        let planes: Vec<f64> = self
            .intensity
            .iter()
            .map(|plane| {
                let zones = self.gamma_deg.windows(2).zip(plane.windows(2));
                zones
                    .map(|(gamma, value)| {
                        let (a, b) = (gamma[0].to_radians(), gamma[1].to_radians());
                        let slope = (value[1] - value[0]) / (b - a);
                        value[0] * a.cos() - value[1] * b.cos() + slope * (b.sin() - a.sin())
                    })
                    .sum()
            })
            .collect();
        let sectors = self.c_deg.windows(2).zip(planes.windows(2));
        let quarter: f64 =
            sectors.map(|(c, zone)| (c[1] - c[0]).to_radians() * 0.5 * (zone[0] + zone[1])).sum();
        4.0 * quarter
    }

    /// Bilinear interpolation.
    pub fn at(&self, c_deg: f64, gamma_deg: f64) -> f64 {
        let locate = |angles: &[f64], x: f64| {
            let last = angles.len() - 2;
            let cell = angles.partition_point(|&a| a <= x).saturating_sub(1).min(last);
            (cell, (x - angles[cell]) / (angles[cell + 1] - angles[cell]))
        };
        let (c, s) = locate(&self.c_deg, c_deg);
        let (g, t) = locate(&self.gamma_deg, gamma_deg);
        let along = |plane: &[f64]| plane[g] * (1.0 - t) + plane[g + 1] * t;
        along(&self.intensity[c]) * (1.0 - s) + along(&self.intensity[c + 1]) * s
    }

    /// Largest I / (A cosγ) from 65° to 85°, per m² of opening.
    pub fn luminance_beyond_65(&self, opening_m2: f64) -> f64 {
        let planes = self.intensity.iter().flat_map(|plane| self.gamma_deg.iter().zip(plane));
        planes
            .filter(|(gamma, _)| (65.0..=85.0).contains(*gamma))
            .map(|(gamma, value)| value / (opening_m2 * gamma.to_radians().cos()))
            .fold(0.0, f64::max)
    }

    /// Share of the flux that reaches the plane h below a square room's ceiling of edge 2 k h with a
    /// field of luminaires at most 1.25 h apart (half of it at the walls).
    fn direct_ratio(&self, room_index: f64) -> f64 {
        let edge_h = 2.0 * room_index;
        let rows = (edge_h / 1.25).ceil() as u32;
        let inside = |shift_h: f64| {
            let stays = |row: &u32| (f64::from(*row) + 0.5) / f64::from(rows) * edge_h + shift_h < edge_h;
            (0..rows).filter(stays).count() as f64 / f64::from(rows)
        };
        let (steps_c, steps_gamma) = (90, 360);
        let (mut reached, mut all) = (0.0, 0.0);
        for i in 0..steps_c {
            let c_deg = (f64::from(i) + 0.5) * 90.0 / f64::from(steps_c);
            let (sin_c, cos_c) = c_deg.to_radians().sin_cos();
            for j in 0..steps_gamma {
                let gamma_deg = (f64::from(j) + 0.5) * 90.0 / f64::from(steps_gamma);
                let (sin, cos) = gamma_deg.to_radians().sin_cos();
                let part = self.at(c_deg, gamma_deg) * sin;
                all += part;
                reached += part * inside(sin / cos * cos_c) * inside(sin / cos * sin_c);
            }
        }
        reached / all
    }
}

/// Edge of the panel's luminous square, m.
pub const PANEL_M: f64 = 0.565;
/// Rated flux of the panel, lm.
pub const PANEL_LM: f64 = 3800.0;
/// Rated flux of the louvre luminaire, lm.
pub const LOUVRE_LM: f64 = 3000.0;
/// Luminous opening of the louvre luminaire, length and width, m.
pub const LOUVRE_M: [f64; 2] = [1.15, 0.15];

/// cd/klm of a microprismatic panel: its luminance falls to less than half beyond 65°.
pub fn panel() -> Quadrant {
    Quadrant::sample(15.0, 5.0, |c, gamma| {
        let luminance = 0.25 + 0.75 / (1.0 + (gamma.to_degrees() / 52.0).powi(4));
        let prisms = 0.03 * (2.0 * c).cos() - 0.02 * (4.0 * c).cos();
        luminance * gamma.cos() * (1.0 + prisms * gamma.sin().powi(2))
    })
    .scaled_to(1000.0)
}

/// cd of a louvre luminaire: batwing in the 90° plane, cut off at 52°, 0° plane along its length.
pub fn louvre() -> Quadrant {
    Quadrant::sample(15.0, 2.5, |c, gamma| {
        let gamma_deg = gamma.to_degrees();
        let wings = (90.0_f64 / 35.0 * gamma).sin().powi(2) * 0.6;
        let across = gamma.cos() * (1.0 + wings);
        let along = gamma.cos().powf(1.3);
        let cut_off = 1.0 / (1.0 + ((gamma_deg - 52.0) / 2.2).exp());
        let blend = c.sin().powi(2);
        let stray = 0.018 * gamma.cos();
        (along * (1.0 - blend) + across * blend) * cut_off + stray
    })
    .scaled_to(LOUVRE_LM)
}

/// EULUMDAT text of the panel.
pub fn panel_ldt() -> String {
    let panel = panel();
    let luminous_mm = format!("{:.0}", PANEL_M * 1000.0);
    let rated_lm = format!("{PANEL_LM:.0}");
    let mut lines: Vec<String> = [
        "gershun example scenes",
        "3",  // any other symmetry than about the vertical axis, not linear
        "4",  // symmetric to C0-C180 and C90-C270
        "24", // planes
        "15",
        "37", // intensities in a plane
        "5",
        "computed",
        "Panel 600 x 600, microprismatic, 32 W",
        "GX-600",
        "panel.ldt",
        "made by make_office",
        "595", // housing: length, width, height, mm
        "595",
        "30",
        &luminous_mm, // length and width of the luminous area, mm
        &luminous_mm,
        "0", // its height in C0, C90, C180, C270
        "0",
        "0",
        "0",
        "100", // downward flux fraction, %
        "100", // light output ratio, %
        "1",
        "0",
        "1", // lamp sets
        "1",
        "LED",
        &rated_lm,
        "4000",
        "80",
        "32",
    ]
    .map(String::from)
    .into();
    let indices = [0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0];
    lines.extend(indices.map(|k| format!("{:.3}", panel.direct_ratio(k))));
    lines.extend((0..24).map(|k| format!("{}", k * 15)));
    lines.extend((0..37).map(|k| format!("{}", k * 5)));
    for plane in &panel.intensity {
        let above = std::iter::repeat_n(0.0, 37 - plane.len());
        lines.extend(plane.iter().copied().chain(above).map(|i| format!("{i:.1}")));
    }
    lines.join("\r\n") + "\r\n"
}

/// LM-63-2002 text of the louvre luminaire.
pub fn louvre_ies() -> String {
    let louvre = louvre();
    let [length, width] = LOUVRE_M;
    let mut lines: Vec<String> = [
        "IESNA:LM-63-2002",
        "[TEST] computed, not measured",
        "[TESTLAB] none",
        "[ISSUEDATE] 2026-01-01",
        "[MANUFAC] gershun example scenes",
        "[LUMCAT] GL-1200",
        "[LUMINAIRE] Louvre 1200 x 200, 30 W",
        "[LAMPCAT] LED",
        "[LAMP] LED 4000 K",
        "TILT=NONE",
    ]
    .map(String::from)
    .into();
    let (gammas, planes) = (louvre.gamma_deg.len(), louvre.c_deg.len());
    lines.push(format!("1 {LOUVRE_LM} 1 {gammas} {planes} 1 2 {width} {length} 0"));
    lines.push("1 1 30".into());
    let mut row = |values: &[f64], decimals: usize| {
        for chunk in values.chunks(13) {
            let mut line = String::new();
            for value in chunk {
                let gap = if line.is_empty() { "" } else { " " };
                write!(line, "{gap}{value:.decimals$}").expect("a string takes all text");
            }
            lines.push(line);
        }
    };
    row(&louvre.gamma_deg, 1);
    row(&louvre.c_deg, 0);
    for plane in &louvre.intensity {
        row(plane, 1);
    }
    lines.join("\r\n") + "\r\n"
}

/// Flux in lm of a file's text, read and summed by other means than it was written: midpoint rule
/// over fine cells. EULUMDAT with quadrant symmetry, or LM-63 with planes 0 … 90.
pub fn flux_of(text: &str) -> f64 {
    let (quadrant, scale) = if text.starts_with("IESNA") {
        let data = text.split("TILT=NONE").nth(1).unwrap_or_default();
        let numbers: Vec<f64> = data.split_whitespace().filter_map(|w| w.parse().ok()).collect();
        let (gammas, planes) = (numbers[3] as usize, numbers[4] as usize);
        let (gamma, rest) = numbers[13..].split_at(gammas);
        let (c, values) = rest.split_at(planes);
        (tabulated(c, gamma, values), numbers[2])
    } else {
        let number = |line: &str| line.trim().parse::<f64>().ok();
        let lines: Vec<&str> = text.lines().collect();
        let numbers: Vec<f64> = lines[42..].iter().copied().filter_map(number).collect();
        let (c, gamma) = (&numbers[..7], &numbers[24..61]);
        let klm = number(lines[28]).unwrap_or_default() / 1000.0;
        (tabulated(c, gamma, &numbers[61..]), klm)
    };
    let (step_c, step_gamma) = (0.5_f64, 0.125_f64);
    let last = *quadrant.gamma_deg.last().unwrap_or(&0.0);
    let mut flux = 0.0;
    for i in 0..(90.0 / step_c) as u32 {
        for j in 0..(last / step_gamma) as u32 {
            let c = (f64::from(i) + 0.5) * step_c;
            let gamma = (f64::from(j) + 0.5) * step_gamma;
            let cell_sr = gamma.to_radians().sin() * step_gamma.to_radians() * step_c.to_radians();
            flux += quadrant.at(c, gamma) * cell_sr;
        }
    }
    4.0 * scale * flux
}

fn tabulated(c_deg: &[f64], gamma_deg: &[f64], values: &[f64]) -> Quadrant {
    assert_eq!(values.len(), c_deg.len() * gamma_deg.len(), "a full table");
    Quadrant {
        c_deg: c_deg.to_vec(),
        gamma_deg: gamma_deg.to_vec(),
        intensity: values.chunks(gamma_deg.len()).map(<[f64]>::to_vec).collect(),
    }
}
