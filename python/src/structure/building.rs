//! Shear buildings, in the plane and in plan.

use std::collections::BTreeMap;
use std::sync::Arc;

use basemat::structure::{
    BiaxialSpring, Hysteresis, IsolationLevel, PlanStorey, ShearBuilding, Storey, StoreyBuilding,
    Structure,
};
use pyo3::prelude::*;

use super::PyStructure;
use super::block::{BODY_DOF_NAMES, PyRigidBody};
use super::hysteresis::LawLike;
use crate::array::Count;
use crate::error::{OrRaise, WithOption, input_error};
use crate::list_arguments::ListOf;
use crate::names::DofNames;
use crate::names::choice;
use crate::recipe::{Factory, Recipe};
use crate::row::{PyDofCombination, PySectionRows, python_rows, space_sections};

/// A storey of a `ShearBuilding`, per metre of thickness: ``height`` of its columns (m), ``mass``
/// of the floor above (kg), lateral ``stiffness`` (N/m), ``rotary_inertia`` of the floor (kg m²; 0 by
/// default), ``damping`` by a dashpot between the floors (N s/m; 0 by default).
#[pyclass(name = "Storey", module = "basemat", frozen, dict)]
#[derive(Clone, Copy)]
pub(crate) struct PyStorey(pub(crate) Storey);

#[pymethods]
impl PyStorey {
    #[pyo3(signature = (height, mass, stiffness, *, rotary_inertia=0.0, damping=0.0))]
    #[new]
    fn new(height: f64, mass: f64, stiffness: f64, rotary_inertia: f64, damping: f64) -> Self {
        Self(Storey { height, mass, rotary_inertia, stiffness, damping })
    }
}

/// Recipes of laws by the number of their storey.
type StoreyLaws = BTreeMap<usize, Recipe<dyn Hysteresis>>;

/// Python's argument `laws`: a dict of laws by storey, or None.
type LawsArgument = Option<BTreeMap<i64, LawLike>>;

/// Recipes of laws by the number of their storey.
fn storey_laws(laws: LawsArgument) -> PyResult<StoreyLaws> {
    let mut recipes = StoreyLaws::new();
    for (storey, law) in laws.into_iter().flatten() {
        recipes.insert(storey_number(storey)?, law.0);
    }
    Ok(recipes)
}

/// Number of the storey of a law; an error if it is negative.
fn storey_number(storey: i64) -> PyResult<usize> {
    usize::try_from(storey)
        .map_err(|_| input_error(format!("laws: storey is {storey}, but must be 0 or more")))
}

/// The building whose storeys follow these laws.
fn with_laws(mut building: ShearBuilding, laws: &StoreyLaws) -> basemat::Result<ShearBuilding> {
    for (storey, make_law) in laws {
        building = building.with_law(*storey, make_law()?)?;
    }
    Ok(building)
}

/// Rigid floors on columns that deform in shear, on a rigid base.
///
/// Degrees of freedom: displacement to the right, up, and rotation of the base, then the absolute horizontal
/// displacement of every floor from below; for `dof` "base_x", "base_y", "base_rotation", "floor_0", "floor_1" and so
/// on. ``width`` of the base: m. ``base_mass``: kg/m. ``base_inertia``: kg m²/m. ``storeys``: list of `Storey`, the
/// lowest first. ``damping``: ratio in the first mode on a fixed base, by damping proportional to stiffness; none
/// unless given. ``center``: x of the middle of the base, m; 0 by default. ``p_delta``: gravity (m/s²) of the P–Δ
/// effect; none unless given. ``laws``: dict ``{storey: law}`` of laws (`Hysteresis` or `UserHysteresis`) that replace
/// the stiffness of storeys, storey 0 the lowest; none unless given.
#[pyclass(name = "ShearBuilding", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyShearBuilding(Factory<ShearBuilding>);

/// Names of the degrees of freedom of the base of a shear building.
const BASE_DOF_NAMES: [&str; 3] = ["base_x", "base_y", "base_rotation"];

extends!(PyShearBuilding, building => {
    let make = Arc::clone(&building.0);
    let dof_count = building.model()?.dofs();
    let mut dof_names = BASE_DOF_NAMES.map(String::from).to_vec();
    for storey in 0..dof_count - BASE_DOF_NAMES.len() {
        dof_names.push(format!("floor_{storey}"));
    }
    let dof_names = DofNames::new(dof_names, dof_count)?;
    PyStructure::new(move || make()).with_dof_names(Some(dof_names))
});

