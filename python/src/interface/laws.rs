//! The core's laws.

use std::sync::Arc;

use basemat::interface::{
    Bonded, Cohesive, Coulomb, CyclicYielding, EarthPressure, PreviousContact, ThinLayer,
    UnilateralCondition, VariableFriction, Yielding,
};
use pyo3::prelude::*;

use super::PyInterfaceLaw;
use crate::array::real_number;
use crate::error::{OrRaise, WithOption, call_user_code, input_error};
use crate::soil::PySoil;
use crate::user::PyPreviousContact;

/// Base and ground are bonded: they neither separate nor slide.
#[pyclass(name = "Bonded", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyBonded;

#[pymethods]
impl PyBonded {
    #[new]
    fn new() -> PyClassInitializer<Self> {
        PyClassInitializer::from(PyInterfaceLaw::from_law(Bonded)).add_subclass(Self)
    }
}

/// Hard unilateral contact with Coulomb friction: an element sticks, slides or opens.
///
/// ``friction``: coefficient, 0 or more; ``math.inf`` for a base that opens but never slides. With 3 or more, steps in
/// plan may have several solutions: compare the run with one of the mirror image. ``tensile_strength`` (Pa; 0 by
/// default) acts on an element until it first opens. ``closed_below`` (m): if given, the contact conditions of an
/// element whose gap is at most this length act on the change of the gap (Moreau's rule); otherwise they act on the
/// gap.
#[pyclass(name = "Coulomb", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyCoulomb(Coulomb);

#[pymethods]
impl PyCoulomb {
    #[pyo3(signature = (friction, *, tensile_strength=0.0, closed_below=None))]
    #[new]
    fn new(
        friction: f64,
        tensile_strength: f64,
        closed_below: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let condition =
            closed_below.map(|closed_below| UnilateralCondition::Velocity { closed_below });
        let law = Coulomb::new(friction)
            .and_then(|law| law.with_tensile_strength(tensile_strength))
            .with(condition, Coulomb::with_unilateral_condition)
            .or_raise()?;
        Ok(PyClassInitializer::from(PyInterfaceLaw::from_law(law)).add_subclass(Self(law)))
    }

    /// Friction coefficient, a number.
    #[getter]
    fn friction(&self) -> f64 {
        self.0.friction()
    }
}

/// A bond that breaks permanently, and friction afterwards: ``tension`` and ``cohesion`` are its strengths (Pa) against
/// opening and shear, ``friction`` the friction coefficient after it is broken.
#[pyclass(name = "Cohesive", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyCohesive;

#[pymethods]
impl PyCohesive {
    #[new]
    fn new(tension: f64, cohesion: f64, friction: f64) -> PyResult<PyClassInitializer<Self>> {
        let law = Cohesive::new(tension, cohesion, friction).or_raise()?;
        Ok(PyClassInitializer::from(PyInterfaceLaw::from_law(law)).add_subclass(Self))
    }
}

/// Coulomb friction on soil that yields under its bearing pressure.
///
/// ``bearing_pressure``: Pa. ``friction``: coefficient. Only friction bounds the shear traction, not an undrained strength.
#[pyclass(name = "Yielding", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyYielding;

#[pymethods]
impl PyYielding {
    #[new]
    fn new(bearing_pressure: f64, friction: f64) -> PyResult<PyClassInitializer<Self>> {
        let law = Yielding::new(bearing_pressure, friction).or_raise()?;
        Ok(PyClassInitializer::from(PyInterfaceLaw::from_law(law)).add_subclass(Self))
    }
}

