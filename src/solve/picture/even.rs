//! A smooth function on the pixels of a tile from few of its values: bilinear from the corners of a square where
//! that holds in the middle and at two edges, else quadratic from nine pixels where that holds at four others,
//! else by quarters, down to every value. What all corners have as 0 is taken to be 0 throughout.

use super::TILE;

/// Largest error, half of it as a share of the value, half as a share of all light.
const ALLOWED: f64 = 0.004;
/// Squares of this edge are not quartered: every value is asked for.
const SMALLEST: usize = 4;
/// Pixel in the middle of a tile.
pub(super) const MIDDLE: usize = TILE / 2 * TILE + TILE / 2;

/// How far a lamp's light may be off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowance {
    /// Light of which a share may be missed whatever the lamp gives, lx: all lamps' divided by their number.
    pub anyway_lx: f64,
}

impl Allowance {
    fn holds(self, guess: f64, value: f64) -> bool {
        (guess - value).abs() <= 0.5 * ALLOWED * (value + self.anyway_lx)
    }
}

/// All values of a tile, row by row; `exact` gives that of a pixel.
pub(super) fn filled(exact: impl Fn(usize) -> f64, allowance: Allowance) -> Vec<f64> {
    let mut values = vec![0.0; TILE * TILE];
    fill(&exact, allowance, [0, 0], TILE, &mut values);
    values
}

/// Fills the square with this first column and row.
fn fill(
    exact: &impl Fn(usize) -> f64,
    allowance: Allowance,
    corner: [usize; 2],
    edge: usize,
    values: &mut [f64],
) {
    let pixel = |[column, row]: [usize; 2]| (corner[1] + row) * TILE + corner[0] + column;
    let at = |place: [usize; 2]| exact(pixel(place));
    let mut put = |value: &dyn Fn([usize; 2]) -> f64| {
        for k in 0..edge * edge {
            let place = [k % edge, k / edge];
            values[pixel(place)] = value(place);
        }
    };
    let [first, middle, last] = nodes(edge);
    let corners = [[first, first], [last, first], [first, last], [last, last]].map(at);
    let places = [[middle, middle], [middle, first], [first, middle]];
    let rest = places.map(at);
    let dark = corners.iter().chain(&rest).filter(|value| !(**value > 0.0)).count();
    if dark == corners.len() + rest.len() {
        return;
    }
    // Where a horizon runs through the square, no function will do.
    if dark == 0 {
        let bilinear = |[column, row]: [usize; 2]| {
            let [x, y] = [column, row].map(|k| k as f64 / last as f64);
            let [a, b, c, d] = corners;
            (a + (b - a) * x) * (1.0 - y) + (c + (d - c) * x) * y
        };
        if places.iter().zip(rest).all(|(place, value)| allowance.holds(bilinear(*place), value)) {
            return put(&bilinear);
        }
        let far = [[last, middle], [middle, last]].map(at);
        let rows =
            [[corners[0], rest[1], corners[1]], [rest[2], rest[0], far[0]], [corners[2], far[1], corners[3]]];
        let shares: Vec<[f64; 3]> = (0..edge).map(|k| shares(k, edge)).collect();
        let quadratic = |[column, row]: [usize; 2]| {
            let (along, down) = (shares[column], shares[row]);
            (0..3).map(|j| down[j] * (0..3).map(|i| along[i] * rows[j][i]).sum::<f64>()).sum::<f64>()
        };
        // Farthest from the nodes.
        let [near, far] = [edge / 4, 3 * edge / 4];
        let checked = [[near, near], [far, near], [near, far], [far, far]];
        if checked.iter().all(|&place| allowance.holds(quadratic(place), at(place))) {
            return put(&|place| quadratic(place).max(0.0));
        }
    }
    if edge <= SMALLEST {
        return put(&at);
    }
    let half = edge / 2;
    for quarter in 0..4 {
        let corner = [corner[0] + quarter % 2 * half, corner[1] + quarter / 2 * half];
        fill(exact, allowance, corner, half, values);
    }
}

