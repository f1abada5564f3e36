//! Meshes in space from Gmsh.

use std::collections::BTreeMap;
use std::path::PathBuf;

use basemat::io::{GmshPart, GmshSpaceMesh};
use pyo3::PyClass;
use pyo3::prelude::*;

use super::material::{PyBeamSection, PyMaterial};
use super::mesh::PyMesh;
use super::solid_material::ElasticMaterial;
use crate::array::{Count, Rows, real_number};
use crate::error::OrRaise;
use crate::list_arguments::type_error;

/// A mesh in space from a file of Gmsh.
///
/// It has points, lines, triangles, quadrilaterals and hexahedra; z points up. ``path``: a file of format 4.1 or 2.2,
/// text or binary. Nodes closer than ``merge_within`` (m) are merged, no nodes unless given.
#[pyclass(name = "GmshSpaceMesh", module = "basemat", frozen, dict)]
pub(crate) struct PyGmshSpaceMesh(GmshSpaceMesh);

/// Python's description of the elements of a group.
struct GroupPart(GmshPart);

extracts!(GroupPart, object => {
    if object.is_none() {
        return Ok(Self(GmshPart::LeftOut));
    }
    if let Ok(material) = object.cast::<PyMaterial>() {
        return Ok(Self(GmshPart::Solid(material.get().0)));
    }
    let entries = object.try_iter().and_then(Iterator::collect::<PyResult<Vec<_>>>);
    let part = match entries.unwrap_or_default().as_slice() {
        [material, thickness] => {
            let material: ElasticMaterial = material.extract()?;
            GmshPart::Shell(material.0, real_number("thickness", thickness)?)
        }
        [material, section, orientation] => {
            let material: ElasticMaterial = material.extract()?;
            let section = cast_entry::<PyBeamSection>(section)?;
            GmshPart::Beam(material.0, section.get().0, orientation.extract()?)
        }
        _ => {
            let requirement = "a Material, (material, thickness), (material, section, orientation) or None; materials \
                               that yield are for quadrilaterals in the plane";
            return Err(type_error(&object, requirement));
        }
    };
    Ok(Self(part))
});

/// An entry of a part as an object of the class `T`.
fn cast_entry<'a, 'py, T: PyClass>(entry: &'a Bound<'py, PyAny>) -> PyResult<&'a Bound<'py, T>> {
    let class_name = T::type_object(entry.py()).name()?;
    entry.cast::<T>().map_err(|_| type_error(entry, &format!("a {class_name}")))
}

#[pymethods]
impl PyGmshSpaceMesh {
    #[pyo3(signature = (path, *, merge_within=None))]
    #[new]
    fn new(path: PathBuf, merge_within: Option<f64>) -> PyResult<Self> {
        let mut mesh = GmshSpaceMesh::read(path).or_raise()?;
        if let Some(tolerance) = merge_within {
            mesh.merge_nodes(tolerance).or_raise()?;
        }
        Ok(Self(mesh))
    }

    /// Coordinates of the nodes: array of shape (nodes, 3), m. A `mesh` has the same nodes with the same numbers.
    #[getter]
    fn nodes(&self) -> Rows {
        Rows(self.0.nodes().iter().map(|point| point.to_vec()).collect())
    }

    /// List of the names of the groups of a ``dimension``: 0 of points, 1 of lines, 2 of surfaces, 3 of volumes.
    fn groups(&self, dimension: Count) -> Vec<&str> {
        self.0.groups(dimension.0)
    }

    /// Numbers of the nodes of each element of the group ``name`` of a ``dimension`` (as for `groups`): a list of
    /// lists. Surfaces are faces for the ``contact`` of a `FemModel`, points are nodes for masses, loads and probes.
    fn cells(&self, dimension: Count, name: &str) -> PyResult<Vec<Vec<usize>>> {
        self.0.cells(dimension.0, name).or_raise()
    }

    /// The elements of the groups as a `Mesh`: ``parts`` is a dict ``{"wall": part}`` with the parts of
    /// `Mesh.from_arrays`.
    ///
    /// The part of volumes is a `Material`; of surfaces it is ``(material, thickness)``, in m; of lines it is
    /// ``(material, section, orientation)`` as in `Mesh.add_space_beams`; None omits a group. Lines and surfaces that
    /// are sides of other elements need no part. Triangles match the sides that they share with quadrilaterals. To find
    /// the number of an element of `cells`, look up its nodes in `Mesh.elements`.
    fn mesh(&self, parts: BTreeMap<String, GroupPart>) -> PyResult<PyMesh> {
        let parts: Vec<(&str, GmshPart)> =
            parts.iter().map(|(name, part)| (name.as_str(), part.0)).collect();
        Ok(PyMesh(self.0.mesh(&parts).or_raise()?))
    }
}
