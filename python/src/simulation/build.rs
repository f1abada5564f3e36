//! From Python's arguments to a simulation of the core.

use basemat::Simulation;
use basemat::contact::ContactSearch;
use basemat::coupled::{Checkpoint, Coordinates, GravityStage, Probe, SimulationBuilder};
use basemat::results::{Quantity, Serviceability};
use pyo3::prelude::*;

use crate::error::{OrRaise, refuse, take_raised};
use crate::probe::PyProbe;
use crate::ticker::{progress_function, watched};

/// A gravity stage by its name.
pub(super) fn gravity_stage(name: &str) -> PyResult<GravityStage> {
    name.parse().or_raise()
}

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

/// Limits of service, each if it is given.
pub(super) fn limits(
    slip: Option<f64>,
    gap: Option<f64>,
    uplifted_fraction: Option<f64>,
    rotation: Option<f64>,
) -> Serviceability {
    Serviceability { slip, gap, uplifted_fraction, rotation }
}

/// The search that follows the paper's flow chart with so many iterations, or the robust one.
pub(super) fn search(flow_chart: Option<usize>) -> ContactSearch {
    flow_chart.map_or(ContactSearch::Robust, |iterations| ContactSearch::FlowChart { iterations })
}

/// What a line of progress counts before the steps.
pub(super) const COEFFICIENTS: &str = "parts of the ground's coefficients";

/// Builds without the GIL.
pub(super) fn build(
    py: Python<'_>,
    builder: SimulationBuilder,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Simulation> {
    let progress = progress_function(progress, COEFFICIENTS)?;
    py.detach(move || watched(progress, |observer| builder.build_observed(observer)))
}

/// The checkpoint at the start of a simulation, or why there is none.
pub(super) fn start(simulation: &Simulation) -> basemat::Result<Checkpoint> {
    let found = simulation.checkpoint();
    match take_raised() {
        Some(reason) => Err(basemat::Error::part("structure", reason.to_string())),
        None => found,
    }
}
