//! Sobolev's problem: a point source between two parallel diffuse plates. The exact solution for
//! infinite plates by Hankel's transform, the numerical one for discs of a radius, and the discs as
//! a scene. Lengths in units of the gap h = 1 m, the source of 1 cd at height a over plate 1.
#![allow(dead_code, reason = "each program uses a part")]

use std::f64::consts::{PI, TAU};

use gershun::geometry::mesh::Mesh;
use gershun::scene::Scene;
use glam::DVec3;

use crate::common::{lambert, point_lamp};

/// A source between two plates.
#[derive(Clone, Copy, Debug)]
pub struct Plates {
    /// Height of the source over plate 1, in gaps.
    pub source: f64,
    /// Reflectances of plate 1 (below) and plate 2.
    pub rho: [f64; 2],
}

/// Five-point Gauss–Legendre nodes and weights on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// J0(x) = 1/π ∫₀^π cos(x sin t) dt; the trapezium rule on a period converges faster than any power.
pub fn bessel_j0(x: f64) -> f64 {
    let n = 40 + x.abs().ceil() as usize;
    (0..n).map(|k| (x * (PI * (k as f64 + 0.5) / n as f64).sin()).cos()).sum::<f64>() / n as f64
}

/// x K1(x) with K1(x) = ∫₀^∞ exp(−x cosh t) cosh t dt, by the trapezium rule; 1 at x = 0.
pub fn x_bessel_k1(x: f64) -> f64 {
    if !(x > 0.0) {
        return 1.0;
    }
    let (step, mut sum, mut t) = (0.05f64, 0.5 * (-x).exp(), 0.05f64);
    while x * t.cosh() < 740.0 {
        sum += (-x * t.cosh()).exp() * t.cosh();
        t += step;
    }
    x * sum * step
}

impl Plates {
    /// Direct illuminance of plate 1 at distance `r`, lx.
    pub fn direct(&self, r: f64) -> f64 {
        self.source / (self.source * self.source + r * r).powf(1.5)
    }

    /// Illuminance of plate 1 at distance `r` between infinite plates, lx:
    /// E = a/(a² + r²)^{3/2} + ∫₀^∞ [ρ₂κ e^{−k(1−a)} + ρ₁ρ₂κ² e^{−ka}]/(1 − ρ₁ρ₂κ²) J₀(kr) k dk,
    /// κ = k K₁(k).
    pub fn exact(&self, r: f64) -> f64 {
        let (a, [rho1, rho2]) = (self.source, self.rho);
        let integrand = |k: f64| {
            let kappa = x_bessel_k1(k);
            let order = rho2 * kappa * (-k * (1.0 - a)).exp() + rho1 * rho2 * kappa * kappa * (-k * a).exp();
            order / (1.0 - rho1 * rho2 * kappa * kappa) * bessel_j0(k * r) * k
        };
        // Panels grow from 1e-6, where bright plates have their peak, and then follow J₀.
        let widest = 0.5 / r.max(1.0);
        let (mut low, mut sum) = (0.0, 0.0);
        while low < 45.0 {
            let high = low + (0.3f64 * low).clamp(1e-6, widest);
            sum += GAUSS
                .iter()
                .map(|(x, w)| w * integrand(0.5 * (low + high) + 0.5 * (high - low) * x))
                .sum::<f64>()
                * 0.5
                * (high - low);
            low = high;
        }
        self.direct(r) + sum
    }

