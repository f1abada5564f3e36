//! The simulation: its parts, its state, and the loop over steps.

use super::base::Base;
use super::builder::SimulationBuilder;
use super::conditioning::Conditioning;
use super::contact::ContactSolver;
use super::coordinates::{Motion, SteppedRow};
use super::ledger::Ledger;
use super::model::Model;
use super::modes::{ContactSearch, ModeSearch, SearchMethod};
use super::operators::Operators;
use super::preload::StaticState;
use super::probe::Probe;
use super::run::{Flow, Run};
use super::scheme::SchemeCoefficients;
use super::state::{Foundation, State};
use crate::bem::full_plane::GroundStability;
use crate::bem::{ContactElement, Ground, HistoryChoice};
use crate::error::Result;
use crate::interface::{ContactState, InterfaceLaw, StepStart, law_of};
use crate::linalg::SparseMatrix;
use crate::motion::FreeField;
use crate::structure::{InternalEnergy, Structure};

/// A structure on a ground, ready to march.
///
/// Made by [`Simulation::builder`]. The caller may own the loop ([`step`](Simulation::step)) or hand
/// it over ([`run`](Simulation::run)).
pub struct Simulation {
    pub(super) time_step: f64,
    pub(super) model: Model,
    pub(super) ground: Box<dyn Ground>,
    pub(super) base: Base,
    pub(super) laws: Vec<Box<dyn InterfaceLaw>>,
    pub(super) motion: Box<dyn FreeField>,
    pub(super) coefficients: SchemeCoefficients,
    /// Whether any law stores energy in its elements.
    pub(super) compliant: bool,
    /// Whether the scheme takes no energy of its own.
    pub(super) conserves_energy: bool,
    pub(super) static_state: StaticState,
    pub(super) static_load: Vec<f64>,
    /// f(u) at the static state, nonlinear structures only.
    pub(super) static_force: Vec<f64>,
    /// Its energies there, where the structure knows them.
    pub(super) static_energy: Option<InternalEnergy>,
    /// Instantaneous operator of the ground, 2Q × 2Q.
    pub(super) soil: Vec<f64>,
    pub(super) operators: Operators,
    pub(super) probes: Vec<Probe>,
    /// Displacement, velocity and acceleration of each probe.
    pub(super) probe_rows: Vec<[SteppedRow; 3]>,
    /// Element midpoints relative to the point of the base moment.
    pub(super) arms: Vec<f64>,
    pub(super) solver: ContactSolver,
    pub(super) search: ModeSearch,
    pub(super) start: Vec<StepStart>,
    pub(super) memory: Memory,
    pub(super) work: Workspace,
    pub(super) state: State,
    pub(super) conditioning: Conditioning,
    /// Lengths of the elements, for [`Run`]'s warnings.
    elements: Vec<ContactElement>,
}

short_debug! {
    Simulation;
    self;
    unknowns: self.model.unknowns,
    elements: self.elements.len(),
    time_step: self.time_step,
    step: self.state.step,
    time: self.state.time,
}

/// Longest run that is prepared for at once; in longer ones, memory grows as they go.
const RESERVED_STEPS: usize = 100_000;

/// What one step needs of the one before, besides the public state.
#[derive(Clone)]
pub(super) struct Memory {
    /// Mean velocity and acceleration of the free field, as the time scheme sees them.
    pub(super) ride_velocity: [f64; 2],
    pub(super) ride_acceleration: [f64; 2],
    /// Free field at t = 0, from which it is measured.
    pub(super) start_motion: Vec<f64>,
    /// Free field, soil displacement by tractions, and jump at the end of the last step, 2Q each.
    pub(super) free_field: Vec<f64>,
    pub(super) soil_displacement: Vec<f64>,
    pub(super) jump: Vec<f64>,
    /// Work of the nonlinear internal force so far; what it stores, where that is known.
    pub(super) nonlinear_work: f64,
}

/// Scratch of a step: nothing in it outlives the step.
pub(super) struct Workspace {
    pub(super) free_field: Vec<f64>,
    pub(super) history: Vec<f64>,
    pub(super) free_jump: Vec<f64>,
    pub(super) means: Vec<f64>,
    pub(super) soil_displacement: Vec<f64>,
    pub(super) modes: Vec<crate::interface::Mode>,
    pub(super) load: Vec<f64>,
    pub(super) known: Vec<f64>,
    pub(super) increment: Vec<f64>,
    pub(super) new_velocity: Vec<f64>,
    pub(super) new_acceleration: Vec<f64>,
    pub(super) vector: Vec<f64>,
    pub(super) force: Vec<f64>,
    pub(super) total: Vec<f64>,
    /// Newton's iterate and its linearised force.
    pub(super) guess: Vec<f64>,
    pub(super) linearised: Vec<f64>,
    pub(super) tangent: SparseMatrix,
}

