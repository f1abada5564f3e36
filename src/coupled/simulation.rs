//! The simulation: the loop over steps, and the return values of its observers.

use std::ops::ControlFlow;

use crate::bem::Ground;
use crate::coupled::base::fixed_base::{into_structure, is_fixed_base, without_rigid_foundations};
use crate::coupled::conditioning::Conditioning;
use crate::coupled::run::Run;
use crate::coupled::run::resolution::Resolution;
use crate::coupled::run::warning::Warning;
use crate::coupled::scene::Scene;
use crate::coupled::state::State;
use crate::coupled::step::energy_accumulator::EnergyAccumulator;
use crate::coupled::step::forcing::{Forcing, StepData};
use crate::coupled::step::increment::Increment;
use crate::coupled::step::joint_losses::JointLosses;
use crate::coupled::step::solver::StepSolver;
use crate::error::{Error, Result, StepError, in_bounds, unobserved};
use crate::geometry::Patch;
use crate::interface::Mode;
use crate::motion::FreeField;
use crate::structure::{Probe, Structure};

/// Relative rounding error of a number of steps that must not add a step.
const STEP_COUNT_TOLERANCE: f64 = 1e-12;

/// A structure on a ground, ready for time steps.
///
/// [`Simulation::builder`] makes it. Write your own loop with [`step`](Simulation::step), or use
/// [`run`](Simulation::run).
pub struct Simulation {
    pub(crate) scene: Scene,
    pub(crate) structure: Box<dyn Structure>,
    pub(crate) ground: Box<dyn Ground>,
    pub(crate) motion: Box<dyn FreeField>,
    pub(crate) forcing: Forcing,
    pub(crate) solver: StepSolver,
    pub(crate) increment: Increment,
    /// The energy balance; `None` if it is omitted.
    pub(crate) energies: Option<EnergyAccumulator>,
    pub(crate) state: State,
    pub(crate) conditioning: Conditioning,
    /// Warnings of the scene and of the steps so far.
    pub(crate) warnings: Vec<Warning>,
    /// Pressure of the soil above each element of unlimited walls, Pa, else infinite.
    pub(crate) pressures_above: Vec<f64>,
    /// Damping of a rigid translation along the ground over the moving mass, 1/s.
    pub(crate) translation_damping_rate: f64,
    /// Rotation of a base at which a run ends, rad.
    pub(crate) rotation_limit: f64,
    /// Expected number of steps; zero if unknown.
    pub(crate) expected_steps: usize,
    /// Number of steps for which the ground is prepared; zero if no end is known.
    pub(crate) prepared_steps: usize,
}

short_debug! {
    Simulation;
    self;
    dofs: self.scene.model.dofs,
    elements: self.scene.element_count(),
    time_step: self.scene.time_step,
    step: self.state.step,
    time: self.state.time,
}

impl Simulation {
    /// Makes one step and returns the new state.
    ///
    /// # Errors
    /// [`Error::Step`] if the step could not be solved; the simulation then stays unchanged.
    pub fn step(&mut self) -> Result<&State> {
        let step = self.state.step + 1;
        let time = step as f64 * self.scene.time_step;
        self.solve(time).map_err(|source| Error::Step { step, time, source })?;
        // From here on no error can occur.
        let Self { scene, structure, ground, forcing, increment, state, warnings, .. } = self;
        if let Some(friction) = increment.substituted_friction {
            Warning::count_substituted_friction(warnings, friction);
        }
        if let Some(energies) = &mut self.energies {
            let data = StepData { scene, structure: structure.as_ref(), state, forcing };
            energies.accumulate(data, ground.as_ref(), increment);
            state.energy_balance = energies.energy_balance;
            JointLosses::set(Some(&energies.joint_losses), state);
        }
        state.advance(scene, forcing, increment);
        increment.set_ground_traction(scene, &forcing.free_traction);
        scene.base.elements().spread_inside(&mut increment.spread_traction);
        ground.commit(&increment.spread_traction);
        if let Some(force) = structure.nonlinear_mut() {
            force.commit(&increment.force_displacement);
        }
        Ok(&self.state)
    }

