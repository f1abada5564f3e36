//! Hysteretic springs, and structures with such springs.

use std::sync::Arc;

use basemat::Result;
use basemat::structure::{
    BiaxialSpring, Bilinear, BoucWen, DofCombination, FrictionPendulum, Hysteresis, LeadRubber,
    PendulumBearing, WithSprings,
};
use pyo3::prelude::*;

use super::{PyStructure, structure_recipe};
use crate::error::{OrRaise, input_error};
use crate::list_arguments::type_error;
use crate::names::DofNames;
use crate::recipe::{Factory, Recipe};
use crate::row::RowLike;
use crate::user;

// Signatures in Python contain these numbers, not the constants of the core.
const _: () = assert!(
    FrictionPendulum::YIELD_DISPLACEMENT == 5e-4
        && LeadRubber::STIFFNESS_RATIO == 10.0
        && basemat::motion::STANDARD_GRAVITY == 9.80665
);

/// A spring whose force depends on its past deformation: a yield law of a storey, an isolator. Forces and stiffnesses
/// are per metre of thickness in the plane, of the whole spring in plan (N and N/m).
#[pyclass(name = "Hysteresis", module = "basemat", subclass, frozen, dict)]
pub(crate) struct PyHysteresis {
    make: Recipe<dyn Hysteresis>,
    /// Builds the coupled spring in two directions.
    make_coupled: Factory<BiaxialSpring>,
}

/// A law of this package, or one written in Python, and its coupled spring in two directions.
pub(super) struct LawLike(pub(super) Recipe<dyn Hysteresis>, Option<Factory<BiaxialSpring>>);

impl LawLike {
    /// Builds the coupled spring; an error for a law written in Python.
    pub(super) fn coupled(self) -> PyResult<Factory<BiaxialSpring>> {
        let text =
            "a hysteresis written in Python acts in one direction: give one for each direction";
        self.1.ok_or_else(|| input_error(text))
    }
}

extracts!(LawLike, object => match object.cast::<PyHysteresis>() {
    Ok(law) => Ok(Self(law.get().make.clone(), Some(law.get().make_coupled.clone()))),
    Err(_) => Ok(Self(user::hysteresis_recipe(&object)?, None)),
});

/// The superclass object of a law that can be cloned.
fn new_superclass<L: Hysteresis + Clone + Sync + 'static>(
    law: L,
    coupled: fn(&L) -> Result<BiaxialSpring>,
) -> PyHysteresis {
    let uniaxial_law = law.clone();
    PyHysteresis {
        make: Arc::new(move || Ok(Box::new(uniaxial_law.clone()))),
        make_coupled: Arc::new(move || coupled(&law)),
    }
}

#[pymethods]
impl PyHysteresis {
    /// Forces (list of m numbers, N/m) of a new spring at the ``deformations`` of a path (array of shape (m,), m).
    fn path(&self, deformations: crate::array::Numbers) -> PyResult<Vec<f64>> {
        let mut spring = (self.make)().or_raise()?;
        let mut forces = Vec::with_capacity(deformations.0.len());
        for deformation in deformations.0 {
            forces.push(spring.response(deformation).force);
            spring.commit(deformation);
        }
        Ok(forces)
    }
}

/// Bilinear spring: ``stiffness`` (N/m per metre) up to ``yield_force`` (N/m), then ``hardening`` (0 to 1) times the
/// stiffness; it unloads with the initial stiffness.
#[pyclass(name = "Bilinear", module = "basemat", extends = PyHysteresis, frozen)]
pub(crate) struct PyBilinear;

#[pymethods]
impl PyBilinear {
    #[new]
    fn new(stiffness: f64, yield_force: f64, hardening: f64) -> PyResult<PyClassInitializer<Self>> {
        let law = Bilinear::new(stiffness, yield_force, hardening).or_raise()?;
        let superclass = new_superclass(law, |law| Ok(law.coupled()));
        Ok(PyClassInitializer::from(superclass).add_subclass(Self))
    }
}

/// Bouc–Wen spring: ``stiffness`` (N/m per metre) up to ``yield_force`` (N/m), then ``hardening`` (0 to 1) times the
/// stiffness, with a smooth transition that ``exponent`` controls; ``beta`` controls the shape of the loops. Give both
/// ``exponent`` and ``beta``, or neither: they are then 2 and 0.5.
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
        let mut law = BoucWen::new(stiffness, yield_force, hardening).or_raise()?;
        match (exponent, beta) {
            (None, None) => {}
            (Some(exponent), Some(beta)) => law = law.with_shape(exponent, beta).or_raise()?,
            _ => return Err(input_error("give both exponent and beta, or neither")),
        }
        Ok(PyClassInitializer::from(new_superclass(law, BoucWen::coupled)).add_subclass(Self))
    }
}

