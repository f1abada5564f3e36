//! Hard unilateral contact with Coulomb friction.

use super::{InterfaceLaw, Limits, Mode, PreviousContact};
use crate::error::{Result, not_negative, require};

/// Quantity that is not negative under unilateral contact: the gap or its change.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
#[non_exhaustive]
pub enum UnilateralCondition {
    /// Signorini's conditions for the gap at the end of the step.
    ///
    /// They are g ≥ 0, p ≥ 0, p·g = 0.
    #[default]
    Position,
    /// Conditions for the change of the gap (Moreau 1988; Jean 1999).
    ///
    /// An element whose gap at the start is at most `closed_below` (m) obeys Δg ≥ 0, p ≥ 0, p·Δg = 0; any
    /// other element is free. In the step in which the base lands, it may penetrate the soil by its motion in that step.
    Velocity {
        /// Largest gap at which an element is regarded as closed, m.
        closed_below: f64,
    },
}

/// Hard unilateral contact with Coulomb friction: stick, slip to either side, open.
///
/// Gap and pressure satisfy Signorini's conditions. Shear satisfies |τ| ≤ friction · p, and slip has the direction of
/// the shear traction. With infinite friction the base uplifts but does not slide; with zero friction it is
/// frictionless. For a coefficient that changes, use [`VariableFriction`](super::VariableFriction).
///
/// ```
/// use basemat::interface::Coulomb;
/// assert_eq!(Coulomb::new(0.4)?.friction(), 0.4);
/// assert!(Coulomb::new(f64::INFINITY).is_ok());
/// assert!(Coulomb::new(-0.1).is_err());
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "CoulombForm"))]
pub struct Coulomb {
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    pub(super) friction: f64,
    pub(super) tensile_strength: f64,
    pub(super) condition: UnilateralCondition,
}

validated! {
    Coulomb as CoulombForm {
        #[serde(with = "crate::text::forms::number")]
        friction: f64,
        #[serde(default)]
        tensile_strength: f64,
        #[serde(default)]
        condition: UnilateralCondition,
    }
    => Coulomb::new(friction)?.with_tensile_strength(tensile_strength)?.with_unilateral_condition(condition)
}

/// Returns an error unless `friction` is a valid coefficient.
pub(super) fn check_friction(friction: f64) -> Result<()> {
    let needed = "zero or more (infinite: no sliding)";
    require("friction coefficient", friction, friction >= 0.0, needed).map(drop)
}

impl Coulomb {
    /// Law with a friction coefficient of zero or more; if it is infinite, nothing ever slides.
    ///
    /// In plan, steps with a coefficient of 3 or more may have several solutions: compare the run with a run of the scene's
    /// mirror image. [`Warning::HighFriction`](crate::coupled::Warning::HighFriction) reports such a coefficient.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for NaN or a negative coefficient.
    pub fn new(friction: f64) -> Result<Self> {
        check_friction(friction)?;
        Ok(Self { friction, ..Self::frictionless() })
    }

    /// Law that opens but never slides (infinite friction).
    ///
    /// In plan, steps may have several solutions: see [`Coulomb::new`].
    pub fn uplift_only() -> Self {
        Self { friction: f64::INFINITY, ..Self::frictionless() }
    }

    /// Law without friction.
    pub(super) fn frictionless() -> Self {
        Self { friction: 0.0, tensile_strength: 0.0, condition: UnilateralCondition::Position }
    }

    /// Law without friction, with this tensile strength.
    pub(super) fn frictionless_with_strength(tensile_strength: f64) -> Self {
        Self { tensile_strength, ..Self::frictionless() }
    }

    /// Adds a tensile strength (Pa) until an element first opens.
    ///
    /// Friction is then limited by friction · (p + strength).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the strength is finite and not below zero.
    pub fn with_tensile_strength(mut self, strength: f64) -> Result<Self> {
        self.tensile_strength = not_negative("tensile strength of the interface", strength)?;
        Ok(self)
    }

    /// Sets the [`UnilateralCondition`] of the contact conditions.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `closed_below` is finite and not below zero.
    pub fn with_unilateral_condition(mut self, condition: UnilateralCondition) -> Result<Self> {
        if let UnilateralCondition::Velocity { closed_below } = condition {
            not_negative("gap below which contact is closed", closed_below)?;
        }
        self.condition = condition;
        Ok(self)
    }

    /// The friction coefficient.
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// Serializes the coefficient alone.
    #[cfg(feature = "serde")]
    pub(super) fn write_friction<S: serde::Serializer>(
        &self,
        to: S,
    ) -> std::result::Result<S::Ok, S::Error> {
        crate::text::forms::number::serialize(&self.friction, to)
    }

