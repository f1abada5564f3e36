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
use crate::array::{Count, Numbers, real_number};
use crate::error::{extract_returned, input_error, store_exception};

/// Name of this kind of part in errors.
const PART_NAME: &str = "law of a fibre";
/// Methods that every law has.
const REQUIRED_METHODS: [&str; 2] = ["response", "energy"];
/// Methods that a law may lack.
const OPTIONAL_METHODS: [&str; 2] = ["initialize", "commit"];
/// Largest number of internal variables of a fibre.
const MAX_VARIABLE_COUNT: usize = 10_000;

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
        for method in REQUIRED_METHODS {
            if !object.hasattr(method)? {
                return Err(input_error(format!("the {PART_NAME} has no method `{method}`")));
            }
        }
        let user_object = UserObject::new(object, PART_NAME, &OPTIONAL_METHODS)?;
        let modulus = object
            .getattr_opt("modulus")?
            .ok_or_else(|| input_error(format!("the {PART_NAME} has no `modulus` (Pa)")))?;
        let modulus = real_number("modulus of the law of a fibre", &modulus)?;
        let name = "variable_count of the law of a fibre";
        let variable_count = match object.getattr_opt("variable_count")? {
            Some(count) => extract_returned::<Count>(name, &count)?.0,
            None => 0,
        };
        if variable_count > MAX_VARIABLE_COUNT {
            return Err(input_error(format!(
                "{name} is {variable_count}, but must be {MAX_VARIABLE_COUNT} or less"
            )));
        }
        if variable_count == 0 && user_object.has("commit") {
            let text = "but no `variable_count`, the number of values that it returns";
            return Err(input_error(format!("the {PART_NAME} has `commit`, {text}")));
        }
        let mut law =
            Self { object: user_object, modulus, initial_variables: vec![0.0; variable_count] };
        if law.object.has("initialize") {
            let value = object.call_method0("initialize")?;
            law.initial_variables = law.numbers("initialize", &value, variable_count)?;
        }
        Ok(law)
    }

    /// Numbers that a method returned for a strain and internal variables, as many as `expected_count` and finite.
    fn call(
        &self,
        py: Python<'_>,
        method: &str,
        strain: f64,
        variables: &[f64],
        expected_count: usize,
    ) -> PyResult<Vec<f64>> {
        let variables = PyArray1::from_slice(py, variables);
        let value = self.object.bind(py).call_method1(method, (strain, variables))?;
        self.numbers(method, &value, expected_count)
    }

    /// Numbers that a method returned, as many as `expected_count` and finite.
    fn numbers(
        &self,
        method: &str,
        value: &Bound<'_, PyAny>,
        expected_count: usize,
    ) -> PyResult<Vec<f64>> {
        let Numbers(numbers) = extract_returned(&format!("{method} of the {PART_NAME}"), value)?;
        let shape = format!("({},)", numbers.len());
        let expected_shape = format!("({expected_count},)");
        let numbers =
            self.object.checked_shape(method, "an array", numbers, &shape, &expected_shape)?;
        match numbers.iter().find(|number| !number.is_finite()) {
            Some(number) => Err(input_error(format!(
                "{method} of the {PART_NAME} returned {number}, but must return finite numbers"
            ))),
            None => Ok(numbers),
        }
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
            let numbers = self.call(py, "response", strain, variables, 2)?;
            Ok(UniaxialResponse { stress: numbers[0], tangent: numbers[1] })
        })
    }

    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy> {
        self.object.try_call(|py| {
            let numbers = self.call(py, "energy", strain, variables, 2)?;
            Ok(InternalEnergy { stored: numbers[0], dissipated: numbers[1] })
        })
    }

    /// After an exception the variables are unchanged.
    fn commit(&self, strain: f64, variables: &mut [f64]) {
        if !self.object.has("commit") {
            return;
        }
        let variable_count = variables.len();
        let committed_variables =
            Python::attach(|py| self.call(py, "commit", strain, variables, variable_count));
        match committed_variables {
            Ok(committed_variables) => variables.copy_from_slice(&committed_variables),
            // The step is already accepted: the exception ends the run after it.
            Err(exception) => store_exception(exception),
        }
    }
}
