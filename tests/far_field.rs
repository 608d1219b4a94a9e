//! Luminous intensity of luminaires as installed, against closed forms, conservation and a count of
//! particles; each with a broken twin.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;

use std::f64::consts::PI;

use common::{lambert, lamp, panel, point_lamp};
use gershun::estimate::Estimate;
use gershun::geometry::mesh::Mesh;
use gershun::luminaire::Luminaire;
use gershun::material::{Bsdf, Material};
use gershun::photometry::{IntensityDistribution, Opening};
use gershun::scene::Scene;
use gershun::solve::far_field::{FarDemand, FarField, axes, far_field};
use glam::DVec3;

fn demand(luminaires: usize, blocks: u64) -> FarDemand {
    let (azimuths_deg, gammas_deg) = axes(30.0, 10.0);
    FarDemand {
        luminaires: (0..luminaires).map(|index| (index, 1.0)).collect(),
        azimuths_deg,
        gammas_deg,
        particles: 2000,
        directions: 32,
        opening_points: 4,
        blocks,
        seed: 5,
    }
}

fn quad(mesh: &mut Mesh, name: &str, material: usize, corners: [DVec3; 4]) {
    let surface = mesh.add_surface(name, material, false);
    mesh.add_quad(corners, surface);
}

/// A level plate of edge 2 a at a height.
fn plate(a: f64, z: f64) -> [DVec3; 4] {
    [(-a, -a), (a, -a), (a, a), (-a, a)].map(|(x, y)| DVec3::new(x, y, z))
}

fn scene(build: impl FnOnce(&mut Mesh), materials: Vec<Material>, luminaires: Vec<Luminaire>) -> Scene {
    let mut mesh = Mesh::default();
    build(&mut mesh);
    Scene::new(mesh, materials, luminaires).expect("a sound scene")
}

fn far_plate(mesh: &mut Mesh) {
    quad(mesh, "Speck", 0, plate(1e-3, -500.0));
}

fn node(field: &FarField, azimuth: f64, gamma: f64) -> Estimate {
    let at = |axis: &[f64], angle: f64| {
        axis.iter().position(|known| (known - angle).abs() < 1e-9).expect("a node of the table")
    };
    field.cd[at(&field.azimuths_deg, azimuth)][at(&field.gammas_deg, gamma)]
}

/// Catches: another frame than the file's, a factor lost, light of a lone luminaire made noisy.
#[test]
fn a_lone_luminaire_gives_its_own_intensities_back() {
    let azimuths = (0..=12).map(|k| 30.0 * f64::from(k)).collect();
    let gammas: Vec<f64> = (0..=18).map(|k| 10.0 * f64::from(k)).collect();
    let cd = |plane: u32, gamma: f64| 50.0 + f64::from(plane % 12) * 5.0 * gamma.to_radians().sin();
    let planes = (0..=12).map(|plane| gammas.iter().map(|gamma| cd(plane, *gamma)).collect()).collect();
    let table = IntensityDistribution::from_grid(azimuths, gammas, planes).expect("sound");
    let opening = Opening::Disc { diameter_m: 0.3, height_m: 0.1 };
    let scene =
        scene(far_plate, vec![lambert("speck", 0.0)], vec![lamp(table.clone(), opening, DVec3::ZERO)]);
    let field = far_field(&scene, &demand(1, 4));
    let found = field.distribution().expect("a table");
    for azimuth in [0.0, 30.0, 45.0, 210.0, 330.0] {
        for gamma in [10.0, 60.0, 95.0, 170.0] {
            let (a, b) = (found.intensity_at(azimuth, gamma), table.intensity_at(azimuth, gamma));
            assert!((a - b).abs() < 1e-9 * b, "{azimuth} {gamma}: {a} {b}");
        }
    }
    assert!((field.escaped_lm.value / field.emitted_lm - 1.0).abs() < 1e-4 && field.error() < 1e-12);
}

