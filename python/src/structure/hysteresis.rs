//! Hysteretic springs, and structures with such springs.

use std::sync::Arc;

use basemat::structure::{
    Bilinear, BoucWen, DofCombination, FrictionPendulum, Hysteresis, LeadRubber, WithSprings,
};
use pyo3::prelude::*;

use super::{PyStructure, recipe};
use crate::dof_names::DofNames;
use crate::error::OrRaise;
use crate::recipe::Recipe;
use crate::row::RowLike;
use crate::several::Pairs;
use crate::user;

/// A spring whose force depends on where it has been: a yield law of a storey, an isolator.
/// Forces and stiffnesses are per metre of thickness.
#[pyclass(name = "Hysteresis", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyHysteresis {
    make: Recipe<dyn Hysteresis>,
}

/// A law of this package, or one written in Python.
pub(super) struct LawLike(pub(super) Recipe<dyn Hysteresis>);

extracts!(LawLike, object => match object.cast::<PyHysteresis>() {
    Ok(own) => Ok(Self(own.get().make.clone())),
    Err(_) => Ok(Self(user::hysteresis(&object)?)),
});

/// The base of a law that can be copied.
fn copied(law: impl Hysteresis + Clone + Sync + 'static) -> PyHysteresis {
    PyHysteresis { make: Arc::new(move || Ok(Box::new(law.clone()))) }
}

#[pymethods]
impl PyHysteresis {
    /// Forces (list of m numbers, N/m) at the ``deformations`` (array of shape (m,), m) of a path that a
    /// new spring is led along.
    fn path(&self, deformations: crate::array::Numbers) -> PyResult<Vec<f64>> {
        let mut spring = (self.make)().or_raise()?;
        let force = |deformation: f64| {
            let force = spring.response(deformation).force;
            spring.commit(deformation);
            force
        };
        Ok(deformations.0.into_iter().map(force).collect())
    }
}

/// Bilinear: ``stiffness`` (N/m per metre) up to ``yield_force`` (N/m), then ``hardening`` (0 to 1) times
/// the stiffness; unloading with the first stiffness.
#[pyclass(name = "Bilinear", module = "basemat", extends = PyHysteresis, frozen)]
pub(crate) struct PyBilinear;

#[pymethods]
impl PyBilinear {
    #[new]
    fn new(stiffness: f64, yield_force: f64, hardening: f64) -> PyResult<PyClassInitializer<Self>> {
        let base = copied(Bilinear::new(stiffness, yield_force, hardening).or_raise()?);
        Ok(PyClassInitializer::from(base).add_subclass(Self))
    }
}

/// Bouc–Wen: ``stiffness`` (N/m per metre) up to ``yield_force`` (N/m), then ``hardening`` (0 to 1) times
/// the stiffness, with a smooth knee of an ``exponent``, and ``beta`` for the shape of loops: both, or
/// neither (then 2 and 0.5).
#[pyclass(name = "BoucWen", module = "basemat", extends = PyHysteresis, frozen)]
pub(crate) struct PyBoucWen;

#[pymethods]
impl PyBoucWen {
    #[pyo3(signature = (stiffness, yield_force, hardening, *, exponent=None, beta=None))]
    #[new]
    fn new(
        stiffness: f64,
        yield_force: f64,
        hardening: f64,
        exponent: Option<f64>,
        beta: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let mut own = BoucWen::new(stiffness, yield_force, hardening).or_raise()?;
        match (exponent, beta) {
            (None, None) => {}
            (Some(exponent), Some(beta)) => own = own.with_shape(exponent, beta).or_raise()?,
            _ => return Err(crate::error::refuse("give both exponent and beta, or neither")),
        }
        Ok(PyClassInitializer::from(copied(own)).add_subclass(Self))
    }
}

/// Friction pendulum under a ``weight`` (N/m): ``radius`` of its dish (m), ``friction`` coefficient,
/// ``yield_displacement`` (m; 0.5 mm by default) before it slides.
#[pyclass(name = "FrictionPendulum", module = "basemat", extends = PyHysteresis, frozen)]
pub(crate) struct PyFrictionPendulum(FrictionPendulum);

extends!(PyFrictionPendulum, own => copied(own.0.clone()));

