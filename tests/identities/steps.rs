//! GOAL: time steps halved twice converge with their order; steps ten times as long give a warning.
//! SCENE: bonded scenes of all parts.
//! REFERENCE: ratios of differences.

use basemat::Result;
use basemat_problems::dense::largest;

use super::compare::largest_difference;
use super::numbers::Numbers;
use super::parts::{Choice, CoordinatePart, LawPart, MotionPart, SchemePart, Space, covering};
use super::scene::{SceneVariant, builder};
use super::tally::{IdentityTally, scenes};
use super::view::PLAIN_VIEW;

/// Displacements of the top at the ends of steps that all runs share, with steps divided by `parts`.
fn top_displacements(choice: &Choice, parts: usize) -> Result<Vec<f64>> {
    let mut simulation = builder(choice, &PLAIN_VIEW, SceneVariant::Divided(parts))?.build()?;
    let mut displacements = Vec::new();
    for _ in 0..super::numbers::RUN_STEPS {
        for _ in 0..parts {
            simulation.step()?;
        }
        displacements.extend(simulation.state().probes.iter().copied());
    }
    Ok(displacements)
}

/// Smallest ratio of two differences: 4 at second order and 2 at first, less where the first step is too long.
fn smallest_ratio(scheme: SchemePart) -> f64 {
    match scheme {
        SchemePart::Midpoint | SchemePart::Dissipative => 2.5,
        // Newmark and HHT are of first order with the soil.
        SchemePart::Theta | SchemePart::Newmark | SchemePart::Hht => 1.6,
    }
}

fn check_order(space: Space, row: &'static str, count: usize) {
    if count == 0 {
        return;
    }
    let mut tally = IdentityTally::new(row);
    for choice in covering(space, 121, count) {
        // Slip and landing are not smooth in time.
        let coordinate = CoordinatePart::Physical;
        let choice = Choice { law: LawPart::Bonded, coordinate, ..choice };
        if choice.body.is_nonlinear() {
            continue;
        }
        super::grounds::clear_shared_kernels();
        tally.scene(&choice.words());
        // Preparation around a trench takes longer with more steps.
        let first = if space == Space::Trench { 1 } else { 2 };
        let runs: Result<Vec<Vec<f64>>> = [first, 2 * first, 4 * first]
            .into_iter()
            .map(|parts| top_displacements(&choice, parts))
            .collect();
        match runs {
            Ok(runs) => {
                let coarse = largest_difference(&runs[0], &runs[1]);
                let fine = largest_difference(&runs[1], &runs[2]);
                // Static states and reductions are not exact beyond this.
                if fine > 1e-8 * largest(&runs[2]) {
                    let limit = 1.0 / smallest_ratio(choice.scheme);
                    tally.within(&choice.name(), fine / coarse, limit);
                }
            }
            Err(error) => tally.add_error(format!("{}: {error}", choice.name())),
        }
    }
    tally.close(0.75);
}

/// GOAL: differences of scenes in the plane decrease with the order of the scheme.
#[test]
fn steps_in_the_plane_converge() {
    check_order(Space::Plane, "order of steps in the plane", scenes(20, 300));
}

/// GOAL: differences of scenes in plan decrease with the order of the scheme.
#[test]
fn steps_in_plan_converge() {
    check_order(Space::Plan, "order of steps in plan", scenes(4, 60));
}

/// GOAL: differences of scenes around a trench decrease with the order; at night only, as preparation takes seconds.
#[test]
fn steps_around_a_trench_converge() {
    check_order(Space::Trench, "order of steps around a trench", scenes(0, 12));
}

/// Number of warnings of a run over the whole motion.
fn warning_count(choice: &Choice, factor: usize) -> Result<usize> {
    let mut simulation = builder(choice, &PLAIN_VIEW, SceneVariant::Longer(factor))?.build()?;
    let steps = simulation.steps_for(Numbers::draw(choice.seed).duration()).max(1);
    Ok(simulation.run(steps, |_| {})?.warnings.len())
}

/// GOAL: steps ten times as long, about one in a wave of the motion, give a warning.
#[test]
fn long_steps_are_warned_of() {
    let mut tally = IdentityTally::new("steps ten times as long are warned of");
    for space in [Space::Plane, Space::Plan] {
        for choice in covering(space, 122, scenes(if space == Space::Plan { 6 } else { 24 }, 200)) {
            let has_record = !matches!(choice.motion, MotionPart::Function | MotionPart::Loads);
            if !has_record {
                continue;
            }
            tally.scene(&choice.words());
            let counts: Result<Vec<usize>> =
                [1, 10, 100].into_iter().map(|factor| warning_count(&choice, factor)).collect();
            match counts {
                Ok(counts) => {
                    if counts[1] == 0 || counts[2] == 0 {
                        let text = format!("{counts:?} warnings for steps × 1, 10, 100");
                        tally.fail(format!("{text}: {}", choice.name()));
                    }
                }
                Err(error) => tally.add_error(format!("{}: {error}", choice.name())),
            }
        }
    }
    tally.close(0.5);
}
