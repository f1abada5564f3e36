//! Cells of a mat in plan.

use basemat::bem::plan::{Plan, impedances_in_plan_observed};
use numpy::{Complex64, PyArray3};
use pyo3::prelude::*;

use super::impedance::contact;
use crate::array::{Numbers, complex, whole};
use crate::error::OrRaise;
use crate::profile::Profile;
use crate::structure::recipe;
use crate::ticker::watched;

/// Square cells of contact under a rigid mat, for an :class:`ElasticGround` of three directions: those that its ``faces``
/// cover, convex polygons by their corners (list of lists of x and y, m), with ``cells`` along the shorter side of them all.
#[pyclass(name = "Plan", module = "basemat", frozen, dict)]
#[derive(Clone)]
pub(crate) struct PyPlan(pub(super) Plan);

#[pymethods]
impl PyPlan {
    #[new]
    fn new(
        faces: Vec<Vec<[f64; 2]>>,
        #[pyo3(from_py_with = whole)] cells: usize,
    ) -> PyResult<Self> {
        Ok(Self(Plan::on_faces(&faces, cells).or_raise()?))
    }

    /// Disc around ``center`` (x and y, m) of a ``radius`` (m), with ``cells`` across it.
    #[staticmethod]
    fn disc(
        center: (f64, f64),
        radius: f64,
        #[pyo3(from_py_with = whole)] cells: usize,
    ) -> PyResult<Self> {
        Ok(Self(Plan::disc(center.into(), radius, cells).or_raise()?))
    }

    fn __len__(&self) -> usize {
        self.0.count()
    }

    /// Dynamic stiffness of the mat as one rigid body on a ``soil`` (:class:`Soil` or :class:`SoilProfile`) for motions
    /// e^(iωt) at ``frequencies`` (array of shape (m,), Hz): complex array of shape (m, 6, 6), forces along x, y and z (N) and
    /// moments about them (N m) by displacements (m) and rotations (rad) of the mat's middle. ``contact``:
    /// "bonded" (the default) or "relaxed" (vertical motions without shear, horizontal ones without pressure).
    #[pyo3(signature = (soil, frequencies, *, contact="bonded"))]
    fn impedances<'py>(
        &self,
        py: Python<'py>,
        soil: Profile,
        frequencies: Numbers,
        contact: &str,
    ) -> PyResult<Bound<'py, PyArray3<Complex64>>> {
        let (plan, contact) = (&self.0, self::contact(contact)?);
        let found = py.detach(move || {
            watched(None, |observer| {
                impedances_in_plan_observed(&soil.0, plan, &frequencies.0, contact, observer)
            })
        });
        let matrices: Vec<Vec<Vec<_>>> = found?
            .iter()
            .map(|at| at.matrix.iter().map(|row| row.map(complex).to_vec()).collect())
            .collect();
        Ok(PyArray3::from_vec3(py, &matrices)?)
    }
}

/// The cells under the faces of a structure; `None` of one in the plane.
pub(super) fn under(structure: &Bound<'_, PyAny>, cells: usize) -> PyResult<Option<PyPlan>> {
    let faces = recipe(structure)?().or_raise()?.contact_faces();
    if faces.is_empty() {
        return Ok(None);
    }
    let corners = faces.iter().map(|face| face.iter().map(|node| [node.x, node.y]).collect());
    PyPlan::new(corners.collect(), cells).map(Some)
}
