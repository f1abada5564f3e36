//! GOAL: a checkpoint contains the convolution history; the energy balance contains the error of an approximate one.
//! SCENE: grounds that choose their history, with much memory and little; corrupt counts of steps.
//! REFERENCE: the saved run to the last bit; typed errors for another choice; the energy balance.

use std::sync::Arc;

use basemat::bem::{ElasticGround, PatchKernel, Strip};
use basemat::coupled::{CheckpointError, StepError};
use basemat::coupled::{Coordinates, SimulationBuilder};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory, HistoryMethod,
    HistoryOptions, RelaxedFftHistory,
};
use basemat::results::Run;
use basemat::soil::SoilProfile;
use basemat::{Error, MemoryError, Simulation};

use super::{RUN_STEPS, half_plane, resume_error, through_text};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene, soil, states};

/// Options by which a ground chooses its history, in at most these bytes.
fn within(memory: usize) -> HistoryOptions {
    HistoryOptions { memory, ..HistoryOptions::default() }
}

/// A block on equal elements whose ground has a history by these options.
fn with_history(elements: usize, options: impl Into<HistoryOptions>) -> SimulationBuilder {
    let ground =
        ElasticGround::new(soil(SI_UNITS), Strip::uniform(-2.0..2.0, elements).unwrap()).unwrap();
    let base = scene(SI_UNITS, 0.6).interface(friction(0.3)).structure(block(SI_UNITS));
    // Coordinates that do not depend on the number of steps.
    let base = base.coordinates(Coordinates::Physical);
    base.ground(ground.with_history(options).unwrap())
}

/// A block on equal elements whose ground chooses its history, in at most these bytes.
pub(crate) fn auto(elements: usize, memory: usize) -> SimulationBuilder {
    with_history(elements, within(memory))
}

/// Memory that is enough for every history of these tests, bytes.
const AMPLE_MEMORY: usize = 1 << 30;
/// Memory that is too little for exponentials of ten elements, and enough for transforms of 64 steps, bytes.
const SCARCE_MEMORY: usize = 50_000;

fn kind(simulation: &Simulation) -> HistoryMethod {
    simulation.ground().description().history.unwrap().kind
}

/// A run of so many steps whose ground has chosen its history.
fn auto_run(elements: usize, memory: usize, steps: usize) -> Simulation {
    let mut simulation = auto(elements, memory).build().unwrap();
    simulation.run(steps, |_| {}).unwrap();
    simulation
}

#[test]
fn a_checkpoint_contains_its_history() {
    for (elements, memory, expected_steps, steps, expected_kind) in [
        // Ten equal elements use wavenumbers, four use pairs.
        (10, AMPLE_MEMORY, 0, 50, HistoryMethod::Exponentials),
        (4, AMPLE_MEMORY, 0, 50, HistoryMethod::Exponentials),
        (10, SCARCE_MEMORY, 0, 20, HistoryMethod::RelaxedFft),
        // The poles depend on the expected steps, which are no part of the scene.
        (10, AMPLE_MEMORY, 1 << 30, 100, HistoryMethod::Exponentials),
    ] {
        let label = format!("{elements} elements, {memory} bytes, {expected_steps} steps expected");
        let mut uninterrupted_simulation =
            auto(elements, memory).expected_steps(expected_steps).build().unwrap();
        uninterrupted_simulation.run(steps, |_| {}).unwrap();
        assert_eq!(kind(&uninterrupted_simulation), expected_kind, "{label}");
        let checkpoint = through_text(&uninterrupted_simulation.checkpoint().unwrap());
        let later_states = states(&mut uninterrupted_simulation, 30);
        let new_simulation = auto(elements, memory).build().unwrap();
        let used_simulation = auto_run(elements, memory, steps + 10);
        for mut resumed in [new_simulation, used_simulation] {
            resumed.resume(&checkpoint).unwrap_or_else(|error| panic!("{label}: {error}"));
            assert_eq!(kind(&resumed), expected_kind, "{label}");
            assert_eq!(resumed.checkpoint().unwrap(), checkpoint, "{label}");
            assert_eq!(states(&mut resumed, 30)[1..], later_states[1..], "{label}");
        }
    }
}

