//! GOAL: one summary, however a run is made; an observer may say nothing, stop or fail.
//! SCENE: a block that rocks and slides under El Centro.
//! REFERENCE: the same steps by `Simulation::run`; the states.

use std::ops::ControlFlow::{Break, Continue};

use basemat::coupled::{State, Warning};
use basemat::results::Run;
use basemat::results::{Comparison, Recorder};
use basemat::{Error, Simulation};

use basemat_problems::scenes::{SI, block, friction, scene};

const STEPS: usize = 300;

fn simulation() -> Simulation {
    scene(SI, 0.6).structure(block(SI)).interface(friction(0.35)).build().unwrap()
}

/// All that a run says, to the last bit, but its wall time.
fn told(mut run: Run) -> String {
    // The end is judged where a run was given its steps, and not in a loop of one's own.
    let at_end =
        |own: &Warning| matches!(own, Warning::PeakAtEnd { .. } | Warning::EndsEarly { .. });
    run.warnings.retain(|own| !at_end(own));
    let page = run.to_string();
    let page: Vec<&str> = page.lines().filter(|line| !line.starts_with("Time taken")).collect();
    let (page, fields) =
        (page.join("\n"), (run.trials, run.fallbacks, run.energy_balance, run.warnings.clone()));
    let parts = (
        run.envelope.clone(),
        run.foundations.clone(),
        run.whole.sliding.clone(),
        run.whole.uplift,
    );
    let mut table = Comparison::default();
    table.add("run", run);
    format!("{page}\n{fields:?}\n{parts:?}\n{}", table.csv())
}

#[test]
fn all_ways_to_run_tell_the_same() {
    let mut whole = simulation();
    let run = whole.run(STEPS, |_| {}).unwrap();
    assert!(run.steps == STEPS && run.mode_changes > 10 && !run.whole.sliding.events.is_empty());
    assert_eq!((run.start, run.end), (0.0, whole.state().time));
    let expected = told(run);

    let mut stepped = simulation();
    let mut run = stepped.begin_run();
    for _ in 0..STEPS {
        run.record(stepped.step().unwrap());
    }
    assert_eq!(told(stepped.end_run(run)), expected);

    // In parts, the run as an observer of them; the histories beside it.
    let mut parts = simulation();
    let (mut run, mut time_series) = (parts.begin_run(), Recorder::new().start(&parts).unwrap());
    for steps in [1, 120, STEPS - 121] {
        let part = parts.run(steps, |state| {
            run.record(state);
            time_series.record(state).unwrap();
        });
        assert_eq!(part.unwrap().steps, steps);
    }
    assert_eq!(told(parts.end_run(run)), expected);
    assert_eq!(time_series.times().len(), STEPS + 1);
}

#[test]
fn observers_stop_and_fail() {
    let uplifted = |state: &State| state.uplifted_fraction > 0.0;
    let mut stopped = simulation();
    let run =
        stopped.run(STEPS, |state| if uplifted(state) { Break(()) } else { Continue(()) }).unwrap();
    assert!(run.steps > 0 && run.steps < STEPS && run.whole.uplift.count == 1);
    assert!(uplifted(stopped.state()));

    // The error is the observer's own; what was seen before it is not lost.
    let full = || Error::part("disk", "is full");
    let mut failed = simulation();
    let mut seen = failed.begin_run();
    let refused = failed.run(STEPS, |state| {
        seen.record(state);
        if uplifted(state) { Err(full()) } else { Ok(()) }
    });
    assert_eq!(refused.unwrap_err(), full());
    assert_eq!(failed.state(), stopped.state());
    assert_eq!(told(failed.end_run(seen)), told(run));

    // Both at once.
    let mut both = simulation();
    let run = both.run(STEPS, |state| {
        if state.time < 0.0 {
            return Err(full());
        }
        Ok(if uplifted(state) { Break(()) } else { Continue(()) })
    });
    assert_eq!(run.unwrap().end, stopped.state().time);
}

#[test]
fn a_page_names_the_methods_that_were_fallen_back_on() {
    let mut run = simulation().run(10, |_| {}).unwrap();
    let line = "Fallbacks of the search for contact modes: ";
    run.fallbacks = basemat::results::Fallbacks::default();
    assert!(!run.to_string().contains(line), "{run}");
    (run.fallbacks.gauss_seidel, run.fallbacks.path) = (133, 2);
    let both = format!("\n{line}133 steps by Gauss–Seidel, 2 steps by path following");
    assert!(run.to_string().contains(&both), "{run}");
}
