//! A checked table of intensities and its bilinear interpolant: look-up, partial integrals and
//! sampling of one and the same function.

use super::emission::{EmissionCdf, invert_segment, segment_integral};

/// cd[azimuth][γ] row by row; the last row repeats the first.
#[derive(Clone, Debug)]
pub(super) struct Table {
    pub(super) azimuths: Axis,
    pub(super) gammas: Axis,
    pub(super) cd: Vec<f64>,
    pub(super) rotational: bool,
    emission: EmissionCdf,
}

impl Table {
    /// Rising axes in degrees, cd\[azimuth\]\[γ\] row by row; `rotational` when all rows are equal.
    pub(super) fn new(azimuths_deg: Vec<f64>, gammas_deg: Vec<f64>, cd: Vec<f64>, rotational: bool) -> Self {
        let emission = EmissionCdf::new(&azimuths_deg, &gammas_deg, &cd);
        let (azimuths, gammas) = (Axis::new(azimuths_deg), Axis::new(gammas_deg));
        Self { azimuths, gammas, cd, rotational, emission }
    }

    pub(super) fn flux(&self) -> f64 {
        self.emission.flux()
    }

    pub(super) fn scale(&mut self, factor: f64) {
        self.cd.iter_mut().for_each(|cd| *cd *= factor);
        self.emission.scale(factor);
    }

    #[inline]
    pub(super) fn interpolate(&self, azimuth_deg: f64, gamma_deg: f64) -> f64 {
        let Some((i, t)) = self.gammas.locate(gamma_deg) else {
            return 0.0;
        };
        let along_gamma = |plane: usize| {
            let at = plane * self.gammas.values.len() + i;
            self.cd[at] + t * (self.cd[at + 1] - self.cd[at])
        };
        if self.rotational {
            return along_gamma(0);
        }
        let Some((j, s)) = self.azimuths.locate(azimuth_deg) else {
            return 0.0;
        };
        let (here, next) = (along_gamma(j), along_gamma(j + 1));
        here + s * (next - here)
    }

    /// Whether all is 0 from an angle on.
    pub(super) fn is_dark_from(&self, gamma_deg: f64) -> bool {
        let gammas = &self.gammas.values;
        let next = gammas.partition_point(|gamma| *gamma < gamma_deg);
        // Between two values light fades towards the second.
        let straddles = gammas.get(next).is_some_and(|gamma| *gamma > gamma_deg);
        let first = if straddles { next.saturating_sub(1) } else { next };
        self.cd.chunks(gammas.len()).all(|plane| plane[first..].iter().all(|cd| !(*cd > 0.0)))
    }

    pub(super) fn zonal_flux(&self, from_deg: f64, to_deg: f64) -> f64 {
        let columns = self.gammas.values.len();
        let plane_integral = |plane: usize| -> f64 {
            let cd = &self.cd[plane * columns..(plane + 1) * columns];
            let mut sum = 0.0;
            for (gamma, cd) in self.gammas.values.windows(2).zip(cd.windows(2)) {
                let (from, to) = (gamma[0].max(from_deg), gamma[1].min(to_deg));
                if to > from {
                    let slope = (cd[1] - cd[0]) / (gamma[1] - gamma[0]);
                    let [a, b] = [from, to].map(|g| cd[0] + slope * (g - gamma[0]));
                    sum += segment_integral(a, b, from.to_radians(), to.to_radians());
                }
            }
            sum
        };
        let integrals: Vec<f64> = (0..self.azimuths.values.len()).map(plane_integral).collect();
        let wedge =
            |(azimuth, i): (&[f64], &[f64])| (azimuth[1] - azimuth[0]).to_radians() * 0.5 * (i[0] + i[1]);
        self.azimuths.values.windows(2).zip(integrals.windows(2)).map(wedge).sum()
    }

