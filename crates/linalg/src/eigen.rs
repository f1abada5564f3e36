//! Eigenvalues and eigenvectors of symmetric dense matrices.

use crate::SparseMatrix;
use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::linalg::evd::{
    ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch,
};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Mat, MatRef, Par, Side, Spec};

/// Row at which a symmetric row-major matrix fails to be positive definite.
///
/// `None` for a positive definite matrix.
pub fn indefinite_pivot(matrix: &[f64], order: usize) -> Option<usize> {
    let matrix = MatRef::from_row_major_slice(matrix, order, order);
    match matrix.llt(Side::Lower) {
        Ok(_) => None,
        Err(LltError::NonPositivePivot { index }) => Some(index),
    }
}

/// Eigenvalues λ, ascending, and eigenvectors of K φ = λ M φ with Φᵀ M Φ = 1.
///
/// K is symmetric, M symmetric positive definite. Eigenvectors are columns of the returned row-major matrix.
/// `None` if M is not positive definite, the iteration fails, or a result is not finite.
///
/// With M = L Lᵀ, λ are the eigenvalues of L⁻¹ K L⁻ᵀ, and Φ is L⁻ᵀ times its eigenvectors.
pub fn generalised_modes(stiffness: &SparseMatrix, mass: &SparseMatrix) -> Option<Eigenpairs> {
    let factor = dense_copy(mass).llt(Side::Lower).ok()?;
    let mut reduced_stiffness = dense_copy(stiffness);
    solve_lower_triangular_in_place(factor.L(), reduced_stiffness.as_mut(), Par::Seq);
    solve_lower_triangular_in_place(
        factor.L(),
        reduced_stiffness.as_mut().transpose_mut(),
        Par::Seq,
    );
    let FaerEigenpairs { values, mut vectors } = symmetric_eigen(&reduced_stiffness)?;
    solve_upper_triangular_in_place(factor.L().transpose(), vectors.as_mut(), Par::Seq);
    let vectors = row_major(&vectors);
    let is_finite = values.iter().chain(&vectors).all(|x| x.is_finite());
    is_finite.then_some(Eigenpairs { values, vectors })
}

/// Eigenvalues, ascending, and eigenvectors of a symmetric row-major matrix.
///
/// Eigenvectors are columns of the returned row-major matrix. `None` if the iteration fails.
pub fn symmetric_modes(matrix: &[f64], order: usize) -> Option<Eigenpairs> {
    let matrix = MatRef::from_row_major_slice(matrix, order, order).to_owned();
    let FaerEigenpairs { values, vectors } = symmetric_eigen(&matrix)?;
    Some(Eigenpairs { values, vectors: row_major(&vectors) })
}

/// Eigenvalues and eigenvectors.
#[derive(Debug, Clone)]
pub struct Eigenpairs {
    /// Eigenvalues, ascending.
    pub values: Vec<f64>,
    /// Row-major matrix whose rows or columns are the eigenvectors, as the function that returns it says.
    pub vectors: Vec<f64>,
}

/// Eigenvalues, ascending, and eigenvectors as columns of a faer matrix.
struct FaerEigenpairs {
    values: Vec<f64>,
    vectors: Mat<f64>,
}

/// Dense copy of a sparse matrix.
fn dense_copy(matrix: &SparseMatrix) -> Mat<f64> {
    let mut dense_matrix = Mat::<f64>::zeros(matrix.order(), matrix.order());
    for (row, column, value) in matrix.entries() {
        dense_matrix[(row, column)] = value;
    }
    dense_matrix
}

/// The entries of a matrix, row-major.
fn row_major(matrix: &Mat<f64>) -> Vec<f64> {
    let n = matrix.ncols();
    (0..matrix.nrows()).flat_map(|i| (0..n).map(move |j| matrix[(i, j)])).collect()
}

/// Eigenvalues and eigenvectors of a symmetric matrix; `None` if the iteration fails.
fn symmetric_eigen(matrix: &Mat<f64>) -> Option<FaerEigenpairs> {
    let n = matrix.nrows();
    // faer does not accept an empty matrix.
    if n == 0 {
        return Some(FaerEigenpairs { values: Vec::new(), vectors: Mat::zeros(0, 0) });
    }
    let mut values = Diag::<f64>::zeros(n);
    let mut vectors = Mat::<f64>::zeros(n, n);
    // From order 128 on, faer uses divide and conquer by default. For a structure of order 308, the residuals of its
    // eigenpairs reached 6e-7 of the largest force. The residuals of the QR iteration are rounding errors.
    let mut parameters = Spec::<SelfAdjointEvdParams, f64>::default();
    parameters.recursion_threshold = usize::MAX;
    let scratch =
        self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, parameters);
    self_adjoint_evd(
        matrix.as_ref(),
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        parameters,
    )
    .ok()?;
    let values = (0..n).map(|j| values.column_vector()[j]).collect();
    Some(FaerEigenpairs { values, vectors })
}
