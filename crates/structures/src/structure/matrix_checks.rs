//! Checks of symmetry and positive semi-definiteness for the matrices of a structure.

use crate::error::{Error, Result};
use crate::linalg::{Elimination, SparseMatrix, indefinite_row, largest};

/// Relative difference of mirrored entries up to which a matrix counts as symmetric.
pub(super) const SYMMETRY_TOLERANCE: f64 = 1e-9;
/// Negative eigenvalues of mass and damping up to this fraction of the diagonal are rounding.
///
/// A singular matrix from a file with seven digits has negative values of this size.
const SEMI_DEFINITE_TOLERANCE: f64 = 1e-6;
/// Masses and dampings up to this fraction of the largest entry are rounding.
///
/// Reductions and sums leave values of this size in place of zeros. The bound serves entries in kg and in kg m², whose
/// magnitudes differ by far less.
pub(super) const MASSLESS_FRACTION: f64 = 1e-12;

/// Whether each degree of freedom is massless, up to rounding.
pub fn massless(mass: &SparseMatrix) -> Vec<bool> {
    let masses = mass.diagonal();
    let rounding = MASSLESS_FRACTION * largest(&masses);
    masses.iter().map(|mass| mass.abs() <= rounding).collect()
}

/// Square of a circular frequency (1/s²) too low to affect a run: its period is a day.
pub const NEGLIGIBLE_SQUARED_FREQUENCY: f64 = 5.29e-9;

/// Returns an error unless the stiffness matrix is symmetric.
///
/// The tolerance of an entry follows from the diagonals of stiffness and mass in its row and column, so that scaling of
/// coordinates does not change the result.
///
/// # Errors
/// [`Error::Unsymmetric`](crate::Error::Unsymmetric).
pub fn check_stiffness(stiffness: &SparseMatrix, mass: &SparseMatrix) -> Result<()> {
    let diagonal = stiffness.diagonal();
    let masses = mass.diagonal();
    let max_entry = stiffness.entries().fold(0.0, |max: f64, (_, _, k)| max.max(k.abs()));
    let rounding = MASSLESS_FRACTION * max_entry;
    check_symmetric("stiffness matrix", stiffness, |i, j| {
        SYMMETRY_TOLERANCE * geometric_mean(&diagonal, i, j)
            + NEGLIGIBLE_SQUARED_FREQUENCY * geometric_mean(&masses, i, j)
            + rounding
    })
}

/// Geometric mean of the magnitudes of two values.
fn geometric_mean(values: &[f64], i: usize, j: usize) -> f64 {
    (values[i] * values[j]).abs().sqrt()
}

/// Returns an error for mirrored entries that differ by more than 1e-9 of the largest entry.
pub(super) fn check_mirrored(name: &'static str, matrix: &SparseMatrix) -> Result<()> {
    let max_entry = matrix.entries().fold(0.0, |max: f64, (_, _, value)| max.max(value.abs()));
    check_symmetric(name, matrix, |_, _| SYMMETRY_TOLERANCE * max_entry)
}

/// Returns an error for mirrored entries that differ by more than the tolerance of their row and column.
fn check_symmetric(
    name: &'static str,
    matrix: &SparseMatrix,
    tolerance: impl Fn(usize, usize) -> f64,
) -> Result<()> {
    match matrix.unsymmetric_pair(tolerance) {
        Some((row, column, entries)) => {
            Err(Error::Unsymmetric { matrix: name, row, column, entries })
        }
        None => Ok(()),
    }
}

/// Whether the mass matrix is positive definite.
///
/// # Errors
/// [`Error::Unsymmetric`](crate::Error::Unsymmetric) and [`Error::Indefinite`](crate::Error::Indefinite) unless it is
/// symmetric and positive semi-definite.
pub fn check_mass(mass: &SparseMatrix, elimination: &Elimination) -> Result<bool> {
    const MATRIX_NAME: &str = "mass matrix";
    check_mirrored(MATRIX_NAME, mass)?;
    let has_positive_diagonal = mass.diagonal().iter().all(|mass| *mass > 0.0);
    if has_positive_diagonal && indefinite_row(mass, 0.0, 0.0, elimination).is_none() {
        return Ok(true);
    }
    check_semi_definite(MATRIX_NAME, mass, elimination).map(|()| false)
}

/// Returns an error unless the damping matrix is symmetric and positive semi-definite.
///
/// # Errors
/// [`Error::Indefinite`](crate::Error::Indefinite).
pub fn check_damping(damping: &SparseMatrix, elimination: &Elimination) -> Result<()> {
    const MATRIX_NAME: &str = "damping matrix";
    check_mirrored(MATRIX_NAME, damping)?;
    check_semi_definite(MATRIX_NAME, damping, elimination)
}

