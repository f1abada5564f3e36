//! GOAL: a checkpoint carries the choice of the convolution history; an approximate history books
//! its error.
//! SCENE: grounds that choose, with much memory and little; corrupt counts of steps.
//! REFERENCE: the saved run to the last bit; typed errors for another choice; the energy balance.

use std::sync::Arc;

use basemat::bem::{ElasticGround, Ground, PatchKernel, Strip};
use basemat::coupled::{Coordinates, SimulationBuilder};
use basemat::history::{
    ChoiceReason, ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory,
    HistoryMethod, HistoryOptions, RelaxedFftHistory,
};
use basemat::soil::SoilProfile;
use basemat::{CheckpointError, Error, MemoryError, StepError};

use super::{STEPS, carried, half_plane, refusal};
use basemat_problems::scenes::{SI, block, friction, scene, soil, states};

/// A chosen history in at most these bytes.
fn within(memory: usize) -> HistoryOptions {
    HistoryOptions { memory, ..HistoryOptions::default() }
}

/// A block on equal elements whose ground chooses its history, in at most these bytes.
pub(crate) fn auto(elements: usize, memory: usize) -> SimulationBuilder {
    let ground =
        ElasticGround::new(soil(SI), Strip::uniform(-2.0..2.0, elements).unwrap()).unwrap();
    let base = scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
    // Not chosen by the number of steps.
    let base = base.coordinates(Coordinates::Physical);
    base.ground(ground.with_history(within(memory)).unwrap())
}

#[test]
fn what_auto_has_chosen_is_chosen_again() {
    const GIB: usize = 1 << 30;
    for (elements, memory, expected, steps, kind) in [
        // By wavenumbers and by pairs.
        (10, GIB, 0, 50, HistoryMethod::RelaxedFft),
        (4, GIB, 0, 50, HistoryMethod::RelaxedFft),
        (10, GIB, 0, 100, HistoryMethod::RelaxedFft),
        (10, 10_000, 0, 100, HistoryMethod::Exponentials),
        // Their poles depend on the steps that were expected, which are no part of the scene.
        (10, 10_000, 1 << 30, 100, HistoryMethod::Exponentials),
    ] {
        let case = format!("{elements} elements, {memory} bytes, {expected} steps expected");
        let mut whole = auto(elements, memory).expected_steps(expected).build().unwrap();
        whole.run(steps, |_| {}).unwrap();
        let choice = whole.ground().history_choice().unwrap();
        assert_eq!(choice.kind, kind, "{case}");
        let saved = carried(&whole.checkpoint().unwrap());
        let wanted = states(&mut whole, 40);
        let mut used = auto(elements, memory).build().unwrap();
        used.run(steps + 10, |_| {}).unwrap();
        for mut other in [auto(elements, memory).build().unwrap(), used] {
            other.resume(&saved).unwrap_or_else(|e| panic!("{case}: {e}"));
            assert_eq!(other.ground().history_choice(), Some(choice), "{case}");
            assert_eq!(other.checkpoint().unwrap(), saved, "{case}");
            assert_eq!(states(&mut other, 40)[1..], wanted[1..], "{case}");
        }
    }
}

#[test]
fn where_nothing_was_chosen_the_choice_is_open_again() {
    // Enough for 50 steps, too little for 100.
    let fresh = auto(10, 60_000).build().unwrap().checkpoint().unwrap();
    let mut used = auto(10, 60_000).build().unwrap();
    used.run(100, |_| {}).unwrap();
    assert_eq!(used.ground().history_choice().unwrap().kind, HistoryMethod::Exponentials);
    used.resume(&fresh).unwrap();
    assert_eq!((used.ground().history_choice(), used.state().step), (None, 0));
    used.run(50, |_| {}).unwrap();
    assert_eq!(used.ground().history_choice().unwrap().kind, HistoryMethod::RelaxedFft);
}

