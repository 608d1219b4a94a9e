//! Small scenes for tests, built without files.
#![allow(dead_code, reason = "each test binary uses a part")]

use std::path::PathBuf;
use std::sync::Arc;

use gershun::geometry::mesh::Mesh;
use gershun::luminaire::{Luminaire, LuminaireType, Maintenance, orientation};
use gershun::material::{Bsdf, Lobe, Material, Pane, Phong, PhongPaper, Ward};
use gershun::photometry::{IntensityDistribution, Opening};
use gershun::project::{LoadOptions, Project, load};
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
        emergency: None,
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

pub fn sheets(
    scene: &Scene,
    demand: &Demand,
    method: Method,
    effort: Effort,
    seed: u64,
    blocks: u64,
) -> Vec<Sheet> {
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

/// The project of the example office, with more text at its end.
pub fn office_with(more: &str) -> Project {
    let folder = tempfile::tempdir().expect("a folder");
    let office = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/office");
    for entry in std::fs::read_dir(office).expect("the office").flatten() {
        std::fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("copied");
    }
    let path = folder.path().join("project.toml");
    let text = std::fs::read_to_string(&path).expect("text") + more;
    std::fs::write(&path, text).expect("written");
    load(folder.path(), &LoadOptions::default()).expect("loads")
}

/// A room with furniture, a mirror, a glazed screen, an opal screen, two kinds of lamps.
pub fn furnished() -> Scene {
    let size = DVec3::new(6.0, 4.0, 2.8);
    let mut mesh = room(size);
    let solid = |mesh: &mut Mesh, name: &str, material, lo: [f64; 3], hi: [f64; 3]| {
        let surface = mesh.add_surface(name, material, true);
        let (a, b) = (DVec3::from_array(lo), DVec3::from_array(hi));
        let p = |x: bool, y: bool, z: bool| {
            DVec3::new(if x { b.x } else { a.x }, if y { b.y } else { a.y }, if z { b.z } else { a.z })
        };
        let (f, t) = (false, true);
        for corners in [
            [p(f, f, f), p(f, t, f), p(t, t, f), p(t, f, f)],
            [p(f, f, t), p(t, f, t), p(t, t, t), p(f, t, t)],
            [p(f, f, f), p(t, f, f), p(t, f, t), p(f, f, t)],
            [p(f, t, f), p(f, t, t), p(t, t, t), p(t, t, f)],
            [p(f, f, f), p(f, f, t), p(f, t, t), p(f, t, f)],
            [p(t, f, f), p(t, t, f), p(t, t, t), p(t, f, t)],
        ] {
            mesh.add_quad(corners, surface);
        }
    };
    for (i, x) in [1.0, 2.8, 4.6].into_iter().enumerate() {
        solid(&mut mesh, &format!("desk {i}"), 3, [x - 0.7, 1.0, 0.70], [x + 0.7, 1.8, 0.74]);
        solid(&mut mesh, &format!("cabinet {i}"), 3, [x - 0.4, 3.5, 0.01], [x + 0.4, 3.9, 1.6]);
    }
    let sheet = |mesh: &mut Mesh, name: &str, material, corners: [[f64; 3]; 4]| {
        let surface = mesh.add_surface(name, material, true);
        mesh.add_quad(corners.map(DVec3::from_array), surface);
    };
    sheet(&mut mesh, "mirror", 4, [[0.01, 0.8, 0.5], [0.01, 2.6, 0.5], [0.01, 2.6, 2.0], [0.01, 0.8, 2.0]]);
    sheet(&mut mesh, "pane", 5, [[3.8, 0.0, 0.0], [3.8, 2.2, 0.0], [3.8, 2.2, 2.2], [3.8, 0.0, 2.2]]);
    sheet(&mut mesh, "opal", 6, [[2.0, 2.2, 0.3], [3.4, 2.2, 0.3], [3.4, 2.2, 1.9], [2.0, 2.2, 1.9]]);
    let materials = vec![
        lambert("floor", 0.25),
        lambert("walls", 0.6),
        lambert("ceiling", 0.8),
        lambert("desk", 0.45),
        Material { name: "mirror".into(), bsdf: Bsdf::Mirror { reflectance: 0.9 } },
        Material { name: "pane".into(), bsdf: Bsdf::Glass(Pane::new(0.85)) },
        Material { name: "opal".into(), bsdf: Bsdf::Opal { reflectance: 0.4, transmittance: 0.5 } },
    ];
    let mut lamps = Vec::new();
    for x in [1.5, 4.5] {
        for y in [1.0, 3.0] {
            lamps.push(panel(3600.0, 0.6, DVec3::new(x, y, 2.79)));
        }
    }
    let disc = Opening::Disc { diameter_m: 0.4, height_m: 0.0 };
    let mut uplight = lamp(IntensityDistribution::isotropic(Lumens(1500.0)), disc, DVec3::new(3.0, 2.0, 2.2));
    uplight.group = "B".into();
    lamps.push(uplight);
    Scene::new(mesh, materials, lamps).expect("the scene is valid")
}

/// The furnished room lit by what is hard to find: a lamp 1 cm from a wall and a small bright tile.
pub fn spots() -> Scene {
    let Scene { mut mesh, mut materials, .. } = furnished();
    let tile = mesh.add_surface("tile", materials.len(), true);
    let corners = [[1.2, 2.5, 1.3], [1.35, 2.5, 1.3], [1.35, 2.65, 1.3], [1.2, 2.65, 1.3]];
    // In mirrors and panes both methods find spots by chance.
    materials[4] = lambert("no mirror", 0.3);
    mesh.add_quad(corners.map(DVec3::from_array), tile);
    let bsdf = Bsdf::Emitter { luminance_cd_m2: 3e4, reflectance: 0.5 };
    materials.push(Material { name: "tile".into(), bsdf });
    let mut spot = point_lamp(2000.0, DVec3::new(5.99, 1.0, 1.3));
    spot.group = "B".into();
    Scene::new(mesh, materials, vec![spot]).expect("the scene is valid")
}

pub fn glossy(name: &str, reflectance: f64, lobe: Lobe) -> Material {
    Material { name: name.into(), bsdf: Bsdf::Glossy { reflectance, lobe } }
}

/// The furnished room with every kind of glossy surface; `diffuse` and `lobe` multiply reflectances.
/// With `downlights`, small bright discs and a point replace the panels, and dull sheets mirror and
/// pane: by their reflection the path tracer finds small lamps too rarely, and points never.
pub fn glossy_room([diffuse, lobe]: [f64; 2], downlights: bool) -> Scene {
    let Scene { mut mesh, mut materials, luminaires: mut lamps, .. } = furnished();
    let rho = |reflectance: f64| reflectance * diffuse;
    materials[0] = glossy("floor", rho(0.25), Lobe::Phong(Phong::new(0.3 * lobe, 60.0)));
    materials[1] = lambert("walls", rho(0.5));
    materials[2] = lambert("ceiling", rho(0.7));
    materials[3] = glossy("desk", rho(0.3), Lobe::Ward(Ward::new(0.2 * lobe, 0.12)));
    materials
        .push(Material { name: "cabinet".into(), bsdf: Bsdf::metallic_roughness(0.6 * diffuse, 0.5, 0.4) });
    materials.push(glossy("paper", rho(0.4), Lobe::PhongPaper(PhongPaper::new(0.3 * lobe, 20.0))));
    materials.push(glossy("sharp", rho(0.1), Lobe::Phong(Phong::new(0.3 * lobe, 300.0))));
    for surface in &mut mesh.surfaces {
        match surface.name.as_str() {
            "Wall_N" => surface.material = 8,
            "desk 1" => surface.material = 9,
            name if name.starts_with("cabinet") => surface.material = 7,
            _ => {}
        }
    }
    let housing = mesh.add_surface("housing", 1, true);
    let (a, b, z) = (1.3, 1.7, 2.70);
    let corners = [[a, a, z], [b, a, z], [b, b, z], [a, b, z]];
    mesh.add_quad(corners.map(DVec3::from_array), housing);
    if downlights {
        materials[4] = lambert("no mirror", rho(0.3));
        materials[5] = lambert("no pane", rho(0.3));
        let disc = |diameter_m| Opening::Disc { diameter_m, height_m: 0.0 };
        lamps = [[1.5, 1.5], [3.0, 1.2], [4.5, 1.4], [1.5, 3.0], [3.1, 2.9], [4.6, 3.1]]
            .into_iter()
            .map(|[x, y]| {
                let distribution = IntensityDistribution::lambert(Lumens(1200.0));
                lamp(distribution, disc(0.2), DVec3::new(x, y, 2.78))
            })
            .collect();
        let mut bulb = point_lamp(800.0, DVec3::new(5.2, 0.8, 2.2));
        bulb.group = "B".into();
        lamps.push(bulb);
    }
    lamps[0].body = vec![housing];
    Scene::new(mesh, materials, lamps).expect("the scene is valid")
}
