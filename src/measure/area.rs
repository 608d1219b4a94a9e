//! Statistics of a grid with honest intervals: the mean from block means, extremes and uniformity
//! as tests on every point. The minimum of noisy values is biased low by about the noise; its
//! interval is not: "at least" needs every point's lower end, "below" one point's corrected upper end.

use super::{Answers, Gauged};
use crate::estimate::{Estimate, Pair};
use crate::norm::Light;
use crate::outcome::PointValue;
use crate::plan::{PlannedQuantity, Rows};
use crate::quantity::Statistic;
use crate::solve::Part;
use crate::units::Undefined;

/// Block values at every evaluated point of a grid: `[point][block]`, with the grid index of each.
#[derive(Clone, Debug)]
pub struct Blocks {
    /// Index in the grid of each entry of `values`.
    pub index: Vec<usize>,
    /// Block values.
    pub values: Vec<Vec<f64>>,
    /// Light at the point that blocks may have missed ([`Answers::hidden`]), in the unit of the values.
    pub hidden: Vec<f64>,
}

impl Blocks {
    /// Whether no point's blocks have found light that may exist: what is known is then a lower end only.
    pub fn is_unseen(&self) -> bool {
        !self.hidden.is_empty() && self.hidden.iter().all(|hidden| hidden.is_infinite())
    }

    /// Whether blocks may have missed what is known to come by two mirrors.
    pub fn is_missed(&self) -> bool {
        self.hidden.iter().any(|hidden| *hidden > 0.0 && hidden.is_finite())
    }

    /// Hidden light on the mean over the points; a few points where nothing at all was found do not count.
    pub(super) fn hidden_mean(&self) -> f64 {
        if self.is_unseen() {
            return f64::INFINITY;
        }
        let known = self.hidden.iter().filter(|hidden| hidden.is_finite());
        known.sum::<f64>() / self.hidden.len().max(1) as f64
    }
}

/// Block values of a planned quantity. A ratio is linearised about its estimate, so that means and
/// errors are those of the ratio to first order.
pub fn blocks(answers: &Answers, entry: &PlannedQuantity, weights: &[f64], light: Light) -> Blocks {
    let mut blocks = Blocks { index: Vec::new(), values: Vec::new(), hidden: Vec::new() };
    for (index, rows) in entry.rows.iter().enumerate() {
        let (values, hidden) = match *rows {
            None => continue,
            Some(Rows::One(row)) => {
                (answers.counted(row, weights, light), answers.hidden(row, weights, light))
            }
            Some(Rows::Ratio(above, below)) => {
                let hidden = [above, below].map(|row| answers.hidden(row, weights, light));
                let (x, y) = (answers.counted(above, weights, light), answers.counted(below, weights, light));
                let pair = Pair::from_blocks(&x, &y);
                let values = if pair.y > 0.0 {
                    let ratio = pair.x / pair.y;
                    x.iter().zip(&y).map(|(x, y)| ratio + (x - ratio * y) / pair.y).collect()
                } else {
                    vec![f64::NAN; x.len()]
                };
                // Either part may be larger by what is hidden: the ratio then has no end that is known.
                let hidden = if hidden.iter().any(|lx| *lx > 0.0) { f64::INFINITY } else { 0.0 };
                (values, hidden)
            }
        };
        blocks.index.push(index);
        blocks.values.push(values);
        blocks.hidden.push(hidden);
    }
    blocks
}

/// Point values for reports, `None` where the grid point is excluded.
pub fn points(
    answers: &Answers,
    entry: &PlannedQuantity,
    weights: &[f64],
    light: Light,
    alpha: f64,
) -> Vec<Option<PointValue>> {
    let blocks = blocks(answers, entry, weights, light);
    let mut points = vec![None; entry.rows.len()];
    for ((index, values), hidden) in blocks.index.iter().zip(&blocks.values).zip(&blocks.hidden) {
        let estimate = Estimate::from_blocks(values);
        let (lo, hi) = opened(estimate.interval(alpha), *hidden);
        let direct = match entry.rows[*index] {
            Some(Rows::One(row)) => answers.part_mean(row, weights, Part::Direct),
            _ => f64::NAN,
        };
        points[*index] = Some(PointValue {
            value: estimate.value,
            se: estimate.se,
            lo,
            hi,
            direct,
            indirect: estimate.value - direct,
        });
    }
    points
}

