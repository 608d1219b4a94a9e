//! The light of a source near a line of sight by its angle from it. What strays in the eye falls with the second or
//! third power of that angle, so such a source counts ring by ring: pieces of an opening are far too coarse there, and
//! its centre says nothing.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Emitters;
use crate::sphere;

/// Half-angle of the innermost cone, degrees: light from within it is what is looked at.
pub const INNERMOST_DEG: f64 = 0.1;
/// Every ring reaches so many times as far as the one before.
const RATIO: f64 = 1.15;
/// Directions in each ring.
const AROUND: u32 = 64;
/// Turn from one direction to the next ring's, and steps across a ring: both even, neither in step with edges.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Panes one after the other through which a luminous surface is looked for.
const PANES: u32 = 8;

/// A source that can be met along a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shiner {
    /// A luminaire or its image: index into [`Emitters::sources`].
    Opening(usize),
    /// A luminous surface of the mesh, seen straight or through panes.
    Surface(usize),
}

/// Light of a source that comes from a ring about a line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Angle from the line of sight, degrees: that with which 1/θ² is the mean over the ring, 1/θ³ to 0.3 %; of the
    /// innermost cone its half.
    pub off_axis_deg: f64,
    /// Illuminance that it gives on the plane of the eye, ∫ L cos θ dω, lx.
    pub eye_lx: f64,
}

/// The light of a source ring by ring up to `to_deg` from the unit `gaze`, the innermost cone first. Directions are fixed,
/// 64 in a ring: an edge that crosses rings is known to about 1 % of the ring.
pub fn rings(emitters: &Emitters, shiner: Shiner, eye: DVec3, gaze: DVec3, to_deg: f64) -> Vec<Ring> {
    let frame = sphere::frame(gaze);
    let mean = |number: u32, [from_deg, end_deg]: [f64; 2]| {
        let luminance = |step: u32| {
            // Even in solid angle across the ring.
            let across = (f64::from(step) * GOLDEN + 0.5).fract();
            let [near, far] = [from_deg, end_deg].map(|angle_deg: f64| angle_deg.to_radians().cos());
            let cos = near + across * (far - near);
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            let turn = (f64::from(step) + f64::from(number) * GOLDEN).rem_euclid(f64::from(AROUND))
                / f64::from(AROUND);
            let (s, c) = (TAU * turn).sin_cos();
            along(emitters, shiner, eye, frame * DVec3::new(sin * c, sin * s, cos))
        };
        (0..AROUND).map(luminance).sum::<f64>() / f64::from(AROUND)
    };
    let size_sr = |[from_deg, end_deg]: [f64; 2]| {
        let half_sine = |angle_deg: f64| (0.5 * angle_deg.to_radians()).sin().powi(2);
        2.0 * TAU * (half_sine(end_deg) - half_sine(from_deg))
    };
    let mut found = Vec::new();
    let (mut from_deg, mut end_deg) = (0.0, INNERMOST_DEG);
    while from_deg < to_deg.min(90.0) {
        let ends = [from_deg, f64::min(end_deg, 90.0)];
        let [near, far] = ends;
        let off_axis_deg = if near > 0.0 {
            ((far * far - near * near) / (2.0 * (far / near).ln())).sqrt()
        } else {
            0.5 * far
        };
        let eye_lx = mean(found.len() as u32, ends) * size_sr(ends) * off_axis_deg.to_radians().cos();
        found.push(Ring { off_axis_deg, eye_lx });
        (from_deg, end_deg) = (end_deg, RATIO * end_deg);
    }
    found
}

/// Luminance that a source shows along a direction, cd/m², what stands before it taken off.
fn along(emitters: &Emitters, shiner: Shiner, eye: DVec3, direction: DVec3) -> f64 {
    match shiner {
        Shiner::Opening(index) => {
            let source = &emitters.sources[index];
            let met = emitters.along(source, eye, direction);
            met.map_or(0.0, |(luminance, arrival)| luminance * emitters.passed(source, eye, &arrival))
        }
        Shiner::Surface(surface) => {
            let (scene, mut origin, mut passed) = (emitters.scene, eye, 1.0);
            for _ in 0..PANES {
                let Some(hit) = scene.tracer.closest(origin, direction, &[]) else { return 0.0 };
                let bsdf = scene.bsdf(hit.triangle);
                if scene.tracer.surface(hit.triangle) as usize == surface {
                    return passed * bsdf.emitted();
                }
                let cos = direction.dot(scene.tracer.normal(hit.triangle)).abs();
                let Some((_, through)) = bsdf.specular(cos).filter(|(_, through)| *through > 0.0) else {
                    return 0.0;
                };
                passed *= through;
                origin += direction * (hit.distance_m + scene.tracer.offset_m() / cos.max(0.01));
            }
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh::Mesh;
    use crate::material::{Bsdf, Material};
    use crate::scene::Scene;
    use std::f64::consts::PI;

    /// Catches: a ring of the wrong size, the half-angle for the angle, rings that overlap or leave gaps.
    #[test]
    fn rings_of_a_plate_that_fills_the_view_add_up() {
        let mut mesh = Mesh::default();
        let surface = mesh.add_surface("plate", 0, true);
        let p = |y: f64, z: f64| DVec3::new(1.0, y, z);
        mesh.add_quad([p(-9.0, -9.0), p(-9.0, 9.0), p(9.0, 9.0), p(9.0, -9.0)], surface);
        let bsdf = Bsdf::Emitter { luminance_cd_m2: 100.0, reflectance: 0.0 };
        let scene =
            Scene::new(mesh, vec![Material { name: "plate".into(), bsdf }], Vec::new()).expect("a scene");
        let emitters = Emitters::new(&scene);
        let found = rings(&emitters, Shiner::Surface(0), DVec3::ZERO, DVec3::X, 30.0);
        let far_deg = found.iter().skip(1).fold(INNERMOST_DEG, |end, _| end * RATIO);
        let whole: f64 = found.iter().map(|ring| ring.eye_lx).sum();
        let expected = 100.0 * PI * far_deg.to_radians().sin().powi(2);
        assert!(far_deg >= 30.0 && (whole / expected - 1.0).abs() < 2e-3, "{whole} is not {expected}");
        // Σ E/θ² of all that strays, against its integral.
        let strayed: f64 = found.iter().skip(1).map(|ring| ring.eye_lx / ring.off_axis_deg.powi(2)).sum();
        let steps = 100_000;
        let exact: f64 = (0..steps)
            .map(|step| {
                let deg =
                    INNERMOST_DEG + (far_deg - INNERMOST_DEG) * (f64::from(step) + 0.5) / f64::from(steps);
                let (sin, cos) = deg.to_radians().sin_cos();
                let width = ((far_deg - INNERMOST_DEG) / f64::from(steps)).to_radians();
                100.0 * TAU * sin * cos * width / (deg * deg)
            })
            .sum();
        assert!((strayed / exact - 1.0).abs() < 3e-3, "{strayed} is not {exact}");
    }
}
