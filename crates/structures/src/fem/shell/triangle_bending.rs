//! Bending of the triangle: MITC3+ with a bounded linear part of the shear strains.

use super::section::ShellSection;
use crate::fem::element_matrix::{condense, recover_inner};
use crate::fem::quad4::integrate_stiffness;

/// Number of degrees of freedom of the nodes: w, θ1, θ2 of each node.
const NODAL_DOF_COUNT: usize = 9;

/// Number of degrees of freedom with the two rotations of the bubble.
const FULL_DOF_COUNT: usize = 11;

/// Derivatives (∂/∂r, ∂/∂s) of the area coordinates 1 − r − s, r, s.
const SHAPE_DERIVATIVES: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

/// Middles of the sides 1–2, 1–3 and 2–3.
const SIDE_MIDPOINTS: [[f64; 2]; 3] = [[0.5, 0.0], [0.0, 0.5], [0.5, 0.5]];

/// Tying points of the constant part of the shear strains: near the nodes 3, 2 and 1.
const TYING_POINTS: [[f64; 2]; 3] =
    [[1.0 / 6.0, 2.0 / 3.0], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 1.0 / 6.0]];

/// Coordinates (r, s) of the nodes.
const NODE_COORDINATES: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// Plate of a triangle in its plane (Lee, Lee & Bathe 2014, with one change).
///
/// The published element evaluates the linear part ĉ of its shear strains close to the centroid, where ĉ nearly
/// vanishes: the element is then almost a mechanism, or locks. Here ĉ is evaluated at the middles of the sides and
/// multiplied by t/√(t² + l²), with the longest side l.
pub(super) struct TriangleBending<'a> {
    pub(super) points: &'a [[f64; 2]; 3],
    pub(super) section: &'a ShellSection,
}

impl TriangleBending<'_> {
    /// Condensed stiffness in the first 9 rows, then the equations of the bubble.
    ///
    /// The degrees of freedom are w, θ1, θ2 of the nodes.
    pub(super) fn stiffness(&self) -> [[f64; FULL_DOF_COUNT]; FULL_DOF_COUNT] {
        let shear_fields = self.shear_fields();
        let plate_stiffness = self.section.plate_stiffness();
        let mut matrix = integrate_stiffness(&plate_stiffness, radon_rule().into_iter(), |point| {
            self.strains(point, &shear_fields)
        });
        condense(&mut matrix, NODAL_DOF_COUNT);
        matrix
    }

    /// Strains `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]` at the corners due to w, θ1, θ2 of the nodes.
    pub(super) fn corner_strains(&self, displacement: &[f64; NODAL_DOF_COUNT]) -> [[f64; 5]; 3] {
        let mut full_displacement = [0.0; FULL_DOF_COUNT];
        full_displacement[..NODAL_DOF_COUNT].copy_from_slice(displacement);
        recover_inner(&self.stiffness(), NODAL_DOF_COUNT, &mut full_displacement);
        let shear_fields = self.shear_fields();
        NODE_COORDINATES.map(|corner| {
            let columns = self.strains(corner, &shear_fields).0;
            std::array::from_fn(|k| {
                columns.iter().zip(&full_displacement).map(|(e, u)| e[k] * u).sum()
            })
        })
    }

    /// Strains at a point due to each unit degree of freedom, and the Jacobian determinant.
    ///
    /// Each entry holds `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]`.
    fn strains(
        &self,
        [r, s]: [f64; 2],
        shear_fields: &[ShearField; FULL_DOF_COUNT],
    ) -> ([[f64; 5]; FULL_DOF_COUNT], f64) {
        let tangents = self.tangents();
        let determinant = tangents[0][0] * tangents[1][1] - tangents[1][0] * tangents[0][1];
        // Derivatives (∂/∂x, ∂/∂y) from derivatives (∂/∂r, ∂/∂s).
        let global_derivatives = |[dr, ds]: [f64; 2]| {
            [
                (tangents[1][1] * dr - tangents[0][1] * ds) / determinant,
                (tangents[0][0] * ds - tangents[1][0] * dr) / determinant,
            ]
        };
        let mut columns = [[0.0; 5]; FULL_DOF_COUNT];
        for (pattern, derivatives) in rotation_derivatives([r, s]).into_iter().enumerate() {
            let [dx, dy] = global_derivatives(derivatives);
            let dofs = rotation_dofs(pattern);
            columns[dofs[0]] = [0.0, -dy, -dx, 0.0, 0.0];
            columns[dofs[1]] = [dx, 0.0, dy, 0.0, 0.0];
        }
        for (column, shear) in columns.iter_mut().zip(shear_fields) {
            let shear_r = shear.constant[0] + shear.twist * (3.0 * s - 1.0) / 3.0;
            let shear_s = shear.constant[1] + shear.twist * (1.0 - 3.0 * r) / 3.0;
            column[3..].copy_from_slice(&global_derivatives([shear_r, shear_s]));
        }
        (columns, determinant)
    }

    /// Covariant shear strains due to each unit degree of freedom.
    fn shear_fields(&self) -> [ShearField; FULL_DOF_COUNT] {
        let tying_strains = TYING_POINTS.map(|point| self.displacement_shears(point));
        let side_strains = SIDE_MIDPOINTS.map(|point| self.displacement_shears(point));
        let thickness = self.section.thickness;
        let twist_factor = thickness / thickness.hypot(self.longest_side());
        std::array::from_fn(|k| {
            // Strains at the tying points near the nodes 3, 2 and 1.
            let [shear_near_3, shear_near_2, shear_near_1] =
                tying_strains.map(|strains| strains[k]);
            let [side_12, side_13, side_23] = side_strains.map(|strains| strains[k]);
            ShearField {
                constant: [
                    2.0 / 3.0 * (shear_near_2[0] - 0.5 * shear_near_2[1])
                        + (shear_near_1[0] + shear_near_1[1]) / 3.0,
                    2.0 / 3.0 * (shear_near_3[1] - 0.5 * shear_near_3[0])
                        + (shear_near_1[0] + shear_near_1[1]) / 3.0,
                ],
                twist: twist_factor * (side_23[0] - side_12[0] - side_23[1] + side_13[1]),
            }
        })
    }

    /// Covariant shear strains of the displacement field due to each unit degree of freedom.
    ///
    /// They are w,r + x,r θ2 − y,r θ1 and w,s + x,s θ2 − y,s θ1.
    fn displacement_shears(&self, [r, s]: [f64; 2]) -> [[f64; 2]; FULL_DOF_COUNT] {
        let tangents = self.tangents();
        let mut columns = [[0.0; 2]; FULL_DOF_COUNT];
        for (node, derivatives) in SHAPE_DERIVATIVES.into_iter().enumerate() {
            columns[3 * node] = derivatives;
        }
        for (pattern, shape_value) in rotation_shapes([r, s]).into_iter().enumerate() {
            let dofs = rotation_dofs(pattern);
            columns[dofs[0]] = tangents.map(|tangent| -tangent[1] * shape_value);
            columns[dofs[1]] = tangents.map(|tangent| tangent[0] * shape_value);
        }
        columns
    }

    /// Tangent vectors ∂(x, y)/∂r and ∂(x, y)/∂s.
    fn tangents(&self) -> [[f64; 2]; 2] {
        let origin = self.points[0];
        [1, 2].map(|node| [0, 1].map(|axis| self.points[node][axis] - origin[axis]))
    }

    /// Length of the longest side, m.
    fn longest_side(&self) -> f64 {
        let mut max_length = 0.0_f64;
        for (side, start) in self.points.iter().enumerate() {
            let end = self.points[(side + 1) % 3];
            max_length = max_length.max((end[0] - start[0]).hypot(end[1] - start[1]));
        }
        max_length
    }
}

