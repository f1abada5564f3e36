//! Motion around a trench.

use std::sync::Arc;

use basemat::site::TrenchMotion;
use pyo3::prelude::*;

use super::waves::{latest_end, vertical_motion};
use super::{PyFreeField, PyRecord, free_field_object};
use crate::error::{OrRaise, input_error};
use crate::ground::PyTrenchGround;
use crate::ticker::with_progress;

/// Free field of a trench: vertical waves below a surface that moves as recorded; `travelling` is for other waves.
///
/// ``ground``: the `TrenchGround`, without backfill; the simulation's ground must be this one. ``horizontal``: `Record`
/// of the surface's motion to the right (shear waves). ``vertical``: `Record` of its motion up (pressure waves). A
/// component is zero unless given. Motion at depth precedes the motion of the surface: begin the record with rest that
/// lasts the travel time of the waves from the base to the surface (`Record.padded`).
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
        let surface = vertical_motion(horizontal.as_ref(), vertical.as_ref())?;
        let duration = latest_end([surface.horizontal.as_ref(), surface.vertical.as_ref()]);
        let ground = (ground.get().make)().or_raise()?;
        let motion = py.detach(move || {
            with_progress(None, |observer| TrenchMotion::new(&ground, surface, observer))
        });
        Ok(trench_motion_object(motion?, duration))
    }

    /// The `TrenchMotion` of a ``wave`` around the trench of ``ground``: a field of a `PlaneWave` or of an
    /// `InclinedWave`, or a `travelling_wave`.
    ///
    /// The wave must belong to the profile of the ground and travel along x: the motion and the apparent velocity at
    /// the surface determine the field below. The motion before and after the record of the wave decays within half the
    /// length of the record.
    #[staticmethod]
    fn travelling(
        py: Python<'_>,
        ground: Bound<'_, PyTrenchGround>,
        wave: Bound<'_, PyAny>,
    ) -> PyResult<Py<Self>> {
        let field = free_field_object(&wave)?.get();
        let requirement = "the wave must travel along the surface: give a travelling_wave, or a field of a PlaneWave or an InclinedWave";
        let make_wave = field.wave.as_ref().ok_or_else(|| input_error(requirement))?;
        let wave = make_wave().or_raise()?;
        let ground = (ground.get().make)().or_raise()?;
        let motion = py.detach(move || {
            with_progress(None, |observer| TrenchMotion::travelling(&ground, &wave, observer))
        });
        Py::new(py, trench_motion_object(motion?, field.duration))
    }
}

/// The object of Python for a motion that ends at `duration` (s).
fn trench_motion_object(
    motion: TrenchMotion,
    duration: Option<f64>,
) -> PyClassInitializer<PyTrenchMotion> {
    let make = Arc::new(move || Ok(Box::new(motion.clone()) as _));
    let superclass = PyFreeField { make, duration, wave: None };
    PyClassInitializer::from(superclass).add_subclass(PyTrenchMotion)
}
