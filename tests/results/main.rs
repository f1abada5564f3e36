//! GOAL: time series, peaks, envelopes, factors of safety, spectra, pages and pictures of a run.
//! SCENE: a block on the half-plane that rocks and slides.
//! REFERENCE: the states they were made of, and statics.

mod foundations;
mod histories;
mod pages;
mod plot;
mod refused;
mod resolution;
mod safety;
mod spectra;
#[path = "../support/mod.rs"]
mod support;

use basemat::Simulation;
use basemat::coupled::{Probe, State};
use basemat::results::{Histories, Recorder};

use crate::support::scenes::{SI, block, friction, scene};

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
