//! Luminous intensity over the full sphere, absolute cd, luminaire frame. What is interpolated
//! here (bilinear in azimuth and γ) is exactly what is integrated by `flux` and sampled by
//! `sample_direction`; outside the tabulated γ range the intensity is 0, not the last value.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::grid::{self, DistributionError};
use super::table::Table;
use crate::units::{Candelas, Lumens};

/// Absolute luminous intensities of a luminaire on the full sphere of its own frame.
#[derive(Clone, Debug)]
pub struct IntensityDistribution {
    shape: Shape,
    flux: Lumens,
}

#[derive(Clone, Debug)]
enum Shape {
    Lambert,
    Isotropic,
    Table(Table),
}

impl IntensityDistribution {
    /// A table cd\[azimuth\]\[γ\]: azimuths rise from 0 to 360, γ within 0 … 180 (0 cd outside the
    /// covered range), the column at 360° equal to that at 0°.
    ///
    /// # Errors
    /// When an axis or the table is not as above.
    pub fn from_grid(
        azimuths_deg: Vec<f64>,
        gammas_deg: Vec<f64>,
        cd: Vec<Vec<f64>>,
    ) -> Result<Self, DistributionError> {
        grid::check(&azimuths_deg, &gammas_deg, &cd)?;
        let rotational = cd.iter().all(|plane| *plane == cd[0]);
        let cd = cd.into_iter().flatten().collect();
        let table = Table::new(azimuths_deg, gammas_deg, cd, rotational);
        Ok(Self { flux: Lumens(table.flux()), shape: Shape::Table(table) })
    }

    /// Flux of an ideal plane Lambertian emitter; `None` for any other distribution.
    pub fn lambert_flux(&self) -> Option<f64> {
        matches!(self.shape, Shape::Lambert).then_some(self.flux.0)
    }

    /// A plane Lambertian emitter facing γ = 0: I = Φ/π · cosγ below the horizon, exact.
    pub fn lambert(flux: Lumens) -> Self {
        Self { shape: Shape::Lambert, flux }
    }

    /// The same intensity in every direction: I = Φ/4π, exact.
    pub fn isotropic(flux: Lumens) -> Self {
        Self { shape: Shape::Isotropic, flux }
    }

    /// I in cd along a unit direction of the luminaire frame (γ = 0 is −z, azimuth from +x to +y).
    #[inline]
    pub fn intensity_along(&self, direction: DVec3) -> f64 {
        match &self.shape {
            Shape::Lambert => self.flux.0 / PI * (-direction.z).max(0.0),
            Shape::Isotropic => self.flux.0 / (4.0 * PI),
            Shape::Table(table) => {
                let gamma_deg = (-direction.z).clamp(-1.0, 1.0).acos().to_degrees();
                let azimuth_deg = if table.rotational { 0.0 } else { azimuth_deg(direction) };
                table.interpolate(azimuth_deg, gamma_deg)
            }
        }
    }

    /// Whether there is no light at γ ≥ 90°.
    pub fn is_dark_above(&self) -> bool {
        match &self.shape {
            Shape::Lambert => true,
            Shape::Isotropic => false,
            Shape::Table(table) => table.is_dark_from(90.0),
        }
    }

    /// I in cd at an azimuth (any turn) and γ of the luminaire frame, degrees.
    pub fn intensity_at(&self, azimuth_deg: f64, gamma_deg: f64) -> f64 {
        match &self.shape {
            Shape::Lambert if gamma_deg < 90.0 => self.flux.0 / PI * gamma_deg.to_radians().cos(),
            Shape::Lambert => 0.0,
            Shape::Isotropic => self.flux.0 / (4.0 * PI),
            Shape::Table(table) => table.interpolate(azimuth_deg.rem_euclid(360.0), gamma_deg),
        }
    }

    /// Φ = ∫∫ I sinγ dγ dφ over the sphere, the exact integral of the interpolant.
    pub fn flux(&self) -> Lumens {
        self.flux
    }

    /// The flux between two cones about γ = 0, exact as well; 0 if the range is empty.
    pub fn zonal_flux(&self, from_gamma_deg: f64, to_gamma_deg: f64) -> Lumens {
        let (from, to) = (from_gamma_deg.clamp(0.0, 180.0), to_gamma_deg.clamp(0.0, 180.0));
        if !(to > from) {
            return Lumens(0.0);
        }
        match &self.shape {
            Shape::Lambert => {
                let sin2 = |gamma_deg: f64| gamma_deg.to_radians().min(FRAC_PI_2).sin().powi(2);
                self.flux * (sin2(to) - sin2(from))
            }
            Shape::Isotropic => self.flux * (0.5 * (from.to_radians().cos() - to.to_radians().cos())),
            Shape::Table(table) => Lumens(table.zonal_flux(from, to)),
        }
    }

