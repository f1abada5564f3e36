//! Shape functions of the four-node quadrilateral, and its Gauss points.

use crate::linalg::gauss;

/// Natural coordinates (ξ, η) of the four nodes, counter-clockwise.
pub(super) const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Gauss points of the 2 × 2 rule in the order of the corners; all weights are 1.
pub(super) fn gauss_points() -> [[f64; 2]; 4] {
    let place = gauss::rule(2).nodes[1];
    CORNERS.map(|[xi, eta]| [place * xi, place * eta])
}

/// Bilinear shape functions at (ξ, η).
pub(super) fn shape([xi, eta]: [f64; 2]) -> [f64; 4] {
    CORNERS.map(|[a, b]| 0.25 * (1.0 + a * xi) * (1.0 + b * eta))
}

/// Jacobian ∂(x, y)/∂(ξ, η) at a point, its inverse transpose and determinant.
pub(super) struct Jacobian {
    /// Rows: ∂ξ/∂x, ∂η/∂x; ∂ξ/∂y, ∂η/∂y.
    inverse: [[f64; 2]; 2],
    pub(super) determinant: f64,
}

impl Jacobian {
    pub(super) fn at(point: [f64; 2], coordinates: &[[f64; 2]]) -> Self {
        let mut j = [[0.0; 2]; 2];
        for (slope, node) in natural_slopes(point).iter().zip(coordinates) {
            for axis in 0..2 {
                j[axis][0] += slope[0] * node[axis];
                j[axis][1] += slope[1] * node[axis];
            }
        }
        let determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        let inverse = [
            [j[1][1] / determinant, -j[1][0] / determinant],
            [-j[0][1] / determinant, j[0][0] / determinant],
        ];
        Self { inverse, determinant }
    }

    /// Slopes (∂/∂x, ∂/∂y) from slopes (∂/∂ξ, ∂/∂η).
    pub(super) fn global(&self, natural: [f64; 2]) -> [f64; 2] {
        self.inverse.map(|row| row[0] * natural[0] + row[1] * natural[1])
    }

    /// Slopes (∂/∂x, ∂/∂y) of the four shape functions at `point`.
    pub(super) fn slopes(&self, point: [f64; 2]) -> [[f64; 2]; 4] {
        natural_slopes(point).map(|slope| self.global(slope))
    }
}

fn natural_slopes([xi, eta]: [f64; 2]) -> [[f64; 2]; 4] {
    CORNERS.map(|[a, b]| [0.25 * a * (1.0 + b * eta), 0.25 * b * (1.0 + a * xi)])
}
