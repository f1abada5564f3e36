//! Shear buildings.

use basemat::structure::{ShearBuilding, Storey};
use pyo3::prelude::*;

use super::PyStructure;
use crate::array::whole;
use crate::error::OrRaise;
use crate::row::{PyRow, PySectionRows};

/// A storey of a :class:`ShearBuilding`, per metre of thickness: ``height`` of its columns (m),
/// ``mass`` of the floor above (kg), sway ``stiffness`` (N/m), ``rotary_inertia`` of the floor
/// (kg m²), ``damping`` by a dashpot between the floors (N s/m).
#[pyclass(name = "Storey", module = "basemat", frozen, dict)]
#[derive(Clone, Copy)]
pub(crate) struct PyStorey(pub(crate) Storey);

#[pymethods]
impl PyStorey {
    #[new]
    #[pyo3(signature = (height, mass, stiffness, *, rotary_inertia=0.0, damping=0.0))]
    fn new(height: f64, mass: f64, stiffness: f64, rotary_inertia: f64, damping: f64) -> Self {
        Self(Storey { height, mass, rotary_inertia, stiffness, damping })
    }

    fn __repr__(&self) -> String {
        let Storey { height, mass, rotary_inertia, stiffness, damping } = self.0;
        format!(
            "Storey({height:?}, {mass:?}, {stiffness:?}, rotary_inertia={rotary_inertia:?}, \
             damping={damping:?})"
        )
    }
}

/// Floors on sway columns on a rigid base.
///
/// Unknowns: displacement to the right, up, and rotation of the base, then the absolute horizontal
/// displacement of every floor from below. ``width`` of the base in m, ``base_mass`` in kg/m,
/// ``base_inertia`` in kg m²/m. ``damping``: ratio in the first mode on a fixed base, by damping
/// proportional to stiffness. ``p_delta``: gravity (m/s²) of the P–Δ effect; none unless given.
#[pyclass(name = "ShearBuilding", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyShearBuilding(pub(crate) ShearBuilding);

#[pymethods]
impl PyShearBuilding {
    #[new]
    #[pyo3(signature = (width, base_mass, base_inertia, storeys, *, damping=None, center=0.0, p_delta=None))]
    fn new(
        width: f64,
        base_mass: f64,
        base_inertia: f64,
        storeys: Vec<Bound<'_, PyStorey>>,
        damping: Option<f64>,
        center: f64,
        p_delta: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let storeys: Vec<Storey> = storeys.iter().map(|storey| storey.get().0).collect();
        let mut building = ShearBuilding::new(width, base_mass, base_inertia, &storeys)
            .and_then(|building| building.centered_at(center))
            .or_raise()?;
        if let Some(ratio) = damping {
            building = building.with_stiffness_damping(ratio).or_raise()?;
        }
        if let Some(gravity) = p_delta {
            building = building.with_p_delta(gravity).or_raise()?;
        }
        let base = PyStructure::copied(building.clone());
        Ok(PyClassInitializer::from(base).add_subclass(Self(building)))
    }

    /// Mass, kg/m.
    #[getter]
    fn total_mass(&self) -> f64 {
        self.0.total_mass()
    }

    /// First natural frequency on a fixed base without P–Δ, Hz.
    #[getter]
    fn fixed_base_frequency(&self) -> f64 {
        self.0.fixed_base_frequency()
    }

    /// Unknown of the topmost floor.
    #[getter]
    fn roof(&self) -> usize {
        self.0.roof()
    }

    /// Unknown of the floor above a storey (0: the lowest).
    fn floor(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<usize> {
        self.0.floor(storey).or_raise()
    }

    /// Drift of a storey: its floors' relative displacement less the turn of the base, m.
    fn drift(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<PyRow> {
        Ok(self.0.drift(storey).or_raise()?.into())
    }

    /// Displacement of a storey's floor less the motion of the base, m.
    fn sway(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<PyRow> {
        Ok(self.0.sway(storey).or_raise()?.into())
    }

    /// Force of what is above a storey's columns on what is below, N/m.
    fn shear(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<PySectionRows> {
        Ok(self.0.shear(storey).or_raise()?.into())
    }
}
