//! The simulation.

use std::sync::{Mutex, MutexGuard};

use basemat::Simulation;
use basemat::coupled::Checkpoint;
use basemat::results::Recorder;
use numpy::PyArray1;
use pyo3::prelude::*;

use super::build;
use super::watched::{Watched, progress_function};
use super::{PyCheckpoint, PyLoad, PyState, PyTimeScheme};
use crate::array::{Numbers, whole};
use crate::error::{OrRaise, locked, raise, refuse, take_raised};
use crate::ground::PyGround;
use crate::motion::PyFreeField;
use crate::probe::PyProbe;
use crate::results::PyRun;
use crate::{error, interface, motion, structure};

/// A structure on a ground, ready to march.
#[pyclass(name = "Simulation", module = "basemat", frozen)]
pub(crate) struct PySimulation {
    simulation: Mutex<Simulation>,
    /// Length of the motion that it was given, s.
    duration: Option<f64>,
    /// Where it began, or why it cannot go back there.
    start: basemat::Result<Checkpoint>,
}

/// Steps as an iterator: see :meth:`Simulation.steps`.
#[pyclass(name = "Steps", module = "basemat")]
pub(crate) struct PySteps {
    simulation: Py<PySimulation>,
    left: usize,
}

impl PySimulation {
    /// The simulation, unless a run holds it.
    fn lock(&self) -> PyResult<MutexGuard<'_, Simulation>> {
        self.simulation.try_lock().map_err(locked)
    }

    /// Steps asked for directly, by a duration, or to the end of the motion.
    fn count(
        &self,
        py: Python<'_>,
        steps: Option<usize>,
        duration: Option<f64>,
    ) -> PyResult<usize> {
        match (steps, duration, self.duration) {
            (Some(_), Some(_), _) => Err(refuse("give steps or a duration, not both")),
            (Some(steps), None, _) => Ok(steps),
            (None, Some(duration), _) => self.steps_for(duration),
            (None, None, Some(end)) => {
                let (all, made) = (self.steps_for(end)?, self.lock()?.state().step);
                if made < all {
                    return Ok(all - made);
                }
                let text = format!(
                    "the motion ended at {end} s, before these {all} steps: the ground does not \
                     accelerate in them; reset() goes back to the start, and steps or a duration \
                     say that they are meant"
                );
                error::warn(py, text)?;
                Ok(all)
            }
            (None, None, None) => {
                Err(refuse("give steps or a duration: no record says how long to run"))
            }
        }
    }
}

