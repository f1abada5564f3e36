//! Middle surface through the nodes of a shell: bilinear over four, plane over three.

use crate::fem::quad4::{natural_derivatives, shape_functions};
use crate::fem::vector::{add_scaled, cross, norm};
use crate::linalg::gauss;

/// Integrals of the shape functions N over the middle surface.
pub(super) struct MiddleSurface<const N: usize> {
    /// ∫ N_i N_j dA, m².
    pub(super) shape_products: [[f64; N]; N],
    /// ∫ N_i n dA with the unit normal n, m².
    pub(super) area_normals: [[f64; 3]; N],
}

impl MiddleSurface<4> {
    /// Bilinear surface, integrated by 3 × 3 points.
    pub(super) fn quadrilateral(nodes: &[[f64; 3]; 4]) -> Self {
        let mut surface = Self { shape_products: [[0.0; 4]; 4], area_normals: [[0.0; 3]; 4] };
        for (point, weight) in gauss::square(3) {
            let shape_derivatives = natural_derivatives(point);
            let mut tangents = [[0.0; 3]; 2];
            for (derivatives, node) in shape_derivatives.iter().zip(nodes) {
                tangents[0] = add_scaled(tangents[0], derivatives[0], *node);
                tangents[1] = add_scaled(tangents[1], derivatives[1], *node);
            }
            let area_normal = cross(tangents[0], tangents[1]);
            let shape_values = shape_functions(point);
            let area_weight = weight * norm(area_normal);
            for i in 0..4 {
                surface.area_normals[i] =
                    add_scaled(surface.area_normals[i], weight * shape_values[i], area_normal);
                for j in 0..4 {
                    surface.shape_products[i][j] += area_weight * shape_values[i] * shape_values[j];
                }
            }
        }
        surface
    }
}

impl MiddleSurface<3> {
    /// Plane triangle, integrated exactly.
    pub(super) fn triangle(nodes: &[[f64; 3]; 3]) -> Self {
        let area_normal =
            cross(add_scaled(nodes[1], -1.0, nodes[0]), add_scaled(nodes[2], -1.0, nodes[0]));
        let area = 0.5 * norm(area_normal);
        Self {
            shape_products: std::array::from_fn(|i| {
                std::array::from_fn(|j| if i == j { area / 6.0 } else { area / 12.0 })
            }),
            area_normals: [area_normal.map(|value| value / 6.0); 3],
        }
    }
}

impl<const N: usize> MiddleSurface<N> {
    /// ∫ N_i dA, m².
    pub(super) fn areas(&self) -> [f64; N] {
        self.shape_products.map(|row| row.iter().sum())
    }
}
