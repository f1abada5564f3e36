//! Winkler's spring bed.

use basemat::bem::{Grading, SpringGround};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::PyGround;
use super::strip::ContactMesh;
use crate::array::whole_numbers;
use crate::error::WithOption;

/// Independent springs and dashpots under each element (Winkler bed).
///
/// ``strips``: a `Strip` or a list of them, or a `Plan`, whose outer cells then end at the edge of the mat.
/// ``normal_stiffness``, ``tangential_stiffness``: Pa/m. ``across_stiffness``: tangential stiffness along y in plan,
/// Pa/m; equal to ``tangential_stiffness`` unless given. ``dashpots``: coefficients of the normal and the tangential
/// dashpots, Pa s/m; none unless given. ``theta``: θ of the time integration of the dashpots, ½ to 1; ½ unless given.
#[pyclass(name = "SpringGround", module = "basemat", extends = PyGround, frozen)]
pub(crate) struct PySpringGround;

#[pymethods]
impl PySpringGround {
    #[new]
    #[pyo3(signature = (strips, normal_stiffness, tangential_stiffness, *, across_stiffness=None, dashpots=None, theta=None))]
    fn new(
        strips: ContactMesh,
        normal_stiffness: f64,
        tangential_stiffness: f64,
        across_stiffness: Option<f64>,
        dashpots: Option<[f64; 2]>,
        theta: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let superclass = PyGround::new(move || {
            let ground = match &strips {
                ContactMesh::Strips(strips) => {
                    SpringGround::on_strips(strips, normal_stiffness, tangential_stiffness)
                }
                ContactMesh::Plan(plan) => {
                    let stiffness_y = across_stiffness.unwrap_or(tangential_stiffness);
                    let stiffness = [normal_stiffness, tangential_stiffness, stiffness_y];
                    SpringGround::in_plan(plan.clone(), stiffness)
                }
            };
            ground
                .with(dashpots, |ground, [normal, tangential]| {
                    ground.with_dashpots(normal, tangential)
                })
                .with(theta, SpringGround::with_theta)
        })?;
        Ok(PyClassInitializer::from(superclass).add_subclass(Self))
    }

    /// Spring bed with contact elements under the foundations of a ``structure``.
    ///
    /// It has a strip of ``count`` equal elements under each foundation; under a structure in plan ``count`` cells
    /// along the shorter side of its base; ``normal_stiffness``, ``tangential_stiffness`` (Pa/m), ``across_stiffness``,
    /// ``dashpots`` and ``theta`` are as in the class; the last three have its defaults unless given. A flexible base
    /// gets at least one element for each of its segments, or as many cells as it has faces; if necessary, ``count`` is
    /// raised for this. ``print(ground)`` shows its number of elements, which is also ``len(ground.elements)``.
    #[staticmethod]
    #[pyo3(
        signature = (structure, count, *stiffness, **options),
        text_signature = "(structure, count, normal_stiffness, tangential_stiffness, *, across_stiffness=None, dashpots=None, theta=None)"
    )]
    fn under<'py>(
        structure: Bound<'py, PyAny>,
        #[pyo3(from_py_with = whole_numbers)] count: usize,
        stiffness: &Bound<'py, PyTuple>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = structure.py();
        let mut arguments =
            vec![ContactMesh::under(&structure, count, Grading::Uniform, None)?.into_bound(py)];
        arguments.extend(stiffness);
        py.get_type::<Self>().call(PyTuple::new(py, arguments)?, options)
    }
}
