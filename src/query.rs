//! What can be asked of a solver: receivers (a point with one or more responses that share rays)
//! and rays (the luminance at a point in a direction). Observers and norms are spelled in these
//! terms by `plan`; a solver never hears of them.

mod zone;

use std::f64::consts::{FRAC_1_PI, PI};

use glam::{DMat3, DVec3};

use crate::sphere;
pub use zone::Zone;

/// Everything asked of one world.
#[derive(Clone, Debug, Default)]
pub struct Demand {
    /// Receivers; each kernel is one row of the sheet, in order.
    pub receivers: Vec<Receiver>,
    /// Rays; one row each, after all kernels.
    pub rays: Vec<Ray>,
    /// Whether the flux of every surface is tallied.
    pub flux: bool,
}

/// A point with the kernels measured there.
#[derive(Clone, Debug)]
pub struct Receiver {
    /// Position, m; on a surface it is lifted along `lift` by the solver.
    pub point: DVec3,
    /// Direction in which the point may be lifted off a surface it lies on, or zero.
    pub lift: DVec3,
    /// Responses; never empty.
    pub kernels: Vec<Kernel>,
}

/// A line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin, m.
    pub point: DVec3,
    /// Unit direction.
    pub direction: DVec3,
}

/// A receiver's response R(ω): E = ∫ L(ω) R(ω) dω. Every response integrates to π over the sphere,
/// so a uniform luminance L gives E = πL for each of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// max(0, cos θ).
    Planar {
        /// Unit normal.
        normal: DVec3,
    },
    /// sin ε / π, ε from the axis.
    Cylindrical {
        /// Unit axis.
        axis: DVec3,
    },
    /// sin ε (1 + cos α) / π, α the azimuth from `facing`.
    Semicylindrical {
        /// Unit axis.
        axis: DVec3,
        /// Unit vector perpendicular to the axis.
        facing: DVec3,
    },
    /// (1 + cos ε) / 4.
    Hemispherical {
        /// Unit axis.
        axis: DVec3,
    },
    /// 1 / 4.
    Spherical,
    /// π/Ω in a zone of solid angle Ω, 0 elsewhere: E/π is its mean luminance.
    Zone(Zone),
}

impl Demand {
    /// Number of rows of a sheet.
    pub fn rows(&self) -> usize {
        self.receivers.iter().map(|receiver| receiver.kernels.len()).sum::<usize>() + self.rays.len()
    }

    /// First row of each receiver.
    pub fn first_rows(&self) -> Vec<usize> {
        self.receivers
            .iter()
            .scan(0, |next, receiver| {
                let first = *next;
                *next += receiver.kernels.len();
                Some(first)
            })
            .collect()
    }
}

impl Kernel {
    /// R(ω) for light that arrives from the unit direction ω.
    pub fn response(&self, direction: DVec3) -> f64 {
        match *self {
            Self::Planar { normal } => normal.dot(direction).max(0.0),
            Self::Cylindrical { axis } => axis.cross(direction).length() * FRAC_1_PI,
            Self::Semicylindrical { axis, facing } => {
                // sin ε cos α is the component along `facing`.
                (axis.cross(direction).length() + facing.dot(direction)).max(0.0) * FRAC_1_PI
            }
            Self::Hemispherical { axis } => 0.25 * (1.0 + axis.dot(direction)),
            Self::Spherical => 0.25,
            Self::Zone(zone) => zone.response(direction),
        }
    }

    /// Whether the response ends at a sharp edge within what it sees, so that openings which the edge may cut are
    /// sampled and not integrated. (A plane ends at its horizon, at which openings are clipped.)
    pub fn has_edge(&self) -> bool {
        match self {
            Self::Zone(_) => true,
            Self::Planar { .. }
            | Self::Cylindrical { .. }
            | Self::Semicylindrical { .. }
            | Self::Hemispherical { .. }
            | Self::Spherical => false,
        }
    }