/// GOAL: exponentials differ from the exact history by rounding.
/// SCENE: a block that uplifts and slides, by wavenumbers and by pairs.
#[test]
fn exponentials_differ_by_rounding() {
    for elements in [4, 10] {
        let by_transforms = run_in_parts(elements, HistoryMethod::RelaxedFft, &[300], 0);
        let by_exponentials = run_in_parts(elements, HistoryMethod::Auto, &[300], 0);
        assert_eq!(kind(&by_exponentials), HistoryMethod::Exponentials);
        let bound = by_exponentials.ground().description().history.unwrap().error_bound;
        assert!(bound > 0.0 && bound <= 1e-12, "{bound:e}");
        let expected = by_transforms.state();
        let computed = by_exponentials.state();
        assert_eq!(expected.modes, computed.modes);
        let weight: f64 = expected.normal_force;
        for (expected, computed) in [
            (expected.base_shear, computed.base_shear),
            (expected.base_moment, computed.base_moment),
            (expected.normal_force, computed.normal_force),
        ] {
            assert!(
                (expected - computed).abs() < 1e-9 * weight,
                "{elements}: {expected} {computed}"
            );
        }
        assert!((expected.mean_slip - computed.mean_slip).abs() < 1e-9 * expected.mean_slip.abs());
        assert!(computed.energy_balance.soil_error_bound > 0.0);
    }
}

/// A simulation after runs of so many steps each, with a total number of steps that it expects.
fn run_in_parts(
    elements: usize,
    method: HistoryMethod,
    parts: &[usize],
    expected_steps: usize,
) -> Simulation {
    let builder = with_history(elements, method).expected_steps(expected_steps);
    let mut simulation = builder.build().unwrap();
    for steps in parts {
        simulation.run(*steps, |_| {}).unwrap();
    }
    simulation
}

/// GOAL: neither the parts of a run nor its expected steps change its results.
/// SCENE: exponentials, and transforms by wavenumbers and by pairs; parts shorter and longer than their blocks.
#[test]
fn a_run_may_be_divided_anywhere() {
    for (elements, method) in [
        (4, HistoryMethod::Auto),
        (4, HistoryMethod::RelaxedFft),
        (10, HistoryMethod::Auto),
        (10, HistoryMethod::RelaxedFft),
    ] {
        let undivided_run = run_in_parts(elements, method, &[300], 0);
        let expected = undivided_run.state();
        let checkpoint = undivided_run.checkpoint().unwrap();
        let divisions: [&[usize]; 7] =
            [&[50, 250], &[64, 236], &[65, 235], &[1, 299], &[299, 1], &[30; 10], &[1; 300]];
        for parts in divisions {
            for expected_steps in [0, 40, 300, 1000] {
                let divided_run = run_in_parts(elements, method, parts, expected_steps);
                let label = format!("{elements} elements, {parts:?}, {expected_steps}");
                assert_eq!(divided_run.state(), expected, "{label}");
                assert_eq!(divided_run.checkpoint().unwrap(), checkpoint, "{label}");
            }
        }
        // Single steps do not tell the simulation their number.
        let mut stepped = run_in_parts(elements, method, &[], 0);
        for _ in 0..300 {
            stepped.step().unwrap();
        }
        assert_eq!(stepped.state(), expected, "{elements} elements");
        assert_eq!(stepped.ground().description().history.unwrap().steps, None);
        let mut resumed_simulation = run_in_parts(elements, method, &[20], 0);
        resumed_simulation.resume(&checkpoint).unwrap();
        assert_eq!(resumed_simulation.state().probes, expected.probes);
    }
}

