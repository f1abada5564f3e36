//! Hysteretic springs: the trait, and laws for yielding storeys and base isolators.

mod biaxial;
mod bilinear;
mod bouc_wen;
mod coupled_bouc_wen;
mod coupled_slider;
mod friction_pendulum;
mod lead_rubber;
mod pendulum_bearing;
mod slider;
mod spring;
mod springs;

pub use biaxial::BiaxialSpring;
pub use bilinear::Bilinear;
pub use bouc_wen::BoucWen;
pub use friction_pendulum::FrictionPendulum;
pub use lead_rubber::LeadRubber;
pub use pendulum_bearing::PendulumBearing;
pub(super) use springs::HystereticSprings;
pub use springs::WithSprings;

use super::InternalEnergy;
use crate::error::{CheckpointError, Result};

/// Force of a hysteretic spring and its tangent stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpringResponse {
    /// Force, N per metre of thickness, positive against a positive deformation.
    pub force: f64,
    /// Derivative of the force with respect to the deformation, N/m per metre of thickness.
    pub tangent: f64,
}

/// Force of a [`BiaxialSpring`] and its tangent stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BiaxialResponse {
    /// Components of the force, N, positive against positive deformations.
    pub force: [f64; 2],
    /// Derivatives of the force with respect to the deformation, N/m: a symmetric matrix, row-major.
    ///
    /// A coupled [`BoucWen`] gives the symmetric part of the derivatives; the neglected antisymmetric part is
    /// of second order in the deformation step.
    pub tangent: [[f64; 2]; 2],
}

/// A hysteretic spring: implement this for your own law.
///
/// The force of the spring depends on its past deformations.
///
/// The spring stores the deformation and the internal variables of the last **committed** step. Newton's method
/// evaluates trial deformations at the end of a straight path from the committed deformation, any number of times;
/// these evaluations change no state. [`commit`](Hysteresis::commit) accepts a deformation.
///
/// ```
/// use basemat::structure::{Bilinear, Hysteresis};
///
/// // 10 MN/m up to 100 kN, a tenth of the stiffness beyond.
/// let mut columns = Bilinear::new(10.0e6, 100.0e3, 0.1)?;
/// assert_eq!(columns.response(0.005).force, 50.0e3);
/// assert_eq!(columns.response(0.03).force, 120.0e3);
/// columns.commit(0.03);
/// // Unloading is elastic again; a permanent deformation of 18 mm remains.
/// assert_eq!(columns.response(0.025).tangent, 10.0e6);
/// assert!((columns.response(0.018).force).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[auto_impl::auto_impl(Box)]
pub trait Hysteresis: Send {
    /// Force and tangent at `deformation` (m), after a straight path from the last committed deformation.
    fn response(&self, deformation: f64) -> SpringResponse;

    /// Stored and dissipated energy at `deformation`, after a straight path from the last committed deformation.
    ///
    /// Their sum is the work of the force along the path.
    fn energy(&self, deformation: f64) -> InternalEnergy;

    /// Accepts a step that ended with `deformation`.
    fn commit(&mut self, deformation: f64);

    /// The internal variables that [`commit`](Hysteresis::commit) changes; their number is constant.
    fn save(&self) -> Vec<f64>;

    /// Restores the variables that [`save`](Hysteresis::save) returned.
    ///
    /// The caller passes finite values only. On an error the spring must not change.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for impossible values.
    fn restore(&mut self, values: &[f64]) -> Result<()>;

    /// Copy of the spring with its internal variables: usually `Box::new(self.clone())`.
    fn clone_box(&self) -> Box<dyn Hysteresis>;
}

impl Clone for Box<dyn Hysteresis> {
    fn clone(&self) -> Self {
        self.as_ref().clone_box()
    }
}

/// Error for impossible internal variables.
fn corrupt_state() -> crate::Error {
    CheckpointError::Corrupt { quantity: "state of a hysteretic spring" }.into()
}
