//! GOAL: the static state under a load is the end of a slow ramp of the load in time, for all laws.
//! SCENE: structures on strongly damped springs.
//! REFERENCE: the displacements at the end of the ramp.

use std::f64::consts::PI;

use basemat::bem::SpringGround;
use basemat::coupled::{GravityStage, Load, SimulationBuilder};
use basemat::{Result, Simulation};
use basemat_problems::dense::largest;
use basemat_problems::scenes::SCENE_GRAVITY;

use super::compare::largest_difference;
use super::grounds::{self, MAT_CELLS, STRIP_ELEMENTS};
use super::numbers::Numbers;
use super::parts::{Choice, CoordinatePart, LawPart, MotionPart, Space, covering};
use super::structures::{self, ProbedStructure};
use super::tally::{IdentityTally, scenes};
use super::view::PLAIN_VIEW;

/// Time step, s.
const TIME_STEP: f64 = 0.05;
/// Steps of the ramp.
const RAMP_STEPS: usize = 400;
/// Steps of constant load after the ramp.
const REST_STEPS: usize = 100;
/// Limit of remaining oscillations, and of slips by loads in increments.
const DISPLACEMENT_LIMIT: f64 = 0.01;

/// Springs with damping by which the ramp is slow; the bed has no history, since soil radiates for long.
fn damped_bed(
    choice: &Choice,
    numbers: &Numbers,
    probed_structure: &ProbedStructure,
) -> Result<SpringGround> {
    let count = if choice.space == Space::Plan { MAT_CELLS } else { STRIP_ELEMENTS };
    let stiffness = 2.0 * numbers.modulus / numbers.sides[0];
    let bed = SpringGround::under(
        probed_structure.structure.as_ref(),
        count,
        stiffness,
        0.7 * stiffness,
    )?;
    let dashpot = 0.02 * stiffness;
    bed.with_dashpots(dashpot, dashpot)
}

/// The scene under a load on the top, along x and in plan along y.
fn builder(
    choice: &Choice,
    numbers: &Numbers,
    value: impl Fn(f64) -> f64 + Clone + Send + 'static,
) -> Result<SimulationBuilder> {
    let probed_structure = structures::structure(choice, numbers, &PLAIN_VIEW)?;
    let ground = damped_bed(choice, numbers, &probed_structure)?;
    let ProbedStructure { structure, top } = probed_structure;
    let in_plan = choice.space == Space::Plan;
    // Half of the force that slides or overturns the structure.
    let weight = SCENE_GRAVITY * numbers.mass(in_plan);
    let overturning = 0.5 * numbers.sides[usize::from(in_plan)] / numbers.height;
    let force = 0.25 * weight * overturning.min(numbers.friction);
    let stage = if choice.seed.is_multiple_of(2) {
        GravityStage::Frictionless
    } else {
        GravityStage::Frictional
    };
    let mut builder = Simulation::builder(TIME_STEP)
        .structure(structure)
        .ground(ground)
        .interface(grounds::law(choice.law, numbers, &PLAIN_VIEW)?)
        .gravity(SCENE_GRAVITY)
        .gravity_stage(stage);
    for (row, ratio) in top.into_iter().zip([1.0, 0.6]) {
        if !row.is_empty() {
            let value = value.clone();
            builder = builder.load(Load::new(row, move |time| ratio * force * value(time)));
        }
    }
    Ok(builder)
}

/// Value of the ramp at a time, s.
fn ramp(time: f64) -> f64 {
    let end = TIME_STEP * RAMP_STEPS as f64;
    0.5 * (1.0 - (PI * (time / end).min(1.0)).cos())
}

/// Displacements of the static state, from those without the load, and of the end of the ramp.
fn static_and_ramp_displacements(choice: &Choice, numbers: &Numbers) -> Result<[Vec<f64>; 2]> {
    let unloaded_displacement =
        builder(choice, numbers, |_| 0.0)?.build()?.static_displacement().to_vec();
    let loaded_displacement =
        builder(choice, numbers, |_| 1.0)?.build()?.static_displacement().to_vec();
    let mut simulation = builder(choice, numbers, ramp)?.build()?;
    for _ in 0..RAMP_STEPS + REST_STEPS {
        simulation.step()?;
    }
    let at_end = simulation.state().displacement().to_vec();
    let by_load =
        loaded_displacement.iter().zip(&unloaded_displacement).map(|(a, b)| a - b).collect();
    Ok([by_load, at_end])
}

fn check(space: Space, row: &'static str, count: usize) {
    let mut tally = IdentityTally::new(row);
    for choice in covering(space, 111, count) {
        // Friction that decreases with speed has another slow limit than the static one. The motion of the choice has
        // no effect.
        let coordinate = CoordinatePart::Physical;
        let choice = Choice { motion: MotionPart::Loads, coordinate, ..choice };
        if choice.law == LawPart::Varying || choice.body.is_nonlinear() {
            continue;
        }
        let numbers = Numbers::draw(choice.seed);
        tally.scene(&["springs", choice.body.word(), choice.law.word(), choice.motion.word()]);
        match static_and_ramp_displacements(&choice, &numbers) {
            Ok([static_state, at_end]) => {
                let difference = largest_difference(&static_state, &at_end);
                let relative_difference = difference / largest(&static_state);
                tally.within(&choice.name(), relative_difference, DISPLACEMENT_LIMIT);
            }
            Err(error) => tally.add_error(format!("{}: {error}", choice.name())),
        }
    }
    tally.close(0.75);
}

/// GOAL: static states in the plane.
#[test]
fn static_states_in_the_plane_are_slow_ramps() {
    check(Space::Plane, "slow loads in the plane", scenes(30, 300));
}

/// GOAL: static states in plan.
#[test]
fn static_states_in_plan_are_slow_ramps() {
    check(Space::Plan, "slow loads in plan", scenes(12, 150));
}
