//! A norm is a data file: requirement rows and the rules of application. Every value says how well
//! it is verified; a value that is absent is *not assessed*, never passed. Nothing here knows how a
//! quantity is computed.

mod application;
mod derived;
mod explain;
mod read;
mod text;

pub use application::{
    Application, Background, Beyond, Comparison, Fact, GridChoice, LevelOf, Light, Reflectances, State,
    Surrounding, UgrMethod,
};
pub use explain::{explain, explain_row, limit_line};
pub use read::{Mistake, NormError};

use serde::{Deserialize, Serialize};

use crate::quantity::{Quantity, Statistic};

/// The standards that ship with the program: name and TOML text.
pub fn bundled() -> &'static [(&'static str, &'static str)] {
    &[
        ("en-12464-1-2021", include_str!("../standards/en-12464-1-2021.toml")),
        ("en-12464-1-2011", include_str!("../standards/en-12464-1-2011.toml")),
        ("en-12464-2-2014", include_str!("../standards/en-12464-2-2014.toml")),
        ("en-12193-2018", include_str!("../standards/en-12193-2018.toml")),
        ("sp-52.13330.2016", include_str!("../standards/sp-52.13330.2016.toml")),
        ("sanpin-1.2.3685-21", include_str!("../standards/sanpin-1.2.3685-21.toml")),
        ("en-1838-2024", include_str!("../standards/en-1838-2024.toml")),
        ("en-1838-2013", include_str!("../standards/en-1838-2013.toml")),
        ("en-17037-2018", include_str!("../standards/en-17037-2018.toml")),
    ]
}

/// JSON Schema of norm files, read as JSON.
pub fn schema() -> &'static str {
    include_str!("norm/norm.schema.json")
}

/// A standard, or a user's own set of rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Standard {
    /// Name in project files, `en-12464-1-2021`.
    pub id: String,
    /// What a verdict calls it, `EN 12464-1:2021`; never empty.
    pub short: String,
    /// Title as printed.
    pub title: String,
    /// Edition, `2021`.
    pub edition: String,
    /// What a reader must know about the file as a whole.
    pub note: String,
    /// How the rows are applied.
    pub application: Application,
    /// The rows in the order of the file.
    pub rows: Vec<Row>,
}

/// How well a value is known to be the norm's own. Sources of another edition do not count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verified {
    /// Not seen in any independent source of this edition.
    #[default]
    Unverified,
    /// Seen in one source of this edition.
    OneSource,
    /// Seen in two independent sources of this edition.
    TwoSources,
}

/// The requirements for one kind of task or area.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// `34.2`.
    pub reference: String,
    /// Group of rows, `Offices`.
    pub area: String,
    /// Kind of task or area, in our words.
    pub task: String,
    /// Table or clause where the reference does not say it; may be empty.
    pub clause: String,
    /// What the row itself limits; see [`Standard::requirements`] for the derived limits.
    pub limits: Vec<Limit>,
    /// What the norm regulates here without this file knowing the value.
    pub unknown: Vec<Unknown>,
    /// Largest luminous intensity of luminaires, against disability glare.
    pub intensity: Option<IntensityLimit>,
    /// What the norm asks here beyond the limits and nothing computes; ends "not assessed".
    pub not_judged: Vec<String>,
    /// How the plane of the task stands.
    pub plane: Plane,
    /// As the norm writes the plane, may be empty.
    pub plane_name: String,
    /// At which eye heights people are in such a room.
    pub posture: Posture,
    /// Mean illuminance for difficult conditions in lx, if the row has one, and its standing.
    pub modified_lx: Option<(f64, Verified)>,
    /// Height of the plane if the row names one, m; 0 is the floor. For a vertical plane its middle.
    pub plane_m: Option<f64>,
    /// Strip along the walls that an area made from the room's outline leaves out, m; `None`: the norm's.
    pub border_m: Option<f64>,
    /// Whether it speaks of a part of a room that the outline does not tell (a court, the middle of a route):
    /// no area is made for it, the project must list one.
    pub part_of_room: bool,
    /// Remarks.
    pub note: String,
    /// Standing of the row's mean illuminance, or of its first limit.
    pub verified: Verified,
    /// Sources of the verified values.
    pub sources: Vec<String>,
}

/// How the plane of a task stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Plane {
    /// A desk, a floor.
    #[default]
    Horizontal,
    /// A board, a rack face, a screen.
    Vertical,
}

