//! Factors of dense matrices: LU, and pivoted Cholesky factors of low rank.

#![allow(
    clippy::inline_always,
    reason = "inlined functions are compiled for the instruction set of their caller"
)]

use super::matrix_scalar::{LuFactors, MatrixScalar};
use super::product::{
    ROWS_AT_ONCE as COLUMNS_AT_ONCE, Simd, WithSimd, add_row, add_rows, vectorized,
};
use faer::MatMut;
use faer::dyn_stack::MemBuffer;

/// LU factors of a dense matrix with partial pivoting, in reusable memory.
pub struct DenseFactor<T = f64> {
    order: usize,
    /// L and U, column by column.
    values: Vec<T>,
    /// Row of the matrix that each row of the factors comes from.
    row_permutation: Vec<usize>,
    inverse_permutation: Vec<usize>,
    /// Number of row exchanges of the last factorization.
    pub(super) exchange_count: usize,
    buffer: MemBuffer,
    /// Right-hand side of a small solve, with permuted rows.
    permuted_rhs: Vec<T>,
}

impl<T: MatrixScalar> DenseFactor<T> {
    /// Allocates memory for matrices up to order `capacity`, and solves with one right-hand side.
    pub fn with_capacity(capacity: usize) -> Self {
        Self::with_columns(capacity, 1)
    }

    /// Allocates memory for matrices up to order `capacity`, and solves with up to `column_count` right-hand sides.
    pub fn with_columns(capacity: usize, column_count: usize) -> Self {
        Self {
            order: 0,
            values: Vec::with_capacity(capacity * capacity),
            row_permutation: Vec::with_capacity(capacity),
            inverse_permutation: Vec::with_capacity(capacity),
            exchange_count: 0,
            buffer: MemBuffer::new(T::lu_scratch(capacity, column_count)),
            permuted_rhs: Vec::with_capacity(capacity),
        }
    }

    /// Factors the row-major `matrix` of `order`; false if it is singular or not finite.
    pub fn factor(&mut self, matrix: &[T], order: usize) -> bool {
        self.factor_columns(order, |column, values| {
            values.extend(matrix.chunks_exact(order).map(|row| row[column]));
        })
    }

    /// Factors the matrix of `order` whose columns `append_column` writes, one after the other.
    ///
    /// Returns false if the matrix is singular or not finite.
    pub fn factor_columns(
        &mut self,
        order: usize,
        mut append_column: impl FnMut(usize, &mut Vec<T>),
    ) -> bool {
        self.order = order;
        self.values.clear();
        (0..order).for_each(|column| append_column(column, &mut self.values));
        self.row_permutation.clear();
        self.row_permutation.resize(order, 0);
        self.inverse_permutation.clear();
        self.inverse_permutation.resize(order, 0);
        if order == 0 {
            return true;
        }
        self.exchange_count = T::lu_factor(
            &mut self.values,
            &mut self.row_permutation,
            &mut self.inverse_permutation,
            &mut self.buffer,
        );
        self.pivots().all(|pivot| T::is_finite_impl(&pivot) && pivot != T::zero_impl())
    }

    /// Diagonal of U.
    pub(super) fn pivots(&self) -> impl Iterator<Item = T> {
        (0..self.order).map(|k| self.values[k * (self.order + 1)])
    }

    /// Overwrites `rhs`, one or several vectors one after the other, with A⁻¹ rhs.
    pub fn solve(&mut self, rhs: &mut [T]) {
        let order = self.order;
        if order == 0 {
            return;
        }
        let column_count = rhs.len() / order;
        self.solve_in(MatMut::from_column_major_slice_mut(rhs, order, column_count));
    }

    /// Overwrites the `column_count` columns of the row-major `rhs` with A⁻¹ rhs.
    pub fn solve_columns(&mut self, rhs: &mut [T], column_count: usize) {
        let order = self.order;
        if order == 0 {
            return;
        }
        self.solve_in(MatMut::from_row_major_slice_mut(rhs, order, column_count));
    }

    fn solve_in(&mut self, rhs: MatMut<'_, T>) {
        let factors = LuFactors::new(
            self.order,
            &self.values,
            &self.row_permutation,
            &self.inverse_permutation,
        );
        T::lu_solve(factors, rhs, &mut self.buffer);
    }

    /// Overwrites `rhs` with A⁻ᵀ rhs.
    pub fn solve_transposed(&mut self, rhs: &mut [T]) {
        if self.order == 0 {
            return;
        }
        let factors = LuFactors::new(
            self.order,
            &self.values,
            &self.row_permutation,
            &self.inverse_permutation,
        );
        T::lu_solve_transposed(factors, MatMut::from_column_major_slice_mut(rhs, self.order, 1));
    }
}

