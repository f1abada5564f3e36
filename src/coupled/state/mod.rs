//! The state after a step, and sequences of states.

pub(crate) mod energy_balance;
#[cfg(feature = "embedded")]
pub(crate) mod face_forces;
pub(crate) mod foundation;
pub(crate) mod joint_state;
pub(crate) mod sequence;
mod transition;

pub use transition::Transition;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::contact::SearchMethod;
use crate::coupled::model::kinematics::{DofResponse, Kinematics};
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::state::foundation::{Foundation, FoundationChecks};
use crate::coupled::state::joint_state::JointState;
use crate::error::Result;
use crate::geometry::resultant;
use crate::geometry::{ContactElement, Footing, Patch};
use crate::interface::{ContactState, Mode, PreviousContacts};
use crate::structure::Probe;
use crate::structure::probe_index;

/// Identity of the simulation to which a state belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SimulationId(u64);

impl SimulationId {
    /// Identity of a new simulation.
    pub(crate) fn new() -> Self {
        static NEXT_ID: AtomicU64 = AtomicU64::new(0);
        Self(NEXT_ID.fetch_add(1, Ordering::Relaxed))
    }
}

/// Constant data that results of all states share.
#[derive(Debug)]
pub(crate) struct ResultContext {
    pub(crate) probes: Vec<Probe>,
    pub(crate) elements: Patch,
    /// Distance of the resultant pressure below the middle of each element, m.
    ///
    /// Empty if the pressure acts at the middle.
    pub(crate) pressure_depths: Vec<f64>,
    /// Friction coefficients for the factor of safety against sliding.
    ///
    /// One for all elements, one for each, or none.
    pub(crate) friction: Vec<f64>,
    /// Shape of each foundation.
    pub(crate) footings: Vec<Footing>,
    /// Contact elements of each joint.
    pub(crate) joint_elements: Vec<Vec<ContactElement>>,
    /// Upward force of the water on the structure, N.
    pub(crate) buoyancy: f64,
    /// Weight of a structure in water, N; zero without water above the base.
    pub(crate) weight_in_water: f64,
}

/// Results of a simulation at the end of an accepted step.
///
/// Displacements are changes from the static state, relative to the free field's translation unless stated otherwise.
/// Forces act from the structure **on the soil**. In the plane they are per metre of thickness, in plan total forces.
/// Tractions are constant over the step.
///
/// States of different simulations may be equal.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct State {
    /// Number of steps so far.
    pub step: usize,
    /// Time, s.
    pub time: f64,
    /// Gap, slip and total tractions of each element of the ground.
    pub contact: Vec<ContactState>,
    /// Mode of each element of the ground.
    pub modes: Vec<Mode>,
    /// Changes of modes in this step, of elements of the ground.
    pub transitions: Vec<Transition>,
    /// Values of the probes, in the order of the builder.
    pub probes: Vec<f64>,
    /// Horizontal force on the soil, positive to the right, N/m.
    pub base_shear: f64,
    /// Moment on the soil, counter-clockwise, N·m/m.
    ///
    /// It refers to the middle of the base, or to the builder's moment center. In plan it is about the axis along y through
    /// this point, by the right-hand rule, N·m.
    pub base_moment: f64,
    /// Total pressure on the soil, positive in compression, N/m.
    pub normal_force: f64,
    /// Length of open elements over the length of the base; in plan area over area.
    pub uplifted_fraction: f64,
    /// Slip averaged over the length of the base, in plan over its area, m.
    ///
    /// It is positive if the structure has moved to the right.
    pub mean_slip: f64,
    /// Rotation of the base's chord, counter-clockwise, rad; with several foundations the largest.
    ///
    /// In plan it is about the axis along y by the right-hand rule.
    pub base_rotation: f64,
    /// Results of each foundation, from left to right; in plan in the order of the structure's faces.
    pub foundations: Vec<Foundation>,
    /// Results of each joint, in the order of the builder.
    pub joints: Vec<JointState>,
    /// Mean horizontal and vertical (up) displacement of the free field at the base and its walls, m.
    pub free_field: [f64; 2],
    /// In plan: mean displacement of the free field along y, m; zero in the plane.
    pub free_field_across: f64,
    /// The energy balance; every term is NaN if the balance is omitted.
    pub energy_balance: EnergyBalance,
    /// Number of trials of the search for contact modes.
    ///
    /// In the plane a trial is a linear solution or a sweep over the elements, in plan a sweep or an iteration of
    /// Newton's method.
    pub trials: usize,
    /// Method that solved the contact problem; for a nonlinear structure the slowest method of all iterations.
    pub method: SearchMethod,
    /// Factors of safety and slip of each foundation; they follow from the other fields.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) checks: Vec<FoundationChecks>,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) simulation: SimulationId,
    /// Shared by all states of a simulation.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) context: Arc<ResultContext>,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) kinematics: Kinematics,
    /// Contact of each element at the start of the next step, for the laws.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) start: PreviousContacts,
}

