//! A function of direction above a surface, stored as numbers: the paper's θ–φ grid, spherical harmonics
//! and an octahedral map. All three are linear: what is looked up is Σ_k w_k(direction) · number_k.
//! Directions are local to the surface, z along its normal; at z = 0 a lobe is dark though its limit is not,
//! so whoever samples must stay above.

mod harmonics;
mod octahedral;
mod theta_phi;

use glam::DVec3;

/// In which form, and how finely.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Equal steps in θ and φ, bilinear (Budak et al. 2021): 4·steps meridians, steps + 1 circles.
    ThetaPhi {
        /// Steps from the normal to the horizon.
        steps: usize,
    },
    /// Real spherical harmonics of even l + m up to an order: the function is continued evenly below the surface.
    Harmonics {
        /// Largest l.
        order: usize,
    },
    /// Octahedral map of the hemisphere with cubic interpolation (Catmull–Rom).
    Octahedral {
        /// Directions along an edge of the square, at least 2.
        size: usize,
    },
}

/// Numbers of a look-up with their weights; the rest has none.
pub type Weights = Vec<(u32, f64)>;

impl Form {
    /// How many numbers are stored.
    pub fn numbers(self) -> usize {
        match self {
            Self::ThetaPhi { steps } => (steps + 1) * 4 * steps,
            Self::Harmonics { order } => (order + 1) * (order + 2) / 2,
            Self::Octahedral { size } => size * size,
        }
    }

    /// Unit directions in which the function must be known.
    pub fn directions(self) -> Vec<DVec3> {
        match self {
            Self::ThetaPhi { steps } => theta_phi::directions(steps),
            Self::Harmonics { order } => {
                harmonics::quadrature(order).into_iter().map(|(direction, _)| direction).collect()
            }
            Self::Octahedral { size } => octahedral::directions(size),
        }
    }

    /// The numbers, `[number · channels + channel]`, of values in [`Form::directions`], laid out alike.
    pub fn store(self, values: &[f64], channels: usize) -> Vec<f64> {
        match self {
            Self::ThetaPhi { .. } | Self::Octahedral { .. } => values.to_vec(),
            Self::Harmonics { order } => harmonics::project(order, values, channels, |weight| weight),
        }
    }

    /// Variances of the numbers of [`Form::store`] from those of independent values.
    pub fn store_variances(self, variances: &[f64], channels: usize) -> Vec<f64> {
        match self {
            Self::ThetaPhi { .. } | Self::Octahedral { .. } => variances.to_vec(),
            Self::Harmonics { order } => {
                harmonics::project(order, variances, channels, |weight| weight * weight)
            }
        }
    }

    /// Weights of the numbers in a direction, written to `out`.
    pub fn weights(self, direction: DVec3, out: &mut Weights) {
        out.clear();
        match self {
            Self::ThetaPhi { steps } => theta_phi::weights(steps, direction, out),
            Self::Harmonics { order } => harmonics::weights(order, direction, out),
            Self::Octahedral { size } => octahedral::weights(size, direction, out),
        }
    }

    /// The function of one channel in a direction.
    pub fn look(self, numbers: &[f64], direction: DVec3) -> f64 {
        let mut weights = Weights::new();
        self.weights(direction, &mut weights);
        weights.iter().map(|&(number, weight)| weight * numbers[number as usize]).sum()
    }

