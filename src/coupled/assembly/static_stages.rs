//! Stages of the static state: the weight first, then the loads at t = 0.

use std::cell::Cell;

use super::growing_weight::state_under_growing_weight;
use super::settled::settle;
use crate::coupled::gravity_stage::GravityStage;
use crate::coupled::statics::buckling::has_p_delta;
use crate::coupled::statics::equilibrium::StaticProblem;
use crate::coupled::statics::stability::cause;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, LawError, Result, StabilityError};
use crate::interface::{
    Condition, ContactState, InterfaceLaw, LawForm, Mode, PreviousContact, PreviousContacts,
    Tolerance, law_of,
};
use crate::linalg::largest;

/// Number of load increments if elements slide or yield: friction depends on the path.
const LOAD_INCREMENT_COUNT: usize = 10;

/// Tolerance of a law's conditions in a static state, relative to the largest pressure and displacement.
const LAW_CONDITION_TOLERANCE: f64 = 1e-6;

/// Time step of laws in a gravity stage, s; static states do not depend on it.
pub(super) const GRAVITY_STAGE_TIME_STEP: f64 = 1.0;

/// Static state under the `weight`, and the contact of its elements.
pub(super) fn state_under_weight(
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    gravity_stage: GravityStage,
    weight: &[f64],
) -> Result<(StaticState, Vec<ContactState>)> {
    let layout = problem.assembled.base.layout();
    let element_count = layout.elements();
    let is_frictionless = gravity_stage != GravityStage::Frictional;
    // Laws with limits act without friction and cohesion.
    let has_frictionless_limits = is_frictionless && LawForm::of(layout) == LawForm::Limits;
    let frictionless_laws: Vec<_> = laws.iter().map(InterfaceLaw::frictionless).collect();
    let can_open = laws.iter().any(|law| law.modes().contains(&Mode::Open));
    // A base that never opens is bonded from the start.
    let has_frictionless_laws = is_frictionless && !has_frictionless_limits && can_open;
    let weight_laws = if has_frictionless_laws { &frictionless_laws } else { laws };
    let at_rest =
        PreviousContact::new(ContactState::default(), Mode::Stick, GRAVITY_STAGE_TIME_STEP);
    let initial_contact = PreviousContacts::new(weight_laws, &vec![at_rest; element_count])?;
    let mut state = StaticState::weightless(layout, weight.len());
    for (e, mode) in state.modes.iter_mut().enumerate() {
        *mode = law_of(weight_laws, e).modes()[0];
    }
    let problem = StaticProblem { is_frictionless: has_frictionless_limits, ..*problem };
    let equilibrium = settle(&problem, weight_laws, initial_contact.clone(), state.clone(), weight);
    let (mut state, contact) = equilibrium.or_else(|error| {
        let error = cause(&problem, weight_laws, weight, error);
        let start = (&initial_contact, state);
        state_under_growing_weight(&problem, weight_laws, start, weight, error)
    })?;
    if has_frictionless_laws {
        check_frictionless_state(laws, &state, &contact)?;
    }
    // A frictionless law with as many state variables counts as the same law, and its variables are transferred. Other
    // laws start with initial state variables, as do elements whose state variables have not changed.
    state.state_variables = Vec::with_capacity(element_count);
    for e in 0..element_count {
        let values = contact.state_variables_of(e);
        let is_same_law = values.len() == law_of(laws, e).state_variables();
        let is_unchanged = values == initial_contact.state_variables_of(e);
        let is_transferred = is_same_law && !(has_frictionless_limits && is_unchanged);
        state.state_variables.push(if is_transferred { values.to_vec() } else { Vec::new() });
    }
    Ok((state, (0..element_count).map(|e| *contact.state(e)).collect()))
}

/// Static state under `weight` and `load`, from the state under the weight.
pub(super) fn state_under_load(
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    (mut state, contact): (StaticState, Vec<ContactState>),
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    if load.iter().all(|force| *force == 0.0) {
        return Ok(state);
    }
    // Under further loads the base sticks at its present position.
    state.modes = state.initial_modes(laws);
    state_under_growing_load(problem, laws, (state, &contact), [weight, load])
        .map(|(state, _)| state)
}

/// As [`state_under_load`], with the contacts from which further loads act.
pub(super) fn contacts_under_load(
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    (mut state, contact): (StaticState, Vec<ContactState>),
    [weight, load]: [&[f64]; 2],
) -> Result<(StaticState, PreviousContacts)> {
    state.modes = state.initial_modes(laws);
    if load.iter().all(|force| *force == 0.0) {
        let contacts = previous_contacts(laws, &state, &contact)?;
        return Ok((state, contacts));
    }
    state_under_growing_load(problem, laws, (state, &contact), [weight, load])
}

/// Contacts of a state without forces.
pub(super) fn unloaded_contacts(
    laws: &[Box<dyn InterfaceLaw>],
    state: &StaticState,
) -> Result<PreviousContacts> {
    let mut contact = vec![ContactState::default(); state.modes.len()];
    for (element, gap) in contact.iter_mut().zip(&state.gap) {
        element.gap = *gap;
    }
    previous_contacts(laws, state, &contact)
}