    /// All intensities times a factor.
    ///
    /// # Panics
    /// When the factor is negative or not finite: dimming and flux ratios are checked on input.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        assert!(factor.is_finite() && factor >= 0.0, "intensities are scaled by a finite factor ≥ 0");
        let mut scaled = self.clone();
        scaled.flux = self.flux * factor;
        if let Shape::Table(table) = &mut scaled.shape {
            table.scale(factor);
        }
        scaled
    }

    /// The largest intensity; the interpolant has its maximum at a node.
    pub fn max_intensity(&self) -> Candelas {
        Candelas(match &self.shape {
            Shape::Lambert => self.flux.0 / PI,
            Shape::Isotropic => self.flux.0 / (4.0 * PI),
            Shape::Table(table) => table.cd.iter().copied().fold(0.0, f64::max),
        })
    }

    /// All planes equal.
    pub fn is_rotationally_symmetric(&self) -> bool {
        match &self.shape {
            Shape::Lambert | Shape::Isotropic => true,
            Shape::Table(table) => table.rotational,
        }
    }

    /// The nodes: azimuths and γ in degrees; `None` for the analytic distributions.
    pub fn grid(&self) -> Option<(&[f64], &[f64])> {
        match &self.shape {
            Shape::Lambert | Shape::Isotropic => None,
            Shape::Table(table) => Some((&table.azimuths.values, &table.gammas.values)),
        }
    }

    /// A direction drawn with density I/Φ, and that density in 1/sr. `u` in \[0, 1)³: u\[0\] decides γ,
    /// u\[1\] the azimuth, so that low-discrepancy points stay well spread; u\[2\] is not needed by the
    /// present shapes. A dark distribution is sampled uniformly, so that I/pdf is 0.
    pub fn sample_direction(&self, u: [f64; 3]) -> (DVec3, f64) {
        let [u, v] = [u[0], u[1]].map(|u| u.clamp(1e-15, 1.0 - 1e-15));
        let uniform = (direction(TAU * v, (1.0 - 2.0 * u).acos()), 0.25 / PI);
        if !(self.flux.0 > 0.0) {
            return uniform;
        }
        match &self.shape {
            Shape::Lambert => {
                let cos = (1.0 - u).sqrt();
                (direction(TAU * v, cos.acos()), cos / PI)
            }
            Shape::Isotropic => uniform,
            Shape::Table(table) => {
                let (azimuth_rad, gamma_rad, cd) = table.sample(u, v);
                (direction(azimuth_rad, gamma_rad), cd / self.flux.0)
            }
        }
    }
}

fn direction(azimuth_rad: f64, gamma_rad: f64) -> DVec3 {
    let (sin_gamma, cos_gamma) = gamma_rad.sin_cos();
    let (sin_azimuth, cos_azimuth) = azimuth_rad.sin_cos();
    DVec3::new(sin_gamma * cos_azimuth, sin_gamma * sin_azimuth, -cos_gamma)
}

