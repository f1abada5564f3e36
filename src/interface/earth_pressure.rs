//! Contact of a wall with soil between its active and its passive pressure.

use super::{
    Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact, Tolerance,
};
use crate::error::{Error, Result, not_negative, require};

/// Coulomb friction of a wall on soil between its active and its passive pressure.
///
/// The pressure of soil on a wall is at most passive and at least active: a wedge of soil slides up if the wall is pushed
/// into the soil, and down if the wall moves away. The state variable of each element is the movement w of the soil's
/// face, positive away from the wall. The normal conditions of an element, combined with stick and slip:
///
/// | | |
/// |---|---|
/// | at rest | g = −w, active ≤ p ≤ passive |
/// | passive | p = passive, g ≤ −w; w becomes −g |
/// | active | p = active, g ≥ −w; w becomes −g |
///
/// Pressure falls as the gap g grows, as in plasticity with fixed yield stresses: without friction the contact problem
/// of a step is convex and has one solution. Soil that has followed the wall does not move back: it resists a returning
/// wall immediately, and pressures increase from cycle to cycle. With an active pressure of zero the soil stands
/// without the wall because of its cohesion. A gap then opens between wall and soil as under
/// [`Yielding`](super::Yielding), and closes again at g = −w.
///
/// In the energy balance, `contact` includes p times the movement of the soil. While soil follows a wall, the weight of
/// the soil does work on the wall, and `contact` decreases by the active pressure times the movement. Over a cycle of
/// movement `contact` never decreases.
///
/// [`TrenchGround::interfaces`](crate::bem::embedded::TrenchGround::interfaces) computes the laws of an embedded wall
/// from the strengths of the soils.
///
/// ```
/// use basemat::interface::{EarthPressure, InterfaceLaw, Mode};
/// let law = EarthPressure::new(6.0e3, 54.0e3, 0.3)?;
/// assert_eq!(law.friction_coefficient(), Some(0.3));
/// assert!(law.modes().contains(&Mode::Active) && law.modes().contains(&Mode::Yield));
/// // The active pressure is below the passive one.
/// assert!(EarthPressure::new(54.0e3, 6.0e3, 0.3).is_err());
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "EarthPressureForm"))]
pub struct EarthPressure {
    active: f64,
    passive: f64,
    #[cfg_attr(
        feature = "serde",
        serde(rename = "friction", serialize_with = "Coulomb::write_friction")
    )]
    contact: Coulomb,
}

validated! {
    EarthPressure as EarthPressureForm {
        active: f64,
        passive: f64,
        #[serde(with = "crate::text::forms::number")]
        friction: f64,
    }
    => EarthPressure::new(active, passive, friction)
}

impl EarthPressure {
    /// Law with an active and a passive pressure (Pa), and friction.
    ///
    /// `friction` is the friction coefficient, zero or more. If it is infinite, nothing ever slides.
    ///
    /// # Errors
    /// [`Error::Input`] for an active pressure that is not finite or below zero, a passive pressure that is not finite
    /// and above the active one, and a coefficient that is NaN or negative.
    pub fn new(active: f64, passive: f64, friction: f64) -> Result<Self> {
        not_negative("active pressure", active)?;
        let is_valid = passive > active && passive.is_finite();
        require("passive pressure", passive, is_valid, "finite and above the active pressure")?;
        Ok(Self { active, passive, contact: Coulomb::new(friction)? })
    }

    /// Active and passive pressure, Pa.
    pub fn pressures(&self) -> [f64; 2] {
        [self.active, self.passive]
    }

    /// The friction coefficient.
    pub fn friction(&self) -> f64 {
        self.contact.friction()
    }

    /// Whether the soil stands without the wall, so that elements can open.
    fn can_open(&self) -> bool {
        self.active == 0.0
    }

    /// Limits of the law without its active pressure, which [`Limits`] do not contain.
    fn passive_limits(&self, start: &PreviousContact) -> Limits {
        let movement = start.state_variables.first().copied().unwrap_or(0.0);
        Limits {
            friction: self.friction(),
            pressure_cap: self.passive,
            gap_offset: -movement,
            ..Limits::default()
        }
    }
}

impl InterfaceLaw for EarthPressure {
    fn modes(&self) -> &[Mode] {
        let friction = self.friction();
        if self.can_open() {
            Mode::with_yield(friction)
        } else {
            Mode::with_following(friction)
        }
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let mut conditions = self.passive_limits(start).conditions(mode, start, [0.0; 2]);
        if mode.is_active() {
            conditions[0] = Condition::pressure_is(self.active);
        }
        conditions
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let limits = self.passive_limits(start);
        let passive_mode =
            limits.next_mode(mode, self.modes()[0], start, trial, tolerance, [0.0; 2]);
        if self.can_open() {
            return passive_mode;
        }
        let is_following = if mode.is_active() {
            trial.gap - limits.gap_offset >= -tolerance.length
        } else {
            trial.pressure < self.active - tolerance.traction
        };
        // Without the active pressure, the limits open an element under tension; here it stays closed.
        let closed_mode = if passive_mode.is_closed() { passive_mode } else { mode.elastic() };
        if is_following { closed_mode.elastic().following() } else { closed_mode }
    }

    fn state_variables(&self) -> usize {
        1
    }

    fn commit(
        &self,
        _start: &PreviousContact,
        end: &ContactState,
        mode: Mode,
        state_variables: &mut [f64],
    ) {
        let movement = &mut state_variables[0];
        if mode.is_yield() {
            *movement = movement.max(-end.gap);
        } else if mode.is_active() {
            *movement = movement.min(-end.gap);
        }
    }

    fn friction_coefficient(&self) -> Option<f64> {
        Some(self.friction())
    }

    /// Never returns an error.
    ///
    /// [`EarthPressure::new`] has checked the numbers, and soil with an active pressure has no limits.
    fn check_start(&self, _start: &PreviousContact) -> Result<()> {
        Ok(())
    }

    /// Limits of soil whose active pressure is zero.
    ///
    /// Returns an error for other soil, which acts only in the plane.
    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let needed = "an active pressure of zero, to act by limits alone";
        if self.can_open() {
            Ok(self.passive_limits(start))
        } else {
            Err(Error::Scene { quantity: "earth pressure", needed })
        }
    }

    /// The same law without friction, with the same pressures.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Self { contact: Coulomb::frictionless(), ..*self })
    }
}
