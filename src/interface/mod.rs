//! Interface laws between the base and the soil.
//!
//! A law knows one contact element at a time. For each [`Mode`] it states two linear
//! [`Condition`]s between the element's opening and its traction, and after a trial it says which
//! mode comes next. The mode search of [`crate::coupled`] does the rest and knows no law.

mod bonded;
mod coulomb;
mod thin_layer;
mod variable_friction;

pub use bonded::Bonded;
pub use coulomb::{Activation, Coulomb};
pub use thin_layer::{FrictionLimit, SlipSense, ThinLayer};
pub use variable_friction::VariableFriction;

use crate::error::Result;

/// What a contact element does during a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Mode {
    /// Closed, no slip (and the only mode of a bonded element).
    Stick,
    /// Closed; the structure slides to the left over the soil.
    SlipLeft,
    /// Closed; the structure slides to the right over the soil.
    SlipRight,
    /// Uplifted: no traction.
    Open,
}

impl Mode {
    /// Whether the element is closed.
    pub fn is_closed(self) -> bool {
        self != Mode::Open
    }

    /// Whether the element slides.
    pub fn is_slip(self) -> bool {
        matches!(self, Mode::SlipLeft | Mode::SlipRight)
    }

    /// The modes of contact with uplift and Coulomb friction.
    fn with_friction(friction: f64) -> &'static [Self] {
        if friction == 0.0 {
            // Either slip mode says the same when there is no friction: one is enough.
            &[Self::SlipRight, Self::Open]
        } else {
            &[Self::Stick, Self::SlipLeft, Self::SlipRight, Self::Open]
        }
    }
}

/// Opening and **total** traction (static part included) of one contact element, as means over it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactState {
    /// Gap between base and soil, m; positive when open.
    pub gap: f64,
    /// Slip of the structure over the soil since the static state, m; positive to the right.
    pub slip: f64,
    /// Contact pressure, Pa; positive in compression.
    pub pressure: f64,
    /// Shear traction that the structure exerts on the soil, Pa; positive to the right.
    pub shear: f64,
}

/// What a law may need of the beginning of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StepStart {
    /// Opening and traction at the end of the step before.
    pub state: ContactState,
    /// Mode of the step before.
    pub mode: Mode,
    /// Whether the element has been open at any time since the start of the run.
    pub has_opened: bool,
    /// Slip velocity of the step before, m/s: its change of slip over its length.
    pub slip_rate: f64,
    /// Pressure of the static state, Pa.
    pub static_pressure: f64,
    /// Time step, s.
    pub time_step: f64,
}

impl StepStart {
    /// Start of a step of `time_step` seconds from `state`, by which a law can be tried without a
    /// simulation: it has opened if it is open, its slip rate is zero, and its static pressure that
    /// of `state`. All fields can then be set.
    ///
    /// ```
    /// use basemat::interface::{ContactState, Coulomb, InterfaceLaw, Mode, StepStart, Tolerance};
    /// let law = Coulomb::new(0.5)?;
    /// let pressed = ContactState { pressure: 10.0e3, ..ContactState::default() };
    /// let mut start = StepStart::new(pressed, Mode::Stick, 0.01);
    /// start.slip_rate = 0.2;
    /// let trial = ContactState { shear: 6.0e3, ..pressed };
    /// let next = law.next_mode(Mode::Stick, &start, &trial, Tolerance::new(1e-9, 1.0));
    /// assert_eq!(next, Mode::SlipRight);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn new(state: ContactState, mode: Mode, time_step: f64) -> Self {
        Self {
            state,
            mode,
            has_opened: !mode.is_closed(),
            slip_rate: 0.0,
            static_pressure: state.pressure,
            time_step,
        }
    }

    /// Goes on to the start of the next step, after this one has ended in `state` and `mode`.
    pub fn advance(&mut self, state: ContactState, mode: Mode) {
        self.slip_rate = (state.slip - self.state.slip) / self.time_step;
        self.has_opened |= !mode.is_closed();
        (self.state, self.mode) = (state, mode);
    }
}

