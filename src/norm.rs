//! A norm is a data file: requirement rows and the rules of application. Every value says how well
//! it is verified; a value that is absent is *not assessed*, never passed. Nothing here knows how a
//! quantity is computed.

mod application;
mod explain;
mod read;
mod text;

pub use application::{
    Application, Background, Beyond, Comparison, Fact, GridChoice, LevelOf, Reflectances, State, Surrounding,
    UgrMethod,
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
        ("en-1838-2013", include_str!("../standards/en-1838-2013.toml")),
        ("en-17037-2018", include_str!("../standards/en-17037-2018.toml")),
    ]
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

    /// Required mean illuminance of the immediate surrounding of a task, lx; `None` if the standard
    /// has no such rule.
    pub fn surrounding_illuminance(&self, task_lx: f64) -> Option<f64> {
        let steps = &self.application.surrounding.as_ref()?.illuminance_lx.value;
        Some(steps.iter().find(|[from_lx, _]| task_lx >= *from_lx).map_or(task_lx, |[_, lx]| *lx))
    }

    /// All limits for an area judged by a row: the row's own, then those for surrounding and
    /// background that follow from the task's illuminance, then the uniformities that go with limits
    /// on walls, ceiling and cylindrical illuminance.
    pub fn requirements(&self, row: &Row) -> Vec<Limit> {
        self.requirements_at(row, None)
    }

    /// The same with the task's illuminance raised or lowered to a value for reasons of context;
    /// surrounding and background follow it.
    pub fn requirements_at(&self, row: &Row, modified_lx: Option<f64>) -> Vec<Limit> {
        let mut limits = row.limits.clone();
        if let Some(task) = row.illuminance() {
            let (bound, verified) = match modified_lx {
                None => (task.bound, task.verified),
                Some(lx) => (Bound::Min(lx), self.standing_of_modified(row, task, lx)),
            };
            let task = Limit { bound, verified, ..*task };
            if let Some(own) = limits.iter_mut().find(|limit| limit.is_task_level()) {
                (own.bound, own.verified) = (bound, verified);
            }
            limits.extend(self.around(&task));
        }
        let rules = &self.application;
        for (zone, uniformity) in [
            (Zone::Walls, &rules.walls_u0),
            (Zone::Ceiling, &rules.ceiling_u0),
            (Zone::Cylindrical, &rules.cylindrical_u0),
        ] {
            let mean =
                row.limits.iter().find(|limit| limit.zone == zone && limit.statistic == Statistic::Mean);
            let own = row.limits.iter().any(|limit| limit.zone == zone && limit.statistic == Statistic::U0);
            if let (Some(mean), Some(u0), false) = (mean, uniformity, own) {
                limits.push(minimum(
                    zone,
                    mean.quantity,
                    Statistic::U0,
                    u0.value,
                    mean.verified.min(u0.verified),
                ));
            }
        }
        limits
    }

    /// How well a modified illuminance is known: as the row's own value for difficult conditions, or no
    /// better than the task's and the scale along which it was found.
    fn standing_of_modified(&self, row: &Row, task: &Limit, lx: f64) -> Verified {
        match (row.modified_lx, &self.application.illuminance_scale_lx) {
            (Some((own_lx, verified)), _) if (own_lx - lx).abs() < 1e-9 => verified,
            (_, Some(scale)) => task.verified.min(scale.verified),
            (_, None) => Verified::Unverified,
        }
    }

    /// Limits of surrounding and background that follow from a task's mean illuminance.
    fn around(&self, task: &Limit) -> Vec<Limit> {
        let mut limits = Vec::new();
        if let Some(share) = &self.application.surrounding_of_task {
            let (zone, statistic) = (Zone::Surrounding, Statistic::OfTask);
            limits.push(minimum(zone, task.quantity, statistic, share.value, share.verified));
        }
        let (Some(surrounding), Bound::Min(task_lx)) = (&self.application.surrounding, task.bound) else {
            return limits;
        };
        let lx = self.surrounding_illuminance(task_lx).unwrap_or(task_lx);
        let known = task.verified.min(surrounding.illuminance_lx.verified);
        let quantity = task.quantity;
        let u0 = &surrounding.u0;
        limits.push(minimum(Zone::Surrounding, quantity, Statistic::Mean, lx, known));
        limits.push(minimum(Zone::Surrounding, quantity, Statistic::U0, u0.value, u0.verified));
        if let Some(Background { fraction, u0, .. }) = &self.application.background {
            let known = known.min(fraction.verified);
            limits.push(minimum(Zone::Background, quantity, Statistic::Mean, lx * fraction.value, known));
            limits.push(minimum(Zone::Background, quantity, Statistic::U0, u0.value, u0.verified));
        }
        limits
    }
}

impl Standard {
    /// The task's illuminance some steps further along the norm's scale, lx; no steps: the row's
    /// value for difficult conditions.
    ///
    /// # Errors
    /// Why there is none, in words that end a sentence.
    pub fn modified_illuminance(&self, row: &Row, steps: Option<i32>) -> Result<f64, String> {
        let Some(Limit { bound: Bound::Min(required_lx), .. }) = row.illuminance() else {
            return Err(format!("row {} requires no illuminance", row.reference));
        };
        let Some(steps) = steps else {
            let modified = row.modified_lx.map(|(lx, _)| lx);
            return modified.ok_or_else(|| {
                format!("the modified illuminance of row {} is not known here: give steps", row.reference)
            });
        };
        let Some(scale) = &self.application.illuminance_scale_lx else {
            return Err(format!("{} has no scale of illuminance to step along", self.short));
        };
        let place = scale.value.iter().position(|lx| (lx - required_lx).abs() < 1e-9);
        let place = place.ok_or_else(|| {
            format!("{required_lx} lx of row {} is no step of the norm's scale", row.reference)
        })?;
        let target = i64::try_from(place).unwrap_or(i64::MAX).saturating_add(i64::from(steps));
        let found = usize::try_from(target).ok().and_then(|target| scale.value.get(target));
        found.copied().ok_or_else(|| format!("{steps} steps from {required_lx} lx leave the norm's scale"))
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

/// A lower limit.
fn minimum(zone: Zone, quantity: Quantity, statistic: Statistic, value: f64, verified: Verified) -> Limit {
    Limit { zone, quantity, statistic, bound: Bound::Min(value), verified }
}

#[cfg(test)]
mod tests;
