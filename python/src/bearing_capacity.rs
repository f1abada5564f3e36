//! The bearing capacity of shallow foundations.

use basemat::soil::{BearingFactors, FootingLoad, ShallowFooting};
use pyo3::prelude::*;

use crate::error::OrRaise;
use crate::soil::PySoilStrength;

/// Bearing capacity factors of drained soil under a rough strip.
///
/// ``friction_angle`` of the soil: rad. Source: EN 1997-1:2004, D.4.
#[pyclass(name = "BearingFactors", module = "basemat", frozen, dict, eq)]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct PyBearingFactors(BearingFactors);

#[pymethods]
impl PyBearingFactors {
    #[new]
    fn new(friction_angle: f64) -> PyResult<Self> {
        BearingFactors::new(friction_angle).or_raise().map(Self)
    }

    /// Factor N_c of the cohesion, a number; π + 2 without friction.
    #[getter]
    fn cohesion(&self) -> f64 {
        self.0.cohesion
    }

    /// Factor N_q of the pressure of the soil beside the base, a number.
    #[getter]
    fn surcharge(&self) -> f64 {
        self.0.surcharge
    }

    /// Factor N_γ of the unit weight of the soil below the base, a number.
    #[getter]
    fn unit_weight(&self) -> f64 {
        self.0.unit_weight
    }
}

/// Rectangular shallow footing, or a `circle`, for its bearing capacity.
///
/// The capacity follows EN 1997-1:2004, Annex D, without partial factors.
///
/// ``sides`` along x and y (m); with ``math.inf`` along y it is a strip, whose forces are per metre. ``surcharge``: vertical
/// pressure of the soil beside the base at its level (Pa; 0 by default), unit weight times depth. ``eccentricity`` of the
/// load along x and y (m; (0, 0) by default). ``vertical_force`` and ``horizontal_force`` (along x and y) of a load whose
/// inclination reduces the capacity (N; 0 by default). ``base_tilt`` of the base against the horizontal (rad; 0 by default).
///
/// The result of `drained_pressure` is the ``bearing_pressure`` for `Yielding` and `CyclicYielding`.
#[pyclass(name = "ShallowFooting", module = "basemat", frozen, dict, eq)]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct PyShallowFooting(ShallowFooting);

#[pymethods]
impl PyShallowFooting {
    #[pyo3(
        signature = (sides, *, surcharge=0.0, eccentricity=(0.0, 0.0), vertical_force=0.0, horizontal_force=(0.0, 0.0), base_tilt=0.0),
        text_signature = "(sides, *, surcharge=0.0, eccentricity=(0.0, 0.0), vertical_force=0.0, horizontal_force=(0.0, 0.0), base_tilt=0.0)"
    )]
    #[new]
    fn new(
        sides: [f64; 2],
        surcharge: f64,
        eccentricity: (f64, f64),
        vertical_force: f64,
        horizontal_force: (f64, f64),
        base_tilt: f64,
    ) -> PyResult<Self> {
        let footing = if sides[1] == f64::INFINITY {
            ShallowFooting::strip(sides[0])
        } else {
            ShallowFooting::rectangle(sides)
        };
        let load = FootingLoad { vertical: vertical_force, horizontal: horizontal_force.into() };
        footing
            .and_then(|footing| footing.with_surcharge(surcharge))
            .and_then(|footing| footing.with_eccentricity(eccentricity.into()))
            .and_then(|footing| footing.with_load(load))
            .and_then(|footing| footing.with_base_tilt(base_tilt))
            .or_raise()
            .map(Self)
    }

    /// Circular footing of a ``diameter`` (m), loaded in its middle. ``surcharge``, ``vertical_force``,
    /// ``horizontal_force`` and ``base_tilt`` are as in the constructor.
    #[pyo3(
        signature = (diameter, *, surcharge=0.0, vertical_force=0.0, horizontal_force=(0.0, 0.0), base_tilt=0.0),
        text_signature = "(diameter, *, surcharge=0.0, vertical_force=0.0, horizontal_force=(0.0, 0.0), base_tilt=0.0)"
    )]
    #[staticmethod]
    fn circle(
        diameter: f64,
        surcharge: f64,
        vertical_force: f64,
        horizontal_force: (f64, f64),
        base_tilt: f64,
    ) -> PyResult<Self> {
        let load = FootingLoad { vertical: vertical_force, horizontal: horizontal_force.into() };
        ShallowFooting::circle(diameter)
            .and_then(|footing| footing.with_surcharge(surcharge))
            .and_then(|footing| footing.with_load(load))
            .and_then(|footing| footing.with_base_tilt(base_tilt))
            .or_raise()
            .map(Self)
    }

    /// Effective sides along x and y, m.
    #[getter]
    fn effective_sides(&self) -> [f64; 2] {
        self.0.effective_sides()
    }

    /// Effective area, m²; of a strip its effective width, m²/m.
    #[getter]
    fn effective_area(&self) -> f64 {
        self.0.effective_area()
    }

    /// Bearing pressure (Pa) of drained soil of a ``strength`` (`SoilStrength`) on the effective area. ``unit_weight`` of the
    /// soil below the base, N/m³.
    fn drained_pressure(&self, strength: &PySoilStrength, unit_weight: f64) -> PyResult<f64> {
        self.0.drained_pressure(&strength.0, unit_weight).or_raise()
    }

    /// Increase of the drained bearing pressure with the settlement of the base (Pa/m), for a ``strength`` and
    /// ``unit_weight`` as in `drained_pressure`: the product of N_q, the unit weight and the factors of shape,
    /// inclination and tilt.
    fn pressure_growth(&self, strength: &PySoilStrength, unit_weight: f64) -> PyResult<f64> {
        self.0.pressure_growth(&strength.0, unit_weight).or_raise()
    }

    /// Bearing pressure (Pa) of undrained soil of an ``undrained_strength`` (Pa) on the effective area.
    fn undrained_pressure(&self, undrained_strength: f64) -> PyResult<f64> {
        self.0.undrained_pressure(undrained_strength).or_raise()
    }

    /// Ratio of the critical contact area to the area of the base, and the moments (N·m) at which the footing rocks
    /// along x and along y, under a ``vertical_force`` (N) on soil of a ``bearing_pressure`` (Pa). The moment of a
    /// rectangle is V L/2 (1 − A_c/A) (Gajan and Kutter 2008).
    fn rocking_capacity(
        &self,
        vertical_force: f64,
        bearing_pressure: f64,
    ) -> PyResult<(f64, [f64; 2])> {
        let capacity = self.0.rocking_capacity(vertical_force, bearing_pressure).or_raise()?;
        Ok((capacity.contact_ratio, capacity.moments))
    }
}
