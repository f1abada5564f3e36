//! The simulation.

use std::sync::{Mutex, MutexGuard};

use basemat::Simulation;
use basemat::contact::ContactSearch;
use basemat::coupled::{Change, Checkpoint};
use basemat::results::{Recorder, Serviceability};
use pyo3::prelude::*;

use super::build;
use super::given::{Given, Made};
use super::watched::{Watched, prepared, settled};
use super::{PyCheckpoint, PyLoad, PyState, PySteps, PyTimeScheme};
use crate::array::{Array, Numbers, whole};
use crate::dof_names::DofNames;
use crate::error;
use crate::error::{OrRaise, kept, locked, raise, refuse, take_raised};
use crate::ground::PyGround;
use crate::probe::PyProbe;
use crate::results::{PyInteraction, PyRun};
use crate::several::{Several, no_such};
use crate::ticker::{progress_function, watched};

/// A structure on a ground, ready to march: from the static state under its weight, step by step.
///
/// Args:
///     time_step: time step, s.
///     structure: a :class:`Structure`, or any object with the methods of :class:`UserStructure`.
///     ground: an :class:`ElasticGround` or a :class:`SpringGround`.
///     interface: an :class:`InterfaceLaw` or an object with the methods of :class:`UserLaw`; one for
///         all contact elements, or a list of one each, from left to right.
///     motion: ground motion, a :class:`FreeField`: a :class:`Record`, a wave, or what
///         :func:`free_field` makes of a function. The ground rests unless given.
///     probes: quantities to record at every step, a list of :class:`Probe` with names of their own;
///         none unless given.
///     loads: forces from outside, a list of :class:`Load`; none unless given.
///     gravity: m/s², gives the structure its weight; 9.80665 unless given. With 0 there is no static
///         state: the base begins without pressure, and nothing resists uplift and sliding.
///     gravity_stage: friction while the weight comes on. "frictionless" (the default): neither friction
///         nor cohesion, and the base sticks from then on; "frictional": the interface law acts, in one step; "unloaded":
///         there is no static state, weight and loads act from t = 0 on, as for a block let go.
///     initial_displacement: of the n degrees of freedom at t = 0 against the static state, array of
///         shape (n,), m and rad; zero unless given. The base may move only if "unloaded".
///     initial_velocity: the same for velocities, m/s and rad/s; zero unless given.
///     scheme: a :class:`TimeScheme`; the midpoint rule, which conserves energy, unless given.
///     coordinates: of a linear structure. "auto" (the default): whichever of the next two takes less
///         time; "physical": its degrees of freedom; "modes": its vibration modes; a number: reduced
///         coordinates, 200 to 400 Ritz vectors for thousands of degrees of freedom, with this
///         relative error of responses (above 0, below 1; "reduced(1e-6)" is the same as 1e-6).
///     expected_steps: number of steps that will be made. Memory and the ground's weights are then
///         ready before the first; unless given, those of the first run. More steps than fit into
///         the memory of the ground's history raise an error.
///     moment_center: x of the point about which the base moment is taken, m; the middle of the base
///         unless given.
///     energy_balance: whether energies are booked; True by default. Without them a step takes less
///         time, and :attr:`Run.energy_error` is NaN.
///     safety_friction: friction coefficient for the factor of safety against sliding; that of the
///         interface law unless given. It changes nothing else.
///     allowable_slip: limit of service of |mean slip|, m; none unless given. This and the next three
///         change nothing in the run: :attr:`Run.serviceability` holds it against them.
///     allowable_gap: limit of service of the gap of any element, m; none unless given.
///     allowable_uplifted_fraction: limit of service of the open length over that of the base, above 0
///         to 1; none unless given.
///     allowable_rotation: limit of service of the base's |rotation|, rad; none unless given.
///     rotation_limit: rotation of the base, about a horizontal axis, at which a run ends, rad; 1 unless given. A further
///         run goes on; infinite: runs end by their steps alone.
///     flow_chart_iterations: searches contact modes by the flow chart of Patel and Spyrakos with at
///         most so many iterations a step, for comparison with their paper; the robust search unless
///         given.
///     fixed_base: whether the base is held: each foundation keeps its shape and moves with the free field
///         under it. Ground and interface are then left out, but for the places of the contact elements.
///         False by default; :meth:`interaction` compares both.
///     progress: True for a line on stderr, or a function ``(parts done, parts in all)``, while the coefficients of a
///         layered ground are computed for the expected steps; none unless given.
#[pyclass(name = "Simulation", module = "basemat", frozen)]
pub(crate) struct PySimulation {
    simulation: Mutex<Simulation>,
    structure: Py<PyAny>,
    /// Laws of the structure's springs that are written in Python.
    hysteresis: Vec<Py<PyAny>>,
    names: Option<DofNames>,
    /// Length of the motion that it was given, s.
    duration: Option<f64>,
    /// Checkpoint of the simulation's start, or why it cannot go back there.
    start: PyResult<Checkpoint>,
    /// Parts and settings, of which the same scene is made again.
    given: Given,
}

