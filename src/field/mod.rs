//! The stored, view-independent field: for every patch and side the luminance that its diffuse
//! material reflects or passes on, one number per channel (initial flux). It is an approximation,
//! frozen after it is built; the solver corrects it without bias, so it decides only the noise.

mod patches;
mod smooth;
pub mod store;

use glam::DVec3;

pub use patches::Patches;
pub use smooth::Smooth;

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
