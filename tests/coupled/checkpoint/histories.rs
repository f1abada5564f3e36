//! GOAL: a checkpoint carries the convolution history; an approximate history books
//! its error.
//! SCENE: grounds that choose, with much memory and little; corrupt counts of steps.
//! REFERENCE: the saved run to the last bit; typed errors for another choice; the energy balance.

use std::sync::Arc;

use basemat::bem::{ElasticGround, Ground, PatchKernel, Strip};
use basemat::coupled::{CheckpointError, StepError};
use basemat::coupled::{Coordinates, SimulationBuilder};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory, HistoryMethod,
    HistoryOptions, RelaxedFftHistory,
};
use basemat::soil::SoilProfile;
use basemat::{Error, MemoryError, Simulation};

use super::{STEPS, carried, half_plane, refusal};
use basemat_problems::scenes::{SI, block, friction, scene, soil, states};

/// A chosen history in at most these bytes.
fn within(memory: usize) -> HistoryOptions {
    HistoryOptions { memory, ..HistoryOptions::default() }
}

/// A block on equal elements whose ground has a history by these options.
fn by(elements: usize, options: impl Into<HistoryOptions>) -> SimulationBuilder {
    let ground =
        ElasticGround::new(soil(SI), Strip::uniform(-2.0..2.0, elements).unwrap()).unwrap();
    let base = scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
    // Not chosen by the number of steps.
    let base = base.coordinates(Coordinates::Physical);
    base.ground(ground.with_history(options).unwrap())
}

/// A block on equal elements whose ground chooses its history, in at most these bytes.
pub(crate) fn auto(elements: usize, memory: usize) -> SimulationBuilder {
    by(elements, within(memory))
}

const GIB: usize = 1 << 30;
/// Too little for exponentials under ten elements, and enough for transforms of 64 steps.
const LITTLE: usize = 50_000;

fn kind(simulation: &Simulation) -> HistoryMethod {
    simulation.ground().description().history.unwrap().kind
}

#[test]
fn a_checkpoint_brings_its_history() {
    for (elements, memory, expected, steps, wanted) in [
        // By wavenumbers and by pairs.
        (10, GIB, 0, 50, HistoryMethod::Exponentials),
        (4, GIB, 0, 50, HistoryMethod::Exponentials),
        (10, LITTLE, 0, 20, HistoryMethod::RelaxedFft),
        // Their poles depend on the steps that were expected, which are no part of the scene.
        (10, GIB, 1 << 30, 100, HistoryMethod::Exponentials),
    ] {
        let case = format!("{elements} elements, {memory} bytes, {expected} steps expected");
        let mut whole = auto(elements, memory).expected_steps(expected).build().unwrap();
        whole.run(steps, |_| {}).unwrap();
        assert_eq!(kind(&whole), wanted, "{case}");
        let saved = carried(&whole.checkpoint().unwrap());
        let later = states(&mut whole, 30);
        let mut used = auto(elements, memory).build().unwrap();
        used.run(steps + 10, |_| {}).unwrap();
        for mut other in [auto(elements, memory).build().unwrap(), used] {
            other.resume(&saved).unwrap_or_else(|e| panic!("{case}: {e}"));
            assert_eq!(kind(&other), wanted, "{case}");
            assert_eq!(other.checkpoint().unwrap(), saved, "{case}");
            assert_eq!(states(&mut other, 30)[1..], later[1..], "{case}");
        }
    }
}

/// GOAL: exponentials differ from the exact history by rounding.
/// SCENE: a block that uplifts and slides, by wavenumbers and by pairs.
#[test]
fn exponentials_differ_by_rounding() {
    for elements in [4, 10] {
        let run = |method| {
            let mut simulation = by(elements, HistoryOptions::from(method)).build().unwrap();
            simulation.run(300, |_| {}).unwrap();
            simulation
        };
        let (exact, chosen) = (run(HistoryMethod::RelaxedFft), run(HistoryMethod::Auto));
        assert_eq!(kind(&chosen), HistoryMethod::Exponentials);
        let bound = chosen.ground().description().history.unwrap().error_bound;
        assert!(bound > 0.0 && bound <= 1e-12, "{bound:e}");
        let (exact, chosen) = (exact.state(), chosen.state());
        assert_eq!(exact.modes, chosen.modes);
        let weight: f64 = exact.normal_force;
        for (exact, chosen) in [
            (exact.base_shear, chosen.base_shear),
            (exact.base_moment, chosen.base_moment),
            (exact.normal_force, chosen.normal_force),
        ] {
            assert!((exact - chosen).abs() < 1e-9 * weight, "{elements}: {exact} {chosen}");
        }
        assert!((exact.mean_slip - chosen.mean_slip).abs() < 1e-9 * exact.mean_slip.abs());
        assert!(chosen.energy_balance.soil_error_bound > 0.0);
    }
}