impl DenseFactor {
    /// As [`DenseFactor::factor`] up to rounding errors, faster for small matrices.
    pub fn factor_small(&mut self, matrix: &[f64], order: usize) -> bool {
        self.order = order;
        self.values.clear();
        (0..order).for_each(|k| self.values.extend(matrix[k..].iter().step_by(order)));
        self.row_permutation.clear();
        self.row_permutation.extend(0..order);
        self.exchange_count = vectorized(SmallElimination {
            columns: &mut self.values,
            row_permutation: &mut self.row_permutation,
        });
        self.inverse_permutation.clear();
        self.inverse_permutation.resize(order, 0);
        for (place, row) in self.row_permutation.iter().enumerate() {
            self.inverse_permutation[*row] = place;
        }
        self.pivots().all(|pivot| pivot.is_finite() && pivot != 0.0)
    }

    /// Overwrites `rhs` with A⁻¹ rhs, faster than [`DenseFactor::solve`] for small matrices.
    ///
    /// It substitutes four columns at a time. For the small systems of a contact problem, faer's blocked solve takes
    /// ten times as long.
    pub fn solve_small(&mut self, rhs: &mut [f64]) {
        self.permuted_rhs.clear();
        self.permuted_rhs.extend(self.row_permutation.iter().map(|&row| rhs[row]));
        vectorized(Substitution { lu_columns: &self.values, x: &mut self.permuted_rhs });
        rhs.copy_from_slice(&self.permuted_rhs);
    }
}

/// LU factors of a matrix in place, one column after the other, with partial pivoting.
///
/// Returns the number of row exchanges.
struct SmallElimination<'a> {
    columns: &'a mut [f64],
    row_permutation: &'a mut [usize],
}

impl WithSimd for SmallElimination<'_> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let Self { columns, row_permutation } = self;
        let order = row_permutation.len();
        let mut exchange_count = 0;
        for k in 0..order {
            let (factored, rest) = columns.split_at_mut(k * order);
            let present = &mut rest[..order];
            eliminate_column(simd, factored, present);
            let mut pivot_row = k;
            for row in k + 1..order {
                if present[row].abs() > present[pivot_row].abs() {
                    pivot_row = row;
                }
            }
            let inverse_pivot = present[pivot_row].recip();
            if pivot_row != k {
                exchange_count += 1;
                row_permutation.swap(k, pivot_row);
                columns.chunks_exact_mut(order).for_each(|column| column.swap(k, pivot_row));
            }
            for value in &mut columns[k * order + k + 1..(k + 1) * order] {
                *value *= inverse_pivot;
            }
        }
        exchange_count
    }
}

/// Overwrites a column of a matrix with its column of U, and below with L times the pivot, from the columns before.
#[inline(always)]
fn eliminate_column<S: Simd>(simd: S, factored: &[f64], present: &mut [f64]) {
    let order = present.len();
    let count = factored.len() / order;
    let complete_blocks_end = count - count % COLUMNS_AT_ONCE;
    for k in (0..complete_blocks_end).step_by(COLUMNS_AT_ONCE) {
        let (block, rows_below) = present[k..].split_at_mut(COLUMNS_AT_ONCE);
        let columns: [&[f64]; COLUMNS_AT_ONCE] =
            std::array::from_fn(|j| &factored[(k + j) * order..][k..order]);
        solve_lower(|j| columns[j], block);
        let multipliers = std::array::from_fn(|j| -block[j]);
        let below = columns.map(|column| &column[COLUMNS_AT_ONCE..]);
        add_rows(simd, multipliers, below, rows_below);
    }
    for k in complete_blocks_end..count {
        let column = &factored[k * order..][..order];
        add_row(simd, -present[k], &column[k + 1..], &mut present[k + 1..]);
    }
}

/// Substitution x ← U⁻¹ L⁻¹ x.
struct Substitution<'a> {
    /// Columns of L and U.
    lu_columns: &'a [f64],
    x: &'a mut [f64],
}