pub(super) struct Parts {
    pub(super) time_step: f64,
    pub(super) model: Model,
    pub(super) ground: Box<dyn Ground>,
    pub(super) base: Base,
    pub(super) laws: Vec<Box<dyn InterfaceLaw>>,
    pub(super) search: ContactSearch,
    pub(super) motion: Box<dyn FreeField>,
    pub(super) coefficients: SchemeCoefficients,
    pub(super) static_state: StaticState,
    pub(super) static_load: Vec<f64>,
    pub(super) soil: Vec<f64>,
    pub(super) operators: Operators,
    pub(super) probes: Vec<Probe>,
    pub(super) arms: Vec<f64>,
    pub(super) start_motion: Vec<f64>,
}

impl Simulation {
    /// Begins a simulation with steps of `time_step` seconds.
    pub fn builder(time_step: f64) -> SimulationBuilder {
        SimulationBuilder::new(time_step)
    }

    pub(super) fn assemble(parts: Parts) -> Self {
        let (n, count) = (parts.model.unknowns, parts.base.lengths().len());
        let size = 2 * count;
        let at = &parts.static_state;
        let contact: Vec<_> = (0..count)
            .map(|e| ContactState {
                gap: at.gap[e],
                slip: 0.0,
                pressure: at.traction[e],
                shear: at.traction[count + e],
            })
            .collect();
        let law = |e: usize| law_of(&parts.laws, e);
        // Whatever the placement did, what touches sticks from now on.
        let modes: Vec<_> = (0..count)
            .map(|e| {
                let known = law(e).modes();
                if known.contains(&at.modes[e]) && !at.modes[e].is_closed() {
                    at.modes[e]
                } else {
                    known[0]
                }
            })
            .collect();
        let start =
            (0..count).map(|e| StepStart::new(contact[e], modes[e], parts.time_step)).collect();
        let mut jump = at.gap.clone();
        jump.resize(size, 0.0);
        let (static_force, static_energy) = parts.model.nonlinear_state(&at.displacement);
        let elements = parts.ground.elements().to_vec();
        let modes_of = parts.model.modes.as_deref();
        let rows = |p: &Probe| p.rows().map(|row| SteppedRow::new(row.terms(), modes_of));
        let probe_rows = parts.probes.iter().map(rows).collect();
        let mut simulation = Self {
            time_step: parts.time_step,
            coefficients: parts.coefficients,
            compliant: parts
                .laws
                .iter()
                .any(|law| law.modes().iter().any(|&mode| law.compliance(mode) != [0.0; 2])),
            conserves_energy: parts.coefficients.conserves_energy(parts.time_step),
            static_load: parts.static_load,
            static_force,
            static_energy,
            soil: parts.soil,
            operators: parts.operators,
            arms: parts.arms,
            solver: ContactSolver::new(count),
            search: ModeSearch::new(count, parts.search),
            start,
            memory: Memory {
                ride_velocity: [0.0; 2],
                ride_acceleration: [0.0; 2],
                start_motion: parts.start_motion,
                free_field: vec![0.0; size],
                soil_displacement: vec![0.0; size],
                jump,
                nonlinear_work: 0.0,
            },
            work: Workspace::new(n, count),
            state: State {
                step: 0,
                time: 0.0,
                motion: Motion::new(n, parts.model.modes.clone()),
                contact,
                modes,
                transitions: Vec::with_capacity(count),
                probes: vec![0.0; parts.probes.len()],
                base_shear: 0.0,
                base_moment: 0.0,
                normal_force: 0.0,
                uplifted_fraction: 0.0,
                mean_slip: 0.0,
                base_rotation: 0.0,
                foundations: parts.base.foundations().map(Foundation::new).collect(),
                free_field: [0.0; 2],
                ledger: Ledger::default(),
                trials: 0,
                method: SearchMethod::ActiveSet,
            },
            probe_rows,
            conditioning: Conditioning::UNKNOWN,
            model: parts.model,
            ground: parts.ground,
            base: parts.base,
            laws: parts.laws,
            motion: parts.motion,
            static_state: parts.static_state,
            probes: parts.probes,
            elements,
        };
        simulation.update_resultants();
        simulation
    }

