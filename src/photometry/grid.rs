//! What a table of intensities must be: rising axes, a closed circle, finite values. Checked once, where
//! a distribution is made, so that look-up and sampling need not.

use super::table::ends;

/// The sun has 3e27 cd, the strongest lighthouses 1e8 cd.
const MAX_CD: f64 = 1e15;

/// Why a grid is no intensity distribution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DistributionError {
    /// An axis has fewer than two values or the table does not match its axes.
    #[error("{what}: expected {expected} values, found {found}")]
    Size {
        /// Which list.
        what: &'static str,
        /// How many it needs.
        expected: usize,
        /// How many it has.
        found: usize,
    },
    /// An axis that does not rise.
    #[error("{axis} must rise, found {next}° after {previous}°")]
    Order {
        /// `γ` or `azimuth`.
        axis: &'static str,
        /// The value before.
        previous: f64,
        /// The value that does not exceed it.
        next: f64,
    },
    /// An axis beyond its range.
    #[error("{axis} runs from {from}° to {to}°, expected {expected}")]
    Range {
        /// `γ` or `azimuth`.
        axis: &'static str,
        /// First value.
        from: f64,
        /// Last value.
        to: f64,
        /// What is required.
        expected: &'static str,
    },
    /// A negative or non-finite intensity.
    #[error("intensity {cd} cd at azimuth {azimuth_deg}°, γ {gamma_deg}° is not a finite number ≥ 0")]
    Intensity {
        /// The value.
        cd: f64,
        /// Where.
        azimuth_deg: f64,
        /// Where.
        gamma_deg: f64,
    },
    /// The planes at 0° and 360° differ.
    #[error("the planes at 0° and 360° differ at γ {gamma_deg}°")]
    NotClosed {
        /// Where.
        gamma_deg: f64,
    },
    /// An intensity beyond any lamp, whose integrals might overflow.
    #[error("intensity {cd} cd is beyond any lamp")]
    Overflow {
        /// The value.
        cd: f64,
    },
}

/// Checks cd\[azimuth\]\[γ\]; see [`super::IntensityDistribution::from_grid`].
pub(super) fn check(
    azimuths_deg: &[f64],
    gammas_deg: &[f64],
    cd: &[Vec<f64>],
) -> Result<(), DistributionError> {
    check_axis("azimuth", azimuths_deg)?;
    check_axis("γ", gammas_deg)?;
    let (first, last) = ends(azimuths_deg);
    if first.abs() > 0.0 || (last - 360.0).abs() > 0.0 {
        let expected = "0° to 360°";
        return Err(DistributionError::Range { axis: "azimuth", from: first, to: last, expected });
    }
    let (first, last) = ends(gammas_deg);
    if first < 0.0 || last > 180.0 {
        let expected = "values within 0° to 180°";
        return Err(DistributionError::Range { axis: "γ", from: first, to: last, expected });
    }
    check_size("planes of intensities", azimuths_deg.len(), cd.len())?;
    for (plane, azimuth) in cd.iter().zip(azimuths_deg) {
        check_size("intensities of a plane", gammas_deg.len(), plane.len())?;
        for (value, gamma) in plane.iter().zip(gammas_deg) {
            if !(value.is_finite() && *value >= 0.0) {
                return Err(DistributionError::Intensity {
                    cd: *value,
                    azimuth_deg: *azimuth,
                    gamma_deg: *gamma,
                });
            }
        }
    }
    let unclosed = (0..gammas_deg.len()).find(|i| (cd[0][*i] - cd[cd.len() - 1][*i]).abs() > 0.0);
    if let Some(i) = unclosed {
        return Err(DistributionError::NotClosed { gamma_deg: gammas_deg[i] });
    }
    let peak = cd.iter().flatten().copied().fold(0.0, f64::max);
    if peak > MAX_CD {
        return Err(DistributionError::Overflow { cd: peak });
    }
    Ok(())
}

fn check_axis(axis: &'static str, values: &[f64]) -> Result<(), DistributionError> {
    if values.len() < 2 {
        return Err(DistributionError::Size { what: axis, expected: 2, found: values.len() });
    }
    let falling = values.windows(2).find(|pair| !(pair[1] > pair[0]));
    falling.map_or(Ok(()), |pair| Err(DistributionError::Order { axis, previous: pair[0], next: pair[1] }))
}

fn check_size(what: &'static str, expected: usize, found: usize) -> Result<(), DistributionError> {
    if expected == found { Ok(()) } else { Err(DistributionError::Size { what, expected, found }) }
}
