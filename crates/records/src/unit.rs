//! Units of acceleration.

use std::fmt;

/// Standard gravity, 9.80665 m/s² (3rd CGPM, 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Unit of the accelerations in a file.
///
/// ```
/// use basemat::motion::AccelerationUnit;
/// assert_eq!(AccelerationUnit::Gal.in_metres_per_second_squared(), 0.01);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum AccelerationUnit {
    /// m/s².
    #[cfg_attr(feature = "serde", serde(rename = "m/s²"))]
    MetrePerSecondSquared,
    /// mm/s².
    #[cfg_attr(feature = "serde", serde(rename = "mm/s²"))]
    MillimetrePerSecondSquared,
    /// g, 9.80665 m/s².
    #[cfg_attr(feature = "serde", serde(rename = "g"))]
    StandardGravity,
    /// Gal, cm/s².
    Gal,
    /// ft/s², 0.3048 m/s².
    #[cfg_attr(feature = "serde", serde(rename = "ft/s²"))]
    FootPerSecondSquared,
    /// in/s², 0.0254 m/s².
    #[cfg_attr(feature = "serde", serde(rename = "in/s²"))]
    InchPerSecondSquared,
}

impl AccelerationUnit {
    /// Value of this unit in m/s².
    pub fn in_metres_per_second_squared(self) -> f64 {
        match self {
            Self::MetrePerSecondSquared => 1.0,
            Self::MillimetrePerSecondSquared => 1e-3,
            Self::StandardGravity => STANDARD_GRAVITY,
            Self::Gal => 1e-2,
            Self::FootPerSecondSquared => 0.3048,
            Self::InchPerSecondSquared => 0.0254,
        }
    }
}

/// The name of the unit: `m/s²`, `g`, `Gal`.
impl fmt::Display for AccelerationUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::MetrePerSecondSquared => "m/s²",
            Self::MillimetrePerSecondSquared => "mm/s²",
            Self::StandardGravity => "g",
            Self::Gal => "Gal",
            Self::FootPerSecondSquared => "ft/s²",
            Self::InchPerSecondSquared => "in/s²",
        })
    }
}
