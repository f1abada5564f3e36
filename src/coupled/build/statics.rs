//! The static state in stages, weight first, then the loads at t = 0, and the initial motion.

use super::assembled::Assembled;
use super::equilibrium::{Standing, StaticState};
use super::gravity_stage::GravityStage;
use super::parts::{Parts, SimulationBuilder};
use crate::coupled::diagnosis;
use crate::coupled::scene::Scene;
use crate::coupled::scene::influence::UP;
use crate::coupled::state::State;
use crate::error::{Error, LawError, Result, all_finite, finite, require, require_part};
use crate::geometry::PLANE;
use crate::interface::{
    Condition, ContactState, InterfaceLaw, Mode, PreviousContact, PreviousContacts, Tolerance,
    law_of,
};
use crate::linalg::matrix::Matrix;
use crate::linalg::{SparseFactor, SparseMatrix, Triplets, largest};
use crate::structure::{Structure, massless, nonlinear_state};

/// Increments of a load under which elements slide: friction makes their path matter.
const INCREMENTS: usize = 10;

/// Passes in which state variables of laws settle.
const PASSES: usize = 10;

/// Relative change of a state variable in the last pass that is taken for rounding.
const UNSETTLED: f64 = 1e-6;

/// Part of the largest pressure and displacement by which a static state may miss the conditions of a law.
const PLACED: f64 = 1e-6;

/// Length of the step that a gravity stage is to the laws, s.
const TIME_STEP: f64 = 1.0;

/// The state under weight and the loads at t = 0, which the structure's internal variables follow;
/// trivial without gravity.
pub(super) fn solve(parts: &mut Parts, assembled: &Assembled) -> Result<StaticState> {
    let mut state = StaticState::weightless(parts.elements.layout(), assembled.dofs());
    if parts.given.is_static() {
        state = under_loads(parts, assembled, &compliance(parts)?)?;
        if let Some(force) = parts.structure.nonlinear_mut() {
            force.commit(&state.displacement);
        }
    }
    let structure = &parts.structure;
    (state.force, state.energy) = nonlinear_state(structure.as_ref(), &state.displacement)?;
    all_finite("nonlinear force at t = 0", &state.force)?;
    if let Some(energy) = &state.energy {
        finite("energy that the nonlinear force stores at t = 0", energy.stored)?;
        finite("energy that the nonlinear force has dissipated at t = 0", energy.dissipated)?;
    }
    Ok(state)
}

/// Static compliance of the ground, for tractions inside the outline.
pub(super) fn compliance(parts: &Parts) -> Result<Vec<f64>> {
    let mut soil = vec![0.0; parts.elements.layout().square()];
    parts.ground.static_compliance(&mut soil)?;
    parts.elements.refer_inside(&mut soil);
    Ok(soil)
}

/// The state under weight and the loads at t = 0 on elements of this static compliance; internal variables of the
/// structure stay as they are.
pub(super) fn under_loads(
    parts: &Parts,
    assembled: &Assembled,
    soil: &[f64],
) -> Result<StaticState> {
    let Parts { structure, given, .. } = parts;
    let n = assembled.dofs();
    let mut own = vec![0.0; n];
    structure.load(0.0, &mut own)?;
    all_finite("load of the structure at t = 0", &own)?;
    let mut load = own.clone();
    for external in &given.loads {
        let force = external.value(0.0);
        external.row().iter().for_each(|&(i, weight)| load[i] += force * weight);
    }
    let mut weight = vec![0.0; n];
    let up = assembled.influence.of(UP, n);
    assembled.mass.multiply_add(-given.gravity, &up, &mut weight);
    all_finite("weight", &weight)?;
    all_finite("load at t = 0", &load)?;
    let (structure, frictionless) = (structure.as_ref(), false);
    let stage = Standing { assembled, structure, soil, frictionless };
    let state = in_stages(&stage, &given.laws, given.gravity_stage, [&weight, &load])?;
    Ok(StaticState { load: own, ..state })
}

