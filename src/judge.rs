//! Measured × limit → verdict. A verdict is certain when the family-wise interval lies on one side
//! of the limit; within the indifference margin the value decides and is called "at the limit".

use crate::measure::Gauged;
use crate::outcome::{Bound, Dimming, Requirement, Verdict};
use crate::project::Compare;
use crate::quantity::{Quantity, Statistic};

/// Share of a limit within which a value is "at the limit".
pub const INDIFFERENCE: f64 = 0.005;
/// The same for UGR, in units of UGR.
pub const INDIFFERENCE_UGR: f64 = 0.1;

/// A verdict with what explains it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// The verdict.
    pub verdict: Verdict,
    /// Decided by the value within the indifference margin.
    pub at_the_limit: bool,
    /// Distance to the limit, positive when it complies: relative, for UGR in its units.
    pub margin: Option<f64>,
}

/// Judges a gauged quantity whose interval is the joint one.
pub fn judge(
    gauged: &Gauged,
    quantity: Quantity,
    statistic: Statistic,
    bound: Bound,
    compare: Compare,
) -> Judged {
    let Ok(value) = gauged.value else {
        return Judged { verdict: Verdict::Undefined, at_the_limit: false, margin: None };
    };
    let round = |x: f64| match compare {
        Compare::Exact => x,
        Compare::Printed => printed(x, quantity, statistic),
    };
    let (limit, sign) = match bound {
        Bound::Min(limit) => (limit, 1.0),
        Bound::Max(limit) => (limit, -1.0),
    };
    let scale = if quantity == Quantity::Ugr { 1.0 } else { limit.abs().max(f64::MIN_POSITIVE) };
    let margin = sign * (value - limit) / scale;
    let complies = |x: f64| sign * (round(x) - limit) >= 0.0;
    let by_value = if complies(value) { Verdict::Pass } else { Verdict::Fail };
    let (certain_pass, certain_fail) =
        (complies(gauged.lo) && complies(gauged.hi), !complies(gauged.lo) && !complies(gauged.hi));
    let indifference = if quantity == Quantity::Ugr { INDIFFERENCE_UGR } else { INDIFFERENCE * limit.abs() };
    let near = (gauged.lo - limit).abs() <= indifference && (gauged.hi - limit).abs() <= indifference;
    let verdict = if certain_pass || certain_fail || near { by_value } else { Verdict::Undecided };
    Judged { verdict, at_the_limit: near, margin: Some(margin) }
}

/// Blocks after which an undecided value will probably be decided: its interval narrows with the
/// root of their number, until it lies on one side of the limit or within the indifference margin.
/// An estimate at the noise found so far, not a promise.
pub fn blocks_needed(gauged: &Gauged, quantity: Quantity, bound: Bound, blocks: usize) -> Option<usize> {
    let value = *gauged.value.as_ref().ok()?;
    let (Bound::Min(limit) | Bound::Max(limit)) = bound;
    let distance = (value - limit).abs();
    let indifference = if quantity == Quantity::Ugr { INDIFFERENCE_UGR } else { INDIFFERENCE * limit.abs() };
    let half = if value < limit { gauged.hi - value } else { value - gauged.lo };
    let enough = distance.max(indifference - distance);
    if !(half.is_finite() && enough > 0.0) {
        return None;
    }
    let needed = blocks as f64 * (half / enough).powi(2);
    (needed.is_finite() && needed < 1e12).then(|| (needed.ceil() as usize).max(blocks + 1))
}

/// The least factor by which all luminaires may be dimmed together, rounded up to three figures: every
/// illuminance is linear in it, its interval too. What all else comes to at the factor (`others_pass`) is
/// judged at `at(factor)`.
/// `None` where no illuminance is required from below, or one has no value, or an index of glare must not
/// fall.
pub fn dimming(requirements: &[Requirement], at: impl FnOnce(f64) -> Vec<Requirement>) -> Option<Dimming> {
    let must_not_fall = |r: &&Requirement| {
        matches!(r.bound, Bound::Min(_)) && matches!(r.quantity, Quantity::Ugr | Quantity::OfView { .. })
    };
    if requirements.iter().filter(must_not_fall).any(|r| is_judged(r) && !is_level(r)) {
        return None;
    }
    let mut least: Option<(f64, &Requirement)> = None;
    for requirement in requirements.iter().filter(|r| is_level(r) && is_judged(r)) {
        let Bound::Min(limit) = requirement.bound else { continue };
        if !(requirement.lo_joint > 0.0) || requirement.value.is_err() {
            return None;
        }
        // At the limit the value decides, not the interval's end.
        let known = match &requirement.value {
            Ok(value) if requirement.at_the_limit => *value,
            _ => requirement.lo_joint,
        };
        let factor = limit / known;
        if least.is_none_or(|(found, _)| factor > found) {
            least = Some((factor, requirement));
        }
    }
    let (factor, by) = least?;
    let factor = rounded_up(factor);
    Some(Dimming {
        factor,
        subject: by.subject.clone(),
        quantity: by.quantity.key(),
        others_pass: others_pass(&at(factor)),
        groups: None,
    })
}

/// Whether all passes that less light does not fail: upper limits, glare, uniformities, ratios.
fn others_pass(requirements: &[Requirement]) -> bool {
    let is_other = |r: &&Requirement| !is_level(r) || matches!(r.bound, Bound::Max(_));
    let mut others = requirements.iter().filter(|r| is_judged(r)).filter(is_other);
    others.all(|r| r.verdict == Verdict::Pass)
}

fn is_level(requirement: &Requirement) -> bool {
    matches!(requirement.quantity.unit(), "lx" | "cd/m²") && !requirement.statistic.is_ratio()
}

