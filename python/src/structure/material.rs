//! Materials, cross-sections of beams in space, and layers of a block.

use basemat::fem::{BeamSection, Layer, Material, QuadFormulation};
use pyo3::prelude::*;

use crate::array::whole_numbers;
use crate::error::{OrRaise, WithOption, input_error};
use crate::names::choice;

/// The formulation of four-node quadrilaterals with this name.
pub(super) fn formulation(name: &str, hourglass_percent: usize) -> PyResult<QuadFormulation> {
    let percent = u8::try_from(hourglass_percent).map_err(|_| {
        input_error(format!(
            "hourglass_percent is {hourglass_percent}, but must be {} or less",
            u8::MAX
        ))
    })?;
    let choices = [
        ("full", QuadFormulation::Full),
        ("incompatible_modes", QuadFormulation::IncompatibleModes),
        ("one_point", QuadFormulation::OnePoint),
        ("hourglass", QuadFormulation::Hourglass { percent }),
        ("mean_dilatation", QuadFormulation::MeanDilatation),
    ];
    choice("formulation", name, &choices)
}

/// Elastic material, in plane strain for elements in the plane: Young's modulus ``young_modulus`` (Pa), Poisson's ratio
/// ``poisson``, ``density`` (kg/m³).
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
/// ``formulation`` of four-node quadrilaterals: "incompatible_modes" (the default: accurate in bending), "full" (2 × 2
/// points), "one_point" (without stiffness against hourglass modes), "hourglass" (one point, stabilised with
/// ``hourglass_percent``, 5 by default) or "mean_dilatation" (2 × 2 points with the mean dilatation of the element: the
/// only formulation for materials that yield).
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

/// Cross-section of beams in space: ``area`` (m²), ``second_moments`` I_y = ∫ z² dA and I_z = ∫ y² dA (two numbers,
/// m⁴) and ``torsion_constant`` (m⁴).
///
/// y and z are the principal axes: y along the orientation of the beam, z perpendicular to it. ``shear_areas`` along y
/// and along z (two numbers, m²) make Timoshenko beams; they are infinite unless given. The shear area of a rectangle
/// is 5/6 of its area, its torsion constant about a b³ (1/3 − 0.21 b/a) with sides a ≥ b.
#[pyclass(name = "BeamSection", module = "basemat", frozen, dict)]
pub(crate) struct PyBeamSection(pub(super) BeamSection);

#[pymethods]
impl PyBeamSection {
    #[pyo3(signature = (area, second_moments, torsion_constant, *, shear_areas=None))]
    #[new]
    fn new(
        area: f64,
        second_moments: [f64; 2],
        torsion_constant: f64,
        shear_areas: Option<[f64; 2]>,
    ) -> PyResult<Self> {
        let section = BeamSection::new(area, second_moments, torsion_constant);
        Ok(Self(section.with(shear_areas, BeamSection::with_shear_areas).or_raise()?))
    }
}