/// Friction pendulum under a ``weight`` (N/m): ``radius`` of its dish (m), ``friction`` coefficient,
/// ``yield_displacement`` (m; 0.5 mm by default) before it slides.
#[pyclass(name = "FrictionPendulum", module = "basemat", extends = PyHysteresis, frozen)]
pub(crate) struct PyFrictionPendulum(FrictionPendulum);

extends!(PyFrictionPendulum, pendulum => new_superclass(pendulum.0.clone(), |law| Ok(law.coupled())));

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
        let pendulum = FrictionPendulum::new(weight, radius, friction)
            .and_then(|pendulum| pendulum.with_yield_displacement(yield_displacement));
        Self(pendulum.or_raise()?).initializer()
    }

    /// Period of sliding on the dish, s, under a ``gravity`` (m/s²; 9.80665 by default).
    #[pyo3(signature = (gravity=9.80665))]
    fn sliding_period(&self, gravity: f64) -> PyResult<f64> {
        self.0.sliding_period(gravity).or_raise()
    }
}

/// Friction pendulum that carries the structure, in plan: its weight is the vertical force on it.
///
/// ``weight`` (N; for its stiffness before it slides, and for its friction until the static state is computed),
/// ``radius`` of its dish (m), ``friction`` coefficient, ``vertical_stiffness`` (N/m), ``yield_displacement`` (m; 0.5
/// mm by default) before it slides. `WithSprings` attaches it to three rows: it slides in any direction, rises on its
/// dish, and lifts off. Friction follows the vertical force one step later; moments of that force about the undisplaced
/// bearing are neglected.
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
            .and_then(|pendulum| pendulum.with_yield_displacement(yield_displacement))
            .and_then(|pendulum| pendulum.with_vertical_stiffness(vertical_stiffness))
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

