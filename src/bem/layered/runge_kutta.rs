//! Runge–Kutta methods Radau IIA for convolution quadrature.
//!
//! With Δ(z) = (A + z/(1−z) 1bᵀ)⁻¹ (Lubich & Ostermann 1993), bᵀ f(Δ) 1 = Σ wⱼ f(λⱼ) over the eigenvalues of
//! Δ. With the stability function R = P/Q, the eigenvalues are the roots of Q − zP, and
//!
//! wⱼ λⱼ = −(1−z)² P(λⱼ)/(λⱼ (Q′ − zP′)(λⱼ)),   Σ wⱼ = 1
//!
//! Both methods are algebraically stable with b > 0 and L-stable (Hairer & Wanner 1996, § IV.5, IV.12).

use crate::error::{Error, Result};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Frequency of the reflections in [`Stages::for_profile`], Hz, a high frequency of strong motion.
const REFLECTION_FREQUENCY: f64 = 15.0;
/// Largest phase error of these reflections with two stages, rad, far below the effect of errors in soil parameters.
const MAX_PHASE_ERROR: f64 = 1e-3;

/// Largest number of Aberth iterations, far above the number in which they converge.
const MAX_ROOT_ITERATIONS: usize = 60;
/// Square of the relative change of roots below which the iteration ends, a rounding error.
const ROOT_TOLERANCE_SQUARED: f64 = 1e-31;

/// Number of stages of the Runge–Kutta method for a ground in the time domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Stages {
    /// Radau IIA of order 3. Phase error per step (ωΔt)⁴/72.
    #[default]
    Two,
    /// Radau IIA of order 5. Phase error per step (ωΔt)⁶/7200.
    Three,
}

/// Eigenvalue of Δ(z) with its weight, a node of the quadrature.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Node {
    /// Eigenvalue λⱼ.
    pub(crate) lambda: Complex,
    /// Weight times eigenvalue, wⱼ λⱼ.
    pub(crate) weight: Complex,
}

impl Stages {
    /// Method with this number of stages.
    ///
    /// # Errors
    /// [`Error::Input`] unless the number is 2 or 3.
    pub fn from_count(count: usize) -> Result<Self> {
        match count {
            2 => Ok(Self::Two),
            3 => Ok(Self::Three),
            _ => Err(Error::Input {
                quantity: "number of Runge–Kutta stages",
                value: count as f64,
                needed: "2 or 3",
            }),
        }
    }

    /// Selects two stages if they are accurate enough for `profile` and `time_step`, else three.
    ///
    /// Two stages are sufficient if the phase error of reflections at 15 Hz is below 10⁻³ rad on the path down through
    /// the layers and back: n (ωΔt)⁴/72 < 10⁻³ for a travel time of n steps.
    pub fn for_profile(profile: &SoilProfile, time_step: f64) -> Self {
        let step_phase = std::f64::consts::TAU * REFLECTION_FREQUENCY * time_step;
        let phase_error = 2.0 * profile.travel_time() / time_step * step_phase.powi(4) / 72.0;
        if phase_error < MAX_PHASE_ERROR { Self::Two } else { Self::Three }
    }

    /// Number of stages.
    pub const fn count(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }

    /// Coefficients of the stability function's polynomials P and Q, constant term first.
    fn stability_polynomials(self) -> [&'static [f64]; 2] {
        match self {
            Self::Two => [&[1.0, 1.0 / 3.0], &[1.0, -2.0 / 3.0, 1.0 / 6.0]],
            Self::Three => [&[1.0, 0.4, 0.05], &[1.0, -0.6, 0.15, -1.0 / 60.0]],
        }
    }

    /// The point z with the eigenvalue `lambda`: Q/P.
    #[cfg(feature = "embedded")]
    pub(crate) fn circle_point(self, lambda: Complex) -> Complex {
        let [p, q] = self.stability_polynomials();
        polynomial(q, lambda) / polynomial(p, lambda)
    }

    /// Eigenvalues of Δ(z) with their weights; `one_less_z` is 1 − z without cancellation.
    ///
    /// The first eigenvalue is near −ln z, the second near −ln z + 2πi. Each is analytic near |z| = 1.
    pub(crate) fn nodes(self, z: Complex, one_less_z: Complex) -> impl Iterator<Item = Node> {
        let [p, q] = self.stability_polynomials();
        let mut roots = match self {
            Self::Two => Self::quadratic_roots(z, one_less_z),
            Self::Three => Self::cubic_roots(z, one_less_z),
        };
        for index in 0..2 {
            let continuous_value =
                -z.ln() + Complex::new(0.0, std::f64::consts::TAU * index as f64);
            let distances = roots.map(|root| (root - continuous_value).squared_modulus());
            let nearest_index =
                (index..self.count()).min_by(|&a, &b| distances[a].total_cmp(&distances[b]));
            roots.swap(index, nearest_index.unwrap_or(index));
        }
        roots.into_iter().take(self.count()).map(move |lambda| {
            let slope = derivative(q, lambda) - z * derivative(p, lambda);
            let weight = -(one_less_z * one_less_z * polynomial(p, lambda) / (lambda * slope));
            Node { lambda, weight }
        })
    }