/// GOAL: where a long run is announced the exponentials take over, with an error at rounding.
/// SCENE: a block that uplifts and slides, by wavenumbers and by pairs.
#[test]
fn the_history_of_a_long_run_differs_by_rounding() {
    for elements in [4, 10] {
        let run = |expected: usize| {
            let mut simulation = auto(elements, 1 << 30).expected_steps(expected).build().unwrap();
            simulation.run(300, |_| {}).unwrap();
            simulation
        };
        let (short, long) = (run(0), run(100_000));
        let kinds = [&short, &long].map(|simulation| simulation.ground().history_choice().unwrap());
        assert_eq!(kinds.map(|c| c.kind), [HistoryMethod::RelaxedFft, HistoryMethod::Exponentials]);
        assert_eq!(kinds[1].reason, ChoiceReason::Rounding);
        assert!(kinds[1].error_bound > 0.0 && kinds[1].error_bound <= 1e-12);
        let (short, long) = (short.state(), long.state());
        assert_eq!(short.modes, long.modes);
        let weight: f64 = short.normal_force;
        for (short, long) in [
            (short.base_shear, long.base_shear),
            (short.base_moment, long.base_moment),
            (short.normal_force, long.normal_force),
        ] {
            assert!((short - long).abs() < 1e-9 * weight, "{elements}: {short} {long}");
        }
        assert!((short.mean_slip - long.mean_slip).abs() < 1e-9 * short.mean_slip.abs());
        assert!(long.energy_balance.soil_error_bound > 0.0);
    }
}

/// GOAL: how a run is cut into pieces changes no bit, nor does what was announced of it, unless
/// another history is chosen.
/// SCENE: transforms by wavenumbers and by pairs; pieces shorter and longer than their blocks.
#[test]
fn a_run_may_be_cut_anywhere() {
    for elements in [4, 10] {
        let run = |cuts: &[usize], expected: usize| {
            let mut simulation = auto(elements, 1 << 30).expected_steps(expected).build().unwrap();
            for steps in cuts {
                simulation.run(*steps, |_| {}).unwrap();
            }
            simulation
        };
        let whole = run(&[300], 0);
        let (state, saved) = (whole.state(), whole.checkpoint().unwrap());
        let cuts: [&[usize]; 6] =
            [&[50, 250], &[64, 236], &[65, 235], &[1, 299], &[299, 1], &[30; 10]];
        for cuts in cuts {
            for expected in [0, 40, 300, 1000] {
                let cut = run(cuts, expected);
                assert_eq!(cut.state(), state, "{elements} elements, {cuts:?}, {expected}");
                assert_eq!(cut.ground().history_choice().unwrap().kind, HistoryMethod::RelaxedFft);
            }
            // Only the first announcement is noted.
            assert_eq!(
                run(cuts, 300).checkpoint().unwrap(),
                run(&[300], 300).checkpoint().unwrap()
            );
        }
        // Steps of one's own loop, of which nothing is announced.
        let mut own = run(&[], 0);
        for _ in 0..300 {
            own.step().unwrap();
        }
        assert_eq!(own.state(), state, "{elements} elements");
        let mut resumed = run(&[20], 0);
        resumed.resume(&saved).unwrap();
        assert_eq!(resumed.state().probes, state.probes);
    }
}

/// Whatever the first run announced, a checkpoint of the same scene fits.
#[test]
fn a_used_simulation_resumes_the_same_scene() {
    for memory in [1 << 30, 60_000] {
        let run = |steps: usize| {
            let mut simulation = auto(10, memory).build().unwrap();
            simulation.run(steps, |_| {}).unwrap();
            simulation
        };
        for (first, second) in [(50, 300), (300, 50)] {
            let (mut one, mut other) = (run(first), run(second));
            other.resume(&one.checkpoint().unwrap()).unwrap();
            assert_eq!(other.ground().history_choice(), one.ground().history_choice());
            assert_eq!(states(&mut other, 40)[1..], states(&mut one, 40)[1..]);
        }
    }
}

/// Where memory decides, the first announcement does, and after it the step at which memory is used
/// up: once it is given to the builder, cuts are the same again.
#[test]
fn a_choice_by_memory_is_that_of_the_first_announcement() {
    let run = |cuts: &[usize], expected: usize| {
        let mut simulation = auto(10, 60_000).expected_steps(expected).build().unwrap();
        for steps in cuts {
            simulation.run(*steps, |_| {}).unwrap();
        }
        (simulation.ground().history_choice().unwrap().kind, simulation.state().clone())
    };
    assert_eq!(run(&[300], 0).0, HistoryMethod::Exponentials);
    assert_eq!(run(&[50], 0).0, HistoryMethod::RelaxedFft);
    assert_ne!(run(&[50, 250], 0).1, run(&[300], 0).1);
    assert_eq!(run(&[50, 250], 300), run(&[300], 0));
}

