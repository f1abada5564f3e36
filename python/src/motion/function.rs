//! The superclass of free fields, and motions that functions of Python define.

use std::cell::RefCell;
use std::sync::Arc;

use basemat::motion::{FreeField, FreeFieldFn, Record, TravellingWave, VerticalIncidence};
use pyo3::prelude::*;

use crate::array::real_number;
use crate::error::{self, OrRaise, has_stored_exception, input_error, raise_user_exceptions};
use crate::list_arguments::reject_class;
use crate::recipe::Recipe;

/// Motion of the ground's surface without the structure: a `Record`, a wave, or a function (`free_field`). Until t = 0
/// the ground is at rest.
#[pyclass(name = "FreeField", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyFreeField {
    pub(crate) make: Recipe<dyn FreeField>,
    /// Time at which the motion ends (s); `None` for a motion without an end.
    pub(crate) duration: Option<f64>,
    /// Builds the wave along the surface; `None` for a motion of another kind.
    pub(super) wave: Option<Arc<WaveFactory>>,
}

/// Builds a wave along the surface.
pub(super) type WaveFactory = dyn Fn() -> basemat::Result<TravellingWave> + Send + Sync;

#[pymethods]
impl PyFreeField {
    /// Displacement (to the right, up), m, at ``x`` (m) and ``time`` (s).
    fn displacement(&self, x: f64, time: f64) -> PyResult<[f64; 2]> {
        raise_user_exceptions(|| Ok((self.make)().or_raise()?.displacement(x, time)))
    }

    /// Displacement (along x, along y, up), m, at the point ``x``, ``y`` (m) of a ground in plan and ``time`` (s).
    fn displacement_at(&self, x: f64, y: f64, time: f64) -> PyResult<[f64; 3]> {
        raise_user_exceptions(|| Ok((self.make)().or_raise()?.displacement_at([x, y], time)))
    }

    /// Velocity (to the right, up), m/s, at ``x`` (m) and ``time`` (s).
    fn velocity(&self, x: f64, time: f64) -> PyResult<[f64; 2]> {
        raise_user_exceptions(|| Ok((self.make)().or_raise()?.velocity(x, time)))
    }
}

/// A free field that `make` builds for each simulation. `make` is also called here, so that its errors are raised at
/// once.
pub(super) fn new_free_field<F: FreeField + 'static>(
    make: impl Fn() -> basemat::Result<F> + Send + Sync + 'static,
) -> PyResult<PyFreeField> {
    make().or_raise()?;
    Ok(PyFreeField { make: Arc::new(move || Ok(Box::new(make()?))), duration: None, wave: None })
}

/// The object as a free field.
pub(crate) fn free_field_object<'a, 'py>(
    object: &'a Bound<'py, PyAny>,
) -> PyResult<&'a Bound<'py, PyFreeField>> {
    if let Ok(field) = object.cast::<PyFreeField>() {
        return Ok(field);
    }
    reject_class(object)?;
    Err(input_error(if object.is_callable() {
        "a function is no motion until free_field states what it returns: \
         free_field(displacement=function), or free_field(acceleration=function, time_step=…, \
         duration=…)"
            .into()
    } else {
        format!(
            "{} is no motion: it must be a FreeField, a Record or a wave",
            object.get_type().name()?
        )
    }))
}

/// A motion that one function defines: give ``displacement``, ``acceleration`` or ``displacement_at``.
///
/// ``displacement``: a function ``(x, time) -> (right, up)`` of the surface's displacement in m, at x (m) and time (s,
/// above 0). It should begin with zero: until t = 0 the ground is at rest.
///
/// ``acceleration``: a function ``(time) -> (right, up)`` in m/s², the same everywhere. It is sampled every
/// ``time_step`` (s) from 0 to ``duration`` (s), linear between the samples as a `Record`, and integrated exactly from
/// rest. After the ``duration`` it is zero, and the velocity stays constant.
///
/// ``displacement_at``: for a ground in plan, a function ``(x, y, time) -> (along x, along y, up)`` of the displacement in m at
/// the point x, y (m).
///
/// ``displacement`` and ``acceleration`` may instead return one number, the motion to the right. All three functions
/// may raise an exception. Arguments that are not given are None.
#[pyfunction]
#[pyo3(signature = (*, displacement=None, acceleration=None, time_step=None, duration=None, displacement_at=None))]
pub(crate) fn free_field(
    displacement: Option<Bound<'_, PyAny>>,
    acceleration: Option<Bound<'_, PyAny>>,
    time_step: Option<f64>,
    duration: Option<f64>,
    displacement_at: Option<Bound<'_, PyAny>>,
) -> PyResult<PyFreeField> {
    if acceleration.is_none() && (time_step.is_some() || duration.is_some()) {
        return Err(input_error("time_step and duration are those of an acceleration"));
    }
    match (displacement, acceleration, displacement_at) {
        (Some(function), None, None) => {
            let function = Arc::new(checked_callable("displacement", &function)?);
            new_free_field(move || {
                let function = Arc::clone(&function);
                Ok(FreeFieldFn::new(move |x, time| {
                    call_motion_function("displacement", |py| function.call1(py, (x, time)))
                }))
            })
        }
        (None, None, Some(function)) => {
            let function = Arc::new(checked_callable("displacement_at", &function)?);
            new_free_field(move || Ok(PlanMotionFunction(Arc::clone(&function))))
        }
        (None, Some(function), None) => {
            let function = checked_callable("acceleration", &function)?;
            let (Some(time_step), Some(duration)) = (time_step, duration) else {
                return Err(input_error(
                    "an acceleration is sampled: give its time_step and duration",
                ));
            };
            if duration < time_step {
                return Err(input_error(format!(
                    "duration is {duration} s, but must be the time_step ({time_step} s) or more"
                )));
            }
            let motion = raise_user_exceptions(|| {
                sampled_motion(&function, time_step, duration).or_raise()
            })?;
            let duration = motion.horizontal.as_ref().map(Record::duration);
            Ok(PyFreeField { duration, ..new_free_field(move || Ok(motion.clone()))? })
        }
        _ => Err(input_error(
            "give the displacement, the acceleration or displacement_at as a function, one of them",
        )),
    }
}

