//! Check that a symmetric stiffness is positive semi-definite with a fixed base.

use crate::coupled::base::PlacedBase;
use crate::error::{Error, Result};
use crate::linalg::{Elimination, SparseMatrix, indefinite_row};
use crate::structure::{SpringSupportedBase, Triplets, max_diagonal_stiffness};

/// Stiffness of the springs that fix the base and replace constraints, relative to the largest stiffness.
///
/// With this factor the displacements of the springs are negligible.
pub(crate) const FIRM_SPRING_FACTOR: f64 = 1e6;
/// Rounding of a zero pivot, relative to the diagonal and to the largest stiffness.
const SIGN_ROUNDING_TOLERANCE: f64 = 1e-12;

/// Error for a symmetric K that is not positive semi-definite with a fixed base.
pub(crate) fn check_signs(
    base: &PlacedBase,
    [mass, damping, stiffness]: [&SparseMatrix; 3],
) -> Result<()> {
    let max_stiffness = max_diagonal_stiffness(stiffness);
    let springs =
        SpringSupportedBase::new(base.nodes(), stiffness, FIRM_SPRING_FACTOR * max_stiffness);
    let matrix = SparseMatrix::new(SpringSupportedBase::STIFFNESS_NAME, &springs.matrix)?;
    if matrix.asymmetry() > SIGN_ROUNDING_TOLERANCE {
        return Ok(());
    }
    let constrained =
        constrain(&matrix, &multipliers(&matrix, [mass, damping]), springs.spring_stiffness)?;
    match indefinite_row(
        &constrained,
        SIGN_ROUNDING_TOLERANCE,
        SIGN_ROUNDING_TOLERANCE * max_stiffness,
        &Elimination::default(),
    ) {
        Some(row) => {
            let diagonal = stiffness.diagonal()[row];
            Err(Error::Indefinite { matrix: SpringSupportedBase::STIFFNESS_NAME, row, diagonal })
        }
        None => Ok(()),
    }
}

/// Replaces each Lagrange multiplier of a structure in a symmetric matrix by a spring.
///
/// `penalty` is the stiffness of the springs.
pub(crate) fn with_constraints(
    matrix: SparseMatrix,
    [mass, damping, stiffness]: [&SparseMatrix; 3],
    penalty: f64,
) -> Result<SparseMatrix> {
    let is_multiplier = multipliers(stiffness, [mass, damping]);
    if is_multiplier.contains(&true) {
        constrain(&matrix, &is_multiplier, penalty)
    } else {
        Ok(matrix)
    }
}

/// Whether each degree of freedom is a Lagrange multiplier.
///
/// A multiplier is a force in the equations of other degrees of freedom, and its row is a constraint. Its diagonal
/// stiffness, its mass and its damping are exactly zero. With the smallest mass m, coupled by c to a mass M, it would grow
/// at the rate √(c / √(m M)).
fn multipliers(stiffness: &SparseMatrix, mass_and_damping: [&SparseMatrix; 2]) -> Vec<bool> {
    let mut is_multiplier: Vec<bool> = stiffness.diagonal().iter().map(|k| *k == 0.0).collect();
    for (row, column, value) in mass_and_damping.into_iter().flat_map(SparseMatrix::entries) {
        if value != 0.0 {
            is_multiplier[row] = false;
            is_multiplier[column] = false;
        }
    }
    is_multiplier
}

/// Replaces each Lagrange multiplier of a symmetric matrix by a spring of stiffness `penalty`.
///
/// The spring acts on the weighted sum of degrees of freedom that the multiplier constrains to zero.
fn constrain(matrix: &SparseMatrix, is_multiplier: &[bool], penalty: f64) -> Result<SparseMatrix> {
    let mut constrained = Triplets::new(matrix.order());
    let mut constraints = vec![Vec::new(); matrix.order()];
    for (row, column, value) in matrix.entries() {
        match (is_multiplier[row], is_multiplier[column]) {
            (false, false) => constrained.add(row, column, value),
            (true, false) => constraints[row].push((column, value)),
            _ => {}
        }
    }
    for mut constraint in constraints {
        let max_weight = constraint.iter().fold(0.0, |max: f64, (_, weight)| max.max(weight.abs()));
        if max_weight > 0.0 {
            for (_, weight) in &mut constraint {
                *weight /= max_weight;
            }
            constrained.add_outer(&constraint, penalty);
        }
    }
    SparseMatrix::new(SpringSupportedBase::STIFFNESS_NAME, &constrained)
}
