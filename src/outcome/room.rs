//! What a run found in a room: areas with their points, observers, luminaires, flux, power.

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::Card;
use crate::grid::Grid;
use crate::norm::{Light, State};
use crate::photometry::IntensityDistribution;
use crate::project::AreaKind;
use crate::quantity::Quantity;
use crate::units::Undefined;

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

/// Installed power of a room, all luminaires at full output, and the power of a light scene beside its light.
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
    /// W/m² of `scene_w` for every 100 lx of it.
    pub density_w_m2_100lx: Option<f64>,
    /// The light scene by which the horizontal task areas are judged; of several the one with the most light.
    pub light_scene: String,
    /// What it takes, `dim` included, W: power in proportion to light.
    pub scene_w: f64,
}

/// The least common factor on all luminaires with which a room still complies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dimming {
    /// The factor, rounded up to three figures: below 1 there is light to spare, above 1 so much flux is
    /// missing. The lower ends of the joint intervals, times the factor, reach their limits.
    pub factor: f64,
    /// Subject of the requirement that decides.
    pub subject: String,
    /// Its quantity.
    pub quantity: String,
    /// Whether all else passes at the factor: upper limits and glare, which fall with it, uniformity, ratios.
    pub others_pass: bool,
    /// Factors by luminaire group, where that is more than one question.
    pub groups: Option<GroupDimming>,
}

/// Factors on the luminaire groups with which all verdicts of a room still pass, at the least power.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroupDimming {
    /// What is left of the power, or of the flux where a power is not known, that the light scenes by which
    /// the room is judged take together.
    pub share: f64,
    /// `power` or `flux`.
    pub of: String,
    /// One entry for each group, in the order of the luminaires.
    pub groups: Vec<GroupFactor>,
}

/// The factor on one luminaire group.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroupFactor {
    /// Group.
    pub group: String,
    /// Factor on its output, beyond that of the light scene; of three figures, with which it was checked.
    pub factor: f64,
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
    /// Unit direction of the C0 half-plane, across the length, in project coordinates.
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

/// Under which condition of the installation an illuminance is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Condition {
    /// Age and output.
    pub state: State,
    /// Which light counts.
    pub light: Light,
}

impl Condition {
    /// At the end of the maintenance interval, all light.
    pub const MAINTAINED: Self = Self { state: State::Maintained, light: Light::All };

    /// As it stands in notes.
    pub fn note(self) -> &'static str {
        match (self.state, self.light) {
            (State::Maintained, Light::All) => "maintained",
            (State::Initial, Light::All) => "initial",
            (State::Emergency, Light::All) => "emergency output, maintained",
            (State::Maintained, Light::Direct) => "maintained, direct light only",
            (State::Initial, Light::Direct) => "initial, direct light only",
            (State::Emergency, Light::Direct) => "emergency output, maintained, direct light only",
        }
    }
}

/// Values of one quantity under one light scene on a grid.
#[derive(Clone, Debug)]
pub struct PointField {
    /// Light scene name.
    pub light_scene: String,
    /// Quantity.
    pub quantity: Quantity,
    /// Age and output of the installation, and which light counts.
    pub condition: Condition,
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
