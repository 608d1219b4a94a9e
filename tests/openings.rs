//! Every shape of luminous opening: what lights a desk (points of the opening), what an eye sees (rays)
//! and where particles start must be the same light, near and far. Each check rejects a broken twin.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;

use std::f64::consts::{PI, TAU};

use common::{lambert, lamp, room};
use gershun::emitters::{Emitters, unshadowed};
use gershun::estimate::Estimate;
use gershun::luminaire::Luminaire;
use gershun::photometry::{IntensityDistribution, Opening};
use gershun::query::Kernel;
use gershun::rng::Rng;
use gershun::scene::Scene;
use gershun::sphere;
use gershun::units::Lumens;
use glam::{DMat3, DVec3};

const SHAPES: [(&str, Opening); 13] = [
    ("panel", Opening::Rect { length_m: 0.6, width_m: 0.3, side_x_m: 0.0, side_y_m: 0.0 }),
    ("disc", Opening::Disc { diameter_m: 0.5, height_m: 0.0 }),
    ("ellipse", Opening::Ellipse { length_m: 0.6, width_m: 0.2, height_m: 0.0 }),
    ("sign", Opening::Upright { width_m: 0.6, height_m: 0.3, across: true, round: false }),
    ("box", Opening::Rect { length_m: 0.6, width_m: 0.3, side_x_m: 0.1, side_y_m: 0.1 }),
    ("two heights", Opening::Rect { length_m: 0.6, width_m: 0.3, side_x_m: 0.05, side_y_m: 0.12 }),
    ("four heights", Opening::Sided { length_m: 0.6, width_m: 0.3, sides_m: [0.05, 0.12, 0.0, 0.08] }),
    ("upright cylinder", Opening::Disc { diameter_m: 0.3, height_m: 0.4 }),
    ("elliptic cylinder", Opening::Ellipse { length_m: 0.5, width_m: 0.2, height_m: 0.3 }),
    ("sphere", Opening::Ellipsoid { length_m: 0.4, width_m: 0.4, height_m: 0.4 }),
    ("ellipsoid", Opening::Ellipsoid { length_m: 0.6, width_m: 0.3, height_m: 0.2 }),
    ("tube", Opening::Tube { length_m: 1.2, width_m: 0.1, height_m: 0.06, across: false }),
    ("tube across", Opening::Tube { length_m: 1.2, width_m: 0.1, height_m: 0.06, across: true }),
];

/// Smooth, no symmetry, light in every direction.
fn uneven() -> IntensityDistribution {
    let azimuths: Vec<f64> = (0..=36).map(|k| 10.0 * f64::from(k)).collect();
    let gammas: Vec<f64> = (0..=36).map(|k| 5.0 * f64::from(k)).collect();
    let cd = |azimuth: f64, gamma: f64| {
        let (a, g) = (azimuth.to_radians(), gamma.to_radians());
        300.0 + 150.0 * g.cos() + 60.0 * g.sin() * (a - 0.7).cos() + 30.0 * (2.0 * a).sin() * g.sin().powi(2)
    };
    let plane = |azimuth: &f64| gammas.iter().map(|gamma| cd(azimuth % 360.0, *gamma)).collect();
    let planes = azimuths.iter().map(plane).collect();
    IntensityDistribution::from_grid(azimuths, gammas, planes).expect("a sound grid")
}

fn hall(luminaire: Luminaire) -> Scene {
    let materials = vec![lambert("floor", 0.2), lambert("walls", 0.5), lambert("ceiling", 0.7)];
    Scene::new(room(DVec3::splat(40.0)), materials, vec![luminaire]).expect("a sound scene")
}

/// One luminaire of a shape, turned, far above a floor that plays no part.
fn scene(opening: Opening) -> Scene {
    let turned = DMat3::from_rotation_z(0.4) * DMat3::from_rotation_x(0.3);
    let mut luminaire = lamp(uneven(), opening, DVec3::new(0.2, -0.1, 3.0));
    luminaire.world_from_luminaire = turned;
    hall(luminaire)
}

/// ∫ L R dω over a cone around the luminaire, by rays on an even grid, clear of the grid's own order.
fn by_rays(emitters: &Emitters, point: DVec3, kernel: &Kernel) -> f64 {
    let source = &emitters.sources[0];
    let towards = source.position - point;
    let distance = towards.length();
    let n = 480;
    let along = towards / distance;
    let frame = sphere::frame(along);
    // Gnomonic coordinates: dω = dA/(1 + x² + y²)^{3/2}; wide enough for the whole ball that holds it.
    let sine = (source.radius_m / distance).min(0.999);
    let reach = sine / (1.0 - sine * sine).sqrt();
    let step = 2.0 * reach / f64::from(n);
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let (x, y) = (-reach + step * (f64::from(i) + 0.5), -reach + step * (f64::from(j) + 0.5));
            let direction = frame * DVec3::new(x, y, 1.0).normalize();
            if let Some((luminance, _)) = emitters.opening_along(0, point, direction) {
                let element_sr = step * step / (1.0 + x * x + y * y).powf(1.5);
                sum += luminance * kernel.response(direction) * element_sr;
            }
        }
    }
    sum
}

