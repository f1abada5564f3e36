//! Checkpoints: saving a run and resuming it later, to the last bit.

use super::energy_accumulator::EnergyAccumulator;
use super::energy_balance::EnergyBalance;
use super::motion::Translation;
use super::scene::Scene;
use super::state::State;
use crate::Simulation;
use crate::contact::SearchMethod;
use crate::error::{CheckpointError, Result};
use crate::geometry::SPACE;
use crate::interface::{ContactState, Mode, PreviousContact};
use crate::structure::{restore_variables, save_variables};
use crate::text::check_sum::CheckSum;

/// Format of [`Checkpoint`]; to be raised when the order of its numbers changes.
const FORMAT: u32 = 8;
/// Most steps that a checkpoint may stand for: more would not fit into any run.
const MOST_STEPS: usize = match 1_usize.checked_shl(47) {
    Some(steps) => steps,
    None => usize::MAX >> 4,
};
/// Allowed difference of numbers of the same scene (other processors round differently).
const SAME: f64 = 1e-9;

/// A run between two steps: see [`Simulation::checkpoint`](crate::Simulation::checkpoint).
///
/// With the feature `serde` it can be written in any of serde's formats. Floating-point numbers
/// are written as their bits (integers of 64 bits), so that none is rounded on the way, and a check
/// sum over all contents goes with them: [`Simulation::resume`](crate::Simulation::resume) returns an error for
/// whatever has been changed since.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Checkpoint {
    format: u32,
    identity: Identity,
    steps: usize,
    /// Number of each element's mode among those of its law, and whether the element has been open.
    modes: Vec<(usize, bool)>,
    /// State variables of the laws of all elements.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    laws: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    state: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    ground: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    structure: Vec<f64>,
    /// Check sum over all of the above; checkpoints of formats before the eighth have none.
    #[cfg_attr(feature = "serde", serde(default))]
    sum: u64,
}

/// Numbers that differ between scenes.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
struct Identity {
    dofs: usize,
    /// Whether an energy balance is kept.
    energy_balance: bool,
    probes: Vec<String>,
    /// Ends of the state variables of each element's law; empty if no law has any.
    laws: Vec<usize>,
    /// Time step and coefficients of the scheme.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    steps: Vec<f64>,
    /// Ends of the elements.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    elements: Vec<f64>,
    /// Sums over the structure's matrices, and one that depends on the signs of its modes.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    structure: Vec<f64>,
    /// Sum over the ground's step compliance.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    ground: Vec<f64>,
    /// Sum over the static tractions.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    static_contact: Vec<f64>,
}

impl Checkpoint {
    /// Steps made before the checkpoint.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Check sum over all contents, field by field.
    fn sum(&self) -> u64 {
        let Self { format, identity, steps, modes, laws, state, ground, structure, sum: _ } = self;
        let mut sum = CheckSum::default();
        sum.add(u64::from(*format));
        identity.add_to(&mut sum);
        sum.add(*steps as u64);
        sum.add(modes.len() as u64);
        for (mode, has_opened) in modes {
            sum.add(*mode as u64);
            sum.add(u64::from(*has_opened));
        }
        for list in [laws, state, ground, structure] {
            sum.add_numbers(list);
        }
        sum.value()
    }
}

impl Identity {
    fn add_to(&self, sum: &mut CheckSum) {
        let Self {
            dofs,
            energy_balance,
            probes,
            laws,
            steps,
            elements,
            structure,
            ground,
            static_contact,
        } = self;
        sum.add(*dofs as u64);
        sum.add(u64::from(*energy_balance));
        sum.add(probes.len() as u64);
        for name in probes {
            sum.add_text(name);
        }
        sum.add_list(laws.iter().map(|end| *end as u64));
        for list in [steps, elements, structure, ground, static_contact] {
            sum.add_numbers(list);
        }
    }

    /// Error that names the first thing that differs.
    fn check(&self, own: &Self) -> std::result::Result<(), CheckpointError> {
        let close = |a: &[f64], b: &[f64], scale: f64| {
            let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * scale.max(b.abs());
            a.len() == b.len() && a.iter().zip(b).all(near)
        };
        let span = crate::linalg::largest(&own.elements);
        for (same, quantity) in [
            (self.dofs == own.dofs, "number of degrees of freedom"),
            (close(&self.steps, &own.steps, 0.0), "time step or scheme"),
            (close(&self.elements, &own.elements, span), "list of contact elements"),
            (self.energy_balance == own.energy_balance, "energy balance"),
            (self.probes == own.probes, "list of probes"),
            (self.laws == own.laws, "state variables of the interface laws"),
            (close(&self.structure, &own.structure, 0.0), "structure"),
            (close(&self.ground, &own.ground, 0.0), "ground"),
            (close(&self.static_contact, &own.static_contact, 0.0), "static state"),
        ] {
            if !same {
                return Err(CheckpointError::OtherScene { quantity });
            }
        }
        Ok(())
    }
}

