//! An element in space that resists every deformation of its nodes equally, and no rigid motion.

use basemat::fem::{Direction, Element, ElementFace, MassKind};

use super::dense::dot;
use super::directions::NODE_DIRECTIONS;
use super::supported::rigid_motion;

/// Norm of the new component below which a motion depends on earlier ones, relative to the motion's norm.
const DEPENDENCE_TOLERANCE: f64 = 1e-9;

/// Nodes with the stiffness k (I − Q Qᵀ), where the columns of Q are an orthonormal basis of the rigid motions.
pub struct StiffElement {
    nodes: Vec<usize>,
    /// Number of directions: 3 displacements, or 6 with rotations.
    directions: usize,
    stiffness: f64,
    /// Mass at each node, kg.
    mass: f64,
    faces: Vec<ElementFace>,
}

impl StiffElement {
    /// Nodes with displacements only.
    pub fn solid(nodes: &[usize], stiffness: f64, mass: f64) -> Self {
        Self { nodes: nodes.to_vec(), directions: 3, stiffness, mass, faces: Vec::new() }
    }

    /// A brick: four nodes counter-clockwise from above, and the four nodes over them.
    pub fn brick(nodes: [usize; 8], stiffness: f64, mass: f64) -> Self {
        let sides =
            [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
        let faces = sides.map(|side| ElementFace::side(&side.map(|k| nodes[k]))).into();
        Self { faces, ..Self::solid(&nodes, stiffness, mass) }
    }

    /// A bar or joint: nodes with displacements and rotations.
    pub fn frame(nodes: &[usize], stiffness: f64, mass: f64) -> Self {
        Self { directions: 6, ..Self::solid(nodes, stiffness, mass) }
    }

    /// A shell.
    pub fn shell(nodes: &[usize], thickness: f64, stiffness: f64, mass: f64) -> Self {
        let faces = vec![ElementFace::shell(nodes, thickness)];
        Self { faces, ..Self::frame(nodes, stiffness, mass) }
    }

    /// Displacements of all nodes in the six rigid motions.
    fn rigid_motions(&self, coordinates: &[[f64; 3]]) -> Vec<Vec<f64>> {
        let mut motions = Vec::new();
        for motion in 0..6 {
            let mut displacements = Vec::new();
            for point in coordinates {
                let relative_position = [0, 1, 2].map(|axis| point[axis] - coordinates[0][axis]);
                let u = rigid_motion(motion, relative_position);
                displacements.extend_from_slice(&u[..self.directions]);
            }
            motions.push(displacements);
        }
        motions
    }
}

impl Element for StiffElement {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        &NODE_DIRECTIONS[..self.directions]
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let n = self.order();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for mut motion in self.rigid_motions(coordinates) {
            let norm = dot(&motion, &motion).sqrt();
            // A second pass makes the vectors orthogonal up to rounding.
            for vector in basis.iter().chain(&basis) {
                let component = dot(vector, &motion);
                motion.iter_mut().zip(vector).for_each(|(u, q)| *u -= component * q);
            }
            let orthogonal_norm = dot(&motion, &motion).sqrt();
            if orthogonal_norm > DEPENDENCE_TOLERANCE * norm {
                basis.push(motion.iter().map(|u| u / orthogonal_norm).collect());
            }
        }
        for i in 0..n {
            matrix[i * (n + 1)] += self.stiffness;
            for j in 0..n {
                let rigid_part: f64 = basis.iter().map(|q| q[i] * q[j]).sum();
                matrix[i * n + j] -= self.stiffness * rigid_part;
            }
        }
    }

    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, matrix: &mut [f64]) {
        let n = self.order();
        for i in (0..n).filter(|i| i % self.directions < 3) {
            matrix[i * (n + 1)] += self.mass;
        }
    }

    fn faces(&self) -> Vec<ElementFace> {
        self.faces.clone()
    }
}
