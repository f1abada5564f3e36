//! Steps halved twice converge with their order; steps ten times as long are warned of.

use basemat::Result;

use super::numbers::Numbers;
use super::parts::{Choice, Coordinate, Law, Motion, Scheme, Space, covering};
use super::scene::{Writing, builder};
use super::tally::{Tally, scenes};
use super::view::PLAIN;

/// Displacements of the top at the ends of steps that all runs share, with steps divided by `parts`.
fn tops(choice: &Choice, parts: usize) -> Result<Vec<f64>> {
    let mut simulation = builder(choice, &PLAIN, Writing::Divided(parts))?.build()?;
    let mut found = Vec::new();
    for _ in 0..super::numbers::STEPS {
        for _ in 0..parts {
            simulation.step()?;
        }
        found.extend(simulation.state().probes.iter().copied());
    }
    Ok(found)
}

fn distance(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()))
}

/// Smallest ratio of two differences: 4 at second order and 2 at first, less where the first step is too long.
fn ratio(scheme: Scheme) -> f64 {
    match scheme {
        Scheme::Midpoint | Scheme::Dissipative => 2.5,
        // Newmark and HHT are of first order with the soil.
        Scheme::Theta | Scheme::Newmark | Scheme::Hht => 1.6,
    }
}

fn check_order(space: Space, row: &'static str, count: usize) {
    if count == 0 {
        return;
    }
    let mut tally = Tally::new(row);
    for choice in covering(space, 121, count) {
        // Slips and landings are not smooth.
        let coordinate = Coordinate::Physical;
        let choice = Choice { law: Law::Bonded, coordinate, ..choice };
        if choice.body.is_nonlinear() {
            continue;
        }
        super::grounds::next_scene();
        tally.scene(&choice.words());
        // Set-up around a trench grows with the steps.
        let first = if space == Space::Trench { 1 } else { 2 };
        let runs = || -> Result<[Vec<f64>; 3]> {
            Ok([tops(&choice, first)?, tops(&choice, 2 * first)?, tops(&choice, 4 * first)?])
        };
        match runs() {
            Ok([first, second, third]) => {
                let [coarse, fine] = [distance(&first, &second), distance(&second, &third)];
                let scale = third.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
                // Static states and reductions are not exact beyond this.
                if fine > 1e-8 * scale {
                    let limit = 1.0 / ratio(choice.scheme);
                    tally.within(&choice.name(), fine / coarse, limit);
                }
            }
            Err(error) => tally.refuse(format!("{}: {error}", choice.name())),
        }
    }
    tally.close(0.75);
}

#[test]
fn steps_in_the_plane_converge() {
    check_order(Space::Plane, "order of steps in the plane", scenes(20, 300));
}

#[test]
fn steps_in_plan_converge() {
    check_order(Space::Plan, "order of steps in plan", scenes(4, 60));
}

/// At night only: set-up around a trench takes seconds.
#[test]
fn steps_around_a_trench_converge() {
    check_order(Space::Trench, "order of steps around a trench", scenes(0, 12));
}

/// Number of warnings of a run over the whole motion.
fn warnings(choice: &Choice, factor: usize) -> Result<usize> {
    let mut simulation = builder(choice, &PLAIN, Writing::Longer(factor))?.build()?;
    let steps = simulation.steps_for(Numbers::draw(choice.seed).duration()).max(1);
    Ok(simulation.run(steps, |_| {})?.warnings.len())
}

/// The motion has some ten steps a wave: ten times that is one step a wave.
#[test]
fn long_steps_are_warned_of() {
    let mut tally = Tally::new("steps ten times as long are warned of");
    for space in [Space::Plane, Space::Plan] {
        for choice in covering(space, 122, scenes(if space == Space::Plan { 6 } else { 24 }, 200)) {
            let has_record = !matches!(choice.motion, Motion::Function | Motion::Loads);
            if !has_record {
                continue;
            }
            tally.scene(&choice.words());
            let counts = || -> Result<[usize; 3]> {
                Ok([warnings(&choice, 1)?, warnings(&choice, 10)?, warnings(&choice, 100)?])
            };
            match counts() {
                Ok([usual, longer, longest]) => {
                    if longer == 0 || longest == 0 {
                        let counts = format!("{usual}, {longer} and {longest} warnings");
                        tally.fail(format!("{counts} for steps × 1, 10, 100: {}", choice.name()));
                    }
                }
                Err(error) => tally.refuse(format!("{}: {error}", choice.name())),
            }
        }
    }
    tally.close(0.5);
}
