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
    /// Length of a contact vector: the number of directions of all elements.
    vector_length: usize,
    shear_wave_speed: Option<f64>,
    /// Step compliance; empty before `prepare`.
    step_compliance: Vec<f64>,
    /// Time step of the simulation, for which the ground was prepared first, s.
    time_step: Option<f64>,
    /// Displacement at the end of the next step due to all tractions so far; `None` after an exception of `advance`.
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
        let vector_length = elements.iter().map(|element| element.directions().len()).sum();
        let wave_speed = copy.getattr_opt("shear_wave_speed")?.filter(|speed| !speed.is_none());
        let attribute_name = "shear_wave_speed of the ground";
        Ok(Self {
            object: UserObject::new(&copy, PART_NAME, &["save"])?,
            elements,
            vector_length,
            shear_wave_speed: wave_speed
                .map(|speed| extract_returned(attribute_name, &speed))
                .transpose()?,
            step_compliance: Vec::new(),
            time_step: None,
            history: Some(vec![0.0; vector_length]),
        })
    }

    /// The object whose methods are called.
    pub(crate) fn object<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        self.object.bind(py).clone()
    }

    /// Square matrix that a method returns, row by row.
    fn matrix(&self, method: &str, arguments: impl for<'py> PyCallArgs<'py>) -> Result<Vec<f64>> {
        self.object.try_call(|py| {
            let returned_matrix = self.object.bind(py).call_method1(method, arguments)?;
            let Table { column_count, rows } = Table::read(&returned_matrix, "(n, n)")?;
            let shape = format!("({}, {column_count})", rows.len());
            let expected_shape = format!("({0}, {0})", self.vector_length);
            let values = self.object.checked_shape(
                method,
                "an array",
                rows.concat(),
                &shape,
                &expected_shape,
            )?;
            check_finite(method, values)
        })
    }

    /// Displacement at the end of the next step, after the tractions of a step.
    fn advanced(&self, traction: &[f64]) -> PyResult<Vec<f64>> {
        Python::attach(|py| {
            let Numbers(values) = self.object.call(py, "advance", (Array::from(traction),))?;
            let shape = format!("({},)", values.len());
            let expected_shape = format!("({},)", self.vector_length);
            let values = self.object.checked_shape(
                "advance",
                "an array",
                values,
                &shape,
                &expected_shape,
            )?;
            check_finite("advance", values)
        })
    }
}

/// The values that a method returned; an error unless all are finite.
fn check_finite(method: &str, values: Vec<f64>) -> PyResult<Vec<f64>> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(values),
        Some(value) => Err(input_error(format!(
            "{method} of the ground returned the number {value}, but all must be finite"
        ))),
    }
}

/// Copies `values` to a slice of the core; an error unless it is as long.
fn copy_values(values: &[f64], target: &mut [f64]) -> Result<()> {
    if values.len() != target.len() {
        let text = format!("{} numbers, but must be {}", values.len(), target.len());
        return Err(Error::part(PART_NAME, text));
    }
    target.copy_from_slice(values);
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
            self.step_compliance = self.matrix("step_compliance", (time_step,))?;
        } else {
            // The core tries a shorter step, which the ground may reject: an exception does not end the run.
            self.step_compliance =
                discard_exceptions(|| self.matrix("step_compliance", (time_step,)))?;
        }
        self.history = Some(vec![0.0; self.vector_length]);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        copy_values(&self.step_compliance, matrix)
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        let Some(history) = &self.history else {
            let text = "`advance` failed after the last step: resume an earlier checkpoint";
            return Err(Error::part(PART_NAME, text));
        };
        copy_values(history, displacement)
    }

    fn commit(&mut self, traction: &[f64]) {
        // The step is already accepted: an exception ends the run after it.
        self.history = self.advanced(traction).map_err(store_exception).ok();
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        copy_values(&self.matrix("static_compliance", ())?, matrix)
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
        let Some((history, variables)) = values.split_at_checked(self.vector_length) else {
            return Err(CheckpointError::Corrupt { quantity: "state of the ground" }.into());
        };
        let arguments = (Array::from(variables),);
        self.object
            .try_call(|py| self.object.bind(py).call_method1("restore", arguments).map(|_| ()))?;
        self.history = Some(history.to_vec());
        Ok(())
    }
}
