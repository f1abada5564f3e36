//! Static state under a weight that grows from zero together with its P–Δ.

use std::cell::RefCell;

use super::settled::settle;
use crate::coupled::model::assembled::LoadedStiffness;
use crate::coupled::statics::equilibrium::StaticProblem;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result, StabilityError};
use crate::interface::{InterfaceLaw, PreviousContacts};

/// First increment of the weight, as a fraction of the whole.
const FIRST_WEIGHT_INCREMENT: f64 = 0.25;
/// Increment without equilibrium at which the structure counts as unstable.
///
/// As a fraction of the whole weight.
const MIN_WEIGHT_INCREMENT: f64 = 1.0 / 64.0;

/// Follows the static state while the weight grows.
///
/// The function is for weights under which a search has failed. Under the whole weight a structure with P–Δ tilts
/// before the soil resists, and a search may pass the equilibrium. The path starts from the state and contact without
/// weight. If it ends before the whole weight, the error is [`StabilityError::Toppling`]. The function returns the
/// failed search's `error` if this error has a known cause, if no part of the weight has an equilibrium, and for a
/// structure that is condensed or has no P–Δ.
pub(super) fn state_under_growing_weight(
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    (start, unloaded_state): (&PreviousContacts, StaticState),
    weight: &[f64],
    error: Error,
) -> Result<(StaticState, PreviousContacts)> {
    let assembled = problem.assembled;
    // A structure condensed on its base has other degrees of freedom.
    let is_whole = problem.structure.dofs() == assembled.dofs();
    if !is_whole || !is_unexplained(&error) {
        return Err(error);
    }
    let Some(loaded) = LoadedStiffness::new(problem.structure, &assembled.stiffness) else {
        return Err(error);
    };
    let mut equilibrium_factor = 0.0;
    let mut increment = FIRST_WEIGHT_INCREMENT;
    let mut state = unloaded_state;
    loop {
        let factor = f64::min(equilibrium_factor + increment, 1.0);
        let equilibrium = if factor == 1.0 {
            settle(problem, laws, start.clone(), state.clone(), weight)
        } else {
            let assembled = assembled.with_stiffness(loaded.at_factor(factor)?);
            let shared_compliance = RefCell::default();
            let problem = StaticProblem {
                assembled: &assembled,
                shared_compliance: &shared_compliance,
                ..*problem
            };
            let reduced_weight: Vec<f64> = weight.iter().map(|force| factor * force).collect();
            settle(&problem, laws, start.clone(), state.clone(), &reduced_weight)
        };
        match equilibrium {
            Ok(equilibrium) if factor == 1.0 => return Ok(equilibrium),
            Ok((next_state, _)) => {
                equilibrium_factor = factor;
                state = next_state;
            }
            Err(Error::Preload { .. }) if increment > MIN_WEIGHT_INCREMENT => increment *= 0.5,
            Err(Error::Preload { .. }) if equilibrium_factor == 0.0 => return Err(error),
            Err(Error::Preload { .. }) => {
                let cause =
                    StabilityError::Toppling { factor: equilibrium_factor, by_loads: false };
                return Err(Error::Stability(Box::new(cause)));
            }
            Err(other) => return Err(other),
        }
    }
}

/// Whether the cause of the missing equilibrium is unknown, or is only rounding.
///
/// A weight has no torque. Without friction a torque that is rounding exceeds the resistance, which is zero.
fn is_unexplained(error: &Error) -> bool {
    match error {
        Error::Preload { .. } => true,
        Error::Stability(cause) => {
            matches!(**cause, StabilityError::Twisting { resistance: 0.0, .. })
        }
        _ => false,
    }
}
