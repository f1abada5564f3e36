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
mod voigt_springs;

use std::sync::Arc;

use basemat::Simulation;
use basemat::bem::Strip;
use basemat::interface::InPlane;
use free_field::PassingWave;
use ground::IndependentSprings;
use law::GlazedFriction;
use scene::TIME_STEP;
use scheme::AverageAcceleration;
use structure::{HardeningOscillator, SPRING_STIFFNESS};

#[test]
fn parts_of_a_user_work_together() {
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let ground = IndependentSprings::new(elements, [4.0e7, 2.0e7]);
    let scene = Simulation::builder(TIME_STEP)
        .structure(HardeningOscillator {
            cubic_stiffness: 100.0 * SPRING_STIFFNESS,
            commits: Arc::default(),
        })
        .ground(ground)
        .interface(InPlane(GlazedFriction { coefficient: 0.4 }))
        .motion(PassingWave { speed: 80.0 })
        .scheme(AverageAcceleration)
        .gravity(9.81);
    let mut simulation = scene.build().unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    assert!(run.end > 0.59 && run.whole.base_shear.largest().value != 0.0, "{run}");
}
