//! Whether a nonlinear force is that of a structure that translates freely.

use super::model::{Model, Tangent};
use super::static_state::StaticState;
use super::supports::{DIRECTIONS, ROW, products};
use crate::error::{Error, Result};
use crate::structure::Structure;

/// Translations (m) that no nonlinear force may resist.
const TRANSLATIONS: [f64; 3] = [1e-3, 1.0, 1e3];

/// Refuses a nonlinear force that resists a translation from the static state by a millimetre, a
/// metre or a kilometre: its structure is tied to a fixed point.
pub(crate) fn check_force(
    model: &Model,
    structure: &dyn Structure,
    at_rest: &StaticState,
) -> Result<()> {
    if model.linear {
        return Ok(());
    }
    let n = model.unknowns;
    let mut tangent = Tangent::new(n);
    tangent.refill(model, structure, &at_rest.displacement)?;
    let translations = model.influence.of_all(n);
    for (translation, direction) in translations.iter().zip(DIRECTIONS) {
        let [_, around] = products(&tangent.matrix, translation);
        for distance in TRANSLATIONS {
            let moved: Vec<f64> = at_rest
                .displacement
                .iter()
                .zip(translation)
                .map(|(u, r)| u + distance * r)
                .collect();
            let mut force = vec![0.0; n];
            structure.nonlinear_force(&moved, &mut force);
            for (unknown, (force, before)) in force.iter().zip(&at_rest.force).enumerate() {
                let force = force - before;
                let scale = distance * around[unknown] + before.abs();
                // Written so that NaN is refused.
                if !(force.abs() <= ROW * scale) {
                    let share = if scale > 0.0 { force.abs() / scale } else { f64::INFINITY };
                    return Err(Error::Supported { direction, force, unknown, share });
                }
            }
        }
    }
    Ok(())
}
