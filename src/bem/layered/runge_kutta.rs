//! The Runge–Kutta methods Radau IIA for convolution quadrature.
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

/// Frequency of the reflections that [`Stages::for_profile`] considers, Hz.
const REFLECTION_FREQUENCY: f64 = 15.0;
/// Largest phase error of these reflections with two stages, rad.
const MAX_PHASE_ERROR: f64 = 1e-3;

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

/// Eigenvalue of Δ(z): λⱼ and wⱼ λⱼ.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Node {
    pub(crate) lambda: Complex,
    pub(crate) weight: Complex,
}

impl Stages {
    /// Method by its number of stages.
    ///
    /// # Errors
    /// [`Error::Input`] unless it is 2 or 3.
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
    /// Two stages are enough if reflections at 15 Hz keep their phase to a thousandth on their way down
    /// through the layers and back: n (ωΔt)⁴/72 < 10⁻³ with n steps on the way.
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

    /// Coefficients of P and Q, constant term first.
    fn stability(self) -> [&'static [f64]; 2] {
        match self {
            Self::Two => [&[1.0, 1.0 / 3.0], &[1.0, -2.0 / 3.0, 1.0 / 6.0]],
            Self::Three => [&[1.0, 0.4, 0.05], &[1.0, -0.6, 0.15, -1.0 / 60.0]],
        }
    }

    /// Eigenvalues and weights at z; `rest` is 1 − z, passed separately so that it keeps its digits.
    ///
    /// The first is near −ln z, the second near −ln z + 2πi; each is analytic near |z| = 1.
    pub(crate) fn nodes(self, z: Complex, rest: Complex) -> impl Iterator<Item = Node> {
        let [p, q] = self.stability();
        let mut roots = match self {
            Self::Two => Self::quadratic(z, rest),
            Self::Three => Self::cubic(z, rest),
        };
        for place in 0..2 {
            let exact = -z.ln() + Complex::new(0.0, std::f64::consts::TAU * place as f64);
            let distances = roots.map(|root| (root - exact).square());
            let nearest =
                (place..self.count()).min_by(|&a, &b| distances[a].total_cmp(&distances[b]));
            roots.swap(place, nearest.unwrap_or(place));
        }
        roots.into_iter().take(self.count()).map(move |lambda| {
            let slope = derivative(q, lambda) - z * derivative(p, lambda);
            let weight = -(rest * rest * polynomial(p, lambda) / (lambda * slope));
            Node { lambda, weight }
        })
    }

    /// λ = 2 + z ± √(z² + 10z − 2), the smaller by the product 6(1 − z).
    fn quadratic(z: Complex, rest: Complex) -> [Complex; 3] {
        let middle = Complex::real(2.0) + z;
        let root = (z * z + z.scale(10.0) - Complex::real(2.0)).sqrt();
        let one = middle + root;
        let two = middle - root;
        let larger = if one.square() >= two.square() { one } else { two };
        [larger, rest.scale(6.0) / larger, Complex::default()]
    }

    /// Roots of x³ − (9−3z)x² + (36+24z)x − 60(1−z), all at once (Aberth's method).
    fn cubic(z: Complex, rest: Complex) -> [Complex; 3] {
        // With 1 − z: 9 − 3z = 6 + 3(1−z), 36 + 24z = 60 − 24(1−z).
        let c2 = -(Complex::real(6.0) + rest.scale(3.0));
        let c1 = Complex::real(60.0) - rest.scale(24.0);
        let c0 = rest.scale(-60.0);
        debug_assert!((rest + z - Complex::real(1.0)).abs() < 1e-10);
        // Near z = 1 the roots are 1 − z and 3 ± i√51.
        let mut roots =
            [rest + Complex::new(0.0, 1e-3), Complex::new(3.0, 7.0), Complex::new(3.1, -7.0)];
        for _ in 0..60 {
            let mut largest_change = 0.0_f64;
            for i in 0..3 {
                let x = roots[i];
                let value = ((x + c2) * x + c1) * x + c0;
                let slope = (x.scale(3.0) + c2.scale(2.0)) * x + c1;
                if value.square() == 0.0 {
                    continue;
                }
                let newton = slope / value;
                let others: Complex = (0..3)
                    .filter(|&j| j != i)
                    .map(|j| (roots[i] - roots[j]).inverse())
                    .fold(Complex::default(), |sum, x| sum + x);
                let step = (newton - others).inverse();
                if step.is_finite() {
                    roots[i] = roots[i] - step;
                    largest_change = largest_change.max(step.square() / roots[i].square());
                }
            }
            if largest_change < 1e-31 {
                break;
            }
        }
        roots
    }
}

