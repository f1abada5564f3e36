//! Motions given as functions.

use std::cell::RefCell;
use std::sync::Arc;

use basemat::motion::{FreeFieldFn, Record, VerticalIncidence};
use pyo3::prelude::*;

use super::PyFreeField;
use crate::array::real;
use crate::error::{OrRaise, has_raised, heard, keep, refuse};

/// A motion of functions, named by what they return: give one of the two.
///
/// ``displacement``: a function ``(x, time) -> (right, up)`` of the surface's displacement in m, at x
/// (m) and time (s, above 0). It should begin with zero: until t = 0 the ground rests.
///
/// ``acceleration``: a function ``(time) -> (right, up)`` in m/s², everywhere the same at once. It is
/// sampled every ``time_step`` (s) from 0 to ``duration`` (s), taken as linear between the samples as
/// a :class:`Record`, and integrated exactly from rest; after the ``duration`` it is zero, and the
/// velocity stays what it is by then.
///
/// Either may return a number instead, the motion to the right, and may raise. None is for the other one,
/// and for its ``time_step`` and ``duration``.
#[pyfunction]
#[pyo3(signature = (*, displacement=None, acceleration=None, time_step=None, duration=None))]
pub(crate) fn free_field(
    displacement: Option<Bound<'_, PyAny>>,
    acceleration: Option<Bound<'_, PyAny>>,
    time_step: Option<f64>,
    duration: Option<f64>,
) -> PyResult<PyFreeField> {
    match (displacement, acceleration) {
        (Some(function), None) => {
            if time_step.is_some() || duration.is_some() {
                return Err(refuse("time_step and duration are those of an acceleration"));
            }
            let function = Arc::new(callable("displacement", &function)?);
            Ok(PyFreeField {
                make: Arc::new(move || {
                    let function = Arc::clone(&function);
                    Ok(Box::new(FreeFieldFn::new(move |x, time| {
                        asked("displacement", |py| function.call1(py, (x, time)))
                    })))
                }),
                duration: None,
            })
        }
        (None, Some(function)) => {
            let function = callable("acceleration", &function)?;
            let (Some(time_step), Some(duration)) = (time_step, duration) else {
                return Err(refuse("an acceleration is sampled: give its time_step and duration"));
            };
            if duration < time_step {
                return Err(refuse(format!(
                    "duration is {duration} s, but must be the time_step ({time_step} s) or more"
                )));
            }
            let (field, end) = heard(|| sampled(&function, time_step, duration).or_raise())?;
            Ok(PyFreeField {
                make: Arc::new(move || Ok(Box::new(field.clone()))),
                duration: Some(end),
            })
        }
        _ => Err(refuse("give the displacement or the acceleration as a function, one of them")),
    }
}

fn callable(name: &str, function: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    if function.is_callable() {
        return Ok(function.clone().unbind());
    }
    let found = function.get_type().name()?;
    Err(refuse(format!("{name} is of the type {found}, but must be a function")))
}

/// Records of the accelerations to the right and up that a function returns, and their length.
fn sampled(
    function: &Py<PyAny>,
    time_step: f64,
    duration: f64,
) -> basemat::Result<(VerticalIncidence, f64)> {
    let up = RefCell::new(Vec::new());
    let right = Record::from_fn(time_step, duration, |time| {
        if has_raised() {
            return f64::NAN;
        }
        let [right, own] = asked("acceleration", |py| function.call1(py, (time,)));
        up.borrow_mut().push(own);
        right
    })?;
    let up = Record::new(time_step, up.into_inner())?;
    let end = right.duration();
    Ok((VerticalIncidence { horizontal: Some(right), vertical: Some(up) }, end))
}

/// What a function returns: a pair, or a number to the right. NaN, which ends the step, if it raises.
fn asked(name: &str, call: impl FnOnce(Python<'_>) -> PyResult<Py<PyAny>>) -> [f64; 2] {
    Python::attach(|py| {
        let found = call(py).and_then(|value| {
            let value = value.bind(py);
            let pair = || {
                let [right, up]: [Bound<'_, PyAny>; 2] = value.extract()?;
                Ok([real(name, &right)?, real(name, &up)?])
            };
            let right = real(name, value).map(|right| [right, 0.0]);
            right.or_else(|_: PyErr| pair()).or_else(|_: PyErr| {
                Err(refuse(format!(
                    "the function of the motion's {name} returned {}, but must return a pair of \
                     numbers (to the right, up) or a number (to the right)",
                    value.repr()?
                )))
            })
        });
        found.unwrap_or_else(|error: PyErr| {
            keep(error);
            [f64::NAN; 2]
        })
    })
}
