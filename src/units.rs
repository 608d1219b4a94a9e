//! Photometric quantities as types, so that lux and candela per square metre cannot be swapped
//! at a module border. Inside a formula the plain `f64` (`.0`) is used.

use serde::Serialize;

macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd, Serialize)]
        #[serde(transparent)]
        pub struct $name(pub f64);

        impl std::ops::Add for $name {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                Self(self.0 + other.0)
            }
        }
        impl std::ops::Mul<f64> for $name {
            type Output = Self;
            fn mul(self, factor: f64) -> Self {
                Self(self.0 * factor)
            }
        }
        impl std::iter::Sum for $name {
            fn sum<I: Iterator<Item = Self>>(items: I) -> Self {
                Self(items.map(|item| item.0).sum())
            }
        }
    };
}

quantity!(
    /// Illuminance in lx.
    Lux
);
quantity!(
    /// Luminance in cd/m².
    Nits
);
quantity!(
    /// Luminous intensity in cd.
    Candelas
);
quantity!(
    /// Luminous flux in lm.
    Lumens
);

/// Why a quantity has no value. Never replaced by 0, −1 or NaN.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Serialize)]
#[error("{reason}")]
pub struct Undefined {
    /// One clause in plain words, as printed in reports.
    pub reason: String,
}

impl Undefined {
    /// An undefined value with its reason.
    pub fn because(reason: impl Into<String>) -> Self {
        Self { reason: reason.into() }
    }
}
