//! Differences of a method from the links method, one quantity and one seed at a time: receivers of
//! one run share chains, so differences that share a seed are not independent.
#![allow(dead_code, reason = "each test binary uses a part")]

use gershun::estimate::Estimate;
use gershun::material::Bsdf;
use gershun::query::{Demand, Kernel, Ray, Receiver};
use gershun::scene::Scene;
use gershun::solve::{Effort, LocalEffort, Method};
use glam::DVec3;
use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::common::{planar, row, sheets};

const BLOCKS: u64 = 64;

/// Receivers of every kind in a room of `size` from the origin, among them points 1 cm from corners
/// and on walls, and lines of sight from `eye` to `targets`.
pub fn demand(size: DVec3, eye: DVec3, targets: &[DVec3]) -> Demand {
    let up = DVec3::Z;
    let facing = DVec3::new(0.6, 0.8, 0.0);
    let mut receivers = vec![
        planar(DVec3::new(0.5 * size.x, 0.7 * size.y, 0.0), up),
        planar(DVec3::new(0.01, 0.01, 0.0), up),
        planar(DVec3::new(size.x - 0.01, size.y - 0.01, size.z), -up),
        planar(DVec3::new(0.0, 0.75 * size.y, 1.3), DVec3::X),
        planar(DVec3::new(0.5 * size.x, 0.0, 1.3), DVec3::Y),
        planar(DVec3::new(0.8 * size.x, 0.7 * size.y, 0.9), -facing),
    ];
    for kernels in [
        vec![Kernel::Cylindrical { axis: up }],
        vec![Kernel::Semicylindrical { axis: up, facing }, Kernel::Planar { normal: facing }],
        vec![Kernel::Hemispherical { axis: up }],
        vec![Kernel::Spherical],
    ] {
        receivers.push(Receiver { point: eye, lift: DVec3::ZERO, kernels });
    }
    let rays = targets.iter().map(|to| Ray { point: eye, direction: (to - eye).normalize() }).collect();
    Demand { receivers, rays, flux: false }
}

/// The part of a demand that holds receiver or ray `index`.
fn only(demand: &Demand, index: usize) -> Demand {
    let receivers: Vec<Receiver> = demand.receivers.get(index).cloned().into_iter().collect();
    let ray = index.checked_sub(demand.receivers.len()).and_then(|ray| demand.rays.get(ray));
    Demand { receivers, rays: ray.copied().into_iter().collect(), flux: false }
}

/// Reference values by links, one per receiver (its first kernel) and ray.
fn reference(scene: &Scene, demand: &Demand) -> Vec<Estimate> {
    // Highlights of highlights are rare, and reflections of small tiles in panes even more: they need more to
    // be known well.
    let any = |is: fn(&Bsdf) -> bool| scene.materials.iter().any(|material| is(&material.bsdf));
    let blocks = match (any(|bsdf| bsdf.emitted() > 0.0), any(|bsdf| bsdf.lobe().is_some())) {
        (true, _) => 12_288,
        (false, true) => 4096,
        (false, false) => 512,
    };
    let effort = Effort { gather: 64, walks: 32, ..Effort::default() };
    let sheets = sheets(scene, demand, Method::Links, effort, 1, blocks);
    let first_ray = demand.rows() - demand.rays.len();
    let rows = demand.first_rows().into_iter().chain(first_ray..demand.rows());
    rows.map(|index| Estimate::from_blocks(&row(&sheets, index, scene.channels.len()))).collect()
}

/// t values of `seeds` runs of each quantity against the reference, sorted, and the p-value of the
/// Kolmogorov–Smirnov test of their t-null.
fn differences(
    scene: &Scene,
    demand: &Demand,
    reference: &[Estimate],
    method: Method,
    local: LocalEffort,
    seeds: u64,
) -> (Vec<f64>, f64) {
    let effort = Effort { local, ..Effort::default() };
    let runs: Vec<(usize, u64)> =
        (0..reference.len()).flat_map(|index| (0..seeds).map(move |seed| (index, seed))).collect();
    let mut t: Vec<f64> = runs
        .into_par_iter()
        .map(|(index, seed)| {
            let demand = only(demand, index);
            let sheets = sheets(scene, &demand, method, effort, 1000 + seed * 64 + index as u64, BLOCKS);
            let found = Estimate::from_blocks(&row(&sheets, 0, scene.channels.len()));
            let known = reference[index];
            // One reference serves all seeds: it must not decide.
            assert!(known.se < 0.3 * found.se, "{index}: {known:?} is no reference for {found:?}");
            (found.value - known.value) / found.se.hypot(known.se)
        })
        .collect();
    t.sort_by(f64::total_cmp);
    let null = StudentsT::new(0.0, 1.0, (BLOCKS - 1) as f64).expect("positive degrees of freedom");
    let n = t.len() as f64;
    let distance = t.iter().enumerate().fold(0f64, |d, (i, &x)| {
        let f = null.cdf(x);
        d.max((f - i as f64 / n).abs()).max(((i + 1) as f64 / n - f).abs())
    });
    let x = (n.sqrt() + 0.12 + 0.11 / n.sqrt()) * distance;
    let p: f64 = (1..100).map(|k| 2.0 * (-1f64).powi(k - 1) * (-2.0 * f64::from(k * k) * x * x).exp()).sum();
    (t, p.clamp(0.0, 1.0))
}

/// The same scene with every diffuse reflectance 2 % higher.
pub fn brighter(scene: &Scene) -> Scene {
    let mut materials = scene.materials.clone();
    for material in &mut materials {
        if let Bsdf::Lambert { reflectance } = &mut material.bsdf {
            *reflectance *= 1.02;
        }
    }
    Scene::new(scene.mesh.clone(), materials, scene.luminaires.clone()).expect("the twin is valid")
}

/// A method agrees with links on a scene, and the twin is told apart.
pub fn agree(name: &str, scene: &Scene, twin: &Scene, demand: &Demand, method: Method, local: LocalEffort) {
    let before = crate::common::cpu_seconds();
    let known = reference(scene, demand);
    let seeds = 200u64.div_ceil(known.len() as u64);
    let (t, p) = differences(scene, demand, &known, method, local, seeds);
    println!("{name}: {} differences, KS p = {p:.4}, extremes {:.2} … {:.2}", t.len(), t[0], t[t.len() - 1]);
    assert!(t.len() >= 200, "too few differences: {}", t.len());
    assert!(p > 0.01, "differences do not follow their null: p = {p}");
    let (_, p) = differences(twin, demand, &known, method, local, seeds);
    println!("{name}, twin: KS p = {p:.2e}; {:.1} CPU-s", crate::common::cpu_seconds() - before);
    assert!(p < 0.01, "a reflectance off by 2 % passes: p = {p}");
}
