//! GOAL: every trait can be implemented outside the crate, and all of them together.
//! SCENE: a block on springs or half-plane under a pulse, one part replaced at a time.
//! REFERENCE: the part of the crate that is the same or nearly so; a closed energy balance.

mod element;
mod forwarding;
mod free_field;
mod fundamental_solution;
mod ground;
mod hints;
mod history;
mod kernel;
mod law;
mod scheme;
mod shared_kernels;
mod state_variables;
mod structure;
mod structure_with_memory;
mod threads_and_texts;

use std::sync::Arc;

use basemat::bem::Strip;
use basemat::coupled::SimulationBuilder;
use basemat::motion::RickerDisplacement;
use basemat::results::Run;
use basemat::{Simulation, Soil};
use free_field::Passing;
use ground::Bed;
use law::Glaze;
use scheme::AverageAcceleration;
use structure::{Hardening, SPRING};

const STEP: f64 = 2e-3;

fn soil() -> Soil {
    Soil::new(30.0e6, 0.3, 1800.0).unwrap()
}

/// A push to either side, strong enough to slide and to rock.
fn push() -> RickerDisplacement {
    RickerDisplacement::new(0.05, 0.12, 0.6).unwrap()
}

fn shaken() -> SimulationBuilder {
    Simulation::builder(STEP).motion(push()).gravity(9.81)
}

#[track_caller]
fn run(builder: SimulationBuilder) -> (Run, Simulation) {
    let mut simulation = builder.build().unwrap();
    let run = simulation.run(600, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9, "{run}");
    assert!(run.whole.base_shear.magnitude() > 0.0, "{run}");
    (run, simulation)
}

#[track_caller]
fn assert_same_motion(a: &Simulation, b: &Simulation, tolerance: f64) {
    let (a, b) = (a.state().absolute_displacement(), b.state().absolute_displacement());
    let largest = a.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    assert!(largest > 0.0);
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() <= tolerance * largest, "{a:?} {b:?}");
    }
}

#[test]
fn all_of_one_s_own_together() {
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let ground = Bed { elements, stiffness: [4.0e7, 2.0e7], displacement: vec![0.0; 8] };
    let scene = Simulation::builder(STEP)
        .structure(Hardening { cubic: 100.0 * SPRING, commits: Arc::default() })
        .ground(ground)
        .interface(Glaze(0.4))
        .motion(Passing { speed: 80.0 })
        .scheme(AverageAcceleration)
        .gravity(9.81);
    let mut simulation = scene.build().unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    assert!(run.end > 0.59 && run.whole.base_shear.largest().value != 0.0, "{run}");
}