/// A simulation resumes a checkpoint of the same scene after runs of any length.
#[test]
fn a_used_simulation_resumes_the_same_scene() {
    for (saved_steps, used_steps) in [(50, 300), (300, 50)] {
        let mut saved_simulation = auto_run(10, AMPLE_MEMORY, saved_steps);
        let mut used_simulation = auto_run(10, AMPLE_MEMORY, used_steps);
        used_simulation.resume(&saved_simulation.checkpoint().unwrap()).unwrap();
        assert_eq!(kind(&used_simulation), kind(&saved_simulation));
        assert_eq!(states(&mut used_simulation, 40)[1..], states(&mut saved_simulation, 40)[1..]);
    }
}

/// A block on this ground in coordinates that do not depend on the number of steps.
fn block_on(ground: ElasticGround) -> SimulationBuilder {
    let builder = scene(SI_UNITS, 0.6).interface(friction(0.3)).structure(block(SI_UNITS));
    builder.ground(ground).coordinates(Coordinates::Physical)
}

fn on_layers(memory: usize) -> SimulationBuilder {
    let profile = SoilProfile::on_rigid_bedrock().with_layer(soil(SI_UNITS), 6.0).unwrap();
    let ground = ElasticGround::new(profile, Strip::uniform(-2.0..2.0, 2).unwrap()).unwrap();
    block_on(ground.with_history(within(memory)).unwrap())
}

/// On a half-plane with a requested history.
fn on_half_plane(method: HistoryMethod, memory: usize) -> SimulationBuilder {
    block_on(half_plane(HistoryOptions { memory, ..HistoryOptions::from(method) }))
}

fn assert_memory_error(error: &Error, memory: usize) {
    let Error::Memory(MemoryError { needed, limit, .. }) = error else {
        panic!("{error}")
    };
    assert!(*limit == memory as f64 && needed > limit, "{needed}");
}

/// Checks that a step after the fiftieth returns an error for its memory, with its number.
fn assert_step_is_an_error(simulation: &mut Simulation, memory: usize) {
    let error = (50..400).find_map(|_| simulation.step().err()).unwrap();
    let Error::Step { step, source: StepError::Part { quantity, source: cause }, .. } = error
    else {
        panic!("{error}");
    };
    assert_eq!(quantity, "history of the ground");
    assert_memory_error(&cause, memory);
    let completed = simulation.state().step;
    assert!((64..400).contains(&completed) && step == completed + 1, "{step}");
}

/// GOAL: steps that need more memory than is allowed are errors, and a checkpoint resumes with more.
///
/// `build` and `run` with a number of steps return the error before the first step, `step` at the step that needs the
/// memory.
/// SCENE: histories that were requested and chosen; layers.
/// REFERENCE: the run with enough memory, to the bit.
#[test]
fn steps_beyond_the_memory_are_errors() {
    type LimitedScene = (usize, fn(usize) -> SimulationBuilder);
    let scenes: [LimitedScene; 3] = [
        (30_000, on_layers),
        (100_000, |memory| on_half_plane(HistoryMethod::RelaxedFft, memory)),
        (100_000, |memory| on_half_plane(HistoryMethod::Direct, memory)),
    ];
    for (number, (memory, builder)) in scenes.into_iter().enumerate() {
        let expected = states(&mut builder(AMPLE_MEMORY).build().unwrap(), 400);
        let error = builder(memory).expected_steps(400).build().err().unwrap();
        assert_memory_error(&error, memory);
        let mut limited = builder(memory).build().unwrap();
        assert_memory_error(&limited.run(400, |_| {}).unwrap_err(), memory);
        assert_eq!(limited.state().step, 0);
        limited.run(50, |_| {}).unwrap();
        assert_memory_error(&limited.run(350, |_| {}).unwrap_err(), memory);
        assert!(*limited.state() == expected[50], "{number}");
        assert_step_is_an_error(&mut limited, memory);
        let completed = limited.state().step;
        assert!(*limited.state() == expected[completed], "{number}");
        // Another attempt is an error, too.
        assert!(limited.step().is_err() && limited.state().step == completed);
        let mut resumed_simulation = builder(AMPLE_MEMORY).build().unwrap();
        resumed_simulation.resume(&limited.checkpoint().unwrap()).unwrap();
        resumed_simulation.run(400 - completed, |_| {}).unwrap();
        assert!(*resumed_simulation.state() == expected[400], "{number}");
    }
}

