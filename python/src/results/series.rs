//! Time series and snapshots as arrays.

use basemat::coupled::{EnergyBalance, EnergyTerm};
use basemat::interface::ContactState;
use basemat::results::{ContactFrame, MotionFrame, Quantity, TimeSeries};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyDictMethods};

use crate::array::Array;
use crate::error::refuse;
use crate::names::mode_number;

/// A scalar, or a probe, by its name.
pub(super) fn named(histories: &TimeSeries, name: &str) -> PyResult<Array> {
    if name == "time" {
        return Ok(Array::from(histories.times()));
    }
    if let Ok(values) = histories.probe(name) {
        return Ok(Array::from(values));
    }
    let in_plan = !histories.depths().is_empty();
    let words: Vec<_> = Quantity::of(in_plan).map(|quantity| quantity.to_string()).collect();
    match words.iter().zip(Quantity::of(in_plan)).find(|(word, _)| *word == name) {
        Some((_, quantity)) => Ok(Array::from(histories.series(quantity))),
        None => Err(pyo3::exceptions::PyKeyError::new_err(format!(
            "'{name}' is neither a time series ({}) nor a probe ({})",
            words.join(", "),
            names(histories).join(", ")
        ))),
    }
}

/// Names of the probes.
pub(super) fn names(histories: &TimeSeries) -> Vec<String> {
    histories.probes().iter().map(|probe| probe.name.clone()).collect()
}

/// All scalars and probes by their names.
pub(super) fn all<'py>(py: Python<'py>, histories: &TimeSeries) -> PyResult<Bound<'py, PyDict>> {
    let time = ("time".to_owned(), Array::from(histories.times()));
    let scalars = Quantity::of(!histories.depths().is_empty())
        .map(|quantity| (quantity.to_string(), Array::from(histories.series(quantity))));
    let series = std::iter::once(time).chain(scalars).into_py_dict(py)?;
    for name in names(histories) {
        series.set_item(&name, named(histories, &name)?)?;
    }
    Ok(series)
}

/// Terms of the energy balance over time.
pub(super) fn energy_balances<'py>(
    py: Python<'py>,
    histories: &TimeSeries,
) -> PyResult<Bound<'py, PyDict>> {
    let balances = histories.energy_balances().iter();
    let terms = EnergyTerm::ALL.map(|term| {
        (term.to_string(), balances.clone().map(|balance| balance.term(term)).collect::<Array>())
    });
    let series = [("time", Array::from(histories.times()))].into_py_dict(py)?;
    series.update(terms.into_py_dict(py)?.as_mapping())?;
    series.set_item("residual", balances.map(EnergyBalance::residual).collect::<Array>())?;
    Ok(series)
}

/// Name and value of a column of a snapshot of the base.
type Column = (&'static str, fn(&ContactState) -> f64);

/// Snapshots of the base: times, and arrays of shape (frames, elements).
pub(super) fn contact<'py>(
    py: Python<'py>,
    histories: &TimeSeries,
) -> PyResult<Bound<'py, PyDict>> {
    let frames: Vec<ContactFrame<'_>> = histories.contact_frames().collect();
    if frames.is_empty() {
        return Err(refuse("no contact was kept: give `contact_every` to `run`"));
    }
    let shape = [frames.len(), histories.elements().len()];
    let columns = PyDict::new(py);
    columns.set_item("time", frames.iter().map(|frame| frame.time).collect::<Array>())?;
    let value = |pick: fn(&ContactState) -> f64| {
        let values = frames.iter().flat_map(|frame| frame.states).map(pick);
        PyArray1::from_iter(py, values).reshape(shape)
    };
    let all: [Column; 6] = [
        ("gap", |state| state.gap),
        ("slip", |state| state.slip),
        ("pressure", |state| state.pressure),
        ("shear", |state| state.shear),
        ("slip_across", |state| state.slip_across),
        ("shear_across", |state| state.shear_across),
    ];
    let count = if histories.depths().is_empty() { 4 } else { 6 };
    for (name, pick) in &all[..count] {
        columns.set_item(name, value(*pick)?)?;
    }
    let modes = frames.iter().flat_map(|frame| frame.modes).map(|mode| mode_number(*mode));
    let modes = modes.collect::<PyResult<Vec<_>>>()?;
    columns.set_item("mode", PyArray1::from_vec(py, modes).reshape(shape)?)?;
    Ok(columns)
}

/// Snapshots of the structure: times, and arrays of shape (frames, n).
pub(super) fn motion<'py>(py: Python<'py>, histories: &TimeSeries) -> PyResult<Bound<'py, PyDict>> {
    let frames: Vec<_> = histories.motion_frames().collect();
    let Some(first) = frames.first() else {
        return Err(refuse("no motion was kept: give `motion_every` to `run`"));
    };
    let shape = [frames.len(), first.displacement.len()];
    let all = |pick: fn(&MotionFrame<'_>) -> Vec<f64>, shape: [usize; 2]| {
        PyArray1::from_vec(py, frames.iter().flat_map(pick).collect()).reshape(shape)
    };
    let columns = PyDict::new(py);
    columns.set_item("time", frames.iter().map(|frame| frame.time).collect::<Array>())?;
    columns.set_item("displacement", all(|frame| frame.displacement.to_vec(), shape)?)?;
    columns.set_item("velocity", all(|frame| frame.velocity.to_vec(), shape)?)?;
    let two = [frames.len(), 2];
    columns.set_item("free_field", all(|frame| frame.free_field.to_vec(), two)?)?;
    if !histories.depths().is_empty() {
        let across = frames.iter().map(|frame| frame.free_field_across);
        columns.set_item("free_field_across", across.collect::<Array>())?;
    }
    Ok(columns)
}
