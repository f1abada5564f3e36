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
    let first_variables = start.state_variables().to_vec();
    let mut state_variables = first_variables.clone();
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
            check_settled(&first_variables, &start, &state_variables)?;
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
///
/// Of an element that hardly bears they are rounding themselves: a change counts relative to the variable, or to the
/// largest change of the same variable of any element since the `first` pass.
fn check_settled(first: &[f64], start: &PreviousContacts, now: &[f64]) -> Result<()> {
    let ends = start.state_variable_ends();
    let count_of = |element: usize| ends[element] - if element > 0 { ends[element - 1] } else { 0 };
    let mut total_changes = vec![0.0; (0..ends.len()).map(count_of).max().unwrap_or(0)];
    let mut places = Vec::with_capacity(now.len());
    (0..ends.len()).for_each(|element| places.extend(0..count_of(element)));
    for (place, (before, now)) in places.iter().zip(first.iter().zip(now)) {
        total_changes[*place] = f64::max(total_changes[*place], (now - before).abs());
    }
    let mut largest_change = 0.0_f64;
    for (place, (before, now)) in places.iter().zip(start.state_variables().iter().zip(now)) {
        let size = before.abs().max(now.abs()).max(total_changes[*place]);
        if size > 0.0 {
            largest_change = largest_change.max((now - before).abs() / size);
        }
    }
    if largest_change <= STATE_VARIABLE_TOLERANCE {
        return Ok(());
    }
    let percent = 100.0 * largest_change;
    let change = format!("by {percent:.2} % in the last of {MAX_SETTLING_PASSES} passes");
    let reason = format!(
        "its state variables do not settle under weight and loads at t = 0: they change {change}"
    );
    Err(Error::part("interface law", reason))
}
