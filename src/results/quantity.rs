//! The scalar histories that every recording keeps.

use std::fmt;
use std::str::FromStr;

use crate::column::column;
use crate::error::{Error, Result};
use crate::words::{plain, unknown};

/// A scalar of [`crate::coupled::State`], or one derived from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Quantity {
    /// Horizontal force on the soil, positive to the right, N/m.
    BaseShear,
    /// Total moment on the soil, counter-clockwise, N·m/m.
    BaseMoment,
    /// Total pressure on the soil, N/m.
    NormalForce,
    /// Length of open elements over the length of the base.
    UpliftedFraction,
    /// Slip averaged over the base, m.
    MeanSlip,
    /// Largest |slip| of any element, m.
    LargestSlip,
    /// Rotation of the base, counter-clockwise, rad.
    BaseRotation,
    /// Mean horizontal displacement of the free field under the base, m.
    #[cfg_attr(feature = "serde", serde(rename = "free_field_x"))]
    FreeFieldHorizontal,
    /// Mean vertical displacement (up) of the free field under the base, m.
    #[cfg_attr(feature = "serde", serde(rename = "free_field_y"))]
    FreeFieldVertical,
    /// Resistance of the interface over the base shear: φN/|H|. Infinite without shear, NaN in
    /// flight, and throughout if an element's law has no friction coefficient and the builder was
    /// told none ([`safety_friction`](crate::coupled::SimulationBuilder::safety_friction)).
    ///
    /// It is made of tractions that did act: on a base that may slide it reaches one when it does,
    /// and never falls below. On a bonded base it may, and says what the interface would have lacked.
    /// Of several foundations the least.
    SlidingSafety,
    /// Restoring over overturning moment about the edge that the pressure moves to: N times the
    /// half width, over the moment about the middle of the base. NaN in flight. On a base that may
    /// open it reaches one when the base stands on its edge (on its last element), and never falls
    /// below. Of several foundations the least.
    OverturningSafety,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::BaseShear,
        Self::BaseMoment,
        Self::NormalForce,
        Self::UpliftedFraction,
        Self::MeanSlip,
        Self::LargestSlip,
        Self::BaseRotation,
        Self::FreeFieldHorizontal,
        Self::FreeFieldVertical,
        Self::SlidingSafety,
        Self::OverturningSafety,
    ];

    /// Its name, for tables and axes.
    pub fn name(self) -> &'static str {
        match self {
            Self::BaseShear => "base shear",
            Self::BaseMoment => "base moment",
            Self::NormalForce => "normal force",
            Self::UpliftedFraction => "uplifted fraction",
            Self::MeanSlip => "mean slip",
            Self::LargestSlip => "largest slip",
            Self::BaseRotation => "base rotation",
            Self::FreeFieldHorizontal => "free field, horizontal",
            Self::FreeFieldVertical => "free field, vertical",
            Self::SlidingSafety => "factor of safety, sliding",
            Self::OverturningSafety => "factor of safety, overturning",
        }
    }

    /// Its SI unit; empty for ratios.
    pub fn unit(self) -> &'static str {
        match self {
            Self::BaseShear | Self::NormalForce => "N/m",
            Self::BaseMoment => "N·m/m",
            Self::MeanSlip
            | Self::LargestSlip
            | Self::FreeFieldHorizontal
            | Self::FreeFieldVertical => "m",
            Self::BaseRotation => "rad",
            Self::UpliftedFraction | Self::SlidingSafety | Self::OverturningSafety => "",
        }
    }

    /// Its column in files, see [the rule](super#columns-and-numbers-in-files).
    ///
    /// ```
    /// use basemat::results::Quantity;
    /// assert_eq!(Quantity::BaseShear.column(), "base_shear_n_per_m");
    /// ```
    pub fn column(self) -> String {
        column(&self.to_string(), self.unit())
    }
}

/// Columns without their unit, in the order of [`Quantity::ALL`].
const COLUMNS: [&str; Quantity::ALL.len()] = [
    "base_shear",
    "base_moment",
    "normal_force",
    "uplifted_fraction",
    "mean_slip",
    "largest_slip",
    "base_rotation",
    "free_field_x",
    "free_field_y",
    "sliding_safety",
    "overturning_safety",
];

/// Its column without the unit: `base_shear`.
impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(COLUMNS[*self as usize])
    }
}

/// Reads what is displayed, the column or the [name](Quantity::name).
///
/// ```
/// use basemat::results::Quantity;
/// for text in ["base_shear", "base_shear_n_per_m", "base shear"] {
///     assert_eq!(text.parse(), Ok(Quantity::BaseShear));
/// }
/// assert!("shear".parse::<Quantity>().is_err());
/// ```
impl FromStr for Quantity {
    type Err = Error;

    /// # Errors
    /// [`Error::Word`] with those that are known.
    fn from_str(text: &str) -> Result<Self> {
        let word = plain(text);
        let is = |own: &Self| {
            COLUMNS[*own as usize] == word || own.column() == word || plain(own.name()) == word
        };
        Self::ALL.into_iter().find(is).ok_or_else(|| unknown("quantity", text, &COLUMNS))
    }
}
