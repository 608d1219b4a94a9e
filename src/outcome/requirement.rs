//! A requirement with its value, interval and verdict.

use serde::Serialize;

use crate::quantity::{Quantity, Statistic};
use crate::units::Undefined;

/// Limit of a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Bound {
    /// At least.
    Min(f64),
    /// At most.
    Max(f64),
}

/// A requirement with its verdict.
#[derive(Clone, Debug)]
pub struct Requirement {
    /// Where it comes from: norm key, or `project` for `[[require]]`.
    pub standard: String,
    /// Clause or row.
    pub clause: String,
    /// Room name.
    pub room: String,
    /// Area, viewpoint or room.
    pub subject: String,
    /// Light scene.
    pub light_scene: String,
    /// Quantity.
    pub quantity: Quantity,
    /// Statistic.
    pub statistic: Statistic,
    /// Limit.
    pub bound: Bound,
    /// Value, or why it has none.
    pub value: Result<f64, Undefined>,
    /// Family-wise interval over the room's requirements.
    pub lo_joint: f64,
    /// See `lo_joint`.
    pub hi_joint: f64,
    /// Signed distance to the limit in units of the limit (UGR: in UGR), positive when it complies.
    pub margin: Option<f64>,
    /// The verdict.
    pub verdict: Verdict,
    /// Decided by value within the indifference margin.
    pub at_the_limit: bool,
    /// Verdict under the other comparison (exact/printed) where it differs.
    pub other_comparison: Option<Verdict>,
    /// Where an undecided requirement stands: blocks that would probably decide it, at the noise found
    /// so far.
    pub blocks_needed: Option<usize>,
    /// Where the norm's own illuminance was raised or lowered for the context of the room.
    pub modified: Option<Modified>,
    /// `two-sources`, `one-source`, `unverified`, `unknown` (the value is not in the norm's file), or
    /// `project`.
    pub verified: String,
    /// How the value came about, when that needs saying ("table method, SHR 0.25").
    pub note: String,
    /// What each modelling omission may cost of the margin, one sentence each.
    pub at_risk: Vec<String>,
}

/// In a note: the area lies in another plane than the one its row speaks of, whose height follows. The table
/// says it below, since the verdict is one on another plane.
pub const OTHER_PLANE: &str = "the row names a plane at";

/// How the reason of a limit begins that the project sets aside (`instead` of a `[[require]]`).
pub const SET_ASIDE: &str = "set aside, the project has a limit of its own";

/// A limit that stands instead of the norm's own.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Modified {
    /// The norm's own limit, lx.
    pub required_lx: f64,
    /// Steps along the norm's scale of illuminance; `None`: the row's value for difficult conditions.
    pub steps: Option<i32>,
    /// Why, in the project's words.
    pub reason: String,
}

/// Verdict on a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Certainly complies.
    Pass,
    /// Certainly does not.
    Fail,
    /// The interval contains the limit.
    Undecided,
    /// There is no value; the reason stands in the requirement.
    Undefined,
    /// Declared by the user beside the limit; not computed.
    Declared,
    /// The norm has no limit or gershun does not compute it.
    NotAssessed,
}
