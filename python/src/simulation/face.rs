//! Forces on a face of a structure in the ground.

use basemat::coupled::FaceForces;
use pyo3::prelude::*;

/// Forces on the soil behind one face of a structure in the ground, per metre: of `State.face`.
#[pyclass(name = "FaceForces", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyFaceForces(pub(super) FaceForces);

#[pymethods]
impl PyFaceForces {
    /// Total pressure, positive in compression, N/m.
    #[getter]
    fn thrust(&self) -> f64 {
        self.0.thrust
    }

    /// Force on the soil along the outline, N/m: positive down the left wall, to the right along the base, up the right wall.
    #[getter]
    fn shear(&self) -> f64 {
        self.0.shear
    }

    /// Point where the thrust acts, m: height above the base; of the base, distance to the right of its middle. NaN without
    /// thrust.
    #[getter]
    fn place(&self) -> f64 {
        self.0.place
    }

    /// Ratio of the length of open elements to the length of the face.
    #[getter]
    fn open_fraction(&self) -> f64 {
        self.0.open_fraction
    }
}
