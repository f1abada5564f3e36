//! GOAL: every trait can be implemented outside the crate, and all of them together.
//! SCENE: a block on springs or half-plane under a pulse, one part replaced at a time.
//! REFERENCE: the part of the crate that is the same or nearly so; a closed energy balance.

mod element;
mod forwarding;
mod free_field;
mod fundamental_solution;
mod ground;
mod ground_order;
mod hints;
mod history;
mod kernel;
mod law;
mod scene;
mod scheme;
mod shared_kernels;
mod state_variables;
mod structure;
mod structure_with_memory;
mod threads_and_texts;

use std::sync::Arc;

use basemat::Simulation;
use basemat::bem::Strip;
use basemat::interface::InPlane;
use free_field::Passing;
use ground::Bed;
use law::Glaze;
use scene::STEP;
use scheme::AverageAcceleration;
use structure::{Hardening, SPRING};

#[test]
fn all_of_one_s_own_together() {
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let ground = Bed { elements, stiffness: [4.0e7, 2.0e7], displacement: vec![0.0; 8] };
    let scene = Simulation::builder(STEP)
        .structure(Hardening { cubic: 100.0 * SPRING, commits: Arc::default() })
        .ground(ground)
        .interface(InPlane(Glaze(0.4)))
        .motion(Passing { speed: 80.0 })
        .scheme(AverageAcceleration)
        .gravity(9.81);
    let mut simulation = scene.build().unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    assert!(run.end > 0.59 && run.whole.base_shear.largest().value != 0.0, "{run}");
}
