//! LU factors of dense matrices, real and complex.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::SparseFactor;
use super::product::{ROWS as COLUMNS, Simd, WithSimd, add_rows, vectorized};
use crate::linalg::SparseMatrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor as dense_factor, solve as dense_solve};
use faer::perm::PermRef;
use faer::traits::ComplexField;
use faer::{Conj, MatMut, MatRef, Par, Spec};

/// LU factors of a dense matrix with partial pivoting, in memory that is kept between factorings.
pub(crate) struct DenseFactor<T = f64> {
    order: usize,
    /// L and U, column by column.
    values: Vec<T>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    /// Row exchanges of the last factoring.
    pub(super) transpositions: usize,
    buffer: MemBuffer,
    /// Right-hand side of a small solve.
    permuted: Vec<T>,
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
            permuted: Vec::with_capacity(capacity),
        }
    }

    /// Factors the row-major `matrix` of `order`; false if it is singular or not finite.
    pub(crate) fn factor(&mut self, matrix: &[T], order: usize) -> bool {
        self.factor_columns(order, |column, values| {
            values.extend((0..order).map(|row| matrix[row * order + column]));
        })
    }

    /// Factors the matrix of `order` whose columns `extend` appends, one after the other; false if it is singular or not
    /// finite.
    pub(crate) fn factor_columns(
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
        let (info, _) = dense_factor::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut self.values, order, order),
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

    /// Overwrites `rhs`, one vector or several after each other, with A⁻¹ rhs.
    pub(crate) fn solve(&mut self, rhs: &mut [T]) {
        let order = self.order;
        if order == 0 {
            return;
        }
        let columns = rhs.len() / order;
        self.solve_in(MatMut::from_column_major_slice_mut(rhs, order, columns));
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
        let lu = MatRef::from_column_major_slice(&self.values, self.order, self.order);
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, self.order);
        let stack = MemStack::new(&mut self.buffer);
        dense_solve::solve_in_place_with_conj(lu, lu, permutation, Conj::No, rhs, Par::Seq, stack);
    }

    /// Overwrites `rhs` with A⁻ᵀ rhs.
    pub(crate) fn solve_transposed(&mut self, rhs: &mut [T]) {
        if self.order == 0 {
            return;
        }
        let lu = MatRef::from_column_major_slice(&self.values, self.order, self.order);
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

impl DenseFactor {
    /// Overwrites `rhs` with A⁻¹ rhs, four columns at a time: for the few numbers of a contact problem, where faer's
    /// blocked solve takes ten times as long.
    pub(crate) fn solve_small(&mut self, rhs: &mut [f64]) {
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
        let whole = order - order % COLUMNS;
        for k in (0..whole).step_by(COLUMNS) {
            let (known, rest) = x[k..].split_at_mut(COLUMNS);
            let columns: [&[f64]; COLUMNS] = std::array::from_fn(|j| &column(k + j)[k..]);
            solve_lower(|j| columns[j], known);
            let factors = std::array::from_fn(|j| -known[j]);
            add_rows(simd, factors, columns.map(|column| &column[COLUMNS..]), rest);
        }
        solve_lower(|j| &column(whole + j)[whole..], &mut x[whole..]);
        // The columns that fill no block come first, so that no rows are left above them.
        let first = order % COLUMNS;
        for k in (first..order).step_by(COLUMNS).rev() {
            let (rest, known) = x[..k + COLUMNS].split_at_mut(k);
            let columns: [&[f64]; COLUMNS] = std::array::from_fn(|j| column(k + j));
            solve_upper(|j| &columns[j][k..], known);
            let factors = std::array::from_fn(|j| -known[j]);
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

// Condition numbers from factors.
//
// The condition is that of the matrix scaled by the roots of its diagonal, SAS with sᵢ = |aᵢᵢ|^−½:
// it does not depend on units (a degree of freedom may be a length or an angle), it is within a factor of
// the order of the least that any scaling reaches for positive definite matrices (van der Sluis
// 1969), and it is what bounds the error of a Cholesky solve, scaled or not (Higham 2002, theorem
// 10.6 with § 10.1.1).

/// Solves of the estimator, at most, with A and with Aᵀ.
const ITERATIONS: usize = 5;

/// Estimate of ‖A⁻¹‖₁ from `solve(b, transposed)`, which overwrites b with A⁻¹ b or A⁻ᵀ b.
///
/// Hager's algorithm with Higham's refinements (Higham 2002, algorithm 15.4; LAPACK's dlacn2): a
/// lower bound, nearly always within a factor of three. Infinite if a solve is not finite.
fn inverse_norm(order: usize, solve: &mut dyn FnMut(&mut [f64], bool)) -> f64 {
    let mut x = vec![1.0 / order as f64; order];
    let mut signs = vec![0.0; order];
    let mut estimate = 0.0_f64;
    let mut place = usize::MAX;
    for iteration in 0..ITERATIONS {
        solve(&mut x, false);
        let norm: f64 = x.iter().map(|x| x.abs()).sum();
        if !norm.is_finite() {
            return f64::INFINITY;
        }
        let same = signs.iter().zip(&x).all(|(s, x)| *s == x.signum());
        if iteration > 0 && (norm <= estimate || same) {
            estimate = estimate.max(norm);
            break;
        }
        estimate = norm;
        signs.iter_mut().zip(&x).for_each(|(s, x)| *s = x.signum());
        x.copy_from_slice(&signs);
        solve(&mut x, true);
        let best = (0..order).fold(0, |a, b| if x[b].abs() > x[a].abs() { b } else { a });
        if best == place {
            break;
        }
        place = best;
        x.fill(0.0);
        x[place] = 1.0;
    }
    // A vector that catches what the iteration may miss.
    let last = order.max(2) as f64 - 1.0;
    for (i, x) in x.iter_mut().enumerate() {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        *x = sign * (1.0 + i as f64 / last);
    }
    solve(&mut x, false);
    let other: f64 = x.iter().map(|x| x.abs()).sum::<f64>() * 2.0 / (3.0 * order as f64);
    if other.is_finite() { estimate.max(other) } else { f64::INFINITY }
}

/// Roots of the diagonal's magnitudes; one where it is zero.
fn scales(diagonal: impl Iterator<Item = f64>) -> Vec<f64> {
    diagonal.map(|d| if d == 0.0 { 1.0 } else { d.abs().sqrt() }).collect()
}

fn scale(values: &mut [f64], scales: &[f64]) {
    values.iter_mut().zip(scales).for_each(|(x, s)| *x *= s);
}

/// Condition of a dense row-major matrix scaled by its diagonal, in the 1-norm; infinite if it is
/// singular.
pub(crate) fn dense_condition(matrix: &[f64], order: usize) -> f64 {
    if order == 0 {
        return 1.0;
    }
    let scales = scales((0..order).map(|i| matrix[i * order + i]));
    let scaled: Vec<f64> =
        (0..order * order).map(|k| matrix[k] / (scales[k / order] * scales[k % order])).collect();
    let column = |j: usize| (0..order).map(|i| scaled[i * order + j].abs()).sum::<f64>();
    let norm = (0..order).map(column).fold(0.0, f64::max);
    let mut factor = DenseFactor::with_capacity(order);
    if !factor.factor(&scaled, order) {
        return f64::INFINITY;
    }
    norm * inverse_norm(order, &mut |x, transposed| {
        if transposed { factor.solve_transposed(x) } else { factor.solve(x) }
    })
}

/// Condition of a sparse matrix with its factors.
pub(crate) fn sparse_condition(matrix: &SparseMatrix, factor: &mut SparseFactor) -> f64 {
    let order = matrix.order();
    let scales = scales(matrix.diagonal().into_iter());
    let mut columns = vec![0.0; order];
    for (row, column, value) in matrix.entries() {
        columns[column] += value.abs() / (scales[row] * scales[column]);
    }
    let norm = columns.into_iter().fold(0.0, f64::max);
    norm * inverse_norm(order, &mut |x, transposed| {
        scale(x, &scales);
        if transposed {
            factor.solve_transposed(x);
        } else {
            factor.solve(x);
        }
        scale(x, &scales);
    })
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
        for (a, b) in rhs.iter().zip(x) {
            assert!((a - b).abs() < 1e-14);
        }
        assert!(!factor.factor(&[1.0, 2.0, 2.0, 4.0], 2));
    }

    #[test]
    fn small_solves_are_exact_for_any_number_of_whole_and_broken_blocks() {
        let mut random = basemat_problems::random::Random(7);
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

#[cfg(test)]
mod condition_tests {

    use super::*;
    use crate::linalg::Triplets;
    use basemat_problems::random::Random;

    #[test]
    fn estimates_are_within_a_factor_of_three_of_the_inverse() {
        let mut random = Random(3);
        let mut worst = 1.0_f64;
        for case in 0..400 {
            let n = 1 + case % 12;
            // Any condition, any units.
            let own = random.log_within(1e-10, 1.0);
            let units: Vec<f64> = (0..n).map(|_| random.log_within(1e-6, 1e6)).collect();
            let root: Vec<f64> = (0..n * n).map(|_| random.within(-1.0, 1.0)).collect();
            let skew = if case % 3 == 0 { 0.5 } else { 0.0 };
            let mut matrix = vec![0.0; n * n];
            for (i, j) in (0..n * n).map(|k| (k / n, k % n)) {
                // One direction is as good as missing.
                let product: f64 = (1..n).map(|k| root[i * n + k] * root[j * n + k]).sum();
                let rest = if i == j { own } else { skew * root[i.min(j) * n + i.max(j)] };
                let sign = if i < j { -1.0 } else { 1.0 };
                matrix[i * n + j] = (product + sign * rest) * units[i] * units[j];
                if i == j {
                    matrix[i * n + j] = matrix[i * n + j].abs();
                }
            }
            let exact = basemat_problems::dense::condition_by_inverse(&matrix, n);
            let mut triplets = Triplets::new(n);
            for (k, value) in matrix.iter().enumerate() {
                triplets.add(k / n, k % n, *value);
            }
            let sparse = SparseMatrix::new("test", &triplets).unwrap();
            let mut factor = SparseFactor::new("test", &triplets).unwrap();
            for found in [dense_condition(&matrix, n), sparse_condition(&sparse, &mut factor)] {
                // A lower bound but for rounding, and seldom far below.
                let ratio = exact / found;
                assert!(ratio > 0.99 && ratio < 3.0, "{case}: {found:e} for {exact:e}");
                worst = worst.max(ratio);
            }
        }
        println!("exact over estimate: {worst} at most");
    }

    #[test]
    fn singular_and_diagonal_matrices_have_their_conditions() {
        assert!((dense_condition(&[1e-9, 0.0, 0.0, 1e9], 2) - 1.0).abs() < 1e-15);
        assert_eq!(dense_condition(&[1.0, 2.0, 2.0, 4.0], 2), f64::INFINITY);
        assert_eq!(dense_condition(&[0.0; 4], 2), f64::INFINITY);
        assert_eq!(dense_condition(&[], 0), 1.0);
    }
}
