//! Probes.

use basemat::coupled::Probe;
use pyo3::prelude::*;

use crate::row::{Order, PyDofCombination, PySectionRows, RowLike};

/// A quantity recorded at every step: a weighted sum of displacements, velocities or accelerations.
///
/// ``name``: that of its time series. ``row``: a :class:`DofCombination` or what makes one. ``unit``:
/// its label in tables; that of the quantity unless given.
///
/// Displacements are changes against the static state, relative to the translation of the free
/// field; :meth:`absolute_displacement` includes it. Velocities and accelerations are total. No two
/// probes of a simulation have the same name, and none that of another time series of a run.
#[pyclass(name = "Probe", module = "basemat", frozen, dict)]
pub(crate) struct PyProbe(pub(crate) Probe, pub(crate) Order);

impl PyProbe {
    fn labelled(probe: Probe, order: Order, unit: Option<String>) -> Self {
        let probe = match unit {
            Some(unit) => probe.in_unit(unit),
            None => probe,
        };
        Self(probe, order)
    }
}

getters! {
    PyProbe, own;
    /// Its name, that of its time series.
    name: &str = &own.0.name;
    /// Label of its unit; values are what the weights make of SI units.
    unit: &str = &own.0.unit;
}

#[pymethods]
impl PyProbe {
    /// Displacement (m, or rad of a rotation) of the ``row`` relative to the free field, as the time
    /// series ``name``; ``unit``: its label, "m" unless given.
    #[staticmethod]
    #[pyo3(signature = (name, row, *, unit=None))]
    fn displacement(name: String, row: RowLike, unit: Option<String>) -> Self {
        Self::labelled(Probe::displacement(name, row.0), row.1, unit)
    }

    /// Displacement (m) of the ``row`` with the translation of the free field, as the time series
    /// ``name``; ``unit``: its label, "m" unless given.
    #[staticmethod]
    #[pyo3(signature = (name, row, *, unit=None))]
    fn absolute_displacement(name: String, row: RowLike, unit: Option<String>) -> Self {
        Self::labelled(Probe::absolute_displacement(name, row.0), row.1, unit)
    }

    /// Total velocity of the ``row``, m/s, as the time series ``name``; ``unit``: its label, "m/s" unless
    /// given.
    #[staticmethod]
    #[pyo3(signature = (name, row, *, unit=None))]
    fn velocity(name: String, row: RowLike, unit: Option<String>) -> Self {
        Self::labelled(Probe::velocity(name, row.0), row.1, unit)
    }

    /// Total acceleration of the ``row``, m/s², as the time series ``name``; ``unit``: its label, "m/s²"
    /// unless given.
    #[staticmethod]
    #[pyo3(signature = (name, row, *, unit=None))]
    fn acceleration(name: String, row: RowLike, unit: Option<String>) -> Self {
        Self::labelled(Probe::acceleration(name, row.0), row.1, unit)
    }

    /// Resultant of a ``section`` (:class:`SectionRows`), a force (N/m) or a moment (N·m/m), as the time
    /// series ``name``; ``unit``: its label, that of the section unless given.
    #[staticmethod]
    #[pyo3(signature = (name, section, *, unit=None))]
    fn section(name: String, section: &PySectionRows, unit: Option<String>) -> Self {
        Self::labelled(Probe::section(name, &section.0), section.1, unit)
    }

    /// The :class:`DofCombination` of displacements, that of velocities and that of accelerations.
    #[getter]
    fn rows(&self) -> [PyDofCombination; 3] {
        [&self.0.displacement, &self.0.velocity, &self.0.acceleration]
            .map(|row| PyDofCombination(row.clone(), self.1))
    }

    fn __repr__(&self) -> String {
        format!("Probe({:?}, unit {:?})", self.0.name, self.0.unit)
    }
}
