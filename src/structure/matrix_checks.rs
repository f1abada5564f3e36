//! Checks that matrices of a structure are symmetric and positive semi-definite.

use crate::error::{Error, Result};
use crate::linalg::{Elimination, SparseMatrix, indefinite_row, largest};

/// Relative difference of mirrored entries up to which a matrix counts as symmetric.
pub(super) const SYMMETRIC: f64 = 1e-9;
/// Negative masses and dampings up to this fraction of the diagonal are rounding.
///
/// A singular matrix read from a file with seven digits has negative values of this size.
const SEMI_DEFINITE: f64 = 1e-6;
/// Masses and dampings up to this fraction of the largest entry are rounding.
///
/// After reductions and sums a zero has values of this size. One bound serves kg and kg m², whose sizes differ by far
/// less.
pub(super) const MASSLESS: f64 = 1e-12;

/// Whether each degree of freedom is massless, up to rounding.
pub(crate) fn massless(mass: &SparseMatrix) -> Vec<bool> {
    let masses = mass.diagonal();
    let most = MASSLESS * largest(&masses);
    masses.iter().map(|mass| mass.abs() <= most).collect()
}

/// Square of a circular frequency (1/s²) too low to affect a run: a period of a day.
pub(crate) const UNNOTICED: f64 = 5.29e-9;

/// Error unless the stiffness matrix is symmetric.
///
/// A difference is relative to the diagonal of its row and column and to the inertia of `mass` there, so that
/// scaling of coordinates does not change the result.
pub(crate) fn check_stiffness(stiffness: &SparseMatrix, mass: &SparseMatrix) -> Result<()> {
    let [diagonal, masses] = [stiffness.diagonal(), mass.diagonal()];
    let rounding = MASSLESS * stiffness.entries().fold(0.0, |m: f64, (_, _, k)| m.max(k.abs()));
    let both = |of: &[f64], i: usize, j: usize| (of[i] * of[j]).abs().sqrt();
    check_symmetric("stiffness matrix", stiffness, |i, j| {
        SYMMETRIC * both(&diagonal, i, j) + UNNOTICED * both(&masses, i, j) + rounding
    })
}

/// Error for mirrored entries that differ by more than 1e-9 of the largest entry.
pub(super) fn check_mirrored(name: &'static str, matrix: &SparseMatrix) -> Result<()> {
    let largest = matrix.entries().fold(0.0, |m: f64, (_, _, value)| m.max(value.abs()));
    check_symmetric(name, matrix, |_, _| SYMMETRIC * largest)
}

fn check_symmetric(
    name: &'static str,
    matrix: &SparseMatrix,
    allowed: impl Fn(usize, usize) -> f64,
) -> Result<()> {
    let refused =
        |(row, column, entries)| Error::Unsymmetric { matrix: name, row, column, entries };
    matrix.unsymmetric_pair(allowed).map_or(Ok(()), |pair| Err(refused(pair)))
}

/// Whether the mass matrix is positive definite; an error unless it is symmetric and positive semi-definite.
pub(crate) fn check_mass(mass: &SparseMatrix, elimination: &Elimination) -> Result<bool> {
    const NAME: &str = "mass matrix";
    check_mirrored(NAME, mass)?;
    let has_mass = mass.diagonal().iter().all(|mass| *mass > 0.0);
    if has_mass && indefinite_row(mass, 0.0, 0.0, elimination).is_none() {
        return Ok(true);
    }
    check_semi_definite(NAME, mass, elimination).map(|()| false)
}

/// Error unless the damping matrix is symmetric and positive semi-definite.
pub(crate) fn check_damping(damping: &SparseMatrix, elimination: &Elimination) -> Result<()> {
    const NAME: &str = "damping matrix";
    check_mirrored(NAME, damping)?;
    check_semi_definite(NAME, damping, elimination)
}

