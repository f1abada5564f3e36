//! Membrane of the triangle: Felippa's optimal triangle with rotations about the normal.

use super::section::Section;
use crate::fem::quad4::add_energy;

/// Degrees of freedom: u, v, ω of each node.
const ORDER: usize = 9;

/// Bulge of a side by the rotations of its ends, relative to the bulge of a quadrilateral's side: α_b.
const BULGE: f64 = 1.5;

/// Parameters β₁ to β₉ of the strains by the rotations, in rows: at node 1, 2 and 3.
const PARAMETERS: [[[f64; 3]; 3]; 3] = [
    [[1.0, 2.0, 1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, -2.0]],
    [[-2.0, -1.0, -1.0], [1.0, 1.0, 2.0], [-1.0, 0.0, 1.0]],
    [[1.0, -1.0, 0.0], [-1.0, -2.0, -1.0], [2.0, 1.0, 1.0]],
];

/// Membrane of a triangle in its plane (Felippa 2003: template of assumed natural deviatoric strains).
pub(super) struct TriangleMembrane<'a> {
    pub(super) points: &'a [[f64; 2]; 3],
    pub(super) section: &'a Section,
    /// Whether the sides 1–2, 2–3 and 3–1 bulge as quadrilaterals do.
    pub(super) shared: [bool; 3],
}

impl TriangleMembrane<'_> {
    /// Stiffness by u, v, ω of the nodes.
    pub(super) fn stiffness(&self) -> [[f64; ORDER]; ORDER] {
        let moduli = self.section.membrane();
        let area = self.area();
        let mut matrix = [[0.0; ORDER]; ORDER];
        add_energy(&mut matrix, &self.mean_strains(), &moduli, area);
        let strains = [0, 1, 2].map(|node| self.deviatoric_strains(node));
        for side in 0..3 {
            let [a, b] = [strains[side], strains[(side + 1) % 3]];
            let middle = std::array::from_fn(|k| mean(a[k], b[k]));
            add_energy(&mut matrix, &middle, &moduli, 0.75 * self.share() * area);
        }
        matrix
    }

    /// Strains `[ε_xx, ε_yy, γ_xy]` at the corners by u, v, ω of the nodes.
    pub(super) fn corner_strains(&self, displacement: &[f64; ORDER]) -> [[f64; 3]; 3] {
        let constant = self.mean_strains();
        [0, 1, 2].map(|node| {
            let linear = self.deviatoric_strains(node);
            std::array::from_fn(|k| {
                let columns = constant.iter().zip(&linear).zip(displacement);
                columns.map(|((mean, own), u)| (mean[k] + own[k]) * u).sum()
            })
        })
    }

    /// β₀: factor of the stiffness of the deviatoric strains.
    fn share(&self) -> f64 {
        (0.5 * (1.0 - 4.0 * self.section.poisson.powi(2))).max(0.01)
    }

    /// x_i − x_j or y_i − y_j, by axis.
    fn between(&self, axis: usize, i: usize, j: usize) -> f64 {
        self.points[i][axis] - self.points[j][axis]
    }

    fn area(&self) -> f64 {
        let x = |i, j| self.between(0, i, j);
        let y = |i, j| self.between(1, i, j);
        0.5 * (x(1, 0) * y(2, 0) - x(2, 0) * y(1, 0))
    }

    /// Mean strains, constant over the element, by each degree of freedom: Lᵀ/A.
    fn mean_strains(&self) -> [[f64; 3]; ORDER] {
        let x = |i, j| self.between(0, i, j);
        let y = |i, j| self.between(1, i, j);
        let area = self.area();
        let bulges = self.shared.map(|shared| if shared { 1.0 } else { BULGE } / 12.0);
        let mut columns = [[0.0; 3]; ORDER];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            columns[3 * i] = [0.5 * y(j, k), 0.0, 0.5 * x(k, j)];
            columns[3 * i + 1] = [0.0, 0.5 * x(k, j), 0.5 * y(j, k)];
            // A constant stress does work on the bulges of the side before the node and of the side after it.
            let [before, after] = [bulges[k], bulges[i]];
            columns[3 * i + 2] = [
                before * y(i, k).powi(2) - after * y(i, j).powi(2),
                before * x(i, k).powi(2) - after * x(i, j).powi(2),
                2.0 * (after * x(i, j) * y(i, j) - before * x(i, k) * y(i, k)),
            ];
        }
        columns.map(|column| column.map(|value| value / area))
    }

    /// Strains at a node beyond the mean ones, T_e Q T_θu, by each degree of freedom.
    fn deviatoric_strains(&self, node: usize) -> [[f64; 3]; ORDER] {
        let area = self.area();
        let natural = self.natural_to_plane();
        let mut by_rotation = [[0.0; 3]; 3];
        for side in 0..3 {
            let factor = 2.0 * area / (3.0 * self.squared_side(side));
            for rotation in 0..3 {
                for k in 0..3 {
                    by_rotation[rotation][k] +=
                        natural[k][side] * factor * PARAMETERS[node][side][rotation];
                }
            }
        }
        let mut columns = [[0.0; 3]; ORDER];
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
    fn hierarchical_rotation(&self, node: usize) -> [f64; ORDER] {
        let area = self.area();
        let mut row = [0.0; ORDER];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            row[3 * i] = self.between(0, k, j) / (4.0 * area);
            row[3 * i + 1] = self.between(1, k, j) / (4.0 * area);
        }
        row[3 * node + 2] += 1.0;
        row
    }

    /// Squared length of the side 1–2, 2–3 or 3–1, m².
    fn squared_side(&self, side: usize) -> f64 {
        let next = (side + 1) % 3;
        self.between(0, next, side).powi(2) + self.between(1, next, side).powi(2)
    }

    /// Strains `[ε_xx, ε_yy, γ_xy]` in rows, by the strains along the three sides.
    fn natural_to_plane(&self) -> [[f64; 3]; 3] {
        let mut rows = [[0.0; 3]; 3];
        let area = self.area();
        for side in 0..3 {
            let (i, j, k) = (side, (side + 1) % 3, (side + 2) % 3);
            let [x_jk, x_ik] = [self.between(0, j, k), self.between(0, i, k)];
            let [y_jk, y_ik] = [self.between(1, j, k), self.between(1, i, k)];
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
