//! A material of solids written in Python.

use std::fmt;

use basemat::Result;
use basemat::fem::{SharedMaterial, SolidMaterial, SolidState};
use basemat::structure::InternalEnergy;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyType;

use super::object::{UserObject, call_unless_raised};
use crate::array::{Table, real_number};
use crate::error::{extract_returned, input_error};

/// Name of this kind of part in errors.
const PART_NAME: &str = "material";
/// Methods that every material has.
const REQUIRED_METHODS: [&str; 4] = ["elasticity", "stress", "tangent", "energy"];
/// Methods that a material may lack.
const OPTIONAL_METHODS: [&str; 3] = ["initialize", "commit", "state"];
/// Largest difference of the stress at zero strain from the initial stress, relative to the initial stress.
const INITIAL_STRESS_TOLERANCE: f64 = 1e-6;
/// Largest difference of these stresses that counts as rounding, relative to the largest modulus of the material.
const RELATIVE_STRESS_ROUNDING: f64 = 1e-12;

/// The material of a Python object with `stress(strain, variables)`.
pub(crate) fn solid_material(object: &Bound<'_, PyAny>) -> PyResult<SharedMaterial> {
    if object.is_instance_of::<PyType>() || !object.hasattr("stress")? {
        return Err(input_error(format!(
            "{} is no material: it must be a Material, Iwan, DruckerPrager or an object with a method `stress`",
            object.repr()?
        )));
    }
    UserMaterial::new(object).map(SharedMaterial::from)
}

/// A Python object with `density`, `elasticity()`, `stress(strain, variables)`, `tangent(strain, variables)` and
/// `energy(strain, variables)`. Optional are `variable_count`, `initialize(initial_stress)`, `commit(strain, variables)`,
/// `state(strain, variables)` and `symmetric_tangent`.
///
/// The element stores the internal variables; `initialize` and `commit` return them.
struct UserMaterial {
    object: UserObject,
    /// Density, kg/m³.
    density: f64,
    /// Elastic stiffness matrix, Pa.
    elasticity: [[f64; 4]; 4],
    variable_count: usize,
    has_symmetric_tangent: bool,
}

impl fmt::Debug for UserMaterial {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("UserMaterial").finish_non_exhaustive()
    }
}

