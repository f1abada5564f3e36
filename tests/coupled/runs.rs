//! GOAL: a run has the same summary in whatever way it is made; an observer may stop or fail it.
//! SCENE: a block that rocks and slides under two pulses.
//! REFERENCE: the same steps by `Simulation::run`; the states.

use std::ops::ControlFlow::{self, Break, Continue};

use basemat::coupled::{State, Warning};
use basemat::results::Run;
use basemat::results::{Comparison, Recorder};
use basemat::{Error, Simulation};

use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

const RUN_STEPS: usize = 300;

fn rocking_block() -> Simulation {
    scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(0.35))
        .build()
        .unwrap()
}

/// Full summary of a run to the last bit, without its wall time.
fn summary(mut run: Run) -> String {
    // Only a run of a known number of steps has warnings of its end.
    run.warnings.retain(|warning| {
        !matches!(warning, Warning::PeakAtEnd { .. } | Warning::EndsEarly { .. })
    });
    let page = run.to_string();
    let page: Vec<&str> = page.lines().filter(|line| !line.starts_with("Time taken")).collect();
    let page = page.join("\n");
    let fields = (run.trials, run.fallbacks, run.energy_balance, run.warnings.clone());
    let contact = (
        run.envelope.clone(),
        run.foundations.clone(),
        run.whole.sliding.clone(),
        run.whole.uplift,
    );
    let mut table = Comparison::default();
    table.add("run", run);
    format!("{page}\n{fields:?}\n{contact:?}\n{}", table.csv())
}

#[test]
fn all_ways_to_run_have_the_same_summary() {
    let mut whole = rocking_block();
    let run = whole.run(RUN_STEPS, |_| {}).unwrap();
    assert_eq!(run.steps, RUN_STEPS);
    assert!(run.mode_changes > 10 && !run.whole.sliding.events.is_empty());
    assert_eq!((run.start, run.end), (0.0, whole.state().time));
    let expected = summary(run);

    let mut stepped = rocking_block();
    let mut run = stepped.begin_run();
    for _ in 0..RUN_STEPS {
        run.record(stepped.step().unwrap());
    }
    assert_eq!(summary(stepped.end_run(run)), expected);

    // A run in parts, of which run and time series record all states.
    let mut parts = rocking_block();
    let mut run = parts.begin_run();
    let mut time_series = Recorder::new().start(&parts).unwrap();
    for steps in [1, 120, RUN_STEPS - 121] {
        let part = parts.run(steps, |state| {
            run.record(state);
            time_series.record(state).unwrap();
        });
        assert_eq!(part.unwrap().steps, steps);
    }
    assert_eq!(summary(parts.end_run(run)), expected);
    assert_eq!(time_series.times().len(), RUN_STEPS + 1);
}

fn is_uplifted(state: &State) -> bool {
    state.uplifted_fraction > 0.0
}

fn break_at_uplift(state: &State) -> ControlFlow<()> {
    if is_uplifted(state) { Break(()) } else { Continue(()) }
}

fn disk_full() -> Error {
    Error::part("disk", "is full")
}

#[test]
fn observers_stop_and_fail() {
    let mut stopped_simulation = rocking_block();
    let run = stopped_simulation.run(RUN_STEPS, break_at_uplift).unwrap();
    assert!(run.steps > 0 && run.steps < RUN_STEPS && run.whole.uplift.count == 1);
    assert!(is_uplifted(stopped_simulation.state()));

    // The run returns the observer's error and keeps the steps before it.
    let mut failed_simulation = rocking_block();
    let mut steps_before = failed_simulation.begin_run();
    let result = failed_simulation.run(RUN_STEPS, |state| {
        steps_before.record(state);
        if is_uplifted(state) { Err(disk_full()) } else { Ok(()) }
    });
    assert_eq!(result.unwrap_err(), disk_full());
    assert_eq!(failed_simulation.state(), stopped_simulation.state());
    assert_eq!(summary(failed_simulation.end_run(steps_before)), summary(run));

    // An observer may both stop and fail the run.
    let mut simulation_with_both = rocking_block();
    let run = simulation_with_both.run(RUN_STEPS, |state| {
        if state.time < 0.0 {
            return Err(disk_full());
        }
        Ok(break_at_uplift(state))
    });
    assert_eq!(run.unwrap().end, stopped_simulation.state().time);
}

#[test]
fn a_page_names_the_methods_that_were_fallen_back_on() {
    let mut run = rocking_block().run(10, |_| {}).unwrap();
    let line = "Fallbacks of the search for contact modes: ";
    run.fallbacks = basemat::results::Fallbacks::default();
    assert!(!run.to_string().contains(line), "{run}");
    run.fallbacks.gauss_seidel = 133;
    run.fallbacks.path = 2;
    let both = format!("\n{line}133 steps by Gauss–Seidel, 2 steps by path following");
    assert!(run.to_string().contains(&both), "{run}");
}
