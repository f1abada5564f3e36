//! GOAL: what the crate promises of every run.
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
mod tally;

use basemat::coupled::{Mistake, State, Warning};
use basemat::motion::Record;
use basemat::{Error, Simulation};
use proptest::prelude::*;
use recipe::{Recipe, Scheme, recipes};
use run_checks::Scales;
use tally::{Tally, accepted, for_all};

use basemat_problems::scenes::{self, Frame, SI};

/// Friction up to which a solution does not depend on where the search begins: see
/// `docs/validation.md`.
const UNIQUE: f64 = 0.6;

#[test]
fn every_run_is_finite_balanced_and_admissible() {
    let strategy = (recipes(10.0), 0..5_u8)
        .prop_map(|(recipe, which)| Recipe { weightless: which == 0, ..recipe });
    let tally = for_all("runs", 40, &strategy, |recipe, tally| {
        let Some(states) = accepted(recipe, recipe.run(SI, 0), tally)? else { return Ok(()) };
        let condition = recipe.whole().build(SI, 0).unwrap().conditioning().effective_stiffness;
        tally.see(&states);
        run_checks::numbers_are_finite(&states)?;
        run_checks::energy_is_kept(recipe, &states, condition, tally)?;
        run_checks::contact_conditions_hold(recipe, &states, tally)?;
        if recipe.weightless {
            return Ok(());
        }
        preload_is_in_equilibrium(recipe, &states[0], tally)
    });
    // A property over scenes in which nothing happens would say nothing.
    let scenes = tally.counted("scenes");
    assert!(tally.counted("refused") < scenes / 4, "{tally}");
    assert!(tally.counted("changes of mode") > 5 * scenes, "{tally}");
}

/// Random scenes of usual weight give no warning of numbers in another unit, nor of a run's end, under usual shaking (at
/// most 2 g) by a function, and under records that are run to their end.
#[test]
fn sensible_scenes_earn_no_warning_of_units() {
    // Without friction a base slides on after a record, and these schemes make energy on soil: responses grow.
    let is_usual = |recipe: &Recipe| {
        let is_heavy = recipe.weight() > 2e3 * recipe::WIDTH && !recipe.weightless;
        let grows = matches!(recipe.scheme, Scheme::Newmark(_) | Scheme::Hht(_));
        is_heavy && recipe.friction() > 0.1 && !grows
    };
    let usual = recipes(1.0).prop_filter("usual weight, friction and scheme", is_usual);
    let record = (0.5..15.0, prop::sample::select(vec![0.0025, 0.005, 0.01, 0.02]), 1.0..8.0);
    let tally = for_all("units", 40, &(usual, record), |(recipe, shaking), tally| {
        let run = |built: Result<Simulation, Error>, tally: &mut Tally, kind| {
            let Ok(mut simulation) = built else { return Ok(()) };
            let steps = match kind {
                "records" => simulation.steps_for(record_of(*shaking).duration()),
                _ => 200,
            };
            // A step is far below the period of a record where elements are small and soil is stiff.
            let Ok(run) = simulation.run(steps.min(4000), |_| {}) else { return Ok(()) };
            tally.count(kind, 1);
            let is_whole = kind == "records" && steps <= 4000;
            for warning in &run.warnings {
                let is_of_end =
                    matches!(warning, Warning::EndsEarly { .. } | Warning::PeakAtEnd { .. });
                prop_assert!(!is_of_units(warning) || is_of_end && !is_whole, "{warning}");
            }
            Ok(())
        };
        if recipe.peak_acceleration() < 2.0 * scenes::GRAVITY {
            run(recipe.build(SI, 0), tally, "functions")?;
        }
        run(recipe.build_with(SI, record_of(*shaking)), tally, "records")
    });
    assert!(tally.counted("functions") > 10 && tally.counted("records") > 20, "{tally}");
}

