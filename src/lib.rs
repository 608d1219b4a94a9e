//! gershun: lighting quality from spatial-angular luminance.
//!
//! One line of data flow: project → plan → prepare → answer → measure → judge → report.
//! `docs/architecture.md` is the map.

pub mod assemble;
pub mod digest;
pub mod emitters;
pub mod estimate;
pub mod field;
pub mod geometry;
pub mod glare;
pub mod grid;
pub mod image;
pub mod judge;
pub mod lamp;
pub mod luminaire;
pub mod material;
pub mod measure;
pub mod norm;
pub mod observe;
pub mod outcome;
pub mod photometry;
pub mod plan;
pub mod project;
pub mod quantity;
pub mod query;
pub mod report;
pub mod rng;
pub mod scene;
pub mod solve;
pub mod sphere;
pub mod units;

mod biases;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use crate::assemble::{Context, seen_by_views};
use crate::measure::Answers;
use crate::outcome::{NormOutcome, Outcome, Requirement, RoomOutcome, Solver, Value, Verdict};
use crate::plan::{Plan, PlanError};
use crate::project::{Goal, Project, World};
use crate::solve::{Counts, Effort, Method, Sheet};

/// How hard to try. The project's goal says what to reach, this says where to give up.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Estimator.
    pub method: Method,
    /// Effort of one block.
    pub effort: Effort,
    /// Fewest blocks from which an interval is trusted.
    pub least_blocks: usize,
    /// Most blocks.
    pub most_blocks: usize,
    /// Exactly this many blocks, whatever the goal.
    /// One number for each world; the last one holds for all that follow.
    pub exact_blocks: Option<Vec<usize>>,
    /// Wall time after which no further blocks are started, s.
    pub seconds: Option<f64>,
    /// Relative standard error of [`Goal::Verdict`] where nothing is required.
    pub relative: f64,
    /// Memory for sheets, bytes: fewer blocks are kept if they would not fit.
    pub memory_bytes: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::Links,
            effort: Effort::default(),
            least_blocks: 32,
            most_blocks: 1024,
            exact_blocks: None,
            seconds: None,
            relative: 0.005,
            memory_bytes: 4 << 30,
        }
    }
}

/// What a run tells while it goes on.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// World that is solved, counted from 0.
    pub world: usize,
    /// Number of worlds.
    pub worlds: usize,
    /// Name of its first room.
    pub room: &'a str,
    /// Blocks done in this world.
    pub blocks: usize,
    /// Blocks after which is looked next.
    pub target: usize,
    /// Requirements not yet certain at the last look.
    pub open: usize,
}

/// Watches a run: is told of progress and may interrupt it.
pub struct Watch<'a> {
    /// Called after every batch of blocks.
    pub progress: &'a (dyn Fn(Progress) + Sync),
    /// Set to stop at the next block's end; what was done is kept.
    pub interrupted: &'a AtomicBool,
}

/// Why a project could not be run.
#[derive(Clone, Debug, thiserror::Error)]
pub enum RunError {
    /// Planning found mistakes in areas or rows.
    #[error("{}", list(.0))]
    Plan(Vec<PlanError>),
}

fn list(errors: &[PlanError]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n\n")
}

/// Runs a project from its plan to the outcome.
///
/// # Errors
/// [`RunError::Plan`] before anything is solved.
pub fn run(project: &Project, settings: &Settings, watch: &Watch) -> Result<Outcome, RunError> {
    let planned: Vec<Result<Plan, Vec<PlanError>>> =
        project.worlds.iter().map(|world| plan::plan(project, world)).collect();
    let errors: Vec<PlanError> =
        planned.iter().filter_map(|plan| plan.as_ref().err()).flatten().cloned().collect();
    if !errors.is_empty() {
        return Err(RunError::Plan(errors));
    }
    let mut total = Total::default();
    let started = Instant::now();
    for (index, (world, plan)) in project.worlds.iter().zip(planned.into_iter().flatten()).enumerate() {
        let stop = solve_world(project, world, &plan, settings, watch, started, index, &mut total);
        total
            .plan
            .extend(plan.reasons.into_iter().filter(|reason| index == 0 || !reason.contains("receivers")));
        total.stopped = total.stopped.max(Some(stop));
    }
    total.plan.dedup();
    Ok(total.outcome(project, settings))
}

