//! LU factors of dense matrices, real and complex.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::matrix_scalar::{LuFactors, MatrixScalar};
use super::product::{ROWS_AT_ONCE as COLUMNS_AT_ONCE, Simd, WithSimd, add_rows, vectorized};
use faer::MatMut;
use faer::dyn_stack::MemBuffer;

/// LU factors of a dense matrix with partial pivoting, in reusable memory.
pub struct DenseFactor<T = f64> {
    order: usize,
    /// L and U, column by column.
    values: Vec<T>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    /// Number of row exchanges of the last factorization.
    pub(super) transpositions: usize,
    buffer: MemBuffer,
    /// Right-hand side of a small solve.
    permuted: Vec<T>,
}

impl<T: MatrixScalar> DenseFactor<T> {
    /// Allocates for matrices up to order `capacity` and solves of one right-hand side.
    pub fn with_capacity(capacity: usize) -> Self {
        Self::with_columns(capacity, 1)
    }

    /// Allocates for matrices up to order `capacity` and solves of up to `columns` right-hand sides.
    pub fn with_columns(capacity: usize, columns: usize) -> Self {
        Self {
            order: 0,
            values: Vec::with_capacity(capacity * capacity),
            forward: Vec::with_capacity(capacity),
            inverse: Vec::with_capacity(capacity),
            transpositions: 0,
            buffer: MemBuffer::new(T::lu_scratch(capacity, columns)),
            permuted: Vec::with_capacity(capacity),
        }
    }

    /// Factors the row-major `matrix` of `order`; false if it is singular or not finite.
    pub fn factor(&mut self, matrix: &[T], order: usize) -> bool {
        self.factor_columns(order, |column, values| {
            values.extend((0..order).map(|row| matrix[row * order + column]));
        })
    }

    /// Factors the matrix of `order` whose columns `extend` appends, one after the other.
    ///
    /// Returns false if the matrix is singular or not finite.
    pub fn factor_columns(
        &mut self,
        order: usize,
        mut extend: impl FnMut(usize, &mut Vec<T>),
    ) -> bool {
        self.order = order;
        self.values.clear();
        (0..order).for_each(|column| extend(column, &mut self.values));
        self.forward.clear();
        self.forward.resize(order, 0);
        self.inverse.clear();
        self.inverse.resize(order, 0);
        if order == 0 {
            return true;
        }
        self.transpositions =
            T::lu_factor(&mut self.values, &mut self.forward, &mut self.inverse, &mut self.buffer);
        self.pivots().all(|pivot| T::is_finite_impl(&pivot) && pivot != T::zero_impl())
    }

    pub(super) fn pivots(&self) -> impl Iterator<Item = T> {
        (0..self.order).map(|k| self.values[k * (self.order + 1)])
    }

    /// Overwrites `rhs`, one vector or several after each other, with A⁻¹ rhs.
    pub fn solve(&mut self, rhs: &mut [T]) {
        let order = self.order;
        if order == 0 {
            return;
        }
        let columns = rhs.len() / order;
        self.solve_in(MatMut::from_column_major_slice_mut(rhs, order, columns));
    }

    /// Overwrites the `columns` columns of the row-major `rhs` with A⁻¹ rhs.
    pub fn solve_columns(&mut self, rhs: &mut [T], columns: usize) {
        let order = self.order;
        if order == 0 {
            return;
        }
        self.solve_in(MatMut::from_row_major_slice_mut(rhs, order, columns));
    }

    fn solve_in(&mut self, rhs: MatMut<'_, T>) {
        let factors = LuFactors::new(self.order, &self.values, &self.forward, &self.inverse);
        T::lu_solve(factors, rhs, &mut self.buffer);
    }

    /// Overwrites `rhs` with A⁻ᵀ rhs.
    pub fn solve_transposed(&mut self, rhs: &mut [T]) {
        if self.order == 0 {
            return;
        }
        let factors = LuFactors::new(self.order, &self.values, &self.forward, &self.inverse);
        T::lu_solve_transposed(factors, MatMut::from_column_major_slice_mut(rhs, self.order, 1));
    }
}

impl DenseFactor {
    /// Overwrites `rhs` with A⁻¹ rhs, four columns at a time.
    ///
    /// Meant for the small systems of a contact problem, where faer's blocked solve takes ten times as long.
    pub fn solve_small(&mut self, rhs: &mut [f64]) {
        self.permuted.clear();
        self.permuted.extend(self.forward.iter().map(|&row| rhs[row]));
        vectorized(Substitute { columns: &self.values, x: &mut self.permuted });
        rhs.copy_from_slice(&self.permuted);
    }
}

/// x ← U⁻¹ L⁻¹ x.
struct Substitute<'a> {
    columns: &'a [f64],
    x: &'a mut [f64],
}

impl WithSimd for Substitute<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { columns, x } = self;
        let order = x.len();
        let column = |k: usize| &columns[k * order..][..order];
        let whole = order - order % COLUMNS_AT_ONCE;
        for k in (0..whole).step_by(COLUMNS_AT_ONCE) {
            let (solved, rest) = x[k..].split_at_mut(COLUMNS_AT_ONCE);
            let columns: [&[f64]; COLUMNS_AT_ONCE] = std::array::from_fn(|j| &column(k + j)[k..]);
            solve_lower(|j| columns[j], solved);
            let factors = std::array::from_fn(|j| -solved[j]);
            add_rows(simd, factors, columns.map(|column| &column[COLUMNS_AT_ONCE..]), rest);
        }
        solve_lower(|j| &column(whole + j)[whole..], &mut x[whole..]);
        // The incomplete block is the first one, because no rows above it need an update.
        let first = order % COLUMNS_AT_ONCE;
        for k in (first..order).step_by(COLUMNS_AT_ONCE).rev() {
            let (rest, solved) = x[..k + COLUMNS_AT_ONCE].split_at_mut(k);
            let columns: [&[f64]; COLUMNS_AT_ONCE] = std::array::from_fn(|j| column(k + j));
            solve_upper(|j| &columns[j][k..], solved);
            let factors = std::array::from_fn(|j| -solved[j]);
            add_rows(simd, factors, columns.map(|column| &column[..k]), rest);
        }
        solve_upper(column, &mut x[..first]);
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
    fn dense_factor_solves_and_reports_singular() {
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
    fn small_solves_are_exact_for_any_number_of_whole_and_broken_blocks() {
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
}
