//! States of sections along beams of fibres.

use basemat::fem::BeamSectionState;
use pyo3::prelude::*;

use super::PyFemModel;
use crate::array::{Array, Count, Rows};
use crate::error::{OrRaise, raise_user_exceptions};

/// States of the n sections along a beam of fibres, each with f fibres.
///
/// `Simulation.beam_sections` and `FemModel.beam_sections` return them. They include the static state. In the plane forces
/// are per metre of thickness. `to_frame` and `fiber_frame` are tables.
#[pyclass(name = "BeamSections", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyBeamSections {
    element: usize,
    positions: Vec<[f64; 3]>,
    lengths: Vec<f64>,
    axial_strains: Vec<f64>,
    curvatures: Vec<f64>,
    axial_forces: Vec<f64>,
    moments: Vec<f64>,
    shears: Vec<f64>,
    curvatures_about_y: Vec<f64>,
    moments_about_y: Vec<f64>,
    shears_along_z: Vec<f64>,
    twist_rates: Vec<f64>,
    torques: Vec<f64>,
    fiber_positions: Vec<[f64; 2]>,
    fiber_areas: Vec<f64>,
    fiber_strains: Vec<Vec<f64>>,
    fiber_stresses: Vec<Vec<f64>>,
}

/// A value of each section.
fn values(sections: &[BeamSectionState], value: impl Fn(&BeamSectionState) -> f64) -> Vec<f64> {
    sections.iter().map(value).collect()
}

impl PyBeamSections {
    /// States that `read` returns for an element; raises exceptions of a law written in Python.
    pub(crate) fn of_element(
        element: usize,
        read: impl FnOnce(usize) -> basemat::Result<Vec<BeamSectionState>>,
    ) -> PyResult<Self> {
        let sections = raise_user_exceptions(|| read(element).or_raise())?;
        let fibers = sections.first().map(|section| section.fibers.as_slice()).unwrap_or_default();
        let strains =
            |section: &BeamSectionState| section.fibers.iter().map(|f| f.strain).collect();
        let stresses =
            |section: &BeamSectionState| section.fibers.iter().map(|f| f.stress).collect();
        Ok(Self {
            element,
            positions: sections.iter().map(|section| section.position).collect(),
            lengths: values(&sections, |section| section.length),
            axial_strains: values(&sections, |section| section.axial_strain),
            curvatures: values(&sections, |section| section.curvature),
            axial_forces: values(&sections, |section| section.axial_force),
            moments: values(&sections, |section| section.moment),
            shears: values(&sections, |section| section.shear),
            curvatures_about_y: values(&sections, |section| section.curvature_about_y),
            moments_about_y: values(&sections, |section| section.moment_about_y),
            shears_along_z: values(&sections, |section| section.shear_along_z),
            twist_rates: values(&sections, |section| section.twist_rate),
            torques: values(&sections, |section| section.torque),
            fiber_positions: fibers.iter().map(|fiber| fiber.position).collect(),
            fiber_areas: fibers.iter().map(|fiber| fiber.area).collect(),
            fiber_strains: sections.iter().map(strains).collect(),
            fiber_stresses: sections.iter().map(stresses).collect(),
        })
    }
}

#[pymethods]
impl PyBeamSections {
    /// Number of the element.
    #[getter]
    fn element(&self) -> usize {
        self.element
    }

    /// Positions x, y and z on the undeformed line between the nodes: array of shape (n, 3), m.
    #[getter]
    fn position(&self) -> Rows {
        Rows(self.positions.iter().map(|position| position.to_vec()).collect())
    }

    /// Part of the length of the beam for which each section stands: array of shape (n,), m.
    #[getter]
    fn length(&self) -> Array {
        self.lengths.as_slice().into()
    }

    /// Strain of the line between the nodes, elongation positive: array of shape (n,), numbers without unit.
    #[getter]
    fn axial_strain(&self) -> Array {
        self.axial_strains.as_slice().into()
    }

    /// Curvature about z, positive where it stretches the fibres at negative y: array of shape (n,), 1/m.
    #[getter]
    fn curvature(&self) -> Array {
        self.curvatures.as_slice().into()
    }

    /// Axial force, tension positive: array of shape (n,), N.
    #[getter]
    fn axial_force(&self) -> Array {
        self.axial_forces.as_slice().into()
    }

    /// Bending moment about z, positive with the curvature: array of shape (n,), N m.
    #[getter]
    fn moment(&self) -> Array {
        self.moments.as_slice().into()
    }

    /// Shear force along y: array of shape (n,), N.
    #[getter]
    fn shear(&self) -> Array {
        self.shears.as_slice().into()
    }

    /// Curvature about y, positive where it stretches the fibres at positive z: array of shape (n,), 1/m; zero in the plane.
    #[getter]
    fn curvature_about_y(&self) -> Array {
        self.curvatures_about_y.as_slice().into()
    }

    /// Bending moment about y, positive with the curvature about y: array of shape (n,), N m; zero in the plane.
    #[getter]
    fn moment_about_y(&self) -> Array {
        self.moments_about_y.as_slice().into()
    }

    /// Shear force along z: array of shape (n,), N; zero in the plane.
    #[getter]
    fn shear_along_z(&self) -> Array {
        self.shears_along_z.as_slice().into()
    }

    /// Change of the rotation about the axis of the beam along it: array of shape (n,), rad/m; zero in the plane.
    #[getter]
    fn twist_rate(&self) -> Array {
        self.twist_rates.as_slice().into()
    }

    /// Torque, positive with the twist rate: array of shape (n,), N m; zero in the plane.
    #[getter]
    fn torque(&self) -> Array {
        self.torques.as_slice().into()
    }

    /// Coordinates y and z of the fibres in their section: array of shape (f, 2), m.
    #[getter]
    fn fiber_position(&self) -> Rows {
        Rows(self.fiber_positions.iter().map(|position| position.to_vec()).collect())
    }

    /// Area of each fibre, the factor of its stress in the resultants: array of shape (f,), m².
    #[getter]
    fn fiber_area(&self) -> Array {
        self.fiber_areas.as_slice().into()
    }

    /// Strains of the fibres, tension positive: array of shape (n, f), numbers without unit.
    #[getter]
    fn fiber_strain(&self) -> Rows {
        Rows(self.fiber_strains.clone())
    }

    /// Stresses of the fibres, tension positive: array of shape (n, f), Pa.
    #[getter]
    fn fiber_stress(&self) -> Rows {
        Rows(self.fiber_stresses.clone())
    }

    fn __repr__(&self) -> String {
        let counts = [self.lengths.len(), self.fiber_areas.len()];
        format!(
            "BeamSections(element {}, {} sections of {} fibres)",
            self.element, counts[0], counts[1]
        )
    }
}

#[pymethods]
impl PyFemModel {
    /// The `BeamSections` of a beam of fibres with the number ``element`` in the undeformed model;
    /// `Simulation.beam_sections` returns those of a simulation.
    fn beam_sections(&self, element: Count) -> PyResult<PyBeamSections> {
        PyBeamSections::of_element(element.0, |index| self.0.beam_sections(index))
    }
}
