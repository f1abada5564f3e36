//! Membrane of the triangle: Felippa's optimal triangle with rotations about the normal.

use super::section::ShellSection;
use crate::fem::quad4::add_point_stiffness;

/// Number of degrees of freedom: u, v, ω of each node.
const DOF_COUNT: usize = 9;

/// Parameter α_b: bulge of a side relative to the bulge of a quadrilateral's side.
const SIDE_BULGE_RATIO: f64 = 1.5;

/// Smallest factor β₀ of the deviatoric stiffness, which would vanish as ν → 1/2 (Felippa 2003).
const MIN_DEVIATORIC_FACTOR: f64 = 0.01;

/// Factor of the stiffness of the deviatoric strains, summed over the middles of the three sides (Felippa 2003).
const DEVIATORIC_STIFFNESS_SCALE: f64 = 0.75;

/// Factors β₁ to β₉, with signs, of the natural strains due to the rotations. Indices: node, side, rotation.
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
    /// Stiffness matrix for u, v, ω of the nodes.
    pub(super) fn stiffness(&self) -> [[f64; DOF_COUNT]; DOF_COUNT] {
        let membrane_stiffness = self.section.membrane_stiffness();
        let area = self.area();
        let mut matrix = [[0.0; DOF_COUNT]; DOF_COUNT];
        add_point_stiffness(&mut matrix, &self.mean_strains(), &membrane_stiffness, area);
        let nodal_strains = [0, 1, 2].map(|node| self.deviatoric_strains(node));
        for side in 0..3 {
            let first_strains = nodal_strains[side];
            let second_strains = nodal_strains[(side + 1) % 3];
            let side_strains = std::array::from_fn(|k| mean(first_strains[k], second_strains[k]));
            let weighted_area = DEVIATORIC_STIFFNESS_SCALE * self.deviatoric_factor() * area;
            add_point_stiffness(&mut matrix, &side_strains, &membrane_stiffness, weighted_area);
        }
        matrix
    }

    /// Strains `[ε_xx, ε_yy, γ_xy]` at the corners due to u, v, ω of the nodes.
    pub(super) fn corner_strains(&self, displacement: &[f64; DOF_COUNT]) -> [[f64; 3]; 3] {
        let mean_strains = self.mean_strains();
        [0, 1, 2].map(|node| {
            let deviatoric_strains = self.deviatoric_strains(node);
            std::array::from_fn(|k| {
                let columns = mean_strains.iter().zip(&deviatoric_strains).zip(displacement);
                columns.map(|((mean, deviatoric), u)| (mean[k] + deviatoric[k]) * u).sum()
            })
        })
    }

    /// Factor β₀ of the stiffness of the deviatoric strains.
    fn deviatoric_factor(&self) -> f64 {
        (0.5 * (1.0 - 4.0 * self.section.poisson.powi(2))).max(MIN_DEVIATORIC_FACTOR)
    }

    /// Difference x_i − x_j of node coordinates, m.
    fn x(&self, i: usize, j: usize) -> f64 {
        self.points[i][0] - self.points[j][0]
    }

    /// Difference y_i − y_j of node coordinates, m.
    fn y(&self, i: usize, j: usize) -> f64 {
        self.points[i][1] - self.points[j][1]
    }

    /// Area, m².
    fn area(&self) -> f64 {
        0.5 * (self.x(1, 0) * self.y(2, 0) - self.x(2, 0) * self.y(1, 0))
    }

    /// Mean strains Lᵀ/A over the element due to each unit degree of freedom.
    fn mean_strains(&self) -> [[f64; 3]; DOF_COUNT] {
        let area = self.area();
        let side_bulges = self
            .shared_sides
            .map(|is_shared| if is_shared { 1.0 } else { SIDE_BULGE_RATIO } / 12.0);
        let mut columns = [[0.0; 3]; DOF_COUNT];
        for i in 0..3 {
            let j = (i + 1) % 3;
            let k = (i + 2) % 3;
            columns[3 * i] = [0.5 * self.y(j, k), 0.0, 0.5 * self.x(k, j)];
            columns[3 * i + 1] = [0.0, 0.5 * self.x(k, j), 0.5 * self.y(j, k)];
            // A constant stress does work on the bulges of the two sides at the node.
            let previous_bulge = side_bulges[k];
            let next_bulge = side_bulges[i];
            let x_ij = self.x(i, j);
            let y_ij = self.y(i, j);
            let x_ik = self.x(i, k);
            let y_ik = self.y(i, k);
            columns[3 * i + 2] = [
                previous_bulge * y_ik.powi(2) - next_bulge * y_ij.powi(2),
                previous_bulge * x_ik.powi(2) - next_bulge * x_ij.powi(2),
                2.0 * (next_bulge * x_ij * y_ij - previous_bulge * x_ik * y_ik),
            ];
        }
        columns.map(|column| column.map(|value| value / area))
    }

    /// Strains at a node less the mean strains, T_e Q T_θu, due to each unit degree of freedom.
    fn deviatoric_strains(&self, node: usize) -> [[f64; 3]; DOF_COUNT] {
        let area = self.area();
        let natural_to_plane = self.natural_to_plane();
        let mut rotation_strains = [[0.0; 3]; 3];
        for side in 0..3 {
            let factor = 2.0 * area / (3.0 * self.squared_side(side));
            for rotation in 0..3 {
                for k in 0..3 {
                    rotation_strains[rotation][k] += natural_to_plane[k][side]
                        * factor
                        * ROTATION_STRAIN_PARAMETERS[node][side][rotation];
                }
            }
        }
        let mut columns = [[0.0; 3]; DOF_COUNT];
        for (rotation, strain) in rotation_strains.iter().enumerate() {
            for (column, rotation_weight) in
                columns.iter_mut().zip(self.hierarchical_rotation(rotation))
            {
                for k in 0..3 {
                    column[k] += rotation_weight * strain[k];
                }
            }
        }
        columns
    }

    /// Rotation of a node less the mean rotation of the triangle due to each unit degree of freedom.
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
        let next_node = (side + 1) % 3;
        self.x(next_node, side).powi(2) + self.y(next_node, side).powi(2)
    }

    /// Transformation of the strains along the three sides to `[ε_xx, ε_yy, γ_xy]`.
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
