//! Transformation between the degrees of freedom of a structure and its stepping coordinates.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: degrees of freedom u = Φ q at modal coordinates q |

use std::sync::Arc;

use crate::linalg::matrix::{SparseMatrix, dense_vector};
use crate::linalg::{dense_multiply_add, dot, largest, transposed_multiply_add};
use crate::structure::DofCombination;

/// Sparse vector of weights: pairs of a coordinate's index and its weight.
pub(crate) type SparseVector = Vec<(usize, f64)>;

/// Adds `factor` times the weighted sum `added_terms` to the weighted sum `terms`.
pub(crate) fn accumulate(terms: &mut SparseVector, added_terms: &DofCombination, factor: f64) {
    for &(dof, weight) in added_terms {
        match terms.iter_mut().find(|(j, _)| *j == dof) {
            Some((_, sum)) => *sum += factor * weight,
            None => terms.push((dof, factor * weight)),
        }
    }
}

/// Transformation to the stepping coordinates, which the build chooses.
#[derive(Debug, Clone)]
pub(crate) enum Transformation {
    /// The degrees of freedom themselves.
    Identity,
    /// Modal coordinates.
    Modes(Arc<ModalBasis>),
}

impl Transformation {
    /// Transforms a weighted sum of degrees of freedom.
    pub(crate) fn weights(&self, terms: &[(usize, f64)]) -> Weights {
        match self {
            Self::Modes(modes) if !terms.is_empty() => Weights::Dense(modes.modal_weights(terms)),
            _ => Weights::Sparse(terms.to_vec()),
        }
    }

    /// Transforms several weighted sums of degrees of freedom.
    pub(crate) fn rows(&self, rows: &Rows) -> Rows {
        match (self, rows) {
            (Self::Modes(modes), Rows::Sparse(rows)) => {
                Rows::Dense(rows.iter().flat_map(|terms| modes.modal_weights(terms)).collect())
            }
            _ => rows.clone(),
        }
    }

    /// Transforms forces on the degrees of freedom, and adds them to `force`.
    pub(crate) fn add_forces(&self, dof_forces: &[f64], force: &mut [f64]) {
        match self {
            Self::Identity => force.iter_mut().zip(dof_forces).for_each(|(f, added)| *f += added),
            Self::Modes(modes) => modes.add_projection(dof_forces, force),
        }
    }

    /// Stepping coordinates of a motion u of the degrees of freedom.
    ///
    /// For modes they are q = Φᵀ M u.
    pub(crate) fn coordinates(&self, dofs: &[f64], mass: &SparseMatrix) -> Vec<f64> {
        match self {
            Self::Identity => dofs.to_vec(),
            Self::Modes(modes) => modes.coordinates(dofs, mass),
        }
    }

    /// Degrees of freedom at stepping coordinates.
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
    Sparse(SparseVector),
    /// A weight for every coordinate.
    Dense(Vec<f64>),
}

impl Weights {
    /// Value of the sum at coordinates `x`.
    pub(crate) fn value(&self, x: &[f64]) -> f64 {
        match self {
            Self::Sparse(terms) => terms.iter().map(|&(i, weight)| weight * x[i]).sum(),
            Self::Dense(weights) => dot(weights, x),
        }
    }

