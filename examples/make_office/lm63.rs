//! LM-63-2002 text of a luminaire that is symmetric about both its axes.

use std::fmt::Write;

use super::quadrant::Quadrant;

/// What stands in the file besides its intensities.
pub struct Label<'a> {
    /// Catalogue number.
    pub catalogue: &'a str,
    /// What it is.
    pub title: &'a str,
    /// Rated flux, lm.
    pub flux_lm: f64,
    /// Power, W.
    pub power_w: f64,
    /// Length and width of the luminous opening, m.
    pub opening_m: [f64; 2],
}

/// The file; intensities in cd with one decimal.
pub fn text(label: &Label, quadrant: &Quadrant) -> String {
    let [length_m, width_m] = label.opening_m;
    let (gammas, planes) = (quadrant.gamma_deg.len(), quadrant.c_deg.len());
    let mut lines: Vec<String> = vec![
        "IESNA:LM-63-2002".into(),
        "[TEST] computed, not measured".into(),
        "[TESTLAB] none".into(),
        "[ISSUEDATE] 2026-01-01".into(),
        "[MANUFAC] gershun example scenes".into(),
        format!("[LUMCAT] {}", label.catalogue),
        format!("[LUMINAIRE] {}", label.title),
        "[LAMPCAT] LED".into(),
        "[LAMP] LED 4000 K".into(),
        "TILT=NONE".into(),
        format!("1 {} 1 {gammas} {planes} 1 2 {width_m} {length_m} 0", label.flux_lm),
        format!("1 1 {}", label.power_w),
    ];
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
    row(&quadrant.gamma_deg, 1);
    row(&quadrant.c_deg, 0);
    for plane in &quadrant.intensity {
        row(plane, 1);
    }
    lines.join("\r\n") + "\r\n"
}
