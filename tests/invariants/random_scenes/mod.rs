//! GOAL: balances, contact conditions and symmetries hold in every run.
//! SCENE: random structures, grounds, interface laws, time schemes, histories, coordinates and
//! ground motions; a failing scene is shrunk to a small one and printed.
//! REFERENCE: balances and contact conditions in every step; repeated, mirrored, rescaled and
//! delayed runs.
//!
//! `PROPTEST_CASES=2000 cargo test --release --test heavy invariants::random_scenes` runs more scenes, different ones
//! each time.

mod recipe;
mod run_checks;
mod shaking;
mod strategies;
mod tally;

use basemat::Simulation;
use basemat::coupled::{Mistake, State, Warning};
use basemat::motion::Record;
use proptest::prelude::*;
use recipe::{SceneRecipe, SchemeRecipe};
use run_checks::RunScales;
use strategies::recipes;
use tally::{PropertyTally, accepted, for_all};

use basemat_problems::scenes::{self, SI_UNITS, UnitFrame};

/// Friction up to which a solution does not depend on the start of the search: see
/// `docs/validation.md`.
const MAX_UNIQUE_FRICTION: f64 = 0.6;

#[test]
fn every_run_is_finite_balanced_and_admissible() {
    let strategy = (recipes(10.0), 0..5_u8)
        .prop_map(|(recipe, choice)| SceneRecipe { weightless: choice == 0, ..recipe });
    let tally = for_all("runs", 40, &strategy, |recipe, tally| {
        let Some(states) = accepted(recipe, recipe.run(SI_UNITS, 0), tally)? else {
            return Ok(());
        };
        let unreduced_simulation = recipe.unreduced().build(SI_UNITS, 0).unwrap();
        let condition = unreduced_simulation.conditioning().effective_stiffness;
        tally.add_run(&states);
        run_checks::numbers_are_finite(&states)?;
        run_checks::energy_is_conserved(recipe, &states, condition, tally)?;
        run_checks::contact_conditions_hold(recipe, &states, tally)?;
        if recipe.weightless {
            return Ok(());
        }
        preload_is_in_equilibrium(recipe, &states[0], tally)
    });
    // Scenes without changes of contact would test nothing.
    let scenes = tally.counted("scenes");
    assert!(tally.counted("build errors") < scenes / 4, "{tally}");
    assert!(tally.counted("changes of mode") > 5 * scenes, "{tally}");
}

/// Random scenes of usual weight give no warning of numbers in another unit, nor of the end of a run, under usual
/// shaking (at most 2 g) by a function, and under records that are run to their end.
#[test]
fn usual_scenes_give_no_warning_of_units() {
    let usual_recipes = recipes(1.0).prop_filter("usual weight, friction and scheme", is_usual);
    let record = (0.5..15.0, prop::sample::select(vec![0.0025, 0.005, 0.01, 0.02]), 1.0..8.0);
    let tally =
        for_all("units", 40, &(usual_recipes, record), |(recipe, (peak, step, waves)), tally| {
            if recipe.peak_acceleration() < 2.0 * scenes::SCENE_GRAVITY
                && let Ok(simulation) = recipe.build(SI_UNITS, 0)
            {
                assert_no_unit_warnings(simulation, 200, false, "functions", tally)?;
            }
            let record = fading_record(*peak, *step, *waves);
            let duration = record.duration();
            let Ok(simulation) = recipe.build_with(SI_UNITS, record) else { return Ok(()) };
            let steps = simulation.steps_for(duration);
            assert_no_unit_warnings(simulation, steps, true, "records", tally)
        });
    assert!(tally.counted("functions") > 10 && tally.counted("records") > 20, "{tally}");
}

/// Whether a scene has usual weight and friction, and a response without numerical growth.
///
/// Without friction a base continues to slide after a record, and Newmark's and the α scheme create energy on soil.
fn is_usual(recipe: &SceneRecipe) -> bool {
    let is_heavy = recipe.weight() > 2e3 * recipe::BASE_WIDTH && !recipe.weightless;
    let can_grow = matches!(recipe.scheme, SchemeRecipe::Newmark(_) | SchemeRecipe::Hht(_));
    is_heavy && recipe.friction() > 0.1 && !can_grow
}

