//! Dimming by groups: the factors on the luminaire groups of a room with which all its verdicts still pass,
//! at the least power. Every illuminance and every contrast of a uniformity is linear in the factors, its
//! standard error their norm, so the factors that comply form a convex set; cutting planes find its
//! cheapest point.
//!
//! The factors are chosen by looking at the data, so an ordinary interval would promise too much. Bounds are
//! Scheffé's, which hold for *all* factors at once: m·x − T √(xᵀCx) with
//! T² = G (n − 1)/(n − G) · F(1 − α; G, n − G) for G groups and n blocks.

use super::Context;
use super::cheapest::{Row, cheapest};
use super::is_computed;
use crate::estimate::scheffe;
use crate::judge::rounded_up;
use crate::measure::area;
use crate::outcome::{Bound, GroupDimming, GroupFactor, Requirement, Verdict};
use crate::plan::{PlannedQuantity, PlannedRequirement, Rows, Subject};
use crate::quantity::{Quantity, Statistic};
use crate::scene::Channel;

/// Cuts after which the point found is taken as it is; it is checked in any case.
const MOST_CUTS: usize = 400;
/// A bound, as a share of its scale, that counts as reached.
const REACHED: f64 = 1e-6;

/// A linear quantity that must not fall below `least`: means of its parts by group, and the covariance of
/// the means, both divided by a scale so that they are about 1.
struct Demand {
    mean: Vec<f64>,
    covariance: Vec<Vec<f64>>,
    least: f64,
    /// Scheffé's multiplier.
    multiplier: f64,
}

impl Demand {
    /// From block values `[group][block]`.
    fn new(blocks: &[Vec<f64>], least: f64, multiplier: f64) -> Option<Self> {
        let count = blocks.first()?.len() as f64;
        let mean: Vec<f64> = blocks.iter().map(|values| values.iter().sum::<f64>() / count).collect();
        let scale = if least > 0.0 { least } else { mean.iter().map(|m| m.abs()).sum::<f64>() };
        if !(scale > 0.0 && count > 1.0) {
            return None;
        }
        let covariance = |i: usize, j: usize| {
            let products = blocks[i].iter().zip(&blocks[j]).map(|(a, b)| (a - mean[i]) * (b - mean[j]));
            products.sum::<f64>() / (count * (count - 1.0) * scale * scale)
        };
        let groups = 0..blocks.len();
        Some(Self {
            covariance: groups.clone().map(|i| groups.clone().map(|j| covariance(i, j)).collect()).collect(),
            mean: mean.iter().map(|m| m / scale).collect(),
            least: least / scale,
            multiplier,
        })
    }

    /// Lower end minus the limit, and its slope.
    fn slack(&self, x: &[f64]) -> (f64, Vec<f64>) {
        let product = |row: &Vec<f64>| row.iter().zip(x).map(|(c, x)| c * x).sum::<f64>();
        let slope: Vec<f64> = self.covariance.iter().map(product).collect();
        let error = product(&slope).max(0.0).sqrt();
        let by_error = |s: &f64| if error > 0.0 { self.multiplier * s / error } else { 0.0 };
        let slope = self.mean.iter().zip(&slope).map(|(m, s)| m - by_error(s)).collect();
        (product(&self.mean) - self.multiplier * error - self.least, slope)
    }
}