/// GOAL: beyond the steps announced the memory allowed holds: exponentials take over, wherever the run
/// is cut or resumed.
/// SCENE: a block that uplifts and slides, announced for 50 steps or not at all, run for 400.
/// REFERENCE: the exact history with memory enough; the run without cuts, to the bit.
#[test]
fn beyond_the_memory_exponentials_take_over() {
    // 64 steps by wavenumbers, 128 by pairs, are 43 and 31 kB.
    for (elements, memory, most) in [(10, 60_000, 64), (4, 40_000, 128)] {
        let make = |expected: usize| auto(elements, memory).expected_steps(expected);
        let march = |cuts: &[usize], expected: usize| {
            let mut simulation = make(expected).build().unwrap();
            for steps in cuts {
                simulation.run(*steps, |_| {}).unwrap();
            }
            simulation
        };
        let exact = states(&mut auto(elements, 1 << 30).build().unwrap(), 400);
        let mut whole = make(50).build().unwrap();
        let found = states(&mut whole, 400);
        assert!(found[most] == exact[most], "{elements}: exact until there");
        let choice = whole.ground().history_choice().unwrap();
        assert_eq!(
            (choice.kind, choice.reason),
            (HistoryMethod::Exponentials, ChoiceReason::MemoryLimit)
        );
        assert!(choice.error_bound > 0.0 && choice.error_bound <= 1e-10);
        assert!(found[400].energy_balance.soil_error_bound > 0.0);
        let scale = exact.iter().map(|s| s.base_shear.abs()).fold(0.0, f64::max);
        for (found, exact) in found.iter().zip(&exact) {
            assert_eq!(found.modes, exact.modes, "{elements}, step {}", exact.step);
            let apart = (found.base_shear - exact.base_shear).abs();
            assert!(apart < 1e-7 * scale, "{elements}, step {}: {apart:e}", exact.step);
            assert!(found.energy_balance.residual() < 1e-9);
        }
        let last = &found[400];
        for cuts in [&[50, 350][..], &[most, 400 - most], &[most - 1, 2, 399 - most], &[1; 400]] {
            assert!(march(cuts, 50).state() == last, "{elements}, {cuts:?}");
        }
        let mut loose = make(0).build().unwrap();
        for _ in 0..400 {
            loose.step().unwrap();
        }
        assert_eq!(loose.state().base_shear, last.base_shear, "{elements}: nothing announced");
        for cut in [most - 1, most, most + 1, 300] {
            let saved = carried(&march(&[cut], 50).checkpoint().unwrap());
            let mut used = make(50).build().unwrap();
            used.run(350, |_| {}).unwrap();
            for mut other in [make(50).build().unwrap(), used] {
                other.resume(&saved).unwrap_or_else(|e| panic!("{elements}, cut at {cut}: {e}"));
                assert_eq!(other.checkpoint().unwrap(), saved, "{elements}, cut at {cut}");
                other.run(400 - cut, |_| {}).unwrap();
                assert!(other.state() == last, "{elements}, cut at {cut}");
            }
        }
        let mut plenty = auto(elements, 1 << 30).expected_steps(50).build().unwrap();
        let quantity = "kind of history";
        let late = march(&[300], 50).checkpoint().unwrap();
        assert_eq!(refusal(&mut plenty, &late), CheckpointError::OtherScene { quantity });
    }
}

