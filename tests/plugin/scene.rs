//! The scene that the tests share: ground, push, run and comparison of two motions.

use basemat::coupled::SimulationBuilder;
use basemat::motion::RickerDisplacement;
use basemat::results::Run;
use basemat::{Simulation, Soil};

pub(crate) const STEP: f64 = 2e-3;

pub(crate) fn soil() -> Soil {
    Soil::new(30.0e6, 0.3, 1800.0).unwrap()
}

/// A push to either side, strong enough to slide and to rock.
pub(crate) fn push() -> RickerDisplacement {
    RickerDisplacement::new(0.05, 0.12, 0.6).unwrap()
}

pub(crate) fn shaken() -> SimulationBuilder {
    Simulation::builder(STEP).motion(push()).gravity(9.81)
}

#[track_caller]
pub(crate) fn run(builder: SimulationBuilder) -> (Run, Simulation) {
    let mut simulation = builder.build().unwrap();
    let run = simulation.run(600, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{run}");
    assert!(run.whole.base_shear.magnitude() > 0.0, "{run}");
    (run, simulation)
}

#[track_caller]
pub(crate) fn assert_same_motion(a: &Simulation, b: &Simulation, tolerance: f64) {
    let (a, b) = (a.state().absolute_displacement(), b.state().absolute_displacement());
    let largest = a.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    assert!(largest > 0.0);
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() <= tolerance * largest, "{a:?} {b:?}");
    }
}