impl PySimulation {
    /// The simulation, unless a run holds it.
    fn lock(&self) -> PyResult<MutexGuard<'_, Simulation>> {
        self.simulation.try_lock().map_err(locked)
    }
}

members! {
    PySimulation, own;
    /// The :class:`State` at the end of the last accepted step (at first: the static state).
    state: PyResult<PyState> = Ok(PyState(own.lock()?.state().clone()));
    /// Time step, s.
    time_step: PyResult<f64> = Ok(own.lock()?.time_step());
    /// Names of the probes, in their order.
    probe_names: PyResult<Vec<String>> = Ok(own.lock()?.probes().iter().map(|probe| probe.name.clone()).collect());
    /// Ends of the contact elements: list of (left, right), m.
    elements: PyResult<Vec<(f64, f64)>> = Ok(own.lock()?.ground().elements().iter().map(|e| (e.left(), e.right())).collect());
    /// Static displacement of the degrees of freedom: array of shape (n,), m and rad.
    static_displacement: PyResult<Array> = Ok(Array::from(own.lock()?.static_displacement()));
    /// Which history the ground keeps, in words; None for a ground without one.
    history_choice: PyResult<Option<String>> = Ok(own.lock()?.ground().description().history.map(|choice| choice.to_string()));
    /// The structure as it was given; of one written in Python with a ``force`` of its own the copy that
    /// this simulation works on, with its internal variables.
    structure: &Py<PyAny> = &own.structure;
    /// The springs of the structure that are written in Python (:class:`UserHysteresis`): list of the
    /// copies that this simulation works on, with their internal variables, in the order of storeys or
    /// springs.
    hysteresis: Vec<&Py<PyAny>> = own.hysteresis.iter().collect();
    /// Condition numbers of the three matrices of a step: effective stiffness, ground, contact problem.
    conditioning: PyResult<(f64, f64, f64)> = {
        let conditioning = own.lock()?.conditioning();
        Ok((conditioning.effective_stiffness, conditioning.ground, conditioning.delassus))
    };
}