/// Covariant shear strains due to one degree of freedom; they vary linearly over the element.
struct ShearField {
    /// Strains along r and along s at the centroid.
    constant: [f64; 2],
    /// Derivative ∂/∂s of the strain along r, and minus the derivative ∂/∂r of the strain along s.
    twist: f64,
}

/// Degrees of freedom θ1 and θ2 of a node (`pattern` below 3) or of the bubble (3).
fn rotation_dofs(pattern: usize) -> [usize; 2] {
    if pattern < 3 {
        [3 * pattern + 1, 3 * pattern + 2]
    } else {
        [NODAL_DOF_COUNT, NODAL_DOF_COUNT + 1]
    }
}

/// Shape functions of the rotations of the three nodes and of the bubble.
///
/// The bubble is 27 L_1 L_2 L_3 with the area coordinates L_i. The function of a node is L_i less a third of the
/// bubble.
fn rotation_shapes([r, s]: [f64; 2]) -> [f64; 4] {
    let bubble = 27.0 * r * s * (1.0 - r - s);
    [1.0 - r - s - bubble / 3.0, r - bubble / 3.0, s - bubble / 3.0, bubble]
}

/// Derivatives (∂/∂r, ∂/∂s) of the shape functions of the rotations.
fn rotation_derivatives([r, s]: [f64; 2]) -> [[f64; 2]; 4] {
    let bubble = [27.0 * s * (1.0 - 2.0 * r - s), 27.0 * r * (1.0 - r - 2.0 * s)];
    let mut derivatives = [bubble; 4];
    for (node_derivatives, area_derivatives) in derivatives.iter_mut().zip(SHAPE_DERIVATIVES) {
        *node_derivatives =
            [area_derivatives[0] - bubble[0] / 3.0, area_derivatives[1] - bubble[1] / 3.0];
    }
    derivatives
}

/// Radon's integration rule of seven points in (r, s), exact for polynomials of degree 5.
///
/// The sum of the weights is the area 1/2.
fn radon_rule() -> [([f64; 2], f64); 7] {
    let mut points = [([1.0 / 3.0, 1.0 / 3.0], 9.0 / 80.0); 7];
    for (orbit, sign) in points[1..].chunks_exact_mut(3).zip([-1.0, 1.0]) {
        let repeated_coordinate = (6.0 + sign * 15.0_f64.sqrt()) / 21.0;
        let single_coordinate = 1.0 - 2.0 * repeated_coordinate;
        let weight = (155.0 + sign * 15.0_f64.sqrt()) / 2400.0;
        orbit[0] = ([repeated_coordinate, repeated_coordinate], weight);
        orbit[1] = ([single_coordinate, repeated_coordinate], weight);
        orbit[2] = ([repeated_coordinate, single_coordinate], weight);
    }
    points
}