impl Context<'_> {
    /// A room's requirements with all luminaires of the world at a factor.
    pub(super) fn dimmed_to(&self, room: usize, factor: f64) -> Vec<Requirement> {
        let mut factors: Vec<(String, f64)> = Vec::new();
        for channel in &self.world.scene.channels {
            if let Channel::Luminaires { group, .. } = channel
                && !factors.iter().any(|(known, _)| known == group)
            {
                factors.push((group.clone(), factor));
            }
        }
        Context { group_factors: &factors, ..*self }.requirements(room)
    }

    /// The cheapest factors; `None` for fewer than two groups, where something does not pass at full
    /// output, or where Scheffé's wider bounds are not reached at full output.
    pub(super) fn group_dimming(&self, room: usize) -> Option<GroupDimming> {
        let (groups, prices, unit) = self.groups(room)?;
        let full = self.requirements(room);
        // What an eye must get at least is no mean over an area: no bound here holds it for all factors.
        if full.iter().any(|r| {
            matches!((r.quantity, r.bound), (Quantity::Ugr | Quantity::OfView { .. }, Bound::Min(_)))
        }) {
            return None;
        }
        let judged = |verdict| matches!(verdict, Verdict::Fail | Verdict::Undecided | Verdict::Undefined);
        if full.iter().any(|r| judged(r.verdict)) || !full.iter().any(|r| r.verdict == Verdict::Pass) {
            return None;
        }
        let demands = self.demands(room, &groups)?;
        let reached = |x: &[f64]| demands.iter().all(|demand| demand.slack(x).0 >= -REACHED);
        if !reached(&vec![1.0; groups.len()]) {
            return None;
        }
        let best = least(&prices, &demands)?;
        // Towards full output until all passes: what is not linear in the factors (glare at observers, U_d)
        // is no bound above.
        // Factors have three figures and are checked with them, since that is how they are printed and set.
        let towards =
            |t: f64| -> Vec<f64> { best.iter().map(|x| rounded_up(x + t * (1.0 - x)).min(1.0)).collect() };
        let complies = |x: &[f64]| {
            let factors: Vec<(String, f64)> = groups.iter().cloned().zip(x.iter().copied()).collect();
            let dimmed = Context { group_factors: &factors, ..*self };
            let verdicts = dimmed.requirements(room);
            reached(x) && verdicts.iter().zip(&full).all(|(new, old)| old.verdict == new.verdict)
        };
        let steps = [0.0, 1e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0];
        let x = steps.into_iter().map(towards).find(|x| complies(x))?;
        let sum = |x: &[f64]| prices.iter().zip(x).map(|(p, x)| p * x).sum::<f64>();
        Some(GroupDimming {
            share: sum(&x) / prices.iter().sum::<f64>(),
            of: unit.into(),
            groups: groups.into_iter().zip(x).map(|(group, factor)| GroupFactor { group, factor }).collect(),
        })
    }

    /// Luminaire groups of a room that shine in a light scene by which it is judged, and what each costs in
    /// these scenes together: power, or flux where a power is not known.
    fn groups(&self, room: usize) -> Option<(Vec<String>, Vec<f64>, &'static str)> {
        let scene = &self.world.scene;
        let hung: Vec<_> = self.world.rooms[room].luminaires.iter().map(|&l| &scene.luminaires[l]).collect();
        let mut judged: Vec<usize> = self.plan.rooms[room]
            .requirements
            .iter()
            .filter(|r| is_computed(&r.subject))
            .map(|r| r.light_scene)
            .collect();
        judged.sort_unstable();
        judged.dedup();
        let in_scenes = |group: &str| -> f64 {
            judged.iter().map(|&light_scene| self.project.light_scenes[light_scene].factor(group)).sum()
        };
        let by_power = hung.iter().all(|luminaire| luminaire.kind.power_w.is_some_and(|watts| watts > 0.0));
        let mut groups: Vec<(String, f64)> = Vec::new();
        for luminaire in hung {
            let kind = &luminaire.kind;
            let full = if by_power { kind.power_w.unwrap_or(0.0) } else { kind.flux_lm } * luminaire.dim;
            let price = full * in_scenes(&luminaire.group);
            match groups.iter_mut().find(|(group, _)| *group == luminaire.group) {
                Some((_, sum)) => *sum += price,
                None => groups.push((luminaire.group.clone(), price)),
            }
        }
        // Light of other rooms, and of surfaces that shine of themselves, is not dimmed with these groups.
        let own = |channel: &Channel| match channel {
            Channel::Luminaires { group, .. } => groups.iter().any(|(known, _)| known == group),
            Channel::Surfaces { .. } => false,
        };
        let alone = scene.channels.iter().all(own) && self.world.rooms.len() == 1;
        groups.retain(|(group, _)| in_scenes(group) > 0.0);
        if groups.len() < 2 || !alone || groups.iter().any(|(_, price)| !(*price > 0.0)) {
            return None;
        }
        let (names, prices) = groups.into_iter().unzip();
        Some((names, prices, if by_power { "power" } else { "flux" }))
    }

    /// All linear bounds of a room's requirements.
    fn demands(&self, room: usize, groups: &[String]) -> Option<Vec<Demand>> {
        let planned = &self.plan.rooms[room];
        let linear = |r: &&PlannedRequirement| {
            matches!(r.subject, Subject::Area(..) | Subject::OfTask(..))
                && matches!(r.bound, Bound::Min(_))
                && r.statistic != Statistic::Ud
        };
        let family = planned.requirements.iter().filter(linear).count().max(1);
        let mut demands = Vec::new();
        for requirement in planned.requirements.iter().filter(linear) {
            let Bound::Min(limit) = requirement.bound else { continue };
            let alpha = self.joint_alpha / family as f64;
            demands.extend(self.of_requirement(room, groups, requirement, limit, alpha)?);
        }
        (!demands.is_empty()).then_some(demands)
    }

    fn of_requirement(
        &self,
        room: usize,
        groups: &[String],
        requirement: &PlannedRequirement,
        limit: f64,
        alpha: f64,
    ) -> Option<Vec<Demand>> {
        let areas = &self.plan.rooms[room].areas;
        // Values by group: [group][point][block].
        let parts = |entry: &PlannedQuantity| -> Option<Vec<area::Blocks>> {
            if entry.rows.iter().flatten().any(|rows| matches!(rows, Rows::Ratio(..))) {
                return None;
            }
            Some(groups.iter().map(|group| self.part(room, entry, requirement.light_scene, group)).collect())
        };
        let means =
            |parts: &[area::Blocks]| -> Vec<Vec<f64>> { parts.iter().map(area::mean_blocks).collect() };
        let multiplier = |tests: usize| scheffe(alpha / tests as f64, groups.len(), self.answers.blocks());
        let minus = |a: &[f64], share: f64, b: &[f64]| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| a - share * b).collect()
        };
        match requirement.subject {
            Subject::Area(place, entry) => {
                let parts = parts(&areas[place].quantities[entry])?;
                let points = parts.first()?.values.len();
                match requirement.statistic {
                    Statistic::Mean => {
                        Demand::new(&means(&parts), limit, multiplier(1)).map(|demand| vec![demand])
                    }
                    Statistic::Min => (0..points)
                        .map(|point| {
                            let own: Vec<Vec<f64>> = parts.iter().map(|p| p.values[point].clone()).collect();
                            Demand::new(&own, limit, multiplier(points))
                        })
                        .collect(),
                    Statistic::U0 => {
                        let means = means(&parts);
                        (0..points)
                            .map(|point| {
                                let contrast: Vec<Vec<f64>> = parts
                                    .iter()
                                    .zip(&means)
                                    .map(|(p, mean)| minus(&p.values[point], limit, mean))
                                    .collect();
                                Demand::new(&contrast, 0.0, multiplier(points))
                            })
                            .collect()
                    }
                    Statistic::Max | Statistic::Ud | Statistic::OfTask | Statistic::Value => Some(Vec::new()),
                }
            }
            Subject::OfTask(place, entry, task, of) => {
                let own = means(&parts(&areas[place].quantities[entry])?);
                let task = means(&parts(&areas[task].quantities[of])?);
                let contrast: Vec<Vec<f64>> =
                    own.iter().zip(&task).map(|(own, task)| minus(own, limit, task)).collect();
                Demand::new(&contrast, 0.0, multiplier(1)).map(|demand| vec![demand])
            }
            Subject::Viewpoint(_)
            | Subject::UgrTable(_)
            | Subject::DiscomfortTable(_)
            | Subject::ColourRendering
            | Subject::Declared(_)
            | Subject::Intensity { .. }
            | Subject::Missing(_) => Some(Vec::new()),
        }
    }

    /// Block values of the light of one group alone.
    fn part(&self, room: usize, entry: &PlannedQuantity, light_scene: usize, group: &str) -> area::Blocks {
        let mut weights = self.weights(light_scene, &self.world.rooms[room]);
        for (weight, channel) in weights.iter_mut().zip(&self.world.scene.channels) {
            let own = matches!(channel, Channel::Luminaires { group: of, .. } if of == group);
            *weight *= f64::from(u8::from(own));
        }
        area::blocks(&self.answers, entry, &weights, self.condition().light)
    }
}

