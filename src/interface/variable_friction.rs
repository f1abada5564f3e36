//! Coulomb friction whose coefficient changes from step to step.

use super::{
    Condition, ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact, Tolerance,
    UnilateralCondition,
};
use crate::error::Result;

type Coefficient = Box<dyn Fn(&PreviousContact) -> f64 + Send>;

/// [`Coulomb`]'s law with a friction coefficient for each step: of the speed of sliding, of the
/// way slid, of the pressure, whatever [`PreviousContact`] knows.
///
/// The coefficient is that of the start of the step, so that it cannot change while the modes of
/// the step are searched for, and what it depends on lags by a step.
///
/// Friction that falls from 0.3 to 0.2 as sliding gets faster:
/// ```
/// use basemat::bem::SpringGround;
/// use basemat::interface::VariableFriction;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
/// use basemat::Simulation;
///
/// let law = VariableFriction::new(|start| 0.2 + 0.1 * (-start.slip_rate.abs() / 0.1).exp());
/// let mut simulation = Simulation::builder(0.005)
///     .structure(RigidBlock::new(8.0, 4.0, 2000.0)?)
///     .ground(SpringGround::new(-4.0..4.0, 8, 2e8, 1e8)?.with_dashpots(7e5, 4e5)?)
///     .interface(law)
///     .motion(el_centro_1940().scaled(1.5)?)
///     .gravity(9.81)
///     .build()?;
/// let run = simulation.run(600, |state| {
///     let largest = 0.3 * state.normal_force;
///     assert!(state.base_shear.abs() <= largest * (1.0 + 1e-9));
/// })?;
/// assert!(run.whole.largest_slip.magnitude() > 1e-3);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct VariableFriction {
    coefficient: Coefficient,
    /// All but the coefficient.
    contact: Coulomb,
}

short_debug! { VariableFriction; self; contact: self.contact }

impl VariableFriction {
    /// Law with the friction coefficient `coefficient(start)`: zero or more, infinite where nothing
    /// slides. Where it is negative or NaN, the step is refused with a
    /// [`LawError`](crate::LawError) that names it.
    pub fn new(coefficient: impl Fn(&PreviousContact) -> f64 + Send + 'static) -> Self {
        Self { coefficient: Box::new(coefficient), contact: Coulomb::frictionless() }
    }

    /// As [`Coulomb::with_tensile_strength`].
    ///
    /// # Errors
    /// The same.
    pub fn with_tensile_strength(mut self, strength: f64) -> Result<Self> {
        self.contact = self.contact.with_tensile_strength(strength)?;
        Ok(self)
    }

    /// As [`Coulomb::with_unilateral_condition`].
    ///
    /// # Errors
    /// The same.
    pub fn with_unilateral_condition(mut self, activation: UnilateralCondition) -> Result<Self> {
        self.contact = self.contact.with_unilateral_condition(activation)?;
        Ok(self)
    }

    /// The law of the step.
    fn at(&self, start: &PreviousContact) -> Coulomb {
        self.contact.with_coefficient((self.coefficient)(start))
    }
}

impl InterfaceLaw for VariableFriction {
    fn modes(&self) -> &[Mode] {
        Mode::with_friction(f64::INFINITY)
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let law = self.at(start);
        if law.friction() >= 0.0 {
            law.conditions(mode, start)
        } else {
            // No mode may pass with a coefficient that is none: see `check_start`.
            [Condition::gap_is(f64::NAN), Condition::slip_is(f64::NAN)]
        }
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        self.at(start).next_mode(mode, start, trial, tolerance)
    }

    fn check_start(&self, start: &PreviousContact) -> Result<()> {
        Coulomb::new(self.at(start).friction()).map(|_| ())
    }
}
