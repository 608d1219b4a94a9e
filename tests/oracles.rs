//! Answers against exact or converged references. Every check can fail: it demands a resolution
//! first, and a broken twin (an input off by twice that) must be rejected by the same check.

mod common;

use common::{lambert, planar, point_lamp, room, row, sheets};
use gershun::estimate::Estimate;
use gershun::query::Demand;
use gershun::scene::Scene;
use gershun::solve::{Effort, Method};
use glam::DVec3;

/// Largest |error| in combined standard errors, RMS and largest relative error, largest relative se.
fn compare(
    scene: &Scene,
    demand: &Demand,
    truth: &[(f64, f64)],
    method: Method,
    effort: Effort,
    blocks: u64,
) -> [f64; 4] {
    let sheets = sheets(scene, demand, method, effort, 1, blocks);
    let (mut z, mut square, mut worst, mut se) = (0f64, 0.0, 0f64, 0f64);
    for (index, &(expected, error)) in truth.iter().enumerate() {
        let estimate = Estimate::from_blocks(&row(&sheets, index, scene.channels.len()));
        z = z.max((estimate.value - expected).abs() / estimate.se.hypot(error));
        let relative = estimate.value / expected - 1.0;
        square += relative * relative;
        worst = worst.max(relative.abs());
        se = se.max(estimate.se / expected);
    }
    [z, (square / truth.len() as f64).sqrt(), worst, se]
}

fn box_room(size: DVec3, rho: [f64; 3], lamp: DVec3, flux: f64) -> Scene {
    let materials = vec![lambert("floor", rho[0]), lambert("walls", rho[1]), lambert("ceiling", rho[2])];
    Scene::new(room(size), materials, vec![point_lamp(flux, lamp)]).expect("the scene is valid")
}

#[test]
fn box_rooms_match_the_radiosity_reference() {
    // rooms.txt: totals to 1e-6 … 4e-5.
    let a = DVec3::new(4.0, 3.0, 2.8);
    let points = |s: DVec3| {
        vec![
            planar(DVec3::new(s.x / 2.0, s.y / 2.0, 0.0), DVec3::Z),
            planar(DVec3::new(0.5, 0.5, 0.0), DVec3::Z),
            planar(DVec3::new(s.x - 0.5, s.y / 2.0, 0.0), DVec3::Z),
            planar(DVec3::new(0.05, 0.05, 0.0), DVec3::Z),
            planar(DVec3::new(0.5, 0.5, s.z), DVec3::NEG_Z),
            planar(DVec3::new(s.x, s.y / 2.0, 1.2), DVec3::NEG_X),
            planar(DVec3::new(s.x / 2.0, s.y, 1.2), DVec3::NEG_Y),
            planar(DVec3::new(1.0, 1.0, 0.75), DVec3::Z),
            planar(DVec3::new(1.0, 1.0, 1.2), DVec3::X),
            planar(DVec3::new(1.0, 1.0, 1.2), DVec3::NEG_X),
        ]
    };
    let rooms = [
        (
            box_room(a, [0.2, 0.5, 0.7], DVec3::new(2.0, 1.5, 2.0), 1000.0),
            a,
            [
                40.85550169,
                24.18436702,
                27.95514660,
                16.53286018,
                21.27121716,
                32.35348398,
                41.25895606,
                43.55374461,
                48.42505842,
                13.18044996,
            ],
        ),
        (
            box_room(DVec3::splat(4.0), [0.5; 3], DVec3::splat(2.0), 10_000.0),
            DVec3::splat(4.0),
            [
                310.98241485,
                161.07376390,
                210.23436054,
                112.94994723,
                161.07376390,
                270.57459065,
                270.57459065,
                261.26235010,
                299.59517076,
                105.31801484,
            ],
        ),
    ];
    for (scene, size, totals) in rooms {
        let demand = Demand { receivers: points(size), rays: vec![], flux: false };
        let truth: Vec<(f64, f64)> = totals.iter().map(|&e| (e, 5e-5 * e)).collect();
        let effort = Effort { gather: 64, walks: 32, ..Effort::default() };
        let before = common::cpu_seconds();
        let [z, rms, worst, se] = compare(&scene, &demand, &truth, Method::Links, effort, 1024);
        println!(
            "links: z {z:.2}, rms {:.3} %, worst {:.3} %, se {:.3} %, {:.2} CPU-s",
            100.0 * rms,
            100.0 * worst,
            100.0 * se,
            common::cpu_seconds() - before
        );
        assert!(5.0 * se <= 0.015, "cannot resolve 1.5 %: se {se}");
        assert!(z <= 5.0, "{z} standard errors");
        // The broken twin: walls that reflect 0.04 more change every value by some 3 %.
        let mut materials = scene.materials.clone();
        materials[1] = lambert("walls", scene.materials[1].bsdf.albedo(1.0) + 0.04);
        let twin = Scene::new(scene.mesh.clone(), materials, scene.luminaires.clone()).expect("a valid twin");
        let [twin_z, ..] = compare(&twin, &demand, &truth, Method::Links, effort, 1024);
        println!("twin: z {twin_z:.1}");
        assert!(twin_z > 5.0, "the twin passes: {twin_z} standard errors");
    }
}