    /// Computes free field, convolution history and increment, without committing them.
    fn solve(&mut self, time: f64) -> std::result::Result<(), StepError> {
        let Self { scene, structure, ground, motion, forcing, solver, increment, state, .. } = self;
        let structure = structure.as_ref();
        forcing.update(scene, state, structure, ground.as_mut(), motion.as_ref(), time)?;
        solver.solve(StepData { scene, structure, state, forcing }, increment)?;
        Ok(increment.evaluate_laws(scene, state)?)
    }

    /// The state after the last accepted step; at first the static state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The time step, s.
    pub fn time_step(&self) -> f64 {
        self.scene.time_step
    }

    /// The contact elements, from left to right.
    pub(crate) fn elements(&self) -> &Patch {
        self.scene.base.elements()
    }

    /// The structure in its present state, with internal variables.
    ///
    /// It is [`Any`](std::any::Any). Downcast it to the type that the builder received (to `Box<…>` for a box).
    ///
    /// ```
    /// use std::any::Any;
    ///
    /// use basemat::Simulation;
    /// use basemat::bem::SpringGround;
    /// use basemat::interface::Bonded;
    /// use basemat::structure::RigidBlock;
    ///
    /// let simulation = Simulation::builder(0.01)
    ///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    ///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///     .interface(Bonded)
    ///     .build()?;
    /// assert_eq!(simulation.structure().dofs(), 3);
    /// let structure: &dyn Any = simulation.structure();
    /// let block = structure.downcast_ref::<RigidBlock>();
    /// assert!(block.is_some_and(|block| block.total_mass() == 48.0e3));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn structure(&self) -> &dyn Structure {
        without_rigid_foundations(self.structure.as_ref())
    }

    /// Returns the structure of the builder by value, in its present state.
    pub fn into_structure(self) -> Box<dyn Structure> {
        into_structure(self.structure)
    }

    /// The ground in its present state.
    ///
    /// The ground is [`Any`](std::any::Any). Downcast it to the type that the builder received (to `Box<…>` for a box).
    ///
    /// ```
    /// use std::any::Any;
    ///
    /// use basemat::Simulation;
    /// use basemat::bem::SpringGround;
    /// use basemat::interface::Bonded;
    /// use basemat::structure::RigidBlock;
    ///
    /// let simulation = Simulation::builder(0.01)
    ///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    ///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///     .interface(Bonded)
    ///     .build()?;
    /// assert_eq!(simulation.ground().elements().len(), 8);
    /// let ground: &dyn Any = simulation.ground();
    /// assert!(ground.is::<SpringGround>());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn ground(&self) -> &dyn Ground {
        self.ground.as_ref()
    }

    /// Sets the force of load number `index` for all further steps.
    ///
    /// Loads are numbered from 0, in the order of the builder.
    ///
    /// `value` is the whole force, including the static force. It replaces the load's function of time; `None` restores
    /// that function. A controller computes the force from the last state and sets it before each step:
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::{Load, Probe};
    /// use basemat::interface::Bonded;
    /// use basemat::motion::el_centro_1940;
    /// use basemat::structure::{ShearBuilding, Storey};
    /// use basemat::{Result, Simulation};
    ///
    /// // At a velocity of 1 m/s of the roof relative to the base the controller applies 800 kN/m against it.
    /// let largest_drift = |gain: f64| -> Result<f64> {
    ///     let building =
    ///         ShearBuilding::new(8.0, 50.0e3, 4.0e5, &[Storey::new(3.0, 20.0e3, 20.0e6); 4])?;
    ///     let drift = building.total_drift(3)?;
    ///     let mut simulation = Simulation::builder(0.005)
    ///         .ground(SpringGround::under(&building, 8, 4e7, 3e7)?)
    ///         .interface(Bonded)
    ///         .motion(el_centro_1940())
    ///         .probe(Probe::velocity("drift", drift.clone()))
    ///         .probe(Probe::displacement("total drift", drift.clone()))
    ///         .load(Load::constant(drift, 0.0))
    ///         .structure(building)
    ///         .build()?;
    ///     let mut run = simulation.begin_run();
    ///     for _ in 0..1000 {
    ///         let velocity = simulation.state().probes[0];
    ///         simulation.set_load(0, -gain * velocity)?;
    ///         run.record(simulation.step()?);
    ///     }
    ///     Ok(run.probe("total drift")?.magnitude())
    /// };
    /// assert!(largest_drift(800.0e3)? < 0.8 * largest_drift(0.0)?);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// A checkpoint contains the value. [`resume_changed`](Simulation::resume_changed) with
    /// [`Change::Load`](crate::coupled::Change::Load) restores the function of every load.
    ///
    /// # Errors
    /// [`Error::Index`] for a load that does not exist, [`Error::NotFinite`] for a value that is not finite.
    pub fn set_load(&mut self, index: usize, value: impl Into<Option<f64>>) -> Result<()> {
        let value = value.into();
        in_bounds("load", index, self.scene.loads.len())?;
        if let Some(value) = value.filter(|value| !value.is_finite()) {
            return Err(Error::NotFinite { quantity: "external load", index, value });
        }
        self.scene.loads[index].set(value);
        Ok(())
    }

    /// The probes, in the order of [`State::probes`].
    pub fn probes(&self) -> &[Probe] {
        &self.scene.context.probes
    }

    /// Static displacement of the degrees of freedom, m and rad.
    ///
    /// Weight and loads at t = 0 cause it. On a half-plane its rigid settlement has no meaning, since the half-plane has
    /// no datum in two dimensions.
    pub fn static_displacement(&self) -> &[f64] {
        &self.scene.static_state.displacement
    }

    /// Number of steps for `duration` (s), rounded up; zero for a negative duration or NaN.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn steps_for(&self, duration: f64) -> usize {
        (duration / self.scene.time_step * (1.0 - STEP_COUNT_TOLERANCE)).ceil() as usize
    }

    /// Makes up to `steps` steps, calling `observe` after each with the new state.
    ///
    /// `observe` may return nothing, [`ControlFlow`] to stop early, or a [`Result`] of either: see [`Observed`].
    /// It may pass the state to a [`TimeSeries`](crate::results::TimeSeries), and to a [`Run`] that spans several calls
    /// or is needed after a failed step ([`Simulation::begin_run`]).
    ///
    /// The run ends after the step in which a base exceeds the
    /// [`rotation_limit`](crate::coupled::SimulationBuilder::rotation_limit), with [`Warning::Overturned`]; a
    /// further call continues from there. Missing convolution weights are computed before the first step, without
    /// an observer. [`Simulation::prepare`] computes them with an observer.
    ///
    /// The division of steps into runs does not change the results, to the last bit, up to 2²⁰ steps or the
    /// [expected](crate::coupled::SimulationBuilder::expected_steps) number. Use [`usize::MAX`] steps for a run that
    /// only `observe` ends. Nothing is then prepared.
    ///
    /// # Errors
    /// [`Error::Memory`] before the first step, for more steps than fit into the memory of the ground's history;
    /// [`crate::Error::Step`] for a step that could not be solved, or the observer's error. The simulation stays
    /// at the last accepted step, which [`Simulation::state`] returns.
    pub fn run<R: Observed>(
        &mut self,
        steps: usize,
        mut observe: impl FnMut(&State) -> R,
    ) -> Result<Run> {
        self.prepare(steps, &mut unobserved)?;
        let mut run = self.begin_run();
        for _ in 0..steps {
            let was_within_limit = self.state.tilt() <= self.rotation_limit;
            self.step()?;
            run.record(&self.state);
            run.is_overturned = was_within_limit && self.state.tilt() > self.rotation_limit;
            if observe(&self.state).flow()? == ControlFlow::Break(()) || run.is_overturned {
                return Ok(self.end_run(run));
            }
        }
        run.ends_by_steps = self.state.step >= self.expected_steps;
        Ok(self.end_run(run))
    }

    /// Starts an empty run at the present state, for a loop of your own.
    ///
    /// Call [`Run::record`] after every step and [`Simulation::end_run`] at the end for the result of
    /// [`Simulation::run`]. An observer may record a run over several calls of [`Simulation::run`].
    ///
    /// ```
    /// use basemat::bem::SpringGround;
    /// use basemat::interface::Coulomb;
    /// use basemat::motion::el_centro_1940;
    /// use basemat::structure::RigidBlock;
    /// use basemat::Simulation;
    ///
    /// let mut simulation = Simulation::builder(0.01)
    ///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
    ///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
    ///     .interface(Coulomb::new(0.4)?)
    ///     .motion(el_centro_1940())
    ///     .build()?;
    /// let mut run = simulation.begin_run();
    /// while simulation.state().time < 3.0 {
    ///     run.record(simulation.step()?);
    /// }
    /// let run = simulation.end_run(run);
    /// assert_eq!(run.steps, 300);
    /// assert!(run.energy_error < 1e-9);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn begin_run(&self) -> Run {
        let shear_wave_speed = self.ground.description().shear_wave_speed;
        let resolution = Resolution::new(self.scene.time_step, shear_wave_speed, &self.state);
        Run::start(&self.state, &self.scene.serviceability, resolution)
    }

    /// Completes a run of this simulation with its warnings and wall time.
    pub fn end_run(&self, mut run: Run) -> Run {
        // On a fixed base, tension is allowed.
        let is_fixed = is_fixed_base(self.ground.as_ref());
        run.finish(
            self.ground.as_ref(),
            self.motion.as_ref(),
            |element| is_fixed || self.scene.law(element).modes().contains(&Mode::Open),
            &self.warnings,
            &self.pressures_above,
            self.translation_damping_rate,
            self.rotation_limit,
        );
        run
    }

    /// Condition numbers of the matrices of a step, estimated when the simulation was built.
    pub fn conditioning(&self) -> Conditioning {
        self.conditioning
    }
}

