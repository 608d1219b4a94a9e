//! How the rows of a standard are applied: planes, states, zones, the UGR method.

use serde::{Deserialize, Serialize};

use super::Verified;
use crate::quantity::Statistic;

/// A value of the application rules with its standing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fact<T> {
    /// The value.
    pub value: T,
    /// Its standing.
    #[serde(default)]
    pub verified: Verified,
    /// Where it was read, and why it was chosen where there is a choice.
    #[serde(default)]
    pub source: String,
}

/// Age of the installation that a limit speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum State {
    /// At the end of the maintenance interval: maintenance factor applied.
    Maintained,
    /// New: no maintenance factor.
    Initial,
    /// In an emergency: the output that the luminaires have left then, maintenance factor applied.
    Emergency,
}

/// Which light counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Light {
    /// All that arrives.
    All,
    /// Straight from luminaires, panes on the way included; no reflection.
    Direct,
}

/// How a room's UGR is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum UgrMethod {
    /// From the luminaire's table, CIE 117 and CIE 190.
    Table,
    /// At the observers of the project.
    Observers,
}

/// Which statistic of the illuminance on a task the column `em` limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LevelOf {
    /// The mean over the area.
    Mean,
    /// The smallest value of the area.
    Min,
}

impl LevelOf {
    /// As a statistic of an area.
    pub fn statistic(self) -> Statistic {
        match self {
            Self::Mean => Statistic::Mean,
            Self::Min => Statistic::Min,
        }
    }
}

/// How the points of an area are laid where the project does not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GridChoice {
    /// p = 0.2 · 5^(lg d) ≤ 10 m as largest spacing, EN 12464-1.
    #[serde(rename = "en-12464-1")]
    En12464,
    /// The same p, its number of points rounded to odd ones, EN 12193.
    #[serde(rename = "en-12193")]
    En12193,
}

/// Something the norm regulates beyond its rows; it ends "not assessed" in every room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beyond {
    /// Spelling of the quantity.
    pub quantity: String,
    /// Why it is not assessed.
    pub reason: String,
}

/// How a value is compared with its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Comparison {
    /// Unrounded.
    #[default]
    Exact,
    /// Rounded half up first: E to three figures, uniformity to 0.01, UGR to 0.1.
    Printed,
}

/// How the rows of a standard are applied. What a file leaves out has the customary value, marked
/// unverified, or is not assessed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Application {
    /// State in which illuminances are judged.
    pub illuminance_state: Fact<State>,
    /// Which light counts for illuminances.
    pub light: Fact<Light>,
    /// State in which upper limits of illuminances are judged where others are judged maintained: a new
    /// installation gives the most light.
    pub upper_limit_state: Fact<State>,
    /// State in which glare is judged.
    pub ugr_state: Fact<State>,
    /// Which UGR is judged.
    pub ugr_method: Fact<UgrMethod>,
    /// Spacing-to-height ratio of the UGR table.
    pub ugr_shr: Fact<f64>,
    /// Default comparison.
    pub comparison: Comparison,
    /// Which statistic `em` limits.
    pub illuminance_statistic: Fact<LevelOf>,
    /// Rule of the grid.
    pub grid: Fact<GridChoice>,
    /// Why nothing of this norm can be judged yet; then every limit ends "not assessed".
    pub not_judged: Option<String>,
    /// Columns that the norm's tables have for every row: a row without one of them is "not
    /// assessed" there, unless it says that the norm leaves it open (`unregulated`).
    pub columns: Vec<String>,
    /// What else the norm regulates.
    pub beyond: Vec<Beyond>,
    /// The scale along which illuminances are raised or lowered for context, lx, rising.
    pub illuminance_scale_lx: Option<Fact<Vec<f64>>>,
    /// Height of the working plane where a row names none, m.
    pub working_plane_m: Fact<f64>,
    /// Eye height of seated people, m; also that of their cylindrical illuminance.
    pub eye_height_seated_m: Fact<f64>,
    /// Eye height of standing people, m; also that of their cylindrical illuminance.
    pub eye_height_standing_m: Fact<f64>,
    /// Strip along the walls that may be left out of a grid, m.
    pub border_m: Fact<f64>,
    /// Whether rows speak of parts of rooms that the outline does not tell; each row may say otherwise.
    pub part_of_room: bool,
    /// Requirements for the strip around a task area.
    pub surrounding: Option<Surrounding>,
    /// Least mean on the area around a task (a sport's total area) as a share of the mean that is
    /// found on the task itself.
    pub surrounding_of_task: Option<Fact<f64>>,
    /// Requirements for the area beyond it.
    pub background: Option<Background>,
    /// Uniformity on walls whose mean is limited.
    pub walls_u0: Option<Fact<f64>>,
    /// Uniformity on ceilings whose mean is limited.
    pub ceiling_u0: Option<Fact<f64>>,
    /// Uniformity of the cylindrical illuminance where its mean is limited.
    pub cylindrical_u0: Option<Fact<f64>>,
    /// Recommended range of modelling; for information, never a limit.
    pub modelling: Option<Fact<[f64; 2]>>,
    /// Recommended reflectances; for information, never a limit.
    pub reflectances: Option<Reflectances>,
}

/// The immediate surrounding of a task area.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surrounding {
    /// Width of the strip, m.
    pub band_m: Fact<f64>,
    /// Pairs [task from, surrounding] in lx, falling; below the last one the task's own value holds.
    pub illuminance_lx: Fact<Vec<[f64; 2]>>,
    /// Uniformity.
    pub u0: Fact<f64>,
}

/// The background area.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Background {
    /// Width beyond the surrounding, m.
    pub width_m: Fact<f64>,
    /// Its mean as a fraction of the surrounding's required illuminance.
    pub fraction: Fact<f64>,
    /// Uniformity.
    pub u0: Fact<f64>,
}

/// Recommended ranges of reflectance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reflectances {
    /// Ceiling.
    pub ceiling: Fact<[f64; 2]>,
    /// Walls.
    pub walls: Fact<[f64; 2]>,
    /// Floor.
    pub floor: Fact<[f64; 2]>,
    /// Large objects: furniture, machines.
    pub objects: Fact<[f64; 2]>,
}

impl Default for Application {
    fn default() -> Self {
        fn customary<T>(value: T) -> Fact<T> {
            Fact { value, verified: Verified::Unverified, source: "not in the file; customary value".into() }
        }
        Self {
            illuminance_state: customary(State::Maintained),
            light: customary(Light::All),
            upper_limit_state: customary(State::Initial),
            ugr_state: customary(State::Initial),
            ugr_method: customary(UgrMethod::Table),
            ugr_shr: customary(0.25),
            comparison: Comparison::Exact,
            illuminance_statistic: customary(LevelOf::Mean),
            grid: customary(GridChoice::En12464),
            not_judged: None,
            columns: Vec::new(),
            beyond: Vec::new(),
            illuminance_scale_lx: None,
            working_plane_m: customary(0.75),
            eye_height_seated_m: customary(1.2),
            eye_height_standing_m: customary(1.6),
            border_m: customary(0.5),
            part_of_room: false,
            surrounding: None,
            surrounding_of_task: None,
            background: None,
            walls_u0: None,
            ceiling_u0: None,
            cylindrical_u0: None,
            modelling: None,
            reflectances: None,
        }
    }
}
