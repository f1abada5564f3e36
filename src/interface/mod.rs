//! Interface laws between the base and the soil.
//!
//! A law describes one contact element at a time. An [`InterfaceLaw`] needs one method: the [`Limits`] of the element's
//! tractions. In the plane, the limits determine two linear [`Condition`]s for each [`Mode`], between the element's opening
//! and its traction. They also determine the next mode after a trial. A law of the plane without such limits implements
//! [`PlaneLaw`], whose three methods return modes, conditions and the next mode. The mode search of [`crate::contact`] is
//! the same for all laws.

mod cohesive;
mod condition;
mod coulomb;
mod cyclic_yielding;
mod earth_pressure;
mod limits;
mod mode;
mod plane_law;
mod previous_contact;
mod shared_law;
mod thin_layer;
mod variable_friction;
mod yielding;

#[doc(inline)]
pub use crate::error::LawError;
pub use cohesive::{Bonded, Cohesive};
pub use condition::Condition;
pub use coulomb::{Coulomb, UnilateralCondition};
pub use cyclic_yielding::CyclicYielding;
pub use earth_pressure::EarthPressure;
pub use limits::Limits;
pub use mode::Mode;
pub use plane_law::{InPlane, PlaneLaw};
pub(crate) use previous_contact::state_variable_ends;
pub use previous_contact::{PreviousContact, PreviousContacts};
pub(crate) use shared_law::SharedLaw;
pub use thin_layer::{FrictionLimit, SlipSense, ThinLayer};
pub use variable_friction::VariableFriction;
pub use yielding::Yielding;

use crate::error::{Result, require_part, same_length};
use crate::geometry::ContactLayout;

/// Whether the laws of a ground act by conditions of modes or by limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LawForm {
    /// Conditions of each mode, if elements slide along one axis.
    Modes,
    /// Limits of the tractions, if elements slide along two axes.
    Limits,
}

impl LawForm {
    /// Form for the elements of a layout.
    pub(crate) fn of(layout: ContactLayout) -> Self {
        if layout.is_plan() { Self::Limits } else { Self::Modes }
    }
}

/// Opening and **total** traction of one contact element, as element means.
///
/// Tractions include the static part.
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
    /// Slip along y on a ground in plan, m; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub slip_across: f64,
    /// Shear traction along y on a ground in plan, Pa; zero in the plane.
    #[cfg_attr(feature = "serde", serde(default))]
    pub shear_across: f64,
}

/// Column of a contact state in files.
///
/// It has a word, an SI unit, whether only grounds in plan have it, and its value.
type ContactColumn = (&'static str, &'static str, bool, fn(&ContactState) -> f64);

impl ContactState {
    /// Columns of a contact state in files, in their order.
    ///
    /// Each column has its word, its SI unit, whether only grounds in plan have it, and its value.
    pub const NUMBER_COLUMNS: [ContactColumn; 6] = [
        ("gap", "m", false, |state| state.gap),
        ("slip", "m", false, |state| state.slip),
        ("pressure", "Pa", false, |state| state.pressure),
        ("shear", "Pa", false, |state| state.shear),
        ("slip_across", "m", true, |state| state.slip_across),
        ("shear_across", "Pa", true, |state| state.shear_across),
    ];