impl WithSimd for Substitution<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { lu_columns, x } = self;
        let order = x.len();
        let column = |k: usize| &lu_columns[k * order..][..order];
        // The incomplete block comes last: at the bottom in the forward substitution, at the top in the backward
        // substitution. No further rows need an update from it.
        let incomplete_len = order % COLUMNS_AT_ONCE;
        let complete_blocks_end = order - incomplete_len;
        for k in (0..complete_blocks_end).step_by(COLUMNS_AT_ONCE) {
            let (block, rows_below) = x[k..].split_at_mut(COLUMNS_AT_ONCE);
            let columns: [&[f64]; COLUMNS_AT_ONCE] = std::array::from_fn(|j| &column(k + j)[k..]);
            solve_lower(|j| columns[j], block);
            let multipliers = std::array::from_fn(|j| -block[j]);
            add_rows(
                simd,
                multipliers,
                columns.map(|column| &column[COLUMNS_AT_ONCE..]),
                rows_below,
            );
        }
        solve_lower(
            |j| &column(complete_blocks_end + j)[complete_blocks_end..],
            &mut x[complete_blocks_end..],
        );
        for k in (incomplete_len..order).step_by(COLUMNS_AT_ONCE).rev() {
            let (rows_above, block) = x[..k + COLUMNS_AT_ONCE].split_at_mut(k);
            let columns: [&[f64]; COLUMNS_AT_ONCE] = std::array::from_fn(|j| column(k + j));
            solve_upper(|j| &columns[j][k..], block);
            let multipliers = std::array::from_fn(|j| -block[j]);
            add_rows(simd, multipliers, columns.map(|column| &column[..k]), rows_above);
        }
        solve_upper(column, &mut x[..incomplete_len]);
    }
}

/// x ← L⁻¹ x for the columns of a unit lower triangle.
#[inline(always)]
fn solve_lower<'a>(column: impl Fn(usize) -> &'a [f64], x: &mut [f64]) {
    for j in 0..x.len() {
        let column = &column(j)[..x.len()];
        for i in j + 1..x.len() {
            x[i] -= column[i] * x[j];
        }
    }
}

/// x ← U⁻¹ x for the columns of an upper triangle.
#[inline(always)]
fn solve_upper<'a>(column: impl Fn(usize) -> &'a [f64], x: &mut [f64]) {
    for j in (0..x.len()).rev() {
        let column = &column(j)[..x.len()];
        x[j] /= column[j];
        for i in 0..j {
            x[i] -= column[i] * x[j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense_multiply_add;

    #[test]
    fn dense_factor_solves_and_reports_singular_matrices() {
        let matrix = [0.0, 2.0, 1.0, 1.0, 0.0, 3.0, 4.0, 1.0, 0.0];
        let x = [1.0, -2.0, 0.5];
        let mut rhs = [0.0; 3];
        dense_multiply_add(&matrix, 1.0, &x, &mut rhs);
        let mut factor = DenseFactor::with_capacity(3);
        assert!(factor.factor(&matrix, 3));
        factor.solve(&mut rhs);
        for (a, b) in rhs.iter().zip(x) {
            assert!((a - b).abs() < 1e-14);
        }
        assert!(!factor.factor(&[1.0, 2.0, 2.0, 4.0], 2));
    }

    #[test]
    fn small_solves_are_exact_with_complete_and_incomplete_blocks() {
        let mut random = basemat_testkit::random::Random(7);
        let mut factor = DenseFactor::with_capacity(18);
        for order in 0..=18 {
            let matrix: Vec<f64> = (0..order * order).map(|_| random.within(-1.0, 1.0)).collect();
            let x: Vec<f64> = (0..order).map(|_| random.within(-1.0, 1.0)).collect();
            let mut rhs = vec![0.0; order];
            dense_multiply_add(&matrix, 1.0, &x, &mut rhs);
            assert!(factor.factor(&matrix, order));
            factor.solve_small(&mut rhs);
            for (a, b) in rhs.iter().zip(&x) {
                assert!((a - b).abs() < 1e-11, "order {order}: {a} for {b}");
            }
        }
    }

    #[test]
    fn small_factors_are_those_of_any_order() {
        let mut random = basemat_testkit::random::Random(8);
        let mut factor = DenseFactor::with_capacity(41);
        let mut small_factor = DenseFactor::with_capacity(41);
        for order in 0..=41 {
            let matrix: Vec<f64> = (0..order * order).map(|_| random.within(-1.0, 1.0)).collect();
            assert!(factor.factor(&matrix, order));
            assert!(small_factor.factor_small(&matrix, order));
            assert_eq!(small_factor.row_permutation, factor.row_permutation);
            assert_eq!(small_factor.exchange_count, factor.exchange_count);
            for (a, b) in small_factor.values.iter().zip(&factor.values) {
                assert!((a - b).abs() < 1e-11, "order {order}: {a} for {b}");
            }
        }
        assert!(!small_factor.factor_small(&[1.0, 2.0, 2.0, 4.0], 2));
    }
}
