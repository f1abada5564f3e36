//! Springs with a memory: the trait, and laws for yielding storeys and base isolators.

mod bouc_wen;
mod lead_rubber;
mod slider;
mod springs;

pub use bouc_wen::BoucWen;
pub use lead_rubber::LeadRubber;
pub use slider::{Bilinear, FrictionPendulum};
pub(super) use springs::Springs;
pub use springs::WithSprings;

use crate::error::{CheckpointError, Result};

/// Force of a spring and its slope.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpringResponse {
    /// Force, N per metre of thickness, positive against a positive deformation.
    pub force: f64,
    /// Slope of the force over the deformation, N/m per metre.
    pub tangent: f64,
}

/// Energy of internal forces, J per metre of thickness.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InternalEnergy {
    /// Energy that unloading gives back.
    pub stored: f64,
    /// Energy turned into heat since the structure was new; it never decreases.
    pub dissipated: f64,
}

impl std::ops::Add for InternalEnergy {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { stored: self.stored + other.stored, dissipated: self.dissipated + other.dissipated }
    }
}

/// A spring whose force depends on where it has been: implement this for a law of your own.
///
/// The spring remembers the deformation of the last **committed** step and its internal variables
/// there. From there it is led straight to any trial deformation as often as Newton's method
/// wants, without remembering it; [`commit`](Hysteresis::commit) accepts one.
///
/// ```
/// use basemat::structure::{Bilinear, Hysteresis};
///
/// // 10 MN/m up to 100 kN, a tenth of the stiffness beyond.
/// let mut columns = Bilinear::new(10.0e6, 100.0e3, 0.1)?;
/// assert_eq!(columns.response(0.005).force, 50.0e3);
/// assert_eq!(columns.response(0.03).force, 120.0e3);
/// columns.commit(0.03);
/// // On the way back it is elastic again, and 18 mm of slip stay.
/// assert_eq!(columns.response(0.025).tangent, 10.0e6);
/// assert!((columns.response(0.018).force).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[auto_impl::auto_impl(Box)]
pub trait Hysteresis: Send {
    /// Force and tangent at `deformation` (m), reached straight from the last committed one.
    fn response(&self, deformation: f64) -> SpringResponse;

    /// Energies at `deformation`, reached in the same way: stored plus dissipated energy is the
    /// work of the force along the path.
    fn energy(&self, deformation: f64) -> InternalEnergy;

    /// Accepts a step that ended with `deformation`.
    fn commit(&mut self, deformation: f64);

    /// The internal variables that [`commit`](Hysteresis::commit) changes, always as many.
    fn save(&self) -> Vec<f64>;

    /// Takes back what [`save`](Hysteresis::save) returned; all values are finite. Unchanged on an
    /// error.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for values that cannot be such.
    fn restore(&mut self, values: &[f64]) -> Result<()>;

    /// A copy with its internal variables, as a rule `Box::new(self.clone())`.
    fn clone_box(&self) -> Box<dyn Hysteresis>;
}

impl Clone for Box<dyn Hysteresis> {
    fn clone(&self) -> Self {
        self.as_ref().clone_box()
    }
}

/// The error for internal variables that cannot be.
fn corrupt() -> crate::Error {
    CheckpointError::Corrupt { quantity: "state of a hysteretic spring" }.into()
}
