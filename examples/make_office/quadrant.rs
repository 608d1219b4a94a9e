//! Luminous intensities of one quadrant: what a made-up luminaire consists of.

/// Luminous intensities of one quadrant, planes first.
pub struct Quadrant {
    pub c_deg: Vec<f64>,
    pub gamma_deg: Vec<f64>,
    pub intensity: Vec<Vec<f64>>,
}

impl Quadrant {
    /// Intensities at whole steps of C and γ from a formula in radians.
    pub fn sample(c_step: f64, gamma_step: f64, intensity: impl Fn(f64, f64) -> f64) -> Self {
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
    pub fn scaled_to(mut self, flux: f64) -> Self {
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
    pub fn direct_ratio(&self, room_index: f64) -> f64 {
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

/// Intensities of a quadrant as a file lists them, planes first.
pub fn tabulated(c_deg: &[f64], gamma_deg: &[f64], values: &[f64]) -> Quadrant {
    assert_eq!(values.len(), c_deg.len() * gamma_deg.len(), "a full table");
    Quadrant {
        c_deg: c_deg.to_vec(),
        gamma_deg: gamma_deg.to_vec(),
        intensity: values.chunks(gamma_deg.len()).map(<[f64]>::to_vec).collect(),
    }
}