impl PyShearBuilding {
    /// A new building of the core.
    pub(crate) fn model(&self) -> PyResult<ShearBuilding> {
        (self.0)().or_raise()
    }
}

#[pymethods]
impl PyShearBuilding {
    #[pyo3(signature = (width, base_mass, base_inertia, storeys, *, damping=None, center=0.0, p_delta=None, laws=None))]
    #[new]
    fn new(
        width: f64,
        base_mass: f64,
        base_inertia: f64,
        storeys: ListOf<'_, PyStorey>,
        damping: Option<f64>,
        center: f64,
        p_delta: Option<f64>,
        laws: LawsArgument,
    ) -> PyResult<PyClassInitializer<Self>> {
        let storeys: Vec<Storey> = storeys.iter().map(|storey| storey.get().0).collect();
        let laws = storey_laws(laws)?;
        let make = move || {
            let building = ShearBuilding::new(width, base_mass, base_inertia, &storeys)?
                .centered_at(center)
                .with(damping, ShearBuilding::with_stiffness_damping)
                .with(p_delta, ShearBuilding::with_p_delta)?;
            with_laws(building, &laws)
        };
        Self(Arc::new(make)).initializer()
    }

    /// The ``building`` with its lowest columns on a slab that rests on isolators of this ``law`` (`Hysteresis` or
    /// `UserHysteresis`). The isolators become storey 0, and the storeys of the building count from 1.
    ///
    /// ``height`` of the bearings: m. ``slab_mass``: kg/m. ``slab_inertia``: kg m²/m; 0 by default. ``damping`` beside
    /// the bearings: N s/m; 0 by default. ``laws``: laws of further storeys, as for the class; none unless given. The
    /// ``building`` must have no laws.
    #[pyo3(signature = (building, law, *, height, slab_mass, slab_inertia=0.0, damping=0.0, laws=None))]
    #[staticmethod]
    fn isolated(
        building: Bound<'_, Self>,
        law: LawLike,
        height: f64,
        slab_mass: f64,
        slab_inertia: f64,
        damping: f64,
        laws: LawsArgument,
    ) -> PyResult<Self> {
        let level = IsolationLevel { height, slab_mass, slab_inertia, damping };
        let make_building = building.get().0.clone();
        let make_law = law.0;
        let upper_laws = storey_laws(laws)?;
        Ok(Self(Arc::new(move || {
            with_laws(make_building()?.isolated(level, make_law()?)?, &upper_laws)
        })))
    }

    /// Mass, kg/m.
    #[getter]
    fn total_mass(&self) -> PyResult<f64> {
        Ok(self.model()?.total_mass())
    }

    /// First natural frequency on a fixed base without P–Δ, Hz.
    #[getter]
    fn fixed_base_frequency(&self) -> PyResult<f64> {
        Ok(self.model()?.fixed_base_frequency())
    }

    /// Number of the degree of freedom of the topmost floor.
    #[getter]
    fn roof(&self) -> PyResult<usize> {
        Ok(self.model()?.roof())
    }

    /// Number of the degree of freedom of the floor above a ``storey`` (0: the lowest).
    fn floor(&self, storey: Count) -> PyResult<usize> {
        self.model()?.floor(storey.0).or_raise()
    }

    /// The `DofCombination` of the drift of a ``storey`` (0: the lowest), m: relative displacement of its two floors,
    /// without the part due to the rotation of the base.
    fn drift(&self, storey: Count) -> PyResult<PyDofCombination> {
        Ok(self.model()?.drift(storey.0).or_raise()?.into())
    }

    /// The `DofCombination` of the displacement of the floor above a ``storey`` (0: the lowest) minus the rigid motion
    /// of the base (displacement and rotation), m.
    fn total_drift(&self, storey: Count) -> PyResult<PyDofCombination> {
        Ok(self.model()?.total_drift(storey.0).or_raise()?.into())
    }

    /// The `SectionRows` of the shear force (N/m) in the columns of a ``storey`` (0: the lowest).
    ///
    /// The upper part of the building exerts this force on the lower part. In a storey with a law the force is computed
    /// from the inertia of the floors above.
    fn shear(&self, storey: Count) -> PyResult<PySectionRows> {
        Ok(self.model()?.shear(storey.0).or_raise()?.into())
    }
}