/// β and α, if a matrix is βA + αB up to rounding.
///
/// A has all places of both. If A is positive definite and B positive semi-definite, the matrix is positive
/// semi-definite, as its check by factors: an α below zero may leave negative values as small as the check allows.
pub(crate) fn combination(matrix: &SparseMatrix, [a, b]: [&SparseMatrix; 2]) -> Option<[f64; 2]> {
    let diagonal = matrix.diagonal();
    let [own, b] = [matrix.values_at(a)?, b.values_at(a)?];
    let entries =
        || a.entries().zip(own.iter().zip(&b)).map(|((i, j, a), (own, b))| (i, j, [*own, a, *b]));
    // Least squares, of entries in a matrix scaled to a unit diagonal.
    let mut sums = [0.0; 5];
    entries().for_each(|(i, j, [own, a, b])| {
        let scale = (diagonal[i] * diagonal[j]).abs().max(f64::MIN_POSITIVE).recip();
        let products = [a * a, a * b, b * b, a * own, b * own];
        sums.iter_mut().zip(products).for_each(|(sum, product)| *sum += scale * product);
    });
    let [aa, ab, bb, ac, bc] = sums;
    let rest = aa * bb - ab * ab;
    let (beta, alpha) = if rest > SYMMETRIC * aa * bb {
        ((ac * bb - bc * ab) / rest, (bc * aa - ac * ab) / rest)
    } else {
        (ac / aa, 0.0)
    };
    // A β below zero is rounding, or is left as a difference.
    let (beta, alpha) = if beta < 0.0 { (0.0, bc / bb) } else { (beta, alpha) };
    let mut left = vec![[0.0; 2]; diagonal.len()];
    entries().for_each(|(i, _, [own, a, b])| {
        left[i][0] += (own - beta * a - alpha * b).abs();
        left[i][1] += (-alpha).max(0.0) * b.abs();
    });
    let is_rounding = |(left, own): (&[f64; 2], &f64)| {
        left[0] <= SYMMETRIC * own && left[1] <= SEMI_DEFINITE * own
    };
    left.iter().zip(&diagonal).all(is_rounding).then_some([beta, alpha])
}

fn check_semi_definite(
    name: &'static str,
    matrix: &SparseMatrix,
    elimination: &Elimination,
) -> Result<()> {
    let largest = matrix.entries().fold(0.0, |m: f64, (_, _, value)| m.max(value.abs()));
    match indefinite_row(matrix, SEMI_DEFINITE, MASSLESS * largest, elimination) {
        Some(row) => Err(Error::Indefinite { matrix: name, row, diagonal: matrix.diagonal()[row] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Triplets;

    /// Chain of springs `spring`, and a spring `own` under each mass.
    fn chain(spring: f64, own: f64) -> SparseMatrix {
        let mut matrix = Triplets::new(30);
        for i in 0..30 {
            matrix.add(i, i, own);
            if i > 0 {
                matrix.add_spring(i - 1, i, spring);
            }
        }
        SparseMatrix::new("chain", &matrix).unwrap()
    }

    #[test]
    fn proportional_matrices_are_combinations_and_others_are_not() {
        let stiffness = chain(4.0e6, 1e-2);
        let masses = Triplets::from_entries(30, (0..30).map(|i| (i, i, 2.0)));
        let mass = SparseMatrix::new("mass", &masses).unwrap();
        // In the places of the mass alone, and without any.
        let own = SparseMatrix::sum("sum", 30, &[(0.7, &mass)]).unwrap();
        let [beta, alpha] = combination(&own, [&stiffness, &mass]).unwrap();
        assert!(beta == 0.0 && (alpha - 0.7).abs() < 1e-14, "{beta} {alpha}");
        let none = SparseMatrix::new("none", &Triplets::new(30)).unwrap();
        assert_eq!(combination(&none, [&stiffness, &mass]), Some([0.0; 2]));
        let floating = [&stiffness, &mass];
        let sum = |terms: &[(f64, &SparseMatrix)]| SparseMatrix::sum("sum", 30, terms).unwrap();
        // In proportion to both, to the stiffness, and to the mass in the places of the stiffness.
        for [beta, alpha] in [[1e-3, 0.7], [1e-3, 0.0], [0.0, 0.7], [1e-3, -1e-6]] {
            let found = combination(&sum(&[(beta, &stiffness), (alpha, &mass)]), floating);
            let [own, other] = found.unwrap();
            assert!((own - beta).abs() < 1e-12 * (beta + alpha.abs()), "{own} for {beta}");
            // Rounding of the entries.
            let entry = 8.0e6 * beta + 2.0 * alpha.abs();
            assert!(2.0 * (other - alpha).abs() < 1e-14 * entry, "{other} for {alpha}");
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
