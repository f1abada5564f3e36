//! A structure written in Python.

use basemat::Result;
use basemat::structure::{Base, InternalEnergy, NonlinearForce, Structure, Triplets};
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use super::object::{UserObject, copied};
use crate::array::{Array, Count, Matrix, Numbers};
use crate::base_node::BaseLike;
use crate::dof_names::DofNames;
use crate::error::{keep, returned};

/// Name of this kind of part in errors.
const PART: &str = "structure";
/// Methods that may be missing.
const OPTIONAL: [&str; 5] = ["damping", "load", "energy", "commit", "save"];

/// A Python object with `dofs`, `base()`, `mass()` and `stiffness()`; a structure that is nonlinear also has `force(u)`
/// and `tangent(u)`.
pub(crate) struct UserStructure {
    object: UserObject,
    dofs: usize,
    base: Base,
    names: Option<DofNames>,
    active_damping: bool,
    active_stiffness: bool,
    nonlinear: bool,
}

impl UserStructure {
    /// The structure of one simulation. A nonlinear one is a deep copy of the object, so that
    /// simulations do not share its internal variables.
    pub(crate) fn new(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = given.py();
        let nonlinear = given.hasattr("force")?;
        let given = if nonlinear { copied(given)? } else { given.clone() };
        let object = UserObject::new(&given, PART, &OPTIONAL)?;
        let dofs = given.getattr("dofs")?;
        let dofs = if dofs.is_callable() { dofs.call0()? } else { dofs };
        let Count(dofs) = returned("dofs of the structure", &dofs)?;
        let base: BaseLike = object.call(py, "base", ())?;
        let flag = |name: &str| -> PyResult<bool> {
            let flag = given.getattr_opt(name)?;
            flag.map_or(Ok(false), |flag| flag.is_truthy())
        };
        Ok(Self {
            dofs,
            names: DofNames::from_structure(&given, dofs)?,
            base: base.of_structure(dofs)?,
            active_damping: flag("active_damping")?,
            active_stiffness: flag("active_stiffness")?,
            nonlinear,
            object,
        })
    }

    /// The object that is asked.
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
        let found = self.object.attempt(|py| {
            let Matrix(found) = self.object.call(py, method, arguments)?;
            let own = [found.order(), self.dofs].map(|order| format!("({order}, {order})"));
            self.object.shaped(method, "a matrix", found, own)
        });
        for &(row, column, value) in found?.entries() {
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
        let found = self.object.attempt(|py| {
            let Numbers(found) = self.object.call(py, method, arguments)?;
            let own = [found.len(), sum.len()].map(|count| format!("({count},)"));
            self.object.shaped(method, "an array", found, own)
        });
        sum.iter_mut().zip(found?).for_each(|(sum, value)| *sum += value);
        Ok(())
    }
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
        self.active_damping
    }

    fn has_active_stiffness(&self) -> bool {
        self.active_stiffness
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        self.names.as_ref()?.describe(dofs)
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        if !self.object.has("load") {
            return Ok(());
        }
        self.add_vector("load", (time,), load)
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.nonlinear.then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        if self.nonlinear { Some(self) } else { None }
    }
}

/// `force(u)` and `tangent(u)`, and as it may be `energy(u)`, `commit(u)`, `save()`, `restore(values)`.
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
            let done = Python::attach(|py| {
                self.object.bind(py).call_method1("commit", argument).map(|_| ())
            });
            // The step is already accepted: the exception ends the run after it.
            done.unwrap_or_else(keep);
        }
    }

    fn save(&self) -> Result<Vec<f64>> {
        self.object.saved()
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        if !self.object.has("save") && values.is_empty() {
            return Ok(());
        }
        let argument = (Array::from(values),);
        self.object.attempt(|py| self.object.bind(py).call_method1("restore", argument).map(|_| ()))
    }
}