/// Factors [β, α] of a matrix that is βA + αB up to rounding.
///
/// `None` for other matrices.
///
/// The sparsity pattern of A contains the patterns of B and of the matrix. If A is positive definite and B positive
/// semi-definite, the matrix is positive semi-definite within the tolerance of [`check_damping`].
pub fn proportional_factors(matrix: &SparseMatrix, [a, b]: [&SparseMatrix; 2]) -> Option<[f64; 2]> {
    let diagonal = matrix.diagonal();
    let matrix_values = matrix.values_at(a)?;
    let b_values = b.values_at(a)?;
    let entries = || {
        let values = matrix_values.iter().zip(&b_values);
        a.entries()
            .zip(values)
            .map(|((i, j, a_ij), (c_ij, b_ij))| (i, j, [a_ij, *b_ij, *c_ij]))
    };
    // Normal equations of least squares for C = βA + αB, with C scaled to a unit diagonal.
    let mut aa = 0.0;
    let mut ab = 0.0;
    let mut bb = 0.0;
    let mut ac = 0.0;
    let mut bc = 0.0;
    for (i, j, [a_ij, b_ij, c_ij]) in entries() {
        let scale = (diagonal[i] * diagonal[j]).abs().max(f64::MIN_POSITIVE).recip();
        aa += scale * (a_ij * a_ij);
        ab += scale * (a_ij * b_ij);
        bb += scale * (b_ij * b_ij);
        ac += scale * (a_ij * c_ij);
        bc += scale * (b_ij * c_ij);
    }
    let determinant = aa * bb - ab * ab;
    let mut beta = ac / aa;
    let mut alpha = 0.0;
    if determinant > SYMMETRY_TOLERANCE * aa * bb {
        beta = (ac * bb - bc * ab) / determinant;
        alpha = (bc * aa - ac * ab) / determinant;
    }
    // A negative β is set to zero. If it is not a rounding error, the residuals are large, and the result is `None`.
    if beta < 0.0 {
        beta = 0.0;
        alpha = bc / bb;
    }
    let mut residuals = vec![0.0; diagonal.len()];
    let mut negative_parts = vec![0.0; diagonal.len()];
    for (i, _, [a_ij, b_ij, c_ij]) in entries() {
        residuals[i] += (c_ij - beta * a_ij - alpha * b_ij).abs();
        negative_parts[i] += (-alpha).max(0.0) * b_ij.abs();
    }
    let is_combination = diagonal.iter().enumerate().all(|(i, c_ii)| {
        residuals[i] <= SYMMETRY_TOLERANCE * c_ii
            && negative_parts[i] <= SEMI_DEFINITE_TOLERANCE * c_ii
    });
    is_combination.then_some([beta, alpha])
}

/// Returns an error unless a symmetric matrix is positive semi-definite up to rounding.
fn check_semi_definite(
    name: &'static str,
    matrix: &SparseMatrix,
    elimination: &Elimination,
) -> Result<()> {
    let max_entry = matrix.entries().fold(0.0, |max: f64, (_, _, value)| max.max(value.abs()));
    let rounding = MASSLESS_FRACTION * max_entry;
    match indefinite_row(matrix, SEMI_DEFINITE_TOLERANCE, rounding, elimination) {
        Some(row) => Err(Error::Indefinite { matrix: name, row, diagonal: matrix.diagonal()[row] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Triplets;

    /// Chain of springs, and a support spring under each mass.
    fn chain(spring_stiffness: f64, support_stiffness: f64) -> SparseMatrix {
        let mut matrix = Triplets::new(30);
        for i in 0..30 {
            matrix.add(i, i, support_stiffness);
            if i > 0 {
                matrix.add_spring(i - 1, i, spring_stiffness);
            }
        }
        SparseMatrix::new("chain", &matrix).unwrap()
    }

    fn sum(terms: &[(f64, &SparseMatrix)]) -> SparseMatrix {
        SparseMatrix::sum("sum", 30, terms).unwrap()
    }

    #[test]
    fn proportional_matrices_are_combinations_and_others_are_not() {
        let stiffness = chain(4.0e6, 1e-2);
        let masses = Triplets::from_entries(30, (0..30).map(|i| (i, i, 2.0)));
        let mass = SparseMatrix::new("mass", &masses).unwrap();
        // The matrix has the sparsity pattern of the mass, or no entries.
        let factors = proportional_factors(&sum(&[(0.7, &mass)]), [&stiffness, &mass]).unwrap();
        assert!(factors[0] == 0.0 && (factors[1] - 0.7).abs() < 1e-14, "{factors:?}");
        let zero = SparseMatrix::new("zero", &Triplets::new(30)).unwrap();
        assert_eq!(proportional_factors(&zero, [&stiffness, &mass]), Some([0.0; 2]));
        let terms = [&stiffness, &mass];
        // The damping is proportional to both, to the stiffness, or to the mass.
        for [beta, alpha] in [[1e-3, 0.7], [1e-3, 0.0], [0.0, 0.7], [1e-3, -1e-6]] {
            let damping = sum(&[(beta, &stiffness), (alpha, &mass)]);
            let factors = proportional_factors(&damping, terms).unwrap();
            let beta_error = (factors[0] - beta).abs();
            assert!(beta_error < 1e-12 * (beta + alpha.abs()), "{factors:?} for {beta}");
            // Rounding of α is relative to the entries of the damping.
            let max_entry = 8.0e6 * beta + 2.0 * alpha.abs();
            let alpha_error = (factors[1] - alpha).abs();
            assert!(2.0 * alpha_error < 1e-14 * max_entry, "{factors:?} for {alpha}");
        }
        // A factor is negative by more than rounding.
        for [beta, alpha] in [[-1e-3, 0.7], [1e-3, -0.7], [0.0, -0.7]] {
            let damping = sum(&[(beta, &stiffness), (alpha, &mass)]);
            assert!(proportional_factors(&damping, terms).is_none());
        }
        // There is one more dashpot, between neighbours or between others.
        for mass_index in [17, 25] {
            let mut dashpot_entries = Triplets::new(30);
            dashpot_entries.add_spring(16, mass_index, 1.0);
            let dashpot = SparseMatrix::new("dashpot", &dashpot_entries).unwrap();
            let damping = sum(&[(1e-3, &stiffness), (0.7, &mass), (1.0, &dashpot)]);
            assert!(proportional_factors(&damping, terms).is_none());
        }
    }
}
