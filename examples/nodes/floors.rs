//! Meshes that are the same everywhere against meshes that are split where light bends: on a diffuse floor, one
//! number a node, and on a glossy one with tables. These fields are solved whole.

use gershun::field::angular::Form;
use gershun::field::nodal::NodalField;
use gershun::scene::Scene;
use gershun::solve::nodal::{NodalEffort, NodeRays, Splitting, StoredLight, nodal_field};

use crate::Row;
use crate::common::cpu_seconds;
use crate::looks::{Error, Lights, Look, looks, prepared, reference, scene};
use crate::positions::floor_nodes;

/// A mesh: distance between nodes, m, and what is tolerated before cells are split, % of the largest luminance.
type Way = (f64, Option<f64>);

pub fn measure(rows: &mut Vec<Row>) {
    let diffuse: [Way; 9] = [
        (2.0, None),
        (1.0, None),
        (0.5, None),
        (0.25, None),
        (0.125, None),
        (1.0, Some(2.0)),
        (1.0, Some(1.0)),
        (1.0, Some(0.5)),
        (1.0, Some(0.25)),
    ];
    let glossy: [Way; 4] = [(1.0, None), (0.5, None), (0.25, None), (1.0, Some(2.0))];
    on(None, &diffuse, [16, 16], rows);
    on(Some(10), &glossy, [8, 2], rows);
}

/// Static and adaptive fields of a floor; `effort` is blocks and rays of each.
fn on(exponent: Option<u32>, ways: &[Way], [blocks, rays]: [u32; 2], rows: &mut Vec<Row>) {
    let scene = scene(exponent);
    // A diffuse floor looks alike from everywhere: one direction, more places.
    let [places, directions] = if exponent.is_some() { [24, 8] } else { [192, 1] };
    let looks = looks(&scene, exponent.unwrap_or(1), places, directions);
    let reference = reference(&scene, &looks);
    let form = Form::Harmonics { order: 12 };
    let numbers = 1 + if exponent.is_some() { form.numbers() } else { 0 };
    for light in 0..2 {
        for &(spacing_m, tolerance_percent) in ways {
            let splitting = tolerance_percent.map(|percent| Splitting {
                tolerance_cd_m2: 0.01 * percent * reference.largest(light),
                deepest: 4,
            });
            let kept = [StoredLight::All, StoredLight::Indirect][light];
            let walked = NodeRays::walked(rays);
            let effort = NodalEffort { form, light: kept, blocks, rays: walked, splitting };
            let before = cpu_seconds();
            let fields = [1, 2].map(|seed| solved(&scene, &effort, spacing_m, seed));
            let cpu_s = 0.5 * (cpu_seconds() - before);
            let nodes = usize::midpoint(fields[0].nodes.len(), fields[1].nodes.len());
            let found = fields.map(|field| shown(&field, &looks, light));
            let way = match tolerance_percent {
                Some(percent) => format!("split, {percent} %"),
                None => "even".into(),
            };
            let error = Error::of(&found, &reference, light);
            let part = "mesh";
            rows.push(Row {
                part,
                light,
                exponent,
                way,
                numbers,
                spacing_m,
                nodes,
                rays: blocks * rays,
                error,
                cpu_s,
                look_s: 0.0,
            });
        }
    }
}

fn solved(scene: &Scene, effort: &NodalEffort, spacing_m: f64, seed: u64) -> NodalField {
    let prepared = prepared(scene, 16, seed);
    nodal_field(&prepared, effort, floor_nodes(scene, spacing_m), |_, front| front)
}

fn shown(field: &NodalField, looks: &[Look], light: usize) -> Vec<Lights> {
    let one = |look: &Look| {
        let mut lights = [0.0; 2];
        lights[light] = field.look(&look.spot, look.to_eye).expect("the floor is solved").luminance[0];
        lights
    };
    looks.iter().map(one).collect()
}
