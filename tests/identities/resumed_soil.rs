//! GOAL: a run of soil that yields is the same to the last bit if it is interrupted and resumed in a new simulation.
//! SCENE: random scenes of all laws, grounds, motions and schemes with clay, sand, or clay in a group.
//! REFERENCE: the states of the uninterrupted run.

use basemat::Result;
use basemat::coupled::State;
use basemat_problems::random::Random;

use super::numbers::RUN_STEPS;
use super::parts::{BodyPart, Choice, CoordinatePart, Space, covering};
use super::scene::{SceneVariant, builder};
use super::tally::{IdentityTally, scenes};
use super::view::PLAIN_VIEW;

/// States after a step of a run without a break, and of a run resumed there in a new simulation.
fn both_runs(choice: &Choice, first_steps: usize) -> Result<[Vec<State>; 2]> {
    let mut uninterrupted_simulation =
        builder(choice, &PLAIN_VIEW, SceneVariant::Usual)?.build()?;
    for _ in 0..first_steps {
        uninterrupted_simulation.step()?;
    }
    let checkpoint = uninterrupted_simulation.checkpoint()?;
    let mut resumed_simulation = builder(choice, &PLAIN_VIEW, SceneVariant::Usual)?.build()?;
    // A used simulation has other variables, which the checkpoint replaces.
    for _ in 0..first_steps % 3 {
        resumed_simulation.step()?;
    }
    resumed_simulation.resume(&checkpoint)?;
    let mut states = [Vec::new(), Vec::new()];
    for _ in first_steps..RUN_STEPS {
        states[0].push(uninterrupted_simulation.step()?.clone());
        states[1].push(resumed_simulation.step()?.clone());
    }
    Ok(states)
}

/// GOAL: all numbers of all states are equal.
#[test]
fn runs_of_soil_that_yields_resume_to_the_last_bit() {
    let mut tally = IdentityTally::new("yielding soil: run, and resumed");
    let mut random = Random(191);
    let bodies = [BodyPart::Clay, BodyPart::Sand, BodyPart::ClayPair];
    for (number, choice) in covering(Space::Plane, 192, scenes(15, 200)).into_iter().enumerate() {
        let body = bodies[number % bodies.len()];
        let choice = Choice { body, coordinate: CoordinatePart::Physical, ..choice };
        super::grounds::clear_shared_kernels();
        tally.scene(&choice.words());
        let first_steps = random.pick(&[0, 1, 7, 20, 33]);
        let place = format!("after {first_steps} steps: {}", choice.name());
        match both_runs(&choice, first_steps) {
            Ok([whole, resumed]) => {
                let first_difference = whole.iter().zip(&resumed).position(|(a, b)| a != b);
                if let Some(step) = first_difference {
                    tally.fail(format!("{place}: differs {step} steps after the break"));
                }
            }
            Err(error) => tally.add_error(format!("{place}: {error}")),
        }
    }
    tally.close(0.75);
}
