//! Parts of a structure that are not attached to its base.

use super::matrix_checks::massless;
use super::{Structure, Triplets};
use crate::error::{Result, StructureError};
use crate::linalg::{Partition, SparseFactor, SparseMatrix, sparse_condition};

/// Condition number of a part's stiffness above which the part counts as floating.
///
/// A floating part has a condition number of 10¹⁶ by rounding; a tower 800 times as high as wide has 10¹².
const FLOATING_CONDITION: f64 = 1e14;
/// Largest difference of a normalised modal mass from one.
///
/// Masses from a file with seven digits differ by less.
const UNIT_MASS_TOLERANCE: f64 = 1e-6;

/// Largest number of degrees of freedom or nodes that a text lists.
pub(super) const MAX_LISTED_ITEMS: usize = 8;

/// Returns an error for a part that no stiffness connects to a degree of freedom of the base.
///
/// `base_dofs`: degrees of freedom of the contact nodes. An empty list is not checked.
///
/// # Errors
/// [`Error::Structure`](crate::Error::Structure).
pub fn check_attached(
    structure: &dyn Structure,
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    base_dofs: &[usize],
) -> Result<()> {
    let dofs = detached_dofs(stiffness, mass, base_dofs)?;
    if dofs.is_empty() {
        return Ok(());
    }
    let place = structure.describe(&dofs).unwrap_or_else(|| dof_list_text(&dofs));
    Err(StructureError::Detached { dofs, place }.into())
}

/// Text that lists degrees of freedom by their indices.
pub fn dof_list_text(dofs: &[usize]) -> String {
    let indices: Vec<String> =
        dofs.iter().take(MAX_LISTED_ITEMS).map(ToString::to_string).collect();
    let noun = if dofs.len() == 1 { "degree of freedom" } else { "degrees of freedom" };
    format!("{noun} {}", joined_items(&indices, dofs.len()))
}

/// Text that joins the first of `item_count` items and states the number of the others.
pub(super) fn joined_items(first_items: &[String], item_count: usize) -> String {
    let text = first_items.join(", ");
    if item_count > first_items.len() {
        format!("{text} and {} more", item_count - first_items.len())
    } else {
        text
    }
}

/// Degrees of freedom of all parts that are not attached to the base, ascending.
///
/// Stiffness connects degrees of freedom to parts; entries that are exactly zero connect nothing. A part without mass
/// and stiffness does not count. A part that its own stiffness supports is attached if the mass couples it with the
/// base: its degrees of freedom are coordinates relative to the base, for example of modes. A mode that the base does
/// not excite is recognised by its unit mass.
fn detached_dofs(
    stiffness: &SparseMatrix,
    mass: &SparseMatrix,
    base_dofs: &[usize],
) -> Result<Vec<usize>> {
    let n = stiffness.order();
    let Some(&first_base_dof) = base_dofs.first() else { return Ok(Vec::new()) };
    let mut stiffness_parts = Partition::new(n);
    for &dof in base_dofs {
        stiffness_parts.join(first_base_dof, dof);
    }
    stiffness_parts.couple(stiffness);
    let base_root = stiffness_parts.root(first_base_dof);
    if (0..n).all(|dof| stiffness_parts.root(dof) == base_root) {
        return Ok(Vec::new());
    }
    let parts = stiffness_parts.sets();
    // Parts that stiffness or mass couples.
    let mut coupled_parts = stiffness_parts;
    coupled_parts.couple(mass);
    let coupled_base_root = coupled_parts.root(first_base_dof);

    let places = places_in_parts(&parts, n);
    let base_part = places[first_base_dof].part;
    let mut part_stiffness: Vec<_> = parts.iter().map(|part| Triplets::new(part.len())).collect();
    for (row, column, value) in stiffness.entries() {
        let part = places[row].part;
        if part != base_part && value != 0.0 {
            part_stiffness[part].add(places[row].index, places[column].index, value);
        }
    }
    let masses = mass.diagonal();
    let is_massless = massless(mass);
    let mut detached_dofs = Vec::new();
    for (part, dofs) in parts.iter().enumerate().filter(|(part, _)| *part != base_part) {
        let has_mass = dofs.iter().any(|&dof| !is_massless[dof]);
        let is_mode = dofs.len() == 1 && (masses[dofs[0]] - 1.0).abs() <= UNIT_MASS_TOLERANCE;
        let is_coupled = !has_mass || is_mode || coupled_parts.root(dofs[0]) == coupled_base_root;
        let is_empty = !has_mass && part_stiffness[part].entries().is_empty();
        let is_attached = is_empty || is_coupled && resists_all_motions(&part_stiffness[part])?;
        if !is_attached {
            detached_dofs.extend_from_slice(dofs);
        }
    }
    detached_dofs.sort_unstable();
    Ok(detached_dofs)
}

/// Part of a degree of freedom, and its index among the degrees of freedom of this part.
#[derive(Clone, Copy)]
struct PlaceInPart {
    part: usize,
    index: usize,
}

/// Place of each of `n` degrees of freedom in the parts.
fn places_in_parts(parts: &[Vec<usize>], n: usize) -> Vec<PlaceInPart> {
    let mut places = vec![PlaceInPart { part: 0, index: 0 }; n];
    for (part, dofs) in parts.iter().enumerate() {
        for (index, &dof) in dofs.iter().enumerate() {
            places[dof] = PlaceInPart { part, index };
        }
    }
    places
}

/// Submatrix of the degrees of freedom for which `row_index` returns a row, in the order of these rows.
pub(super) fn submatrix(
    name: &'static str,
    matrix: &SparseMatrix,
    order: usize,
    row_index: impl Fn(usize) -> Option<usize>,
) -> Result<SparseMatrix> {
    let mut entries = Triplets::new(order);
    for (row, column, value) in matrix.entries() {
        if let (Some(row), Some(column)) = (row_index(row), row_index(column)) {
            entries.add(row, column, value);
        }
    }
    SparseMatrix::new(name, &entries)
}

/// Whether a stiffness resists every motion.
fn resists_all_motions(stiffness: &Triplets) -> Result<bool> {
    const MATRIX_NAME: &str = "stiffness matrix of a part";
    let matrix = SparseMatrix::new(MATRIX_NAME, stiffness)?;
    if matrix.is_empty() {
        return Ok(false);
    }
    Ok(SparseFactor::new(MATRIX_NAME, stiffness)
        .is_ok_and(|factor| sparse_condition(&matrix, &factor) < FLOATING_CONDITION))
}
