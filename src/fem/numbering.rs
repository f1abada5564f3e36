//! Which unknown belongs to which node and direction.

use super::element::Element;
use super::mesh::Mesh;
use crate::geometry::Direction;

/// Numbers of the unknowns: node by node, only the directions that some element uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Numbering {
    numbers: Vec<[Option<usize>; 3]>,
    unknowns: usize,
}

impl Numbering {
    /// Numbers the unknowns of `mesh`.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let mut used = vec![[false; 3]; mesh.nodes().len()];
        for element in mesh.elements() {
            for &node in element.nodes() {
                for &direction in element.directions() {
                    used[node][slot(direction)] = true;
                }
            }
        }
        let mut unknowns = 0;
        let mut next = |is_used: bool| {
            is_used.then(|| {
                unknowns += 1;
                unknowns - 1
            })
        };
        let numbers = used.into_iter().map(|node| node.map(&mut next)).collect();
        Self { numbers, unknowns }
    }

    /// Number of unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Index of the unknown of `node` in `direction`, if there is one.
    pub(crate) fn unknown(&self, node: usize, direction: Direction) -> Option<usize> {
        self.numbers.get(node)?[slot(direction)]
    }

    /// Indices of the unknowns of `element`, in the order of its matrices; replaces `indices`.
    pub(crate) fn of_element(&self, element: &dyn Element, indices: &mut Vec<usize>) {
        indices.clear();
        for &node in element.nodes() {
            for &direction in element.directions() {
                indices.push(self.unknown(node, direction).unwrap_or(usize::MAX));
            }
        }
    }
}

fn slot(direction: Direction) -> usize {
    match direction {
        Direction::X => 0,
        Direction::Y => 1,
        Direction::Rotation => 2,
    }
}