    /// Gap, slip and tractions of an element from their components.
    ///
    /// `jump` and `traction` return a component by its index: 0 down, 1 along x, and in plan 2 along y.
    #[inline]
    pub(crate) fn from_components(
        jump: impl Fn(usize) -> f64,
        traction: impl Fn(usize) -> f64,
        is_plan: bool,
    ) -> Self {
        Self {
            gap: jump(0),
            slip: -jump(1),
            pressure: traction(0),
            shear: traction(1),
            slip_across: if is_plan { -jump(2) } else { 0.0 },
            shear_across: if is_plan { traction(2) } else { 0.0 },
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

/// Differences below which a law should treat numbers as equal.
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

/// Data of the scene with which a law checks whether it applies.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactScene {
    /// Gravity, m/s²; zero if the base starts without pressure.
    pub gravity: f64,
    /// Time step, s.
    pub time_step: f64,
}

/// Returns an error unless there is one law, or one for each element.
///
/// Each law must have modes.
pub(crate) fn check_list(laws: &[Box<dyn InterfaceLaw>], element_count: usize) -> Result<()> {
    if laws.len() != 1 {
        same_length("list of interface laws", laws.len(), element_count)?;
    }
    let all_have_modes = laws.iter().all(|law| !law.modes().is_empty());
    require_part("interface law", all_have_modes, "`modes` must name at least one mode")
}

/// Law of an element.
///
/// `laws`: one law for all elements, or one for each.
pub(crate) fn law_of(laws: &[Box<dyn InterfaceLaw>], element: usize) -> &dyn InterfaceLaw {
    laws[if laws.len() == 1 { 0 } else { element }].as_ref()
}

/// Contact law between base and soil; implement this trait for your law.
///
/// A law needs one method: the [`limits`](InterfaceLaw::limits) of an element's tractions. A law of the plane that no
/// limits describe (an open element with traction, a slip with viscous resistance) implements [`PlaneLaw`] instead.
///
/// A law stores nothing that changes in a run. [`PreviousContact`] contains the end of the previous step. If a
/// law depends on earlier steps, it declares state variables per element. The simulation stores these variables, passes
/// them in [`PreviousContact::state_variables`] and saves them in checkpoints. A law that returns a number
/// that is not finite, or a mode that it does not list, causes a [`LawError`].
///
/// Friction that falls from 0.5 to 0.3 with the distance that an element has slid:
/// ```
/// use basemat::Simulation;
/// use basemat::bem::SpringGround;
/// use basemat::interface::{ContactState, InterfaceLaw, Limits, Mode, PreviousContact};
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
///
/// struct SlipWeakening;
///
/// impl InterfaceLaw for SlipWeakening {
///     fn limits(&self, start: &PreviousContact) -> basemat::Result<Limits> {
///         let slid_distance = start.state_variables[0];
///         Ok(Limits { friction: 0.3 + 0.2 * (-slid_distance / 0.01).exp(), ..Limits::default() })
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
/// let slid_distance = simulation.state().state_variables(3)[0];
/// assert!(slid_distance > 0.02 && slid_distance > run.whole.largest_slip.magnitude());
/// assert!(run.energy_error < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// A law without its method does not compile:
/// ```compile_fail,E0046
/// struct Nothing;
/// impl basemat::interface::InterfaceLaw for Nothing {}
/// ```
#[auto_impl::auto_impl(Box)]
pub trait InterfaceLaw: Send {
    /// Limits of the tractions of an element in the step after `start`.
    ///
    /// This is the only required method. In plan the slip has the direction of the shear traction, and a run uses the
    /// limits alone: it calls this method once per attempted step. In the plane, modes and conditions follow from the
    /// limits, unless the law implements their methods.
    ///
    /// # Errors
    /// If the law has no limits for this element, as [`Error::Scene`](crate::Error::Scene) or
    /// [`Error::part`](crate::Error::part).
    fn limits(&self, start: &PreviousContact) -> Result<Limits>;

    /// The modes of this law in the plane, first the mode of rest.
    ///
    /// The default has all modes of a law with [`limits`](InterfaceLaw::limits). A law overrides it to omit modes that
    /// its limits exclude.
    fn modes(&self) -> &[Mode] {
        Mode::WITH_LIMITS
    }

    /// The two conditions that `mode` imposes at the end of the step.
    ///
    /// The default follows from [`limits`](InterfaceLaw::limits) and [`compliance`](InterfaceLaw::compliance). A law
    /// overrides it only if its conditions in the plane do not follow from its limits.
    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let compliance = self.compliance(Mode::Stick, start);
        self.limits(start).map_or_else(
            |_| [Condition::gap_is(f64::NAN), Condition::slip_is(f64::NAN)],
            |limits| limits.conditions(mode, start, compliance),
        )
    }

    /// The mode to try next after a `trial` with the conditions of `mode`.
    ///
    /// Return `mode` itself if the trial is admissible. The default follows from [`limits`](InterfaceLaw::limits).
    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let compliance = self.compliance(Mode::Stick, start);
        let closing_mode = self.modes().first().copied().unwrap_or(Mode::Stick);
        self.limits(start).map_or(mode, |limits| {
            limits.next_mode(mode, closing_mode, start, trial, tolerance, compliance)
        })
    }

