//! Means of Legendre polynomials over the elements of a patch.

use crate::bem::ContactElement;
use crate::fundamental::gauss;

/// Legendre polynomials of degree 0, 1, … on [−1, 1] stretched over a patch.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Half of the patch's length, m.
    pub(super) half: f64,
    /// Lengths of the elements, m.
    pub(super) lengths: Vec<f64>,
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
        let lengths = elements.iter().map(ContactElement::length).collect();
        Self { half, lengths, means }
    }

    /// Forgets the polynomials from `degrees` on.
    pub(super) fn truncate(&mut self, degrees: usize) {
        self.means.truncate(degrees);
    }

    /// Number of polynomials.
    pub(super) fn degrees(&self) -> usize {
        self.means.len()
    }

    /// Means of all polynomials over one element.
    pub(super) fn over(&self, element: usize) -> impl Iterator<Item = f64> {
        self.means.iter().map(move |mean| mean[element])
    }

    /// Overwrites `moments` with ∫ P τ dx, one for each degree, m·Pa.
    pub(super) fn moments(&self, traction: &[f64], moments: &mut [f64]) {
        for (moment, mean) in moments.iter_mut().zip(&self.means) {
            *moment = 0.0;
            for ((traction, length), mean) in traction.iter().zip(&self.lengths).zip(mean) {
                *moment += traction * length * mean;
            }
        }
    }

    /// Adds Σ amplitude · P to element means.
    pub(super) fn add(&self, amplitudes: &[f64], displacement: &mut [f64]) {
        for (amplitude, mean) in amplitudes.iter().zip(&self.means) {
            for (displacement, mean) in displacement.iter_mut().zip(mean) {
                *displacement += amplitude * mean;
            }
        }
    }
}