/// GOAL: how a run is cut into pieces changes no bit, nor does what was announced of it.
/// SCENE: exponentials, and transforms by wavenumbers and by pairs; pieces shorter and longer than their blocks.
#[test]
fn a_run_may_be_cut_anywhere() {
    for (elements, method) in [
        (4, HistoryMethod::Auto),
        (4, HistoryMethod::RelaxedFft),
        (10, HistoryMethod::Auto),
        (10, HistoryMethod::RelaxedFft),
    ] {
        let run = |cuts: &[usize], expected: usize| {
            let mut simulation = by(elements, method).expected_steps(expected).build().unwrap();
            for steps in cuts {
                simulation.run(*steps, |_| {}).unwrap();
            }
            simulation
        };
        let whole = run(&[300], 0);
        let (state, saved) = (whole.state(), whole.checkpoint().unwrap());
        let cuts: [&[usize]; 7] =
            [&[50, 250], &[64, 236], &[65, 235], &[1, 299], &[299, 1], &[30; 10], &[1; 300]];
        for cuts in cuts {
            for expected in [0, 40, 300, 1000] {
                let cut = run(cuts, expected);
                assert_eq!(cut.state(), state, "{elements} elements, {cuts:?}, {expected}");
                assert_eq!(cut.checkpoint().unwrap(), saved);
            }
        }
        // Steps of one's own loop, of which nothing is announced.
        let mut own = run(&[], 0);
        for _ in 0..300 {
            own.step().unwrap();
        }
        assert_eq!(own.state(), state, "{elements} elements");
        assert_eq!(own.ground().description().history.unwrap().steps, None);
        let mut resumed = run(&[20], 0);
        resumed.resume(&saved).unwrap();
        assert_eq!(resumed.state().probes, state.probes);
    }
}

/// Whatever the first run announced, a checkpoint of the same scene fits.
#[test]
fn a_used_simulation_resumes_the_same_scene() {
    let run = |steps: usize| {
        let mut simulation = auto(10, GIB).build().unwrap();
        simulation.run(steps, |_| {}).unwrap();
        simulation
    };
    for (first, second) in [(50, 300), (300, 50)] {
        let (mut one, mut other) = (run(first), run(second));
        other.resume(&one.checkpoint().unwrap()).unwrap();
        assert_eq!(kind(&other), kind(&one));
        assert_eq!(states(&mut other, 40)[1..], states(&mut one, 40)[1..]);
    }
}

/// GOAL: steps that need more memory than is allowed are refused: by a build and a run that know their number before
/// the first of them, by a step of one's own loop when it comes; a checkpoint goes on with more. SCENE: histories that
/// were requested and chosen; layers. REFERENCE: the run with memory enough, to the bit.
#[test]
fn steps_beyond_the_memory_are_refused() {
    // Modes would be taken for some numbers of steps and not for others.
    let over = |ground: Box<dyn Ground>| {
        let base = scene(SI, 0.6).interface(friction(0.3)).structure(block(SI));
        base.ground(ground).coordinates(Coordinates::Physical)
    };
    let layers = |memory| {
        let profile = SoilProfile::on_rigid_bedrock().with_layer(soil(SI), 6.0).unwrap();
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
    let of_memory = |error: Error, memory: usize| {
        let Error::Memory(MemoryError { needed, limit, .. }) = error else { panic!("{error}") };
        assert!(limit == memory as f64 && needed > limit, "{needed}");
    };
    for (number, (memory, make)) in scenes.into_iter().enumerate() {
        let wanted = states(&mut make(GIB).build().unwrap(), 400);
        of_memory(make(memory).expected_steps(400).build().err().unwrap(), memory);
        let mut short = make(memory).build().unwrap();
        of_memory(short.run(400, |_| {}).unwrap_err(), memory);
        assert_eq!(short.state().step, 0);
        short.run(50, |_| {}).unwrap();
        of_memory(short.run(350, |_| {}).unwrap_err(), memory);
        assert!(*short.state() == wanted[50], "{number}");
        let error = (50..400).find_map(|_| short.step().err()).unwrap();
        let Error::Step { step, source: StepError::Part { quantity, source: cause }, .. } = error
        else {
            panic!("{number}: {error}");
        };
        assert_eq!(quantity, "history of the ground");
        of_memory(*cause, memory);
        let seen = short.state().step;
        assert!((64..400).contains(&seen) && step == seen + 1, "{number}: {step}");
        assert!(*short.state() == wanted[seen], "{number}");
        // It stays so.
        assert!(short.step().is_err() && short.state().step == seen);
        let mut other = make(GIB).build().unwrap();
        other.resume(&short.checkpoint().unwrap()).unwrap();
        other.run(400 - seen, |_| {}).unwrap();
        assert!(*other.state() == wanted[400], "{number}");
    }
}

#[test]
fn another_kind_is_refused_and_changes_nothing() {
    let run = |memory| {
        let mut simulation = auto(10, memory).build().unwrap();
        simulation.run(50, |_| {}).unwrap();
        simulation.checkpoint().unwrap()
    };
    let [transforms, exponentials] = [run(LITTLE), run(GIB)];
    let quantity = "kind of history";
    for (memory, checkpoint) in [(GIB, &transforms), (LITTLE, &exponentials)] {
        let mut fresh = auto(10, memory).build().unwrap();
        assert_eq!(refusal(&mut fresh, checkpoint), CheckpointError::OtherScene { quantity });
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
