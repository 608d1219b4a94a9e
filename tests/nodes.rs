//! The nodal field – nodes with tables over directions – against closed forms, the solver's own answers and exact
//! radiosity. Every check has a twin that it must reject.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;

use common::{glossy, lambert, panel, point_lamp, room, sheets};
use gershun::estimate::Estimate;
use gershun::field::angular::Form;
use gershun::field::nodal::{Interpolated, NodalField, Spot};
use gershun::field::nodes::Nodes;
use gershun::material::{Bsdf, Lobe, Material, Phong};
use gershun::query::{Demand, Ray};
use gershun::rng::Rng;
use gershun::scene::Scene;
use gershun::solve::nodal::{
    NodalEffort, NodeRays, Splitting, StoredLight, nodal_field, nodal_luminance, reflected, scattering_nodes,
};
use gershun::solve::{Effort, Method, Prepared, prepare};
use gershun::sphere;
use glam::DVec3;
use std::f64::consts::PI;

static NOTHING: Demand = Demand { receivers: Vec::new(), rays: Vec::new(), flux: false };

fn prepared(scene: &Scene) -> Prepared<'_> {
    prepare(scene, &NOTHING, Method::Links, Effort::default(), 1)
}

fn lobe(specular: f64) -> Lobe {
    Lobe::Phong(Phong::new(specular, 10.0))
}

/// The side of a surface on which a point lies from above or wherever `from` is.
fn spot(scene: &Scene, point: DVec3, from: DVec3) -> Spot {
    let towards = (point - from).normalize();
    let hit = scene.tracer.closest(from, towards, &[]).expect("something is there");
    Spot { triangle: hit.triangle, barycentric: hit.barycentric, front: hit.front }
}

/// A black box that glows with 100 cd/m² above a glossy floor.
fn furnace(specular: f64) -> Scene {
    let glow =
        Material { name: "glow".into(), bsdf: Bsdf::Emitter { luminance_cd_m2: 100.0, reflectance: 0.0 } };
    let mut mesh = room(DVec3::new(2.0, 1.5, 1.0));
    // One material, one channel.
    mesh.surfaces[1].material = 1;
    Scene::new(mesh, vec![glossy("floor", 0.2, lobe(specular)), glow], vec![]).expect("a valid scene")
}

/// The floor of a box room, its first two triangles, seen from inside.
fn floor_field(prepared: &Prepared, effort: &NodalEffort, spacing_m: f64) -> NodalField {
    let scene = prepared.emitters().scene;
    let nodes = Nodes::new(&scene.mesh, spacing_m, 1e-3, |triangle| triangle < 2);
    nodal_field(prepared, effort, nodes, |_, front| front)
}

/// Catches: tables that lose or gain light, a wrong frame of directions, errors that are too small.
#[test]
fn a_furnace_shows_the_albedo_in_every_form() {
    let angles_deg = [8.0f64, 33.0, 57.0, 74.0];
    for form in [Form::ThetaPhi { steps: 12 }, Form::Harmonics { order: 8 }, Form::Octahedral { size: 14 }] {
        let effort = NodalEffort { form, blocks: 64, rays: NodeRays::walked(8), ..NodalEffort::default() };
        let look = |scene: &Scene, light: StoredLight| -> Vec<Interpolated> {
            let field = floor_field(&prepared(scene), &NodalEffort { light, ..effort }, 2.0);
            let spot = spot(scene, DVec3::new(0.7, 0.9, 0.0), DVec3::new(0.7, 0.9, 0.5));
            let towards = |angle: &f64| {
                let (sin, cos) = angle.to_radians().sin_cos();
                DVec3::new(sin * 0.8, sin * 0.6, cos)
            };
            angles_deg.iter().map(|angle| field.look(&spot, towards(angle)).expect("it is solved")).collect()
        };
        let (found, twins) = (look(&furnace(0.5), StoredLight::All), look(&furnace(0.55), StoredLight::All));
        let mut rejected = 0;
        for ((angle, found), twin) in angles_deg.iter().zip(&found).zip(&twins) {
            // L = L0 (ρ_d + a(θ)); interpolation errs by what the albedo bends within a step.
            let truth = 100.0 * (0.2 + lobe(0.5).albedo(angle.to_radians().cos()));
            let bends = 0.005 * truth;
            let (off, se) = (found.luminance[0] - truth, found.se[0]);
            println!("{form:?} at {angle}°: {:.2} ± {se:.2}, truth {truth:.2}", found.luminance[0]);
            assert!(5.0 * se < 0.03 * truth, "{form:?}: cannot resolve 3 %: {se} of {truth}");
            assert!(off.abs() <= 5.0 * se + bends, "{form:?} at {angle}°: {off} with {se}");
            let twin_off = (twin.luminance[0] - truth).abs();
            rejected += usize::from(twin_off > 5.0 * twin.se[0] + bends);
        }
        assert!(rejected >= 3, "{form:?}: a lobe 10 % stronger passes");
        // What glows is no luminaire: it counts as indirect light, with the same random numbers.
        assert_eq!(look(&furnace(0.5), StoredLight::Indirect), found);
    }
}

