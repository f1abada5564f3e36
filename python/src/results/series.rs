//! Time series and snapshots as arrays.

use basemat::coupled::{EnergyBalance, EnergyTerm, FaceForces};
use basemat::interface::ContactState;
use basemat::results::{ContactFrame, MotionFrame, Quantity, Run, TimeSeries};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};

use crate::array::{Array, Named, filled};
use crate::error::refuse;
use crate::names::FACES;

/// A scalar, or a probe, by its name.
pub(super) fn named(time_series: &TimeSeries, name: &str) -> PyResult<Array> {
    if name == "time" {
        return Ok(Array::from(time_series.times()));
    }
    if let Ok(values) = time_series.probe(name) {
        return Ok(Array::from(values));
    }
    let in_plan = time_series.in_plan();
    if let Some(quantity) = Quantity::recorded(in_plan).find(|own| own.to_string() == name) {
        return Ok(Array::from(time_series.series(quantity)));
    }
    let words: Vec<_> = Quantity::recorded(in_plan).map(|quantity| quantity.to_string()).collect();
    let (words, names) = (words.join(", "), names(time_series).join(", "));
    let text = format!("'{name}' is neither a time series ({words}) nor a probe ({names})");
    Err(pyo3::exceptions::PyKeyError::new_err(text))
}

/// Names of the probes.
pub(super) fn names(time_series: &TimeSeries) -> Vec<String> {
    time_series.probes().iter().map(|probe| probe.name.clone()).collect()
}

/// All scalars and probes by their names.
pub(super) fn all(time_series: &TimeSeries) -> PyResult<Named<String, Array>> {
    let scalars = Quantity::recorded(time_series.in_plan()).map(|own| own.to_string());
    let all = std::iter::once("time".into()).chain(scalars).chain(names(time_series));
    all.map(|name| named(time_series, &name).map(|values| (name, values))).collect()
}

/// Terms of the energy balance over time.
pub(super) fn energy_balances(time_series: &TimeSeries) -> Named<String, Array> {
    let balances = time_series.energy_balances().iter();
    let terms = EnergyTerm::ALL.map(|term| {
        (term.to_string(), balances.clone().map(|balance| balance.term(term)).collect())
    });
    let residual = balances.clone().map(EnergyBalance::residual).collect();
    let time = ("time".to_owned(), Array::from(time_series.times()));
    [time].into_iter().chain(terms).chain([("residual".to_owned(), residual)]).collect()
}

/// Snapshots of the base: times, and arrays of shape (frames, elements).
pub(super) fn contact<'py>(
    py: Python<'py>,
    time_series: &TimeSeries,
) -> PyResult<Bound<'py, PyDict>> {
    let frames: Vec<ContactFrame<'_>> = time_series.contact_frames().collect();
    if frames.is_empty() {
        return Err(refuse("no contact was kept: give `contact_every` to `run`"));
    }
    let shape = [frames.len(), time_series.elements().len()];
    let columns = PyDict::new(py);
    columns.set_item("time", frames.iter().map(|frame| frame.time).collect::<Array>())?;
    let value = |pick: fn(&ContactState) -> f64| {
        filled(py, shape, frames.iter().flat_map(|frame| frame.states).map(pick))
    };
    let in_plan = time_series.in_plan();
    for (name, _, across, pick) in ContactState::NUMBERS {
        if in_plan || !across {
            columns.set_item(name, value(pick)?)?;
        }
    }
    let modes = frames.iter().flat_map(|frame| frame.modes).map(|mode| *mode as u8);
    columns.set_item("mode", filled(py, shape, modes)?)?;
    Ok(columns)
}

/// Forces on each face that has elements, at the snapshots of the base.
pub(super) fn faces(
    time_series: &TimeSeries,
) -> PyResult<Named<&'static str, Named<&'static str, Array>>> {
    let times: Vec<f64> = time_series.contact_frames().map(|frame| frame.time).collect();
    if times.is_empty() {
        return Err(refuse("no contact was kept: give `contact_every` to `run`"));
    }
    let has_walls = time_series.elements().iter().any(|own| own.directions()[0][2] > -0.5);
    let columns = |face| {
        let forces: Vec<FaceForces> = time_series.face(face).collect();
        let column = |value: fn(&FaceForces) -> f64| forces.iter().map(value).collect::<Array>();
        Named(vec![
            ("time", Array::from(&*times)),
            ("thrust", column(|own| own.thrust)),
            ("shear", column(|own| own.shear)),
            ("place", column(|own| own.place)),
            ("open_fraction", column(|own| own.open_fraction)),
        ])
    };
    let known = FACES.iter().filter(|(name, _)| has_walls || *name == "base");
    Ok(known.map(|(name, face)| (*name, columns(*face))).collect())
}

/// Snapshots of the structure: times, and arrays of shape (frames, n).
pub(super) fn motion<'py>(
    py: Python<'py>,
    time_series: &TimeSeries,
) -> PyResult<Bound<'py, PyDict>> {
    let frames: Vec<_> = time_series.motion_frames().collect();
    let Some(first) = frames.first() else {
        return Err(refuse("no motion was kept: give `motion_every` to `run`"));
    };
    let shape = [frames.len(), first.displacement.len()];
    let all = |pick: for<'a> fn(&'a MotionFrame<'a>) -> &'a [f64]| {
        filled(py, shape, frames.iter().flat_map(pick).copied())
    };
    let columns = PyDict::new(py);
    columns.set_item("time", frames.iter().map(|frame| frame.time).collect::<Array>())?;
    columns.set_item("displacement", all(|frame| frame.displacement)?)?;
    columns.set_item("velocity", all(|frame| frame.velocity)?)?;
    let free_field = frames.iter().flat_map(|frame| frame.free_field);
    columns.set_item("free_field", filled(py, [frames.len(), 2], free_field)?)?;
    if time_series.in_plan() {
        let across = frames.iter().map(|frame| frame.free_field_across);
        columns.set_item("free_field_across", across.collect::<Array>())?;
    }
    Ok(columns)
}

/// Units of the numbers of elements, in snapshots and envelopes.
pub(crate) fn element_units() -> Named<&'static str, &'static str> {
    let contact = ContactState::NUMBERS.map(|(name, unit, ..)| (name, unit)).into_iter();
    contact.chain(Run::ENVELOPE.map(|(name, unit, ..)| (name, unit))).collect()
}