/// A statistic of a grid whose interval errs with probability `alpha`.
pub fn gauge(blocks: &Blocks, statistic: Statistic, alpha: f64) -> Gauged {
    if blocks.values.is_empty() {
        return Gauged::undefined(Undefined::because("the area has no point"));
    }
    if blocks.values.iter().flatten().any(|value| !value.is_finite()) {
        return Gauged::undefined(Undefined::because("the quantity is undefined where no light arrives"));
    }
    match statistic {
        Statistic::Mean => {
            let estimate = Estimate::from_blocks(&mean_blocks(blocks));
            let (lo, hi) = opened(estimate.interval(alpha), blocks.hidden_mean());
            Gauged { value: Ok(estimate.value), se: estimate.se, lo, hi, place: None }
        }
        Statistic::Min => extreme(blocks, alpha, 1.0),
        Statistic::Max => extreme(blocks, alpha, -1.0),
        Statistic::U0 => uniformity(blocks, alpha),
        Statistic::Ud => diversity(blocks, alpha),
        Statistic::OfTask => Gauged::undefined(Undefined::because("compare with a task area")),
        Statistic::Value => Gauged::undefined(Undefined::because(
            "an area has no single value: ask for its mean, min, max, U0 or Ud",
        )),
    }
}

/// An interval that allows for hidden light.
fn opened((lo, hi): (f64, f64), hidden: f64) -> (f64, f64) {
    (lo, hi + hidden)
}

/// Mean over an area divided by the mean over its task area, by Fieller's interval.
pub fn gauge_of_task(own: &Blocks, task: &Blocks, alpha: f64) -> Gauged {
    if own.values.is_empty() || task.values.is_empty() {
        return Gauged::undefined(Undefined::because("the area has no point"));
    }
    let hidden = [own.hidden_mean(), task.hidden_mean()];
    let gauged = ratio([&mean_blocks(own), &mean_blocks(task)], hidden, alpha);
    let dark = || Gauged::undefined(Undefined::because("no light arrives on the task area: 0/0"));
    gauged.unwrap_or_else(dark)
}

/// First over second of two series of blocks by Fieller's interval, opened by what is `hidden` of either; `None`
/// where the second is dark.
pub(super) fn ratio([x, y]: [&[f64]; 2], hidden: [f64; 2], alpha: f64) -> Option<Gauged> {
    let pair = Pair::from_blocks(x, y);
    if !(pair.y > 0.0) {
        return None;
    }
    let ratio = pair.ratio();
    let (mut lo, mut hi) = pair.ratio_interval(alpha);
    hi += hidden[0] / pair.y;
    lo *= pair.y / (pair.y + hidden[1]);
    Some(Gauged { value: Ok(ratio.value), se: ratio.se, lo, hi, place: None })
}

/// Block values of the mean over the points.
pub fn mean_blocks(blocks: &Blocks) -> Vec<f64> {
    let count = blocks.values[0].len();
    (0..count)
        .map(|k| blocks.values.iter().map(|point| point[k]).sum::<f64>() / blocks.values.len() as f64)
        .collect()
}

/// Minimum (`sign` = 1) or maximum (`sign` = −1) over the points.
fn extreme(blocks: &Blocks, alpha: f64, sign: f64) -> Gauged {
    let corrected = alpha / blocks.values.len() as f64;
    let (mut value, mut se, mut place) = (f64::INFINITY, 0.0, 0);
    let (mut lo, mut hi) = (f64::INFINITY, f64::INFINITY);
    for (at, values) in blocks.values.iter().enumerate() {
        let estimate = Estimate::from_blocks(values);
        let signed = Estimate { value: sign * estimate.value, ..estimate };
        if signed.value < value {
            (value, se, place) = (signed.value, estimate.se, blocks.index[at]);
        }
        // Hidden light raises the point: its upper end, which for a maximum is the lower one here.
        let [below, above] = if sign > 0.0 { [0.0, blocks.hidden[at]] } else { [blocks.hidden[at], 0.0] };
        lo = lo.min(signed.interval(alpha).0 - below);
        hi = hi.min(signed.interval(corrected).1 + above);
    }
    let (lo, hi) = if sign > 0.0 { (lo, hi) } else { (-hi, -lo) };
    Gauged { value: Ok(sign * value), se, lo, hi, place: Some(place) }
}

