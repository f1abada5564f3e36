//! Elements that yield on the degrees of freedom of another structure.

use basemat::fem::Direction;
use basemat::structure::{DofCombination, WithElements};
use pyo3::prelude::*;

use super::mesh::PyMesh;
use super::{PyStructure, structure_recipe};
use crate::error::{OrRaise, input_error};
use crate::names::DofNames;
use crate::row::RowLike;

/// A linear ``structure`` with the elements of a ``mesh`` that yield, such as beams of fibres.
///
/// The structure may be a `MatrixModel` of another program. ``rows``: a list for each node of the mesh, of the rows of its
/// displacements in the directions of the mesh ("x", "y" and "rotation" in the plane; six in space) as sums of degrees of
/// freedom of the structure. The elements add their forces and masses; their stiffness must not be in the matrix of the
/// structure, and Rayleigh damping by their stiffness is not added. `Simulation.beam_sections` and `Simulation.solid_points`
/// return their states, by their numbers in the mesh. `WithSprings` may be around it, not inside.
#[pyclass(name = "WithElements", module = "basemat", extends = PyStructure, frozen)]
pub(crate) struct PyWithElements(
    /// The structure without the elements.
    pub(crate) Py<PyAny>,
);

#[pymethods]
impl PyWithElements {
    #[new]
    fn new(
        structure: Bound<'_, PyAny>,
        mesh: &PyMesh,
        rows: Vec<Vec<RowLike>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let make_structure = structure_recipe(&structure)?;
        let dof_count = make_structure().or_raise()?.dofs();
        let dof_names = DofNames::from_structure(&structure, dof_count)?;
        let mesh = mesh.0.clone();
        let directions: Vec<Direction> = mesh.directions().to_vec();
        let node_count = mesh.nodes().len();
        if rows.len() != node_count {
            let count = rows.len();
            let text =
                format!("rows has {count} entries, but must have {node_count}, one for each node");
            return Err(input_error(text));
        }
        let mut node_rows: Vec<Vec<DofCombination>> = Vec::with_capacity(node_count);
        for (node, row_list) in rows.into_iter().enumerate() {
            if row_list.len() != directions.len() {
                return Err(input_error(format!(
                    "rows of node {node} are {}, but must be {}, one for each direction of the mesh",
                    row_list.len(),
                    directions.len()
                )));
            }
            let mut combinations = Vec::with_capacity(row_list.len());
            for RowLike(row, weight_count) in row_list {
                weight_count.check("a row of an element", dof_count)?;
                combinations.push(row);
            }
            node_rows.push(combinations);
        }
        let make = move || {
            WithElements::new(make_structure()?, mesh.clone(), |node, direction| {
                let index = directions.iter().position(|other| *other == direction);
                Ok(index.map(|index| node_rows[node][index].clone()).unwrap_or_default())
            })
        };
        make().or_raise()?;
        let superclass = PyStructure::new(make).with_dof_names(dof_names);
        Ok(PyClassInitializer::from(superclass).add_subclass(Self(structure.unbind())))
    }
}
