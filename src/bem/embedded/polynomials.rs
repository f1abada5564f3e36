//! Polynomials on the interval [0, 1].
//!
//! Lagrange functions of Lobatto's nodes, and their even and odd combinations.

use crate::linalg::gauss::{largest_rule, next_legendre};

/// Functions of the unit interval: values and derivatives at the points of a Gauss rule.
///
/// One list of points for each function.
pub(super) struct IntervalFunctions {
    values: Vec<Vec<f64>>,
    derivatives: Vec<Vec<f64>>,
}

/// Integrals of products of two sets of functions; row by row.
#[derive(Debug)]
pub(super) struct ProductIntegrals {
    column_count: usize,
    values: Vec<f64>,
}

impl ProductIntegrals {
    fn new(row_functions: &[Vec<f64>], column_functions: &[Vec<f64>]) -> Self {
        let mut values = Vec::with_capacity(row_functions.len() * column_functions.len());
        for row in row_functions {
            for column in column_functions {
                let points = largest_rule().points_on_unit_interval().zip(row.iter().zip(column));
                values.push(points.map(|((_, weight), (a, b))| weight * a * b).sum());
            }
        }
        Self { column_count: column_functions.len(), values }
    }

    /// The integrals with rows and columns exchanged.
    pub(super) fn transposed(&self) -> Self {
        let row_count = self.values.len() / self.column_count;
        let values =
            (0..self.column_count).flat_map(|j| (0..row_count).map(move |i| self.at(i, j)));
        Self { column_count: row_count, values: values.collect() }
    }

    /// The integral of the product of two functions.
    pub(super) fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.column_count + column]
    }
}

impl IntervalFunctions {
    /// Lagrange functions of the `degree` + 1 nodes, in their order.
    pub(super) fn lagrange(degree: usize) -> Self {
        let nodes = lobatto_nodes(degree);
        let mut functions = Self { values: vec![], derivatives: vec![] };
        for i in 0..=degree {
            let points = largest_rule().points_on_unit_interval().map(|(x, _)| x);
            functions.values.push(points.clone().map(|x| lagrange(&nodes, i, x)).collect());
            functions
                .derivatives
                .push(points.map(|x| lagrange_derivative(&nodes, i, x)).collect());
        }
        functions
    }

    /// Combinations that are even and odd about the middle of the interval.
    ///
    /// The first function of either set is the only one that does not vanish at the ends: it is 1 at the left end.
    pub(super) fn even_and_odd(&self) -> [Self; 2] {
        [1.0, -1.0].map(|sign| Self {
            values: combine_mirrored(&self.values, sign),
            derivatives: combine_mirrored(&self.derivatives, sign),
        })
    }

    /// Number of functions.
    pub(super) fn count(&self) -> usize {
        self.values.len()
    }

    /// ∫ f g of these functions f and the functions g of `other`.
    pub(super) fn masses(&self, other: &Self) -> ProductIntegrals {
        ProductIntegrals::new(&self.values, &other.values)
    }

    /// ∫ f′ g′ of these functions.
    pub(super) fn stiffnesses(&self) -> ProductIntegrals {
        ProductIntegrals::new(&self.derivatives, &self.derivatives)
    }

    /// ∫ f′ g of these functions f and the functions g of `other`.
    pub(super) fn derivative_products(&self, other: &Self) -> ProductIntegrals {
        ProductIntegrals::new(&self.derivatives, &other.values)
    }

    /// ∫ f: the mean of each function.
    pub(super) fn means(&self) -> Vec<f64> {
        let one = vec![vec![1.0; largest_rule().nodes.len()]];
        ProductIntegrals::new(&self.values, &one).values
    }
}

/// Number of Newton iterations for a node.
///
/// From Chebyshev's nodes, fewer iterations reach rounding.
const NEWTON_ITERATIONS: usize = 20;

/// Lobatto's nodes on [0, 1]: the ends, and the extrema of Legendre's polynomial of `degree`.
pub(super) fn lobatto_nodes(degree: usize) -> Vec<f64> {
    let n = degree as f64;
    let mut nodes = vec![];
    for i in 0..=degree {
        let mut x = -(std::f64::consts::PI * i as f64 / n).cos();
        // Newton's method at the inner nodes.
        let iterations = if i == 0 || i == degree { 0 } else { NEWTON_ITERATIONS };
        for _ in 0..iterations {
            let mut previous_value = 1.0;
            let mut value = x;
            for k in 2..=degree {
                (previous_value, value) = (value, next_legendre(k, x, [previous_value, value]));
            }
            // (1 − x²) Pₙ′ = n (Pₙ₋₁ − x Pₙ), whose derivative is −n (n + 1) Pₙ.
            x += (previous_value - x * value) / ((n + 1.0) * value);
        }
        nodes.push(0.5 * (1.0 + x));
    }
    nodes
}

/// Sums (`sign` 1) or differences (−1) of functions of mirrored nodes.
fn combine_mirrored(functions: &[Vec<f64>], sign: f64) -> Vec<Vec<f64>> {
    let degree = functions.len() - 1;
    let mut combined = vec![];
    for i in 0..=degree / 2 {
        let j = degree - i;
        let is_middle = i == j;
        // The function of a node in the middle is even.
        if is_middle && sign < 0.0 {
            continue;
        }
        let factor = if is_middle { 0.0 } else { sign };
        let value_pairs = functions[i].iter().zip(&functions[j]);
        combined.push(value_pairs.map(|(a, b)| a + factor * b).collect());
    }
    combined
}

/// Lagrange's function of node `i` at `x`.
pub(super) fn lagrange(nodes: &[f64], i: usize, x: f64) -> f64 {
    let other_nodes = (0..nodes.len()).filter(|k| *k != i);
    other_nodes.map(|k| (x - nodes[k]) / (nodes[i] - nodes[k])).product()
}

/// Derivative of Lagrange's function of node `i` at `x`.
fn lagrange_derivative(nodes: &[f64], i: usize, x: f64) -> f64 {
    let mut terms = vec![];
    for j in (0..nodes.len()).filter(|j| *j != i) {
        let other_nodes = (0..nodes.len()).filter(|k| *k != i && *k != j);
        let product: f64 = other_nodes.map(|k| (x - nodes[k]) / (nodes[i] - nodes[k])).product();
        terms.push(product / (nodes[i] - nodes[j]));
    }
    terms.iter().sum()
}
