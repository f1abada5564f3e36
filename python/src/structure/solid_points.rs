//! States of solids at integration points.

use basemat::fem::SolidPoint;
use pyo3::prelude::*;

use super::PyFemModel;
use crate::array::{Array, Count, Rows};
use crate::error::{OrRaise, raise_user_exceptions};

/// States at the n integration points of an element whose material yields or is a `UserMaterial`.
///
/// `Simulation.solid_points` and `FemModel.solid_points` return them. Components are xx, yy, zz and xy; tension is
/// positive, and the shear strain is the engineering strain. The values include the static state.
#[pyclass(name = "SolidPoints", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PySolidPoints {
    element: usize,
    positions: Vec<[f64; 2]>,
    areas: Vec<f64>,
    strains: Vec<[f64; 4]>,
    stresses: Vec<[f64; 4]>,
    plastic_strains: Vec<f64>,
    mobilised_strengths: Vec<f64>,
}

/// Rows of an array.
fn rows<const N: usize>(values: &[[f64; N]]) -> Rows {
    Rows(values.iter().map(|row| row.to_vec()).collect())
}

impl PySolidPoints {
    /// States that `read` returns for an element; raises exceptions of a material written in Python.
    pub(crate) fn of_element(
        element: usize,
        read: impl FnOnce(usize) -> basemat::Result<Vec<SolidPoint>>,
    ) -> PyResult<Self> {
        let points = raise_user_exceptions(|| read(element).or_raise())?;
        Ok(Self {
            element,
            positions: points.iter().map(|point| point.position).collect(),
            areas: points.iter().map(|point| point.area).collect(),
            strains: points.iter().map(|point| point.strain).collect(),
            stresses: points.iter().map(|point| point.stress).collect(),
            plastic_strains: values(&points, |point| point.state.plastic_strain),
            mobilised_strengths: values(&points, |point| point.state.mobilised_strength),
        })
    }

    /// Whether the element has no points.
    pub(crate) fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Plastic shear strain, mean over the area of the element.
    pub(crate) fn mean_plastic(&self) -> f64 {
        let area: f64 = self.areas.iter().sum();
        let areas_and_strains = self.areas.iter().zip(&self.plastic_strains);
        areas_and_strains.map(|(area, strain)| area * strain).sum::<f64>() / area
    }

    /// Largest mobilised strength of the points.
    pub(crate) fn largest_mobilised(&self) -> f64 {
        self.mobilised_strengths.iter().fold(0.0, |max, strength| strength.max(max))
    }
}

/// A value at each point.
fn values(points: &[SolidPoint], value: impl Fn(&SolidPoint) -> f64) -> Vec<f64> {
    points.iter().map(value).collect()
}

#[pymethods]
impl PySolidPoints {
    /// Number of the element.
    #[getter]
    fn element(&self) -> usize {
        self.element
    }

    /// Positions x and y in the undeformed mesh: array of shape (n, 2), m.
    #[getter]
    fn position(&self) -> Rows {
        rows(&self.positions)
    }

    /// Area of each point, the factor of its values in integrals over the element: array of shape (n,), m².
    #[getter]
    fn area(&self) -> Array {
        self.areas.as_slice().into()
    }

    /// Strains: array of shape (n, 4), numbers without unit.
    #[getter]
    fn strain(&self) -> Rows {
        rows(&self.strains)
    }

    /// Stresses: array of shape (n, 4), Pa.
    #[getter]
    fn stress(&self) -> Rows {
        rows(&self.stresses)
    }

    /// Plastic shear strains √(2 e^p : e^p) of the deviator e^p, in simple shear |γ^p|: array of shape (n,), numbers without
    /// unit.
    #[getter]
    fn plastic_strain(&self) -> Array {
        self.plastic_strains.as_slice().into()
    }

    /// Ratio of shear stress to shear strength at each point, from 0 to 1: array of shape (n,).
    #[getter]
    fn mobilised_strength(&self) -> Array {
        self.mobilised_strengths.as_slice().into()
    }

    /// Plastic shear strain, mean over the area of the element; a number without unit.
    #[getter]
    fn mean_plastic_strain(&self) -> f64 {
        self.mean_plastic()
    }

    /// Largest ratio of shear stress to shear strength at the points.
    #[getter]
    fn largest_mobilised_strength(&self) -> f64 {
        self.largest_mobilised()
    }

    fn __repr__(&self) -> String {
        format!("SolidPoints(element {}, {} points)", self.element, self.areas.len())
    }
}

#[pymethods]
impl PyFemModel {
    /// Numbers of the elements whose material yields or is a `UserMaterial`, beams of fibres included: list, ascending.
    #[getter]
    fn inelastic_elements(&self) -> Vec<usize> {
        self.0.inelastic_elements().collect()
    }

    /// The `SolidPoints` of an ``element`` of the undeformed model, with its initial stress; `Simulation.solid_points`
    /// returns those of a simulation.
    fn solid_points(&self, element: Count) -> PyResult<PySolidPoints> {
        PySolidPoints::of_element(element.0, |index| self.0.solid_points(index))
    }
}