/// Why a world's blocks ended, in order of gravity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Stop {
    Certain,
    Accurate,
    Asked,
    Limit,
    Time,
    Interrupted,
}

/// What has been collected over worlds.
#[derive(Default)]
struct Total {
    rooms: Vec<RoomOutcome>,
    values: Vec<Value>,
    requirements: Vec<Requirement>,
    plan: Vec<String>,
    biases: Vec<outcome::Bias>,
    tables: measure::room_ugr::Tables,
    counts: Counts,
    blocks: Vec<usize>,
    stopped: Option<Stop>,
}

/// The loop: blocks until every verdict is certain, the goal is reached, or a limit is.
#[allow(
    clippy::too_many_arguments,
    reason = "called once; the line of data flow is easier to read than a struct"
)]
fn solve_world(
    project: &Project,
    world: &World,
    plan: &Plan,
    settings: &Settings,
    watch: &Watch,
    started: Instant,
    index: usize,
    total: &mut Total,
) -> Stop {
    let seed = project.accuracy.seed;
    let prepared = solve::prepare(&world.scene, &plan.demand, settings.method, settings.effort, seed);
    let seen = seen_by_views(plan, prepared.emitters(), seed);
    let tables = assemble::ugr_tables(&mut total.tables, project, world, plan);
    let alpha = 1.0 - project.accuracy.confidence;
    let bytes = plan.demand.rows() * world.scene.channels.len() * solve::PARTS * size_of::<f64>();
    let fitting = (settings.memory_bytes / bytes.max(1)).max(settings.least_blocks);
    let exact = settings.exact_blocks.as_ref().and_then(|list| list.get(index).or(list.last()).copied());
    let most = exact.unwrap_or(settings.most_blocks.min(fitting));
    let mut sheets: Vec<Sheet> = Vec::new();
    let mut target = exact.unwrap_or(settings.least_blocks);
    let mut open = 0;
    loop {
        let finished = extend(&prepared, &mut sheets, target, settings, watch, started, |blocks| {
            let room = world.rooms.first().map_or("", |room| room.name.as_str());
            (watch.progress)(Progress {
                world: index,
                worlds: project.worlds.len(),
                room,
                blocks,
                target,
                open,
            });
        });
        let (by_chance, may_hide) = (prepared.by_chance(), prepared.may_hide());
        let answers = Answers { may_hide, by_chance, ..Answers::of(&sheets, &world.scene) };
        let context = Context {
            project,
            world,
            plan,
            answers,
            emitters: prepared.emitters(),
            seen: &seen,
            tables: &tables,
            group_factors: &[],
            alpha,
            joint_alpha: judge::look_alpha(alpha, look_at(sheets.len(), settings.least_blocks)),
        };
        let required: Vec<Vec<Requirement>> =
            (0..world.rooms.len()).map(|room| context.requirements(room)).collect();
        open = required.iter().flatten().filter(|r| r.verdict == Verdict::Undecided).count();
        let decided = open == 0 && required.iter().flatten().next().is_some();
        let stop = match (finished, project.accuracy.goal) {
            (Some(stop), _) => Some(stop),
            (None, _) if exact.is_some() => Some(Stop::Asked),
            (None, Goal::Verdict) if decided => Some(Stop::Certain),
            (None, Goal::Verdict)
                if required.iter().all(Vec::is_empty) && context.accurate(settings.relative) =>
            {
                Some(Stop::Accurate)
            }
            (None, Goal::Relative(r)) if context.accurate(r) => Some(Stop::Accurate),
            (None, _) if sheets.len() >= most => Some(Stop::Limit),
            (None, _) => None,
        };
        if let Some(stop) = stop {
            for (room, required) in required.into_iter().enumerate() {
                let (mut outcome, values) = context.room(room);
                let views = &plan.rooms[room].views;
                observe::cards::add(
                    &mut outcome.viewpoints,
                    &prepared,
                    project,
                    world,
                    room,
                    views,
                    &seen[room],
                );
                total.rooms.push(outcome);
                total.values.extend(values);
                total.requirements.extend(required);
            }
            for sheet in &sheets {
                total.counts.add(sheet.counts);
            }
            total.blocks.push(sheets.len());
            let scenes = &project.light_scenes;
            biases::add(&mut total.biases, world, scenes, settings, &answers, prepared.emitters());
            return stop;
        }
        target = (2 * target).min(most);
    }
}