    /// Illuminance of plate 1 at `places` between discs of `radius` by quadrature along the radius
    /// (kernel integrated over the azimuth in closed form) and conjugate gradients.
    pub fn discs(&self, radius: f64, places: &[f64]) -> Vec<f64> {
        let (mut nodes, mut low) = (Vec::new(), 0.0);
        while low < radius {
            let high = (low + 0.5f64).min(radius);
            for (x, w) in GAUSS {
                let r = 0.5 * (low + high) + 0.5 * (high - low) * x;
                nodes.push((r, 0.5 * (high - low) * w * r));
            }
            low = high;
        }
        // ∫ dφ/(π (A − B cos φ)²) = 2A/(A² − B²)^{3/2}
        let kernel = |r: f64, s: f64| {
            let (a, b) = (1.0 + r * r + s * s, 2.0 * r * s);
            2.0 * a / (a * a - b * b).powf(1.5)
        };
        let n = nodes.len();
        let matrix: Vec<f64> = (0..n * n)
            .map(|at| {
                let ((r, u), (s, v)) = (nodes[at / n], nodes[at % n]);
                (u * v).sqrt() * kernel(r, s)
            })
            .collect();
        let apply = |x: &[f64]| -> Vec<f64> {
            matrix.chunks(n).map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum()).collect()
        };
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let [rho1, rho2] = self.rho;
        let height = 1.0 - self.source;
        let above: Vec<f64> =
            nodes.iter().map(|(r, w)| w.sqrt() * height / (height * height + r * r).powf(1.5)).collect();
        let below: Vec<f64> = nodes.iter().map(|(r, w)| w.sqrt() * self.direct(*r)).collect();
        // (I − ρ₁ρ₂ K²) E₂ = E₂,direct + ρ₁ K E₁,direct, symmetric and positive.
        let mut rest: Vec<f64> =
            above.iter().zip(apply(&below)).map(|(above, from)| above + rho1 * from).collect();
        let (mut upper, mut way) = (vec![0.0; n], rest.clone());
        let mut square = dot(&rest, &rest);
        let enough = square * 1e-26;
        for _ in 0..2000 {
            if square <= enough {
                break;
            }
            let image: Vec<f64> =
                way.iter().zip(apply(&apply(&way))).map(|(x, kk)| x - rho1 * rho2 * kk).collect();
            let step = square / dot(&way, &image);
            for i in 0..n {
                upper[i] += step * way[i];
                rest[i] -= step * image[i];
            }
            let next = dot(&rest, &rest);
            for i in 0..n {
                way[i] = rest[i] + next / square * way[i];
            }
            square = next;
        }
        let at = |r: f64| {
            let from: f64 = nodes.iter().zip(&upper).map(|((s, w), e)| w.sqrt() * kernel(r, *s) * e).sum();
            self.direct(r) + rho2 * from
        };
        places.iter().map(|&r| at(r)).collect()
    }

    /// The discs as a scene: rings that widen outwards, so that the stored field is fine where light is.
    pub fn scene(&self, radius: f64) -> Scene {
        let mut mesh = Mesh::default();
        let mut rings = vec![0.0, 0.1];
        while rings[rings.len() - 1] < radius {
            rings.push((rings[rings.len() - 1] * 1.25).min(radius));
        }
        let sectors = 32;
        for (name, material, z) in [("below", 0, 0.0), ("above", 1, 1.0)] {
            let surface = mesh.add_surface(name, material, false);
            let point = |ring: usize, sector: usize| {
                let (sin, cos) = (TAU * sector as f64 / f64::from(sectors)).sin_cos();
                DVec3::new(rings[ring] * cos, rings[ring] * sin, z)
            };
            for ring in 1..rings.len() {
                for sector in 0..sectors as usize {
                    let next = (sector + 1) % sectors as usize;
                    let quad = [
                        point(ring - 1, sector),
                        point(ring, sector),
                        point(ring, next),
                        point(ring - 1, next),
                    ];
                    if ring > 1 {
                        mesh.add_quad(quad, surface);
                    } else {
                        let first = mesh.positions.len() as u32;
                        mesh.positions.extend([quad[0], quad[1], quad[2]]);
                        let vertices = [first, first + 1, first + 2];
                        mesh.triangles.push(gershun::geometry::mesh::Triangle { vertices, surface });
                    }
                }
            }
        }
        let materials = vec![lambert("below", self.rho[0]), lambert("above", self.rho[1])];
        let lamp = point_lamp(4.0 * PI, DVec3::new(0.0, 0.0, self.source));
        Scene::new(mesh, materials, vec![lamp]).expect("the scene is valid")
    }
}

/// A place of plate 1 at distance `r`, away from the edges of its triangles.
pub fn place(r: f64) -> DVec3 {
    let (sin, cos) = 0.11f64.sin_cos();
    DVec3::new(r * cos + 1e-4, r * sin + 1e-5, 0.0)
}