    /// Density in 1/sr with which [`Kernel::sample`] draws a direction.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        match *self {
            Self::Planar { normal } => normal.dot(direction).max(0.0) * FRAC_1_PI,
            Self::Hemispherical { .. } => self.response(direction) * FRAC_1_PI,
            Self::Semicylindrical { axis, facing } => {
                let sin = axis.cross(direction).length();
                let cos_azimuth = if sin > 0.0 { facing.dot(direction) / sin } else { 0.0 };
                (1.0 + cos_azimuth) * 0.25 * FRAC_1_PI
            }
            Self::Cylindrical { .. } | Self::Spherical => 0.25 * FRAC_1_PI,
            Self::Zone(zone) => zone.pdf(direction),
        }
    }

    /// Draws a direction of arrival.
    pub fn sample(&self, u: [f64; 3]) -> DVec3 {
        match *self {
            Self::Planar { normal } => sphere::frame(normal) * sphere::cosine_hemisphere([u[0], u[1]]),
            Self::Hemispherical { axis } => {
                let cos = 2.0 * u[0].sqrt() - 1.0;
                let sin = (1.0 - cos * cos).max(0.0).sqrt();
                let (s, c) = (2.0 * PI * u[1]).sin_cos();
                sphere::frame(axis) * DVec3::new(sin * c, sin * s, cos)
            }
            Self::Semicylindrical { axis, facing } => {
                // Azimuth uniform, then turned by 180° with probability (1 − cos α)/2: density (1 + cos α)/2π.
                let mut d = sphere::uniform_sphere([u[0], u[1]]);
                let radius = d.x.hypot(d.y);
                if radius > 0.0 && u[2] < 0.5 * (1.0 - d.x / radius) {
                    (d.x, d.y) = (-d.x, -d.y);
                }
                DMat3::from_cols(facing, axis.cross(facing), axis) * d
            }
            Self::Cylindrical { .. } | Self::Spherical => sphere::uniform_sphere([u[0], u[1]]),
            Self::Zone(zone) => zone.sample([u[0], u[1]]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    const TILTED: DVec3 = DVec3::new(0.36, 0.48, 0.8);

    fn kernels() -> [Kernel; 7] {
        let facing = TILTED.cross(DVec3::X).normalize();
        let zone =
            |front, angles_deg| Kernel::Zone(Zone::new(TILTED, front, angles_deg).expect("it is in sight"));
        [
            Kernel::Planar { normal: TILTED },
            Kernel::Cylindrical { axis: TILTED },
            Kernel::Semicylindrical { axis: TILTED, facing },
            Kernel::Hemispherical { axis: TILTED },
            Kernel::Spherical,
            zone(TILTED, [0.0, 50.0]),
            zone((TILTED + facing).normalize(), [30.0, 60.0]),
        ]
    }

    #[test]
    fn every_kernel_integrates_to_pi_and_every_density_to_one() {
        let n = 400;
        for kernel in kernels() {
            let (mut response, mut density) = (0.0, 0.0);
            for i in 0..n {
                for j in 0..n {
                    let u = [(f64::from(i) + 0.5) / f64::from(n), (f64::from(j) + 0.5) / f64::from(n)];
                    let solid_angle = 4.0 * PI / f64::from(n * n);
                    response += kernel.response(sphere::uniform_sphere(u)) * solid_angle;
                    density += kernel.pdf(sphere::uniform_sphere(u)) * solid_angle;
                }
            }
            // At an edge the quadrature counts whole cells.
            let within = if kernel.has_edge() { 5e-3 } else { 2e-4 };
            assert!((response - PI).abs() < within * PI, "{kernel:?}: {response}");
            assert!((density - 1.0).abs() < within, "{kernel:?}: {density}");
        }
    }

    #[test]
    fn sampling_follows_the_density() {
        // E of a linear radiance 1 + a·ω estimated by sampling equals its quadrature.
        let a = DVec3::new(0.2, -0.5, 0.4);
        for kernel in kernels() {
            let (n, mut rng, mut sum) = (200_000, Rng::new(3, 1, 4), 0.0);
            for _ in 0..n {
                let direction = kernel.sample(rng.uniforms());
                sum += kernel.response(direction) / kernel.pdf(direction) * (1.0 + a.dot(direction));
            }
            let mut exact = 0.0;
            for i in 0..400 {
                for j in 0..400 {
                    let d =
                        sphere::uniform_sphere([(f64::from(i) + 0.5) / 400.0, (f64::from(j) + 0.5) / 400.0]);
                    exact += kernel.response(d) * (1.0 + a.dot(d)) * 4.0 * PI / 160_000.0;
                }
            }
            let estimate = sum / f64::from(n);
            assert!((estimate - exact).abs() < 0.02, "{kernel:?}: {estimate} is not {exact}");
        }
    }
}
