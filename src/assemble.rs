//! Plan and sheets → requirements with verdicts, and everything the report shows.

mod cheapest;
mod dimming;
mod flux;
mod gauge;
mod listed;
mod room;

use crate::emitters::{Emitters, Sighted};
use crate::judge::{self, Judged};
use crate::measure::{self, Answers, area, room_ugr};
use crate::norm::State;
use crate::outcome::{Bound, Condition, Requirement, UgrTableOutcome, Verdict};
use crate::plan::{Plan, PlannedQuantity, PlannedRequirement, Subject};
use crate::project::{Compare, Project, Room, World};
use crate::quantity::Statistic;
use crate::scene::Channel;

/// Everything that is measured on one world after some blocks.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// The project.
    pub project: &'a Project,
    /// The world.
    pub world: &'a World,
    /// Its plan.
    pub plan: &'a Plan,
    /// Its answers so far.
    pub answers: Answers<'a>,
    /// Its luminaires.
    pub emitters: &'a Emitters<'a>,
    /// What each planned view of each room sees, computed once.
    pub seen: &'a [Vec<Sighted>],
    /// For each room, the UGR table method's values for each spacing-to-height ratio asked for.
    pub tables: &'a [Vec<(f64, Vec<UgrTableOutcome>)>],
    /// Factors on luminaire groups beyond those of the light scene; empty: none.
    pub group_factors: &'a [(String, f64)],
    /// Risk of an individual interval.
    pub alpha: f64,
    /// Risk of all requirements of a room at this look.
    pub joint_alpha: f64,
}

/// The table method's values of every room: the norm's ratio first, then others that are required.
pub fn ugr_tables(
    tables: &mut room_ugr::Tables,
    project: &Project,
    world: &World,
    plan: &Plan,
) -> Vec<Vec<(f64, Vec<UgrTableOutcome>)>> {
    let usual = project.norm.as_ref().map_or(0.25, |norm| norm.standard.application.ugr_shr.value);
    let rooms = world.rooms.iter().zip(&plan.rooms);
    rooms
        .map(|(room, planned)| {
            let mut ratios = vec![usual];
            for requirement in &planned.requirements {
                if let Subject::UgrTable(shr) | Subject::DiscomfortTable(shr) = requirement.subject
                    && !ratios.iter().any(|known| known.to_bits() == shr.to_bits())
                {
                    ratios.push(shr);
                }
            }
            ratios.into_iter().map(|shr| (shr, room_ugr::of_room(tables, world, room, shr))).collect()
        })
        .collect()
}

/// The sources seen by every planned view.
pub fn seen_by_views(plan: &Plan, emitters: &Emitters, seed: u64) -> Vec<Vec<Sighted>> {
    use rayon::prelude::*;
    plan.rooms
        .iter()
        .map(|room| {
            room.views
                .par_iter()
                .map(|view| crate::emitters::sighted_from(emitters, view.eye, seed, view.highlights))
                .collect()
        })
        .collect()
}

