//! Bending of the triangle: MITC3+ with a bound on the rotation about the normal of its shear strains.

use super::section::Section;
use crate::fem::condensation::{complete, condense};
use crate::fem::quad4::integrate;

/// Degrees of freedom of the nodes: w, θ1, θ2 each.
const OUTER: usize = 9;

/// Degrees of freedom with the two rotations of the bubble.
const ALL: usize = 11;

/// Slopes (∂/∂r, ∂/∂s) of the area coordinates 1 − r − s, r, s.
const SLOPES: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

/// Middles of the sides 1–2, 1–3 and 2–3.
const MIDDLES: [[f64; 2]; 3] = [[0.5, 0.0], [0.0, 0.5], [0.5, 0.5]];

/// Places of the constant part of the shear strains: near the nodes 3, 2 and 1.
const TYING: [[f64; 2]; 3] =
    [[1.0 / 6.0, 2.0 / 3.0], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 1.0 / 6.0]];

/// Places (r, s) of the nodes.
const NODES: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// Plate of a triangle in its plane (Lee, Lee & Bathe 2014, with one change).
///
/// The published element takes the linear part ĉ of its shear strains close to the centroid, where it nearly
/// vanishes: the element is then almost a mechanism, or locks. Here ĉ belongs to the middles of the sides and is
/// multiplied by t/√(t² + l²), l the longest side.
pub(super) struct TriangleBending<'a> {
    pub(super) points: &'a [[f64; 2]; 3],
    pub(super) section: &'a Section,
}

impl TriangleBending<'_> {
    /// Stiffness by w, θ1, θ2 of the nodes in its first 9 rows, condensed; then the equations of the bubble.
    pub(super) fn stiffness(&self) -> [[f64; ALL]; ALL] {
        let shears = self.shears();
        let moduli = self.section.bending_and_shear();
        let mut matrix =
            integrate(&moduli, rule().into_iter(), |point| self.strains(point, &shears));
        condense(&mut matrix, OUTER);
        matrix
    }

    /// Strains `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]` at the corners by w, θ1, θ2 of the nodes.
    pub(super) fn corner_strains(&self, displacement: &[f64; OUTER]) -> [[f64; 5]; 3] {
        let mut values = [0.0; ALL];
        values[..OUTER].copy_from_slice(displacement);
        complete(&self.stiffness(), OUTER, &mut values);
        let shears = self.shears();
        NODES.map(|corner| {
            let (columns, _) = self.strains(corner, &shears);
            std::array::from_fn(|k| columns.iter().zip(&values).map(|(e, u)| e[k] * u).sum())
        })
    }

    /// Columns `[κ_xx, κ_yy, 2κ_xy, γ_x, γ_y]` of all degrees of freedom, and the determinant of the Jacobian.
    fn strains(&self, [r, s]: [f64; 2], shears: &[Shear; ALL]) -> ([[f64; 5]; ALL], f64) {
        let tangents = self.tangents();
        let determinant = tangents[0][0] * tangents[1][1] - tangents[1][0] * tangents[0][1];
        // Slopes (∂/∂x, ∂/∂y) from slopes (∂/∂r, ∂/∂s).
        let global = |[dr, ds]: [f64; 2]| {
            [
                (tangents[1][1] * dr - tangents[0][1] * ds) / determinant,
                (tangents[0][0] * ds - tangents[1][0] * dr) / determinant,
            ]
        };
        let mut columns = [[0.0; 5]; ALL];
        for (pattern, slopes) in rotation_slopes([r, s]).into_iter().enumerate() {
            let [dx, dy] = global(slopes);
            let [first, second] = rotations(pattern);
            columns[first] = [0.0, -dy, -dx, 0.0, 0.0];
            columns[second] = [dx, 0.0, dy, 0.0, 0.0];
        }
        for (column, shear) in columns.iter_mut().zip(shears) {
            let along_r = shear.constant[0] + shear.twist * (3.0 * s - 1.0) / 3.0;
            let along_s = shear.constant[1] + shear.twist * (1.0 - 3.0 * r) / 3.0;
            let [x, y] = global([along_r, along_s]);
            column[3] = x;
            column[4] = y;
        }
        (columns, determinant)
    }

    /// Constant and linear part of the covariant shear strains, by each degree of freedom.
    fn shears(&self) -> [Shear; ALL] {
        let [a, b, c] = TYING.map(|point| self.displacement_shears(point));
        let [d, e, f] = MIDDLES.map(|point| self.displacement_shears(point));
        let thickness = self.section.thickness;
        let factor = thickness / thickness.hypot(self.longest_side());
        std::array::from_fn(|k| Shear {
            constant: [
                2.0 / 3.0 * (b[k][0] - 0.5 * b[k][1]) + (c[k][0] + c[k][1]) / 3.0,
                2.0 / 3.0 * (a[k][1] - 0.5 * a[k][0]) + (c[k][0] + c[k][1]) / 3.0,
            ],
            twist: factor * (f[k][0] - d[k][0] - f[k][1] + e[k][1]),
        })
    }

    /// Covariant shear strains w,r + x,r θ2 − y,r θ1 and w,s + x,s θ2 − y,s θ1 of the displacements.
    fn displacement_shears(&self, [r, s]: [f64; 2]) -> [[f64; 2]; ALL] {
        let tangents = self.tangents();
        let mut columns = [[0.0; 2]; ALL];
        for (node, slopes) in SLOPES.into_iter().enumerate() {
            columns[3 * node] = slopes;
        }
        for (pattern, weight) in rotation_shapes([r, s]).into_iter().enumerate() {
            let [first, second] = rotations(pattern);
            columns[first] = tangents.map(|tangent| -tangent[1] * weight);
            columns[second] = tangents.map(|tangent| tangent[0] * weight);
        }
        columns
    }

    /// ∂(x, y)/∂r and ∂(x, y)/∂s.
    fn tangents(&self) -> [[f64; 2]; 2] {
        let [first, second, third] = *self.points;
        [second, third].map(|[x, y]| [x - first[0], y - first[1]])
    }

    fn longest_side(&self) -> f64 {
        let side = |i: usize| {
            let [from, to] = [self.points[i], self.points[(i + 1) % 3]];
            (to[0] - from[0]).hypot(to[1] - from[1])
        };
        side(0).max(side(1)).max(side(2))
    }
}

