//! Finite-element models, and meshes from Gmsh.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use basemat::fem::SharedMaterial;
use basemat::io::GmshMesh;
use basemat::structure::FemModel;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use super::PyStructure;
use super::composed::PyRayleighDamping;
use super::layer::{formulation, stabilisation_percent};
use super::mesh::{PyMesh, direction};
use super::solid_material::SolidLike;
use crate::array::{Array, Count, whole_numbers};
use crate::base_node::{PyBaseNode, python_nodes};
use crate::error::{OrRaise, WithOption, input_error};
use crate::recipe::SharedStructure;
use crate::row::{PyDofCombination, PySectionRows, space_sections};

/// A finite-element structure.
///
/// ``mesh``: a `Mesh`. ``contact``: numbers of the nodes that touch the ground from left to right; a list of such lists
/// for separate foundations; all lowest nodes unless given. In space: a list of faces, each by its corner nodes, shells
/// with their underside; all faces at the lowest height unless given. ``in_trench``: whether ``contact`` is the outline
/// of walls and base in a trench, down the left wall, along the base and up the right wall, in a mesh whose y counts
/// from the surface; False by default. ``on_soil_at_rest``: whether the outline is that of the soil at rest in the mesh
/// (`Mesh.with_stress_at_rest`), which fills a trench, in place of ``contact``; False by default. ``rayleigh``: `RayleighDamping`; none unless given. ``mass``: matrix of masses,
/// "consistent" (the default) or "lumped". ``rigid_links``: list of pairs (leader, followers) of nodes that move as one
/// body; none unless given. ``diaphragms``: list of such pairs in space, whose nodes at one height follow the leader
/// along x, along y and about z; none unless given. ``ties``: list of such pairs, whose nodes at one height have the
/// displacements of the leader, as both sides of a soil column; none unless given. ``p_delta``: gravity (m/s²) for the
/// weight whose static forces cause the P–Δ effect; none unless given. ``active_damping``: whether damping may add
/// energy; by default such damping is an error. ``active_stiffness``: whether matrices of elements may be unsymmetric;
/// by default such matrices are an error.
///
/// Elements whose material yields act by a nonlinear force: the matrix of `stiffness` contains the linear elements
/// only. Each simulation starts from the undeformed model; `Simulation.solid_points` returns stresses and plastic
/// strains.
#[pyclass(name = "FemModel", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyFemModel(pub(crate) Arc<FemModel>);

/// Node numbers of the base, of each foundation, or of each face.
enum Contact {
    Nodes(Vec<usize>),
    Lines(Vec<Vec<usize>>),
}

extracts!(Contact, object => match object.extract() {
    Ok(lines) => Ok(Self::Lines(lines)),
    Err(_) => Ok(Self::Nodes(whole_numbers(&object)?)),
});

