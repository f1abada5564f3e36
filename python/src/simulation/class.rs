//! The simulation.

use std::sync::{Mutex, MutexGuard};

use basemat::Simulation;
use basemat::coupled::{Change, Checkpoint};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::build;
use super::options::{
    PyInitialConditions, PyResultOptions, PyServiceLimits, PySolverOptions,
    reject_unknown_arguments,
};
use super::parts::{BuilderParts, OptionGroups, SimulationParts};
use super::run_reporter::{RunReporter, prepare_next_step, step_result};
use super::{PyCheckpoint, PyLoad, PyState, PySteps};
use crate::array::{Array, whole_numbers};
use crate::error::{self, OrRaise, lock_error, take_exception, to_exception};
use crate::joint::PyJoint;
use crate::list_arguments::{ListOf, type_error};
use crate::names::DofNames;
use crate::probe::PyProbe;
use crate::results::PyRun;
use crate::ticker::{progress_function, with_progress};

/// Simulation of a structure on a ground, from its static state on.
///
/// Args:
///     time_step: time step, s.
///     structure: a `Structure`, or any object with the methods of `UserStructure`.
///     ground: a `Ground`: an `ElasticGround`, `SpringGround` or `TrenchGround`; or any object with the methods of
///         `UserGround`.
///     interface: an `InterfaceLaw` or an object with the methods of `UserLaw`; one law for all contact elements, or a
///         list with a law for each element, from left to right.
///     motion: ground motion, a `FreeField`: a `Record`, a wave, or a function (`free_field`). Without a motion the
///         ground is at rest.
///     joints: contact between lines of nodes of the structure, a list of `Joint`; none unless given.
///     loads: forces from outside, a list of `Load`; none unless given.
///     probes: quantities to record at every step, a list of `Probe` with different names; none unless given.
///     initial: weight and motion at the start, `InitialConditions`; weight and rest unless given.
///     solver: time scheme, coordinates and so on, `SolverOptions`; the defaults unless given.
///     results: quantities that a run evaluates, `ResultOptions`; the defaults unless given.
///     service_limits: limits of service, `ServiceLimits`; none unless given.
///     fixed_base: whether the base is fixed: each foundation keeps its shape and moves with the free field under it.
///         Ground and interface then have no effect, except for the positions of the contact elements. False by
///         default; `interaction` compares the fixed base with the ground.
///     progress: True for a line on stderr, or a function ``(parts done, parts in all)``, while the convolution weights
///         of a ground with layers or a trench are computed for the expected steps; none unless given.
#[pyclass(name = "Simulation", module = "basemat", frozen)]
pub(crate) struct PySimulation {
    simulation: Mutex<Simulation>,
    structure: Py<PyAny>,
    ground: Py<PyAny>,
    /// Laws of the structure's springs that are written in Python.
    hysteresis: Vec<Py<PyAny>>,
    pub(super) dof_names: Option<DofNames>,
    /// Duration of the ground motion, s; `None` for a motion without an end.
    pub(super) motion_duration: Option<f64>,
    /// Checkpoint at the start, or the reason why the simulation cannot return to it.
    start: PyResult<Checkpoint>,
    /// Parts and settings, from which the same scene can be built again.
    pub(super) parts: SimulationParts,
}

impl PySimulation {
    /// The simulation; an error while it is running.
    pub(super) fn lock(&self) -> PyResult<MutexGuard<'_, Simulation>> {
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

    /// Text with the method by which the ground computes its history; None for a ground without history.
    #[getter]
    fn history_choice(&self) -> PyResult<Option<String>> {
        Ok(self.lock()?.ground().description().history.map(|choice| choice.to_string()))
    }

    /// The argument ``structure``; for a structure written in Python with a method ``force``, the copy in this
    /// simulation, with its internal variables.
    #[getter]
    fn structure(&self) -> &Py<PyAny> {
        &self.structure
    }

    /// The argument ``ground``; for a ground written in Python, the copy in this simulation.
    #[getter]
    fn ground(&self) -> &Py<PyAny> {
        &self.ground
    }

    /// The argument ``interface``: a law, or the list of laws.
    #[getter]
    fn interface(&self) -> &Py<PyAny> {
        &self.parts.interface
    }

    /// The argument ``motion``; None without one.
    #[getter]
    fn motion(&self) -> Option<&Py<PyAny>> {
        self.parts.motion.as_ref()
    }

