//! Step compliance of a ground: a matrix, or a diagonal for a bed of springs.

use crate::bem::Ground;
use crate::contact::MAX_STRUCTURE_RANK;
use crate::coupled::base::PlacedBase;
use crate::error::{Error, Result, all_finite, same_length};
use crate::geometry::{Patch, check_count, lattice_cells};
use crate::linalg::{CompressedMatrix, indefinite_pivot};
use crate::structure::Structure;

/// Number of contact elements from which a bed of springs is not stored as a matrix.
///
/// With fewer elements, matrices take less time.
const MIN_BED_ELEMENTS: usize = 64;

/// Tolerance below which a negative eigenvalue of the ground's matrix counts as rounding.
///
/// The matrix is scaled to a diagonal of one.
const NEGATIVE_EIGENVALUE_TOLERANCE: f64 = 1e-9;

/// Name of the ground's step compliance in errors.
const STEP_COMPLIANCE_NAME: &str = "step compliance of the ground";

/// Step compliance of a ground, for tractions inside the outline.
///
/// The result is a diagonal for a bed of independent springs under a base of few rigid bodies, otherwise a matrix. A
/// ground that could generate energy is an error.
pub(crate) fn step_compliance(
    ground: &dyn Ground,
    structure: &dyn Structure,
    elements: &Patch,
) -> Result<CompressedMatrix> {
    if let Some(diagonal) = bed_compliance(ground, structure, elements)? {
        return Ok(CompressedMatrix::of_diagonal(diagonal));
    }
    check_count(elements.len(), elements.layout().components())?;
    compliance_matrix(ground, elements)
}

/// Diagonal of the step compliance of a bed; `None` for other scenes.
///
/// It is for tractions inside the outline.
fn bed_compliance(
    ground: &dyn Ground,
    structure: &dyn Structure,
    elements: &Patch,
) -> Result<Option<Vec<f64>>> {
    if elements.len() < MIN_BED_ELEMENTS || !elements.is_plan() {
        return Ok(None);
    }
    let Some(compliance) = ground.diagonal_compliance()? else { return Ok(None) };
    let base = PlacedBase::of(structure, elements, &[])?;
    let rank = base.dofs().len();
    let has_small_rank = rank <= MAX_STRUCTURE_RANK && 2 * rank <= elements.len();
    let is_elastic = compliance.in_step.iter().all(|entry| *entry != 0.0);
    if base.is_flexible() || !has_small_rank || !is_elastic {
        return Ok(None);
    }
    diagonal_inside_outline(STEP_COMPLIANCE_NAME, compliance.in_step, elements).map(Some)
}

/// Diagonal compliance for tractions inside the outline.
///
/// Returns an error unless it is finite and positive.
pub(crate) fn diagonal_inside_outline(
    quantity: &'static str,
    mut diagonal: Vec<f64>,
    elements: &Patch,
) -> Result<Vec<f64>> {
    same_length(quantity, diagonal.len(), elements.layout().len())?;
    all_finite(quantity, &diagonal)?;
    if let Some((row, entry)) = diagonal.iter().enumerate().find(|(_, entry)| **entry <= 0.0) {
        return Err(Error::Indefinite { matrix: quantity, row, diagonal: *entry });
    }
    elements.spread_inside(&mut diagonal);
    Ok(diagonal)
}

/// Step compliance of all pairs of elements; an error if it could generate energy.
///
/// With rows weighted by the elements' areas, its symmetric part must be positive semi-definite.
fn compliance_matrix(ground: &dyn Ground, elements: &Patch) -> Result<CompressedMatrix> {
    let layout = elements.layout();
    let areas = elements.areas();
    let order = layout.len();
    let mut compliance = vec![0.0; layout.matrix_len()];
    ground.step_compliance(&mut compliance)?;
    elements.refer_inside(&mut compliance);
    all_finite(STEP_COMPLIANCE_NAME, &compliance)?;
    let row_areas: Vec<f64> =
        (0..order).map(|row| areas[layout.component_and_element(row)[1]]).collect();
    let mut scale = vec![1.0; order];
    for row in 0..order {
        let root = (row_areas[row] * compliance[row * (order + 1)].abs()).sqrt();
        if root > 0.0 {
            scale[row] = root.recip();
        }
    }
    let mut symmetric_part = vec![0.0; order * order];
    for i in 0..order {
        for j in 0..order {
            let sum =
                row_areas[i] * compliance[i * order + j] + row_areas[j] * compliance[j * order + i];
            symmetric_part[i * order + j] = 0.5 * scale[i] * scale[j] * sum;
        }
        symmetric_part[i * (order + 1)] += NEGATIVE_EIGENVALUE_TOLERANCE;
    }
    match indefinite_pivot(&symmetric_part, order) {
        None => Ok(match lattice_cells(elements) {
            Some(cells) => CompressedMatrix::on_lattice(compliance, &cells, areas),
            None => CompressedMatrix::new(compliance, order),
        }),
        Some(row) => {
            let diagonal = compliance[row * (order + 1)];
            Err(Error::Indefinite { matrix: STEP_COMPLIANCE_NAME, row, diagonal })
        }
    }
}
