//! Dense complex symmetric matrices of a block elimination.

use std::ops::{Index, IndexMut, Range};

use basemat_fourier::num_complex::Complex64;
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::{Accum, MatMut, MatRef, Par};

use super::DenseFactor;
use crate::error::{Error, Result};

/// Dense complex matrix, stored column by column.
#[derive(Debug, Clone, PartialEq)]
pub struct ComplexBlock {
    rows: usize,
    values: Vec<Complex64>,
}

impl ComplexBlock {
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, values: vec![Complex64::ZERO; rows * columns] }
    }

    pub fn rows(&self) -> usize {
        self.rows
    }

    pub fn values(&self) -> &[Complex64] {
        &self.values
    }

    /// Copies the submatrix of these rows and columns.
    pub fn submatrix(&self, rows: Range<usize>, columns: Range<usize>) -> Self {
        let mut values = Vec::with_capacity(rows.len() * columns.len());
        for column in columns {
            values.extend_from_slice(&self.values[column * self.rows..][rows.clone()]);
        }
        Self { rows: rows.len(), values }
    }

    /// −A.
    pub fn negated(mut self) -> Self {
        self.values.iter_mut().for_each(|value| *value = -*value);
        self
    }

    /// Largest magnitude of a real or imaginary part.
    pub fn largest(&self) -> f64 {
        self.values
            .iter()
            .fold(0.0, |maximum, value| maximum.max(value.re.abs()).max(value.im.abs()))
    }

    /// Subtracts Cᵀ M⁻¹ C: eliminates the symmetric `pivot` M.
    ///
    /// `coupling`: C, from M's rows to this symmetric matrix.
    ///
    /// The result is symmetric to the last bit.
    ///
    /// # Errors
    /// [`Error::Singular`] for a pivot that is singular or not finite.
    pub fn eliminate(&mut self, pivot: &Self, coupling: &Self) -> Result<()> {
        let order = pivot.rows;
        let count = self.rows;
        if order == 0 || count == 0 {
            return Ok(());
        }
        let mut factor = DenseFactor::with_columns(order, count);
        if !factor.factor_columns(order, |column, values| {
            values.extend_from_slice(&pivot.values[column * order..][..order]);
        }) {
            return Err(Error::Singular { matrix: "finite elements around a trench", order });
        }
        let mut solved = coupling.values.clone();
        factor.solve(&mut solved);
        matmul(
            MatMut::from_column_major_slice_mut(&mut self.values, count, count),
            BlockStructure::TriangularLower,
            Accum::Add,
            MatRef::from_column_major_slice(&coupling.values, order, count).transpose(),
            BlockStructure::Rectangular,
            MatRef::from_column_major_slice(&solved, order, count),
            BlockStructure::Rectangular,
            Complex64::new(-1.0, 0.0),
            Par::Seq,
        );
        for column in 1..count {
            for row in 0..column {
                self.values[column * count + row] = self.values[row * count + column];
            }
        }
        Ok(())
    }
}

impl Index<(usize, usize)> for ComplexBlock {
    type Output = Complex64;

    #[inline]
    fn index(&self, (row, column): (usize, usize)) -> &Complex64 {
        &self.values[column * self.rows + row]
    }
}

impl IndexMut<(usize, usize)> for ComplexBlock {
    #[inline]
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut Complex64 {
        &mut self.values[column * self.rows + row]
    }
}