/// Catches: a point met by a ray that is weighted other than when it is drawn, so that light found in
/// both ways does not add up to itself.
#[test]
fn a_ray_gives_a_point_the_weight_with_which_it_is_drawn() {
    for (name, opening) in SHAPES.into_iter().filter(|(_, opening)| !opening.is_point()) {
        let place = DVec3::new(0.9, -1.3, -1.7);
        for k in 0..64 {
            let u = [(f64::from(k % 8) + 0.5) / 8.0, (f64::from(k / 8) + 0.5) / 8.0];
            let Some(shine) = opening.shine(place, u) else { continue };
            let met = opening.along(place, (shine.at - place).normalize());
            // A ray aimed at the very limb of a body may pass beside it.
            let Some(met) = met.filter(|met| (met.distance_m - shine.at.distance(place)).abs() < 1e-9) else {
                continue;
            };
            assert!((met.weight / shine.weight - 1.0).abs() < 1e-6, "{name}: {met:?} is not {shine:?}");
        }
    }
}

/// Catches: another weight for desks than for eyes, a limb counted twice, a hidden face that shines, a
/// mantle turned by 90°, an ellipsoid sampled by its surface instead of what it shows.
#[test]
fn a_desk_gets_the_light_that_an_eye_sees() {
    for (name, opening) in SHAPES {
        let worst = worst_difference(opening, opening);
        println!("{name}: points against rays, worst {worst:.1e}");
        // The rays' own grid errs by its steps along the outline.
        assert!(worst < 4e-3, "{name}: {worst:e}");
    }
    let ball = |diameter: f64| Opening::Ellipsoid { length_m: diameter, width_m: 0.4, height_m: 0.4 };
    let twin = worst_difference(ball(0.4), ball(0.44));
    assert!(twin > 8e-3, "a ball that the eye sees 10 % longer passes: {twin:e}");
}

fn worst_difference(of_desk: Opening, of_eye: Opening) -> f64 {
    let scenes = [of_desk, of_eye].map(scene);
    let emitters = scenes.each_ref().map(Emitters::new);
    let source = &emitters[0].sources[0];
    let mut worst = 0f64;
    let mut rng = Rng::new(7, 1, 1);
    for k in 0..12 {
        let distance = source.radius_m * [1.15, 1.6, 3.0, 12.0][k % 4];
        // Flat openings shine down only: what they emit edge-on and upwards has no ray.
        let mut down = sphere::cosine_hemisphere([0.9 * rng.uniform(), rng.uniform()]);
        if of_desk.is_flat() || k % 2 == 0 {
            down.z = -down.z.abs();
        }
        let point = source.position + scenes[0].luminaires[0].world_from_luminaire * down * distance;
        let kernel =
            [Kernel::Spherical, Kernel::Planar { normal: (source.position - point).normalize() }][k / 4 % 2];
        let desk = unshadowed(&emitters[0], source, point, &kernel);
        let eye = by_rays(&emitters[1], point, &kernel);
        worst = worst.max((desk / eye - 1.0).abs());
    }
    worst
}

/// Flux through a closed sphere near a luminaire, as a share of its own: light that leaves twice or
/// never would show. `twin` changes the weights as a wrong implementation would.
fn flux_through(radius: f64, opening: Opening, twin: impl Fn(DVec3) -> f64) -> Estimate {
    let distribution = uneven();
    let share = |block: u64| {
        let mut rng = Rng::new(11, block, 1);
        let (samples, mut sum) = (8_000, 0.0);
        for _ in 0..samples {
            let (z, azimuth) = (2.0 * rng.uniform() - 1.0, TAU * rng.uniform());
            let sine = (1.0 - z * z).sqrt();
            let outward = DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), z);
            let Some(shine) = opening.shine(outward * radius, rng.uniforms()) else { continue };
            let away = outward * radius - shine.at;
            let leaving = away.normalize();
            let normal_lx = shine.weight * distribution.intensity_along(leaving) / away.length_squared();
            sum += normal_lx * leaving.dot(outward) * twin(shine.at);
        }
        4.0 * PI * radius * radius * sum / f64::from(samples) / distribution.flux().0
    };
    Estimate::from_blocks(&(0..64).map(share).collect::<Vec<_>>())
}