/// Cutting planes: the cheapest point under the cuts so far, then a cut where it violates a demand most.
/// A concave function lies below its tangents, so no cut removes a point that complies.
fn least(prices: &[f64], demands: &[Demand]) -> Option<Vec<f64>> {
    let mut cuts: Vec<Row> = Vec::new();
    let mut x = vec![0.0; prices.len()];
    for _ in 0..MOST_CUTS {
        let slacks = demands.iter().map(|demand| demand.slack(&x));
        let worst = slacks.min_by(|(a, _), (b, _)| a.total_cmp(b));
        let Some((slack, slope)) = worst.filter(|(slack, _)| *slack < -0.1 * REACHED) else { break };
        let at: f64 = slope.iter().zip(&x).map(|(s, x)| s * x).sum();
        cuts.push((slope, at - slack));
        x = cheapest(prices, &cuts)?;
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn demand(mean: [f64; 2], sd: [f64; 2], least: f64) -> Demand {
        // Two independent parts with these standard deviations of the mean.
        let covariance = vec![vec![sd[0] * sd[0], 0.0], vec![0.0, sd[1] * sd[1]]];
        Demand { mean: mean.to_vec(), covariance, least, multiplier: 3.0 }
    }

    /// Catches: an optimum of the values instead of the lower ends, one that is not the cheapest.
    #[test]
    fn the_cheapest_factors_lie_on_the_lower_ends() {
        let prices = [1.0, 1.5];
        let demands = [
            demand([0.9, 0.5], [0.02, 0.05], 0.8),
            demand([0.2, 1.0], [0.01, 0.03], 0.5),
            demand([0.6, 0.7], [0.0, 0.0], 0.7),
        ];
        let x = least(&prices, &demands).expect("it is reached");
        assert!(demands.iter().all(|d| d.slack(&x).0 > -2.0 * REACHED), "{x:?}");
        let cost = |x: &[f64]| prices[0] * x[0] + prices[1] * x[1];
        let mut best = f64::INFINITY;
        for i in 0..=1000 {
            for j in 0..=1000 {
                let y = [f64::from(i) / 1000.0, f64::from(j) / 1000.0];
                if demands.iter().all(|d| d.slack(&y).0 >= 0.0) {
                    best = best.min(cost(&y));
                }
            }
        }
        assert!(cost(&x) <= best + 1e-5 && cost(&x) > best - 5e-3, "{} is not {best}", cost(&x));
        assert!(
            least(&prices, &[demand([0.4, 0.5], [0.02, 0.05], 0.9)]).is_none(),
            "full output is too little"
        );
    }

    /// Catches: blocks of the wrong group, a covariance divided by the wrong number.
    #[test]
    fn means_and_errors_come_from_the_blocks() {
        let blocks = [vec![10.0, 12.0, 14.0, 12.0], vec![5.0, 5.0, 5.0, 5.0]];
        let demand = Demand::new(&blocks, 10.0, 2.0).expect("a demand");
        // 12 x + 5 y, standard error √(8/12) x: 0.8165.
        let (slack, slope) = demand.slack(&[1.0, 0.5]);
        let expected = (12.0 + 2.5 - 2.0 * (8.0f64 / 12.0).sqrt() - 10.0) / 10.0;
        assert!((slack - expected).abs() < 1e-12, "{slack} {expected}");
        assert!((slope[1] - 0.5).abs() < 1e-12);
    }
}
