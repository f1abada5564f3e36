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
const INCREMENTS: usize = 10;

/// Tolerance of a law's conditions in a static state, relative to the largest pressure and displacement.
const PLACED: f64 = 1e-6;

/// Step length that laws see in a gravity stage, s.
pub(super) const TIME_STEP: f64 = 1.0;

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
    let at_rest = PreviousContact::new(ContactState::default(), Mode::Stick, TIME_STEP);
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
    let keeps = |e: usize, own: &[f64]| {
        let is_same = own.len() == law_of(laws, e).state_variables();
        is_same && !(by_limits && own == first.state_variables_of(e))
    };
    state.state_variables = (0..count)
        .map(|e| {
            let own = start.state_variables_of(e);
            if keeps(e, own) { own.to_vec() } else { Vec::new() }
        })
        .collect();
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
            let start = PreviousContact::new(contact[e], state.modes[e], TIME_STEP);
            start.with_state_variables(&state.state_variables[e])
        })
        .collect();
    let begin = PreviousContacts::new(laws, &placed)?;
    let total =
        |share: f64| -> Vec<f64> { weight.iter().zip(load).map(|(w, f)| w + share * f).collect() };
    let reached = Cell::new(0.0);
    let path = |increments: usize| -> Result<StaticState> {
        let (mut state, mut start) = (state.clone(), begin.clone());
        reached.set(0.0);
        for k in 1..=increments {
            let share = k as f64 / increments as f64;
            (state, start) = settle(stage, laws, start, state, &total(share))?;
            reached.set(share);
        }
        state.state_variables = (0..count).map(|e| start.state_variables_of(e).to_vec()).collect();
        Ok(state)
    };
    let sticks = |e: usize| law_of(laws, e).modes().contains(&Mode::Stick);
    let takes_a_path = |state: &StaticState| {
        let mut modes = state.modes.iter().enumerate();
        modes.any(|(e, mode)| mode.is_slip() && sticks(e) || mode.is_yield() || mode.is_active())
    };
    match path(1) {
        Ok(state) if !takes_a_path(&state) => Ok(state),
        _ => path(INCREMENTS).map_err(|error| {
            let error = cause(stage, laws, &total(1.0), error);
            named_by_loads(stage, reached.get(), error)
        }),
    }
}

/// The reason of `error`, if no other is known: a structure with P–Δ falls over beyond the share `reached` of its loads.
fn named_by_loads(stage: &Standing<'_>, reached: f64, error: Error) -> Error {
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
    let [pressure, length] = [pressures, &state.displacement].map(largest);
    let tolerance = Tolerance::new(PLACED * length, PLACED * pressure);
    for (element, mode) in state.modes.iter().enumerate().filter(|(_, mode)| mode.is_closed()) {
        let law = law_of(laws, element);
        let contact = ContactState {
            gap: state.gap[element],
            pressure: pressures[element],
            ..ContactState::default()
        };
        let at_rest = law.modes()[0];
        let previous = PreviousContact::new(contact, at_rest, TIME_STEP);
        let own = start.state_variables_of(element);
        let first = previous.first_state_variables(law);
        let previous =
            previous.with_state_variables(if own.len() == first.len() { own } else { &first });
        let misses = |condition: &Condition| {
            let Condition { gap, pressure: factor, value, .. } = *condition;
            let miss = gap * contact.gap + factor * contact.pressure - value;
            miss.abs() > PLACED * (gap.abs() * length + factor.abs() * pressure + value.abs())
        };
        let next = law.next_mode(at_rest, &previous, &contact, tolerance);
        let is_at_limit = mode.is_yield() || mode.is_active();
        let yields = (next.is_yield() || next.is_active()) && !is_at_limit;
        if !yields && (is_at_limit || !law.conditions(at_rest, &previous).iter().any(misses)) {
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
