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
/// ``friction``: coefficient, 0 or more; ``math.inf`` for a base that opens but never slides.
/// ``tensile_strength`` (Pa; 0 by default) holds an element until it first opens. ``closed_below`` (m):
/// contact conditions act on the change of the gap of elements whose gap is at most that (Moreau's
/// rule); on the gap unless given.
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

    /// Friction coefficient, a number.
    #[getter]
    fn friction(&self) -> f64 {
        self.0.friction()
    }

    fn __repr__(&self) -> String {
        format!("Coulomb({:?})", self.0.friction())
    }
}

/// A bond that breaks for good, and friction afterwards: ``tension`` and ``cohesion`` are its strengths
/// (Pa) against opening and shear, ``friction`` the coefficient when it is broken.
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

/// Coulomb friction of a coefficient ``friction`` on soil that yields under its ``bearing_pressure`` (Pa).
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

/// The thin layer of soil between base and ground of Patel and Spyrakos, elastic while it is closed.
///
/// ``soil``: of the layer. ``neighbour_height``: of the finite elements beside it, m. ``friction``:
/// coefficient. ``thickness_ratio``: of the layer to them; 0.1 unless given. ``debonded_share``: of the
/// stiffness that is kept when it is open, 0 to 1; 0.001 unless given. ``slip_stiffness_share``: when
/// it slides, 0 to 1; 0 unless given. ``friction_limit``: pressure that friction sees, "total" (of this
/// step; the default), "lagged" (of the step before), "static" or "dynamic" (what shaking added).
/// ``slip_sense``: what tells the sense of slip, "inelastic" (slip beyond the elastic one; the
/// default), "velocity" or "last velocity" (of this step or the one before).
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

    /// Layer of given ``normal`` and ``shear`` stiffness (Pa/m); ``friction``, ``debonded_share``,
    /// ``slip_stiffness_share``, ``friction_limit`` and ``slip_sense`` are those of the class, the last
    /// four if given.
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
