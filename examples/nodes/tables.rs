//! Tables over directions: against their size where nodes lie close, and whole fields.

use gershun::field::angular::Form;
use gershun::field::nodal::{NodalField, Stored};
use gershun::rng::Rng;
use gershun::scene::Scene;
use gershun::solve::Prepared;
use gershun::solve::nodal::{NodalEffort, NodeRays, StoredLight, nodal_field, nodal_luminance};
use rayon::prelude::*;

use crate::Row;
use crate::common::cpu_seconds;
use crate::looks::{Error, Lights, Look, Reference, looks, prepared, reference};
use crate::positions::floor_nodes;
use crate::today::ray;

/// Nodes so close that place matters little, m.
const CLOSE_M: f64 = 1.0 / 128.0;
/// Distances between nodes of whole fields, m.
const WHOLE_M: [f64; 3] = [1.0, 0.5, 0.25];
/// Those that are also solved without walks.
const QUICK_M: [f64; 2] = [0.5, 0.25];
/// Whole fields are looked at in so many places.
const PLACES: usize = 12;
/// Rounds of looks by which their CPU time is measured.
const ROUNDS: usize = 40;
/// Points on openings of a look at a field that stores indirect light.
const SAMPLES: u32 = 16;

/// Name of a form.
pub fn name(form: Form) -> &'static str {
    match form {
        Form::ThetaPhi { .. } => "θ–φ grid",
        Form::Harmonics { .. } => "spherical harmonics",
        Form::Octahedral { .. } => "octahedral map",
    }
}

/// Largest steps, order and edge that are tried, and rays of each of two blocks of a number.
fn limits(exponent: u32) -> ([usize; 3], u32) {
    match exponent {
        1 => ([16, 16, 24], 16),
        10 => ([24, 24, 32], 16),
        30 => ([24, 24, 32], 8),
        100 => ([32, 32, 48], 4),
        _ => ([48, 48, 64], 2),
    }
}

/// The form of whole fields: harmonics of about the order that holds a per cent of all light.
pub fn chosen(exponent: u32) -> Form {
    let order = match exponent {
        1 => 8,
        10 => 12,
        30 => 16,
        100 => 24,
        _ => 48,
    };
    Form::Harmonics { order }
}

fn forms([steps, order, size]: [usize; 3]) -> Vec<Form> {
    let up_to = |list: &'static [usize], most: usize| list.iter().copied().filter(move |&n| n <= most);
    let grids = up_to(&[4, 6, 8, 12, 16, 24, 32, 48], steps).map(|steps| Form::ThetaPhi { steps });
    let orders = up_to(&[2, 4, 6, 8, 12, 16, 24, 32, 48], order).map(|order| Form::Harmonics { order });
    let maps = up_to(&[6, 8, 12, 16, 24, 32, 48, 64], size).map(|size| Form::Octahedral { size });
    grids.chain(orders).chain(maps).collect()
}

/// A field of the nodes about the looks only, with direct and indirect light apart.
fn about(
    prepared: &Prepared,
    looks: &[Look],
    spacing_m: f64,
    form: Form,
    rays: NodeRays,
) -> (NodalField, usize) {
    let nodes = floor_nodes(prepared.emitters().scene, spacing_m);
    let mut near = vec![false; nodes.len()];
    for look in looks {
        let around = nodes.around(look.spot.triangle, look.spot.barycentric).expect("the floor has nodes");
        for (node, _) in around {
            near[node] = true;
        }
    }
    let effort = NodalEffort { form, light: StoredLight::Apart, blocks: 2, rays, splitting: None };
    let asked = near.iter().filter(|&&near| near).count();
    (nodal_field(prepared, &effort, nodes, |node, front| front && near[node]), asked)
}

/// What a field shows, direct and indirect light apart.
fn shown(field: &NodalField, looks: &[Look]) -> Vec<Lights> {
    let one = |look: &Look| {
        let found = field.look(&look.spot, look.to_eye).expect("its nodes are solved").luminance;
        [found[0] + found[1], found[1]]
    };
    looks.par_iter().map(one).collect()
}

