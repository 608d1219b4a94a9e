//! Shape of a norm file as written: what serde checks. Values keep their place for later messages.

use serde::Deserialize;
use toml::Spanned;

use super::{Application, Verified, Zone};
use crate::quantity::{Quantity, Statistic};

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StandardText {
    pub(super) id: Spanned<String>,
    #[serde(default)]
    pub(super) short: String,
    #[serde(default)]
    pub(super) title: String,
    #[serde(default)]
    pub(super) edition: String,
    #[serde(default)]
    pub(super) note: String,
    pub(super) application: Option<Spanned<Application>>,
    #[serde(default)]
    pub(super) row: Vec<RowText>,
}

/// A `[[row]]`: one optional column per customary requirement.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RowText {
    #[serde(rename = "ref")]
    pub(super) reference: Spanned<String>,
    #[serde(default)]
    pub(super) area: String,
    #[serde(default)]
    pub(super) task: String,
    /// Quantity of `em` and `u0`; E_h unless the task is on another plane.
    pub(super) quantity: Option<Spanned<String>>,
    pub(super) plane_m: Option<Spanned<f64>>,
    pub(super) em: Option<Spanned<f64>>,
    pub(super) em_modified: Option<Spanned<f64>>,
    pub(super) u0: Option<Spanned<f64>>,
    pub(super) ugr: Option<Spanned<f64>>,
    pub(super) ra: Option<Spanned<f64>>,
    pub(super) em_cylindrical: Option<Spanned<f64>>,
    pub(super) em_walls: Option<Spanned<f64>>,
    pub(super) em_ceiling: Option<Spanned<f64>>,
    /// Limits that no column expresses.
    #[serde(default)]
    pub(super) limit: Vec<LimitText>,
    /// Columns seen in two sources of this edition.
    #[serde(default)]
    pub(super) two_sources: Vec<Spanned<String>>,
    /// Columns seen in one source.
    #[serde(default)]
    pub(super) one_source: Vec<Spanned<String>>,
    #[serde(default)]
    pub(super) sources: Vec<String>,
    #[serde(default)]
    pub(super) note: String,
}

/// A `[[row.limit]]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LimitText {
    pub(super) zone: Zone,
    pub(super) quantity: Spanned<String>,
    pub(super) statistic: Spanned<String>,
    pub(super) min: Option<Spanned<f64>>,
    pub(super) max: Option<Spanned<f64>>,
    #[serde(default)]
    pub(super) verified: Verified,
}

/// What a number may be.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Illuminance,
    Fraction,
    Ugr,
    ColourRendering,
    Height,
    Ratio,
}

/// The columns of a row: key, kind of number, zone, quantity (`None`: the row's own), statistic.
#[rustfmt::skip]
const COLUMNS: [(&str, Kind, Zone, Option<Quantity>, Statistic); 7] = [
    ("em", Kind::Illuminance, Zone::Task, None, Statistic::Mean),
    ("u0", Kind::Fraction, Zone::Task, None, Statistic::U0),
    ("ugr", Kind::Ugr, Zone::Room, Some(Quantity::Ugr), Statistic::Value),
    ("ra", Kind::ColourRendering, Zone::Declared, Some(Quantity::ColourRendering), Statistic::Value),
    ("em_cylindrical", Kind::Illuminance, Zone::Cylindrical, Some(Quantity::Cylindrical), Statistic::Mean),
    ("em_walls", Kind::Illuminance, Zone::Walls, Some(Quantity::Normal), Statistic::Mean),
    ("em_ceiling", Kind::Illuminance, Zone::Ceiling, Some(Quantity::Normal), Statistic::Mean),
];

/// A column that a row fills.
pub(super) struct Filled<'a> {
    pub(super) name: &'static str,
    pub(super) value: &'a Spanned<f64>,
    pub(super) kind: Kind,
    pub(super) zone: Zone,
    pub(super) quantity: Quantity,
    pub(super) statistic: Statistic,
}

impl RowText {
    /// The columns with a value; `own` is the quantity of the row's task.
    pub(super) fn filled(&self, own: Quantity) -> Vec<Filled<'_>> {
        let values =
            [&self.em, &self.u0, &self.ugr, &self.ra, &self.em_cylindrical, &self.em_walls, &self.em_ceiling];
        let mut filled = Vec::new();
        for ((name, kind, zone, quantity, statistic), value) in COLUMNS.into_iter().zip(values) {
            if let Some(value) = value {
                let quantity = quantity.unwrap_or(own);
                filled.push(Filled { name, value, kind, zone, quantity, statistic });
            }
        }
        filled
    }

    /// Standing of a column: what no list names is unverified.
    pub(super) fn standing(&self, name: &str) -> Verified {
        let listed = |list: &[Spanned<String>]| list.iter().any(|column| column.get_ref() == name);
        if listed(&self.two_sources) {
            Verified::TwoSources
        } else if listed(&self.one_source) {
            Verified::OneSource
        } else {
            Verified::Unverified
        }
    }
}
