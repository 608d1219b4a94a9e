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

    /// Catches: a file of the folder that nobody can choose, a broken one, a value called verified
    /// without a source.
    #[test]
    fn every_file_of_the_folder_is_bundled_parses_under_its_own_name_and_names_its_sources() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("standards");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
            .collect();
        let mut names: Vec<String> = bundled().iter().map(|(name, _)| (*name).to_owned()).collect();
        files.sort();
        names.sort();
        assert_eq!(files, names);
        for (name, text) in bundled() {
            let standard = Standard::parse(text, name).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(standard.id, *name);
            assert!(!standard.edition.is_empty() && !standard.note.is_empty(), "{name}");
            for row in &standard.rows {
                let at = format!("{name} {}", row.reference);
                assert_eq!(standard.row(&row.reference), Some(row), "{at} is not reachable");
                assert!(!row.limits.is_empty() && !row.task.is_empty(), "{at}");
                let verified = row.limits.iter().any(|limit| limit.verified != Verified::Unverified);
                assert!(!verified || !row.sources.is_empty(), "{at} is verified by nobody");
            }
        }
    }

    /// Catches: a row of an indoor norm that lost one of its columns: it would be passed in silence.
    #[test]
    fn a_column_without_a_value_is_known_to_be_unknown() {
        let standard = en();
        for row in &standard.rows {
            let known = |name: &str| row.unknown.iter().any(|unknown| unknown.column == name);
            for (name, zone, statistic) in [
                ("em", Zone::Task, Statistic::Mean),
                ("u0", Zone::Task, Statistic::U0),
                ("ugr", Zone::Room, Statistic::Value),
                ("ra", Zone::Declared, Statistic::Value),
                ("em_walls", Zone::Walls, Statistic::Mean),
            ] {
                let limited = limit_of(&row.limits, zone, statistic).is_some();
                assert!(limited != known(name), "{} {name}", row.reference);
            }
        }
        assert!(standard.row("34.2").unwrap().unknown.is_empty());
        let unknown = &standard.row("12.1").unwrap().unknown;
        let names: Vec<&str> = unknown.iter().map(|unknown| unknown.column.as_str()).collect();
        assert_eq!(names, ["em_cylindrical", "em_walls", "em_ceiling"]);
    }

    /// Catches: a minimum read as a mean, a maximum as a minimum, a plane lost.
    #[test]
    fn the_other_norms_carry_their_own_statistics_senses_and_planes() {
        let read = |name: &str| {
            let (_, text) = bundled().iter().find(|(id, _)| *id == name).unwrap();
            Standard::parse(text, name).unwrap()
        };
        let task = |standard: &Standard, row: &str| {
            let row = standard.row(row).unwrap();
            let own = row.limits.iter().find(|limit| limit.zone == Zone::Task).unwrap();
            (own.quantity, own.statistic, own.bound)
        };
        let sanpin = read("sanpin-1.2.3685-21");
        assert_eq!(task(&sanpin, "15"), (Quantity::Horizontal, Statistic::Mean, Bound::Min(300.0)));
        assert_eq!(task(&sanpin, "15-board"), (Quantity::Normal, Statistic::Mean, Bound::Min(500.0)));
        assert_eq!(task(&sanpin, "17-screen"), (Quantity::Normal, Statistic::Mean, Bound::Max(200.0)));
        assert_eq!(sanpin.row("15-board").unwrap().plane, Plane::Vertical);
        assert_eq!(sanpin.row("15").unwrap().plane_m, Some(0.8));
        let heights = sanpin.application.eye_heights_m(Posture::Both);
        assert!(heights.len() == 1 && (heights[0] - 1.5).abs() < 1e-9);
        assert!(sanpin.application.surrounding.is_none());
        let pulsation = Quantity::Declared(crate::quantity::Property::Pulsation);
        let limits = &sanpin.row("15").unwrap().limits;
        assert!(limits.iter().any(|l| l.quantity == pulsation && l.bound == Bound::Max(10.0)));
        let sp = read("sp-52.13330.2016");
        assert_eq!(task(&sp, "classroom").2, Bound::Min(400.0), "SP and SanPiN differ");
        assert_eq!(task(&sp, "Iб").2, Bound::Min(1250.0), "1 200 lx is no step of its scale");
        let emergency = read("en-1838-2013");
        assert_eq!(task(&emergency, "route-centre"), (Quantity::Horizontal, Statistic::Min, Bound::Min(1.0)));
        assert!(emergency.application.not_judged.is_some());
        let sports = read("en-12193-2018");
        let limits = sports.requirements(sports.row("basketball-II").unwrap());
        let share = limit_of(&limits, Zone::Surrounding, Statistic::OfTask).unwrap();
        assert_eq!(share, (Bound::Min(0.75), Verified::TwoSources));
        assert!(limit_of(&limits, Zone::Surrounding, Statistic::Mean).is_none());
        assert_eq!(sports.application.grid.value, GridChoice::En12193);
    }

    /// Catches: a step in the wrong direction, off the scale, or surroundings that do not follow.
    #[test]
    fn a_modified_illuminance_steps_along_the_scale_and_the_surrounding_follows() {
        let standard = en();
        let office = standard.row("34.2").unwrap();
        let at = |row: &Row, steps: Option<i32>| standard.modified_illuminance(row, steps);
        assert_eq!(at(office, Some(1)), Ok(750.0));
        assert_eq!(at(office, Some(-1)), Ok(300.0));
        assert_eq!(at(office, None), Ok(1000.0), "the row's own modified value is two steps");
        assert!(at(office, Some(30)).unwrap_err().contains("leave the norm's scale"));
        assert!(at(office, Some(-30)).is_err());
        let store = standard.row("12.1").unwrap();
        assert!(at(store, None).unwrap_err().contains("12.1"));
        let limits = standard.requirements_at(office, Some(750.0));
        let limit = |zone, statistic| limit_of(&limits, zone, statistic).unwrap().0;
        assert_eq!(limit(Zone::Task, Statistic::Mean), Bound::Min(750.0));
        assert_eq!(limit(Zone::Surrounding, Statistic::Mean), Bound::Min(500.0));
        assert_eq!(limit(Zone::Walls, Statistic::Mean), Bound::Min(150.0), "walls do not follow");
        let house = Standard::parse("id = \"house\"\nrow = [{ ref = \"1\", em = 300 }]\n", "house").unwrap();
        assert!(house.modified_illuminance(&house.rows[0], Some(1)).is_err(), "no scale, no steps");
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
        assert_eq!(limit(Zone::Surrounding, Statistic::Mean), (Bound::Min(300.0), Verified::OneSource));
        assert_eq!(limit(Zone::Surrounding, Statistic::U0).0, Bound::Min(0.4));
        assert_eq!(limit(Zone::Background, Statistic::Mean).1, Verified::OneSource);
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