#[pymethods]
impl PyFemModel {
    #[new]
    #[pyo3(signature = (mesh, contact=None, *, in_trench=false, on_soil_at_rest=false, rayleigh=None, mass="consistent", rigid_links=None, diaphragms=None, ties=None, p_delta=None, active_damping=false, active_stiffness=false))]
    fn new(
        mesh: &PyMesh,
        contact: Option<Contact>,
        in_trench: bool,
        on_soil_at_rest: bool,
        rayleigh: Option<&PyRayleighDamping>,
        mass: &str,
        #[pyo3(from_py_with = whole_numbers)] rigid_links: Option<Vec<(usize, Vec<usize>)>>,
        #[pyo3(from_py_with = whole_numbers)] diaphragms: Option<Vec<(usize, Vec<usize>)>>,
        #[pyo3(from_py_with = whole_numbers)] ties: Option<Vec<(usize, Vec<usize>)>>,
        p_delta: Option<f64>,
        active_damping: bool,
        active_stiffness: bool,
    ) -> PyResult<PyClassInitializer<Self>> {
        let has_depth = mesh.has_depth();
        let mesh = mesh.0.clone();
        let model = match contact {
            None if on_soil_at_rest => FemModel::on_soil_at_rest(mesh),
            Some(_) if on_soil_at_rest => {
                let requirement = "with on_soil_at_rest, contact is the outline of the soil: give only one of them";
                return Err(input_error(requirement));
            }
            Some(Contact::Nodes(outline)) if in_trench => FemModel::in_trench(mesh, &outline),
            _ if in_trench => {
                return Err(input_error("in a trench, contact is the list of the outline's nodes"));
            }
            None => FemModel::on_base(mesh),
            // A single face may be given without a list.
            Some(Contact::Nodes(face)) if has_depth => FemModel::on_faces(mesh, &[face]),
            Some(Contact::Lines(faces)) if has_depth => FemModel::on_faces(mesh, &faces),
            Some(Contact::Nodes(nodes)) => FemModel::new(mesh, &nodes),
            Some(Contact::Lines(lines)) => FemModel::on_foundations(mesh, &lines),
        };
        let mut model = model
            .with(Some(mass), |model, mass| Ok(model.with_mass(mass.parse()?)))
            .with(rayleigh, |model, damping| Ok(model.with_rayleigh(damping.0)));
        for (leader, followers) in rigid_links.into_iter().flatten() {
            model = model.and_then(|model| model.with_rigid_link(leader, &followers));
        }
        for (leader, followers) in diaphragms.into_iter().flatten() {
            model = model.and_then(|model| model.with_rigid_diaphragm(leader, &followers));
        }
        for (leader, followers) in ties.into_iter().flatten() {
            model = model.and_then(|model| model.with_tied_nodes(leader, &followers));
        }
        let mut model = model.with(p_delta, FemModel::with_p_delta).or_raise()?;
        if active_damping {
            model = model.with_active_damping();
        }
        if active_stiffness {
            model = model.with_active_stiffness();
        }
        let model = Arc::new(model);
        let superclass = if model.inelastic_elements().next().is_none() {
            PyStructure::from_structure(SharedStructure {
                structure: Arc::clone(&model),
                dof_names: None,
            })
        } else {
            // Each simulation has separate internal variables.
            let undeformed_model = Arc::clone(&model);
            PyStructure::new(move || Ok(FemModel::clone(&undeformed_model)))
        };
        Ok(PyClassInitializer::from(superclass).add_subclass(Self(model)))
    }

    /// The `DofCombination` of the motion of a ``node`` in a ``direction`` of the mesh, such as "x".
    fn row(&self, node: Count, direction: &str) -> PyResult<PyDofCombination> {
        Ok(self.0.row(node.0, self::direction(direction)?).or_raise()?.into())
    }

    /// Number of the degree of freedom of a ``node`` in a ``direction`` of the mesh, such as "x"; None if the node has
    /// no separate one.
    fn dof_at(&self, node: Count, direction: &str) -> PyResult<Option<usize>> {
        Ok(self.0.dof(node.0, self::direction(direction)?))
    }

    /// Number of the node at (``x``, ``y``), in space at (``x``, ``y``, ``z``), m, within a millionth of the extent of
    /// the model. ``z`` is 0 by default.
    #[pyo3(signature = (x, y, z=0.0))]
    fn node_at(&self, x: f64, y: f64, z: f64) -> PyResult<usize> {
        self.0.mesh().node_at_point([x, y, z]).or_raise()
    }

    /// A line of nodes of a model in the plane as contact nodes, a list of `BaseNode`, for a `Joint`. ``nodes``: list of
    /// their numbers.
    fn contact_nodes(
        &self,
        #[pyo3(from_py_with = whole_numbers)] nodes: Vec<usize>,
    ) -> PyResult<Vec<PyBaseNode>> {
        self.0.contact_nodes(&nodes).or_raise().map(python_nodes)
    }

    /// All n degrees of freedom in a rigid motion in a ``direction`` of the mesh, by 1 m or by 1 rad about ``point`` (x, y
    /// and z, m; the origin unless given): array of shape (n,), m or rad.
    #[pyo3(signature = (direction, point=None))]
    fn rigid_motion(&self, direction: &str, point: Option<[f64; 3]>) -> PyResult<Array> {
        let direction = self::direction(direction)?;
        Ok(self.0.rigid_motion(direction, point.unwrap_or_default()).into())
    }

