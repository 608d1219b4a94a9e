//! What both writers share: which planes to store, and numbers that survive a round trip.

use super::{Photometry, Symmetry};

/// Differences below this share of the largest intensity count as symmetric when writing.
const EXACT: f64 = 1e-9;
const SAME_DEG: f64 = 1e-6;

/// Planes in the file's own angle (azimuth + turn), rising within 0 … 360 without 360.
pub(super) struct Planes {
    pub(super) all_deg: Vec<f64>,
    pub(super) gammas_deg: Vec<f64>,
    pub(super) symmetry: Symmetry,
    turn_deg: f64,
}

impl Planes {
    /// The nodes of the distribution and the symmetry that its planes allow to use: a mirror needs
    /// the planes on its axis and the image of every plane.
    pub(super) fn of(photometry: &Photometry, turn_deg: f64) -> Self {
        let distribution = &photometry.distribution;
        let every_degree: Vec<f64> = (0..=180).map(f64::from).collect();
        let (azimuths, gammas) = distribution.grid().unwrap_or((&[0.0], &every_degree));
        let turned = |azimuth: &f64| {
            let angle = (azimuth + turn_deg).rem_euclid(360.0);
            if 360.0 - angle < SAME_DEG { 0.0 } else { angle }
        };
        let mut all_deg: Vec<f64> = azimuths.iter().map(turned).collect();
        all_deg.sort_by(f64::total_cmp);
        all_deg.dedup_by(|next, kept| *next - *kept < SAME_DEG);
        let mut symmetry = Symmetry::of(distribution, EXACT);
        let mut planes = Self { all_deg, gammas_deg: gammas.to_vec(), symmetry, turn_deg };
        let along = planes.mirrors_at(turn_deg);
        let across = planes.mirrors_at(turn_deg + 90.0);
        symmetry = match symmetry {
            Symmetry::Rotational => Symmetry::Rotational,
            Symmetry::Quadrant if along && across => Symmetry::Quadrant,
            Symmetry::Quadrant | Symmetry::AboutLength if along => Symmetry::AboutLength,
            Symmetry::Quadrant | Symmetry::AboutWidth if across => Symmetry::AboutWidth,
            _ => Symmetry::None,
        };
        planes.symmetry = symmetry;
        if symmetry == Symmetry::Rotational {
            planes.all_deg = vec![0.0];
        }
        planes
    }

    fn has(&self, angle_deg: f64) -> bool {
        let apart = |known: &f64| {
            let difference = (known - angle_deg).rem_euclid(360.0);
            difference.min(360.0 - difference)
        };
        self.all_deg.iter().any(|known| apart(known) < SAME_DEG)
    }

    fn mirrors_at(&self, axis_deg: f64) -> bool {
        let images = self.all_deg.iter().all(|angle| self.has(2.0 * axis_deg - angle));
        self.has(axis_deg) && self.has(axis_deg + 180.0) && images
    }

    /// The planes with angles within `from` … `to`, where 360 may be passed, in that order.
    pub(super) fn between(&self, from_deg: f64, to_deg: f64) -> Vec<f64> {
        let twice = self.all_deg.iter().copied().chain(self.all_deg.iter().map(|angle| angle + 360.0));
        twice.filter(|angle| (from_deg - SAME_DEG..=to_deg + SAME_DEG).contains(angle)).collect()
    }

    /// Intensities of one plane, cd.
    pub(super) fn intensities(&self, photometry: &Photometry, angle_deg: f64) -> Vec<f64> {
        let azimuth = angle_deg - self.turn_deg;
        let distribution = &photometry.distribution;
        self.gammas_deg.iter().map(|gamma| distribution.intensity_at(azimuth, *gamma)).collect()
    }
}

/// Ten significant digits without an exponent.
pub(super) fn number(value: f64) -> String {
    format!("{value:.9e}").parse::<f64>().unwrap_or(value).to_string()
}

/// One line of at most `most` characters in ASCII; others become `?`.
pub(super) fn ascii(text: &str, most: usize) -> String {
    text.chars().map(|c| if c.is_ascii() && !c.is_ascii_control() { c } else { '?' }).take(most).collect()
}
