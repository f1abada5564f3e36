//! Straight line between the nodes of a two-node element.

use super::element_matrix::add_transformed;
use super::vector::{add_scaled, cross, norm, unit_vector};
use crate::error::{Result, positive, same_length};

/// Length and direction of the straight line from the first to the second node.
pub(super) struct ElementLine {
    pub(super) length: f64,
    /// Unit vector along the line.
    tangent: [f64; 3],
    /// Horizontal unit vector at a right angle to the line.
    horizontal_normal: [f64; 3],
}

impl ElementLine {
    /// Line between the nodes; `None` unless there are exactly two.
    pub(super) fn between(coordinates: &[[f64; 3]]) -> Option<Self> {
        let &[first_point, second_point] = coordinates else {
            return None;
        };
        let difference = add_scaled(second_point, -1.0, first_point);
        let tangent = unit_vector(difference);
        let horizontal_length = difference[0].hypot(difference[1]);
        let horizontal_normal = if horizontal_length > 0.0 {
            [-difference[1] / horizontal_length, difference[0] / horizontal_length, 0.0]
        } else {
            [0.0, 1.0, 0.0]
        };
        Some(Self { length: norm(difference), tangent, horizontal_normal })
    }

    /// Unit vector from the first to the second node.
    pub(super) fn tangent(&self) -> [f64; 3] {
        self.tangent
    }

    /// Returns an error unless there are two distinct points.
    ///
    /// `quantity`: name of the length in the error.
    pub(super) fn check_length(quantity: &'static str, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length(quantity, coordinates.len(), 2)?;
        positive(quantity, Self::between(coordinates).map_or(0.0, |line| line.length)).map(drop)
    }

    /// Adds the matrix of an axial `stiffness` (N/m) to `matrix`.
    ///
    /// Degrees of freedom: displacements along the first `axis_count` axes at both ends.
    pub(super) fn add_axial(&self, stiffness: f64, axis_count: usize, matrix: &mut [f64]) {
        add_spring(stiffness, self.tangent, axis_count, matrix);
    }

    /// Adds the geometric stiffness −P/L of a bar with the compressive force P (N) to `matrix`.
    ///
    /// It acts on relative displacements of the ends at right angles to the bar. Degrees of freedom: displacements
    /// along the first `axis_count` axes at both ends.
    pub(super) fn add_geometric_stiffness(
        &self,
        compression: f64,
        axis_count: usize,
        matrix: &mut [f64],
    ) {
        // The second normal points out of the plane of a mesh with two axes.
        let normals = [self.horizontal_normal, cross(self.tangent, self.horizontal_normal)];
        for normal in normals.into_iter().take(axis_count - 1) {
            add_spring(-compression / self.length, normal, axis_count, matrix);
        }
    }

    /// Elongation of the line, m, by the displacements of its two ends, m.
    pub(super) fn elongation(&self, first_end: &[f64], second_end: &[f64]) -> f64 {
        let displacements = first_end.iter().zip(second_end);
        self.tangent
            .iter()
            .zip(displacements)
            .map(|(cosine, (first, second))| cosine * (second - first))
            .sum()
    }

    /// Transforms a local matrix to global degrees of freedom in the plane and adds it to `matrix`.
    ///
    /// Local, at both ends: displacement along the line, displacement to its left, rotation. Global, at both ends:
    /// displacements along x and y, rotation.
    pub(super) fn add_rotated(&self, local_matrix: &[[f64; 6]; 6], matrix: &mut [f64]) {
        let cosine = self.tangent[0];
        let sine = self.tangent[1];
        let mut to_local = [[0.0; 6]; 6];
        for dof in [0, 3] {
            to_local[dof][dof] = cosine;
            to_local[dof][dof + 1] = sine;
            to_local[dof + 1][dof] = -sine;
            to_local[dof + 1][dof + 1] = cosine;
            to_local[dof + 2][dof + 2] = 1.0;
        }
        add_transformed(local_matrix, &to_local, matrix);
    }
}

/// Adds the matrix of a spring along a unit vector `direction` between two nodes.
fn add_spring(stiffness: f64, direction: [f64; 3], axis_count: usize, matrix: &mut [f64]) {
    let order = 2 * axis_count;
    // Elongation of the spring by each degree of freedom.
    let mut elongations = [0.0; 6];
    for axis in 0..axis_count {
        elongations[axis] = -direction[axis];
        elongations[axis_count + axis] = direction[axis];
    }
    for (index, entry) in matrix.iter_mut().take(order * order).enumerate() {
        *entry += stiffness * elongations[index / order] * elongations[index % order];
    }
}