/// Error against the number of directions.
pub fn directions(exponent: u32, scene: &Scene, rows: &mut Vec<Row>) {
    let looks = looks(scene, exponent, 3, 64);
    let reference = reference(scene, &looks);
    let replicas = [1, 2].map(|seed| prepared(scene, 16, seed));
    let (limits, rays) = limits(exponent);
    for form in forms(limits) {
        let before = cpu_seconds();
        let fields = [0, 1].map(|k| about(&replicas[k], &looks, CLOSE_M, form, NodeRays::walked(rays)));
        let (asked, nodes) = (fields[0].1, fields[0].0.nodes.len());
        let cpu_s = (cpu_seconds() - before) / (2 * asked) as f64 * nodes as f64;
        let found = fields.map(|(field, _)| shown(&field, &looks));
        for light in 0..2 {
            rows.push(Row {
                part: "direction",
                light,
                exponent: Some(exponent),
                way: name(form).into(),
                numbers: form.numbers() + 1,
                spacing_m: CLOSE_M,
                nodes,
                rays: 2 * rays,
                error: Error::of(&found, &reference, light),
                cpu_s,
                look_s: 0.0,
            });
        }
    }
}

/// Fields as they would be kept: error of tables on nodes, and of indirect light in tables with the panel's light
/// added at every look.
pub fn whole(exponent: u32, scene: &Scene, looks: &[Look], reference: &Reference, rows: &mut Vec<Row>) {
    let looks = &looks[..PLACES * looks.len() / 24];
    let reference = reference.first(looks.len());
    let replicas = [1, 2].map(|seed| prepared(scene, 16, seed));
    let (form, rays) = (chosen(exponent), limits(exponent).1);
    let quick = |spacing_m: f64| (spacing_m, NodeRays { gather: 4 * rays, walks: 0 });
    let walked = WHOLE_M.map(|spacing_m| (spacing_m, NodeRays::walked(rays)));
    for (spacing_m, rays) in walked.into_iter().chain(QUICK_M.map(quick)) {
        let before = cpu_seconds();
        let fields = [0, 1].map(|k| about(&replicas[k], looks, spacing_m, form, rays));
        let (asked, nodes) = (fields[0].1, fields[0].0.nodes.len());
        let cpu_s = (cpu_seconds() - before) / (2 * asked) as f64 * nodes as f64;
        let fields = fields.map(|(field, _)| field);
        let started = cpu_seconds();
        (0..ROUNDS).for_each(|_| drop(shown(&fields[0], looks)));
        let look_s = (cpu_seconds() - started) / (ROUNDS * looks.len()) as f64;
        let found = [0, 1].map(|k| shown(&fields[k], looks));
        let mut push = |light: usize, way: &str, error: Error, look_s: f64| {
            rows.push(Row {
                part: "whole",
                light,
                exponent: Some(exponent),
                way: if rays.walks > 0 { way.into() } else { format!("{way}; patches as stored") },
                numbers: form.numbers() + 1,
                spacing_m,
                nodes,
                rays: 2 * rays.gather,
                error,
                cpu_s,
                look_s,
            });
        };
        push(0, "all light in tables", Error::of(&found, &reference, 0), look_s);
        push(1, "indirect light in tables", Error::of(&found, &reference, 1), look_s);
        let kept = [0, 1].map(|k| indirect_of(&fields[k]));
        let mixed = |k: usize| -> Vec<Lights> {
            let one = |(index, look): (usize, &Look)| {
                let mut rng = Rng::new(41, 1 + k as u64, index as u64);
                let light = StoredLight::Indirect;
                let found = nodal_luminance(&replicas[k], &kept[k], light, &ray(look), SAMPLES, &mut rng);
                [found.expect("its nodes are solved")[0], 0.0]
            };
            looks.iter().enumerate().map(one).collect()
        };
        let started = cpu_seconds();
        (0..ROUNDS).for_each(|_| drop(mixed(0)));
        let look_s = (cpu_seconds() - started) / (ROUNDS * looks.len()) as f64;
        let mixed = [mixed(0), mixed(1)];
        push(
            0,
            "indirect light in tables, direct light at the look",
            Error::of(&mixed, &reference, 0),
            look_s,
        );
    }
}

/// The field without the channel of direct light.
fn indirect_of(field: &NodalField) -> NodalField {
    let second = |values: &[f64]| values.iter().skip(1).step_by(2).copied().collect::<Vec<f64>>();
    let side = |stored: &Option<Stored>| {
        stored.as_ref().map(|s| Stored { numbers: second(&s.numbers), errors: second(&s.errors) })
    };
    let sides = field.sides.iter().map(|[front, back]| [side(front), side(back)]).collect();
    NodalField { nodes: field.nodes.clone(), form: field.form, channels: 1, sides }
}
