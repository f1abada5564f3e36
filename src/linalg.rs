//! Sparse and dense solves: the only file that names faer.
//!
//! Everything runs sequentially, and solves use workspace made when the factor was made.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{
    ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch,
};
use faer::linalg::lu::partial_pivoting::{factor as dense_factor, solve as dense_solve};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::lu::{
    LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Accum, Conj, Mat, MatMut, MatRef, Par, Side, Spec};

use crate::error::{Error, Result};
pub(crate) use crate::matrix::SparseMatrix;
use crate::structure::Triplets;

/// Factors of a square sparse matrix, with the workspace of their solves.
pub(crate) struct SparseFactor {
    order: usize,
    kind: Kind,
    buffer: MemBuffer,
}

enum Kind {
    Cholesky { symbolic: SymbolicCholesky<usize>, values: Vec<f64> },
    Lu { symbolic: SymbolicLu<usize>, numeric: NumericLu<usize, f64> },
}

impl SparseFactor {
    /// Cholesky where the matrix is symmetric positive definite, else LU with partial pivoting.
    pub(crate) fn new(name: &'static str, triplets: &Triplets) -> Result<Self> {
        let matrix = SparseMatrix::new(name, triplets)?;
        let order = matrix.order();
        let singular = || Error::Singular { matrix: name, order };
        let entries: Vec<_> =
            matrix.entries().map(|(row, col, val)| Triplet { row, col, val }).collect();
        let csc = SparseColMat::<usize, f64>::try_new_from_triplets(order, order, &entries)
            .map_err(|_| singular())?;
        let symmetric = matrix.asymmetry() <= 1e-13;
        let factor = if symmetric { Self::cholesky(&csc) } else { None };
        let mut factor = factor.or_else(|| Self::lu(&csc)).ok_or_else(singular)?;
        // A singular matrix may pass LU with a pivot of rounding size: it shows in a solve.
        let mut probe = vec![1.0; order];
        factor.solve(&mut probe);
        if probe.iter().all(|x| x.is_finite()) { Ok(factor) } else { Err(singular()) }
    }

    fn cholesky(matrix: &SparseColMat<usize, f64>) -> Option<Self> {
        let symbolic = factorize_symbolic_cholesky(
            matrix.symbolic(),
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .ok()?;
        let mut values = vec![0.0; symbolic.len_val()];
        let mut buffer = MemBuffer::new(
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default()),
        );
        symbolic
            .factorize_numeric_llt(
                &mut values,
                matrix.as_ref(),
                Side::Lower,
                faer::linalg::cholesky::llt::factor::LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut buffer),
                Spec::default(),
            )
            .ok()?;
        let buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Some(Self { order: matrix.nrows(), kind: Kind::Cholesky { symbolic, values }, buffer })
    }

    fn lu(matrix: &SparseColMat<usize, f64>) -> Option<Self> {
        let symbolic =
            factorize_symbolic_lu(matrix.symbolic(), LuSymbolicParams::default()).ok()?;
        let mut numeric = NumericLu::new();
        let mut buffer =
            MemBuffer::new(symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Spec::default()));
        symbolic
            .factorize_numeric_lu(
                &mut numeric,
                matrix.as_ref(),
                Par::Seq,
                MemStack::new(&mut buffer),
                Spec::default(),
            )
            .ok()?;
        let buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Some(Self { order: matrix.nrows(), kind: Kind::Lu { symbolic, numeric }, buffer })
    }

    /// Numbers that a solve reads, about.
    pub(crate) fn stored(&self) -> usize {
        match &self.kind {
            Kind::Cholesky { values, .. } => values.len(),
            Kind::Lu { .. } => self.order * self.order,
        }
    }

    /// Overwrites `rhs` with A⁻¹ rhs.
    pub(crate) fn solve(&mut self, rhs: &mut [f64]) {
        let stack = MemStack::new(&mut self.buffer);
        let rhs = MatMut::from_column_major_slice_mut(rhs, self.order, 1);
        match &self.kind {
            Kind::Cholesky { symbolic, values } => {
                LltRef::new(symbolic, values).solve_in_place_with_conj(
                    Conj::No,
                    rhs,
                    Par::Seq,
                    stack,
                );
            }
            Kind::Lu { symbolic, numeric } => {
                LuRef::new_unchecked(symbolic, numeric).solve_in_place_with_conj(
                    Conj::No,
                    rhs,
                    Par::Seq,
                    stack,
                );
            }
        }
    }
}