/// One linear condition on the end of a step:
/// `gap·g + slip·s + pressure·p + shear·τ = value`, coefficients in the fields.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Condition {
    /// Coefficient of the gap.
    pub gap: f64,
    /// Coefficient of the slip.
    pub slip: f64,
    /// Coefficient of the pressure.
    pub pressure: f64,
    /// Coefficient of the shear traction.
    pub shear: f64,
    /// Right-hand side.
    pub value: f64,
}

impl Condition {
    /// The gap is `value`.
    pub fn gap_is(value: f64) -> Self {
        Self { gap: 1.0, value, ..Self::default() }
    }

    /// The gap that this condition gives for a pressure, if it relates nothing else.
    pub(crate) fn gap_at(&self, pressure: f64) -> Option<f64> {
        (self.gap != 0.0 && self.slip == 0.0 && self.shear == 0.0)
            .then(|| (self.value - self.pressure * pressure) / self.gap)
    }

    /// The slip is `value`.
    pub fn slip_is(value: f64) -> Self {
        Self { slip: 1.0, value, ..Self::default() }
    }

    /// The pressure is `value`.
    pub fn pressure_is(value: f64) -> Self {
        Self { pressure: 1.0, value, ..Self::default() }
    }

    /// The shear traction is `value`.
    pub fn shear_is(value: f64) -> Self {
        Self { shear: 1.0, value, ..Self::default() }
    }
}

/// Differences below which a law should see equality.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Tolerance {
    /// For gaps and slips, m.
    pub length: f64,
    /// For tractions, Pa.
    pub traction: f64,
}

impl Tolerance {
    /// Tolerance for lengths (m) and tractions (Pa).
    pub fn new(length: f64, traction: f64) -> Self {
        Self { length, traction }
    }
}

/// What a law can check of the scene it is to act in.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactScene {
    /// Gravity, m/s²; zero if the base starts unpressed.
    pub gravity: f64,
    /// Time step, s.
    pub time_step: f64,
}

/// The law of `element` from a list of one law for all, or one each.
pub(crate) fn law_of(laws: &[Box<dyn InterfaceLaw>], element: usize) -> &dyn InterfaceLaw {
    laws[if laws.len() == 1 { 0 } else { element }].as_ref()
}

/// How base and soil touch: implement this for a law of your own.
///
/// A law is a rule without memory: what it needs of the past is in [`StepStart`].
#[auto_impl::auto_impl(Box)]
pub trait InterfaceLaw: Send {
    /// The modes that this law uses; the first is that of an element at rest in contact.
    fn modes(&self) -> &[Mode];

    /// The two conditions that `mode` imposes on the end of the step.
    fn conditions(&self, mode: Mode, start: &StepStart) -> [Condition; 2];

    /// The mode to try next, given the `trial` that the conditions of `mode` led to; `mode` itself
    /// if the trial is admissible.
    fn next_mode(
        &self,
        mode: Mode,
        start: &StepStart,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode;

    /// Elastic opening per traction in `mode`, m/Pa: gap per tension and slip per shear traction.
    /// Zero (the default) for hard contact. The energy ledger books what so much elasticity
    /// stores; only the rest of gap and slip can be lost to friction and impact.
    fn compliance(&self, _mode: Mode) -> [f64; 2] {
        [0.0; 2]
    }

    /// The friction coefficient, for the factor of safety against sliding
    /// ([`Run::least_sliding_safety`](crate::coupled::Run::least_sliding_safety)): the base resists by this times the pressure.
    /// Infinite for a law that never slides, `None` (the default) for one without such a number.
    fn friction_coefficient(&self) -> Option<f64> {
        None
    }

    /// This law without friction and adhesion, for setting the structure down on the ground; hard
    /// and smooth contact unless the law says otherwise.
    fn smooth(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Coulomb::smooth())
    }

    /// Asked once, when a simulation is put together: whether this law makes sense in it.
    ///
    /// # Errors
    /// With the reason if it does not, as [`Error::part`](crate::Error::part) for example.
    fn check(&self, _scene: &ContactScene) -> Result<()> {
        Ok(())
    }
}
