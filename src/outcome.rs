//! What a run produced: measured values, verdicts, and everything a reader needs to trust them.
//! The report writes this and nothing else; it holds no clock, host, thread count or absolute path.

mod card;

use glam::{DVec2, DVec3};
use serde::Serialize;

pub use card::{Card, PlacedSource, Remedy, Shift};

use crate::grid::Grid;
use crate::photometry::IntensityDistribution;
use crate::project::{AreaKind, Compare, Info, InputFile};
use crate::quantity::{Quantity, Statistic};
use crate::units::Undefined;

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

/// A room with its areas, observers, luminaires and flux.
#[derive(Clone, Debug)]
pub struct RoomOutcome {
    /// Name.
    pub name: String,
    /// Number on the plan.
    pub number: String,
    /// Plan outline, m.
    pub footprint: Vec<DVec2>,
    /// Floor level and clear height, m.
    pub floor_m: f64,
    /// Clear height, m.
    pub height_m: f64,
    /// Row of the norm.
    pub row: Option<String>,
    /// Mean reflectances of ceiling, walls, floor.
    pub reflectances: [f64; 3],
    /// Areas.
    pub areas: Vec<AreaOutcome>,
    /// Observers.
    pub viewpoints: Vec<ViewpointOutcome>,
    /// Luminaires in the room, for plans and the schedule.
    pub luminaires: Vec<LuminaireOutcome>,
    /// Luminaire types used in the room.
    pub types: Vec<TypeOutcome>,
    /// Outlines of furniture in plan (convex hull or section), m.
    pub furniture: Vec<Vec<DVec2>>,
    /// Flux balance of the room's world for each light scene, initial flux.
    pub flux: Vec<FluxBalance>,
    /// UGR by the table method, crosswise and endwise, per luminaire type.
    pub ugr_table: Vec<UgrTableOutcome>,
    /// Installed power; `None` where a luminaire's power is not known.
    pub power: Option<Power>,
    /// How far all luminaires may be dimmed together; `None` where no illuminance is required.
    pub dimming: Option<Dimming>,
}

/// Installed power of a room, all luminaires at full output.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Power {
    /// Of all luminaires, W.
    pub installed_w: f64,
    /// Of the floor, m².
    pub area_m2: f64,
    /// W/m².
    pub density_w_m2: f64,
    /// Mean maintained illuminance on the horizontal task areas under `light_scene`, lx.
    pub mean_lx: Option<f64>,
    /// W/m² for every 100 lx of it.
    pub density_w_m2_100lx: Option<f64>,
    /// The first light scene.
    pub light_scene: String,
}

/// The least common factor on all luminaires with which a room still complies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dimming {
    /// The factor: below 1 there is light to spare, above 1 so much flux is missing. The lower ends of
    /// the joint intervals, times the factor, reach their limits.
    pub factor: f64,
    /// Subject of the requirement that decides.
    pub subject: String,
    /// Its quantity.
    pub quantity: String,
    /// Whether what dimming cannot mend (uniformity, ratios, glare) passes.
    pub others_pass: bool,
}

/// One luminaire on the plan.
#[derive(Clone, Debug)]
pub struct LuminaireOutcome {
    /// Type name, `A`.
    pub kind: String,
    /// Group.
    pub group: String,
    /// Position, m.
    pub position: DVec3,
    /// Outline of the opening in project coordinates, empty for a point.
    pub outline: Vec<DVec3>,
    /// Unit direction of the C0 half-plane in project coordinates.
    pub c0: DVec3,
    /// Unit direction of the beam axis.
    pub aim: DVec3,
}

/// A luminaire type in the schedule.
#[derive(Clone, Debug, Serialize)]
pub struct TypeOutcome {
    /// Its intensities at initial flux, for the polar diagram.
    #[serde(skip)]
    pub distribution: IntensityDistribution,
    /// Type name.
    pub name: String,
    /// From the photometric file.
    pub description: String,
    /// File as written in the project.
    pub file: String,
    /// Number of luminaires in the room.
    pub count: usize,
    /// Initial flux, lm.
    pub flux_lm: f64,
    /// Rated flux of the file, lm.
    pub rated_flux_lm: Option<f64>,
    /// Power, W.
    pub power_w: Option<f64>,
    /// Maintenance factor including the room's RSMF.
    pub maintenance_factor: f64,
    /// Its components LLMF, LSF, LMF, RSMF.
    pub maintenance: [f64; 4],
}

/// An area's grid and point values.
#[derive(Clone, Debug)]
pub struct AreaOutcome {
    /// Name.
    pub name: String,
    /// Role.
    pub kind: AreaKind,
    /// Name of the task area it surrounds.
    pub of: Option<String>,
    /// Row of the norm.
    pub row: Option<String>,
    /// The grid.
    pub grid: Grid,
    /// Point values, one entry for each (light scene, quantity).
    pub fields: Vec<PointField>,
}

