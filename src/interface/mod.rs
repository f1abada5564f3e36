//! Interface laws between the base and the soil.
//!
//! A law describes one contact element at a time. For each [`Mode`] it states two linear
//! [`Condition`]s between the element's opening and its traction, and after a trial it says which
//! mode comes next. The mode search of [`crate::coupled`] does the rest and depends on no law.

mod cohesive;
mod coulomb;
mod limits;
mod mode;
mod previous_contact;
mod thin_layer;
mod yielding;

pub use cohesive::{Bonded, Cohesive};
pub use coulomb::{Coulomb, UnilateralCondition, VariableFriction};
pub use limits::Limits;
pub use mode::Mode;
pub(crate) use previous_contact::state_variable_ends;
pub use previous_contact::{PreviousContact, PreviousContacts};
pub use thin_layer::{FrictionLimit, SlipSense, ThinLayer};
pub use yielding::Yielding;

use crate::error::{Error, Result, require_part, same_length};

/// Opening and **total** traction (static part included) of one contact element, as means over it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ContactState {
    /// Gap between base and soil, m; positive when open.
    pub gap: f64,
    /// Slip of the structure over the soil since the static state, m; positive to the right.
    pub slip: f64,
    /// Contact pressure, Pa; positive in compression.
    pub pressure: f64,
    /// Shear traction that the structure exerts on the soil, Pa; positive to the right.
    pub shear: f64,
    /// In plan: slip along y, m; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slip_across: f64,
    /// In plan: shear traction along y, Pa; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub shear_across: f64,
}

/// A number of an element: its word, its SI unit, whether it is one of grounds in plan only, and its value.
type Number = (&'static str, &'static str, bool, fn(&ContactState) -> f64);

impl ContactState {
    /// All numbers, in the order of columns in files: word, SI unit, whether only grounds in plan have it, value.
    pub const NUMBERS: [Number; 6] = [
        ("gap", "m", false, |own| own.gap),
        ("slip", "m", false, |own| own.slip),
        ("pressure", "Pa", false, |own| own.pressure),
        ("shear", "Pa", false, |own| own.shear),
        ("slip_across", "m", true, |own| own.slip_across),
        ("shear_across", "Pa", true, |own| own.shear_across),
    ];

    /// Gap, slip and tractions of an element by their components: down, along x, and in plan along y.
    #[inline]
    pub(crate) fn from_components(
        jump: impl Fn(usize) -> f64,
        traction: impl Fn(usize) -> f64,
        plan: bool,
    ) -> Self {
        let [slip_across, shear_across] = if plan { [-jump(2), traction(2)] } else { [0.0; 2] };
        Self {
            gap: jump(0),
            slip: -jump(1),
            pressure: traction(0),
            shear: traction(1),
            slip_across,
            shear_across,
        }
    }

    /// Jump between soil and structure: down, along x, along y, m.
    pub(crate) fn jump(&self) -> [f64; 3] {
        [self.gap, -self.slip, -self.slip_across]
    }

    /// Total traction of the structure on the soil: down, along x, along y, Pa.
    pub(crate) fn traction(&self) -> [f64; 3] {
        [self.pressure, self.shear, self.shear_across]
    }
}

/// Linear condition on the end of a step:
/// `gap·g + slip·s + pressure·p + shear·τ = value`, coefficients in the fields.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
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
    /// Condition that the gap is `value`.
    pub fn gap_is(value: f64) -> Self {
        Self { gap: 1.0, value, ..Self::default() }
    }

    /// Sum of all its numbers: finite only if they are.
    pub(crate) fn sum(&self) -> f64 {
        self.gap + self.slip + self.pressure + self.shear + self.value
    }

    /// The first number that is not finite, with its name.
    pub(crate) fn not_finite(&self) -> Option<(&'static str, f64)> {
        let Self { gap, slip, pressure, shear, value } = *self;
        [
            ("coefficient of the gap", gap),
            ("coefficient of the slip", slip),
            ("coefficient of the pressure", pressure),
            ("coefficient of the shear traction", shear),
            ("right-hand side of a condition", value),
        ]
        .into_iter()
        .find(|(_, value)| !value.is_finite())
    }

    /// The gap that this condition gives for a pressure, if it relates nothing else.
    pub(crate) fn gap_at(&self, pressure: f64) -> Option<f64> {
        (self.gap != 0.0 && self.slip == 0.0 && self.shear == 0.0)
            .then(|| (self.value - self.pressure * pressure) / self.gap)
    }

    /// The pressure that this condition gives, if it relates nothing else.
    pub(crate) fn pressure_alone(&self) -> Option<f64> {
        let alone = self.gap == 0.0 && self.slip == 0.0 && self.shear == 0.0;
        (alone && self.pressure != 0.0).then(|| self.value / self.pressure)
    }

    /// The component (0 normal, 1 tangential) whose traction it fixes by itself.
    #[inline]
    pub(crate) fn fixed_component(&self) -> Option<usize> {
        match *self {
            Self { gap, slip, .. } if gap != 0.0 || slip != 0.0 => None,
            Self { pressure, shear: 0.0, .. } if pressure != 0.0 => Some(0),
            Self { pressure: 0.0, shear, .. } if shear != 0.0 => Some(1),
            _ => None,
        }
    }

    /// Condition that the slip is `value`.
    pub fn slip_is(value: f64) -> Self {
        Self { slip: 1.0, value, ..Self::default() }
    }

    /// Condition that the pressure is `value`.
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Tolerance {
    /// Tolerance for gaps and slips, m.
    pub length: f64,
    /// Tolerance for tractions, Pa.
    pub traction: f64,
}

