//! Weighted sums of unknowns in the coordinates that are stepped.

use super::modal_basis::ModalBasis;
use crate::linalg::dot;

/// (unknown, weight) pairs.
pub(crate) type Terms = Vec<(usize, f64)>;

/// A weighted sum of unknowns, in the coordinates that are stepped.
#[derive(Debug, Clone)]
pub(crate) enum SteppedRow {
    /// (unknown, weight) pairs.
    Unknowns(Vec<(usize, f64)>),
    /// A weight for every mode; none for a sum of nothing.
    Modes(Vec<f64>),
}

impl SteppedRow {
    pub(crate) fn new(terms: &[(usize, f64)], modes: Option<&ModalBasis>) -> Self {
        let Some(modes) = modes else { return Self::Unknowns(terms.to_vec()) };
        if terms.is_empty() {
            return Self::Modes(Vec::new());
        }
        let n = modes.count();
        let mut weights = vec![0.0; n];
        for &(i, weight) in terms {
            weights.iter_mut().zip(modes.row(i)).for_each(|(w, phi)| *w += weight * phi);
        }
        Self::Modes(weights)
    }

    /// The sum at coordinates `x`.
    pub(crate) fn of(&self, x: &[f64]) -> f64 {
        match self {
            Self::Unknowns(terms) => terms.iter().map(|&(i, weight)| weight * x[i]).sum(),
            Self::Modes(weights) if weights.is_empty() => 0.0,
            Self::Modes(weights) => dot(weights, x),
        }
    }

    /// Adds `factor` times the weights to `force`: what a force on the sum does to the coordinates.
    pub(crate) fn add(&self, factor: f64, force: &mut [f64]) {
        match self {
            Self::Unknowns(terms) => {
                for &(i, weight) in terms {
                    force[i] += factor * weight;
                }
            }
            Self::Modes(weights) => {
                force.iter_mut().zip(weights).for_each(|(f, weight)| *f += factor * weight);
            }
        }
    }
}
