//! A scene on its ground and on a fixed base.

use basemat::coupled::{Interaction, SystemMode};
use basemat::results::Quantity;
use pyo3::prelude::*;

use super::PyRun;
use crate::array::Named;
use crate::error::OrRaise;
use crate::html::preformatted;

/// Vibration mode of a structure on a fixed base and on its ground (ASCE 7, chapter 19).
#[pyclass(name = "SystemMode", module = "basemat", frozen, eq)]
#[derive(Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PySystemMode(SystemMode);

members! {
    PySystemMode, own;
    /// Axis along which the mode moves the most mass, "x" or "y" in plan; None in the plane.
    axis: Option<char> = own.0.axis;
    /// Period T on a fixed base, s.
    fixed_period: f64 = own.0.fixed_period;
    /// Damping ratio β on a fixed base.
    fixed_damping: f64 = own.0.fixed_damping;
    /// Period T̃ of the soil–structure system, s.
    period: f64 = own.0.period;
    /// Damping ratio β₀ of the soil–structure system.
    damping: f64 = own.0.damping;
    /// Period lengthening T̃/T, a ratio.
    period_ratio: f64 = own.0.period_ratio();
    /// Foundation damping ratio β_f = β₀ − β/(T̃/T)²: radiation and the damping of the soil.
    foundation_damping: f64 = own.0.foundation_damping();
}

#[pymethods]
impl PySystemMode {
    fn __repr__(&self) -> String {
        let SystemMode { fixed_period, period, fixed_damping, damping, .. } = self.0;
        format!(
            "SystemMode(period={period:?}, damping={damping:?}, fixed_period={fixed_period:?}, \
             fixed_damping={fixed_damping:?})"
        )
    }
}

/// A scene on its ground and on a fixed base: what :meth:`Simulation.interaction` returns. Printed, it is a table for a
/// report.
#[pyclass(name = "Interaction", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyInteraction {
    pub(crate) found: Interaction,
    pub(crate) names: Option<Vec<String>>,
}

members! {
    PyInteraction, own;
    /// The :class:`Run` on the ground, without time series.
    on_ground: PyRun = PyRun::new(own.found.on_ground.clone(), None, own.names.clone());
    /// The :class:`Run` on the fixed base, without time series.
    on_fixed_base: PyRun = PyRun::new(own.found.on_fixed_base.clone(), None, own.names.clone());
    /// The mode with the most mass along x, in plan also that along y: list of :class:`SystemMode`; empty for a structure
    /// that is rigid.
    modes: Vec<PySystemMode> = own.found.modes.iter().copied().map(PySystemMode).collect();
    /// Largest magnitudes of the probes on the ground over those on the fixed base: dict of numbers by their names.
    probe_ratios: PyResult<Named<String, f64>> = {
        let names = own.found.on_ground.probes.iter().map(|probe| probe.name.clone());
        names.map(|name| Ok((name.clone(), own.found.probe_ratio(&name).or_raise()?))).collect()
    };
}

#[pymethods]
impl PyInteraction {
    /// Ratio of the largest magnitudes of the scalar ``name``, such as "base_shear", on the ground and on the fixed base;
    /// NaN where both are zero.
    fn ratio(&self, name: &str) -> PyResult<f64> {
        Ok(self.found.ratio(name.parse::<Quantity>().or_raise()?))
    }

    fn _repr_html_(&self) -> String {
        preformatted(&self.found.to_string())
    }

    fn __str__(&self) -> String {
        self.found.to_string()
    }
}
