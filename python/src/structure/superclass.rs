//! The superclass of structures, structures of this package, and structures written in Python.

use std::sync::Arc;

use basemat::structure::{DofCombination, Structure, Triplets};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use crate::base_node::python_base;
use crate::error::{OrRaise, input_error, user_code_error};
use crate::list_arguments::reject_class;
use crate::names::DofNames;
use crate::recipe::Recipe;
use crate::row::PyDofCombination;
use crate::user::UserStructure;

/// A structure with n degrees of freedom, which only the ground supports.
///
/// Degrees of freedom are in m and rad. Matrices are per metre of thickness in the plane, of the whole structure in
/// plan. The object is a description from which each simulation builds a separate structure.
#[pyclass(name = "Structure", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyStructure {
    pub(crate) make: Recipe<dyn Structure>,
    dof_names: Option<DofNames>,
}

impl PyStructure {
    /// The superclass object of a structure that can be cloned.
    pub(crate) fn from_structure(structure: impl Structure + Clone + Sync + 'static) -> Self {
        Self::new(move || Ok(structure.clone()))
    }

    /// The superclass object of a structure that `make` builds for each simulation.
    pub(crate) fn new<S: Structure + 'static>(
        make: impl Fn() -> basemat::Result<S> + Send + Sync + 'static,
    ) -> Self {
        Self { make: Arc::new(move || Ok(Box::new(make()?))), dof_names: None }
    }

    /// Replaces the names of the structure's degrees of freedom.
    pub(crate) fn with_dof_names(self, dof_names: Option<DofNames>) -> Self {
        Self { dof_names, ..self }
    }
}

/// Attribute of Python's objects of the package that contain a `Structure`.
const INNER_STRUCTURE: &str = "__basemat_structure__";

/// The structure of this package that an object is or contains; `None` for one written in Python.
fn inner_structure<'py>(object: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyStructure>>> {
    if let Ok(structure) = object.cast::<PyStructure>() {
        return Ok(Some(structure.clone()));
    }
    let inner_object = object.getattr_opt(INNER_STRUCTURE)?;
    Ok(inner_object.and_then(|inner_object| inner_object.cast_into::<PyStructure>().ok()))
}

/// The recipe of a structure of this package, or of one written in Python.
pub(crate) fn structure_recipe(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn Structure>> {
    if let Some(structure) = inner_structure(object)? {
        return Ok(structure.get().make.clone());
    }
    reject_class(object)?;
    if has_base(object)? {
        let object = object.clone().unbind();
        return Ok(Arc::new(move || {
            let structure = Python::attach(|py| UserStructure::new(object.bind(py)));
            Ok(Box::new(structure.map_err(|error| user_code_error("structure", error))?))
        }));
    }
    Err(input_error(format!(
        "{} is no structure: it has no method `base`",
        object.get_type().name()?
    )))
}

/// Whether an object has the method `base`, as structures have.
fn has_base(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(object.getattr_opt("base")?.is_some_and(|base| base.is_callable()))
}

/// A structure for one simulation, and its Python object: a copy of `object` if the structure is nonlinear and written
/// in Python.
pub(crate) fn new_structure<'py>(
    object: &Bound<'py, PyAny>,
) -> PyResult<(Box<dyn Structure>, Bound<'py, PyAny>)> {
    reject_class(object)?;
    if inner_structure(object)?.is_none() && has_base(object)? {
        let structure = UserStructure::new(object)?;
        let copy = structure.object(object.py());
        return Ok((Box::new(structure), copy));
    }
    let make = structure_recipe(object)?;
    Ok((object.py().detach(|| make()).or_raise()?, object.clone()))
}

/// Largest number of degrees of freedom of a structure whose matrices become arrays; such an array takes 3.2 GB.
const MAX_ARRAY_DOFS: usize = 20_000;

/// Dense n × n array of the matrix that `fill` adds up.
fn matrix_array<'py>(
    py: Python<'py>,
    structure: &dyn Structure,
    fill: impl FnOnce(&dyn Structure, &mut Triplets) -> basemat::Result<()>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let order = structure.dofs();
    if order > MAX_ARRAY_DOFS {
        return Err(input_error(format!(
            "the structure has {order} degrees of freedom, but its matrices are arrays up to {MAX_ARRAY_DOFS}"
        )));
    }
    let mut entries = Triplets::new(order);
    fill(structure, &mut entries).or_raise()?;
    // numpy allocates, and raises a MemoryError if the array does not fit.
    let array = py.import("numpy")?.call_method1("zeros", ((order, order),))?;
    let array = array.cast_into::<PyArray2<f64>>()?;
    {
        let mut view = array.try_readwrite()?;
        let mut view = view.as_array_mut();
        for &(row, column, value) in entries.entries() {
            match view.get_mut([row, column]) {
                Some(entry) => *entry += value,
                None => {
                    return Err(input_error(format!(
                        "entry ({row}, {column}) is outside a matrix of order {order}"
                    )));
                }
            }
        }
    }
    Ok(array)
}

#[pymethods]
impl PyStructure {
    /// Number n of degrees of freedom.
    #[getter]
    fn dofs(&self) -> PyResult<usize> {
        Ok((self.make)().or_raise()?.dofs())
    }

    /// Names of the degrees of freedom: list of n texts; None without names.
    #[getter]
    fn dof_names(&self) -> Option<Vec<String>> {
        self.dof_names.as_ref().map(DofNames::to_vec)
    }

    /// The `DofCombination` of the degree of freedom called ``name``, one of `dof_names`.
    fn dof(&self, name: &str) -> PyResult<PyDofCombination> {
        let names = self.dof_names.as_ref().ok_or_else(|| {
            input_error(format!(
                "there is no degree of freedom '{name}': the structure has no dof_names"
            ))
        })?;
        Ok(DofCombination::from(names.dof_index(name)?).into())
    }

    /// Base of the structure: a list for each foundation, of its `BaseNode` from left to right; in plan
    /// `BaseFaces`.
    fn base(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        python_base(py, (self.make)().or_raise()?.base())
    }

    /// Mass matrix (n × n array, kg/m); matrices become arrays up to 20 000 degrees of freedom.
    fn mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix_array(py, (self.make)().or_raise()?.as_ref(), Structure::mass)
    }

    /// Stiffness matrix (n × n array, N/m per metre).
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix_array(py, (self.make)().or_raise()?.as_ref(), Structure::stiffness)
    }

    /// Viscous damping matrix (n × n array, N s/m per metre).
    fn damping<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix_array(py, (self.make)().or_raise()?.as_ref(), Structure::damping)
    }
}
