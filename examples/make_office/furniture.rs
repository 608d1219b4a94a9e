//! Loose furniture, each piece in its own coordinates: floor at z = 0, its user at −y looking
//! towards +y. Pieces that join reach into one another, so that no two faces lie in one plane.

use glam::DVec3;

use super::glb::Part;
use super::solid::{Shape, polygon, rectangle, ring, squircle};

/// Nothing touches what it stands on, m.
const GAP_M: f64 = 0.001;
/// Furniture at a wall is sunk this far into it: points of the wall behind it lie inside furniture.
pub const SUNK_M: f64 = 0.002;
/// Height of a desk's top, m.
const DESK_M: f64 = 0.74;

fn part(material: &'static str, shape: Shape) -> Part {
    Part { material, shape }
}

/// 1.6 × 0.8 m on four legs, with a modesty panel at the far side.
pub fn desk() -> Vec<Part> {
    let mut parts = vec![
        part("Desk", Shape::cuboid([-0.8, 0.8], [-0.4, 0.4], [DESK_M - 0.025, DESK_M])),
        part("Wood", Shape::cuboid([-0.735, 0.735], [0.345, 0.357], [0.3, 0.6])),
        part("Metal", Shape::cuboid([-0.73, 0.73], [-0.01, 0.03], [0.66, 0.718])),
    ];
    for x in [-0.75, 0.75] {
        for y in [-0.35, 0.35] {
            let leg = Shape::cuboid([x - 0.025, x + 0.025], [y - 0.025, y + 0.025], [GAP_M, 0.72]);
            parts.push(part("Metal", leg));
        }
    }
    parts
}

/// A 24-inch monitor on its stand at the far edge of a desk.
pub fn monitor() -> Vec<Part> {
    let foot = squircle(8, [0.12, 0.083], 0.6);
    let foot = |z| ring(DVec3::new(0.0, 0.305, z), DVec3::X, DVec3::Y, &foot);
    vec![
        part("Screen", Shape::cuboid([-0.265, 0.265], [0.2645, 0.269], [0.86, 1.18])),
        part("Plastic", Shape::cuboid([-0.275, 0.275], [0.27, 0.3], [0.85, 1.19])),
        part("Plastic", Shape::cuboid([-0.03, 0.03], [0.295, 0.34], [0.98, 1.04])),
        part("Plastic", Shape::lathe([0.0, 0.325], 8, &[(0.02, 0.745), (0.014, 1.0)])),
        part("Plastic", Shape::loft(&[foot(DESK_M + GAP_M), foot(0.749)])),
    ]
}

/// A flat keyboard, lower than the plane of the task area 10 mm above the desk.
pub fn keyboard() -> Vec<Part> {
    vec![
        part("Plastic", Shape::cuboid([-0.22, 0.22], [-0.25, -0.11], [DESK_M + GAP_M, 0.747])),
        part("Plastic", Shape::cuboid([-0.21, 0.21], [-0.24, -0.12], [0.746, 0.749])),
    ]
}

/// A thin stack of A4 sheets.
pub fn papers() -> Vec<Part> {
    let stack = Shape::cuboid([0.42, 0.63], [-0.3, -0.003], [DESK_M + GAP_M, 0.746]);
    vec![part("Paper", stack)]
}

/// A swivel chair with a five-star base on castors.
pub fn chair() -> Vec<Part> {
    let mut parts = Vec::new();
    for arm in 0..5 {
        let (sin, cos) = (std::f64::consts::TAU * (f64::from(arm) + 0.25) / 5.0).sin_cos();
        let outward = DVec3::new(cos, sin, 0.0);
        let across = DVec3::new(-sin, cos, 0.0);
        let section = |radius: f64, z: f64, half: [f64; 2]| {
            let centre = outward * radius + DVec3::Z * z;
            ring(centre, across, DVec3::Z, &rectangle(half[0], half[1]))
        };
        let beam = [section(0.02, 0.095, [0.024, 0.02]), section(0.3, 0.07, [0.014, 0.01])];
        parts.push(part("Metal", Shape::loft(&beam)));
        let wheel = |offset: f64| {
            let centre = outward * 0.28 + across * offset + DVec3::Z * (0.025 + GAP_M);
            ring(centre, DVec3::Z, outward, &polygon(6, 0.025))
        };
        parts.push(part("Plastic", Shape::loft(&[wheel(-0.02), wheel(0.02)])));
    }
    let column = [(0.05, 0.065), (0.045, 0.125), (0.024, 0.13), (0.024, 0.4)];
    parts.push(part("Metal", Shape::lathe([0.0, 0.0], 8, &column)));
    parts.push(part("Metal", Shape::cuboid([-0.09, 0.09], [-0.12, 0.12], [0.385, 0.435])));
    let level =
        |y: f64, z: f64, outline: &[(f64, f64)]| ring(DVec3::new(0.0, y, z), DVec3::X, DVec3::Y, outline);
    let spine =
        [(-0.105, 0.4), (-0.262, 0.5), (-0.242, 0.68)].map(|(y, z)| level(y, z, &rectangle(0.025, 0.012)));
    parts.push(part("Metal", Shape::loft(&spine)));
    let seat = [(0.86, 0.425), (1.0, 0.455), (0.97, 0.49), (0.75, 0.5)]
        .map(|(scale, z)| level(0.0, z, &squircle(16, [0.24 * scale, 0.23 * scale], 0.65)));
    parts.push(part("Fabric", Shape::loft(&seat)));
    parts.push(part("Fabric", backrest()));
    for side in [-1.0, 1.0] {
        let across = |a: f64, b: f64| if side < 0.0 { [-b, -a] } else { [a, b] };
        parts.push(part("Plastic", Shape::cuboid(across(0.22, 0.25), [-0.025, 0.025], [0.45, 0.65])));
        parts.push(part("Plastic", Shape::cuboid(across(0.2, 0.27), [-0.12, 0.14], [0.645, 0.665])));
    }
    parts
}