/// Two panels of different groups over a glossy floor.
fn lit(specular: f64) -> Scene {
    let floor = glossy("floor", 0.2, lobe(specular));
    let materials = vec![floor, lambert("walls", 0.5), lambert("ceiling", 0.7)];
    let mut lamps = [[1.0, 1.5], [3.0, 1.2]].map(|[x, y]| panel(2000.0, 0.4, DVec3::new(x, y, 2.79)));
    lamps[1].group = "B".into();
    Scene::new(room(DVec3::new(4.0, 3.0, 2.8)), materials, lamps.to_vec()).expect("a valid scene")
}

/// Catches: a node's estimate that counts light twice or loses some, channels mixed up, light on the wrong side
/// of the division into direct and indirect.
#[test]
fn nodes_hold_what_lines_of_sight_see() {
    let scene = lit(0.3);
    let point = DVec3::new(1.7, 0.8, 0.0);
    let to_eye = DVec3::new(0.3, 0.4, 0.75f64.sqrt());
    let ray = Ray { point: point + to_eye, direction: -to_eye };
    let demand = Demand { rays: vec![ray], ..Demand::default() };
    let effort = Effort { gather: 64, ..Effort::default() };
    let blocks = 256;
    let answers = sheets(&scene, &demand, Method::Links, effort, 5, blocks);
    let seen = |scene: &Scene, channel: usize| {
        let prepared = prepared(scene);
        let spot = spot(scene, point, ray.point);
        let local = sphere::frame(DVec3::Z).transpose() * to_eye;
        let values: Vec<f64> = (0..blocks)
            .map(|block| {
                let found =
                    reflected(&prepared, &spot, local, NodeRays::walked(64), &mut Rng::new(3, 1 + block, 0));
                found.direct[channel] + found.indirect[channel]
            })
            .collect();
        Estimate::from_blocks(&values)
    };
    for channel in 0..2 {
        let values: Vec<f64> = answers
            .iter()
            .map(|sheet| {
                sheet.values[channel * gershun::solve::PARTS..][..gershun::solve::PARTS].iter().sum()
            })
            .collect();
        let truth = Estimate::from_blocks(&values);
        let (found, twin) = (seen(&scene, channel), seen(&lit(0.33), channel));
        let z = |found: &Estimate| (found.value - truth.value).abs() / found.se.hypot(truth.se);
        println!("channel {channel}: {found:?}, by lines of sight {truth:?}, z {:.2}", z(&found));
        assert!(5.0 * found.se.hypot(truth.se) < 0.02 * truth.value, "cannot resolve 2 %");
        assert!(z(&found) <= 5.0, "{} standard errors", z(&found));
        assert!(z(&twin) > 5.0, "a lobe 10 % stronger passes");
    }
}

/// Catches: light of the luminaires stored and added again at the look-up, or neither; forms that differ.
#[test]
fn direct_light_may_be_stored_or_added() {
    let scene = lit(0.3);
    let prepared = prepared(&scene);
    let point = DVec3::new(1.31, 1.17, 0.0);
    let to_eye = DVec3::new(0.3, 0.4, 0.75f64.sqrt());
    let ray = Ray { point: point + 0.5 * to_eye, direction: -to_eye };
    let nodes = Nodes::new(&scene.mesh, 0.05, 1e-3, |triangle| triangle < 2);
    let here = spot(&scene, point, ray.point);
    let near: Vec<usize> = nodes
        .around(here.triangle, here.barycentric)
        .expect("the floor has nodes")
        .map(|(node, _)| node)
        .to_vec();
    let look = |kept: StoredLight, told: StoredLight| {
        let effort = NodalEffort {
            form: Form::Harmonics { order: 12 },
            light: kept,
            blocks: 8,
            rays: NodeRays::walked(32),
            ..NodalEffort::default()
        };
        let field =
            nodal_field(&prepared, &effort, nodes.clone(), |node, front| front && near.contains(&node));
        let one = |round: u64| {
            let mut rng = Rng::new(4, round, 0);
            nodal_luminance(&prepared, &field, told, &ray, 4, &mut rng).expect("its nodes are solved")[0]
        };
        Estimate::from_blocks(&(0..64).map(one).collect::<Vec<f64>>()).value
    };
    let demand = Demand { rays: vec![ray], ..Demand::default() };
    let effort = Effort { gather: 64, ..Effort::default() };
    let answers = sheets(&scene, &demand, Method::Links, effort, 5, 128);
    let values: Vec<f64> = answers.iter().map(|sheet| sheet.values[..3].iter().sum()).collect();
    let truth = Estimate::from_blocks(&values).value;
    let stored = look(StoredLight::All, StoredLight::All);
    let added = look(StoredLight::Indirect, StoredLight::Indirect);
    println!("{stored} stored, {added} added, {truth} by lines of sight");
    assert!((stored / truth - 1.0).abs() < 0.02 && (added / truth - 1.0).abs() < 0.02);
    let twice = look(StoredLight::All, StoredLight::Indirect);
    let never = look(StoredLight::Indirect, StoredLight::All);
    assert!(twice > 1.3 * truth && never < 0.7 * truth, "{twice} {never}");
}

