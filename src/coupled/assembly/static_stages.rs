//! Stages of the static state: weight, and then the loads at t = 0.

use std::cell::Cell;

use super::growing_weight::state_under_growing_weight;
use super::settled::settle;
use crate::coupled::gravity_stage::GravityStage;
use crate::coupled::statics::buckling::has_p_delta;
use crate::coupled::statics::equilibrium::Standing;
use crate::coupled::statics::stability::cause;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, LawError, Result, StabilityError};
use crate::interface::{
    Condition, ContactState, InterfaceLaw, LawForm, Mode, PreviousContact, PreviousContacts,
    Tolerance, law_of,
};
use crate::linalg::largest;

/// Number of load increments if elements slide, since friction depends on the path.
const LOAD_INCREMENT_COUNT: usize = 10;

/// Tolerance of a law's conditions in a static state, relative to the largest pressure and displacement.
const LAW_CONDITION_TOLERANCE: f64 = 1e-6;

/// Step length that laws see in a gravity stage, s.
pub(super) const GRAVITY_STAGE_TIME_STEP: f64 = 1.0;

/// The state under `weight` by the chosen gravity stage, and the contact states at which laws start.
pub(super) fn placed(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    gravity_stage: GravityStage,
    weight: &[f64],
) -> Result<(StaticState, Vec<ContactState>)> {
    let layout = stage.assembled.base.layout();
    let count = layout.elements();
    let is_placed = gravity_stage != GravityStage::Frictional;
    // Limits apply without friction and cohesion.
    let by_limits = is_placed && LawForm::of(layout) == LawForm::Limits;
    let smooth: Vec<_> = laws.iter().map(InterfaceLaw::frictionless).collect();
    let can_open = laws.iter().any(|law| law.modes().contains(&Mode::Open));
    // A base that never opens is bonded from the start.
    let is_smooth = is_placed && !by_limits && can_open;
    let placing = if is_smooth { &smooth } else { laws };
    let at_rest =
        PreviousContact::new(ContactState::default(), Mode::Stick, GRAVITY_STAGE_TIME_STEP);
    let first = PreviousContacts::new(placing, &vec![at_rest; count])?;
    let mut state = StaticState::weightless(layout, weight.len());
    for (e, mode) in state.modes.iter_mut().enumerate() {
        *mode = law_of(placing, e).modes()[0];
    }
    let place = Standing { frictionless: by_limits, ..*stage };
    let found = settle(&place, placing, first.clone(), state.clone(), weight);
    let (mut state, start) = found.or_else(|error| {
        let error = cause(&place, placing, weight, error);
        state_under_growing_weight(&place, placing, (&first, state), weight, error)
    })?;
    if is_smooth {
        check_placed(laws, &state, &start)?;
    }
    // A frictionless law with as many state variables is the same law and keeps them. Other laws start with new
    // ones, and so do elements whose state variables have not changed.
    state.state_variables = Vec::with_capacity(count);
    for e in 0..count {
        let values = start.state_variables_of(e);
        let is_same_law = values.len() == law_of(laws, e).state_variables();
        let is_unchanged = values == first.state_variables_of(e);
        let is_kept = is_same_law && !(by_limits && is_unchanged);
        state.state_variables.push(if is_kept { values.to_vec() } else { Vec::new() });
    }
    Ok((state, (0..count).map(|e| *start.state(e)).collect()))
}

/// The state under `load` in addition to the `weight`, with the interface laws.
pub(super) fn loaded(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    (mut state, contact): (StaticState, Vec<ContactState>),
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    if load.iter().all(|force| *force == 0.0) {
        return Ok(state);
    }
    // From now on the base sticks at its place.
    state.modes = state.modes_with(laws);
    under_growing_load(stage, laws, (state, &contact), [weight, load])
}

