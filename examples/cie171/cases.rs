//! The families' scenes, formulas and answers.

use std::f64::consts::PI;

use gershun::estimate::Estimate;
use gershun::geometry::mesh::Mesh;
use gershun::luminaire::Luminaire;
use gershun::material::{Bsdf, Material, Pane};
use gershun::photometry::{IntensityDistribution, Opening};
use gershun::query::{Demand, Receiver};
use gershun::scene::Scene;
use gershun::solve::{Effort, Method, PARTS, Part, Sheet};
use gershun::units::Lumens;
use glam::DVec3;

use crate::Line;
use crate::common::{lambert, lamp, planar, point_lamp, room, sheets};
use crate::factors::{Rect, parallel, perpendicular, shadow};
use crate::section6;

pub fn all() -> Vec<Line> {
    let families = [
        points(),
        areas(),
        flux(),
        glass(),
        reflection(),
        obstruction(),
        cube(),
        section6::mirror(),
        two_panes(),
        section6::leak(),
        section6::symmetry(),
    ];
    families.into_iter().flatten().collect()
}

pub fn solve(scene: &Scene, receivers: Vec<Receiver>, effort: Effort, blocks: u64) -> Vec<Sheet> {
    sheets(scene, &Demand { receivers, ..Demand::default() }, Method::Links, effort, 1, blocks)
}

/// One row of a scene with one channel; `parts` summed.
pub fn row(sheets: &[Sheet], row: usize, parts: &[Part]) -> Estimate {
    let value = |sheet: &Sheet| parts.iter().map(|part| sheet.values[row * PARTS + *part as usize]).sum();
    let blocks: Vec<f64> = sheets.iter().map(value).collect();
    // Equal blocks leave rounding as their scatter, which is no error.
    let estimate = Estimate::from_blocks(&blocks);
    if estimate.se <= 1e-12 * estimate.value.abs() { Estimate { se: 0.0, ..estimate } } else { estimate }
}

pub const ALL: [Part; 3] = [Part::Direct, Part::Image, Part::Indirect];

pub fn quick() -> Effort {
    Effort { gather: 1, walks: 1, links: 1, ..Effort::default() }
}

/// A quadrilateral sheet; corners counter-clockwise seen from its front.
pub fn sheet(mesh: &mut Mesh, name: &str, material: usize, corners: [[f64; 3]; 4]) {
    let surface = mesh.add_surface(name, material, false);
    mesh.add_quad(corners.map(DVec3::from_array), surface);
}

fn horizontal(mesh: &mut Mesh, name: &str, material: usize, x: [f64; 2], y: [f64; 2], z: f64) {
    sheet(mesh, name, material, [[x[0], y[0], z], [x[1], y[0], z], [x[1], y[1], z], [x[0], y[1], z]]);
}

pub fn scene(mesh: Mesh, materials: Vec<Material>, lamps: Vec<Luminaire>) -> Scene {
    Scene::new(mesh, materials, lamps).expect("the scene is valid")
}

fn floor() -> Mesh {
    let mut mesh = Mesh::default();
    horizontal(&mut mesh, "Floor", 0, [0.0, 4.0], [0.0, 4.0], 0.0);
    mesh
}