    /// The `SectionRows` of shear (N/m), compression (N/m) and moment (N·m/m) that the part above
    /// ``height`` (m) exerts on the part below, the moment about (``reference``, ``height``), m;
    /// ``reference`` is 0 by default.
    #[pyo3(signature = (height, reference=0.0))]
    fn section<'py>(
        &self,
        py: Python<'py>,
        height: f64,
        reference: f64,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let section = self.0.section(height, reference).or_raise()?;
        let rows = [section.shear, section.compression, section.moment];
        PyTuple::new(py, rows.map(PySectionRows::from))
    }

    /// The six `SectionRows` of shear along x and along y (N), compression (N), moments about x and about y (N·m)
    /// and torque about z (N·m) that the part above ``height`` (m) exerts on the part below in space.
    ///
    /// Moments are about ``reference`` (x and y, m; the origin by default) at this height, by the right-hand rule. No
    /// element may cross the cut; elements in the plane of the cut belong to the part below. To include the weight
    /// above, add the acceleration of gravity to the vertical accelerations.
    #[pyo3(signature = (height, reference=[0.0; 2]), text_signature = "($self, height, reference=(0.0, 0.0))")]
    fn section_in_space(&self, height: f64, reference: [f64; 2]) -> PyResult<[PySectionRows; 6]> {
        Ok(space_sections(self.0.section_in_space(height, reference).or_raise()?))
    }

    /// The `DofCombination` of a uniform pressure on a line of ``nodes`` (list of numbers): as the
    /// row of a `Load`, whose forces are then pressures (Pa).
    fn pressure_row(
        &self,
        #[pyo3(from_py_with = whole_numbers)] nodes: Vec<usize>,
    ) -> PyResult<PyDofCombination> {
        Ok(self.0.pressure_row(&nodes).or_raise()?.into())
    }

    /// The `DofCombination` of a unit force in a ``direction`` ("x" or "y", in space also "z"), spread evenly along a line
    /// of ``nodes`` (list of numbers): as the row of a `Load` in N/m, in space in N.
    fn resultant_row(
        &self,
        #[pyo3(from_py_with = whole_numbers)] nodes: Vec<usize>,
        direction: &str,
    ) -> PyResult<PyDofCombination> {
        Ok(self.0.resultant_row(&nodes, self::direction(direction)?).or_raise()?.into())
    }

    /// Factor of the axial forces of the static state at which the structure buckles.
    fn buckling_factor(&self) -> PyResult<f64> {
        self.0.buckling_factor().or_raise()
    }
}

/// A mesh of quadrilaterals from a file of Gmsh.
///
/// ``path`` of the file: formats 4.1 and 2.2, text or binary. Nodes closer than ``merge_within`` (m) become one, no
/// nodes unless given.
#[pyclass(name = "GmshMesh", module = "basemat", frozen, dict)]
pub(crate) struct PyGmshMesh(GmshMesh);

#[pymethods]
impl PyGmshMesh {
    #[pyo3(signature = (path, *, merge_within=None))]
    #[new]
    fn new(path: PathBuf, merge_within: Option<f64>) -> PyResult<Self> {
        let mut mesh = GmshMesh::read(path).or_raise()?;
        if let Some(tolerance) = merge_within {
            mesh.merge_nodes(tolerance).or_raise()?;
        }
        Ok(Self(mesh))
    }

    /// List of the names of the groups of quadrilaterals.
    #[getter]
    fn surfaces(&self) -> Vec<&str> {
        self.0.surfaces()
    }

    /// List of the names of the groups of lines.
    #[getter]
    fn lines(&self) -> Vec<&str> {
        self.0.lines()
    }

    /// The quadrilaterals as a `Mesh`, each with the material of its group: ``materials`` is a dict
    /// ``{"wall": material}`` of materials as in `Layer`; ``formulation`` and ``hourglass_percent`` are as there, that of each
    /// material unless given.
    #[pyo3(signature = (materials, *, formulation=None, hourglass_percent=5))]
    fn mesh(
        &self,
        materials: BTreeMap<String, SolidLike>,
        formulation: Option<&str>,
        #[pyo3(from_py_with = whole_numbers)] hourglass_percent: usize,
    ) -> PyResult<PyMesh> {
        let materials: Vec<(&str, SharedMaterial)> = materials
            .iter()
            .map(|(name, material)| (name.as_str(), material.0.clone()))
            .collect();
        let percent = stabilisation_percent(hourglass_percent)?;
        let mesh = match formulation {
            Some(name) => self.0.mesh_of(&materials, self::formulation(name, percent)?),
            None => self.0.mesh(&materials),
        };
        mesh.or_raise().map(PyMesh)
    }

    /// Numbers of the nodes of the group ``name`` of lines in one piece: list, from left to right.
    fn line(&self, name: &str) -> PyResult<Vec<usize>> {
        self.0.line(name).or_raise()
    }

    /// Numbers of the nodes of the group ``name`` of lines, a list for each piece: for the ``contact`` of a
    /// `FemModel`.
    fn foundations(&self, name: &str) -> PyResult<Vec<Vec<usize>>> {
        self.0.foundations(name).or_raise()
    }
}
