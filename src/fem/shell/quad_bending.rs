//! Bending of the quadrilateral: MITC4.

use super::section::Section;
use crate::fem::quad4::{
    CORNERS, Jacobian, derivatives, gauss_points, integrate, natural_slopes, shape,
};

/// Degrees of freedom: w, θ1, θ2 of each node.
const ORDER: usize = 12;

/// Plate of a quadrilateral in its plane (Bathe & Dvorkin 1985).
pub(super) struct QuadBending<'a> {
    pub(super) points: &'a [[f64; 2]; 4],
    pub(super) section: &'a Section,
}

impl QuadBending<'_> {
    /// Stiffness by w, θ1, θ2 of the nodes.
    pub(super) fn stiffness(&self) -> [[f64; ORDER]; ORDER] {
        let points = gauss_points().into_iter().map(|point| (point, 1.0));
        integrate(&self.section.bending_and_shear(), points, |point| self.strains(point))
    }

    /// Strains `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]` at the corners by w, θ1, θ2 of the nodes.
    pub(super) fn corner_strains(&self, displacement: &[f64; ORDER]) -> [[f64; 5]; 4] {
        CORNERS.map(|corner| {
            let (columns, _) = self.strains(corner);
            std::array::from_fn(|k| columns.iter().zip(displacement).map(|(e, u)| e[k] * u).sum())
        })
    }

    /// Columns `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]` of all degrees of freedom, and the determinant of the Jacobian.
    fn strains(&self, point: [f64; 2]) -> ([[f64; 5]; ORDER], f64) {
        let jacobian = Jacobian::at(point, self.points);
        let mut columns = [[0.0; 5]; ORDER];
        for (node, [dx, dy]) in jacobian.slopes(point).into_iter().enumerate() {
            columns[3 * node + 1] = [0.0, -dy, -dx, 0.0, 0.0];
            columns[3 * node + 2] = [dx, 0.0, dy, 0.0, 0.0];
        }
        let [xi, eta] = point;
        let along = |axis: usize, place: f64, sides: [[f64; 2]; 2]| {
            let [low, high] = sides.map(|side| self.shear(axis, side));
            let mean = |k: usize| 0.5 * ((1.0 - place) * low[k] + (1.0 + place) * high[k]);
            std::array::from_fn::<_, ORDER, _>(mean)
        };
        let shear_xi = along(0, eta, [[0.0, -1.0], [0.0, 1.0]]);
        let shear_eta = along(1, xi, [[-1.0, 0.0], [1.0, 0.0]]);
        for (column, shears) in columns.iter_mut().zip(shear_xi.into_iter().zip(shear_eta)) {
            column[3..].copy_from_slice(&jacobian.global([shears.0, shears.1]));
        }
        (columns, jacobian.determinant)
    }

    /// Covariant shear strain w,ξ + x,ξ θ2 − y,ξ θ1 along an axis (0 for ξ, 1 for η) by each degree of freedom.
    fn shear(&self, axis: usize, point: [f64; 2]) -> [f64; ORDER] {
        let natural = natural_slopes(point);
        let (tangents, _) = derivatives(&natural, self.points);
        let weights = shape(point);
        std::array::from_fn(|k| match k % 3 {
            0 => natural[k / 3][axis],
            1 => -tangents[1][axis] * weights[k / 3],
            _ => tangents[0][axis] * weights[k / 3],
        })
    }
}
