//! Motion around a trench.

use std::sync::Arc;

use basemat::Observer;
use basemat::site::TrenchMotion;
use pyo3::prelude::*;

use super::waves::incidence;
use super::{PyFreeField, PyRecord, given};
use crate::error::{OrRaise, refuse};
use crate::ground::PyTrenchGround;
use crate::ticker::watched;

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
        let (surface, duration) = incidence([horizontal, vertical])?;
        let ground = (ground.get().make)().or_raise()?;
        let call = move |observer: &mut Observer<'_>| TrenchMotion::new(&ground, surface, observer);
        Ok(around(py.detach(move || watched(None, call))?, duration))
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
        let field = given(&wave)?.get();
        let needed = "the wave runs along the surface: a travelling_wave, or a field of a PlaneWave or an InclinedWave";
        let wave = field.wave.as_ref().ok_or_else(|| refuse(needed))?;
        let wave = wave().or_raise()?;
        let ground = (ground.get().make)().or_raise()?;
        let call =
            move |observer: &mut Observer<'_>| TrenchMotion::travelling(&ground, &wave, observer);
        Py::new(py, around(py.detach(move || watched(None, call))?, field.duration))
    }
}

/// The class of a motion that ends at `duration` (s).
fn around(motion: TrenchMotion, duration: Option<f64>) -> PyClassInitializer<PyTrenchMotion> {
    let make = Arc::new(move || Ok(Box::new(motion.clone()) as _));
    let base = PyFreeField { make, duration, wave: None };
    PyClassInitializer::from(base).add_subclass(PyTrenchMotion)
}
