//! GOAL: results with events inside a step converge as the step is reduced.
//! SCENE: a block on springs and on the half-plane: the whole base lifts off and lands; slip reverses in all elements at
//! once; impacts follow each other at decreasing intervals.
//! REFERENCE: the next finer run, and rest at the end.

use basemat::Simulation;
use basemat::bem::{Grading, SpringGround};
use basemat::coupled::{SimulationBuilder, State, Transition};
use basemat::interface::Mode;
use basemat::motion::FreeFieldFn;
use basemat::results::Run;
use basemat::structure::RigidBlock;

use basemat_problems::scenes::{SCENE_GRAVITY, SI_UNITS, friction, ground};

/// Interval of the samples that are compared, s.
const SAMPLE_INTERVAL: f64 = 4e-3;
const ELEMENT_COUNT: usize = 6;
/// Numbers of steps per sample in the runs that are compared.
const STEPS_PER_SAMPLE: [usize; 4] = [1, 2, 4, 8];

/// A run and its events.
#[derive(Default)]
struct SampledRun {
    /// Displacements to the right and up, and rotation of the base, at the samples.
    samples: Vec<[f64; 3]>,
    /// Steps in which all elements changed their mode.
    simultaneous_changes: usize,
    was_fully_open: bool,
    transitions: Vec<Transition>,
}

impl SampledRun {
    /// Records a state, the last of every `steps_per_sample`.
    fn record(&mut self, state: &State, steps_per_sample: usize) {
        if state.step.is_multiple_of(steps_per_sample) {
            let u = state.absolute_displacement();
            self.samples.push([u[0], u[1], u[2]]);
        }
        self.transitions.extend_from_slice(&state.transitions);
        self.simultaneous_changes += usize::from(state.transitions.len() == state.modes.len());
        self.was_fully_open |= state.modes.iter().all(|mode| *mode == Mode::Open);
    }

    /// Number of reversals of slip within a step.
    fn reversals(&self) -> usize {
        let changes = self.transitions.iter();
        changes.filter(|change| is_reversal(change)).count()
    }

    /// Displacements of the base at all samples, with rotations as displacements of its ends.
    fn displacements(&self) -> Vec<f64> {
        self.samples
            .iter()
            .flat_map(|motion| [motion[0], motion[1], 2.0 * motion[2]])
            .collect()
    }
}

fn is_reversal(change: &Transition) -> bool {
    change.from.is_slip() && change.to.is_slip() && change.from != change.to
}

fn block(height: f64) -> RigidBlock {
    RigidBlock::new(4.0, height, 1500.0).unwrap()
}

fn springs() -> SpringGround {
    let springs = SpringGround::new(-2.0..2.0, ELEMENT_COUNT, 4e7, 3e7).unwrap();
    springs.with_dashpots(3e5, 2e5).unwrap()
}

fn on_half_plane(builder: SimulationBuilder) -> SimulationBuilder {
    builder.ground(ground(SI_UNITS, ELEMENT_COUNT, Grading::Cosine))
}

/// Runs a scene for `duration` seconds.
fn sampled_run(
    builder: SimulationBuilder,
    steps_per_sample: usize,
    duration: f64,
) -> (SampledRun, Run) {
    let mut simulation = builder.gravity(SCENE_GRAVITY).build().unwrap();
    let mut sampled_run = SampledRun::default();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
    let samples = (duration / SAMPLE_INTERVAL).round() as usize;
    let run = simulation
        .run(samples * steps_per_sample, |state| sampled_run.record(state, steps_per_sample))
        .unwrap();
    let changes = &sampled_run.transitions;
    let opened_count = changes.iter().filter(|change| change.to == Mode::Open).count();
    let closed_count = changes.iter().filter(|change| change.from == Mode::Open).count();
    let counts = [run.mode_changes, run.debondings, run.rebondings];
    assert_eq!(counts, [changes.len(), opened_count, closed_count]);
    (sampled_run, run)
}

/// Runs with decreasing steps.
struct RefinedRuns {
    sampled_runs: Vec<SampledRun>,
    runs: Vec<Run>,
    /// Largest differences between successive runs, relative to the largest displacement.
    differences: Vec<f64>,
}

fn refined_runs(
    name: &str,
    duration: f64,
    scene: impl Fn(f64) -> SimulationBuilder,
) -> RefinedRuns {
    let mut sampled_runs = Vec::new();
    let mut runs = Vec::new();
    for steps_per_sample in STEPS_PER_SAMPLE {
        let builder = scene(SAMPLE_INTERVAL / steps_per_sample as f64);
        let (sampled_run, run) = sampled_run(builder, steps_per_sample, duration);
        let Run { mode_changes, trials, steps, fallbacks, energy_error, .. } = &run;
        println!(
            "{name}: {steps} steps, {trials} solves, fallbacks {fallbacks:?}, {mode_changes} changes, {} common, energy error {energy_error:.1e}",
            sampled_run.simultaneous_changes
        );
        assert!(*energy_error < 1e-9, "{name}");
        // A few solves a step find the contact during any event.
        assert!(*trials < 3 * steps, "{name}");
        sampled_runs.push(sampled_run);
        runs.push(run);
    }
    let displacements: Vec<Vec<f64>> = sampled_runs.iter().map(SampledRun::displacements).collect();
    let scale = largest_absolute(displacements[displacements.len() - 1].iter().copied());
    let differences = displacements
        .windows(2)
        .map(|pair| largest_absolute(pair[0].iter().zip(&pair[1]).map(|(a, b)| a - b)) / scale)
        .collect();
    println!("{name}: {differences:?}");
    RefinedRuns { sampled_runs, runs, differences }
}