/// Catches: light made or lost in the near field, which no far-field comparison shows.
#[test]
fn a_body_sends_out_its_flux_however_near() {
    for (name, opening) in SHAPES.into_iter().filter(|(_, opening)| !opening.is_flat()) {
        for factor in [1.2, 2.0] {
            let share = flux_through(factor * opening.radius_m(), opening, |_| 1.0);
            println!("{name} at {factor} radii: flux {:.5} ± {:.5}", share.value, share.se);
            assert!(5.0 * share.se < 0.02, "{name}: the test could not fail");
            assert!((share.value - 1.0).abs() < 5.0 * share.se, "{name} at {factor} radii: {}", share.value);
        }
        let twin = |at: DVec3| 1.0 + 0.04 * at.length() / opening.radius_m();
        let share = flux_through(2.0 * opening.radius_m(), opening, twin);
        assert!((share.value - 1.0).abs() > 5.0 * share.se, "{name}: a twin brighter at its ends passes");
    }
}

/// Catches: particles that start elsewhere than desks and eyes see the light: flux through a plane patch
/// near the body by counting and by integration.
#[test]
fn particles_leave_from_where_the_light_is_seen() {
    let distribution = uneven();
    for (name, opening) in SHAPES {
        // A patch at one side below: |x − 0.4| < 0.5, |y| < 0.4, z = −0.7.
        let inside = |p: DVec3| (p.x - 0.4).abs() < 0.5 && p.y.abs() < 0.4;
        let (blocks, per_block) = (64, 4_000);
        let mut shares = Vec::new();
        for block in 0..blocks {
            let mut rng = Rng::new(3, block, 5);
            let mut hits = 0.0;
            for _ in 0..per_block {
                let (direction, _) = distribution.sample_direction(rng.uniforms());
                let start = opening.leaving(direction, rng.uniforms());
                let t = (-0.7 - start.z) / direction.z;
                hits += f64::from(u8::from(t > 0.0 && inside(start + direction * t)));
            }
            shares.push(hits / f64::from(per_block));
        }
        let counted = Estimate::from_blocks(&shares);
        let n = 40;
        let mut lm = 0.0;
        for i in 0..n {
            for j in 0..n {
                let at = |k: i32, half: f64| half * ((2.0 * f64::from(k) + 1.0) / f64::from(n) - 1.0);
                let place = DVec3::new(0.4 + at(i, 0.5), at(j, 0.4), -0.7);
                let element = 1.0 * 0.8 / f64::from(n * n);
                let mut rng = Rng::new(1, 1, (i * n + j) as u64);
                let samples = 32;
                for _ in 0..samples {
                    let Some(shine) = opening.shine(place, rng.uniforms()) else { continue };
                    let away = place - shine.at;
                    let leaving = away.normalize();
                    let normal_lx =
                        shine.weight * distribution.intensity_along(leaving) / away.length_squared();
                    lm += normal_lx * -leaving.z * element / f64::from(samples);
                }
            }
        }
        let truth = lm / distribution.flux().0;
        println!("{name}: counted {:.5} ± {:.5}, integrated {truth:.5}", counted.value, counted.se);
        assert!(5.0 * counted.se < 0.04 * truth, "{name}: the test could not fail");
        assert!((counted.value - truth).abs() < 5.0 * counted.se + 2e-3 * truth, "{name}");
        assert!((counted.value - 1.08 * truth).abs() > 5.0 * counted.se, "{name}: 8 % off passes");
    }
}

/// Closed form: a sphere whose every point has the luminance L lights like a point of I = L π r² at any
/// distance, on a surface that faces it (the solid-angle projection of a ball: E = π L (r/d)²).
#[test]
fn a_sphere_lights_like_a_point_at_its_centre() {
    let r = 0.2;
    let ball = Opening::Ellipsoid { length_m: 2.0 * r, width_m: 2.0 * r, height_m: 2.0 * r };
    let luminaire =
        lamp(IntensityDistribution::isotropic(Lumens(4.0 * PI * 100.0)), ball, DVec3::new(20.0, 20.0, 3.0));
    let scene = hall(luminaire);
    let emitters = Emitters::new(&scene);
    for distance in [0.21, 0.3, 1.0, 10.0] {
        let point = DVec3::new(20.0, 20.0, 3.0 - distance);
        let found = unshadowed(&emitters, &emitters.sources[0], point, &Kernel::Planar { normal: DVec3::Z });
        let truth = 100.0 / (distance * distance);
        assert!((found / truth - 1.0).abs() < 2e-4, "{distance} m: {found} lx, not {truth}");
    }
    let seen = gershun::emitters::seen_from(&emitters, DVec3::new(20.3, 20.0, 3.0), 1);
    let truth = TAU * (1.0 - (1.0f64 - (r / 0.3f64).powi(2)).sqrt());
    let found = &seen[0];
    assert!((found.solid_angle_sr.value / truth - 1.0).abs() < 5e-3, "{} sr", found.solid_angle_sr.value);
    let luminance = found.luminance_cd_m2().expect("an area");
    assert!((luminance * PI * r * r / 100.0 - 1.0).abs() < 1e-9, "{luminance} cd/m²");
}
