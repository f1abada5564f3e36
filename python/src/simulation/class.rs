//! The simulation.

use std::sync::{Mutex, MutexGuard};

use basemat::Simulation;
use basemat::coupled::{Change, Checkpoint};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::build;
use super::options::{
    Options, PyInitialConditions, PyResultOptions, PyServiceLimits, PySolverOptions, refuse_others,
};
use super::parts::{BuilderParts, OptionGroups, SimulationParts, cloned_or_default};
use super::run_reporter::{RunReporter, prepare_next_step, step_result};
use super::{PyCheckpoint, PyLoad, PyState, PySteps};
use crate::array::{Array, whole_numbers};
use crate::dof_names::DofNames;
use crate::error::{
    self, OrRaise, input_error, lock_error, take_exception, to_exception, user_code_error,
};
use crate::probe::PyProbe;
use crate::results::{PyInteraction, PyRun};
use crate::several::{ListOf, type_error};
use crate::ticker::{progress_function, with_progress};

/// A structure on a ground, ready to march: from the static state under its weight, step by step.
///
/// Args:
///     time_step: time step, s.
///     structure: a `Structure`, or any object with the methods of `UserStructure`.
///     ground: a `Ground`: an `ElasticGround`, `SpringGround` or `TrenchGround`; or any object with the methods of
///         `UserGround`.
///     interface: an `InterfaceLaw` or an object with the methods of `UserLaw`; one for
///         all contact elements, or a list of one each, from left to right.
///     motion: ground motion, a `FreeField`: a `Record`, a wave, or what
///         `free_field` makes of a function. The ground rests unless given.
///     loads: forces from outside, a list of `Load`; none unless given.
///     probes: quantities to record at every step, a list of `Probe` with names of their own;
///         none unless given.
///     initial: weight and motion at the start, `InitialConditions`; weight and rest unless given.
///     solver: time scheme, coordinates and so on, `SolverOptions`; the defaults unless given.
///     results: quantities that a run evaluates, `ResultOptions`; the defaults unless given.
///     service_limits: limits of service, `ServiceLimits`; none unless given.
///     fixed_base: whether the base is held: each foundation keeps its shape and moves with the free field
///         under it. Ground and interface are then left out, but for the places of the contact elements.
///         False by default; `interaction` compares both.
///     progress: True for a line on stderr, or a function ``(parts done, parts in all)``, while the coefficients of a
///         ground with layers or a trench are computed for the expected steps; none unless given.
#[pyclass(name = "Simulation", module = "basemat", frozen)]
pub(crate) struct PySimulation {
    simulation: Mutex<Simulation>,
    structure: Py<PyAny>,
    ground: Py<PyAny>,
    /// Laws of the structure's springs that are written in Python.
    hysteresis: Vec<Py<PyAny>>,
    names: Option<DofNames>,
    /// Length of the motion that it was given, s.
    duration: Option<f64>,
    /// Checkpoint of the simulation's start, or why it cannot go back there.
    start: PyResult<Checkpoint>,
    /// Parts and settings, from which the same scene can be made again.
    parts: SimulationParts,
}

impl PySimulation {
    /// The simulation, unless a run holds it.
    fn lock(&self) -> PyResult<MutexGuard<'_, Simulation>> {
        self.simulation.try_lock().map_err(lock_error)
    }
}

#[pymethods]
impl PySimulation {
    /// The `State` at the end of the last accepted step (at first: the static state).
    #[getter]
    fn state(&self) -> PyResult<PyState> {
        Ok(PyState(self.lock()?.state().clone()))
    }

    /// Time step, s.
    #[getter]
    fn time_step(&self) -> PyResult<f64> {
        Ok(self.lock()?.time_step())
    }

    /// Names of the probes, in their order.
    #[getter]
    fn probe_names(&self) -> PyResult<Vec<String>> {
        Ok(self.lock()?.probes().iter().map(|probe| probe.name.clone()).collect())
    }

    /// Ends of the contact elements: list of (left, right), m.
    #[getter]
    fn elements(&self) -> PyResult<Vec<(f64, f64)>> {
        let simulation = self.lock()?;
        let elements = simulation.ground().elements().iter();
        Ok(elements.map(|element| (element.left(), element.right())).collect())
    }

