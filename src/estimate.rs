//! Estimates from independent blocks: mean, standard error, Student intervals, and Fieller's
//! interval of a ratio. Points share rays within a block, so statistics are always of the
//! *reported* quantity's block values, never combined from point errors.

use statrs::distribution::{ContinuousCDF, FisherSnedecor, Normal, StudentsT};

/// Mean of independent block values with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Mean over blocks.
    pub value: f64,
    /// Standard error of the mean.
    pub se: f64,
    /// Number of blocks.
    pub n: usize,
    /// Skewness of the blocks, m₃/m₂^1.5; 0 where nothing is known of it.
    pub skew: f64,
}

impl Estimate {
    /// From block values, summed in order. One block has no standard error: it is infinite.
    pub fn from_blocks(blocks: &[f64]) -> Self {
        let n = blocks.len();
        let value = blocks.iter().sum::<f64>() / n as f64;
        let squares: f64 = blocks.iter().map(|x| (x - value) * (x - value)).sum();
        let se = if n > 1 { (squares / ((n - 1) as f64 * n as f64)).sqrt() } else { f64::INFINITY };
        Self { value, se, n, skew: skewness(blocks.iter().map(|x| x - value)) }
    }

    /// A value that is known without error.
    pub fn exact(value: f64, n: usize) -> Self {
        Self { value, se: 0.0, n, skew: 0.0 }
    }

    /// Two-sided interval that errs with probability `alpha`: Student's, wider where the blocks are skewed
    /// ([`reaches`]). Blocks that are all alike give a point; whether that is certainty the caller must know.
    pub fn interval(&self, alpha: f64) -> (f64, f64) {
        if !(self.se > 0.0) {
            return (self.value, self.value);
        }
        let [below, above] = reaches(alpha, self.n, self.skew);
        (self.value - below * self.se, self.value + above * self.se)
    }

    /// How much farther than Student's the interval reaches below and above, as factors.
    pub fn widenings(&self, alpha: f64) -> [f64; 2] {
        let t = quantile(1.0 - 0.5 * alpha, self.n.saturating_sub(1));
        if t.is_finite() { reaches(alpha, self.n, self.skew).map(|reach| reach / t) } else { [1.0; 2] }
    }
}

/// Skewness m₃/m₂^1.5 of deviations from their mean; 0 if there are none.
fn skewness(deviations: impl Iterator<Item = f64>) -> f64 {
    let (mut count, mut squares, mut cubes) = (0.0, 0.0, 0.0);
    for x in deviations {
        count += 1.0;
        squares += x * x;
        cubes += x * x * x;
    }
    let variance: f64 = squares / count;
    let skew = cubes / count / (variance * variance.sqrt());
    if skew.is_finite() { skew } else { 0.0 }
}

/// Skewness from which an interval heeds it, in standard errors √(6/n) that it has where there is none.
const SKEWED: f64 = 5.0;

/// How many standard errors an interval that errs with probability `alpha` reaches below and above the mean of
/// `n` blocks with this skewness: Student's t on both sides, and where the skewness γ is more than chance makes
/// of even blocks (|γ| > 5 √(6/n)), at least as far as by Hall's transformation
///
///   T(x) = (3/a) {[1 + a (x − a/6)]^⅓ − 1},  a = γ/√n,  x = ±t      (P. Hall, J. R. Statist. Soc. B 54, 1992)
///
/// which allows for what a few rare bright blocks say of those that are still to come: a mean of 31 dark blocks and
/// a bright one reaches 6.4 standard errors up where Student's t says 2.0. No side is ever narrower than Student's.
pub fn reaches(alpha: f64, n: usize, skew: f64) -> [f64; 2] {
    let t = quantile(1.0 - 0.5 * alpha, n.saturating_sub(1));
    let count = n as f64;
    if !(skew.abs() > SKEWED * (6.0 / count).sqrt() && t.is_finite()) {
        return [t, t];
    }
    let a = skew / count.sqrt();
    let hall = |x: f64| 3.0 / a * ((1.0 + a * (x - a / 6.0)).cbrt() - 1.0);
    [hall(t).max(t), (-hall(-t)).max(t)]
}

/// Quantile of Student's t with `df` degrees of freedom at probability `p` > ½.
pub fn quantile(p: f64, df: usize) -> f64 {
    if df == 0 {
        return f64::INFINITY;
    }
    // statrs' t falls below the normal quantile for very many degrees of freedom.
    if df >= 5_000 {
        let normal = Normal::new(0.0, 1.0).expect("unit normal");
        // Second-order correction of the normal quantile: t ≈ z + (z³ + z)/(4 df).
        let z = normal.inverse_cdf(p);
        return z + (z * z * z + z) / (4.0 * df as f64);
    }
    StudentsT::new(0.0, 1.0, df as f64).expect("positive degrees of freedom").inverse_cdf(p)
}