/// Name, distribution and the same as a formula of γ in radians, cd.
type PointSource = (&'static str, IntensityDistribution, fn(f64) -> f64);

fn points() -> Vec<Line> {
    let gammas: Vec<f64> = (0..=18).map(|k| 5.0 * f64::from(k)).collect();
    let plane: Vec<f64> = gammas.iter().map(|g| 1000.0 * g.to_radians().cos().max(0.0).powi(3)).collect();
    let table = IntensityDistribution::from_grid(vec![0.0, 360.0], gammas, vec![plane.clone(), plane])
        .expect("the table is valid");
    let at = DVec3::new(0.0, 0.0, 3.0);
    let mut lines = Vec::new();
    let sources: [PointSource; 3] = [
        ("isotropic", IntensityDistribution::isotropic(Lumens(4000.0 * PI)), |_| 1000.0),
        ("Lambertian", IntensityDistribution::lambert(Lumens(1000.0 * PI)), |g| 1000.0 * g.cos()),
        ("cos³ table", table, |g| 1000.0 * g.cos().powi(3)),
    ];
    for (name, distribution, intensity) in sources {
        let scene = scene(floor(), vec![lambert("black", 0.0)], vec![lamp(distribution, Opening::Point, at)]);
        // At nodes of the table, so that its interpolation plays no part.
        let places: Vec<(String, DVec3, DVec3, f64)> = [0.0f64, 15.0, 30.0, 45.0, 60.0]
            .into_iter()
            .flat_map(|degrees| {
                let gamma = degrees.to_radians();
                let r = 3.0 * gamma.tan() / 2f64.sqrt();
                let on_floor = DVec3::new(r, r, 0.0);
                let wall = DVec3::new(r, 0.0, 3.0 - r / gamma.tan().max(1e-9));
                let mut places = vec![(format!("floor, γ {degrees}°"), on_floor, DVec3::Z, gamma)];
                if degrees > 20.0 {
                    places.push((format!("upright, γ {degrees}°"), wall, DVec3::NEG_X, gamma));
                }
                places
            })
            .collect();
        let receivers = places.iter().map(|(_, p, n, _)| planar(*p, *n)).collect();
        let sheets = solve(&scene, receivers, quick(), 4);
        for (index, (place, point, normal, gamma)) in places.into_iter().enumerate() {
            let towards = at - point;
            let expected = intensity(gamma) * normal.dot(towards.normalize()) / towards.length_squared();
            let what = format!("{name}, {place}, lx");
            lines.push(Line { family: "5.2", what, expected, found: row(&sheets, index, &ALL) });
        }
    }
    lines
}

fn areas() -> Vec<Line> {
    let mut lines = Vec::new();
    for [a, b] in [[1.0, 1.0], [2.0, 0.5]] {
        let luminance = 1000.0;
        let opening = Opening::Rect { length_m: a, width_m: b, side_x_m: 0.0, side_y_m: 0.0 };
        let distribution = IntensityDistribution::lambert(Lumens(PI * luminance * a * b));
        let mut mesh = Mesh::default();
        horizontal(&mut mesh, "Floor", 0, [-5.0, 5.0], [-5.0, 5.0], -0.001);
        let lamps = vec![lamp(distribution, opening, DVec3::new(0.0, 0.0, 2.0))];
        let scene = scene(mesh, vec![lambert("black", 0.0)], lamps);
        let asides = [0.0, 0.5, 1.0, 2.0, 4.0];
        let up = asides.map(|x| planar(DVec3::new(x, 0.3, 0.0), DVec3::Z));
        let across = asides.map(|x| planar(DVec3::new(x, 0.3, 0.0), DVec3::NEG_X));
        let sheets = solve(&scene, up.into_iter().chain(across).collect(), quick(), 64);
        for (index, x) in asides.into_iter().enumerate() {
            let v = [-b / 2.0 - 0.3, b / 2.0 - 0.3];
            let rect = Rect { u: [x - a / 2.0, x + a / 2.0], v, distance_m: 2.0 };
            let above = Rect { u: [rect.u[0].max(0.0), rect.u[1]], ..rect };
            for (offset, facing, factor) in
                [(0, "up", parallel(&rect)), (asides.len(), "sideways", perpendicular(&above))]
            {
                let what = format!("{a} × {b} m, {x} m aside, facing {facing}, lx");
                let expected = PI * luminance * factor;
                lines.push(Line { family: "5.3", what, expected, found: row(&sheets, index + offset, &ALL) });
            }
        }
    }
    lines
}

/// Solid angle of a rectangle from the foot's distance d: corners are atan(uv/(d r)).
fn solid_angle(u: [f64; 2], v: [f64; 2], d: f64) -> f64 {
    let corner = |u: f64, v: f64| (u * v / (d * (u * u + v * v + d * d).sqrt())).atan();
    corner(u[1], v[1]) - corner(u[0], v[1]) - corner(u[1], v[0]) + corner(u[0], v[0])
}

fn tally(scene: &Scene, particles: u32, blocks: u64) -> Vec<Sheet> {
    let demand = Demand { flux: true, ..Demand::default() };
    let effort = Effort { particles, ..quick() };
    sheets(scene, &demand, Method::Path, effort, 1, blocks)
}

fn of_flux(sheets: &[Sheet], value: impl Fn(&gershun::solve::FluxSheet) -> f64) -> Estimate {
    let blocks: Vec<f64> =
        sheets.iter().map(|sheet| value(sheet.flux.as_ref().expect("the flux was asked for"))).collect();
    let estimate = Estimate::from_blocks(&blocks);
    if estimate.se <= 1e-12 * estimate.value.abs() { Estimate { se: 0.0, ..estimate } } else { estimate }
}

fn flux() -> Vec<Line> {
    let (size, at, lm) = (DVec3::new(4.0, 3.0, 2.8), DVec3::new(1.0, 1.0, 2.0), 1000.0);
    let scene = scene(room(size), vec![lambert("black", 0.0); 3], vec![point_lamp(lm, at)]);
    let sheets = tally(&scene, 16_384, 64);
    let (x, y, z) = ([-at.x, size.x - at.x], [-at.y, size.y - at.y], [-at.z, size.z - at.z]);
    let faces = [
        ("Floor", solid_angle(x, y, at.z)),
        ("Ceiling", solid_angle(x, y, size.z - at.z)),
        ("Wall_S", solid_angle(x, z, at.y)),
        ("Wall_N", solid_angle(x, z, size.y - at.y)),
        ("Wall_W", solid_angle(y, z, at.x)),
        ("Wall_E", solid_angle(y, z, size.x - at.x)),
    ];
    let mut lines: Vec<Line> = faces
        .into_iter()
        .map(|(name, solid_angle)| {
            let index = scene.mesh.surfaces.iter().position(|s| s.name == name).expect("it is there");
            let expected = lm * solid_angle / (4.0 * PI);
            let found = of_flux(&sheets, |flux| flux.incident[index]);
            Line { family: "5.4", what: format!("{name}, lm"), expected, found }
        })
        .collect();
    let found = of_flux(&sheets, |flux| flux.absorbed.iter().sum::<f64>() + flux.escaped[0]);
    lines.push(Line { family: "5.4", what: "all faces, lm".into(), expected: lm, found });
    lines
}

/// Transmittance of a pane by Fresnel's equations, written independently of the library: both
/// polarisations, all inner reflections, absorption exp(−α · way).
fn transmittance(normal: f64, degrees: f64) -> f64 {
    let index = 1.52;
    let theta = degrees.to_radians();
    let inside = (theta.sin() / index).asin();
    let pane = |theta: f64, inside: f64, depth: f64| {
        let way = (-depth / inside.cos()).exp();
        let [s, p] = if theta > 1e-9 {
            let s = (theta - inside).sin() / (theta + inside).sin();
            let p = (theta - inside).tan() / (theta + inside).tan();
            [s * s, p * p]
        } else {
            [((index - 1.0) / (index + 1.0)).powi(2); 2]
        };
        let through = |r: f64| (1.0 - r).powi(2) * way / (1.0 - (r * way).powi(2));
        0.5 * (through(s) + through(p))
    };
    // The depth that gives the normal transmittance, by bisection.
    let (mut low, mut high) = (0.0, 5.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if pane(0.0, 0.0, middle) > normal { low = middle } else { high = middle }
    }
    pane(theta, inside, low)
}

fn behind_panes(family: &'static str, panes: u8, angles: &[f64]) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut mesh = Mesh::default();
    for k in 0..panes {
        horizontal(&mut mesh, "Pane", 0, [-50.0, 50.0], [-50.0, 50.0], 1.0 + 0.2 * f64::from(k));
    }
    horizontal(&mut mesh, "Black", 1, [-60.0, 60.0], [-60.0, 60.0], -1.0);
    let materials =
        vec![Material { name: "pane".into(), bsdf: Bsdf::Glass(Pane::new(0.88)) }, lambert("black", 0.0)];
    let at = DVec3::new(0.0, 0.0, 2.0);
    let scene = scene(mesh, materials, vec![point_lamp(4000.0 * PI, at)]);
    let place = |degrees: f64| DVec3::new(2.0 * degrees.to_radians().tan(), 0.0, 0.0);
    let receivers = angles.iter().map(|&a| planar(place(a), (at - place(a)).normalize())).collect();
    let sheets = solve(&scene, receivers, quick(), 64);
    for (index, &degrees) in angles.iter().enumerate() {
        let free = 1000.0 / at.distance_squared(place(degrees));
        let direct = row(&sheets, index, &[Part::Direct]);
        let found = Estimate { value: direct.value / free, se: direct.se / free, ..direct };
        let expected = transmittance(0.88, degrees).powi(i32::from(panes));
        lines.push(Line { family, what: format!("E/E₀ at {degrees}°"), expected, found });
    }
    lines
}

fn glass() -> Vec<Line> {
    behind_panes("5.5", 1, &[0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 85.0])
}

fn two_panes() -> Vec<Line> {
    behind_panes("6, double", 2, &[0.0, 30.0, 45.0, 60.0])
}

/// Receivers beside a square of half width `half` on the floor: facing down above it, and upright
/// at its edge facing it; with the rectangle as each sees it.
fn beside(half: f64) -> Vec<(String, Receiver, Rect, bool)> {
    let mut places = Vec::new();
    for [x, y, z] in [[0.0, 0.0, 1.0], [0.0, 0.0, 3.0], [1.0, 1.5, 2.0], [3.0, 0.0, 1.0]] {
        let rect = Rect { u: [-half - x, half - x], v: [-half - y, half - y], distance_m: z };
        let receiver = planar(DVec3::new(x, y, z), DVec3::NEG_Z);
        places.push((format!("facing down at ({x}, {y}, {z})"), receiver, rect, true));
    }
    for [y, z] in [[0.0, 0.5], [0.0, 2.0], [1.0, 1.0], [2.5, 3.0]] {
        let x = -half - 0.2;
        let rect = Rect { u: [0.2, 0.2 + 2.0 * half], v: [-half - y, half - y], distance_m: z };
        let receiver = planar(DVec3::new(x, y, z), DVec3::X);
        places.push((format!("upright at ({x}, {y}, {z})"), receiver, rect, false));
    }
    places
}

fn reflection() -> Vec<Line> {
    let mut lines = Vec::new();
    for half in [2.0, 0.25] {
        let mut mesh = Mesh::default();
        horizontal(&mut mesh, "S2", 0, [-half, half], [-half, half], 0.0);
        let height = 400.0;
        let lamps = vec![point_lamp(4.0 * PI * 1e6, DVec3::new(0.0, 0.0, height))];
        let scene = scene(mesh, vec![lambert("S2", 0.8)], lamps);
        let places = beside(half);
        let receivers = places.iter().map(|(_, receiver, ..)| receiver.clone()).collect();
        let effort = Effort { gather: 256, walks: 16, ..Effort::default() };
        let sheets = solve(&scene, receivers, effort, 512);
        for (index, (place, _, rect, down)) in places.into_iter().enumerate() {
            let factor = if down { parallel(&rect) } else { perpendicular(&rect) };
            let what = format!("{} m, {place}, lx", 2.0 * half);
            let expected = 0.8 * 1e6 / (height * height) * factor;
            lines.push(Line { family: "5.6", what, expected, found: row(&sheets, index, &[Part::Indirect]) });
        }
    }
    lines
}

fn obstruction() -> Vec<Line> {
    let mut mesh = Mesh::default();
    horizontal(&mut mesh, "S2", 0, [-2.0, 2.0], [-2.0, 2.0], 0.0);
    horizontal(&mut mesh, "Plate", 1, [-0.5, 1.5], [-1.0, 0.5], 0.3);
    let shining = Bsdf::Emitter { luminance_cd_m2: 100.0, reflectance: 0.0 };
    let materials = vec![Material { name: "S2".into(), bsdf: shining }, lambert("black", 0.0)];
    let scene = scene(mesh, materials, Vec::new());
    let places = beside(2.0);
    let receivers = places.iter().map(|(_, receiver, ..)| receiver.clone()).collect();
    let sheets = solve(&scene, receivers, Effort { gather: 256, walks: 1, ..Effort::default() }, 256);
    let mut lines = Vec::new();
    for (index, (place, receiver, rect, down)) in places.into_iter().enumerate() {
        let p = receiver.point;
        let x = if down { [-0.5 - p.x, 1.5 - p.x] } else { [(-0.5 - p.x).max(0.0), 1.5 - p.x] };
        let plate = Rect { u: x, v: [-1.0 - p.y, 0.5 - p.y], distance_m: p.z - 0.3 };
        let hidden = shadow(&rect, &plate);
        let factor = |rect: &Rect| if down { parallel(rect) } else { perpendicular(rect) };
        let expected = PI * 100.0 * (factor(&rect) - factor(&hidden));
        lines.push(Line {
            family: "5.7",
            what: format!("{place}, lx"),
            expected,
            found: row(&sheets, index, &ALL),
        });
    }
    lines
}

fn cube() -> Vec<Line> {
    let lm = 10_000.0;
    let mut lines = Vec::new();
    for rho in [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95] {
        let lamps = vec![point_lamp(lm, DVec3::splat(2.0))];
        let scene = scene(room(DVec3::splat(4.0)), vec![lambert("wall", rho); 3], lamps);
        let sheets = tally(&scene, 4096, 64);
        let incident = of_flux(&sheets, |flux| flux.incident.iter().sum::<f64>());
        let found = Estimate { value: (incident.value - lm) / 96.0, se: incident.se / 96.0, ..incident };
        let expected = rho * lm / (96.0 * (1.0 - rho));
        lines.push(Line { family: "5.8", what: format!("ρ {rho}, lx"), expected, found });
    }
    lines
}