fn largest_absolute(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0_f64, |largest, value| largest.max(value.abs()))
}

/// Checks that halving the step multiplies differences by less than 0.7 on average, and that the last is small.
///
/// They do not decrease in exact proportion to the step, since a landing may fall on either side of a step's end.
fn assert_converging(name: &str, differences: &[f64], max_last: f64) {
    let last_difference = differences[differences.len() - 1];
    let first = differences[0];
    let halvings = i32::try_from(differences.len() - 1).unwrap();
    assert!(last_difference < first * 0.7_f64.powi(halvings), "{name}: {differences:?}");
    assert!(last_difference < max_last, "{name}: {differences:?}");
}

/// A low block on ground that rises by 0.12 m within about 80 ms, and stops.
fn thrown_block(time_step: f64) -> SimulationBuilder {
    fn rise(time: f64) -> f64 {
        let width = 0.04;
        0.5 * 0.12 * (((time - 4.0 * width) / width).tanh() + 4.0_f64.tanh())
    }

    let motion = FreeFieldFn::new(|_, t| [0.0, rise(t) - rise(0.0)]);
    Simulation::builder(time_step)
        .structure(block(3.0))
        .interface(friction(0.5))
        .motion(motion)
}

#[test]
fn whole_base_lifts_off_and_lands() {
    let on_springs = refined_runs("springs", 0.8, |step| thrown_block(step).ground(springs()));
    assert_converging("springs", &on_springs.differences, 0.01);
    for run in &on_springs.sampled_runs {
        // All elements are equal here: they open in one step, and land in one.
        assert!(
            run.was_fully_open && run.simultaneous_changes >= 2,
            "{}",
            run.simultaneous_changes
        );
    }
    let on_soil = refined_runs("half-plane", 0.8, |step| on_half_plane(thrown_block(step)));
    assert_converging("half-plane", &on_soil.differences, 0.01);
    for (sampled, run) in on_soil.sampled_runs.iter().zip(&on_soil.runs) {
        assert!(sampled.was_fully_open && run.rebondings >= ELEMENT_COUNT, "{}", run.rebondings);
    }
}

/// A flat block on ground that sways harmonically.
fn swaying_block(time_step: f64) -> SimulationBuilder {
    let motion = FreeFieldFn::new(|_, t: f64| [0.03 * (1.0 - (18.0 * t).cos()), 0.0]);
    Simulation::builder(time_step)
        .structure(block(1.0))
        .interface(friction(0.25))
        .motion(motion)
}

#[test]
fn slip_reverses_in_all_elements() {
    let on_springs = refined_runs("springs", 1.2, |step| swaying_block(step).ground(springs()));
    assert_converging("springs", &on_springs.differences, 0.01);
    let reversals: Vec<_> = on_springs.sampled_runs.iter().map(SampledRun::reversals).collect();
    println!("{reversals:?} reversals within a step");
    assert!(reversals[0] >= ELEMENT_COUNT);
    assert!(on_springs.sampled_runs.iter().all(|run| run.simultaneous_changes > 0));
    let on_soil = refined_runs("half-plane", 1.2, |step| on_half_plane(swaying_block(step)));
    assert_converging("half-plane", &on_soil.differences, 0.01);
    assert!(on_soil.runs.iter().all(|run| run.whole.residual_slip != 0.0));
}

/// A slender block on stiff springs that is pushed once.
fn rocking_block(time_step: f64) -> SimulationBuilder {
    fn push(time: f64) -> f64 {
        0.06 * (-((time - 0.2) / 0.06).powi(2)).exp()
    }

    let stiff_springs = SpringGround::new(-2.0..2.0, ELEMENT_COUNT, 1e9, 7e8).unwrap();
    Simulation::builder(time_step)
        .structure(block(8.0))
        .interface(friction(0.8))
        .motion(FreeFieldFn::new(|_, t| [push(t) - push(0.0), 0.0]))
        .ground(stiff_springs.with_dashpots(3e6, 2e6).unwrap())
}

/// A slender block rocks to rest with impacts at decreasing intervals.
#[test]
fn impacts_that_accumulate_end_at_rest() {
    let refined = refined_runs("stiff springs", 5.0, rocking_block);
    assert_converging("stiff springs", &refined.differences, 0.1);
    for run in &refined.sampled_runs {
        let peak = largest_absolute(run.samples.iter().map(|motion| motion[2]));
        let last_samples = &run.samples[run.samples.len() - 100..];
        let end = largest_absolute(last_samples.iter().map(|motion| motion[2]));
        println!("largest rotation {peak:e}, {end:e} at the end");
        assert!(end < 0.02 * peak);
    }
}