/// Result of a step, after the core has returned.
fn settled<T>(result: basemat::Result<T>) -> PyResult<T> {
    match take_raised() {
        Some(raised) => Err(raised),
        None => result.or_raise(),
    }
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
        allowable_rotation=None, flow_chart_iterations=None,
    ))]
    fn new(
        py: Python<'_>,
        time_step: f64,
        structure: Bound<'_, PyAny>,
        ground: Bound<'_, PyGround>,
        interface: Bound<'_, PyAny>,
        motion: Option<Bound<'_, PyAny>>,
        probes: Option<Vec<Bound<'_, PyProbe>>>,
        loads: Option<Vec<Bound<'_, PyLoad>>>,
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
        #[pyo3(from_py_with = whole)] flow_chart_iterations: Option<usize>,
    ) -> PyResult<Self> {
        take_raised();
        let laws = interface::recipes(&interface)?;
        let laws = laws.iter().map(|make| make()).collect::<basemat::Result<_>>().or_raise()?;
        let structure = structure::recipe(&structure)?().or_raise()?;
        let dofs = structure.dofs();
        let mut builder = Simulation::builder(time_step)
            .structure(structure)
            .ground((ground.get().make)().or_raise()?)
            .interfaces(laws)
            .gravity_stage(build::gravity_stage(gravity_stage)?)
            .contact_search(build::search(flow_chart_iterations))
            .serviceability(build::limits(
                allowable_slip,
                allowable_gap,
                allowable_uplifted_fraction,
                allowable_rotation,
            )?)
            .probes(build::probes(probes.iter().flatten(), dofs)?);
        for load in loads.iter().flatten() {
            load.get().order.check("a load", dofs)?;
            builder = builder.load((load.get().make)().or_raise()?);
        }
        if let Some(motion) = &motion {
            builder = builder.motion((motion::given(motion)?.get().make)().or_raise()?);
        }
        if let Some(gravity) = gravity {
            builder = builder.gravity(gravity);
        }
        if let Some(values) = initial_displacement {
            builder = builder.initial_displacement(values.0);
        }
        if let Some(values) = initial_velocity {
            builder = builder.initial_velocity(values.0);
        }
        if let Some(scheme) = scheme {
            builder = builder.scheme((scheme.get().make)().or_raise()?);
        }
        if let Some(coordinates) = coordinates {
            builder = builder.coordinates(build::coordinates(&coordinates)?);
        }
        if let Some(steps) = expected_steps {
            builder = builder.expected_steps(steps);
        }
        if let Some(x) = moment_center {
            builder = builder.moment_center(x);
        }
        if !energy_balance {
            builder = builder.without_energy_balance();
        }
        if let Some(coefficient) = safety_friction {
            builder = builder.safety_friction(coefficient);
        }
        let simulation = build::build(py, builder)?;
        let motion = motion.as_ref().and_then(|motion| motion.cast::<PyFreeField>().ok());
        let duration = motion.and_then(|motion| motion.get().duration);
        let start = simulation.checkpoint();
        take_raised();
        Ok(Self { simulation: Mutex::new(simulation), duration, start })
    }

    /// Makes ``steps`` steps, or those of a ``duration`` (s); without either, those to the end of the
    /// motion. If that is past, as many as it has, under rest, with a :class:`BasematWarning`:
    /// :meth:`reset` goes back to the start.
    ///
    /// ``progress``: True for a line on stderr, or a function ``(steps done, steps in all)`` that is
    /// called about every 50 ms. ``observe(state)`` is called after every ``observe_every``th step
    /// and ends the run when it returns True; what it raises comes out of here. Ctrl-C is heard, or
    /// a :class:`BasematWarning` says that the process ignores it. In all three cases the
    /// simulation stays at the last accepted step.
    ///
    /// Time series are kept of every ``every``th step (all: needed for floor spectra), contact of
    /// every ``contact_every``th and the structure's motion of every ``motion_every``th (none unless
    /// given). ``series=False`` keeps no time series at all.
    ///
    /// Every warning in :attr:`Run.warnings` is also a :class:`BasematWarning`, unless ``warn=False``.
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
        let steps = self.count(py, steps, duration)?;
        if observe_every == 0 {
            return Err(refuse("observe_every is 0, but must be one or more"));
        }
        let mut recorder = Recorder::new().every(every);
        if let Some(every) = contact_every {
            recorder = recorder.contact(every);
        }
        if let Some(every) = motion_every {
            recorder = recorder.motion(every);
        }
        let progress = progress_function(progress)?;
        take_raised();
        let run = py.detach(|| {
            let mut simulation = self.lock()?;
            let mut histories =
                series.then(|| recorder.start(&simulation)).transpose().or_raise()?;
            if let Some(histories) = &mut histories {
                histories.reserve(steps);
            }
            let mut watched = Watched::new(progress, steps, observe, observe_every, histories);
            let result = simulation.run(steps, |state| watched.see(state));
            watched.end(result)
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
        let left = slf.get().count(slf.py(), steps, duration)?;
        Ok(PySteps { simulation: slf.unbind(), left })
    }

    /// The state at the end of the last accepted step (at first: the static state).
    #[getter]
    fn state(&self) -> PyResult<PyState> {
        Ok(PyState(self.lock()?.state().clone()))
    }

    /// Time step, s.
    #[getter]
    fn time_step(&self) -> PyResult<f64> {
        Ok(self.lock()?.time_step())
    }

    /// Names of the probes.
    #[getter]
    fn probe_names(&self) -> PyResult<Vec<String>> {
        Ok(self.lock()?.probes().iter().map(|probe| probe.name.clone()).collect())
    }

    /// Ends of the contact elements: list of (left, right), m.
    #[getter]
    fn elements(&self) -> PyResult<Vec<(f64, f64)>> {
        Ok(self.lock()?.elements().iter().map(|e| (e.left, e.right)).collect())
    }

    /// Static displacement of the degrees of freedom: array of shape (n,), m and rad.
    #[getter]
    fn static_displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, self.lock()?.static_displacement()))
    }

    /// Which history the ground keeps and why, in words; None if it has not chosen one yet.
    #[getter]
    fn history_choice(&self) -> PyResult<Option<String>> {
        Ok(self.lock()?.history_choice().map(|choice| choice.to_string()))
    }

    /// Condition numbers of the matrices of a step: effective stiffness, ground, Delassus operator.
    #[getter]
    fn conditioning(&self) -> PyResult<(f64, f64, f64)> {
        let conditioning = self.lock()?.conditioning();
        Ok((conditioning.effective_stiffness, conditioning.ground, conditioning.delassus))
    }

    /// Number of steps that last ``duration`` (s), rounded up.
    fn steps_for(&self, duration: f64) -> PyResult<usize> {
        if !duration.is_finite() || duration < 0.0 {
            return Err(refuse(format!(
                "duration is {duration} s, but must be finite and 0 or more"
            )));
        }
        Ok(self.lock()?.steps_for(duration))
    }

    /// All that the steps so far have left behind, for :meth:`resume`.
    fn checkpoint(&self) -> PyResult<PyCheckpoint> {
        take_raised();
        settled(self.lock()?.checkpoint()).map(PyCheckpoint)
    }

    /// Goes to where ``checkpoint`` was made, in a simulation that was built in the same way.
    fn resume(&self, checkpoint: &PyCheckpoint) -> PyResult<()> {
        take_raised();
        settled(self.lock()?.resume(&checkpoint.0))
    }

    /// Goes back to the start: what follows has the bits that it had from there.
    ///
    /// Needs what :meth:`checkpoint` needs: a structure of the user's that has ``commit`` also has
    /// ``save`` and ``restore``.
    fn reset(&self) -> PyResult<()> {
        take_raised();
        let start = self.start.as_ref().map_err(|reason| raise(reason.clone()))?;
        settled(self.lock()?.resume(start))
    }

    fn __repr__(&self) -> String {
        let reason = if self.simulation.is_poisoned() { "unusable" } else { "running" };
        self.lock().map_or_else(
            |_| format!("Simulation({reason})"),
            |simulation| {
                format!(
                    "Simulation(step {}, {} s)",
                    simulation.state().step,
                    simulation.state().time
                )
            },
        )
    }
}

#[pymethods]
impl PySteps {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<PyState>> {
        if self.left == 0 {
            return Ok(None);
        }
        py.check_signals()?;
        let state = self.simulation.get().step(py)?;
        self.left -= 1;
        Ok(Some(state))
    }

    fn __len__(&self) -> usize {
        self.left
    }
}