/// Columns and rows of the nine pixels.
fn nodes(edge: usize) -> [usize; 3] {
    [0, edge / 2, edge - 1]
}

/// Lagrange's shares of the three nodes at a column.
fn shares(column: usize, edge: usize) -> [f64; 3] {
    let x = column as f64;
    let [a, b, c] = nodes(edge).map(|node| node as f64);
    [
        (x - b) * (x - c) / ((a - b) * (a - c)),
        (x - a) * (x - c) / ((b - a) * (b - c)),
        (x - a) * (x - b) / ((c - a) * (c - b)),
    ]
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// Largest error of a tile as a share, and the number of values asked for.
    fn worst(value: impl Fn(f64, f64) -> f64, anyway_lx: f64) -> (f64, usize) {
        let asked = Cell::new(0);
        let exact = |pixel: usize| value((pixel % TILE) as f64, (pixel / TILE) as f64);
        let counted = |pixel: usize| {
            asked.set(asked.get() + 1);
            exact(pixel)
        };
        let found = filled(counted, Allowance { anyway_lx });
        let off = |(pixel, found): (usize, &f64)| (found / exact(pixel) - 1.0).abs();
        (found.iter().enumerate().map(off).fold(0.0, f64::max), asked.get())
    }

    /// Catches: a bend along one edge that the corners do not show, a bend in the middle, shares that do not
    /// meet their nodes, a tile that is asked for more than it needs.
    #[test]
    fn bends_are_followed_and_slopes_are_cheap() {
        assert_eq!(worst(|x, y| 5.0 + 0.3 * x - 0.2 * y, 0.0).1, 7);
        let bend = |x: f64| 0.1 * (x - 3.5) * (x - 3.5);
        let bent = worst(|x, _| 5.0 + bend(x), 0.0);
        assert!(bent.0 < 1e-12 && bent.1 == 13, "{bent:?}");
        let bent = worst(|_, y| 5.0 + bend(y), 0.0);
        assert!(bent.0 < 1e-12 && bent.1 == 13, "{bent:?}");
        let saddle = worst(|x, y| 20.0 + bend(x) - bend(y), 0.0);
        assert!(saddle.0 < 1e-12, "{saddle:?}");
        // A lamp near a plane: E ∝ h (h² + r²)^−3/2, from tiles far wider than high to tiles far smaller.
        let mut asked = [0; 3];
        for step in [0.003, 0.01, 0.03, 0.1, 0.3] {
            for shift in [0.0, 0.7, 2.0, 5.0] {
                let lamp = |x: f64, y: f64| {
                    let (x, y) = (step * (x - 3.0) + shift, step * (y - 5.0));
                    (1.0 + x * x + y * y).powf(-1.5)
                };
                let (off, count) = worst(lamp, 0.0);
                assert!(off < 0.004, "{off} at {step}, {shift}");
                asked[usize::from(count > 7) + usize::from(count > 13)] += 1;
            }
        }
        assert!(asked.iter().all(|count| *count > 2), "{asked:?}");
        // A step is found, and only where it lies is every value asked for.
        let step = |x: f64, _: f64| if x < 4.5 { 9.0 } else { 5.0 };
        let (off, count) = worst(step, 0.0);
        assert!(off < 1e-12 && count < 3 * TILE * TILE / 2, "{off} {count}");
        // Beside much other light a little may be further off, but no more than that light allows.
        let faint = |x: f64, y: f64| (1.0 + x * x + y * y).powf(-1.5);
        assert!(worst(faint, 1000.0).1 == 7 && worst(faint, 0.0).1 > 13);
        assert_eq!(filled(|_| 0.0, Allowance { anyway_lx: 1.0 }), vec![0.0; TILE * TILE]);
    }
}
