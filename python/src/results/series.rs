//! Time series and snapshots as arrays.

use basemat::coupled::{EnergyBalance, EnergyTerm, FaceForces};
use basemat::interface::ContactState;
use basemat::results::{ContactFrame, Quantity, Run, TimeSeries};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyDictMethods};

use crate::array::{Array, OrderedDict, filled_array};
use crate::error::input_error;
use crate::ground::is_base_element;
use crate::names::TRENCH_FACES;

/// Time series of a scalar or a probe by its name.
pub(super) fn series_named(time_series: &TimeSeries, name: &str) -> PyResult<Array> {
    if name == "time" {
        return Ok(Array::from(time_series.times()));
    }
    if let Ok(values) = time_series.probe(name) {
        return Ok(Array::from(values));
    }
    let in_plan = time_series.in_plan();
    if let Some(quantity) =
        Quantity::recorded(in_plan).find(|quantity| quantity.to_string() == name)
    {
        return Ok(Array::from(time_series.series(quantity)));
    }
    let scalar_names: Vec<_> =
        Quantity::recorded(in_plan).map(|quantity| quantity.to_string()).collect();
    let scalars = scalar_names.join(", ");
    let probes = probe_names(time_series).join(", ");
    let text = format!("'{name}' is neither a time series ({scalars}) nor a probe ({probes})");
    Err(pyo3::exceptions::PyKeyError::new_err(text))
}

/// Names of the probes.
pub(super) fn probe_names(time_series: &TimeSeries) -> Vec<String> {
    time_series.probes().iter().map(|probe| probe.name.clone()).collect()
}

/// All scalars and probes by their names.
pub(super) fn all_series(time_series: &TimeSeries) -> PyResult<OrderedDict<String, Array>> {
    let scalars = Quantity::recorded(time_series.in_plan()).map(|quantity| quantity.to_string());
    let names = std::iter::once("time".into()).chain(scalars).chain(probe_names(time_series));
    names
        .map(|name| series_named(time_series, &name).map(|values| (name, values)))
        .collect()
}

/// Terms of the energy balance over time.
pub(super) fn energy_balances(time_series: &TimeSeries) -> OrderedDict<String, Array> {
    let balances = time_series.energy_balances().iter();
    let terms = EnergyTerm::ALL_TERMS.map(|term| {
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
    contact_arrays(py, &frames, time_series.in_plan())
}

/// Snapshots of a base or a joint: times, and arrays of shape (frames, elements).
pub(super) fn contact_arrays<'py>(
    py: Python<'py>,
    frames: &[ContactFrame<'_>],
    in_plan: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let Some(first_frame) = frames.first() else {
        return Err(input_error("no contact was recorded: give `contact_every` to `run`"));
    };
    let shape = [frames.len(), first_frame.states.len()];
    let columns = PyDict::new(py);
    columns.set_item("time", frames.iter().map(|frame| frame.time).collect::<Array>())?;
    for (name, _, is_plan_only, value) in ContactState::NUMBER_COLUMNS {
        if in_plan || !is_plan_only {
            let values = frames.iter().flat_map(|frame| frame.states).map(value);
            columns.set_item(name, filled_array(py, shape, values)?)?;
        }
    }
    let modes = frames.iter().flat_map(|frame| frame.modes).map(|mode| *mode as u8);
    columns.set_item("mode", filled_array(py, shape, modes)?)?;
    Ok(columns)
}

/// Forces on each face that has elements, at the snapshots of the base.
pub(super) fn faces(
    time_series: &TimeSeries,
) -> PyResult<OrderedDict<&'static str, OrderedDict<&'static str, Array>>> {
    let times: Vec<f64> = time_series.contact_frames().map(|frame| frame.time).collect();
    if times.is_empty() {
        return Err(input_error("no contact was recorded: give `contact_every` to `run`"));
    }
    let mut elements = time_series.elements().iter();
    let has_walls = elements.any(|element| !is_base_element(element));
    let present_faces = TRENCH_FACES.iter().filter(|(name, _)| has_walls || *name == "base");
    let forces_by_face = present_faces.map(|(name, face)| {
        let forces: Vec<FaceForces> = time_series.face(*face).collect();
        let columns = OrderedDict(vec![
            ("time", Array::from(&*times)),
            ("thrust", forces.iter().map(|force| force.thrust).collect()),
            ("shear", forces.iter().map(|force| force.shear).collect()),
            ("place", forces.iter().map(|force| force.place).collect()),
            ("open_fraction", forces.iter().map(|force| force.open_fraction).collect()),
        ]);
        (*name, columns)
    });
    Ok(forces_by_face.collect())
}

/// Snapshots of the structure: times, and arrays of shape (frames, n).
pub(super) fn motion<'py>(
    py: Python<'py>,
    time_series: &TimeSeries,
) -> PyResult<Bound<'py, PyDict>> {
    let frames: Vec<_> = time_series.motion_frames().collect();
    let Some(first_frame) = frames.first() else {
        return Err(input_error("no motion was recorded: give `motion_every` to `run`"));
    };
    let shape = [frames.len(), first_frame.displacement.len()];
    let columns = PyDict::new(py);
    columns.set_item("time", frames.iter().map(|frame| frame.time).collect::<Array>())?;
    let displacements = frames.iter().flat_map(|frame| frame.displacement).copied();
    columns.set_item("displacement", filled_array(py, shape, displacements)?)?;
    let velocities = frames.iter().flat_map(|frame| frame.velocity).copied();
    columns.set_item("velocity", filled_array(py, shape, velocities)?)?;
    let free_field = frames.iter().flat_map(|frame| frame.free_field);
    columns.set_item("free_field", filled_array(py, [frames.len(), 2], free_field)?)?;
    if time_series.in_plan() {
        let displacements_y = frames.iter().map(|frame| frame.free_field_across);
        columns.set_item("free_field_across", displacements_y.collect::<Array>())?;
    }
    Ok(columns)
}

