//! Polynomials of an interval [0, 1]: Lagrange functions of Lobatto's nodes, and their even and odd combinations.

use crate::linalg::gauss::{largest, next_legendre};

/// Functions of the unit interval, by their values and slopes at points of a Gauss rule.
pub(super) struct IntervalFunctions {
    values: Vec<Vec<f64>>,
    slopes: Vec<Vec<f64>>,
}

/// Integrals of products of two sets of functions; row by row.
pub(super) struct ProductIntegrals {
    columns: usize,
    values: Vec<f64>,
}

impl ProductIntegrals {
    fn new(rows: &[Vec<f64>], columns: &[Vec<f64>]) -> Self {
        let mut values = Vec::with_capacity(rows.len() * columns.len());
        for row in rows {
            for column in columns {
                let points = largest().points_on_unit_interval().zip(row.iter().zip(column));
                values.push(points.map(|((_, weight), (a, b))| weight * a * b).sum());
            }
        }
        Self { columns: columns.len(), values }
    }

    /// The integrals with rows and columns exchanged.
    pub(super) fn transposed(&self) -> Self {
        let rows = self.values.len() / self.columns;
        let values = (0..self.columns).flat_map(|j| (0..rows).map(move |i| self.at(i, j)));
        Self { columns: rows, values: values.collect() }
    }

    /// The integral of the product of two functions.
    pub(super) fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }
}

impl IntervalFunctions {
    /// Lagrange functions of the `degree` + 1 nodes, in their order.
    pub(super) fn lagrange(degree: usize) -> Self {
        let nodes = nodes(degree);
        let mut functions = Self { values: vec![], slopes: vec![] };
        for i in 0..=degree {
            let points = largest().points_on_unit_interval().map(|(x, _)| x);
            functions.values.push(points.clone().map(|x| lagrange(&nodes, i, x)).collect());
            functions.slopes.push(points.map(|x| lagrange_slope(&nodes, i, x)).collect());
        }
        functions
    }

    /// Combinations that are even and odd about the middle of the interval.
    ///
    /// The first function of either set is the only one that does not vanish at the ends: it is 1 at the left end.
    pub(super) fn halves(&self) -> [Self; 2] {
        [1.0, -1.0].map(|sign| Self {
            values: combine_mirrored(&self.values, sign),
            slopes: combine_mirrored(&self.slopes, sign),
        })
    }

    /// Number of functions.
    pub(super) fn count(&self) -> usize {
        self.values.len()
    }

    /// ∫ f g of these functions f and the `others` g.
    pub(super) fn masses(&self, others: &Self) -> ProductIntegrals {
        ProductIntegrals::new(&self.values, &others.values)
    }

    /// ∫ f′ g′.
    pub(super) fn stiffnesses(&self) -> ProductIntegrals {
        ProductIntegrals::new(&self.slopes, &self.slopes)
    }

    /// ∫ f′ g.
    pub(super) fn slopes_by(&self, others: &Self) -> ProductIntegrals {
        ProductIntegrals::new(&self.slopes, &others.values)
    }

    /// ∫ f.
    pub(super) fn means(&self) -> Vec<f64> {
        let one = vec![vec![1.0; largest().nodes.len()]];
        ProductIntegrals::new(&self.values, &one).values
    }
}

/// Lobatto's nodes on [0, 1]: the ends, and the extrema of Legendre's polynomial of `degree`.
pub(super) fn nodes(degree: usize) -> Vec<f64> {
    let n = degree as f64;
    let mut nodes = vec![];
    for i in 0..=degree {
        let mut x = -(std::f64::consts::PI * i as f64 / n).cos();
        // Newton's method at the inner nodes.
        let iterations = if i == 0 || i == degree { 0 } else { 20 };
        for _ in 0..iterations {
            let mut before = 1.0;
            let mut value = x;
            for k in 2..=degree {
                (before, value) = (value, next_legendre(k, x, [before, value]));
            }
            // (1 − x²) P′ = n (P before − x P), whose slope is −n (n + 1) P.
            x += (before - x * value) / ((n + 1.0) * value);
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
        let pairs = functions[i].iter().zip(&functions[j]);
        combined.push(pairs.map(|(a, b)| a + factor * b).collect());
    }
    combined
}

/// Lagrange's function of node `i` at `x`.
pub(super) fn lagrange(nodes: &[f64], i: usize, x: f64) -> f64 {
    let others = (0..nodes.len()).filter(|k| *k != i);
    others.map(|k| (x - nodes[k]) / (nodes[i] - nodes[k])).product()
}

/// Derivative of Lagrange's function of node `i` at `x`.
fn lagrange_slope(nodes: &[f64], i: usize, x: f64) -> f64 {
    let mut terms = vec![];
    for j in (0..nodes.len()).filter(|j| *j != i) {
        let others = (0..nodes.len()).filter(|k| *k != i && *k != j);
        let product: f64 = others.map(|k| (x - nodes[k]) / (nodes[i] - nodes[k])).product();
        terms.push(product / (nodes[i] - nodes[j]));
    }
    terms.iter().sum()
}
