//! Checkpoints: saving a run and resuming it later, to the last bit.

use crate::Simulation;
use crate::contact::SearchMethod;
#[cfg(feature = "serde")]
use crate::coupled::identity::bits;
use crate::coupled::identity::{Change, Identity};
use crate::coupled::model::kinematics::Translation;
use crate::coupled::scene::Scene;
use crate::coupled::state::State;
use crate::coupled::state::energy_balance::EnergyBalance;
use crate::coupled::step::energy_accumulator::EnergyAccumulator;
use crate::coupled::step::joint_losses::JointLosses;
use crate::error::{CheckpointError, Result};
use crate::geometry::COMPONENTS_IN_SPACE;
use crate::interface::{ContactState, LawForm, Mode, PreviousContact};
use crate::linalg::SparseMatrix;
use crate::structure::{Structure, Tangent, restore_variables, save_variables};
use crate::text::check_sum::CheckSum;

/// Format of [`Checkpoint`]; increase it when the order of its numbers changes.
const CHECKPOINT_FORMAT: u32 = 14;
/// Largest number of steps of a checkpoint; no run has more.
const MAX_CHECKPOINT_STEPS: usize = match 1_usize.checked_shl(47) {
    Some(steps) => steps,
    None => usize::MAX >> 4,
};

/// Saved run between two steps, made by [`Simulation::checkpoint`](crate::Simulation::checkpoint).
///
/// With the feature `serde` it can be written in any of serde's formats. Floating-point numbers are written as their
/// bits (integers of 64 bits), so that none is rounded. A check sum over all contents is written too.
/// [`Simulation::resume`](crate::Simulation::resume) returns an error if the contents have changed.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Checkpoint {
    format: u32,
    identity: Identity,
    steps: usize,
    /// Index of each element's mode in `Mode::ALL`, and whether the element has been open.
    modes: Vec<(usize, bool)>,
    /// State variables of the laws of all elements.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    laws: Vec<f64>,
    /// Numbers of the state and of the energy balance.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    state: Vec<f64>,
    /// Numbers that the ground saved.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    ground: Vec<f64>,
    /// Internal variables of the structure.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    structure: Vec<f64>,
    /// Values of the tangent with which the next step of a large nonlinear structure begins; empty for none.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    tangent: Vec<f64>,
    /// Two numbers for each load: whether its force was set (1 or 0), and that force.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    set_loads: Vec<f64>,
    /// Check sum over all fields above; formats before the eighth have none.
    #[cfg_attr(feature = "serde", serde(default))]
    sum: u64,
}

impl Checkpoint {
    /// Number of steps before the checkpoint.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Check sum over all contents, field by field.
    fn check_sum(&self) -> u64 {
        let Self { format, identity, steps, modes, laws, state, .. } = self;
        let Self { ground, structure, tangent, set_loads, sum: _, .. } = self;
        let mut sum = CheckSum::default();
        sum.add(u64::from(*format));
        identity.add_to(&mut sum);
        sum.add(*steps as u64);
        sum.add(modes.len() as u64);
        for (mode, has_opened) in modes {
            sum.add(*mode as u64);
            sum.add(u64::from(*has_opened));
        }
        for list in [laws, state, ground, structure, tangent, set_loads] {
            sum.add_numbers(list);
        }
        sum.value()
    }
}

