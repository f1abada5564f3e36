//! Elastic soil, the strength of drained soil, and water in it.

use basemat::Soil;
use basemat::soil::{SoilStrength, WaterTable};
use pyo3::prelude::*;

use crate::error::OrRaise;

/// Elastic soil, isotropic and homogeneous.
///
/// ``shear_modulus`` G = ρ c² (Pa), Poisson's ratio ``poisson`` (above −1, below 0.5), ``density`` (kg/m³). A run warns
/// if the speed of shear waves is outside 10 to 5 000 m/s or the density outside 500 to 10 000 kg/m³: a usual cause is
/// a wrong unit.
#[pyclass(name = "Soil", module = "basemat", frozen, eq)]
#[derive(Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PySoil(pub(crate) Soil);

#[pymethods]
impl PySoil {
    #[new]
    fn new(shear_modulus: f64, poisson: f64, density: f64) -> PyResult<Self> {
        Ok(Self(Soil::new(shear_modulus, poisson, density).or_raise()?))
    }

    /// Soil from the ``speed`` of its shear waves (m/s), Poisson's ratio ``poisson`` and ``density``
    /// (kg/m³).
    #[staticmethod]
    fn from_shear_wave_speed(speed: f64, poisson: f64, density: f64) -> PyResult<Self> {
        Soil::from_shear_wave_speed(speed, poisson, density).or_raise().map(Self)
    }

    /// Soil from the speeds of ``shear`` and ``pressure`` waves (m/s) and its ``density`` (kg/m³).
    #[staticmethod]
    fn from_wave_speeds(shear: f64, pressure: f64, density: f64) -> PyResult<Self> {
        Soil::from_wave_speeds(shear, pressure, density).or_raise().map(Self)
    }

    /// Shear modulus, Pa.
    #[getter]
    fn shear_modulus(&self) -> f64 {
        self.0.shear_modulus()
    }

    /// Poisson's ratio, a number.
    #[getter]
    fn poisson(&self) -> f64 {
        self.0.poisson()
    }

    /// Density, kg/m³.
    #[getter]
    fn density(&self) -> f64 {
        self.0.density()
    }

    /// Speed of shear waves, m/s.
    #[getter]
    fn shear_wave_speed(&self) -> f64 {
        self.0.shear_wave_speed()
    }

    /// Speed of pressure waves, m/s.
    #[getter]
    fn pressure_wave_speed(&self) -> f64 {
        self.0.pressure_wave_speed()
    }

    fn __repr__(&self) -> String {
        let Self(soil) = self;
        format!(
            "Soil(shear_modulus={:?}, poisson={:?}, density={:?})",
            soil.shear_modulus(),
            soil.poisson(),
            soil.density()
        )
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        (self.shear_modulus(), self.poisson(), self.density()).into_pyobject(py)?.hash()
    }
}

/// Strength of drained soil, for `ShallowFooting` and `TrenchGround.interfaces`.
///
/// It has the ``friction_angle`` (rad), its ``cohesion`` (Pa; 0 by default), and the ``wall_friction_angle`` between
/// soil and wall (rad; 0 by default), at most the friction angle.
///
/// Stresses are effective stresses. Plane wedges overestimate the passive pressure if the wall friction angle is a
/// third of the soil's friction angle or more.
#[pyclass(name = "SoilStrength", module = "basemat", frozen, dict, eq)]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct PySoilStrength(pub(crate) SoilStrength);

#[pymethods]
impl PySoilStrength {
    #[pyo3(signature = (friction_angle, *, cohesion=0.0, wall_friction_angle=0.0))]
    #[new]
    fn new(friction_angle: f64, cohesion: f64, wall_friction_angle: f64) -> PyResult<Self> {
        let strength = SoilStrength::new(friction_angle)
            .and_then(|strength| strength.with_cohesion(cohesion))
            .and_then(|strength| strength.with_wall_friction(wall_friction_angle));
        strength.or_raise().map(Self)
    }

    /// Active and passive ratio of the horizontal to the vertical pressure, without cohesion (Coulomb; without wall
    /// friction Rankine).
    #[getter]
    fn pressure_ratios(&self) -> [f64; 2] {
        self.0.pressure_ratios()
    }

    /// Active and passive pressure on a wall under a ``vertical`` pressure of the soil, all Pa.
    fn pressures(&self, vertical: f64) -> [f64; 2] {
        self.0.pressures(vertical)
    }
}

/// Water table: the level below which water at rest presses on a structure.
///
/// It lies ``depth`` below the surface of the ground, m; negative for water above a base on the surface, which lies below the
/// water table in reality. ``density``: of the water, kg/m³; 1000 by default.
///
/// The pressure ρ g (z − depth) at the depth z acts up on a base and inwards on walls, also on elements that are open.
/// Tractions, factors of safety and friction are then effective. Shaking and gaps do not change the pressure. For a
/// base on the surface it is given to `InitialConditions`, in a trench to `TrenchGround`.
#[pyclass(name = "WaterTable", module = "basemat", frozen, dict, eq)]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct PyWaterTable(pub(crate) WaterTable);

#[pymethods]
impl PyWaterTable {
    #[new]
    #[pyo3(signature = (depth, *, density=1000.0))]
    fn new(depth: f64, density: f64) -> PyResult<Self> {
        let water = WaterTable::at_depth(depth).and_then(|water| water.with_density(density));
        water.or_raise().map(Self)
    }
}
