//! Conversion of Python's arguments to a simulation of the core.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use basemat::Simulation;
use basemat::coupled::{Checkpoint, Coordinates, Probe, SimulationBuilder};
use basemat::results::{Quantity, Recorder};
use pyo3::prelude::*;

use super::run_reporter::step_result;
use crate::error::{self, OrRaise, input_error};
use crate::probe::PyProbe;
use crate::ticker::{ProgressObserver, progress_function};

/// Coordinates from a Python argument: their name, or a number for reduced coordinates with this tolerance.
pub(super) fn coordinates(argument: &Bound<'_, PyAny>) -> PyResult<Coordinates> {
    match argument.extract::<f64>() {
        Ok(tolerance) => Ok(Coordinates::Reduced { tolerance }),
        Err(_) => argument.extract::<String>()?.parse().or_raise(),
    }
}

/// The probes of a structure with this number of degrees of freedom.
///
/// It is an error if a probe has the name of another time series of a run.
pub(super) fn probes<'a, 'py: 'a>(
    python_probes: impl Iterator<Item = &'a Bound<'py, PyProbe>>,
    dof_count: usize,
) -> PyResult<Vec<Probe>> {
    let mut probes = Vec::new();
    for probe in python_probes {
        let PyProbe(probe, weight_count) = probe.get();
        weight_count.check(&format!("the probe '{}'", probe.name), dof_count)?;
        let name = probe.name.as_str();
        if name == "time"
            || Quantity::ALL_QUANTITIES.iter().any(|quantity| quantity.to_string() == name)
        {
            return Err(input_error(format!(
                "a probe is called '{name}', but this is the name of another time series of a run"
            )));
        }
        probes.push(probe.clone());
    }
    Ok(probes)
}

/// Name of the items that a line of progress counts before the steps.
pub(super) const COEFFICIENT_PARTS: &str = "parts of the ground's coefficients";

/// Locks the observer of a build; it stays valid after a panic.
fn lock(observer: &Mutex<ProgressObserver>) -> MutexGuard<'_, ProgressObserver> {
    observer.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Builds a simulation without the GIL.
pub(super) fn build(
    py: Python<'_>,
    builder: SimulationBuilder,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Simulation> {
    let report_progress = progress_function(progress, COEFFICIENT_PARTS)?;
    py.detach(move || {
        let observer = Arc::new(Mutex::new(ProgressObserver::new(report_progress)));
        let builder_observer = Arc::clone(&observer);
        let result =
            builder.observer(move |progress| lock(&builder_observer).update(progress)).build();
        lock(&observer).end(result)
    })
}

/// Checkpoint at the start of a simulation, or the reason why it has none.
pub(super) fn start_checkpoint(simulation: &Simulation) -> PyResult<Checkpoint> {
    step_result(simulation.checkpoint())
}

/// Number of steps in a duration (s), rounded up.
pub(super) fn steps_for(simulation: &Simulation, duration: f64) -> PyResult<usize> {
    if !duration.is_finite() || duration < 0.0 {
        return Err(input_error(format!(
            "duration is {duration} s, but must be finite and 0 or more"
        )));
    }
    Ok(simulation.steps_for(duration))
}

/// Recorder of scalars, and of those frames whose interval in steps is given.
pub(super) fn recorder(
    every: usize,
    contact_every: Option<usize>,
    motion_every: Option<usize>,
    foundations: bool,
) -> Recorder {
    let mut recorder = Recorder::new().every(every);
    if let Some(every) = contact_every {
        recorder = recorder.contact(every);
    }
    if let Some(every) = motion_every {
        recorder = recorder.motion(every);
    }
    if foundations { recorder.foundations() } else { recorder }
}

/// Error unless the observer of a run is a function and its interval one step or more.
pub(super) fn check_observer(
    py: Python<'_>,
    observe: Option<&Py<PyAny>>,
    observe_every: usize,
) -> PyResult<()> {
    if observe_every == 0 {
        return Err(input_error("observe_every is 0, but must be one or more"));
    }
    if observe.is_some_and(|observe| !observe.bind(py).is_callable()) {
        return Err(input_error("observe must be a function of a state"));
    }
    Ok(())
}

/// Number of steps of a run: `steps`, or the steps of a duration (s), or the steps up to the `motion_end` (s).
pub(super) fn run_step_count(
    py: Python<'_>,
    simulation: &Simulation,
    motion_end: Option<f64>,
    steps: Option<usize>,
    duration: Option<f64>,
) -> PyResult<usize> {
    match (steps, duration, motion_end) {
        (Some(_), Some(_), _) => Err(input_error("give steps or a duration, not both")),
        (Some(steps), None, _) => Ok(steps),
        (None, Some(duration), _) => steps_for(simulation, duration),
        (None, None, Some(motion_end)) => {
            let motion_steps = steps_for(simulation, motion_end)?;
            let steps_made = simulation.state().step;
            if steps_made < motion_steps {
                return Ok(motion_steps - steps_made);
            }
            let text = format!(
                "the motion ended at {motion_end} s, before these {motion_steps} steps: the ground does not \
                 accelerate in them. Call reset() to return to the start, or give steps or a \
                 duration to avoid this warning"
            );
            error::warn(py, text)?;
            Ok(motion_steps)
        }
        (None, None, None) => Err(missing_end_error("steps or a duration")),
    }
}

/// Error for a motion without an end, for which the user must give these `arguments`.
pub(super) fn missing_end_error(arguments: &str) -> PyErr {
    input_error(format!("give {arguments}: the motion has no record with an end"))
}
