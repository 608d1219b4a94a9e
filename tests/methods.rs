//! The links method and the path tracer share nothing but scene and tracer. Their differences,
//! divided by their combined standard errors, must look like Student's t: a bias of either shows.

mod common;

use common::{furnished, row, sheets};
use gershun::estimate::Estimate;
use gershun::query::{Demand, Kernel, Ray, Receiver};
use gershun::scene::Scene;
use gershun::solve::{Effort, Method};
use glam::DVec3;
use statrs::distribution::{ContinuousCDF, StudentsT};

fn demand() -> Demand {
    let mut receivers = Vec::new();
    let up = DVec3::Z;
    for i in 0..5 {
        for j in 0..4 {
            let p = DVec3::new(0.6 + 1.2 * f64::from(i), 0.5 + f64::from(j), 0.9);
            receivers.push(Receiver { point: p, lift: up, kernels: vec![Kernel::Planar { normal: up }] });
            let facing = DVec3::new(0.6, 0.8, 0.0);
            let kernels = vec![
                Kernel::Cylindrical { axis: up },
                Kernel::Semicylindrical { axis: up, facing },
                Kernel::Hemispherical { axis: up },
                Kernel::Spherical,
                Kernel::Planar { normal: -facing },
            ];
            receivers.push(Receiver { point: p + DVec3::Z * 0.4, lift: DVec3::ZERO, kernels });
        }
        let wall = DVec3::new(0.5 + 1.2 * f64::from(i), 0.0, 1.3);
        receivers.push(Receiver {
            point: wall,
            lift: DVec3::Y,
            kernels: vec![Kernel::Planar { normal: DVec3::Y }],
        });
        let ceiling = DVec3::new(0.5 + 1.2 * f64::from(i), 0.7, 2.8);
        receivers.push(Receiver { point: ceiling, lift: -up, kernels: vec![Kernel::Planar { normal: -up }] });
        let floor = DVec3::new(0.5 + 1.2 * f64::from(i), 0.03, 0.0);
        receivers.push(Receiver { point: floor, lift: up, kernels: vec![Kernel::Planar { normal: up }] });
    }
    let eye = DVec3::new(3.2, 0.6, 1.2);
    let rays = (0..70)
        .map(|k| {
            let (s, c) = (f64::from(k) * 0.53).sin_cos();
            let target = match k % 4 {
                0 => DVec3::new(0.01, 1.0 + 0.02 * f64::from(k), 1.2), // the mirror
                1 => DVec3::new(5.9, 0.3 + 0.02 * f64::from(k), 1.0),  // through the pane
                2 => DVec3::new(3.0 + 3.0 * c, 2.0 + 2.0 * s, 2.8),    // ceiling and luminaires
                _ => DVec3::new(2.0 + 0.02 * f64::from(k), 2.2, 1.0),  // the opal
            };
            Ray { point: eye, direction: (target - eye).normalize() }
        })
        .collect();
    Demand { receivers, rays, flux: false }
}

/// t values of all rows, and the p-value of the Kolmogorov–Smirnov test of their t-null.
fn differences(links: &Scene, path: &Scene, seed: u64) -> (Vec<f64>, f64) {
    let (blocks, demand) = (64, demand());
    let a = sheets(
        links,
        &demand,
        Method::Links,
        Effort { gather: 16, walks: 8, ..Effort::default() },
        seed,
        blocks,
    );
    let b = sheets(path, &demand, Method::Path, Effort { paths: 128, ..Effort::default() }, seed, blocks);
    let channels = links.channels.len();
    let mut t: Vec<f64> = Vec::new();
    for index in 0..demand.rows() {
        let (x, y) = (
            Estimate::from_blocks(&row(&a, index, channels)),
            Estimate::from_blocks(&row(&b, index, channels)),
        );
        let se = x.se.hypot(y.se);
        if se > 1e-9 * x.value.abs() {
            t.push((x.value - y.value) / se);
        } else {
            assert!((x.value - y.value).abs() <= 1e-9 * x.value.abs(), "row {index}: {x:?} against {y:?}");
        }
    }
    // The path tracer's error dominates: about blocks − 1 degrees of freedom.
    let null = StudentsT::new(0.0, 1.0, (blocks - 1) as f64).expect("positive degrees of freedom");
    t.sort_by(f64::total_cmp);
    let n = t.len() as f64;
    let distance = t.iter().enumerate().fold(0f64, |d, (i, &x)| {
        let f = null.cdf(x);
        d.max((f - i as f64 / n).abs()).max(((i + 1) as f64 / n - f).abs())
    });
    let x = (n.sqrt() + 0.12 + 0.11 / n.sqrt()) * distance;
    let p: f64 = (1..100).map(|k| 2.0 * (-1f64).powi(k - 1) * (-2.0 * f64::from(k * k) * x * x).exp()).sum();
    (t, p.clamp(0.0, 1.0))
}

#[test]
fn links_and_path_agree_in_a_room_with_mirror_pane_and_opal() {
    let scene = furnished();
    let (t, p) = differences(&scene, &scene, 1);
    println!("{} differences, KS p = {p:.4}, extremes {:.2} … {:.2}", t.len(), t[0], t[t.len() - 1]);
    assert!(t.len() >= 190, "too few quantities: {}", t.len());
    assert!(p > 0.01, "differences do not follow their null: p = {p}");
}

#[test]
fn a_reflectance_off_by_two_percent_is_rejected() {
    let scene = furnished();
    let mut materials = scene.materials.clone();
    for material in &mut materials {
        if let gershun::material::Bsdf::Lambert { reflectance } = &mut material.bsdf {
            *reflectance *= 1.02;
        }
    }
    let twin = Scene::new(scene.mesh.clone(), materials, scene.luminaires.clone()).unwrap();
    let (_, p) = differences(&scene, &twin, 1);
    println!("broken twin: KS p = {p:.2e}");
    assert!(p < 0.01, "the twin passes: p = {p}");
}
