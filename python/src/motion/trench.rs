//! Motion around a trench.

use std::sync::Arc;

use basemat::site::TrenchMotion;
use pyo3::prelude::*;

use super::waves::{incidence, latest_end};
use super::{PyFreeField, PyRecord, free_field_object};
use crate::error::{OrRaise, input_error};
use crate::ground::PyTrenchGround;
use crate::ticker::with_progress;

/// Free field of a trench: vertical waves below a surface that moves as recorded; `travelling` has other waves.
///
/// ``ground``: the `TrenchGround`, without backfill; the simulation's ground must be this one. ``horizontal``: `Record` of the
/// surface's motion to the right, by shear waves; ``vertical``: up, by pressure waves; a component is zero unless given. Motion at
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
        let surface = incidence(horizontal.as_ref(), vertical.as_ref())?;
        let duration = latest_end([surface.horizontal.as_ref(), surface.vertical.as_ref()]);
        let ground = (ground.get().make)().or_raise()?;
        let motion = py.detach(move || {
            with_progress(None, |observer| TrenchMotion::new(&ground, surface, observer))
        });
        Ok(around(motion?, duration))
    }

    /// The `TrenchMotion` of a ``wave`` around the trench of ``ground``: of what a `PlaneWave` or an `InclinedWave` makes of
    /// a record, or of a `travelling_wave`.
    ///
    /// The wave must be one of the ground's profile, along x: the motion of the surface and its velocity along it determine
    /// the field below. Motion before and after the wave's record fades within half of its length.
    #[staticmethod]
    fn travelling(
        py: Python<'_>,
        ground: Bound<'_, PyTrenchGround>,
        wave: Bound<'_, PyAny>,
    ) -> PyResult<Py<Self>> {
        let field = free_field_object(&wave)?.get();
        let needed = "the wave runs along the surface: a travelling_wave, or a field of a PlaneWave or an InclinedWave";
        let wave = field.wave.as_ref().ok_or_else(|| input_error(needed))?;
        let wave = wave().or_raise()?;
        let ground = (ground.get().make)().or_raise()?;
        let motion = py.detach(move || {
            with_progress(None, |observer| TrenchMotion::travelling(&ground, &wave, observer))
        });
        Py::new(py, around(motion?, field.duration))
    }
}

/// The class of a motion that ends at `duration` (s).
fn around(motion: TrenchMotion, duration: Option<f64>) -> PyClassInitializer<PyTrenchMotion> {
    let make = Arc::new(move || Ok(Box::new(motion.clone()) as _));
    let base = PyFreeField { make, duration, wave: None };
    PyClassInitializer::from(base).add_subclass(PyTrenchMotion)
}