impl Simulation {
    /// Saves the state of the run for [`Simulation::resume`].
    ///
    /// The checkpoint contains the ground's history: all tractions of an exact history, and the tractions of at most two
    /// windows of a history of exponentials.
    ///
    /// # Errors
    /// [`CheckpointError::Unsupported`](crate::coupled::CheckpointError::Unsupported) if the ground, its history or the
    /// structure cannot save its state.
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::Checkpoint;
    /// use basemat::interface::Coulomb;
    /// use basemat::motion::el_centro_1940;
    /// use basemat::structure::RigidBlock;
    /// use basemat::Simulation;
    ///
    /// let scene = || {
    ///     Simulation::builder(0.01)
    ///         .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    ///         .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///         .interface(Coulomb::new(0.4)?)
    ///         .motion(el_centro_1940())
    ///         .gravity(9.81)
    ///         .build()
    /// };
    /// let mut simulation = scene()?;
    /// simulation.run(200, |_| {})?;
    /// let checkpoint: Checkpoint = simulation.checkpoint()?;
    /// simulation.run(100, |_| {})?;
    ///
    /// let mut resumed_simulation = scene()?;
    /// resumed_simulation.resume(&checkpoint)?;
    /// assert_eq!(resumed_simulation.state().step, 200);
    /// resumed_simulation.run(100, |_| {})?;
    /// assert_eq!(resumed_simulation.state(), simulation.state());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn checkpoint(&self) -> Result<Checkpoint> {
        let Self { scene, state, .. } = self;
        let mode_index = |start: PreviousContact<'_>| {
            let index = Mode::ALL.iter().position(|mode| *mode == start.mode);
            let unsupported_law = CheckpointError::Unsupported { part: "interface law" };
            Ok((index.ok_or(unsupported_law)?, start.has_opened))
        };
        let mut state_copy = state.clone();
        let mut energies = self.energies.clone();
        let numbers =
            state_numbers(scene.layout().components(), &mut state_copy, energies.as_mut());
        let mut checkpoint = Checkpoint {
            format: CHECKPOINT_FORMAT,
            identity: self.identity(),
            steps: state.step,
            modes: state.start.iter().map(mode_index).collect::<Result<_>>()?,
            laws: state.start.state_variables().to_vec(),
            state: numbers.into_iter().map(|value| *value).collect(),
            ground: self.ground.save()?,
            structure: save_variables(self.structure.as_ref())?,
            tangent: self.solver.first_tangent(state.step).to_vec(),
            set_loads: set_loads(scene),
            sum: 0,
        };
        checkpoint.sum = checkpoint.check_sum();
        Ok(checkpoint)
    }

    /// Sets the simulation to the state of `checkpoint`, whatever its present state.
    ///
    /// The simulation must be built in the same way. Further steps have the same bits on the same processor.
    ///
    /// The function compares sizes, time step and scheme, elements, probes, sums over the matrices, static state, gravity
    /// stage, initial motion and the [label](crate::coupled::SimulationBuilder::label). It does not compare interface
    /// laws, ground motion, loads and nonlinear forces: name them in the label. It restores forces that were
    /// [set](Simulation::set_load). A checkpoint does not contain the transitions, trials and method of its last step.
    ///
    /// # Errors
    /// [`crate::Error::Checkpoint`] for a checkpoint of another scene, another format, or with numbers missing or
    /// not finite. The simulation then stays unchanged.
    pub fn resume(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        self.resume_changed(checkpoint, &[])
    }

    /// Sets the simulation to the state of `checkpoint`, in a scene with these `changes`.
    ///
    /// Apart from the changes the function is [`Simulation::resume`]. Use it, for example, to continue with another
    /// friction or another motion, which the label names.
    ///
    /// # Errors
    /// As for [`Simulation::resume`], for a difference outside the `changes`.
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::Change;
    /// use basemat::interface::Coulomb;
    /// use basemat::structure::RigidBlock;
    /// use basemat::Simulation;
    ///
    /// let scene = |friction: f64| {
    ///     Simulation::builder(0.01)
    ///         .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    ///         .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///         .interface(Coulomb::new(friction)?)
    ///         .label(format!("friction {friction}"))
    ///         .build()
    /// };
    /// let checkpoint = scene(0.4)?.checkpoint()?;
    /// let error = scene(0.3)?.resume(&checkpoint).unwrap_err();
    /// assert!(error.to_string().contains("the label differs"));
    /// scene(0.3)?.resume_changed(&checkpoint, &[Change::InterfaceLaw])?;
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn resume_changed(&mut self, checkpoint: &Checkpoint, changes: &[Change]) -> Result<()> {
        checkpoint.check()?;
        checkpoint.identity.check(&self.identity(), changes)?;
        // A changed load follows the function of the new scene.
        let restores_loads = !changes.contains(&Change::Load);
        if restores_loads && checkpoint.set_loads.len() != 2 * self.scene.loads.len() {
            return Err(CheckpointError::OtherScene { quantity: "load" }.into());
        }
        let scene = &self.scene;
        let structure = self.structure.as_mut();
        let mut state = self.state.clone();
        let mut energies = self.energies.clone();
        let numbers = state_numbers(scene.layout().components(), &mut state, energies.as_mut());
        if numbers.len() != checkpoint.state.len() {
            return Err(CheckpointError::Corrupt { quantity: "state" }.into());
        }
        for (number, saved_number) in numbers.into_iter().zip(&checkpoint.state) {
            *number = *saved_number;
        }
        restore_modes(scene, &checkpoint.modes, &mut state)?;
        let law_variables = state.start.state_variables_mut();
        if law_variables.len() != checkpoint.laws.len() {
            return Err(CheckpointError::Corrupt { quantity: LAW_VARIABLES_NAME }.into());
        }
        law_variables.copy_from_slice(&checkpoint.laws);
        let first_tangent = restored_tangent(structure, &checkpoint.tangent)?;
        let previous_variables = save_variables(structure)?;
        restore_variables(structure, &checkpoint.structure)?;
        if let Err(error) = self.ground.restore(checkpoint.steps, &checkpoint.ground) {
            restore_variables(structure, &previous_variables)?;
            return Err(error);
        }
        // From here on no error can occur.
        state.step = checkpoint.steps;
        state.time = state.step as f64 * scene.time_step;
        state.trials = 0;
        state.method = SearchMethod::ActiveSet;
        state.transitions.clear();
        state.joints.iter_mut().for_each(|joint| joint.transitions.clear());
        state.kinematics.clear_dof_cache();
        state.energy_balance =
            energies.as_ref().map_or(EnergyBalance::ALL_NAN, |energies| energies.energy_balance);
        JointLosses::set(energies.as_ref().map(|energies| &energies.joint_losses), &mut state);
        state.update_resultants(scene);
        self.solver.set_first_tangent(state.step, first_tangent);
        self.state = state;
        self.energies = energies;
        let mut saved_loads = checkpoint.set_loads.chunks_exact(2).filter(|_| restores_loads);
        for load in &mut self.scene.loads {
            let saved_load = saved_loads.next().filter(|saved_load| saved_load[0] != 0.0);
            load.set(saved_load.map(|saved_load| saved_load[1]));
        }
        Ok(())
    }
}

