//! What a run produced: measured values, verdicts, and everything a reader needs to trust them.
//! The report writes this and nothing else; it holds no clock, host, thread count or absolute path.

mod card;
mod requirement;
mod room;

use serde::Serialize;

pub use card::{Card, PlacedSource, Remedy, Shift};
pub use requirement::*;
pub use room::*;

use crate::project::{Compare, Info, InputFile};

/// Result of `run`.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Head of the report.
    pub info: Info,
    /// Rooms in project order.
    pub rooms: Vec<RoomOutcome>,
    /// Norm title and edition, if a norm was applied.
    pub norm: Option<NormOutcome>,
    /// Every value that was measured, in canonical order.
    pub values: Vec<Value>,
    /// Requirements with their verdicts.
    pub requirements: Vec<Requirement>,
    /// How it was solved.
    pub solver: Solver,
    /// Reasons of the plan, one sentence each.
    pub plan: Vec<String>,
    /// Every clamp, cut, approximation or omission that was switched on or met.
    pub biases: Vec<Bias>,
    /// Input files.
    pub inputs: Vec<InputFile>,
}

/// The norm that was applied.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NormOutcome {
    /// Key, `en-12464-1-2021`.
    pub id: String,
    /// What a verdict calls it, `EN 12464-1:2021`.
    pub short: String,
    /// Title as printed.
    pub title: String,
    /// Edition.
    pub edition: String,
    /// Exact or printed.
    pub compare: Compare,
}

/// A bias: what was done, and how large its effect is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bias {
    /// What it is, one sentence.
    pub what: String,
    /// Its measured or bounded effect, in words with a figure, or "not quantified".
    pub effect: String,
    /// Largest share of an illuminance that it may cost or add; `None` where that is not known.
    pub share: Option<f64>,
}

/// How the answers were computed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Solver {
    /// `links` or `path`.
    pub method: String,
    /// Blocks of the world that took most.
    pub blocks: usize,
    /// Blocks of each world (the box or CAD file, each footprint room), in project order.
    pub blocks_by_world: Vec<usize>,
    /// Why it stopped: `verdicts certain`, `block limit`, `accuracy reached`, `time`, `interrupted`,
    /// `blocks asked for`. Told to the user and kept out of every file: `--blocks N` repeats a run that
    /// stopped after N blocks byte for byte, whatever stopped it.
    #[serde(skip)]
    pub stopped: String,
    /// Seed.
    pub seed: u64,
    /// Individual confidence.
    pub confidence: f64,
    /// Triangles over all worlds.
    pub triangles: usize,
    /// Luminaires over all worlds.
    pub luminaires: usize,
    /// Rays lost through cracks or at degenerate places, and all rays.
    pub lost_rays: u64,
    /// All rays traced in blocks.
    pub rays: u64,
}

impl Outcome {
    /// Verdict of the whole: fail before undecided or undefined before pass; `None` if nothing was required.
    pub fn verdict(&self) -> Option<Verdict> {
        let has = |verdict| self.requirements.iter().any(|r| r.verdict == verdict);
        if has(Verdict::Fail) {
            Some(Verdict::Fail)
        } else if has(Verdict::Undecided) || has(Verdict::Undefined) {
            Some(Verdict::Undecided)
        } else if has(Verdict::Pass) {
            Some(Verdict::Pass)
        } else {
            None
        }
    }
}
