//! Means of Legendre polynomials over the elements of a patch.

use crate::geometry::ContactElement;
use crate::linalg::gauss;

/// Legendre polynomials of degree 0, 1, … on [−1, 1] stretched over a patch.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Half of the patch's length, m.
    pub(super) half: f64,
    /// Per degree: its means over the elements.
    means: Vec<Vec<f64>>,
}

/// Overwrites `values` with the Legendre polynomials of degree 0, 1, … at `x`.
pub(super) fn legendre(x: f64, values: &mut [f64]) {
    for degree in 0..values.len() {
        let k = degree as f64;
        values[degree] = match degree {
            0 => 1.0,
            1 => x,
            _ => ((2.0 * k - 1.0) * x * values[degree - 1] - (k - 1.0) * values[degree - 2]) / k,
        };
    }
}

impl Basis {
    pub(super) fn new(elements: &[ContactElement], degrees: usize) -> Self {
        let (first, last) = (elements[0].left, elements[elements.len() - 1].right);
        let (half, middle) = (0.5 * (last - first), 0.5 * (first + last));
        let mut means = vec![vec![0.0; elements.len()]; degrees];
        let mut values = vec![0.0; degrees];
        // A Gauss rule over each element is exact, and does not cancel on short ones.
        let rule = gauss::largest();
        for (e, element) in elements.iter().enumerate() {
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let x = element.center() - middle + 0.5 * element.length() * node;
                legendre(x / half, &mut values);
                for (mean, value) in means.iter_mut().zip(&values) {
                    mean[e] += 0.5 * weight * value;
                }
            }
        }
        Self { half, means }
    }

    /// Forgets the polynomials from `degrees` on.
    pub(super) fn truncate(&mut self, degrees: usize) {
        self.means.truncate(degrees);
    }

    /// Per polynomial: its means over the elements.
    pub(super) fn into_means(self) -> Vec<Vec<f64>> {
        self.means
    }
}
