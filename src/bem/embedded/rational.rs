//! Compliances between samples: rational functions of the Laplace variable s.
//!
//! r(s) = Σ wⱼ Fⱼ/(s − sⱼ) / Σ wⱼ/(s − sⱼ) takes the value Fⱼ at each node sⱼ. Conjugate nodes have conjugate values and
//! weights. All functions share the weights, which make Σᵢ |Σ wⱼ (Fᵢ − Fⱼ)/(sᵢ − sⱼ)|² small over samples i that are not
//! nodes (AAA: Nakatsukasa, Sète & Trefethen, SIAM J. Sci. Comput. 40, 2018). A few sums of the functions with random
//! signs stand for all functions there.

use crate::linalg::{Complex, add_combined_rows, dot};

/// Number of sums with random signs.
const SUM_COUNT: usize = 16;
/// First state of the random signs.
const SIGN_SEED: u64 = 0x9e37_79b9_7f4a_7c15;
/// First of the bits of a state that are signs: lower bits are less random.
const FIRST_SIGN_BIT: usize = 20;
/// Every sixth sample is not a node.
const SAMPLES_PER_CHECK: usize = 6;
/// Number of inverse iterations for the weights.
const INVERSE_ITERATIONS: usize = 4;
/// Smallest diagonal entry of the triangle, relative to its first entry: a rounding error.
const MIN_DIAGONAL_RATIO: f64 = 1e-16;

/// Compliances of all classes at a Laplace variable with Im s > 0.
#[derive(Debug)]
pub(super) struct Sample<const KINDS: usize> {
    pub(super) s: Complex,
    pub(super) values: Vec<[Complex; KINDS]>,
    /// For each class, the geometric mean of the compliances of its two elements.
    pub(super) scales: Vec<f64>,
}

/// Sums of all compliances with random signs at a sample.
#[derive(Debug, Clone)]
pub(super) struct SampleSums {
    s: Complex,
    pub(super) sums: [Complex; SUM_COUNT],
    /// Root mean square of the scales of the sample's classes.
    pub(super) scale: f64,
}

impl SampleSums {
    /// Sums of the compliances divided by `scales`, one for each class.
    pub(super) fn new<const KINDS: usize>(sample: &Sample<KINDS>, scales: &[f64]) -> Self {
        let mut sums = [Complex::default(); SUM_COUNT];
        let mut signs = SIGN_SEED;
        for (values, scale) in sample.values.iter().zip(scales) {
            for value in values {
                signs = next_signs(signs);
                for (k, sum) in sums.iter_mut().enumerate() {
                    let is_positive = signs >> (k + FIRST_SIGN_BIT) & 1 == 0;
                    *sum += value.scale(if is_positive { 1.0 } else { -1.0 } / scale);
                }
            }
        }
        let ratios = sample.scales.iter().zip(scales).map(|(scale, reference)| scale / reference);
        let scale = (ratios.map(|ratio| ratio * ratio).sum::<f64>()).sqrt();
        Self { s: sample.s, sums, scale }
    }
}

/// Next state of the random signs: one bit for the sign of each sum (xorshift, Marsaglia 2003).
fn next_signs(mut signs: u64) -> u64 {
    signs ^= signs << 13;
    signs ^= signs >> 7;
    signs ^ signs << 17
}

/// Nodes and weights of rational functions.
#[derive(Debug)]
pub(super) struct RationalWeights {
    /// Index of each node among the samples.
    pub(super) samples: Vec<usize>,
    nodes: Vec<Complex>,
    weights: Vec<Complex>,
}

/// Factors of the value of a node and of its conjugate in a value of the rational functions.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeFactors {
    value: Complex,
    conjugate: Complex,
}

impl NodeFactors {
    /// Contribution of the node's value.
    #[inline]
    pub(super) fn product(self, node_value: Complex) -> Complex {
        self.value * node_value + self.conjugate * node_value.conj()
    }
}

impl RationalWeights {
    /// Weights for `samples` along a curve, of which every sixth from `first_check` on is not a node.
    pub(super) fn new(samples: &[SampleSums], first_check: usize) -> Self {
        let is_check = |index: &usize| index % SAMPLES_PER_CHECK == first_check;
        let checks: Vec<usize> = (0..samples.len()).filter(is_check).collect();
        let node_samples: Vec<usize> =
            (0..samples.len()).filter(|index| !is_check(index)).collect();
        let mut columns = vec![];
        for node in &node_samples {
            columns.extend(residual_columns(samples, &checks, &samples[*node]));
        }
        let solution = smallest_combination(columns);
        let weights = solution.chunks_exact(2).map(|parts| Complex::new(parts[0], parts[1]));
        Self {
            nodes: node_samples.iter().map(|node| samples[*node].s).collect(),
            samples: node_samples,
            weights: weights.collect(),
        }
    }

    /// Factors of all nodes at `s`.
    pub(super) fn factors(&self, s: Complex) -> Vec<NodeFactors> {
        let zero = NodeFactors { value: Complex::default(), conjugate: Complex::default() };
        let mut factors = vec![zero; self.nodes.len()];
        let mut sum = Complex::default();
        for ((node, weight), factors) in self.nodes.iter().zip(&self.weights).zip(&mut factors) {
            let differences = [s - *node, s - node.conj()];
            if differences.iter().any(|difference| difference.squared_modulus() == 0.0) {
                return self.factors_at_node(s);
            }
            factors.value = *weight / differences[0];
            factors.conjugate = weight.conj() / differences[1];
            sum += factors.value + factors.conjugate;
        }
        let inverse_sum = sum.inverse();
        for NodeFactors { value, conjugate } in &mut factors {
            *value = *value * inverse_sum;
            *conjugate = *conjugate * inverse_sum;
        }
        factors
    }