/// The state under `weight`, placed as chosen, and then under `load`, with the interface laws.
fn in_stages(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    gravity_stage: GravityStage,
    [weight, load]: [&[f64]; 2],
) -> Result<StaticState> {
    let layout = stage.assembled.base.layout();
    let count = layout.elements();
    let is_placed = gravity_stage == GravityStage::Frictionless;
    // In plan the laws' own limits hold, all but friction and cohesion.
    let by_limits = is_placed && layout.is_plan();
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
    let found = settle(&place, placing, first.clone(), state, weight);
    let (mut state, start) = found.map_err(|e| diagnosis::cause(&place, placing, weight, e))?;
    if is_smooth {
        check_placed(laws, &state, &start)?;
    }
    // A frictionless law with as many state variables is the same law. Others begin anew, and so do elements to whose
    // law nothing happened.
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
    if load.iter().all(|force| *force == 0.0) {
        return Ok(state);
    }
    // From here on the base sticks where it was placed.
    state.modes = state.modes_with(laws);
    let placed: Vec<_> = (0..count)
        .map(|e| {
            let start = PreviousContact::new(*start.state(e), state.modes[e], TIME_STEP);
            start.with_state_variables(&state.state_variables[e])
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
        state.state_variables = (0..count).map(|e| start.state_variables_of(e).to_vec()).collect();
        Ok(state)
    };
    let sticks = |e: usize| law_of(laws, e).modes().contains(&Mode::Stick);
    let takes_a_path = |state: &StaticState| {
        let mut modes = state.modes.iter().enumerate();
        modes.any(|(e, mode)| mode.is_slip() && sticks(e) || mode.is_yield())
    };
    match path(1) {
        Ok(state) if !takes_a_path(&state) => Ok(state),
        _ => path(INCREMENTS).map_err(|e| diagnosis::cause(stage, laws, &total(1.0), e)),
    }
}

/// Refuses a static state, found without friction, that the law of a closed element does not hold: a law with a bearing
/// pressure or a compliance, say, whose frictionless law has none.
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
        let yields = next.is_yield() && !mode.is_yield();
        if !yields && (mode.is_yield() || !law.conditions(at_rest, &previous).iter().any(misses)) {
            continue;
        }
        let needed = "one that the law holds at rest: give the law a `frictionless` of its own, or take \
                      `GravityStage::Frictional`, in which the law itself acts";
        let reason = Box::new(Error::Scene { quantity: "static state without friction", needed });
        return Err(Error::Law(LawError::Refused { element, mode: at_rest.word(), reason }));
    }
    Ok(())
}