/// Scheffé's multiplier of a standard error: with probability 1 − `alpha` all linear combinations of `parts`
/// correlated means from `n` blocks lie within it of their truth at once.
/// T² = p (n − 1)/(n − p) · F(1 − α; p, n − p), which is Student's t for one part.
pub fn scheffe(alpha: f64, parts: usize, n: usize) -> f64 {
    if parts == 0 || n <= parts {
        return f64::INFINITY;
    }
    let (p, rest) = (parts as f64, (n - parts) as f64);
    let f = FisherSnedecor::new(p, rest).expect("positive degrees of freedom").inverse_cdf(1.0 - alpha);
    (p * (n - 1) as f64 / rest * f).sqrt()
}

/// Means of x and y over blocks with the (co)variances of the means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Mean of x.
    pub x: f64,
    /// Mean of y.
    pub y: f64,
    /// Variance of the mean of x.
    pub var_x: f64,
    /// Variance of the mean of y.
    pub var_y: f64,
    /// Covariance of the means.
    pub cov: f64,
    /// Number of blocks.
    pub n: usize,
    /// Skewness of the contrasts x − (x̄/ȳ) y.
    pub skew: f64,
}

impl Pair {
    /// From block values of x and y, equally many.
    pub fn from_blocks(x: &[f64], y: &[f64]) -> Self {
        let n = x.len();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / n as f64;
        let (mx, my) = (mean(x), mean(y));
        let scale = if n > 1 { 1.0 / ((n - 1) as f64 * n as f64) } else { f64::INFINITY };
        let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
        for (a, b) in x.iter().zip(y) {
            xx += (a - mx) * (a - mx);
            yy += (b - my) * (b - my);
            xy += (a - mx) * (b - my);
        }
        let ratio = mx / my;
        let skew = skewness(x.iter().zip(y).map(|(a, b)| (a - mx) - ratio * (b - my)));
        Self { x: mx, y: my, var_x: xx * scale, var_y: yy * scale, cov: xy * scale, n, skew }
    }

    /// x / y with the standard error of first order; exact zero error where the variances vanish.
    pub fn ratio(&self) -> Estimate {
        let ratio = self.x / self.y;
        let variance = self.var_x - 2.0 * ratio * self.cov + ratio * ratio * self.var_y;
        let skew = self.skew * self.y.signum();
        Estimate { value: ratio, se: variance.max(0.0).sqrt() / self.y.abs(), n: self.n, skew }
    }

    /// Fieller's interval of x / y: all u for which the contrast x − u·y does not differ from zero
    /// at two-sided `alpha`, the test as wide as [`reaches`] says. Unbounded (±∞) where y itself is not
    /// significantly above zero.
    pub fn ratio_interval(&self, alpha: f64) -> (f64, f64) {
        let [below, above] = reaches(alpha, self.n, self.skew);
        (self.fieller(below).0, self.fieller(above).1)
    }