/// Closed form: an isotropic point of I0 at height h under the middle of a Lambertian square plate of
/// edge 2a. The plate receives Φ = I0 Ω, Ω = 4 asin(a²/(a² + h²)), and sends ρΦ/π cosγ down; upwards the
/// point is hidden where the plate covers it.
#[test]
fn a_reflector_above_a_point() {
    let (a, h, rho, i0) = (0.5, 0.3, 0.8, 100.0);
    let make = |rho: f64| {
        scene(
            |mesh| quad(mesh, "Plate", 0, plate(a, h)),
            vec![lambert("white", rho)],
            vec![point_lamp(4.0 * PI * i0, DVec3::ZERO)],
        )
    };
    let omega = 4.0 * (a * a / (a * a + h * h)).asin();
    let all = FarDemand { directions: 1000, particles: 4000, ..demand(1, 64) };
    let field = far_field(&make(rho), &all);
    let reflected = |gamma: f64| rho * i0 * omega / PI * gamma.to_radians().cos();
    for gamma in [0.0, 30.0, 60.0, 80.0] {
        let found = node(&field, 60.0, gamma);
        let truth = i0 + reflected(gamma);
        println!("γ {gamma}°: {:.2} ± {:.2} cd, {truth:.2}", found.value, found.se);
        assert!(5.0 * found.se < 0.03 * truth, "the test could not fail");
        assert!((found.value - truth).abs() < 5.0 * found.se, "γ {gamma}°: {} is not {truth}", found.value);
    }
    assert!(node(&field, 60.0, 170.0).value.abs() < 1e-9, "light goes through the plate");
    assert!((node(&field, 60.0, 100.0).value - i0).abs() < 1e-9, "the point is hidden where it is not");
    let lor = 1.0 - (1.0 - rho) * omega / (4.0 * PI);
    let escaped = field.escaped_lm.value / field.emitted_lm;
    assert!((escaped - lor).abs() < 5.0 * field.escaped_lm.se / field.emitted_lm, "LOR {escaped}, not {lor}");
    let twin = node(&far_field(&make(rho * 1.06), &all), 60.0, 30.0);
    let truth = i0 + reflected(30.0);
    assert!(
        (twin.value - truth).abs() > 5.0 * twin.se,
        "6 % more reflectance passes: {} {truth}",
        twin.value
    );
}

/// Conservation: a panel deep in a white and in a black box that is open below. The table's flux is what
/// escapes, counted apart; a black box lets only the form factor through.
#[test]
fn housings_keep_the_balance() {
    let (a, depth) = (0.3, 0.3);
    let housing = |mesh: &mut Mesh| {
        let [p, q, r, s] = plate(a, 0.0);
        let up = DVec3::Z * depth;
        quad(mesh, "Top", 0, [p + up, q + up, r + up, s + up]);
        for (name, from, to) in [("S", p, q), ("E", q, r), ("N", r, s), ("W", s, p)] {
            quad(mesh, name, 0, [from, to, to + up, from + up]);
        }
    };
    let make = |bsdf: Bsdf| {
        let material = Material { name: "housing".into(), bsdf };
        scene(housing, vec![material], vec![panel(1000.0, 2.0 * a, DVec3::new(0.0, 0.0, depth - 1e-3))])
    };
    let fine = FarDemand { particles: 4000, ..demand(1, 64) };
    let (azimuths_deg, gammas_deg) = axes(10.0, 5.0);
    let fine = FarDemand { azimuths_deg, gammas_deg, directions: 64, ..fine };
    let mut shares = Vec::new();
    for (name, bsdf) in [
        ("black", Bsdf::Lambert { reflectance: 0.0 }),
        ("white", Bsdf::Lambert { reflectance: 0.9 }),
        ("mirror", Bsdf::Mirror { reflectance: 0.9 }),
    ] {
        let field = far_field(&make(bsdf), &fine);
        let (table, escaped) = (field.table_lm, field.escaped_lm);
        println!(
            "{name}: table {:.2} ± {:.2} lm, escaped {:.2} ± {:.2} lm, blurred {:.1} lm",
            table.value, table.se, escaped.value, escaped.se, field.mirrored_lm.value
        );
        // Linear interpolation of a smooth table at 5° × 10° errs by less than half a percent.
        let noise = 5.0 * table.se.hypot(escaped.se);
        assert!(noise < 20.0, "{name}: the test could not fail");
        assert!((table.value - escaped.value).abs() < noise + 0.005 * escaped.value, "{name}");
        assert!(
            (table.value - 1.05 * escaped.value).abs() > noise + 0.005 * escaped.value,
            "{name}: 5 % off passes"
        );
        shares.push(escaped.value / field.emitted_lm);
    }
    // Two parallel unit squares at a distance of half an edge: F = 0.415 253 (closed form).
    assert!((shares[0] - 0.415_253).abs() < 0.006, "{shares:?}");
    assert!(shares[1] > shares[0] + 0.2 && shares[2] > 0.8, "{shares:?}");
}

/// Catches: results that depend on the number of threads or on anything but the seed.
#[test]
fn the_same_seed_gives_the_same_table() {
    let make = || {
        scene(
            |mesh| quad(mesh, "P", 0, plate(0.4, 0.2)),
            vec![lambert("w", 0.5)],
            vec![point_lamp(100.0, DVec3::ZERO)],
        )
    };
    let run = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            format!("{:?}", far_field(&make(), &FarDemand { seed, particles: 200, ..demand(1, 8) }))
        })
    };
    assert_eq!(run(1, 1), run(3, 1));
    assert_ne!(run(1, 1), run(1, 2));
}
