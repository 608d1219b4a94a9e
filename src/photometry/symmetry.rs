//! The symmetry that a distribution *has*, whatever its file declares. Planes are those of the
//! luminaire frame: the opening's length lies along +x.

use super::IntensityDistribution;

/// Mirror planes of a distribution through the vertical axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// All half-planes are equal.
    Rotational,
    /// About the plane along the length and the plane across it.
    Quadrant,
    /// About the vertical plane along the length: I(−φ) = I(φ).
    AboutLength,
    /// About the vertical plane across the length: I(180° − φ) = I(φ).
    AboutWidth,
    /// None of these.
    None,
}

impl Symmetry {
    /// The word in files for machines.
    pub fn key(self) -> &'static str {
        match self {
            Self::Rotational => "rotational",
            Self::Quadrant => "quadrant",
            Self::AboutLength => "about-length",
            Self::AboutWidth => "about-width",
            Self::None => "none",
        }
    }

    /// The symmetry of a distribution, where differences up to `tolerance` times the largest
    /// intensity do not count.
    pub fn of(distribution: &IntensityDistribution, tolerance: f64) -> Self {
        let Some((azimuths, gammas)) = distribution.grid() else {
            return Self::Rotational;
        };
        if distribution.is_rotationally_symmetric() {
            return Self::Rotational;
        }
        let limit_cd = tolerance * distribution.max_intensity().0;
        let holds = |image: &dyn Fn(f64) -> f64| {
            azimuths.iter().all(|azimuth| {
                let differs = |gamma: &f64| {
                    let [here, there] =
                        [*azimuth, image(*azimuth)].map(|at| distribution.intensity_at(at, *gamma));
                    (here - there).abs() > limit_cd
                };
                !gammas.iter().any(differs)
            })
        };
        let first = azimuths[0];
        match (holds(&|azimuth| -azimuth), holds(&|azimuth| 180.0 - azimuth)) {
            (true, true) if holds(&|_| first) => Self::Rotational,
            (true, true) => Self::Quadrant,
            (true, false) => Self::AboutLength,
            (false, true) => Self::AboutWidth,
            (false, false) => Self::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: the two mirror planes swapped, noise taken for asymmetry.
    #[test]
    fn mirrors_are_told_apart() {
        let with = |cd: [f64; 4]| {
            let column = |cd: f64| vec![100.0, cd, 0.0];
            let planes = [cd[0], cd[1], cd[2], cd[3], cd[0]].map(column).to_vec();
            let azimuths = vec![0.0, 90.0, 180.0, 270.0, 360.0];
            let grid = IntensityDistribution::from_grid(azimuths, vec![0.0, 45.0, 90.0], planes);
            Symmetry::of(&grid.expect("valid"), 1e-3)
        };
        assert_eq!(with([50.0, 60.0, 50.0, 60.0]), Symmetry::Quadrant);
        assert_eq!(with([50.0, 60.0, 40.0, 60.0]), Symmetry::AboutLength);
        assert_eq!(with([50.0, 60.0, 50.0, 40.0]), Symmetry::AboutWidth);
        assert_eq!(with([50.0, 60.0, 40.0, 30.0]), Symmetry::None);
        assert_eq!(with([50.0, 50.01, 50.0, 49.99]), Symmetry::Rotational);
    }
}
