//! GOAL: events inside a step converge as the step shrinks.
//! SCENE: a block on springs and on the half-plane: the whole base lifts off and lands; slip
//! reverses in all elements at once; impacts follow each other ever faster.
//! REFERENCE: the next finer run, and rest at the end.

use basemat::Simulation;
use basemat::bem::{Grading, SpringGround};
use basemat::coupled::{SimulationBuilder, Transition};
use basemat::interface::Mode;
use basemat::motion::FreeFieldFn;
use basemat::results::Run;
use basemat::structure::RigidBlock;

use basemat_problems::scenes::{GRAVITY, SI, friction, ground};

/// Samples are compared at multiples of this, s.
const SAMPLE: f64 = 4e-3;
const ELEMENTS: usize = 6;

/// Displacements `[along, up]` and rotation of the base at the samples, and the run.
struct Outcome {
    history: Vec<[f64; 3]>,
    run: Run,
    /// Steps in which all elements changed their mode.
    at_once: usize,
    all_open: bool,
    transitions: Vec<Transition>,
}

fn block(height: f64) -> RigidBlock {
    RigidBlock::new(4.0, height, 1500.0).unwrap()
}

fn bed() -> SpringGround {
    let bed = SpringGround::new(-2.0..2.0, ELEMENTS, 4e7, 3e7).unwrap();
    bed.with_dashpots(3e5, 2e5).unwrap()
}

/// Runs a scene with the step SAMPLE / `parts` for `duration` seconds.
fn outcome(builder: SimulationBuilder, parts: usize, duration: f64) -> Outcome {
    let mut simulation = builder.gravity(GRAVITY).build().unwrap();
    let (mut history, mut at_once, mut all_open, mut transitions) = (Vec::new(), 0, false, vec![]);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
    let samples = (duration / SAMPLE).round() as usize;
    let run = simulation
        .run(samples * parts, |state| {
            if state.step % parts == 0 {
                let u = state.absolute_displacement();
                history.push([u[0], u[1], u[2]]);
            }
            transitions.extend_from_slice(&state.transitions);
            at_once += usize::from(state.transitions.len() == state.modes.len());
            all_open |= state.modes.iter().all(|mode| *mode == Mode::Open);
        })
        .unwrap();
    let opened = transitions.iter().filter(|change| change.to == Mode::Open).count();
    let closed = transitions.iter().filter(|change| change.from == Mode::Open).count();
    assert_eq!(
        [run.mode_changes, run.debondings, run.rebondings],
        [transitions.len(), opened, closed]
    );
    Outcome { history, run, at_once, all_open, transitions }
}