    /// The state at the end of the last accepted step (at first: the static state).
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The time step, s.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// The contact elements, from left to right.
    pub fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// Friction coefficient of the laws: one for all elements, one each, or none unless all have one.
    pub(crate) fn friction(&self) -> Vec<f64> {
        let each: Option<Vec<f64>> =
            self.laws.iter().map(InterfaceLaw::friction_coefficient).collect();
        each.unwrap_or_default()
    }

    /// The structure as it is now, internal variables included. It is [`Any`](std::any::Any): of
    /// its own type it is what was given to the builder (the box, if that was a box).
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
    /// assert_eq!(simulation.structure().unknowns(), 3);
    /// let structure: &dyn Any = simulation.structure();
    /// let block = structure.downcast_ref::<RigidBlock>();
    /// assert!(block.is_some_and(|block| block.total_mass() == 48.0e3));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    pub fn structure(&self) -> &dyn Structure {
        self.model.structure.as_ref()
    }

    /// The structure alone, after a run: as [`Simulation::structure`], by value.
    pub fn into_structure(self) -> Box<dyn Structure> {
        self.model.structure
    }

    /// Which history the ground keeps and why, if it has chosen one yet.
    pub fn history_choice(&self) -> Option<HistoryChoice> {
        self.ground.history_choice()
    }

    /// What the ground has found about the growth of its own march, if it has assessed that: see
    /// [`FullPlaneGround`](crate::bem::full_plane::FullPlaneGround).
    pub fn ground_stability(&self) -> Option<&GroundStability> {
        self.ground.stability()
    }

    /// The probes, in the order of [`State::probes`].
    pub fn probes(&self) -> &[Probe] {
        &self.probes
    }

    /// Static displacement of the structure's unknowns under weight, m and rad. Its rigid
    /// settlement has no meaning on a half-plane, which has no datum in two dimensions.
    pub fn static_displacement(&self) -> &[f64] {
        &self.static_state.displacement
    }

    /// Number of steps that last `duration` (s), rounded up; none for a negative one or NaN.
    pub fn steps_for(&self, duration: f64) -> usize {
        // A duration that is a whole number of steps but for rounding is that number.
        let steps = (duration / self.time_step * (1.0 - 1e-12)).ceil();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let steps = steps as usize;
        steps
    }

    /// Makes up to `steps` steps, calling `observe` after each with the new state.
    ///
    /// `observe` may return nothing, or a [`Flow`] to stop early.
    ///
    /// # Errors
    /// [`crate::Error::Step`] for a step that could not be solved; the simulation stays at the last
    /// accepted one, and [`Simulation::state`] shows it.
    pub fn run<R: Into<Flow>>(
        &mut self,
        steps: usize,
        mut observe: impl FnMut(&State) -> R,
    ) -> Result<Run> {
        // There is no clock in bare WebAssembly.
        let begin = (!cfg!(target_family = "wasm")).then(std::time::Instant::now);
        // More steps than any record asks for: an observer is meant to stop the run, and what it
        // will need is not known. Histories grow by doubling then.
        if steps <= RESERVED_STEPS {
            self.ground.reserve(self.state.step.saturating_add(steps))?;
        }
        let mut run = Run::new(self);
        let start = self.state.time;
        for _ in 0..steps {
            self.step()?;
            run.record(&self.state);
            if observe(&self.state).into() == Flow::Stop {
                break;
            }
        }
        let wall = begin.map_or(std::time::Duration::ZERO, |begin| begin.elapsed());
        self.resolve_ground(&mut run, start);
        run.finish(&self.state, wall);
        Ok(run)
    }
}

impl Workspace {
    fn new(unknowns: usize, count: usize) -> Self {
        let contact = || vec![0.0; 2 * count];
        let structure = || vec![0.0; unknowns];
        Self {
            free_field: contact(),
            history: contact(),
            free_jump: contact(),
            means: contact(),
            soil_displacement: contact(),
            modes: vec![crate::interface::Mode::Stick; count],
            load: structure(),
            known: structure(),
            increment: structure(),
            new_velocity: structure(),
            new_acceleration: structure(),
            vector: structure(),
            force: structure(),
            total: structure(),
            guess: structure(),
            linearised: structure(),
            tangent: SparseMatrix::default(),
        }
    }
}
