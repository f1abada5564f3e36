//! Materials of solids and shells, layers of a block.

use basemat::fem::{Layer, Material, QuadFormulation};
use pyo3::prelude::*;

use crate::array::whole_numbers;
use crate::error::{OrRaise, input_error};
use crate::names::choice;

/// Integration of four-node quadrilaterals by its name.
pub(super) fn formulation(name: &str, percent: usize) -> PyResult<QuadFormulation> {
    let percent = u8::try_from(percent).map_err(|_| {
        input_error(format!("hourglass_percent is {percent}, but must be {} or less", u8::MAX))
    })?;
    let choices = [
        ("full", QuadFormulation::Full),
        ("incompatible_modes", QuadFormulation::IncompatibleModes),
        ("one_point", QuadFormulation::OnePoint),
        ("hourglass", QuadFormulation::Hourglass { percent }),
    ];
    choice("formulation", name, &choices)
}

/// Elastic material in plane strain: Young's modulus ``young_modulus`` (Pa), Poisson's ratio ``poisson``,
/// ``density`` (kg/m³).
#[pyclass(name = "Material", module = "basemat", frozen, dict)]
pub(crate) struct PyMaterial(pub(super) Material);

#[pymethods]
impl PyMaterial {
    #[new]
    fn new(young_modulus: f64, poisson: f64, density: f64) -> PyResult<Self> {
        Ok(Self(Material::new(young_modulus, poisson, density).or_raise()?))
    }
}

/// Horizontal layer of a block of quadrilaterals: ``height`` (m), number of ``rows`` of elements,
/// ``material`` (`Material`).
///
/// ``formulation`` of four-node quadrilaterals: "incompatible_modes" (the default: right in bending),
/// "full" (2 × 2 points), "one_point" (without stiffness against hourglass modes) or "hourglass" (one
/// point, stabilised with ``hourglass_percent``, 5 by default).
#[pyclass(name = "Layer", module = "basemat", frozen, dict)]
pub(crate) struct PyLayer(pub(super) Layer);

#[pymethods]
impl PyLayer {
    #[pyo3(signature = (height, rows, material, *, formulation="incompatible_modes", hourglass_percent=5))]
    #[new]
    fn new(
        height: f64,
        #[pyo3(from_py_with = whole_numbers)] rows: usize,
        material: &PyMaterial,
        formulation: &str,
        #[pyo3(from_py_with = whole_numbers)] hourglass_percent: usize,
    ) -> PyResult<Self> {
        let formulation = self::formulation(formulation, hourglass_percent)?;
        Ok(Self(Layer { height, rows, material: material.0, formulation }))
    }
}
