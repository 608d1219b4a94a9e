//! The integrating sphere as a fine polyhedron with the sphere's area, 4π m², and a point source in
//! its centre.
#![allow(dead_code, reason = "each program uses a part")]

use std::collections::BTreeMap;
use std::f64::consts::PI;

use gershun::geometry::mesh::{Mesh, Triangle};
use gershun::query::Receiver;
use gershun::scene::Scene;
use glam::DVec3;

use crate::common::{lambert, planar, point_lamp};

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Reflectance.
    pub rho: f64,
    /// Flux of the source, lm.
    pub flux_lm: f64,
}

/// An icosahedron divided `times` times, blown up to the unit sphere and scaled to its area.
fn polyhedron(times: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let surface = mesh.add_surface("Sphere", 0, false);
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        mesh.positions.extend([DVec3::new(a, b, 0.0), DVec3::new(0.0, a, b), DVec3::new(b, 0.0, a)]);
    }
    // Faces: all triples of vertices that are edge-neighbours (edge length 2).
    let near =
        |i: usize, j: usize, mesh: &Mesh| (mesh.positions[i].distance(mesh.positions[j]) - 2.0).abs() < 1e-9;
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j, &mesh) && near(j, k, &mesh) && near(i, k, &mesh) {
                    faces.push([i, j, k].map(|v| v as u32));
                }
            }
        }
    }
    for _ in 0..times {
        let mut middles: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let mut middle = |a: u32, b: u32, mesh: &mut Mesh| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = mesh.positions[a as usize].normalize() + mesh.positions[b as usize].normalize();
                mesh.positions.push(sum.normalize());
                (mesh.positions.len() - 1) as u32
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) =
                    (middle(a, b, &mut mesh), middle(b, c, &mut mesh), middle(c, a, &mut mesh));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    for position in &mut mesh.positions {
        *position = position.normalize();
    }
    mesh.triangles = faces.into_iter().map(|vertices| Triangle { vertices, surface }).collect();
    let area_m2: f64 = mesh.surface_areas_m2().iter().sum();
    let scale = (4.0 * PI / area_m2).sqrt();
    for position in &mut mesh.positions {
        *position *= scale;
    }
    mesh
}

impl Sphere {
    /// The scene, 5 120 triangles.
    pub fn scene(&self) -> Scene {
        let lamp = point_lamp(self.flux_lm, DVec3::ZERO);
        Scene::new(polyhedron(4), vec![lambert("Sphere", self.rho)], vec![lamp]).expect("it is valid")
    }

    /// Receivers on the middles of some triangles and their illuminance: direct light of the polyhedron
    /// and, uniform to some 1e-4 of itself, indirect light ρΦ/(S (1 − ρ)).
    pub fn receivers(&self, scene: &Scene) -> Vec<(Receiver, f64)> {
        let uniform = self.rho * self.flux_lm / (4.0 * PI * (1.0 - self.rho));
        [17, 1234, 4321]
            .into_iter()
            .map(|triangle| {
                let middle = scene.mesh.corners(triangle).iter().sum::<DVec3>() / 3.0;
                let outwards = scene.mesh.normal_and_area(triangle).0;
                let inwards = if outwards.dot(middle) > 0.0 { -outwards } else { outwards };
                let distance = middle.length();
                let direct =
                    self.flux_lm / (4.0 * PI) * -inwards.dot(middle) / (distance * distance * distance);
                (planar(middle, inwards), direct + uniform)
            })
            .collect()
    }
}
