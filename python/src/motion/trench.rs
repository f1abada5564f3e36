//! Motion around a trench.

use std::sync::Arc;

use basemat::Observer;
use basemat::site::TrenchMotion;
use pyo3::prelude::*;

use super::waves::incidence;
use super::{PyFreeField, PyRecord};
use crate::error::OrRaise;
use crate::ground::PyTrenchGround;
use crate::ticker::watched;

/// Free field of a trench: vertical waves below a surface that moves as recorded.
///
/// ``ground``: the `TrenchGround`, without backfill; the simulation's ground must be this one. ``horizontal``: `Record` of the
/// surface's motion to the right, by shear waves; ``vertical``: up, by pressure waves; a component left out is zero. Motion at
/// depth precedes the motion of the surface: begin the record with rest for as long as waves take from the base to the
/// surface (`Record.padded`).
#[pyclass(name = "TrenchMotion", module = "basemat", extends = PyFreeField, frozen)]
pub(crate) struct PyTrenchMotion;

#[pymethods]
impl PyTrenchMotion {
    #[new]
    #[pyo3(signature = (ground, horizontal=None, vertical=None))]
    fn new(
        py: Python<'_>,
        ground: Bound<'_, PyTrenchGround>,
        horizontal: Option<Bound<'_, PyRecord>>,
        vertical: Option<Bound<'_, PyRecord>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (surface, duration) = incidence([horizontal, vertical])?;
        let ground = (ground.get().make)().or_raise()?;
        let call = move |observer: &mut Observer<'_>| TrenchMotion::new(&ground, surface, observer);
        let motion = py.detach(move || watched(None, call))?;
        let make = Arc::new(move || Ok(Box::new(motion.clone()) as _));
        Ok(PyClassInitializer::from(PyFreeField { make, duration }).add_subclass(Self))
    }
}
