//! Saving a run and going on with it later, to the last bit.

use super::ledger::Ledger;
use super::simulation::{Memory, Simulation};
use super::state::State;
use crate::error::{CheckpointError, Result};
use crate::interface::{ContactState, Mode, StepStart, law_of};

/// Format of [`Checkpoint`]; to be raised when the order of its numbers changes.
const FORMAT: u32 = 4;
/// Most steps that a checkpoint may stand for: more would not fit into any run.
const MOST_STEPS: usize = match 1_usize.checked_shl(47) {
    Some(steps) => steps,
    None => usize::MAX >> 4,
};
/// How far numbers of the same scene may be apart (other processors round differently).
const SAME: f64 = 1e-9;

/// A run between two steps: see [`Simulation::checkpoint`].
///
/// With the feature `serde` it can be written in any of serde's formats. Floating-point numbers
/// are written as their bits (integers of 64 bits), so that none is rounded on the way.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Checkpoint {
    format: u32,
    scene: Scene,
    steps: usize,
    /// Per element: which of its law's modes, and whether it has been open.
    modes: Vec<(usize, bool)>,
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    state: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    ground: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    structure: Vec<f64>,
}

/// What tells one scene from another.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Scene {
    unknowns: usize,
    probes: Vec<String>,
    /// Time step and coefficients of the scheme.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    steps: Vec<f64>,
    /// Ends of the elements.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    elements: Vec<f64>,
    /// Sums over the structure's matrices, and one that knows the signs of its modes.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    structure: Vec<f64>,
    /// Sum over the ground's instantaneous operator.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    ground: Vec<f64>,
    /// Sum over the static tractions.
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    preload: Vec<f64>,
}

impl Checkpoint {
    /// Steps made before it.
    pub fn steps(&self) -> usize {
        self.steps
    }
}

impl Scene {
    /// Error that names the first thing that differs.
    fn check(&self, own: &Self) -> std::result::Result<(), CheckpointError> {
        let close = |a: &[f64], b: &[f64], scale: f64| {
            let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * scale.max(b.abs());
            a.len() == b.len() && a.iter().zip(b).all(near)
        };
        let span = crate::linalg::largest(&own.elements);
        for (same, quantity) in [
            (self.unknowns == own.unknowns, "number of unknowns"),
            (close(&self.steps, &own.steps, 0.0), "time step or scheme"),
            (close(&self.elements, &own.elements, span), "list of contact elements"),
            (self.probes == own.probes, "list of probes"),
            (close(&self.structure, &own.structure, 0.0), "structure"),
            (close(&self.ground, &own.ground, 0.0), "ground"),
            (close(&self.preload, &own.preload, 0.0), "static state"),
        ] {
            if !same {
                return Err(CheckpointError::OtherScene { quantity });
            }
        }
        Ok(())
    }
}