/// Runs a scene and checks that it gives no warning of units, nor of the end of a motion that is run to its end.
fn assert_no_unit_warnings(
    mut simulation: Simulation,
    steps: usize,
    has_end: bool,
    kind: &'static str,
    tally: &mut PropertyTally,
) -> Result<(), TestCaseError> {
    // A step is far below the period of a record where elements are small and soil is stiff.
    const MAX_STEPS: usize = 4000;
    let Ok(run) = simulation.run(steps.min(MAX_STEPS), |_| {}) else {
        return Ok(());
    };
    tally.count(kind, 1);
    let is_whole = has_end && steps <= MAX_STEPS;
    for warning in &run.warnings {
        let is_of_end = matches!(warning, Warning::EndsEarly { .. } | Warning::PeakAtEnd { .. });
        prop_assert!(!is_of_units(warning) || is_of_end && !is_whole, "{warning}");
    }
    Ok(())
}

/// A record with this peak (m/s²) and time step (s), and `waves` waves that grow and fade in 200 samples.
///
/// The response decays in 400 more.
fn fading_record(peak: f64, time_step: f64, waves: f64) -> Record {
    let samples = (0..=600)
        .map(|k: usize| std::f64::consts::PI * k.min(200) as f64 / 200.0)
        .map(|phase| phase.sin().powi(2) * (2.0 * waves * phase).sin())
        .collect();
    Record::new(time_step, samples).unwrap().scaled_to_peak(peak).unwrap()
}

fn is_of_units(warning: &Warning) -> bool {
    matches!(
        warning,
        Warning::Mistake(
            Mistake::UnusualMotion { .. }
                | Mistake::UnusualInterval { .. }
                | Mistake::LightStructure { .. }
                | Mistake::UnusualFriction { .. }
                | Mistake::UnusualGravity { .. }
        ) | Warning::EndsEarly { .. }
            | Warning::PeakAtEnd { .. }
    )
}

/// Checks that forces and moments of the static state balance the weight.
fn preload_is_in_equilibrium(
    recipe: &SceneRecipe,
    state: &State,
    tally: &mut PropertyTally,
) -> Result<(), TestCaseError> {
    let weight = recipe.weight();
    let limit = recipe.static_rounding().max(1e-10);
    tally.within("preload: vertical force", (state.normal_force / weight - 1.0).abs(), limit)?;
    tally.within("preload: horizontal force", state.base_shear.abs() / weight, limit)?;
    tally.within("preload: moment", state.base_moment.abs() / (weight * recipe::BASE_WIDTH), limit)
}

/// The search for the static state ends by forces relative to the root of masses.
///
/// With limits of forces and moments themselves it would not end where the unit of length is short.
#[test]
fn static_state_is_found_in_any_unit_of_length() {
    for power in -6..=6 {
        let frame = UnitFrame { length: 10.0_f64.powi(power), ..SI_UNITS };
        let builder = scenes::scene(frame, 0.0).structure(scenes::block(frame));
        let simulation = builder
            .interface(scenes::friction(0.05))
            .gravity_stage(basemat::coupled::GravityStage::Frictional)
            .build();
        let state = simulation.unwrap().state().clone();
        let weight = 4.0 * 6.0 * 1500.0 * scenes::SCENE_GRAVITY;
        let relative_force = state.normal_force / (weight * frame.pressure() * frame.length);
        assert!((relative_force - 1.0).abs() < 1e-10, "10^{power}: {relative_force}");
    }
}

#[test]
fn repeated_runs_have_the_same_bits() {
    for_all("repetition", 12, &recipes(10.0), |recipe, tally| {
        let Some(first) = accepted(recipe, recipe.run(SI_UNITS, 0), tally)? else {
            return Ok(());
        };
        tally.add_run(&first);
        let second = recipe.run(SI_UNITS, 0).unwrap();
        prop_assert!(first == second);
        Ok(())
    });
}

/// Relation of a run to another one, in other units or as a mirror image.
#[derive(Debug, Clone, Copy)]
struct RunRelation {
    /// Factors from the other run's pressure, shear, slip and rotation to the first run's.
    factors: [f64; 4],
    mirrored: bool,
}

const IDENTICAL_RUNS: RunRelation = RunRelation { factors: [1.0; 4], mirrored: false };

/// Largest differences of pressures, shear tractions, slips and rotations of two runs.
///
/// They are relative to the largest traction and length of the first run.
fn max_differences(first: &[State], second: &[State], relation: RunRelation) -> [f64; 4] {
    let RunScales { traction, length, .. } = RunScales::largest(first);
    let scales = [traction, traction, length, length / recipe::BASE_WIDTH];
    let count = first[0].contact.len();
    let mut differences = [0.0_f64; 4];
    for (a, b) in first.iter().zip(second) {
        for e in 0..count {
            let second_element = if relation.mirrored { count - 1 - e } else { e };
            let a_contact = &a.contact[e];
            let b_contact = &b.contact[second_element];
            let pairs = [
                (a_contact.pressure, b_contact.pressure),
                (a_contact.shear, b_contact.shear),
                (a_contact.slip, b_contact.slip),
                (a.base_rotation, b.base_rotation),
            ];
            for (k, (x, y)) in pairs.into_iter().enumerate() {
                let difference = (x - relation.factors[k] * y).abs() / scales[k];
                differences[k] = differences[k].max(difference);
            }
        }
    }
    differences
}