/// The state under `weight` and `load`, from the `state` under the weight, with its contact states.
///
/// In one increment, or in several if elements slide or yield: friction depends on the path.
fn under_growing_load(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    (state, contact): (StaticState, &[ContactState]),
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    let count = state.modes.len();
    let placed: Vec<_> = (0..count)
        .map(|e| {
            let start = PreviousContact::new(contact[e], state.modes[e], GRAVITY_STAGE_TIME_STEP);
            start.with_state_variables(&state.state_variables[e])
        })
        .collect();
    let begin = PreviousContacts::new(laws, &placed)?;
    let total_load = |factor: f64| -> Vec<f64> {
        weight.iter().zip(load).map(|(weight, load)| weight + factor * load).collect()
    };
    let reached = Cell::new(0.0);
    let path = |increments: usize| -> Result<StaticState> {
        let mut state = state.clone();
        let mut start = begin.clone();
        reached.set(0.0);
        for k in 1..=increments {
            let factor = k as f64 / increments as f64;
            (state, start) = settle(stage, laws, start, state, &total_load(factor))?;
            reached.set(factor);
        }
        state.state_variables = (0..count).map(|e| start.state_variables_of(e).to_vec()).collect();
        Ok(state)
    };
    match path(1) {
        Ok(state) if !is_path_dependent(laws, &state) => Ok(state),
        _ => path(LOAD_INCREMENT_COUNT).map_err(|error| {
            let error = cause(stage, laws, &total_load(1.0), error);
            toppling_by_loads(stage, reached.get(), error)
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

/// Toppling beyond the fraction `reached` of the loads, where P–Δ explains an unexplained `error`.
fn toppling_by_loads(stage: &Standing<'_>, reached: f64, error: Error) -> Error {
    if matches!(error, Error::Preload { .. }) && has_p_delta(stage.structure) {
        let cause = StabilityError::Toppling { factor: reached, by_loads: true };
        return Error::Stability(Box::new(cause));
    }
    error
}

/// Error for a static state, found without friction, that the law of a closed element cannot hold.
///
/// Example: a law with a bearing pressure or a compliance whose frictionless law has none.
fn check_placed(
    laws: &[Box<dyn InterfaceLaw>],
    state: &StaticState,
    start: &PreviousContacts,
) -> Result<()> {
    let pressures = &state.traction[..state.modes.len()];
    let pressure = largest(pressures);
    let length = largest(&state.displacement);
    let tolerance =
        Tolerance::new(LAW_CONDITION_TOLERANCE * length, LAW_CONDITION_TOLERANCE * pressure);
    for (element, mode) in state.modes.iter().enumerate().filter(|(_, mode)| mode.is_closed()) {
        let law = law_of(laws, element);
        let contact = ContactState {
            gap: state.gap[element],
            pressure: pressures[element],
            ..ContactState::default()
        };
        let at_rest = law.modes()[0];
        let previous = PreviousContact::new(contact, at_rest, GRAVITY_STAGE_TIME_STEP);
        let values = start.state_variables_of(element);
        let first = previous.first_state_variables(law);
        let previous = previous.with_state_variables(if values.len() == first.len() {
            values
        } else {
            &first
        });
        let is_violated = |condition: &Condition| {
            let Condition { gap, pressure: factor, value, .. } = *condition;
            let residual = gap * contact.gap + factor * contact.pressure - value;
            let scale = gap.abs() * length + factor.abs() * pressure + value.abs();
            residual.abs() > LAW_CONDITION_TOLERANCE * scale
        };
        let next = law.next_mode(at_rest, &previous, &contact, tolerance);
        let is_at_limit = mode.is_yield() || mode.is_active();
        let yields = (next.is_yield() || next.is_active()) && !is_at_limit;
        if !yields && (is_at_limit || !law.conditions(at_rest, &previous).iter().any(is_violated)) {
            continue;
        }
        let needed = "one that the law holds at rest: give the law a `frictionless` of its own, or take \
                      `GravityStage::Frictional`, in which the law itself acts";
        let unheld = Error::Scene { quantity: "static state without friction", needed };
        let reason = Box::new(law.check_start(&previous).err().unwrap_or(unheld));
        return Err(Error::Law(LawError { element, mode: at_rest.word(), reason }));
    }
    Ok(())
}
