//! Transformations between a structure's degrees of freedom and its stepping coordinates; vibration modes.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: degrees of freedom u = Φ q at modal coordinates q |

use std::sync::Arc;

use crate::linalg::matrix::{SparseMatrix, spread};
use crate::linalg::{dense_multiply_add, dot, largest, transposed_multiply_add};
use crate::structure::DofCombination;

/// (coordinate, weight) pairs.
pub(crate) type Terms = Vec<(usize, f64)>;

/// Adds `factor` times a weighted sum.
pub(crate) fn accumulate(row: &mut Terms, terms: &DofCombination, factor: f64) {
    for &(index, weight) in terms {
        match row.iter_mut().find(|(j, _)| *j == index) {
            Some((_, sum)) => *sum += factor * weight,
            None => row.push((index, factor * weight)),
        }
    }
}

/// Coordinates that are stepped, chosen once while building.
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

    /// Transforms several weighted sums of degrees of freedom.
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
            Self::Identity => force.iter_mut().zip(on_dofs).for_each(|(f, added)| *f += added),
            Self::Modes(modes) => modes.project(on_dofs, force),
        }
    }

    /// Coordinates q = Φᵀ M u of a motion of the degrees of freedom; M is their mass.
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

    /// Adds `factor` times the weights to `force`: the effect of a force on the sum.
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
    /// Writes the sums at coordinates `x` to `out`.
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

    /// The sum of a row at coordinates `x`.
    pub(crate) fn sum(&self, row: usize, x: &[f64]) -> f64 {
        match self {
            Self::Sparse(rows) => rows[row].iter().map(|&(j, weight)| weight * x[j]).sum(),
            Self::Dense(rows) => dot(&rows[row * x.len()..][..x.len()], x),
        }
    }

    /// Adds factor · rowsᵀ (scale ∘ x) to `force`; `scale` depends on the number of the row.
    pub(crate) fn add_transposed(
        &self,
        factor: f64,
        scale: impl Fn(usize) -> f64,
        x: &[f64],
        force: &mut [f64],
    ) {
        const ROW_BLOCK_SIZE: usize = 64;
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
                let mut scaled = [0.0; ROW_BLOCK_SIZE];
                let rows = rows.chunks(ROW_BLOCK_SIZE * force.len());
                for (block, (rows, x)) in rows.zip(x.chunks(ROW_BLOCK_SIZE)).enumerate() {
                    for (k, (scaled, x)) in scaled.iter_mut().zip(x).enumerate() {
                        *scaled = scale(block * ROW_BLOCK_SIZE + k) * x;
                    }
                    transposed_multiply_add(rows, factor, &scaled[..x.len()], force);
                }
            }
        }
    }
}

/// Vibration modes of a structure: all of them, or fewer Ritz modes.
///
/// In modes every matrix of the equation of motion is diagonal: Φᵀ M Φ = 1, Φᵀ K Φ = diag(λ), Φᵀ C Φ = diag(c). A
/// step costs a few operations per mode, and as many per mode and contact component for contact. A step evaluates
/// only the rows of Φ of the base and of probes.
#[derive(Debug)]
pub(crate) struct ModalBasis {
    /// λ.
    pub(crate) stiffness: Vec<f64>,
    /// c.
    pub(crate) damping: Vec<f64>,
    /// Φᵀ C Φ, row-major, of Ritz modes that the damping couples; otherwise empty.
    pub(crate) coupled_damping: Vec<f64>,
    /// Φ, row-major: a row per degree of freedom.
    vectors: Vec<f64>,
}

impl ModalBasis {
    /// The modes with these λ, c and Φ (row-major, a row per degree of freedom).
    ///
    /// They include rigid translations with λ = 0.
    pub(crate) fn of(stiffness: Vec<f64>, damping: Vec<f64>, vectors: Vec<f64>) -> Self {
        Self { stiffness, damping, coupled_damping: Vec::new(), vectors }
    }

    /// Weights by mode of a weighted sum of degrees of freedom.
    pub(crate) fn row(&self, terms: &[(usize, f64)]) -> Vec<f64> {
        let n = self.count();
        let mut weights = vec![0.0; n];
        for &(dof, weight) in terms {
            let displacements = &self.vectors[dof * n..(dof + 1) * n];
            weights.iter_mut().zip(displacements).for_each(|(w, phi)| *w += weight * phi);
        }
        weights
    }

    /// Number of modes.
    pub(crate) fn count(&self) -> usize {
        self.stiffness.len()
    }

    /// Adds Φᵀ f to `modal`; skips degrees of freedom without force.
    pub(crate) fn project(&self, force: &[f64], modal: &mut [f64]) {
        for (row, force) in self.vectors.chunks_exact(self.count()).zip(force) {
            if *force != 0.0 {
                modal.iter_mut().zip(row).for_each(|(q, phi)| *q += phi * force);
            }
        }
    }

    /// Φᵀ M u: the coordinates of u, since Φᵀ M Φ = 1.
    pub(crate) fn coordinates(&self, dofs: &[f64], mass: &SparseMatrix) -> Vec<f64> {
        let mut momentum = vec![0.0; dofs.len()];
        mass.multiply_add(1.0, dofs, &mut momentum);
        let mut modal = vec![0.0; self.count()];
        self.project(&momentum, &mut modal);
        modal
    }

    /// Modal coordinates of a rigid translation with mass matrix M: only rigid modes have a part in it.
    pub(crate) fn translation(
        &self,
        vector: &[(usize, f64)],
        mass: &SparseMatrix,
    ) -> Vec<(usize, f64)> {
        let coordinates = self.coordinates(&spread(vector, mass.order()), mass);
        let noise = 1e-12 * largest(&coordinates);
        let mut rigid = Vec::new();
        for (j, (q, stiffness)) in coordinates.into_iter().zip(&self.stiffness).enumerate() {
            if *stiffness == 0.0 && q.abs() > noise {
                rigid.push((j, q));
            }
        }
        rigid
    }

    /// Φ q.
    pub(crate) fn dofs(&self, modal: &[f64]) -> Vec<f64> {
        self.vectors.chunks_exact(self.count()).map(|row| dot(row, modal)).collect()
    }
}