/// Coulomb friction on soil that settles in every cycle of load.
///
/// ``friction``: coefficient. ``bearing_pressure``: largest pressure of the soil, Pa. Only friction bounds the shear
/// traction, not an undrained strength.
///
/// Under virgin load half of the bearing pressure acts at the ``reference_settlement`` (m; 0 or more).
/// ``elastic_range``: increase of pressure without yielding, relative to the bearing pressure, above 0 and at most 1; 1
/// unless given, for soil that yields again only above its largest previous pressure. ``depth_gradient``: growth of the
/// bearing pressure with the settlement, Pa/m; 0 unless given (`ShallowFooting.pressure_growth`). State variables of an
/// element: settlement (m), and pressure above which it yields (Pa).
#[pyclass(name = "CyclicYielding", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyCyclicYielding(CyclicYielding);

#[pymethods]
impl PyCyclicYielding {
    #[pyo3(signature = (bearing_pressure, reference_settlement, friction, *, elastic_range=1.0, depth_gradient=0.0))]
    #[new]
    fn new(
        bearing_pressure: f64,
        reference_settlement: f64,
        friction: f64,
        elastic_range: f64,
        depth_gradient: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let law = CyclicYielding::new(bearing_pressure, reference_settlement, friction)
            .and_then(|law| law.with_elastic_range(elastic_range))
            .and_then(|law| law.with_depth_gradient(depth_gradient))
            .or_raise()?;
        Ok(PyClassInitializer::from(PyInterfaceLaw::from_law(law)).add_subclass(Self(law)))
    }

    /// Settlement (m) of soil without earlier load under a ``pressure`` (Pa), without the settlement of the elastic
    /// ground.
    fn virgin_settlement(&self, pressure: f64) -> f64 {
        self.0.virgin_settlement(pressure)
    }
}

/// Coulomb friction between a wall and soil that yields.
///
/// ``friction``: coefficient. The soil yields at its ``active`` pressure (Pa) towards a wall that moves away, at its
/// ``passive`` pressure (Pa) under a wall that moves into it.
///
/// With an ``active`` pressure of 0 the soil is stable by its cohesion, and a gap opens at the wall.
/// `TrenchGround.interfaces` creates these laws from the strength of the soil.
#[pyclass(name = "EarthPressure", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyEarthPressure(EarthPressure);

#[pymethods]
impl PyEarthPressure {
    #[new]
    fn new(active: f64, passive: f64, friction: f64) -> PyResult<PyClassInitializer<Self>> {
        let law = EarthPressure::new(active, passive, friction).or_raise()?;
        Ok(PyClassInitializer::from(PyInterfaceLaw::from_law(law)).add_subclass(Self(law)))
    }

    /// Active and passive pressure, Pa.
    #[getter]
    fn pressures(&self) -> [f64; 2] {
        self.0.pressures()
    }
}

/// Thin elastic layer between base and ground (Patel and Spyrakos).
///
/// ``soil``: `Soil` of the layer. ``neighbour_height``: height of the finite elements beside the layer, m.
/// ``friction``: coefficient. ``thickness_ratio``: ratio of the thickness of the layer to this height; 0.1 unless
/// given. ``debonded_ratio``: fraction of the stiffness that remains while the layer is open, 0 to 1; 0.001 unless
/// given. ``slip_stiffness_ratio``: fraction of the shear stiffness that resists slip in addition to friction, 0 to 1;
/// 0 unless given. ``friction_limit``: pressure in the friction limit, "total" (of this step; the default), "lagged"
/// (of the step before), "static" or "dynamic" (the magnitude of the change since the static state). ``slip_sense``:
/// quantity that decides the sense of slip, "inelastic" (the slip without its elastic part; the default), "velocity"
/// (the rate of slip in this step) or "last_velocity" (in the step before).
#[pyclass(name = "ThinLayer", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyThinLayer(ThinLayer);

extends!(PyThinLayer, layer => PyInterfaceLaw::from_law(layer.0));

impl PyThinLayer {
    /// The layer with the options that are not `None`.
    fn with_options(
        law: basemat::Result<ThinLayer>,
        debonded_ratio: Option<f64>,
        slip_stiffness_ratio: Option<f64>,
        friction_limit: Option<&str>,
        slip_sense: Option<&str>,
    ) -> PyResult<Self> {
        let law = law
            .with(debonded_ratio, ThinLayer::with_debonded_ratio)
            .with(slip_stiffness_ratio, ThinLayer::with_slip_stiffness_ratio)
            .with(friction_limit, |law, limit| Ok(law.with_friction_limit(limit.parse()?)))
            .with(slip_sense, |law, sense| Ok(law.with_slip_sense(sense.parse()?)));
        law.or_raise().map(Self)
    }
}

