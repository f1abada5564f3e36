//! Checks that matrices of a structure are symmetric and positive semi-definite.

use crate::error::{Error, Result};
use crate::linalg::{Elimination, SparseMatrix, indefinite_row, largest};

/// Relative difference of mirrored entries up to which a matrix counts as symmetric.
pub(super) const SYMMETRY_TOLERANCE: f64 = 1e-9;
/// Negative masses and dampings up to this fraction of the diagonal are rounding.
///
/// A singular matrix read from a file with seven digits has negative values of this size.
const SEMI_DEFINITE_TOLERANCE: f64 = 1e-6;
/// Masses and dampings up to this fraction of the largest entry are rounding.
///
/// After reductions and sums a zero has values of this size. One bound serves kg and kg m², whose sizes differ by far
/// less.
pub(super) const MASSLESS_FRACTION: f64 = 1e-12;

/// Whether each degree of freedom is massless, up to rounding.
pub fn massless(mass: &SparseMatrix) -> Vec<bool> {
    let masses = mass.diagonal();
    let rounding = MASSLESS_FRACTION * largest(&masses);
    masses.iter().map(|mass| mass.abs() <= rounding).collect()
}

/// Square of a circular frequency (1/s²) too low to affect a run: a period of a day.
pub const NEGLIGIBLE_SQUARED_FREQUENCY: f64 = 5.29e-9;

/// Error unless the stiffness matrix is symmetric.
///
/// A difference is relative to the diagonal of its row and column and to the inertia of `mass` there, so that
/// scaling of coordinates does not change the result.
///
/// # Errors
/// [`Error::Unsymmetric`](crate::Error::Unsymmetric).
pub fn check_stiffness(stiffness: &SparseMatrix, mass: &SparseMatrix) -> Result<()> {
    let diagonal = stiffness.diagonal();
    let masses = mass.diagonal();
    let largest = stiffness.entries().fold(0.0, |m: f64, (_, _, k)| m.max(k.abs()));
    let rounding = MASSLESS_FRACTION * largest;
    check_symmetric("stiffness matrix", stiffness, |i, j| {
        SYMMETRY_TOLERANCE * geometric_mean(&diagonal, i, j)
            + NEGLIGIBLE_SQUARED_FREQUENCY * geometric_mean(&masses, i, j)
            + rounding
    })
}

/// Geometric mean of the sizes of two values.
fn geometric_mean(values: &[f64], i: usize, j: usize) -> f64 {
    (values[i] * values[j]).abs().sqrt()
}

/// Error for mirrored entries that differ by more than 1e-9 of the largest entry.
pub(super) fn check_mirrored(name: &'static str, matrix: &SparseMatrix) -> Result<()> {
    let largest = matrix.entries().fold(0.0, |m: f64, (_, _, value)| m.max(value.abs()));
    check_symmetric(name, matrix, |_, _| SYMMETRY_TOLERANCE * largest)
}

/// Error for mirrored entries that differ by more than the tolerance at their row and column.
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

/// Whether the mass matrix is positive definite; an error unless it is symmetric and positive semi-definite.
///
/// # Errors
/// [`Error::Indefinite`](crate::Error::Indefinite).
pub fn check_mass(mass: &SparseMatrix, elimination: &Elimination) -> Result<bool> {
    const MATRIX_NAME: &str = "mass matrix";
    check_mirrored(MATRIX_NAME, mass)?;
    let has_mass = mass.diagonal().iter().all(|mass| *mass > 0.0);
    if has_mass && indefinite_row(mass, 0.0, 0.0, elimination).is_none() {
        return Ok(true);
    }
    check_semi_definite(MATRIX_NAME, mass, elimination).map(|()| false)
}

/// Error unless the damping matrix is symmetric and positive semi-definite.
///
/// # Errors
/// [`Error::Indefinite`](crate::Error::Indefinite).
pub fn check_damping(damping: &SparseMatrix, elimination: &Elimination) -> Result<()> {
    const MATRIX_NAME: &str = "damping matrix";
    check_mirrored(MATRIX_NAME, damping)?;
    check_semi_definite(MATRIX_NAME, damping, elimination)
}

