//! Forces at the ends of beams, as rows for probes.

use basemat::structure::{BeamEndRows, BeamRows};
use pyo3::prelude::*;

use super::PyFemModel;
use crate::array::{Count, Rows};
use crate::error::OrRaise;
use crate::row::PySectionRows;

/// Rows of the forces and moments at the ends of a beam.
///
/// They are rows of displacements for `Probe.section`. `FemModel.beam_rows` returns them.
///
/// At both ends the forces and moments act on a section whose outward normal is x, the axis of the beam. A probe
/// records changes from the static state. The rows contain the elastic forces, without damping and inertia; with P–Δ
/// also the forces of the geometric stiffness, in the axes of the undeformed beam.
#[pyclass(name = "BeamRows", module = "basemat", frozen)]
pub(crate) struct PyBeamRows(BeamRows);

#[pymethods]
impl PyBeamRows {
    /// Unit vectors x (along the beam), y and z of the section as rows: array of shape (3, 3), numbers without unit.
    #[getter]
    fn axes(&self) -> Rows {
        Rows(self.0.axes.iter().map(|axis| axis.to_vec()).collect())
    }

    /// Two `BeamEndRows`, of the first and the second end.
    #[getter]
    fn ends(&self) -> [PyBeamEndRows; 2] {
        self.0.ends.clone().map(PyBeamEndRows)
    }
}

/// Forces and moments at one end of a beam, as `SectionRows`: N and N·m, in the plane per metre of thickness.
#[pyclass(name = "BeamEndRows", module = "basemat", frozen)]
pub(crate) struct PyBeamEndRows(BeamEndRows);

#[pymethods]
impl PyBeamEndRows {
    /// Number of the node.
    #[getter]
    fn node(&self) -> usize {
        self.0.node
    }

    /// `SectionRows` of the axial force, N; tension is positive.
    #[getter]
    fn axial(&self) -> PySectionRows {
        self.0.axial.clone().into()
    }

    /// Two `SectionRows` of the shear forces along y and z, N; the second is zero in the plane.
    #[getter]
    fn shears(&self) -> [PySectionRows; 2] {
        self.0.shears.clone().map(PySectionRows::from)
    }

    /// `SectionRows` of the torque about x, N·m; zero in the plane.
    #[getter]
    fn torque(&self) -> PySectionRows {
        self.0.torque.clone().into()
    }

    /// Two `SectionRows` of the moments about y and z by the right-hand rule, N·m; the first is zero in the plane. Positive
    /// with tension at positive z, and at negative y.
    #[getter]
    fn moments(&self) -> [PySectionRows; 2] {
        self.0.moments.clone().map(PySectionRows::from)
    }
}

#[pymethods]
impl PyFemModel {
    /// The `BeamRows` of the beam with the number ``element``: forces and moments at its ends, in its own axes.
    fn beam_rows(&self, element: Count) -> PyResult<PyBeamRows> {
        self.0.beam_rows(element.0).or_raise().map(PyBeamRows)
    }
}
