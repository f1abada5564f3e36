//! GOAL: time series, peaks, envelopes, factors of safety, spectra, pages and pictures of a run are right.
//! SCENE: a block on the half-plane that rocks and slides.
//! REFERENCE: the states they were made of, and statics.

mod case_files;
mod case_table_files;
mod case_tables;
mod damaged_tables;
mod files;
mod foundations;
mod layout;
mod mistakes;
#[cfg(feature = "npz")]
mod npz;
mod pages;
mod plot;
mod plot_texts;
mod refused;
mod resolution;
mod rocking;
mod rocking_pictures;
mod safety;
mod serviceability;
mod solid_pictures;
mod spectra;
mod time_series;
mod units;
mod walls;

use basemat::Simulation;
use basemat::coupled::{Probe, State};
use basemat::results::Run;
use basemat::results::{Recorder, TimeSeries};

use basemat_problems::scenes::{self, SI_UNITS, block, friction, scene};

const FRICTION_COEFFICIENT: f64 = 0.35;
const STEP_COUNT: usize = 400;

fn simulation() -> Simulation {
    scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(FRICTION_COEFFICIENT))
        .probe(Probe::displacement("top", block(SI_UNITS).horizontal_at(6.0)))
        .probe(Probe::acceleration("top acceleration", block(SI_UNITS).horizontal_at(6.0)))
        .build()
        .unwrap()
}

/// A simulation that has run, and its results.
struct Recorded {
    simulation: Simulation,
    states: Vec<State>,
    time_series: TimeSeries,
    run: Run,
}

fn recorded(recorder: Recorder) -> Recorded {
    let mut simulation = simulation();
    let (time_series, run, states) = scenes::recorded(&mut simulation, recorder, STEP_COUNT);
    Recorded { simulation, states, time_series, run }
}
