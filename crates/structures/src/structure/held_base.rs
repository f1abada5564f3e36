//! Structures on springs under their contact nodes.
//!
//! | symbol | meaning |
//! |---|---|
//! | N | displacements of the contact nodes |
//! | γ | stiffness of the springs |

use super::{BaseNode, DofCombination, Triplets};
use crate::error::Result;
use crate::geometry::{COMPONENTS_IN_PLANE, COMPONENTS_IN_SPACE};
use crate::linalg::{SparseFactor, SparseMatrix, largest};

/// A structure on springs at its contact nodes: K + γ NᵀN, and forces that move its base.
#[allow(missing_debug_implementations, reason = "a helper of basemat")]
pub struct HeldBase<'a> {
    nodes: &'a [BaseNode],
    #[doc(hidden)]
    pub spring: f64,
    #[doc(hidden)]
    pub matrix: Triplets,
}

impl<'a> HeldBase<'a> {
    #[doc(hidden)]
    pub const STIFFNESS_NAME: &'static str = "stiffness matrix with its base held";

    #[doc(hidden)]
    pub fn new(nodes: &'a [BaseNode], stiffness: &SparseMatrix, spring: f64) -> Self {
        let mut matrix = SparseMatrix::weighted_sum(stiffness.order(), &[(1.0, stiffness)]);
        for row in nodes.iter().flat_map(BaseNode::rows).filter(|row| !row.is_empty()) {
            matrix.add_outer(row, spring);
        }
        Self { nodes, spring, matrix }
    }

    /// The factored matrix.
    #[doc(hidden)]
    pub fn factor(&self) -> Result<SparseFactor> {
        SparseFactor::new(Self::STIFFNESS_NAME, &self.matrix)
    }

    /// Forces γ Nᵀ1 for base displacements of 1 m to the right, upwards and, in plan, away.
    #[doc(hidden)]
    pub fn pulls(&self) -> Vec<Vec<f64>> {
        (0..self.directions())
            .map(|direction| {
                self.forces(self.nodes.iter().map(move |node| (node.rows()[direction], 1.0)))
            })
            .collect()
    }

    /// Forces γ Nᵀn for rotations of `nodes` by 1 rad about `middle`.
    ///
    /// In the plane: the rotation of x and up, at the height of the lowest node. In plan: the rotations of x and up, of
    /// y and up, and of x and y.
    #[doc(hidden)]
    pub fn turns<'b>(
        &self,
        nodes: impl Iterator<Item = &'b BaseNode> + Clone,
        [x, y]: [f64; 2],
    ) -> Vec<Vec<f64>> {
        let lowest = nodes.clone().map(|node| node.z).fold(f64::INFINITY, f64::min);
        let walls = nodes.clone().filter(|node| node.z > lowest);
        let along = walls.map(|node| (&node.horizontal, lowest - node.z));
        let up = nodes.clone().map(|node| (&node.vertical, node.x - x));
        let mut turns = vec![self.forces(up.chain(along))];
        if self.directions() == COMPONENTS_IN_SPACE {
            turns.push(self.forces(nodes.clone().map(|node| (&node.vertical, node.y - y))));
            let along = self.forces(nodes.clone().map(|node| (&node.horizontal, y - node.y)));
            let across = self.forces(nodes.map(|node| (&node.across, node.x - x)));
            turns.push(along.iter().zip(&across).map(|(one, other)| one + other).collect());
        }
        turns
    }

    /// Number of directions in which the nodes move.
    fn directions(&self) -> usize {
        self.nodes.first().map_or(COMPONENTS_IN_PLANE, BaseNode::directions)
    }

    /// Forces of springs with these elongations.
    fn forces<'b>(&self, pulled: impl Iterator<Item = (&'b DofCombination, f64)>) -> Vec<f64> {
        let mut force = vec![0.0; self.matrix.order()];
        for (row, amount) in pulled {
            for &(i, weight) in row {
                force[i] += self.spring * weight * amount;
            }
        }
        force
    }
}

/// The largest stiffness on the diagonal, or one.
pub fn stiffest(stiffness: &SparseMatrix) -> f64 {
    let stiffest = largest(&stiffness.diagonal());
    if stiffest > 0.0 { stiffest } else { 1.0 }
}
