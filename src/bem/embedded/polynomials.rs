//! Polynomials of an interval [0, 1]: Lagrange functions of Lobatto's nodes, and their even and odd combinations.

use crate::linalg::gauss::{largest, next_legendre};

/// Functions of the unit interval, by their values and slopes at points of a Gauss rule.
pub(super) struct Polynomials {
    values: Vec<Vec<f64>>,
    slopes: Vec<Vec<f64>>,
}

/// Integrals of products of two sets of functions; row by row.
pub(super) struct Integrals {
    columns: usize,
    values: Vec<f64>,
}

impl Integrals {
    fn new(rows: &[Vec<f64>], columns: &[Vec<f64>]) -> Self {
        let weights = || largest().points_on_unit_interval().map(|(_, weight)| weight);
        let product = |one: &[f64], other: &[f64]| -> f64 {
            weights().zip(one.iter().zip(other)).map(|(weight, (a, b))| weight * a * b).sum()
        };
        let values = rows.iter().flat_map(|row| columns.iter().map(|column| product(row, column)));
        Self { columns: columns.len(), values: values.collect() }
    }

    /// The integrals with rows and columns exchanged.
    pub(super) fn transposed(&self) -> Self {
        let rows = self.values.len() / self.columns;
        let values = (0..self.columns).flat_map(|j| (0..rows).map(move |i| self.at(i, j)));
        Self { columns: rows, values: values.collect() }
    }

    pub(super) fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }
}

impl Polynomials {
    /// Lagrange functions of the `degree` + 1 nodes, in their order.
    pub(super) fn lagrange(degree: usize) -> Self {
        let nodes = nodes(degree);
        let points = || largest().points_on_unit_interval().map(|(x, _)| x);
        let each = |of: &dyn Fn(usize, f64) -> f64| -> Vec<Vec<f64>> {
            (0..=degree).map(|i| points().map(|x| of(i, x)).collect()).collect()
        };
        Self {
            values: each(&|i, x| lagrange(&nodes, i, x)),
            slopes: each(&|i, x| {
                let others = (0..=degree).filter(|j| *j != i);
                let without = |j: usize| -> f64 {
                    let rest = (0..=degree).filter(|k| *k != i && *k != j);
                    rest.map(|k| (x - nodes[k]) / (nodes[i] - nodes[k])).product::<f64>()
                        / (nodes[i] - nodes[j])
                };
                others.map(without).sum()
            }),
        }
    }

    /// Combinations that are even and odd about the middle of the interval.
    ///
    /// The first function of either set is the only one that does not vanish at the ends: it is 1 at the left end.
    pub(super) fn halves(&self) -> [Self; 2] {
        let degree = self.count() - 1;
        let combined = |list: &[Vec<f64>], sign: f64| -> Vec<Vec<f64>> {
            let pairs = (0..=degree / 2).map(|i| (i, degree - i));
            // The function of a node in the middle is even.
            let found = pairs.filter(|(i, j)| i < j || sign > 0.0);
            let sum = |(i, j): (usize, usize)| {
                let other = if i < j { sign } else { 0.0 };
                list[i].iter().zip(&list[j]).map(|(a, b)| a + other * b).collect()
            };
            found.map(sum).collect()
        };
        [1.0, -1.0].map(|sign| Self {
            values: combined(&self.values, sign),
            slopes: combined(&self.slopes, sign),
        })
    }

    pub(super) fn count(&self) -> usize {
        self.values.len()
    }

    /// ∫ f g of these functions f and the `others` g.
    pub(super) fn masses(&self, others: &Self) -> Integrals {
        Integrals::new(&self.values, &others.values)
    }

    /// ∫ f′ g′.
    pub(super) fn stiffnesses(&self) -> Integrals {
        Integrals::new(&self.slopes, &self.slopes)
    }

    /// ∫ f′ g.
    pub(super) fn slopes_by(&self, others: &Self) -> Integrals {
        Integrals::new(&self.slopes, &others.values)
    }

    /// ∫ f.
    pub(super) fn means(&self) -> Vec<f64> {
        let one = vec![vec![1.0; largest().nodes.len()]];
        Integrals::new(&self.values, &one).values
    }
}

/// Lobatto's nodes on [0, 1]: the ends, and the extrema of Legendre's polynomial of `degree`.
pub(super) fn nodes(degree: usize) -> Vec<f64> {
    let n = degree as f64;
    let node = |i: usize| {
        let mut x = -(std::f64::consts::PI * i as f64 / n).cos();
        if i == 0 || i == degree {
            return x;
        }
        for _ in 0..20 {
            let mut before = 1.0;
            let mut value = x;
            for k in 2..=degree {
                (before, value) = (value, next_legendre(k, x, [before, value]));
            }
            // (1 − x²) P′ = n (P before − x P), whose slope is −n (n + 1) P.
            x += (before - x * value) / ((n + 1.0) * value);
        }
        x
    };
    (0..=degree).map(|i| 0.5 * (1.0 + node(i))).collect()
}

/// Lagrange's function of node `i` at `x`.
pub(super) fn lagrange(nodes: &[f64], i: usize, x: f64) -> f64 {
    let others = (0..nodes.len()).filter(|k| *k != i);
    others.map(|k| (x - nodes[k]) / (nodes[i] - nodes[k])).product()
}
