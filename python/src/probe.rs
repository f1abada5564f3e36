//! Probes: quantities that a run records at every step.

use basemat::coupled::Probe;
use pyo3::prelude::*;

use crate::row::{PyDofCombination, PySectionRows, RowLike, WeightCount};

/// A quantity recorded at every step: a weighted sum of displacements, velocities or accelerations.
///
/// ``name``: name of its time series. ``row``: a `DofCombination` or its ``terms``. ``unit``: its label in tables;
/// unless given, the unit of the quantity.
///
/// Displacements are changes against the static state, relative to the translation of the free field;
/// `absolute_displacement` includes it. Velocities and accelerations are total. The names of the probes of a simulation
/// differ from each other and from the names of other time series of a run.
#[pyclass(name = "Probe", module = "basemat", frozen, dict)]
pub(crate) struct PyProbe(pub(crate) Probe, pub(crate) WeightCount);

/// A probe with the label of its unit, if there is one.
fn with_unit(probe: Probe, weight_count: WeightCount, unit: Option<String>) -> PyProbe {
    let probe = match unit {
        Some(unit) => probe.in_unit(unit),
        None => probe,
    };
    PyProbe(probe, weight_count)
}

#[pymethods]
impl PyProbe {
    /// Displacement (m, or rad of a rotation) of the ``row`` relative to the free field, as the time
    /// series ``name``; ``unit``: its label, "m" unless given.
    #[pyo3(signature = (name, row, *, unit=None))]
    #[staticmethod]
    fn displacement(name: String, row: RowLike, unit: Option<String>) -> Self {
        with_unit(Probe::displacement(name, row.0), row.1, unit)
    }

    /// Displacement (m) of the ``row`` including the translation of the free field, as the time series ``name``;
    /// ``unit``: its label, "m" unless given.
    #[pyo3(signature = (name, row, *, unit=None))]
    #[staticmethod]
    fn absolute_displacement(name: String, row: RowLike, unit: Option<String>) -> Self {
        with_unit(Probe::absolute_displacement(name, row.0), row.1, unit)
    }

    /// Total velocity of the ``row``, m/s, as the time series ``name``; ``unit``: its label, "m/s" unless
    /// given.
    #[pyo3(signature = (name, row, *, unit=None))]
    #[staticmethod]
    fn velocity(name: String, row: RowLike, unit: Option<String>) -> Self {
        with_unit(Probe::velocity(name, row.0), row.1, unit)
    }

    /// Total acceleration of the ``row``, m/s², as the time series ``name``; ``unit``: its label, "m/s²"
    /// unless given.
    #[pyo3(signature = (name, row, *, unit=None))]
    #[staticmethod]
    fn acceleration(name: String, row: RowLike, unit: Option<String>) -> Self {
        with_unit(Probe::acceleration(name, row.0), row.1, unit)
    }

    /// Resultant of a ``section`` (`SectionRows`), a force (N/m, in plan N) or a moment (N·m/m, in plan N·m), as the
    /// time series ``name``; ``unit``: its label; unless given, the section's.
    #[pyo3(signature = (name, section, *, unit=None))]
    #[staticmethod]
    fn section(name: String, section: &PySectionRows, unit: Option<String>) -> Self {
        with_unit(Probe::section(name, &section.0), section.1, unit)
    }

    /// Name of the probe and of its time series.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Label of its unit. It converts nothing: values are sums of SI values times the weights.
    #[getter]
    fn unit(&self) -> &str {
        &self.0.unit
    }

    /// Three `DofCombination`: of displacements, of velocities and of accelerations.
    #[getter]
    fn rows(&self) -> [PyDofCombination; 3] {
        let Probe { displacement, velocity, acceleration, .. } = &self.0;
        [displacement, velocity, acceleration].map(|row| PyDofCombination(row.clone(), self.1))
    }
}