/// Catches: nodes on the edge itself, where the neighbouring surface is not seen.
#[test]
fn nodes_at_a_concave_edge_hold_its_limit() {
    // A black room with one glowing wall: at its foot E → πL/2 on the floor, half of what it sees.
    let glow =
        Material { name: "glow".into(), bsdf: Bsdf::Emitter { luminance_cd_m2: 100.0, reflectance: 0.0 } };
    let mut mesh = room(DVec3::new(4.0, 4.0, 3.0));
    mesh.surfaces[4].material = 3;
    let materials = vec![lambert("floor", 0.5), lambert("black", 0.0), lambert("black", 0.0), glow];
    let scene = Scene::new(mesh, materials, vec![]).expect("a valid scene");
    let prepared = prepared(&scene);
    let at = |inset_m: f64| {
        let nodes = Nodes::new(&scene.mesh, 0.25, inset_m, |triangle| triangle < 2);
        let middle = spot(&scene, DVec3::new(0.0005, 2.0, 0.0), DVec3::new(0.0005, 2.0, 0.5));
        let near = nodes.around(middle.triangle, middle.barycentric).expect("the floor has nodes");
        let near: Vec<usize> = near.iter().map(|(node, _)| *node).collect();
        let effort = NodalEffort { blocks: 64, rays: NodeRays::walked(64), ..NodalEffort::default() };
        let field = nodal_field(&prepared, &effort, nodes, |node, front| front && near.contains(&node));
        let found = field.look(&middle, DVec3::Z).expect("its nodes are solved");
        (found.luminance[0], found.se[0])
    };
    // L = ρ/π · πL_w/2 at the edge itself; the sides of a wall 4 m wide hardly count there.
    let truth = 0.5 * 100.0 / 2.0;
    for inset_m in [1e-2, 1e-3, 1e-4] {
        let (found, se) = at(inset_m);
        println!("inset {inset_m} m: {found:.3} ± {se:.3}, limit {truth}");
        assert!(5.0 * se < 0.03 * truth, "cannot resolve 3 %");
        // ½ (1 − x/√(x² + h²)) is lower by x/h, and the look-up goes on straight to the edge.
        let allowed = 5.0 * se + truth * (inset_m / 3.0 + 0.01);
        assert!((found - truth).abs() <= allowed, "{found} at {inset_m} m");
    }
    let (on_edge, se) = at(0.0);
    println!("on the edge: {on_edge:.3} ± {se:.3}");
    assert!(
        (on_edge - truth).abs() > 5.0 * se + 0.1 * truth,
        "a node on the edge sees what it should not: {on_edge}"
    );
}

fn box_room(walls: f64) -> Scene {
    let materials = vec![lambert("floor", 0.2), lambert("walls", walls), lambert("ceiling", 0.7)];
    let lamp = point_lamp(1000.0, DVec3::new(2.0, 1.5, 2.0));
    Scene::new(room(DVec3::new(4.0, 3.0, 2.8)), materials, vec![lamp]).expect("a valid scene")
}

