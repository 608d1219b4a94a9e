//! Names of the quantities that can be asked for, measured and limited; one table, read by
//! project files, norm files and reports alike.

use serde::Serialize;

/// A photometric quantity at a point (or, for UGR, at a viewpoint or room).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Quantity {
    /// Horizontal illuminance E_h, lx: on an upward-facing plane.
    Horizontal,
    /// Vertical illuminance E_v, lx: on a vertical plane that faces `azimuth_deg`.
    Vertical {
        /// Degrees from +x towards +y.
        azimuth_deg: f64,
    },
    /// Illuminance on the area's own normal E_n, lx.
    Normal,
    /// Cylindrical illuminance E_cyl (CIE: E_z), lx: mean vertical illuminance over all azimuths.
    Cylindrical,
    /// Semicylindrical illuminance E_semi, lx, facing `azimuth_deg`.
    Semicylindrical {
        /// Degrees from +x towards +y.
        azimuth_deg: f64,
    },
    /// Hemispherical illuminance E_hemi, lx, axis up.
    Hemispherical,
    /// Spherical (scalar) illuminance E_sph, lx: flux on a small sphere divided by its area.
    Spherical,
    /// Modelling E_cyl / E_h at the same point, 1.
    Modelling,
    /// Luminance L seen from the point, cd/m².
    Luminance {
        /// Direction of sight, degrees from +x towards +y.
        azimuth_deg: f64,
        /// Direction of sight above the horizon, degrees.
        tilt_deg: f64,
    },
    /// Unified glare rating, 1.
    Ugr,
    /// Luminous intensity of a luminaire in a zone about the vertical, cd.
    Intensity,
    /// General colour rendering index R_a, 1: declared, never computed.
    ColourRendering,
    /// Discomfort index M of older Russian norms, 1: M = 10^((UGR + 4.8)/16), from the table UGR.
    DiscomfortIndex,
    /// An index of glare or another figure of a view, as a requirement on a viewpoint names it: a row of
    /// `glare::index`, without its function.
    OfView {
        /// Key of the row.
        key: &'static str,
        /// Its unit, `1` for none.
        unit: &'static str,
    },
    /// Another property of the light sources: declared, never computed.
    Declared(Property),
    /// What norms limit and gershun does not compute: always "not assessed".
    NotComputed(Unmeasured),
}

/// A property that only the maker of a luminaire can state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Property {
    /// Pulsation of the illuminance, %.
    Pulsation,
    /// Short-term flicker P_st^LM, 1.
    PstLm,
    /// Stroboscopic visibility measure, 1.
    Svm,
}

/// A quantity of norms that has no computation here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Unmeasured {
    /// Glare rating R_G of outdoor and sports lighting (CIE 112), 1.
    GlareRating,
    /// Daylight factor D, %.
    DaylightFactor,
    /// Daylight glare probability over the occupied time of a year, 1.
    DaylightGlare,
}

/// How the values of an area become one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Statistic {
    /// Arithmetic mean over the grid.
    Mean,
    /// Smallest grid value.
    Min,
    /// Largest grid value.
    Max,
    /// Uniformity U0 = E_min / Ē.
    U0,
    /// Diversity U_d = E_min / E_max.
    Ud,
    /// Mean over the area divided by the mean of E_h over its task area (the area itself, for a task).
    OfTask,
    /// A single value: a viewpoint's index, a room's UGR table value.
    Value,
}

impl Statistic {
    /// All of them, in the order of hints.
    pub const ALL: [Self; 7] =
        [Self::Mean, Self::Min, Self::Max, Self::U0, Self::Ud, Self::OfTask, Self::Value];

    /// Whether it is a ratio without a unit.
    pub fn is_ratio(self) -> bool {
        matches!(self, Self::U0 | Self::Ud | Self::OfTask)
    }

    /// The key used in files: `mean`, `min`, `max`, `U0`, `Ud`, `mean/task`, `value`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::Min => "min",
            Self::Max => "max",
            Self::U0 => "U0",
            Self::Ud => "Ud",
            Self::OfTask => "mean/task",
            Self::Value => "value",
        }
    }

    /// The statistic of a key; `None` for anything else.
    pub fn parse(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|statistic| statistic.key() == key)
    }
}

/// The spellings a user may write, for error hints.
pub const SPELLINGS: &[&str] = &[
    "E_h",
    "E_v@azimuth",
    "E_n",
    "E_cyl",
    "E_semi@azimuth",
    "E_hemi",
    "E_sph",
    "modelling",
    "L@azimuth,tilt",
    "UGR",
    "R_a",
    "M",
    "pulsation",
    "PstLM",
    "SVM",
    "GR",
    "D",
    "DGP",
];

impl Property {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Pulsation, Self::PstLm, Self::Svm];

    /// The spelling in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Pulsation => "pulsation",
            Self::PstLm => "PstLM",
            Self::Svm => "SVM",
        }
    }
}

impl Unmeasured {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::GlareRating, Self::DaylightFactor, Self::DaylightGlare];

    /// The spelling in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::GlareRating => "GR",
            Self::DaylightFactor => "D",
            Self::DaylightGlare => "DGP",
        }
    }
}

