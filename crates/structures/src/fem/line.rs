//! Line between the nodes of a two-node element.

use super::element::add_transformed;
use super::vector::{add, cross, length, unit};
use crate::error::{Result, positive, same_length};

/// Length and direction of the straight line from the first to the second node.
pub(super) struct ElementLine {
    pub(super) length: f64,
    along: [f64; 3],
    /// Level direction across the line.
    across: [f64; 3],
}

impl ElementLine {
    /// Line between two points; `None` unless there are exactly two.
    pub(super) fn between(coordinates: &[[f64; 3]]) -> Option<Self> {
        let &[first, second] = coordinates else {
            return None;
        };
        let difference = add(second, -1.0, first);
        let along = unit(difference);
        let level_length = difference[0].hypot(difference[1]);
        let across = if level_length > 0.0 {
            [-difference[1] / level_length, difference[0] / level_length, 0.0]
        } else {
            [0.0, 1.0, 0.0]
        };
        Some(Self { length: length(difference), along, across })
    }

    /// Error unless there are two points at different places.
    pub(super) fn check(quantity: &'static str, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length(quantity, coordinates.len(), 2)?;
        positive(quantity, Self::between(coordinates).map_or(0.0, |line| line.length)).map(drop)
    }

    /// Adds the axial `stiffness` of the line.
    ///
    /// Degrees of freedom: along the first `axes` axes at both ends.
    pub(super) fn add_axial(&self, stiffness: f64, axes: usize, matrix: &mut [f64]) {
        add_relative(stiffness, self.along, axes, matrix);
    }

    /// Adds the geometric stiffness −P/L of a bar with the compressive force P.
    ///
    /// It acts on relative displacements across the bar; degrees of freedom along the first `axes` axes at both
    /// ends.
    pub(super) fn add_sway(&self, compression: f64, axes: usize, matrix: &mut [f64]) {
        // In the plane the second direction across the line leaves it.
        let directions = [self.across, cross(self.along, self.across)];
        for across in directions.into_iter().take(axes - 1) {
            add_relative(-compression / self.length, across, axes, matrix);
        }
    }

    /// Lengthening of the line, m, when its ends are displaced along the first axes.
    pub(super) fn lengthening(&self, first: &[f64], second: &[f64]) -> f64 {
        let ends = first.iter().zip(second);
        self.along
            .iter()
            .zip(ends)
            .map(|(along, (first, second))| along * (second - first))
            .sum()
    }

    /// Transforms a `local` matrix to global degrees of freedom of the plane and adds it.
    ///
    /// Local: along the line, across it to the left, rotation; both ends. Global: x, y, rotation; both ends.
    pub(super) fn add_rotated(&self, local: &[[f64; 6]; 6], matrix: &mut [f64]) {
        let cosine = self.along[0];
        let sine = self.along[1];
        let mut to_local = [[0.0; 6]; 6];
        for end in [0, 3] {
            to_local[end][end] = cosine;
            to_local[end][end + 1] = sine;
            to_local[end + 1][end] = -sine;
            to_local[end + 1][end + 1] = cosine;
            to_local[end + 2][end + 2] = 1.0;
        }
        add_transformed(local, &to_local, matrix);
    }
}

/// Adds factor · (relative displacement of two nodes along a `vector`)² as a matrix.
fn add_relative(factor: f64, vector: [f64; 3], axes: usize, matrix: &mut [f64]) {
    let order = 2 * axes;
    let mut weights = [0.0; 6];
    for axis in 0..axes {
        weights[axis] = -vector[axis];
        weights[axes + axis] = vector[axis];
    }
    for (index, entry) in matrix.iter_mut().take(order * order).enumerate() {
        *entry += factor * weights[index / order] * weights[index % order];
    }
}
