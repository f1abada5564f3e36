//! Whether the mass and damping matrices of a structure are symmetric and positive semi-definite.

use crate::error::{Error, Result};
use crate::linalg::{SparseMatrix, indefinite_row};

/// Relative difference of mirrored entries up to which a matrix counts as symmetric.
pub(super) const SYMMETRIC: f64 = 1e-9;
/// Negative masses and dampings up to this, relative to those on the diagonal, are rounding: a file
/// with seven digits leaves as much of a singular matrix.
const SEMI_DEFINITE: f64 = 1e-6;
/// Masses and dampings up to this, relative to the largest entry, are rounding: reductions and sums
/// leave as much of none. One bound for kg and kg m², which differ by far less.
pub(super) const MASSLESS: f64 = 1e-12;

/// Refuses a mass matrix that is not symmetric or not positive semi-definite.
pub(crate) fn check_mass(mass: &SparseMatrix) -> Result<()> {
    check_semi_definite("mass matrix", mass)
}

/// Refuses a damping matrix that is not symmetric or not positive semi-definite.
pub(crate) fn check_damping(damping: &SparseMatrix) -> Result<()> {
    check_semi_definite("damping matrix", damping)
}

fn check_semi_definite(name: &'static str, matrix: &SparseMatrix) -> Result<()> {
    if matrix.asymmetry() > SYMMETRIC {
        return Err(Error::Scene { quantity: name, needed: "must be symmetric" });
    }
    let largest = matrix.entries().fold(0.0, |m: f64, (_, _, value)| m.max(value.abs()));
    match indefinite_row(matrix, SEMI_DEFINITE, MASSLESS * largest) {
        Some(row) => Err(Error::Indefinite { matrix: name, row, diagonal: matrix.diagonal()[row] }),
        None => Ok(()),
    }
}
