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
    row_count: usize,
    values: Vec<Complex64>,
}

impl ComplexBlock {
    /// Matrix of zeros.
    pub fn zeros(row_count: usize, column_count: usize) -> Self {
        Self { row_count, values: vec![Complex64::ZERO; row_count * column_count] }
    }

    /// Matrix of these `values`, column by column.
    pub fn from_columns(row_count: usize, values: Vec<Complex64>) -> Self {
        Self { row_count, values }
    }

    /// Number of rows.
    #[inline]
    pub fn rows(&self) -> usize {
        self.row_count
    }

    /// All entries, column by column.
    #[inline]
    pub fn values(&self) -> &[Complex64] {
        &self.values
    }

    /// Copies the submatrix of these rows and columns.
    pub fn submatrix(&self, rows: Range<usize>, columns: Range<usize>) -> Self {
        let mut values = Vec::with_capacity(rows.len() * columns.len());
        for column in columns {
            values.extend_from_slice(&self.values[column * self.row_count..][rows.clone()]);
        }
        Self { row_count: rows.len(), values }
    }

    /// −A.
    pub fn negated(mut self) -> Self {
        self.values.iter_mut().for_each(|value| *value = -*value);
        self
    }

    /// Entries of a column.
    #[inline]
    pub fn column(&self, column: usize) -> &[Complex64] {
        &self.values[column * self.row_count..][..self.row_count]
    }

    /// Mutable entries of a column.
    #[inline]
    pub fn column_mut(&mut self, column: usize) -> &mut [Complex64] {
        &mut self.values[column * self.row_count..][..self.row_count]
    }

    /// Largest magnitude of a real or imaginary part.
    pub fn largest(&self) -> f64 {
        // Several maxima at once, because comparisons with a single one would wait for each other.
        let mut maxima = [0.0_f64; MAXIMA_AT_ONCE];
        let (chunks, remaining_values) = self.values.as_chunks::<MAXIMA_AT_ONCE>();
        for values in chunks {
            for (maximum, value) in maxima.iter_mut().zip(values) {
                *maximum = maximum.max(value.re.abs()).max(value.im.abs());
            }
        }
        remaining_values
            .iter()
            .flat_map(|value| [value.re.abs(), value.im.abs()])
            .chain(maxima)
            .fold(0.0, f64::max)
    }

    /// Subtracts Cᵀ M⁻¹ C from this symmetric matrix.
    ///
    /// This eliminates the rows of the symmetric `pivot` M.
    ///
    /// `coupling`: the block C, with the rows of M and the columns of this matrix. The result is symmetric to the last
    /// bit.
    ///
    /// # Errors
    /// [`Error::Singular`] for a pivot that is singular or not finite.
    pub fn eliminate(&mut self, pivot: &Self, coupling: &Self) -> Result<()> {
        if pivot.row_count > 0 && self.row_count > 0 {
            self.eliminate_in_lower(pivot, coupling)?;
            self.mirror_lower();
        }
        Ok(())
    }

    /// The same as [`eliminate`](Self::eliminate) for the lower triangle alone.
    ///
    /// # Errors
    /// [`Error::Singular`] for a pivot that is singular or not finite.
    pub fn eliminate_in_lower(&mut self, pivot: &Self, coupling: &Self) -> Result<()> {
        let pivot_order = pivot.row_count;
        let order = self.row_count;
        if pivot_order == 0 || order == 0 {
            return Ok(());
        }
        let mut factor = DenseFactor::with_columns(pivot_order, order);
        let is_regular = factor.factor_columns(pivot_order, |column, values| {
            values.extend_from_slice(pivot.column(column));
        });
        if !is_regular {
            // All callers eliminate degrees of freedom of these elements.
            let matrix = "finite elements around a trench";
            return Err(Error::Singular { matrix, order: pivot_order });
        }
        let mut solution = coupling.values.clone();
        factor.solve(&mut solution);
        matmul(
            MatMut::from_column_major_slice_mut(&mut self.values, order, order),
            BlockStructure::TriangularLower,
            Accum::Add,
            MatRef::from_column_major_slice(&coupling.values, pivot_order, order).transpose(),
            BlockStructure::Rectangular,
            MatRef::from_column_major_slice(&solution, pivot_order, order),
            BlockStructure::Rectangular,
            Complex64::new(-1.0, 0.0),
            Par::Seq,
        );
        Ok(())
    }

    /// Overwrites the upper triangle with the lower one.
    pub fn mirror_lower(&mut self) {
        let order = self.row_count;
        for column in 1..order {
            for row in 0..column {
                self.values[column * order + row] = self.values[row * order + column];
            }
        }
    }
}

/// Number of maxima at once in [`ComplexBlock::largest`].
const MAXIMA_AT_ONCE: usize = 8;

impl Index<(usize, usize)> for ComplexBlock {
    type Output = Complex64;

    #[inline]
    fn index(&self, (row, column): (usize, usize)) -> &Complex64 {
        &self.values[column * self.row_count + row]
    }
}

impl IndexMut<(usize, usize)> for ComplexBlock {
    #[inline]
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut Complex64 {
        &mut self.values[column * self.row_count + row]
    }
}
