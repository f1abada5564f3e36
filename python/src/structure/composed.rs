//! Structures that consist of other structures: reduced models, groups, modal damping and walls; and Rayleigh damping.

use std::sync::Arc;

use basemat::structure::{
    CraigBampton, ModalDamping, RayleighDamping, ReducedModel, Structure, StructureGroup, WithWalls,
};
use pyo3::prelude::*;

use super::{PyStructure, structure_recipe};
use crate::array::{Array, Count, Numbers, whole_numbers};
use crate::base_node::{PyBaseNode, python_nodes, structure_nodes};
use crate::error::{OrRaise, WithOption, input_error};
use crate::list_arguments::{ListOf, PairList};
use crate::names::DofNames;
use crate::recipe::{Factory, Recipe, SharedStructure};
use crate::row::{PyDofCombination, RowLike};

/// Rayleigh damping by a damping matrix a M + b K.
///
/// ``mass``: factor a of the mass matrix, 1/s. ``stiffness``: factor b of the stiffness matrix, s.
#[pyclass(name = "RayleighDamping", module = "basemat", frozen, dict)]
pub(crate) struct PyRayleighDamping(pub(super) RayleighDamping);

#[pymethods]
impl PyRayleighDamping {
    #[new]
    fn new(mass: f64, stiffness: f64) -> PyResult<Self> {
        Ok(Self(RayleighDamping::new(mass, stiffness).or_raise()?))
    }

    /// Rayleigh damping with the damping ``ratios`` (a pair) at two ``frequencies`` (a pair, Hz).
    #[staticmethod]
    fn from_ratios(frequencies: [f64; 2], ratios: [f64; 2]) -> PyResult<Self> {
        RayleighDamping::from_ratios(frequencies, ratios).or_raise().map(Self)
    }

    /// Factor of the mass, 1/s.
    #[getter]
    fn mass(&self) -> f64 {
        self.0.mass()
    }

    /// Factor of the stiffness, s.
    #[getter]
    fn stiffness(&self) -> f64 {
        self.0.stiffness()
    }

    /// Damping ratio at a ``frequency`` (Hz).
    fn ratio(&self, frequency: f64) -> f64 {
        self.0.ratio(frequency)
    }
}

/// A ``structure`` reduced by the method of Craig and Bampton.
///
/// The reduced degrees of freedom are the degrees of freedom of the contact nodes, those in the list ``keep`` (none
/// unless given), and the amplitudes of the lowest ``modes`` modes of the remaining structure. ``damping_ratio`` of
/// these modes replaces the damping of the structure, if given.
#[pyclass(name = "ReducedModel", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyReducedModel {
    pub(crate) model: Arc<ReducedModel>,
    /// The full structure.
    pub(crate) structure: Py<PyAny>,
}

#[pymethods]
impl PyReducedModel {
    #[pyo3(signature = (structure, modes, *, keep=None, damping_ratio=None))]
    #[new]
    fn new(
        structure: Bound<'_, PyAny>,
        modes: Count,
        #[pyo3(from_py_with = whole_numbers)] keep: Option<Vec<usize>>,
        damping_ratio: Option<f64>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let py = structure.py();
        let full_structure = structure_recipe(&structure)?().or_raise()?;
        let reduction = CraigBampton::new(modes.0).keep(&keep.unwrap_or_default());
        let reduced_model = py.detach(move || {
            reduction
                .reduce(full_structure)
                .with(damping_ratio, ReducedModel::with_damping_ratio)
        });
        let reduced_model = Arc::new(reduced_model.or_raise()?);
        let superclass = PyStructure::from_structure(SharedStructure {
            structure: Arc::clone(&reduced_model),
            dof_names: None,
        });
        let model = Self { model: reduced_model, structure: structure.unbind() };
        Ok(PyClassInitializer::from(superclass).add_subclass(model))
    }

    /// Frequencies of the modes: array of shape (modes,), Hz.
    #[getter]
    fn frequencies(&self) -> Array {
        self.model.frequencies().into()
    }