    /// Adds `factor` times the weights to `force`.
    ///
    /// This is the generalised force of a force `factor` on the sum.
    pub(crate) fn add_scaled(&self, factor: f64, force: &mut [f64]) {
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

/// Several weighted sums of coordinates, one in each row.
#[derive(Debug, Clone)]
pub(crate) enum Rows {
    Sparse(Vec<SparseVector>),
    /// Row-major.
    Dense(Vec<f64>),
}

impl Rows {
    /// Writes the values of the sums at coordinates `x` to `values`.
    pub(crate) fn multiply(&self, x: &[f64], values: &mut [f64]) {
        match self {
            Self::Sparse(rows) => {
                for (row, value) in rows.iter().zip(values) {
                    *value = row.iter().map(|&(j, weight)| weight * x[j]).sum();
                }
            }
            Self::Dense(rows) => {
                values.fill(0.0);
                dense_multiply_add(rows, 1.0, x, values);
            }
        }
    }

    /// Value of the sum in a row at coordinates `x`.
    pub(crate) fn row_value(&self, row: usize, x: &[f64]) -> f64 {
        match self {
            Self::Sparse(rows) => rows[row].iter().map(|&(j, weight)| weight * x[j]).sum(),
            Self::Dense(rows) => dot(&rows[row * x.len()..][..x.len()], x),
        }
    }

    /// Adds factor · rowsᵀ (scale ∘ x) to `force`.
    ///
    /// `scale` returns the factor of a row.
    pub(crate) fn add_transposed(
        &self,
        factor: f64,
        scale: impl Fn(usize) -> f64,
        x: &[f64],
        force: &mut [f64],
    ) {
        // Number of scaled values in the buffer, which lies on the stack.
        const ROW_BLOCK_SIZE: usize = 64;
        match self {
            Self::Sparse(rows) => {
                for (i, (row, value)) in rows.iter().zip(x).enumerate() {
                    let scaled_value = factor * scale(i) * value;
                    for &(j, weight) in row {
                        force[j] += weight * scaled_value;
                    }
                }
            }
            Self::Dense(rows) => {
                let mut scaled_values = [0.0; ROW_BLOCK_SIZE];
                let row_blocks = rows.chunks(ROW_BLOCK_SIZE * force.len());
                let value_blocks = x.chunks(ROW_BLOCK_SIZE);
                for (block, (rows, values)) in row_blocks.zip(value_blocks).enumerate() {
                    for (k, (scaled, value)) in scaled_values.iter_mut().zip(values).enumerate() {
                        *scaled = scale(block * ROW_BLOCK_SIZE + k) * value;
                    }
                    transposed_multiply_add(rows, factor, &scaled_values[..values.len()], force);
                }
            }
        }
    }
}

/// Modal coordinate of a rigid translation that counts as rounding, relative to its largest modal coordinate.
const RIGID_COORDINATE_ROUNDING: f64 = 1e-12;

/// Vibration modes of a structure: all of them, or fewer Ritz modes.
///
/// In modal coordinates every matrix of the equation of motion is diagonal: Φᵀ M Φ = 1, Φᵀ K Φ = diag(λ),
/// Φᵀ C Φ = diag(c). A step needs a few operations per mode, and a few per mode and contact component. It evaluates only
/// the rows of Φ for the base and the probes.
#[derive(Debug)]
pub(crate) struct ModalBasis {
    /// Modal stiffnesses λ, the squared circular frequencies.
    pub(crate) stiffness: Vec<f64>,
    /// Modal damping coefficients c.
    pub(crate) damping: Vec<f64>,
    /// Φᵀ C Φ, row-major, if the damping couples the modes; otherwise empty.
    pub(crate) coupled_damping: Vec<f64>,
    /// Φ, row-major: a row per degree of freedom.
    vectors: Vec<f64>,
}

impl ModalBasis {
    /// Modes with λ, c and Φ, with uncoupled damping.
    ///
    /// `vectors` is Φ, row-major, with a row per degree of freedom. The modes include rigid translations with λ = 0.
    pub(crate) fn of(stiffness: Vec<f64>, damping: Vec<f64>, vectors: Vec<f64>) -> Self {
        Self { stiffness, damping, coupled_damping: Vec::new(), vectors }
    }

    /// Modal weights of a weighted sum of degrees of freedom.
    pub(crate) fn modal_weights(&self, terms: &[(usize, f64)]) -> Vec<f64> {
        let mode_count = self.count();
        let mut weights = vec![0.0; mode_count];
        for &(dof, weight) in terms {
            let row = &self.vectors[dof * mode_count..(dof + 1) * mode_count];
            weights.iter_mut().zip(row).for_each(|(w, phi)| *w += weight * phi);
        }
        weights
    }

    /// Number of modes.
    pub(crate) fn count(&self) -> usize {
        self.stiffness.len()
    }

    /// Adds Φᵀ f to the `modal_forces`; skips degrees of freedom without force.
    pub(crate) fn add_projection(&self, forces: &[f64], modal_forces: &mut [f64]) {
        for (row, force) in self.vectors.chunks_exact(self.count()).zip(forces) {
            if *force != 0.0 {
                modal_forces.iter_mut().zip(row).for_each(|(q, phi)| *q += phi * force);
            }
        }
    }

    /// Modal coordinates Φᵀ M u of a motion u, since Φᵀ M Φ = 1.
    pub(crate) fn coordinates(&self, dofs: &[f64], mass: &SparseMatrix) -> Vec<f64> {
        let mut momentum = vec![0.0; dofs.len()];
        mass.multiply_add(1.0, dofs, &mut momentum);
        let mut coordinates = vec![0.0; self.count()];
        self.add_projection(&momentum, &mut coordinates);
        coordinates
    }

    /// Modal coordinates of a rigid translation, which are nonzero only for rigid modes.
    pub(crate) fn rigid_translation(
        &self,
        vector: &[(usize, f64)],
        mass: &SparseMatrix,
    ) -> Vec<(usize, f64)> {
        let coordinates = self.coordinates(&dense_vector(vector, mass.order()), mass);
        let rounding = RIGID_COORDINATE_ROUNDING * largest(&coordinates);
        let mut rigid_terms = Vec::new();
        for (j, (q, stiffness)) in coordinates.into_iter().zip(&self.stiffness).enumerate() {
            if *stiffness == 0.0 && q.abs() > rounding {
                rigid_terms.push((j, q));
            }
        }
        rigid_terms
    }

    /// Degrees of freedom Φ q at modal coordinates q.
    pub(crate) fn dofs(&self, coordinates: &[f64]) -> Vec<f64> {
        self.vectors.chunks_exact(self.count()).map(|row| dot(row, coordinates)).collect()
    }
}
