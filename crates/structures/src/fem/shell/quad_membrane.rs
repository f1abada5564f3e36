//! Membrane of the quadrilateral: bending modes, Allman's sides, and rotations about the normal.

use super::section::ShellSection;
use crate::fem::condensation::{complete, condense};
use crate::fem::quad4::{Jacobian, NODE_COORDINATES, gauss_points, integrate_stiffness, shape};

/// Degrees of freedom of the nodes: u, v, ω each.
const NODAL_DOF_COUNT: usize = 12;

/// Degrees of freedom with the two bending modes in u and in v.
const FULL_DOF_COUNT: usize = 16;

/// Stiffness against the hourglass pattern of rotations, relative to G t A.
///
/// The pattern causes no strain at the 2 × 2 points. Ten times this stiffness stiffens a curved mesh by a third.
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
    /// The energy of the strains has a second part (Hughes & Brezzi 1989): shear stiffness ties the rotation ω
    /// to the rotation ½(v,x − u,y) of the displacements. `Quad4` has the same bending modes (QM6).
    pub(super) fn stiffness(&self) -> [[f64; FULL_DOF_COUNT]; FULL_DOF_COUNT] {
        let ShellSection { shear_modulus, thickness, .. } = *self.section;
        let centre = Jacobian::at([0.0; 2], self.points);
        let mut moduli = [[0.0; 4]; 4];
        for (row, membrane) in moduli.iter_mut().zip(self.section.membrane()) {
            row[..3].copy_from_slice(&membrane);
        }
        moduli[3][3] = shear_modulus * thickness;
        let points = gauss_points().into_iter().map(|point| (point, 1.0));
        let mut matrix = integrate_stiffness(&moduli, points, |point| self.strains(point, &centre));
        let area = self.area();
        let pattern = self.hourglass(&centre);
        for i in 0..4 {
            for j in 0..4 {
                matrix[3 * i + 2][3 * j + 2] += HOURGLASS_STIFFNESS_RATIO
                    * shear_modulus
                    * thickness
                    * area
                    * pattern[i]
                    * pattern[j];
            }
        }
        condense(&mut matrix, NODAL_DOF_COUNT);
        matrix
    }

    /// Strains `[ε_xx, ε_yy, γ_xy]` at the corners by u, v, ω of the nodes.
    ///
    /// They are computed with the bending modes at 2 × 2 points and extrapolated bilinearly.
    pub(super) fn corner_strains(&self, displacement: &[f64; NODAL_DOF_COUNT]) -> [[f64; 3]; 4] {
        let mut values = [0.0; FULL_DOF_COUNT];
        values[..NODAL_DOF_COUNT].copy_from_slice(displacement);
        complete(&self.stiffness(), NODAL_DOF_COUNT, &mut values);
        let centre = Jacobian::at([0.0; 2], self.points);
        let inside = gauss_points().map(|point| {
            let patterns = self.strains(point, &centre).0;
            [0, 1, 2].map(|k| patterns.iter().zip(&values).map(|(e, u)| e[k] * u).sum::<f64>())
        });
        NODE_COORDINATES.map(|corner| {
            // Natural coordinates in which the Gauss points are the corners.
            let weights = shape(corner.map(|place| place * 3.0_f64.sqrt()));
            std::array::from_fn(|k| weights.iter().zip(&inside).map(|(w, e)| w * e[k]).sum())
        })
    }

    /// Strains at a point due to each degree of freedom, and the determinant of the Jacobian.
    ///
    /// Columns `[ε_xx, ε_yy, γ_xy, ω − ½(v,x − u,y)]`.
    fn strains(&self, point: [f64; 2], centre: &Jacobian) -> ([[f64; 4]; FULL_DOF_COUNT], f64) {
        let jacobian = Jacobian::at(point, self.points);
        let mut columns = [[0.0; 4]; FULL_DOF_COUNT];
        let weights = shape(point);
        for (node, slopes) in jacobian.slopes(point).into_iter().enumerate() {
            columns[3 * node..3 * node + 2].copy_from_slice(&strains_of_slopes(slopes));
            columns[3 * node + 2][3] = weights[node];
        }
        for (first, bulge) in bulges(point).into_iter().enumerate() {
            let second = (first + 1) % 4;
            let from = self.points[first];
            let to = self.points[second];
            let across = [(to[1] - from[1]) / 8.0, (from[0] - to[0]) / 8.0];
            let bulge_strains = strains_of_slopes(jacobian.global_slopes(bulge));
            for k in 0..4 {
                let strain = across[0] * bulge_strains[0][k] + across[1] * bulge_strains[1][k];
                columns[3 * second + 2][k] += strain;
                columns[3 * first + 2][k] -= strain;
            }
        }
        // Slopes of 1 − ξ² and 1 − η² by the Jacobian at the centre, scaled so that their integrals vanish.
        let scale = -2.0 * centre.determinant / jacobian.determinant;
        let mode_xi = strains_of_slopes(centre.global_slopes([scale * point[0], 0.0]));
        let mode_eta = strains_of_slopes(centre.global_slopes([0.0, scale * point[1]]));
        columns[NODAL_DOF_COUNT..NODAL_DOF_COUNT + 2].copy_from_slice(&mode_xi);
        columns[NODAL_DOF_COUNT + 2..].copy_from_slice(&mode_eta);
        (columns, jacobian.determinant)
    }

    /// Area in the plane, m².
    fn area(&self) -> f64 {
        gauss_points().map(|point| Jacobian::at(point, self.points).determinant).iter().sum()
    }

    /// Hourglass pattern +, −, +, − of rotations without its linear part.
    ///
    /// It is orthogonal to every linear field of ω.
    fn hourglass(&self, centre: &Jacobian) -> [f64; 4] {
        let signs = NODE_COORDINATES.map(|[xi, eta]| xi * eta);
        let pairs = signs.iter().zip(self.points);
        let x: f64 = pairs.clone().map(|(sign, point)| sign * point[0]).sum();
        let y: f64 = pairs.map(|(sign, point)| sign * point[1]).sum();
        let slopes = centre.slopes([0.0; 2]);
        std::array::from_fn(|node| 0.25 * (signs[node] - x * slopes[node][0] - y * slopes[node][1]))
    }
}

/// Strains of a displacement with slopes (∂/∂x, ∂/∂y) in u and in v.
fn strains_of_slopes([dx, dy]: [f64; 2]) -> [[f64; 4]; 2] {
    [[dx, 0.0, dy, 0.5 * dy], [0.0, dy, dx, -0.5 * dx]]
}

/// Slopes (∂/∂ξ, ∂/∂η) of the bulges of the sides 1–2, 2–3, 3–4 and 4–1, such as ½(1 − ξ²)(1 − η).
fn bulges([xi, eta]: [f64; 2]) -> [[f64; 2]; 4] {
    let along_xi = 0.5 * (1.0 - xi * xi);
    let along_eta = 0.5 * (1.0 - eta * eta);
    [
        [-xi * (1.0 - eta), -along_xi],
        [along_eta, -eta * (1.0 + xi)],
        [-xi * (1.0 + eta), along_xi],
        [-along_eta, -eta * (1.0 - xi)],
    ]
}