impl Context<'_> {
    /// All requirements of a room, judged.
    pub fn requirements(&self, room: usize) -> Vec<Requirement> {
        let planned = &self.plan.rooms[room];
        let family = planned.requirements.iter().filter(|r| is_computed(&r.subject)).count().max(1);
        let alpha = self.joint_alpha / family as f64;
        planned.requirements.iter().map(|requirement| self.requirement(room, requirement, alpha)).collect()
    }

    fn requirement(&self, room: usize, planned: &PlannedRequirement, alpha: f64) -> Requirement {
        let compare = self.project.norm.as_ref().map_or(Compare::Exact, |norm| norm.compare);
        let (gauged, note, forced) = self.gauge(room, planned, alpha);
        let other = if compare == Compare::Exact { Compare::Printed } else { Compare::Exact };
        let judge =
            |compare| judge::judge(&gauged, planned.quantity, planned.statistic, planned.bound, compare);
        let Judged { verdict, at_the_limit, margin } = judge(compare);
        let verdict = match (forced, verdict) {
            (Some(Verdict::Declared), Verdict::Fail) => Verdict::Fail,
            (Some(forced), _) => forced,
            (None, verdict) => verdict,
        };
        let otherwise = judge(other).verdict;
        let blocks_needed = (verdict == Verdict::Undecided)
            .then(|| judge::blocks_needed(&gauged, planned.quantity, planned.bound, self.answers.blocks()))
            .flatten();
        Requirement {
            standard: planned.standard.clone(),
            clause: planned.clause.clone(),
            room: self.world.rooms[room].name.clone(),
            subject: planned.subject_name.clone(),
            light_scene: self.project.light_scenes[planned.light_scene].name.clone(),
            quantity: planned.quantity,
            statistic: planned.statistic,
            bound: planned.bound,
            value: gauged.value.clone(),
            lo_joint: gauged.lo,
            hi_joint: gauged.hi,
            margin,
            verdict,
            at_the_limit,
            other_comparison: (forced.is_none() && otherwise != verdict).then_some(otherwise),
            blocks_needed,
            modified: planned.modified.clone(),
            verified: planned.verified.clone(),
            note,
            at_risk: Vec::new(),
        }
    }

    /// Weights of a new installation.
    fn initial(&self, light_scene: usize, room: &Room) -> Vec<f64> {
        let weights = measure::weights(self.world, &self.project.light_scenes[light_scene], room, false);
        self.dimmed(weights)
    }

    /// Weights times the factors of their groups.
    fn dimmed(&self, mut weights: Vec<f64>) -> Vec<f64> {
        for (weight, channel) in weights.iter_mut().zip(&self.world.scene.channels) {
            let own = self
                .group_factors
                .iter()
                .find(|(known, _)| matches!(channel, Channel::Luminaires { group, .. } if group == known));
            *weight *= own.map_or(1.0, |(_, factor)| *factor);
        }
        weights
    }

    /// The condition in which the project's norm judges illuminances; maintained without one.
    fn condition(&self) -> Condition {
        self.project.norm.as_ref().map_or(Condition::MAINTAINED, |norm| {
            let rules = &norm.standard.application;
            Condition { state: rules.illuminance_state.value, light: rules.light.value }
        })
    }

    /// The condition in which a requirement is judged: the norm's, in which its upper limits of illuminances may
    /// have a state of their own.
    fn condition_of(&self, planned: &PlannedRequirement) -> Condition {
        let usual = self.condition();
        let norm = self.project.norm.as_ref().map(|norm| &norm.standard);
        let is_upper = matches!(planned.bound, Bound::Max(_))
            && planned.quantity.unit() == "lx"
            && !planned.statistic.is_ratio();
        match norm.filter(|norm| norm.id == planned.standard && is_upper) {
            Some(norm) if usual.state == State::Maintained => {
                Condition { state: norm.application.upper_limit_state.value, ..usual }
            }
            _ => usual,
        }
    }

    /// Weights of the norm's condition.
    fn weights(&self, light_scene: usize, room: &Room) -> Vec<f64> {
        self.weights_in(self.condition().state, light_scene, room)
    }

    /// Weights of a state.
    fn weights_in(&self, state: State, light_scene: usize, room: &Room) -> Vec<f64> {
        let light_scene = &self.project.light_scenes[light_scene];
        self.dimmed(match state {
            State::Maintained => measure::weights(self.world, light_scene, room, true),
            State::Initial => measure::weights(self.world, light_scene, room, false),
            State::Emergency => measure::emergency_weights(self.world, light_scene, room),
        })
    }

    /// Block values of a planned quantity under a light scene in the norm's condition.
    fn blocks(&self, entry: &PlannedQuantity, light_scene: usize, room: &Room) -> area::Blocks {
        area::blocks(&self.answers, entry, &self.weights(light_scene, room), self.condition().light)
    }

    /// Whether every requested value has reached a relative standard error `r` (UGR: 3.5 r).
    pub fn accurate(&self, r: f64) -> bool {
        (0..self.plan.rooms.len()).all(|room| {
            let entry = &self.world.rooms[room];
            let planned = &self.plan.rooms[room];
            let areas = planned.areas.iter().all(|area| {
                let own = area.quantities.iter();
                own.map(|quantity| self.blocks(quantity, area.light_scene, entry))
                    .all(|blocks| fine(&blocks, r))
            });
            let views = (0..planned.views.len()).all(|index| {
                let ugr = self.glare(room, index, planned.views[index].light_scene, self.alpha, &[]).ugr;
                let weights = self.initial(planned.views[index].light_scene, entry);
                let zones = self.zones(room, index, &weights);
                let field = self.field(room, index, &weights);
                (ugr.value.is_err() || ugr.se <= 3.5 * r)
                    && zones.is_none_or(|zones| zones.is_within(r))
                    && field.is_none_or(|field| field.is_within(r))
            });
            areas && views
        })
    }
}

/// RMS over points of se/value and the relative errors of the mean within `r`.
fn fine(blocks: &area::Blocks, r: f64) -> bool {
    let relative = |values: &[f64]| {
        let estimate = crate::estimate::Estimate::from_blocks(values);
        if estimate.se > 0.0 { estimate.se / estimate.value.abs() } else { 0.0 }
    };
    let count = blocks.values.len().max(1) as f64;
    if blocks.is_unseen() {
        return false;
    }
    let square = blocks.values.iter().map(|point| relative(point).powi(2)).sum::<f64>() / count;
    let statistics = [Statistic::Mean, Statistic::Min, Statistic::Max].map(|s| area::gauge(blocks, s, 0.5));
    let all = statistics.iter().all(|g| g.value.as_ref().map_or(true, |v| !(g.se > r * v.abs())));
    square.sqrt() <= r && all
}

fn is_computed(subject: &Subject) -> bool {
    matches!(subject, Subject::Area(..) | Subject::OfTask(..) | Subject::Viewpoint(_))
}
