//! Whether a nonlinear force is that of a structure that translates freely.

use super::model::{Model, Tangent};
use super::static_state::StaticState;
use super::supports::{DIRECTIONS, ROW, products};
use crate::error::{Error, Result};
use crate::linalg::largest;
use crate::structure::Structure;

/// Translations (m) that no nonlinear force may resist.
const TRANSLATIONS: [f64; 6] = [1e-3, -1e-3, 1.0, -1.0, 1e3, -1e3];

/// Refuses a nonlinear force that resists a translation of the whole structure from the static
/// state: it is tied to a fixed point. Returns which parts it joins with others: those that it does
/// not let translate alone.
pub(crate) fn joined_by_force(
    model: &Model,
    structure: &dyn Structure,
    at_rest: &StaticState,
) -> Result<Vec<bool>> {
    let parts = model.influence.parts();
    let mut joined = vec![false; parts.len()];
    let Some(own) = structure.nonlinear() else { return Ok(joined) };
    let n = model.unknowns;
    let mut tangent = Tangent::new(n);
    tangent.refill(structure, &at_rest.displacement)?;
    let stiffest = largest(&tangent.matrix.diagonal()).max(largest(&model.stiffness.diagonal()));
    let resistance = |translation: &[f64]| -> Result<Option<(f64, usize, f64)>> {
        let [_, around] = products(&tangent.matrix, translation);
        let mut force = vec![0.0; n];
        for distance in TRANSLATIONS {
            let moved: Vec<f64> = at_rest
                .displacement
                .iter()
                .zip(translation)
                .map(|(u, r)| u + distance * r)
                .collect();
            force.fill(0.0);
            own.force(&moved, &mut force)?;
            for (unknown, (force, before)) in force.iter().zip(&at_rest.force).enumerate() {
                let force = force - before;
                let scale = distance.abs() * around[unknown] + before.abs();
                let rounding = f64::EPSILON * stiffest * distance.abs();
                if force.is_nan() || force.abs() > ROW * scale + rounding {
                    let share = if scale > 0.0 { force.abs() / scale } else { f64::INFINITY };
                    return Ok(Some((force, unknown, share)));
                }
            }
        }
        Ok(None)
    };
    for (translation, direction) in model.influence.of_all(n).iter().zip(DIRECTIONS) {
        if let Some((force, unknown, share)) = resistance(translation)? {
            return Err(Error::Supported { direction, force, unknown, share });
        }
    }
    if parts.len() > 1 {
        for (part, joined) in parts.iter().zip(&mut joined) {
            for vector in &part.vectors {
                let mut translation = vec![0.0; n];
                for &(i, r) in vector {
                    translation[i] = r;
                }
                *joined |= resistance(&translation)?.is_some();
            }
        }
    }
    Ok(joined)
}
