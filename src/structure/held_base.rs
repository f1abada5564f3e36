//! Structures on springs under their contact nodes.
//!
//! | symbol | meaning |
//! |---|---|
//! | N | displacements of the contact nodes |
//! | γ | stiffness of the springs |

use super::{ContactNode, DofCombination, Triplets};
use crate::error::Result;
use crate::linalg::{SparseFactor, SparseMatrix, largest};

/// K + γ NᵀN, and the forces that move such a base.
pub(crate) struct HeldBase<'a> {
    nodes: &'a [ContactNode],
    pub(crate) spring: f64,
    pub(crate) matrix: Triplets,
}

impl<'a> HeldBase<'a> {
    pub(crate) const NAME: &'static str = "stiffness matrix with its base held";

    pub(crate) fn new(nodes: &'a [ContactNode], stiffness: &SparseMatrix, spring: f64) -> Self {
        let mut matrix = SparseMatrix::weighted_sum(stiffness.order(), &[(1.0, stiffness)]);
        for node in nodes {
            matrix.add_outer(&node.horizontal, spring);
            matrix.add_outer(&node.vertical, spring);
        }
        Self { nodes, spring, matrix }
    }

    /// The factored matrix.
    pub(crate) fn factor(&self) -> Result<SparseFactor> {
        SparseFactor::new(Self::NAME, &self.matrix)
    }

    /// γ Nᵀ1 for 1 m to the right and upwards.
    pub(crate) fn pulls(&self) -> [Vec<f64>; 2] {
        let nodes = || self.nodes.iter();
        [
            self.forces(nodes().map(|node| (&node.horizontal, 1.0))),
            self.forces(nodes().map(|node| (&node.vertical, 1.0))),
        ]
    }

    /// γ Nᵀn for a rotation of `nodes` by 1 rad about `middle`.
    pub(crate) fn turn<'b>(
        &self,
        nodes: impl IntoIterator<Item = &'b ContactNode>,
        middle: f64,
    ) -> Vec<f64> {
        self.forces(nodes.into_iter().map(|node| (&node.vertical, node.x - middle)))
    }

    /// Forces of springs that are pulled by these amounts.
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
pub(crate) fn stiffest(stiffness: &SparseMatrix) -> f64 {
    let stiffest = largest(&stiffness.diagonal());
    if stiffest > 0.0 { stiffest } else { 1.0 }
}