/// Name of [`Checkpoint::tangent`] in errors.
const TANGENT_NAME: &str = "tangent of the structure";
/// Name of [`Checkpoint::laws`] in errors.
const LAW_VARIABLES_NAME: &str = "state variables of the interface laws";

impl Checkpoint {
    /// Returns an error for another format, another check sum, or an impossible number.
    fn check(&self) -> Result<()> {
        if self.format != CHECKPOINT_FORMAT {
            return Err(
                CheckpointError::Format { found: self.format, needed: CHECKPOINT_FORMAT }.into()
            );
        }
        if self.sum != self.check_sum() {
            return Err(CheckpointError::Corrupt { quantity: "contents" }.into());
        }
        if self.steps > MAX_CHECKPOINT_STEPS {
            return Err(CheckpointError::Corrupt { quantity: "number of steps" }.into());
        }
        for (values, quantity) in [
            (&self.laws, LAW_VARIABLES_NAME),
            (&self.state, "state"),
            (&self.ground, "state of the ground"),
            (&self.structure, "state of the structure"),
            (&self.tangent, TANGENT_NAME),
            (&self.set_loads, "forces that were set"),
        ] {
            if values.iter().any(|value| !value.is_finite()) {
                return Err(CheckpointError::Corrupt { quantity }.into());
            }
        }
        Ok(())
    }
}

