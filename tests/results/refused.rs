//! GOAL: requests that cannot be met are typed errors, and states that do not fit are not recorded.
//! SCENE: a recorder that misses steps, bad numbers, states of another scene.
//! REFERENCE: the error; the series as they were.

use basemat::Error;
use basemat::coupled::State;
use basemat::results::{Recorder, Run, TimeSeries, log_spaced};

use super::simulation;

fn record(state: &State, time_series: &mut TimeSeries, run: &mut Run) {
    time_series.record(state).unwrap();
    run.record(state);
}

#[test]
fn invalid_requests_are_errors() {
    // The series of a loop that leaves steps out has no spectrum.
    let mut skipping = simulation();
    let mut time_series = Recorder::new().start(&skipping).unwrap();
    for step in 0..200 {
        let state = skipping.step().unwrap();
        if step % 2 == 1 {
            time_series.record(state).unwrap();
        }
    }
    let spectrum = time_series.floor_spectrum("top acceleration", &[0.1, 0.2], 0.05);
    assert!(matches!(spectrum, Err(Error::Scene { .. })));

    let mut simulation = simulation();
    for recorder in
        [Recorder::new().every(0), Recorder::new().contact(0), Recorder::new().motion(0)]
    {
        assert!(matches!(recorder.start(&simulation), Err(Error::Input { .. })));
    }
    let mut time_series = Recorder::new().start(&simulation).unwrap();
    let mut run = simulation.begin_run();
    let known_names = ["top", "top acceleration"].map(str::to_owned).into();
    assert_eq!(
        time_series.probe("nobody"),
        Err(Error::Name { quantity: "probe", name: "nobody".to_owned(), known: known_names })
    );
    assert!(time_series.floor_spectrum("nobody", &[1.0], 0.05).is_err());
    assert!(time_series.floor_spectrum("top", &[1.0], 0.05).is_err());
    // Only the initial state is recorded: one sample is not a record.
    assert!(time_series.floor_spectrum("top acceleration", &[1.0], 0.05).is_err());
    for invalid_value in [[0.0, 1.0], [1.0, f64::NAN], [f64::INFINITY, 1.0]] {
        assert!(log_spaced(invalid_value[0], invalid_value[1], 5).is_err());
    }
    assert!(log_spaced(1.0, 2.0, 1).is_err() && log_spaced(1.0, 2.0, usize::MAX).is_err());
    // The same state twice, and one of another scene.
    let state = simulation.step().unwrap().clone();
    record(&state, &mut time_series, &mut run);
    record(&state, &mut time_series, &mut run);
    let mut wrong_state = state.clone();
    wrong_state.time += 1.0;
    wrong_state.contact.pop();
    record(&wrong_state, &mut time_series, &mut run);
    // States that a caller has damaged.
    let damage: [&dyn Fn(&mut State); 3] = [
        &|state| state.foundations[0].elements = 0..100,
        &|state| state.foundations.clear(),
        &|state| state.modes.truncate(1),
    ];
    for damage in damage {
        let mut wrong_state = state.clone();
        wrong_state.time += 1.0;
        damage(&mut wrong_state);
        record(&wrong_state, &mut time_series, &mut run);
    }
    assert_eq!(time_series.times().len(), 2);
    assert_eq!((run.steps, run.end), (1, state.time));
}

/// States of another simulation of the same sizes are not recorded.
#[test]
fn states_of_another_simulation_are_ignored() {
    let mut first = simulation();
    let mut second = simulation();
    let mut time_series = Recorder::new().start(&first).unwrap();
    let mut run = first.begin_run();
    let foreign_state = second.step().unwrap();
    time_series.record(foreign_state).unwrap();
    run.record(foreign_state);
    assert_eq!((time_series.times(), run.steps), (&[0.0][..], 0));
    let state = first.step().unwrap();
    time_series.record(state).unwrap();
    run.record(state);
    assert_eq!((time_series.times(), run.steps), (&[0.0, first.time_step()][..], 1));
}

/// Time series and snapshots that exceed the limit of memory are an error before the run.
///
/// The error names the memory that they would need: the memory of one recorded step for each step.
#[test]
fn time_series_beyond_the_limit_of_memory_are_an_error() {
    let mut simulation = simulation();
    let mut series = Recorder::new().contact(1).motion(1).start(&simulation).unwrap();
    let start = series.bytes() as f64;
    let errors = [usize::MAX, 1_000_000_000].map(|steps| match series.reserve(steps) {
        Err(Error::Memory(error)) => error,
        other => panic!("{steps} steps: {other:?}"),
    });
    series.reserve(5).unwrap();
    series.record(simulation.step().unwrap()).unwrap();
    let step = series.bytes() as f64 - start;
    for error in errors {
        assert!((error.needed / (start + step * error.asked) - 1.0).abs() < 1e-12);
        assert_eq!(error.limit, basemat::memory_limit() as f64);
        assert!(error.to_string().starts_with("steps with time series and snapshots: "), "{error}");
    }
    // Frames that are seldom kept fit where all steps do not.
    let time_series_of_few_frames =
        Recorder::new().every(1_000_000).motion(1_000_000).start(&simulation);
    time_series_of_few_frames.unwrap().reserve(1_000_000_000).unwrap();
}
