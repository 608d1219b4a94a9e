//! Real spherical harmonics of even l + m: those that are even about the surface, by which a function
//! on the hemisphere is continued below it. Half of (L + 1)² are left, and no jump at the horizon.

use std::f64::consts::{PI, SQRT_2, TAU};

use glam::DVec3;

use super::Weights;

/// Directions above the surface with the weights by which ∫ over the whole sphere of an even function is
/// their sum: Gauss–Legendre in z, equal steps in φ, exact for products of two harmonics up to `order`.
pub(super) fn quadrature(order: usize) -> Vec<(DVec3, f64)> {
    let (levels, around) = (gauss(order + 2), 2 * order + 4);
    let mut all = Vec::with_capacity(levels.len() * around);
    for (z, weight) in levels {
        for k in 0..around {
            let phi = TAU * k as f64 / around as f64;
            let s = (1.0 - z * z).sqrt();
            // Twice, for the continuation below.
            all.push((DVec3::new(s * phi.cos(), s * phi.sin(), z), 2.0 * weight * TAU / around as f64));
        }
    }
    all
}

/// c_j = Σ_i g(w_i y_j(ω_i)) v_i for every channel: coefficients with g(x) = x, their variances with g(x) = x².
pub(super) fn project(order: usize, values: &[f64], channels: usize, g: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut basis = Vec::new();
    let mut coefficients = vec![0.0; (order + 1) * (order + 2) / 2 * channels];
    for ((direction, weight), values) in quadrature(order).into_iter().zip(values.chunks(channels)) {
        harmonics(order, direction, &mut basis);
        for (coefficients, y) in coefficients.chunks_mut(channels).zip(&basis) {
            let factor = g(weight * y);
            for (coefficient, value) in coefficients.iter_mut().zip(values) {
                *coefficient += factor * value;
            }
        }
    }
    coefficients
}

pub(super) fn weights(order: usize, direction: DVec3, out: &mut Weights) {
    let mut basis = Vec::new();
    harmonics(order, direction, &mut basis);
    out.extend(basis.into_iter().enumerate().map(|(number, y)| (number as u32, y)));
}

/// Gauss–Legendre nodes and weights on [0, 1].
fn gauss(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|k| {
            let mut x = (PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut p, mut before) = (1.0, 0.0);
                for l in 0..n {
                    let l = l as f64;
                    (p, before) = (((2.0 * l + 1.0) * x * p - l * before) / (l + 1.0), p);
                }
                slope = n as f64 * (x * p - before) / (x * x - 1.0);
                let step = p / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (x + 1.0), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Harmonics of even l + m at a direction, orthonormal on the sphere, order by order in m.
fn harmonics(order: usize, w: DVec3, out: &mut Vec<f64>) {
    out.clear();
    let (z, s) = (w.z, (1.0 - w.z * w.z).max(0.0).sqrt());
    let phi = w.y.atan2(w.x);
    let mut diagonal = (1.0 / (4.0 * PI)).sqrt();
    for m in 0..=order {
        if m > 0 {
            diagonal *= -((2 * m + 1) as f64 / (2 * m) as f64).sqrt() * s;
        }
        let (mut p, mut before) = (diagonal, 0.0);
        let m2 = (m * m) as f64;
        let (sin, cos) = (m as f64 * phi).sin_cos();
        for l in m..=order {
            if l > m {
                let l2 = (l * l) as f64;
                let a = ((4.0 * l2 - 1.0) / (l2 - m2)).sqrt();
                let b = (((l - 1) * (l - 1)) as f64 - m2) / (4.0 * ((l - 1) * (l - 1)) as f64 - 1.0);
                (p, before) = (a * (z * p - b.max(0.0).sqrt() * before), p);
            }
            if (l + m) % 2 == 1 {
                continue;
            }
            if m == 0 {
                out.push(p);
            } else {
                out.push(SQRT_2 * p * cos);
                out.push(SQRT_2 * p * sin);
            }
        }
    }
}