    /// Factors at a node or its conjugate: one for the value there.
    fn factors_at_node(&self, s: Complex) -> Vec<NodeFactors> {
        let factor = |is_there| Complex::real(if is_there { 1.0 } else { 0.0 });
        let factors = self.nodes.iter().map(|node| NodeFactors {
            value: factor(*node == s),
            conjugate: factor(node.conj() == s && *node != s),
        });
        factors.collect()
    }
}

/// Residuals at the `checks` for a unit and for an imaginary unit weight of a node.
fn residual_columns(samples: &[SampleSums], checks: &[usize], node: &SampleSums) -> [Vec<f64>; 2] {
    let mut columns = [vec![], vec![]];
    for check in checks {
        let SampleSums { s, sums, scale } = &samples[*check];
        let inverse = (*s - node.s).inverse().scale(1.0 / scale);
        let conjugate_inverse = (*s - node.s.conj()).inverse().scale(1.0 / scale);
        for (sum, node_sum) in sums.iter().zip(&node.sums) {
            let residual = (*sum - *node_sum) * inverse;
            let conjugate_residual = (*sum - node_sum.conj()) * conjugate_inverse;
            let real = residual + conjugate_residual;
            let difference = residual - conjugate_residual;
            columns[0].extend([real.re, real.im]);
            columns[1].extend([-difference.im, difference.re]);
        }
    }
    columns
}

/// Factors x with |x| = 1 for which the sum of the `columns` times x is nearly as small as possible.
fn smallest_combination(columns: Vec<Vec<f64>>) -> Vec<f64> {
    let triangle = orthogonal_triangle(columns);
    let count = triangle.len();
    let mut x = vec![1.0; count];
    // Inverse iteration: x ← (RᵀR)⁻¹ x.
    for _ in 0..INVERSE_ITERATIONS {
        for j in 0..count {
            x[j] /= triangle[j][j];
            for k in j + 1..count {
                x[k] -= triangle[j][k] * x[j];
            }
        }
        for j in (0..count).rev() {
            let sum = dot(&triangle[j][j + 1..], &x[j + 1..]);
            x[j] = (x[j] - sum) / triangle[j][j];
        }
        let norm = dot(&x, &x).sqrt();
        for value in &mut x {
            *value /= norm;
        }
    }
    x
}

/// Triangle R of the QR factorization of the `columns` (modified Gram–Schmidt), row by row.
fn orthogonal_triangle(mut columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let count = columns.len();
    let mut triangle = vec![vec![0.0; count]; count];
    for j in 0..count {
        let (before, after) = columns.split_at_mut(j + 1);
        let column = &mut before[j];
        let norm = dot(column, column).sqrt();
        let min_norm = MIN_DIAGONAL_RATIO * triangle[0][0];
        triangle[j][j] = norm.max(min_norm).max(f64::MIN_POSITIVE);
        for value in column.iter_mut() {
            *value /= triangle[j][j];
        }
        for (k, other) in after.iter_mut().enumerate() {
            let product = dot(column, other);
            triangle[j][j + 1 + k] = product;
            for (value, direction) in other.iter_mut().zip(column.iter()) {
                *value -= product * direction;
            }
        }
    }
    triangle
}

/// Compliances of all classes as rational functions.
#[derive(Debug)]
pub(super) struct RationalCompliances<const KINDS: usize> {
    weights: RationalWeights,
    /// Real parts of all compliances at the first node, then imaginary parts; the same at the other nodes.
    node_values: Vec<f64>,
}

impl<const KINDS: usize> RationalCompliances<KINDS> {
    /// Rational functions with these `weights` through `samples`.
    pub(super) fn new(weights: RationalWeights, samples: &[&Sample<KINDS>]) -> Self {
        let mut node_values = vec![];
        for node in &weights.samples {
            let values = samples[*node].values.as_flattened();
            node_values.extend(values.iter().map(|value| value.re));
            node_values.extend(values.iter().map(|value| value.im));
        }
        Self { weights, node_values }
    }

    /// Number of nodes.
    #[cfg(test)]
    pub(super) fn node_count(&self) -> usize {
        self.weights.nodes.len()
    }

    /// Overwrites `values`, one per class, with the compliances at `s`.
    pub(super) fn evaluate(&self, s: Complex, values: &mut [[Complex; KINDS]]) {
        // With real and imaginary parts x and y, a (x + iy) + b (x − iy) = (a + b) x + i (a − b) y.
        let mut factors = vec![];
        for NodeFactors { value, conjugate } in self.weights.factors(s) {
            let sum = value + conjugate;
            let difference = value - conjugate;
            factors.extend([sum.re, sum.im, -difference.im, difference.re]);
        }
        let function_count = KINDS * values.len();
        let mut sums = vec![0.0; 2 * function_count];
        add_combined_rows(&factors, &self.node_values, function_count, 1.0, &mut sums);
        let (real_parts, imaginary_parts) = sums.split_at(function_count);
        let parts = real_parts.iter().zip(imaginary_parts);
        for (value, (re, im)) in values.as_flattened_mut().iter_mut().zip(parts) {
            *value = Complex::new(*re, *im);
        }
    }
}
