//! The links method and the path tracer share nothing but scene and tracer. Their differences,
//! divided by their combined standard errors, must look like Student's t: a bias of either shows.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;

use common::{furnished, glossy_room, row, sheets};
use gershun::estimate::Estimate;
use gershun::query::{Demand, Kernel, Ray, Receiver, Zone};
use gershun::scene::Scene;
use gershun::solve::{Effort, Method};
use glam::DVec3;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// 205 quantities in a room of `size` from the origin: every kernel on a grid in the air, planes on
/// walls, ceiling and floor, and lines of sight from `eye` towards `targets` in turn.
fn demand(size: DVec3, eye: DVec3, targets: [DVec3; 4]) -> Demand {
    let mut receivers = Vec::new();
    let up = DVec3::Z;
    for i in 0..5 {
        let x = size.x * (0.1 + 0.2 * f64::from(i));
        for j in 0..4 {
            let p = DVec3::new(x, size.y * (0.125 + 0.25 * f64::from(j)), 0.9);
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
        let mut on = |point: DVec3, normal: DVec3| {
            receivers.push(Receiver { point, lift: normal, kernels: vec![Kernel::Planar { normal }] });
        };
        on(DVec3::new(x, 0.0, 1.3), DVec3::Y);
        on(DVec3::new(x, 0.7, size.z), -up);
        on(DVec3::new(x, 0.03, 0.0), up);
    }
    let rays = (0..70u32)
        .map(|k| {
            let (s, c) = (f64::from(k) * 0.53).sin_cos();
            let target = targets[k as usize % 4] + DVec3::new(c, s, -s) * 0.15;
            Ray { point: eye, direction: (target - eye).normalize() }
        })
        .collect();
    Demand { receivers, rays, flux: false }
}

fn furnished_demand() -> Demand {
    let targets = [
        DVec3::new(0.01, 1.7, 1.2), // the mirror
        DVec3::new(5.9, 1.0, 1.0),  // through the pane
        DVec3::new(4.5, 1.0, 2.8),  // a luminaire and the ceiling round it
        DVec3::new(2.7, 2.2, 1.0),  // the opal
    ];
    demand(DVec3::new(6.0, 4.0, 2.8), DVec3::new(3.2, 0.6, 1.2), targets)
}

/// t values of all rows, and the p-value of the Kolmogorov–Smirnov test of their t-null.
fn differences(links: &Scene, path: &Scene, demand: &Demand, seed: u64) -> (Vec<f64>, f64) {
    let blocks = 64;
    let a = sheets(
        links,
        demand,
        Method::Links,
        Effort { gather: 16, walks: 4, ..Effort::default() },
        seed,
        blocks,
    );
    let b = sheets(path, demand, Method::Path, Effort { paths: 40, ..Effort::default() }, seed, blocks);
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

/// The same scene with every diffuse reflectance `factor` times as high.
fn brighter(scene: &Scene, factor: f64) -> Scene {
    let mut materials = scene.materials.clone();
    for material in &mut materials {
        if let gershun::material::Bsdf::Lambert { reflectance } = &mut material.bsdf {
            *reflectance *= factor;
        }
    }
    Scene::new(scene.mesh.clone(), materials, scene.luminaires.clone()).expect("the twin is valid")
}

/// Both methods agree on a scene for independent seeds, and the twin is told apart.
fn agree(name: &str, scene: &Scene, twin: &Scene, demand: &Demand) {
    let before = common::cpu_seconds();
    for seed in [1, 2, 3] {
        let (t, p) = differences(scene, scene, demand, seed);
        let extremes = [t[0], t[t.len() - 1]];
        println!("{name}, seed {seed}: {} differences, KS p = {p:.4}, extremes {extremes:.2?}", t.len());
        assert!(t.len() >= 200, "too few quantities: {}", t.len());
        assert!(p > 0.01, "differences do not follow their null: p = {p}");
    }
    let (_, p) = differences(scene, twin, demand, 1);
    println!("{name}, twin: KS p = {p:.2e}; {:.1} CPU-s", common::cpu_seconds() - before);
    assert!(p < 0.01, "a reflectance off by 2 % passes: p = {p}");
}

#[test]
fn methods_agree_in_a_room_with_mirror_pane_and_opal() {
    let scene = furnished();
    agree("furnished", &scene, &brighter(&scene, 1.02), &furnished_demand());
}

fn glossy_demand() -> Demand {
    let targets = [
        DVec3::new(0.01, 1.7, 1.2),  // the mirror, if there is one
        DVec3::new(2.8, 1.4, 0.74),  // the sharp desk
        DVec3::new(3.05, 1.6, 0.0),  // the floor where it reflects a downlight
        DVec3::new(3.05, 4.0, 1.75), // the wall of the paper's lobe
    ];
    demand(DVec3::new(6.0, 4.0, 2.8), DVec3::new(3.2, 0.6, 1.2), targets)
}

#[test]
fn methods_agree_on_glossy_surfaces_under_downlights() {
    let (scene, twin) = (glossy_room([1.0, 1.0], true), glossy_room([1.02, 1.0], true));
    agree("downlights", &scene, &twin, &glossy_demand());
}

#[test]
fn methods_agree_on_glossy_surfaces_beside_a_mirror() {
    let (scene, twin) = (glossy_room([1.0, 1.0], false), glossy_room([1.02, 1.0], false));
    agree("glossy and mirror", &scene, &twin, &glossy_demand());
}

#[test]
fn methods_agree_in_the_box() {
    let project = project("scenes/box");
    let targets = [
        DVec3::new(0.0, 2.0, 1.2),
        DVec3::new(5.0, 2.0, 1.0),
        DVec3::new(1.25, 1.0, 2.8), // a luminaire
        DVec3::new(2.5, 4.0, 2.0),
    ];
    let demand = demand(DVec3::new(5.0, 4.0, 2.8), DVec3::new(2.7, 0.6, 1.2), targets);
    let scene = &project.worlds[0].scene;
    agree("box", scene, &brighter(scene, 1.02), &demand);
}

#[test]
fn methods_agree_in_the_office() {
    let project = project("scenes/office");
    let scene = &project.worlds[0].scene;
    let mirror = (0..scene.mesh.triangles.len())
        .filter(|&index| scene.mesh.surfaces[scene.mesh.triangles[index].surface as usize].name == "Mirror")
        .map(|index| scene.mesh.corners(index).iter().sum::<DVec3>() / 3.0)
        .max_by(|a, b| b.y.total_cmp(&a.y))
        .expect("the office has a mirror");
    let targets = [
        mirror,
        DVec3::new(8.0, 3.4, 1.4),  // the glazed partition
        DVec3::new(4.0, 1.25, 2.8), // a panel
        DVec3::new(0.0, 2.5, 1.5),
    ];
    let demand = demand(DVec3::new(8.0, 5.0, 2.8), DVec3::new(3.2, 0.7, 1.3), targets);
    agree("office", scene, &brighter(scene, 1.02), &demand);
}

/// Zones about four tasks of an eye in the furnished room: the mirror, what lies behind the pane, a luminaire cut by
/// the edge of its cone, and a desk below, where the plane of the eye cuts the far field.
fn zones() -> Demand {
    let (eye, gaze) = (DVec3::new(3.2, 0.6, 1.2), DVec3::Y);
    let targets = [
        DVec3::new(0.01, 1.7, 1.2),
        DVec3::new(5.9, 1.0, 1.0),
        DVec3::new(4.3, 1.2, 2.8),
        DVec3::new(2.9, 1.2, 0.74),
    ];
    let mut receivers = Vec::new();
    for axis in targets.map(|target| (target - eye).normalize()) {
        for angles_deg in [[0.0, 10.0], [10.0, 30.0], [30.0, 60.0]] {
            let zone = Zone::new(axis, gaze, angles_deg).expect("it lies before the eye");
            receivers.push(Receiver { point: eye, lift: DVec3::ZERO, kernels: vec![Kernel::Zone(zone)] });
        }
    }
    Demand { receivers, rays: Vec::new(), flux: false }
}

/// Catches: zones that a method samples or weights with another size than they have, openings at their edges counted
/// in part, light by mirror or pane left out of them.
#[test]
fn methods_agree_on_zones_of_the_field_of_view() {
    let (scene, demand) = (furnished(), zones());
    let blocks = 256;
    let by = |scene: &Scene, method: Method| -> Vec<Estimate> {
        let effort = Effort { gather: 32, walks: 8, paths: 512, ..Effort::default() };
        let sheets = sheets(scene, &demand, method, effort, 7, blocks);
        (0..demand.rows())
            .map(|index| Estimate::from_blocks(&row(&sheets, index, scene.channels.len())))
            .collect()
    };
    let path = by(&scene, Method::Path);
    // Several rows are compared, so each resolves what it can; the twin is told apart by their sum of squares.
    let apart = |found: &[Estimate]| -> Vec<f64> {
        found.iter().zip(&path).map(|(a, b)| (a.value - b.value) / a.se.hypot(b.se)).collect()
    };
    let squares = |t: &[f64]| t.iter().map(|t| t * t).sum::<f64>();
    for method in [Method::Links, Method::Local, Method::Double] {
        let found = by(&scene, method);
        let t = apart(&found);
        println!("{method:?}: {t:.2?}, squares {:.1}", squares(&t));
        for (index, (a, b)) in found.iter().zip(&path).enumerate() {
            let resolved = 5.0 * a.se.hypot(b.se) / b.value;
            assert!(method != Method::Links || resolved < 0.1, "{method:?} {index}: resolves {resolved}");
            assert!(t[index].abs() < 5.0, "{method:?} {index}: {a:?} is not {b:?}");
        }
    }
    let twin = apart(&by(&brighter(&scene, 1.1), Method::Links));
    println!("twin: {twin:.2?}, squares {:.1}", squares(&twin));
    assert!(twin.iter().any(|t| t.abs() > 5.0), "reflectances off by 10 % pass: {twin:?}");
}

fn project(folder: &str) -> gershun::project::Project {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    gershun::project::load(&path, &gershun::project::LoadOptions::default()).expect("the example loads")
}