    /// A ``row`` of the full structure as a `DofCombination` of the reduced structure, for a probe or a load.
    fn row(&self, row: RowLike) -> PyResult<PyDofCombination> {
        row.1.check("the row", self.model.recovery().full_dofs())?;
        Ok(self.model.recovery().row(row.0).or_raise()?.into())
    }

    /// Degrees of freedom of the full structure, array of shape (n,), m and rad, from those of the
    /// ``reduced`` one, array of shape (dofs,).
    fn full(&self, reduced: Numbers) -> PyResult<Array> {
        self.model.recovery().full(&reduced.0).or_raise().map(Array::from)
    }
}

/// Several structures on one ground, coupled through the soil.
///
/// ``members``: list of pairs ``(structure, shift)`` from left to right, each moved to the right by its shift (m); in
/// plan in any order, without overlap; their positions along y are unchanged (``center`` of `RigidBody.cuboid`).
/// ``above``: list of pairs ``(structure, (shift, height))`` of structures in the plane that touch no ground, each moved
/// to the right and upwards (m), none unless given. They stand on others by joints (`Joint`), and count after the members.
#[pyclass(name = "StructureGroup", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyStructureGroup {
    pub(crate) make: Factory<StructureGroup>,
    /// Structures and their shifts to the right and upwards, m: those on the ground, then those above.
    pub(crate) members: Vec<(Py<PyAny>, [f64; 2])>,
    /// Number of degrees of freedom of each structure.
    dof_counts: Vec<usize>,
}

#[pymethods]
impl PyStructureGroup {
    #[new]
    #[pyo3(signature = (members, above=None))]
    fn new(
        members: PairList<Bound<'_, PyAny>, f64>,
        above: Option<PairList<Bound<'_, PyAny>, [f64; 2]>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let ground_count = members.0.len();
        let on_ground = members.0.into_iter().map(|(structure, shift)| (structure, [shift, 0.0]));
        let above = above.map(|above| above.0).unwrap_or_default();
        let members: Vec<_> = on_ground.chain(above).collect();
        let mut recipes: Vec<(Recipe<dyn Structure>, [f64; 2])> = Vec::with_capacity(members.len());
        for (structure, shift) in &members {
            recipes.push((structure_recipe(structure)?, *shift));
        }
        if ground_count == 0 {
            return Err(input_error("a group needs at least one structure on the ground"));
        }
        let dof_counts = recipes.iter().map(|(make_structure, _)| Ok(make_structure()?.dofs()));
        let dof_counts = dof_counts.collect::<basemat::Result<_>>().or_raise()?;
        let make = Arc::new(move || {
            let mut group = StructureGroup::new();
            for (member, (make_structure, offset)) in recipes.iter().enumerate() {
                let structure = make_structure()?;
                group = if member < ground_count {
                    group.with(structure, offset[0])?
                } else {
                    group.with_above(structure, *offset)?
                };
            }
            Ok(group)
        });
        make().or_raise()?;
        let make_group = Arc::clone(&make);
        let superclass = PyStructure::new(move || make_group());
        let members = members.into_iter().map(|(structure, offset)| (structure.unbind(), offset));
        let group = Self { make, members: members.collect(), dof_counts };
        Ok(PyClassInitializer::from(superclass).add_subclass(group))
    }

    /// A ``row`` of the structure ``member`` (0: the first) as a `DofCombination` of the group.
    fn row(&self, member: Count, row: RowLike) -> PyResult<PyDofCombination> {
        if let Some(dof_count) = self.dof_counts.get(member.0) {
            row.1.check("the row", *dof_count)?;
        }
        Ok((self.make)().or_raise()?.row(member.0, row.0).or_raise()?.into())
    }

