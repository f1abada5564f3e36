//! The static state in stages: weight first, then the loads at t = 0.

use super::base::Base;
use super::model::Model;
use super::proximal::Standing;
use super::standing;
use super::static_state::StaticState;
use crate::bem::Ground;
use crate::error::Result;
use crate::interface::{ContactState, InterfaceLaw, Mode, StepStart, StepStarts, law_of};
use crate::structure::Structure;

/// Friction while the structure is placed on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
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
    /// For a structure that is dropped, or tilted and let go.
    ///
    /// ```
    /// use basemat::Simulation;
    /// use basemat::bem::SpringGround;
    /// use basemat::coupled::Placement;
    /// use basemat::interface::Coulomb;
    /// use basemat::structure::RigidBlock;
    ///
    /// // Tilted by 20 mrad about its left edge.
    /// let tilt = 0.02;
    /// let mut simulation = Simulation::builder(0.001)
    ///     .structure(RigidBlock::new(1.0, 4.0, 2400.0)?.with_p_delta(9.81)?)
    ///     .ground(SpringGround::new(-0.5..0.5, 8, 5e9, 2e9)?.with_dashpots(1e6, 1e6)?)
    ///     .interface(Coulomb::new(0.8)?)
    ///     .placement(Placement::Unloaded)
    ///     .initial_displacement([0.0, 0.5 * tilt, tilt])
    ///     .build()?;
    /// assert_eq!(simulation.state().uplifted_fraction, 1.0);
    /// let run = simulation.run(1000, |_| {})?;
    /// // It rocks over to the other edge, and less far.
    /// let other_side = -run.whole.base_rotation.lowest.value;
    /// assert!(other_side > 0.2 * tilt && other_side < tilt, "{other_side}");
    /// # Ok::<(), basemat::Error>(())
    /// ```
    Unloaded,
}

words! { Placement, "placement", {
    Frictionless = "frictionless",
    WithInterfaceLaw = "with_interface_law",
    Unloaded = "unloaded",
} }

/// Increments of a load under which elements slide: friction makes their path matter.
const INCREMENTS: usize = 10;

/// Passes in which laws that remember settle.
const PASSES: usize = 10;

/// Of the step that a stage is to the laws, s.
const TIME_STEP: f64 = 1.0;

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
    let at_rest = StepStart::new(ContactState::default(), Mode::Stick, TIME_STEP);
    let start = StepStarts::new(placing, &vec![at_rest; count])?;
    let mut state = StaticState::weightless(count, model.unknowns);
    for (e, mode) in state.modes.iter_mut().enumerate() {
        *mode = law_of(placing, e).modes()[0];
    }
    let found = settle(&stage, placing, start, state, weight);
    let (mut state, start) = found.map_err(|e| standing::cause(&stage, placing, weight, e))?;
    // A law without friction that remembers as much is the same law; others begin anew.
    state.memory = (0..count)
        .map(|e| {
            let own = start.memory_of(e);
            if own.len() == law_of(laws, e).memory() { own.to_vec() } else { Vec::new() }
        })
        .collect();
    if load.iter().all(|force| *force == 0.0) {
        return Ok(state);
    }
    // From here on the base sticks where it was placed.
    for (e, mode) in state.modes.iter_mut().enumerate() {
        let known = law_of(laws, e).modes();
        *mode = known.iter().copied().find(|m| m == mode && !m.is_closed()).unwrap_or(known[0]);
    }
    let placed: Vec<_> = (0..count)
        .map(|e| {
            let start = StepStart::new(*start.state(e), state.modes[e], TIME_STEP);
            start.with_memory(&state.memory[e])
        })
        .collect();
    let begin = StepStarts::new(laws, &placed)?;
    let total =
        |share: f64| -> Vec<f64> { weight.iter().zip(load).map(|(w, f)| w + share * f).collect() };
    let path = |increments: usize| -> Result<StaticState> {
        let (mut state, mut start) = (state.clone(), begin.clone());
        for k in 1..=increments {
            let load = total(k as f64 / increments as f64);
            (state, start) = settle(&stage, laws, start, state, &load)?;
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
        _ => path(INCREMENTS).map_err(|e| standing::cause(&stage, laws, &total(1.0), e)),
    }
}

/// Equilibrium under `load` from where `start` and `state` are, and where it leaves them: with laws
/// that remember it is found again until they remember nothing new.
fn settle(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    mut start: StepStarts,
    mut state: StaticState,
    load: &[f64],
) -> Result<(StaticState, StepStarts)> {
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
