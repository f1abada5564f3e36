//! The state at the end of a step, steps as an iterator, and checkpoints that pickle.

use basemat::coupled::{Checkpoint, State};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use super::{PyFaceForces, PyFoundation};
use crate::array::{Array, Count};
use crate::error::{OrRaise, input_error};
use crate::names::{TRENCH_FACES, choice, mode_name};
use crate::results::PyEnergyBalance;

/// The simulation at the end of an accepted step.
///
/// Displacements are changes against the static state, relative to the translation of the free field unless stated
/// otherwise. Forces act from the structure on the soil, per metre of thickness in the plane, of the whole body in plan
/// (N and N·m). A state belongs to its simulation and cannot be pickled; a `Checkpoint` can.
#[pyclass(name = "State", module = "basemat", frozen)]
pub(crate) struct PyState(pub(super) State);

#[pymethods]
impl PyState {
    /// Number of steps made.
    #[getter]
    fn step(&self) -> usize {
        self.0.step
    }

    /// Time, s.
    #[getter]
    fn time(&self) -> f64 {
        self.0.time
    }

    /// Gap of each element: array of shape (elements,), m.
    #[getter]
    fn gap(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.gap).collect()
    }

    /// Slip of each element: array of shape (elements,), m.
    #[getter]
    fn slip(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.slip).collect()
    }

    /// Pressure on each element: array of shape (elements,), Pa.
    #[getter]
    fn pressure(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.pressure).collect()
    }

    /// Shear traction on each element: array of shape (elements,), Pa.
    #[getter]
    fn shear(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.shear).collect()
    }

    /// In plan: slip of each element along y: array of shape (elements,), m; 0 in the plane.
    #[getter]
    fn slip_across(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.slip_across).collect()
    }

    /// In plan: shear traction on each element along y: array of shape (elements,), Pa; 0 in the plane.
    #[getter]
    fn shear_across(&self) -> Array {
        self.0.contact.iter().map(|contact| contact.shear_across).collect()
    }

    /// Values of the probes: array of shape (probes,), in their order.
    #[getter]
    fn probes(&self) -> Array {
        self.0.probes.as_slice().into()
    }

    /// Horizontal force on the soil, positive to the right, N/m.
    #[getter]
    fn base_shear(&self) -> f64 {
        self.0.base_shear
    }

    /// Moment on the soil, counter-clockwise, N·m/m; in plan about y by the right-hand rule, N·m.
    #[getter]
    fn base_moment(&self) -> f64 {
        self.0.base_moment
    }

    /// Total pressure on the soil, N/m.
    #[getter]
    fn normal_force(&self) -> f64 {
        self.0.normal_force
    }

    /// Ratio of the length of open elements to the length of the base, in plan of their area to the area.
    #[getter]
    fn uplifted_fraction(&self) -> f64 {
        self.0.uplifted_fraction
    }

    /// Slip averaged over the base, m.
    #[getter]
    fn mean_slip(&self) -> f64 {
        self.0.mean_slip
    }

    /// Largest |slip| of any element, m.
    #[getter]
    fn largest_slip(&self) -> f64 {
        self.0.value(basemat::results::Quantity::LargestSlip)
    }

    /// Rotation of the base, counter-clockwise, rad; in plan about y by the right-hand rule.
    #[getter]
    fn base_rotation(&self) -> f64 {
        self.0.base_rotation
    }

    /// Force on the soil as a vector, N/m; in plan along x, y and up, N. In the plane axes point to the right, up and towards the reader.
    #[getter]
    fn force_vector(&self) -> [f64; 3] {
        self.0.force_vector()
    }

    /// Moment on the soil as a vector by the right-hand rule, N·m/m, in plan N·m.
    #[getter]
    fn moment_vector(&self) -> [f64; 3] {
        self.0.moment_vector()
    }

    /// Rotation of the base as a vector by the right-hand rule, rad.
    #[getter]
    fn rotation_vector(&self) -> [f64; 3] {
        self.0.rotation_vector()
    }

    /// Mean displacement (to the right, up) of the free field under the base, m.
    #[getter]
    fn free_field(&self) -> [f64; 2] {
        self.0.free_field
    }

    /// The `EnergyBalance` since the start.
    #[getter]
    fn energy_balance(&self) -> PyEnergyBalance {
        PyEnergyBalance(self.0.energy_balance)
    }

    /// Number of trials of the search for contact modes: linear solutions, sweeps and iterations of Newton's method.
    #[getter]
    fn trials(&self) -> usize {
        self.0.trials
    }

    /// Displacement of the degrees of freedom relative to the free field: array of shape (n,), m and rad.
    #[getter]
    fn displacement(&self) -> Array {
        self.0.displacement().into()
    }

    /// Displacement of the degrees of freedom including the translation of the free field: array of shape (n,), m and
    /// rad.
    #[getter]
    fn absolute_displacement(&self) -> Array {
        self.0.absolute_displacement().into()
    }

    /// Total velocity of the degrees of freedom: array of shape (n,), m/s and rad/s.
    #[getter]
    fn velocity(&self) -> Array {
        self.0.velocity().into()
    }

    /// Total acceleration of the degrees of freedom: array of shape (n,), m/s² and rad/s².
    #[getter]
    fn acceleration(&self) -> Array {
        self.0.acceleration().into()
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

    /// Each foundation separately: list of `FoundationState`, from left to right.
    #[getter]
    fn foundations(&self) -> Vec<PyFoundation> {
        self.0.foundations.iter().cloned().map(PyFoundation).collect()
    }

    /// Search method of the modes in this step: "active_set", "gauss_seidel", "path", and in plan "newton" or
    /// "proximal".
    #[getter]
    fn method(&self) -> String {
        self.0.method.to_string()
    }

    /// Value of a ``quantity`` at the end of the step, in its unit: the name of a scalar time series, such as "base_shear", in plan
    /// also "torque" or "uplifted_area".
    fn value(&self, quantity: &str) -> PyResult<f64> {
        Ok(self.0.value(quantity.parse().or_raise()?))
    }

    /// The `FaceForces` on a ``face`` of a structure in the ground: "left_wall", "base" or "right_wall"; zeros for a wall of
    /// a base without walls.
    fn face(&self, face: &str) -> PyResult<PyFaceForces> {
        Ok(PyFaceForces(self.0.face(choice("face", face, &TRENCH_FACES)?)))
    }

    /// State variables of the law of an ``element`` (0: the leftmost): list of numbers, empty if the law has none.
    /// Elements of joints follow those of the ground, joint by joint.
    fn state_variables(&self, element: Count) -> PyResult<Vec<f64>> {
        let Count(element) = element;
        let joint_elements = self.0.joints.iter().map(|joint| joint.contact.len());
        let element_count = self.0.contact.len() + joint_elements.sum::<usize>();
        if element >= element_count {
            return Err(input_error(format!(
                "element is {element}, but must be below {element_count}"
            )));
        }
        Ok(self.0.state_variables(element).to_vec())
    }

    fn __repr__(&self) -> String {
        format!("State(step {}, {} s)", self.0.step, self.0.time)
    }
}