/// Total illuminances of the receivers of room A in the reference data.
fn references() -> Option<Vec<(DVec3, DVec3, f64)>> {
    let text =
        std::fs::read_to_string(common::data()?.join("oracles/rooms.txt")).expect("the rooms are there");
    let places = [
        ("floor centre", DVec3::new(2.0, 1.5, 0.0), DVec3::Z),
        ("floor (.5,.5)", DVec3::new(0.5, 0.5, 0.0), DVec3::Z),
        ("floor (X-.5,Y/2)", DVec3::new(3.5, 1.5, 0.0), DVec3::Z),
        ("ceiling (.5,.5)", DVec3::new(0.5, 0.5, 2.8), DVec3::NEG_Z),
        ("wall x=X, y=Y/2, z=1.2", DVec3::new(4.0, 1.5, 1.2), DVec3::NEG_X),
        ("wall y=Y, x=X/2, z=1.2", DVec3::new(2.0, 3.0, 1.2), DVec3::NEG_Y),
    ];
    let total = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name)).expect("room A comes first");
        line.split_whitespace().rev().nth(1).and_then(|total| total.parse().ok()).expect("the total")
    };
    Some(places.map(|(name, point, normal)| (point, normal, total(name))).to_vec())
}

/// Catches: nodes that hold a wrong luminance, interpolation to the wrong place, a wrong side.
#[test]
fn the_field_of_a_box_room_is_that_of_exact_radiosity() {
    let Some(references) = references() else {
        println!("skipped: no reference data");
        return;
    };
    // Illuminance by the field at every place: direct light is added exactly, as the lamp is a point.
    let found = |scene: &Scene, spacing_m: f64| -> Vec<(f64, f64)> {
        let prepared = prepared(scene);
        let effort = NodalEffort { blocks: 64, rays: NodeRays::walked(64), ..NodalEffort::default() };
        let nodes = scattering_nodes(scene, spacing_m, 1e-3);
        let field = nodal_field(&prepared, &effort, nodes, |_, front| front);
        references
            .iter()
            .map(|(point, normal, _)| {
                let ray = Ray { point: *point + 0.1 * *normal, direction: -*normal };
                let spot = spot(scene, *point, ray.point);
                let light = StoredLight::Indirect;
                let luminance = nodal_luminance(&prepared, &field, light, &ray, 1, &mut Rng::new(1, 1, 1));
                let factor = PI / scene.bsdf(spot.triangle).albedo(1.0);
                let se = field.look(&spot, DVec3::Z).expect("all of the room is solved").se[0];
                (factor * luminance.expect("all of the room is solved")[0], factor * se)
            })
            .collect()
    };
    let [fine, coarse] = [0.3, 0.6].map(|spacing_m| found(&box_room(0.5), spacing_m));
    let twin = found(&box_room(0.58), 0.3);
    let mut rejected = 0;
    for (index, (point, _, truth)) in references.iter().enumerate() {
        let ((value, se), (twin, twin_se)) = (fine[index], twin[index]);
        // What interpolation errs is about a third of what twice the spacing changes; all of it is allowed.
        let bends = (value - coarse[index].0).abs();
        let error = 5.0 * se + bends;
        println!("{point}: {value:.3} ± {se:.3}, twice the spacing {:.3}, truth {truth:.3}", coarse[index].0);
        assert!(error < 0.03 * truth, "cannot resolve 3 % at {point}: {error} of {truth}");
        assert!((value - truth).abs() <= error, "{value} is not {truth} at {point} within {error}");
        rejected += usize::from((twin - truth).abs() > 5.0 * twin_se + bends);
    }
    assert!(rejected >= 4, "walls that reflect 0.58 pass in all but {rejected} places");
}

