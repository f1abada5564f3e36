//! Membrane of the triangle: Felippa's optimal triangle with rotations about the normal.

use super::section::ShellSection;
use crate::fem::quad4::add_energy;

/// Degrees of freedom: u, v, ω of each node.
const DOF_COUNT: usize = 9;

/// Bulge of a side relative to the bulge of a quadrilateral's side: α_b.
const SIDE_BULGE_RATIO: f64 = 1.5;

/// Parameters β₁ to β₉ of the strains due to the rotations.
///
/// In rows: at node 1, 2 and 3.
const ROTATION_STRAIN_PARAMETERS: [[[f64; 3]; 3]; 3] = [
    [[1.0, 2.0, 1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, -2.0]],
    [[-2.0, -1.0, -1.0], [1.0, 1.0, 2.0], [-1.0, 0.0, 1.0]],
    [[1.0, -1.0, 0.0], [-1.0, -2.0, -1.0], [2.0, 1.0, 1.0]],
];

/// Membrane of a triangle in its plane (Felippa 2003: template of assumed natural deviatoric strains).
pub(super) struct TriangleMembrane<'a> {
    pub(super) points: &'a [[f64; 2]; 3],
    pub(super) section: &'a ShellSection,
    /// Whether the sides 1–2, 2–3 and 3–1 bulge as quadrilaterals do.
    pub(super) shared_sides: [bool; 3],
}

impl TriangleMembrane<'_> {
    /// Stiffness by u, v, ω of the nodes.
    pub(super) fn stiffness(&self) -> [[f64; DOF_COUNT]; DOF_COUNT] {
        let moduli = self.section.membrane();
        let area = self.area();
        let mut matrix = [[0.0; DOF_COUNT]; DOF_COUNT];
        add_energy(&mut matrix, &self.mean_strains(), &moduli, area);
        let strains = [0, 1, 2].map(|node| self.deviatoric_strains(node));
        for side in 0..3 {
            let first = strains[side];
            let second = strains[(side + 1) % 3];
            let middle = std::array::from_fn(|k| mean(first[k], second[k]));
            add_energy(&mut matrix, &middle, &moduli, 0.75 * self.deviatoric_factor() * area);
        }
        matrix
    }

    /// Strains `[ε_xx, ε_yy, γ_xy]` at the corners by u, v, ω of the nodes.
    pub(super) fn corner_strains(&self, displacement: &[f64; DOF_COUNT]) -> [[f64; 3]; 3] {
        let constant = self.mean_strains();
        [0, 1, 2].map(|node| {
            let linear = self.deviatoric_strains(node);
            std::array::from_fn(|k| {
                let columns = constant.iter().zip(&linear).zip(displacement);
                columns.map(|((mean, deviation), u)| (mean[k] + deviation[k]) * u).sum()
            })
        })
    }

    /// β₀: factor of the stiffness of the deviatoric strains.
    fn deviatoric_factor(&self) -> f64 {
        (0.5 * (1.0 - 4.0 * self.section.poisson.powi(2))).max(0.01)
    }

    /// x_i − x_j, m.
    fn x(&self, i: usize, j: usize) -> f64 {
        self.points[i][0] - self.points[j][0]
    }

    /// y_i − y_j, m.
    fn y(&self, i: usize, j: usize) -> f64 {
        self.points[i][1] - self.points[j][1]
    }

    fn area(&self) -> f64 {
        0.5 * (self.x(1, 0) * self.y(2, 0) - self.x(2, 0) * self.y(1, 0))
    }

    /// Mean strains, constant over the element, by each degree of freedom: Lᵀ/A.
    fn mean_strains(&self) -> [[f64; 3]; DOF_COUNT] {
        let area = self.area();
        let bulges = self
            .shared_sides
            .map(|is_shared| if is_shared { 1.0 } else { SIDE_BULGE_RATIO } / 12.0);
        let mut columns = [[0.0; 3]; DOF_COUNT];
        for i in 0..3 {
            let j = (i + 1) % 3;
            let k = (i + 2) % 3;
            columns[3 * i] = [0.5 * self.y(j, k), 0.0, 0.5 * self.x(k, j)];
            columns[3 * i + 1] = [0.0, 0.5 * self.x(k, j), 0.5 * self.y(j, k)];
            // A constant stress does work on the bulges of the side before the node and of the side after it.
            let before = bulges[k];
            let after = bulges[i];
            let x_ij = self.x(i, j);
            let y_ij = self.y(i, j);
            let x_ik = self.x(i, k);
            let y_ik = self.y(i, k);
            columns[3 * i + 2] = [
                before * y_ik.powi(2) - after * y_ij.powi(2),
                before * x_ik.powi(2) - after * x_ij.powi(2),
                2.0 * (after * x_ij * y_ij - before * x_ik * y_ik),
            ];
        }
        columns.map(|column| column.map(|value| value / area))
    }

    /// Strains at a node beyond the mean ones, T_e Q T_θu, by each degree of freedom.
    fn deviatoric_strains(&self, node: usize) -> [[f64; 3]; DOF_COUNT] {
        let area = self.area();
        let natural = self.natural_to_plane();
        let mut by_rotation = [[0.0; 3]; 3];
        for side in 0..3 {
            let factor = 2.0 * area / (3.0 * self.squared_side(side));
            for rotation in 0..3 {
                for k in 0..3 {
                    by_rotation[rotation][k] += natural[k][side]
                        * factor
                        * ROTATION_STRAIN_PARAMETERS[node][side][rotation];
                }
            }
        }
        let mut columns = [[0.0; 3]; DOF_COUNT];
        for (rotation, strain) in by_rotation.iter().enumerate() {
            for (column, weight) in columns.iter_mut().zip(self.hierarchical_rotation(rotation)) {
                for k in 0..3 {
                    column[k] += weight * strain[k];
                }
            }
        }
        columns
    }

    /// Rotation of a node less the mean rotation of the triangle, by each degree of freedom.
    fn hierarchical_rotation(&self, node: usize) -> [f64; DOF_COUNT] {
        let area = self.area();
        let mut row = [0.0; DOF_COUNT];
        for i in 0..3 {
            let j = (i + 1) % 3;
            let k = (i + 2) % 3;
            row[3 * i] = self.x(k, j) / (4.0 * area);
            row[3 * i + 1] = self.y(k, j) / (4.0 * area);
        }
        row[3 * node + 2] += 1.0;
        row
    }

    /// Squared length of the side 1–2, 2–3 or 3–1, m².
    fn squared_side(&self, side: usize) -> f64 {
        let next = (side + 1) % 3;
        self.x(next, side).powi(2) + self.y(next, side).powi(2)
    }

    /// Strains `[ε_xx, ε_yy, γ_xy]` in rows, by the strains along the three sides.
    fn natural_to_plane(&self) -> [[f64; 3]; 3] {
        let mut rows = [[0.0; 3]; 3];
        let area = self.area();
        for side in 0..3 {
            let j = (side + 1) % 3;
            let k = (side + 2) % 3;
            let x_jk = self.x(j, k);
            let y_jk = self.y(j, k);
            let x_ik = self.x(side, k);
            let y_ik = self.y(side, k);
            let factor = self.squared_side(side) / (4.0 * area * area);
            rows[0][side] = factor * y_jk * y_ik;
            rows[1][side] = factor * x_jk * x_ik;
            rows[2][side] = -factor * (y_jk * x_ik + x_jk * y_ik);
        }
        rows
    }
}

fn mean(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| 0.5 * (a[k] + b[k]))
}