    /// Tensile strength of the element (Pa): zero after it has opened once.
    fn remaining_strength(&self, start: &PreviousContact) -> f64 {
        if start.has_opened { 0.0 } else { self.tensile_strength }
    }

    /// Gap (m) of a closed element at the end of the step.
    ///
    /// `None` if the element cannot close.
    fn closed_gap(&self, start: &PreviousContact) -> Option<f64> {
        match self.condition {
            UnilateralCondition::Position => Some(0.0),
            UnilateralCondition::Velocity { closed_below } => {
                (start.state.gap <= closed_below).then_some(start.state.gap)
            }
        }
    }
}

impl InterfaceLaw for Coulomb {
    fn modes(&self) -> &[Mode] {
        Mode::with_friction(self.friction)
    }

    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let tension = self.remaining_strength(start);
        Ok(Limits {
            friction: self.friction,
            attraction: tension,
            tension,
            gap_offset: self.closed_gap(start).unwrap_or(f64::NEG_INFINITY),
            ..Limits::default()
        })
    }

    /// Friction coefficient of the law, without the effect of a tensile strength.
    fn friction_coefficient(&self) -> Option<f64> {
        Some(self.friction)
    }

    /// Law without friction, with the same tensile strength and the condition on the position.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Self::frictionless_with_strength(self.tensile_strength))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::{ContactState, Tolerance};

    const TEST_TOLERANCE: Tolerance = Tolerance { length: 1e-12, traction: 1e-9 };

    fn start(mode: Mode) -> PreviousContact<'static> {
        PreviousContact::new(ContactState::default(), mode, 0.01)
    }

    #[test]
    fn admissible_states_keep_their_mode() {
        let law = Coulomb::new(0.5).unwrap();
        let start = start(Mode::Stick);
        let state = ContactState { pressure: 2.0, shear: 0.99, ..Default::default() };
        assert_eq!(law.next_mode(Mode::Stick, &start, &state, TEST_TOLERANCE), Mode::Stick);
        let state = ContactState { pressure: 2.0, shear: 1.0, slip: 0.1, ..Default::default() };
        assert_eq!(law.next_mode(Mode::SlipRight, &start, &state, TEST_TOLERANCE), Mode::SlipRight);
        let state = ContactState { gap: 0.1, ..Default::default() };
        assert_eq!(law.next_mode(Mode::Open, &start, &state, TEST_TOLERANCE), Mode::Open);
    }

    #[test]
    fn violations_change_the_mode() {
        let law = Coulomb::new(0.5).unwrap();
        let start = start(Mode::Stick);
        let next_mode_of = |mode, gap, slip, pressure, shear| {
            let state = ContactState { gap, slip, pressure, shear, ..Default::default() };
            law.next_mode(mode, &start, &state, TEST_TOLERANCE)
        };
        assert_eq!(next_mode_of(Mode::Stick, 0.0, 0.0, -1.0, 0.0), Mode::Open);
        assert_eq!(next_mode_of(Mode::Stick, 0.0, 0.0, 1.0, 0.6), Mode::SlipRight);
        assert_eq!(next_mode_of(Mode::Stick, 0.0, 0.0, 1.0, -0.6), Mode::SlipLeft);
        assert_eq!(next_mode_of(Mode::SlipRight, 0.0, -0.1, 1.0, 0.5), Mode::Stick);
        assert_eq!(next_mode_of(Mode::SlipLeft, 0.0, 0.1, 1.0, -0.5), Mode::Stick);
        assert_eq!(next_mode_of(Mode::Open, -0.1, 0.0, 0.0, 0.0), Mode::Stick);
    }

    #[test]
    fn tensile_strength_acts_until_first_opening() {
        let law = Coulomb::new(0.5).unwrap().with_tensile_strength(3.0).unwrap();
        let state = ContactState { pressure: -2.0, ..Default::default() };
        let mut start = start(Mode::Stick);
        assert_eq!(law.next_mode(Mode::Stick, &start, &state, TEST_TOLERANCE), Mode::Stick);
        start.has_opened = true;
        assert_eq!(law.next_mode(Mode::Stick, &start, &state, TEST_TOLERANCE), Mode::Open);
        assert!(law.with_tensile_strength(f64::NAN).is_err());
        assert!(
            law.with_unilateral_condition(UnilateralCondition::Velocity { closed_below: -1.0 })
                .is_err()
        );
    }
}
