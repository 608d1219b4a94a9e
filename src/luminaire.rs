//! A luminaire: photometry placed in the room. The luminaire frame has γ = 0 along −z and the
//! opening's *length* along +x; the opening is no geometry and does not occlude.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::photometry::{IntensityDistribution, Opening};

/// What all luminaires of one `[luminaires.X]` entry share.
#[derive(Clone, Debug)]
pub struct LuminaireType {
    /// Name in the project file, `A`.
    pub name: String,
    /// What the drawing and the schedule print, from the photometric file.
    pub description: String,
    /// Absolute initial luminous intensities in the luminaire frame.
    pub distribution: IntensityDistribution,
    /// The light-emitting area.
    pub opening: Opening,
    /// Initial flux in lm as integrated from `distribution` (after the project's `flux` was applied).
    pub flux_lm: f64,
    /// Rated flux of the file in lm, if it states one.
    pub rated_flux_lm: Option<f64>,
    /// Connected power in W, if the file states one.
    pub power_w: Option<f64>,
    /// Luminaire part of the maintenance factor, LLMF·LSF·LMF; a room's RSMF multiplies it.
    pub maintenance: Maintenance,
    /// Share of the initial flux that is left in an emergency; `None`: the luminaire is dark then.
    pub emergency: Option<f64>,
    /// Photometric file as written in the project, empty for built-in sources.
    pub file: String,
    /// Colour rendering index declared for this type, if any.
    pub declared_ra: Option<f64>,
}

/// Maintenance factor by components, CIE 97.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Maintenance {
    /// Lamp lumen maintenance factor.
    pub llmf: f64,
    /// Lamp survival factor.
    pub lsf: f64,
    /// Luminaire maintenance factor.
    pub lmf: f64,
}

impl Maintenance {
    /// A new installation: all factors 1.
    pub const NEW: Self = Self { llmf: 1.0, lsf: 1.0, lmf: 1.0 };

    /// LLMF · LSF · LMF.
    pub fn factor(self) -> f64 {
        self.llmf * self.lsf * self.lmf
    }
}

/// A placed luminaire.
#[derive(Clone, Debug)]
pub struct Luminaire {
    /// What it is.
    pub kind: Arc<LuminaireType>,
    /// Centre of the opening in project coordinates, m.
    pub position: DVec3,
    /// Rotation from the luminaire frame to project axes (columns: length, width, −beam axis).
    pub world_from_luminaire: DMat3,
    /// Control group.
    pub group: String,
    /// Dimming of this placement, 0 … 1, part of its channel's flux.
    pub dim: f64,
    /// Surfaces of its own housing, to which it is blind (indices into the mesh's surfaces).
    pub body: Vec<u32>,
}

impl Luminaire {
    /// The unit direction of γ = 0.
    pub fn beam_axis(&self) -> DVec3 {
        -self.world_from_luminaire.z_axis
    }
}

/// Rotation for `aim` and `rotate`: the shortest rotation from −z to `aim` (for +z: 180° about +x),
/// then `rotate_deg` counter-clockwise seen against the aim. `aim` need not be normalised.
pub fn orientation(aim: DVec3, rotate_deg: f64) -> DMat3 {
    let aim = aim.normalize();
    let cos = -aim.z;
    let shortest = if cos < -1.0 + 1e-12 {
        DMat3::from_rotation_x(std::f64::consts::PI)
    } else {
        // Rodrigues' formula for the rotation that takes −z to `aim` about v = −z × aim.
        let v = DVec3::NEG_Z.cross(aim);
        let skew = DMat3::from_cols(
            DVec3::new(0.0, v.z, -v.y),
            DVec3::new(-v.z, 0.0, v.x),
            DVec3::new(v.y, -v.x, 0.0),
        );
        DMat3::IDENTITY + skew + skew * skew * (1.0 / (1.0 + cos))
    };
    // Who looks against the aim has it pointing at the eye, so counter-clockwise is a positive turn about it.
    DMat3::from_axis_angle(aim, rotate_deg.to_radians()) * shortest
}
