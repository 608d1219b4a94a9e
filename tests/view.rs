//! Luminance pictures: against receivers, closed forms and the unbiased blocks.

mod common;

use std::path::Path;

use gershun::image::{LuminanceImage, Projection, View};
use gershun::material::{Bsdf, Material, Pane};
use gershun::measure::weights;
use gershun::project::{LoadOptions, load};
use gershun::query::{Demand, Kernel, Receiver};
use gershun::scene::Scene;
use gershun::solve::picture::{Detail, expose, render, replicate};
use gershun::solve::{Effort, Method, PARTS, answer, prepare};
use glam::DVec3;
use rayon::prelude::*;

fn fisheye(eye: DVec3, direction: DVec3) -> View {
    let projection = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    View::new(projection, eye, direction, DVec3::Z).expect("a view")
}

fn picture(scene: &Scene, weights: &[f64], view: &View, size: [usize; 2], detail: Detail) -> LuminanceImage {
    render(&expose(scene, 1).picture(weights, detail), view, size, &|_| {}).0
}

/// E_v at the eye by the solver: value and standard error.
fn receiver_lx(scene: &Scene, weights: &[f64], view: &View) -> (f64, f64) {
    let demand = Demand {
        receivers: vec![Receiver {
            point: view.eye,
            lift: DVec3::ZERO,
            kernels: vec![Kernel::Planar { normal: view.forward() }],
        }],
        rays: Vec::new(),
        flux: false,
    };
    let effort = Effort { gather: 128, walks: 128, opening_points: 16, ..Effort::default() };
    let prepared = prepare(scene, &demand, Method::Links, effort, 5);
    let blocks: Vec<f64> = (0..1024u64)
        .into_par_iter()
        .map(|block| {
            let sheet = answer(&prepared, block);
            sheet.values.chunks(PARTS).zip(weights).map(|(parts, w)| w * parts.iter().sum::<f64>()).sum()
        })
        .collect();
    mean_and_error(&blocks)
}

fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (square / n).sqrt())
}

/// Catches: a wrong Jacobian, openings seen with another luminance than they light with, indirect
/// light counted twice or not at all, weights of the light scene lost.
#[test]
fn a_fisheye_holds_the_illuminance_of_the_eye() {
    for (name, limits) in [("box", [0.005, 0.01]), ("office", [0.005, 0.01])] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
        let project = load(&folder, &LoadOptions::default()).expect("an example that runs");
        let world = &project.worlds[0];
        let weights = weights(world, &project.light_scenes[0], &world.rooms[0], false);
        let (eye, direction) = world
            .viewpoints
            .first()
            .map_or((DVec3::new(1.0, 1.2, 1.2), DVec3::new(0.8, 0.6, 0.0)), |viewpoint| {
                (viewpoint.eye, viewpoint.directions[0])
            });
        let view = fisheye(eye, direction);
        let (expected, error) = receiver_lx(&world.scene, &weights, &view);
        assert!(5.0 * error < 0.8 * limits[0] * expected, "{name}: {expected} ± {error} resolves nothing");
        for (detail, limit) in [Detail::Exact, Detail::Stored].into_iter().zip(limits) {
            let image = picture(&world.scene, &weights, &view, [320, 320], detail);
            let found = image.illuminance_lx().expect("a view");
            println!("{name} {detail:?}: {found:.2} lx, receiver {expected:.2} ± {error:.2} lx");
            assert!((found / expected - 1.0).abs() < limit, "{name} {detail:?}: {found} is not {expected}");
            // Broken twin: light twice the limit too weak is told apart.
            let weak = (1.0 - 2.0 * limit) * found / expected;
            assert!((weak - 1.0).abs() > limit, "{name}: {found} resolves nothing");
        }
    }
}

/// The hall's floor, polished or with a weaker lobe, seen from its entrance.
fn hall(lobe: f64) -> (gershun::project::Project, View) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hall");
    let mut project = load(&folder, &LoadOptions::default()).expect("an example that runs");
    let scene = &project.worlds[0].scene;
    let mut materials = scene.materials.clone();
    for material in &mut materials {
        if let Bsdf::Glossy { lobe: gershun::material::Lobe::Phong(phong), .. } = &mut material.bsdf {
            *phong = gershun::material::Phong::new(0.06 * lobe, 60.0);
        }
    }
    let changed = Scene::new(scene.mesh.clone(), materials, scene.luminaires.clone()).expect("a scene");
    project.worlds[0].scene = changed;
    let projection = Projection::Perspective { horizontal_deg: 70.0, vertical_deg: 50.0 };
    let view = View::new(projection, DVec3::new(1.0, 3.0, 1.6), DVec3::new(1.0, 0.0, -0.35), DVec3::Z);
    (project, view.expect("a view"))
}

