//! Structures given by their matrices.

use std::sync::Arc;

use basemat::structure::MatrixModel;
use pyo3::prelude::*;

use super::PyStructure;
use super::composed::PyRayleighDamping;
use super::contact_node::{PyContactNode, nodes};
use crate::array::Matrix;
use crate::error::{OrRaise, refuse};
use crate::recipe::Shared;

/// A structure given by its mass, stiffness and damping matrices, dense or of ``scipy.sparse``.
///
/// ``mass`` (n × n, kg/m) and ``stiffness`` (n × n, N/m per metre) act on absolute displacements
/// (m, rad). The structure is free, without supports: the ground holds it up. ``contact``: the
/// points of its base, a list of :class:`ContactNode` from left to right. ``damping`` (n × n, N s/m per
/// metre; none unless given) must be symmetric and positive semi-definite unless ``active_damping``
/// (False by default); ``rayleigh``: :class:`RayleighDamping` instead, none unless given.
#[pyclass(name = "MatrixModel", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyMatrixModel;

#[pymethods]
impl PyMatrixModel {
    #[new]
    #[pyo3(signature = (mass, stiffness, contact, *, damping=None, active_damping=false, rayleigh=None))]
    fn new(
        mass: Matrix,
        stiffness: Matrix,
        contact: Vec<Bound<'_, PyContactNode>>,
        damping: Option<Matrix>,
        active_damping: bool,
        rayleigh: Option<&PyRayleighDamping>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let contact = nodes(&contact, mass.0.order())?;
        let mut model = MatrixModel::new(mass.0, stiffness.0, contact).or_raise()?;
        model = match (damping, rayleigh) {
            (Some(_), Some(_)) => {
                return Err(refuse("give a damping matrix or Rayleigh damping, not both"));
            }
            (Some(matrix), None) if active_damping => {
                model.with_active_damping(matrix.0).or_raise()?
            }
            (Some(matrix), None) => model.with_damping(matrix.0).or_raise()?,
            (None, Some(damping)) => model.with_rayleigh(damping.0),
            (None, None) => model,
        };
        let shared = Shared(Arc::new(model));
        Ok(PyClassInitializer::from(PyStructure::copied(shared)).add_subclass(Self))
    }
}
