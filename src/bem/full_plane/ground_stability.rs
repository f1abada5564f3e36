//! Stability of a full-plane ground, assessed before the run.

use std::fmt;

use super::stability::Stability;
use super::stability_symbol::Symbol;
use super::{Boundary, BoundaryCondition, BoundaryKernel};
use crate::error::Result;

/// Stability of a boundary in the two limit states of its contact: all open, and all bonded.
///
/// A partly open base, and the structure on it, are not assessed. A structure stabilises the elements in
/// contact with it.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct GroundStability {
    /// All elements free of traction, as under an uplifted base.
    pub uplifted: Stability,
    /// State with prescribed displacements of the contact elements, as under a base that sticks.
    ///
    /// This state has the passivity figures.
    pub bonded: Stability,
}

impl GroundStability {
    /// Assesses `kernel` on `boundary` for growth beyond `smallest_growth` per step.
    pub(super) fn assess(
        kernel: &dyn BoundaryKernel,
        boundary: &Boundary,
        smallest_growth: f64,
    ) -> Result<Self> {
        let mut conditions = vec![BoundaryCondition::TractionFree; boundary.segments().len()];
        let mut symbol = Symbol::new(kernel, &conditions)?;
        let uplifted = Stability::from_symbol(&symbol, smallest_growth)?;
        for &element in boundary.contact() {
            conditions[element] = BoundaryCondition::PrescribedDisplacement;
        }
        symbol.prescribe(&conditions)?;
        let bonded = Stability::from_symbol(&symbol, smallest_growth)?;
        Ok(Self { uplifted, bonded })
    }

    /// The state that grows faster; the uplifted state if neither grows.
    pub fn worst(&self) -> &Stability {
        if self.bonded.growth_per_step > self.uplifted.growth_per_step {
            &self.bonded
        } else {
            &self.uplifted
        }
    }

    /// Whether neither state grows faster than the smallest growth searched for.
    pub fn is_bounded(&self) -> bool {
        self.uplifted.is_bounded() && self.bonded.is_bounded()
    }

    /// Returns `Ok` if no perturbation grows in either state.
    ///
    /// # Errors
    /// [`GroundError::Unstable`](crate::bem::GroundError::Unstable) with the faster growth.
    pub fn require_bounded(&self) -> Result<()> {
        self.worst().require_bounded()
    }
}

impl fmt::Display for GroundStability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "uplifted: {}\nbonded: {}", self.uplifted, self.bonded)
    }
}