/// A storey of a `StoreyBuilding`: ``height`` of its columns (m), ``mass`` of the floor above (kg), a rectangle with the
/// ``sides`` along x and y (m), and its ``stiffness``: along x and y (N/m) and against twist about its centre of stiffness (N m).
///
/// ``inertia``: rotary inertia of the floor about x, y and z through its centre of mass (kg m²); unless given, that of
/// the rectangle. ``mass_center`` and ``stiffness_center``: x and y from the middle of the mat, m; (0, 0) by default.
/// ``damping``: dashpots beside the three stiffnesses, N s/m and N m s; 0 by default.
#[pyclass(name = "PlanStorey", module = "basemat", frozen, dict)]
pub(crate) struct PyPlanStorey(PlanStorey);

#[pymethods]
impl PyPlanStorey {
    #[pyo3(
        signature = (height, mass, sides, stiffness, *, inertia=None, mass_center=[0.0; 2], stiffness_center=[0.0; 2], damping=[0.0; 3]),
        text_signature = "(height, mass, sides, stiffness, *, inertia=None, mass_center=(0.0, 0.0), stiffness_center=(0.0, 0.0), damping=(0.0, 0.0, 0.0))"
    )]
    #[new]
    fn new(
        height: f64,
        mass: f64,
        sides: [f64; 2],
        stiffness: [f64; 3],
        inertia: Option<[f64; 3]>,
        mass_center: [f64; 2],
        stiffness_center: [f64; 2],
        damping: [f64; 3],
    ) -> Self {
        let storey = PlanStorey::new(height, mass, sides, stiffness);
        let inertia = inertia.unwrap_or(storey.inertia);
        Self(PlanStorey { inertia, mass_center, stiffness_center, damping, ..storey })
    }
}

/// Directions of the laws of storeys in plan; `None` for a coupled law along x and y.
const LAW_DIRECTIONS: [(&str, Option<usize>); 4] = [
    ("x", Some(StoreyBuilding::DIRECTION_ALONG)),
    ("y", Some(StoreyBuilding::DIRECTION_ACROSS)),
    ("xy", None),
    ("twist", Some(StoreyBuilding::DIRECTION_TWIST)),
];

/// A law of a storey in plan.
enum StoreyLaw {
    Uniaxial(usize, Recipe<dyn Hysteresis>),
    Biaxial(Factory<BiaxialSpring>),
}

/// Building with rigid floors on a rigid mat, in space.
///
/// The floors stand on flexible columns and walls, and these stand on the ``mat`` (`RigidBody`). Floors move along x
/// and y and twist, and tilt with the mat.
///
/// Degrees of freedom: the six of the mat, then the absolute displacements along x and y and the rotation about z of
/// every floor from below, at its point above the middle of the mat; for `dof` "x", "y", "z", "rx", "ry", "rz",
/// "floor_0_x", "floor_0_y", "floor_0_rz", "floor_1_x" and so on. ``storeys``: list of `PlanStorey`, the lowest first.
/// ``p_delta``: gravity (m/s²) of the P–Δ effect; none unless given. ``laws``: dict ``{(storey, direction): law}`` of
/// laws (`Hysteresis` or `UserHysteresis`) that replace a stiffness, direction "x", "y" or "twist"; none unless given.
/// In the direction "xy" a `Hysteresis` acts along x and y together (``BoucWen`` with an exponent of 2): its force has
/// the same limit in every direction. Two laws along x and y act independently: on the diagonal their resultant reaches
/// √2 times the limit.
#[pyclass(name = "StoreyBuilding", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyStoreyBuilding(Factory<StoreyBuilding>);

/// Names of the degrees of freedom of a floor in plan.
const FLOOR_DOF_NAMES: [&str; 3] = ["x", "y", "rz"];

extends!(PyStoreyBuilding, building => {
    let make = Arc::clone(&building.0);
    let dof_count = building.model()?.dofs();
    let mut dof_names = BODY_DOF_NAMES.map(String::from).to_vec();
    for storey in 0..(dof_count - BODY_DOF_NAMES.len()) / FLOOR_DOF_NAMES.len() {
        dof_names.extend(FLOOR_DOF_NAMES.map(|name| format!("floor_{storey}_{name}")));
    }
    PyStructure::new(move || make()).with_dof_names(Some(DofNames::new(dof_names, dof_count)?))
});

impl PyStoreyBuilding {
    /// A new building of the core.
    pub(crate) fn model(&self) -> PyResult<StoreyBuilding> {
        (self.0)().or_raise()
    }
}

