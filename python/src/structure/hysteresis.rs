//! Hysteretic springs, and structures with such springs.

use std::sync::Arc;

use basemat::Result;
use basemat::structure::{
    BiaxialSpring, Bilinear, BoucWen, DofCombination, FrictionPendulum, Hysteresis, LeadRubber,
    PendulumBearing, WithSprings,
};
use pyo3::prelude::*;

use super::{PyStructure, recipe};
use crate::dof_names::DofNames;
use crate::error::{OrRaise, refuse};
use crate::recipe::{Make, Recipe};
use crate::row::RowLike;
use crate::several::no_such;
use crate::user;

// Signatures show numbers only.
const _: () = assert!(
    FrictionPendulum::YIELD_DISPLACEMENT == 5e-4
        && LeadRubber::STIFFNESS_RATIO == 10.0
        && basemat::motion::STANDARD_GRAVITY == 9.80665
);

/// A spring whose force depends on where it has been: a yield law of a storey, an isolator.
/// Forces and stiffnesses are per metre of thickness.
#[pyclass(name = "Hysteresis", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyHysteresis {
    make: Recipe<dyn Hysteresis>,
    coupled: Make<BiaxialSpring>,
}

/// A law of this package, or one written in Python, and its coupled spring in two directions.
pub(super) struct LawLike(pub(super) Recipe<dyn Hysteresis>, Option<Make<BiaxialSpring>>);

impl LawLike {
    pub(super) fn coupled(self) -> PyResult<Make<BiaxialSpring>> {
        let needed = "a hysteresis written in Python acts in one direction: give one for each";
        self.1.ok_or_else(|| refuse(needed))
    }
}

extracts!(LawLike, object => match object.cast::<PyHysteresis>() {
    Ok(own) => Ok(Self(own.get().make.clone(), Some(own.get().coupled.clone()))),
    Err(_) => Ok(Self(user::hysteresis(&object)?, None)),
});

/// The base of a law that can be copied.
fn copied<L: Hysteresis + Clone + Sync + 'static>(
    law: L,
    coupled: fn(&L) -> Result<BiaxialSpring>,
) -> PyHysteresis {
    let own = law.clone();
    PyHysteresis {
        make: Arc::new(move || Ok(Box::new(law.clone()))),
        coupled: Arc::new(move || coupled(&own)),
    }
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
        let own = Bilinear::new(stiffness, yield_force, hardening).or_raise()?;
        let base = copied(own, |law| Ok(law.coupled()));
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
            _ => return Err(refuse("give both exponent and beta, or neither")),
        }
        Ok(PyClassInitializer::from(copied(own, BoucWen::coupled)).add_subclass(Self))
    }
}

/// Friction pendulum under a ``weight`` (N/m): ``radius`` of its dish (m), ``friction`` coefficient,
/// ``yield_displacement`` (m; 0.5 mm by default) before it slides.
#[pyclass(name = "FrictionPendulum", module = "basemat", extends = PyHysteresis, frozen)]
pub(crate) struct PyFrictionPendulum(FrictionPendulum);

extends!(PyFrictionPendulum, own => copied(own.0.clone(), |law| Ok(law.coupled())));

#[pymethods]
impl PyFrictionPendulum {
    #[new]
    #[pyo3(signature = (weight, radius, friction, *, yield_displacement=5e-4))]
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
    #[pyo3(signature = (gravity=9.80665))]
    fn sliding_period(&self, gravity: f64) -> PyResult<f64> {
        self.0.sliding_period(gravity).or_raise()
    }
}

/// Friction pendulum that carries the structure, in plan: its weight is the vertical force on it.
///
/// ``weight`` (N; of its stiffness before it slides, and of its friction until the static state is known), ``radius`` of its
/// dish (m), ``friction`` coefficient, ``vertical_stiffness`` (N/m), ``yield_displacement`` (m; 0.5 mm by default) before
/// it slides. `WithSprings` attaches it to three rows: it slides in any direction, climbs on its dish, and lifts off.
/// Friction follows the vertical force one step later; moments of that force at the displaced bearing are left out.
#[pyclass(name = "PendulumBearing", module = "basemat", frozen, dict)]
pub(crate) struct PyPendulumBearing(PendulumBearing);

#[pymethods]
impl PyPendulumBearing {
    #[new]
    #[pyo3(signature = (weight, radius, friction, vertical_stiffness, *, yield_displacement=5e-4))]
    fn new(
        weight: f64,
        radius: f64,
        friction: f64,
        vertical_stiffness: f64,
        yield_displacement: f64,
    ) -> PyResult<Self> {
        FrictionPendulum::new(weight, radius, friction)
            .and_then(|own| own.with_yield_displacement(yield_displacement))
            .and_then(|own| own.with_vertical_stiffness(vertical_stiffness))
            .or_raise()
            .map(Self)
    }

    /// Vertical force (N) on a new bearing at a ``deformation`` (along x, along y and up, m); 0 while it is lifted off.
    fn vertical_force(&self, deformation: [f64; 3]) -> f64 {
        self.0.vertical_force(deformation)
    }

    /// Forces (along x, along y and up, N) of a new bearing at a ``deformation`` (m).
    fn force(&self, deformation: [f64; 3]) -> [f64; 3] {
        self.0.force(deformation)
    }
}

