//! Weight of a run's structure, and buoyancy.

use pyo3::prelude::*;

use super::PyRun;

#[pymethods]
impl PyRun {
    /// Upward force of the water on the structure, N/m (in plan N): `WaterTable`. The weight is the effective
    /// ``static_normal_force`` plus this force.
    #[getter]
    fn buoyancy(&self) -> f64 {
        self.run.buoyancy
    }

    /// Ratio of the largest base shear to the weight; None if the structure has no weight.
    #[getter]
    fn shear_coefficient(&self) -> Option<f64> {
        self.run.shear_coefficient()
    }
}
