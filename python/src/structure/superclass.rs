//! The superclass of structures, and structures in any form that Python may give them.

use std::sync::Arc;

use basemat::structure::{DofCombination, Structure, Triplets};
use numpy::{PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use crate::base_node::shown;
use crate::dof_names::DofNames;
use crate::error::{OrRaise, kept, refuse};
use crate::recipe::Recipe;
use crate::row::PyDofCombination;
use crate::several::no_class;
use crate::user::UserStructure;

/// A structure with n degrees of freedom (m, rad), free of supports: the ground holds it up. It is a
/// description from which every simulation makes one of its own.
#[pyclass(name = "Structure", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyStructure {
    pub(crate) make: Recipe<dyn Structure>,
    names: Option<DofNames>,
}

impl PyStructure {
    /// A structure that can be copied.
    pub(crate) fn copied(structure: impl Structure + Clone + Sync + 'static) -> Self {
        Self::new(move || Ok(structure.clone()))
    }

    /// A structure from what makes it.
    pub(crate) fn new<S: Structure + 'static>(
        make: impl Fn() -> basemat::Result<S> + Send + Sync + 'static,
    ) -> Self {
        Self { make: Arc::new(move || Ok(Box::new(make()?))), names: None }
    }

    /// Replaces the names of the structure's degrees of freedom.
    pub(crate) fn named(self, names: Option<DofNames>) -> Self {
        Self { names, ..self }
    }
}

/// The recipe of a structure of this package, or of one written in Python.
pub(crate) fn recipe(object: &Bound<'_, PyAny>) -> PyResult<Recipe<dyn Structure>> {
    if let Ok(own) = object.cast::<PyStructure>() {
        return Ok(own.get().make.clone());
    }
    no_class(object)?;
    if has_base(object)? {
        let object = object.clone().unbind();
        return Ok(Arc::new(move || {
            let made = Python::attach(|py| UserStructure::new(object.bind(py)));
            Ok(Box::new(made.map_err(|error| kept("structure", error))?))
        }));
    }
    Err(refuse(format!("{} is no structure: it has no method `base`", object.get_type().name()?)))
}

/// Whether this may be a structure.
fn has_base(object: &Bound<'_, PyAny>) -> PyResult<bool> {
    Ok(object.getattr_opt("base")?.is_some_and(|base| base.is_callable()))
}

/// A structure for one simulation, and the object that has its internal variables: a copy if it is a
/// nonlinear one of the user's.
pub(crate) fn made<'py>(
    object: &Bound<'py, PyAny>,
) -> PyResult<(Box<dyn Structure>, Bound<'py, PyAny>)> {
    no_class(object)?;
    if object.cast::<PyStructure>().is_err() && has_base(object)? {
        let own = UserStructure::new(object)?;
        let copy = own.object(object.py());
        return Ok((Box::new(own), copy));
    }
    let make = recipe(object)?;
    Ok((object.py().detach(|| make()).or_raise()?, object.clone()))
}

/// Most degrees of freedom of a structure whose matrices are written out: an array takes 3.2 GB.
const MOST_DOFS: usize = 20_000;

/// An n × n array of what `fill` adds up.
fn array<'py>(
    py: Python<'py>,
    structure: &dyn Structure,
    fill: impl FnOnce(&dyn Structure, &mut Triplets) -> basemat::Result<()>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let order = structure.dofs();
    if order > MOST_DOFS {
        return Err(refuse(format!(
            "the structure has {order} degrees of freedom, but its matrices are arrays up to {MOST_DOFS}"
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
                    return Err(refuse(format!(
                        "entry ({row}, {column}) of a matrix of order {order}"
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
        self.names.as_ref().map(DofNames::to_vec)
    }

    /// The `DofCombination` of the degree of freedom called ``name``, one of `dof_names`.
    fn dof(&self, name: &str) -> PyResult<PyDofCombination> {
        let names = self.names.as_ref().ok_or_else(|| {
            refuse(format!(
                "there is no degree of freedom '{name}': the structure has no dof_names"
            ))
        })?;
        Ok(DofCombination::from(names.number(name)?).into())
    }

    /// Base of the structure: a list for each foundation, of its `BaseNode` from left to right; in plan
    /// `BaseFaces`.
    fn base(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        shown(py, (self.make)().or_raise()?.base())
    }

    /// Mass matrix (n × n array, kg/m); this and the others of up to 20 000 degrees of freedom.
    fn mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, (self.make)().or_raise()?.as_ref(), Structure::mass)
    }

    /// Stiffness matrix (n × n array, N/m per metre).
    fn stiffness<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, (self.make)().or_raise()?.as_ref(), Structure::stiffness)
    }

    /// Viscous damping matrix (n × n array, N s/m per metre).
    fn damping<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array(py, (self.make)().or_raise()?.as_ref(), Structure::damping)
    }
}
