//! Octahedral map of the hemisphere: |x| + |y| + z = 1 laid flat and turned by 45° into a square.

use glam::DVec3;

use super::Weights;

pub(super) fn directions(size: usize) -> Vec<DVec3> {
    let place = |k: usize| 2.0 * k as f64 / (size - 1) as f64 - 1.0;
    let unfold = |u: f64, v: f64| {
        let (x, y) = (0.5 * (u + v), 0.5 * (u - v));
        DVec3::new(x, y, 1.0 - x.abs() - y.abs()).normalize()
    };
    (0..size * size).map(|k| unfold(place(k % size), place(k / size))).collect()
}

pub(super) fn weights(size: usize, w: DVec3, out: &mut Weights) {
    let p = w / (w.x.abs() + w.y.abs() + w.z);
    let on = |t: f64| 0.5 * (t + 1.0) * (size - 1) as f64;
    let (along, across) = (cubic(on(p.x + p.y), size), cubic(on(p.x - p.y), size));
    for (row, b) in across {
        for (column, a) in along {
            if a * b != 0.0 {
                out.push(((row * size + column) as u32, a * b));
            }
        }
    }
}

/// Catmull–Rom weights of the four numbers about a place in a row; past its ends the outermost go on straight.
fn cubic(place: f64, size: usize) -> [(usize, f64); 4] {
    let last = size - 1;
    let i = (place as usize).min(size - 2);
    let t = place - i as f64;
    let (t2, t3) = (t * t, t * t * t);
    let mut a = 0.5 * (-t3 + 2.0 * t2 - t);
    let mut b = 0.5 * (3.0 * t3 - 5.0 * t2 + 2.0);
    let mut c = 0.5 * (-3.0 * t3 + 4.0 * t2 + t);
    let mut d = 0.5 * (t3 - t2);
    if i == 0 {
        (a, b, c) = (0.0, b + 2.0 * a, c - a);
    }
    if i + 2 > last {
        (b, c, d) = (b - d, c + 2.0 * d, 0.0);
    }
    [(i.saturating_sub(1), a), (i, b), (i + 1, c), ((i + 2).min(last), d)]
}