/// U0 = E_min / Ē: U0 ≥ u means every contrast E_i − u·Ē ≥ 0, so its interval is made of Fieller
/// intervals of all points: the lower ends uncorrected, the upper ends by Bonferroni.
fn uniformity(blocks: &Blocks, alpha: f64) -> Gauged {
    let mean = mean_blocks(blocks);
    if !(mean.iter().sum::<f64>() > 0.0) {
        return Gauged::undefined(Undefined::because("no light arrives on the area: 0/0"));
    }
    let corrected = alpha / blocks.values.len() as f64;
    let mut least: Option<(f64, f64, usize)> = None;
    let (mut lo, mut hi) = (f64::INFINITY, f64::INFINITY);
    for (index, values) in blocks.values.iter().enumerate() {
        let pair = Pair::from_blocks(values, &mean);
        let ratio = pair.ratio();
        if least.is_none_or(|(value, _, _)| ratio.value < value) {
            least = Some((ratio.value, ratio.se, blocks.index[index]));
        }
        lo = lo.min(pair.ratio_interval(alpha).0);
        hi = hi.min(pair.ratio_interval(corrected).1 + blocks.hidden[index] / pair.y);
    }
    // Hidden light may fall on any of the points and raise the mean alone.
    let mean_lx = mean.iter().sum::<f64>() / mean.len() as f64;
    lo = lo.max(0.0) * mean_lx / (mean_lx + blocks.hidden_mean());
    let (value, se, place) = least.expect("an area has points here");
    // A minimum of illuminances lies between 0 and their mean; an interval says no more than that.
    Gauged { value: Ok(value), se, lo: lo.clamp(0.0, 1.0), hi: hi.clamp(0.0, 1.0), place: Some(place) }
}