    fn fieller(&self, t: f64) -> (f64, f64) {
        let t2 = t * t;
        let a = self.y * self.y - t2 * self.var_y;
        if !(a > 0.0) {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let b = self.x * self.y - t2 * self.cov;
        let c = self.x * self.x - t2 * self.var_x;
        let root = (b * b - a * c).max(0.0).sqrt();
        ((b - root) / a, (b + root) / a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn quantiles_match_tables_and_never_fall_below_the_normal_one() {
        for (p, df, expected) in
            [(0.975, 31, 2.0395), (0.975, 1, 12.706), (0.995, 63, 2.6561), (0.9999, 63, 3.955)]
        {
            assert!(
                (quantile(p, df) - expected).abs() < 2e-3 * expected,
                "t({p}, {df}) = {}",
                quantile(p, df)
            );
        }
        for df in [100, 4_999, 5_000, 1_000_000] {
            assert!(quantile(0.975, df) > 1.959_963, "df {df}");
        }
    }

    /// Catches: Student's t trusted where few rare blocks bring most of the light.
    #[test]
    fn rare_bright_blocks_widen_the_interval_and_even_ones_do_not() {
        let mut blocks = vec![0.0; 32];
        blocks[7] = 32.0;
        let once = Estimate::from_blocks(&blocks);
        let (lo, hi) = once.interval(0.05);
        assert!((once.value - 1.0).abs() < 1e-12 && (once.se - 1.0).abs() < 1e-12);
        // a = γ/√32 with γ = 30/√31: T(−2.04) = −6.4; one event at 97.5 % leaves up to 5.6 (Poisson).
        assert!((hi - 7.4).abs() < 0.1, "{hi}");
        assert!((lo + 1.04).abs() < 0.02, "never narrower than Student's: {lo}");
        assert!(Estimate::from_blocks(&[1.0, 2.0, 3.0, 4.0]).skew.abs() < 1e-12);
        // Every tenth block brings light: how often does an interval of 32 blocks miss the mean?
        let (mut missed, mut missed_by_t, mut widened, runs) = (0, 0, 0, 2000);
        for run in 0..runs {
            let mut rng = Rng::new(7, run, 0);
            let rare: Vec<f64> = (0..32).map(|_| f64::from(u8::from(rng.uniform() < 0.1))).collect();
            let estimate = Estimate::from_blocks(&rare);
            let misses = |(lo, hi): (f64, f64)| usize::from(!(lo <= 0.1 && 0.1 <= hi));
            missed += misses(estimate.interval(0.05));
            missed_by_t += misses(Estimate { skew: 0.0, ..estimate }.interval(0.05));
            let even: Vec<f64> = (0..32).map(|_| rng.uniform() + rng.uniform()).collect();
            let [below, above] = Estimate::from_blocks(&even).widenings(0.05);
            widened += usize::from(below.max(above) > 1.0);
        }
        // 3.4 % of the runs see nothing at all, which no interval of theirs can know: 5 % ± 5 σ of the binomial.
        assert!(missed <= 149, "{missed}");
        assert!(missed_by_t > 200, "Student's t promises too much: {missed_by_t}");
        assert!(widened < 149, "even blocks are widened: {widened}");
    }

    /// Catches: a skewness that a ratio does not heed, or heeds on the wrong side.
    #[test]
    fn a_ratio_of_skewed_blocks_reaches_further_to_the_rare_side() {
        let x: Vec<f64> = (0..32).map(|k| if k == 3 { 40.0 } else { 1.0 }).collect();
        let y: Vec<f64> = (0..32).map(|k| 10.0 + 0.01 * f64::from(k)).collect();
        let pair = Pair::from_blocks(&x, &y);
        let (lo, hi) = pair.ratio_interval(0.05);
        let (even_lo, even_hi) = Pair { skew: 0.0, ..pair }.ratio_interval(0.05);
        assert!((lo - even_lo).abs() < 1e-12, "{lo} {even_lo}");
        assert!(hi - pair.x / pair.y > 2.0 * (even_hi - pair.x / pair.y), "{hi} {even_hi}");
    }

    /// Catches: a multiplier of one combination for a promise about all of them.
    #[test]
    fn scheffes_bounds_hold_for_all_combinations_at_once() {
        assert!((scheffe(0.05, 1, 64) - quantile(0.975, 63)).abs() < 1e-6, "one part: Student's t");
        assert!((scheffe(0.05, 3, 64) - 2.9234).abs() < 2e-3, "{}", scheffe(0.05, 3, 64));
        assert!(scheffe(0.05, 3, 3).is_infinite());
        // Two independent parts of mean 1: how often does the worst direction of 180 miss the truth?
        let (mut missed, mut missed_by_t, runs) = (0, 0, 1000);
        for run in 0..runs {
            let mut rng = Rng::new(6, run, 0);
            let n = 32;
            let parts: [Vec<f64>; 2] = std::array::from_fn(|_| (0..n).map(|_| 0.5 + rng.uniform()).collect());
            let worst = (0..180).map(|degree| {
                let (s, c) = f64::from(degree).to_radians().sin_cos();
                let sum: Vec<f64> = parts[0].iter().zip(&parts[1]).map(|(x, y)| c * x + s * y).collect();
                let estimate = Estimate::from_blocks(&sum);
                (estimate.value - c - s).abs() / estimate.se
            });
            let worst = worst.fold(0.0, f64::max);
            missed += usize::from(worst > scheffe(0.05, 2, n));
            missed_by_t += usize::from(worst > quantile(0.975, n - 1));
        }
        // 5 % of 1000 with 5 σ of the binomial: 50 ± 34.
        assert!((16..=84).contains(&missed), "{missed}");
        assert!(missed_by_t > 84, "Student's t promises too much: {missed_by_t}");
    }

    #[test]
    fn intervals_cover_as_often_as_they_say() {
        let (mut covered, mut ratio_covered, runs) = (0, 0, 2000);
        for run in 0..runs {
            let mut rng = Rng::new(5, run, 0);
            let blocks: Vec<f64> = (0..32).map(|_| rng.uniform() + rng.uniform() * rng.uniform()).collect();
            let (lo, hi) = Estimate::from_blocks(&blocks).interval(0.05);
            covered += usize::from(lo <= 0.75 && 0.75 <= hi);
            let y: Vec<f64> = blocks.iter().map(|b| 1.0 + 0.3 * b + 0.1 * rng.uniform()).collect();
            let (lo, hi) = Pair::from_blocks(&blocks, &y).ratio_interval(0.05);
            let truth = 0.75 / (1.0 + 0.225 + 0.05);
            ratio_covered += usize::from(lo <= truth && truth <= hi);
        }
        // 95 % of 2000 with 5 σ of the binomial: 1900 ± 49.
        assert!((1851..=1949).contains(&covered), "{covered}");
        assert!((1851..=1949).contains(&ratio_covered), "{ratio_covered}");
    }
}
