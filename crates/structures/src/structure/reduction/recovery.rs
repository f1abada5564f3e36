//! Recovery of the full model's degrees of freedom from a reduced model.

use std::sync::Arc;

use crate::error::{Result, same_length};
use crate::linalg::{SparseMatrix, row_products, transposed_multiply_add};
use crate::structure::DofCombination;
use crate::structure::probe::Probe;

/// Number of columns of A T that are computed together.
///
/// A block of this size fits into the cache.
const COLUMNS_PER_BLOCK: usize = 16;

/// The basis T of a reduction, u = T q.
#[derive(Debug)]
pub(super) struct Basis {
    /// Degrees of freedom of the full model that are among q.
    kept_dofs: Vec<usize>,
    /// Tᵀ, row-major: for each reduced degree of freedom a row over the full model's.
    transposed: Vec<f64>,
    /// Number of degrees of freedom of the full model.
    full_dofs: usize,
}

impl Basis {
    pub(super) fn new(kept_dofs: Vec<usize>, transposed: Vec<f64>, full_dofs: usize) -> Self {
        Self { kept_dofs, transposed, full_dofs }
    }

    /// Degrees of freedom of the full model that the reduced model keeps.
    pub(super) fn kept_dofs(&self) -> &[usize] {
        &self.kept_dofs
    }

    /// Number of reduced degrees of freedom.
    pub(super) fn order(&self) -> usize {
        self.transposed.len() / self.full_dofs.max(1)
    }

    /// Rows of Tᵀ, one for each reduced degree of freedom.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.transposed.chunks_exact(self.full_dofs.max(1))
    }

    /// Tᵀ A T for a symmetric matrix, row-major, symmetric to the last bit.
    pub(super) fn congruence(&self, matrix: &SparseMatrix) -> Vec<f64> {
        let order = self.order();
        let mut result = vec![0.0; order * order];
        if matrix.is_empty() {
            return result;
        }
        for (block_index, rows) in
            self.transposed.chunks(COLUMNS_PER_BLOCK * self.full_dofs).enumerate()
        {
            let mut products = vec![0.0; rows.len()];
            for (row, product) in
                rows.chunks_exact(self.full_dofs).zip(products.chunks_exact_mut(self.full_dofs))
            {
                matrix.multiply_add(1.0, row, product);
            }
            let column_count = rows.len() / self.full_dofs;
            // Rows after this block follow by symmetry from the columns of later blocks.
            let block_end = (COLUMNS_PER_BLOCK * block_index + column_count) * self.full_dofs;
            let entries = row_products(&self.transposed[..block_end], &products, self.full_dofs);
            for (index, value) in entries.iter().enumerate() {
                let i = index / column_count;
                let j = COLUMNS_PER_BLOCK * block_index + index % column_count;
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
        self.basis.full_dofs
    }

    /// The kept degrees of freedom of the full model.
    ///
    /// They are the first degrees of freedom of the reduced model, in this order.
    pub fn kept(&self) -> &[usize] {
        &self.basis.kept_dofs
    }

    /// Converts a sum of the full model's degrees of freedom to the reduced model's.
    ///
    /// Springs and probes of the reduced model need such sums.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a degree of freedom that the full model does not have,
    /// [`Error::Input`](crate::Error::Input) for a weight that is not finite.
    pub fn row(&self, row: impl Into<DofCombination>) -> Result<DofCombination> {
        let full_row = row.into();
        full_row.check("degree of freedom of the full model", self.basis.full_dofs)?;
        if full_row.is_empty() {
            return Ok(full_row);
        }
        Ok(self.basis.rows().map(|basis_row| full_row.value(basis_row)).enumerate().collect())
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
    /// `reduced_values`: displacements, velocities or accelerations.
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) unless there is a value for each reduced degree of freedom.
    pub fn full(&self, reduced_values: &[f64]) -> Result<Vec<f64>> {
        same_length(
            "list of reduced degrees of freedom",
            reduced_values.len(),
            self.basis.order(),
        )?;
        let mut full_values = vec![0.0; self.basis.full_dofs];
        transposed_multiply_add(&self.basis.transposed, 1.0, reduced_values, &mut full_values);
        Ok(full_values)
    }
}
