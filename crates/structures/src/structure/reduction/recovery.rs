//! Recovery of the full model's degrees of freedom from a reduced model.

use std::sync::Arc;

use crate::error::{Result, same_length};
use crate::linalg::{SparseMatrix, row_products, transposed_multiply_add};
use crate::structure::DofCombination;
use crate::structure::probe::Probe;

/// Columns of A T computed at a time.
const COLUMNS_PER_BLOCK: usize = 16;

/// The basis T of a reduction, u = T q.
#[derive(Debug)]
pub(super) struct Basis {
    /// Degrees of freedom of the full model that are among q.
    kept: Vec<usize>,
    /// Tᵀ, row-major: for each reduced degree of freedom a row over the full model's.
    transposed: Vec<f64>,
    full: usize,
}

impl Basis {
    pub(super) fn new(kept: Vec<usize>, transposed: Vec<f64>, full: usize) -> Self {
        Self { kept, transposed, full }
    }

    /// Degrees of freedom of the full model that the reduced model keeps.
    pub(super) fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// Number of reduced degrees of freedom.
    pub(super) fn order(&self) -> usize {
        self.transposed.len() / self.full.max(1)
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.transposed.chunks_exact(self.full.max(1))
    }

    /// Tᵀ A T for a symmetric matrix, row-major, symmetric to the last bit.
    pub(super) fn congruence(&self, matrix: &SparseMatrix) -> Vec<f64> {
        let order = self.order();
        let mut result = vec![0.0; order * order];
        if matrix.is_empty() {
            return result;
        }
        for (block, rows) in self.transposed.chunks(COLUMNS_PER_BLOCK * self.full).enumerate() {
            let mut products = vec![0.0; rows.len()];
            for (row, product) in
                rows.chunks_exact(self.full).zip(products.chunks_exact_mut(self.full))
            {
                matrix.multiply_add(1.0, row, product);
            }
            let columns = rows.len() / self.full;
            // Rows after the block are the columns of later blocks.
            let upto = (COLUMNS_PER_BLOCK * block + columns) * self.full;
            let entries = row_products(&self.transposed[..upto], &products, self.full);
            for (place, value) in entries.iter().enumerate() {
                let i = place / columns;
                let j = COLUMNS_PER_BLOCK * block + place % columns;
                if i <= j {
                    result[i * order + j] = *value;
                    result[j * order + i] = *value;
                }
            }
        }
        result
    }
}

/// Recovers the full model's degrees of freedom from a [`ReducedModel`](crate::structure::ReducedModel).
#[derive(Debug, Clone)]
pub struct Recovery {
    basis: Arc<Basis>,
}

impl Recovery {
    pub(super) fn new(basis: Arc<Basis>) -> Self {
        Self { basis }
    }

    /// Number of degrees of freedom of the full model.
    pub fn full_dofs(&self) -> usize {
        self.basis.full
    }

    /// The kept degrees of freedom of the full model.
    ///
    /// They are the first ones of the reduced model, in this order.
    pub fn kept(&self) -> &[usize] {
        &self.basis.kept
    }

    /// Converts a weighted sum of the full model's degrees of freedom to the reduced model's.
    ///
    /// For a spring or a deformed shape.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a degree of freedom that the full model does not have,
    /// [`Error::Input`](crate::Error::Input) for a weight that is not finite.
    pub fn row(&self, row: impl Into<DofCombination>) -> Result<DofCombination> {
        let full = row.into();
        full.check("degree of freedom of the full model", self.basis.full)?;
        if full.is_empty() {
            return Ok(full);
        }
        Ok(self.basis.rows().map(|values| full.value(values)).enumerate().collect())
    }

    /// Converts a probe of the full model to a probe of the reduced model.
    ///
    /// Name and unit stay. Section resultants are converted too.
    ///
    /// # Errors
    /// [`Error::Item`](crate::Error::Item) with the reason of [`Recovery::row`].
    pub fn probe(&self, probe: Probe) -> Result<Probe> {
        probe.try_map_rows(|row| self.row(row))
    }

    /// Values of the full model's degrees of freedom from the reduced model's.
    ///
    /// `reduced`: displacements, velocities or accelerations.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless there is a value for each reduced degree of freedom.
    pub fn full(&self, reduced: &[f64]) -> Result<Vec<f64>> {
        same_length("list of reduced degrees of freedom", reduced.len(), self.basis.order())?;
        let mut full = vec![0.0; self.basis.full];
        transposed_multiply_add(&self.basis.transposed, 1.0, reduced, &mut full);
        Ok(full)
    }
}
