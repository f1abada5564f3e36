//! GOAL: a structure in the ground stands, opens its walls, and its energy balance closes.
//! SCENE: blocks with walls in a trench, on springs and in the half-plane, at rest and shaken.
//! REFERENCE: weight and pressure at rest; Fourier synthesis of a welded block; the energy balance.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::coupled::{Face, GravityStage, Load};
use basemat::interface::{Bonded, ContactState, Coulomb};
use basemat::motion::{Record, STANDARD_GRAVITY, VerticalIncidence, el_centro_1940};
use basemat::site::TrenchMotion;
use basemat::structure::{RigidBlock, WithWalls};
use basemat::{Error, Simulation, Soil, unobserved};

use super::trench_springs::{
    BLOCK_HEIGHT, SOIL_DENSITY, TRENCH_DEPTH, TRENCH_WIDTH, TrenchSprings, friction_laws, soil,
    trench_elements, trench_motion, walled_block,
};

/// Weight of the block, N/m.
const BLOCK_WEIGHT: f64 = 900.0 * TRENCH_WIDTH * BLOCK_HEIGHT * STANDARD_GRAVITY;

/// The base carries the weight, and the walls carry the pressure at rest; without ground motion nothing moves.
#[test]
fn a_backfilled_block_stays_at_rest() {
    let mut simulation = Simulation::builder(0.01)
        .structure(walled_block())
        .ground(TrenchSprings::new(&trench_elements(), 4e7, 4e5))
        .interfaces(friction_laws())
        .build()
        .unwrap();
    let state = simulation.state();
    let base = state.face(Face::Base);
    assert!((base.thrust / BLOCK_WEIGHT - 1.0).abs() < 1e-12);
    assert!(base.place.abs() < 1e-9 && base.shear == 0.0);
    for wall in [Face::LeftWall, Face::RightWall] {
        let wall = state.face(wall);
        let thrust = 0.25 * SOIL_DENSITY * STANDARD_GRAVITY * TRENCH_DEPTH * TRENCH_DEPTH;
        assert!((wall.thrust / thrust - 1.0).abs() < 1e-12);
        assert_eq!((wall.shear, wall.open_fraction), (0.0, 0.0));
    }
    assert!(state.base_moment.abs() < 1e-6 && state.base_shear.abs() < 1e-6);
    let initial_contact = state.contact.clone();
    simulation.run(50, |_| {}).unwrap();
    for (contact, initial) in simulation.state().contact.iter().zip(&initial_contact) {
        assert!((contact.pressure - initial.pressure).abs() < 1e-12 * 2e5);
        assert!(contact.gap.abs() < 1e-15);
    }
}

/// Strong shaking opens walls and base; the energy balance closes.
#[test]
fn walls_open_and_slide_and_the_energy_balance_closes() {
    let record = el_centro_1940().scaled(2.5).unwrap().padded(0.5, 0.5).unwrap();
    let vertical = Some(record.scaled(0.6).unwrap());
    let motion = trench_motion(VerticalIncidence { horizontal: Some(record), vertical });
    let mut simulation = Simulation::builder(0.01)
        .structure(walled_block())
        .ground(TrenchSprings::new(&trench_elements(), 4e7, 4e5))
        .interfaces(friction_laws())
        .motion(motion)
        .build()
        .unwrap();
    let mut wall_opening = 0.0_f64;
    let mut base_opening = 0.0_f64;
    let mut slips = 0;
    let run = simulation
        .run(800, |state| {
            for wall in [Face::LeftWall, Face::RightWall] {
                wall_opening = wall_opening.max(state.face(wall).open_fraction);
            }
            base_opening = base_opening.max(state.face(Face::Base).open_fraction);
            slips += state.modes.iter().filter(|mode| mode.is_slip()).count();
        })
        .unwrap();
    assert!(run.energy_error < 1e-11, "{}", run.energy_error);
    assert!(wall_opening > 0.2 && base_opening > 0.1, "{wall_opening} {base_opening}");
    assert!(slips > 10, "{slips}");
    assert!(simulation.state().energy_balance.soil > 0.0);
    assert!(simulation.state().energy_balance.contact > 0.0);
}

/// A block welded in a trench under a pulse of shear waves, beside its Fourier synthesis.
#[test]
fn a_welded_block_follows_its_fourier_synthesis() {
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let elements = Trench::new(-1.0..1.0, 1.0).unwrap().elements(4, 3).unwrap();
    let ground = TrenchGround::new(soil, elements).unwrap();
    let record = Record::from_fn(0.02, 40.0, |t: f64| {
        let x = 0.6 * (t - 9.0);
        0.36 * (-6.0 + x * x * (24.0 - 8.0 * x * x)) * (-x * x).exp()
    });
    let record = record.unwrap();
    let motion = TrenchMotion::new(&ground, record, &mut unobserved).unwrap();
    let mut simulation = Simulation::builder(0.2)
        .structure(WithWalls::new(RigidBlock::new(2.0, 3.0, 1.0).unwrap(), 1.0).unwrap())
        .ground(ground)
        .interface(Bonded)
        .motion(motion)
        .expected_steps(130)
        .build()
        .unwrap();
    let table = include_str!("../data/embedded/td_SV_h1f_dt02.csv");
    let mut max_values = [0.0_f64; 2];
    let mut difference = [0.0_f64; 2];
    for line in table.lines() {
        let values: Vec<f64> = line.split(',').filter_map(|cell| cell.parse().ok()).collect();
        if values.len() < 3 {
            continue;
        }
        let state = simulation.step().unwrap();
        assert!((state.time - values[0]).abs() < 1e-9);
        // The table's rotation lowers the right end.
        let computed = [state.absolute_displacement()[0], -state.base_rotation];
        for k in 0..2 {
            max_values[k] = max_values[k].max(values[1 + k].abs());
            difference[k] = difference[k].max((computed[k] - values[1 + k]).abs());
        }
    }
    // The table has twice as many elements.
    assert!((0..2).all(|k| difference[k] < 0.025 * max_values[k]), "{difference:?} {max_values:?}");
    let energy = simulation.state().energy_balance;
    assert!(energy.residual() < 1e-9 && energy.soil > 0.0, "{energy:?}");
}

