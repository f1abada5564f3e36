//! Structures given by their matrices.

use std::sync::Arc;

use basemat::structure::MatrixModel;
use pyo3::prelude::*;

use super::PyStructure;
use super::composed::PyRayleighDamping;
use crate::array::Matrix;
use crate::base_node::BaseLike;
use crate::error::{OrRaise, WithOption, input_error};
use crate::names::DofNames;
use crate::recipe::SharedStructure;

/// A structure that its mass, stiffness and damping matrices define.
///
/// Matrices are dense or of ``scipy.sparse``.
///
/// ``mass`` (n × n, kg/m) and ``stiffness`` (n × n, N/m per metre) act on absolute displacements (m, rad). The
/// structure has no supports; only the ground supports it. ``base``: nodes of the base, a list of `BaseNode` from left
/// to right; a list of such lists for several foundations; `BaseFaces` for a ground in plan, where matrices refer to
/// the whole body. ``damping`` (n × n, N s/m per metre; none unless given) must be symmetric and positive semi-definite
/// unless ``active_damping`` (False by default), and ``stiffness`` symmetric unless ``active_stiffness`` (False by
/// default); ``rayleigh``: `RayleighDamping` instead, none unless given. ``dof_names``: list of n different names, for
/// `dof`, frames and errors; none unless given.
#[pyclass(name = "MatrixModel", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyMatrixModel;

#[pymethods]
impl PyMatrixModel {
    #[pyo3(signature = (mass, stiffness, base, *, damping=None, active_damping=false, active_stiffness=false, rayleigh=None, dof_names=None))]
    #[new]
    fn new(
        mass: Matrix,
        stiffness: Matrix,
        base: BaseLike,
        damping: Option<Matrix>,
        active_damping: bool,
        active_stiffness: bool,
        rayleigh: Option<&PyRayleighDamping>,
        dof_names: Option<Vec<String>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let dof_count = mass.0.order();
        let dof_names = dof_names.map(|names| DofNames::new(names, dof_count)).transpose()?;
        if damping.is_some() && rayleigh.is_some() {
            return Err(input_error("give a damping matrix or Rayleigh damping, not both"));
        }
        let with_damping = if active_damping {
            MatrixModel::with_active_damping
        } else {
            MatrixModel::with_damping
        };
        let model = MatrixModel::new(mass.0, stiffness.0, base.of_structure(dof_count)?)
            .map(|model| if active_stiffness { model.with_active_stiffness() } else { model })
            .with(damping, |model, matrix| with_damping(model, matrix.0))
            .with(rayleigh, |model, damping| Ok(model.with_rayleigh(damping.0)))
            .or_raise()?;
        let superclass = PyStructure::from_structure(SharedStructure {
            structure: Arc::new(model),
            dof_names: dof_names.clone(),
        })
        .with_dof_names(dof_names);
        Ok(PyClassInitializer::from(superclass).add_subclass(Self))
    }
}
