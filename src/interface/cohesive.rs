//! Cohesive contact: a bond that breaks for good.

use super::{
    Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact, Tolerance,
};
use crate::error::{Result, not_negative};

/// Cohesive contact, a bond that breaks for good: an element sticks up to a tensile strength and a cohesion, and is one
/// of Coulomb's law from the step on in which either is exceeded.
///
/// While bonded, p ≥ −tension and |τ| ≤ cohesion + friction · max(p, 0). Its state variable says whether an element is
/// bonded (1) or broken (0); an element that is open at first is broken. What broken elements carried passes
/// to their neighbours at once, so that a base may unzip in a step, and the elastic energy that
/// is set free is radiated. Within a step bonds only break: first those that are loaded most beyond
/// their strength while the others hold, then, with what these carried handed over, the next.
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
#[cfg_attr(feature = "serde", serde(try_from = "AdhesiveForm"))]
pub struct Cohesive {
    tension: f64,
    cohesion: f64,
    #[cfg_attr(
        feature = "serde",
        serde(rename = "friction", serialize_with = "Coulomb::write_friction")
    )]
    broken: Coulomb,
}

validated! {
    Cohesive as AdhesiveForm {
        tension: f64,
        cohesion: f64,
        #[serde(with = "crate::text::words::number")]
        friction: f64,
    }
    => Cohesive::new(tension, cohesion, friction)
}

impl Cohesive {
    /// Law with a tensile strength and a cohesion (Pa), and the friction coefficient of zero or more
    /// that stays; infinity means that nothing ever slides.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for strengths that are not finite or below zero, for NaN
    /// or a negative coefficient.
    pub fn new(tension: f64, cohesion: f64, friction: f64) -> Result<Self> {
        Ok(Self {
            tension: not_negative("tensile strength of the interface", tension)?,
            cohesion: not_negative("cohesion of the interface", cohesion)?,
            broken: Coulomb::new(friction)?,
        })
    }

    /// The friction coefficient.
    pub(crate) fn friction(&self) -> f64 {
        self.broken.friction()
    }

    /// Traction by which a bonded element exceeds its strength, below zero while it holds.
    fn overload(&self, trial: &ContactState) -> f64 {
        let friction = match self.friction() * trial.pressure.max(0.0) {
            limit if limit.is_nan() => 0.0,
            limit => limit,
        };
        (-trial.pressure - self.tension).max(trial.shear.abs() - self.cohesion - friction)
    }
}

/// Whether the element was bonded at the start of the step, and is so far in it.
fn is_glued(start: &PreviousContact) -> bool {
    !start.has_opened && start.state_variables.first().is_some_and(|glued| *glued > 0.0)
}

impl InterfaceLaw for Cohesive {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.broken.conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let holds = || is_glued(start) && self.overload(trial) <= tolerance.traction;
        if mode == Mode::Stick && holds() {
            return Mode::Stick;
        }
        self.broken.next_mode(mode, start, trial, tolerance)
    }

    fn bond_overload(&self, start: &PreviousContact, trial: &ContactState) -> Option<f64> {
        is_glued(start).then(|| self.overload(trial))
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

    /// Limits in plan: an element whose strength is exceeded carries it to the end of the step, unless it opens.
    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let broken = self.broken.limits(start)?;
        if is_glued(start) {
            Ok(Limits { tension: self.tension, shear_strength: self.cohesion, ..broken })
        } else {
            Ok(broken)
        }
    }

    /// Friction coefficient of the broken interface, without adhesion.
    fn friction_coefficient(&self) -> Option<f64> {
        Some(self.friction())
    }
}

/// Base and soil never separate or slide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bonded;

impl InterfaceLaw for Bonded {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, _mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        [Condition::gap_is(start.state.gap), Condition::slip_is(start.state.slip)]
    }

    fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        Mode::Stick
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        Ok(Limits { bonded: true, gap_offset: start.state.gap, ..Limits::default() })
    }
}