#[pymethods]
impl PySimulation {
    #[new]
    #[pyo3(signature = (
        time_step, structure, ground, interface, *,
        motion=None, probes=None, loads=None, gravity=None, gravity_stage="frictionless",
        initial_displacement=None, initial_velocity=None, scheme=None, coordinates=None,
        expected_steps=None, moment_center=None, energy_balance=true, safety_friction=None,
        allowable_slip=None, allowable_gap=None, allowable_uplifted_fraction=None,
        allowable_rotation=None, rotation_limit=None, flow_chart_iterations=None, fixed_base=false,
        progress=None,
    ))]
    fn new(
        py: Python<'_>,
        time_step: f64,
        structure: Bound<'_, PyAny>,
        ground: Bound<'_, PyAny>,
        interface: Bound<'_, PyAny>,
        motion: Option<Bound<'_, PyAny>>,
        probes: Option<Several<'_, PyProbe>>,
        loads: Option<Several<'_, PyLoad>>,
        gravity: Option<f64>,
        gravity_stage: &str,
        initial_displacement: Option<Numbers>,
        initial_velocity: Option<Numbers>,
        scheme: Option<Bound<'_, PyTimeScheme>>,
        coordinates: Option<Bound<'_, PyAny>>,
        #[pyo3(from_py_with = whole)] expected_steps: Option<usize>,
        moment_center: Option<f64>,
        energy_balance: bool,
        safety_friction: Option<f64>,
        allowable_slip: Option<f64>,
        allowable_gap: Option<f64>,
        allowable_uplifted_fraction: Option<f64>,
        allowable_rotation: Option<f64>,
        rotation_limit: Option<f64>,
        #[pyo3(from_py_with = whole)] flow_chart_iterations: Option<usize>,
        fixed_base: bool,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        take_raised();
        let ground = ground
            .cast::<PyGround>()
            .map_err(|_| no_such(&ground, "an ElasticGround or a SpringGround"))?;
        let progress = progress.as_ref();
        let given = Given {
            time_step,
            structure: structure.unbind(),
            ground: ground.clone().unbind(),
            interface: interface.unbind(),
            motion: motion.map(Bound::unbind),
            probes: probes
                .iter()
                .flat_map(|own| own.iter())
                .map(|own| own.clone().unbind())
                .collect(),
            loads: loads
                .iter()
                .flat_map(|own| own.iter())
                .map(|own| own.clone().unbind())
                .collect(),
            gravity,
            gravity_stage: gravity_stage.parse().or_raise()?,
            initial_displacement: initial_displacement.map(|numbers| numbers.0),
            initial_velocity: initial_velocity.map(|numbers| numbers.0),
            scheme: scheme.map(Bound::unbind),
            coordinates: coordinates.map(|own| build::coordinates(&own)).transpose()?,
            expected_steps,
            moment_center,
            energy_balance,
            safety_friction,
            serviceability: Serviceability {
                slip: allowable_slip,
                gap: allowable_gap,
                uplifted_fraction: allowable_uplifted_fraction,
                rotation: allowable_rotation,
            },
            search: flow_chart_iterations.map(|iterations| ContactSearch::FlowChart { iterations }),
            rotation_limit,
            fixed_base,
        };
        let Made { builder, structure, hysteresis, names, duration } = given.made(py)?;
        let simulation = build::build(py, builder, progress)?;
        let start = build::start(&simulation);
        let simulation = Mutex::new(simulation);
        Ok(Self { simulation, structure, hysteresis, names, duration, start, given })
    }

    /// Makes ``steps`` steps, or those of a ``duration`` (s); without either, those to the end of the
    /// motion. If that is past, as many as it has, under rest, with a :class:`BasematWarning`:
    /// :meth:`reset` goes back to the start.
    ///
    /// ``progress``: True for lines on stderr, one for the coefficients of a layered ground and one for the steps, or a
    /// function ``(steps done, steps in all)`` that is called about every 50 ms. ``observe(state)`` is called after every ``observe_every``th step
    /// and ends the run when it returns True; what it raises comes out of here. Ctrl-C is heard, or
    /// a :class:`BasematWarning` says that the process ignores it. In all three cases the
    /// simulation stays at the last accepted step.
    ///
    /// ``series``: whether time series are kept, True by default: of every ``every``th step (1 by
    /// default, which floor spectra need), of contact every ``contact_every``th and of the structure's
    /// motion every ``motion_every``th (none unless given). They must fit into :func:`memory_limit`: all
    /// of them before the first step; with ``observe``, which may end the run, those of the steps made.
    ///
    /// ``warn``: whether every warning in :attr:`Run.warnings` is also a :class:`BasematWarning`; True
    /// by default.
    #[pyo3(signature = (
        steps=None, *, duration=None, progress=None, observe=None, observe_every=1, series=true,
        every=1, contact_every=None, motion_every=None, warn=true,
    ))]
    fn run(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = whole)] steps: Option<usize>,
        duration: Option<f64>,
        progress: Option<Bound<'_, PyAny>>,
        observe: Option<Py<PyAny>>,
        #[pyo3(from_py_with = whole)] observe_every: usize,
        series: bool,
        #[pyo3(from_py_with = whole)] every: usize,
        #[pyo3(from_py_with = whole)] contact_every: Option<usize>,
        #[pyo3(from_py_with = whole)] motion_every: Option<usize>,
        warn: bool,
    ) -> PyResult<PyRun> {
        let steps = build::count(py, &*self.lock()?, self.duration, steps, duration)?;
        if observe_every == 0 {
            return Err(refuse("observe_every is 0, but must be one or more"));
        }
        if let Some(observe) = &observe
            && !observe.bind(py).is_callable()
        {
            return Err(refuse("observe must be a function of a state"));
        }
        let mut recorder = Recorder::new().every(every);
        if let Some(every) = contact_every {
            recorder = recorder.contact(every);
        }
        if let Some(every) = motion_every {
            recorder = recorder.motion(every);
        }
        let line = progress.as_ref().filter(|own| !own.is_callable());
        let coefficients = progress_function(line, build::COEFFICIENTS)?;
        let progress = progress_function(progress.as_ref(), "steps")?;
        take_raised();
        let run = py.detach(|| {
            let mut simulation = self.lock()?;
            let mut time_series =
                series.then(|| recorder.start(&simulation)).transpose().or_raise()?;
            if let Some(time_series) = &mut time_series {
                // A run that its observer ends may take fewer steps than given.
                time_series.reserve(steps).or_else(|error| match error {
                    basemat::Error::Memory(_) if observe.is_some() => Ok(()),
                    _ => Err(raise(error)),
                })?;
            }
            watched(coefficients, |observer| simulation.prepare(steps, observer))?;
            let mut watched = Watched::new(progress, steps, observe, observe_every, time_series);
            let result = simulation.run(steps, |state| watched.see(state));
            watched.end(result, self.names.as_ref())
        })?;
        if warn {
            run.warnings().into_iter().try_for_each(|text| error::warn(py, text))?;
        }
        Ok(run)
    }

    /// Makes one step and returns the new state. Raises :class:`StepError` if the step could not be
    /// solved; the simulation is then as it was before.
    fn step(&self, py: Python<'_>) -> PyResult<PyState> {
        take_raised();
        py.detach(|| {
            let mut simulation = self.lock()?;
            prepared(&mut simulation)?;
            settled(simulation.step().cloned()).map(PyState)
        })
    }

    /// An iterator that makes a step and yields its state, ``steps`` times or those of a
    /// ``duration`` (s); without either, those to the end of the motion.
    #[pyo3(signature = (steps=None, *, duration=None))]
    fn steps(
        slf: Bound<'_, Self>,
        #[pyo3(from_py_with = whole)] steps: Option<usize>,
        duration: Option<f64>,
    ) -> PyResult<PySteps> {
        let own = slf.get();
        let left = build::count(slf.py(), &*own.lock()?, own.duration, steps, duration)?;
        Ok(PySteps { simulation: slf.into_any().unbind(), left })
    }

    /// Sets the force of the load number ``index`` (from 0, in the order of ``loads``) for all steps from now on.
    ///
    /// ``value``: the whole force (N/m; on a rotation N·m/m), the static one included, in place of the load's function;
    /// None returns to that function. A controller computes it from the last state and sets it before each
    /// :meth:`step`. A checkpoint holds it; :meth:`reset` returns to the functions.
    fn set_load(
        &self,
        #[pyo3(from_py_with = whole)] index: usize,
        value: Option<f64>,
    ) -> PyResult<()> {
        self.lock()?.set_load(index, value).or_raise()
    }

    /// The :class:`Interaction` of the soil with the structure: this scene from its start, run for a ``duration`` (s; that
    /// of the motion unless given) on its ground and on a fixed base, and the period lengthening and damping of its
    /// first mode (ASCE 7, chapter 19). This simulation stays where it is.
    ///
    /// T and β belong to the mode that moves the most mass along an axis, with the contact nodes held; of a nonlinear
    /// structure with its first tangent. For T̃ and β₀ the structure is bonded to its ground, deflected in this mode and
    /// let go. The soil is linear: give it the moduli of the design motion.
    #[pyo3(signature = (duration=None))]
    fn interaction(&self, py: Python<'_>, duration: Option<f64>) -> PyResult<PyInteraction> {
        let needed = "give a duration: no record says how long to run";
        let duration = duration.or(self.duration).ok_or_else(|| refuse(needed))?;
        take_raised();
        let scene = || {
            let made = Python::attach(|py| self.given.made(py));
            made.map(|made| made.builder).map_err(|error| kept("scene", error))
        };
        let found = py.detach(|| settled(basemat::coupled::interaction(duration, scene)))?;
        Ok(PyInteraction { found, names: self.names.as_ref().map(DofNames::to_vec) })
    }

    /// Number of steps that last ``duration`` (s), rounded up.
    fn steps_for(&self, duration: f64) -> PyResult<usize> {
        build::steps_for(&*self.lock()?, duration)
    }

    /// Saves what the steps so far have left behind as a :class:`Checkpoint`, for :meth:`resume`.
    fn checkpoint(&self) -> PyResult<PyCheckpoint> {
        take_raised();
        settled(self.lock()?.checkpoint()).map(PyCheckpoint)
    }

    /// Goes to where ``checkpoint`` (a :class:`Checkpoint`) was made, in a simulation that was built in
    /// the same way; raises :class:`CheckpointError` in another one, with what differs: sizes, time step,
    /// elements, matrices, static state, interface law, and ground motion and loads in the steps so far.
    ///
    /// Args:
    ///     changes: differences that are wanted, of "interface_law", "ground_motion", "load",
    ///         "gravity_stage" and "initial_motion"; none unless given.
    #[pyo3(signature = (checkpoint, changes=None))]
    fn resume(&self, checkpoint: &PyCheckpoint, changes: Option<Vec<String>>) -> PyResult<()> {
        take_raised();
        let words = changes.unwrap_or_default();
        let changes: basemat::Result<Vec<Change>> = words.iter().map(|word| word.parse()).collect();
        settled(self.lock()?.resume_changed(&checkpoint.0, &settled(changes)?))
    }

    /// Goes back to the start: what follows has the bits that it had from there.
    ///
    /// Needs what :meth:`checkpoint` needs: a structure of the user's that has ``commit`` also has
    /// ``save`` and ``restore``.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        take_raised();
        let start = self.start.as_ref().map_err(|reason| reason.clone_ref(py))?;
        // The simulation's own start, even if the user's loads and laws return other values by now.
        settled(self.lock()?.resume_changed(start, &Change::ALL))
    }

    fn __repr__(&self) -> String {
        match self.lock() {
            Ok(own) => format!("Simulation(step {}, {} s)", own.state().step, own.state().time),
            Err(_) if self.simulation.is_poisoned() => "Simulation(unusable)".into(),
            Err(_) => "Simulation(running)".into(),
        }
    }
}