impl Tolerance {
    /// Tolerance for lengths (m) and tractions (Pa).
    pub fn new(length: f64, traction: f64) -> Self {
        Self { length, traction }
    }
}

/// The scene as a law can check it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactScene {
    /// Gravity, m/s²; zero if the base starts unpressed.
    pub gravity: f64,
    /// Time step, s.
    pub time_step: f64,
}

/// Refuses laws that are neither one nor one for each of `count` elements, and a law without modes.
pub(crate) fn check_list(laws: &[Box<dyn InterfaceLaw>], count: usize) -> Result<()> {
    if laws.len() != 1 {
        same_length("list of interface laws", laws.len(), count)?;
    }
    let named = laws.iter().all(|law| !law.modes().is_empty());
    require_part("interface law", named, "`modes` must name at least one mode")
}

/// The law of `element` from a list of one law for all, or one each.
pub(crate) fn law_of(laws: &[Box<dyn InterfaceLaw>], element: usize) -> &dyn InterfaceLaw {
    laws[if laws.len() == 1 { 0 } else { element }].as_ref()
}

/// Contact law between base and soil: implement this for a law of your own.
///
/// A law is a rule and keeps nothing itself. The end of the step before is in [`PreviousContact`]; what
/// else it needs of the past it declares as a few state variables per element, which the
/// simulation keeps, shows in [`PreviousContact::state_variables`] and saves in checkpoints. Numbers of a law that
/// are not finite, and a next mode that is none of its modes, are a [`LawError`](crate::LawError).
///
/// Friction that falls from 0.5 to 0.3 with the distance that an element has slid:
/// ```
/// use basemat::Simulation;
/// use basemat::bem::SpringGround;
/// use basemat::interface::{
///     Condition, ContactState, Coulomb, InterfaceLaw, Mode, PreviousContact, Tolerance,
/// };
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
///
/// struct SlipWeakening;
///
/// impl SlipWeakening {
///     /// Coulomb's law with the friction of this step.
///     fn now(&self, start: &PreviousContact) -> Coulomb {
///         let slid = start.state_variables[0];
///         Coulomb::new(0.3 + 0.2 * (-slid / 0.01).exp()).expect("a friction above zero")
///     }
/// }
///
/// impl InterfaceLaw for SlipWeakening {
///     fn modes(&self) -> &[Mode] {
///         &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
///     }
///     fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
///         self.now(start).conditions(mode, start)
///     }
///     fn next_mode(
///         &self, mode: Mode, start: &PreviousContact, trial: &ContactState, tolerance: Tolerance,
///     ) -> Mode {
///         self.now(start).next_mode(mode, start, trial, tolerance)
///     }
///     fn state_variables(&self) -> usize {
///         1
///     }
///     fn commit(&self, start: &PreviousContact, end: &ContactState, mode: Mode, state_variables: &mut [f64]) {
///         if mode.is_slip() {
///             state_variables[0] += (end.slip - start.state.slip).abs();
///         }
///     }
/// }
///
/// let mut simulation = Simulation::builder(0.005)
///     .structure(RigidBlock::new(8.0, 4.0, 2000.0)?)
///     .ground(SpringGround::new(-4.0..4.0, 8, 2e8, 1e8)?.with_dashpots(7e5, 4e5)?)
///     .interface(SlipWeakening)
///     .motion(el_centro_1940().scaled(3.0)?)
///     .build()?;
/// let run = simulation.run(1000, |_| {})?;
/// let slid = simulation.state().state_variables(3)[0];
/// assert!(slid > 0.02 && slid > run.whole.largest_slip.magnitude());
/// assert!(run.energy_error < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
#[auto_impl::auto_impl(Box)]
pub trait InterfaceLaw: Send {
    /// The modes that this law uses; the first is that of an element at rest in contact.
    fn modes(&self) -> &[Mode];

