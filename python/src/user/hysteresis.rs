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

/// Deformation that a difference quotient steps over, relative to the deformation.
const RELATIVE_STEP: f64 = 1e-6;

/// Smallest deformation from which that step is taken, m.
const MIN_STEP_DEFORMATION: f64 = 1e-3;

thread_local! {
    /// The objects of all springs made on this thread since the last call of `take_made_springs`.
    static MADE_SPRINGS: RefCell<Vec<Py<PyAny>>> = const { RefCell::new(Vec::new()) };
}

/// Takes the objects of the springs that were made on this thread since the last call.
pub(crate) fn take_made_springs() -> Vec<Py<PyAny>> {
    MADE_SPRINGS.take()
}

/// The recipe of springs that are copies of `object`, if it has `force(deformation)`.
pub(crate) fn hysteresis(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn Hysteresis>> {
    if object.is_instance_of::<PyType>() || !object.hasattr("force")? {
        return Err(input_error(format!(
            "{} is no hysteresis: it must be a Hysteresis or an object with a method `force`",
            object.repr()?
        )));
    }
    let object = object.clone().unbind();
    Ok(Arc::new(move || {
        let made = Python::attach(|py| UserHysteresis::new(object.bind(py)));
        Ok(Box::new(made.map_err(|error| user_code_error(PART_NAME, error))?))
    }))
}

/// A Python object with `force(deformation)`. Optional are `tangent(deformation)`, `energy(deformation)`,
/// `commit(deformation)`, `save()` and `restore(values)`.
///
/// After an exception the methods return NaN, which ends the step.
struct UserHysteresis {
    object: UserObject,
    /// Deformation (m) and force (N/m) of the last committed step, and the work done until then (J/m).
    committed: [f64; 3],
    /// Initial stiffness, N/m: that of unloading, if the object does not return its energy.
    stiffness: f64,
    /// The deformation of the last call of `response`, and its result.
    last: Cell<Option<(f64, SpringResponse)>>,
}

impl UserHysteresis {
    fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let copy = deep_copy(object)?;
        let optional = ["tangent", "energy", "commit", "save"];
        let object = UserObject::new(&copy, PART_NAME, &optional)?;
        let last = Cell::new(None);
        let mut spring = Self { object, committed: [0.0; 3], stiffness: 0.0, last };
        let initial = spring.respond(copy.py(), 0.0)?;
        spring.committed[1] = initial.force;
        spring.stiffness = initial.tangent;
        spring.last.set(Some((0.0, initial)));
        MADE_SPRINGS.with_borrow_mut(|springs| springs.push(copy.unbind()));
        Ok(spring)
    }

    /// The number that a method returns for a deformation.
    fn number(&self, py: Python<'_>, method: &str, deformation: f64) -> PyResult<f64> {
        let found = self.object.bind(py).call_method1(method, (deformation,))?;
        real_number(&format!("{method} of the hysteresis"), &found)
    }

    fn respond(&self, py: Python<'_>, deformation: f64) -> PyResult<SpringResponse> {
        let force = self.number(py, "force", deformation)?;
        let tangent = if self.object.has("tangent") {
            self.number(py, "tangent", deformation)?
        } else {
            let step = RELATIVE_STEP * deformation.abs().max(MIN_STEP_DEFORMATION);
            let low = deformation - step;
            let high = deformation + step;
            (self.number(py, "force", high)? - self.number(py, "force", low)?) / (high - low)
        };
        Ok(SpringResponse { force, tangent })
    }

    /// Work done until `deformation`, by the trapezoidal rule over steps.
    fn work(&self, deformation: f64) -> f64 {
        let [start, start_force, start_work] = self.committed;
        start_work + 0.5 * (start_force + self.response(deformation).force) * (deformation - start)
    }
}

impl Hysteresis for UserHysteresis {
    fn response(&self, deformation: f64) -> SpringResponse {
        if let Some((at, response)) = self.last.get()
            && at.to_bits() == deformation.to_bits()
        {
            return response;
        }
        let undefined = SpringResponse { force: f64::NAN, tangent: f64::NAN };
        let response = call_unless_raised(undefined, |py| self.respond(py, deformation));
        self.last.set(Some((deformation, response)));
        response
    }

    fn energy(&self, deformation: f64) -> InternalEnergy {
        self.object.energy((deformation,)).unwrap_or_else(|| {
            let work = self.work(deformation);
            let force = self.response(deformation).force;
            let elastic = 0.5 * force * force / self.stiffness;
            let is_elastic = !self.object.has("commit") || self.stiffness <= 0.0;
            let stored = if is_elastic { work } else { elastic.min(work) };
            InternalEnergy { stored, dissipated: work - stored }
        })
    }

    fn commit(&mut self, deformation: f64) {
        let work = self.work(deformation);
        self.committed = [deformation, self.response(deformation).force, work];
        if self.object.has("commit") {
            // The step is already accepted: the exception ends the run after it.
            call_unless_raised((), |py| {
                self.object.bind(py).call_method1("commit", (deformation,)).map(|_| ())
            });
            self.last.set(None);
        }
    }

    fn save(&self) -> Vec<f64> {
        let variables = self.object.saved_variables().unwrap_or_else(|error| {
            store_exception(to_exception(error));
            Vec::new()
        });
        [&self.committed[..], &variables].concat()
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let Some((committed, variables)) = values.split_first_chunk() else {
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
        self.committed = *committed;
        self.last.set(None);
        Ok(())
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        // An object that cannot be copied is shared, and its error ends the step.
        let object = call_unless_raised(self.object.clone(), |py| {
            Ok(self.object.with(deep_copy(self.object.bind(py))?))
        });
        Box::new(Self { object, last: Cell::new(None), ..*self })
    }
}