/// Equilibrium under `load` from where `start` and `state` are, and where it leaves them: with laws
/// with state variables is found again until these no longer change.
fn settle(
    stage: &Standing<'_>,
    laws: &[Box<dyn InterfaceLaw>],
    mut start: PreviousContacts,
    mut state: StaticState,
    load: &[f64],
) -> Result<(StaticState, PreviousContacts)> {
    let mut state_variables = start.state_variables().to_vec();
    for pass in 1..=PASSES {
        let contact;
        (state, contact) = stage.equilibrium(laws, &start, state, load)?;
        let mut seen = contact.clone();
        if stage.frictionless {
            // To a law the base sticks where it is placed.
            state.modes.iter_mut().for_each(|mode| *mode = mode.sticking());
            for (e, own) in seen.iter_mut().enumerate() {
                let ContactState { slip, slip_across, .. } = *start.state(e);
                (own.slip, own.slip_across) = (slip, slip_across);
            }
        }
        start.update_state_variables(laws, &seen, &state.modes, &mut state_variables)?;
        let is_settled = state_variables == start.state_variables();
        if pass == PASSES && !is_settled {
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

/// Refuses state variables that change at rest by more than rounding.
fn check_settled(before: &[f64], now: &[f64]) -> Result<()> {
    let changes = before.iter().zip(now).map(|(before, now)| {
        let size = before.abs().max(now.abs());
        if size > 0.0 { (now - before).abs() / size } else { 0.0 }
    });
    let change = changes.fold(0.0, f64::max);
    if change <= UNSETTLED {
        return Ok(());
    }
    let change = format!("by {:.2} % in the last of {PASSES} passes", 100.0 * change);
    let reason = format!(
        "its state variables do not settle under weight and loads at t = 0: they change {change}"
    );
    Err(Error::part("interface law", reason))
}

// Motion at t = 0: displacement and velocity against the static state, and what the base does with them.

/// Gap relative to the largest displacement below which an element is closed.
const CLOSED: f64 = 1e-12;

/// Sets `state`, which is at rest, and the structure's internal variables in motion; `mass` is that of
/// the degrees of freedom.
pub(super) fn set_in_motion(
    given: &SimulationBuilder,
    mass: &SparseMatrix,
    scene: &Scene,
    structure: &mut dyn Structure,
    state: &mut State,
) -> Result<()> {
    let SimulationBuilder { displacement, velocity, .. } = given;
    if given.is_static() && displacement.is_empty() && velocity.is_empty() {
        return Ok(());
    }
    let motion = &mut state.motion;
    for (start, own) in [(displacement, &mut motion.displacement), (velocity, &mut motion.velocity)]
    {
        if !start.is_empty() {
            *own = scene.model.transformation.coordinates(start, mass);
        }
    }
    set_contact(given, scene, state)?;
    if let Some(force) = structure.nonlinear_mut() {
        force.commit(&scene.seen_at(&state.motion));
    }
    let c = &scene.coefficients;
    if [c.displacement, c.velocity, c.acceleration, c.new_velocity, c.new_acceleration]
        .iter()
        .any(|row| row[2] != 0.0)
    {
        state.motion.acceleration = acceleration(scene, structure, state)?;
    }
    state.motion.changed();
    state.update_resultants(scene);
    Ok(())
}

/// Gaps, slips and modes of the displaced base.
fn set_contact(given: &SimulationBuilder, scene: &Scene, state: &mut State) -> Result<()> {
    let layout = scene.layout();
    let [mut moved, mut rate] = [(); 2].map(|()| vec![0.0; layout.len()]);
    scene.base.means(&state.motion.displacement, &mut moved);
    scene.base.means(&state.motion.velocity, &mut rate);
    let closed = CLOSED * largest(&given.displacement);
    if given.is_static() {
        let needed = "zero where weight holds it on the ground (begin with \
                      `GravityStage::Unloaded`, or with a load that is released)";
        for value in moved {
            require("initial displacement of the base, m", value, value.abs() <= closed, needed)?;
        }
    } else {
        let mut starts = Vec::with_capacity(scene.count());
        for (e, (contact, mode)) in state.contact.iter_mut().zip(&mut state.modes).enumerate() {
            let [down, along] = layout.places(e);
            contact.gap = -moved[down];
            contact.slip = moved[along];
            if layout.is_plan() {
                contact.slip_across = moved[layout.place(PLANE, e)];
            }
            let quantity = "gap of an element under the initial displacement, m";
            require(quantity, contact.gap, contact.gap >= -closed, "zero or more")?;
            if contact.gap > closed {
                let opens = scene.law(e).modes().contains(&Mode::Open);
                let needed =
                    "must leave the base on the ground where the interface law does not open";
                require_part("initial displacement", opens, needed)?;
                *mode = Mode::Open;
            }
            starts.push(PreviousContact::new(*contact, *mode, scene.time_step));
        }
        state.start = PreviousContacts::new(&scene.laws, &starts)?;
    }
    let [_, along, across] = layout.split(&rate);
    for (e, own) in state.start.slip_rates_mut().enumerate() {
        *own = across.get(e).map_or(along[e], |across| along[e].hypot(*across));
    }
    Ok(())
}

/// a of M a + C v + K u + f(u) = p at t = 0, before the soil has responded.
fn acceleration(scene: &Scene, structure: &dyn Structure, state: &State) -> Result<Vec<f64>> {
    let (model, at_rest) = (&scene.model, &scene.static_state);
    let mut force = vec![0.0; model.coordinates];
    let mut scratch = vec![0.0; model.dofs];
    model.load(structure, 0.0, &at_rest.load, &mut scratch, &mut force)?;
    scene.add_loads(0.0, &mut force);
    let mut displacement = state.motion.displacement.clone();
    scene.subtract_base(&mut displacement, &mut vec![0.0; scene.layout().len()]);
    model.stiffness.multiply_add(-1.0, &displacement, &mut force);
    model.damping.multiply_add(-1.0, &state.motion.velocity, &mut force);
    if !model.linear {
        let (nonlinear, _) = nonlinear_state(structure, &scene.seen_at(&state.motion))?;
        for (force, (now, at_rest)) in force.iter_mut().zip(nonlinear.iter().zip(&at_rest.force)) {
            *force -= now - at_rest;
        }
    }
    if let (Matrix::Sparse(mass), Matrix::Sparse(stiffness)) = (&model.mass, &model.stiffness) {
        accelerate(mass, stiffness, &mut force)?;
    }
    Ok(force)
}

/// Force on a degree of freedom without mass, relative to the largest force, that counts as none.
const BALANCED: f64 = 1e-9;

/// Square of a time, s², that is short to every structure.
const SMALL: f64 = 1e-20;

/// Replaces `force` by the acceleration that it gives a structure at rest. Degrees of freedom without mass
/// follow the others by their stiffness, so small that it resists nothing; with Lagrange multipliers it
/// is the constraint of the accelerations.
fn accelerate(mass: &SparseMatrix, stiffness: &SparseMatrix, force: &mut [f64]) -> Result<()> {
    let largest = largest(force);
    if largest == 0.0 {
        return Ok(());
    }
    let massless = massless(mass);
    for (force, _) in force.iter_mut().zip(&massless).filter(|(_, massless)| **massless) {
        let needed = "zero where there is no mass, for the acceleration at t = 0, which \
                      `Midpoint` does not take";
        require_part("force at t = 0", force.abs() <= BALANCED * largest, needed)?;
        *force = 0.0;
    }
    let mut matrix = Triplets::new(mass.order());
    for (own, factor, follows) in [(mass, 1.0, false), (stiffness, SMALL, true)] {
        for (row, column, value) in own.entries() {
            if (massless[row] || massless[column]) == follows {
                matrix.add(row, column, factor * value);
            }
        }
    }
    SparseFactor::new("mass matrix, for the acceleration at t = 0", &matrix)?.solve(force);
    Ok(())
}
