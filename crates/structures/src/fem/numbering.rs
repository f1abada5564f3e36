//! Numbers of the degrees of freedom of a mesh.

use super::element::Element;
use super::mesh::Mesh;
use crate::geometry::Direction;

/// Numbers of a mesh's degrees of freedom, node by node.
///
/// Directions that no element uses at a node have no number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Numbering {
    /// Directions of the mesh.
    directions: &'static [Direction],
    /// Numbers of each node in these directions.
    numbers: Vec<Option<usize>>,
    dofs: usize,
}

impl Numbering {
    /// Numbers the degrees of freedom of `mesh`.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let directions = mesh.directions();
        let mut numbers = vec![None; directions.len() * mesh.nodes().len()];
        for element in mesh.elements() {
            let places: Vec<usize> = element
                .directions()
                .iter()
                .filter_map(|&direction| place(directions, direction))
                .collect();
            for node in element.nodes() {
                for place in &places {
                    numbers[node * directions.len() + place] = Some(0);
                }
            }
        }
        let mut dofs = 0;
        for number in numbers.iter_mut().flatten() {
            *number = dofs;
            dofs += 1;
        }
        Self { directions, numbers, dofs }
    }

    /// Number of degrees of freedom.
    pub(crate) fn dofs(&self) -> usize {
        self.dofs
    }

    /// Index of the degree of freedom of `node` in `direction`, if there is one.
    pub(crate) fn dof(&self, node: usize, direction: Direction) -> Option<usize> {
        let place = place(self.directions, direction)?;
        *self.numbers.chunks_exact(self.directions.len()).nth(node)?.get(place)?
    }

    /// Overwrites `indices` with the degrees of freedom of `element`.
    ///
    /// They have the order of the element's matrices.
    pub(crate) fn of_element(&self, element: &dyn Element, indices: &mut Vec<usize>) {
        indices.clear();
        for &node in element.nodes() {
            for &direction in element.directions() {
                indices.push(self.dof(node, direction).unwrap_or(usize::MAX));
            }
        }
    }
}

/// Place of a direction among the directions of a mesh.
fn place(directions: &[Direction], direction: Direction) -> Option<usize> {
    directions.iter().position(|candidate| *candidate == direction)
}
