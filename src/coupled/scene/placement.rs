//! The static state: weight first, then the loads at t = 0, contact conditions included.

use super::base::Base;
use super::model::Model;
use super::proximal::Standing;
use super::standing;
use super::static_state::StaticState;
use crate::bem::Ground;
use crate::error::Result;
use crate::interface::{
    ContactState, InterfaceLaw, Mode, StepStart, StepStarts, law_of, memory_ends,
};
use crate::structure::Structure;

/// Friction while the structure is placed on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Placement {
    /// The base is placed without friction and without adhesion, and sticks from then on. What
    /// does not touch under weight alone starts open. Where no element's law ever opens, the base
    /// is bonded from the start.
    #[default]
    Frictionless,
    /// The interface law acts while the weight comes on, in one step.
    WithInterfaceLaw,
    /// There is no static state: the base begins unpressed, and weight and loads act from t = 0 on.
    /// For a structure that is dropped, or tilted and let go
    /// ([`initial_displacement`](crate::coupled::SimulationBuilder::initial_displacement)).
    Unloaded,
}

/// Increments of a load under which elements slide: friction makes their path matter.
const INCREMENTS: usize = 10;

/// Nothing has happened yet.
const AT_REST: StepStart<'static> = StepStart {
    state: ContactState { gap: 0.0, slip: 0.0, pressure: 0.0, shear: 0.0 },
    mode: Mode::Stick,
    has_opened: false,
    slip_rate: 0.0,
    static_pressure: 0.0,
    time_step: 1.0,
    memory: &[],
};

/// The state under `weight`, placed as chosen, and then under `load`, with the interface laws.
pub(crate) fn solve(
    (model, structure, base): (&Model, &dyn Structure, &Base),
    ground: &dyn Ground,
    laws: &[Box<dyn InterfaceLaw>],
    placement: Placement,
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    let count = base.lengths().len();
    let mut soil = vec![0.0; 4 * count * count];
    ground.static_compliance(&mut soil)?;
    let stage = Standing { model, structure, base, soil: &soil };
    let smooth: Vec<_> = laws.iter().map(InterfaceLaw::smooth).collect();
    let can_open = laws.iter().any(|law| law.modes().contains(&Mode::Open));
    // A base that never opens is bonded from the start.
    let is_smooth = placement == Placement::Frictionless && can_open;
    let placing = if is_smooth { &smooth } else { laws };
    let start = StepStarts::new(placing, &vec![AT_REST; count])?;
    let mut state = StaticState::weightless(count, model.unknowns);
    for (e, mode) in state.modes.iter_mut().enumerate() {
        *mode = law_of(placing, e).modes()[0];
    }
    let found = stage.equilibrium(placing, &start, state, weight);
    let (mut state, contact) = found.map_err(|e| standing::cause(&stage, placing, weight, e))?;
    let mut memory = start.memory().to_vec();
    start.remember(placing, &contact, &state.modes, &mut memory)?;
    // A law without friction that remembers as much is the same law; others begin anew.
    if memory_ends(placing, count)? == memory_ends(laws, count)? {
        state.memory = memory;
    }
    if load.iter().all(|force| *force == 0.0) {
        return Ok(state);
    }
    // From here on the base sticks where it was placed.
    for (e, mode) in state.modes.iter_mut().enumerate() {
        let known = law_of(laws, e).modes();
        *mode = known.iter().copied().find(|m| m == mode && !m.is_closed()).unwrap_or(known[0]);
    }
    let begin: Vec<_> = (contact.iter().zip(&state.modes))
        .map(|(contact, &mode)| StepStart::new(*contact, mode, AT_REST.time_step))
        .collect();
    let mut begin = StepStarts::new(laws, &begin)?;
    if !state.memory.is_empty() {
        begin.memory_mut().copy_from_slice(&state.memory);
    }
    let path = |increments: usize| -> Result<StaticState> {
        let (mut state, mut start) = (state.clone(), begin.clone());
        for k in 1..=increments {
            let share = k as f64 / increments as f64;
            let total: Vec<f64> = weight.iter().zip(load).map(|(w, f)| w + share * f).collect();
            let (next, contact) = stage.equilibrium(laws, &start, state, &total)?;
            let mut memory = start.memory().to_vec();
            start.remember(laws, &contact, &next.modes, &mut memory)?;
            start.advance(&contact, &next.modes, &memory);
            start.slip_rates_mut().for_each(|rate| *rate = 0.0);
            state = next;
        }
        state.memory = start.memory().to_vec();
        Ok(state)
    };
    let sticks = |e: usize| law_of(laws, e).modes().contains(&Mode::Stick);
    let slides = |state: &StaticState| {
        state.modes.iter().enumerate().any(|(e, mode)| mode.is_slip() && sticks(e))
    };
    match path(1) {
        Ok(state) if !slides(&state) => Ok(state),
        _ => path(INCREMENTS).map_err(|error| {
            let total: Vec<f64> = weight.iter().zip(load).map(|(w, f)| w + f).collect();
            standing::cause(&stage, laws, &total, error)
        }),
    }
}
