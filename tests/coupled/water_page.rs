//! GOAL: weight, factor of safety against flotation and coefficients of a run in water refer to the structure's weight.
//! SCENE: a block without a static state, bonded where it would float, and run twice; a box bonded to its floor in a trench.
//! REFERENCE: weight and buoyancy of the block in closed form.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::bem::embedded::TrenchGround;
use basemat::coupled::{GravityStage, SimulationBuilder, Warning};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::soil::WaterTable;
use basemat::structure::{RigidBlock, WithWalls};

use super::trench_springs::{TRENCH_DEPTH, TRENCH_WIDTH, soil, trench_elements};
use super::water::{BASE_WIDTH, BLOCK_DENSITY, BODY_HEIGHT, WATER_DENSITY, block, shaken_block};

const BLOCK_WEIGHT: f64 = BLOCK_DENSITY * STANDARD_GRAVITY * BASE_WIDTH * BODY_HEIGHT;

/// The block with water of this height (m) above its base, on a half-plane.
fn block_in_water(water_head: f64) -> SimulationBuilder {
    shaken_block().water_table(WaterTable::at_depth(-water_head).unwrap())
}

fn line_of_flotation(water_head: f64) -> String {
    let buoyancy = WATER_DENSITY * STANDARD_GRAVITY * BASE_WIDTH * water_head;
    format!("factor of safety against flotation {:.3}", BLOCK_WEIGHT / buoyancy)
}

#[test]
fn a_block_without_static_state_has_its_weight() {
    let mut simulation = Simulation::builder(0.01)
        .ground(SpringGround::under(&block(), 8, 2.0e8, 1.0e8).unwrap())
        .structure(block())
        .interface(Coulomb::new(0.4).unwrap())
        .motion(el_centro_1940())
        .gravity_stage(GravityStage::Unloaded)
        .water_table(WaterTable::at_depth(-4.0).unwrap())
        .build()
        .unwrap();
    let run = simulation.run(300, |_| {}).unwrap();
    assert_eq!(run.whole.static_normal_force, 0.0);
    let expected_coefficient = run.whole.horizontal_force.magnitude() / BLOCK_WEIGHT;
    assert!((run.shear_coefficient().unwrap() / expected_coefficient - 1.0).abs() < 1e-12);
    assert!(run.to_string().contains(&line_of_flotation(4.0)), "{run}");
}

#[test]
fn a_second_run_has_the_same_weight() {
    let mut simulation = block_in_water(4.0).build().unwrap();
    let first_run = simulation.run(250, |_| {}).unwrap();
    let second_run = simulation.run(250, |_| {}).unwrap();
    assert_ne!(first_run.whole.static_normal_force, second_run.whole.static_normal_force);
    for run in [first_run, second_run] {
        assert!((run.weight_in_water / BLOCK_WEIGHT - 1.0).abs() < 1e-12);
        assert!(run.to_string().contains(&line_of_flotation(4.0)), "{run}");
    }
}

#[test]
fn a_bonded_base_that_floats_is_reported() {
    let mut simulation = block_in_water(14.0).interface(Bonded).build().unwrap();
    let run = simulation.run(100, |_| {}).unwrap();
    assert!(run.to_string().contains(&line_of_flotation(14.0)), "{run}");
    let has_tension = |warning: &Warning| matches!(warning, Warning::Tension { .. });
    assert!(run.warnings.iter().any(has_tension), "{:?}", run.warnings);
}

#[test]
fn without_gravity_water_has_no_effect_and_no_warning() {
    let mut simulation = block_in_water(4.0).gravity(0.0).interface(Bonded).build().unwrap();
    let run = simulation.run(20, |_| {}).unwrap();
    assert_eq!(run.buoyancy, 0.0);
    assert!(!run.warnings.iter().any(|warning| matches!(warning, Warning::Mistake(_))));
}

/// A box lighter than its buoyancy, anchored to its floor in a trench whose walls may lift off.
#[test]
fn a_box_anchored_to_its_floor_does_not_float() {
    let build = |is_anchored: bool, is_fixed: bool| {
        let elements = trench_elements();
        let walls = Coulomb::new(0.3).unwrap();
        let laws = if is_anchored {
            elements.interfaces(Bonded, walls)
        } else {
            elements.interfaces(Coulomb::new(0.3).unwrap(), walls)
        };
        let ground = TrenchGround::new(soil(), elements)
            .and_then(|ground| ground.with_water_table(WaterTable::at_depth(0.5)?))
            .unwrap();
        let light_block = RigidBlock::new(TRENCH_WIDTH, TRENCH_DEPTH, 300.0).unwrap();
        let builder = Simulation::builder(0.01)
            .structure(WithWalls::new(light_block, TRENCH_DEPTH).unwrap())
            .ground(ground)
            .interfaces(laws);
        if is_fixed { builder.on_fixed_base().build() } else { builder.build() }
    };
    assert!(build(false, false).is_err());
    let buoyancy = WATER_DENSITY * STANDARD_GRAVITY * TRENCH_WIDTH * (TRENCH_DEPTH - 0.5);
    let weight = 300.0 * STANDARD_GRAVITY * TRENCH_WIDTH * TRENCH_DEPTH;
    let normal_force = build(true, false).unwrap().state().normal_force;
    let error = normal_force - (weight - buoyancy);
    assert!(error.abs() < 1e-9 * weight, "{normal_force}");
    // A fixed base has no soil, and no water of the soil.
    let support_force = build(true, true).unwrap().state().normal_force;
    assert!((support_force / weight - 1.0).abs() < 1e-9, "{support_force}");
}
