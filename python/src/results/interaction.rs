//! A scene on its ground and on a fixed base.

use basemat::analyses::{Interaction, SystemMode};
use basemat::results::Quantity;
use pyo3::prelude::*;

use super::PyRun;
use crate::array::OrderedDict;
use crate::error::OrRaise;
use crate::names::preformatted;

/// Vibration mode on a fixed base and on the ground (ASCE 7, chapter 19).
#[pyclass(name = "SystemMode", module = "basemat", frozen, eq)]
#[derive(Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PySystemMode(SystemMode);

#[pymethods]
impl PySystemMode {
    /// Axis along which the mode has the largest participating mass, "x" or "y" in plan; None in the plane.
    #[getter]
    fn axis(&self) -> Option<char> {
        self.0.axis
    }

    /// Period T on a fixed base, s.
    #[getter]
    fn fixed_period(&self) -> f64 {
        self.0.fixed_period
    }

    /// Damping ratio β on a fixed base.
    #[getter]
    fn fixed_damping(&self) -> f64 {
        self.0.fixed_damping
    }

    /// Period T̃ of the soil–structure system, s.
    #[getter]
    fn period(&self) -> f64 {
        self.0.period
    }

    /// Damping ratio β₀ of the soil–structure system.
    #[getter]
    fn damping(&self) -> f64 {
        self.0.damping
    }

    /// Period lengthening T̃/T, a ratio.
    #[getter]
    fn period_ratio(&self) -> f64 {
        self.0.period_ratio()
    }

    /// Foundation damping ratio β_f = β₀ − β/(T̃/T)²: radiation and the damping of the soil.
    #[getter]
    fn foundation_damping(&self) -> f64 {
        self.0.foundation_damping()
    }

    fn __repr__(&self) -> String {
        let SystemMode { fixed_period, period, fixed_damping, damping, .. } = self.0;
        format!(
            "SystemMode(period={period:?}, damping={damping:?}, fixed_period={fixed_period:?}, \
             fixed_damping={fixed_damping:?})"
        )
    }
}

/// A scene on its ground and on a fixed base: what `Simulation.interaction` returns. Printed, it is a table for a
/// report.
#[pyclass(name = "Interaction", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyInteraction {
    pub(crate) interaction: Interaction,
    pub(crate) dof_names: Option<Vec<String>>,
}

#[pymethods]
impl PyInteraction {
    /// The `Run` on the ground, without time series.
    #[getter]
    fn on_ground(&self) -> PyRun {
        PyRun::new(self.interaction.on_ground.clone(), None, self.dof_names.clone())
    }

    /// The `Run` on the fixed base, without time series.
    #[getter]
    fn on_fixed_base(&self) -> PyRun {
        PyRun::new(self.interaction.on_fixed_base.clone(), None, self.dof_names.clone())
    }

    /// The mode with the largest participating mass along x, in plan also the mode for y: list of `SystemMode`; empty
    /// for a structure that is rigid.
    #[getter]
    fn modes(&self) -> Vec<PySystemMode> {
        self.interaction.modes.iter().copied().map(PySystemMode).collect()
    }

    /// Ratios of the largest magnitudes of the probes on the ground to those on the fixed base: dict of numbers by the
    /// names of the probes.
    #[getter]
    fn probe_ratios(&self) -> PyResult<OrderedDict<String, f64>> {
        let names = self.interaction.on_ground.probes.iter().map(|probe| probe.name.clone());
        names
            .map(|name| Ok((name.clone(), self.interaction.probe_ratio(&name).or_raise()?)))
            .collect()
    }

    /// Ratio of the largest magnitudes of the scalar ``name``, such as "base_shear", on the ground and on the fixed base;
    /// NaN where both are zero.
    fn ratio(&self, name: &str) -> PyResult<f64> {
        Ok(self.interaction.ratio(name.parse::<Quantity>().or_raise()?))
    }

    fn _repr_html_(&self) -> String {
        preformatted(&self.interaction.to_string())
    }

    fn __str__(&self) -> String {
        self.interaction.to_string()
    }
}