/// The how-manieth look a run has after `blocks` blocks. It depends on their number only, so that
/// `--blocks N` repeats a run that stopped after N for whatever reason, intervals included.
fn look_at(blocks: usize, least_blocks: usize) -> u32 {
    let rounds = blocks.div_ceil(least_blocks.max(1)).max(1);
    1 + rounds.next_power_of_two().ilog2()
}

/// Adds blocks up to `target`, in batches so that time and interruption are noticed; why it ended early.
fn extend(
    prepared: &solve::Prepared,
    sheets: &mut Vec<Sheet>,
    target: usize,
    settings: &Settings,
    watch: &Watch,
    started: Instant,
    tell: impl Fn(usize),
) -> Option<Stop> {
    // A fixed batch: what is computed never depends on the number of threads.
    const BATCH: usize = 16;
    while sheets.len() < target {
        let first = sheets.len();
        let last = (first + BATCH).min(target);
        sheets.par_extend(
            (first as u64..last as u64).into_par_iter().map(|block| solve::answer(prepared, block)),
        );
        tell(sheets.len());
        let enough = sheets.len() >= settings.least_blocks.min(target);
        if enough && watch.interrupted.load(Ordering::Relaxed) {
            return Some(Stop::Interrupted);
        }
        if enough && settings.seconds.is_some_and(|limit| started.elapsed().as_secs_f64() >= limit) {
            return Some(Stop::Time);
        }
    }
    None
}

impl Total {
    fn outcome(self, project: &Project, settings: &Settings) -> Outcome {
        let norm = project.norm.as_ref().map(|norm| NormOutcome {
            id: norm.standard.id.clone(),
            short: norm.standard.short.clone(),
            title: norm.standard.title.clone(),
            edition: norm.standard.edition.clone(),
            compare: norm.compare,
        });
        let stopped = match self.stopped {
            Some(Stop::Certain) => "verdicts certain",
            Some(Stop::Accurate) => "accuracy reached",
            Some(Stop::Asked) => "blocks asked for",
            Some(Stop::Limit) => "block limit",
            Some(Stop::Time) => "time",
            Some(Stop::Interrupted) => "interrupted",
            None => "nothing to solve",
        };
        let mut biases: Vec<outcome::Bias> = project
            .biases
            .iter()
            .map(|what| outcome::Bias { what: what.clone(), effect: "not quantified".into(), share: None })
            .collect();
        for bias in self.biases {
            if !biases.contains(&bias) {
                biases.push(bias);
            }
        }
        let mut requirements = self.requirements;
        for requirement in &mut requirements {
            requirement.at_risk = biases::risks(&biases, requirement);
        }
        Outcome {
            info: project.info.clone(),
            rooms: self.rooms,
            norm,
            values: self.values,
            requirements,
            solver: Solver {
                method: match settings.method {
                    Method::Links => "links",
                    Method::Path => "path",
                    Method::Local => "local",
                    Method::Double => "double",
                }
                .into(),
                blocks: self.blocks.iter().copied().max().unwrap_or(0),
                blocks_by_world: self.blocks,
                stopped: stopped.into(),
                seed: project.accuracy.seed,
                confidence: project.accuracy.confidence,
                triangles: project.worlds.iter().map(|world| world.scene.mesh.triangles.len()).sum(),
                luminaires: project.worlds.iter().map(|world| world.scene.luminaires.len()).sum(),
                lost_rays: self.counts.escaped,
                rays: self.counts.rays,
            },
            plan: self.plan,
            biases,
            inputs: project.inputs.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: intervals that depend on why a run stopped and not on its blocks alone.
    #[test]
    fn looks_are_counted_by_blocks() {
        // A run looks after 32, 64, 128 … blocks, at the limit, and where time or the user ends it.
        for (blocks, look) in [(2, 1), (32, 1), (48, 2), (64, 2), (80, 3), (128, 3), (1000, 6), (1024, 6)] {
            assert_eq!(look_at(blocks, 32), look, "{blocks}");
        }
    }
}