impl Simulation {
    /// Saves the state of the run, to be restored by [`Simulation::resume`].
    ///
    /// Its size is that of the history: all tractions for exact histories, those of two windows at
    /// most for the exponentials.
    ///
    /// # Errors
    /// [`CheckpointError::Unsupported`](crate::CheckpointError::Unsupported) if the ground, its history or the
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
    /// let saved: Checkpoint = simulation.checkpoint()?;
    /// simulation.run(100, |_| {})?;
    ///
    /// let mut other = scene()?;
    /// other.resume(&saved)?;
    /// assert_eq!(other.state().step, 200);
    /// other.run(100, |_| {})?;
    /// assert_eq!(other.state(), simulation.state());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn checkpoint(&self) -> Result<Checkpoint> {
        let Self { scene, state, .. } = self;
        let number = |(e, start): (usize, PreviousContact<'_>)| {
            let known = modes_of(scene, e);
            let number = known.iter().position(|mode| *mode == start.mode);
            let unknown = CheckpointError::Unsupported { part: "interface law" };
            Ok((number.ok_or(unknown)?, start.has_opened))
        };
        let (mut own, mut books) = (state.clone(), self.books.clone());
        let numbers = numbers(scene.layout().components(), &mut own, books.as_mut());
        let mut checkpoint = Checkpoint {
            format: FORMAT,
            identity: self.identity(),
            steps: state.step,
            modes: state.start.iter().enumerate().map(number).collect::<Result<_>>()?,
            laws: state.start.state_variables().to_vec(),
            state: numbers.into_iter().map(|value| *value).collect(),
            ground: self.ground.save()?,
            structure: save_variables(self.structure.as_ref())?,
            sum: 0,
        };
        checkpoint.sum = checkpoint.sum();
        Ok(checkpoint)
    }

    /// Goes to where `checkpoint` was made, in a simulation that was built in the same way, and
    /// wherever this one is; what follows is the same to the last bit on the same processor.
    ///
    /// Sizes, time step, elements, probes, matrices and static state are compared. Loads, initial and ground motion,
    /// gravity and laws are not, nor what a user's structure leaves out of what it [saves][`save`]. The transitions,
    /// trials and method of the step before the checkpoint are not kept.
    ///
    /// # Errors
    /// [`crate::Error::Checkpoint`] for a checkpoint of another scene, another format, or with
    /// numbers missing or not finite. The simulation is then as it was.
    ///
    /// [`save`]: crate::structure::NonlinearForce::save
    pub fn resume(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        if checkpoint.format != FORMAT {
            let found = checkpoint.format;
            return Err(CheckpointError::Format { found, needed: FORMAT }.into());
        }
        if checkpoint.sum != checkpoint.sum() {
            return Err(CheckpointError::Damaged.into());
        }
        checkpoint.identity.check(&self.identity())?;
        let corrupt = |quantity| CheckpointError::Corrupt { quantity };
        if checkpoint.steps > MOST_STEPS {
            return Err(corrupt("number of steps").into());
        }
        for (values, quantity) in [
            (&checkpoint.laws, "state variables of the interface laws"),
            (&checkpoint.state, "state"),
            (&checkpoint.ground, "state of the ground"),
            (&checkpoint.structure, "state of the structure"),
        ] {
            if values.iter().any(|value| !value.is_finite()) {
                return Err(corrupt(quantity).into());
            }
        }
        let (scene, structure) = (&self.scene, self.structure.as_mut());
        let (mut state, mut books) = (self.state.clone(), self.books.clone());
        let own = numbers(scene.layout().components(), &mut state, books.as_mut());
        if own.len() != checkpoint.state.len() {
            return Err(corrupt("state").into());
        }
        own.into_iter().zip(&checkpoint.state).for_each(|(own, saved)| *own = *saved);
        restore_modes(scene, &checkpoint.modes, &mut state)?;
        let laws = state.start.state_variables_mut();
        if laws.len() != checkpoint.laws.len() {
            return Err(corrupt("state variables of the interface laws").into());
        }
        laws.copy_from_slice(&checkpoint.laws);
        let before = save_variables(structure)?;
        restore_variables(structure, &checkpoint.structure)?;
        if let Err(error) = self.ground.restore(checkpoint.steps, &checkpoint.ground) {
            restore_variables(structure, &before)?;
            return Err(error);
        }
        // From here on nothing fails.
        state.step = checkpoint.steps;
        state.time = state.step as f64 * scene.time_step;
        (state.trials, state.method) = (0, SearchMethod::ActiveSet);
        state.transitions.clear();
        state.motion.changed();
        state.energy_balance =
            books.as_ref().map_or(EnergyBalance::LEFT_OUT, |books| books.energy_balance);
        state.update_resultants(scene);
        (self.state, self.books) = (state, books);
        self.scene.loads.iter_mut().for_each(|load| load.set(None));
        Ok(())
    }

    /// Numbers that another simulation of the same scene has too.
    fn identity(&self) -> Identity {
        let Self { scene, state, .. } = self;
        let sum = |values: &[f64]| -> f64 { values.iter().map(|value| value.abs()).sum() };
        let model = &scene.model;
        // Modes may come with either sign. A nonlinear structure has none, and columns that change.
        let columns = self.solver.operators().columns.iter().enumerate().filter(|_| model.linear);
        let signed = columns.map(|(k, value)| (k as f64).cos() * value).sum();
        let c = scene.coefficients;
        let mut steps = vec![scene.time_step];
        for row in [c.acceleration, c.velocity, c.displacement] {
            steps.extend(row);
        }
        let mut elements: Vec<f64> =
            scene.base.elements().iter().flat_map(|e| [e.left, e.right]).collect();
        if scene.layout().is_plan() {
            elements.extend(scene.base.elements().depths().iter().flatten());
        }
        Identity {
            dofs: model.dofs,
            energy_balance: self.books.is_some(),
            probes: scene.context.probes.iter().map(|probe| probe.name.clone()).collect(),
            laws: state.start.state_variable_ends().to_vec(),
            steps,
            elements,
            structure: vec![
                sum(model.mass.values()),
                sum(model.damping.values()),
                sum(model.stiffness.values()),
                signed,
            ],
            ground: vec![sum(&scene.soil)],
            // The weight is none of the static state where it acts as a load.
            static_contact: [&scene.static_state.traction, &scene.weight]
                .map(|values| sum(values))
                .to_vec(),
        }
    }
}