    /// Static displacement of the degrees of freedom: array of shape (n,), m and rad.
    #[getter]
    fn static_displacement(&self) -> PyResult<Array> {
        Ok(Array::from(self.lock()?.static_displacement()))
    }

    /// The method by which the ground computes its history, in words; None for a ground without history.
    #[getter]
    fn history_choice(&self) -> PyResult<Option<String>> {
        Ok(self.lock()?.ground().description().history.map(|choice| choice.to_string()))
    }

    /// The structure as it was given; of one written in Python with a ``force`` of its own the copy that
    /// this simulation works on, with its internal variables.
    #[getter]
    fn structure(&self) -> &Py<PyAny> {
        &self.structure
    }

    /// The ground as it was given; of one written in Python the copy that this simulation works on.
    #[getter]
    fn ground(&self) -> &Py<PyAny> {
        &self.ground
    }

    /// The law of the interface as it was given, or the list of laws.
    #[getter]
    fn interface(&self) -> &Py<PyAny> {
        &self.parts.interface
    }

    /// The ground motion as it was given; None without one.
    #[getter]
    fn motion(&self) -> Option<&Py<PyAny>> {
        self.parts.motion.as_ref()
    }

    /// All arguments by their names, as they were given; those that were not are None, an empty list or False.
    #[getter]
    fn _arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.parts.arguments(py)
    }

    /// The springs of the structure that are written in Python (`UserHysteresis`): list of the
    /// copies that this simulation works on, with their internal variables, in the order of storeys or
    /// springs.
    #[getter]
    fn hysteresis(&self) -> Vec<&Py<PyAny>> {
        self.hysteresis.iter().collect()
    }

    /// Condition numbers of the three matrices of a step: effective stiffness, ground, contact problem.
    #[getter]
    fn conditioning(&self) -> PyResult<(f64, f64, f64)> {
        let conditioning = self.lock()?.conditioning();
        Ok((conditioning.effective_stiffness, conditioning.ground, conditioning.delassus))
    }

    // `others` are not in the text: each is an error that names the group of the option.
    #[new]
    #[pyo3(
        signature = (
            time_step, structure, ground, interface, *, motion=None, loads=None, probes=None,
            initial=None, solver=None, results=None, service_limits=None, fixed_base=false,
            progress=None, **others
        ),
        text_signature = "(time_step, structure, ground, interface, *, motion=None, loads=None, \
            probes=None, initial=None, solver=None, results=None, service_limits=None, \
            fixed_base=False, progress=None)"
    )]
    fn new(
        py: Python<'_>,
        time_step: Bound<'_, PyAny>,
        structure: Bound<'_, PyAny>,
        ground: Bound<'_, PyAny>,
        interface: Bound<'_, PyAny>,
        motion: Option<Bound<'_, PyAny>>,
        loads: Option<ListOf<'_, PyLoad>>,
        probes: Option<ListOf<'_, PyProbe>>,
        initial: Option<Py<PyInitialConditions>>,
        solver: Option<Py<PySolverOptions>>,
        results: Option<Py<PyResultOptions>>,
        service_limits: Option<Py<PyServiceLimits>>,
        fixed_base: bool,
        progress: Option<Bound<'_, PyAny>>,
        others: Option<Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        refuse_others(others.as_ref())?;
        take_exception();
        let needed = "a number of seconds: Simulation(time_step, structure, ground, interface)";
        let time_step = time_step.extract().map_err(|_| type_error(&time_step, needed))?;
        let parts = SimulationParts {
            time_step,
            structure: structure.unbind(),
            ground: ground.unbind(),
            interface: interface.unbind(),
            motion: motion.map(Bound::unbind),
            loads: loads.map(ListOf::unbound).unwrap_or_default(),
            probes: probes.map(ListOf::unbound).unwrap_or_default(),
            options: Options {
                initial: cloned_or_default(initial.as_ref()),
                solver: cloned_or_default(solver.as_ref()),
                results: cloned_or_default(results.as_ref()),
                limits: cloned_or_default(service_limits.as_ref()),
            },
            groups: OptionGroups { initial, solver, results, service_limits },
            fixed_base,
        };
        let BuilderParts { builder, structure, ground, hysteresis, names, duration } =
            parts.builder_parts(py)?;
        let simulation = build::build(py, builder, progress.as_ref())?;
        let start = build::start(&simulation);
        let simulation = Mutex::new(simulation);
        Ok(Self { simulation, structure, ground, hysteresis, names, duration, start, parts })
    }

    /// Makes ``steps`` steps, or the steps of a ``duration`` (s); without either, up to the end of the motion.
    ///
    /// After that end the motion's number of steps again, under rest, with a `BasematWarning`; `reset` returns to the start.
    ///
    /// ``progress``: True for lines on stderr, one for the ground's coefficients and one for the steps; or a function
    /// ``(steps done, steps in all)``, called about every 50 ms.
    ///
    /// ``observe(state)`` is called after every ``observe_every``th step. The run ends when it returns True. An exception of
    /// it ends the run, too, and so does Ctrl-C; a `BasematWarning` tells if the process ignores Ctrl-C. The simulation then
    /// stays at the last accepted step.
    ///
    /// ``series``: whether time series are recorded, True by default: the scalars of every ``every``th step (1 by default, as
    /// floor spectra need), the contact of every ``contact_every``th and the structure's motion of every
    /// ``motion_every``th (none unless given), and with ``foundations`` (False by default) scalars of each foundation. All of
    /// them must fit into `memory_limit` before the first step; with ``observe``, which may end the run, only the values of
    /// the steps made.
    ///
    /// ``warn``: whether every warning in `Run.warnings` is also a `BasematWarning`; True
    /// by default.
    #[pyo3(signature = (
        steps=None, *, duration=None, progress=None, observe=None, observe_every=1, series=true,
        every=1, contact_every=None, motion_every=None, foundations=false, warn=true,
    ))]
    fn run(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = whole_numbers)] steps: Option<usize>,
        duration: Option<f64>,
        progress: Option<Bound<'_, PyAny>>,
        observe: Option<Py<PyAny>>,
        #[pyo3(from_py_with = whole_numbers)] observe_every: usize,
        series: bool,
        #[pyo3(from_py_with = whole_numbers)] every: usize,
        #[pyo3(from_py_with = whole_numbers)] contact_every: Option<usize>,
        #[pyo3(from_py_with = whole_numbers)] motion_every: Option<usize>,
        foundations: bool,
        warn: bool,
    ) -> PyResult<PyRun> {
        let steps = build::count(py, &*self.lock()?, self.duration, steps, duration)?;
        build::check_observer(py, observe.as_ref(), observe_every)?;
        let recorder = build::recorder(every, contact_every, motion_every, foundations);
        let line = progress.as_ref().filter(|progress| !progress.is_callable());
        let coefficients = progress_function(line, build::COEFFICIENT_PARTS)?;
        let progress = progress_function(progress.as_ref(), "steps")?;
        take_exception();
        let run = py.detach(|| {
            let mut simulation = self.lock()?;
            let mut time_series =
                series.then(|| recorder.start(&simulation)).transpose().or_raise()?;
            if let Some(time_series) = &mut time_series {
                // A run that its observer ends may take fewer steps than given.
                time_series.reserve(steps).or_else(|error| match error {
                    basemat::Error::Memory(_) if observe.is_some() => Ok(()),
                    _ => Err(to_exception(error)),
                })?;
            }
            with_progress(coefficients, |observer| simulation.prepare(steps, observer))?;
            let mut reporter =
                RunReporter::new(progress, steps, observe, observe_every, time_series);
            let result = simulation.run(steps, |state| reporter.update(state));
            reporter.end(result, self.names.as_ref())
        })?;
        if warn {
            run.warnings().into_iter().try_for_each(|text| error::warn(py, text))?;
        }
        Ok(run)
    }

    /// Makes one step and returns the new state. Raises `StepError` if the step could not be
    /// solved; the simulation is then as it was before.
    fn step(&self, py: Python<'_>) -> PyResult<PyState> {
        take_exception();
        py.detach(|| {
            let mut simulation = self.lock()?;
            prepare_next_step(&mut simulation)?;
            step_result(simulation.step().cloned()).map(PyState)
        })
    }

    /// An iterator that makes a step and yields its state, ``steps`` times or for a
    /// ``duration`` (s); without either, those to the end of the motion.
    #[pyo3(signature = (steps=None, *, duration=None))]
    fn steps(
        slf: Bound<'_, Self>,
        #[pyo3(from_py_with = whole_numbers)] steps: Option<usize>,
        duration: Option<f64>,
    ) -> PyResult<PySteps> {
        let this = slf.get();
        let remaining = build::count(slf.py(), &*this.lock()?, this.duration, steps, duration)?;
        Ok(PySteps { simulation: slf.into_any().unbind(), remaining })
    }

    /// Sets the force of the load number ``index`` (from 0, in the order of ``loads``) for all steps from now on.
    ///
    /// ``value``: the whole force (N/m; on a rotation N·m/m), the static one included, in place of the load's function;
    /// None returns to that function. A controller computes it from the last state and sets it before each
    /// `step`. A checkpoint holds it; `reset` returns to the functions.
    fn set_load(
        &self,
        #[pyo3(from_py_with = whole_numbers)] index: usize,
        value: Option<f64>,
    ) -> PyResult<()> {
        self.lock()?.set_load(index, value).or_raise()
    }

    /// The `Interaction` of the soil with the structure: this scene from its start, run for a ``duration`` (s; that
    /// of the motion unless given) on its ground and on a fixed base, and the period lengthening and damping of its
    /// first mode (ASCE 7, chapter 19). This simulation stays where it is.
    ///
    /// T and β belong to the mode that moves the most mass along an axis, with the contact nodes held; of a nonlinear
    /// structure with its first tangent. For T̃ and β₀ the structure is bonded to its ground and released from a
    /// deflection in this mode. The soil is linear: give it the moduli of the design motion.
    #[pyo3(signature = (duration=None))]
    fn interaction(&self, py: Python<'_>, duration: Option<f64>) -> PyResult<PyInteraction> {
        let needed = "give a duration: no record says how long to run";
        let duration = duration.or(self.duration).ok_or_else(|| input_error(needed))?;
        take_exception();
        let found = py.detach(|| {
            step_result(basemat::analyses::interaction(duration, || {
                let parts = Python::attach(|py| self.parts.builder_parts(py));
                parts.map(|parts| parts.builder).map_err(|error| user_code_error("scene", error))
            }))
        })?;
        Ok(PyInteraction { found, names: self.names.as_ref().map(DofNames::to_vec) })
    }

    /// Number of steps that last ``duration`` (s), rounded up.
    fn steps_for(&self, duration: f64) -> PyResult<usize> {
        build::steps_for(&*self.lock()?, duration)
    }

    /// Saves what the steps so far have left behind as a `Checkpoint`, for `resume`.
    fn checkpoint(&self) -> PyResult<PyCheckpoint> {
        take_exception();
        step_result(self.lock()?.checkpoint()).map(PyCheckpoint)
    }

    /// Goes to where ``checkpoint`` (a `Checkpoint`) was made, in a simulation that was built in
    /// the same way; raises `CheckpointError` in another one, with what differs: sizes, time step,
    /// elements, matrices, static state, and the label of `ResultOptions`, which should name interface law, ground motion
    /// and loads.
    ///
    /// Args:
    ///     changes: differences that are wanted, of "interface_law", "ground_motion" and "load", each with another
    ///         label, "gravity_stage" and "initial_motion"; none unless given.
    #[pyo3(signature = (checkpoint, changes=None))]
    fn resume(&self, checkpoint: &PyCheckpoint, changes: Option<Vec<String>>) -> PyResult<()> {
        take_exception();
        let names = changes.unwrap_or_default();
        let changes: basemat::Result<Vec<Change>> = names.iter().map(|name| name.parse()).collect();
        step_result(self.lock()?.resume_changed(&checkpoint.0, &step_result(changes)?))
    }

    /// Goes back to the start: what follows has the bits that it had from there.
    ///
    /// Needs what `checkpoint` needs: a structure of the user's that has ``commit`` also has
    /// ``save`` and ``restore``.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        take_exception();
        let start = self.start.as_ref().map_err(|reason| reason.clone_ref(py))?;
        // The simulation's own start, even if the user's loads and laws return other values by now.
        step_result(self.lock()?.resume_changed(start, &Change::ALL))
    }

    fn __repr__(&self) -> String {
        match self.lock() {
            Ok(simulation) => {
                let state = simulation.state();
                format!("Simulation(step {}, {} s)", state.step, state.time)
            }
            Err(_) if self.simulation.is_poisoned() => "Simulation(unusable)".into(),
            Err(_) => "Simulation(running)".into(),
        }
    }
}
