//! A structure written in Python.

use basemat::Result;
use basemat::structure::{ContactNode, NonlinearForce, Structure, Triplets};
use pyo3::prelude::*;

use super::nonlinear::UserForce;
use crate::array::{Count, Matrix, Numbers};
use crate::error::{kept, refuse, returned};
use crate::structure::PyContactNode;

/// Its name in errors.
pub(super) const PART: &str = "structure";

/// A Python object with `dofs`, `contact_nodes()`, `mass()` and `stiffness()`; a structure that
/// is nonlinear also has `force(u)` and `tangent(u)`.
pub(crate) struct UserStructure {
    object: Py<PyAny>,
    dofs: usize,
    contact: Vec<ContactNode>,
    ends: Vec<usize>,
    active_damping: bool,
    has_damping: bool,
    has_load: bool,
    force: Option<UserForce>,
}

impl UserStructure {
    /// The structure of one simulation. A nonlinear one is a deep copy of the object, so that
    /// simulations do not share its internal variables.
    pub(crate) fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let nonlinear = object.hasattr("force")?;
        let object = if nonlinear {
            object.py().import("copy")?.call_method1("deepcopy", (object,))?
        } else {
            object.clone()
        };
        let dofs = object.getattr("dofs")?;
        let dofs = if dofs.is_callable() { dofs.call0()? } else { dofs };
        let Count(dofs) = returned("dofs of the structure", &dofs)?;
        let nodes: Vec<Bound<'_, PyContactNode>> =
            returned("contact_nodes of the structure", &object.call_method0("contact_nodes")?)?;
        let ends = if object.hasattr("foundation_ends")? {
            returned("foundation_ends of the structure", &object.call_method0("foundation_ends")?)?
        } else {
            Vec::new()
        };
        let active_damping = match object.getattr_opt("active_damping")? {
            Some(flag) => flag.is_truthy()?,
            None => false,
        };
        Ok(Self {
            dofs,
            contact: crate::structure::nodes(&nodes, dofs)?,
            ends,
            active_damping,
            has_damping: object.hasattr("damping")?,
            has_load: object.hasattr("load")?,
            force: nonlinear.then(|| UserForce::new(&object, dofs)).transpose()?,
            object: object.unbind(),
        })
    }

    /// The object that is asked.
    pub(crate) fn object<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        self.object.bind(py).clone()
    }

    /// Adds the matrix that a method returns.
    fn add(&self, method: &str, matrix: &mut Triplets) -> Result<()> {
        let found = Python::attach(|py| -> PyResult<Triplets> {
            matrix_of(method, &self.object.bind(py).call_method0(method)?, self.dofs)
        });
        add_matrix(&found.map_err(|error| kept(PART, error))?, matrix);
        Ok(())
    }
}

/// The matrix that a method of the structure returned.
pub(super) fn matrix_of(
    method: &str,
    found: &Bound<'_, PyAny>,
    order: usize,
) -> PyResult<Triplets> {
    let name = format!("{method} of the structure");
    let Matrix(matrix) = returned(&name, found)?;
    if matrix.order() == order {
        return Ok(matrix);
    }
    let shape = (matrix.order(), matrix.order());
    let needed = (order, order);
    Err(refuse(format!(
        "{name} returned a matrix of shape {shape:?}, but must return one of {needed:?}"
    )))
}

/// The vector that a method of the structure returned.
pub(super) fn vector_of(
    method: &str,
    found: &Bound<'_, PyAny>,
    order: usize,
) -> PyResult<Vec<f64>> {
    let name = format!("{method} of the structure");
    let Numbers(values) = returned(&name, found)?;
    if values.len() == order {
        return Ok(values);
    }
    let shape = values.len();
    Err(refuse(format!(
        "{name} returned an array of shape ({shape},), but must return one of ({order},)"
    )))
}

/// Adds a matrix of Python to one of the core.
pub(super) fn add_matrix(own: &Triplets, matrix: &mut Triplets) {
    for &(row, column, value) in own.entries() {
        matrix.add(row, column, value);
    }
}

/// Adds numbers of Python to a vector of the core.
pub(super) fn add_numbers(own: &[f64], sum: &mut [f64]) {
    sum.iter_mut().zip(own).for_each(|(sum, value)| *sum += value);
}

impl Structure for UserStructure {
    fn dofs(&self) -> usize {
        self.dofs
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.contact.clone()
    }

    fn foundation_ends(&self) -> Vec<usize> {
        self.ends.clone()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.add("mass", matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add("stiffness", matrix)
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        if self.has_damping { self.add("damping", matrix) } else { Ok(()) }
    }

    fn has_active_damping(&self) -> bool {
        self.active_damping
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        if !self.has_load {
            return Ok(());
        }
        let found = Python::attach(|py| -> PyResult<Vec<f64>> {
            let found = self.object.bind(py).call_method1("load", (time,))?;
            vector_of("load", &found, load.len())
        });
        add_numbers(&found.map_err(|error| kept(PART, error))?, load);
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.force.as_ref().map(|force| force as &dyn NonlinearForce)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.force.as_mut().map(|force| force as &mut dyn NonlinearForce)
    }
}
