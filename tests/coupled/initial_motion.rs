//! GOAL: runs begin with the prescribed motion: its energy, its fall and its landing.
//! SCENE: buildings that are struck, blocks that are dropped or tilted and released.
//! REFERENCE: energy, free fall, Housner's block.

use basemat::bem::ElasticGround;
use basemat::coupled::{Coordinates, GravityStage, Newmark, SimulationBuilder};
use basemat::interface::{Coulomb, FrictionLimit, ThinLayer};
use basemat::motion::STANDARD_GRAVITY;
use basemat::reference::RockingBlock;
use basemat::structure::{RigidBlock, Structure};
use basemat::{Simulation, Soil};

use super::loads::{BLOCK_WEIGHT, block, building, on_half_plane, soil};

/// A building whose roof starts with 10 mm and 0.5 m/s.
fn struck_building() -> SimulationBuilder {
    let roof = building(3).roof();
    let mut velocity = vec![0.0; building(3).dofs()];
    velocity[roof] = 0.5;
    let mut displacement = vec![0.0; building(3).dofs()];
    displacement[roof] = 0.01;
    on_half_plane(building(3))
        .interface(Coulomb::new(0.6).unwrap())
        .initial_velocity(velocity)
        .initial_displacement(displacement)
}

#[test]
fn an_initial_velocity_is_the_energy_that_a_run_begins_with() {
    let roof = building(3).roof();
    let kinetic = 0.5 * 20.0e3 * 0.25;
    let strain = 0.5 * 4.0e6 * 1e-4;
    for coordinates in [Coordinates::Physical, Coordinates::Modes] {
        for newmark in [false, true] {
            let mut builder = struck_building().coordinates(coordinates);
            if newmark {
                builder = builder.scheme(Newmark::default());
            }
            let mut simulation = builder.build().unwrap();
            let initial = simulation.state().energy_balance;
            assert!((initial.kinetic / kinetic - 1.0).abs() < 1e-9, "{initial}");
            assert!((initial.strain / strain - 1.0).abs() < 1e-9, "{initial}");
            assert!((initial.input / (kinetic + strain) - 1.0).abs() < 1e-9, "{initial}");
            assert!((simulation.state().velocity()[roof] - 0.5).abs() < 1e-12);
            let acceleration = simulation.state().acceleration()[roof];
            let expected = if newmark { -4.0e6 * 0.01 / 20.0e3 } else { 0.0 };
            assert!((acceleration - expected).abs() < 1e-9, "{acceleration} {expected}");
            let run = simulation.run(1000, |_| {}).unwrap();
            assert!(run.energy_error < 1e-9, "{run}");
            // The soil has absorbed the other part of the energy.
            let energy_balance = simulation.state().energy_balance;
            let remaining_energy = energy_balance.kinetic + energy_balance.strain;
            assert!(
                remaining_energy < 0.9 * (kinetic + strain) && energy_balance.soil > 0.0,
                "{run}"
            );
        }
    }
}

/// A block falls freely, h = g t²/2, until it lands, and then bounces to less than half of h.
#[test]
fn a_dropped_block_falls_freely_and_lands() {
    let height = 0.05;
    let mut simulation = on_half_plane(block())
        .interface(Coulomb::new(0.5).unwrap())
        .gravity_stage(GravityStage::Unloaded)
        .initial_displacement([0.0, height, 0.0])
        .build()
        .unwrap();
    let state = simulation.state();
    assert!((state.contact[3].gap - height).abs() < 1e-15 && state.uplifted_fraction == 1.0);
    assert_eq!(state.normal_force, 0.0);
    let fall = (2.0 * height / STANDARD_GRAVITY).sqrt();
    while simulation.state().time + 0.005 < fall {
        let state = simulation.step().unwrap();
        let expected = height - 0.5 * STANDARD_GRAVITY * state.time.powi(2);
        assert!((state.displacement()[1] - expected).abs() < 1e-12, "{}", state.time);
    }
    let mut max_gap = 0.0_f64;
    let run = simulation.run(600, |state| max_gap = max_gap.max(state.contact[3].gap)).unwrap();
    assert!(run.energy_error < 1e-9 && max_gap < 0.5 * height, "{max_gap}");
    // At the end the soil carries the weight.
    assert!((simulation.state().normal_force / BLOCK_WEIGHT - 1.0).abs() < 0.01, "{run}");
}

/// A block that nothing supports, by Newmark's method.
fn falling_block() -> SimulationBuilder {
    on_half_plane(block())
        .interface(Coulomb::new(0.5).unwrap())
        .gravity_stage(GravityStage::Unloaded)
        .scheme(Newmark::default())
}

