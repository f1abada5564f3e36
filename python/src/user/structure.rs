//! A structure written in Python.

use basemat::structure::{
    ContactNode, FaceNode, InternalEnergy, NonlinearForce, Structure, Triplets,
};
use basemat::{CheckpointError, Error, Result};
use numpy::PyArray1;
use pyo3::prelude::*;

use super::object::{UserObject, ask, copied};
use crate::array::{Count, Matrix, Numbers};
use crate::dof_names::DofNames;
use crate::error::{keep, refuse, returned};
use crate::structure::Contact;

/// Its name in errors.
const PART: &str = "structure";
/// Methods that may be missing.
const OPTIONAL: [&str; 7] =
    ["damping", "load", "foundation_ends", "contact_faces", "energy", "commit", "save"];

/// A Python object with `dofs`, `contact_nodes()` or `contact_faces()`, `mass()` and `stiffness()`; a structure that
/// is nonlinear also has `force(u)` and `tangent(u)`.
pub(crate) struct UserStructure {
    object: UserObject,
    dofs: usize,
    contact: (Vec<ContactNode>, Vec<Vec<FaceNode>>),
    ends: Vec<usize>,
    names: Option<DofNames>,
    active_damping: bool,
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
        let base = |method| object.call::<Contact<'_>>(py, method, ());
        let faces = object.has("contact_faces").then(|| base("contact_faces")).transpose()?;
        let contact = match faces {
            Some(faces @ Contact::Faces(_)) => faces,
            _ => base("contact_nodes")?,
        };
        let ends = object.has("foundation_ends").then(|| object.call(py, "foundation_ends", ()));
        let flag = given.getattr_opt("active_damping")?;
        Ok(Self {
            dofs,
            names: DofNames::of(&given, dofs)?,
            contact: contact.of(dofs)?,
            ends: ends.transpose()?.unwrap_or_default(),
            active_damping: flag.map_or(Ok(false), |flag| flag.is_truthy())?,
            nonlinear,
            object,
        })
    }

    /// The object that is asked.
    pub(crate) fn object<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        self.object.bind(py).clone()
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

    /// Adds the matrix that a method returns.
    fn add(&self, method: &str, matrix: &mut Triplets) -> Result<()> {
        let found = self.object.attempt(|py| {
            matrix_of(method, &self.object.bind(py).call_method0(method)?, self.dofs)
        });
        add_matrix(&found?, matrix);
        Ok(())
    }
}

/// What a method of the structure returned, if it has the `shape` that is needed; `found` is its own.
fn shaped<T>(method: &str, what: &str, value: T, found: String, shape: String) -> PyResult<T> {
    if found == shape {
        return Ok(value);
    }
    let text = format!("returned {what} of shape {found}, but must return one of {shape}");
    Err(refuse(format!("{method} of the structure {text}")))
}

/// The matrix that a method of the structure returned.
fn matrix_of(method: &str, found: &Bound<'_, PyAny>, order: usize) -> PyResult<Triplets> {
    let Matrix(matrix) = returned(&format!("{method} of the structure"), found)?;
    let [own, needed] = [matrix.order(), order].map(|order| format!("({order}, {order})"));
    shaped(method, "a matrix", matrix, own, needed)
}

/// The vector that a method of the structure returned.
fn vector_of(method: &str, found: &Bound<'_, PyAny>, order: usize) -> PyResult<Vec<f64>> {
    let Numbers(values) = returned(&format!("{method} of the structure"), found)?;
    let [own, needed] = [values.len(), order].map(|count| format!("({count},)"));
    shaped(method, "an array", values, own, needed)
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
        if self.object.has("damping") { self.add("damping", matrix) } else { Ok(()) }
    }

    fn has_active_damping(&self) -> bool {
        self.active_damping
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        self.names.as_ref()?.describe(dofs)
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        if !self.object.has("load") {
            return Ok(());
        }
        let found = self.object.attempt(|py| {
            let found = self.object.bind(py).call_method1("load", (time,))?;
            vector_of("load", &found, load.len())
        });
        add_numbers(&found?, load);
        Ok(())
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
        let found = self
            .object
            .attempt(|py| vector_of("force", &self.call(py, "force", displacement)?, force.len()));
        add_numbers(&found?, force);
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        let found = self.object.attempt(|py| {
            matrix_of("tangent", &self.call(py, "tangent", displacement)?, self.dofs)
        });
        add_matrix(&found?, matrix);
        Ok(())
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        if !self.object.has("energy") {
            return None;
        }
        let (stored, dissipated) = ask((f64::NAN, f64::NAN), |py| {
            self.object.call(py, "energy", (PyArray1::from_slice(py, displacement),))
        });
        Some(InternalEnergy { stored, dissipated })
    }

    fn commit(&mut self, displacement: &[f64]) {
        if self.object.has("commit") {
            let done = Python::attach(|py| self.call(py, "commit", displacement).map(|_| ()));
            // The step is accepted by now: the exception ends the run after it.
            done.unwrap_or_else(keep);
        }
    }

    fn save(&self) -> Result<Vec<f64>> {
        if self.object.has("save") {
            return self.object.attempt(|py| Ok(self.object.call::<Numbers>(py, "save", ())?.0));
        }
        if self.object.has("commit") {
            return Err(Error::Checkpoint(CheckpointError::Unsupported { part: PART }));
        }
        Ok(Vec::new())
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        if !self.object.has("save") && values.is_empty() {
            return Ok(());
        }
        self.object.attempt(|py| self.call(py, "restore", values).map(|_| ()))
    }
}
