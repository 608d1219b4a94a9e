//! The cumulative flux of a bilinear intensity table, for importance sampling. All integrals
//! carry the sinγ of the solid angle; without it the poles would receive too much light.

/// Cumulative fluxes over γ bands, and within each band over the wedges between planes.
#[derive(Clone, Debug)]
pub(super) struct EmissionCdf {
    /// Up to the end of each band, lm.
    bands: Vec<f64>,
    /// Per band: up to the end of each wedge, lm.
    wedges: Vec<f64>,
}

impl EmissionCdf {
    /// Axes in degrees, cd\[azimuth\]\[γ\] row by row.
    pub(super) fn new(azimuths_deg: &[f64], gammas_deg: &[f64], cd: &[f64]) -> Self {
        let columns = gammas_deg.len();
        let mut bands = Vec::with_capacity(columns - 1);
        let mut wedges = Vec::with_capacity((columns - 1) * (azimuths_deg.len() - 1));
        let mut total = 0.0;
        for (i, gamma) in gammas_deg.windows(2).enumerate() {
            let mut band = 0.0;
            for (j, azimuth) in azimuths_deg.windows(2).enumerate() {
                let mean = |i: usize| 0.5 * (cd[j * columns + i] + cd[(j + 1) * columns + i]);
                let ring =
                    segment_integral(mean(i), mean(i + 1), gamma[0].to_radians(), gamma[1].to_radians());
                band += ring.max(0.0) * (azimuth[1] - azimuth[0]).to_radians();
                wedges.push(band);
            }
            total += band;
            bands.push(total);
        }
        Self { bands, wedges }
    }

    /// The whole flux, lm.
    pub(super) fn flux(&self) -> f64 {
        self.bands[self.bands.len() - 1]
    }

    pub(super) fn scale(&mut self, factor: f64) {
        self.bands.iter_mut().chain(&mut self.wedges).for_each(|flux| *flux *= factor);
    }

    /// A band drawn by its flux; what is left of `u` is again uniform in \[0, 1\].
    pub(super) fn draw_band(&self, u: f64) -> (usize, f64) {
        draw(&self.bands, u)
    }

    /// A wedge of a band drawn by its flux.
    pub(super) fn draw_wedge(&self, band: usize, u: f64) -> (usize, f64) {
        let per_band = self.wedges.len() / self.bands.len();
        draw(&self.wedges[band * per_band..(band + 1) * per_band], u)
    }
}

fn draw(cumulative: &[f64], u: f64) -> (usize, f64) {
    let total = cumulative[cumulative.len() - 1];
    // Below the total, so that a cell without flux is never drawn.
    let x = (u * total).min(total.next_down());
    let cell = cumulative.partition_point(|flux| *flux <= x).min(cumulative.len() - 1);
    let before = if cell == 0 { 0.0 } else { cumulative[cell - 1] };
    let left = (x - before) / (cumulative[cell] - before);
    (cell, left.clamp(1e-15, 1.0 - 1e-15))
}

/// ∫ I(γ) sinγ dγ for I linear from `a` at γ0 to `b` at γ1 (rad), closed form.
/// With d = γ1 − γ0: a (cosγ0 − cosγ1) + (b − a)/d · \[sinγ1 − sinγ0 − d cosγ1\].
pub(super) fn segment_integral(a: f64, b: f64, g0: f64, g1: f64) -> f64 {
    partial_integral(a, b, g0, g1, 1.0)
}

/// The same up to γ0 + t (γ1 − γ0).
fn partial_integral(a: f64, b: f64, g0: f64, g1: f64, t: f64) -> f64 {
    let whole = g1 - g0;
    let d = t * whole;
    let end = g0 + d;
    // Written without differences of nearly equal numbers: narrow bands near the pole matter.
    let half_sine = (0.5 * d).sin();
    let constant = 2.0 * (0.5 * (g0 + end)).sin() * half_sine;
    let sine_minus_d =
        if d < 0.05 { -d.powi(3) / 6.0 * (1.0 - d * d / 20.0 * (1.0 - d * d / 42.0)) } else { d.sin() - d };
    let ramp = 2.0 * end.sin() * half_sine * half_sine + end.cos() * sine_minus_d;
    a * constant + (b - a) / whole * ramp
}

/// The t in 0 … 1 below which the share `u` of the segment's integral lies: Newton's method kept
/// inside a shrinking bracket.
pub(super) fn invert_segment(a: f64, b: f64, g0: f64, g1: f64, u: f64) -> f64 {
    let target = u * segment_integral(a, b, g0, g1);
    let (mut low, mut high) = (0.0, 1.0);
    // The start neglects that sinγ and I vary together: a linear density between the end values.
    let (p, q) = (a * g0.sin(), b * g1.sin());
    let root = p + (p * p + u * (q * q - p * p)).max(0.0).sqrt();
    let mut t = if root > 0.0 { (u * (p + q) / root).clamp(0.0, 1.0) } else { 0.5 };
    for _ in 0..60 {
        let miss = partial_integral(a, b, g0, g1, t) - target;
        if miss > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let density = (a + t * (b - a)) * (g0 + t * (g1 - g0)).sin() * (g1 - g0);
        let newton = t - miss / density;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() < 1e-12 {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Catches: a slip in the closed form, cancellation in narrow bands at the pole.
    #[test]
    fn segment_agrees_with_quadrature() {
        for (g0, g1) in
            [(0.0, 0.1), (0.3, 1.2), (0.0, PI), (3.0, PI), (0.0, 1e-6), (1.0, 1.0 + 1e-7), (0.0, 0.0499)]
        {
            let n = 20_000;
            let at = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
            let value =
                |k: i32| (2.0 + 5.0 * at(k)) * (g0 + at(k) * (g1 - g0)).sin() * (g1 - g0) / f64::from(n);
            let truth: f64 = (0..n).map(value).sum();
            let closed = segment_integral(2.0, 7.0, g0, g1);
            assert!((closed - truth).abs() < 1e-8 * truth, "{g0} {g1}: {closed} {truth}");
        }
    }

    /// Catches: Newton leaving the segment, or a start that never converges (I = 0 at an end).
    #[test]
    fn inversion_returns_the_share() {
        for (a, b) in [(1.0, 1.0), (0.0, 3.0), (3.0, 0.0), (1e-9, 1e9)] {
            for (g0, g1) in [(0.0, 0.04), (0.7, 1.6), (2.9, PI)] {
                for k in 0..=20 {
                    let u = f64::from(k) / 20.0;
                    let t = invert_segment(a, b, g0, g1, u);
                    let share = partial_integral(a, b, g0, g1, t) / segment_integral(a, b, g0, g1);
                    assert!(
                        (0.0..=1.0).contains(&t) && (share - u).abs() < 1e-9,
                        "{a} {b} {g0} {u}: {share}"
                    );
                }
            }
        }
    }

    /// Catches: bands without light drawn at u = 0 or u → 1.
    #[test]
    fn dark_cells_are_never_drawn() {
        let cumulative = [0.0, 2.0, 2.0, 5.0, 5.0];
        let cells = [0.0, 0.39, 0.41, 0.999, 1.0 - f64::EPSILON, 1.0].map(|u| draw(&cumulative, u).0);
        assert_eq!(cells, [1, 1, 3, 3, 3, 3]);
    }
}
