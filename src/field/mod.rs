//! The stored, view-independent field: for every patch and side the luminance that its diffuse
//! material reflects or passes on, one number per channel (initial flux). It is an approximation,
//! frozen after it is built; the solver corrects it without bias, so it decides only the noise.

pub mod angular;
mod neighbours;
pub mod nodal;
pub mod nodes;
mod patches;
mod smooth;
pub mod store;

use glam::DVec3;

pub use patches::Patches;
pub use smooth::{Misfit, Smooth};

/// Luminance of every patch side for every channel, cd/m².
#[derive(Clone, Debug)]
pub struct LuminanceField {
    patches: Patches,
    channels: usize,
    luminance: Vec<f64>,
}

impl LuminanceField {
    /// A dark field.
    pub fn dark(patches: Patches, channels: usize) -> Self {
        let luminance = vec![0.0; patches.sides() * channels];
        Self { patches, channels, luminance }
    }

    /// The patches.
    pub fn patches(&self) -> &Patches {
        &self.patches
    }

    /// Luminance of all channels leaving a patch side, cd/m².
    pub fn at(&self, side: usize) -> &[f64] {
        &self.luminance[side * self.channels..(side + 1) * self.channels]
    }

    /// Mutable [`LuminanceField::at`], for the builder.
    pub fn at_mut(&mut self, side: usize) -> &mut [f64] {
        &mut self.luminance[side * self.channels..(side + 1) * self.channels]
    }
}

/// A random place on a patch: position and unit normal of the front side.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Position, m.
    pub point: DVec3,
    /// Unit normal of the triangle's front.
    pub normal: DVec3,
}

/// How much of a patch side light reaches; the rest is covered by what stands on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// All of it.
    Whole,
    /// A part.
    Part {
        /// Share of its area, 0 … 1.
        share: f64,
        /// Mean of the places that light reaches, m.
        middle: DVec3,
        /// One of them, near to the mean, m.
        place: DVec3,
    },
    /// Nothing.
    Dark,
}

impl Reached {
    /// From the places that light reaches, out of `tried`.
    pub fn part(places: &[DVec3], tried: u32) -> Self {
        if places.len() == tried as usize {
            return Self::Whole;
        }
        let middle = places.iter().sum::<DVec3>() / places.len().max(1) as f64;
        let nearest = places.iter().min_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle)));
        nearest.map_or(Self::Dark, |&place| {
            let share = places.len() as f64 / f64::from(tried.max(1));
            Self::Part { share, middle, place }
        })
    }

    /// Share of the area that counts; a side that is dark as a whole counts as one.
    pub fn share(&self) -> f64 {
        match self {
            Self::Part { share, .. } => *share,
            Self::Whole | Self::Dark => 1.0,
        }
    }

    /// Whether no light reaches it.
    pub fn is_dark(&self) -> bool {
        matches!(self, Self::Dark)
    }

    /// Middle and a place of the part that light reaches; `None` where it is all or none.
    pub fn middle(&self) -> Option<[DVec3; 2]> {
        match *self {
            Self::Part { middle, place, .. } => Some([middle, place]),
            Self::Whole | Self::Dark => None,
        }
    }
}
