//! From a structure's degrees of freedom to the coordinates that are stepped, and back.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: degrees of freedom u = Φ q at modal coordinates q |

use std::sync::Arc;

use super::modal_basis::ModalBasis;
use crate::linalg::matrix::SparseMatrix;
use crate::linalg::{dense_multiply_add, dot, transposed_multiply_add};

/// (coordinate, weight) pairs.
pub(crate) type Terms = Vec<(usize, f64)>;

/// Which coordinates are stepped: chosen once, while building.
#[derive(Debug, Clone)]
pub(crate) enum Transformation {
    /// The degrees of freedom themselves.
    Identity,
    /// Coordinates of modes.
    Modes(Arc<ModalBasis>),
}

impl Transformation {
    /// A weighted sum of degrees of freedom.
    pub(crate) fn row(&self, terms: &[(usize, f64)]) -> Weights {
        match self {
            Self::Modes(modes) if !terms.is_empty() => Weights::Dense(modes.row(terms)),
            _ => Weights::Sparse(terms.to_vec()),
        }
    }

    /// Several weighted sums of degrees of freedom.
    pub(crate) fn rows(&self, rows: &Rows) -> Rows {
        match (self, rows) {
            (Self::Modes(modes), Rows::Sparse(rows)) => {
                Rows::Dense(rows.iter().flat_map(|terms| modes.row(terms)).collect())
            }
            _ => rows.clone(),
        }
    }

    /// Adds forces on the degrees of freedom to `force`.
    pub(crate) fn add_forces(&self, on_dofs: &[f64], force: &mut [f64]) {
        match self {
            Self::Identity => force.iter_mut().zip(on_dofs).for_each(|(f, own)| *f += own),
            Self::Modes(modes) => modes.project(on_dofs, force),
        }
    }

    /// Coordinates of a motion of the degrees of freedom, which have this mass: q = Φᵀ M u.
    pub(crate) fn coordinates(&self, dofs: &[f64], mass: &SparseMatrix) -> Vec<f64> {
        match self {
            Self::Identity => dofs.to_vec(),
            Self::Modes(modes) => modes.coordinates(dofs, mass),
        }
    }

    /// The degrees of freedom at these coordinates.
    pub(crate) fn dofs(&self, coordinates: Vec<f64>) -> Vec<f64> {
        match self {
            Self::Identity => coordinates,
            Self::Modes(modes) => modes.dofs(&coordinates),
        }
    }
}

/// A weighted sum of coordinates.
#[derive(Debug, Clone)]
pub(crate) enum Weights {
    Sparse(Terms),
    /// A weight for every coordinate.
    Dense(Vec<f64>),
}

impl Weights {
    /// The sum at coordinates `x`.
    pub(crate) fn of(&self, x: &[f64]) -> f64 {
        match self {
            Self::Sparse(terms) => terms.iter().map(|&(i, weight)| weight * x[i]).sum(),
            Self::Dense(weights) => dot(weights, x),
        }
    }

    /// Adds `factor` times the weights to `force`: what a force on the sum does to the coordinates.
    pub(crate) fn add(&self, factor: f64, force: &mut [f64]) {
        match self {
            Self::Sparse(terms) => {
                for &(i, weight) in terms {
                    force[i] += factor * weight;
                }
            }
            Self::Dense(weights) => {
                force.iter_mut().zip(weights).for_each(|(f, weight)| *f += factor * weight);
            }
        }
    }
}

/// Weighted sums of coordinates, a row each.
#[derive(Debug, Clone)]
pub(crate) enum Rows {
    Sparse(Vec<Terms>),
    /// Row-major.
    Dense(Vec<f64>),
}

impl Rows {
    /// out ← the sums at coordinates `x`.
    pub(crate) fn multiply(&self, x: &[f64], out: &mut [f64]) {
        match self {
            Self::Sparse(rows) => {
                for (row, out) in rows.iter().zip(out) {
                    *out = row.iter().map(|&(j, weight)| weight * x[j]).sum();
                }
            }
            Self::Dense(rows) => {
                out.fill(0.0);
                dense_multiply_add(rows, 1.0, x, out);
            }
        }
    }

    /// Adds factor · rowsᵀ (scale ∘ x) to `force`, `scale` by the number of the row.
    pub(crate) fn add_transposed(
        &self,
        factor: f64,
        scale: impl Fn(usize) -> f64,
        x: &[f64],
        force: &mut [f64],
    ) {
        const BLOCK: usize = 64;
        match self {
            Self::Sparse(rows) => {
                for (i, (row, x)) in rows.iter().zip(x).enumerate() {
                    let scaled = factor * scale(i) * x;
                    for &(j, weight) in row {
                        force[j] += weight * scaled;
                    }
                }
            }
            Self::Dense(rows) => {
                let mut scaled = [0.0; BLOCK];
                let rows = rows.chunks(BLOCK * force.len());
                for (block, (rows, x)) in rows.zip(x.chunks(BLOCK)).enumerate() {
                    for (k, (scaled, x)) in scaled.iter_mut().zip(x).enumerate() {
                        *scaled = scale(block * BLOCK + k) * x;
                    }
                    transposed_multiply_add(rows, factor, &scaled[..x.len()], force);
                }
            }
        }
    }
}
