//! A law of fibres written in Python.

use std::fmt;
use std::sync::Arc;

use basemat::Result;
use basemat::fem::{UniaxialMaterial, UniaxialResponse};
use basemat::structure::InternalEnergy;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyType;

use super::object::UserObject;
use crate::array::real_number;
use crate::error::input_error;

/// Name of this kind of part in errors.
const PART_NAME: &str = "law of a fibre";
/// Methods that every law has.
const REQUIRED_METHODS: [&str; 2] = ["response", "energy"];
/// Methods that a law may lack.
const OPTIONAL_METHODS: [&str; 2] = ["initialize", "commit"];

/// The law of a Python object with `response(strain, variables)`.
pub(crate) fn uniaxial_material(object: &Bound<'_, PyAny>) -> PyResult<Arc<dyn UniaxialMaterial>> {
    if object.is_instance_of::<PyType>() || !object.hasattr("response")? {
        return Err(input_error(format!(
            "{} is no law of a fibre: it must be a Concrete, BilinearSteel, MenegottoPinto, Material or an object with a \
             method `response`",
            object.repr()?
        )));
    }
    Ok(Arc::new(UserUniaxialMaterial::new(object)?))
}

/// A Python object with `modulus`, `response(strain, variables)` and `energy(strain, variables)`. Optional are
/// `variable_count`, `initialize()` and `commit(strain, variables)`.
///
/// The element stores the internal variables; `initialize` and `commit` return them.
struct UserUniaxialMaterial {
    object: UserObject,
    /// Modulus of small strains, Pa.
    modulus: f64,
    /// Internal variables of a fibre without strain.
    initial_variables: Vec<f64>,
}

impl fmt::Debug for UserUniaxialMaterial {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("UserUniaxialMaterial").finish_non_exhaustive()
    }
}

impl UserUniaxialMaterial {
    fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let user_object =
            UserObject::with_required(object, PART_NAME, &REQUIRED_METHODS, &OPTIONAL_METHODS)?;
        let modulus = object
            .getattr_opt("modulus")?
            .ok_or_else(|| input_error(format!("the {PART_NAME} has no `modulus` (Pa)")))?;
        let modulus = real_number("modulus of the law of a fibre", &modulus)?;
        let variable_count = user_object.variable_count(object.py())?;
        let mut law =
            Self { object: user_object, modulus, initial_variables: vec![0.0; variable_count] };
        if law.object.has("initialize") {
            let value = object.call_method0("initialize")?;
            law.initial_variables = law.object.numbers("initialize", &value, variable_count)?;
        }
        Ok(law)
    }

    /// Value that a method returns for a strain and internal variables.
    fn call<'py>(
        &self,
        py: Python<'py>,
        method: &str,
        strain: f64,
        variables: &[f64],
    ) -> PyResult<Bound<'py, PyAny>> {
        let variables = PyArray1::from_slice(py, variables);
        self.object.bind(py).call_method1(method, (strain, variables))
    }

    /// Two finite numbers that a method returns for a strain and internal variables.
    fn call_pair(
        &self,
        py: Python<'_>,
        method: &str,
        strain: f64,
        variables: &[f64],
    ) -> PyResult<[f64; 2]> {
        let value = self.call(py, method, strain, variables)?;
        let numbers = self.object.numbers(method, &value, 2)?;
        Ok([numbers[0], numbers[1]])
    }
}

impl UniaxialMaterial for UserUniaxialMaterial {
    fn modulus(&self) -> f64 {
        self.modulus
    }

    fn variable_count(&self) -> usize {
        self.initial_variables.len()
    }

    fn initialize(&self, variables: &mut [f64]) {
        variables.copy_from_slice(&self.initial_variables);
    }

    fn response(&self, strain: f64, variables: &[f64]) -> Result<UniaxialResponse> {
        self.object.try_call(|py| {
            let [stress, tangent] = self.call_pair(py, "response", strain, variables)?;
            Ok(UniaxialResponse { stress, tangent })
        })
    }

    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy> {
        self.object.try_call(|py| {
            let [stored, dissipated] = self.call_pair(py, "energy", strain, variables)?;
            Ok(InternalEnergy { stored, dissipated })
        })
    }

    fn commit(&self, strain: f64, variables: &mut [f64]) {
        self.object.commit_variables(variables, |py, previous_variables| {
            self.call(py, "commit", strain, previous_variables)
        });
    }
}