    /// All arguments by their names; arguments that were not given are None, an empty list or False.
    #[getter]
    fn _arguments<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.parts.arguments(py)
    }

    /// The springs of the structure that are written in Python (`UserHysteresis`): list of the copies in this
    /// simulation, with their internal variables, in the order of storeys or springs.
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

    // The text signature omits `others`: each is an error that names the group of the option.
    #[new]
    #[pyo3(
        signature = (
            time_step, structure, ground, interface, *, motion=None, joints=None, loads=None,
            probes=None, initial=None, solver=None, results=None, service_limits=None, fixed_base=false,
            progress=None, **others
        ),
        text_signature = "(time_step, structure, ground, interface, *, motion=None, joints=None, \
            loads=None, probes=None, initial=None, solver=None, results=None, service_limits=None, \
            fixed_base=False, progress=None)"
    )]
    fn new(
        py: Python<'_>,
        time_step: Bound<'_, PyAny>,
        structure: Bound<'_, PyAny>,
        ground: Bound<'_, PyAny>,
        interface: Bound<'_, PyAny>,
        motion: Option<Bound<'_, PyAny>>,
        joints: Option<ListOf<'_, PyJoint>>,
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
        reject_unknown_arguments(others.as_ref())?;
        take_exception();
        let requirement =
            "a number of seconds: Simulation(time_step, structure, ground, interface)";
        let time_step = time_step.extract().map_err(|_| type_error(&time_step, requirement))?;
        let groups = OptionGroups { initial, solver, results, service_limits };
        let parts = SimulationParts {
            time_step,
            structure: structure.unbind(),
            ground: ground.unbind(),
            interface: interface.unbind(),
            motion: motion.map(Bound::unbind),
            joints: joints.map(ListOf::unbound).unwrap_or_default(),
            loads: loads.map(ListOf::unbound).unwrap_or_default(),
            probes: probes.map(ListOf::unbound).unwrap_or_default(),
            options: groups.options(),
            groups,
            fixed_base,
        };
        let BuilderParts { builder, structure, ground, hysteresis, dof_names, motion_duration } =
            parts.builder_parts(py)?;
        let simulation = build::build(py, builder, progress.as_ref())?;
        let start = build::start_checkpoint(&simulation);
        let simulation = Mutex::new(simulation);
        Ok(Self {
            simulation,
            structure,
            ground,
            hysteresis,
            dof_names,
            motion_duration,
            start,
            parts,
        })
    }

    /// Makes ``steps`` steps, or the steps of a ``duration`` (s); without either, up to the end of the motion.
    ///
    /// If neither is given after the end of the motion, the run makes as many steps again, without acceleration of the
    /// ground, and issues a `BasematWarning`; `reset` returns to the start.
    ///
    /// ``progress``: True for lines on stderr, one for the convolution weights of the ground and one for the steps; or
    /// a function ``(steps done, steps in all)``, called about every 50 ms.
    ///
    /// ``observe(state)`` is called after every ``observe_every``th step. The run ends when it returns True. An
    /// exception of ``observe`` or Ctrl-C also ends the run, and the simulation stays at the last accepted step. A
    /// `BasematWarning` is issued if the process ignores Ctrl-C.
    ///
    /// ``series``: whether time series are recorded, True by default: the scalars of every ``every``th step (1 by
    /// default, as floor spectra need), the contact of every ``contact_every``th step and the structure's motion of
    /// every ``motion_every``th step (none unless given), and with ``foundations`` (False by default) the scalars of
    /// each foundation. The series of all steps must fit into `memory_limit` before the first step; with ``observe``,
    /// which may end the run early, only the series of the steps that are made must fit.
    ///
    /// ``warn``: whether every warning in `Run.warnings` is also a `BasematWarning`; True by default.
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
        let steps =
            build::run_step_count(py, &*self.lock()?, self.motion_duration, steps, duration)?;
        build::check_observer(py, observe.as_ref(), observe_every)?;
        let recorder = build::recorder(every, contact_every, motion_every, foundations);
        let line_flag = progress.as_ref().filter(|progress| !progress.is_callable());
        let report_weights = progress_function(line_flag, build::COEFFICIENT_PARTS)?;
        let report_steps = progress_function(progress.as_ref(), "steps")?;
        take_exception();
        let run = py.detach(|| {
            let mut simulation = self.lock()?;
            let mut time_series =
                series.then(|| recorder.start(&simulation)).transpose().or_raise()?;
            if let Some(time_series) = &mut time_series {
                // A run that its observer ends may make fewer steps.
                time_series.reserve(steps).or_else(|error| match error {
                    basemat::Error::Memory(_) if observe.is_some() => Ok(()),
                    _ => Err(to_exception(error)),
                })?;
            }
            with_progress(report_weights, |observer| simulation.prepare(steps, observer))?;
            let mut reporter =
                RunReporter::new(report_steps, steps, observe, observe_every, time_series);
            let result = simulation.run(steps, |state| reporter.update(state));
            reporter.end(result, self.dof_names.as_ref())
        })?;
        if warn {
            run.warnings().into_iter().try_for_each(|text| error::warn(py, text))?;
        }
        Ok(run)
    }

    /// Makes one step and returns the new state. A `StepError` is raised if the step has no solution; the simulation is
    /// then unchanged.
    fn step(&self, py: Python<'_>) -> PyResult<PyState> {
        take_exception();
        py.detach(|| {
            let mut simulation = self.lock()?;
            prepare_next_step(&mut simulation)?;
            step_result(simulation.step().cloned()).map(PyState)
        })
    }

    /// Iterator that makes steps and yields the state after each: ``steps`` steps, or the steps of a ``duration`` (s);
    /// without either, up to the end of the motion.
    #[pyo3(signature = (steps=None, *, duration=None))]
    fn steps(
        slf: Bound<'_, Self>,
        #[pyo3(from_py_with = whole_numbers)] steps: Option<usize>,
        duration: Option<f64>,
    ) -> PyResult<PySteps> {
        let owner = slf.get();
        let remaining_steps = build::run_step_count(
            slf.py(),
            &*owner.lock()?,
            owner.motion_duration,
            steps,
            duration,
        )?;
        Ok(PySteps { simulation: slf.into_any().unbind(), remaining_steps })
    }

    /// Sets the force of the load with the number ``index`` (from 0, in the order of ``loads``) for all further steps.
    ///
    /// ``value``: the total force (N/m; on a rotation N·m/m; in plan N and N·m), which includes the static force, in
    /// place of the function of the load; None restores that function. A controller computes the force from the last
    /// state and sets it before each `step`. A checkpoint contains the force that was set; `reset` restores the
    /// functions.
    fn set_load(
        &self,
        #[pyo3(from_py_with = whole_numbers)] index: usize,
        value: Option<f64>,
    ) -> PyResult<()> {
        self.lock()?.set_load(index, value).or_raise()
    }

    /// Number of steps that last ``duration`` (s), rounded up.
    fn steps_for(&self, duration: f64) -> PyResult<usize> {
        build::steps_for(&*self.lock()?, duration)
    }

    /// The `Checkpoint` of the present state and history, for `resume`.
    fn checkpoint(&self) -> PyResult<PyCheckpoint> {
        take_exception();
        step_result(self.lock()?.checkpoint()).map(PyCheckpoint)
    }

    /// Returns to the state of ``checkpoint`` (a `Checkpoint`), in a simulation that was built in the same way. In a
    /// simulation with other sizes, time step, elements, matrices, static state or label of `ResultOptions`, it raises
    /// a `CheckpointError` that names the difference. The label should name interface law, ground motion and loads.
    ///
    /// Args:
    ///     changes: names of the intended differences, a list; none unless given. "interface_law", "ground_motion" and
    ///         "load" allow another label as well; the other names are "gravity_stage" and "initial_motion".
    #[pyo3(signature = (checkpoint, changes=None))]
    fn resume(&self, checkpoint: &PyCheckpoint, changes: Option<Vec<String>>) -> PyResult<()> {
        take_exception();
        let changes: basemat::Result<Vec<Change>> =
            changes.iter().flatten().map(|name| name.parse()).collect();
        step_result(self.lock()?.resume_changed(&checkpoint.0, &step_result(changes)?))
    }

    /// Returns to the start; further steps have the same bits as the first time.
    ///
    /// As for `checkpoint`, a structure written in Python that has ``commit`` must also have ``save`` and ``restore``.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        take_exception();
        let start = self.start.as_ref().map_err(|reason| reason.clone_ref(py))?;
        // The checkpoint belongs to this simulation, even if loads and laws of the user have changed since.
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