/// The argument called `name` as a function; an error unless it can be called.
fn checked_callable(name: &str, function: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
    if function.is_callable() {
        return Ok(function.clone().unbind());
    }
    let type_name = function.get_type().name()?;
    Err(input_error(format!("{name} is of the type {type_name}, but must be a function")))
}

/// Records of the accelerations to the right and up that a function returns.
fn sampled_motion(
    function: &Py<PyAny>,
    time_step: f64,
    duration: f64,
) -> basemat::Result<VerticalIncidence> {
    let vertical_samples = RefCell::new(Vec::new());
    let horizontal = Record::from_fn(time_step, duration, |time| {
        if has_stored_exception() {
            return f64::NAN;
        }
        let acceleration = call_motion_function("acceleration", |py| function.call1(py, (time,)));
        vertical_samples.borrow_mut().push(acceleration[1]);
        acceleration[0]
    })?;
    let vertical = Record::new(time_step, vertical_samples.into_inner())?;
    Ok(VerticalIncidence { horizontal: Some(horizontal), vertical: Some(vertical) })
}

/// A function `(x, y, time)` of the displacement in plan.
struct PlanMotionFunction(Arc<Py<PyAny>>);

impl FreeField for PlanMotionFunction {
    fn moves_across(&self) -> bool {
        true
    }

    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        let [displacement_x, _, displacement_up] = self.displacement_at([x, 0.0], time);
        [displacement_x, displacement_up]
    }

    fn displacement_at(&self, [x, y]: [f64; 2], time: f64) -> [f64; 3] {
        error::call_user_code([f64::NAN; 3], |py| {
            let returned_value = self.0.call1(py, (x, y, time))?;
            let returned_value = returned_value.bind(py);
            extract_numbers("displacement_at", returned_value).ok_or_else(|| {
                return_error(
                    "displacement_at",
                    returned_value,
                    "three numbers (along x, along y, up)",
                )
            })
        })
    }
}

/// Motion (right, up) that a function returns, as a pair or as one number for the motion to the right.
///
/// If the function raises an exception, the motion is NaN, which ends the step.
fn call_motion_function(
    name: &str,
    call: impl FnOnce(Python<'_>) -> PyResult<Py<PyAny>>,
) -> [f64; 2] {
    error::call_user_code([f64::NAN; 2], |py| {
        let returned_value = call(py)?;
        let returned_value = returned_value.bind(py);
        if let Ok(right) = real_number(name, returned_value) {
            return Ok([right, 0.0]);
        }
        let requirement = "a pair of numbers (to the right, up) or a number (to the right)";
        extract_numbers(name, returned_value)
            .ok_or_else(|| return_error(name, returned_value, requirement))
    })
}

/// Extracts `N` numbers, if the object has as many.
fn extract_numbers<const N: usize>(name: &str, object: &Bound<'_, PyAny>) -> Option<[f64; N]> {
    let entries: [Bound<'_, PyAny>; N] = object.extract().ok()?;
    let values: Result<Vec<f64>, _> =
        entries.iter().map(|entry| real_number(name, entry)).collect();
    values.ok()?.try_into().ok()
}

/// Error for a function of the motion that returned something else.
fn return_error(name: &str, returned_value: &Bound<'_, PyAny>, requirement: &str) -> PyErr {
    let value_text =
        returned_value.repr().map_or_else(|_| "something".into(), |text| text.to_string());
    input_error(format!(
        "the function of the motion's {name} returned {value_text}, but must return {requirement}"
    ))
}