/// Return value of an observer of [`Simulation::run`](crate::Simulation::run).
///
/// Nothing, [`ControlFlow`] to stop after a step, or a [`Result`] of either, whose error ends the run.
///
/// ```
/// use std::ops::ControlFlow::{Break, Continue};
///
/// use basemat::bem::SpringGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::RigidBlock;
/// use basemat::{Error, Simulation};
///
/// let mut simulation = Simulation::builder(0.01)
///     .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
///     .ground(SpringGround::new(-2.0..2.0, 8, 2e7, 1e7)?)
///     .interface(Coulomb::new(0.4)?)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(500, |state| {
///     if state.uplifted_fraction > 0.2 { Break(()) } else { Continue(()) }
/// })?;
/// assert!(run.steps < 500);
/// let result = simulation.run(500, |_| Err::<(), _>(Error::part("observer", "stops the run")));
/// assert!(result.is_err());
/// # Ok::<(), Error>(())
/// ```
pub trait Observed {
    /// Whether the run continues.
    ///
    /// # Errors
    /// Any error of the observer.
    fn flow(self) -> Result<ControlFlow<()>>;
}

impl Observed for () {
    fn flow(self) -> Result<ControlFlow<()>> {
        Ok(ControlFlow::Continue(()))
    }
}

impl Observed for ControlFlow<()> {
    fn flow(self) -> Result<ControlFlow<()>> {
        Ok(self)
    }
}

impl<T: Observed> Observed for std::result::Result<T, Error> {
    fn flow(self) -> Result<ControlFlow<()>> {
        self.and_then(Observed::flow)
    }
}