/// At which eye heights people are in a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Posture {
    /// They sit.
    #[default]
    Seated,
    /// They stand and walk.
    Standing,
    /// Both.
    Both,
}

/// Largest luminous intensity of a luminaire within a zone about the vertical, by its mounting height.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IntensityLimit {
    /// Pairs [mounting height from, limit] in m and cd, rising from 0 m.
    pub by_height_cd: Vec<[f64; 2]>,
    /// The zone begins at this angle from straight down, degrees.
    pub from_deg: f64,
    /// And ends at this one.
    pub to_deg: f64,
    /// Standing of the limits.
    #[serde(default)]
    pub verified: Verified,
}

impl IntensityLimit {
    /// Height class of a mounting height: from, to (infinite for the last), limit.
    pub fn class(&self, height_m: f64) -> Option<(f64, f64, f64)> {
        let index = self.by_height_cd.iter().rposition(|[from_m, _]| height_m >= *from_m)?;
        let [from_m, limit_cd] = self.by_height_cd[index];
        let to_m = self.by_height_cd.get(index + 1).map_or(f64::INFINITY, |[next_m, _]| *next_m);
        Some((from_m, to_m, limit_cd))
    }
}

/// A column that the norm has for a row, and whose value is not in the file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unknown {
    /// Name of the column.
    pub column: String,
    /// Where.
    pub zone: Zone,
    /// What.
    pub quantity: Quantity,
    /// Which number of it.
    pub statistic: Statistic,
}

/// Where a limit applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Zone {
    /// The task area, or the whole area of an area row.
    Task,
    /// The strip around the task area.
    Surrounding,
    /// The area beyond it.
    Background,
    /// Every wall.
    Walls,
    /// The ceiling.
    Ceiling,
    /// The space in which people move, at eye height.
    Cylindrical,
    /// The room as a whole.
    Room,
    /// A property of the luminaires that is declared, never computed.
    Declared,
}

/// A bound and its sense.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// Not less than.
    Min(f64),
    /// Not more than.
    Max(f64),
}

/// One limit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// Where.
    pub zone: Zone,
    /// What.
    pub quantity: Quantity,
    /// Which number of it.
    pub statistic: Statistic,
    /// Against what.
    pub bound: Bound,
    /// Standing of the value; of the weakest one where it is derived from several.
    pub verified: Verified,
}

impl Standard {
    /// Reads a standard from TOML text; `file` is only for messages. All mistakes come at once, but
    /// for a wrong key or type, which hides what follows it.
    ///
    /// # Errors
    /// Each mistake with file, line and hint.
    pub fn parse(text: &str, file: &str) -> Result<Self, NormError> {
        read::standard(text, file)
    }

    /// Whether any row limits something in a zone, known or not.
    pub fn regulates(&self, zone: Zone) -> bool {
        self.rows.iter().any(|row| {
            row.limits.iter().any(|limit| limit.zone == zone)
                || row.unknown.iter().any(|unknown| unknown.zone == zone)
        })
    }

    /// The row of a reference such as `34.2`.
    pub fn row(&self, reference: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.reference == reference)
    }
}

impl Limit {
    /// Whether it is the required illuminance of the task itself.
    fn is_task_level(&self) -> bool {
        self.zone == Zone::Task
            && matches!(self.statistic, Statistic::Mean | Statistic::Min)
            && matches!(self.bound, Bound::Min(_))
    }
}

impl Row {
    /// Group and task, what there is of them.
    pub fn called(&self) -> String {
        let parts = [&self.area, &self.task].map(String::as_str);
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(": ")
    }

    /// The limit on the illuminance of the task area: its mean, or its minimum where the norm limits that.
    pub fn illuminance(&self) -> Option<&Limit> {
        self.limits.iter().find(|limit| limit.is_task_level())
    }
}

impl Verified {
    /// The word used in files and reports.
    pub fn key(self) -> &'static str {
        match self {
            Self::Unverified => "unverified",
            Self::OneSource => "one-source",
            Self::TwoSources => "two-sources",
        }
    }
}

impl Zone {
    /// The word used in files and lists.
    pub fn key(self) -> &'static str {
        match self {
            Self::Task => "task",
            Self::Surrounding => "surrounding",
            Self::Background => "background",
            Self::Walls => "walls",
            Self::Ceiling => "ceiling",
            Self::Cylindrical => "cylindrical",
            Self::Room => "room",
            Self::Declared => "declared",
        }
    }
}

#[cfg(test)]
mod tests;
