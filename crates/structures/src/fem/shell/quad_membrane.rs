//! Membrane of the quadrilateral: bending modes, and Allman's sides with rotations about the normal.

use super::section::ShellSection;
use crate::fem::element_matrix::{condense, recover_inner};
use crate::fem::quad4::{
    Jacobian, NODE_COORDINATES, gauss_points, integrate_stiffness, shape_functions,
};

/// Number of degrees of freedom of the nodes: u, v, ω of each node.
const NODAL_DOF_COUNT: usize = 12;

/// Number of degrees of freedom with the two bending modes in u and in v.
const FULL_DOF_COUNT: usize = 16;

/// Stiffness against the hourglass pattern of rotations, relative to G t A.
///
/// The pattern causes no strain at the 2 × 2 points. A ratio ten times as large makes a curved mesh stiffer by a third.
const HOURGLASS_STIFFNESS_RATIO: f64 = 0.01;

/// Membrane of a quadrilateral in its plane.
pub(super) struct QuadMembrane<'a> {
    pub(super) points: &'a [[f64; 2]; 4],
    pub(super) section: &'a ShellSection,
}

impl QuadMembrane<'_> {
    /// Condensed stiffness in the first 12 rows, then the equations of the bending modes.
    ///
    /// The degrees of freedom are u, v, ω of the nodes.
    ///
    /// The strain energy has a penalty term (Hughes & Brezzi 1989): the shear stiffness ties the rotation ω to the
    /// rotation ½(v,x − u,y) of the displacements. `Quad4` has the same bending modes (QM6).
    pub(super) fn stiffness(&self) -> [[f64; FULL_DOF_COUNT]; FULL_DOF_COUNT] {
        let ShellSection { shear_modulus, thickness, .. } = *self.section;
        let center_jacobian = Jacobian::at([0.0; 2], self.points);
        let mut moduli = [[0.0; 4]; 4];
        for (row, membrane_row) in moduli.iter_mut().zip(self.section.membrane_stiffness()) {
            row[..3].copy_from_slice(&membrane_row);
        }
        moduli[3][3] = shear_modulus * thickness;
        let weighted_points = gauss_points().into_iter().map(|point| (point, 1.0));
        let mut matrix = integrate_stiffness(&moduli, weighted_points, |point| {
            self.strains(point, &center_jacobian)
        });
        let area = self.area();
        let hourglass_pattern = self.hourglass_pattern(&center_jacobian);
        for i in 0..4 {
            for j in 0..4 {
                matrix[3 * i + 2][3 * j + 2] += HOURGLASS_STIFFNESS_RATIO
                    * shear_modulus
                    * thickness
                    * area
                    * hourglass_pattern[i]
                    * hourglass_pattern[j];
            }
        }
        condense(&mut matrix, NODAL_DOF_COUNT);
        matrix
    }

    /// Strains `[ε_xx, ε_yy, γ_xy]` at the corners due to u, v, ω of the nodes.
    ///
    /// The strains, with those of the bending modes, are computed at 2 × 2 points and extrapolated bilinearly.
    pub(super) fn corner_strains(&self, displacement: &[f64; NODAL_DOF_COUNT]) -> [[f64; 3]; 4] {
        let mut full_displacement = [0.0; FULL_DOF_COUNT];
        full_displacement[..NODAL_DOF_COUNT].copy_from_slice(displacement);
        recover_inner(&self.stiffness(), NODAL_DOF_COUNT, &mut full_displacement);
        let center_jacobian = Jacobian::at([0.0; 2], self.points);
        let gauss_strains = gauss_points().map(|point| {
            let columns = self.strains(point, &center_jacobian).0;
            [0, 1, 2]
                .map(|k| columns.iter().zip(&full_displacement).map(|(e, u)| e[k] * u).sum::<f64>())
        });
        NODE_COORDINATES.map(|corner| {
            // Natural coordinates in which the Gauss points are the corners.
            let shape_values =
                shape_functions(corner.map(|coordinate| coordinate * 3.0_f64.sqrt()));
            std::array::from_fn(|k| {
                shape_values.iter().zip(&gauss_strains).map(|(w, e)| w * e[k]).sum()
            })
        })
    }

    /// Strains at a point due to each unit degree of freedom, and the Jacobian determinant.
    ///
    /// Each entry holds `[ε_xx, ε_yy, γ_xy, ω − ½(v,x − u,y)]`.
    fn strains(
        &self,
        point: [f64; 2],
        center_jacobian: &Jacobian,
    ) -> ([[f64; 4]; FULL_DOF_COUNT], f64) {
        let jacobian = Jacobian::at(point, self.points);
        let mut columns = [[0.0; 4]; FULL_DOF_COUNT];
        let shape_values = shape_functions(point);
        for (node, derivatives) in jacobian.shape_derivatives(point).into_iter().enumerate() {
            columns[3 * node..3 * node + 2].copy_from_slice(&strain_columns(derivatives));
            columns[3 * node + 2][3] = shape_values[node];
        }
        for (first_node, bulge) in bulge_derivatives(point).into_iter().enumerate() {
            let second_node = (first_node + 1) % 4;
            let start = self.points[first_node];
            let end = self.points[second_node];
            // Displacement of the middle of the side due to a unit difference between the rotations of its ends.
            let bulge_vector = [(end[1] - start[1]) / 8.0, (start[0] - end[0]) / 8.0];
            let bulge_strains = strain_columns(jacobian.global_derivatives(bulge));
            for k in 0..4 {
                let strain =
                    bulge_vector[0] * bulge_strains[0][k] + bulge_vector[1] * bulge_strains[1][k];
                columns[3 * second_node + 2][k] += strain;
                columns[3 * first_node + 2][k] -= strain;
            }
        }
        // Derivatives of 1 − ξ² and 1 − η² from the Jacobian at the centre, scaled so that their integrals vanish.
        let scale = -2.0 * center_jacobian.determinant / jacobian.determinant;
        let xi_mode = strain_columns(center_jacobian.global_derivatives([scale * point[0], 0.0]));
        let eta_mode = strain_columns(center_jacobian.global_derivatives([0.0, scale * point[1]]));
        columns[NODAL_DOF_COUNT..NODAL_DOF_COUNT + 2].copy_from_slice(&xi_mode);
        columns[NODAL_DOF_COUNT + 2..].copy_from_slice(&eta_mode);
        (columns, jacobian.determinant)
    }

    /// Area in the plane, m².
    fn area(&self) -> f64 {
        gauss_points().map(|point| Jacobian::at(point, self.points).determinant).iter().sum()
    }

    /// Hourglass pattern +, −, +, − of rotations less its linear part.
    ///
    /// It is orthogonal to every linear field of ω.
    fn hourglass_pattern(&self, center_jacobian: &Jacobian) -> [f64; 4] {
        let signs = NODE_COORDINATES.map(|[xi, eta]| xi * eta);
        let pairs = signs.iter().zip(self.points);
        let x_sum: f64 = pairs.clone().map(|(sign, point)| sign * point[0]).sum();
        let y_sum: f64 = pairs.map(|(sign, point)| sign * point[1]).sum();
        let derivatives = center_jacobian.shape_derivatives([0.0; 2]);
        std::array::from_fn(|node| {
            0.25 * (signs[node] - x_sum * derivatives[node][0] - y_sum * derivatives[node][1])
        })
    }
}

/// Strains due to a displacement u, and due to a displacement v, with derivatives (∂/∂x, ∂/∂y).
fn strain_columns([dx, dy]: [f64; 2]) -> [[f64; 4]; 2] {
    [[dx, 0.0, dy, 0.5 * dy], [0.0, dy, dx, -0.5 * dx]]
}

/// Derivatives (∂/∂ξ, ∂/∂η) of the bulges of the sides 1–2, 2–3, 3–4 and 4–1, such as ½(1 − ξ²)(1 − η).
fn bulge_derivatives([xi, eta]: [f64; 2]) -> [[f64; 2]; 4] {
    let xi_parabola = 0.5 * (1.0 - xi * xi);
    let eta_parabola = 0.5 * (1.0 - eta * eta);
    [
        [-xi * (1.0 - eta), -xi_parabola],
        [eta_parabola, -eta * (1.0 + xi)],
        [-xi * (1.0 + eta), xi_parabola],
        [-eta_parabola, -eta * (1.0 - xi)],
    ]
}
