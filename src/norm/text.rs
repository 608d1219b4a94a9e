//! Shape of a norm file as written: what serde checks. Values keep their place for later messages.

use serde::Deserialize;
use toml::Spanned;

use super::{Application, Bound, IntensityLimit, LevelOf, Plane, Posture, Verified, Zone};
use crate::quantity::{Property, Quantity, Statistic, Unmeasured};

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
    /// Table or clause where the row's number does not say it.
    #[serde(default)]
    pub(super) clause: String,
    /// Quantity of `em` and `u0`; E_h, or E_n where the plane is vertical.
    pub(super) quantity: Option<Spanned<String>>,
    pub(super) plane: Option<Plane>,
    pub(super) plane_m: Option<Spanned<f64>>,
    /// Strip along the walls that this row leaves out; the norm's where it names none.
    pub(super) border_m: Option<Spanned<f64>>,
    /// Whether the row speaks of a part of a room that its outline does not tell.
    pub(super) part_of_room: Option<bool>,
    /// As the norm writes the plane, `Г-0,8`.
    #[serde(default)]
    pub(super) plane_name: String,
    pub(super) posture: Option<Posture>,
    pub(super) statistic: Option<LevelOf>,
    pub(super) em: Option<Spanned<f64>>,
    pub(super) em_modified: Option<Spanned<f64>>,
    pub(super) u0: Option<Spanned<f64>>,
    pub(super) ugr: Option<Spanned<f64>>,
    pub(super) ra: Option<Spanned<f64>>,
    pub(super) kp: Option<Spanned<f64>>,
    pub(super) gr: Option<Spanned<f64>>,
    pub(super) m: Option<Spanned<f64>>,
    pub(super) em_cylindrical: Option<Spanned<f64>>,
    pub(super) em_walls: Option<Spanned<f64>>,
    pub(super) em_ceiling: Option<Spanned<f64>>,
    /// Limits that no column expresses.
    #[serde(default)]
    pub(super) limit: Vec<LimitText>,
    /// Largest luminous intensities.
    pub(super) intensity: Option<Spanned<IntensityLimit>>,
    /// What the norm asks beyond these limits and nothing computes.
    #[serde(default)]
    pub(super) not_judged: Vec<String>,
    /// Columns that the norm itself leaves open for this row.
    #[serde(default)]
    pub(super) unregulated: Vec<Spanned<String>>,
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
    Percentage,
    GlareRating,
    DiscomfortIndex,
    Height,
    Ratio,
}

/// A column: key, kind of number, zone, quantity (`None`: the row's own), statistic (`None`: the one
/// that the norm limits).
pub(super) struct Column {
    pub(super) name: &'static str,
    pub(super) kind: Kind,
    pub(super) zone: Zone,
    quantity: Option<Quantity>,
    statistic: Option<Statistic>,
    is_maximum: bool,
}

const fn column(
    name: &'static str,
    kind: Kind,
    zone: Zone,
    quantity: Option<Quantity>,
    statistic: Option<Statistic>,
    is_maximum: bool,
) -> Column {
    Column { name, kind, zone, quantity, statistic, is_maximum }
}

/// All columns in the order of a row.
#[rustfmt::skip]
pub(super) const COLUMNS: [Column; 10] = [
    column("em", Kind::Illuminance, Zone::Task, None, None, false),
    column("u0", Kind::Fraction, Zone::Task, None, Some(Statistic::U0), false),
    column("ugr", Kind::Ugr, Zone::Room, Some(Quantity::Ugr), Some(Statistic::Value), true),
    column("m", Kind::DiscomfortIndex, Zone::Room, Some(Quantity::DiscomfortIndex), Some(Statistic::Value), true),
    column("gr", Kind::GlareRating, Zone::Room, Some(Quantity::NotComputed(Unmeasured::GlareRating)), Some(Statistic::Value), true),
    column("ra", Kind::ColourRendering, Zone::Declared, Some(Quantity::ColourRendering), Some(Statistic::Value), false),
    column("kp", Kind::Percentage, Zone::Declared, Some(Quantity::Declared(Property::Pulsation)), Some(Statistic::Value), true),
    column("em_cylindrical", Kind::Illuminance, Zone::Cylindrical, Some(Quantity::Cylindrical), Some(Statistic::Mean), false),
    column("em_walls", Kind::Illuminance, Zone::Walls, Some(Quantity::Normal), Some(Statistic::Mean), false),
    column("em_ceiling", Kind::Illuminance, Zone::Ceiling, Some(Quantity::Normal), Some(Statistic::Mean), false),
];

impl Column {
    /// What the column limits in a row of this quantity and level.
    pub(super) fn limits(&self, own: Quantity, level: Statistic) -> (Zone, Quantity, Statistic) {
        (self.zone, self.quantity.unwrap_or(own), self.statistic.unwrap_or(level))
    }

    /// A number as the bound it is.
    pub(super) fn bound(&self, number: f64) -> Bound {
        if self.is_maximum { Bound::Max(number) } else { Bound::Min(number) }
    }
}

impl RowText {
    /// The value of a column, if the row fills it.
    pub(super) fn value(&self, name: &str) -> Option<&Spanned<f64>> {
        match name {
            "em" => self.em.as_ref(),
            "u0" => self.u0.as_ref(),
            "ugr" => self.ugr.as_ref(),
            "m" => self.m.as_ref(),
            "gr" => self.gr.as_ref(),
            "ra" => self.ra.as_ref(),
            "kp" => self.kp.as_ref(),
            "em_cylindrical" => self.em_cylindrical.as_ref(),
            "em_walls" => self.em_walls.as_ref(),
            "em_ceiling" => self.em_ceiling.as_ref(),
            _ => None,
        }
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
