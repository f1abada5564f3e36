//! Histories, peaks, envelopes and factors of safety, against the states they were made of and
//! against statics.

mod histories;
mod pages;
mod refused;
mod resolution;
mod safety;
#[path = "../support/scenes.rs"]
mod scenes;
mod spectra;
#[path = "../support/wrapped.rs"]
mod wrapped;

use basemat::Simulation;
use basemat::coupled::{Probe, State};
use basemat::results::{Histories, Recorder};

use scenes::{SI, block, friction, scene};

const FRICTION: f64 = 0.35;
const STEPS: usize = 400;

fn simulation() -> Simulation {
    scene(SI, 0.6)
        .structure(block(SI))
        .interface(friction(FRICTION))
        .probe(Probe::displacement("top", block(SI).horizontal_at(6.0)))
        .probe(Probe::acceleration("top acceleration", block(SI).horizontal_at(6.0)))
        .build()
        .unwrap()
}

/// The states of a run, and its histories.
fn recorded(recorder: Recorder) -> (Vec<State>, Histories, Simulation) {
    let mut simulation = simulation();
    let mut histories = recorder.start(&simulation).unwrap();
    let mut states = vec![simulation.state().clone()];
    simulation
        .run(STEPS, |state| {
            histories.record(state);
            states.push(state.clone());
        })
        .unwrap();
    (states, histories, simulation)
}
