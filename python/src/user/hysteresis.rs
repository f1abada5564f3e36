//! A hysteretic spring written in Python.

use std::cell::{Cell, RefCell};
use std::sync::Arc;

use basemat::Result;
use basemat::coupled::CheckpointError;
use basemat::structure::{Hysteresis, InternalEnergy, SpringResponse};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyType;

use super::object::{UserObject, ask, copied};
use crate::array::real;
use crate::error::{keep, kept, raise, refuse};
use crate::recipe::Recipe;

/// Name of this kind of part in errors.
const PART: &str = "hysteresis";

/// Deformation that a difference quotient steps over, relative to the deformation.
const RELATIVE_STEP: f64 = 1e-6;

/// Least deformation that counts in that step, m.
const LEAST_DEFORMATION: f64 = 1e-3;

thread_local! {
    /// The objects of all springs made on this thread since they were last asked for.
    static MADE: RefCell<Vec<Py<PyAny>>> = const { RefCell::new(Vec::new()) };
}

/// Takes the objects of the springs that were made on this thread since the last call.
pub(crate) fn made_springs() -> Vec<Py<PyAny>> {
    MADE.take()
}

/// The recipe of springs that are copies of `object`, if it has `force(deformation)`.
pub(crate) fn hysteresis(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn Hysteresis>> {
    if object.is_instance_of::<PyType>() || !object.hasattr("force")? {
        return Err(refuse(format!(
            "{} is no hysteresis: it must be a Hysteresis or an object with a method `force`",
            object.repr()?
        )));
    }
    let object = object.clone().unbind();
    Ok(Arc::new(move || {
        let made = Python::attach(|py| UserHysteresis::new(object.bind(py)));
        Ok(Box::new(made.map_err(|error| kept(PART, error))?))
    }))
}

/// A Python object with `force(deformation)`, and as it may be `tangent(deformation)`,
/// `energy(deformation)`, `commit(deformation)`, `save()` and `restore(values)`.
///
/// After an exception every number that the core asks for is NaN, which ends the step.
struct UserHysteresis {
    object: UserObject,
    /// Deformation (m) and force (N/m) of the last committed step, and the work done until then (J/m).
    committed: [f64; 3],
    /// First stiffness, with which it is taken to unload if it does not return its energy, N/m.
    stiffness: f64,
    /// The last deformation asked for, and its response.
    last: Cell<Option<(f64, SpringResponse)>>,
}

impl UserHysteresis {
    fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (object, last) = (copied(object)?, Cell::new(None));
        let own = UserObject::new(&object, PART, &["tangent", "energy", "commit", "save"])?;
        let mut own = Self { object: own, committed: [0.0; 3], stiffness: 0.0, last };
        let begin = own.respond(object.py(), 0.0)?;
        own.committed[1] = begin.force;
        own.stiffness = begin.tangent;
        own.last.set(Some((0.0, begin)));
        MADE.with_borrow_mut(|made| made.push(object.unbind()));
        Ok(own)
    }

    /// The number that a method returns for a deformation.
    fn number(&self, py: Python<'_>, method: &str, deformation: f64) -> PyResult<f64> {
        let found = self.object.bind(py).call_method1(method, (deformation,))?;
        real(&format!("{method} of the hysteresis"), &found)
    }

    fn respond(&self, py: Python<'_>, deformation: f64) -> PyResult<SpringResponse> {
        let force = self.number(py, "force", deformation)?;
        let tangent = if self.object.has("tangent") {
            self.number(py, "tangent", deformation)?
        } else {
            let step = RELATIVE_STEP * deformation.abs().max(LEAST_DEFORMATION);
            let (low, high) = (deformation - step, deformation + step);
            (self.number(py, "force", high)? - self.number(py, "force", low)?) / (high - low)
        };
        Ok(SpringResponse { force, tangent })
    }

    /// Work done until `deformation`, by the trapezoidal rule over steps.
    fn work(&self, deformation: f64) -> f64 {
        let [start, force, work] = self.committed;
        work + 0.5 * (force + self.response(deformation).force) * (deformation - start)
    }
}

impl Hysteresis for UserHysteresis {
    fn response(&self, deformation: f64) -> SpringResponse {
        if let Some((at, response)) = self.last.get()
            && at.to_bits() == deformation.to_bits()
        {
            return response;
        }
        let nothing = SpringResponse { force: f64::NAN, tangent: f64::NAN };
        let response = ask(nothing, |py| self.respond(py, deformation));
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
            ask((), |py| self.object.bind(py).call_method1("commit", (deformation,)).map(|_| ()));
            self.last.set(None);
        }
    }

    fn save(&self) -> Vec<f64> {
        let own = self.object.saved().unwrap_or_else(|error| {
            keep(raise(error));
            Vec::new()
        });
        [&self.committed[..], &own].concat()
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let Some((committed, own)) = values.split_first_chunk() else {
            return Err(
                CheckpointError::Corrupt { quantity: "state of a hysteretic spring" }.into()
            );
        };
        if self.object.has("save") {
            self.object.attempt(|py| {
                let own = PyArray1::from_slice(py, own);
                self.object.bind(py).call_method1("restore", (own,)).map(|_| ())
            })?;
        }
        self.committed = *committed;
        self.last.set(None);
        Ok(())
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        // An object that cannot be copied is shared, and its error ends the step.
        let object =
            ask(self.object.clone(), |py| Ok(self.object.with(copied(self.object.bind(py))?)));
        Box::new(Self { object, last: Cell::new(None), ..*self })
    }
}
