//! GOAL: requests that cannot be met are typed errors, and states that do not fit are not recorded.
//! SCENE: a recorder that misses steps, bad numbers, states of another scene.
//! REFERENCE: the error; the series as they were.

use basemat::Error;
use basemat::coupled::State;
use basemat::results::{Recorder, log_spaced};

use super::simulation;

#[test]
fn bad_requests_are_errors() {
    // A loop of one's own that forgets steps has no spectrum.
    let mut forgetful = simulation();
    let mut histories = Recorder::new().start(&forgetful).unwrap();
    histories.reserve(usize::MAX);
    for step in 0..200 {
        let state = forgetful.step().unwrap();
        if step % 2 == 1 {
            histories.record(state);
        }
    }
    let spectrum = histories.floor_spectrum("top acceleration", &[0.1, 0.2], 0.05);
    assert!(matches!(spectrum, Err(Error::Scene { .. })));

    let mut simulation = simulation();
    let start = |recorder: Recorder| recorder.start(&simulation);
    for coefficient in [-0.1, f64::NAN, f64::NEG_INFINITY] {
        let fault = start(Recorder::new().friction(coefficient));
        assert!(matches!(fault, Err(Error::Input { .. })));
    }
    assert!(start(Recorder::new().friction(f64::INFINITY)).is_ok());
    let fault = start(Recorder::new().frictions(vec![0.4; 3]));
    assert!(matches!(fault, Err(Error::Size { found: 3, .. })));
    for recorder in
        [Recorder::new().every(0), Recorder::new().contact(0), Recorder::new().motion(0)]
    {
        assert!(matches!(start(recorder), Err(Error::Input { .. })));
    }
    let mut histories = start(Recorder::new()).unwrap();
    assert_eq!(
        histories.probe("nobody"),
        Err(Error::Name { quantity: "probe", name: "nobody".to_owned() })
    );
    assert!(histories.floor_spectrum("nobody", &[1.0], 0.05).is_err());
    assert!(histories.floor_spectrum("top", &[1.0], 0.05).is_err());
    // Nothing recorded yet: one sample is no record.
    assert!(histories.floor_spectrum("top acceleration", &[1.0], 0.05).is_err());
    for bad in [[0.0, 1.0], [1.0, f64::NAN], [f64::INFINITY, 1.0]] {
        assert!(log_spaced(bad[0], bad[1], 5).is_err());
    }
    assert!(log_spaced(1.0, 2.0, 1).is_err() && log_spaced(1.0, 2.0, usize::MAX).is_err());
    // The same state twice, and one of another scene.
    let state = simulation.step().unwrap().clone();
    histories.record(&state);
    histories.record(&state);
    let mut other = state.clone();
    other.time += 1.0;
    other.contact.pop();
    histories.record(&other);
    // Those that somebody has meddled with.
    let spoil: [&dyn Fn(&mut State); 3] = [
        &|state| state.foundations[0].elements = 0..100,
        &|state| state.foundations.clear(),
        &|state| state.modes.truncate(1),
    ];
    for spoil in spoil {
        let mut other = state.clone();
        other.time += 1.0;
        spoil(&mut other);
        histories.record(&other);
    }
    assert_eq!(histories.times().len(), 2);
    assert_eq!(histories.summary().steps, 1);
}

/// States of another simulation of the same sizes are not taken for the next ones of this.
#[test]
fn states_of_another_simulation_are_ignored() {
    let (mut own, mut other) = (simulation(), simulation());
    let mut histories = Recorder::new().start(&own).unwrap();
    histories.record(other.step().unwrap());
    assert_eq!(histories.times(), [0.0]);
    histories.record(own.step().unwrap());
    assert_eq!(histories.times(), [0.0, own.time_step()]);
}
