//! The paper's grid: equal steps in θ and φ, bilinear. The normal is stored once for every meridian.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::Weights;

pub(super) fn directions(steps: usize) -> Vec<DVec3> {
    let around = 4 * steps;
    let step = FRAC_PI_2 / steps as f64;
    let at = |k: usize| {
        let (theta, phi) = ((k / around) as f64 * step, (k % around) as f64 * step);
        DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
    };
    (0..(steps + 1) * around).map(at).collect()
}

pub(super) fn weights(steps: usize, w: DVec3, out: &mut Weights) {
    let around = 4 * steps;
    let step = FRAC_PI_2 / steps as f64;
    let theta = w.z.clamp(-1.0, 1.0).acos() / step;
    let phi = w.y.atan2(w.x).rem_euclid(TAU) / step;
    let (i, j) = ((theta as usize).min(steps - 1), phi as usize % around);
    let (u, v) = (theta - i as f64, phi - phi.floor());
    let number = |i: usize, j: usize| (i * around + j % around) as u32;
    out.extend([
        (number(i, j), (1.0 - u) * (1.0 - v)),
        (number(i, j + 1), (1.0 - u) * v),
        (number(i + 1, j), u * (1.0 - v)),
        (number(i + 1, j + 1), u * v),
    ]);
}
