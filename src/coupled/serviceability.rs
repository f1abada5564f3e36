//! Serviceability limits: allowable slip, gap, uplifted fraction, rotation and settlement of a base.

use crate::coupled::State;
use crate::error::{Result, positive, require};
use crate::geometry::resultant;

/// Response of a base with a serviceability limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Criterion {
    /// Slip averaged over a foundation, in any direction, m.
    ///
    /// It includes the tangential motion of open elements.
    Slip,
    /// Gap of an element, m.
    Gap,
    /// Uplifted fraction of a foundation.
    UpliftedFraction,
    /// Magnitude of the rotation of a foundation's chord since the static state, rad.
    ///
    /// In plan it is the tilt in any direction.
    Rotation,
    /// Settlement of a foundation's centre since the static state, m, downwards.
    Settlement,
}

words! { pub(crate) Criterion, "criterion", {
    Slip = "slip",
    Gap = "gap",
    UpliftedFraction = "uplifted_fraction",
    Rotation = "rotation",
    Settlement = "settlement",
} }

impl Criterion {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slip => "slip",
            Self::Gap => "gap",
            Self::UpliftedFraction => "uplifted fraction",
            Self::Rotation => "rotation",
            Self::Settlement => "settlement",
        }
    }

    /// SI unit; empty for a fraction.
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Slip | Self::Gap | Self::Settlement => "m",
            Self::UpliftedFraction => "",
            Self::Rotation => "rad",
        }
    }

    /// Value of largest magnitude among all foundations or elements of a state.
    pub(crate) fn largest_value(self, state: &State) -> f64 {
        let foundations = state.foundations.iter();
        match self {
            Self::Slip => foundations
                .map(|foundation| resultant(foundation.mean_slip, foundation.mean_slip_across))
                .fold(0.0, larger_magnitude),
            Self::Gap => {
                state.contact.iter().fold(0.0, |largest, contact| contact.gap.max(largest))
            }
            Self::UpliftedFraction => foundations
                .map(|foundation| foundation.uplifted_fraction)
                .fold(0.0, larger_magnitude),
            Self::Rotation => foundations
                .map(|foundation| resultant(foundation.base_rotation, foundation.rotation_across))
                .fold(0.0, larger_magnitude),
            Self::Settlement => {
                foundations.fold(0.0, |largest, foundation| foundation.settlement.max(largest))
            }
        }
    }
}

/// The one of two values with the larger magnitude.
fn larger_magnitude(first: f64, second: f64) -> f64 {
    if second.abs() > first.abs() { second } else { first }
}

/// Allowable motion of a base: serviceability limits.
///
/// Set them by [`SimulationBuilder::serviceability`](crate::coupled::SimulationBuilder::serviceability); each
/// [`Run`](crate::results::Run) states whether they were met.
///
/// ```
/// use basemat::bem::SpringGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::results::{Criterion, Serviceability};
/// use basemat::structure::RigidBlock;
/// use basemat::Simulation;
///
/// let limits =
///     Serviceability { slip: Some(5e-3), rotation: Some(0.05), ..Serviceability::default() };
/// let mut simulation = Simulation::builder(0.01)
///     .structure(RigidBlock::new(4.0, 2.0, 2000.0)?)
///     .ground(SpringGround::new(-2.0..2.0, 8, 2e8, 1e8)?)
///     .interface(Coulomb::new(0.1)?)
///     .motion(el_centro_1940())
///     .serviceability(limits)
///     .build()?;
/// let run = simulation.run(1000, |_| {})?;
///
/// // The block exceeds the allowable slip, but not the allowable rotation.
/// let [slip, rotation] = &run.serviceability[..] else { panic!("two criteria") };
/// assert_eq!(slip.criterion, Criterion::Slip);
/// assert!(!slip.is_met() && slip.margin() < 0.0);
/// assert!(slip.first_excess.is_some_and(|time| time > 1.0 && time <= slip.largest.time));
/// assert!(rotation.is_met() && rotation.margin() > 0.9 && rotation.first_excess.is_none());
/// assert_eq!(run.is_serviceable(), Some(false));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "ServiceabilityForm"))]
pub struct Serviceability {
    /// Allowable slip (m), above zero: [`Criterion::Slip`].
    pub slip: Option<f64>,
    /// Allowable gap (m), above zero: [`Criterion::Gap`].
    pub gap: Option<f64>,
    /// Allowable uplifted fraction, above zero and at most one: [`Criterion::UpliftedFraction`].
    pub uplifted_fraction: Option<f64>,
    /// Allowable rotation (rad), above zero: [`Criterion::Rotation`].
    pub rotation: Option<f64>,
    /// Allowable settlement (m), above zero: [`Criterion::Settlement`].
    pub settlement: Option<f64>,
}

validated! {
    Serviceability as ServiceabilityForm {
        slip: Option<f64>,
        gap: Option<f64>,
        uplifted_fraction: Option<f64>,
        rotation: Option<f64>,
        #[serde(default)]
        settlement: Option<f64>,
    }
    => {
        Serviceability { slip, gap, uplifted_fraction, rotation, settlement }.checked()
    }
}

impl Serviceability {
    /// Returns the limits if all of them are valid.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless slip, gap, rotation and settlement are finite and above zero, and
    /// the fraction is above zero and at most one.
    pub(crate) fn checked(self) -> Result<Self> {
        for (quantity, limit) in [
            ("allowable slip", self.slip),
            ("allowable gap", self.gap),
            ("allowable rotation", self.rotation),
            ("allowable settlement", self.settlement),
        ] {
            limit.map_or(Ok(0.0), |limit| positive(quantity, limit))?;
        }
        if let Some(value) = self.uplifted_fraction {
            let is_fraction = value > 0.0 && value <= 1.0;
            let needed = "above zero, at most one";
            require("allowable uplifted fraction", value, is_fraction, needed)?;
        }
        Ok(self)
    }
}
