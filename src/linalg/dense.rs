//! LU factors of dense matrices, real and complex.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor as dense_factor, solve as dense_solve};
use faer::perm::PermRef;
use faer::traits::ComplexField;
use faer::{Conj, MatMut, MatRef, Par, Spec};

/// LU factors of a dense matrix with partial pivoting, in memory that is kept between factorings.
pub(crate) struct DenseFactor<T = f64> {
    order: usize,
    values: Vec<T>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    /// Row exchanges of the last factoring.
    pub(super) transpositions: usize,
    buffer: MemBuffer,
}

impl<T: ComplexField + Copy> DenseFactor<T> {
    /// Room for matrices up to order `capacity`, and solves of one right-hand side.
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        Self::with_columns(capacity, 1)
    }

    /// Room for matrices up to order `capacity`, and solves of up to `columns` right-hand sides.
    pub(crate) fn with_columns(capacity: usize, columns: usize) -> Self {
        let factor = dense_factor::lu_in_place_scratch::<usize, T>(
            capacity,
            capacity,
            Par::Seq,
            Spec::default(),
        );
        let solve = dense_solve::solve_in_place_scratch::<usize, T>(capacity, columns, Par::Seq);
        Self {
            order: 0,
            values: Vec::with_capacity(capacity * capacity),
            forward: Vec::with_capacity(capacity),
            inverse: Vec::with_capacity(capacity),
            transpositions: 0,
            buffer: MemBuffer::new(factor.or(solve)),
        }
    }

    /// Factors the row-major `matrix` of `order`; false if it is singular or not finite.
    pub(crate) fn factor(&mut self, matrix: &[T], order: usize) -> bool {
        self.order = order;
        self.values.clear();
        self.values.extend_from_slice(&matrix[..order * order]);
        self.forward.clear();
        self.forward.resize(order, 0);
        self.inverse.clear();
        self.inverse.resize(order, 0);
        if order == 0 {
            return true;
        }
        let (info, _) = dense_factor::lu_in_place(
            MatMut::from_row_major_slice_mut(&mut self.values, order, order),
            &mut self.forward,
            &mut self.inverse,
            Par::Seq,
            MemStack::new(&mut self.buffer),
            Spec::default(),
        );
        self.transpositions = info.transposition_count;
        self.pivots().all(|pivot| T::is_finite_impl(&pivot) && pivot != T::zero_impl())
    }

    pub(super) fn pivots(&self) -> impl Iterator<Item = T> {
        (0..self.order).map(|k| self.values[k * (self.order + 1)])
    }

    /// Overwrites `rhs` with A⁻¹ rhs.
    pub(crate) fn solve(&mut self, rhs: &mut [T]) {
        let order = self.order;
        if order == 0 {
            return;
        }
        self.solve_in(MatMut::from_column_major_slice_mut(rhs, order, 1));
    }

    /// Overwrites the `columns` columns of the row-major `rhs` with A⁻¹ rhs.
    pub(crate) fn solve_columns(&mut self, rhs: &mut [T], columns: usize) {
        let order = self.order;
        if order == 0 {
            return;
        }
        self.solve_in(MatMut::from_row_major_slice_mut(rhs, order, columns));
    }

    fn solve_in(&mut self, rhs: MatMut<'_, T>) {
        let lu = MatRef::from_row_major_slice(&self.values, self.order, self.order);
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, self.order);
        let stack = MemStack::new(&mut self.buffer);
        dense_solve::solve_in_place_with_conj(lu, lu, permutation, Conj::No, rhs, Par::Seq, stack);
    }

    /// Overwrites `rhs` with A⁻ᵀ rhs.
    pub(crate) fn solve_transposed(&mut self, rhs: &mut [T]) {
        if self.order == 0 {
            return;
        }
        let lu = MatRef::from_row_major_slice(&self.values, self.order, self.order);
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, self.order);
        let scratch =
            dense_solve::solve_transpose_in_place_scratch::<usize, T>(self.order, 1, Par::Seq);
        dense_solve::solve_transpose_in_place_with_conj(
            lu,
            lu,
            permutation,
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, self.order, 1),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense_multiply_add;

    #[test]
    fn dense_factor_solves_and_reports_singular() {
        let matrix = [0.0, 2.0, 1.0, 1.0, 0.0, 3.0, 4.0, 1.0, 0.0];
        let x = [1.0, -2.0, 0.5];
        let mut rhs = [0.0; 3];
        dense_multiply_add(&matrix, 1.0, &x, &mut rhs);
        let mut factor = DenseFactor::with_capacity(3);
        assert!(factor.factor(&matrix, 3));
        factor.solve(&mut rhs);
        for (a, b) in rhs.iter().zip(&x) {
            assert!((a - b).abs() < 1e-14);
        }
        assert!(!factor.factor(&[1.0, 2.0, 2.0, 4.0], 2));
    }
}
