//! Plane of a shell element: its axes, the projected nodes, and rigid links to the nodes.

use crate::fem::vector::{add_scaled, cross, dot, unit_vector};

/// Axes e1, e2, n of a flat element, and the projections of its N nodes on its plane.
///
/// The plane contains the mean of the nodes. A node at a distance from the plane, as in a warped quadrilateral, is
/// connected to its projection by a rigid link, so that rigid motions cause no strain.
pub(super) struct LocalFrame<const N: usize> {
    /// Unit vectors e1, e2, n as rows.
    pub(super) axes: [[f64; 3]; 3],
    /// Coordinates of the projections along e1 and e2, m.
    pub(super) points: [[f64; 2]; N],
    /// Distances of the nodes from the plane along n, m.
    heights: [f64; N],
}

impl LocalFrame<4> {
    /// Frame of a quadrilateral.
    ///
    /// n is normal to both diagonals; e1 runs from the middle of side 4–1 to the middle of side 2–3.
    pub(super) fn quadrilateral(nodes: &[[f64; 3]; 4]) -> Self {
        let first_diagonal = add_scaled(nodes[2], -1.0, nodes[0]);
        let second_diagonal = add_scaled(nodes[3], -1.0, nodes[1]);
        // Twice the vector from the middle of side 4–1 to the middle of side 2–3.
        let tangent = add_scaled(first_diagonal, -1.0, second_diagonal);
        Self::new(nodes, cross(first_diagonal, second_diagonal), tangent)
    }
}

impl LocalFrame<3> {
    /// Frame of a triangle, e1 along the side 1–2.
    pub(super) fn triangle(nodes: &[[f64; 3]; 3]) -> Self {
        let first_side = add_scaled(nodes[1], -1.0, nodes[0]);
        let last_side = add_scaled(nodes[2], -1.0, nodes[0]);
        Self::new(nodes, cross(first_side, last_side), first_side)
    }
}

impl<const N: usize> LocalFrame<N> {
    /// Frame with n along `normal` and e1 along the projection of `tangent` on the plane.
    ///
    /// Neither vector needs to have unit length.
    fn new(nodes: &[[f64; 3]; N], normal: [f64; 3], tangent: [f64; 3]) -> Self {
        let n = unit_vector(normal);
        let e1 = unit_vector(add_scaled(tangent, -dot(tangent, n), n));
        let axes = [e1, cross(n, e1), n];
        let node_count = N as f64;
        let mean =
            nodes.iter().fold([0.0; 3], |sum, node| add_scaled(sum, 1.0 / node_count, *node));
        let local_coordinates =
            nodes.map(|node| axes.map(|axis| dot(axis, add_scaled(node, -1.0, mean))));
        Self {
            axes,
            points: local_coordinates.map(|[x, y, _]| [x, y]),
            heights: local_coordinates.map(|[_, _, z]| z),
        }
    }

    /// Rigid link: matrix from the displacements and rotations of a node to those of its projection.
    ///
    /// Rows: u, v, w, θ1, θ2, θn.
    fn rigid_link(&self, node: usize) -> [[f64; 6]; 6] {
        let mut link = [[0.0; 6]; 6];
        for (row, axis) in self.axes.iter().enumerate() {
            link[row][..3].copy_from_slice(axis);
            link[3 + row][3..].copy_from_slice(axis);
        }
        let height = self.heights[node];
        for column in 0..3 {
            link[0][3 + column] = -height * self.axes[1][column];
            link[1][3 + column] = height * self.axes[0][column];
        }
        link
    }

    /// Adds the stiffness matrices of membrane and bending (M = 3N) to the element's `matrix`.
    ///
    /// `matrix` is row-major and has the six degrees of freedom of each node, node by node.
    pub(super) fn add_stiffness<const M: usize>(
        &self,
        membrane: &[[f64; M]; M],
        bending: &[[f64; M]; M],
        matrix: &mut [f64],
    ) {
        let links: [_; N] = std::array::from_fn(|node| self.rigid_link(node));
        for (i, row_link) in links.iter().enumerate() {
            for (j, column_link) in links.iter().enumerate() {
                let half_transformed = half_transformed_block(membrane, bending, i, j, column_link);
                for (row, entries) in matrix.chunks_exact_mut(6 * N).skip(6 * i).take(6).enumerate()
                {
                    for (column, entry) in entries[6 * j..6 * j + 6].iter_mut().enumerate() {
                        *entry += (0..6)
                            .map(|k| row_link[k][row] * half_transformed[k][column])
                            .sum::<f64>();
                    }
                }
            }
        }
    }

    /// Displacements of all projections due to the displacements and rotations of each node; M = 3N.
    pub(super) fn local_displacements<const M: usize>(
        &self,
        displacement: &[f64],
    ) -> LocalDisplacements<M> {
        let mut membrane_and_bending = [[0.0; M]; 2];
        for (node, node_displacement) in displacement.chunks_exact(6).take(N).enumerate() {
            let link = self.rigid_link(node);
            let projected_motion =
                link.map(|row| row.iter().zip(node_displacement).map(|(a, b)| a * b).sum::<f64>());
            for (values, dofs) in membrane_and_bending.iter_mut().zip(MEMBRANE_AND_BENDING_DOFS) {
                values[3 * node..3 * node + 3]
                    .copy_from_slice(&dofs.map(|dof| projected_motion[dof]));
            }
        }
        LocalDisplacements { membrane: membrane_and_bending[0], bending: membrane_and_bending[1] }
    }
}

/// Displacements of a shell's projected nodes, in the axes of the element.
pub(super) struct LocalDisplacements<const M: usize> {
    /// u, v, θn of each node.
    pub(super) membrane: [f64; M],
    /// w, θ1, θ2 of each node.
    pub(super) bending: [f64; M],
}

/// Degrees of freedom of membrane (u, v, θn) and bending (w, θ1, θ2), as indices into the six of a node.
const MEMBRANE_AND_BENDING_DOFS: [[usize; 3]; 2] = [[0, 1, 5], [2, 3, 4]];

/// Local stiffness between the nodes i and j times the rigid link of node j.
fn half_transformed_block<const M: usize>(
    membrane: &[[f64; M]; M],
    bending: &[[f64; M]; M],
    i: usize,
    j: usize,
    link: &[[f64; 6]; 6],
) -> [[f64; 6]; 6] {
    let mut block = [[0.0; 6]; 6];
    for (matrix, dofs) in [membrane, bending].into_iter().zip(MEMBRANE_AND_BENDING_DOFS) {
        for (a, &row_dof) in dofs.iter().enumerate() {
            for (b, &column_dof) in dofs.iter().enumerate() {
                let stiffness = matrix[3 * i + a][3 * j + b];
                for column in 0..6 {
                    block[row_dof][column] += stiffness * link[column_dof][column];
                }
            }
        }
    }
    block
}