/// Values of one quantity under one light scene on a grid.
#[derive(Clone, Debug)]
pub struct PointField {
    /// Light scene name.
    pub light_scene: String,
    /// Quantity.
    pub quantity: Quantity,
    /// Whether maintained (else initial).
    pub maintained: bool,
    /// Number of blocks behind every point.
    pub n: usize,
    /// One entry per grid point; `None` where the point is excluded.
    pub points: Vec<Option<PointValue>>,
}

/// Value at a grid point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointValue {
    /// Mean over blocks.
    pub value: f64,
    /// Standard error.
    pub se: f64,
    /// Lower end of the individual interval.
    pub lo: f64,
    /// Upper end of the individual interval.
    pub hi: f64,
    /// Part that comes straight from luminaires.
    pub direct: f64,
    /// The rest.
    pub indirect: f64,
}

/// Glare at an observer in one direction under one light scene, initial flux.
#[derive(Clone, Debug)]
pub struct ViewpointOutcome {
    /// Name.
    pub name: String,
    /// Light scene name.
    pub light_scene: String,
    /// Eye, m.
    pub eye: DVec3,
    /// Line of sight.
    pub direction: DVec3,
    /// Azimuth of the line of sight, degrees from +x towards +y.
    pub azimuth_deg: f64,
    /// Tilt above the horizon, degrees.
    pub tilt_deg: f64,
    /// UGR with its interval.
    pub ugr: Result<Interval, Undefined>,
    /// Further indices that the project asks for.
    pub indices: Vec<IndexOutcome>,
    /// How it was computed: source luminance, position index.
    pub convention: String,
    /// Background luminance E_i/π, cd/m².
    pub background_cd_m2: f64,
    /// Vertical illuminance at the eye, lx, direct included.
    pub e_v_lx: f64,
    /// Sources in order of share.
    pub sources: Vec<GlareSourceOutcome>,
    /// Validity notes.
    pub notes: Vec<String>,
    /// Its card, where one was made.
    pub card: Option<Card>,
}

/// An index of glare beside UGR.
#[derive(Clone, Debug)]
pub struct IndexOutcome {
    /// Key, `DGP`.
    pub key: String,
    /// Name in words.
    pub name: String,
    /// Unit, `1` for none.
    pub unit: String,
    /// Value with its interval, or why there is none.
    pub estimate: Result<Interval, Undefined>,
    /// What makes it doubtful.
    pub notes: Vec<String>,
}

/// One glare source seen by an observer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GlareSourceOutcome {
    /// Label, `A @ row-1 #3`.
    pub label: String,
    /// Mean luminance of the visible part, cd/m².
    pub luminance_cd_m2: f64,
    /// Solid angle of the visible part, sr.
    pub solid_angle_sr: f64,
    /// Position index.
    pub position_index: f64,
    /// Visible fraction of the opening.
    pub visible_fraction: f64,
    /// Share of Σ L²ω/P².
    pub share: f64,
}

/// An estimate with its individual confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Estimate.
    pub value: f64,
    /// Standard error.
    pub se: f64,
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

/// A measured value as it stands in result.json.
#[derive(Clone, Debug)]
pub struct Value {
    /// Room name.
    pub room: String,
    /// Area, viewpoint, surface or room.
    pub subject: String,
    /// Light scene.
    pub light_scene: String,
    /// Quantity key (`E_h`, `UGR`, `flux`, …).
    pub quantity: String,
    /// Statistic key.
    pub statistic: String,
    /// Where an extreme lies, m.
    pub location: Option<DVec3>,
    /// Unit.
    pub unit: String,
    /// Value with interval, or why there is none.
    pub estimate: Result<Interval, Undefined>,
    /// Number of blocks.
    pub n: usize,
}

/// Flux balance for one light scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FluxBalance {
    /// Light scene name.
    pub light_scene: String,
    /// Flux leaving the luminaires, lm.
    pub emitted_lm: f64,
    /// Flux absorbed by all surfaces, lm.
    pub absorbed: Interval,
    /// Flux that left the scene, lm.
    pub escaped: Interval,
    /// Emitted − absorbed − escaped as a share of the emitted flux, with its interval: 0 within error.
    pub residual_share: Interval,
    /// Share of the emitted flux that arrives on the task areas.
    pub utilisation: Option<Interval>,
    /// Surfaces.
    pub surfaces: Vec<SurfaceFlux>,
}

/// Flux at one surface, both sides together, lm.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceFlux {
    /// Surface name.
    pub surface: String,
    /// Area of one side, m².
    pub area_m2: f64,
    /// Incident flux.
    pub incident: Interval,
    /// Flux leaving again by reflection and transmission.
    pub leaving: Interval,
}

/// UGR of the table method for one luminaire type in a room.
#[derive(Clone, Debug)]
pub struct UgrTableOutcome {
    /// Luminaire type.
    pub kind: String,
    /// Spacing-to-height ratio.
    pub shr: f64,
    /// Line of sight across the luminaire's length.
    pub crosswise: Result<f64, Undefined>,
    /// Line of sight along it.
    pub endwise: Result<f64, Undefined>,
    /// Notes: clamped room size, nearest reflectance set.
    pub notes: Vec<String>,
}

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
