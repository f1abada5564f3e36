//! A hysteretic spring written in Python.

use std::cell::{Cell, RefCell};
use std::sync::Arc;

use basemat::structure::{Hysteresis, InternalEnergy, SpringResponse};
use basemat::{CheckpointError, Error, Result};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::array::{Numbers, real};
use crate::error::{has_raised, keep, kept, raise, refuse, returned};
use crate::recipe::Recipe;

/// Its name in errors.
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
#[allow(clippy::struct_excessive_bools, reason = "one for each method that may be missing")]
struct UserHysteresis {
    object: Py<PyAny>,
    has_tangent: bool,
    has_energy: bool,
    has_commit: bool,
    has_save: bool,
    /// Deformation (m) and force (N/m) of the last committed step, and the work done until then (J/m).
    committed: [f64; 3],
    /// The last deformation asked for, and its response.
    last: Cell<Option<(f64, SpringResponse)>>,
}

impl UserHysteresis {
    fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let object = copied(object)?;
        let mut own = Self {
            has_tangent: object.hasattr("tangent")?,
            has_energy: object.hasattr("energy")?,
            has_commit: object.hasattr("commit")?,
            has_save: object.hasattr("save")?,
            object: object.clone().unbind(),
            committed: [0.0; 3],
            last: Cell::new(None),
        };
        let begin = own.respond(object.py(), 0.0)?;
        own.committed[1] = begin.force;
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
        let tangent = if self.has_tangent {
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

/// The result of `ask`, or `otherwise` if it raises, or something has raised before.
fn asked<T>(otherwise: T, ask: impl FnOnce(Python<'_>) -> PyResult<T>) -> T {
    if has_raised() {
        return otherwise;
    }
    Python::attach(ask).unwrap_or_else(|error| {
        keep(error);
        otherwise
    })
}

impl Hysteresis for UserHysteresis {
    fn response(&self, deformation: f64) -> SpringResponse {
        if let Some((at, response)) = self.last.get()
            && at.to_bits() == deformation.to_bits()
        {
            return response;
        }
        let nothing = SpringResponse { force: f64::NAN, tangent: f64::NAN };
        let response = asked(nothing, |py| self.respond(py, deformation));
        self.last.set(Some((deformation, response)));
        response
    }

    fn energy(&self, deformation: f64) -> InternalEnergy {
        if !self.has_energy {
            return InternalEnergy { stored: self.work(deformation), dissipated: 0.0 };
        }
        let (stored, dissipated) = asked((f64::NAN, f64::NAN), |py| {
            let found = self.object.bind(py).call_method1("energy", (deformation,))?;
            returned("energy of the hysteresis", &found)
        });
        InternalEnergy { stored, dissipated }
    }

    fn commit(&mut self, deformation: f64) {
        let work = self.work(deformation);
        self.committed = [deformation, self.response(deformation).force, work];
        if self.has_commit {
            // The step is accepted by now: the exception ends the run after it.
            asked((), |py| self.object.bind(py).call_method1("commit", (deformation,)).map(|_| ()));
            self.last.set(None);
        }
    }

    fn save(&self) -> Vec<f64> {
        let mut values = self.committed.to_vec();
        if self.has_save {
            values.extend(asked(Vec::new(), |py| {
                let found = self.object.bind(py).call_method0("save")?;
                Ok(returned::<Numbers>("save of the hysteresis", &found)?.0)
            }));
        } else if self.has_commit {
            keep(raise(Error::Checkpoint(CheckpointError::Unsupported { part: PART })));
        }
        values
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let Some((committed, own)) = values.split_first_chunk() else {
            return Err(
                CheckpointError::Corrupt { quantity: "state of a hysteretic spring" }.into()
            );
        };
        if self.has_save {
            let done = Python::attach(|py| {
                let own = PyArray1::from_slice(py, own);
                self.object.bind(py).call_method1("restore", (own,)).map(|_| ())
            });
            done.map_err(|error| kept(PART, error))?;
        }
        self.committed = *committed;
        self.last.set(None);
        Ok(())
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        let object = Python::attach(|py| {
            copied(self.object.bind(py)).map_or_else(
                |error| {
                    keep(error);
                    self.object.clone_ref(py)
                },
                Bound::unbind,
            )
        });
        Box::new(Self { object, last: Cell::new(None), ..*self })
    }
}

/// A deep copy, with internal variables of its own.
fn copied<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    object.py().import("copy")?.call_method1("deepcopy", (object,))
}
