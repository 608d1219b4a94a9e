//! The least Σ pᵢ xᵢ for 0 ≤ x ≤ 1 under linear lower bounds a·x ≥ b: the dual simplex on a dense tableau,
//! for a handful of luminaire groups. With p > 0 the origin is dual feasible, so no first phase is needed.

/// Pivots after which rounding is taken to have the upper hand.
const MOST_PIVOTS: usize = 1_000;
/// What counts as fulfilled; rows are scaled to about 1.
const TOLERANCE: f64 = 1e-9;

/// A lower bound: coefficients and right-hand side.
pub(super) type Row = (Vec<f64>, f64);

/// The cheapest x; `None` where no x fulfils all bounds. Prices must be positive.
pub(super) fn cheapest(prices: &[f64], bounds: &[Row]) -> Option<Vec<f64>> {
    let count = prices.len();
    // Dictionary: basic slack = constant + Σ coefficient · nonbasic; −x ≥ −1 closes the box.
    let mut rows: Vec<Row> = bounds.iter().map(|(a, b)| (a.clone(), -b)).collect();
    for index in 0..count {
        rows.push(((0..count).map(|j| if j == index { -1.0 } else { 0.0 }).collect(), 1.0));
    }
    let mut price = prices.to_vec();
    // Variables: 0 … count are x, those behind are slacks.
    let mut nonbasic: Vec<usize> = (0..count).collect();
    let mut basic: Vec<usize> = (count..count + rows.len()).collect();
    for _ in 0..MOST_PIVOTS {
        let worst = (0..rows.len()).min_by(|&i, &j| rows[i].1.total_cmp(&rows[j].1));
        let Some(leaving) = worst.filter(|&row| rows[row].1 < -TOLERANCE) else {
            return Some(
                (0..count)
                    .map(|x| {
                        basic.iter().position(|&v| v == x).map_or(0.0, |row| rows[row].1.clamp(0.0, 1.0))
                    })
                    .collect(),
            );
        };
        let ratio = |j: usize| price[j] / rows[leaving].0[j];
        let entering = (0..count)
            .filter(|&j| rows[leaving].0[j] > TOLERANCE)
            .min_by(|&i, &j| ratio(i).total_cmp(&ratio(j)))?;
        pivot(&mut rows, &mut price, leaving, entering);
        std::mem::swap(&mut basic[leaving], &mut nonbasic[entering]);
    }
    None
}

/// Solves the leaving row for the entering variable and puts it into all others.
fn pivot(rows: &mut [Row], price: &mut [f64], leaving: usize, entering: usize) {
    let (coefficients, constant) = rows[leaving].clone();
    let divisor = coefficients[entering];
    let solved: Vec<f64> = (0..price.len())
        .map(|j| if j == entering { 1.0 / divisor } else { -coefficients[j] / divisor })
        .collect();
    let start = -constant / divisor;
    for (index, (row, value)) in rows.iter_mut().enumerate() {
        if index == leaving {
            continue;
        }
        let factor = row[entering];
        row[entering] = 0.0;
        for (cell, solved) in row.iter_mut().zip(&solved) {
            *cell += factor * solved;
        }
        *value += factor * start;
    }
    let factor = price[entering];
    price[entering] = 0.0;
    for (cell, solved) in price.iter_mut().zip(&solved) {
        *cell += factor * solved;
    }
    rows[leaving] = (solved, start);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    fn cost(prices: &[f64], x: &[f64]) -> f64 {
        prices.iter().zip(x).map(|(p, x)| p * x).sum()
    }

    /// Catches: a bound ignored, the box ignored, a solution that is feasible and not the cheapest.
    #[test]
    fn no_point_of_a_lattice_is_cheaper() {
        for seed in 0..200 {
            let mut rng = Rng::new(seed, 0, 0);
            let prices: Vec<f64> = (0..3).map(|_| 0.1 + rng.uniform()).collect();
            let bounds: Vec<Row> = (0..6)
                .map(|_| {
                    let a: Vec<f64> = (0..3).map(|_| rng.uniform() - 0.2).collect();
                    (a, 0.8 * rng.uniform() - 0.1)
                })
                .collect();
            let fulfils = |x: &[f64], slack: f64| bounds.iter().all(|(a, b)| cost(a, x) >= b - slack);
            let steps = 20;
            let lattice = (0..(steps + 1usize).pow(3))
                .map(|n| [n % 21, n / 21 % 21, n / 441].map(|k| k as f64 / steps as f64));
            let best =
                lattice.filter(|x| fulfils(x, 0.0)).map(|x| cost(&prices, &x)).fold(f64::INFINITY, f64::min);
            match cheapest(&prices, &bounds) {
                Some(x) => {
                    assert!(fulfils(&x, 1e-7) && x.iter().all(|x| (0.0..=1.0).contains(x)), "{seed}: {x:?}");
                    assert!(cost(&prices, &x) <= best + 1e-9, "{seed}: {x:?} costs more than {best}");
                    // A lattice this fine cannot be beaten by much more than a step.
                    assert!(best.is_infinite() || cost(&prices, &x) > best - 0.2, "{seed}");
                }
                None => assert!(best.is_infinite(), "{seed}: the lattice has a solution"),
            }
        }
    }

    #[test]
    fn two_groups_of_different_price_share_as_arithmetic_says() {
        // 300 x + 100 y ≥ 250 and 50 x + 250 y ≥ 150, prices 2 and 1: the corner of both bounds.
        let x = cheapest(&[2.0, 1.0], &[(vec![300.0, 100.0], 250.0), (vec![50.0, 250.0], 150.0)]).unwrap();
        assert!((x[0] - 0.678_571_428_6).abs() < 1e-9 && (x[1] - 0.464_285_714_3).abs() < 1e-9, "{x:?}");
        assert_eq!(cheapest(&[1.0], &[(vec![10.0], 11.0)]), None, "full output does not reach it");
        assert_eq!(cheapest(&[1.0, 1.0], &[]), Some(vec![0.0, 0.0]));
    }
}
