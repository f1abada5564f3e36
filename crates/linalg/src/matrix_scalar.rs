//! Number types of dense matrices, and the algorithms that are compiled for them.
//!
//! The matrix library is generic: a crate that calls it for a number type compiles it again. The methods of this trait
//! are not generic, so they are compiled only in this crate.

use basemat_fourier::num_complex::Complex64;
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::evd;
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::traits::ComplexField;
use faer::traits::math_utils::{add, conj, is_finite, mul_real, real};
use faer::{Conj, MatMut, MatRef, Par, Spec};

/// LU factors of a dense matrix, column by column, and its permutation of rows.
pub struct LuFactors<'a, T> {
    order: usize,
    values: &'a [T],
    /// Row of the matrix that each row of the factors comes from.
    row_permutation: &'a [usize],
    inverse_permutation: &'a [usize],
}

impl<'a, T> LuFactors<'a, T> {
    pub(super) fn new(
        order: usize,
        values: &'a [T],
        row_permutation: &'a [usize],
        inverse_permutation: &'a [usize],
    ) -> Self {
        Self { order, values, row_permutation, inverse_permutation }
    }
}

/// Number type of dense matrices: `f64` or `Complex64`.
pub trait MatrixScalar: ComplexField<Real = f64> + Copy {
    /// Memory for factorising matrices up to `order` and for solving with up to `column_count` right-hand sides.
    fn lu_scratch(order: usize, column_count: usize) -> StackReq;

    /// Factors the matrix in place; returns the number of row exchanges.
    fn lu_factor(
        matrix: &mut [Self],
        row_permutation: &mut [usize],
        inverse_permutation: &mut [usize],
        buffer: &mut MemBuffer,
    ) -> usize;

    /// Overwrites `right_side` b with A⁻¹ b.
    fn lu_solve(factors: LuFactors<Self>, right_side: MatMut<'_, Self>, buffer: &mut MemBuffer);

    /// Overwrites `right_side` b, of one column, with A⁻ᵀ b.
    fn lu_solve_transposed(factors: LuFactors<Self>, right_side: MatMut<'_, Self>);

    /// Smallest and largest eigenvalue of the Hermitian part of a row-major matrix.
    ///
    /// `None` if the matrix is empty or not finite.
    fn hermitian_range(matrix: &[Self], order: usize) -> Option<[f64; 2]>;
}

macro_rules! matrix_scalar {
    ($type:ty) => {
        impl MatrixScalar for $type {
            fn lu_scratch(order: usize, column_count: usize) -> StackReq {
                lu_scratch::<Self>(order, column_count)
            }

            fn lu_factor(
                matrix: &mut [Self],
                row_permutation: &mut [usize],
                inverse_permutation: &mut [usize],
                buffer: &mut MemBuffer,
            ) -> usize {
                lu_factor(matrix, row_permutation, inverse_permutation, buffer)
            }

            fn lu_solve(
                factors: LuFactors<Self>,
                right_side: MatMut<'_, Self>,
                buffer: &mut MemBuffer,
            ) {
                lu_solve(&factors, right_side, buffer);
            }

            fn lu_solve_transposed(factors: LuFactors<Self>, right_side: MatMut<'_, Self>) {
                lu_solve_transposed(&factors, right_side);
            }

            fn hermitian_range(matrix: &[Self], order: usize) -> Option<[f64; 2]> {
                hermitian_range(matrix, order)
            }
        }
    };
}

matrix_scalar! { f64 }
matrix_scalar! { Complex64 }

fn lu_scratch<T: ComplexField>(order: usize, column_count: usize) -> StackReq {
    let factor_scratch =
        factor::lu_in_place_scratch::<usize, T>(order, order, Par::Seq, Spec::default());
    factor_scratch.or(solve::solve_in_place_scratch::<usize, T>(order, column_count, Par::Seq))
}

fn lu_factor<T: ComplexField>(
    matrix: &mut [T],
    row_permutation: &mut [usize],
    inverse_permutation: &mut [usize],
    buffer: &mut MemBuffer,
) -> usize {
    let order = row_permutation.len();
    let (info, _) = factor::lu_in_place(
        MatMut::from_column_major_slice_mut(matrix, order, order),
        row_permutation,
        inverse_permutation,
        Par::Seq,
        MemStack::new(buffer),
        Spec::default(),
    );
    info.transposition_count
}

fn lu_solve<T: ComplexField>(
    factors: &LuFactors<T>,
    right_side: MatMut<'_, T>,
    buffer: &mut MemBuffer,
) {
    let lu = MatRef::from_column_major_slice(factors.values, factors.order, factors.order);
    let permutation =
        PermRef::new_checked(factors.row_permutation, factors.inverse_permutation, factors.order);
    let stack = MemStack::new(buffer);
    solve::solve_in_place_with_conj(lu, lu, permutation, Conj::No, right_side, Par::Seq, stack);
}

fn lu_solve_transposed<T: ComplexField>(factors: &LuFactors<T>, right_side: MatMut<'_, T>) {
    let lu = MatRef::from_column_major_slice(factors.values, factors.order, factors.order);
    let permutation =
        PermRef::new_checked(factors.row_permutation, factors.inverse_permutation, factors.order);
    let scratch = solve::solve_transpose_in_place_scratch::<usize, T>(factors.order, 1, Par::Seq);
    solve::solve_transpose_in_place_with_conj(
        lu,
        lu,
        permutation,
        Conj::No,
        right_side,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
    );
}

fn hermitian_range<T>(matrix: &[T], order: usize) -> Option<[f64; 2]>
where
    T: ComplexField<Real = f64> + Copy,
{
    let mut hermitian_part = Vec::with_capacity(order * order);
    for row in 0..order {
        for column in 0..order {
            let mirrored_entry = conj(&matrix[column * order + row]);
            hermitian_part
                .push(mul_real(&add(&matrix[row * order + column], &mirrored_entry), &0.5));
        }
    }
    if order == 0 || !hermitian_part.iter().all(is_finite) {
        return None;
    }
    let mut eigenvalues = hermitian_part[..order].to_vec();
    let mut buffer = MemBuffer::new(evd::self_adjoint_evd_scratch::<T>(
        order,
        evd::ComputeEigenvectors::No,
        Par::Seq,
        Spec::default(),
    ));
    evd::self_adjoint_evd(
        MatRef::from_row_major_slice(&hermitian_part, order, order),
        DiagMut::from_slice_mut(&mut eigenvalues),
        None,
        Par::Seq,
        MemStack::new(&mut buffer),
        Spec::default(),
    )
    .ok()?;
    let range = eigenvalues
        .iter()
        .map(real)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    Some(range)
}
