//! An element in space that resists every deformation of its nodes alike, and no rigid motion.

use basemat::fem::{Direction, Element, ElementFace, MassKind};

use super::dense::dot;
use super::directions::IN_SPACE;

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
        let side = |side: [usize; 4]| ElementFace::side(&side.map(|k| nodes[k]));
        Self { faces: sides.map(side).into(), ..Self::solid(&nodes, stiffness, mass) }
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
        let motion = |k: usize| -> Vec<f64> {
            let node = |p: &[f64; 3]| {
                let [x, y, z] = [0, 1, 2].map(|axis| p[axis] - coordinates[0][axis]);
                let mut u = [0.0; 6];
                u[k] = 1.0;
                // θ × r.
                match k {
                    3 => [u[1], u[2]] = [-z, y],
                    4 => [u[0], u[2]] = [z, -x],
                    5 => [u[0], u[1]] = [-y, x],
                    _ => {}
                }
                u.into_iter().take(self.directions)
            };
            coordinates.iter().flat_map(node).collect()
        };
        (0..6).map(motion).collect()
    }
}

impl Element for StiffElement {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        &IN_SPACE[..self.directions]
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let n = self.order();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for mut motion in self.rigid_motions(coordinates) {
            let whole = dot(&motion, &motion).sqrt();
            // Twice is enough to be orthogonal to rounding.
            for own in basis.iter().chain(&basis) {
                let part = dot(own, &motion);
                motion.iter_mut().zip(own).for_each(|(u, q)| *u -= part * q);
            }
            let rest = dot(&motion, &motion).sqrt();
            if rest > 1e-9 * whole {
                basis.push(motion.iter().map(|u| u / rest).collect());
            }
        }
        for i in 0..n {
            matrix[i * (n + 1)] += self.stiffness;
            for j in 0..n {
                let rigid: f64 = basis.iter().map(|q| q[i] * q[j]).sum();
                matrix[i * n + j] -= self.stiffness * rigid;
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
