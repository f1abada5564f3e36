//! From Python's arguments to a simulation of the core.

use basemat::Simulation;
use basemat::coupled::{ContactSearch, Coordinates, Placement, SimulationBuilder};
use basemat::results::Serviceability;
use pyo3::prelude::*;

use crate::error::{OrRaise, refuse};

/// A placement by its name.
pub(super) fn placement(name: &str) -> PyResult<Placement> {
    match name {
        "frictionless" => Ok(Placement::Frictionless),
        "with interface law" => Ok(Placement::WithInterfaceLaw),
        "unloaded" => Ok(Placement::Unloaded),
        _ => Err(refuse(format!(
            "placement is '{name}', but must be 'frictionless', 'with interface law' or 'unloaded'"
        ))),
    }
}

/// Coordinates by their name, or the tolerance of reduced ones.
pub(super) fn coordinates(given: &Bound<'_, PyAny>) -> PyResult<Coordinates> {
    if let Ok(tolerance) = given.extract::<f64>() {
        return Ok(Coordinates::Reduced { tolerance });
    }
    match given.extract::<String>()?.as_str() {
        "auto" => Ok(Coordinates::Auto),
        "unknowns" => Ok(Coordinates::Unknowns),
        "modes" => Ok(Coordinates::Modes),
        name => Err(refuse(format!(
            "coordinates are '{name}', but must be 'auto', 'unknowns', 'modes' or the tolerance of \
             reduced ones"
        ))),
    }
}

/// Limits of service, each if it is given.
pub(super) fn limits(
    slip: Option<f64>,
    gap: Option<f64>,
    uplifted_fraction: Option<f64>,
    rotation: Option<f64>,
) -> PyResult<Serviceability> {
    let mut limits = Serviceability::new();
    if let Some(limit) = slip {
        limits = limits.with_slip(limit).or_raise()?;
    }
    if let Some(limit) = gap {
        limits = limits.with_gap(limit).or_raise()?;
    }
    if let Some(limit) = uplifted_fraction {
        limits = limits.with_uplifted_fraction(limit).or_raise()?;
    }
    if let Some(limit) = rotation {
        limits = limits.with_rotation(limit).or_raise()?;
    }
    Ok(limits)
}

/// The search that follows the paper's flow chart with so many iterations, or the robust one.
pub(super) fn search(flow_chart: Option<usize>) -> ContactSearch {
    flow_chart.map_or(ContactSearch::Robust, |iterations| ContactSearch::FlowChart { iterations })
}

/// Builds without the GIL.
pub(super) fn build(py: Python<'_>, builder: SimulationBuilder) -> PyResult<Simulation> {
    let built = py.detach(move || builder.build());
    match crate::error::take_raised() {
        Some(raised) => Err(raised),
        None => built.or_raise(),
    }
}