/// LU factors of a dense matrix with partial pivoting, in memory that is kept between factorings.
pub(crate) struct DenseFactor {
    order: usize,
    values: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    buffer: MemBuffer,
}

impl DenseFactor {
    /// Room for matrices up to order `capacity`.
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        let factor = dense_factor::lu_in_place_scratch::<usize, f64>(
            capacity,
            capacity,
            Par::Seq,
            Spec::default(),
        );
        let solve = dense_solve::solve_in_place_scratch::<usize, f64>(capacity, 1, Par::Seq);
        Self {
            order: 0,
            values: Vec::with_capacity(capacity * capacity),
            forward: Vec::with_capacity(capacity),
            inverse: Vec::with_capacity(capacity),
            buffer: MemBuffer::new(factor.or(solve)),
        }
    }

    /// Factors the row-major `matrix` of `order`; false if it is singular or not finite.
    pub(crate) fn factor(&mut self, matrix: &[f64], order: usize) -> bool {
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
        dense_factor::lu_in_place(
            MatMut::from_row_major_slice_mut(&mut self.values, order, order),
            &mut self.forward,
            &mut self.inverse,
            Par::Seq,
            MemStack::new(&mut self.buffer),
            Spec::default(),
        );
        (0..order).all(|k| {
            let pivot = self.values[k * order + k];
            pivot.is_finite() && pivot != 0.0
        })
    }

    /// Overwrites `rhs` with A⁻¹ rhs.
    pub(crate) fn solve(&mut self, rhs: &mut [f64]) {
        if self.order == 0 {
            return;
        }
        let lu = MatRef::from_row_major_slice(&self.values, self.order, self.order);
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, self.order);
        dense_solve::solve_in_place_with_conj(
            lu,
            lu,
            permutation,
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, self.order, 1),
            Par::Seq,
            MemStack::new(&mut self.buffer),
        );
    }
}

/// Eigenvalues λ, ascending, and eigenvectors of K φ = λ M φ with Φᵀ M Φ = 1, for symmetric K and
/// positive definite M. Eigenvectors are columns of the row-major matrix returned. `None` if M is
/// not positive definite or the iteration fails.
///
/// With M = L Lᵀ these are the eigenvalues of L⁻¹ K L⁻ᵀ, and Φ = L⁻ᵀ times its eigenvectors.
pub(crate) fn generalised_modes(
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = mass.order();
    let dense = |matrix: &SparseMatrix| {
        let mut dense = Mat::<f64>::zeros(n, n);
        for (row, column, value) in matrix.entries() {
            dense[(row, column)] = value;
        }
        dense
    };
    let factor = dense(mass).llt(Side::Lower).ok()?;
    let mut reduced = dense(stiffness);
    solve_lower_triangular_in_place(factor.L(), reduced.as_mut(), Par::Seq);
    solve_lower_triangular_in_place(factor.L(), reduced.as_mut().transpose_mut(), Par::Seq);
    let (mut values, mut vectors) = (Diag::<f64>::zeros(n), Mat::<f64>::zeros(n, n));
    // Divide and conquer, faer's way from order 128 on, left residuals of 6e-7 of the largest force
    // (order 308, the containment of the examples); the QR iteration leaves none above rounding.
    let mut parameters = Spec::<SelfAdjointEvdParams, f64>::default();
    parameters.recursion_threshold = usize::MAX;
    let scratch =
        self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, parameters);
    self_adjoint_evd(
        reduced.as_ref(),
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        parameters,
    )
    .ok()?;
    solve_upper_triangular_in_place(factor.L().transpose(), vectors.as_mut(), Par::Seq);
    let values: Vec<f64> = (0..n).map(|j| values.column_vector()[j]).collect();
    let rows = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let vectors: Vec<f64> = rows.map(|place| vectors[place]).collect();
    let finite = values.iter().chain(&vectors).all(|x| x.is_finite());
    finite.then_some((values, vectors))
}

