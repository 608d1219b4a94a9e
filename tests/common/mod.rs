//! Small scenes for tests, built without files.
#![allow(dead_code, reason = "each test binary uses a part")]

use std::path::PathBuf;
use std::sync::Arc;

use gershun::geometry::mesh::Mesh;
use gershun::luminaire::{Luminaire, LuminaireType, Maintenance, orientation};
use gershun::material::{Bsdf, Material};
use gershun::photometry::{IntensityDistribution, Opening};
use gershun::query::{Demand, Kernel, Receiver};
use gershun::scene::Scene;
use gershun::solve::{Effort, Method, PARTS, Sheet, answer, prepare};
use gershun::units::Lumens;
use glam::DVec3;
use rayon::prelude::*;

/// Folder of reference data that is not ours; tests that need it say "skipped" without it.
pub fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("GERSHUN_DATA")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data"), PathBuf::from);
    folder.is_dir().then_some(folder)
}

pub fn lambert(name: &str, reflectance: f64) -> Material {
    Material { name: name.into(), bsdf: Bsdf::Lambert { reflectance } }
}

/// An empty room from the origin; materials 0 floor, 1 walls, 2 ceiling.
pub fn room(size: DVec3) -> Mesh {
    let mut mesh = Mesh::default();
    let p = |x: f64, y: f64, z: f64| DVec3::new(x * size.x, y * size.y, z * size.z);
    let faces = [
        ("Floor", 0, [p(0., 0., 0.), p(1., 0., 0.), p(1., 1., 0.), p(0., 1., 0.)]),
        ("Ceiling", 2, [p(0., 0., 1.), p(0., 1., 1.), p(1., 1., 1.), p(1., 0., 1.)]),
        ("Wall_S", 1, [p(0., 0., 0.), p(0., 0., 1.), p(1., 0., 1.), p(1., 0., 0.)]),
        ("Wall_N", 1, [p(0., 1., 0.), p(1., 1., 0.), p(1., 1., 1.), p(0., 1., 1.)]),
        ("Wall_W", 1, [p(0., 0., 0.), p(0., 1., 0.), p(0., 1., 1.), p(0., 0., 1.)]),
        ("Wall_E", 1, [p(1., 0., 0.), p(1., 0., 1.), p(1., 1., 1.), p(1., 1., 0.)]),
    ];
    for (name, material, corners) in faces {
        let surface = mesh.add_surface(name, material, false);
        mesh.add_quad(corners, surface);
    }
    mesh
}

pub fn lamp(distribution: IntensityDistribution, opening: Opening, position: DVec3) -> Luminaire {
    let flux_lm = distribution.flux().0;
    let kind = LuminaireType {
        name: "A".into(),
        description: String::new(),
        distribution,
        opening,
        flux_lm,
        rated_flux_lm: None,
        power_w: None,
        maintenance: Maintenance::NEW,
        c0_azimuth_deg: 0.0,
        file: String::new(),
        declared_ra: None,
    };
    Luminaire {
        kind: Arc::new(kind),
        position,
        world_from_luminaire: orientation(DVec3::NEG_Z, 0.0),
        group: "A".into(),
        dim: 1.0,
        body: Vec::new(),
    }
}

pub fn point_lamp(flux_lm: f64, position: DVec3) -> Luminaire {
    lamp(IntensityDistribution::isotropic(Lumens(flux_lm)), Opening::Point, position)
}

pub fn panel(flux_lm: f64, size_m: f64, position: DVec3) -> Luminaire {
    let opening = Opening::Rect { length_m: size_m, width_m: size_m, side_x_m: 0.0, side_y_m: 0.0 };
    lamp(IntensityDistribution::lambert(Lumens(flux_lm)), opening, position)
}

/// A planar receiver; on a surface its normal lifts it.
pub fn planar(point: DVec3, normal: DVec3) -> Receiver {
    Receiver { point, lift: normal, kernels: vec![Kernel::Planar { normal }] }
}

pub fn sheets(scene: &Scene, demand: &Demand, method: Method, effort: Effort, seed: u64, blocks: u64) -> Vec<Sheet> {
    let prepared = prepare(scene, demand, method, effort, seed);
    (0..blocks).into_par_iter().map(|block| answer(&prepared, block)).collect()
}

/// Block values of one row, all channels and parts summed.
pub fn row(sheets: &[Sheet], row: usize, channels: usize) -> Vec<f64> {
    let span = channels * PARTS;
    sheets.iter().map(|sheet| sheet.values[row * span..(row + 1) * span].iter().sum()).collect()
}

/// CPU seconds of this process so far (Linux), for printed figures only.
pub fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    let ticks = |index: usize| fields.get(index).and_then(|f| f.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(11) + ticks(12)) / 100.0
}
