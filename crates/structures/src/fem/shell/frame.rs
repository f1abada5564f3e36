//! Plane of a shell element: its axes, its nodes projected on it, and rigid links to the nodes.

use crate::fem::vector::{add, cross, dot, unit};

/// Axes e1, e2, n of an element, and the places of its N nodes.
///
/// The element itself lies in the plane through the mean of its nodes. A node beside the plane, as in a warped
/// quadrilateral, moves its projection as a rigid link does, so that rigid motions cause no strain.
pub(super) struct Frame<const N: usize> {
    /// Unit vectors e1, e2, n as rows.
    pub(super) axes: [[f64; 3]; 3],
    /// Coordinates of the projections along e1 and e2, m.
    pub(super) points: [[f64; 2]; N],
    /// Heights of the nodes over the plane along n, m.
    heights: [f64; N],
}

impl Frame<4> {
    /// Frame of a quadrilateral.
    ///
    /// n is across both diagonals; e1 runs from the middle of side 4–1 to the middle of side 2–3.
    pub(super) fn quadrilateral(nodes: &[[f64; 3]; 4]) -> Self {
        let first_diagonal = add(nodes[2], -1.0, nodes[0]);
        let second_diagonal = add(nodes[3], -1.0, nodes[1]);
        // Twice the vector between the middles of the sides.
        let along = add(first_diagonal, -1.0, second_diagonal);
        Self::new(nodes, cross(first_diagonal, second_diagonal), along)
    }
}

impl Frame<3> {
    /// Frame of a triangle, e1 along the side 1–2.
    pub(super) fn triangle(nodes: &[[f64; 3]; 3]) -> Self {
        let along = add(nodes[1], -1.0, nodes[0]);
        Self::new(nodes, cross(along, add(nodes[2], -1.0, nodes[0])), along)
    }
}

impl<const N: usize> Frame<N> {
    fn new(nodes: &[[f64; 3]; N], across: [f64; 3], along: [f64; 3]) -> Self {
        let normal = unit(across);
        let first = unit(add(along, -dot(along, normal), normal));
        let axes = [first, cross(normal, first), normal];
        let count = N as f64;
        let mean = nodes.iter().fold([0.0; 3], |sum, node| add(sum, 1.0 / count, *node));
        let local = nodes.map(|node| axes.map(|axis| dot(axis, add(node, -1.0, mean))));
        Self { axes, points: local.map(|[x, y, _]| [x, y]), heights: local.map(|[_, _, z]| z) }
    }

    /// Displacements of a node's projection due to the six displacements of the node.
    ///
    /// Rows: u, v, w, θ1, θ2, θn.
    fn transformation(&self, node: usize) -> [[f64; 6]; 6] {
        let mut rows = [[0.0; 6]; 6];
        for (row, axis) in self.axes.iter().enumerate() {
            rows[row][..3].copy_from_slice(axis);
            rows[3 + row][3..].copy_from_slice(axis);
        }
        let height = self.heights[node];
        for column in 0..3 {
            rows[0][3 + column] = -height * self.axes[1][column];
            rows[1][3 + column] = height * self.axes[0][column];
        }
        rows
    }

    /// Adds the stiffness of membrane and bending (M = 3N) to the element's `matrix`.
    ///
    /// The matrix has all six directions of the nodes.
    pub(super) fn add_stiffness<const M: usize>(
        &self,
        membrane: &[[f64; M]; M],
        bending: &[[f64; M]; M],
        matrix: &mut [f64],
    ) {
        let links: [_; N] = std::array::from_fn(|node| self.transformation(node));
        for (i, rows) in links.iter().enumerate() {
            for (j, columns) in links.iter().enumerate() {
                let local_stiffness = local_block(membrane, bending, i, j, columns);
                for (row, entries) in matrix.chunks_exact_mut(6 * N).skip(6 * i).take(6).enumerate()
                {
                    for (column, entry) in entries[6 * j..6 * j + 6].iter_mut().enumerate() {
                        *entry +=
                            (0..6).map(|k| rows[k][row] * local_stiffness[k][column]).sum::<f64>();
                    }
                }
            }
        }
    }

    /// Displacements of all projections due to the six displacements of each node, M = 3N.
    pub(super) fn local<const M: usize>(&self, displacement: &[f64]) -> LocalDisplacements<M> {
        let mut parts = [[0.0; M]; 2];
        for (node, values) in displacement.chunks_exact(6).take(N).enumerate() {
            let link = self.transformation(node);
            let local = link.map(|row| row.iter().zip(values).map(|(a, b)| a * b).sum::<f64>());
            for (part, places) in parts.iter_mut().zip(DIRECTION_PLACES) {
                part[3 * node..3 * node + 3].copy_from_slice(&places.map(|place| local[place]));
            }
        }
        LocalDisplacements { membrane: parts[0], bending: parts[1] }
    }
}

/// Displacements of a shell's projected nodes, in the axes of the element.
pub(super) struct LocalDisplacements<const M: usize> {
    /// u, v, θn of each node.
    pub(super) membrane: [f64; M],
    /// w, θ1, θ2 of each node.
    pub(super) bending: [f64; M],
}

/// Places of membrane's u, v, θn and bending's w, θ1, θ2 among a node's six directions.
const DIRECTION_PLACES: [[usize; 3]; 2] = [[0, 1, 5], [2, 3, 4]];

/// Local stiffness between the nodes i and j times the transformation of node j.
fn local_block<const M: usize>(
    membrane: &[[f64; M]; M],
    bending: &[[f64; M]; M],
    i: usize,
    j: usize,
    columns: &[[f64; 6]; 6],
) -> [[f64; 6]; 6] {
    let mut block = [[0.0; 6]; 6];
    for (part, places) in [membrane, bending].into_iter().zip(DIRECTION_PLACES) {
        for (a, &row) in places.iter().enumerate() {
            for (b, &place) in places.iter().enumerate() {
                let stiffness = part[3 * i + a][3 * j + b];
                for column in 0..6 {
                    block[row][column] += stiffness * columns[place][column];
                }
            }
        }
    }
    block
}
