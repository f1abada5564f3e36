//! Coulomb friction whose coefficient changes from step to step.

use super::coulomb::{Coulomb, UnilateralCondition};
use super::{InterfaceLaw, Limits, Mode, PreviousContact};
use crate::error::Result;

type FrictionFunction = Box<dyn Fn(&PreviousContact) -> f64 + Send>;

/// [`Coulomb`]'s law with a friction coefficient from a closure for each step.
///
/// The closure receives the [`PreviousContact`] of the element: slip, slip rate, pressure, static pressure. The law has no
/// state variables: friction that depends on the sliding distance needs a user's [`InterfaceLaw`].
///
/// The coefficient is computed from the end of the previous step, so that it is constant during the mode search.
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
///     let max_shear = 0.3 * state.normal_force;
///     assert!(state.base_shear.abs() <= max_shear * (1.0 + 1e-9));
/// })?;
/// assert!(run.whole.largest_slip.magnitude() > 1e-3);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct VariableFriction {
    coefficient: FrictionFunction,
    /// Contact law without the coefficient.
    contact: Coulomb,
}

short_debug! { VariableFriction; self; contact: self.contact }

impl VariableFriction {
    /// Law with the friction coefficient `coefficient(start)`: zero or more; if infinite, nothing slides.
    ///
    /// If the coefficient is negative or NaN, the step returns a [`LawError`](crate::interface::LawError) that names it.
    pub fn new(coefficient: impl Fn(&PreviousContact) -> f64 + Send + 'static) -> Self {
        Self { coefficient: Box::new(coefficient), contact: Coulomb::frictionless() }
    }

    /// Sets the tensile strength, as [`Coulomb::with_tensile_strength`] does.
    ///
    /// # Errors
    /// The errors of [`Coulomb::with_tensile_strength`].
    pub fn with_tensile_strength(mut self, strength: f64) -> Result<Self> {
        self.contact = self.contact.with_tensile_strength(strength)?;
        Ok(self)
    }

    /// Sets the unilateral condition, as [`Coulomb::with_unilateral_condition`] does.
    ///
    /// # Errors
    /// The errors of [`Coulomb::with_unilateral_condition`].
    pub fn with_unilateral_condition(mut self, condition: UnilateralCondition) -> Result<Self> {
        self.contact = self.contact.with_unilateral_condition(condition)?;
        Ok(self)
    }

    /// The law with the coefficient of this step.
    fn law_of_step(&self, start: &PreviousContact) -> Coulomb {
        Coulomb { friction: (self.coefficient)(start), ..self.contact }
    }
}

impl InterfaceLaw for VariableFriction {
    fn modes(&self) -> &[Mode] {
        Mode::with_friction(f64::INFINITY)
    }

    fn check_start(&self, start: &PreviousContact) -> Result<()> {
        Coulomb::new(self.law_of_step(start).friction()).map(|_| ())
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        self.law_of_step(start).limits(start)
    }

    /// This law without friction, with the same tensile strength.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        InterfaceLaw::frictionless(&self.contact)
    }
}