/// Runs with ever shorter steps; returns them and the largest differences between neighbours,
/// relative to the largest displacement.
fn refine(
    name: &str,
    parts: &[usize],
    duration: f64,
    scene: impl Fn(f64) -> SimulationBuilder,
) -> (Vec<Outcome>, Vec<f64>) {
    let runs: Vec<Outcome> =
        parts.iter().map(|&k| outcome(scene(SAMPLE / k as f64), k, duration)).collect();
    // Rotations as displacements of the base's ends.
    let unit = |h: &[f64; 3]| [h[0], h[1], 2.0 * h[2]];
    let all = |o: &Outcome| o.history.iter().flat_map(unit).collect::<Vec<_>>();
    let scale = all(&runs[runs.len() - 1]).iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    let apart: Vec<f64> = runs
        .windows(2)
        .map(|pair| {
            let (a, b) = (all(&pair[0]), all(&pair[1]));
            a.iter().zip(&b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / scale
        })
        .collect();
    for run in &runs {
        let Run { mode_changes, trials, steps, fallbacks, energy_error, .. } = &run.run;
        println!(
            "{name}: {steps} steps, {trials} solves, fallbacks {fallbacks:?}, {mode_changes} changes, {} at once, energy balance {energy_error:.1e}",
            run.at_once
        );
        assert!(*energy_error < 1e-9, "{name}");
        // Contact is found by a few solves a step, whatever happens in it.
        assert!(*trials < 3 * steps, "{name}");
    }
    println!("{name}: {apart:?}");
    (runs, apart)
}

/// The last differences shrink in proportion to the step or faster, within what a landing that
/// falls on either side of a step's end does.
fn assert_converging(name: &str, apart: &[f64], finest: f64) {
    let last = apart[apart.len() - 1];
    let first = apart[0];
    let halvings = i32::try_from(apart.len() - 1).unwrap();
    assert!(last < first * 0.7_f64.powi(halvings), "{name}: {apart:?}");
    assert!(last < finest, "{name}: {apart:?}");
}

/// The ground rises by `rise` (m) within about 2 `width` (s), and stops.
fn thrown(rise: f64, width: f64) -> FreeFieldFn {
    let up = move |t: f64| 0.5 * rise * (((t - 4.0 * width) / width).tanh() + 4.0_f64.tanh());
    FreeFieldFn::new(move |_, t| [0.0, up(t) - up(0.0)])
}

#[test]
fn whole_base_lifts_off_and_lands() {
    let scene = |time_step: f64| {
        Simulation::builder(time_step)
            .structure(block(3.0))
            .interface(friction(0.5))
            .motion(thrown(0.12, 0.04))
    };
    let parts = [1, 2, 4, 8];
    let (runs, apart) = refine("spring bed", &parts, 0.8, |step| scene(step).ground(bed()));
    assert_converging("spring bed", &apart, 0.01);
    for run in &runs {
        // All elements are alike here: they open in one step, and land in one.
        assert!(run.all_open && run.at_once >= 2, "{}", run.at_once);
    }
    let half_plane = |step| scene(step).ground(ground(SI, ELEMENTS, Grading::Cosine));
    let (runs, apart) = refine("half-plane", &parts, 0.8, half_plane);
    assert_converging("half-plane", &apart, 0.01);
    for run in &runs {
        let back = run.run.rebondings;
        assert!(run.all_open && back >= ELEMENTS, "{back}");
    }
}

#[test]
fn slip_reverses_in_all_elements() {
    let scene = |time_step: f64| {
        let sway = |t: f64| 0.03 * (1.0 - (18.0 * t).cos());
        let motion = FreeFieldFn::new(move |_, t| [sway(t), 0.0]);
        Simulation::builder(time_step)
            .structure(block(1.0))
            .interface(friction(0.25))
            .motion(motion)
    };
    let reversals = |run: &Outcome| {
        let turns = |a: Mode, b: Mode| a.is_slip() && b.is_slip() && a != b;
        run.transitions.iter().filter(|change| turns(change.from, change.to)).count()
    };
    let parts = [1, 2, 4, 8];
    let (runs, apart) = refine("spring bed", &parts, 1.2, |step| scene(step).ground(bed()));
    assert_converging("spring bed", &apart, 0.01);
    println!("{:?} reversals within a step", runs.iter().map(reversals).collect::<Vec<_>>());
    assert!(reversals(&runs[0]) >= ELEMENTS && runs.iter().all(|run| run.at_once > 0));
    let half_plane = |step| scene(step).ground(ground(SI, ELEMENTS, Grading::Cosine));
    let (runs, apart) = refine("half-plane", &parts, 1.2, half_plane);
    assert_converging("half-plane", &apart, 0.01);
    assert!(runs.iter().all(|run| run.run.whole.residual_slip != 0.0));
}

/// A slender block that was pushed rocks to rest, its impacts following each other ever faster.
#[test]
fn impacts_that_accumulate_end_at_rest() {
    let scene = |time_step: f64| {
        let push = |t: f64| 0.06 * (-((t - 0.2) / 0.06).powi(2)).exp();
        let motion = FreeFieldFn::new(move |_, t| [push(t) - push(0.0), 0.0]);
        Simulation::builder(time_step).structure(block(8.0)).interface(friction(0.8)).motion(motion)
    };
    let stiff = || {
        let bed = SpringGround::new(-2.0..2.0, ELEMENTS, 1e9, 7e8).unwrap();
        bed.with_dashpots(3e6, 2e6).unwrap()
    };
    let (runs, apart) = refine("stiff bed", &[1, 2, 4, 8], 5.0, |step| scene(step).ground(stiff()));
    assert_converging("stiff bed", &apart, 0.1);
    for run in &runs {
        let peak = run.history.iter().fold(0.0_f64, |m, u| m.max(u[2].abs()));
        let end =
            run.history[run.history.len() - 100..].iter().fold(0.0_f64, |m, u| m.max(u[2].abs()));
        println!("rotation {peak:e} at most, {end:e} at the end");
        assert!(end < 0.02 * peak);
    }
}