/// Numbers of [`Checkpoint::set_loads`].
fn set_loads(scene: &Scene) -> Vec<f64> {
    let mut numbers = Vec::with_capacity(2 * scene.loads.len());
    for load in &scene.loads {
        let value = load.set_force();
        numbers.extend([f64::from(u8::from(value.is_some())), value.unwrap_or(0.0)]);
    }
    numbers
}

/// The tangent with these values; an empty matrix for none.
fn restored_tangent(structure: &dyn Structure, values: &[f64]) -> Result<SparseMatrix> {
    if values.is_empty() {
        return Ok(SparseMatrix::default());
    }
    let tangent = Tangent::at(structure, &vec![0.0; structure.dofs()])?.matrix;
    let with_values = tangent.with_values(values);
    with_values.ok_or_else(|| CheckpointError::Corrupt { quantity: TANGENT_NAME }.into())
}

/// Restores the modes, and whether elements have been open.
fn restore_modes(scene: &Scene, saved_modes: &[(usize, bool)], state: &mut State) -> Result<()> {
    let corrupt_modes = CheckpointError::Corrupt { quantity: "contact modes" };
    if saved_modes.len() != scene.element_count() {
        return Err(corrupt_modes.into());
    }
    let has_limits = LawForm::of(scene.layout()) == LawForm::Limits;
    let mut restored_modes = Vec::with_capacity(saved_modes.len());
    for (e, &(index, has_opened)) in saved_modes.iter().enumerate() {
        let mode = Mode::ALL.get(index).copied();
        let is_possible = |mode: &Mode| has_limits || scene.law(e).modes().contains(mode);
        let mode = mode.filter(is_possible).ok_or_else(|| corrupt_modes.clone())?;
        restored_modes.push((mode, has_opened));
    }
    let elements = state.elements_mut().zip(&restored_modes);
    let mut contacts = Vec::with_capacity(saved_modes.len());
    for ((contact, present_mode), (mode, _)) in elements {
        *present_mode = *mode;
        contacts.push(*contact);
    }
    for (e, (contact, (mode, has_opened))) in contacts.into_iter().zip(restored_modes).enumerate() {
        state.start.restore(e, contact, mode, has_opened);
    }
    Ok(())
}

/// All numbers that a step passes to the next, in a fixed order.
///
/// `component_count` is the number of displacement components: 2 in the plane, 3 in plan.
fn state_numbers<'a>(
    component_count: usize,
    state: &'a mut State,
    energies: Option<&'a mut EnergyAccumulator>,
) -> Vec<&'a mut f64> {
    let mut numbers = Vec::new();
    let State { kinematics, contact, start, free_field, free_field_across, foundations, .. } =
        state;
    let joint_contact = state.joints.iter_mut().flat_map(|joint| &mut joint.contact);
    for values in
        [&mut kinematics.displacement, &mut kinematics.velocity, &mut kinematics.acceleration]
    {
        numbers.extend(values.iter_mut());
    }
    numbers.extend(free_field);
    for translation in &mut kinematics.translations {
        let Translation { displacement, increment, velocity, new_velocity, new_acceleration } =
            translation;
        for values in [displacement, increment, velocity, new_velocity, new_acceleration] {
            numbers.extend(values.iter_mut().take(component_count));
        }
    }
    let mut y_components = Vec::new();
    for ContactState { gap, slip, pressure, shear, slip_across, shear_across } in
        contact.iter_mut().chain(joint_contact)
    {
        numbers.extend([gap, slip, pressure, shear]);
        y_components.extend([slip_across, shear_across]);
    }
    numbers.extend(start.slip_rates_mut());
    for foundation in foundations {
        numbers.push(&mut foundation.rocking_work);
        y_components.push(&mut foundation.rocking_work_across);
    }
    if component_count == COMPONENTS_IN_SPACE {
        numbers.push(free_field_across);
        numbers.extend(y_components);
    }
    numbers.extend(energies.into_iter().flat_map(|energies| energies.numbers(component_count)));
    numbers
}