/// Lead–rubber bearing: ``shear_modulus`` (Pa), ``rubber_area`` (m² per metre) and ``rubber_thickness`` (m)
/// of its rubber, ``lead_area`` (m² per metre) of its lead; ``stiffness_ratio``: first stiffness over that
/// after yielding, 10 by default.
#[pyclass(name = "LeadRubber", module = "basemat", extends = PyHysteresis, frozen)]
pub(crate) struct PyLeadRubber(LeadRubber);

#[pymethods]
impl PyLeadRubber {
    #[pyo3(signature = (shear_modulus, rubber_area, rubber_thickness, lead_area, *, stiffness_ratio=10.0))]
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
    #[pyo3(signature = (stiffness, strength, *, stiffness_ratio=10.0))]
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

extends!(PyLeadRubber, own => copied(own.0.clone(), |law| Ok(law.coupled())));

fn bearing(own: basemat::Result<LeadRubber>, stiffness_ratio: f64) -> PyResult<PyLeadRubber> {
    let own = own.and_then(|own| own.with_stiffness_ratio(stiffness_ratio));
    own.or_raise().map(PyLeadRubber)
}

/// Springs of a list: rows of the deformations, one to three, and the law.
struct Springs(Vec<(Vec<RowLike>, SpringLaw)>);

/// Law of one or two rows, or a bearing of three.
enum SpringLaw {
    Law(LawLike),
    Bearing(PendulumBearing),
}

extracts!(Springs, object => {
    let needed = "a list of (row, law), (row_x, row_y, law) or (row_x, row_y, row_z, bearing)";
    let entries = object.try_iter().map_err(|_| no_such(&object, needed))?;
    let spring = |entry: PyResult<Bound<'py, PyAny>>| {
        let entry = entry?;
        let count = entry.len().ok().filter(|count| [2, 3, 4].contains(count));
        let needed = "(row, law), (row_x, row_y, law) or (row_x, row_y, row_z, bearing)";
        let last = count.ok_or_else(|| no_such(&entry, needed))? - 1;
        let rows = (0..last).map(|k| entry.get_item(k)?.extract::<RowLike>());
        let law = entry.get_item(last)?;
        let law = match law.cast::<PyPendulumBearing>() {
            Ok(own) if last == 3 => SpringLaw::Bearing(own.get().0.clone()),
            _ if last == 3 => return Err(no_such(&law, "a PendulumBearing for three rows")),
            _ => SpringLaw::Law(law.extract()?),
        };
        Ok((rows.collect::<PyResult<_>>()?, law))
    };
    entries.map(spring).collect::<PyResult<_>>().map(Self)
});

/// A row and a law along it, or two rows and a coupled law.
enum Spring {
    Uniaxial(DofCombination, Recipe<dyn Hysteresis>),
    Biaxial([DofCombination; 2], Make<BiaxialSpring>),
    Bearing([DofCombination; 3], PendulumBearing),
}

/// A ``structure`` with hysteretic ``springs``: a list of pairs ``(row, law)``, of a row of degrees of
/// freedom, which is the spring's deformation (m), and a `Hysteresis` or `UserHysteresis`.
/// In plan also ``(row_x, row_y, law)`` with two deformations at a right angle and a `Hysteresis`
/// (``BoucWen`` with an exponent of 2), whose force (N) has the same limit in every direction; two springs
/// along x and y act independently, and carry √2 times their limit on the diagonal. With three deformations, along x, along
/// y and up, ``(row_x, row_y, row_z, bearing)`` of a `PendulumBearing`.
#[pyclass(name = "WithSprings", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithSprings(
    /// The structure without the springs.
    pub(crate) Py<PyAny>,
);

#[pymethods]
impl PyWithSprings {
    #[new]
    fn new(structure: Bound<'_, PyAny>, springs: Springs) -> PyResult<PyClassInitializer<Self>> {
        let (object, structure) = (structure.clone(), recipe(&structure)?);
        let dofs = structure().or_raise()?.dofs();
        let names = DofNames::from_structure(&object, dofs)?;
        let spring = |(rows, law): (Vec<RowLike>, SpringLaw)| {
            let count = rows.len();
            let row = |RowLike(row, order): RowLike| {
                order.check("the row of a spring", dofs)?;
                Ok(row)
            };
            let mut rows = rows.into_iter().map(row).collect::<PyResult<Vec<_>>>()?.into_iter();
            let mut next = || rows.next().unwrap_or_default();
            Ok(match law {
                SpringLaw::Bearing(law) => Spring::Bearing([next(), next(), next()], law),
                SpringLaw::Law(law) if count == 2 => {
                    Spring::Biaxial([next(), next()], law.coupled()?)
                }
                SpringLaw::Law(law) => Spring::Uniaxial(next(), law.0),
            })
        };
        let springs: Vec<_> = springs.0.into_iter().map(spring).collect::<PyResult<_>>()?;
        let make = move || {
            let mut own = WithSprings::new(structure()?);
            for spring in &springs {
                own = match spring {
                    Spring::Uniaxial(row, law) => own.spring(row, law()?)?,
                    Spring::Biaxial(rows, law) => own.biaxial_spring(rows.each_ref(), law()?)?,
                    Spring::Bearing(rows, law) => own.pendulum(rows.each_ref(), law.clone())?,
                };
            }
            Ok(own)
        };
        make().or_raise()?;
        let base = PyStructure::new(make).named(names);
        Ok(PyClassInitializer::from(base).add_subclass(Self(object.unbind())))
    }
}
