//! A foundation, and forces on a face of a structure in the ground, at the end of a step.

use basemat::coupled::{FaceForces, Foundation};
use pyo3::prelude::*;

/// A foundation at the end of a step; forces act from the structure on the soil, per metre
/// of thickness in the plane, of the whole body in plan (N and N·m).
#[pyclass(name = "FoundationState", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyFoundation(pub(super) Foundation);

#[pymethods]
impl PyFoundation {
    /// Number of the first element, and one more than the number of the last element.
    #[getter]
    fn elements(&self) -> (usize, usize) {
        (self.0.elements.start, self.0.elements.end)
    }

    /// Horizontal force on the soil, positive to the right, N/m.
    #[getter]
    fn shear(&self) -> f64 {
        self.0.base_shear
    }

    /// Moment on the soil about its middle, counter-clockwise, N·m/m; in plan about y by the right-hand rule, N·m.
    #[getter]
    fn moment(&self) -> f64 {
        self.0.base_moment
    }

    /// Total pressure, N/m.
    #[getter]
    fn normal_force(&self) -> f64 {
        self.0.normal_force
    }

    /// Ratio of the open length to the length of the foundation, in plan of the open area to the area.
    #[getter]
    fn uplifted_fraction(&self) -> f64 {
        self.0.uplifted_fraction
    }

    /// Slip averaged over the foundation, m.
    #[getter]
    fn mean_slip(&self) -> f64 {
        self.0.mean_slip
    }

    /// Rotation of the foundation's chord, counter-clockwise, rad; in plan about y by the right-hand rule.
    #[getter]
    fn rotation(&self) -> f64 {
        self.0.base_rotation
    }

    /// Settlement of its centre since the static state, positive downwards, m.
    #[getter]
    fn settlement(&self) -> f64 {
        self.0.settlement
    }

    /// Work of its moment on the soil since the start, ∫M dθ, J/m; in plan about y, J.
    #[getter]
    fn rocking_work(&self) -> f64 {
        self.0.rocking_work
    }

    /// In plan: force on the soil along y, positive away, N.
    #[getter]
    fn shear_across(&self) -> f64 {
        self.0.shear_across
    }

    /// In plan: moment on the soil about x, N·m.
    #[getter]
    fn moment_across(&self) -> f64 {
        self.0.moment_across
    }

    /// In plan: moment on the soil about the vertical axis, counter-clockwise from above, N·m.
    #[getter]
    fn torque(&self) -> f64 {
        self.0.torque
    }

    /// In plan: slip along y averaged over the foundation, m.
    #[getter]
    fn mean_slip_across(&self) -> f64 {
        self.0.mean_slip_across
    }

    /// In plan: rotation about x, rad.
    #[getter]
    fn rotation_across(&self) -> f64 {
        self.0.rotation_across
    }

    /// In plan: work of the moment about x on the soil since the start, J.
    #[getter]
    fn rocking_work_across(&self) -> f64 {
        self.0.rocking_work_across
    }

    /// In plan: rotation about the vertical axis, counter-clockwise from above, rad.
    #[getter]
    fn twist(&self) -> f64 {
        self.0.twist
    }

    /// Force on the soil as a vector, N/m; in plan along x, y and up, N. In the plane axes point to the right, up and towards the reader.
    #[getter]
    fn force_vector(&self) -> [f64; 3] {
        self.0.force_vector()
    }

    /// Moment on the soil about its middle as a vector by the right-hand rule, N·m/m, in plan N·m.
    #[getter]
    fn moment_vector(&self) -> [f64; 3] {
        self.0.moment_vector()
    }

    /// Rotation as a vector by the right-hand rule, rad.
    #[getter]
    fn rotation_vector(&self) -> [f64; 3] {
        self.0.rotation_vector()
    }
}

/// Forces on the soil at one face of a structure in the ground.
///
/// They are per metre of thickness. `State.face` returns them.
#[pyclass(name = "FaceForces", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyFaceForces(pub(super) FaceForces);

#[pymethods]
impl PyFaceForces {
    /// Total pressure, positive in compression, N/m.
    #[getter]
    fn thrust(&self) -> f64 {
        self.0.thrust
    }

    /// Force on the soil along the outline, N/m: positive down the left wall, to the right along the base, up the right wall.
    #[getter]
    fn shear(&self) -> f64 {
        self.0.shear
    }

    /// Position of the thrust, m: on a wall its height above the base, on the base its distance to the right of the
    /// middle. NaN without thrust.
    #[getter]
    fn place(&self) -> f64 {
        self.0.place
    }

    /// Ratio of the length of open elements to the length of the face.
    #[getter]
    fn open_fraction(&self) -> f64 {
        self.0.open_fraction
    }
}
