//! The base class of free fields.

use basemat::motion::FreeField;
use pyo3::prelude::*;

use crate::error::{OrRaise, heard, refuse};
use crate::recipe::Recipe;

/// Motion of the ground's surface without the structure: a :class:`Record`, a wave, or what
/// :func:`free_field` makes of a function. Until t = 0 the ground rests.
#[pyclass(name = "FreeField", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyFreeField {
    pub(crate) make: Recipe<dyn FreeField>,
    /// Time at which it ends (s), if that is known.
    pub(crate) duration: Option<f64>,
}

#[pymethods]
impl PyFreeField {
    /// Displacement (to the right, up), m, at ``x`` (m) and ``time`` (s).
    fn displacement(&self, x: f64, time: f64) -> PyResult<[f64; 2]> {
        heard(|| Ok((self.make)().or_raise()?.displacement(x, time)))
    }

    /// Displacement (along x, along y, up), m, at the point ``x``, ``y`` (m) of a ground in plan and ``time`` (s).
    fn displacement_at(&self, x: f64, y: f64, time: f64) -> PyResult<[f64; 3]> {
        heard(|| Ok((self.make)().or_raise()?.displacement_at([x, y], time)))
    }

    /// Velocity (to the right, up), m/s, at ``x`` (m) and ``time`` (s).
    fn velocity(&self, x: f64, time: f64) -> PyResult<[f64; 2]> {
        heard(|| Ok((self.make)().or_raise()?.velocity(x, time)))
    }
}

/// The free field that Python gives.
pub(crate) fn given<'a, 'py>(
    object: &'a Bound<'py, PyAny>,
) -> PyResult<&'a Bound<'py, PyFreeField>> {
    if let Ok(own) = object.cast::<PyFreeField>() {
        return Ok(own);
    }
    Err(refuse(if object.is_callable() {
        "a function is no motion before it is said what it returns: \
         free_field(displacement=function), or free_field(acceleration=function, time_step=…, \
         duration=…)"
            .into()
    } else {
        format!("{} is no motion: no FreeField, Record or wave", object.get_type().name()?)
    }))
}
