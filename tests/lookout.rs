//! What a map's eyes see of luminaires and their images, against many points on every opening. Catches an image
//! seen beyond its mirror, a shaft called clear in which something stands, the wrong reflectance, points that
//! crowd.

#![allow(clippy::print_stdout, reason = "measured figures belong in the log")]

mod common;

use gershun::emitters::{Emitters, Lookout, Seen, seen_by_points};
use gershun::rng::Rng;
use gershun::scene::Scene;
use glam::DVec3;

const EYES: usize = 256;
/// Classes of sources: luminaires, images in the mirror, images in the pane.
const CLASSES: [&str; 3] = ["luminaires", "in the mirror", "in the pane"];
/// Of each, the largest mean error of the light that is allowed.
const ALLOWED: [f64; 3] = [0.002, 0.004, 0.02];

/// The furnished room with the mirror's upper edge lowered.
fn room(lowered_m: f64) -> Scene {
    let Scene { mut mesh, materials, luminaires, .. } = common::furnished();
    let mirror = mesh.surfaces.iter().position(|surface| surface.name == "mirror").expect("a mirror") as u32;
    let of_mirror = mesh.triangles.iter().filter(|triangle| triangle.surface == mirror);
    let mut corners: Vec<u32> = of_mirror.flat_map(|triangle| triangle.vertices).collect();
    corners.sort_unstable();
    corners.dedup();
    for corner in corners {
        let z = &mut mesh.positions[corner as usize].z;
        *z = if *z > 1.0 { *z - lowered_m } else { *z };
    }
    Scene::new(mesh, materials, luminaires).expect("a scene")
}

fn eyes() -> Vec<DVec3> {
    let mut rng = Rng::new(5, 5, 5);
    let mut eye = || {
        let [x, y, z] = rng.uniforms();
        DVec3::new(0.3 + 5.4 * x, 0.2 + 3.2 * y, 0.8 + 1.2 * z)
    };
    (0..EYES).map(|_| eye()).collect()
}

fn of_source(all: &[Seen], source: usize) -> [f64; 3] {
    let found = all.iter().find(|seen| seen.source == source);
    found.map_or([0.0; 3], |seen| [seen.normal_lx.value, seen.solid_angle_sr.value, seen.visible_fraction])
}

/// Mean errors of light and solid angle as shares of what is seen, by class; and how many were seen in part.
fn errors(scene: &Scene, reference: &[Vec<Seen>]) -> ([f64; 3], [usize; 3]) {
    let emitters = Emitters::new(scene);
    let lookout = Lookout::new(&emitters, 1);
    let (mut off, mut all, mut parts) = ([[0.0; 2]; 3], [[0.0; 2]; 3], [0; 3]);
    let mut worst: f64 = 0.0;
    for (eye, truth) in eyes().into_iter().zip(reference) {
        let found = lookout.from(eye).luminaires;
        for (index, source) in emitters.sources.iter().enumerate() {
            let class = match source.mirror {
                None => 0,
                Some(_) if emitters.reflectance(source, DVec3::X) > 0.5 => 1,
                Some(_) => 2,
            };
            let (own, truth) = (of_source(&found, index), of_source(truth, index));
            for k in 0..2 {
                off[class][k] += (own[k] - truth[k]).abs();
                all[class][k] += truth[k];
            }
            parts[class] += usize::from((0.02..0.98).contains(&truth[2]));
            if class < 2 {
                worst = worst.max((own[2] - truth[2]).abs());
            }
        }
    }
    println!("worst visible share {worst:.3}, of partly visible {parts:?}");
    let error = |class: usize| (0..2).map(|k| off[class][k] / all[class][k]).fold(0.0, f64::max);
    (std::array::from_fn(error), parts)
}

#[test]
fn many_eyes_see_what_one_sees() {
    let scene = room(0.0);
    let emitters = Emitters::new(&scene);
    let reference: Vec<Vec<Seen>> =
        eyes().into_iter().map(|eye| seen_by_points(&emitters, eye, 7, 256)).collect();
    let (found, parts) = errors(&scene, &reference);
    let (twin, _) = errors(&room(0.02), &reference);
    for (class, name) in CLASSES.iter().enumerate() {
        println!("{name}: {:.4} off, with a mirror 2 cm lower {:.4}", found[class], twin[class]);
        assert!(found[class] < ALLOWED[class], "{name}: {}", found[class]);
        assert!(parts[class] > 20, "{name}: {parts:?}");
    }
    assert!(twin[1] > ALLOWED[1], "{}", twin[1]);
}
