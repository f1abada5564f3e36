//! A hysteretic spring written in Python.

use std::cell::{Cell, RefCell};
use std::sync::Arc;

use basemat::Result;
use basemat::coupled::CheckpointError;
use basemat::structure::{Hysteresis, InternalEnergy, SpringResponse};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyType;

use super::object::{UserObject, call_unless_raised, deep_copy};
use crate::array::real_number;
use crate::error::{input_error, store_exception, to_exception, user_code_error};
use crate::recipe::Recipe;

/// Name of this kind of part in errors.
const PART_NAME: &str = "hysteresis";

/// Step of a difference quotient, relative to the deformation: about the cube root of the rounding unit.
const RELATIVE_STEP: f64 = 1e-6;

/// Smallest deformation to which the step of a difference quotient is relative, m; this step is 1 nm.
const MIN_STEP_DEFORMATION: f64 = 1e-3;

thread_local! {
    /// The objects of all springs made on this thread since the last call of `take_made_springs`.
    static MADE_SPRINGS: RefCell<Vec<Py<PyAny>>> = const { RefCell::new(Vec::new()) };
}

/// Takes the objects of the springs that were made on this thread since the last call.
pub(crate) fn take_made_springs() -> Vec<Py<PyAny>> {
    MADE_SPRINGS.take()
}

/// The recipe of springs that are copies of `object`; an error unless the object has `force(deformation)`.
pub(crate) fn hysteresis_recipe(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn Hysteresis>> {
    if object.is_instance_of::<PyType>() || !object.hasattr("force")? {
        return Err(input_error(format!(
            "{} is no hysteresis: it must be a Hysteresis or an object with a method `force`",
            object.repr()?
        )));
    }
    let object = object.clone().unbind();
    Ok(Arc::new(move || {
        let spring = Python::attach(|py| UserHysteresis::new(object.bind(py)));
        Ok(Box::new(spring.map_err(|error| user_code_error(PART_NAME, error))?))
    }))
}

/// A Python object with `force(deformation)`. Optional are `tangent(deformation)`, `energy(deformation)`,
/// `commit(deformation)`, `save()` and `restore(values)`.
///
/// After an exception the methods return NaN, which ends the step.
struct UserHysteresis {
    object: UserObject,
    committed: CommittedState,
    /// Initial stiffness, N/m; if the object has no method `energy`, its elastic energy is computed with this
    /// stiffness.
    stiffness: f64,
    /// The deformation of the last call of `response`, and its result.
    last_response: Cell<Option<(f64, SpringResponse)>>,
}

/// A spring at the end of the last committed step.
#[derive(Clone, Copy, Default)]
struct CommittedState {
    /// Deformation, m.
    deformation: f64,
    /// Force, N/m.
    force: f64,
    /// Work done since the start, J/m.
    work: f64,
}

impl UserHysteresis {
    fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let copy = deep_copy(object)?;
        let optional = ["tangent", "energy", "commit", "save"];
        let object = UserObject::new(&copy, PART_NAME, &optional)?;
        let mut spring = Self {
            object,
            committed: CommittedState::default(),
            stiffness: 0.0,
            last_response: Cell::new(None),
        };
        let initial_response = spring.new_response(copy.py(), 0.0)?;
        spring.committed.force = initial_response.force;
        spring.stiffness = initial_response.tangent;
        spring.last_response.set(Some((0.0, initial_response)));
        MADE_SPRINGS.with_borrow_mut(|springs| springs.push(copy.unbind()));
        Ok(spring)
    }

    /// The number that a method returns for a deformation.
    fn call_number(&self, py: Python<'_>, method: &str, deformation: f64) -> PyResult<f64> {
        let returned_value = self.object.bind(py).call_method1(method, (deformation,))?;
        real_number(&format!("{method} of the hysteresis"), &returned_value)
    }

    /// Force and tangent at a deformation; if the object has no method `tangent`, the tangent is a central difference.
    fn new_response(&self, py: Python<'_>, deformation: f64) -> PyResult<SpringResponse> {
        let force = self.call_number(py, "force", deformation)?;
        let tangent = if self.object.has("tangent") {
            self.call_number(py, "tangent", deformation)?
        } else {
            let deformation_step = RELATIVE_STEP * deformation.abs().max(MIN_STEP_DEFORMATION);
            let lower_deformation = deformation - deformation_step;
            let upper_deformation = deformation + deformation_step;
            (self.call_number(py, "force", upper_deformation)?
                - self.call_number(py, "force", lower_deformation)?)
                / (upper_deformation - lower_deformation)
        };
        Ok(SpringResponse { force, tangent })
    }

    /// Work done until `deformation`, by the trapezoidal rule over steps.
    fn work_until(&self, deformation: f64) -> f64 {
        let committed = self.committed;
        let mean_force = 0.5 * (committed.force + self.response(deformation).force);
        committed.work + mean_force * (deformation - committed.deformation)
    }
}

impl Hysteresis for UserHysteresis {
    fn response(&self, deformation: f64) -> SpringResponse {
        if let Some((last_deformation, response)) = self.last_response.get()
            && last_deformation.to_bits() == deformation.to_bits()
        {
            return response;
        }
        let undefined_response = SpringResponse { force: f64::NAN, tangent: f64::NAN };
        let response =
            call_unless_raised(undefined_response, |py| self.new_response(py, deformation));
        self.last_response.set(Some((deformation, response)));
        response
    }

    fn energy(&self, deformation: f64) -> InternalEnergy {
        self.object.energy((deformation,)).unwrap_or_else(|| {
            let work = self.work_until(deformation);
            let force = self.response(deformation).force;
            let elastic_energy = 0.5 * force * force / self.stiffness;
            let is_elastic = !self.object.has("commit") || self.stiffness <= 0.0;
            let stored = if is_elastic { work } else { elastic_energy.min(work) };
            InternalEnergy { stored, dissipated: work - stored }
        })
    }

    fn commit(&mut self, deformation: f64) {
        let work = self.work_until(deformation);
        let force = self.response(deformation).force;
        self.committed = CommittedState { deformation, force, work };
        if self.object.has("commit") {
            // The step is already accepted: the exception ends the run after it.
            call_unless_raised((), |py| {
                self.object.bind(py).call_method1("commit", (deformation,)).map(|_| ())
            });
            self.last_response.set(None);
        }
    }

    fn save(&self) -> Vec<f64> {
        let variables = self.object.saved_variables().unwrap_or_else(|error| {
            store_exception(to_exception(error));
            Vec::new()
        });
        let CommittedState { deformation, force, work } = self.committed;
        [&[deformation, force, work], &variables[..]].concat()
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let Some((&[deformation, force, work], variables)) = values.split_first_chunk() else {
            return Err(
                CheckpointError::Corrupt { quantity: "state of a hysteretic spring" }.into()
            );
        };
        if self.object.has("save") {
            self.object.try_call(|py| {
                let variables = PyArray1::from_slice(py, variables);
                self.object.bind(py).call_method1("restore", (variables,)).map(|_| ())
            })?;
        }
        self.committed = CommittedState { deformation, force, work };
        self.last_response.set(None);
        Ok(())
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        // If the copy fails, both springs have the same object, and the stored exception ends the step.
        let object = call_unless_raised(self.object.clone(), |py| {
            Ok(self.object.with_object(deep_copy(self.object.bind(py))?))
        });
        Box::new(Self { object, last_response: Cell::new(None), ..*self })
    }
}
