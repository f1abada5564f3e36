//! Indices of a mesh's degrees of freedom.

use super::element::Element;
use super::mesh::Mesh;
use crate::geometry::Direction;

/// Indices of a mesh's degrees of freedom, node by node.
///
/// A node has no degree of freedom in a direction that none of its elements has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Numbering {
    /// Directions of the mesh.
    directions: &'static [Direction],
    /// Index of each degree of freedom, by node and direction, row-major.
    dof_indices: Vec<Option<usize>>,
    /// Number of degrees of freedom.
    dof_count: usize,
}

impl Numbering {
    /// Indices for the degrees of freedom of `mesh`.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let directions = mesh.directions();
        let mut dof_indices = vec![None; directions.len() * mesh.nodes().len()];
        for element in mesh.elements() {
            let columns: Vec<usize> = element
                .directions()
                .iter()
                .filter_map(|&direction| direction_index(directions, direction))
                .collect();
            for node in element.nodes() {
                for column in &columns {
                    dof_indices[node * directions.len() + column] = Some(0);
                }
            }
        }
        let mut dof_count = 0;
        for index in dof_indices.iter_mut().flatten() {
            *index = dof_count;
            dof_count += 1;
        }
        Self { directions, dof_indices, dof_count }
    }

    /// Number of degrees of freedom.
    pub(crate) fn dofs(&self) -> usize {
        self.dof_count
    }

    /// Index of the degree of freedom of `node` in `direction`, if there is one.
    pub(crate) fn dof(&self, node: usize, direction: Direction) -> Option<usize> {
        let column = direction_index(self.directions, direction)?;
        *self.dof_indices.chunks_exact(self.directions.len()).nth(node)?.get(column)?
    }

    /// Overwrites `dofs` with the degrees of freedom of `element`, in the order of its matrices.
    pub(crate) fn element_dofs(&self, element: &dyn Element, dofs: &mut Vec<usize>) {
        dofs.clear();
        for &node in element.nodes() {
            for &direction in element.directions() {
                dofs.push(self.dof(node, direction).unwrap_or(usize::MAX));
            }
        }
    }
}

/// Index of a direction among the directions of a mesh.
fn direction_index(directions: &[Direction], direction: Direction) -> Option<usize> {
    directions.iter().position(|candidate| *candidate == direction)
}