/// Catches: highlights lost, doubled or in the wrong place; luminaires whose outlines are lost between
/// the centres of pixels; standard errors that are not those of the lobe rays.
#[test]
fn a_glossy_floor_is_seen_as_path_tracing_shows_it() {
    let (size, fine) = ([14, 10], [140, 100]);
    let (project, view) = hall(1.0);
    let weights = vec![1.0; project.worlds[0].scene.channels.len()];
    let (demand, effort) = (Demand::default(), Effort { gather: 1, ..Effort::default() });
    let prepared = prepare(&project.worlds[0].scene, &demand, Method::Links, effort, 3);
    let blocks: Vec<Vec<f64>> =
        (0..2048).map(|block| replicate(&prepared, &view, size, &weights, block)).collect();
    let expected: Vec<(f64, f64)> = (0..size[0] * size[1])
        .map(|pixel| mean_and_error(&blocks.iter().map(|block| block[pixel]).collect::<Vec<_>>()))
        .collect();
    // Errors of blocks of 10 × 10 pixels in order, and their mean with its sign.
    let compared = |image: &LuminanceImage| {
        let mut off = Vec::new();
        for (block, (expected, _)) in expected.iter().enumerate() {
            let (row, column) = (block / size[0], block % size[0]);
            let pixel = |k: usize| (10 * row + k / 10) * fine[0] + 10 * column + k % 10;
            let found = (0..100).map(|k| image.luminance_cd_m2[pixel(k)]).sum::<f64>() / 100.0;
            off.push(found / expected - 1.0);
        }
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        off.sort_unstable_by(|a, b| a.abs().total_cmp(&b.abs()));
        (mean, off[off.len() * 95 / 100].abs())
    };
    let mut noise: Vec<f64> = expected.iter().map(|(value, error)| error / value).collect();
    noise.sort_unstable_by(f64::total_cmp);
    let noise = noise[noise.len() * 95 / 100];
    let image = picture(&project.worlds[0].scene, &weights, &view, fine, Detail::Exact);
    let (mean, off) = compared(&image);
    println!(
        "hall: mean {:.2} %, 95 of 100 blocks within {:.2} %, reference within {:.2} %",
        100.0 * mean,
        100.0 * off,
        200.0 * noise
    );
    assert!(2.0 * noise < 0.03, "{noise}: the reference resolves nothing");
    assert!(mean.abs() < 0.01 && off < 0.03, "{mean} {off}");
    // The noise that is told is there, and small.
    let errors = image.standard_error_cd_m2.as_ref().expect("noise of the lobe rays");
    let told =
        errors.iter().zip(&image.luminance_cd_m2).map(|(e, l)| e / l).sum::<f64>() / errors.len() as f64;
    assert!((1e-4..0.1).contains(&told), "{told}");
    // Broken twin: a lobe that reflects a tenth less.
    let (dull, view) = hall(0.9);
    let (mean, off) = compared(&picture(&dull.worlds[0].scene, &weights, &view, fine, Detail::Exact));
    assert!(mean.abs() > 0.01 || off > 0.03, "a weaker lobe passes: {mean} {off}");
}

fn materials(ceiling: f64, extra: Bsdf) -> Vec<Material> {
    vec![
        common::lambert("floor", 0.3),
        common::lambert("walls", 0.5),
        common::lambert("ceiling", ceiling),
        Material { name: "extra".into(), bsdf: extra },
    ]
}

/// A 4 × 4 × 3 m room with a panel and an upright sheet of `extra` at x = 3. Its ceiling is black: an
/// opening is no geometry, so the ceiling would be seen behind the panel.
fn room_with(extra: Bsdf) -> Scene {
    let mut mesh = common::room(DVec3::new(4.0, 4.0, 3.0));
    let sheet = mesh.add_surface("sheet", 3, false);
    let p = |y: f64, z: f64| DVec3::new(3.0, y, z);
    mesh.add_quad([p(0.5, 0.2), p(0.5, 2.8), p(3.5, 2.8), p(3.5, 0.2)], sheet);
    let panel = common::panel(3000.0, 0.6, DVec3::new(1.5, 2.0, 2.9));
    Scene::new(mesh, materials(0.0, extra), vec![panel]).expect("a scene")
}

fn seen(scene: &Scene, direction: DVec3) -> f64 {
    let view = View::new(
        Projection::Perspective { horizontal_deg: 1.0, vertical_deg: 1.0 },
        DVec3::new(1.0, 2.0, 1.5),
        direction,
        DVec3::Z,
    )
    .expect("a view");
    picture(scene, &[1.0], &view, [1, 1], Detail::Exact).luminance_cd_m2[0]
}

