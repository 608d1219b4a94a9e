//! A norm is a data file: requirement rows and the rules of application. Every value says how well
//! it is verified; a value that is absent is *not assessed*, never passed. Nothing here knows how a
//! quantity is computed.

mod application;
mod read;
mod text;

pub use application::{
    Application, Background, Comparison, Fact, Reflectances, State, Surrounding, UgrMethod,
};
pub use read::{Mistake, NormError};

use serde::{Deserialize, Serialize};

use crate::quantity::{Quantity, Statistic};

/// The standards that ship with the program: name and TOML text.
pub fn bundled() -> &'static [(&'static str, &'static str)] {
    &[("en-12464-1-2021", include_str!("../standards/en-12464-1-2021.toml"))]
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
    /// What the row itself limits; see [`Standard::requirements`] for the derived limits.
    pub limits: Vec<Limit>,
    /// Mean illuminance for difficult conditions in lx, if the row has one, and its standing.
    pub modified_lx: Option<(f64, Verified)>,
    /// Height of the plane if the row names one, m; 0 is the floor.
    pub plane_m: Option<f64>,
    /// Remarks.
    pub note: String,
    /// Standing of the row's mean illuminance, or of its first limit.
    pub verified: Verified,
    /// Sources of the verified values.
    pub sources: Vec<String>,
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
        let mut limits = row.limits.clone();
        if let Some(task) = row.illuminance() {
            limits.extend(self.around(task));
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

    /// Limits of surrounding and background that follow from a task's mean illuminance.
    fn around(&self, task: &Limit) -> Vec<Limit> {
        let (Some(surrounding), Bound::Min(task_lx)) = (&self.application.surrounding, task.bound) else {
            return Vec::new();
        };
        let lx = self.surrounding_illuminance(task_lx).unwrap_or(task_lx);
        let known = task.verified.min(surrounding.illuminance_lx.verified);
        let quantity = task.quantity;
        let u0 = &surrounding.u0;
        let mut limits = vec![
            minimum(Zone::Surrounding, quantity, Statistic::Mean, lx, known),
            minimum(Zone::Surrounding, quantity, Statistic::U0, u0.value, u0.verified),
        ];
        if let Some(Background { fraction, u0, .. }) = &self.application.background {
            let known = known.min(fraction.verified);
            limits.push(minimum(Zone::Background, quantity, Statistic::Mean, lx * fraction.value, known));
            limits.push(minimum(Zone::Background, quantity, Statistic::U0, u0.value, u0.verified));
        }
        limits
    }
}