impl UserMaterial {
    fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let user_object =
            UserObject::with_required(object, PART_NAME, &REQUIRED_METHODS, &OPTIONAL_METHODS)?;
        let density = object
            .getattr_opt("density")?
            .ok_or_else(|| input_error("the material has no `density` (kg/m³)"))?;
        let density = real_number("density of the material", &density)?;
        if !(density.is_finite() && density >= 0.0) {
            let requirement = "must be finite and not negative";
            return Err(input_error(format!(
                "density of the material is {density}, but {requirement}"
            )));
        }
        let variable_count = user_object.variable_count(object.py())?;
        let has_symmetric_tangent = match object.getattr_opt("symmetric_tangent")? {
            Some(flag) => flag.is_truthy()?,
            None => true,
        };
        let mut material = Self {
            object: user_object,
            density,
            elasticity: [[0.0; 4]; 4],
            variable_count,
            has_symmetric_tangent,
        };
        material.elasticity = material.matrix("elasticity", &object.call_method0("elasticity")?)?;
        Ok(material)
    }

    /// Value that a method returns for a strain and internal variables.
    fn call<'py>(
        &self,
        py: Python<'py>,
        method: &str,
        strain: [f64; 4],
        variables: &[f64],
    ) -> PyResult<Bound<'py, PyAny>> {
        let strain = PyArray1::from_slice(py, &strain);
        let variables = PyArray1::from_slice(py, variables);
        self.object.bind(py).call_method1(method, (strain, variables))
    }

    /// Matrix of shape (4, 4) that a method returned, with finite entries.
    fn matrix(&self, method: &str, value: &Bound<'_, PyAny>) -> PyResult<[[f64; 4]; 4]> {
        let name = format!("{method} of the {PART_NAME}");
        let ReturnedTable(Table { column_count, rows }) = extract_returned(&name, value)?;
        let shape = format!("({}, {column_count})", rows.len());
        let rows = self.object.checked_shape(method, "an array", rows, &shape, "(4, 4)")?;
        self.object.check_finite(method, rows.iter().flatten())?;
        let mut matrix = [[0.0; 4]; 4];
        for (entries, row) in matrix.iter_mut().zip(&rows) {
            entries.copy_from_slice(row);
        }
        Ok(matrix)
    }

    fn call_stress(
        &self,
        py: Python<'_>,
        strain: [f64; 4],
        variables: &[f64],
    ) -> PyResult<[f64; 4]> {
        let value = self.call(py, "stress", strain, variables)?;
        let numbers = self.object.numbers("stress", &value, 4)?;
        Ok([numbers[0], numbers[1], numbers[2], numbers[3]])
    }

    /// Overwrites the internal variables with those at zero strain under an initial stress.
    ///
    /// Without `initialize` they are zeros. It is an error unless the stress is then the initial stress.
    fn initial_variables(
        &self,
        py: Python<'_>,
        initial_stress: [f64; 4],
        variables: &mut [f64],
    ) -> PyResult<()> {
        if self.object.has("initialize") {
            let argument = (PyArray1::from_slice(py, &initial_stress),);
            let value = self.object.bind(py).call_method1("initialize", argument)?;
            variables.copy_from_slice(&self.object.numbers(
                "initialize",
                &value,
                self.variable_count,
            )?);
        } else {
            variables.fill(0.0);
        }
        let stress = self.call_stress(py, [0.0; 4], variables)?;
        let magnitude = largest_magnitude(&initial_stress);
        let max_modulus = largest_magnitude(self.elasticity.as_flattened());
        let tolerance =
            INITIAL_STRESS_TOLERANCE * magnitude + RELATIVE_STRESS_ROUNDING * max_modulus;
        let is_initial_stress =
            stress.iter().zip(&initial_stress).all(|(a, b)| (a - b).abs() <= tolerance);
        if is_initial_stress {
            return Ok(());
        }
        Err(input_error(format!(
            "stress of the material at zero strain is {stress:?} Pa, but must be the initial stress {initial_stress:?} Pa \
             (`initialize` returns the internal variables under it)"
        )))
    }
}

/// An array of two axes that a method returned.
struct ReturnedTable(Table);

extracts!(ReturnedTable, object => Ok(Self(Table::read(&object, "(4, 4)")?)));

fn largest_magnitude(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0_f64, |max, number| max.max(number.abs()))
}

impl SolidMaterial for UserMaterial {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> [[f64; 4]; 4] {
        self.elasticity
    }

    fn variable_count(&self) -> usize {
        self.variable_count
    }

    fn initialize(&self, initial_stress: [f64; 4], variables: &mut [f64]) -> Result<()> {
        self.object.try_call(|py| self.initial_variables(py, initial_stress, variables))
    }

    fn stress(&self, strain: [f64; 4], variables: &[f64]) -> Result<[f64; 4]> {
        self.object.try_call(|py| self.call_stress(py, strain, variables))
    }

    fn tangent(&self, strain: [f64; 4], variables: &[f64]) -> Result<[[f64; 4]; 4]> {
        self.object
            .try_call(|py| self.matrix("tangent", &self.call(py, "tangent", strain, variables)?))
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.has_symmetric_tangent
    }

    fn energy(&self, strain: [f64; 4], variables: &[f64]) -> Result<InternalEnergy> {
        self.object.try_call(|py| {
            let value = self.call(py, "energy", strain, variables)?;
            let numbers = self.object.numbers("energy", &value, 2)?;
            Ok(InternalEnergy { stored: numbers[0], dissipated: numbers[1] })
        })
    }

    fn commit(&self, strain: [f64; 4], variables: &mut [f64]) {
        self.object.commit_variables(variables, |py, previous_variables| {
            self.call(py, "commit", strain, previous_variables)
        });
    }

    fn state(&self, strain: [f64; 4], variables: &[f64]) -> SolidState {
        if !self.object.has("state") {
            return SolidState::default();
        }
        call_unless_raised(SolidState::default(), |py| {
            let value = self.call(py, "state", strain, variables)?;
            let numbers = self.object.numbers("state", &value, 2)?;
            Ok(SolidState { plastic_strain: numbers[0], mobilised_strength: numbers[1] })
        })
    }
}
