//! Compliance of a bed: many elements that do not move each other, under a base of few rigid bodies.

use crate::bem::Ground;
use crate::contact::MAX_STRUCTURE_RANK;
use crate::coupled::base::PlacedBase;
use crate::error::{Error, Result, all_finite, same_length};
use crate::geometry::Patch;
use crate::structure::Structure;

/// Number of contact elements from which a bed is not stored as a matrix.
///
/// Below, matrices take less time.
const MIN_BED_ELEMENTS: usize = 64;

/// Name of the ground's step compliance in errors.
pub(crate) const STEP_COMPLIANCE: &str = "instantaneous operator of the ground";

/// Diagonal of the step compliance of a bed, for tractions inside the outline; `None` for other scenes.
///
/// Returns an error if the bed could generate energy.
pub(crate) fn of_bed(
    ground: &dyn Ground,
    structure: &dyn Structure,
    elements: &Patch,
) -> Result<Option<Vec<f64>>> {
    if elements.len() < MIN_BED_ELEMENTS || !elements.is_plan() {
        return Ok(None);
    }
    let Some(compliance) = ground.diagonal_compliance()? else { return Ok(None) };
    let base = PlacedBase::of(structure, elements)?;
    let rank = base.dofs().len();
    let has_few_motions = rank <= MAX_STRUCTURE_RANK && 2 * rank <= elements.len();
    let is_elastic = compliance.in_step.iter().all(|entry| *entry != 0.0);
    if base.is_flexible() || !has_few_motions || !is_elastic {
        return Ok(None);
    }
    inside(STEP_COMPLIANCE, compliance.in_step, elements).map(Some)
}

/// Diagonal compliance for tractions inside the outline; an error unless it is finite and positive.
pub(crate) fn inside(
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
