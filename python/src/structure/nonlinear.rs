//! Buildings that yield or stand on isolators, and structures with hysteretic springs.

use std::collections::BTreeMap;
use std::sync::Arc;

use basemat::structure::{
    Hysteresis, IsolationLevel, NonlinearShearBuilding, Row, ShearBuilding, Structure, WithSprings,
};
use pyo3::prelude::*;

use super::hysteresis::PyHysteresis;
use super::{PyShearBuilding, PyStructure, recipe};
use crate::array::whole;
use crate::error::OrRaise;
use crate::recipe::Recipe;
use crate::row::{PyRow, PySectionRows, RowLike};

/// A :class:`ShearBuilding` some of whose storeys follow a :class:`Hysteresis` law:
/// ``laws={storey: law}``, storey 0 the lowest. The law takes the place of the storey's stiffness.
#[pyclass(name = "NonlinearShearBuilding", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyNonlinearShearBuilding(Make);

type Make = Arc<dyn Fn() -> basemat::Result<NonlinearShearBuilding> + Send + Sync>;

type Laws = BTreeMap<usize, Recipe<dyn Hysteresis>>;

/// The building, new, on isolators if there are any.
fn made(
    building: &ShearBuilding,
    isolation: Option<&(IsolationLevel, Recipe<dyn Hysteresis>)>,
    laws: &Laws,
) -> basemat::Result<NonlinearShearBuilding> {
    let mut own = match isolation {
        Some((level, law)) => NonlinearShearBuilding::isolated(building.clone(), *level, law()?)?,
        None => NonlinearShearBuilding::new(building.clone()),
    };
    for (storey, law) in laws {
        own = own.with_law(*storey, law()?)?;
    }
    Ok(own)
}

fn building(
    building: &PyShearBuilding,
    isolation: Option<(IsolationLevel, Recipe<dyn Hysteresis>)>,
    laws: Option<BTreeMap<usize, Bound<'_, PyHysteresis>>>,
) -> PyResult<PyClassInitializer<PyNonlinearShearBuilding>> {
    let laws: Laws =
        laws.into_iter().flatten().map(|(storey, law)| (storey, law.get().make.clone())).collect();
    let building = building.0.clone();
    let make: Make = Arc::new(move || made(&building, isolation.as_ref(), &laws));
    make().or_raise()?;
    let own = Arc::clone(&make);
    let base = PyStructure { make: Arc::new(move || Ok(Box::new(own()?))) };
    Ok(PyClassInitializer::from(base).add_subclass(PyNonlinearShearBuilding(make)))
}

#[pymethods]
impl PyNonlinearShearBuilding {
    #[new]
    fn new(
        building: Bound<'_, PyShearBuilding>,
        laws: BTreeMap<usize, Bound<'_, PyHysteresis>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        self::building(building.get(), None, Some(laws))
    }

    /// The building with its lowest columns on a slab that rests on isolators of this ``law``; they
    /// become storey 0, and the building's storeys count from 1. ``height`` of the bearings in m,
    /// ``slab_mass`` in kg/m, ``slab_inertia`` in kg m²/m, ``damping`` beside the bearings in
    /// N s/m. ``laws``: of further storeys.
    #[staticmethod]
    #[pyo3(signature = (building, law, *, height, slab_mass, slab_inertia=0.0, damping=0.0, laws=None))]
    fn isolated(
        building: Bound<'_, PyShearBuilding>,
        law: Bound<'_, PyHysteresis>,
        height: f64,
        slab_mass: f64,
        slab_inertia: f64,
        damping: f64,
        laws: Option<BTreeMap<usize, Bound<'_, PyHysteresis>>>,
    ) -> PyResult<Py<Self>> {
        let level = IsolationLevel { height, slab_mass, slab_inertia, damping };
        let isolation = Some((level, law.get().make.clone()));
        Py::new(law.py(), self::building(building.get(), isolation, laws)?)
    }

    /// Mass, kg/m.
    #[getter]
    fn total_mass(&self) -> PyResult<f64> {
        Ok((self.0)().or_raise()?.building().total_mass())
    }

    /// Unknown of the topmost floor.
    #[getter]
    fn roof(&self) -> PyResult<usize> {
        Ok((self.0)().or_raise()?.building().roof())
    }

    /// Unknown of the floor above a storey.
    fn floor(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<usize> {
        (self.0)().or_raise()?.building().floor(storey).or_raise()
    }

    /// Drift of a storey, m.
    fn drift(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<PyRow> {
        Ok((self.0)().or_raise()?.building().drift(storey).or_raise()?.into())
    }

    /// Displacement of a storey's floor less the motion of the base, m.
    fn sway(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<PyRow> {
        Ok((self.0)().or_raise()?.building().sway(storey).or_raise()?.into())
    }

    /// Force of what is above a storey's columns on what is below, N/m, from the inertia above.
    fn shear(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<PySectionRows> {
        Ok((self.0)().or_raise()?.shear(storey).or_raise()?.into())
    }
}

/// A structure with hysteretic springs: pairs ``(row, law)``, each spring sees the deformation of
/// its row (m).
#[pyclass(name = "WithSprings", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithSprings;

#[pymethods]
impl PyWithSprings {
    #[new]
    fn new(
        structure: Bound<'_, PyAny>,
        springs: Vec<(RowLike, Bound<'_, PyHysteresis>)>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let structure = recipe(&structure)?;
        let unknowns = structure().or_raise()?.unknowns();
        let springs: Vec<(Row, Recipe<dyn Hysteresis>)> = springs
            .into_iter()
            .map(|(RowLike(row, order), law)| {
                order.check("the row of a spring", unknowns)?;
                Ok((row, law.get().make.clone()))
            })
            .collect::<PyResult<_>>()?;
        let make = move || {
            let mut own = WithSprings::new(structure()?);
            for (row, law) in &springs {
                own = own.spring(row, law()?)?;
            }
            Ok(Box::new(own) as Box<_>)
        };
        make().or_raise()?;
        Ok(PyClassInitializer::from(PyStructure { make: Arc::new(make) }).add_subclass(Self))
    }
}
