//! Shear buildings.

use std::collections::BTreeMap;
use std::sync::Arc;

use basemat::structure::{Hysteresis, IsolationLevel, ShearBuilding, Storey, Structure};
use pyo3::prelude::*;

use super::PyStructure;
use super::hysteresis::LawLike;
use crate::array::whole;
use crate::dof_names::DofNames;
use crate::error::{OrRaise, refuse};
use crate::recipe::Recipe;
use crate::row::{PyDofCombination, PySectionRows};

/// A storey of a :class:`ShearBuilding`, per metre of thickness: ``height`` of its columns (m), ``mass``
/// of the floor above (kg), lateral ``stiffness`` (N/m), ``rotary_inertia`` of the floor (kg m²; 0 by
/// default), ``damping`` by a dashpot between the floors (N s/m; 0 by default).
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

type Laws = BTreeMap<usize, Recipe<dyn Hysteresis>>;

/// Laws by storey, as Python gives them.
type GivenLaws = Option<BTreeMap<i64, LawLike>>;

/// Recipes of laws by storey.
fn recipes(laws: GivenLaws) -> PyResult<Laws> {
    let own = |(storey, LawLike(law)): (i64, LawLike)| {
        let storey = usize::try_from(storey)
            .map_err(|_| refuse(format!("laws: storey is {storey}, but must be 0 or more")))?;
        Ok((storey, law))
    };
    laws.into_iter().flatten().map(own).collect()
}

/// The building with its laws.
fn following(mut building: ShearBuilding, laws: &Laws) -> basemat::Result<ShearBuilding> {
    for (storey, law) in laws {
        building = building.with_law(*storey, law()?)?;
    }
    Ok(building)
}

/// Rigid floors on columns that shear, on a rigid base.
///
/// Degrees of freedom: displacement to the right, up, and rotation of the base, then the absolute
/// horizontal displacement of every floor from below; for :meth:`dof` "base x", "base y", "base rotation",
/// "floor 0", "floor 1" and so on. ``width`` of the base: m. ``base_mass``: kg/m.
/// ``base_inertia``: kg m²/m. ``storeys``: list of :class:`Storey`, the lowest first. ``damping``: ratio
/// in the first mode on a fixed base, by damping proportional to stiffness; none unless given.
/// ``center``: x of the middle of the base, m; 0 by default. ``p_delta``: gravity (m/s²) of the P–Δ
/// effect; none unless given. ``laws``: dict ``{storey: law}`` of laws (:class:`Hysteresis`, or your own:
/// :class:`UserHysteresis`) that take the place of the stiffness of storeys, storey 0 the lowest; none
/// unless given.
#[pyclass(name = "ShearBuilding", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyShearBuilding(Make);

type Make = Arc<dyn Fn() -> basemat::Result<ShearBuilding> + Send + Sync>;

impl PyShearBuilding {
    /// Of a recipe that works.
    fn of(
        make: impl Fn() -> basemat::Result<ShearBuilding> + Send + Sync + 'static,
    ) -> PyResult<PyClassInitializer<Self>> {
        let make: Make = Arc::new(make);
        let floors = make().or_raise()?.dofs() - 3;
        let base = ["base x", "base y", "base rotation"].map(String::from);
        let names = base.into_iter().chain((0..floors).map(|storey| format!("floor {storey}")));
        let names = DofNames::new(names.collect(), 3 + floors)?;
        let own = Arc::clone(&make);
        let base = PyStructure::new(Arc::new(move || Ok(Box::new(own()?)))).named(Some(names));
        Ok(PyClassInitializer::from(base).add_subclass(Self(make)))
    }

    fn made(&self) -> PyResult<ShearBuilding> {
        (self.0)().or_raise()
    }
}

getters! {
    PyShearBuilding, own;
    /// Mass, kg/m.
    total_mass: PyResult<f64> = Ok(own.made()?.total_mass());
    /// First natural frequency on a fixed base without P–Δ, Hz.
    fixed_base_frequency: PyResult<f64> = Ok(own.made()?.fixed_base_frequency());
    /// Number of the degree of freedom of the topmost floor.
    roof: PyResult<usize> = Ok(own.made()?.roof());
}

#[pymethods]
impl PyShearBuilding {
    #[new]
    #[pyo3(signature = (width, base_mass, base_inertia, storeys, *, damping=None, center=0.0, p_delta=None, laws=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords in Python")]
    fn new(
        width: f64,
        base_mass: f64,
        base_inertia: f64,
        storeys: Vec<Bound<'_, PyStorey>>,
        damping: Option<f64>,
        center: f64,
        p_delta: Option<f64>,
        laws: GivenLaws,
    ) -> PyResult<PyClassInitializer<Self>> {
        let storeys: Vec<Storey> = storeys.iter().map(|storey| storey.get().0).collect();
        let laws = recipes(laws)?;
        Self::of(move || {
            let mut building = ShearBuilding::new(width, base_mass, base_inertia, &storeys)?
                .centered_at(center)?;
            if let Some(ratio) = damping {
                building = building.with_stiffness_damping(ratio)?;
            }
            if let Some(gravity) = p_delta {
                building = building.with_p_delta(gravity)?;
            }
            following(building, &laws)
        })
    }

    /// The ``building`` with its lowest columns on a slab that rests on isolators of this ``law``
    /// (:class:`Hysteresis` or :class:`UserHysteresis`); they become storey 0, and the building's storeys count from 1.
    ///
    /// ``height`` of the bearings: m. ``slab_mass``: kg/m. ``slab_inertia``: kg m²/m; 0 by default.
    /// ``damping`` beside the bearings: N s/m; 0 by default. ``laws``: of further storeys, as for the
    /// class; none unless given. The building must have none.
    #[staticmethod]
    #[pyo3(signature = (building, law, *, height, slab_mass, slab_inertia=0.0, damping=0.0, laws=None))]
    fn isolated(
        building: Bound<'_, Self>,
        law: LawLike,
        height: f64,
        slab_mass: f64,
        slab_inertia: f64,
        damping: f64,
        laws: GivenLaws,
    ) -> PyResult<Py<Self>> {
        let level = IsolationLevel { height, slab_mass, slab_inertia, damping };
        let (make, own, laws) = (building.get().0.clone(), law.0, recipes(laws)?);
        let made = Self::of(move || following(make()?.isolated(level, own()?)?, &laws))?;
        Py::new(building.py(), made)
    }

    /// Number of the degree of freedom of the floor above a ``storey`` (0: the lowest).
    fn floor(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<usize> {
        self.made()?.floor(storey).or_raise()
    }

    /// The :class:`DofCombination` of the drift of a ``storey`` (0: the lowest), m: its floors' relative
    /// displacement less what the base's rotation makes of it.
    fn drift(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<PyDofCombination> {
        Ok(self.made()?.drift(storey).or_raise()?.into())
    }

    /// The :class:`DofCombination` of the displacement of the floor above a ``storey`` (0: the lowest)
    /// less the motion of the base, its rotation included, m.
    fn total_drift(
        &self,
        #[pyo3(from_py_with = whole)] storey: usize,
    ) -> PyResult<PyDofCombination> {
        Ok(self.made()?.total_drift(storey).or_raise()?.into())
    }

    /// The :class:`SectionRows` of the force (N/m) of what is above the columns of a ``storey`` (0: the
    /// lowest) on what is below; of a storey that follows a law, from the inertia above.
    fn shear(&self, #[pyo3(from_py_with = whole)] storey: usize) -> PyResult<PySectionRows> {
        Ok(self.made()?.shear(storey).or_raise()?.into())
    }
}