    /// Eigenvalues of two stages: λ = 2 + z ± √(z² + 10z − 2).
    ///
    /// The smaller root is computed from the product 6(1 − z) of both, without cancellation.
    fn quadratic_roots(z: Complex, one_less_z: Complex) -> [Complex; 3] {
        let middle = Complex::real(2.0) + z;
        let root = (z * z + z.scale(10.0) - Complex::real(2.0)).sqrt();
        let first_root = middle + root;
        let second_root = middle - root;
        let larger_root = if first_root.squared_modulus() >= second_root.squared_modulus() {
            first_root
        } else {
            second_root
        };
        [larger_root, one_less_z.scale(6.0) / larger_root, Complex::default()]
    }

    /// Eigenvalues of three stages, roots of x³ − (9−3z)x² + (36+24z)x − 60(1−z) (Aberth's method).
    fn cubic_roots(z: Complex, one_less_z: Complex) -> [Complex; 3] {
        // With 1 − z: 9 − 3z = 6 + 3(1−z), 36 + 24z = 60 − 24(1−z).
        let c2 = -(Complex::real(6.0) + one_less_z.scale(3.0));
        let c1 = Complex::real(60.0) - one_less_z.scale(24.0);
        let c0 = one_less_z.scale(-60.0);
        debug_assert!((one_less_z + z - Complex::real(1.0)).abs() < 1e-10);
        // Near z = 1 the roots are 1 − z and 3 ± i√51.
        let mut roots =
            [one_less_z + Complex::new(0.0, 1e-3), Complex::new(3.0, 7.0), Complex::new(3.1, -7.0)];
        for _ in 0..MAX_ROOT_ITERATIONS {
            let mut max_relative_change = 0.0_f64;
            for i in 0..3 {
                let x = roots[i];
                let value = ((x + c2) * x + c1) * x + c0;
                let derivative = (x.scale(3.0) + c2.scale(2.0)) * x + c1;
                if value.squared_modulus() == 0.0 {
                    continue;
                }
                let newton_term = derivative / value;
                let repulsion: Complex = (0..3)
                    .filter(|&j| j != i)
                    .map(|j| (roots[i] - roots[j]).inverse())
                    .fold(Complex::default(), |sum, x| sum + x);
                let correction = (newton_term - repulsion).inverse();
                if correction.is_finite() {
                    roots[i] = roots[i] - correction;
                    max_relative_change = max_relative_change
                        .max(correction.squared_modulus() / roots[i].squared_modulus());
                }
            }
            if max_relative_change < ROOT_TOLERANCE_SQUARED {
                break;
            }
        }
        roots
    }
}

/// Point z of a circle about the origin.
pub(crate) struct CirclePoint {
    pub(crate) z: Complex,
    /// 1 − z without cancellation.
    pub(crate) one_less_z: Complex,
}

/// Point z = r e^(iφ) of a circle, from ln r and φ.
pub(crate) fn on_circle(log_radius: f64, angle: f64) -> CirclePoint {
    let z = Complex::polar(log_radius.exp(), angle);
    let half_sine = (0.5 * angle).sin();
    let real_part = 2.0 * half_sine * half_sine - angle.cos() * log_radius.exp_m1();
    CirclePoint { z, one_less_z: Complex::new(real_part, -z.im) }
}

/// Value of a polynomial at `x`, constant term first.
fn polynomial(coefficients: &[f64], x: Complex) -> Complex {
    coefficients
        .iter()
        .rev()
        .fold(Complex::default(), |sum, c| sum * x + Complex::real(*c))
}

