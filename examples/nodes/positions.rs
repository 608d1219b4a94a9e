//! Error of interpolating between nodes alone: each of the three nodes about a place is solved in the very direction
//! that is looked in, as a table without error would hold it.

use gershun::field::nodal::Spot;
use gershun::field::nodes::Nodes;
use gershun::rng::Rng;
use gershun::scene::Scene;
use gershun::solve::nodal::NodeRays;
use rayon::prelude::*;

use crate::Row;
use crate::looks::{Error, Lights, Look, Reference, prepared, seen};

/// Distances between nodes, m.
const SPACINGS_M: [f64; 6] = [2.0, 1.0, 0.5, 0.25, 0.125, 0.0625];
/// Rays by which a node is solved.
const RAYS: u32 = 128;
/// Distance of nodes from the walls, m.
pub const INSET_M: f64 = 1e-3;

/// Nodes on the floor, which is the first surface of the room.
pub fn floor_nodes(scene: &Scene, spacing_m: f64) -> Nodes {
    Nodes::new(&scene.mesh, spacing_m, INSET_M, |triangle| scene.mesh.triangles[triangle].surface == 0)
}

pub fn measure(exponent: u32, scene: &Scene, looks: &[Look], reference: &Reference, rows: &mut Vec<Row>) {
    let replicas = [1, 2].map(|seed| prepared(scene, 16, seed));
    for (number, spacing_m) in SPACINGS_M.into_iter().enumerate() {
        let nodes = floor_nodes(scene, spacing_m);
        let found: [Vec<Lights>; 2] = [0, 1].map(|replica| {
            let between = |(index, look): (usize, &Look)| {
                let around =
                    nodes.around(look.spot.triangle, look.spot.barycentric).expect("the floor has nodes");
                let mut sum = [0.0; 2];
                for (node, weight) in around {
                    let (triangle, barycentric) = nodes.place(node);
                    let spot = Spot { triangle, barycentric, front: look.spot.front };
                    let stream = (1 + replica + 2 * number) as u64;
                    let mut rng = Rng::new(21, stream, ((index as u64) << 32) + node as u64);
                    let lights =
                        seen(&replicas[replica], &spot, look.to_eye, NodeRays::walked(RAYS), &mut rng);
                    (0..2).for_each(|light| sum[light] += weight * lights[light]);
                }
                sum
            };
            looks.par_iter().enumerate().map(between).collect()
        });
        for light in 0..2 {
            let error = Error::of(&found, reference, light);
            rows.push(Row {
                part: "position",
                light,
                exponent: Some(exponent),
                way: "without error in direction".into(),
                numbers: 0,
                spacing_m,
                nodes: nodes.len(),
                rays: RAYS,
                error,
                cpu_s: 0.0,
                look_s: 0.0,
            });
        }
    }
}
