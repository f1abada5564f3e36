//! Middle surface through the nodes of a shell: bilinear over four, plane over three.

use crate::fem::quad4::{natural_slopes, shape};
use crate::fem::vector::{add, cross, length};
use crate::linalg::gauss;

/// Integrals of the shape functions N over the middle surface.
pub(super) struct MiddleSurface<const N: usize> {
    /// ∫ N_i N_j dA, m².
    pub(super) products: [[f64; N]; N],
    /// ∫ N_i dA with the unit normal as a vector, m².
    pub(super) vectors: [[f64; 3]; N],
}

impl MiddleSurface<4> {
    /// Bilinear surface, integrated by 3 × 3 points.
    pub(super) fn quadrilateral(nodes: &[[f64; 3]; 4]) -> Self {
        let mut surface = Self { products: [[0.0; 4]; 4], vectors: [[0.0; 3]; 4] };
        for (point, weight) in gauss::square(3) {
            let slopes = natural_slopes(point);
            let mut tangents = [[0.0; 3]; 2];
            for (slope, node) in slopes.iter().zip(nodes) {
                tangents[0] = add(tangents[0], slope[0], *node);
                tangents[1] = add(tangents[1], slope[1], *node);
            }
            let normal = cross(tangents[0], tangents[1]);
            let weights = shape(point);
            let area = weight * length(normal);
            for i in 0..4 {
                surface.vectors[i] = add(surface.vectors[i], weight * weights[i], normal);
                for j in 0..4 {
                    surface.products[i][j] += area * weights[i] * weights[j];
                }
            }
        }
        surface
    }
}

impl MiddleSurface<3> {
    /// Plane triangle, integrated exactly.
    pub(super) fn triangle(nodes: &[[f64; 3]; 3]) -> Self {
        let normal = cross(add(nodes[1], -1.0, nodes[0]), add(nodes[2], -1.0, nodes[0]));
        let area = 0.5 * length(normal);
        Self {
            products: std::array::from_fn(|i| {
                std::array::from_fn(|j| if i == j { area / 6.0 } else { area / 12.0 })
            }),
            vectors: [normal.map(|value| value / 6.0); 3],
        }
    }
}

impl<const N: usize> MiddleSurface<N> {
    /// ∫ N_i dA, m².
    pub(super) fn areas(&self) -> [f64; N] {
        self.products.map(|row| row.iter().sum())
    }
}
