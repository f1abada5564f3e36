//! Joints at the end of a step, and of a simulation.

use basemat::coupled::JointState;
use pyo3::prelude::*;

use super::{PySimulation, PyState};
use crate::array::Array;
use crate::joint::PyJoint;
use crate::names::mode_name;

/// A joint at the end of a step; forces act from the upper side on the lower side, per metre of thickness.
#[pyclass(name = "JointState", module = "basemat", frozen)]
pub(crate) struct PyJointState(JointState);

#[pymethods]
impl PyJointState {
    /// Gap of each element: array of shape (elements,), m.
    #[getter]
    fn gap(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.gap).collect()
    }

    /// Slip of each element, of the upper side in the sense of the joint's nodes: array of shape (elements,), m.
    #[getter]
    fn slip(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.slip).collect()
    }

    /// Pressure on each element: array of shape (elements,), Pa.
    #[getter]
    fn pressure(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.pressure).collect()
    }

    /// Shear traction on each element, on the lower side: array of shape (elements,), Pa.
    #[getter]
    fn shear(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.shear).collect()
    }

    /// Mode of each element: array of shape (elements,) of numbers into `basemat.MODES`.
    #[getter]
    fn modes(&self) -> Array<u8> {
        self.0.modes.iter().map(|mode| *mode as u8).collect()
    }

    /// Changes of mode in this step: list of tuples (element, mode before, mode now).
    #[getter]
    fn transitions(&self) -> Vec<(usize, &'static str, &'static str)> {
        let transitions = self.0.transitions.iter();
        transitions
            .map(|change| (change.element, mode_name(change.from), mode_name(change.to)))
            .collect()
    }

    /// Total pressure, positive in compression, N/m.
    #[getter]
    fn normal_force(&self) -> f64 {
        self.0.normal_force
    }

    /// Force along the joint on the lower side, positive in the sense of the joint's nodes, N/m.
    #[getter]
    fn shear_force(&self) -> f64 {
        self.0.shear_force
    }

    /// Moment of the pressures about the middle of the joint, N·m/m: positive if the pressure is larger before the
    /// middle, in the sense of the nodes.
    #[getter]
    fn moment(&self) -> f64 {
        self.0.moment
    }

    /// Ratio of the length of open elements to the length of the joint.
    #[getter]
    fn open_fraction(&self) -> f64 {
        self.0.open_fraction
    }

    /// Slip averaged over the joint, m.
    #[getter]
    fn mean_slip(&self) -> f64 {
        self.0.mean_slip
    }

    /// Largest gap of an element, m.
    #[getter]
    fn largest_gap(&self) -> f64 {
        self.0.largest_gap
    }

    /// Energy lost by friction and impact since the start, J/m; NaN if the energy balance is omitted.
    #[getter]
    fn contact_energy(&self) -> f64 {
        self.0.contact_energy
    }

    fn __repr__(&self) -> String {
        format!("JointState({} elements, {} open)", self.0.contact.len(), self.0.open_fraction)
    }
}

#[pymethods]
impl PyState {
    /// Each joint separately: list of `JointState`, in the order of ``joints`` of the simulation.
    #[getter]
    fn joints(&self) -> Vec<PyJointState> {
        self.0.joints.iter().cloned().map(PyJointState).collect()
    }
}

#[pymethods]
impl PySimulation {
    /// The argument ``joints``: list of `Joint`.
    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyJoint>> {
        self.parts.joints.iter().map(|joint| joint.bind(py).clone()).collect()
    }
}