/// Catches: a branch at glass lost or doubled, an opening seen twice, a reflectance left out.
/// L of the uniform panel is Φ/(πA); its image stands at x = 4.5.
#[test]
fn a_panel_is_seen_straight_in_a_mirror_and_through_a_pane() {
    let panel = 3000.0 / (std::f64::consts::PI * 0.36);
    let mirror = room_with(Bsdf::Mirror { reflectance: 0.9 });
    let straight = seen(&mirror, DVec3::new(0.5, 0.0, 1.4));
    assert!((straight / panel - 1.0).abs() < 1e-9, "{straight} is not {panel}");
    let reflected = seen(&mirror, DVec3::new(3.5, 0.0, 1.4));
    assert!((reflected / (0.9 * panel) - 1.0).abs() < 1e-9, "{reflected} is not {}", 0.9 * panel);
    let pane = Pane::new(0.88);
    let glazed = room_with(Bsdf::Glass(pane));
    let towards = DVec3::new(3.5, 0.0, 1.4).normalize();
    let both = seen(&glazed, towards);
    // Behind the pane there is the wall, which an image of the panel outshines by far.
    let image = pane.reflectance(towards.x) * panel;
    assert!(both > image && both < image + 300.0, "{both} is not {image} and a wall");
    let through = seen(&glazed, DVec3::X);
    let wall = seen(&room_with(Bsdf::Glass(Pane::new(0.44))), DVec3::X);
    assert!(through > 1.5 * wall, "{through} and {wall}: the pane's transmittance does not count");
}

/// Catches: shadows in the wrong place, direct light of images left out, indirect light blurred over
/// edges – whatever makes the quick picture another one than the unbiased one.
#[test]
fn the_quick_picture_is_the_unbiased_one() {
    let mut mesh = common::room(DVec3::new(4.0, 4.0, 3.0));
    let table = mesh.add_surface("table", 1, true);
    let p = |x: f64, y: f64| DVec3::new(x, y, 0.8);
    mesh.add_quad([p(1.0, 1.0), p(2.6, 1.0), p(2.6, 2.2), p(1.0, 2.2)], table);
    let mirror = mesh.add_surface("mirror", 3, false);
    let q = |x: f64, z: f64| DVec3::new(x, 3.999, z);
    mesh.add_quad([q(1.0, 0.5), q(3.0, 0.5), q(3.0, 2.0), q(1.0, 2.0)], mirror);
    let panels = vec![
        common::panel(3000.0, 0.6, DVec3::new(1.5, 1.5, 2.9)),
        common::panel(2000.0, 0.3, DVec3::new(3.0, 3.0, 2.9)),
    ];
    let scene = Scene::new(mesh, materials(0.7, Bsdf::Mirror { reflectance: 0.8 }), panels).expect("a scene");
    let weights = vec![1.0; scene.channels.len()];
    let view = View::new(
        Projection::Perspective { horizontal_deg: 90.0, vertical_deg: 90.0 },
        DVec3::new(3.7, 0.3, 1.6),
        DVec3::new(-1.0, 1.0, -0.3),
        DVec3::Z,
    )
    .expect("a view");
    // A block looks at a random place of each pixel; means over 8 × 8 quick pixels are the same.
    let (size, fine) = ([12, 12], [96, 96]);
    let quick = picture(&scene, &weights, &view, fine, Detail::Exact);
    let demand = Demand::default();
    let effort = Effort { gather: 1, ..Effort::default() };
    let prepared = prepare(&scene, &demand, Method::Links, effort, 3);
    let blocks: Vec<Vec<f64>> =
        (0..400).map(|block| replicate(&prepared, &view, size, &weights, block)).collect();
    let (mut squares, mut brighter, mut noise, mut count) = (0.0f64, 0.0, 0.0f64, 0.0);
    for row in 0..12 {
        for column in 0..12 {
            let values: Vec<f64> = blocks.iter().map(|block| block[row * 12 + column]).collect();
            let (expected, error) = mean_and_error(&values);
            let mut found = 0.0;
            for k in 0..64 {
                found += quick.luminance_cd_m2[(8 * row + k / 8) * 96 + 8 * column + k % 8] / 64.0;
            }
            // Where the mirror shows a panel blocks are noisy, and their mean is no yardstick.
            if error < 0.04 * expected {
                squares += (found / expected - 1.0).powi(2);
                brighter += (1.05 * found / expected - 1.0).powi(2);
                noise += (error / expected).powi(2);
                count += 1.0;
            }
            assert!(
                (found - expected).abs() < 5.0 * error + 0.08 * expected,
                "{column}, {row}: {found} is not {expected} ± {error}"
            );
        }
    }
    let excess = |squares: f64| (squares - noise) / count;
    println!(
        "RMS difference {:.4}, noise {:.4}, {count} pixels",
        (squares / count).sqrt(),
        (noise / count).sqrt()
    );
    assert!(count > 100.0, "{count}");
    assert!(excess(squares) < 0.02f64.powi(2), "{}", excess(squares));
    // Broken twin: a picture a twentieth too bright.
    assert!(excess(brighter) > 0.02f64.powi(2), "{}", excess(brighter));
}

/// Catches: results that depend on the number of threads.
#[test]
fn a_picture_is_the_same_for_any_number_of_threads() {
    let scene = room_with(Bsdf::Glass(Pane::new(0.88)));
    let view = fisheye(DVec3::new(1.0, 2.0, 1.5), DVec3::X);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let prepared = Demand::default();
            let prepared = prepare(&scene, &prepared, Method::Links, Effort::default(), 1);
            (
                picture(&scene, &[1.0], &view, [50, 50], Detail::Exact),
                replicate(&prepared, &view, [20, 20], &[1.0], 0),
            )
        })
    };
    assert!(on(1) == on(3));
}
