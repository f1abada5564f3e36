//! Equilibrium in which the state variables of the laws are constant.

use crate::coupled::statics::equilibrium::StaticProblem;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result};
use crate::interface::{ContactState, InterfaceLaw, PreviousContacts};

/// Largest number of passes until the state variables are constant.
///
/// The laws of this crate need two or three.
const MAX_SETTLING_PASSES: usize = 10;

/// Relative change of a state variable in the last pass that counts as rounding.
const STATE_VARIABLE_TOLERANCE: f64 = 1e-6;

/// Computes the equilibrium under `load`, from the state and contact of the previous stage.
///
/// For laws with state variables the computation is repeated until the state variables are constant.
pub(super) fn settle(
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    mut start: PreviousContacts,
    mut state: StaticState,
    load: &[f64],
) -> Result<(StaticState, PreviousContacts)> {
    let initial_variables = start.state_variables().to_vec();
    let mut state_variables = initial_variables.clone();
    for pass in 1..=MAX_SETTLING_PASSES {
        let contact;
        (state, contact) = problem.equilibrium(laws, &start, state, load)?;
        let mut law_contact = contact.clone();
        if problem.is_frictionless {
            // The laws update their variables as for a base that sticks without slip.
            state.modes.iter_mut().for_each(|mode| *mode = mode.sticking());
            for (e, element) in law_contact.iter_mut().enumerate() {
                let ContactState { slip, slip_across, .. } = *start.state(e);
                element.slip = slip;
                element.slip_across = slip_across;
            }
        }
        start.update_state_variables(laws, &law_contact, &state.modes, &mut state_variables)?;
        let is_settled = state_variables == start.state_variables();
        if pass == MAX_SETTLING_PASSES && !is_settled {
            check_settled(&initial_variables, &start, &state_variables)?;
        }
        start.advance(&contact, &state.modes, &state_variables);
        start.slip_rates_mut().for_each(|rate| *rate = 0.0);
        if is_settled {
            break;
        }
    }
    Ok((state, start))
}

/// Returns an error for state variables that change at rest by more than rounding.
///
/// The state variables of an element with almost no pressure may be rounding themselves. The change is therefore
/// relative to the larger of two numbers: the variable, and the largest change of the same variable in any element
/// since `initial_values`.
fn check_settled(initial_values: &[f64], start: &PreviousContacts, values: &[f64]) -> Result<()> {
    let ends = start.state_variable_ends();
    let count_of = |element: usize| ends[element] - if element > 0 { ends[element - 1] } else { 0 };
    let mut total_changes = vec![0.0; (0..ends.len()).map(count_of).max().unwrap_or(0)];
    let mut variable_indices = Vec::with_capacity(values.len());
    (0..ends.len()).for_each(|element| variable_indices.extend(0..count_of(element)));
    for (index, (initial, value)) in variable_indices.iter().zip(initial_values.iter().zip(values))
    {
        total_changes[*index] = f64::max(total_changes[*index], (value - initial).abs());
    }
    let mut largest_change = 0.0_f64;
    let previous_values = start.state_variables();
    for (index, (previous, value)) in
        variable_indices.iter().zip(previous_values.iter().zip(values))
    {
        let magnitude = previous.abs().max(value.abs()).max(total_changes[*index]);
        if magnitude > 0.0 {
            largest_change = largest_change.max((value - previous).abs() / magnitude);
        }
    }
    if largest_change <= STATE_VARIABLE_TOLERANCE {
        return Ok(());
    }
    let reason = format!(
        "its state variables do not settle under weight and loads at t = 0: they change by {:.2} % in the last of \
         {MAX_SETTLING_PASSES} passes",
        100.0 * largest_change
    );
    Err(Error::part("interface law", reason))
}
