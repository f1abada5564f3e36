//! Layers of a block of quadrilaterals, and the formulations of four-node ones.

use basemat::fem::{Layer, QuadFormulation, SharedMaterial};
use pyo3::prelude::*;

use super::solid_material::SolidLike;
use crate::array::whole_numbers;
use crate::error::input_error;
use crate::names::choice;

/// Formulation of four-node quadrilaterals of a material: by its name, or the usual one without a name.
pub(super) fn formulation_of(
    material: &SharedMaterial,
    name: Option<&str>,
    hourglass_percent: usize,
) -> PyResult<QuadFormulation> {
    let percent = stabilisation_percent(hourglass_percent)?;
    match name {
        Some(name) => formulation(name, percent),
        None => Ok(QuadFormulation::for_material(material)),
    }
}

/// Percentage of the stabilisation against hourglass modes.
pub(super) fn stabilisation_percent(hourglass_percent: usize) -> PyResult<u8> {
    u8::try_from(hourglass_percent).map_err(|_| {
        input_error(format!(
            "hourglass_percent is {hourglass_percent}, but must be {} or less",
            u8::MAX
        ))
    })
}

/// Formulation of four-node quadrilaterals by its name.
pub(super) fn formulation(name: &str, percent: u8) -> PyResult<QuadFormulation> {
    let choices = [
        ("full", QuadFormulation::Full),
        ("incompatible_modes", QuadFormulation::IncompatibleModes),
        ("one_point", QuadFormulation::OnePoint),
        ("hourglass", QuadFormulation::Hourglass { percent }),
        ("mean_dilatation", QuadFormulation::MeanDilatation),
    ];
    choice("formulation", name, &choices)
}

/// Horizontal layer of a block of quadrilaterals: ``height`` (m), number of ``rows`` of elements,
/// ``material`` (`Material`, `Iwan`, `DruckerPrager` or `UserMaterial`).
///
/// ``formulation`` of four-node quadrilaterals: "incompatible_modes" (accurate in bending: that of an elastic material
/// unless given), "full" (2 × 2 points), "one_point" (without stiffness against hourglass modes), "hourglass" (one point,
/// stabilised with ``hourglass_percent``, 5 by default) or "mean_dilatation" (2 × 2 points with the mean dilatation of the
/// element: the only formulation for materials that yield, and theirs unless given).
#[pyclass(name = "Layer", module = "basemat", frozen, dict)]
pub(crate) struct PyLayer(pub(super) Layer<SharedMaterial>);

#[pymethods]
impl PyLayer {
    #[pyo3(signature = (height, rows, material, *, formulation=None, hourglass_percent=5))]
    #[new]
    fn new(
        height: f64,
        #[pyo3(from_py_with = whole_numbers)] rows: usize,
        material: SolidLike,
        formulation: Option<&str>,
        #[pyo3(from_py_with = whole_numbers)] hourglass_percent: usize,
    ) -> PyResult<Self> {
        let formulation = formulation_of(&material.0, formulation, hourglass_percent)?;
        Ok(Self(Layer { formulation, ..Layer::new(height, rows, material.0) }))
    }
}