/// Value of a polynomial's derivative at `x`, constant term first.
fn derivative(coefficients: &[f64], x: Complex) -> Complex {
    let mut sum = Complex::default();
    for (degree, c) in coefficients.iter().enumerate().skip(1).rev() {
        sum = sum * x + Complex::real(degree as f64 * c);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Matrix A and weights b of the methods (Hairer & Wanner 1996, table IV.5.6).
    fn tableau(stages: Stages) -> (Vec<Vec<f64>>, Vec<f64>) {
        let root = 6.0_f64.sqrt();
        let a = match stages {
            Stages::Two => vec![vec![5.0 / 12.0, -1.0 / 12.0], vec![0.75, 0.25]],
            Stages::Three => vec![
                vec![
                    (88.0 - 7.0 * root) / 360.0,
                    (296.0 - 169.0 * root) / 1800.0,
                    (-2.0 + 3.0 * root) / 225.0,
                ],
                vec![
                    (296.0 + 169.0 * root) / 1800.0,
                    (88.0 + 7.0 * root) / 360.0,
                    (-2.0 - 3.0 * root) / 225.0,
                ],
                vec![(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
            ],
        };
        let b = a[a.len() - 1].clone();
        (a, b)
    }

    /// Σ wⱼ/(λⱼ − s) equals bᵀ (Δ − s)⁻¹ 1 by elimination, at an s away from all eigenvalues.
    #[test]
    fn nodes_are_the_eigenvalues_of_the_tableau() {
        let mut max_error = 0.0_f64;
        for stages in [Stages::Two, Stages::Three] {
            let (a, b) = tableau(stages);
            let stage_count = a.len();
            for (log_radius, angle) in [
                (-0.1, 0.0),
                (-1e-3, 0.01),
                (-1e-5, 1e-6),
                (-0.07, 1.0),
                (-1.0, 2.0),
                (-1e-4, 3.1),
                (-0.3, -2.0),
            ] {
                let CirclePoint { z, one_less_z } = on_circle(log_radius, angle);
                let nodes: Vec<Node> = stages.nodes(z, one_less_z).collect();
                let weight_sum: Complex = nodes
                    .iter()
                    .fold(Complex::default(), |sum, node| sum + node.weight / node.lambda);
                assert!(
                    (weight_sum - Complex::real(1.0)).abs() < 1e-12,
                    "{stages:?} {z:?} {weight_sum:?}"
                );
                assert!(nodes.iter().all(|n| n.lambda.re > 0.0));
                let s = Complex::new(-1.3, 0.4);
                // (Δ − s)⁻¹ 1 = (1 − s M)⁻¹ M 1 with M = A + z/(1−z) 1bᵀ.
                let mut rows: Vec<Vec<Complex>> = vec![];
                for i in 0..stage_count {
                    let mut row = vec![];
                    let mut sum = Complex::default();
                    for j in 0..stage_count {
                        let entry = Complex::real(a[i][j]) + (z / one_less_z).scale(b[j]);
                        let identity = Complex::real(if i == j { 1.0 } else { 0.0 });
                        row.push(identity - s * entry);
                        sum += entry;
                    }
                    row.push(sum);
                    rows.push(row);
                }
                for i in 0..stage_count {
                    let pivot = rows[i][i].inverse();
                    for j in 0..=stage_count {
                        rows[i][j] = rows[i][j] * pivot;
                    }
                    for other_row in 0..stage_count {
                        if other_row != i {
                            let factor = rows[other_row][i];
                            for j in 0..=stage_count {
                                let product = factor * rows[i][j];
                                rows[other_row][j] = rows[other_row][j] - product;
                            }
                        }
                    }
                }
                let expected = (0..stage_count)
                    .fold(Complex::default(), |sum, i| sum + rows[i][stage_count].scale(b[i]));
                let computed = nodes
                    .iter()
                    .fold(Complex::default(), |sum, n| sum + n.weight / n.lambda / (n.lambda - s));
                max_error = max_error.max((computed - expected).abs() / expected.abs());
            }
        }
        println!("{max_error:e}");
        assert!(max_error < 1e-12, "{max_error:e}");
    }

    /// The smallest eigenvalue equals −ln z up to an error of the method's order.
    #[test]
    fn orders_are_three_and_five() {
        for (stages, constant, order) in
            [(Stages::Two, 1.0 / 72.0, 4), (Stages::Three, 1.0 / 7200.0, 6)]
        {
            let theta: f64 = 0.05;
            let CirclePoint { z, one_less_z } = on_circle(0.0, theta);
            let smallest_node = stages
                .nodes(z, one_less_z)
                .min_by(|a, b| a.lambda.squared_modulus().total_cmp(&b.lambda.squared_modulus()))
                .unwrap();
            let error = (smallest_node.lambda - Complex::new(0.0, -theta)).abs();
            assert!(
                (error / (constant * theta.powi(order)) - 1.0).abs() < 0.1,
                "{stages:?} {error:e}"
            );
        }
        assert!(Stages::from_count(4).is_err());
        assert_eq!(Stages::from_count(3).unwrap().count(), 3);
    }
}
