//! The static state of a load is the end of a slow ramp of the same load in time, for all laws.

use std::f64::consts::PI;

use basemat::bem::SpringGround;
use basemat::coupled::{GravityStage, Load, SimulationBuilder};
use basemat::structure::DofCombination;
use basemat::{Result, Simulation};
use basemat_problems::scenes::GRAVITY;

use super::grounds::{self, CELLS, ELEMENTS};
use super::numbers::Numbers;
use super::parts::{Choice, Coordinate, Law, Motion, Space, covering};
use super::structures::{self, Made};
use super::tally::{Tally, scenes};
use super::view::PLAIN;

/// Steps of the ramp and of the rest after it.
const RAMP: usize = 400;
const REST: usize = 100;
/// Remaining swings, and slips by loads in increments.
const LIMIT: f64 = 0.01;

/// Springs with so much damping that the ramp is slow: a bed without history, since soil radiates for long.
fn bed(choice: &Choice, numbers: &Numbers, made: &Made) -> Result<SpringGround> {
    let count = if choice.space == Space::Plan { CELLS } else { ELEMENTS };
    let stiffness = 2.0 * numbers.modulus / numbers.sides[0];
    let bed = SpringGround::under(made.structure.as_ref(), count, stiffness, 0.7 * stiffness)?;
    let dashpot = 0.02 * stiffness;
    bed.with_dashpots(dashpot, dashpot)
}

/// The scene under a load on the top, along x and in plan along y.
fn builder(
    choice: &Choice,
    numbers: &Numbers,
    value: impl Fn(f64) -> f64 + Clone + Send + 'static,
) -> Result<SimulationBuilder> {
    let made = structures::structure(choice, numbers, &PLAIN)?;
    let ground = bed(choice, numbers, &made)?;
    let Made { structure, top } = made;
    let in_plan = choice.space == Space::Plan;
    // Half of what slides or overturns the structure.
    let weight = GRAVITY * numbers.mass(in_plan);
    let overturning = 0.5 * numbers.sides[usize::from(in_plan)] / numbers.height;
    let force = 0.25 * weight * overturning.min(numbers.friction);
    let stage = if choice.seed.is_multiple_of(2) {
        GravityStage::Frictionless
    } else {
        GravityStage::Frictional
    };
    let mut builder = Simulation::builder(0.05)
        .structure(structure)
        .ground(ground)
        .interface(grounds::law(choice.law, numbers, &PLAIN)?)
        .gravity(GRAVITY)
        .gravity_stage(stage);
    let [along, across, _]: [DofCombination; 3] = top;
    for (row, part) in [(along, 1.0), (across, 0.6)] {
        if !row.is_empty() {
            let value = value.clone();
            builder = builder.load(Load::new(row, move |time| part * force * value(time)));
        }
    }
    Ok(builder)
}

/// Displacements of the static state and of the end of the ramp.
fn both(choice: &Choice, numbers: &Numbers) -> Result<[Vec<f64>; 2]> {
    let at_rest = builder(choice, numbers, |_| 0.0)?.build()?.static_displacement().to_vec();
    let at_once = builder(choice, numbers, |_| 1.0)?.build()?.static_displacement().to_vec();
    let end = 0.05 * RAMP as f64;
    let ramp = move |time: f64| 0.5 * (1.0 - (PI * (time / end).min(1.0)).cos());
    let mut simulation = builder(choice, numbers, ramp)?.build()?;
    for _ in 0..RAMP + REST {
        simulation.step()?;
    }
    let slowly = simulation.state().displacement().to_vec();
    let moved = at_once.iter().zip(&at_rest).map(|(a, b)| a - b).collect();
    Ok([moved, slowly])
}

fn check(space: Space, row: &'static str, count: usize) {
    let mut tally = Tally::new(row);
    for choice in covering(space, 111, count) {
        // Friction that falls with speed has no slow limit of its own beside the static one; motions do not matter.
        let coordinate = Coordinate::Physical;
        let choice = Choice { motion: Motion::Loads, coordinate, ..choice };
        if choice.law == Law::Varying || choice.body.is_nonlinear() {
            continue;
        }
        let numbers = Numbers::draw(choice.seed);
        tally.scene(&["springs", choice.body.word(), choice.law.word(), choice.motion.word()]);
        match both(&choice, &numbers) {
            Ok([static_state, ramp]) => {
                let scale = static_state.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
                let pairs = static_state.iter().zip(&ramp);
                let apart = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
                tally.within(&choice.name(), apart / scale, LIMIT);
            }
            Err(error) => tally.refuse(format!("{}: {error}", choice.name())),
        }
    }
    tally.close(0.75);
}

#[test]
fn static_states_in_the_plane_are_slow_ramps() {
    check(Space::Plane, "slow loads in the plane", scenes(30, 300));
}

#[test]
fn static_states_in_plan_are_slow_ramps() {
    check(Space::Plan, "slow loads in plan", scenes(12, 150));
}
