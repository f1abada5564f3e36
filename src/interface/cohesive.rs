//! Cohesive contact: a bond that breaks for good.

use super::{
    Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact, Tolerance,
};
use crate::error::{Result, not_negative};

/// Cohesive contact: a bond with strengths that breaks for good, then Coulomb friction.
///
/// An element sticks until its tensile strength or its cohesion is exceeded. From that step on, it obeys
/// Coulomb's law. A bonded element has p ≥ −tension and |τ| ≤ cohesion + friction · max(p, 0). The state variable of an
/// element is 1 while it is bonded and 0 after its bond has broken; an element that is open initially has no bond. The
/// neighbours of a broken element take over its traction in the same step. Many bonds may therefore break in one step, and
/// the released elastic energy is radiated. First, the bonds with the largest overload break while the others remain
/// intact. Then the tractions are computed again, and the next bonds break.
///
/// ```
/// use basemat::Simulation;
/// use basemat::bem::SpringGround;
/// use basemat::interface::Cohesive;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
///
/// let mut simulation = Simulation::builder(0.002)
///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///     .ground(SpringGround::new(-2.0..2.0, 16, 8e7, 4e7)?.with_dashpots(7e5, 4e5)?)
///     .interface(Cohesive::new(120.0e3, 80.0e3, 0.6)?)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(2500, |_| {})?;
/// let bonded = (0..16).filter(|&e| simulation.state().state_variables(e) == [1.0]).count();
/// assert!(bonded > 0 && bonded < 16, "{bonded}");
/// assert!(run.energy_error < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "CohesiveForm"))]
pub struct Cohesive {
    tension: f64,
    cohesion: f64,
    #[cfg_attr(
        feature = "serde",
        serde(rename = "friction", serialize_with = "Coulomb::write_friction")
    )]
    broken_contact: Coulomb,
}

validated! {
    Cohesive as CohesiveForm {
        tension: f64,
        cohesion: f64,
        #[serde(with = "crate::text::forms::number")]
        friction: f64,
    }
    => Cohesive::new(tension, cohesion, friction)
}

impl Cohesive {
    /// Creates the law from its two strengths (Pa) and its friction coefficient.
    ///
    /// `tension`: tensile strength; `cohesion`: shear strength without pressure; `friction`: coefficient that bonded
    /// elements add to the cohesion, and that alone acts on broken elements.
    ///
    /// The coefficient is zero or more; if it is infinite, nothing ever slides.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a strength that is not finite or below zero, and for a
    /// coefficient that is NaN or negative.
    pub fn new(tension: f64, cohesion: f64, friction: f64) -> Result<Self> {
        Ok(Self {
            tension: not_negative("tensile strength of the interface", tension)?,
            cohesion: not_negative("cohesion of the interface", cohesion)?,
            broken_contact: Coulomb::new(friction)?,
        })
    }

    /// The friction coefficient, of bonded and broken elements.
    pub(crate) fn friction(&self) -> f64 {
        self.broken_contact.friction()
    }

    /// Traction by which a bonded element exceeds its strength, Pa; negative below the strength.
    fn overload(&self, trial: &ContactState) -> f64 {
        let mut friction_limit = self.friction() * trial.pressure.max(0.0);
        // Infinite friction times zero pressure is NaN.
        if friction_limit.is_nan() {
            friction_limit = 0.0;
        }
        (-trial.pressure - self.tension).max(trial.shear.abs() - self.cohesion - friction_limit)
    }
}

/// Whether an element's bond is intact at the start of the step and in it.
fn is_bonded(start: &PreviousContact) -> bool {
    !start.has_opened && start.state_variables.first().is_some_and(|bonded| *bonded > 0.0)
}

impl InterfaceLaw for Cohesive {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.broken_contact.conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        if mode == Mode::Stick && is_bonded(start) && self.overload(trial) <= tolerance.traction {
            return Mode::Stick;
        }
        self.broken_contact.next_mode(mode, start, trial, tolerance)
    }

    fn bond_overload(&self, start: &PreviousContact, trial: &ContactState) -> Option<f64> {
        is_bonded(start).then(|| self.overload(trial))
    }

    fn state_variables(&self) -> usize {
        1
    }

    fn initial_state_variables(&self, start: &PreviousContact, state_variables: &mut [f64]) {
        state_variables[0] = if start.mode.is_closed() { 1.0 } else { 0.0 };
    }

    fn commit(
        &self,
        _start: &PreviousContact,
        _end: &ContactState,
        mode: Mode,
        state_variables: &mut [f64],
    ) {
        if mode != Mode::Stick {
            state_variables[0] = 0.0;
        }
    }

    /// Limits in plan.
    ///
    /// An element whose strength is exceeded retains the strength until the end of the step, unless it opens.
    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let broken_limits = self.broken_contact.limits(start)?;
        if is_bonded(start) {
            Ok(Limits { tension: self.tension, shear_strength: self.cohesion, ..broken_limits })
        } else {
            Ok(broken_limits)
        }
    }

    /// This law without friction and cohesion, with the same tensile strength.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Coulomb::frictionless_with_strength(self.tension))
    }

    /// Friction coefficient of the broken interface, without cohesion.
    fn friction_coefficient(&self) -> Option<f64> {
        Some(self.friction())
    }
}

/// Bonded contact: base and soil never separate or slide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bonded;

impl InterfaceLaw for Bonded {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        Ok(Limits { bonded: true, gap_offset: start.state.gap, ..Limits::default() })
    }

    /// This law itself.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Self)
    }
}
