//! Stability of a full-plane ground, found before it marches.

use std::fmt;

use super::BoundaryCondition;
use super::stability::Stability;
use super::stability_symbol::Symbol;
use super::{Boundary, BoundaryKernel};
use crate::error::Result;

/// Assessment of a boundary with contact elements, in the two states between which contact moves:
/// all of it open, all of it held.
///
/// A base that is open in part, and the structure that stands on it, are not assessed; a structure
/// steadies what it holds.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct GroundStability {
    /// All elements free of traction, as under a base that has lifted off.
    pub uplifted: Stability,
    /// Displacements of the contact elements prescribed, as under a base that sticks. This one has
    /// the passivity figures.
    pub bonded: Stability,
}

impl GroundStability {
    /// Assesses `kernel` on `boundary`, looking for growth beyond `smallest_growth` per step.
    pub(super) fn assess(
        kernel: &dyn BoundaryKernel,
        boundary: &Boundary,
        smallest_growth: f64,
    ) -> Result<Self> {
        let mut conditions = vec![BoundaryCondition::TractionFree; boundary.segments().len()];
        let mut symbol = Symbol::new(kernel, &conditions)?;
        let uplifted = Stability::of(&symbol, smallest_growth)?;
        for &element in boundary.contact() {
            conditions[element] = BoundaryCondition::PrescribedDisplacement;
        }
        symbol.prescribe(&conditions)?;
        let bonded = Stability::of(&symbol, smallest_growth)?;
        Ok(Self { uplifted, bonded })
    }

    /// The state that grows faster; the uplifted one if neither grows.
    pub fn worst(&self) -> &Stability {
        if self.bonded.growth_per_step > self.uplifted.growth_per_step {
            &self.bonded
        } else {
            &self.uplifted
        }
    }

    /// Whether neither state grows faster than what was looked for.
    pub fn is_bounded(&self) -> bool {
        self.uplifted.is_bounded() && self.bonded.is_bounded()
    }

    /// Nothing if the march is bounded in both states.
    ///
    /// # Errors
    /// [`crate::Error::Unstable`] with the faster growth.
    pub fn require_bounded(&self) -> Result<()> {
        self.worst().require_bounded()
    }
}

impl fmt::Display for GroundStability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "uplifted: {}\nbonded: {}", self.uplifted, self.bonded)
    }
}
