//! Conversion of Python's arguments to a simulation of the core.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use basemat::Simulation;
use basemat::coupled::{Checkpoint, Coordinates, Probe, SimulationBuilder};
use basemat::results::Quantity;
use pyo3::prelude::*;

use super::watched::settled;
use crate::error::{self, OrRaise, refuse};
use crate::probe::PyProbe;
use crate::ticker::{Watching, progress_function};

/// Coordinates by their name, or the tolerance of reduced ones.
pub(super) fn coordinates(given: &Bound<'_, PyAny>) -> PyResult<Coordinates> {
    match given.extract::<f64>() {
        Ok(tolerance) => Ok(Coordinates::Reduced { tolerance }),
        Err(_) => given.extract::<String>()?.parse().or_raise(),
    }
}

/// The probes of a structure of so many degrees of freedom, none of which has the name of another time series of a run.
pub(super) fn probes<'a, 'py: 'a>(
    given: impl Iterator<Item = &'a Bound<'py, PyProbe>>,
    dofs: usize,
) -> PyResult<Vec<Probe>> {
    given
        .map(|probe| {
            let PyProbe(probe, order) = probe.get();
            order.check(&format!("the probe '{}'", probe.name), dofs)?;
            let name = probe.name.as_str();
            if name == "time" || Quantity::ALL.iter().any(|own| own.to_string() == name) {
                return Err(refuse(format!(
                    "a probe is called '{name}', but that is another time series of a run"
                )));
            }
            Ok(probe.clone())
        })
        .collect()
}

/// Task that a line of progress counts before the steps.
pub(super) const COEFFICIENTS: &str = "parts of the ground's coefficients";

/// Locks the observer of a build; a panic leaves it whole.
fn lock(watching: &Mutex<Watching>) -> MutexGuard<'_, Watching> {
    watching.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Builds without the GIL.
pub(super) fn build(
    py: Python<'_>,
    builder: SimulationBuilder,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Simulation> {
    let progress = progress_function(progress, COEFFICIENTS)?;
    py.detach(move || {
        let watching = Arc::new(Mutex::new(Watching::new(progress)));
        let own = Arc::clone(&watching);
        let result = builder.observer(move |progress| lock(&own).see(progress)).build();
        lock(&watching).end(result)
    })
}

/// The checkpoint at the start of a simulation, or why there is none.
pub(super) fn start(simulation: &Simulation) -> PyResult<Checkpoint> {
    settled(simulation.checkpoint())
}

/// Number of steps that last so long, rounded up.
pub(super) fn steps_for(simulation: &Simulation, duration: f64) -> PyResult<usize> {
    if !duration.is_finite() || duration < 0.0 {
        return Err(refuse(format!("duration is {duration} s, but must be finite and 0 or more")));
    }
    Ok(simulation.steps_for(duration))
}

/// Steps asked for directly, by a duration, or to the `end` of the motion.
pub(super) fn count(
    py: Python<'_>,
    simulation: &Simulation,
    end: Option<f64>,
    steps: Option<usize>,
    duration: Option<f64>,
) -> PyResult<usize> {
    match (steps, duration, end) {
        (Some(_), Some(_), _) => Err(refuse("give steps or a duration, not both")),
        (Some(steps), None, _) => Ok(steps),
        (None, Some(duration), _) => steps_for(simulation, duration),
        (None, None, Some(end)) => {
            let (all, made) = (steps_for(simulation, end)?, simulation.state().step);
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