/// Contacts of a static state, from which the next stage begins.
fn previous_contacts(
    laws: &[Box<dyn InterfaceLaw>],
    state: &StaticState,
    contact: &[ContactState],
) -> Result<PreviousContacts> {
    let mut element_contacts = Vec::with_capacity(contact.len());
    for (e, contact) in contact.iter().enumerate() {
        let start = PreviousContact::new(*contact, state.modes[e], GRAVITY_STAGE_TIME_STEP);
        let variables = state.state_variables.get(e);
        element_contacts.push(start.with_state_variables(variables.map_or(&[], Vec::as_slice)));
    }
    PreviousContacts::new(laws, &element_contacts)
}

/// Static state under `weight` and `load`, from the `state` under the weight with its contact.
///
/// The load is applied in one increment, or in several if elements slide or yield: friction depends on the path.
fn state_under_growing_load(
    problem: &StaticProblem<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    (state, contact): (StaticState, &[ContactState]),
    [weight, load]: [&[f64]; 2],
) -> Result<(StaticState, PreviousContacts)> {
    let element_count = state.modes.len();
    let initial_contact = previous_contacts(laws, &state, contact)?;
    let total_load = |factor: f64| -> Vec<f64> {
        weight.iter().zip(load).map(|(weight, load)| weight + factor * load).collect()
    };
    // Largest factor of the load with an equilibrium.
    let equilibrium_factor = Cell::new(0.0);
    let follow_path = |increment_count: usize| -> Result<(StaticState, PreviousContacts)> {
        let mut state = state.clone();
        let mut contact = initial_contact.clone();
        equilibrium_factor.set(0.0);
        for k in 1..=increment_count {
            let factor = k as f64 / increment_count as f64;
            (state, contact) = settle(problem, laws, contact, state, &total_load(factor))?;
            equilibrium_factor.set(factor);
        }
        state.state_variables =
            (0..element_count).map(|e| contact.state_variables_of(e).to_vec()).collect();
        Ok((state, contact))
    };
    match follow_path(1) {
        Ok(found) if !is_path_dependent(laws, &found.0) => Ok(found),
        _ => follow_path(LOAD_INCREMENT_COUNT).map_err(|error| {
            let error = cause(problem, laws, &total_load(1.0), error);
            toppling_by_loads(problem, equilibrium_factor.get(), error)
        }),
    }
}

/// Whether an element slides against its friction, or yields.
fn is_path_dependent(laws: &[Box<dyn InterfaceLaw>], state: &StaticState) -> bool {
    state.modes.iter().enumerate().any(|(e, mode)| {
        let can_stick = law_of(laws, e).modes().contains(&Mode::Stick);
        mode.is_slip() && can_stick || mode.is_yield() || mode.is_active()
    })
}

/// Replaces an unexplained `error` by toppling, for a structure with P–Δ.
///
/// `equilibrium_factor` is the largest factor of the loads with an equilibrium.
fn toppling_by_loads(problem: &StaticProblem<'_>, equilibrium_factor: f64, error: Error) -> Error {
    if matches!(error, Error::Preload { .. }) && has_p_delta(problem.structure) {
        let cause = StabilityError::Toppling { factor: equilibrium_factor, by_loads: true };
        return Error::Stability(Box::new(cause));
    }
    error
}

/// Returns an error for a frictionless static state that violates the law of a closed element.
///
/// An example is a law with a bearing pressure or a compliance, if its frictionless law has none.
fn check_frictionless_state(
    laws: &[Box<dyn InterfaceLaw>],
    state: &StaticState,
    start: &PreviousContacts,
) -> Result<()> {
    let pressures = &state.traction[..state.modes.len()];
    let pressure_scale = largest(pressures);
    let length_scale = largest(&state.displacement);
    let tolerance = Tolerance::new(
        LAW_CONDITION_TOLERANCE * length_scale,
        LAW_CONDITION_TOLERANCE * pressure_scale,
    );
    for (element, mode) in state.modes.iter().enumerate().filter(|(_, mode)| mode.is_closed()) {
        let law = law_of(laws, element);
        let contact = ContactState {
            gap: state.gap[element],
            pressure: pressures[element],
            ..ContactState::default()
        };
        let first_mode = law.modes()[0];
        let previous = PreviousContact::new(contact, first_mode, GRAVITY_STAGE_TIME_STEP);
        let values = start.state_variables_of(element);
        let initial_values = previous.first_state_variables(law);
        let has_same_count = values.len() == initial_values.len();
        let previous =
            previous.with_state_variables(if has_same_count { values } else { &initial_values });
        let is_violated = |condition: &Condition| {
            let Condition { gap: gap_factor, pressure: pressure_factor, value, .. } = *condition;
            let residual = gap_factor * contact.gap + pressure_factor * contact.pressure - value;
            let scale = gap_factor.abs() * length_scale
                + pressure_factor.abs() * pressure_scale
                + value.abs();
            residual.abs() > LAW_CONDITION_TOLERANCE * scale
        };
        let next_mode = law.next_mode(first_mode, &previous, &contact, tolerance);
        let is_at_limit = mode.is_yield() || mode.is_active();
        let starts_yielding = (next_mode.is_yield() || next_mode.is_active()) && !is_at_limit;
        let has_violation = || law.conditions(first_mode, &previous).iter().any(is_violated);
        if !starts_yielding && (is_at_limit || !has_violation()) {
            continue;
        }
        let needed = "one that satisfies the law: implement `frictionless` of the law, or use \
                      `GravityStage::Frictional`, in which the law itself acts";
        let violation = Error::Scene { quantity: "static state without friction", needed };
        let reason = Box::new(law.check_start(&previous).err().unwrap_or(violation));
        return Err(Error::Law(LawError { element, mode: first_mode.word(), reason }));
    }
    Ok(())
}
