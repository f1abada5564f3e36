//! Contact of a wall with soil between its active and its passive pressure.

use super::{
    Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PreviousContact, Tolerance,
};
use crate::error::{Error, Result, not_negative, require};

/// Coulomb friction of a wall on soil between its active and its passive pressure.
///
/// The soil beside a wall bears no more than its passive pressure, and presses with no less than its active pressure: a
/// wedge of it slides up before a wall that is pushed in, and down behind a wall that moves away. The state variable of
/// each element is the movement w of the soil's face, positive away from the wall. The normal conditions of an element,
/// combined with stick and slip:
///
/// | | |
/// |---|---|
/// | at rest | g = −w, active ≤ p ≤ passive |
/// | passive | p = passive, g ≤ −w; w becomes −g |
/// | active | p = active, g ≥ −w; w becomes −g |
///
/// Pressure falls as the gap g grows, as in plasticity with fixed yield stresses: without friction the contact problem of a
/// step is convex and has one solution. Soil that has followed the wall stays where it is, and resists a wall that
/// returns at once: pressures ratchet. With an active pressure of zero the soil stands by its cohesion instead, the wall
/// opens as under [`Yielding`](super::Yielding), and meets the soil again at g = −w.
///
/// The energy balance counts p times the movement of the soil in `contact`. While soil follows a wall, its weight does
/// work on the wall, and `contact` falls by the active pressure times the movement. Over a cycle of movement it never falls.
///
/// [`TrenchGround::interfaces`](crate::bem::embedded::TrenchGround::interfaces) makes the laws of walls from the
/// strengths of soils.
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
    /// The friction coefficient is zero or more.
    ///
    /// If the coefficient is infinite, nothing ever slides.
    ///
    /// # Errors
    /// [`Error::Input`] for an active pressure that is not finite or below zero, a passive pressure that is not finite
    /// and above the active one, and a coefficient that is NaN or negative.
    pub fn new(active: f64, passive: f64, friction: f64) -> Result<Self> {
        not_negative("active pressure", active)?;
        let is_above = passive > active && passive.is_finite();
        require("passive pressure", passive, is_above, "finite and above the active pressure")?;
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

    /// Whether the soil stands without the wall, which then opens.
    fn opens(&self) -> bool {
        self.active == 0.0
    }

    /// Limits without the active pressure.
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
        if self.opens() {
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
        let next = limits.next_mode(mode, self.modes()[0], start, trial, tolerance, [0.0; 2]);
        if self.opens() {
            return next;
        }
        let follows = if mode.is_active() {
            trial.gap - limits.gap_offset >= -tolerance.length
        } else {
            trial.pressure < self.active - tolerance.traction
        };
        // Limits without the active pressure open elements under tension.
        let closed = if next.is_closed() { next } else { mode.elastic() };
        if follows { closed.elastic().following() } else { closed }
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

    /// No reason: the numbers of the law are valid, also without limits.
    fn check_start(&self, _start: &PreviousContact) -> Result<()> {
        Ok(())
    }

    /// Limits of soil that stands: in plan there are no walls.
    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let needed = "an active pressure of zero, to act by limits alone";
        if self.opens() {
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