/// A record with this peak (m/s²) and time step (s), and so many waves that grow and fade in 200 samples; the response
/// dies away in as long a time again and again.
fn record_of((peak, time_step, waves): (f64, f64, f64)) -> Record {
    let sample = |k: usize| {
        let phase = std::f64::consts::PI * k.min(200) as f64 / 200.0;
        phase.sin().powi(2) * (2.0 * waves * phase).sin()
    };
    let record = Record::new(time_step, (0..=600).map(sample).collect()).unwrap();
    record.scaled_to_peak(peak).unwrap()
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

/// Forces and moments of the static state, against the weight that the pressures carry.
fn preload_is_in_equilibrium(
    recipe: &Recipe,
    state: &State,
    tally: &mut Tally,
) -> Result<(), TestCaseError> {
    let weight = recipe.weight();
    let limit = recipe.static_rounding().max(1e-10);
    tally.within("preload: vertical force", (state.normal_force / weight - 1.0).abs(), limit)?;
    tally.within("preload: horizontal force", state.base_shear.abs() / weight, limit)?;
    tally.within("preload: moment", state.base_moment.abs() / (weight * recipe::WIDTH), limit)
}

/// The search for the static state ends by forces over the root of masses: by forces and moments
/// as they are it never ended where the unit of length is short.
#[test]
fn static_state_is_found_in_any_unit_of_length() {
    for power in -6..=6 {
        let frame = Frame { length: 10.0_f64.powi(power), ..SI };
        let builder = scenes::scene(frame, 0.0).structure(scenes::block(frame));
        let simulation = builder
            .interface(scenes::friction(0.05))
            .gravity_stage(basemat::coupled::GravityStage::Frictional)
            .build();
        let state = simulation.unwrap().state().clone();
        let weight = 4.0 * 6.0 * 1500.0 * scenes::GRAVITY;
        let relative = state.normal_force / (weight * frame.pressure() * frame.length);
        assert!((relative - 1.0).abs() < 1e-10, "10^{power}: {relative}");
    }
}

#[test]
fn runs_repeat_to_the_bit() {
    for_all("repetition", 12, &recipes(10.0), |recipe, tally| {
        let Some(first) = accepted(recipe, recipe.run(SI, 0), tally)? else { return Ok(()) };
        tally.see(&first);
        let second = recipe.run(SI, 0).unwrap();
        prop_assert!(first == second);
        Ok(())
    });
}

/// Relation of a run to another: in other units, as a mirror image.
#[derive(Debug, Clone, Copy)]
struct Twin {
    /// Factors from the other run's pressure, shear, slip and rotation to the first run's.
    factors: [f64; 4],
    mirrored: bool,
}

const SAME: Twin = Twin { factors: [1.0; 4], mirrored: false };

/// Largest differences of pressures, shear tractions, slips and rotations of two runs, relative to
/// the largest traction and length of the first.
fn apart(one: &[State], other: &[State], twin: Twin) -> [f64; 4] {
    let Scales { traction, length, .. } = Scales::largest(one);
    let scales = [traction, traction, length, length / recipe::WIDTH];
    let count = one[0].contact.len();
    let mut apart = [0.0_f64; 4];
    for (a, b) in one.iter().zip(other) {
        for e in 0..count {
            let (at, to) =
                (&a.contact[e], &b.contact[if twin.mirrored { count - 1 - e } else { e }]);
            let pairs = [
                (at.pressure, to.pressure),
                (at.shear, to.shear),
                (at.slip, to.slip),
                (a.base_rotation, b.base_rotation),
            ];
            for (k, (at, to)) in pairs.into_iter().enumerate() {
                apart[k] = apart[k].max((at - twin.factors[k] * to).abs() / scales[k]);
            }
        }
    }
    apart
}

/// Two runs that should be the same are as near as the static state is known, which is to 1e-10: 1e-9, unless landings
/// amplify it. Runs whose shaking and soil differ by 1e-10 show the amplification.
fn same_run(
    recipe: &Recipe,
    one: &[State],
    other: &[State],
    twin: Twin,
    tally: &mut Tally,
) -> Result<(), TestCaseError> {
    // Where such a layer lands there may be several solutions, as there may be none.
    if recipe.pulls_while_open() {
        return Ok(());
    }
    let more = 1.0 + 1e-10;
    let stronger = Recipe { strength: recipe.strength * more, ..recipe.clone() };
    let stiffer = Recipe { modulus: recipe.modulus * more, ..recipe.clone() };
    let mut sensitivity = [0.0_f64; 4];
    for nearly in [stronger, stiffer] {
        let Some(nearly) = accepted(recipe, nearly.run(SI, 0), tally)? else { return Ok(()) };
        let found = apart(one, &nearly, SAME);
        for k in 0..4 {
            sensitivity[k] = sensitivity[k].max(found[k]);
        }
    }
    let found = apart(one, other, twin);
    let names = ["pressures apart", "shear apart", "slip apart", "rotation apart"];
    for k in 0..4 {
        tally.within(names[k], found[k], 1e-9 + 10.0 * sensitivity[k])?;
    }
    Ok(())
}

#[test]
fn mirrored_scenes_respond_as_mirror_images() {
    let mirror = Frame { mirrored: true, ..SI };
    let twin = Twin { factors: [1.0, -1.0, -1.0, -1.0], mirrored: true };
    for_all("mirror", 12, &recipes(UNIQUE), |recipe, tally| {
        let Some(plain) = accepted(recipe, recipe.run(SI, 0), tally)? else { return Ok(()) };
        tally.see(&plain);
        let Some(other) = accepted(recipe, recipe.run(mirror, 0), tally)? else { return Ok(()) };
        same_run(recipe, &plain, &other, twin, tally)
    });
}

#[test]
fn units_do_not_matter_over_twelve_orders_of_magnitude() {
    let powers = || (-6.0..6.0, -6.0..6.0, -6.0..6.0);
    let strategy = (recipes(UNIQUE), powers());
    for_all("units", 12, &strategy, |(recipe, (length, time, mass)), tally| {
        let ten = |power: f64| 10.0_f64.powf(power);
        let frame =
            Frame { length: ten(*length), time: ten(*time), mass: ten(*mass), mirrored: false };
        let Some(plain) = accepted(recipe, recipe.run(SI, 0), tally)? else { return Ok(()) };
        tally.see(&plain);
        let Some(other) = accepted(recipe, recipe.run(frame, 0), tally)? else {
            return Err(TestCaseError::fail("refused in other units"));
        };
        let traction = 1.0 / frame.pressure();
        let factors = [traction, traction, 1.0 / frame.length, 1.0];
        same_run(recipe, &plain, &other, Twin { factors, mirrored: false }, tally)
    });
}

#[test]
fn later_shaking_gives_the_same_response_later() {
    let strategy = (recipes(UNIQUE), 1_usize..40);
    for_all("shift", 12, &strategy, |(recipe, delay), tally| {
        let Some(plain) = accepted(recipe, recipe.run(SI, 0), tally)? else { return Ok(()) };
        tally.see(&plain);
        let Some(other) = accepted(recipe, recipe.run(SI, *delay), tally)? else { return Ok(()) };
        same_run(recipe, &plain, &other[*delay..], SAME, tally)
    });
}
