//! A structure written in Python.

use basemat::Result;
use basemat::structure::{Base, InternalEnergy, NonlinearForce, Structure, Triplets};
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use super::object::{UserObject, deep_copy};
use crate::array::{Array, Count, Matrix, Numbers};
use crate::base_node::BaseLike;
use crate::error::{extract_returned, store_exception};
use crate::names::DofNames;

/// Name of this kind of part in errors.
const PART_NAME: &str = "structure";
/// Methods that a structure may lack.
const OPTIONAL_METHODS: [&str; 5] = ["damping", "load", "energy", "commit", "save"];

/// A Python object with `dofs`, `base()`, `mass()` and `stiffness()`; a structure that is nonlinear also has `force(u)`
/// and `tangent(u)`.
pub(crate) struct UserStructure {
    object: UserObject,
    dofs: usize,
    base: Base,
    dof_names: Option<DofNames>,
    has_active_damping: bool,
    has_active_stiffness: bool,
    is_nonlinear: bool,
}

impl UserStructure {
    /// The structure of one simulation. A nonlinear structure is a deep copy of the object, so that simulations do not
    /// share its internal variables.
    pub(crate) fn new(structure: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = structure.py();
        let is_nonlinear = structure.hasattr("force")?;
        let copy = if is_nonlinear { deep_copy(structure)? } else { structure.clone() };
        let object = UserObject::new(&copy, PART_NAME, &OPTIONAL_METHODS)?;
        let dofs = copy.getattr("dofs")?;
        let dofs = if dofs.is_callable() { dofs.call0()? } else { dofs };
        let Count(dofs) = extract_returned("dofs of the structure", &dofs)?;
        let base: BaseLike = object.call(py, "base", ())?;
        Ok(Self {
            dofs,
            dof_names: DofNames::from_structure(&copy, dofs)?,
            base: base.of_structure(dofs)?,
            has_active_damping: is_set(&copy, "active_damping")?,
            has_active_stiffness: is_set(&copy, "active_stiffness")?,
            is_nonlinear,
            object,
        })
    }

    /// The object whose methods are called.
    pub(crate) fn object<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        self.object.bind(py).clone()
    }

    /// Adds the matrix that a method returns.
    fn add_matrix(
        &self,
        method: &str,
        arguments: impl for<'py> PyCallArgs<'py>,
        matrix: &mut Triplets,
    ) -> Result<()> {
        let triplets = self.object.try_call(|py| {
            let Matrix(triplets) = self.object.call(py, method, arguments)?;
            let shape = format!("({0}, {0})", triplets.order());
            let expected_shape = format!("({0}, {0})", self.dofs);
            self.object.checked_shape(method, "a matrix", triplets, &shape, &expected_shape)
        });
        for &(row, column, value) in triplets?.entries() {
            matrix.add(row, column, value);
        }
        Ok(())
    }

    /// Adds the vector that a method returns.
    fn add_vector(
        &self,
        method: &str,
        arguments: impl for<'py> PyCallArgs<'py>,
        sum: &mut [f64],
    ) -> Result<()> {
        let terms = self.object.try_call(|py| {
            let Numbers(terms) = self.object.call(py, method, arguments)?;
            let shape = format!("({},)", terms.len());
            let expected_shape = format!("({},)", sum.len());
            self.object.checked_shape(method, "an array", terms, &shape, &expected_shape)
        });
        sum.iter_mut().zip(terms?).for_each(|(sum, term)| *sum += term);
        Ok(())
    }
}

/// Whether an object has a flag that is true.
fn is_set(object: &Bound<'_, PyAny>, flag: &str) -> PyResult<bool> {
    object.getattr_opt(flag)?.map_or(Ok(false), |value| value.is_truthy())
}

impl Structure for UserStructure {
    fn dofs(&self) -> usize {
        self.dofs
    }

    fn base(&self) -> Base {
        self.base.clone()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrix("mass", (), matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrix("stiffness", (), matrix)
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        if !self.object.has("damping") {
            return Ok(());
        }
        self.add_matrix("damping", (), matrix)
    }

    fn has_active_damping(&self) -> bool {
        self.has_active_damping
    }

    fn has_active_stiffness(&self) -> bool {
        self.has_active_stiffness
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        self.dof_names.as_ref()?.describe(dofs)
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        if !self.object.has("load") {
            return Ok(());
        }
        self.add_vector("load", (time,), load)
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.is_nonlinear.then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        if self.is_nonlinear { Some(self) } else { None }
    }
}

/// `force(u)` and `tangent(u)`; optional are `energy(u)`, `commit(u)`, `save()` and `restore(values)`.
impl NonlinearForce for UserStructure {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        self.add_vector("force", (Array::from(displacement),), force)
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        self.add_matrix("tangent", (Array::from(displacement),), matrix)
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        self.object.energy((Array::from(displacement),))
    }

    fn commit(&mut self, displacement: &[f64]) {
        if self.object.has("commit") {
            let argument = (Array::from(displacement),);
            let result = Python::attach(|py| {
                self.object.bind(py).call_method1("commit", argument).map(|_| ())
            });
            // The step is already accepted: the exception ends the run after it.
            result.unwrap_or_else(store_exception);
        }
    }

    fn save(&self) -> Result<Vec<f64>> {
        self.object.saved_variables()
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        if !self.object.has("save") && values.is_empty() {
            return Ok(());
        }
        let argument = (Array::from(values),);
        self.object
            .try_call(|py| self.object.bind(py).call_method1("restore", argument).map(|_| ()))
    }
}
