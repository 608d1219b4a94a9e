//! Watertightness, self-hits, and the same hits at every SIMD level.

use super::*;

fn lambert() -> Vec<Material> {
    vec![Material { name: "grey".into(), bsdf: Bsdf::Lambert { reflectance: 0.5 } }]
}

fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// A closed box with `cells`² quads a wall, turned about an odd axis and shifted by `shift`.
fn closed_box(cells: usize, shift: DVec3) -> (Mesh, DVec3) {
    let turn = glam::DMat3::from_axis_angle(DVec3::new(0.3, -0.5, 0.8).normalize(), 0.7);
    let mut mesh = Mesh::default();
    let surface = mesh.add_surface("box", 0, false);
    let n = cells as u32 + 1;
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0.0), (axis, 1.0)]) {
        let first = mesh.positions.len() as u32;
        for i in 0..n {
            for j in 0..n {
                let mut p = [0.0; 3];
                p[axis] = side;
                p[(axis + 1) % 3] = f64::from(i) / cells as f64;
                p[(axis + 2) % 3] = f64::from(j) / cells as f64;
                mesh.positions.push(turn * DVec3::from_array(p) + shift);
            }
        }
        for i in 0..cells as u32 {
            for j in 0..cells as u32 {
                let a = first + i * n + j;
                for vertices in [[a, a + n, a + n + 1], [a, a + n + 1, a + 1]] {
                    mesh.triangles.push(super::super::mesh::Triangle { vertices, surface });
                }
            }
        }
    }
    (mesh, turn * DVec3::splat(0.5) + shift)
}

#[test]
fn no_ray_leaves_a_closed_box_even_along_edges_and_far_from_the_origin() {
    for shift in [DVec3::ZERO, DVec3::new(1000.0, -2000.0, 30.0)] {
        let (mesh, centre) = closed_box(7, shift);
        let tracer = Tracer::build(&mesh, &lambert());
        let mut state = 1;
        let mut missed = 0;
        for index in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(index);
            for (p, q) in [(a, b), (b, c), (c, a), (a, a)] {
                for _ in 0..20 {
                    let target = p.lerp(q, random(&mut state));
                    missed += i32::from(tracer.closest(centre, (target - centre).normalize(), &[]).is_none());
                }
            }
        }
        assert_eq!(missed, 0, "rays aimed at edges and vertices must not leak, shift {shift}");
    }
}

#[test]
fn a_lifted_origin_neither_hits_its_own_surface_nor_leaves() {
    let (mesh, _) = closed_box(3, DVec3::new(1e3, 1e3, 0.0));
    let tracer = Tracer::build(&mesh, &lambert());
    let mut state = 7;
    let centre = mesh.positions.iter().sum::<DVec3>() / mesh.positions.len() as f64;
    for index in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(index);
        for _ in 0..200 {
            let (u, v) = (random(&mut state), random(&mut state));
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let inward = tracer.normal(index as u32) * (centre - a).dot(tracer.normal(index as u32)).signum();
            let origin = a + (b - a) * u + (c - a) * v + inward * tracer.offset_m();
            let direction =
                DVec3::new(random(&mut state) - 0.5, random(&mut state) - 0.5, random(&mut state) - 0.5)
                    .normalize();
            let direction = direction * direction.dot(inward).signum();
            let hit = tracer.closest(origin, direction, &[]).expect("a closed box");
            assert_ne!(hit.triangle as usize, index);
        }
    }
}

#[test]
fn simd_level_and_visiting_order_do_not_change_any_hit() {
    let mut mesh = Mesh::default();
    let surface = mesh.add_surface("soup", 0, false);
    let mut state = 3;
    let mut point = || DVec3::new(random(&mut state), random(&mut state), random(&mut state));
    for _ in 0..3000 {
        let corner = point();
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([corner, corner + 0.1 * point(), corner + 0.1 * point()]);
        mesh.triangles
            .push(super::super::mesh::Triangle { vertices: [first, first + 1, first + 2], surface });
    }
    let fast = Tracer::build_with(&mesh, &lambert(), Simd::Detect);
    let plain = Tracer::build_with(&mesh, &lambert(), Simd::Off);
    for _ in 0..5000 {
        let (origin, aim) = (point(), point());
        let direction = (aim - origin).normalize();
        let hit = fast.closest(origin, direction, &[]);
        assert_eq!(hit, plain.closest(origin, direction, &[]));
        // Brute force over all triangles: the hierarchy must not lose a hit.
        let ray = prepare(origin, fast.centre, direction);
        let nearest = (0..3000u32)
            .filter_map(|id| {
                let (t, _, _, ok) = meet(&Pack::new(&mesh, &[id]), &ray);
                ok[0].then_some(t[0])
            })
            .fold(f64::INFINITY, f64::min);
        assert_eq!(hit.map_or(f64::INFINITY, |h| h.distance_m).to_bits(), nearest.to_bits());
        let open = fast.transmittance(origin, direction, 0.5, &[]);
        assert_eq!(open.to_bits(), plain.transmittance(origin, direction, 0.5, &[]).to_bits());
        assert_eq!(open < 0.5, nearest < 0.5);
    }
}

/// Catches: a shaft called clear in which something stands.
#[test]
fn what_is_called_clear_lets_every_ray_pass() {
    let mut state = 5;
    let mut point = |edge: f64| edge * DVec3::from_array([(); 3].map(|()| random(&mut state) - 0.5));
    let mut mesh = Mesh::default();
    let surface = mesh.add_surface("shards", 0, false);
    for _ in 0..300 {
        let at = point(10.0);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([at, at + point(0.4), at + point(0.4)]);
        mesh.triangles
            .push(super::super::mesh::Triangle { vertices: [first, first + 1, first + 2], surface });
    }
    let tracer = Tracer::build(&mesh, &lambert());
    let (mut clear, mut hidden_behind_twins) = (0, 0);
    for _ in 0..3000 {
        let (a, b) = (point(8.0), point(8.0));
        let from: Vec<DVec3> = (0..4).map(|_| a + point(0.3)).collect();
        let to: Vec<DVec3> = (0..4).map(|_| b + point(0.8)).collect();
        let blocked = || {
            let blocks = |p: &DVec3, q: &DVec3| {
                tracer.transmittance(*p, (*q - *p).normalize(), p.distance(*q), &[]) < 1.0
            };
            from.iter().any(|p| to.iter().any(|q| blocks(p, q)))
        };
        if tracer.is_clear(&from, &to, &[b - a], &[]) {
            clear += 1;
            assert!(!blocked(), "a ray from {a} to {b} is blocked");
        }
        // Broken twin: a shaft to the first point only.
        hidden_behind_twins += i32::from(tracer.is_clear(&from, &to[..1], &[b - a], &[]) && blocked());
    }
    assert!(clear > 300 && hidden_behind_twins > 5, "{clear} {hidden_behind_twins}");
}
