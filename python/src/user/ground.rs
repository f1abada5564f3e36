//! A ground written in Python.

use basemat::bem::{ContactElement, Ground, GroundDescription};
use basemat::coupled::CheckpointError;
use basemat::{Error, Observer, Result};
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use super::object::{UserObject, deep_copy};
use crate::array::{Array, Numbers, Table};
use crate::error::{discard_exceptions, extract_returned, input_error, store_exception};

/// Name of this kind of part in errors.
const PART_NAME: &str = "ground";

/// A Python object with `elements`, `static_compliance()`, `step_compliance(time_step)` and `advance(traction)`.
///
/// Optional are `save()`, `restore(values)` and `shear_wave_speed`.
pub(crate) struct UserGround {
    object: UserObject,
    elements: Vec<ContactElement>,
    /// Length of a contact vector.
    size: usize,
    shear_wave_speed: Option<f64>,
    /// Step compliance; empty before `prepare`.
    step: Vec<f64>,
    /// Time step of the simulation: the first for which the ground was prepared, s.
    time_step: Option<f64>,
    /// Displacement at the end of the next step by all tractions so far; `None` after an exception of `advance`.
    history: Option<Vec<f64>>,
}

impl UserGround {
    /// The ground of one simulation: a deep copy of the object, so that simulations do not share its past tractions.
    ///
    /// `contact_elements` reads its `elements`.
    pub(crate) fn new(
        ground: &Bound<'_, PyAny>,
        contact_elements: fn(&Bound<'_, PyAny>) -> PyResult<Vec<ContactElement>>,
    ) -> PyResult<Self> {
        let copy = deep_copy(ground)?;
        let elements = copy.getattr("elements")?;
        let elements = if elements.is_callable() { elements.call0()? } else { elements };
        let elements = contact_elements(&elements).map_err(|reason| {
            input_error(format!("elements of the ground: {}", reason.value(copy.py())))
        })?;
        let size = elements.iter().map(|element| element.directions().len()).sum();
        let speed = copy.getattr_opt("shear_wave_speed")?.filter(|speed| !speed.is_none());
        let name = "shear_wave_speed of the ground";
        Ok(Self {
            object: UserObject::new(&copy, PART_NAME, &["save"])?,
            elements,
            size,
            shear_wave_speed: speed.map(|speed| extract_returned(name, &speed)).transpose()?,
            step: Vec::new(),
            time_step: None,
            history: Some(vec![0.0; size]),
        })
    }

    /// The object that is called.
    pub(crate) fn object<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        self.object.bind(py).clone()
    }

    /// Square matrix that a method returns, row by row.
    fn matrix(&self, method: &str, arguments: impl for<'py> PyCallArgs<'py>) -> Result<Vec<f64>> {
        self.object.try_call(|py| {
            let found = self.object.bind(py).call_method1(method, arguments)?;
            let Table { columns, rows } = Table::read(&found, "(n, n)")?;
            let shape = format!("({}, {columns})", rows.len());
            let needed = format!("({0}, {0})", self.size);
            let values =
                self.object.checked_shape(method, "an array", rows.concat(), [shape, needed])?;
            finite(method, values)
        })
    }

    /// Displacement at the end of the next step, after the tractions of a step.
    fn advanced(&self, traction: &[f64]) -> PyResult<Vec<f64>> {
        Python::attach(|py| {
            let Numbers(values) = self.object.call(py, "advance", (Array::from(traction),))?;
            let shapes = [values.len(), self.size].map(|count| format!("({count},)"));
            finite("advance", self.object.checked_shape("advance", "an array", values, shapes)?)
        })
    }
}

/// The values that a method returned, if they are finite.
fn finite(method: &str, values: Vec<f64>) -> PyResult<Vec<f64>> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(values),
        Some(value) => Err(input_error(format!(
            "{method} of the ground returned the number {value}, but all must be finite"
        ))),
    }
}

/// `values` into a slice of the core, if it is as long.
fn copy(values: &[f64], to: &mut [f64]) -> Result<()> {
    if values.len() != to.len() {
        return Err(Error::part(PART_NAME, format!("{} numbers for {}", values.len(), to.len())));
    }
    to.copy_from_slice(values);
    Ok(())
}

impl Ground for UserGround {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(
        &mut self,
        time_step: f64,
        _steps: Option<usize>,
        _observer: &mut Observer<'_>,
    ) -> Result<()> {
        if *self.time_step.get_or_insert(time_step) == time_step {
            self.step = self.matrix("step_compliance", (time_step,))?;
        } else {
            // A trial of `build` with a shorter step, which the ground need not have: its exception is not the run's.
            self.step = discard_exceptions(|| self.matrix("step_compliance", (time_step,)))?;
        }
        self.history = Some(vec![0.0; self.size]);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        copy(&self.step, matrix)
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        let lost = "`advance` failed after the last step: resume an earlier checkpoint";
        copy(self.history.as_ref().ok_or_else(|| Error::part(PART_NAME, lost))?, displacement)
    }

    fn commit(&mut self, traction: &[f64]) {
        // The step is already accepted: an exception ends the run after it.
        self.history = self.advanced(traction).map_err(store_exception).ok();
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        copy(&self.matrix("static_compliance", ())?, matrix)
    }

    fn description(&self) -> GroundDescription {
        let shear_wave_speed = self.shear_wave_speed;
        GroundDescription { shear_wave_speed, ..GroundDescription::default() }
    }

    fn save(&self) -> Result<Vec<f64>> {
        let Some(history) = self.history.as_ref().filter(|_| self.object.has("save")) else {
            return Err(CheckpointError::Unsupported { part: PART_NAME }.into());
        };
        Ok([&history[..], &self.object.saved_variables()?].concat())
    }

    fn restore(&mut self, _steps: usize, values: &[f64]) -> Result<()> {
        let Some((history, variables)) = values.split_at_checked(self.size) else {
            return Err(CheckpointError::Corrupt { quantity: "state of the ground" }.into());
        };
        let arguments = (Array::from(variables),);
        self.object
            .try_call(|py| self.object.bind(py).call_method1("restore", arguments).map(|_| ()))?;
        self.history = Some(history.to_vec());
        Ok(())
    }
}