/// Checks that two runs differ by 1e-9 at most, unless landings amplify the differences.
///
/// The static state is computed to 1e-10. Runs whose shaking and soil differ by 1e-10 show the amplification.
fn assert_related(
    recipe: &SceneRecipe,
    first: &[State],
    second: &[State],
    relation: RunRelation,
    tally: &mut PropertyTally,
) -> Result<(), TestCaseError> {
    // Where an open layer with shear lands, there may be several solutions or none.
    if recipe.has_shear_while_open() {
        return Ok(());
    }
    let perturbation = 1.0 + 1e-10;
    let stronger_recipe =
        SceneRecipe { strength: recipe.strength * perturbation, ..recipe.clone() };
    let stiffer_recipe = SceneRecipe { modulus: recipe.modulus * perturbation, ..recipe.clone() };
    let mut sensitivity = [0.0_f64; 4];
    for perturbed_recipe in [stronger_recipe, stiffer_recipe] {
        let Some(perturbed_recipe) = accepted(recipe, perturbed_recipe.run(SI_UNITS, 0), tally)?
        else {
            return Ok(());
        };
        let differences = max_differences(first, &perturbed_recipe, IDENTICAL_RUNS);
        for k in 0..4 {
            sensitivity[k] = sensitivity[k].max(differences[k]);
        }
    }
    let differences = max_differences(first, second, relation);
    let names = ["difference of pressures", "of shear tractions", "of slips", "of base rotations"];
    for k in 0..4 {
        tally.within(names[k], differences[k], 1e-9 + 10.0 * sensitivity[k])?;
    }
    Ok(())
}

#[test]
fn mirrored_scenes_respond_as_mirror_images() {
    let mirror = UnitFrame { mirrored: true, ..SI_UNITS };
    let relation = RunRelation { factors: [1.0, -1.0, -1.0, -1.0], mirrored: true };
    for_all("mirror", 12, &recipes(MAX_UNIQUE_FRICTION), |recipe, tally| {
        let Some(plain) = accepted(recipe, recipe.run(SI_UNITS, 0), tally)? else {
            return Ok(());
        };
        tally.add_run(&plain);
        let Some(mirrored) = accepted(recipe, recipe.run(mirror, 0), tally)? else {
            return Ok(());
        };
        assert_related(recipe, &plain, &mirrored, relation, tally)
    });
}

#[test]
fn units_have_no_effect_over_twelve_orders_of_magnitude() {
    let powers = (-6.0..6.0, -6.0..6.0, -6.0..6.0);
    let strategy = (recipes(MAX_UNIQUE_FRICTION), powers);
    for_all("units", 12, &strategy, |(recipe, (length, time, mass)), tally| {
        let frame = UnitFrame {
            length: 10.0_f64.powf(*length),
            time: 10.0_f64.powf(*time),
            mass: 10.0_f64.powf(*mass),
            mirrored: false,
        };
        let Some(plain) = accepted(recipe, recipe.run(SI_UNITS, 0), tally)? else {
            return Ok(());
        };
        tally.add_run(&plain);
        let Some(in_frame) = accepted(recipe, recipe.run(frame, 0), tally)? else {
            return Err(TestCaseError::fail("an error in other units"));
        };
        let traction = 1.0 / frame.pressure();
        let factors = [traction, traction, 1.0 / frame.length, 1.0];
        let relation = RunRelation { factors, mirrored: false };
        assert_related(recipe, &plain, &in_frame, relation, tally)
    });
}

#[test]
fn delayed_shaking_gives_the_same_response_later() {
    let strategy = (recipes(MAX_UNIQUE_FRICTION), 1_usize..40);
    for_all("shift", 12, &strategy, |(recipe, delay), tally| {
        let Some(plain) = accepted(recipe, recipe.run(SI_UNITS, 0), tally)? else {
            return Ok(());
        };
        tally.add_run(&plain);
        let Some(delayed) = accepted(recipe, recipe.run(SI_UNITS, *delay), tally)? else {
            return Ok(());
        };
        assert_related(recipe, &plain, &delayed[*delay..], IDENTICAL_RUNS, tally)
    });
}
