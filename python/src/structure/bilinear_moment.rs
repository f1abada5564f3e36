//! Moment–rotation law of a hinge.

use basemat::fem::BilinearMoment;
use pyo3::prelude::*;

use crate::error::OrRaise;

/// Moment of a hinge with two straight branches and kinematic hardening, a moment–rotation law.
///
/// ``plastic_moment`` (N m) and rotational ``stiffness`` (N m/rad), in the plane per metre of thickness; ``hardening_ratio``:
/// ratio of the stiffness beyond the plastic moment to it, from 0 to below 1.
#[pyclass(name = "BilinearMoment", module = "basemat", frozen, dict)]
pub(crate) struct PyBilinearMoment(pub(super) BilinearMoment);

#[pymethods]
impl PyBilinearMoment {
    #[new]
    fn new(plastic_moment: f64, stiffness: f64, hardening_ratio: f64) -> PyResult<Self> {
        BilinearMoment::new(plastic_moment, stiffness, hardening_ratio).or_raise().map(Self)
    }
}
