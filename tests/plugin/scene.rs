//! The scene that the tests share: ground, push, run and comparison of two motions.

use basemat::coupled::SimulationBuilder;
use basemat::motion::RickerDisplacement;
use basemat::results::Run;
use basemat::{Simulation, Soil};

pub(crate) const TIME_STEP: f64 = 2e-3;

pub(crate) fn soil() -> Soil {
    Soil::new(30.0e6, 0.3, 1800.0).unwrap()
}

/// A pulse to both sides, strong enough for slip and rocking.
pub(crate) fn push() -> RickerDisplacement {
    RickerDisplacement::new(0.05, 0.12, 0.6).unwrap()
}

pub(crate) fn shaken() -> SimulationBuilder {
    Simulation::builder(TIME_STEP).motion(push()).gravity(9.81)
}

/// A run and the simulation at its end.
pub(crate) struct CompletedRun {
    pub(crate) run: Run,
    pub(crate) simulation: Simulation,
}

/// Runs 600 steps with a closed energy balance.
#[track_caller]
pub(crate) fn complete_run(builder: SimulationBuilder) -> CompletedRun {
    let mut simulation = builder.build().unwrap();
    let run = simulation.run(600, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{run}");
    assert!(run.whole.base_shear.magnitude() > 0.0, "{run}");
    CompletedRun { run, simulation }
}

#[track_caller]
pub(crate) fn assert_same_motion(a: &Simulation, b: &Simulation, tolerance: f64) {
    let a = a.state().absolute_displacement();
    let b = b.state().absolute_displacement();
    let max_magnitude = a.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
    assert!(max_magnitude > 0.0);
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() <= tolerance * max_magnitude, "{a:?} {b:?}");
    }
}