/// While base and walls open and slide, the balance closes and the soil only absorbs energy.
#[test]
fn soil_around_a_trench_never_returns_energy() {
    let elements = Trench::new(-0.5 * TRENCH_WIDTH..0.5 * TRENCH_WIDTH, TRENCH_DEPTH).unwrap();
    let elements = elements.elements(4, 3).unwrap();
    let laws = elements.interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap());
    let ground = TrenchGround::new(soil(), elements).unwrap().with_pressure_at_rest(0.5).unwrap();
    let record = el_centro_1940().scaled(3.0).unwrap().padded(0.2, 0.0).unwrap();
    let motion = TrenchMotion::new(&ground, record, &mut unobserved).unwrap();
    let mut simulation = Simulation::builder(0.02)
        .structure(walled_block())
        .ground(ground)
        .interfaces(laws)
        .motion(motion)
        .expected_steps(256)
        .build()
        .unwrap();
    let mut smallest_energy = 0.0_f64;
    let mut largest_energy = 0.0_f64;
    let mut wall_opening = 0.0_f64;
    let run = simulation
        .run(256, |state| {
            smallest_energy = smallest_energy.min(state.energy_balance.soil);
            largest_energy = largest_energy.max(state.energy_balance.soil);
            wall_opening = wall_opening.max(state.face(Face::LeftWall).open_fraction);
        })
        .unwrap();
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    assert!(smallest_energy > -1e-12 * largest_energy, "{smallest_energy} {largest_energy}");
    assert!(wall_opening > 0.3, "{wall_opening}");
}

/// Contact at rest under a vertical load of so many weights of the block.
fn contact_at_rest(load_ratio: f64) -> Vec<ContactState> {
    let elements = Trench::new(-0.5 * TRENCH_WIDTH..0.5 * TRENCH_WIDTH, TRENCH_DEPTH).unwrap();
    let elements = elements.elements(4, 2).unwrap();
    let laws = elements.interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap());
    let simulation = Simulation::builder(0.02)
        .structure(walled_block())
        .ground(TrenchGround::new(soil(), elements).unwrap())
        .interfaces(laws)
        .load(Load::constant([(1, 1.0)], -load_ratio * BLOCK_WEIGHT))
        .build()
        .unwrap();
    simulation.state().contact.clone()
}

/// A tiny load at the start changes the tractions as little, since jumps of loads count from the state at rest.
#[test]
fn a_tiny_load_at_the_start_hardly_changes_tractions() {
    let unloaded_contact = contact_at_rest(0.0);
    let loaded_contact = contact_at_rest(1e-6);
    let mean_pressure = BLOCK_WEIGHT / TRENCH_WIDTH;
    for (a, b) in unloaded_contact.iter().zip(&loaded_contact) {
        let difference = (a.pressure - b.pressure).abs().max((a.shear - b.shear).abs());
        assert!(difference < 1e-5 * mean_pressure, "{a:?} {b:?}");
    }
    assert!(unloaded_contact.iter().zip(&loaded_contact).any(|(a, b)| a.pressure != b.pressure));
}

/// Uplift and slip are those of the base; a gravity stage and a structure without walls are errors.
#[test]
fn walls_have_separate_results() {
    let mut simulation = Simulation::builder(0.01)
        .structure(walled_block())
        .ground(TrenchSprings::new(&trench_elements(), 4e7, 4e5))
        .interfaces(friction_laws())
        .motion(trench_motion(el_centro_1940().scaled(2.0).unwrap()))
        .build()
        .unwrap();
    simulation
        .run(300, |state| {
            let base = state.face(Face::Base);
            assert!((state.uplifted_fraction - base.open_fraction).abs() < 1e-12);
            assert!((state.base_shear - base.shear).abs() > 0.0 || state.time < 0.1);
        })
        .unwrap();
    let state = simulation.state();
    let left_thrust = state.face(Face::LeftWall).thrust;
    let right_thrust = state.face(Face::RightWall).thrust;
    let shear = right_thrust - left_thrust + state.face(Face::Base).shear;
    assert!((state.base_shear - shear).abs() < 1e-9 * state.normal_force);
    let result = Simulation::builder(0.01)
        .structure(walled_block())
        .ground(TrenchSprings::new(&trench_elements(), 4e7, 4e5))
        .interfaces(friction_laws())
        .gravity_stage(GravityStage::Unloaded)
        .build();
    assert!(matches!(result, Err(Error::Scene { quantity: "gravity stage", .. })));
    let on_surface = Simulation::builder(0.01)
        .structure(RigidBlock::new(TRENCH_WIDTH, BLOCK_HEIGHT, 900.0).unwrap())
        .ground(TrenchSprings::new(&trench_elements(), 4e7, 4e5))
        .interfaces(friction_laws())
        .build();
    assert!(on_surface.unwrap_err().to_string().contains("WithWalls"));
}
