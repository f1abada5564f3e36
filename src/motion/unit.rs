//! Units of acceleration.

use std::fmt;
use std::str::FromStr;

use crate::error::{Error, Result};
use crate::text::words::unknown;

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
    /// One of this unit in m/s².
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

    /// The unit that files call so, by the whole name; upper or lower case.
    pub(super) fn named(name: &str) -> Option<Self> {
        let name = name.trim().trim_end_matches('.').to_ascii_lowercase();
        match name.as_str() {
            "g" | "g's" | "gs" => return Some(Self::StandardGravity),
            "gal" | "gals" => return Some(Self::Gal),
            _ => {}
        }
        let (length, time) = name.split_once('/')?;
        if !matches!(
            time.trim(),
            "s2" | "s²" | "s^2" | "s**2" | "s/s" | "sec2" | "sec^2" | "sec**2" | "sec/sec"
        ) {
            return None;
        }
        match length.trim() {
            "m" => Some(Self::MetrePerSecondSquared),
            "cm" => Some(Self::Gal),
            "mm" => Some(Self::MillimetrePerSecondSquared),
            "ft" => Some(Self::FootPerSecondSquared),
            "in" => Some(Self::InchPerSecondSquared),
            _ => None,
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

/// The names that files have, too: `cm/s2`, `m/s^2`, `m/sec/sec`, in upper or lower case.
///
/// ```
/// use basemat::motion::AccelerationUnit;
/// assert_eq!("cm/s^2".parse(), Ok(AccelerationUnit::Gal));
/// assert_eq!("m/s²".parse(), Ok(AccelerationUnit::MetrePerSecondSquared));
/// assert!("mg".parse::<AccelerationUnit>().is_err());
/// ```
impl FromStr for AccelerationUnit {
    type Err = Error;

    /// # Errors
    /// [`Error::Word`] with those that are known.
    fn from_str(text: &str) -> Result<Self> {
        let known = &["m/s²", "mm/s²", "g", "Gal", "cm/s²", "ft/s²", "in/s²"];
        Self::named(text).ok_or_else(|| unknown("unit of acceleration", text, known))
    }
}