    /// Elastic opening per traction in `mode`, m/Pa: gap per tension, and slip per shear traction.
    ///
    /// Zero (the default) for hard contact. The energy balance includes the energy stored in this compliance,
    /// ½ compliance · traction² at the end of the step. The dissipated energy is only the work on the inelastic gap and
    /// slip, and the energy that a changing compliance releases.
    ///
    /// The simulation calls this method for every mode at the static state, and once per step for the mode at the end of
    /// the step. A law without state variables that is hard in every mode at the static state is treated as hard in the
    /// whole run.
    fn compliance(&self, _mode: Mode, _start: &PreviousContact) -> [f64; 2] {
        [0.0; 2]
    }

    /// Number of state variables per element, always the same; zero by default.
    fn state_variables(&self) -> usize {
        0
    }

    /// Sets the initial state variables of an element; by default they are zero.
    ///
    /// `start` is the start of the element's first step. If the law acts during the gravity stage, the method is also
    /// called for that stage, with a start without pressure. It is not called for a law without state variables.
    fn initial_state_variables(&self, _start: &PreviousContact, _state_variables: &mut [f64]) {}

    /// Updates the state variables of an element at the `end` of a step in `mode`.
    ///
    /// On entry `state_variables` contains the values at the `start` of the step. The method is called once per accepted
    /// step, after the search for modes, and not for a law without state variables.
    fn commit(
        &self,
        _start: &PreviousContact,
        _end: &ContactState,
        _mode: Mode,
        _state_variables: &mut [f64],
    ) {
    }

    /// The friction coefficient for the factor of safety against sliding.
    ///
    /// The resistance of the base is this coefficient times the pressure
    /// ([`Quantity::SlidingSafety`](crate::results::Quantity::SlidingSafety)). For friction that varies, return the
    /// smallest coefficient: with a larger one, the base could slide although the factor of safety is above one.
    /// Infinite for a law that never slides; `None` (the default) for a law without such a coefficient.
    fn friction_coefficient(&self) -> Option<f64> {
        None
    }

    /// Traction by which `trial` exceeds the strength of a bond that breaks for good, Pa.
    ///
    /// Negative below the strength; `None` (the default) for an element without a bond, or with a broken one.
    ///
    /// The mode search first keeps bonded elements in their mode of rest, at any traction, until all other modes are
    /// found. Then the bonds with the largest overload break, and the search is repeated until no bond is overloaded.
    /// `start.has_opened` is true for a broken bond.
    fn bond_overload(&self, _start: &PreviousContact, _trial: &ContactState) -> Option<f64> {
        None
    }

    /// Returns the cause of a condition that is not finite, if the law can determine it.
    ///
    /// # Errors
    /// An error with the cause, as [`Error::Input`](crate::Error::Input) or [`Error::part`](crate::Error::part). The default
    /// returns errors of the [`limits`](InterfaceLaw::limits) from which the conditions follow.
    fn check_start(&self, start: &PreviousContact) -> Result<()> {
        self.limits(start)?.checked().map(drop)
    }

    /// The same law without friction and cohesion, for the gravity stage.
    ///
    /// The returned law acts on a ground in the plane. The default is hard and frictionless contact. `build` returns an
    /// error if the static state without friction is not in equilibrium under the law itself. On a ground in plan, the
    /// gravity stage uses the [`limits`](Self::limits) of the law itself, without friction, attraction and shear strength.
    /// Its state variables are then initialised without pressure.
    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        Box::new(Coulomb::frictionless())
    }

    /// Checks whether this law applies in the simulation that is being built; called once.
    ///
    /// # Errors
    /// The reason why it does not apply, for example as [`Error::part`](crate::Error::part).
    fn check(&self, _scene: &ContactScene) -> Result<()> {
        Ok(())
    }
}

former_constants! {
    ContactState { NUMBERS: [ContactColumn; 6] = NUMBER_COLUMNS, "use `NUMBER_COLUMNS`"; }
}
