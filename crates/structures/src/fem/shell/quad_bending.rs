//! Bending of the quadrilateral: MITC4.

use super::section::ShellSection;
use crate::fem::quad4::{
    Jacobian, NODE_COORDINATES, gauss_points, integrate_stiffness, jacobian_matrix,
    natural_derivatives, shape_functions,
};

/// Number of degrees of freedom: w, θ1, θ2 of each node.
const DOF_COUNT: usize = 12;

/// Plate of a quadrilateral in its plane (Bathe & Dvorkin 1985).
pub(super) struct QuadBending<'a> {
    pub(super) points: &'a [[f64; 2]; 4],
    pub(super) section: &'a ShellSection,
}

impl QuadBending<'_> {
    /// Stiffness matrix for w, θ1, θ2 of the nodes.
    pub(super) fn stiffness(&self) -> [[f64; DOF_COUNT]; DOF_COUNT] {
        let weighted_points = gauss_points().into_iter().map(|point| (point, 1.0));
        integrate_stiffness(&self.section.plate_stiffness(), weighted_points, |point| {
            self.strains(point)
        })
    }

    /// Strains `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]` at the corners due to w, θ1, θ2 of the nodes.
    pub(super) fn corner_strains(&self, displacement: &[f64; DOF_COUNT]) -> [[f64; 5]; 4] {
        NODE_COORDINATES.map(|corner| {
            let columns = self.strains(corner).0;
            std::array::from_fn(|k| columns.iter().zip(displacement).map(|(e, u)| e[k] * u).sum())
        })
    }

    /// Strains at a point due to each unit degree of freedom, and the Jacobian determinant.
    ///
    /// Each entry holds `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]`.
    fn strains(&self, point: [f64; 2]) -> ([[f64; 5]; DOF_COUNT], f64) {
        let jacobian = Jacobian::at(point, self.points);
        let mut columns = [[0.0; 5]; DOF_COUNT];
        for (node, [dx, dy]) in jacobian.shape_derivatives(point).into_iter().enumerate() {
            columns[3 * node + 1] = [0.0, -dy, -dx, 0.0, 0.0];
            columns[3 * node + 2] = [dx, 0.0, dy, 0.0, 0.0];
        }
        // Each shear strain is interpolated between the tying points at the middles of two opposite sides.
        let shear_xi = self.interpolated_shear(0, point[1], [[0.0, -1.0], [0.0, 1.0]]);
        let shear_eta = self.interpolated_shear(1, point[0], [[-1.0, 0.0], [1.0, 0.0]]);
        for (column, (xi, eta)) in columns.iter_mut().zip(shear_xi.into_iter().zip(shear_eta)) {
            column[3..].copy_from_slice(&jacobian.global_derivatives([xi, eta]));
        }
        (columns, jacobian.determinant)
    }

    /// Covariant shear strains along an axis due to each unit degree of freedom, between two tying points.
    ///
    /// `coordinate`: from −1 at the first tying point to 1 at the second.
    fn interpolated_shear(
        &self,
        axis: usize,
        coordinate: f64,
        tying_points: [[f64; 2]; 2],
    ) -> [f64; DOF_COUNT] {
        let first_shear = self.shear(axis, tying_points[0]);
        let second_shear = self.shear(axis, tying_points[1]);
        std::array::from_fn(|k| {
            0.5 * ((1.0 - coordinate) * first_shear[k] + (1.0 + coordinate) * second_shear[k])
        })
    }

    /// Covariant shear strains along an axis (0 for ξ, 1 for η) due to each unit degree of freedom.
    ///
    /// Along ξ it is w,ξ + x,ξ θ2 − y,ξ θ1.
    fn shear(&self, axis: usize, point: [f64; 2]) -> [f64; DOF_COUNT] {
        let derivatives = natural_derivatives(point);
        let jacobian = jacobian_matrix(&derivatives, self.points);
        let shape_values = shape_functions(point);
        std::array::from_fn(|k| match k % 3 {
            0 => derivatives[k / 3][axis],
            1 => -jacobian[1][axis] * shape_values[k / 3],
            _ => jacobian[0][axis] * shape_values[k / 3],
        })
    }
}
