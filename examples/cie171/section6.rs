//! Mirrors, light leaks and symmetry of sources.

use std::f64::consts::PI;

use gershun::estimate::Estimate;
use gershun::geometry::mesh::Mesh;
use gershun::material::{Bsdf, Material};
use gershun::photometry::{IntensityDistribution, Opening};
use gershun::solve::{Effort, Part};
use glam::DVec3;

use crate::Line;
use crate::cases::{ALL, quick, row, scene, sheet, solve};
use crate::common::{lambert, lamp, panel, planar, point_lamp, room};

pub fn mirror() -> Vec<Line> {
    let mut mesh = Mesh::default();
    sheet(&mut mesh, "Mirror", 0, [[0.0, -3.0, -3.0], [0.0, 3.0, -3.0], [0.0, 3.0, 3.0], [0.0, -3.0, 3.0]]);
    let materials = vec![Material { name: "mirror".into(), bsdf: Bsdf::Mirror { reflectance: 0.9 } }];
    let at = DVec3::new(2.0, 0.0, 0.0);
    let scene = scene(mesh, materials, vec![point_lamp(4000.0 * PI, at)]);
    let places = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 1.0], [0.5, -1.5, 1.0]].map(DVec3::from_array);
    let receivers = places.map(|p| planar(p, DVec3::NEG_X)).to_vec();
    let sheets = solve(&scene, receivers, quick(), 64);
    let image = DVec3::new(-2.0, 0.0, 0.0);
    places
        .into_iter()
        .enumerate()
        .map(|(index, p)| {
            let towards = image - p;
            let expected = 0.9 * 1000.0 * -towards.normalize().x / towards.length_squared();
            let what = format!("at ({}, {}, {}), image, lx", p.x, p.y, p.z);
            Line { family: "6, specular", what, expected, found: row(&sheets, index, &[Part::Image]) }
        })
        .collect()
}

pub fn leak() -> Vec<Line> {
    let mut mesh = room(DVec3::new(4.0, 4.0, 3.0));
    let mut next = room(DVec3::new(3.0, 4.0, 3.0));
    // The second room stands east of the first and shares its wall.
    let east = next.surfaces.iter().position(|s| s.name == "Wall_W").map(|s| s as u32);
    next.triangles.retain(|triangle| Some(triangle.surface) != east);
    let (vertices, surfaces) = (mesh.positions.len() as u32, mesh.surfaces.len() as u32);
    mesh.positions.extend(next.positions.iter().map(|p| *p + DVec3::X * 4.0));
    mesh.surfaces.extend(next.surfaces);
    mesh.triangles.extend(next.triangles.iter().map(|t| gershun::geometry::mesh::Triangle {
        vertices: t.vertices.map(|v| v + vertices),
        surface: t.surface + surfaces,
    }));
    let lamps = vec![panel(50_000.0, 0.6, DVec3::new(3.5, 2.0, 2.99))];
    let scene = scene(mesh, vec![lambert("white", 0.8); 3], lamps);
    let places = [[5.5, 2.0, 0.0], [4.001, 2.0, 0.0], [4.001, 0.001, 0.0], [4.001, 2.0, 2.999]];
    let receivers = places.map(|p| planar(DVec3::from_array(p), DVec3::Z)).to_vec();
    let effort = Effort { gather: 256, walks: 64, ..Effort::default() };
    let sheets = solve(&scene, receivers, effort, 64);
    places
        .iter()
        .enumerate()
        .map(|(index, [x, y, z])| {
            let what = format!("at ({x}, {y}, {z}), lx");
            Line { family: "6, leak", what, expected: 0.0, found: row(&sheets, index, &ALL) }
        })
        .collect()
}

pub fn symmetry() -> Vec<Line> {
    let azimuths: Vec<f64> = (0..=24).map(|k| 15.0 * f64::from(k)).collect();
    let gammas: Vec<f64> = (0..=36).map(|k| 5.0 * f64::from(k)).collect();
    let cd = azimuths
        .iter()
        .map(|c| {
            let across = c.to_radians().sin().powi(2);
            // Mirror images of a plane carry the very same numbers.
            let across = (across * 1e6).round() / 1e6;
            gammas.iter().map(|g| 300.0 + 200.0 * across * g.to_radians().sin().max(0.0)).collect()
        })
        .collect();
    let table = IntensityDistribution::from_grid(azimuths, gammas, cd).expect("the table is valid");
    let lamps = vec![lamp(table, Opening::Point, DVec3::new(2.0, 2.0, 2.5))];
    let scene = scene(room(DVec3::new(4.0, 4.0, 3.0)), vec![lambert("wall", 0.5); 3], lamps);
    let places = [[1.0, 1.5], [3.0, 1.5], [1.0, 2.5], [3.0, 2.5]];
    let receivers = places.map(|[x, y]| planar(DVec3::new(x, y, 0.0), DVec3::Z)).to_vec();
    let effort = Effort { gather: 64, walks: 16, ..Effort::default() };
    let sheets = solve(&scene, receivers, effort, 512);
    let mut lines = Vec::new();
    for (name, parts) in [("direct", &[Part::Direct][..]), ("all light", &ALL[..])] {
        let found: Vec<Estimate> = (0..4).map(|index| row(&sheets, index, parts)).collect();
        for (index, [x, y]) in places.into_iter().enumerate() {
            let others = found.iter().enumerate().filter(|(other, _)| *other != index);
            let expected = others.clone().map(|(_, e)| e.value).sum::<f64>() / 3.0;
            let spread = others.map(|(_, e)| e.se * e.se).sum::<f64>().sqrt() / 3.0;
            let found = Estimate { se: found[index].se.hypot(spread), ..found[index] };
            let what = format!("{name} at ({x}, {y}) against the mean of the other three, lx");
            lines.push(Line { family: "6, symmetry", what, expected, found });
        }
    }
    lines
}