/// β and α, if a matrix is βA + αB up to rounding.
///
/// A has all places of both. If A is positive definite and B positive semi-definite, the matrix is positive
/// semi-definite, as its check by factors: an α below zero may leave negative values as small as the check allows.
pub fn combination(matrix: &SparseMatrix, [a, b]: [&SparseMatrix; 2]) -> Option<[f64; 2]> {
    let diagonal = matrix.diagonal();
    let matrix_values = matrix.values_at(a)?;
    let b_values = b.values_at(a)?;
    let entries = || {
        let values = matrix_values.iter().zip(&b_values);
        a.entries().zip(values).map(|((i, j, a), (c, b))| (i, j, [a, *b, *c]))
    };
    // Normal equations of least squares for C = βA + αB, in a scaling to a unit diagonal of C.
    let mut aa = 0.0;
    let mut ab = 0.0;
    let mut bb = 0.0;
    let mut ac = 0.0;
    let mut bc = 0.0;
    for (i, j, [a, b, c]) in entries() {
        let scale = (diagonal[i] * diagonal[j]).abs().max(f64::MIN_POSITIVE).recip();
        aa += scale * (a * a);
        ab += scale * (a * b);
        bb += scale * (b * b);
        ac += scale * (a * c);
        bc += scale * (b * c);
    }
    let determinant = aa * bb - ab * ab;
    let mut beta = ac / aa;
    let mut alpha = 0.0;
    if determinant > SYMMETRY_TOLERANCE * aa * bb {
        beta = (ac * bb - bc * ab) / determinant;
        alpha = (bc * aa - ac * ab) / determinant;
    }
    // A β below zero is rounding; if it is not, the residual shows it.
    if beta < 0.0 {
        beta = 0.0;
        alpha = bc / bb;
    }
    let mut residuals = vec![0.0; diagonal.len()];
    let mut negative_parts = vec![0.0; diagonal.len()];
    for (i, _, [a, b, c]) in entries() {
        residuals[i] += (c - beta * a - alpha * b).abs();
        negative_parts[i] += (-alpha).max(0.0) * b.abs();
    }
    let is_combination = diagonal.iter().enumerate().all(|(i, diagonal)| {
        residuals[i] <= SYMMETRY_TOLERANCE * diagonal
            && negative_parts[i] <= SEMI_DEFINITE_TOLERANCE * diagonal
    });
    is_combination.then_some([beta, alpha])
}

/// Error unless a symmetric matrix is positive semi-definite up to rounding.
fn check_semi_definite(
    name: &'static str,
    matrix: &SparseMatrix,
    elimination: &Elimination,
) -> Result<()> {
    let largest = matrix.entries().fold(0.0, |m: f64, (_, _, value)| m.max(value.abs()));
    let rounding = MASSLESS_FRACTION * largest;
    match indefinite_row(matrix, SEMI_DEFINITE_TOLERANCE, rounding, elimination) {
        Some(row) => Err(Error::Indefinite { matrix: name, row, diagonal: matrix.diagonal()[row] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Triplets;

    /// Chain of springs `spring`, and a spring `support` under each mass.
    fn chain(spring: f64, support: f64) -> SparseMatrix {
        let mut matrix = Triplets::new(30);
        for i in 0..30 {
            matrix.add(i, i, support);
            if i > 0 {
                matrix.add_spring(i - 1, i, spring);
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
        // In the places of the mass alone, and without any.
        let found = combination(&sum(&[(0.7, &mass)]), [&stiffness, &mass]).unwrap();
        assert!(found[0] == 0.0 && (found[1] - 0.7).abs() < 1e-14, "{found:?}");
        let none = SparseMatrix::new("none", &Triplets::new(30)).unwrap();
        assert_eq!(combination(&none, [&stiffness, &mass]), Some([0.0; 2]));
        let floating = [&stiffness, &mass];
        // In proportion to both, to the stiffness, and to the mass in the places of the stiffness.
        for [beta, alpha] in [[1e-3, 0.7], [1e-3, 0.0], [0.0, 0.7], [1e-3, -1e-6]] {
            let damping = sum(&[(beta, &stiffness), (alpha, &mass)]);
            let found = combination(&damping, floating).unwrap();
            let beta_error = (found[0] - beta).abs();
            assert!(beta_error < 1e-12 * (beta + alpha.abs()), "{found:?} for {beta}");
            // Rounding of the entries.
            let entry = 8.0e6 * beta + 2.0 * alpha.abs();
            assert!(2.0 * (found[1] - alpha).abs() < 1e-14 * entry, "{found:?} for {alpha}");
        }
        // Negative, by more than rounding or in part.
        for [beta, alpha] in [[-1e-3, 0.7], [1e-3, -0.7], [0.0, -0.7]] {
            let damping = sum(&[(beta, &stiffness), (alpha, &mass)]);
            assert!(combination(&damping, floating).is_none());
        }
        // A dashpot more, between neighbours or elsewhere.
        for place in [17, 25] {
            let mut dashpot = Triplets::new(30);
            dashpot.add_spring(16, place, 1.0);
            let dashpot = SparseMatrix::new("dashpot", &dashpot).unwrap();
            let damping = sum(&[(1e-3, &stiffness), (0.7, &mass), (1.0, &dashpot)]);
            assert!(combination(&damping, floating).is_none());
        }
    }
}