/// Lead–rubber bearing: ``shear_modulus`` (Pa), ``rubber_area`` (m² per metre) and ``rubber_thickness`` (m) of its
/// rubber, ``lead_area`` (m² per metre) of its lead; ``stiffness_ratio``: ratio of the initial stiffness to the
/// stiffness after yielding, 10 by default.
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
        let bearing = LeadRubber::new(shear_modulus, rubber_area, rubber_thickness, lead_area);
        with_stiffness_ratio(bearing, stiffness_ratio)?.initializer()
    }

    /// Bearing of a ``stiffness`` after yielding (N/m per metre) and a ``strength`` (N/m);
    /// ``stiffness_ratio`` is as in the class.
    #[pyo3(signature = (stiffness, strength, *, stiffness_ratio=10.0))]
    #[staticmethod]
    fn from_strength(stiffness: f64, strength: f64, stiffness_ratio: f64) -> PyResult<Self> {
        with_stiffness_ratio(LeadRubber::from_strength(stiffness, strength), stiffness_ratio)
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

extends!(PyLeadRubber, bearing => new_superclass(bearing.0.clone(), |law| Ok(law.coupled())));

/// The bearing with this ratio of its initial stiffness to that after yielding.
fn with_stiffness_ratio(
    bearing: basemat::Result<LeadRubber>,
    stiffness_ratio: f64,
) -> PyResult<PyLeadRubber> {
    let bearing = bearing.and_then(|bearing| bearing.with_stiffness_ratio(stiffness_ratio));
    bearing.or_raise().map(PyLeadRubber)
}

/// Python's list of springs: rows of the deformations, one to three, and the law.
struct SpringList(Vec<(Vec<RowLike>, SpringLaw)>);

/// Law of one or two rows, or a bearing of three.
enum SpringLaw {
    Law(LawLike),
    Bearing(PendulumBearing),
}

extracts!(SpringList, object => {
    let requirement = "a list of (row, law), (row_x, row_y, law) or (row_x, row_y, row_z, bearing)";
    let entries = object.try_iter().map_err(|_| type_error(&object, requirement))?;
    entries.map(|entry| spring_entry(&entry?)).collect::<PyResult<_>>().map(Self)
});

/// The rows and the law of an entry of a list of springs.
fn spring_entry(entry: &Bound<'_, PyAny>) -> PyResult<(Vec<RowLike>, SpringLaw)> {
    let requirement = "(row, law), (row_x, row_y, law) or (row_x, row_y, row_z, bearing)";
    let entry_length = entry.len().ok().filter(|entry_length| [2, 3, 4].contains(entry_length));
    let row_count = entry_length.ok_or_else(|| type_error(entry, requirement))? - 1;
    let law_object = entry.get_item(row_count)?;
    let law = match law_object.cast::<PyPendulumBearing>() {
        Ok(bearing) if row_count == 3 => SpringLaw::Bearing(bearing.get().0.clone()),
        _ if row_count == 3 => {
            return Err(type_error(&law_object, "a PendulumBearing for three rows"));
        }
        _ => SpringLaw::Law(law_object.extract()?),
    };
    let rows = (0..row_count).map(|index| entry.get_item(index)?.extract::<RowLike>());
    Ok((rows.collect::<PyResult<_>>()?, law))
}

/// A spring of a structure: a law along one row, a coupled law of two rows, or a bearing of three.
enum SpringOrBearing {
    Uniaxial(DofCombination, Recipe<dyn Hysteresis>),
    Biaxial([DofCombination; 2], Factory<BiaxialSpring>),
    Bearing([DofCombination; 3], PendulumBearing),
}

impl SpringOrBearing {
    /// The spring along these rows of a structure with so many degrees of freedom.
    fn new(rows: Vec<RowLike>, law: SpringLaw, dof_count: usize) -> PyResult<Self> {
        let mut combinations = Vec::with_capacity(rows.len());
        for RowLike(row, weight_count) in rows {
            weight_count.check("the row of a spring", dof_count)?;
            combinations.push(row);
        }
        match law {
            SpringLaw::Bearing(law) => Ok(Self::Bearing(row_array(combinations)?, law)),
            SpringLaw::Law(law) if combinations.len() == 2 => {
                Ok(Self::Biaxial(row_array(combinations)?, law.coupled()?))
            }
            SpringLaw::Law(law) => {
                let [row] = row_array(combinations)?;
                Ok(Self::Uniaxial(row, law.0))
            }
        }
    }
}

/// The rows as an array; an error unless there are `N`.
fn row_array<const N: usize>(rows: Vec<DofCombination>) -> PyResult<[DofCombination; N]> {
    let row_count = rows.len();
    rows.try_into()
        .map_err(|_| input_error(format!("a spring has {row_count} rows, but must have {N}")))
}

/// A ``structure`` with hysteretic springs.
///
/// ``springs``: list of pairs ``(row, law)``. The row of degrees of freedom is the spring's deformation (m), the law is
/// a `Hysteresis` or `UserHysteresis`.
///
/// In plan an entry may also be ``(row_x, row_y, law)`` with two deformations at a right angle and a `Hysteresis`
/// (``BoucWen`` with an exponent of 2): its force (N) has the same limit in every direction. Two separate springs along
/// x and y act independently: on the diagonal their resultant reaches √2 times the limit. An entry ``(row_x, row_y,
/// row_z, bearing)`` has deformations along x, along y and up, and a `PendulumBearing`.
#[pyclass(name = "WithSprings", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithSprings(
    /// The structure without the springs.
    pub(crate) Py<PyAny>,
);

#[pymethods]
impl PyWithSprings {
    #[new]
    fn new(structure: Bound<'_, PyAny>, springs: SpringList) -> PyResult<PyClassInitializer<Self>> {
        let make_structure = structure_recipe(&structure)?;
        let dof_count = make_structure().or_raise()?.dofs();
        let dof_names = DofNames::from_structure(&structure, dof_count)?;
        let springs =
            springs.0.into_iter().map(|(rows, law)| SpringOrBearing::new(rows, law, dof_count));
        let springs: Vec<SpringOrBearing> = springs.collect::<PyResult<_>>()?;
        let make = move || {
            let mut with_springs = WithSprings::new(make_structure()?);
            for spring in &springs {
                with_springs = match spring {
                    SpringOrBearing::Uniaxial(row, make_law) => {
                        with_springs.spring(row, make_law()?)?
                    }
                    SpringOrBearing::Biaxial(rows, make_spring) => {
                        with_springs.biaxial_spring(rows.each_ref(), make_spring()?)?
                    }
                    SpringOrBearing::Bearing(rows, bearing) => {
                        with_springs.pendulum(rows.each_ref(), bearing.clone())?
                    }
                };
            }
            Ok(with_springs)
        };
        make().or_raise()?;
        let superclass = PyStructure::new(make).with_dof_names(dof_names);
        Ok(PyClassInitializer::from(superclass).add_subclass(Self(structure.unbind())))
    }
}