/// Iterator over steps, which yields the `State` at the end of each.
///
/// ``len()`` is the number of remaining steps. `Simulation.steps` creates it.
#[pyclass(name = "Steps", module = "basemat")]
pub(crate) struct PySteps {
    /// Simulation, which has a method `step`.
    pub(super) simulation: Py<PyAny>,
    pub(super) remaining_steps: usize,
}

#[pymethods]
impl PySteps {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&mut self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        if self.remaining_steps == 0 {
            return Ok(None);
        }
        py.check_signals()?;
        let state = self.simulation.call_method0(py, "step")?;
        self.remaining_steps -= 1;
        Ok(Some(state))
    }

    fn __len__(&self) -> usize {
        self.remaining_steps
    }
}

/// State of a run between two steps: `Simulation.checkpoint` creates it, `Simulation.resume` continues from it with the
/// same bits. It pickles. ``data``: the bytes that `to_bytes` returned.
#[pyclass(name = "Checkpoint", module = "basemat", frozen, eq)]
#[derive(PartialEq)]
pub(crate) struct PyCheckpoint(pub(super) Checkpoint);

#[pymethods]
impl PyCheckpoint {
    #[new]
    fn new(data: &[u8]) -> PyResult<Self> {
        let decoded = postcard::from_bytes(data);
        Ok(Self(
            decoded.map_err(|error| {
                input_error(format!("these bytes are not a checkpoint: {error}"))
            })?,
        ))
    }

    /// Steps made before the checkpoint.
    #[getter]
    fn steps(&self) -> usize {
        self.0.steps()
    }

    /// The checkpoint as bytes, for a file.
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let encoded = postcard::to_allocvec(&self.0);
        let bytes = encoded.map_err(|error| input_error(format!("checkpoint: {error}")))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn __getnewargs__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyBytes>,)> {
        Ok((self.to_bytes(py)?,))
    }

    fn __repr__(&self) -> String {
        format!("Checkpoint(after {} steps)", self.0.steps())
    }
}
