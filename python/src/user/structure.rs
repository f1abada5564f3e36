//! A structure written in Python.

use basemat::structure::{
    ContactNode, FaceNode, InternalEnergy, NonlinearForce, Structure, Triplets,
};
use basemat::{CheckpointError, Error, Result};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::array::{Count, Matrix, Numbers};
use crate::dof_names::DofNames;
use crate::error::{keep, kept, refuse, returned};
use crate::structure::Contact;

/// Its name in errors.
const PART: &str = "structure";

/// A Python object with `dofs`, `contact_nodes()`, `mass()` and `stiffness()`; a structure that
/// is nonlinear also has `force(u)` and `tangent(u)`.
pub(crate) struct UserStructure {
    object: Py<PyAny>,
    dofs: usize,
    contact: (Vec<ContactNode>, Vec<Vec<FaceNode>>),
    ends: Vec<usize>,
    names: Option<DofNames>,
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
        let base = |method: &str| -> PyResult<Contact<'_>> {
            returned(&format!("{method} of the structure"), &object.call_method0(method)?)
        };
        let faces = object.hasattr("contact_faces")?.then(|| base("contact_faces")).transpose()?;
        let contact = match faces {
            Some(faces @ Contact::Faces(_)) => faces,
            _ => base("contact_nodes")?,
        };
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
            names: DofNames::of(&object, dofs)?,
            contact: contact.of(dofs)?,
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
fn matrix_of(method: &str, found: &Bound<'_, PyAny>, order: usize) -> PyResult<Triplets> {
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
fn vector_of(method: &str, found: &Bound<'_, PyAny>, order: usize) -> PyResult<Vec<f64>> {
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
fn add_matrix(own: &Triplets, matrix: &mut Triplets) {
    for &(row, column, value) in own.entries() {
        matrix.add(row, column, value);
    }
}

/// Adds numbers of Python to a vector of the core.
fn add_numbers(own: &[f64], sum: &mut [f64]) {
    sum.iter_mut().zip(own).for_each(|(sum, value)| *sum += value);
}

impl Structure for UserStructure {
    fn dofs(&self) -> usize {
        self.dofs
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.contact.0.clone()
    }

    fn contact_faces(&self) -> Vec<Vec<FaceNode>> {
        self.contact.1.clone()
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

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        self.names.as_ref()?.describe(dofs)
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

/// `force(u)` and `tangent(u)`, and as it may be `energy(u)`, `commit(u)`, `save()`, `restore(values)`.
struct UserForce {
    object: Py<PyAny>,
    dofs: usize,
    has_energy: bool,
    has_commit: bool,
    has_save: bool,
}

impl UserForce {
    fn new(object: &Bound<'_, PyAny>, dofs: usize) -> PyResult<Self> {
        Ok(Self {
            dofs,
            has_energy: object.hasattr("energy")?,
            has_commit: object.hasattr("commit")?,
            has_save: object.hasattr("save")?,
            object: object.clone().unbind(),
        })
    }

    /// Calls a method with the displacement: array of shape (n,).
    fn call<'py>(
        &self,
        py: Python<'py>,
        method: &str,
        displacement: &[f64],
    ) -> PyResult<Bound<'py, PyAny>> {
        let displacement = PyArray1::from_slice(py, displacement);
        self.object.bind(py).call_method1(method, (displacement,))
    }
}

impl NonlinearForce for UserForce {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        let found = Python::attach(|py| -> PyResult<Vec<f64>> {
            vector_of("force", &self.call(py, "force", displacement)?, force.len())
        });
        add_numbers(&found.map_err(|error| kept(PART, error))?, force);
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        let found = Python::attach(|py| -> PyResult<Triplets> {
            matrix_of("tangent", &self.call(py, "tangent", displacement)?, self.dofs)
        });
        add_matrix(&found.map_err(|error| kept(PART, error))?, matrix);
        Ok(())
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        if !self.has_energy {
            return None;
        }
        let found = Python::attach(|py| -> PyResult<(f64, f64)> {
            returned("energy of the structure", &self.call(py, "energy", displacement)?)
        });
        let (stored, dissipated) = found.unwrap_or_else(|error| {
            keep(error);
            (f64::NAN, f64::NAN)
        });
        Some(InternalEnergy { stored, dissipated })
    }

    fn commit(&mut self, displacement: &[f64]) {
        if self.has_commit {
            let done = Python::attach(|py| self.call(py, "commit", displacement).map(|_| ()));
            // The step is accepted by now: the exception ends the run after it.
            done.unwrap_or_else(keep);
        }
    }

    fn save(&self) -> Result<Vec<f64>> {
        if self.has_save {
            let found = Python::attach(|py| -> PyResult<Vec<f64>> {
                let found = self.object.bind(py).call_method0("save")?;
                Ok(returned::<Numbers>("save of the structure", &found)?.0)
            });
            return found.map_err(|error| kept(PART, error));
        }
        if self.has_commit {
            return Err(Error::Checkpoint(CheckpointError::Unsupported { part: "structure" }));
        }
        Ok(Vec::new())
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        if !self.has_save && values.is_empty() {
            return Ok(());
        }
        let done = Python::attach(|py| {
            let values = PyArray1::from_slice(py, values);
            self.object.bind(py).call_method1("restore", (values,)).map(|_| ())
        });
        done.map_err(|error| kept(PART, error))
    }
}
