//! Shapes from which the office is built. A solid is always a loft of rings, so that it is closed
//! and its normals point outwards by construction; sheets (walls, panes) are open.

use glam::DVec3;

/// A triangle mesh with shared vertices; coordinates are whole hundredths of a millimetre, so that
/// the last bits of `sin` on another machine do not change the file.
#[derive(Clone, Debug)]
pub struct Shape {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Closed solid, or open sheet.
    pub closed: bool,
}

impl Shape {
    /// The solid between the first and the last ring. Rings have the same even number of corners
    /// and run counter-clockwise seen from the last ring's end.
    pub fn loft(rings: &[Vec<DVec3>]) -> Self {
        let n = rings[0].len() as u32;
        assert!(n.is_multiple_of(2), "caps pair corner i with corner n−1−i");
        let mut triangles = Vec::new();
        for ring in 1..rings.len() as u32 {
            join(&mut triangles, (ring - 1) * n, ring * n, n);
        }
        let top = (rings.len() as u32 - 1) * n;
        for i in 0..n / 2 - 1 {
            let [a, b, c, d] = [i, i + 1, n - 2 - i, n - 1 - i];
            triangles.extend([[a, c, b], [a, d, c]]);
            triangles.extend([[a, b, c], [a, c, d]].map(|t| t.map(|v| v + top)));
        }
        Self::new(rings.concat(), triangles, true)
    }

    /// A closed hoop: the last ring is joined to the first.
    pub fn hoop(rings: &[Vec<DVec3>]) -> Self {
        let n = rings[0].len() as u32;
        let count = rings.len() as u32;
        let mut triangles = Vec::new();
        for ring in 0..count {
            join(&mut triangles, ring * n, (ring + 1) % count * n, n);
        }
        Self::new(rings.concat(), triangles, true)
    }

    /// A box with edges along the axes.
    pub fn cuboid(x: [f64; 2], y: [f64; 2], z: [f64; 2]) -> Self {
        Self::loft(&z.map(|z| {
            [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])]
                .map(|(x, y)| DVec3::new(x, y, z))
                .to_vec()
        }))
    }

    /// Surface of revolution about the z axis through (x, y), from (radius, z) pairs.
    pub fn lathe(centre: [f64; 2], sides: usize, profile: &[(f64, f64)]) -> Self {
        let rings: Vec<_> = profile
            .iter()
            .map(|&(radius, z)| {
                let centre = DVec3::new(centre[0], centre[1], z);
                ring(centre, DVec3::X, DVec3::Y, &polygon(sides, radius))
            })
            .collect();
        Self::loft(&rings)
    }

    /// An open sheet of rectangular cells `us` × `vs` without the cell `hole`; its front faces u × v.
    pub fn sheet(
        origin: DVec3,
        u: DVec3,
        v: DVec3,
        us: &[f64],
        vs: &[f64],
        hole: Option<[usize; 2]>,
    ) -> Self {
        let vertices = vs.iter().flat_map(|&b| us.iter().map(move |&a| origin + u * a + v * b)).collect();
        let columns = us.len();
        let mut triangles = Vec::new();
        for row in 0..vs.len() - 1 {
            for column in 0..columns - 1 {
                if hole != Some([column, row]) {
                    let a = row * columns + column;
                    let [a, b, c, d] = [a, a + 1, a + columns + 1, a + columns].map(|index| index as u32);
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        Self::new(vertices, triangles, false)
    }

    fn new(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>, closed: bool) -> Self {
        let vertices = vertices.into_iter().map(|p| (p * 1e5).round() / 1e5).collect();
        Self { vertices, triangles, closed }
    }
}

/// Side faces between two rings of `n` corners.
fn join(triangles: &mut Vec<[u32; 3]>, low: u32, high: u32, n: u32) {
    for k in 0..n {
        let next = (k + 1) % n;
        let [a, b, c, d] = [low + k, low + next, high + next, high + k];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
}

/// A ring in the plane of `e1` and `e2`; the loft runs towards e1 × e2.
pub fn ring(centre: DVec3, e1: DVec3, e2: DVec3, outline: &[(f64, f64)]) -> Vec<DVec3> {
    outline.iter().map(|&(a, b)| centre + e1 * a + e2 * b).collect()
}

/// Corners of a regular polygon, the first on the first axis.
pub fn polygon(sides: usize, radius: f64) -> Vec<(f64, f64)> {
    squircle(sides, [radius, radius], 1.0)
}

/// Corners on a superellipse with the half axes `half`; exponent 1 is an ellipse, 0.5 a rounded rectangle.
pub fn squircle(sides: usize, half: [f64; 2], exponent: f64) -> Vec<(f64, f64)> {
    let flatten = |t: f64| t.signum() * t.abs().powf(exponent);
    (0..sides)
        .map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
            (half[0] * flatten(cos), half[1] * flatten(sin))
        })
        .collect()
}

/// Corners of a rectangle with the half edges `a` and `b`.
pub fn rectangle(a: f64, b: f64) -> Vec<(f64, f64)> {
    vec![(-a, -b), (a, -b), (a, b), (-a, b)]
}