/// Covariant shear strains of a degree of freedom, linear over the element.
struct Shear {
    /// Their values at the centroid.
    constant: [f64; 2],
    /// Their opposite slopes.
    twist: f64,
}

/// Places of θ1 and θ2 of a node, and of the bubble after the three nodes.
fn rotations(pattern: usize) -> [usize; 2] {
    if pattern < 3 { [3 * pattern + 1, 3 * pattern + 2] } else { [OUTER, OUTER + 1] }
}

/// Shape functions of the rotations of the nodes, L_i less a third of the bubble, and the bubble 27 L_1 L_2 L_3.
fn rotation_shapes([r, s]: [f64; 2]) -> [f64; 4] {
    let bubble = 27.0 * r * s * (1.0 - r - s);
    [1.0 - r - s - bubble / 3.0, r - bubble / 3.0, s - bubble / 3.0, bubble]
}

/// Slopes (∂/∂r, ∂/∂s) of the shape functions of the rotations.
fn rotation_slopes([r, s]: [f64; 2]) -> [[f64; 2]; 4] {
    let bubble = [27.0 * s * (1.0 - 2.0 * r - s), 27.0 * r * (1.0 - r - 2.0 * s)];
    let [first, second, third] =
        SLOPES.map(|slopes| [slopes[0] - bubble[0] / 3.0, slopes[1] - bubble[1] / 3.0]);
    [first, second, third, bubble]
}

/// Radon's rule of seven points in (r, s), exact to degree 5; the weights sum to 1/2.
fn rule() -> [([f64; 2], f64); 7] {
    let root = 15.0_f64.sqrt();
    let orbit = |sign: f64| {
        let [near, weight] = [(6.0 + sign * root) / 21.0, (155.0 + sign * root) / 2400.0];
        let far = 1.0 - 2.0 * near;
        [[near, near], [far, near], [near, far]].map(|point| (point, weight))
    };
    let [[a, b, c], [d, e, f]] = [orbit(-1.0), orbit(1.0)];
    [([1.0 / 3.0, 1.0 / 3.0], 9.0 / 80.0), a, b, c, d, e, f]
}
