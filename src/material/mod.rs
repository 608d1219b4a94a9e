//! Surface materials. Both sides of a surface reflect alike; `reflectance` is the diffuse part.

/// A named material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name as in the project file or glTF.
    pub name: String,
    /// How it scatters light.
    pub bsdf: Bsdf,
}

/// The closed set of scattering models. Luminous values, no colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Perfectly diffuse reflection, f = ρ/π.
    Lambert {
        /// ρ, 0 … < 1.
        reflectance: f64,
    },
    /// Diffuse reflection and diffuse transmission.
    Opal {
        /// ρ, 0 … 1.
        reflectance: f64,
        /// τ, ρ + τ ≤ 1.
        transmittance: f64,
    },
    /// Ideal mirror with a constant reflectance.
    Mirror {
        /// ρ, 0 … 1.
        reflectance: f64,
    },
    /// A clear pane drawn as one surface; see [`Pane`].
    Glass(Pane),
    /// A diffuse surface that also emits: luminous ceilings, screens, bright windows.
    Emitter {
        /// Emitted luminance of both sides, cd/m².
        luminance_cd_m2: f64,
        /// Diffuse reflectance of the surface itself.
        reflectance: f64,
    },
}

/// A plane-parallel pane of clear glass, from its normal transmittance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pane {
    /// Transmittance at normal incidence, interreflection inside the pane included, 0 … 1.
    pub normal_transmittance: f64,
}

impl Bsdf {
    /// Whether some incident light is absorbed, or leaves the scene, for every direction.
    pub fn absorbs(&self) -> bool {
        match *self {
            Self::Lambert { reflectance }
            | Self::Mirror { reflectance }
            | Self::Emitter { reflectance, .. } => reflectance < 1.0,
            Self::Opal {
                reflectance,
                transmittance,
            } => reflectance + transmittance < 1.0,
            Self::Glass(pane) => pane.normal_transmittance < 1.0,
        }
    }
}