/// Newmark's method falls from the first step on, with an initial velocity or without.
#[test]
fn a_weight_that_acts_from_the_start_accelerates_at_once() {
    for builder in [falling_block(), falling_block().initial_velocity([0.0; 3])] {
        let simulation = builder.build().unwrap();
        assert!((simulation.state().acceleration()[1] + STANDARD_GRAVITY).abs() < 1e-9);
    }
    // A law that needs a static pressure is an error where there is none.
    let layer =
        ThinLayer::new(soil(), 1.0, 0.4).unwrap().with_friction_limit(FrictionLimit::Static);
    assert!(falling_block().interface(layer).build().is_err());
}

/// Slender block of the rocking tests.
fn housner_block() -> RockingBlock {
    RockingBlock::new(0.5, 2.0, STANDARD_GRAVITY).unwrap()
}

/// Tilt at which the slender block is released.
fn initial_tilt() -> f64 {
    0.3 * housner_block().slenderness_angle()
}

/// Computed rocking of a slender block that is released on an edge.
struct Rocking {
    /// Time until it is upright, over Housner's quarter period.
    quarter_period_ratio: f64,
    /// First amplitude after an impact, over the initial tilt.
    amplitude_ratio: f64,
}

/// Rocking on soil of this shear-wave speed (m/s), with a time step (s).
fn rocking(shear_wave_speed: f64, elements: usize, time_step: f64) -> Rocking {
    let tilt = initial_tilt();
    let quarter_period = 0.25 * housner_block().period(tilt).unwrap();
    let block = RigidBlock::new(1.0, 4.0, 2500.0).unwrap().with_p_delta(STANDARD_GRAVITY).unwrap();
    let soil = Soil::from_shear_wave_speed(shear_wave_speed, 0.3, 2000.0).unwrap();
    let mut simulation = Simulation::builder(time_step)
        .ground(ElasticGround::under(soil, &block, elements).unwrap())
        .structure(block)
        .interface(Coulomb::new(2.0).unwrap())
        .gravity_stage(GravityStage::Unloaded)
        .initial_displacement([0.0, 0.5 * tilt, tilt])
        .build()
        .unwrap();
    let mut upright_time = 0.0;
    let mut previous_rotation = tilt;
    let mut smallest_rotation = 0.0_f64;
    let steps = simulation.steps_for(2.6 * quarter_period);
    let run = simulation
        .run(steps, |state| {
            let rotation = state.base_rotation;
            if upright_time == 0.0 && rotation <= 0.0 {
                upright_time = state.time + time_step * rotation / (previous_rotation - rotation);
            }
            previous_rotation = rotation;
            smallest_rotation = smallest_rotation.min(rotation);
        })
        .unwrap();
    assert!(run.energy_error < 1e-9);
    Rocking {
        quarter_period_ratio: upright_time / quarter_period,
        amplitude_ratio: -smallest_rotation / tilt,
    }
}

/// The quarter period is Housner's within 1 % on stiff soil.
///
/// The loss by an impact converges, and grows with the stiffness of the soil towards Housner's.
#[test]
fn a_tilted_block_rocks_as_housner_s_on_stiff_soil() {
    let mut losses = Vec::new();
    for (speed, time_step) in [(200.0, 1e-3), (400.0, 5e-4), (800.0, 2.5e-4)] {
        let Rocking { quarter_period_ratio, amplitude_ratio } = rocking(speed, 32, time_step);
        assert!((quarter_period_ratio - 1.0).abs() < 0.01, "{speed}: {quarter_period_ratio}");
        let fewer_elements = rocking(speed, 16, time_step).amplitude_ratio;
        let shorter_steps = rocking(speed, 32, 0.5 * time_step).amplitude_ratio;
        let loss = 1.0 - amplitude_ratio;
        println!(
            "{speed} m/s: quarter {quarter_period_ratio:.4}, loss {loss:.4} ({fewer_elements:.4} \
             {shorter_steps:.4})"
        );
        for refined_ratio in [fewer_elements, shorter_steps] {
            assert!(
                ((1.0 - refined_ratio) / loss - 1.0).abs() < 0.05,
                "{speed}: {loss} {refined_ratio}"
            );
        }
        losses.push(loss);
    }
    let tilt = initial_tilt();
    let rigid_loss = 1.0 - housner_block().next_peak(tilt).unwrap() / tilt;
    assert!(losses.windows(2).all(|pair| pair[1] > pair[0]), "{losses:?}");
    assert!(losses[2] < rigid_loss, "{losses:?} {rigid_loss}");
}