/// A point z of a circle about the origin.
pub(crate) struct CirclePoint {
    pub(crate) z: Complex,
    /// 1 − z without cancellation.
    pub(crate) rest: Complex,
}

/// The point z = r e^(iφ), from ln r and φ.
pub(crate) fn on_circle(logarithm: f64, angle: f64) -> CirclePoint {
    let z = Complex::polar(logarithm.exp(), angle);
    let half_sine = (0.5 * angle).sin();
    let rest = 2.0 * half_sine * half_sine - angle.cos() * logarithm.exp_m1();
    CirclePoint { z, rest: Complex::new(rest, -z.im) }
}

/// A polynomial at `x`, constant term first.
fn polynomial(coefficients: &[f64], x: Complex) -> Complex {
    coefficients
        .iter()
        .rev()
        .fold(Complex::default(), |sum, c| sum * x + Complex::real(*c))
}

/// Derivative of the polynomial at `x`.
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

    /// A and b of the methods (Hairer & Wanner 1996, table IV.5.6).
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

    /// bᵀ (Δ − s)⁻¹ 1 by elimination against Σ wⱼ/(λⱼ − s), for s where nothing is singular.
    #[test]
    fn nodes_are_the_eigenvalues_of_the_tableau() {
        let mut worst = 0.0_f64;
        for stages in [Stages::Two, Stages::Three] {
            let (a, b) = tableau(stages);
            let m = a.len();
            for (logarithm, angle) in [
                (-0.1, 0.0),
                (-1e-3, 0.01),
                (-1e-5, 1e-6),
                (-0.07, 1.0),
                (-1.0, 2.0),
                (-1e-4, 3.1),
                (-0.3, -2.0),
            ] {
                let CirclePoint { z, rest } = on_circle(logarithm, angle);
                let nodes: Vec<Node> = stages.nodes(z, rest).collect();
                let one: Complex =
                    nodes.iter().fold(Complex::default(), |s, n| s + n.weight / n.lambda);
                assert!((one - Complex::real(1.0)).abs() < 1e-12, "{stages:?} {z:?} {one:?}");
                assert!(nodes.iter().all(|n| n.lambda.re > 0.0));
                let s = Complex::new(-1.3, 0.4);
                // (Δ − s)⁻¹ 1 = (1 − s M)⁻¹ M 1 with M = A + z/(1−z) 1bᵀ.
                let mut rows: Vec<Vec<Complex>> = vec![];
                for i in 0..m {
                    let mut row = vec![];
                    let mut sum = Complex::default();
                    for j in 0..m {
                        let entry = Complex::real(a[i][j]) + (z / rest).scale(b[j]);
                        let unit = Complex::real(if i == j { 1.0 } else { 0.0 });
                        row.push(unit - s * entry);
                        sum += entry;
                    }
                    row.push(sum);
                    rows.push(row);
                }
                for i in 0..m {
                    let pivot = rows[i][i].inverse();
                    for j in 0..=m {
                        rows[i][j] = rows[i][j] * pivot;
                    }
                    for other in 0..m {
                        if other != i {
                            let factor = rows[other][i];
                            for j in 0..=m {
                                let change = factor * rows[i][j];
                                rows[other][j] = rows[other][j] - change;
                            }
                        }
                    }
                }
                let wanted = (0..m).fold(Complex::default(), |sum, i| sum + rows[i][m].scale(b[i]));
                let found = nodes
                    .iter()
                    .fold(Complex::default(), |sum, n| sum + n.weight / n.lambda / (n.lambda - s));
                worst = worst.max((found - wanted).abs() / wanted.abs());
            }
        }
        println!("{worst:e}");
        assert!(worst < 1e-12, "{worst:e}");
    }

    /// The small root equals −ln z up to the order of the method.
    #[test]
    fn orders_are_three_and_five() {
        for (stages, constant, order) in
            [(Stages::Two, 1.0 / 72.0, 4), (Stages::Three, 1.0 / 7200.0, 6)]
        {
            let theta: f64 = 0.05;
            let CirclePoint { z, rest } = on_circle(0.0, theta);
            let smallest = stages
                .nodes(z, rest)
                .min_by(|a, b| a.lambda.square().total_cmp(&b.lambda.square()))
                .unwrap();
            let error = (smallest.lambda - Complex::new(0.0, -theta)).abs();
            assert!(
                (error / (constant * theta.powi(order)) - 1.0).abs() < 0.1,
                "{stages:?} {error:e}"
            );
        }
        assert!(Stages::from_count(4).is_err());
        assert_eq!(Stages::from_count(3).unwrap().count(), 3);
    }
}
