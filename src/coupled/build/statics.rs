//! The static state in stages: weight first, then the loads at t = 0.

use super::assembled::Assembled;
use super::equilibrium::{Standing, StaticState};
use super::parts::{GravityStage, Parts};
use crate::coupled::diagnosis::stability;
use crate::error::{Result, all_finite, finite};
use crate::interface::{
    ContactState, InterfaceLaw, Mode, PreviousContact, PreviousContacts, law_of,
};
use crate::structure::nonlinear_state;

/// Increments of a load under which elements slide: friction makes their path matter.
const INCREMENTS: usize = 10;

/// Passes in which laws that remember settle.
const PASSES: usize = 10;

/// Of the step that a stage is to the laws, s.
const TIME_STEP: f64 = 1.0;

/// The state under weight and the loads at t = 0, which the structure's internal variables follow;
/// trivial without gravity.
pub(super) fn solve(parts: &mut Parts, assembled: &Assembled) -> Result<StaticState> {
    let Parts { structure, ground, given, elements, .. } = parts;
    let (count, n) = (elements.len(), assembled.dofs());
    let mut state = StaticState::weightless(count, n);
    if given.is_static() {
        let mut own = vec![0.0; n];
        structure.load(0.0, &mut own)?;
        all_finite("load of the structure at t = 0", &own)?;
        let mut load = own.clone();
        for external in &given.loads {
            let force = external.value(0.0);
            external.row().iter().for_each(|&(i, weight)| load[i] += force * weight);
        }
        let mut weight = vec![0.0; n];
        let [_, up] = assembled.influence.of_all(n);
        assembled.mass.multiply_add(-given.gravity, &up, &mut weight);
        all_finite("weight", &weight)?;
        all_finite("load at t = 0", &load)?;
        let mut soil = vec![0.0; assembled.base.layout().square()];
        ground.static_compliance(&mut soil)?;
        let stage = Standing { assembled, structure: structure.as_ref(), soil: &soil };
        state = in_stages(&stage, &given.laws, given.gravity_stage, [&weight, &load])?;
        state.load = own;
        if let Some(force) = structure.nonlinear_mut() {
            force.commit(&state.displacement);
        }
    }
    (state.force, state.energy) = nonlinear_state(structure.as_ref(), &state.displacement)?;
    all_finite("nonlinear force at t = 0", &state.force)?;
    if let Some(energy) = &state.energy {
        finite("energy that the nonlinear force stores at t = 0", energy.stored)?;
        finite("energy that the nonlinear force has dissipated at t = 0", energy.dissipated)?;
    }
    Ok(state)
}

/// The state under `weight`, placed as chosen, and then under `load`, with the interface laws.
fn in_stages(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    gravity_stage: GravityStage,
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    let count = stage.assembled.base.lengths().len();
    let smooth: Vec<_> = laws.iter().map(InterfaceLaw::frictionless).collect();
    let can_open = laws.iter().any(|law| law.modes().contains(&Mode::Open));
    // A base that never opens is bonded from the start.
    let is_smooth = gravity_stage == GravityStage::Frictionless && can_open;
    let placing = if is_smooth { &smooth } else { laws };
    let at_rest = PreviousContact::new(ContactState::default(), Mode::Stick, TIME_STEP);
    let start = PreviousContacts::new(placing, &vec![at_rest; count])?;
    let mut state = StaticState::weightless(count, weight.len());
    for (e, mode) in state.modes.iter_mut().enumerate() {
        *mode = law_of(placing, e).modes()[0];
    }
    let found = settle(stage, placing, start, state, weight);
    let (mut state, start) = found.map_err(|e| stability::cause(stage, placing, weight, e))?;
    // A law without friction that remembers as much is the same law; others begin anew.
    state.memory = (0..count)
        .map(|e| {
            let own = start.memory_of(e);
            if own.len() == law_of(laws, e).state_variables() { own.to_vec() } else { Vec::new() }
        })
        .collect();
    if load.iter().all(|force| *force == 0.0) {
        return Ok(state);
    }
    // From here on the base sticks where it was placed.
    state.modes = state.modes_with(laws);
    let placed: Vec<_> = (0..count)
        .map(|e| {
            let start = PreviousContact::new(*start.state(e), state.modes[e], TIME_STEP);
            start.with_memory(&state.memory[e])
        })
        .collect();
    let begin = PreviousContacts::new(laws, &placed)?;
    let total =
        |share: f64| -> Vec<f64> { weight.iter().zip(load).map(|(w, f)| w + share * f).collect() };
    let path = |increments: usize| -> Result<StaticState> {
        let (mut state, mut start) = (state.clone(), begin.clone());
        for k in 1..=increments {
            let load = total(k as f64 / increments as f64);
            (state, start) = settle(stage, laws, start, state, &load)?;
        }
        state.memory = (0..count).map(|e| start.memory_of(e).to_vec()).collect();
        Ok(state)
    };
    let sticks = |e: usize| law_of(laws, e).modes().contains(&Mode::Stick);
    let takes_a_path = |state: &StaticState| {
        let mut modes = state.modes.iter().enumerate();
        modes.any(|(e, mode)| mode.is_slip() && sticks(e) || mode.is_yield())
    };
    match path(1) {
        Ok(state) if !takes_a_path(&state) => Ok(state),
        _ => path(INCREMENTS).map_err(|e| stability::cause(stage, laws, &total(1.0), e)),
    }
}

/// Equilibrium under `load` from where `start` and `state` are, and where it leaves them: with laws
/// that remember it is found again until they remember nothing new.
fn settle(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    mut start: PreviousContacts,
    mut state: StaticState,
    load: &[f64],
) -> Result<(StaticState, PreviousContacts)> {
    let mut memory = start.memory().to_vec();
    for _ in 0..PASSES {
        let contact;
        (state, contact) = stage.equilibrium(laws, &start, state, load)?;
        start.remember(laws, &contact, &state.modes, &mut memory)?;
        let is_settled = memory == start.memory();
        start.advance(&contact, &state.modes, &memory);
        start.slip_rates_mut().for_each(|rate| *rate = 0.0);
        if is_settled {
            break;
        }
    }
    Ok((state, start))
}
