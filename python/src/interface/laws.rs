//! The core's laws.

use basemat::interface::{Bonded, Cohesive, Coulomb, ThinLayer, UnilateralCondition, Yielding};
use pyo3::prelude::*;

use super::PyInterfaceLaw;
use crate::error::OrRaise;
use crate::soil::PySoil;

/// Base and ground never part.
#[pyclass(name = "Bonded", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyBonded;

#[pymethods]
impl PyBonded {
    #[new]
    fn new() -> PyClassInitializer<Self> {
        PyClassInitializer::from(PyInterfaceLaw::copied(Bonded)).add_subclass(Self)
    }

    #[allow(clippy::unused_self, reason = "a method of Python")]
    fn __repr__(&self) -> &'static str {
        "Bonded()"
    }
}

/// Hard unilateral contact with Coulomb friction: an element sticks, slides or opens.
///
/// ``friction``: coefficient, infinite for a base that opens but never slides.
/// ``tensile_strength`` (Pa) holds an element until it first opens. ``closed_below`` (m): contact
/// conditions act on the change of the gap of elements whose gap is at most that (Moreau's rule),
/// instead of on the gap.
#[pyclass(name = "Coulomb", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyCoulomb(Coulomb);

#[pymethods]
impl PyCoulomb {
    #[new]
    #[pyo3(signature = (friction, *, tensile_strength=0.0, closed_below=None))]
    fn new(
        friction: f64,
        tensile_strength: f64,
        closed_below: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let mut law = Coulomb::new(friction)
            .and_then(|law| law.with_tensile_strength(tensile_strength))
            .or_raise()?;
        if let Some(closed_below) = closed_below {
            law = law
                .with_unilateral_condition(UnilateralCondition::Velocity { closed_below })
                .or_raise()?;
        }
        Ok(PyClassInitializer::from(PyInterfaceLaw::copied(law)).add_subclass(Self(law)))
    }

    /// Friction coefficient.
    #[getter]
    fn friction(&self) -> f64 {
        self.0.friction()
    }

    fn __repr__(&self) -> String {
        format!("Coulomb({:?})", self.0.friction())
    }
}

/// Glue that breaks once, and friction afterwards: ``tension`` and ``cohesion`` are its strengths
/// (Pa), ``friction`` the coefficient when it is broken.
#[pyclass(name = "Cohesive", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyCohesive;

#[pymethods]
impl PyCohesive {
    #[new]
    fn new(tension: f64, cohesion: f64, friction: f64) -> PyResult<PyClassInitializer<Self>> {
        let law = Cohesive::new(tension, cohesion, friction).or_raise()?;
        Ok(PyClassInitializer::from(PyInterfaceLaw::copied(law)).add_subclass(Self))
    }
}

/// Coulomb friction on soil that yields under its ``bearing_pressure`` (Pa).
#[pyclass(name = "Yielding", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyYielding;

#[pymethods]
impl PyYielding {
    #[new]
    fn new(bearing_pressure: f64, friction: f64) -> PyResult<PyClassInitializer<Self>> {
        let law = Yielding::new(bearing_pressure, friction).or_raise()?;
        Ok(PyClassInitializer::from(PyInterfaceLaw::copied(law)).add_subclass(Self))
    }
}

/// The paper's thin layer of soil between base and ground, elastic while it is closed.
///
/// ``neighbour_height`` (m): height of the neighbouring elements. ``thickness_ratio``: of the layer
/// to them; ``debonded_share``: of the stiffness that is kept when it is open;
/// ``slip_stiffness_share``: when it slides. ``friction_limit``: "total", "lagged", "static" or
/// "dynamic"; ``slip_sense``: "inelastic", "velocity" or "last velocity".
#[pyclass(name = "ThinLayer", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyThinLayer(ThinLayer);

fn layer(
    mut law: ThinLayer,
    thickness_ratio: Option<f64>,
    debonded_share: Option<f64>,
    slip_stiffness_share: Option<f64>,
    friction_limit: Option<&str>,
    slip_sense: Option<&str>,
) -> PyResult<PyClassInitializer<PyThinLayer>> {
    if let Some(ratio) = thickness_ratio {
        law = law.with_thickness_ratio(ratio).or_raise()?;
    }
    if let Some(share) = debonded_share {
        law = law.with_debonded_ratio(share).or_raise()?;
    }
    if let Some(share) = slip_stiffness_share {
        law = law.with_slip_stiffness_ratio(share).or_raise()?;
    }
    if let Some(limit) = friction_limit {
        law = law.with_friction_limit(limit.parse().or_raise()?);
    }
    if let Some(sense) = slip_sense {
        law = law.with_slip_sense(sense.parse().or_raise()?);
    }
    Ok(PyClassInitializer::from(PyInterfaceLaw::copied(law)).add_subclass(PyThinLayer(law)))
}

#[pymethods]
impl PyThinLayer {
    #[new]
    #[pyo3(signature = (soil, neighbour_height, friction, *, thickness_ratio=None, debonded_share=None, slip_stiffness_share=None, friction_limit=None, slip_sense=None))]
    fn new(
        soil: &PySoil,
        neighbour_height: f64,
        friction: f64,
        thickness_ratio: Option<f64>,
        debonded_share: Option<f64>,
        slip_stiffness_share: Option<f64>,
        friction_limit: Option<&str>,
        slip_sense: Option<&str>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let law = ThinLayer::new(soil.0, neighbour_height, friction).or_raise()?;
        let shares = (thickness_ratio, debonded_share, slip_stiffness_share);
        layer(law, shares.0, shares.1, shares.2, friction_limit, slip_sense)
    }

    /// Layer of given normal and shear stiffness (Pa/m).
    #[staticmethod]
    #[pyo3(signature = (normal, shear, friction, *, debonded_share=None, slip_stiffness_share=None, friction_limit=None, slip_sense=None))]
    fn from_stiffness(
        py: Python<'_>,
        normal: f64,
        shear: f64,
        friction: f64,
        debonded_share: Option<f64>,
        slip_stiffness_share: Option<f64>,
        friction_limit: Option<&str>,
        slip_sense: Option<&str>,
    ) -> PyResult<Py<Self>> {
        let law = ThinLayer::from_stiffness(normal, shear, friction).or_raise()?;
        let shares = (debonded_share, slip_stiffness_share);
        Py::new(py, layer(law, None, shares.0, shares.1, friction_limit, slip_sense)?)
    }

    /// Normal and shear stiffness, Pa/m.
    #[getter]
    fn stiffness(&self) -> [f64; 2] {
        self.0.stiffness()
    }
}
