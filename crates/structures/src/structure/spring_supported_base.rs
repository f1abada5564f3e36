//! Stiffness of a structure on springs at its contact nodes.
//!
//! | symbol | meaning |
//! |---|---|
//! | N | matrix from the degrees of freedom to the displacements of the contact nodes |
//! | γ | stiffness of the springs |

use super::{BaseNode, DofCombination, Triplets};
use crate::error::Result;
use crate::geometry::{COMPONENTS_IN_PLANE, COMPONENTS_IN_SPACE};
use crate::linalg::{SparseFactor, SparseMatrix, largest};

/// Stiffness K + γ NᵀN of a structure on springs at its contact nodes.
#[allow(missing_debug_implementations, reason = "a helper of basemat")]
pub struct SpringSupportedBase<'a> {
    nodes: &'a [BaseNode],
    /// Stiffness γ of the springs, N/m.
    #[doc(hidden)]
    pub spring_stiffness: f64,
    /// K + γ NᵀN.
    #[doc(hidden)]
    pub matrix: Triplets,
}

impl<'a> SpringSupportedBase<'a> {
    /// Name of the matrix in errors.
    #[doc(hidden)]
    pub const STIFFNESS_NAME: &'static str = "stiffness matrix with its base held";

    /// Structure on springs of `spring_stiffness` (N/m) at each displacement of `nodes`.
    #[doc(hidden)]
    pub fn new(nodes: &'a [BaseNode], stiffness: &SparseMatrix, spring_stiffness: f64) -> Self {
        let mut matrix = SparseMatrix::weighted_sum(stiffness.order(), &[(1.0, stiffness)]);
        for row in nodes.iter().flat_map(BaseNode::rows).filter(|row| !row.is_empty()) {
            matrix.add_outer(row, spring_stiffness);
        }
        Self { nodes, spring_stiffness, matrix }
    }

    /// Factors of the matrix.
    #[doc(hidden)]
    pub fn factor(&self) -> Result<SparseFactor> {
        SparseFactor::new(Self::STIFFNESS_NAME, &self.matrix)
    }

    /// Forces γ Nᵀ1 for base displacements of 1 m to the right, upwards and, in space, away.
    #[doc(hidden)]
    pub fn translation_forces(&self) -> Vec<Vec<f64>> {
        (0..self.directions())
            .map(|direction| {
                self.forces(self.nodes.iter().map(move |node| (node.rows()[direction], 1.0)))
            })
            .collect()
    }

    /// Forces γ Nᵀn for rotations of `nodes` by 1 rad about `middle`.
    ///
    /// In the plane there is one rotation, which tilts x upwards, about the height of the lowest node. In space there
    /// are three: they tilt x upwards, tilt y upwards, and turn x towards y.
    #[doc(hidden)]
    pub fn rotation_forces<'b>(
        &self,
        nodes: impl Iterator<Item = &'b BaseNode> + Clone,
        [x, y]: [f64; 2],
    ) -> Vec<Vec<f64>> {
        let lowest_height = nodes.clone().map(|node| node.z).fold(f64::INFINITY, f64::min);
        let wall_nodes = nodes.clone().filter(|node| node.z > lowest_height);
        let horizontal = wall_nodes.map(|node| (&node.horizontal, lowest_height - node.z));
        let vertical = nodes.clone().map(|node| (&node.vertical, node.x - x));
        let mut rotations = vec![self.forces(vertical.chain(horizontal))];
        if self.directions() == COMPONENTS_IN_SPACE {
            rotations.push(self.forces(nodes.clone().map(|node| (&node.vertical, node.y - y))));
            let x_forces = self.forces(nodes.clone().map(|node| (&node.horizontal, y - node.y)));
            let y_forces = self.forces(nodes.map(|node| (&node.across, node.x - x)));
            rotations.push(x_forces.iter().zip(&y_forces).map(|(a, b)| a + b).collect());
        }
        rotations
    }

    /// Number of directions in which the nodes move.
    fn directions(&self) -> usize {
        self.nodes.first().map_or(COMPONENTS_IN_PLANE, BaseNode::direction_count)
    }

    /// Nodal forces of the springs for prescribed elongations (m).
    ///
    /// Each elongation belongs to a displacement of a node, as a row of degrees of freedom.
    fn forces<'b>(&self, elongations: impl Iterator<Item = (&'b DofCombination, f64)>) -> Vec<f64> {
        let mut force = vec![0.0; self.matrix.order()];
        for (row, elongation) in elongations {
            for &(dof, weight) in row {
                force[dof] += self.spring_stiffness * weight * elongation;
            }
        }
        force
    }
}

/// Largest stiffness on the diagonal, N/m; one for a zero matrix.
pub fn max_diagonal_stiffness(stiffness: &SparseMatrix) -> f64 {
    let max_stiffness = largest(&stiffness.diagonal());
    if max_stiffness > 0.0 { max_stiffness } else { 1.0 }
}
