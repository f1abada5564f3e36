//! Winkler's spring bed.

use basemat::bem::SpringGround;
use pyo3::prelude::*;

use super::PyGround;
use super::strip::Strips;
use crate::array::whole;
use crate::structure;

/// Independent springs and dashpots under each element (Winkler bed).
///
/// ``strips``: a :class:`Strip` or a list of them. ``normal_stiffness``, ``tangential_stiffness``: Pa/m.
/// ``dashpots``: normal and tangential, Pa s/m; none unless given. ``theta``: of the rule that steps
/// them, ½ to 1; ½ unless given.
#[pyclass(name = "SpringGround", module = "basemat", extends = PyGround, frozen)]
pub(crate) struct PySpringGround;

fn ground(
    make: impl Fn() -> basemat::Result<SpringGround> + Send + Sync + 'static,
    dashpots: Option<[f64; 2]>,
    theta: Option<f64>,
) -> PyResult<PyClassInitializer<PySpringGround>> {
    let base = PyGround::new(move || {
        let mut ground = make()?;
        if let Some([normal, tangential]) = dashpots {
            ground = ground.with_dashpots(normal, tangential)?;
        }
        match theta {
            Some(theta) => ground.with_theta(theta),
            None => Ok(ground),
        }
    })?;
    Ok(PyClassInitializer::from(base).add_subclass(PySpringGround))
}

#[pymethods]
impl PySpringGround {
    #[new]
    #[pyo3(signature = (strips, normal_stiffness, tangential_stiffness, *, dashpots=None, theta=None))]
    fn new(
        strips: Strips,
        normal_stiffness: f64,
        tangential_stiffness: f64,
        dashpots: Option<[f64; 2]>,
        theta: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (normal, tangential) = (normal_stiffness, tangential_stiffness);
        ground(move || SpringGround::on_strips(&strips.0, normal, tangential), dashpots, theta)
    }

    /// One strip from ``left`` to ``right`` (m) of ``count`` equal elements; ``normal_stiffness``,
    /// ``tangential_stiffness`` (Pa/m), ``dashpots`` and ``theta`` are those of the class, the last two
    /// if given.
    #[staticmethod]
    #[pyo3(signature = (left, right, count, normal_stiffness, tangential_stiffness, *, dashpots=None, theta=None))]
    fn strip(
        py: Python<'_>,
        left: f64,
        right: f64,
        #[pyo3(from_py_with = whole)] count: usize,
        normal_stiffness: f64,
        tangential_stiffness: f64,
        dashpots: Option<[f64; 2]>,
        theta: Option<f64>,
    ) -> PyResult<Py<Self>> {
        let (normal, tangential) = (normal_stiffness, tangential_stiffness);
        let make = move || SpringGround::new(left..right, count, normal, tangential);
        Py::new(py, ground(make, dashpots, theta)?)
    }

    /// Strips of ``count`` elements under each foundation of a ``structure``; ``normal_stiffness``,
    /// ``tangential_stiffness`` (Pa/m), ``dashpots`` and ``theta`` are those of the class, the last two
    /// if given.
    #[staticmethod]
    #[pyo3(signature = (structure, count, normal_stiffness, tangential_stiffness, *, dashpots=None, theta=None))]
    fn under(
        structure: Bound<'_, PyAny>,
        #[pyo3(from_py_with = whole)] count: usize,
        normal_stiffness: f64,
        tangential_stiffness: f64,
        dashpots: Option<[f64; 2]>,
        theta: Option<f64>,
    ) -> PyResult<Py<Self>> {
        let py = structure.py();
        let structure = structure::recipe(&structure)?;
        let (normal, tangential) = (normal_stiffness, tangential_stiffness);
        let make = move || SpringGround::under(&*structure()?, count, normal, tangential);
        Py::new(py, ground(make, dashpots, theta)?)
    }
}
