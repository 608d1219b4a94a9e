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
    /// General colour rendering index R_a, 1: declared, never computed.
    ColourRendering,
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
    /// A single value: a viewpoint's index, a room's UGR table value.
    Value,
}

impl Statistic {
    /// The key used in files: `mean`, `min`, `max`, `U0`, `Ud`, `value`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::Min => "min",
            Self::Max => "max",
            Self::U0 => "U0",
            Self::Ud => "Ud",
            Self::Value => "value",
        }
    }

    /// The statistic of a key; `None` for anything else.
    pub fn parse(key: &str) -> Option<Self> {
        [Self::Mean, Self::Min, Self::Max, Self::U0, Self::Ud, Self::Value]
            .into_iter()
            .find(|statistic| statistic.key() == key)
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
];

impl Quantity {
    /// Reads a spelling such as `E_h`, `E_v@90` or `L@45,-10`; `None` if it is not one of [`SPELLINGS`].
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
            ("R_a", None) => Some(Self::ColourRendering),
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
            Self::ColourRendering => "R_a".into(),
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
            Self::Modelling | Self::Ugr | Self::ColourRendering => "1",
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
        ] {
            let quantity = Quantity::parse(text).unwrap_or_else(|| panic!("{text} must parse"));
            assert_eq!(quantity.key(), text);
        }
        for text in ["", "E", "E_v", "E_v@", "E_v@nan", "E_h@3", "L@1", "L@1,91", "e_h"] {
            assert!(Quantity::parse(text).is_none(), "{text} must be refused");
        }
    }
}
