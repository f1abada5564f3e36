//! A tower that rocks and slides on a half-space, through which all cells are coupled.

use basemat::Simulation;
use basemat::bem::ElasticGround;
use basemat::interface::Coulomb;
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::soil::Soil;
use basemat::structure::RigidBody;

/// In steps in which much of the base lands, Newton's method starts far from the directions of slip.
///
/// Without an early end of these iterations, a step would solve up to 194 systems.
#[test]
fn steps_in_which_many_cells_land_take_few_iterations() {
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0).unwrap();
    let tower = RigidBody::cuboid([8.0, 6.0, 12.0], 500.0).unwrap();
    let ground = ElasticGround::under(soil, &tower, 16).unwrap();
    let motion = Triaxial {
        x: Some(el_centro_1940()),
        y: Some(el_centro_1940().scaled(0.6).unwrap()),
        up: None,
    };
    let mut simulation = Simulation::builder(0.01)
        .structure(tower)
        .ground(ground)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(motion)
        .expected_steps(340)
        .build()
        .unwrap();
    let mut max_trials = 0;
    let run = simulation.run(340, |state| max_trials = max_trials.max(state.trials)).unwrap();
    assert!(max_trials < 150, "{max_trials}");
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
}
