//! Check that a symmetric stiffness is not negative with the base held.

use crate::coupled::base::PlacedBase;
use crate::error::{Error, Result};
use crate::linalg::{Elimination, SparseMatrix, indefinite_row};
use crate::structure::{HeldBase, Triplets, stiffest};

/// Stiffness of springs that hold the base and of constraints, relative to the largest stiffness.
///
/// So large that base and constraints do not move.
pub(crate) const FIRM_SPRING_FACTOR: f64 = 1e6;
/// Remainder of a zero after assembly and factors, relative to the diagonal and to the largest stiffness.
const SIGN_ROUNDING_TOLERANCE: f64 = 1e-12;

/// Error for a symmetric K that is not positive semi-definite with the base held.
pub(crate) fn check_signs(
    base: &PlacedBase,
    [mass, damping, stiffness]: [&SparseMatrix; 3],
) -> Result<()> {
    let tie = stiffest(stiffness);
    let springs = HeldBase::new(base.nodes(), stiffness, FIRM_SPRING_FACTOR * tie);
    let matrix = SparseMatrix::new(HeldBase::STIFFNESS_NAME, &springs.matrix)?;
    if matrix.asymmetry() > SIGN_ROUNDING_TOLERANCE {
        return Ok(());
    }
    let constrained = constrain(&matrix, &multipliers(&matrix, [mass, damping]), springs.spring)?;
    match indefinite_row(
        &constrained,
        SIGN_ROUNDING_TOLERANCE,
        SIGN_ROUNDING_TOLERANCE * tie,
        &Elimination::default(),
    ) {
        Some(row) => {
            let diagonal = stiffness.diagonal()[row];
            Err(Error::Indefinite { matrix: HeldBase::STIFFNESS_NAME, row, diagonal })
        }
        None => Ok(()),
    }
}

/// A symmetric matrix in which a spring of stiffness `penalty` replaces each Lagrange multiplier of a structure.
pub(crate) fn with_constraints(
    matrix: SparseMatrix,
    [mass, damping, stiffness]: [&SparseMatrix; 3],
    penalty: f64,
) -> Result<SparseMatrix> {
    let multipliers = multipliers(stiffness, [mass, damping]);
    if multipliers.contains(&true) {
        constrain(&matrix, &multipliers, penalty)
    } else {
        Ok(matrix)
    }
}

/// Marks the degrees of freedom that are Lagrange multipliers.
///
/// Multipliers are forces in others' equations, and their own equation is a constraint. Zeros are exact: a
/// multiplier with the smallest mass m, on a coupling c with a mass M, grows at the rate √(c / √(m M)).
fn multipliers(stiffness: &SparseMatrix, others: [&SparseMatrix; 2]) -> Vec<bool> {
    let mut multipliers: Vec<bool> = stiffness.diagonal().iter().map(|k| *k == 0.0).collect();
    for (row, column, value) in others.into_iter().flat_map(SparseMatrix::entries) {
        if value != 0.0 {
            multipliers[row] = false;
            multipliers[column] = false;
        }
    }
    multipliers
}

/// A symmetric matrix with a spring of stiffness `penalty` in place of each Lagrange multiplier.
///
/// The spring acts on the sum of degrees of freedom that the multiplier keeps at zero.
fn constrain(matrix: &SparseMatrix, multipliers: &[bool], penalty: f64) -> Result<SparseMatrix> {
    let mut constrained = Triplets::new(matrix.order());
    let mut constraints = vec![Vec::new(); matrix.order()];
    for (row, column, value) in matrix.entries() {
        match (multipliers[row], multipliers[column]) {
            (false, false) => constrained.add(row, column, value),
            (true, false) => constraints[row].push((column, value)),
            _ => {}
        }
    }
    for mut constraint in constraints {
        let largest = constraint.iter().fold(0.0, |m: f64, (_, c)| m.max(c.abs()));
        if largest > 0.0 {
            for (_, c) in &mut constraint {
                *c /= largest;
            }
            constrained.add_outer(&constraint, penalty);
        }
    }
    SparseMatrix::new(HeldBase::STIFFNESS_NAME, &constrained)
}