/// SI units of the time series and of the energies, by their names.
pub(super) fn units(run: &Run) -> OrderedDict<String, &str> {
    let in_plan = run.in_plan;
    let scalars =
        Quantity::recorded(in_plan).map(|quantity| (quantity.to_string(), quantity.unit(in_plan)));
    let probes = run.probes.iter().map(|probe| (probe.name.clone(), probe.unit.as_str()));
    let energy_unit = if in_plan { "J" } else { "J/m" };
    let terms = EnergyTerm::ALL_TERMS.map(|term| (term.to_string(), energy_unit));
    let time = [("time".to_owned(), "s")].into_iter();
    time.chain(scalars).chain(probes).chain(terms).collect()
}

/// Results of a run for a table, in addition to the peaks of its scalars.
pub(super) fn scalar_results(run: &Run) -> [(&'static str, Option<f64>); 10] {
    [
        ("end", Some(run.end)),
        ("shear_coefficient", run.shear_coefficient()),
        ("uplift_duration", Some(run.whole.uplift.duration)),
        ("largest_gap", Some(run.largest_gap().value)),
        ("largest_pressure", run.largest_pressure().map(|(_, peak)| peak.value)),
        ("residual_slip", Some(run.whole.residual_slip)),
        ("residual_settlement", Some(run.whole.residual_settlement)),
        ("residual_rotation", Some(run.whole.residual_rotation)),
        ("energy_input", Some(run.energy_balance.input)),
        ("energy_error", Some(run.energy_error)),
    ]
}

/// Envelopes of the elements, by their names.
pub(super) fn envelope(run: &Run) -> OrderedDict<&'static str, Array> {
    let columns = Run::ENVELOPE_COLUMNS.into_iter().filter(|(_, _, is_present, _)| is_present(run));
    columns
        .map(|(name, .., value)| (name, run.envelope.iter().map(value).collect()))
        .collect()
}

/// Units of the numbers of elements, in snapshots and envelopes.
pub(crate) fn element_units() -> OrderedDict<&'static str, &'static str> {
    let contact = ContactState::NUMBER_COLUMNS.map(|(name, unit, ..)| (name, unit)).into_iter();
    contact.chain(Run::ENVELOPE_COLUMNS.map(|(name, unit, ..)| (name, unit))).collect()
}