#[pymethods]
impl PyThinLayer {
    #[pyo3(signature = (soil, neighbour_height, friction, *, thickness_ratio=None, debonded_ratio=None, slip_stiffness_ratio=None, friction_limit=None, slip_sense=None))]
    #[new]
    fn new(
        soil: &PySoil,
        neighbour_height: f64,
        friction: f64,
        thickness_ratio: Option<f64>,
        debonded_ratio: Option<f64>,
        slip_stiffness_ratio: Option<f64>,
        friction_limit: Option<&str>,
        slip_sense: Option<&str>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let law = ThinLayer::new(soil.0, neighbour_height, friction)
            .with(thickness_ratio, ThinLayer::with_thickness_ratio);
        Self::with_options(law, debonded_ratio, slip_stiffness_ratio, friction_limit, slip_sense)?
            .initializer()
    }

    /// Layer of given ``normal`` and ``shear`` stiffness (Pa/m); ``friction``, ``debonded_ratio``,
    /// ``slip_stiffness_ratio``, ``friction_limit`` and ``slip_sense`` are as in the class; the last four have its
    /// defaults unless given.
    #[pyo3(signature = (normal, shear, friction, *, debonded_ratio=None, slip_stiffness_ratio=None, friction_limit=None, slip_sense=None))]
    #[staticmethod]
    fn from_stiffness(
        normal: f64,
        shear: f64,
        friction: f64,
        debonded_ratio: Option<f64>,
        slip_stiffness_ratio: Option<f64>,
        friction_limit: Option<&str>,
        slip_sense: Option<&str>,
    ) -> PyResult<Self> {
        let law = ThinLayer::from_stiffness(normal, shear, friction);
        Self::with_options(law, debonded_ratio, slip_stiffness_ratio, friction_limit, slip_sense)
    }

    /// Normal and shear stiffness, Pa/m.
    #[getter]
    fn stiffness(&self) -> [f64; 2] {
        self.0.stiffness()
    }
}

/// Coulomb friction whose coefficient is returned by a Python function.
///
/// ``coefficient(start)`` returns a number for a `PreviousContact`. An exception of the function ends the run, which
/// raises it. ``tensile_strength`` (Pa; 0 by default) acts on an element until it first opens.
#[pyclass(name = "VariableFriction", module = "basemat", extends = PyInterfaceLaw, frozen)]
pub(crate) struct PyVariableFriction;

#[pymethods]
impl PyVariableFriction {
    #[pyo3(signature = (coefficient, *, tensile_strength=0.0))]
    #[new]
    fn new(
        coefficient: Bound<'_, PyAny>,
        tensile_strength: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        if !coefficient.is_callable() {
            return Err(input_error("the coefficient must be a function of the start of a step"));
        }
        let function = Arc::new(coefficient.unbind());
        // An invalid strength raises here, not later when a simulation is built.
        VariableFriction::new(|_| 0.0).with_tensile_strength(tensile_strength).or_raise()?;
        let make = move || {
            let function = Arc::clone(&function);
            let law = VariableFriction::new(move |start: &PreviousContact<'_>| {
                call_user_code(f64::NAN, |py| {
                    let coefficient =
                        function.call1(py, (PyPreviousContact::from_core(py, start)?,))?;
                    real_number("the coefficient's function", coefficient.bind(py))
                })
            });
            Ok(Box::new(law.with_tensile_strength(tensile_strength)?) as Box<_>)
        };
        Ok(PyClassInitializer::from(PyInterfaceLaw { make: Arc::new(make) }).add_subclass(Self))
    }
}