#[pymethods]
impl PyStoreyBuilding {
    #[pyo3(signature = (mat, storeys, *, p_delta=None, laws=None))]
    #[new]
    fn new(
        mat: &PyRigidBody,
        storeys: ListOf<'_, PyPlanStorey>,
        p_delta: Option<f64>,
        laws: Option<BTreeMap<(i64, String), LawLike>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let storeys: Vec<PlanStorey> = storeys.iter().map(|storey| storey.get().0).collect();
        let mat = mat.0.clone();
        let laws = laws.into_iter().flatten().map(|((storey, direction), law)| {
            let law = match choice("direction of a law", &direction, &LAW_DIRECTIONS)? {
                Some(direction) => StoreyLaw::Uniaxial(direction, law.0),
                None => StoreyLaw::Biaxial(law.coupled()?),
            };
            Ok((storey_number(storey)?, law))
        });
        let laws: Vec<_> = laws.collect::<PyResult<_>>()?;
        let make = move || {
            let building = StoreyBuilding::new(mat.clone(), &storeys);
            let mut building = building.with(p_delta, StoreyBuilding::with_p_delta)?;
            for (storey, law) in &laws {
                building = match law {
                    StoreyLaw::Uniaxial(direction, make_law) => {
                        building.with_law(*storey, *direction, make_law()?)?
                    }
                    StoreyLaw::Biaxial(make_spring) => {
                        building.with_biaxial_law(*storey, make_spring()?)?
                    }
                };
            }
            Ok(building)
        };
        Self(Arc::new(make)).initializer()
    }

    /// Mass of mat and floors, kg.
    #[getter]
    fn total_mass(&self) -> PyResult<f64> {
        Ok(self.model()?.total_mass())
    }

    /// The three `DofCombination` of the displacements along x and y and of the twist of the floor above a ``storey``
    /// (0: the lowest) at a ``place`` (x and y from the middle of the mat, m; the middle by default).
    #[pyo3(signature = (storey, place=[0.0; 2]), text_signature = "($self, storey, place=(0.0, 0.0))")]
    fn floor(&self, storey: Count, place: [f64; 2]) -> PyResult<[PyDofCombination; 3]> {
        Ok(python_rows(self.model()?.floor(storey.0, place).or_raise()?))
    }

    /// The three `DofCombination` of the deformation of a ``storey`` (0: the lowest), drifts along x and y (m) and twist,
    /// at a ``place`` (x and y from the middle of the mat, m); at its centre of stiffness unless given.
    #[pyo3(signature = (storey, place=None))]
    fn drift(&self, storey: Count, place: Option<[f64; 2]>) -> PyResult<[PyDofCombination; 3]> {
        let rows = match place {
            Some(place) => self.model()?.drift_at(storey.0, place),
            None => self.model()?.drift(storey.0),
        };
        Ok(python_rows(rows.or_raise()?))
    }

    /// The three `DofCombination` of the displacements along x and y and of the twist of the floor above a ``storey``
    /// (0: the lowest) minus the rigid motion of the mat, at a ``place`` as for `floor`.
    #[pyo3(signature = (storey, place=[0.0; 2]), text_signature = "($self, storey, place=(0.0, 0.0))")]
    fn total_drift(&self, storey: Count, place: [f64; 2]) -> PyResult<[PyDofCombination; 3]> {
        Ok(python_rows(self.model()?.total_drift(storey.0, place).or_raise()?))
    }

    /// The three `SectionRows` of the forces along x and y (N) that the floor above a ``storey`` (0: the lowest) exerts
    /// on the part below, and of their torque about the centre of stiffness (N·m), computed from the inertia of the
    /// floors above.
    fn shear(&self, storey: Count) -> PyResult<[PySectionRows; 3]> {
        Ok(self.model()?.shear(storey.0).or_raise()?.map(PySectionRows::from))
    }

    /// The six `SectionRows` of shear along x and along y (N), compression (N), moments about x and about y (N·m) and
    /// torque about z (N·m) that the floors above exert on the part below the foot of a ``storey`` (0: the lowest),
    /// computed from the inertia of these floors. Moments are about ``reference`` (x and y from the middle of the mat,
    /// m; the middle by default) at the foot.
    #[pyo3(signature = (storey, reference=[0.0; 2]), text_signature = "($self, storey, reference=(0.0, 0.0))")]
    fn section(&self, storey: Count, reference: [f64; 2]) -> PyResult<[PySectionRows; 6]> {
        Ok(space_sections(self.model()?.section(storey.0, reference).or_raise()?))
    }
}
