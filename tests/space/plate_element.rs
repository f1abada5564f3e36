//! The ACM plate rectangle, and its patch test.

use basemat_problems::dense;

/// Displacement and rotations about x and y of a node: w, ∂w/∂y, −∂w/∂x.
pub(super) const NODE_DOFS: usize = 3;
/// Degrees of freedom of a plate element.
const PLATE_DOFS: usize = 4 * NODE_DOFS;
/// Points and weights of Gauss' rule of three.
const GAUSS_RULE: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];

/// The twelve monomials of an ACM rectangle: powers of x and y.
const MONOMIAL_POWERS: [[i32; 2]; PLATE_DOFS] = [
    [0, 0],
    [1, 0],
    [0, 1],
    [2, 0],
    [1, 1],
    [0, 2],
    [3, 0],
    [2, 1],
    [1, 2],
    [0, 3],
    [3, 1],
    [1, 3],
];

/// Derivative of x^power, of this order.
fn power_derivative(x: f64, power: i32, order: i32) -> f64 {
    let factor: i32 = (0..order).map(|k| power - k).product();
    if power < order { 0.0 } else { f64::from(factor) * x.powi(power - order) }
}

/// A derivative of the monomials at a point, of these orders in x and y.
fn monomials([x, y]: [f64; 2], [order_x, order_y]: [i32; 2]) -> [f64; PLATE_DOFS] {
    MONOMIAL_POWERS.map(|[a, b]| power_derivative(x, a, order_x) * power_derivative(y, b, order_y))
}

/// Second derivatives at a point of the shape functions, whose coefficients are the columns of a row-major matrix.
fn curvatures(coefficients: &[f64], point: [f64; 2], orders: [i32; 2]) -> Vec<f64> {
    let derivatives = monomials(point, orders);
    (0..PLATE_DOFS)
        .map(|j| {
            (0..PLATE_DOFS)
                .map(|k| derivatives[k] * coefficients[k * PLATE_DOFS + j])
                .sum::<f64>()
        })
        .collect()
}

/// Stiffness of the ACM plate rectangle (Adini, Clough, Melosh; Kirchhoff's theory) with these sides, row-major;
/// corners counter-clockwise from the left front one.
pub(super) fn plate_stiffness([a, b]: [f64; 2], rigidity: f64, poisson: f64) -> Vec<f64> {
    let mut nodal_values = Vec::new();
    for point in [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]] {
        nodal_values.extend(monomials(point, [0, 0]));
        nodal_values.extend(monomials(point, [0, 1]));
        nodal_values.extend(monomials(point, [1, 0]).map(|x| -x));
    }
    let coefficients = dense::inverse(&nodal_values, PLATE_DOFS);
    let mut stiffness = vec![0.0; PLATE_DOFS * PLATE_DOFS];
    for (s, s_weight) in GAUSS_RULE {
        for (t, t_weight) in GAUSS_RULE {
            let point = [0.5 * a * (1.0 + s), 0.5 * b * (1.0 + t)];
            let weight = 0.25 * a * b * s_weight * t_weight * rigidity;
            let xx = curvatures(&coefficients, point, [2, 0]);
            let yy = curvatures(&coefficients, point, [0, 2]);
            let xy = curvatures(&coefficients, point, [1, 1]);
            for i in 0..PLATE_DOFS {
                for j in 0..PLATE_DOFS {
                    let bending = xx[i] * xx[j] + yy[i] * yy[j];
                    let coupling = poisson * (xx[i] * yy[j] + yy[i] * xx[j]);
                    let twist = 2.0 * (1.0 - poisson) * xy[i] * xy[j];
                    stiffness[i * PLATE_DOFS + j] += weight * (bending + coupling + twist);
                }
            }
        }
    }
    stiffness
}

/// Corners of the plate that begins at a node.
pub(super) fn plate_corners([i, j]: [usize; 2]) -> [[usize; 2]; 4] {
    [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]]
}

/// Deflection of a plate: a rigid motion and constant curvatures.
struct DeflectionField {
    /// w, ∂w/∂x and ∂w/∂y at the origin.
    rigid_motion: [f64; 3],
    /// ∂²w/∂x², ∂²w/∂y² and ∂²w/∂x∂y.
    curvatures: [f64; 3],
}

impl DeflectionField {
    /// Degrees of freedom of a node.
    fn nodal_values(&self, x: f64, y: f64) -> [f64; NODE_DOFS] {
        let [xx, yy, xy] = self.curvatures;
        let w = self.rigid_motion[0] + self.rigid_motion[1] * x + self.rigid_motion[2] * y;
        let bending = 0.5 * xx * x * x + 0.5 * yy * y * y + xy * x * y;
        [
            w + bending,
            self.rigid_motion[2] + yy * y + xy * x,
            -(self.rigid_motion[1] + xx * x + xy * y),
        ]
    }

    /// Energy of Kirchhoff's plate.
    fn energy(&self, area: f64, rigidity: f64, poisson: f64) -> f64 {
        let [xx, yy, xy] = self.curvatures;
        0.5 * rigidity
            * area
            * (xx * xx + yy * yy + 2.0 * poisson * xx * yy + 2.0 * (1.0 - poisson) * xy * xy)
    }
}

/// Patch test: fields of constant curvature leave no force at a node within a patch of unequal rectangles, and have the
/// energy of Kirchhoff's plate; rigid motions have none.
#[test]
fn plates_pass_the_patch_test() {
    let rigidity = 3.0;
    let poisson = 0.3;
    let sides = [[1.0, 2.0], [0.7, 1.1]];
    let lines = sides.map(|[first, second]| [0.0, first, first + second]);
    for (rigid_motion, curvatures) in [
        ([1.0, 0.0, 0.0], [0.0; 3]),
        ([0.0, 2.0, -3.0], [0.0; 3]),
        ([0.0; 3], [1.0, 0.0, 0.0]),
        ([0.0; 3], [0.3, -0.8, 0.6]),
    ] {
        let field = DeflectionField { rigid_motion, curvatures };
        let mut inner_force = [0.0; NODE_DOFS];
        let mut energy = 0.0;
        for j in 0..2 {
            for i in 0..2 {
                let stiffness = plate_stiffness([sides[0][i], sides[1][j]], rigidity, poisson);
                let corners = plate_corners([i, j]);
                let u: Vec<f64> = corners
                    .iter()
                    .flat_map(|[i, j]| field.nodal_values(lines[0][*i], lines[1][*j]))
                    .collect();
                let force: Vec<f64> =
                    stiffness.chunks(PLATE_DOFS).map(|row| dense::dot(row, &u)).collect();
                energy += 0.5 * dense::dot(&force, &u);
                let inner_corner = corners.iter().position(|node| *node == [1, 1]).unwrap();
                for (sum, f) in inner_force.iter_mut().zip(&force[NODE_DOFS * inner_corner..]) {
                    *sum += f;
                }
            }
        }
        let expected = field.energy(lines[0][2] * lines[1][2], rigidity, poisson);
        assert!((energy - expected).abs() < 1e-10, "{energy} {expected}");
        assert!(inner_force.iter().all(|f| f.abs() < 1e-10), "{inner_force:?}");
    }
}