    /// The two conditions that `mode` imposes on the end of the step.
    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2];

    /// The mode to try next, given the `trial` that the conditions of `mode` led to; `mode` itself
    /// if the trial is admissible.
    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode;

    /// Elastic opening per traction in `mode`, m/Pa: gap per tension and slip per shear traction.
    /// Zero (the default) for hard contact. The energy balance counts what so much elasticity
    /// stores, ½ compliance · traction² at the end of the step; only the rest of gap and slip, and
    /// what goes with a compliance that changes, can be lost to friction, impact and damage.
    ///
    /// Asked for every mode at the static state, and once per solved step for the mode it ends in. A
    /// law without state variables that is hard in every mode at the static state counts as hard for the
    /// whole run.
    fn compliance(&self, _mode: Mode, _start: &PreviousContact) -> [f64; 2] {
        [0.0; 2]
    }

    /// Count of the state variables that the law keeps per element, always the same; none by default.
    fn state_variables(&self) -> usize {
        0
    }

    /// Sets the state variables that an element begins a run with, zeros unless this says otherwise, from
    /// the `start` of its first step (and, where the law acts while the weight comes on, from one
    /// without pressure for that). Not called for a law without any.
    fn initial_state_variables(&self, _start: &PreviousContact, _state_variables: &mut [f64]) {}

    /// Brings the state variables of an element to the `end` of a step in `mode`: they hold what they were at the
    /// `start` of the step. Called once per accepted step, after its modes are found, and not for a
    /// law without any.
    fn commit(
        &self,
        _start: &PreviousContact,
        _end: &ContactState,
        _mode: Mode,
        _state_variables: &mut [f64],
    ) {
    }

    /// The friction coefficient, for the factor of safety against sliding
    /// ([`Quantity::SlidingSafety`](crate::results::Quantity::SlidingSafety)): the base resists by this times the
    /// pressure. Infinite for a law that never slides, `None` (the default) for one without such a number.
    fn friction_coefficient(&self) -> Option<f64> {
        None
    }

    /// Traction (Pa) by which `trial` exceeds the strength of a bond that breaks for good, below zero
    /// while it holds; `None` (the default) for an element without a bond, or with a broken one.
    ///
    /// A step holds elements with a bond in their mode of rest, whatever their tractions, until all
    /// other modes are found; then bonds break where the overload is largest, the modes are found anew,
    /// and so on. From there on the law sees a broken bond as `start.has_opened`.
    fn bond_overload(&self, _start: &PreviousContact, _trial: &ContactState) -> Option<f64> {
        None
    }

    /// Asked after a condition that is not finite: the reason, if the law can give it.
    ///
    /// # Errors
    /// With the number behind it, as [`Error::Input`] or
    /// [`Error::part`](crate::Error::part).
    fn check_start(&self, _start: &PreviousContact) -> Result<()> {
        Ok(())
    }

    /// Limits of the tractions of an element on a ground in plan, in the step after `start`: modes and conditions are
    /// for the plane. The direction of slip is mechanics there, along the shear traction, and the law says how far
    /// tractions go. Asked once per attempted step.
    ///
    /// The default is an error that names the law: it is one of the plane alone.
    ///
    /// # Errors
    /// If the law has none for this element, as [`Error::Scene`],
    /// [`Error::Input`] or [`Error::part`].
    fn limits(&self, _start: &PreviousContact) -> Result<Limits> {
        let quantity = std::any::type_name::<Self>();
        let quantity = quantity.rsplit("::").next().unwrap_or(quantity);
        Err(Error::Scene { quantity, needed: "`limits`, to act on a ground in plan" })
    }

    /// Same law without friction and cohesion, for setting the structure down on the ground; hard
    /// and frictionless contact unless the law says otherwise.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Coulomb::frictionless())
    }

    /// Asked once, when a simulation is put together: whether this law makes sense in it.
    ///
    /// # Errors
    /// With the reason if it does not, as [`Error::part`](crate::Error::part) for example.
    fn check(&self, _scene: &ContactScene) -> Result<()> {
        Ok(())
    }
}