/// U_d = E_min / E_max, from the intervals of both at half the risk each (conservative).
fn diversity(blocks: &Blocks, alpha: f64) -> Gauged {
    let least = extreme(blocks, 0.5 * alpha, 1.0);
    let most = extreme(blocks, 0.5 * alpha, -1.0);
    match (least.value, most.value) {
        (Ok(small), Ok(large)) if large > 0.0 => {
            let value = small / large;
            let se = (least.se / large).hypot(value * most.se / large);
            let lo = least.lo.max(0.0) / most.hi;
            let hi = if most.lo > 0.0 { least.hi / most.lo } else { f64::INFINITY };
            Gauged { value: Ok(value), se, lo, hi, place: least.place }
        }
        _ => Gauged::undefined(Undefined::because("no light arrives on the area: 0/0")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emitters::ByChance;
    use crate::rng::Rng;

    /// A grid of independent noisy points about `truth`.
    fn noisy(truth: &[f64], sd: f64, blocks: usize, seed: u64) -> Blocks {
        let mut rng = Rng::new(seed, 0, 0);
        let values = truth
            .iter()
            .map(|t| (0..blocks).map(|_| t + sd * 12f64.sqrt() * (rng.uniform() - 0.5)).collect())
            .collect();
        Blocks { index: (0..truth.len()).collect(), values, hidden: vec![0.0; truth.len()] }
    }

    #[test]
    fn a_uniformity_at_its_limit_is_called_wrongly_no_more_often_than_stated() {
        // 40 points, one of which sits exactly at U0 = 0.6; 1000 runs, α = 5 %.
        let mut truth = vec![100.0; 40];
        truth[7] = 0.6 * (39.0 * 100.0) / (40.0 - 0.6);
        let (mut below, mut above) = (0, 0);
        for run in 0..1000 {
            let gauged = gauge(&noisy(&truth, 20.0, 64, run), Statistic::U0, 0.05);
            below += usize::from(gauged.hi < 0.6);
            above += usize::from(gauged.lo > 0.6);
        }
        // Binomial 5 σ above 2.5 % of 1000: 25 + 25.
        assert!(below <= 50 && above <= 50, "wrongly failed {below}, wrongly passed {above}");
    }

    #[test]
    fn statistics_of_exact_values_are_exact() {
        let blocks = noisy(&[100.0, 200.0, 300.0], 0.0, 4, 1);
        let of = |statistic| gauge(&blocks, statistic, 0.05).value.unwrap();
        assert!((of(Statistic::Mean) - 200.0).abs() < 1e-12);
        assert!((of(Statistic::Min) - 100.0).abs() < 1e-12);
        assert!((of(Statistic::Max) - 300.0).abs() < 1e-12);
        assert!((of(Statistic::U0) - 0.5).abs() < 1e-12);
        assert!((of(Statistic::Ud) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(gauge(&blocks, Statistic::Min, 0.05).place, Some(0));
    }

    /// Catches: blocks that agree on what all of them missed taken for certainty.
    #[test]
    fn what_no_block_has_found_has_no_upper_end() {
        let known = noisy(&[3.0, 5.0], 0.0, 32, 1);
        let unseen = Blocks { hidden: vec![f64::INFINITY; 2], ..known.clone() };
        for statistic in [Statistic::Mean, Statistic::Min, Statistic::Max] {
            let (known, unseen) = (gauge(&known, statistic, 0.05), gauge(&unseen, statistic, 0.05));
            assert!((unseen.lo - known.lo).abs() < 1e-12 && unseen.hi.is_infinite(), "{unseen:?}");
            assert!(known.hi < 6.0, "the twin is certain: {known:?}");
        }
        let ratio = gauge(&unseen, Statistic::U0, 0.05);
        assert!(ratio.lo.abs() < 1e-12 && (ratio.hi - 1.0).abs() < 1e-12, "{ratio:?}");
        let diversity = gauge(&unseen, Statistic::Ud, 0.05);
        assert!(diversity.lo <= 0.0 && diversity.hi.is_infinite(), "{diversity:?}");
        // One point of several: the least may be higher than it seems, the mean has its own noise.
        let one = Blocks { hidden: vec![f64::INFINITY, 0.0], ..known.clone() };
        assert!((gauge(&one, Statistic::Min, 0.05).hi - 5.0).abs() < 1e-12);
        assert!(gauge(&one, Statistic::Max, 0.05).hi.is_infinite());
        // What is known but was seldom met opens the upper end by as much.
        let missed = gauge(&Blocks { hidden: vec![4.0, 0.0], ..known }, Statistic::Mean, 0.05);
        assert!((missed.hi - 6.0).abs() < 1e-12 && (missed.lo - 4.0).abs() < 1e-12, "{missed:?}");
    }

    /// Catches: darkness where light may exist taken for certain, or certain darkness for doubt.
    #[test]
    fn light_that_may_exist_is_told_from_light_that_cannot() {
        let sheet =
            |indirect: f64| crate::solve::Sheet { values: vec![4.0, 0.0, indirect], ..Default::default() };
        let sheets = |found: [f64; 2]| found.map(sheet);
        let hidden = |found: [f64; 2], may_hide: bool, weight: f64, light: Light| {
            let sheets = sheets(found);
            let by_chance = [vec![
                ByChance { channel: 0, lx: 7.0, per_ray: 1.0 },
                ByChance { channel: 0, lx: 90.0, per_ray: 5.0 },
            ]];
            let may_hide = [may_hide];
            let answers =
                Answers { sheets: &sheets, channels: 1, may_hide: &may_hide, by_chance: &by_chance };
            answers.hidden(0, &[weight], light)
        };
        assert!(hidden([0.0, 0.0], true, 1.0, Light::All).is_infinite());
        // One block has found some; ten rays are expected at the second way of two mirrors, two at the first.
        assert!((hidden([0.0, 1e-9], true, 0.5, Light::All) - 3.5).abs() < 1e-12);
        assert!(
            (hidden([0.0, 0.0], false, 1.0, Light::All) - 7.0).abs() < 1e-12,
            "nothing else returns light"
        );
        let never = [hidden([0.0, 0.0], true, 0.0, Light::All), hidden([0.0, 0.0], true, 1.0, Light::Direct)];
        assert!(never.iter().all(|lx| lx.abs() < 1e-12), "all is off, or direct light is all that counts");
    }

    #[test]
    fn darkness_has_no_uniformity() {
        let dark = noisy(&[0.0, 0.0], 0.0, 4, 1);
        assert!(gauge(&dark, Statistic::U0, 0.05).value.is_err());
        assert!(gauge(&dark, Statistic::Ud, 0.05).value.is_err());
    }
}
