//! What must hold for a model before it may be written: closed solids, nothing outside, no two
//! faces in one plane, no way out for light.

use std::collections::HashMap;

use glam::DVec3;

use super::furniture::SUNK_M;
use super::glb::Model;
use super::room::{CORRIDOR_M, ROOM_M};
use super::solid::Shape;

/// All faults in words; empty for a sound model.
pub fn faults(model: &Model) -> Vec<String> {
    let mut faults = Vec::new();
    for mesh in &model.meshes {
        for (index, part) in mesh.parts.iter().enumerate() {
            if let Some(fault) = not_solid(&part.shape) {
                faults.push(format!("{} part {index}: {fault}", mesh.name));
            }
        }
    }
    let triangles = model.triangles();
    for (node, corners) in &triangles {
        let name = &model.nodes[*node].name;
        let (low, high) = allowed(name);
        for p in corners {
            if p.cmplt(low - 1e-9).any() || p.cmpgt(high + 1e-9).any() {
                faults.push(format!("{name} pokes out at {p}"));
            }
        }
    }
    for (index, (node, a)) in triangles.iter().enumerate() {
        for (other, b) in &triangles[index + 1..] {
            if coplanar_overlap(a, b) {
                let names = [node, other].map(|&node| &model.nodes[node].name);
                let (at, with) = (a[0], b[0]);
                faults.push(format!("{names:?} share a plane near {at} and {with}"));
            }
        }
    }
    faults.extend(leaks(&triangles));
    faults
}

/// Closed: each directed edge occurs once and its reverse once; outward: the enclosed volume is positive.
fn not_solid(shape: &Shape) -> Option<String> {
    if !shape.closed {
        return None;
    }
    let mut edges: HashMap<(u32, u32), usize> = HashMap::new();
    for &[a, b, c] in &shape.triangles {
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    let closed = edges.iter().all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1));
    if !closed {
        return Some("an edge is not shared by two opposite triangles".into());
    }
    let corner = |v: u32| shape.vertices[v as usize];
    let volume_m3: f64 =
        shape.triangles.iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c))) / 6.0).sum();
    let thin = shape.triangles.iter().any(|&[a, b, c]| {
        let cross = (corner(b) - corner(a)).cross(corner(c) - corner(a));
        0.5 * cross.length() < 1e-8
    });
    if thin {
        return Some("a triangle is degenerate".into());
    }
    (volume_m3 <= 0.0).then(|| format!("volume {volume_m3} m³: normals point inwards"))
}

/// The box in which a node must stay.
fn allowed(name: &str) -> (DVec3, DVec3) {
    if name.starts_with("Corridor_") {
        let high = ROOM_M + DVec3::X * CORRIDOR_M;
        (DVec3::X * ROOM_M.x, high)
    } else if name.starts_with("Door_") {
        (DVec3::new(-0.08, 0.37, -0.02), DVec3::new(0.04, 1.43, 2.13))
    } else if name == "Partition_Frame" {
        (DVec3::new(7.97, 0.0, 0.0), DVec3::new(8.03, 5.0, 2.8))
    } else {
        (DVec3::ZERO, ROOM_M + DVec3::Y * SUNK_M)
    }
}

/// Whether two triangles overlap by more than 0.1 mm in one plane (within 0.05 mm).
fn coplanar_overlap(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    let normal = |t: &[DVec3; 3]| (t[1] - t[0]).cross(t[2] - t[0]).normalize();
    let n = normal(a);
    if b.iter().any(|&p| n.dot(p - a[0]).abs() > 5e-5) || n.cross(normal(b)).length() > 1e-3 {
        return false;
    }
    let separated = |t: &[DVec3; 3]| {
        (0..3).any(|k| {
            let axis = n.cross(t[(k + 1) % 3] - t[k]).normalize();
            let span = |t: &[DVec3; 3]| {
                let along = t.map(|p| axis.dot(p));
                (
                    along.into_iter().fold(f64::INFINITY, f64::min),
                    along.into_iter().fold(f64::NEG_INFINITY, f64::max),
                )
            };
            let ((a0, a1), (b0, b1)) = (span(a), span(b));
            a1.min(b1) - a0.max(b0) < 1e-4
        })
    };
    !separated(a) && !separated(b)
}

/// Rays from the room and from the corridor that meet nothing.
fn leaks(triangles: &[(usize, [DVec3; 3])]) -> Vec<String> {
    let eyes = [
        DVec3::new(0.713, 0.937, 1.131),
        DVec3::new(3.917, 1.013, 1.559),
        DVec3::new(7.331, 2.877, 0.621),
        DVec3::new(8.771, 2.713, 1.377),
    ];
    let rays = 2000;
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let mut leaks = Vec::new();
    for eye in eyes {
        for k in 0..rays {
            // Fibonacci sphere
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(rays);
            let (sin, cos) = (golden * f64::from(k)).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let direction = DVec3::new(radius * cos, radius * sin, z);
            if !triangles.iter().any(|(_, t)| hit(eye, direction, t)) {
                leaks.push(format!("light escapes from {eye} towards {direction}"));
            }
        }
    }
    leaks
}

/// Möller and Trumbore's test.
fn hit(origin: DVec3, direction: DVec3, t: &[DVec3; 3]) -> bool {
    let (e1, e2) = (t[1] - t[0], t[2] - t[0]);
    let p = direction.cross(e2);
    let determinant = e1.dot(p);
    if determinant.abs() < 1e-12 {
        return false;
    }
    let s = origin - t[0];
    let u = s.dot(p) / determinant;
    let q = s.cross(e1);
    let v = direction.dot(q) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && e2.dot(q) / determinant > 0.0
}