/// GOAL: where no exponentials can take over, the step that would need more memory is refused, and the
/// run goes on from there with more.
/// SCENE: exact histories that were asked for; layers.
/// REFERENCE: the run with memory enough, to the bit.
#[test]
fn beyond_the_memory_exact_histories_stop() {
    // Modes would be taken for some numbers of steps and not for others.
    let over = |ground: Box<dyn Ground>| {
        let base = scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
        base.ground(ground).coordinates(Coordinates::Physical)
    };
    let layers = |memory| {
        let profile = SoilProfile::on_rigid_base().with_layer(soil(SI), 6.0).unwrap();
        let ground = ElasticGround::new(profile, Strip::uniform(-2.0..2.0, 2).unwrap()).unwrap();
        over(Box::new(ground.with_history(within(memory)).unwrap()))
    };
    let asked = |history, memory| {
        over(Box::new(half_plane(HistoryOptions { memory, ..HistoryOptions::from(history) })))
    };
    let scenes: [(usize, &dyn Fn(usize) -> SimulationBuilder); 3] = [
        (30_000, &layers),
        (100_000, &|memory| asked(HistoryMethod::RelaxedFft, memory)),
        (100_000, &|memory| asked(HistoryMethod::Direct, memory)),
    ];
    for (number, (memory, make)) in scenes.into_iter().enumerate() {
        let mut whole = make(1 << 30).expected_steps(10).build().unwrap();
        let wanted = states(&mut whole, 400);
        let mut short = make(memory).expected_steps(10).build().unwrap();
        let mut seen = 0;
        let error = short.run(400, |_| seen += 1).unwrap_err();
        let Error::Step { step, source: StepError::Ground(cause), .. } = error else {
            panic!("{number}: {error}");
        };
        let Error::Memory(MemoryError { needed, limit, .. }) = *cause else {
            panic!("{number}: {cause}")
        };
        assert!(limit == memory as f64 && needed > limit, "{number}: {needed}");
        assert!((64..400).contains(&seen) && step == seen + 1, "{number}: {step}");
        assert!(*short.state() == wanted[seen], "{number}");
        // It stays so.
        assert!(short.step().is_err() && short.state().step == seen);
        let mut other = make(1 << 30).expected_steps(10).build().unwrap();
        other.resume(&short.checkpoint().unwrap()).unwrap();
        other.run(400 - seen, |_| {}).unwrap();
        assert!(*other.state() == wanted[400], "{number}");
        // What is announced is given.
        let mut told = make(memory).expected_steps(400).build().unwrap();
        told.run(400, |_| {}).unwrap();
        assert!(*told.state() == wanted[400], "{number}");
        assert!(told.step().is_err(), "{number}");
    }
}

#[test]
fn another_choice_is_refused_and_changes_nothing() {
    let run = |memory| {
        let mut simulation = auto(10, memory).build().unwrap();
        simulation.run(100, |_| {}).unwrap();
        simulation.checkpoint().unwrap()
    };
    let [transforms, exponentials] = [run(1 << 30), run(10_000)];
    let quantity = "kind of history";
    for (memory, checkpoint) in [(10_000, &transforms), (1 << 30, &exponentials)] {
        // It would choose another one.
        let mut fresh = auto(10, memory).build().unwrap();
        assert_eq!(refusal(&mut fresh, checkpoint), CheckpointError::OtherScene { quantity });
        assert_eq!(fresh.ground().history_choice(), None);
        // It has chosen another one.
        fresh.run(50, |_| {}).unwrap();
        assert_eq!(refusal(&mut fresh, checkpoint), CheckpointError::OtherScene { quantity });
    }
}

#[test]
fn a_step_count_without_tractions_takes_no_memory() {
    // By pairs, and by wavenumbers.
    for count in [4, 10] {
        let elements = Strip::uniform(-2.0..2.0, count).unwrap().elements();
        let kernel: Arc<dyn ConvolutionWeights> =
            Arc::new(PatchKernel::new(soil(SI), elements, 0.01).unwrap());
        let corrupt = |history: &mut dyn ConvolutionHistory| {
            for steps in [1 << 40, 1 << 47, usize::MAX] {
                let error = history.restore(steps, &[0.0; 16]).unwrap_err();
                assert!(matches!(error, Error::Checkpoint(CheckpointError::Corrupt { .. })));
            }
        };
        corrupt(&mut DirectHistory::new(Arc::clone(&kernel)));
        corrupt(&mut RelaxedFftHistory::new(Arc::clone(&kernel)));
        corrupt(&mut ExponentialHistory::new(kernel, 1e-6).unwrap());
    }
}

#[test]
fn an_approximate_history_is_in_the_energy_balance() {
    let run = |history, tolerance| {
        let ground = half_plane(HistoryOptions {
            tolerance: Some(tolerance),
            ..HistoryOptions::from(history)
        });
        let base = scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
        base.ground(ground).build().unwrap().run(STEPS, |_| {}).unwrap()
    };
    let exact = run(HistoryMethod::Direct, 1e-3);
    assert_eq!(exact.energy_balance.soil_error_bound, 0.0);
    let mut last = f64::INFINITY;
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let run = run(HistoryMethod::Exponentials, tolerance);
        let bound = run.energy_balance.soil_error_bound;
        println!("{tolerance:e}: soil {:e} within {bound:e}", run.energy_balance.soil);
        assert!(bound > 0.0 && bound < 100.0 * tolerance * run.energy_balance.soil);
        assert!(bound < 0.1 * last);
        assert!(run.energy_error < 1e-10, "{:e}", run.energy_error);
        assert!(run.to_string().contains("soil within"));
        last = bound;
    }
}
