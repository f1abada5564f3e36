//! Elastic materials, and cross-sections of beams in space.

use basemat::fem::{BeamSection, Material};
use pyo3::prelude::*;

use crate::error::{OrRaise, WithOption};

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