#[test]
fn another_kind_is_an_error_and_changes_nothing() {
    let transforms = auto_run(10, SCARCE_MEMORY, 50).checkpoint().unwrap();
    let exponentials = auto_run(10, AMPLE_MEMORY, 50).checkpoint().unwrap();
    let quantity = "kind of history";
    for (memory, checkpoint) in [(AMPLE_MEMORY, &transforms), (SCARCE_MEMORY, &exponentials)] {
        let mut simulation = auto(10, memory).build().unwrap();
        assert_eq!(
            resume_error(&mut simulation, checkpoint),
            CheckpointError::OtherScene { quantity }
        );
        simulation.run(50, |_| {}).unwrap();
        assert_eq!(
            resume_error(&mut simulation, checkpoint),
            CheckpointError::OtherScene { quantity }
        );
    }
}

/// Checks that a history returns an error for large counts of steps whose tractions are missing.
fn assert_counts_are_corrupt(history: &mut dyn ConvolutionHistory) {
    for steps in [1 << 40, 1 << 47, usize::MAX] {
        let error = history.restore(steps, &[0.0; 16]).unwrap_err();
        assert!(matches!(error, Error::Checkpoint(CheckpointError::Corrupt { .. })));
    }
}

#[test]
fn a_step_count_without_tractions_takes_no_memory() {
    // By pairs, and by wavenumbers.
    for count in [4, 10] {
        let elements = Strip::uniform(-2.0..2.0, count).unwrap().elements();
        let kernel: Arc<dyn ConvolutionWeights> =
            Arc::new(PatchKernel::new(soil(SI_UNITS), elements, 0.01).unwrap());
        assert_counts_are_corrupt(&mut DirectHistory::new(Arc::clone(&kernel)));
        assert_counts_are_corrupt(&mut RelaxedFftHistory::new(Arc::clone(&kernel)));
        assert_counts_are_corrupt(&mut ExponentialHistory::new(kernel, 1e-6).unwrap());
    }
}

/// Runs a block on a half-plane whose history has this tolerance.
fn run_with_tolerance(method: HistoryMethod, tolerance: f64) -> Run {
    let tolerance = Some(tolerance);
    let ground = half_plane(HistoryOptions { tolerance, ..HistoryOptions::from(method) });
    let builder = scene(SI_UNITS, 0.6).interface(friction(0.3)).structure(block(SI_UNITS));
    builder.ground(ground).build().unwrap().run(RUN_STEPS, |_| {}).unwrap()
}

#[test]
fn an_approximate_history_is_in_the_energy_balance() {
    let expected = run_with_tolerance(HistoryMethod::Direct, 1e-3);
    assert_eq!(expected.energy_balance.soil_error_bound, 0.0);
    let mut previous_bound = f64::INFINITY;
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let run = run_with_tolerance(HistoryMethod::Exponentials, tolerance);
        let bound = run.energy_balance.soil_error_bound;
        println!("{tolerance:e}: soil {:e} within {bound:e}", run.energy_balance.soil);
        assert!(bound > 0.0 && bound < 100.0 * tolerance * run.energy_balance.soil);
        assert!(bound < 0.1 * previous_bound);
        assert!(run.energy_error < 1e-10, "{:e}", run.energy_error);
        assert!(run.to_string().contains("soil within"));
        previous_bound = bound;
    }
}
