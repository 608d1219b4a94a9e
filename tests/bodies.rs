//! A luminaire's own light passes its body once: covers and reflectors named in `body`, seen by rays.
#![allow(clippy::print_stdout, reason = "measured figures are shown")]

mod common;

use common::{lambert, panel, room, row, sheets};
use gershun::geometry::mesh::Mesh;
use gershun::image::{Projection, View};
use gershun::material::{Bsdf, Material, Pane};
use gershun::query::{Demand, Ray};
use gershun::scene::Scene;
use gershun::solve::picture::{Detail, expose, render};
use gershun::solve::{Effort, Method};
use glam::DVec3;

const FLUX_LM: f64 = 1000.0;
const EDGE_M: f64 = 0.5;
const MIRROR: f64 = 0.8;
const METHODS: [Method; 4] = [Method::Links, Method::Path, Method::Local, Method::Double];

/// What a scene is made of besides a black room of 4 × 4 × 4 m with a panel at (2, 2, 3.5).
struct Part {
    name: &'static str,
    material: usize,
    corners: [[f64; 3]; 4],
    of_the_body: bool,
}

fn level(name: &'static str, material: usize, z: f64, of_the_body: bool) -> Part {
    let corners = [[1.0, 1.0, z], [3.0, 1.0, z], [3.0, 3.0, z], [1.0, 3.0, z]];
    Part { name, material, corners, of_the_body }
}

fn glass() -> Pane {
    Pane::new(0.9)
}

fn scene(parts: &[Part]) -> Scene {
    let mut mesh: Mesh = room(DVec3::splat(4.0));
    let mut lamp = panel(FLUX_LM, EDGE_M, DVec3::new(2.0, 2.0, 3.5));
    for part in parts {
        let surface = mesh.add_surface(part.name, part.material, true);
        mesh.add_quad(part.corners.map(DVec3::from_array), surface);
        if part.of_the_body {
            lamp.body.push(surface);
        }
    }
    let mut materials: Vec<Material> =
        ["floor", "walls", "ceiling"].iter().map(|name| lambert(name, 0.0)).collect();
    materials.push(Material { name: "glass".into(), bsdf: Bsdf::Glass(glass()) });
    materials.push(Material { name: "mirror".into(), bsdf: Bsdf::Mirror { reflectance: MIRROR } });
    Scene::new(mesh, materials, vec![lamp]).expect("the scene is valid")
}

/// Luminance along a ray by every method and by a picture of one narrow pixel, cd/m², with the
/// standard error.
fn seen(scene: &Scene, point: DVec3, direction: DVec3) -> Vec<(String, f64, f64)> {
    let direction = direction.normalize();
    let demand = Demand { rays: vec![Ray { point, direction }], ..Demand::default() };
    let mut all: Vec<(String, f64, f64)> = METHODS
        .into_iter()
        .map(|method| {
            let blocks = row(&sheets(scene, &demand, method, Effort::default(), 1, 256), 0, 1);
            let estimate = gershun::estimate::Estimate::from_blocks(&blocks);
            (format!("{method:?}"), estimate.value, estimate.se)
        })
        .collect();
    let up = if direction.z.abs() > 0.9 { DVec3::Y } else { DVec3::Z };
    let narrow = Projection::Perspective { horizontal_deg: 0.1, vertical_deg: 0.1 };
    let view = View::new(narrow, point, direction, up).expect("the view is valid");
    let exposure = expose(scene, 1);
    let image = render(&exposure.picture(&[1.0], Detail::Exact), &view, [1, 1], &|_| ()).0;
    all.push(("picture".to_owned(), image.luminance_cd_m2[0], 0.0));
    all
}

/// Every way sees `expected`; and none sees `wrong`, which a fault would make of it.
fn expect(scene: &Scene, point: DVec3, direction: DVec3, expected: f64, wrong: f64) {
    for (name, value, se) in seen(scene, point, direction) {
        println!("{name}: {value:.3} ± {se:.3}, expected {expected:.3}, by mistake {wrong:.3}");
        // Pictures cut what carries less than 1e-4 of the light.
        let bound = 5.0 * se + 2e-4 * expected + 1e-6;
        assert!((value - expected).abs() <= bound, "{name}: {value} is not {expected}");
        assert!((value - wrong).abs() > bound, "{name}: {value} is not told from {wrong}");
    }
}