/// A shell curved in plan and in profile.
fn backrest() -> Shape {
    // (z, half width, y of the middle)
    let levels = [
        (0.56, 0.19, -0.235),
        (0.68, 0.215, -0.225),
        (0.8, 0.22, -0.24),
        (0.92, 0.21, -0.26),
        (1.02, 0.17, -0.29),
    ];
    let stations = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
    let rings = levels.map(|(z, half_width, middle)| {
        let face = |s: f64, thickness: f64| DVec3::new(s * half_width, middle + 0.06 * s * s + thickness, z);
        let rear = stations.iter().map(|&s| face(s, -0.015));
        let front = stations.iter().rev().map(|&s| face(s, 0.015));
        rear.chain(front).collect::<Vec<_>>()
    });
    Shape::loft(&rings)
}

/// A cupboard with two doors, its back at y = 0 in the wall.
pub fn cabinet() -> Vec<Part> {
    let mut parts = vec![part("Wood", Shape::cuboid([-0.4, 0.4], [-0.4, SUNK_M], [GAP_M, 1.2]))];
    for side in [-1.0, 1.0] {
        let across = |a: f64, b: f64| if side < 0.0 { [-b, -a] } else { [a, b] };
        parts.push(part("Wood", Shape::cuboid(across(0.001, 0.395), [-0.42, -0.401], [0.03, 1.19])));
        parts.push(part("Metal", Shape::cuboid(across(0.03, 0.042), [-0.44, -0.415], [0.6, 0.75])));
    }
    parts
}

/// Heights of the shelf's boards that carry books, m.
pub const BOOK_BOARDS_M: [f64; 4] = [0.45, 0.84, 1.23, 1.62];

/// A shelf unit, its back at y = 0 in the wall.
pub fn shelf() -> Vec<Part> {
    let mut parts =
        vec![part("Wood", Shape::cuboid([-0.483, 0.483], [-0.012, SUNK_M - 0.0002], [0.05, 1.985]))];
    for x in [[-0.5, -0.48], [0.48, 0.5]] {
        parts.push(part("Wood", Shape::cuboid(x, [-0.33, SUNK_M], [GAP_M, 2.0])));
    }
    for z in [0.06].into_iter().chain(BOOK_BOARDS_M).chain([1.99]) {
        parts.push(part("Wood", Shape::cuboid([-0.485, 0.485], [-0.325, -0.006], [z - 0.02, z])));
    }
    parts
}

/// A row of books on a board at z = 0 of the shelf.
pub fn books() -> Vec<Part> {
    // (thickness, depth, height)
    let sizes = [
        (0.032, 0.19, 0.245),
        (0.021, 0.16, 0.215),
        (0.045, 0.22, 0.29),
        (0.028, 0.17, 0.23),
        (0.038, 0.21, 0.265),
        (0.024, 0.18, 0.24),
    ];
    let mut left = -0.4;
    sizes
        .map(|(thickness, depth, height)| {
            let x = [left, left + thickness];
            left += thickness + GAP_M;
            let book = Shape::cuboid(x, [-0.05 - depth, -0.05], [GAP_M, height]);
            part("Paper", book)
        })
        .into()
}

/// An open waste bin.
pub fn bin() -> Vec<Part> {
    let profile = [(0.11, GAP_M), (0.14, 0.32), (0.135, 0.32), (0.106, 0.006)];
    vec![part("Metal", Shape::lathe([0.0, 0.0], 12, &profile))]
}

/// A pot with eight long leaves.
pub fn plant() -> Vec<Part> {
    let profile = [(0.12, GAP_M), (0.16, 0.32), (0.145, 0.32), (0.135, 0.27)];
    let mut parts = vec![part("Pot", Shape::lathe([0.0, 0.0], 12, &profile))];
    for leaf in 0..8 {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(leaf) / 8.0).sin_cos();
        let outward = DVec3::new(cos, sin, 0.0);
        let across = DVec3::new(-sin, cos, 0.0);
        let tall = if leaf % 2 == 0 { 1.0 } else { 0.8 };
        let blade =
            [(0.05, 0.26, 0.008), (0.13, 0.26 + 0.45 * tall, 0.035), (0.26, 0.26 + 0.7 * tall, 0.004)].map(
                |(radius, z, half_width)| {
                    let centre = outward * radius + DVec3::Z * z;
                    ring(centre, outward, across, &rectangle(0.003, half_width))
                },
            );
        parts.push(part("Leaf", Shape::loft(&blade)));
    }
    parts
}
