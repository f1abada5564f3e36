//! Parts of a structure on its fixed base that nothing holds.

use super::matrix_checks::massless;
use super::{Structure, Triplets};
use crate::error::{Result, StructureError};
use crate::linalg::{Partition, SparseFactor, SparseMatrix, sparse_condition};

/// Condition of a part's stiffness above which the part counts as floating.
///
/// A floating part has a condition of 10¹⁶ up to rounding, a tower 800 times as high as wide has 10¹².
const FLOATING_CONDITION: f64 = 1e14;
/// A modal mass within 1e-6 of one counts as normalised.
const UNIT_MASS_TOLERANCE: f64 = 1e-6;

/// Largest number of degrees of freedom or nodes that a text lists.
pub(super) const MAX_LISTED_ITEMS: usize = 8;

/// Error for a part that no stiffness connects to a degree of freedom of `base`.
///
/// Without any degree of freedom in `base` nothing is checked.
///
/// # Errors
/// [`Error::Structure`](crate::Error::Structure).
pub fn check_attached(
    structure: &dyn Structure,
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    base: &[usize],
) -> Result<()> {
    let dofs = detached(stiffness, mass, base)?;
    if dofs.is_empty() {
        return Ok(());
    }
    let place = structure.describe(&dofs).unwrap_or_else(|| numbers(&dofs));
    Err(StructureError::Detached { dofs, place }.into())
}

/// Degrees of freedom by their numbers.
pub fn numbers(dofs: &[usize]) -> String {
    let texts: Vec<String> = dofs.iter().take(MAX_LISTED_ITEMS).map(ToString::to_string).collect();
    let noun = if dofs.len() == 1 { "degree of freedom" } else { "degrees of freedom" };
    format!("{noun} {}", listed(&texts, dofs.len()))
}

/// Joins the texts, and adds the number of those left out of `count`.
pub(super) fn listed(texts: &[String], count: usize) -> String {
    let list = texts.join(", ");
    if count > texts.len() {
        format!("{list} and {} more", count - texts.len())
    } else {
        list
    }
}

/// Degrees of freedom of all parts that stiffness does not connect to `base`, ascending.
///
/// A part without mass and stiffness does not count. Entries that are exactly zero couple nothing, in
/// symmetric matrices or others. A part that its own stiffness holds is attached if the mass couples it with
/// the rest: its degrees of freedom are coordinates relative to the base, for example of modes. A mode that
/// the base does not excite is recognised by its unit mass.
fn detached(stiffness: &SparseMatrix, mass: &SparseMatrix, base: &[usize]) -> Result<Vec<usize>> {
    let n = stiffness.order();
    let Some(&first) = base.first() else { return Ok(Vec::new()) };
    let mut by_stiffness = Partition::new(n);
    for &dof in base {
        by_stiffness.join(first, dof);
    }
    by_stiffness.couple(stiffness);
    let ground = by_stiffness.root(first);
    if (0..n).all(|dof| by_stiffness.root(dof) == ground) {
        return Ok(Vec::new());
    }
    let parts = by_stiffness.sets();
    let mut by_any = by_stiffness;
    by_any.couple(mass);
    let ground = by_any.root(first);

    let mut place = vec![(0, 0); n];
    for (part, dofs) in parts.iter().enumerate() {
        dofs.iter().enumerate().for_each(|(k, &dof)| place[dof] = (part, k));
    }
    let base_part = place[first].0;
    let mut part_stiffness: Vec<_> = parts.iter().map(|part| Triplets::new(part.len())).collect();
    for (row, column, value) in stiffness.entries() {
        let part = place[row].0;
        if part != base_part && value != 0.0 {
            part_stiffness[part].add(place[row].1, place[column].1, value);
        }
    }
    let masses = mass.diagonal();
    let massless = massless(mass);
    let mut found = Vec::new();
    for (part, dofs) in parts.iter().enumerate().filter(|(part, _)| *part != base_part) {
        let has_mass = dofs.iter().any(|&dof| !massless[dof]);
        let is_mode = dofs.len() == 1 && (masses[dofs[0]] - 1.0).abs() <= UNIT_MASS_TOLERANCE;
        let takes_part = !has_mass || is_mode || by_any.root(dofs[0]) == ground;
        let is_empty = !has_mass && part_stiffness[part].entries().is_empty();
        let is_attached = is_empty || takes_part && holds_itself(&part_stiffness[part])?;
        if !is_attached {
            found.extend_from_slice(dofs);
        }
    }
    found.sort_unstable();
    Ok(found)
}

/// Submatrix of the degrees of freedom for which `place` returns a row, in the order of these rows.
pub(super) fn restricted(
    name: &'static str,
    matrix: &SparseMatrix,
    order: usize,
    place: impl Fn(usize) -> Option<usize>,
) -> Result<SparseMatrix> {
    let mut part = Triplets::new(order);
    for (row, column, value) in matrix.entries() {
        if let (Some(row), Some(column)) = (place(row), place(column)) {
            part.add(row, column, value);
        }
    }
    SparseMatrix::new(name, &part)
}

/// Whether a stiffness resists every motion.
fn holds_itself(stiffness: &Triplets) -> Result<bool> {
    const MATRIX_NAME: &str = "stiffness matrix of a part";
    let matrix = SparseMatrix::new(MATRIX_NAME, stiffness)?;
    if matrix.is_empty() {
        return Ok(false);
    }
    Ok(SparseFactor::new(MATRIX_NAME, stiffness)
        .is_ok_and(|factor| sparse_condition(&matrix, &factor) < FLOATING_CONDITION))
}
