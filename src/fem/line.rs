//! Line between the nodes of a two-node element.

use super::element::add_square;
use crate::error::{Result, positive, same_length};

/// Length and direction of the straight line from the first to the second node.
pub(super) struct Line {
    pub(super) length: f64,
    cosine: f64,
    sine: f64,
}

impl Line {
    /// Line between two points; `None` unless there are exactly two.
    pub(super) fn between(coordinates: &[[f64; 3]]) -> Option<Self> {
        let &[[x0, y0, _], [x1, y1, _]] = coordinates else { return None };
        let length = (x1 - x0).hypot(y1 - y0);
        Some(Self { length, cosine: (x1 - x0) / length, sine: (y1 - y0) / length })
    }

    /// Error unless there are two points at different places.
    pub(super) fn check(quantity: &'static str, coordinates: &[[f64; 3]]) -> Result<()> {
        same_length(quantity, coordinates.len(), 2)?;
        positive(quantity, Self::between(coordinates).map_or(0.0, |line| line.length)).map(drop)
    }

    /// Adds the axial `stiffness` of the line; degrees of freedom x, y at both ends.
    pub(super) fn add_axial(&self, stiffness: f64, matrix: &mut [f64]) {
        let row = [-self.cosine, -self.sine, self.cosine, self.sine];
        add_square(matrix, &row.map(|a| row.map(|b| stiffness * a * b)));
    }

    /// Adds the geometric stiffness −P/L of a bar with the compressive force P.
    ///
    /// It acts on relative displacements across the bar; degrees of freedom x, y at both ends.
    pub(super) fn add_sway(&self, compression: f64, matrix: &mut [f64]) {
        let row = [self.sine, -self.cosine, -self.sine, self.cosine];
        let factor = -compression / self.length;
        add_square(matrix, &row.map(|a| row.map(|b| factor * a * b)));
    }

    /// Lengthening of the line, m, when its ends are displaced by [x, y].
    pub(super) fn lengthening(&self, first: [f64; 2], second: [f64; 2]) -> f64 {
        self.cosine * (second[0] - first[0]) + self.sine * (second[1] - first[1])
    }

    /// Transforms a `local` matrix to global degrees of freedom and adds it.
    ///
    /// Local: along the line, across it to the left, rotation; both ends. Global: x, y, rotation; both ends.
    pub(super) fn add_rotated(&self, local: &[[f64; 6]; 6], matrix: &mut [f64]) {
        let mut to_local = [[0.0; 6]; 6];
        for end in [0, 3] {
            to_local[end][end] = self.cosine;
            to_local[end][end + 1] = self.sine;
            to_local[end + 1][end] = -self.sine;
            to_local[end + 1][end + 1] = self.cosine;
            to_local[end + 2][end + 2] = 1.0;
        }
        let mut half = [[0.0; 6]; 6];
        let mut global = [[0.0; 6]; 6];
        for i in 0..6 {
            for j in 0..6 {
                half[i][j] = (0..6).map(|k| local[i][k] * to_local[k][j]).sum();
            }
        }
        for i in 0..6 {
            for j in 0..6 {
                global[i][j] = (0..6).map(|k| to_local[k][i] * half[k][j]).sum();
            }
        }
        add_square(matrix, &global);
    }
}