fn is_judged(requirement: &Requirement) -> bool {
    matches!(requirement.verdict, Verdict::Pass | Verdict::Fail | Verdict::Undecided | Verdict::Undefined)
}

/// A factor that must hold as it is printed: three significant figures, never rounded down.
pub fn rounded_up(factor: f64) -> f64 {
    if !(factor > 0.0 && factor.is_finite()) {
        return factor;
    }
    let decimals = 2 - factor.log10().floor() as i32;
    let scale = 10f64.powi(decimals.abs());
    // What is a number of three figures already, but for the last bits, stays.
    let whole = |x: f64| (x * (1.0 - 1e-12)).ceil();
    if decimals >= 0 { whole(factor * scale) / scale } else { whole(factor / scale) * scale }
}

/// A value as norms print it, rounded half-up: illuminance and luminance to three significant figures,
/// ratios and probabilities to 0.01, UGR and other indices of glare to 0.1.
pub fn printed(value: f64, quantity: Quantity, statistic: Statistic) -> f64 {
    let to = |step: f64| ((value / step) + 0.5 + 1e-12).floor() * step;
    let is_ratio = statistic.is_ratio() || quantity.is_luminance_ratio();
    if is_ratio || quantity == Quantity::Modelling || quantity.is_probability() {
        to(0.01)
    } else if matches!(quantity, Quantity::Ugr | Quantity::OfView { unit: "1" | "%", .. }) {
        to(0.1)
    } else if quantity.is_single() && !matches!(quantity, Quantity::OfView { .. }) {
        value
    } else if value > 0.0 && value.is_finite() {
        to(10f64.powi(value.log10().floor() as i32 - 2))
    } else {
        value
    }
}

/// Risk spent at look `look` (1-based): α/(k(k+1)), which sums to α over all looks.
pub fn look_alpha(alpha: f64, look: u32) -> f64 {
    let k = f64::from(look);
    alpha / (k * (k + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gauged(value: f64, lo: f64, hi: f64) -> Gauged {
        Gauged { value: Ok(value), se: 1.0, lo, hi, place: None }
    }

    fn verdict(g: &Gauged, bound: Bound) -> (Verdict, bool) {
        let judged = judge(g, Quantity::Horizontal, Statistic::Mean, bound, Compare::Exact);
        (judged.verdict, judged.at_the_limit)
    }

    #[test]
    fn intervals_decide_and_overlap_does_not() {
        assert_eq!(verdict(&gauged(520.0, 505.0, 535.0), Bound::Min(500.0)), (Verdict::Pass, false));
        assert_eq!(verdict(&gauged(480.0, 465.0, 495.0), Bound::Min(500.0)), (Verdict::Fail, false));
        assert_eq!(verdict(&gauged(505.0, 490.0, 520.0), Bound::Min(500.0)), (Verdict::Undecided, false));
        assert_eq!(verdict(&gauged(520.0, 505.0, 535.0), Bound::Max(500.0)), (Verdict::Fail, false));
    }

    #[test]
    fn within_half_a_percent_the_value_decides_and_says_so() {
        assert_eq!(verdict(&gauged(500.2, 499.0, 501.4), Bound::Min(500.0)), (Verdict::Pass, true));
        assert_eq!(verdict(&gauged(499.8, 499.0, 500.6), Bound::Min(500.0)), (Verdict::Fail, true));
    }

    #[test]
    fn printing_rounds_half_up_and_may_change_the_verdict() {
        assert!((printed(499.5, Quantity::Horizontal, Statistic::Mean) - 500.0).abs() < 1e-9);
        assert!((printed(0.595, Quantity::Horizontal, Statistic::U0) - 0.6).abs() < 1e-9);
        assert!((printed(19.04, Quantity::Ugr, Statistic::Value) - 19.0).abs() < 1e-9);
        let g = gauged(19.04, 19.03, 19.049);
        let of = |compare| judge(&g, Quantity::Ugr, Statistic::Value, Bound::Max(19.0), compare).verdict;
        assert_eq!((of(Compare::Exact), of(Compare::Printed)), (Verdict::Fail, Verdict::Pass));
    }

    #[test]
    fn the_blocks_needed_grow_with_the_square_of_noise_over_distance() {
        let needed = |value: f64, half: f64| {
            let g = gauged(value, value - half, value + half);
            blocks_needed(&g, Quantity::Horizontal, Bound::Min(500.0), 64)
        };
        assert_eq!(needed(510.0, 20.0), Some(256), "twice too wide: four times the blocks");
        assert_eq!(needed(490.0, 20.0), Some(256), "on either side");
        assert_eq!(needed(500.0, 25.0), Some(6400), "at the limit: the indifference of 2.5 lx decides");
        assert_eq!(needed(500.0, f64::INFINITY), None);
    }

    /// Catches: a factor rounded to nearest, at which the room then fails; one that is given too few figures.
    #[test]
    fn a_factor_that_must_hold_is_never_rounded_down() {
        let said =
            [(0.10495, 0.105), (0.012_34, 0.0124), (0.61, 0.61), (1.0, 1.0), (0.9991, 1.0), (3.001, 3.01)];
        for (exact, rounded) in said {
            assert!((rounded_up(exact) - rounded).abs() < 1e-12, "{exact}: {}", rounded_up(exact));
        }
        assert!((rounded_up(1234.0) - 1240.0).abs() < 1e-9 && rounded_up(0.0).abs() < 1e-12);
    }

    #[test]
    fn risks_of_all_looks_sum_to_alpha() {
        let sum: f64 = (1..100_000).map(|look| look_alpha(0.05, look)).sum();
        assert!(sum < 0.05 && sum > 0.0499);
    }
}