impl Row {
    /// The limit on the mean illuminance of the task area.
    pub fn illuminance(&self) -> Option<&Limit> {
        self.limits.iter().find(|limit| {
            limit.zone == Zone::Task
                && limit.statistic == Statistic::Mean
                && matches!(limit.bound, Bound::Min(_))
        })
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
mod tests {
    use super::*;

    fn en() -> Standard {
        let (name, text) = bundled()[0];
        Standard::parse(text, name).unwrap_or_else(|error| panic!("{error}"))
    }

    fn limit_of(limits: &[Limit], zone: Zone, statistic: Statistic) -> Option<(Bound, Verified)> {
        limits
            .iter()
            .find(|limit| limit.zone == zone && limit.statistic == statistic)
            .map(|limit| (limit.bound, limit.verified))
    }

    #[test]
    fn every_bundled_file_parses_under_its_own_name_and_every_row_limits_something() {
        for (name, text) in bundled() {
            let standard = Standard::parse(text, name).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(standard.id, *name);
            for row in &standard.rows {
                for statistic in [Statistic::Mean, Statistic::U0] {
                    assert!(limit_of(&row.limits, Zone::Task, statistic).is_some(), "{}", row.reference);
                }
                assert!(limit_of(&row.limits, Zone::Room, Statistic::Value).is_some(), "{}", row.reference);
                assert!(
                    limit_of(&row.limits, Zone::Declared, Statistic::Value).is_some(),
                    "{}",
                    row.reference
                );
                assert_eq!(row.verified == Verified::Unverified, row.sources.is_empty(), "{}", row.reference);
            }
        }
    }

    #[test]
    fn the_rows_of_en_12464_1_carry_their_corrections() {
        let standard = en();
        let em =
            |reference: &str| standard.row(reference).and_then(Row::illuminance).map(|limit| limit.bound);
        assert_eq!(em("34.2"), Some(Bound::Min(500.0)));
        assert_eq!(em("12.1"), Some(Bound::Min(200.0)), "100 lx is the 2011 edition");
        assert_eq!(em("34.5"), None, "split into 34.5.1 and 34.5.2");
        assert!(em("34.5.1").is_some() && em("34.5.2").is_some());
        assert_eq!(em("13.1"), None, "a row of the 2011 edition");
        let ra =
            |reference| limit_of(&standard.row(reference).unwrap().limits, Zone::Declared, Statistic::Value);
        assert_eq!(ra("12.2").unwrap().0, Bound::Min(80.0));
        assert_eq!(standard.row("9.1").unwrap().plane_m, Some(0.0));
        assert_eq!(standard.row("34.2").unwrap().plane_m, None);
        assert_eq!(standard.row("34.2").unwrap().modified_lx, Some((1000.0, Verified::Unverified)));
    }

    #[test]
    fn an_office_brings_its_derived_limits_with_the_weakest_standing() {
        let standard = en();
        let limits = standard.requirements(standard.row("34.2").unwrap());
        let limit = |zone, statistic| limit_of(&limits, zone, statistic).unwrap();
        assert_eq!(limit(Zone::Task, Statistic::Mean), (Bound::Min(500.0), Verified::TwoSources));
        assert_eq!(limit(Zone::Task, Statistic::U0), (Bound::Min(0.6), Verified::TwoSources));
        assert_eq!(limit(Zone::Room, Statistic::Value), (Bound::Max(19.0), Verified::TwoSources));
        assert_eq!(limit(Zone::Surrounding, Statistic::Mean), (Bound::Min(300.0), Verified::Unverified));
        assert_eq!(limit(Zone::Surrounding, Statistic::U0).0, Bound::Min(0.4));
        assert_eq!(limit(Zone::Background, Statistic::Mean).1, Verified::Unverified);
        let (Bound::Min(background_lx), _) = limit(Zone::Background, Statistic::Mean) else {
            panic!("a minimum")
        };
        assert!((background_lx - 100.0).abs() < 1e-9, "{background_lx}");
        assert_eq!(limit(Zone::Walls, Statistic::Mean), (Bound::Min(150.0), Verified::Unverified));
        for zone in [Zone::Walls, Zone::Ceiling, Zone::Cylindrical] {
            assert_eq!(limit(zone, Statistic::U0).0, Bound::Min(0.1));
        }
        // A row without wall columns must not grow wall limits.
        let store = standard.requirements(standard.row("12.1").unwrap());
        assert!(limit_of(&store, Zone::Walls, Statistic::U0).is_none());
    }

    #[test]
    fn the_surrounding_steps_down_by_one() {
        let standard = en();
        for (task_lx, expected_lx) in [
            (1000.0, 500.0),
            (750.0, 500.0),
            (749.0, 300.0),
            (500.0, 300.0),
            (300.0, 200.0),
            (200.0, 150.0),
            (150.0, 150.0),
            (50.0, 50.0),
        ] {
            assert_eq!(standard.surrounding_illuminance(task_lx), Some(expected_lx));
        }
    }

    #[test]
    fn a_standard_of_one_row_works_and_derives_nothing() {
        let text = "id = \"house\"\nrow = [{ ref = \"1\", em = 300 }]\n";
        let standard = Standard::parse(text, "house.toml").unwrap();
        let limits = standard.requirements(standard.row("1").unwrap());
        assert_eq!(limits.len(), 1);
        assert_eq!(limits[0].bound, Bound::Min(300.0));
        assert_eq!(standard.surrounding_illuminance(500.0), None);
        assert_eq!(standard.application, Application::default());
        assert_eq!(standard.short, "house", "a norm without a short name is called by its id");
        assert_eq!(en().short, "EN 12464-1:2021");
    }
}