/// Catches: splitting where nothing bends, not where light does, or of noise.
#[test]
fn cells_are_split_where_light_bends() {
    let materials = vec![lambert("floor", 0.5), lambert("walls", 0.0), lambert("ceiling", 0.0)];
    let lamp = point_lamp(1000.0, DVec3::new(1.0, 1.0, 0.4));
    let scene = Scene::new(room(DVec3::new(4.0, 4.0, 3.0)), materials, vec![lamp]).expect("a valid scene");
    let prepared = prepared(&scene);
    let solve = |splitting: Option<Splitting>, spacing_m: f64| {
        let effort = NodalEffort {
            light: StoredLight::All,
            blocks: 2,
            rays: NodeRays::walked(1),
            splitting,
            ..NodalEffort::default()
        };
        floor_field(&prepared, &effort, spacing_m)
    };
    // L = ρ/π · I h/d³ of a point lamp over a floor in a black room.
    let truth = |p: DVec3| {
        let h = 0.4;
        let d = p.distance(DVec3::new(1.0, 1.0, h));
        0.5 / PI * (1000.0 / (4.0 * PI)) * h / d.powi(3)
    };
    let worst = |field: &NodalField| {
        let mut rng = Rng::new(1, 1, 1);
        (0..2000)
            .map(|_| {
                let [u, v] = rng.uniforms();
                let point = DVec3::new(4.0 * u, 4.0 * v, 0.0);
                let spot = spot(&scene, point, point + 0.2 * DVec3::Z);
                let found = field.look(&spot, DVec3::Z).expect("the floor is solved").luminance[0];
                (found - truth(point)).abs()
            })
            .fold(0.0, f64::max)
    };
    let tolerance_cd_m2 = 0.01 * truth(DVec3::new(1.0, 1.0, 0.0));
    let split = solve(Some(Splitting { tolerance_cd_m2, deepest: 5 }), 1.0);
    let spacing_m = (16.0 / split.nodes.len() as f64).sqrt();
    let even = solve(None, spacing_m);
    println!(
        "{} nodes split: {:.2}, {} nodes even: {:.2} cd/m², tolerated {tolerance_cd_m2:.2}",
        split.nodes.len(),
        worst(&split),
        even.nodes.len(),
        worst(&even)
    );
    assert!(even.nodes.len() >= split.nodes.len(), "the even mesh has as many nodes");
    assert!(worst(&split) < 2.0 * tolerance_cd_m2, "{}", worst(&split));
    assert!(worst(&even) > 2.0 * worst(&split), "splitting gains nothing");
    // Uniform light is never split, however little is tolerated: noise is not light.
    let scene = furnace(0.5);
    let effort = NodalEffort {
        blocks: 64,
        rays: NodeRays::walked(4),
        form: Form::Harmonics { order: 4 },
        splitting: Some(Splitting { tolerance_cd_m2: 0.0, deepest: 2 }),
        ..NodalEffort::default()
    };
    let prepared = self::prepared(&scene);
    let field = floor_field(&prepared, &effort, 0.5);
    let unsplit = floor_field(&prepared, &NodalEffort { splitting: None, ..effort }, 0.5);
    println!("uniform light: {} of {} nodes", field.nodes.len(), unsplit.nodes.len());
    assert!(field.nodes.len() < 2 * unsplit.nodes.len(), "noise is split");
}

/// Catches: results that depend on the order in which nodes are solved, or on which are asked for.
#[test]
fn a_node_is_the_same_whatever_else_is_asked() {
    let scene = lit(0.3);
    let prepared = prepared(&scene);
    let effort = NodalEffort {
        form: Form::Harmonics { order: 2 },
        blocks: 2,
        rays: NodeRays::walked(2),
        ..NodalEffort::default()
    };
    let nodes = Nodes::new(&scene.mesh, 1.0, 1e-3, |triangle| triangle < 2);
    let all = nodal_field(&prepared, &effort, nodes.clone(), |_, front| front);
    let some = nodal_field(&prepared, &effort, nodes, |node, front| front && node % 3 == 1);
    for (node, (all, some)) in all.sides.iter().zip(&some.sides).enumerate() {
        assert!(all[1].is_none() && all[0].is_some());
        assert_eq!(some[0].is_some(), node % 3 == 1);
        if some[0].is_some() {
            assert_eq!(all, some, "node {node}");
        }
    }
    // A diffuse number and a table per channel; a diffuse surface has one number, a mirror has no nodes.
    let numbers = &all.sides[0][0].as_ref().expect("it is solved").numbers;
    assert_eq!(numbers.len(), 2 * (1 + effort.form.numbers()));
    let mirror = Material { name: "mirror".into(), bsdf: Bsdf::Mirror { reflectance: 0.9 } };
    let materials = vec![mirror, lambert("walls", 0.5), lambert("ceiling", 0.7)];
    let lamp = point_lamp(1000.0, DVec3::new(1.0, 1.0, 1.0));
    let scene = Scene::new(room(DVec3::new(2.0, 2.0, 2.0)), materials, vec![lamp]).expect("a valid scene");
    let nodes = scattering_nodes(&scene, 1.0, 1e-3);
    assert!(nodes.around(0, [0.3, 0.3]).is_none() && nodes.around(2, [0.3, 0.3]).is_some());
    let walls = nodal_field(&self::prepared(&scene), &effort, nodes, |_, front| front);
    assert!(walls.sides.iter().all(|side| side[0].as_ref().is_some_and(|stored| stored.numbers.len() == 1)));
    // What a mirror shows is followed at the look-up.
    let ray = Ray { point: DVec3::new(0.5, 0.9, 0.5), direction: DVec3::new(0.6, 0.0, -0.8) };
    let prepared = self::prepared(&scene);
    let seen = nodal_luminance(&prepared, &walls, StoredLight::Indirect, &ray, 256, &mut Rng::new(1, 1, 1));
    assert!(seen.is_some_and(|luminance| luminance[0] > 0.0), "the wall in the mirror is dark");
}