impl Simulation {
    /// All that the steps so far have left behind, to be taken up by [`Simulation::resume`].
    ///
    /// Its size is that of the history: all tractions for exact histories, a few ten kilobytes for
    /// the exponentials.
    ///
    /// # Errors
    /// [`CheckpointError::Unsupported`] if the ground, its history or the structure cannot save its
    /// state.
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
        let (mut state, mut memory) = (self.state.clone(), self.memory.clone());
        let modes = self
            .start
            .iter()
            .enumerate()
            .map(|(e, start)| {
                let known = law_of(&self.laws, e).modes();
                let number = known.iter().position(|mode| *mode == start.mode);
                let unknown = CheckpointError::Unsupported { part: "interface law" };
                Ok((number.ok_or(unknown)?, start.has_opened))
            })
            .collect::<Result<Vec<_>>>()?;
        Ok(Checkpoint {
            format: FORMAT,
            scene: self.scene(),
            steps: state.step,
            modes,
            state: numbers(&mut state, &mut memory)
                .into_iter()
                .map(|value| *value)
                .chain(self.start.iter().map(|start| start.slip_rate))
                .collect(),
            ground: self.ground.save()?,
            structure: self.model.structure.save()?,
        })
    }

    /// Goes to where `checkpoint` was made, in a simulation that was built in the same way, and
    /// wherever this one is; what follows is the same to the last bit on the same processor.
    ///
    /// Sizes, time step, elements, probes, matrices and static state are compared. Loads, motion and laws
    /// are not, nor what a user's structure leaves out of what it [saves][`save`]. The
    /// transitions, trials and method of the step before the checkpoint are not kept.
    ///
    /// # Errors
    /// [`crate::Error::Checkpoint`] for a checkpoint of another scene, another format, or with
    /// numbers missing or not finite. The simulation is then as it was.
    ///
    /// [`save`]: crate::structure::Structure::save
    pub fn resume(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        if checkpoint.format != FORMAT {
            let found = checkpoint.format;
            return Err(CheckpointError::Format { found, needed: FORMAT }.into());
        }
        checkpoint.scene.check(&self.scene())?;
        let corrupt = |quantity| CheckpointError::Corrupt { quantity };
        if checkpoint.steps > MOST_STEPS {
            return Err(corrupt("number of steps").into());
        }
        for (values, quantity) in [
            (&checkpoint.state, "state"),
            (&checkpoint.ground, "state of the ground"),
            (&checkpoint.structure, "state of the structure"),
        ] {
            if values.iter().any(|value| !value.is_finite()) {
                return Err(corrupt(quantity).into());
            }
        }
        let (mut state, mut memory) = (self.state.clone(), self.memory.clone());
        let mut rates = vec![0.0; self.start.len()];
        let mut own = numbers(&mut state, &mut memory);
        own.extend(&mut rates);
        if own.len() != checkpoint.state.len() {
            return Err(corrupt("state").into());
        }
        own.into_iter().zip(&checkpoint.state).for_each(|(own, saved)| *own = *saved);
        let modes = self.modes_of(&checkpoint.modes)?;
        let before = self.model.structure.save()?;
        self.model.structure.restore(&checkpoint.structure)?;
        if let Err(error) = self.ground.restore(checkpoint.steps, &checkpoint.ground) {
            self.model.structure.restore(&before)?;
            return Err(error);
        }
        for (e, (start, (mode, has_opened))) in self.start.iter_mut().zip(modes).enumerate() {
            state.modes[e] = mode;
            let (state, slip_rate) = (state.contact[e], rates[e]);
            *start = StepStart { state, mode, has_opened, slip_rate, ..*start };
        }
        state.step = checkpoint.steps;
        state.time = state.step as f64 * self.time_step;
        state.transitions.clear();
        state.motion.changed();
        (self.state, self.memory) = (state, memory);
        self.update_resultants();
        Ok(())
    }

    /// Modes and whether elements have been open, from their numbers.
    fn modes_of(&self, saved: &[(usize, bool)]) -> Result<Vec<(Mode, bool)>> {
        let corrupt = CheckpointError::Corrupt { quantity: "contact modes" };
        if saved.len() != self.start.len() {
            return Err(corrupt.into());
        }
        let mode = |(e, &(number, has_opened)): (usize, &(usize, bool))| {
            let mode = law_of(&self.laws, e).modes().get(number).copied();
            Ok((mode.ok_or_else(|| corrupt.clone())?, has_opened))
        };
        saved.iter().enumerate().map(mode).collect()
    }

    fn scene(&self) -> Scene {
        let sum = |values: &[f64]| -> f64 { values.iter().map(|value| value.abs()).sum() };
        // Modes may come with either sign. A nonlinear structure has none, and columns that change.
        let columns = self.operators.columns.iter().enumerate().filter(|_| self.model.linear);
        let signed = columns.map(|(k, value)| (k as f64).cos() * value).sum();
        let c = self.coefficients;
        let mut steps = vec![self.time_step];
        for row in [c.acceleration, c.velocity, c.displacement] {
            steps.extend(row);
        }
        Scene {
            unknowns: self.model.unknowns,
            probes: self.probes.iter().map(|probe| probe.name.clone()).collect(),
            steps,
            elements: self.elements().iter().flat_map(|e| [e.left, e.right]).collect(),
            structure: vec![
                sum(self.model.mass.values()),
                sum(self.model.damping.values()),
                sum(self.model.stiffness.values()),
                signed,
            ],
            ground: vec![sum(&self.soil)],
            preload: vec![sum(&self.static_state.traction)],
        }
    }
}

/// Every number that a step leaves to the next, always in this order.
fn numbers<'a>(state: &'a mut State, memory: &'a mut Memory) -> Vec<&'a mut f64> {
    let Memory {
        ride_velocity,
        ride_acceleration,
        start_motion: _,
        free_field,
        soil_displacement,
        jump,
        nonlinear_work,
    } = memory;
    let Ledger {
        kinetic,
        strain,
        hysteresis,
        damping,
        numerical,
        soil,
        contact,
        layer,
        preload,
        input,
        soil_error_bound,
    } = &mut state.ledger;
    let mut all = vec![nonlinear_work, kinetic, strain, damping, numerical, soil, contact];
    all.extend([layer, preload, input, soil_error_bound, hysteresis]);
    all.extend(ride_velocity.iter_mut().chain(ride_acceleration).chain(&mut state.free_field));
    let motion = &mut state.motion;
    for values in [&mut motion.displacement, &mut motion.velocity, &mut motion.acceleration] {
        all.extend(values.iter_mut());
    }
    for values in [free_field, soil_displacement, jump] {
        all.extend(values.iter_mut());
    }
    for ContactState { gap, slip, pressure, shear } in &mut state.contact {
        all.extend([gap, slip, pressure, shear]);
    }
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
