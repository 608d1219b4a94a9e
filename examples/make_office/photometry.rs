//! The two photometric files. Intensities follow simple made-up formulas, scaled so that the flux
//! of the *printed* values, interpolated linearly, is the rated one.

use super::lm63::{self, Label};
use super::quadrant::{Quadrant, tabulated};

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
    let label = Label {
        catalogue: "GL-1200",
        title: "Louvre 1200 x 200, 30 W",
        flux_lm: LOUVRE_LM,
        power_w: 30.0,
        opening_m: LOUVRE_M,
    };
    lm63::text(&label, &louvre())
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