fn panel_cd_m2() -> f64 {
    FLUX_LM / (std::f64::consts::PI * EDGE_M * EDGE_M)
}

/// Catches: an opening behind its own glass cover that is seen before the cover and once more behind it.
#[test]
fn an_opening_behind_its_own_cover_is_seen_once() {
    let (l, passes) = (panel_cd_m2(), glass().transmittance(1.0));
    let eye = DVec3::new(2.0, 2.0, 1.0);
    let cover = || level("cover", 3, 3.2, true);
    expect(&scene(&[cover()]), eye, DVec3::Z, l, l * (1.0 + passes));
    // A pane of the room behind the cover takes its share, once; one before it sends light back to the
    // cover, which is glass to what has been reflected.
    let between = scene(&[cover(), level("pane", 3, 3.35, false)]);
    expect(&between, eye, DVec3::Z, l * passes, l * passes * (1.0 + passes));
    let back = glass().reflectance(1.0).powi(2);
    let before = scene(&[cover(), level("pane", 3, 2.5, false)]);
    expect(&before, eye, DVec3::Z, l * passes / (1.0 - back), l * passes * (1.0 + passes));
    // A cover that is no body of the luminaire is a pane like others.
    expect(&scene(&[level("pane", 3, 3.2, false)]), eye, DVec3::Z, l * passes, l);
}

/// Catches: the same by way of a mirror of the room.
#[test]
fn a_mirror_shows_an_opening_behind_its_own_cover_once() {
    let l = panel_cd_m2();
    // From (2, 2, 1) down to the mirror at 0.5 and up to the panel.
    let shown = scene(&[level("mirror", 4, 0.5, false), level("cover", 3, 3.2, true)]);
    let (passes, back) = (glass().transmittance(1.0), glass().reflectance(1.0));
    // What the mirror has sent up, the cover sends down again like any pane.
    let expected = l * MIRROR / (1.0 - MIRROR * back);
    expect(&shown, DVec3::new(2.0, 2.0, 1.0), -DVec3::Z, expected, expected * (1.0 + passes));
}

/// Catches: a mirror in a luminaire's own body that reflects the light it lets pass, straight or by a
/// second mirror that no image covers.
#[test]
fn a_mirror_of_the_body_shows_no_image_of_its_own_lamp() {
    let l = panel_cd_m2();
    let eye = DVec3::new(2.0, 2.0, 1.0);
    expect(&scene(&[level("mirror", 4, 0.5, true)]), eye, -DVec3::Z, 0.0, l * MIRROR);
    expect(&scene(&[level("mirror", 4, 0.5, false)]), eye, -DVec3::Z, l * MIRROR, 0.0);
    // Twice: from (1.2, 2, 2.4) to the wall mirror at x = 0.5, down to the level one at z = 0.2, and up.
    let wall = || Part {
        name: "wall mirror",
        material: 4,
        corners: [[0.5, 0.5, 0.3], [0.5, 3.5, 0.3], [0.5, 3.5, 2.5], [0.5, 0.5, 2.5]],
        of_the_body: false,
    };
    let level_at = |body| Part {
        name: "level mirror",
        material: 4,
        corners: [[0.6, 0.5, 0.2], [3.5, 0.5, 0.2], [3.5, 3.5, 0.2], [0.6, 3.5, 0.2]],
        of_the_body: body,
    };
    // Unfolded, the way is 0.7 + 1.5 m long in x and 2.2 + 3.3 m in z.
    let (eye, gaze) = (DVec3::new(1.2, 2.0, 2.4), DVec3::new(-2.2, 0.0, -5.5));
    let twice = l * MIRROR * MIRROR;
    expect(&scene(&[wall(), level_at(true)]), eye, gaze, 0.0, twice);
    expect(&scene(&[wall(), level_at(false)]), eye, gaze, twice, 0.0);
}