/// Modes by their numbers: those of an element's law, or in plan all.
fn modes_of(scene: &Scene, element: usize) -> &[Mode] {
    if scene.layout().is_plan() { &Mode::ALL } else { scene.law(element).modes() }
}

/// Takes over modes and whether elements have been open, from their numbers.
fn restore_modes(scene: &Scene, saved: &[(usize, bool)], state: &mut State) -> Result<()> {
    let corrupt = CheckpointError::Corrupt { quantity: "contact modes" };
    if saved.len() != scene.count() {
        return Err(corrupt.into());
    }
    for (e, &(number, has_opened)) in saved.iter().enumerate() {
        let mode = modes_of(scene, e).get(number).copied().ok_or_else(|| corrupt.clone())?;
        state.modes[e] = mode;
        state.start.restore(e, state.contact[e], mode, has_opened);
    }
    Ok(())
}

/// Every number that a step leaves to the next, for two or three directions, always in this order.
fn numbers<'a>(
    directions: usize,
    state: &'a mut State,
    books: Option<&'a mut EnergyAccumulator>,
) -> Vec<&'a mut f64> {
    let mut all = Vec::new();
    let State { motion, contact, start, free_field, free_field_across, .. } = state;
    for values in [&mut motion.displacement, &mut motion.velocity, &mut motion.acceleration] {
        all.extend(values.iter_mut());
    }
    all.extend(free_field);
    for translation in &mut motion.translations {
        let Translation { displacement, increment, velocity, new_velocity, new_acceleration } =
            translation;
        for values in [displacement, increment, velocity, new_velocity, new_acceleration] {
            all.extend(values.iter_mut().take(directions));
        }
    }
    let mut across = Vec::new();
    for ContactState { gap, slip, pressure, shear, slip_across, shear_across } in contact {
        all.extend([gap, slip, pressure, shear]);
        across.extend([slip_across, shear_across]);
    }
    all.extend(start.slip_rates_mut());
    if directions == SPACE {
        all.push(free_field_across);
        all.extend(across);
    }
    all.extend(books.into_iter().flat_map(|books| books.numbers(directions)));
    all
}

/// Floating-point numbers as their bits.
#[cfg(feature = "serde")]
mod bits {
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(values: &[f64], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(values.iter().map(|value| value.to_bits()))
    }

    pub(super) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Vec<f64>, D::Error> {
        let bits = Vec::<u64>::deserialize(from)?;
        Ok(bits.into_iter().map(f64::from_bits).collect())
    }
}