impl Quantity {
    /// Whether it is one number of a room or a luminaire, not a value at every point of an area.
    pub fn is_single(self) -> bool {
        matches!(
            self,
            Self::Ugr
                | Self::Intensity
                | Self::ColourRendering
                | Self::DiscomfortIndex
                | Self::OfView { .. }
                | Self::Declared(_)
                | Self::NotComputed(_)
        )
    }

    /// Whether it is a probability of being disturbed, between 0 and 1, which norms print with two decimals.
    pub fn is_probability(self) -> bool {
        matches!(
            self,
            Self::OfView { key: "DGP" | "DGPs" | "UGP" | "UGP2", .. }
                | Self::NotComputed(Unmeasured::DaylightGlare)
        )
    }

    /// Whether it is a ratio of luminances about a task.
    pub fn is_luminance_ratio(self) -> bool {
        matches!(self, Self::OfView { key: "L_task/L_surround" | "L_task/L_far", .. })
    }

    /// Reads a spelling such as `E_h`, `E_v@90` or `L@45,-10`; `None` if it is not one of [`SPELLINGS`].
    /// [`Quantity::OfView`] has no spelling of its own: `M` and `DGP` mean something else of a room.
    pub fn parse(text: &str) -> Option<Self> {
        let finite = |number: &str| number.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        let (name, argument) = match text.split_once('@') {
            Some((name, argument)) => (name, Some(argument)),
            None => (text, None),
        };
        match (name, argument) {
            ("E_h", None) => Some(Self::Horizontal),
            ("E_n", None) => Some(Self::Normal),
            ("E_cyl", None) => Some(Self::Cylindrical),
            ("E_hemi", None) => Some(Self::Hemispherical),
            ("E_sph", None) => Some(Self::Spherical),
            ("modelling", None) => Some(Self::Modelling),
            ("UGR", None) => Some(Self::Ugr),
            ("I", None) => Some(Self::Intensity),
            ("R_a", None) => Some(Self::ColourRendering),
            ("M", None) => Some(Self::DiscomfortIndex),
            (name, None) if Property::ALL.iter().any(|property| property.key() == name) => {
                Property::ALL.into_iter().find(|property| property.key() == name).map(Self::Declared)
            }
            (name, None) => {
                Unmeasured::ALL.into_iter().find(|quantity| quantity.key() == name).map(Self::NotComputed)
            }
            ("E_v", Some(azimuth)) => Some(Self::Vertical { azimuth_deg: finite(azimuth)? }),
            ("E_semi", Some(azimuth)) => Some(Self::Semicylindrical { azimuth_deg: finite(azimuth)? }),
            ("L", Some(angles)) => {
                let (azimuth, tilt) = angles.split_once(',')?;
                let tilt_deg = finite(tilt).filter(|tilt| tilt.abs() <= 90.0)?;
                Some(Self::Luminance { azimuth_deg: finite(azimuth)?, tilt_deg })
            }
            _ => None,
        }
    }

    /// The spelling that [`Quantity::parse`] reads back.
    pub fn key(self) -> String {
        match self {
            Self::Horizontal => "E_h".into(),
            Self::Vertical { azimuth_deg } => format!("E_v@{azimuth_deg}"),
            Self::Normal => "E_n".into(),
            Self::Cylindrical => "E_cyl".into(),
            Self::Semicylindrical { azimuth_deg } => format!("E_semi@{azimuth_deg}"),
            Self::Hemispherical => "E_hemi".into(),
            Self::Spherical => "E_sph".into(),
            Self::Modelling => "modelling".into(),
            Self::Luminance { azimuth_deg, tilt_deg } => format!("L@{azimuth_deg},{tilt_deg}"),
            Self::Ugr => "UGR".into(),
            Self::Intensity => "I".into(),
            Self::ColourRendering => "R_a".into(),
            Self::DiscomfortIndex => "M".into(),
            Self::OfView { key, .. } => key.into(),
            Self::Declared(property) => property.key().into(),
            Self::NotComputed(quantity) => quantity.key().into(),
        }
    }

    /// Unit as printed in headers; `1` for ratios.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Horizontal
            | Self::Vertical { .. }
            | Self::Normal
            | Self::Cylindrical
            | Self::Semicylindrical { .. }
            | Self::Hemispherical
            | Self::Spherical => "lx",
            Self::Luminance { .. } => "cd/m²",
            Self::Intensity => "cd",
            Self::OfView { unit, .. } => unit,
            Self::Declared(Property::Pulsation) | Self::NotComputed(Unmeasured::DaylightFactor) => "%",
            Self::Modelling
            | Self::Ugr
            | Self::ColourRendering
            | Self::DiscomfortIndex
            | Self::Declared(_)
            | Self::NotComputed(_) => "1",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_reads_back_and_nonsense_does_not() {
        for text in [
            "E_h",
            "E_v@90",
            "E_n",
            "E_cyl",
            "E_semi@-45.5",
            "E_hemi",
            "E_sph",
            "modelling",
            "L@10,-30",
            "UGR",
            "R_a",
            "M",
            "pulsation",
            "SVM",
            "GR",
            "D",
            "DGP",
        ] {
            let quantity = Quantity::parse(text).unwrap_or_else(|| panic!("{text} must parse"));
            assert_eq!(quantity.key(), text);
        }
        for text in ["", "E", "E_v", "E_v@", "E_v@nan", "E_h@3", "L@1", "L@1,91", "e_h"] {
            assert!(Quantity::parse(text).is_none(), "{text} must be refused");
        }
    }
}
