//! Contact laws of the plane without limits, defined by the conditions of each mode.

use super::{
    Condition, ContactScene, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact,
    Tolerance,
};
use crate::error::Result;

/// Contact law of the plane without [`Limits`], defined by linear conditions.
///
/// Examples are an open element with traction, or slip against viscous resistance. Such a law needs three methods. A scene
/// uses it as [`InPlane`]`(law)`. All other laws implement [`InterfaceLaw`] by their limits.
///
/// Rubber pads, bonded to both sides, under a block without weight:
/// ```
/// use basemat::Simulation;
/// use basemat::bem::SpringGround;
/// use basemat::interface::{Condition, ContactState, InPlane, Mode, PlaneLaw, PreviousContact, Tolerance};
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
///
/// struct Pads {
///     /// Compliance of gap and slip, m/Pa.
///     compliance: [f64; 2],
/// }
///
/// impl PlaneLaw for Pads {
///     fn modes(&self) -> &[Mode] {
///         &[Mode::Stick]
///     }
///     fn conditions(&self, _mode: Mode, _start: &PreviousContact) -> [Condition; 2] {
///         let [normal, shear] = self.compliance;
///         [
///             Condition { pressure: normal, ..Condition::gap_is(0.0) },
///             Condition { shear: -shear, ..Condition::slip_is(0.0) },
///         ]
///     }
///     fn next_mode(&self, mode: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
///         mode
///     }
///     fn compliance(&self, _mode: Mode, _start: &PreviousContact) -> [f64; 2] {
///         self.compliance
///     }
/// }
///
/// let mut simulation = Simulation::builder(0.005)
///     .structure(RigidBlock::new(4.0, 2.0, 2000.0)?)
///     .ground(SpringGround::new(-2.0..2.0, 8, 2e8, 1e8)?.with_dashpots(7e5, 4e5)?)
///     .interface(InPlane(Pads { compliance: [1e-8, 4e-8] }))
///     .motion(el_centro_1940())
///     .gravity(0.0)
///     .build()?;
/// let run = simulation.run(1000, |state| {
///     assert!(state.contact.iter().all(|element| (element.slip - 4e-8 * element.shear).abs() < 1e-12));
/// })?;
/// assert!(run.energy_error < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
pub trait PlaneLaw: Send {
    /// The modes of this law, at least one; first the mode of rest.
    fn modes(&self) -> &[Mode];

    /// The two conditions that `mode` imposes at the end of the step.
    ///
    /// All their numbers must be finite: another number ends the step with a [`LawError`](super::LawError).
    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2];

    /// The mode to try next after a `trial` with the conditions of `mode`: one of [`modes`](PlaneLaw::modes).
    ///
    /// Return `mode` itself if the trial is admissible, up to the `tolerance`.
    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode;

    /// Elastic opening per traction in `mode`, m/Pa, as [`InterfaceLaw::compliance`]; zero by default.
    fn compliance(&self, _mode: Mode, _start: &PreviousContact) -> [f64; 2] {
        [0.0; 2]
    }

    /// Number of state variables per element, as [`InterfaceLaw::state_variables`]; zero by default.
    fn state_variables(&self) -> usize {
        0
    }

    /// Sets the initial state variables, as [`InterfaceLaw::initial_state_variables`]; by default they are zero.
    fn initial_state_variables(&self, _start: &PreviousContact, _state_variables: &mut [f64]) {}

    /// Updates the state variables at the end of a step, as [`InterfaceLaw::commit`].
    fn commit(
        &self,
        _start: &PreviousContact,
        _end: &ContactState,
        _mode: Mode,
        _state_variables: &mut [f64],
    ) {
    }

    /// The friction coefficient for the factor of safety, as [`InterfaceLaw::friction_coefficient`]; `None` by default.
    fn friction_coefficient(&self) -> Option<f64> {
        None
    }

    /// Traction beyond the strength of a bond, as [`InterfaceLaw::bond_overload`]; `None` by default.
    fn bond_overload(&self, _start: &PreviousContact, _trial: &ContactState) -> Option<f64> {
        None
    }

    /// Returns an error with the cause of a condition that is not finite.
    ///
    /// The law may be unable to determine it. Default: no error.
    ///
    /// # Errors
    /// An error with the cause, as [`Error::Input`](crate::Error::Input) or [`Error::part`](crate::Error::part).
    fn check_start(&self, _start: &PreviousContact) -> Result<()> {
        Ok(())
    }

    /// The same law without friction and cohesion, for the gravity stage, as [`InterfaceLaw::frictionless`].
    ///
    /// By default, hard and frictionless contact. A law of this trait is returned as `Box::new(InPlane(law))`.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Coulomb::frictionless())
    }

    /// Checks whether this law applies in the simulation that is being built, as [`InterfaceLaw::check`].
    ///
    /// # Errors
    /// The reason why it does not apply, for example as [`Error::part`](crate::Error::part).
    fn check(&self, _scene: &ContactScene) -> Result<()> {
        Ok(())
    }
}

/// A [`PlaneLaw`] as the interface law of a scene in the plane.
///
/// Its [`limits`](InterfaceLaw::limits) return an [`Error::Scene`](crate::Error::Scene) with the name of the law, so
/// `build` returns an error on a ground in plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct InPlane<L>(pub L);

impl<L: PlaneLaw> InterfaceLaw for InPlane<L> {
    fn limits(&self, _start: &PreviousContact) -> Result<Limits> {
        Limits::missing(std::any::type_name::<L>())
    }

    fn modes(&self) -> &[Mode] {
        self.0.modes()
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.0.conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        self.0.next_mode(mode, start, trial, tolerance)
    }

    fn compliance(&self, mode: Mode, start: &PreviousContact) -> [f64; 2] {
        self.0.compliance(mode, start)
    }

    fn state_variables(&self) -> usize {
        self.0.state_variables()
    }

    fn initial_state_variables(&self, start: &PreviousContact, state_variables: &mut [f64]) {
        self.0.initial_state_variables(start, state_variables);
    }

    fn commit(
        &self,
        start: &PreviousContact,
        end: &ContactState,
        mode: Mode,
        state_variables: &mut [f64],
    ) {
        self.0.commit(start, end, mode, state_variables);
    }

    fn friction_coefficient(&self) -> Option<f64> {
        self.0.friction_coefficient()
    }

    fn bond_overload(&self, start: &PreviousContact, trial: &ContactState) -> Option<f64> {
        self.0.bond_overload(start, trial)
    }

    fn check_start(&self, start: &PreviousContact) -> Result<()> {
        self.0.check_start(start)
    }

    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        self.0.frictionless()
    }

    fn check(&self, scene: &ContactScene) -> Result<()> {
        self.0.check(scene)
    }
}
