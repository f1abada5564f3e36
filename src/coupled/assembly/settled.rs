//! Equilibrium with state variables of the laws that have become constant.

use crate::coupled::statics::equilibrium::Standing;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result};
use crate::interface::{ContactState, InterfaceLaw, PreviousContacts};

/// Largest number of passes until state variables of laws are constant.
const MAX_SETTLING_PASSES: usize = 10;

/// Relative change of a state variable in the last pass that counts as rounding.
const STATE_VARIABLE_TOLERANCE: f64 = 1e-6;

/// Equilibrium under `load`, starting from `start` and `state`; returns the final state.
///
/// With state variables it is repeated until these are constant.
pub(super) fn settle(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    mut start: PreviousContacts,
    mut state: StaticState,
    load: &[f64],
) -> Result<(StaticState, PreviousContacts)> {
    let mut state_variables = start.state_variables().to_vec();
    for pass in 1..=MAX_SETTLING_PASSES {
        let contact;
        (state, contact) = stage.equilibrium(laws, &start, state, load)?;
        let mut seen = contact.clone();
        if stage.frictionless {
            // The laws update their variables for a base that sticks at its place.
            state.modes.iter_mut().for_each(|mode| *mode = mode.sticking());
            for (e, element) in seen.iter_mut().enumerate() {
                let ContactState { slip, slip_across, .. } = *start.state(e);
                element.slip = slip;
                element.slip_across = slip_across;
            }
        }
        start.update_state_variables(laws, &seen, &state.modes, &mut state_variables)?;
        let is_settled = state_variables == start.state_variables();
        if pass == MAX_SETTLING_PASSES && !is_settled {
            check_settled(start.state_variables(), &state_variables)?;
        }
        start.advance(&contact, &state.modes, &state_variables);
        start.slip_rates_mut().for_each(|rate| *rate = 0.0);
        if is_settled {
            break;
        }
    }
    Ok((state, start))
}

/// Error for state variables that change at rest by more than rounding.
fn check_settled(before: &[f64], now: &[f64]) -> Result<()> {
    let changes = before.iter().zip(now).map(|(before, now)| {
        let size = before.abs().max(now.abs());
        if size > 0.0 { (now - before).abs() / size } else { 0.0 }
    });
    let change = changes.fold(0.0, f64::max);
    if change <= STATE_VARIABLE_TOLERANCE {
        return Ok(());
    }
    let change = format!("by {:.2} % in the last of {MAX_SETTLING_PASSES} passes", 100.0 * change);
    let reason = format!(
        "its state variables do not settle under weight and loads at t = 0: they change {change}"
    );
    Err(Error::part("interface law", reason))
}