impl PartialEq for State {
    fn eq(&self, other: &Self) -> bool {
        // The pattern names all fields, so that a new field is compared or omitted on purpose.
        let Self {
            step,
            time,
            contact,
            modes,
            transitions,
            probes,
            base_shear,
            base_moment,
            normal_force,
            uplifted_fraction,
            mean_slip,
            base_rotation,
            foundations,
            joints,
            free_field,
            free_field_across,
            energy_balance,
            trials,
            method,
            checks: _,
            simulation: _,
            context: _,
            kinematics,
            start,
        } = self;
        *step == other.step
            && *time == other.time
            && *contact == other.contact
            && *modes == other.modes
            && *transitions == other.transitions
            && *probes == other.probes
            && *base_shear == other.base_shear
            && *base_moment == other.base_moment
            && *normal_force == other.normal_force
            && *uplifted_fraction == other.uplifted_fraction
            && *mean_slip == other.mean_slip
            && *base_rotation == other.base_rotation
            && *foundations == other.foundations
            && *joints == other.joints
            && *free_field == other.free_field
            && *free_field_across == other.free_field_across
            && *energy_balance == other.energy_balance
            && *trials == other.trials
            && *method == other.method
            && *kinematics == other.kinematics
            && *start == other.start
    }
}

impl State {
    /// Displacements of the structure's degrees of freedom (m, rad) relative to the free field.
    ///
    /// For each connected part it is the displacement since t = 0 minus the mean translation of the ground under the part.
    ///
    /// Displacement, absolute displacement, velocity and acceleration are computed at their first use in a step. A structure
    /// of n degrees of freedom in modal coordinates needs n² operations for each. To record a few quantities at every
    /// step, a [`Probe`](super::Probe) takes less time.
    pub fn displacement(&self) -> &[f64] {
        self.kinematics.dofs(DofResponse::Displacement)
    }

    /// Displacement of the degrees of freedom plus the translation of the free field, m and rad.
    pub fn absolute_displacement(&self) -> &[f64] {
        self.kinematics.dofs(DofResponse::AbsoluteDisplacement)
    }

    /// Total velocities of the degrees of freedom at the end of the step.
    ///
    /// They are not relative to the free field; m/s and rad/s.
    pub fn velocity(&self) -> &[f64] {
        self.kinematics.dofs(DofResponse::Velocity)
    }

    /// Total accelerations of the degrees of freedom, m/s² and rad/s².
    ///
    /// For the midpoint and θ rules they are means over the step.
    pub fn acceleration(&self) -> &[f64] {
        self.kinematics.dofs(DofResponse::Acceleration)
    }

    /// The value of the probe called `name`.
    ///
    /// Every call searches for the name; [`State::probes`] has the value by its index without a search.
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::Probe;
    /// use basemat::interface::Coulomb;
    /// use basemat::motion::el_centro_1940;
    /// use basemat::structure::RigidBlock;
    /// use basemat::{Error, Simulation};
    ///
    /// let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
    /// let mut simulation = Simulation::builder(0.01)
    ///     .probe(Probe::displacement("top", block.horizontal_at(6.0)))
    ///     .structure(block)
    ///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///     .interface(Coulomb::new(0.4)?)
    ///     .motion(el_centro_1940())
    ///     .build()?;
    /// let state = simulation.step()?;
    /// assert_eq!(state.probe("top")?, state.probes[0]);
    /// assert!(matches!(state.probe("roof"), Err(Error::Name { .. })));
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if no probe has this name.
    pub fn probe(&self, name: &str) -> Result<f64> {
        // A user may have shortened the public list of values.
        let probe_count = self.context.probes.len().min(self.probes.len());
        let probes = &self.context.probes[..probe_count];
        probe_index(probes, name, |probe| &probe.name).map(|index| self.probes[index])
    }

    /// Copies the modes of all elements, of the ground and then of the joints.
    pub(crate) fn copy_modes(&self, modes: &mut [Mode]) {
        let ground_count = self.modes.len();
        modes[..ground_count].copy_from_slice(&self.modes);
        let joint_modes = self.joints.iter().flat_map(|joint| &joint.modes);
        modes[ground_count..]
            .iter_mut()
            .zip(joint_modes)
            .for_each(|(copy, mode)| *copy = *mode);
    }

    /// Contact and mode of each element, of the ground and then of the joints.
    pub(crate) fn elements_mut(&mut self) -> impl Iterator<Item = (&mut ContactState, &mut Mode)> {
        let ground = self.contact.iter_mut().zip(&mut self.modes);
        let joints = self.joints.iter_mut();
        ground.chain(joints.flat_map(|joint| joint.contact.iter_mut().zip(&mut joint.modes)))
    }

    /// Largest rotation of a foundation about a horizontal axis, rad.
    pub(crate) fn tilt(&self) -> f64 {
        let tilts = self.foundations.iter().map(|foundation| {
            resultant(foundation.base_rotation, foundation.rotation_across).abs()
        });
        tilts.fold(0.0, f64::max)
    }

    /// Whether the ground is in plan.
    pub(crate) fn is_plan(&self) -> bool {
        self.context.elements.is_plan()
    }

    /// State variables of the law of an element.
    ///
    /// See [`InterfaceLaw::state_variables`](crate::interface::InterfaceLaw::state_variables). Empty if the law
    /// has none, or the element does not exist. Elements of joints count after those of the ground, joint by joint.
    pub fn state_variables(&self, element: usize) -> &[f64] {
        if element < self.start.len() { self.start.state_variables_of(element) } else { &[] }
    }
}