    /// (azimuth in rad, γ in rad, cd there). γ first from its marginal in the drawn cell, then
    /// the azimuth, in which the intensity is linear.
    pub(super) fn sample(&self, u: f64, v: f64) -> (f64, f64, f64) {
        let columns = self.gammas.values.len();
        let (i, u) = self.emission.draw_band(u);
        let (j, v) = self.emission.draw_wedge(i, v);
        let [here, next] =
            [j, j + 1].map(|plane| [self.cd[plane * columns + i], self.cd[plane * columns + i + 1]]);
        let [g0, g1] = [i, i + 1].map(|i| self.gammas.values[i].to_radians());
        let t = invert_segment(here[0] + next[0], here[1] + next[1], g0, g1, u);
        let a = here[0] + t * (here[1] - here[0]);
        let b = next[0] + t * (next[1] - next[0]);
        // ∫₀ˢ a + (b − a)s' ds' = v (a + b)/2, solved in the form that is stable for a = b.
        let s = (v * (a + b) / (a + (a * a + v * (b * b - a * a)).max(0.0).sqrt())).clamp(0.0, 1.0);
        let [phi0, phi1] = [j, j + 1].map(|j| self.azimuths.values[j].to_radians());
        (phi0 + s * (phi1 - phi0), g0 + t * (g1 - g0), a + s * (b - a))
    }
}

/// Rising values in degrees; a uniform step gives the cell without a search.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    pub(super) values: Vec<f64>,
    cells_per_degree: Option<f64>,
}

impl Axis {
    fn new(values: Vec<f64>) -> Self {
        let (first, last) = ends(&values);
        let step = (last - first) / (values.len() - 1) as f64;
        let on_step = |(k, value): (usize, &f64)| (value - first - step * k as f64).abs() < 1e-9;
        let uniform = values.iter().enumerate().all(on_step);
        Self { cells_per_degree: uniform.then(|| 1.0 / step), values }
    }

    /// The cell that holds `at`, and the position 0 … 1 within it.
    #[inline]
    fn locate(&self, at: f64) -> Option<(usize, f64)> {
        let values = &self.values;
        let (first, last) = ends(values);
        if !(at >= first && at <= last) {
            return None;
        }
        if let Some(cells_per_degree) = self.cells_per_degree {
            let x = (at - first) * cells_per_degree;
            let cell = (x as usize).min(values.len() - 2);
            return Some((cell, (x - cell as f64).min(1.0)));
        }
        let cell = values.partition_point(|value| *value <= at).clamp(1, values.len() - 1) - 1;
        Some((cell, (at - values[cell]) / (values[cell + 1] - values[cell])))
    }
}

/// First and last value.
pub(super) fn ends(values: &[f64]) -> (f64, f64) {
    (values[0], values[values.len() - 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: light above the horizon that is taken for dark, at a value, between two, or in one plane only.
    #[test]
    fn dark_is_what_has_no_light_from_there_on() {
        let dark = |gammas: &[f64], cd: &[f64]| {
            Table::new(vec![0.0, 360.0], gammas.to_vec(), cd.to_vec(), false).is_dark_from(90.0)
        };
        assert!(dark(&[0.0, 45.0, 90.0, 180.0], &[9.0, 9.0, 0.0, 0.0, 9.0, 9.0, 0.0, 0.0]));
        assert!(dark(&[0.0, 45.0, 85.0], &[9.0, 9.0, 1.0, 9.0, 9.0, 1.0]));
        assert!(!dark(&[0.0, 45.0, 90.0, 180.0], &[9.0, 9.0, 0.0, 0.0, 9.0, 9.0, 1.0, 0.0]));
        assert!(!dark(&[0.0, 80.0, 100.0, 180.0], &[9.0, 9.0, 0.0, 0.0, 9.0, 9.0, 0.0, 0.0]));
        assert!(dark(&[0.0, 80.0, 100.0, 180.0], &[9.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0]));
    }

    /// Catches: a uniform-step shortcut that disagrees with the search at nodes and edges.
    #[test]
    fn uniform_and_searched_cells_agree() {
        let fast = Axis::new((0..=72).map(|k| f64::from(k) * 2.5).collect());
        let slow = Axis { values: fast.values.clone(), cells_per_degree: None };
        assert!(fast.cells_per_degree.is_some());
        for k in 0..=1800 {
            let at = f64::from(k) * 0.1;
            let position = |axis: &Axis| axis.locate(at).map(|(cell, t)| cell as f64 + t);
            assert!((position(&fast).expect("inside") - position(&slow).expect("inside")).abs() < 1e-9);
        }
        assert_eq!(fast.locate(180.1), None);
    }
}