    /// Mean over the stored directions of the square of one function; harmonics: over the sphere (Parseval).
    pub fn mean_square(self, numbers: impl Iterator<Item = f64>) -> f64 {
        let squares: f64 = numbers.map(|number| number * number).sum();
        match self {
            Self::ThetaPhi { .. } | Self::Octahedral { .. } => squares / self.numbers() as f64,
            Self::Harmonics { .. } => squares / (4.0 * std::f64::consts::PI),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    fn forms() -> [Form; 3] {
        [Form::ThetaPhi { steps: 12 }, Form::Harmonics { order: 8 }, Form::Octahedral { size: 16 }]
    }

    fn upper(rng: &mut Rng) -> DVec3 {
        let direction = crate::sphere::uniform_sphere(rng.uniforms());
        DVec3::new(direction.x, direction.y, direction.z.abs())
    }

    /// Largest difference between what is looked up in 500 directions and a function.
    fn worst(form: Form, numbers: &[f64], truth: impl Fn(DVec3) -> f64) -> f64 {
        let mut rng = Rng::new(1, 1, 1);
        let difference = |direction| (form.look(numbers, direction) - truth(direction)).abs();
        (0..500).map(|_| difference(upper(&mut rng))).fold(0.0, f64::max)
    }

    fn stored(form: Form, function: impl Fn(DVec3) -> f64) -> Vec<f64> {
        form.store(&form.directions().into_iter().map(function).collect::<Vec<f64>>(), 1)
    }

    /// Catches: weights that do not sum to one, a seam at φ = 0, a wrong quadrature.
    #[test]
    fn uniform_light_is_uniform_in_every_form() {
        for form in forms() {
            let mut numbers = stored(form, |_| 3.0);
            assert_eq!(numbers.len(), form.numbers());
            assert!(worst(form, &numbers, |_| 3.0) < 1e-10, "{form:?}");
            // The twin: one number of them off by a hundredth of the light.
            numbers[form.numbers() / 3] += 0.03;
            assert!(worst(form, &numbers, |_| 3.0) > 1e-10, "{form:?} hides a wrong number");
        }
    }

    /// Catches: axes swapped, a map that is not unfolded as it was folded, harmonics that are not orthonormal.
    #[test]
    fn smooth_light_comes_back_as_well_as_the_steps_allow() {
        let smooth = |w: DVec3| 1.0 + 0.5 * w.x - 0.3 * w.y * w.x + 0.2 * w.z * w.z;
        // The second derivative bounds bilinear interpolation: 1/8 · step² · |f''| in each of θ and φ.
        let bounds = [0.25 * (std::f64::consts::FRAC_PI_2 / 12.0).powi(2), 1e-10, 8e-3];
        for (form, bound) in forms().into_iter().zip(bounds) {
            let numbers = stored(form, smooth);
            let error = worst(form, &numbers, smooth);
            assert!(error < bound, "{form:?}: {error}");
            let turned = worst(form, &numbers, |w| smooth(DVec3::new(-w.y, w.x, w.z)));
            assert!(turned > 10.0 * bound, "{form:?} does not tell a quarter turn: {turned}");
        }
    }

    /// Catches: variances that are projected like values.
    #[test]
    fn variances_of_numbers_are_those_of_sampled_noise() {
        let form = Form::Harmonics { order: 3 };
        let (count, mut rng) = (form.directions().len(), Rng::new(2, 1, 1));
        let expected = form.store_variances(&vec![1.0 / 12.0; count], 1);
        let (runs, mut squares) = (4000, vec![0.0; form.numbers()]);
        for _ in 0..runs {
            let noise: Vec<f64> = (0..count).map(|_| rng.uniform() - 0.5).collect();
            for (square, number) in squares.iter_mut().zip(form.store(&noise, 1)) {
                *square += number * number / f64::from(runs);
            }
        }
        for (found, expected) in squares.iter().zip(&expected) {
            // A mean of 4 000 squares of nearly normal numbers: 5 σ are 5 √(2/4000).
            assert!((found / expected - 1.0).abs() < 0.112, "{found} is not {expected}");
        }
        let as_values = form.store(&vec![1.0 / 12.0; count], 1);
        assert!(as_values.iter().zip(&squares).any(|(a, b)| (a / b - 1.0).abs() > 0.112));
    }

    /// Catches: channels that are mixed up.
    #[test]
    fn channels_are_stored_apart() {
        for form in forms() {
            let directions = form.directions();
            let both: Vec<f64> = directions.iter().flat_map(|w| [w.z, 1.0 + w.x]).collect();
            let numbers = form.store(&both, 2);
            for (channel, alone) in [stored(form, |w| w.z), stored(form, |w| 1.0 + w.x)].iter().enumerate() {
                let picked = numbers.iter().skip(channel).step_by(2);
                assert!(picked.zip(alone).all(|(a, b)| (a - b).abs() < 1e-12), "{form:?}");
            }
        }
    }
}