    /// Contact ``nodes`` (list of `BaseNode`) of the structure ``member`` (0: the first) as nodes of the group, a list, for
    /// a `Joint`.
    fn contact_nodes(
        &self,
        member: Count,
        nodes: ListOf<'_, PyBaseNode>,
    ) -> PyResult<Vec<PyBaseNode>> {
        let nodes = nodes.iter().map(|node| node.get().clone()).collect();
        let mut lines = structure_nodes(vec![nodes], self.dof_counts.get(member.0).copied())?;
        let nodes = lines.pop().unwrap_or_default();
        let nodes = (self.make)().or_raise()?.contact_nodes(member.0, nodes).or_raise()?;
        Ok(python_nodes(nodes))
    }
}

/// A ``structure`` with additional damping of its modes.
///
/// ``ratios``: damping ratios of the modes (array of shape (m,)), the lowest mode first; the last ratio is that of all
/// further modes.
///
/// With ``fixed_base`` the modes are those on a fixed base, as in codes and tests. Without it (the default) they are
/// those of the free structure, whose frequencies are far higher: with a ratio of 5 %, the first mode of five storeys
/// on a base then has 0.9 %.
#[pyclass(name = "WithModalDamping", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithModalDamping {
    frequencies: Vec<f64>,
    /// The structure without this damping.
    pub(crate) structure: Py<PyAny>,
}

#[pymethods]
impl PyWithModalDamping {
    #[pyo3(signature = (structure, ratios, *, fixed_base = false))]
    #[new]
    fn new(
        structure: Bound<'_, PyAny>,
        ratios: Numbers,
        fixed_base: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let py = structure.py();
        let make_structure = structure_recipe(&structure)?;
        let undamped_structure = make_structure().or_raise()?;
        let dof_names = DofNames::from_structure(&structure, undamped_structure.dofs())?;
        let damping = ModalDamping::new(&ratios.0).or_raise()?;
        let add_damping = move |structure| {
            if fixed_base { damping.on_fixed_base(structure) } else { damping.on(structure) }
        };
        // Modes of a large structure take seconds.
        let damped_structure = py.detach(|| add_damping(undamped_structure)).or_raise()?;
        let frequencies = damped_structure.frequencies().to_vec();
        let superclass =
            PyStructure::new(move || add_damping(make_structure()?)).with_dof_names(dof_names);
        let model = Self { frequencies, structure: structure.unbind() };
        Ok(PyClassInitializer::from(superclass).add_subclass(model))
    }

    /// Frequencies of the modes that are not rigid: array of shape (modes,), Hz.
    #[getter]
    fn frequencies(&self) -> Array {
        self.frequencies.as_slice().into()
    }
}

/// A ``structure`` in the ground: its rigid base lies at a ``depth`` (m) and has walls up to the surface.
///
/// The structure is the same as on the surface: its heights are relative to the base. The ground is a `TrenchGround` of
/// this width and depth. A structure with a flexible base needs no `WithWalls`: its ``base`` lists the nodes down the
/// left wall, along the base and up the right wall, with their heights ``z`` (`BaseNode`).
#[pyclass(name = "WithWalls", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithWalls {
    /// The structure without walls.
    pub(crate) structure: Py<PyAny>,
    /// Depth of the base, m.
    pub(crate) depth: f64,
}

#[pymethods]
impl PyWithWalls {
    #[new]
    fn new(structure: Bound<'_, PyAny>, depth: f64) -> PyResult<PyClassInitializer<Self>> {
        let make_structure = structure_recipe(&structure)?;
        let with_walls = WithWalls::new(make_structure().or_raise()?, depth).or_raise()?;
        let dof_names = DofNames::from_structure(&structure, with_walls.dofs())?;
        let superclass = PyStructure::new(move || WithWalls::new(make_structure()?, depth))
            .with_dof_names(dof_names);
        let model = Self { structure: structure.unbind(), depth };
        Ok(PyClassInitializer::from(superclass).add_subclass(model))
    }

    /// Depth of the base, m.
    #[getter]
    fn depth(&self) -> f64 {
        self.depth
    }
}
