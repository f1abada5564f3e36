//! Static state under a weight that grows from nothing together with its P–Δ.

use std::cell::RefCell;

use super::settled::settle;
use crate::coupled::model::assembled::LoadedStiffness;
use crate::coupled::statics::equilibrium::Standing;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result, StabilityError};
use crate::interface::{InterfaceLaw, PreviousContacts};

/// First increment of the weight, and the increment at whose failure there is no equilibrium.
const FIRST_INCREMENT: f64 = 0.25;
const SMALLEST_INCREMENT: f64 = 1.0 / 64.0;

/// Follows the static state to the whole `weight` from the `unloaded` one, after a search under the whole weight ended in
/// `error`.
///
/// Under the whole weight a structure leans by its whole P–Δ before the soil resists, and a search may pass an equilibrium.
/// Returns `error` without P–Δ, and [`StabilityError::Toppling`] where no equilibrium follows.
pub(super) fn state_under_growing_weight(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    (start, unloaded): (&PreviousContacts, StaticState),
    weight: &[f64],
    error: Error,
) -> Result<(StaticState, PreviousContacts)> {
    let assembled = stage.assembled;
    // A structure condensed on its base has other degrees of freedom.
    let is_whole = stage.structure.dofs() == assembled.dofs();
    if !is_whole || !is_unexplained(&error) {
        return Err(error);
    }
    let Some(loaded) = LoadedStiffness::new(stage.structure, &assembled.stiffness) else {
        return Err(error);
    };
    let mut reached = 0.0;
    let mut increment = FIRST_INCREMENT;
    let mut state = unloaded;
    loop {
        let factor = f64::min(reached + increment, 1.0);
        let settled = if factor == 1.0 {
            settle(stage, laws, start.clone(), state.clone(), weight)
        } else {
            let assembled = assembled.with_stiffness(loaded.at(factor)?);
            let shared = RefCell::default();
            let stage = Standing { assembled: &assembled, shared: &shared, ..*stage };
            let reduced_weight: Vec<f64> = weight.iter().map(|force| factor * force).collect();
            settle(&stage, laws, start.clone(), state.clone(), &reduced_weight)
        };
        match settled {
            Ok(found) if factor == 1.0 => return Ok(found),
            Ok((found, _)) => (reached, state) = (factor, found),
            Err(Error::Preload { .. }) if increment > SMALLEST_INCREMENT => increment *= 0.5,
            Err(Error::Preload { .. }) if reached == 0.0 => return Err(error),
            Err(Error::Preload { .. }) => {
                let cause = StabilityError::Toppling { factor: reached, by_loads: false };
                return Err(Error::Stability(Box::new(cause)));
            }
            Err(other) => return Err(other),
        }
    }
}

/// Whether the reason why there is no equilibrium is unknown, or may be rounding.
///
/// A weight has no torque: without friction its rounding already exceeds the resistance.
fn is_unexplained(error: &Error) -> bool {
    match error {
        Error::Preload { .. } => true,
        Error::Stability(cause) => {
            matches!(**cause, StabilityError::Twisting { resistance: 0.0, .. })
        }
        _ => false,
    }
}