/// Columns below which the call of a library costs more than it saves.
const NARROW: usize = 24;

/// y ← y + factor · A x for a large dense row-major matrix with `x.len()` columns, with the widest
/// vector registers found at run time.
pub(crate) fn wide_multiply_add(matrix: &[f64], factor: f64, x: &[f64], y: &mut [f64]) {
    let (rows, columns) = (y.len(), x.len());
    if columns < NARROW {
        return dense_multiply_add(matrix, factor, x, y);
    }
    matmul(
        MatMut::from_column_major_slice_mut(y, rows, 1),
        Accum::Add,
        MatRef::from_row_major_slice(matrix, rows, columns),
        MatRef::from_column_major_slice(x, columns, 1),
        factor,
        Par::Seq,
    );
}

/// y ← y + factor · Aᵀ x, likewise, for a matrix with `y.len()` columns.
pub(crate) fn wide_transposed_multiply_add(matrix: &[f64], factor: f64, x: &[f64], y: &mut [f64]) {
    let (rows, columns) = (x.len(), y.len());
    if columns < NARROW {
        for (row, x) in matrix.chunks_exact(columns.max(1)).zip(x) {
            y.iter_mut().zip(row).for_each(|(y, a)| *y += factor * x * a);
        }
        return;
    }
    matmul(
        MatMut::from_column_major_slice_mut(y, columns, 1),
        Accum::Add,
        MatRef::from_column_major_slice(matrix, columns, rows),
        MatRef::from_column_major_slice(x, rows, 1),
        factor,
        Par::Seq,
    );
}

/// y ← y + factor · A x for a dense row-major matrix with `x.len()` columns.
pub(crate) fn dense_multiply_add(matrix: &[f64], factor: f64, x: &[f64], y: &mut [f64]) {
    if x.is_empty() {
        return;
    }
    for (row, y) in matrix.chunks_exact(x.len()).zip(y) {
        *y += factor * dot(row, x);
    }
}

/// Largest magnitude; 0 for an empty slice.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Σ xᵢ yᵢ, in eight running sums so that the compiler can use vector registers.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (x_chunks, y_chunks) = (x.chunks_exact(8), y.chunks_exact(8));
    let tail: f64 = x_chunks.remainder().iter().zip(y_chunks.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in x_chunks.zip(y_chunks) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    tail + (((a + b) + (c + d)) + ((e + f) + (g + h)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ladder(order: usize, skew: f64) -> Triplets {
        let mut matrix = Triplets::new(order);
        for i in 0..order {
            matrix.add(i, i, 3.0 + i as f64);
            if i > 0 {
                matrix.add(i, i - 1, -1.0 + skew);
                matrix.add(i - 1, i, -0.5);
                matrix.add(i - 1, i, -0.5 - skew);
            }
        }
        matrix
    }

    #[test]
    fn sparse_factors_solve_symmetric_and_unsymmetric() {
        for skew in [0.0, 0.3] {
            let triplets = ladder(40, skew);
            let matrix = SparseMatrix::new("test", &triplets).unwrap();
            let x: Vec<f64> = (0..40).map(|i| f64::from(i).sin()).collect();
            let mut rhs = vec![0.0; 40];
            matrix.multiply_add(1.0, &x, &mut rhs);
            let mut factor = SparseFactor::new("test", &triplets).unwrap();
            assert_eq!(matches!(factor.kind, Kind::Cholesky { .. }), skew == 0.0);
            factor.solve(&mut rhs);
            for (a, b) in rhs.iter().zip(&x) {
                assert!((a - b).abs() < 1e-13);
            }
        }
    }

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

    #[test]
    fn singular_and_bad_matrices_are_errors() {
        let mut zero = Triplets::new(2);
        zero.add(0, 0, 1.0);
        assert!(matches!(SparseFactor::new("k", &zero), Err(Error::Singular { .. })));
        zero.add(1, 2, 1.0);
        assert!(matches!(SparseMatrix::new("k", &zero), Err(Error::Index { index: 2, .. })));
        let mut nan = Triplets::new(1);
        nan.add(0, 0, f64::NAN);
        assert!(matches!(SparseMatrix::new("k", &nan), Err(Error::Input { .. })));
    }
}