fn azimuth_deg(direction: DVec3) -> f64 {
    let azimuth = direction.y.atan2(direction.x).to_degrees();
    if azimuth < 0.0 { azimuth + 360.0 } else { azimuth }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uneven in both axes, asymmetric, with uplight and a gap below γ = 5°.
    fn uneven() -> IntensityDistribution {
        let azimuths = vec![0.0, 30.0, 100.0, 200.0, 360.0];
        let gammas = vec![5.0, 20.0, 50.0, 90.0, 100.0, 170.0];
        let value = |j: usize, i: usize| {
            if i == 3 { 0.0 } else { 100.0 + 40.0 * (j % 4) as f64 - 12.0 * i as f64 }
        };
        let cd = (0..5).map(|j| (0..6).map(|i| value(j, i)).collect()).collect();
        IntensityDistribution::from_grid(azimuths, gammas, cd).expect("valid grid")
    }

    fn close(a: f64, b: f64, relative: f64) {
        assert!((a - b).abs() <= relative * b.abs(), "{a} is not {b}");
    }

    /// Midpoint quadrature through the look-up, independent of the closed form.
    fn quadrature(d: &IntensityDistribution, from_deg: f64, to_deg: f64) -> f64 {
        // Steps of 0.05° meet every node, where the interpolant has kinks and ends.
        let (step, n_azimuth) = (0.05, 360);
        let n_gamma = ((to_deg - from_deg) / step).round() as i32;
        let ring = |i: i32| -> f64 {
            let gamma = from_deg + step * (f64::from(i) + 0.5);
            let sum: f64 = (0..n_azimuth).map(|j| d.intensity_at(f64::from(j) + 0.5, gamma)).sum();
            sum * TAU / f64::from(n_azimuth) * gamma.to_radians().sin() * step.to_radians()
        };
        (0..n_gamma).map(ring).sum()
    }

    /// Catches: uneven planes weighted evenly, zonal-constant rule, 360° wedge left out.
    #[test]
    fn flux_is_the_integral_of_the_look_up() {
        let d = uneven();
        close(d.flux().0, quadrature(&d, 0.0, 180.0), 1e-6);
        close(d.zonal_flux(33.0, 97.0).0, quadrature(&d, 33.0, 97.0), 1e-6);
        close(d.zonal_flux(0.0, 180.0).0, d.flux().0, 1e-13);
        close(d.zonal_flux(0.0, 61.0).0 + d.zonal_flux(61.0, 180.0).0, d.flux().0, 1e-13);
    }

    /// Catches: a wrong constant (2π for π) or a table behind the analytic shapes.
    #[test]
    fn analytic_shapes_have_their_flux() {
        for d in
            [IntensityDistribution::lambert(Lumens(1000.0)), IntensityDistribution::isotropic(Lumens(1000.0))]
        {
            close(quadrature(&d, 0.0, 180.0), 1000.0, 1e-6);
            close(quadrature(&d, 0.0, 40.0), d.zonal_flux(0.0, 40.0).0, 1e-6);
            close(d.scaled(2.0).max_intensity().0, 2.0 * d.max_intensity().0, 1e-15);
        }
        let lambert = IntensityDistribution::lambert(Lumens(PI));
        close(lambert.intensity_along(DVec3::NEG_Z), 1.0, 1e-15);
        assert!(lambert.intensity_along(DVec3::Z).abs() < 1e-300);
    }

    /// Catches: azimuth turned or mirrored, γ from the zenith, range edges extrapolated.
    #[test]
    fn look_up_by_direction_agrees_with_angles() {
        let d = uneven();
        for (azimuth, gamma) in [(0.0, 20.0), (30.0, 50.0), (77.0, 33.0), (290.0, 95.0), (359.9, 169.0)] {
            let w = direction(f64::to_radians(azimuth), f64::to_radians(gamma));
            close(d.intensity_along(w), d.intensity_at(azimuth, gamma), 1e-9);
        }
        close(d.intensity_at(30.0, 20.0), 128.0, 1e-12);
        close(
            d.intensity_along(direction(FRAC_PI_2, 20f64.to_radians())),
            88.0 + 40.0 + 40.0 * 60.0 / 70.0,
            1e-12,
        );
        close(d.intensity_at(30.0 - 720.0, 20.0), 128.0, 1e-12);
        assert!(d.intensity_at(30.0, 4.9).abs() < 1e-300 && d.intensity_at(30.0, 171.0).abs() < 1e-300);
    }

    fn lcg(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*state >> 11) as f64 / (1u64 << 53) as f64
    }

    /// χ² per degree of freedom over 9 × 6 bins against the zonal integral of the look-up.
    fn chi2(d: &IntensityDistribution, mut draw: impl FnMut([f64; 3]) -> DVec3) -> f64 {
        let (n, mut seed, mut counts) = (200_000, 7, [[0.0; 6]; 9]);
        for _ in 0..n {
            let w = draw([lcg(&mut seed), lcg(&mut seed), lcg(&mut seed)]);
            let gamma = (-w.z).clamp(-1.0, 1.0).acos().to_degrees();
            counts[(gamma / 20.0) as usize % 9][(azimuth_deg(w) / 60.0) as usize % 6] += 1.0;
        }
        let mut sum = 0.0;
        for (i, row) in counts.iter().enumerate() {
            for (j, count) in row.iter().enumerate() {
                let cell = |k: i32| {
                    let gamma = 20.0 * i as f64 + (f64::from(k / 60) + 0.5) / 10.0;
                    let azimuth = 60.0 * j as f64 + f64::from(k % 60) + 0.5;
                    d.intensity_at(azimuth, gamma)
                        * gamma.to_radians().sin()
                        * 0.1_f64.to_radians()
                        * 1_f64.to_radians()
                };
                let expected = f64::from(n) * (0..200 * 60).map(cell).sum::<f64>() / d.flux().0;
                sum += (count - expected).powi(2) / expected;
            }
        }
        sum / 53.0
    }

    /// Catches: sampling by I without sinγ, by the mean plane only, or with swapped planes. χ²/53
    /// has a standard deviation of 0.19; five of them are allowed, the broken twins exceed 20.
    #[test]
    fn samples_follow_the_interpolant() {
        let d = uneven();
        let good = chi2(&d, |u| d.sample_direction(u).0);
        assert!(good < 1.0 + 5.0 * 0.194, "χ²/dof {good}");
        let uniform_azimuth = chi2(&d, |u| {
            let w = d.sample_direction(u).0;
            direction(TAU * u[2], (-w.z).acos())
        });
        let no_sine = chi2(&d, |u| {
            let w = d.sample_direction(u).0;
            direction(w.y.atan2(w.x), PI * u[0])
        });
        assert!(uniform_azimuth > 20.0 && no_sine > 20.0, "{uniform_azimuth} {no_sine}");
        for shape in
            [IntensityDistribution::lambert(Lumens(5.0)), IntensityDistribution::isotropic(Lumens(5.0))]
        {
            let mut seed = 3;
            let mean_z =
                (0..20_000).map(|_| -shape.sample_direction([lcg(&mut seed), lcg(&mut seed), 0.0]).0.z);
            let mean_z = mean_z.sum::<f64>() / 20_000.0;
            let truth = if shape.intensity_at(0.0, 180.0) > 0.0 { 0.0 } else { 2.0 / 3.0 };
            assert!((mean_z - truth).abs() < 5.0 * 0.6 / 20_000_f64.sqrt(), "{mean_z}");
        }
    }

    /// Catches: a density of another interpolant than the look-up's; division by 0 at u = 0.
    #[test]
    fn density_is_intensity_over_flux() {
        let d = uneven();
        let mut seed = 11;
        for k in 0..5000 {
            let u = if k == 0 { [0.0; 3] } else { [lcg(&mut seed), lcg(&mut seed), lcg(&mut seed)] };
            let (w, pdf) = d.sample_direction(u);
            assert!(pdf > 0.0 && (w.length() - 1.0).abs() < 1e-12);
            if k > 0 {
                close(pdf, d.intensity_along(w) / d.flux().0, 1e-6);
            }
        }
        let dark = d.scaled(0.0);
        let (w, pdf) = dark.sample_direction([0.3, 0.4, 0.5]);
        assert!(pdf > 0.0 && (dark.intensity_along(w) / pdf).abs() < 1e-300);
    }

    /// Catches: unsorted, short, open, negative or infinite tables taken in silently.
    #[test]
    fn bad_tables_are_refused() {
        let make = |azimuths: &[f64], gammas: &[f64], cd: &[[f64; 2]]| {
            let cd = cd.iter().map(|plane| plane.to_vec()).collect();
            IntensityDistribution::from_grid(azimuths.to_vec(), gammas.to_vec(), cd).map(|d| d.flux().0)
        };
        let (round, down) = ([0.0, 360.0], [0.0, 90.0]);
        assert!(make(&round, &down, &[[1.0, 0.0]; 2]).is_ok());
        assert!(make(&round, &[45.0, 40.0], &[[1.0, 0.0]; 2]).is_err());
        assert!(make(&round, &[0.0, f64::NAN], &[[1.0, 0.0]; 2]).is_err());
        assert!(make(&[0.0, 180.0], &down, &[[1.0, 0.0]; 2]).is_err());
        assert!(make(&round, &[0.0, 190.0], &[[1.0, 0.0]; 2]).is_err());
        assert!(make(&round, &down, &[[1.0, 0.0]]).is_err());
        assert!(make(&round, &down, &[[1.0, 0.0], [2.0, 0.0]]).is_err());
        assert!(make(&round, &down, &[[-1.0, 0.0]; 2]).is_err());
        assert!(make(&round, &down, &[[f64::INFINITY, 0.0]; 2]).is_err());
        assert_eq!(
            make(&round, &down, &[[f64::MAX, f64::MAX]; 2]),
            Err(DistributionError::Overflow { cd: f64::MAX })
        );
    }
}
