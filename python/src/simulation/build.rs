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

/// Coordinates by their name, or reduced ones by their tolerance.
pub(super) fn coordinates(argument: &Bound<'_, PyAny>) -> PyResult<Coordinates> {
    match argument.extract::<f64>() {
        Ok(tolerance) => Ok(Coordinates::Reduced { tolerance }),
        Err(_) => argument.extract::<String>()?.parse().or_raise(),
    }
}

/// The probes of a structure with this number of degrees of freedom.
///
/// An error if one has the name of another time series of a run.
pub(super) fn probes<'a, 'py: 'a>(
    python_probes: impl Iterator<Item = &'a Bound<'py, PyProbe>>,
    dofs: usize,
) -> PyResult<Vec<Probe>> {
    let mut probes = Vec::new();
    for probe in python_probes {
        let PyProbe(probe, weight_count) = probe.get();
        weight_count.check(&format!("the probe '{}'", probe.name), dofs)?;
        let name = probe.name.as_str();
        if name == "time" || Quantity::ALL_QUANTITIES.iter().any(|quantity| quantity.to_string() == name) {
            return Err(input_error(format!(
                "a probe is called '{name}', but that is another time series of a run"
            )));
        }
        probes.push(probe.clone());
    }
    Ok(probes)
}

/// Name of the parts of the work that a line of progress counts before the steps.
pub(super) const COEFFICIENT_PARTS: &str = "parts of the ground's coefficients";

/// Locks the observer of a build; a panic leaves it whole.
fn lock(observer: &Mutex<ProgressObserver>) -> MutexGuard<'_, ProgressObserver> {
    observer.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Builds without the GIL.
pub(super) fn build(
    py: Python<'_>,
    builder: SimulationBuilder,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Simulation> {
    let progress = progress_function(progress, COEFFICIENT_PARTS)?;
    py.detach(move || {
        let observer = Arc::new(Mutex::new(ProgressObserver::new(progress)));
        let shared = Arc::clone(&observer);
        let result = builder.observer(move |progress| lock(&shared).update(progress)).build();
        lock(&observer).end(result)
    })
}

/// The checkpoint at the start of a simulation, or why there is none.
pub(super) fn start(simulation: &Simulation) -> PyResult<Checkpoint> {
    step_result(simulation.checkpoint())
}

/// Number of steps that last so long, rounded up.
pub(super) fn steps_for(simulation: &Simulation, duration: f64) -> PyResult<usize> {
    if !duration.is_finite() || duration < 0.0 {
        return Err(input_error(format!(
            "duration is {duration} s, but must be finite and 0 or more"
        )));
    }
    Ok(simulation.steps_for(duration))
}

/// Recorder of the scalars of every `every`th step, and of the frames that are given.
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

/// Error unless the observer of a run is a function that is called every `observe_every` steps, one or more.
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

/// Number of steps of a run: the argument `steps`, or those of a duration, or those to the `end` of the motion.
pub(super) fn count(
    py: Python<'_>,
    simulation: &Simulation,
    end: Option<f64>,
    steps: Option<usize>,
    duration: Option<f64>,
) -> PyResult<usize> {
    match (steps, duration, end) {
        (Some(_), Some(_), _) => Err(input_error("give steps or a duration, not both")),
        (Some(steps), None, _) => Ok(steps),
        (None, Some(duration), _) => steps_for(simulation, duration),
        (None, None, Some(end)) => {
            let all = steps_for(simulation, end)?;
            let done = simulation.state().step;
            if done < all {
                return Ok(all - done);
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
            Err(input_error("give steps or a duration: no record says how long to run"))
        }
    }
}