#[pymethods]
impl PyFrictionPendulum {
    #[new]
    #[pyo3(signature = (weight, radius, friction, *, yield_displacement=FrictionPendulum::YIELD_DISPLACEMENT))]
    fn new(
        weight: f64,
        radius: f64,
        friction: f64,
        yield_displacement: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let own = FrictionPendulum::new(weight, radius, friction)
            .and_then(|own| own.with_yield_displacement(yield_displacement));
        Self(own.or_raise()?).initializer()
    }

    /// Period of sliding on the dish, s, under a ``gravity`` (m/s²; 9.80665 by default).
    #[pyo3(signature = (gravity=basemat::motion::STANDARD_GRAVITY))]
    fn sliding_period(&self, gravity: f64) -> PyResult<f64> {
        self.0.sliding_period(gravity).or_raise()
    }
}

/// Lead–rubber bearing: ``shear_modulus`` (Pa), ``rubber_area`` (m² per metre) and ``rubber_thickness`` (m)
/// of its rubber, ``lead_area`` (m² per metre) of its lead; ``stiffness_ratio``: first stiffness over that
/// after yielding, 10 by default.
#[pyclass(name = "LeadRubber", module = "basemat", extends = PyHysteresis, frozen)]
pub(crate) struct PyLeadRubber(LeadRubber);

#[pymethods]
impl PyLeadRubber {
    #[pyo3(signature = (shear_modulus, rubber_area, rubber_thickness, lead_area, *, stiffness_ratio=LeadRubber::STIFFNESS_RATIO))]
    #[new]
    fn new(
        shear_modulus: f64,
        rubber_area: f64,
        rubber_thickness: f64,
        lead_area: f64,
        stiffness_ratio: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let own = LeadRubber::new(shear_modulus, rubber_area, rubber_thickness, lead_area);
        bearing(own, stiffness_ratio)?.initializer()
    }

    /// Bearing of a ``stiffness`` after yielding (N/m per metre) and a ``strength`` (N/m);
    /// ``stiffness_ratio`` is as in the class.
    #[pyo3(signature = (stiffness, strength, *, stiffness_ratio=LeadRubber::STIFFNESS_RATIO))]
    #[staticmethod]
    fn from_strength(stiffness: f64, strength: f64, stiffness_ratio: f64) -> PyResult<Self> {
        bearing(LeadRubber::from_strength(stiffness, strength), stiffness_ratio)
    }

    /// Strength: force at zero deformation, N/m.
    #[getter]
    fn strength(&self) -> f64 {
        self.0.strength()
    }

    /// Stiffness after yielding, N/m per metre.
    #[getter]
    fn stiffness(&self) -> f64 {
        self.0.stiffness()
    }
}

extends!(PyLeadRubber, own => copied(own.0.clone()));

fn bearing(own: basemat::Result<LeadRubber>, stiffness_ratio: f64) -> PyResult<PyLeadRubber> {
    let own = own.and_then(|own| own.with_stiffness_ratio(stiffness_ratio));
    own.or_raise().map(PyLeadRubber)
}

/// A ``structure`` with hysteretic ``springs``: a list of pairs ``(row, law)``, of a row of degrees of
/// freedom, which is the spring's deformation (m), and a :class:`Hysteresis` or :class:`UserHysteresis`.
#[pyclass(name = "WithSprings", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithSprings;

#[pymethods]
impl PyWithSprings {
    #[new]
    fn new(
        structure: Bound<'_, PyAny>,
        springs: Pairs<RowLike, LawLike>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (object, structure) = (structure.clone(), recipe(&structure)?);
        let dofs = structure().or_raise()?.dofs();
        let names = DofNames::from_structure(&object, dofs)?;
        let springs: Vec<(DofCombination, Recipe<dyn Hysteresis>)> = springs
            .0
            .into_iter()
            .map(|(RowLike(row, order), LawLike(law))| {
                order.check("the row of a spring", dofs)?;
                Ok((row, law))
            })
            .collect::<PyResult<_>>()?;
        let make = move || {
            let mut own = WithSprings::new(structure()?);
            for (row, law) in &springs {
                own = own.spring(row, law()?)?;
            }
            Ok(own)
        };
        make().or_raise()?;
        let base = PyStructure::new(make).named(names);
        Ok(PyClassInitializer::from(base).add_subclass(Self))
    }
}
