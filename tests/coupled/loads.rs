//! GOAL: loads and static stages follow mechanics, and the energy balance contains them.
//! SCENE: blocks, frames and towers that are pushed, pulled and released.
//! REFERENCE: statics, a structure that carries the same load itself, energy.

use basemat::bem::ElasticGround;
use basemat::coupled::{
    Change, DissipativeMidpoint, GravityStage, HhtAlpha, Load, Midpoint, Newmark,
    SimulationBuilder, TimeScheme,
};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{Bilinear, DofCombination, RigidBlock, ShearBuilding, Storey, Structure};
use basemat::{Error, Simulation, Soil};

use basemat_problems::wrapped::StructureWithForce;

pub(super) fn soil() -> Soil {
    Soil::new(80.0e6, 0.33, 1900.0).unwrap()
}

pub(super) fn block() -> RigidBlock {
    RigidBlock::new(6.0, 9.0, 2000.0).unwrap()
}

/// Weight of [`block`], N/m.
pub(super) const BLOCK_WEIGHT: f64 = 6.0 * 9.0 * 2000.0 * STANDARD_GRAVITY;

/// Shear building of equal storeys on a light base.
pub(super) fn building(storeys: usize) -> ShearBuilding {
    let storeys = vec![Storey::new(3.0, 20.0e3, 4.0e6); storeys];
    ShearBuilding::new(8.0, 50.0e3, 4.0e5, &storeys).unwrap()
}

/// Simulation of a structure on the half-plane, all but its law.
pub(super) fn on_half_plane(structure: impl Structure + 'static) -> SimulationBuilder {
    let ground = ElasticGround::under(soil(), &structure, 8).unwrap();
    Simulation::builder(0.005).ground(ground).structure(structure)
}

#[test]
fn a_load_of_the_builder_is_one_of_the_structure() {
    fn roof_force(time: f64) -> f64 {
        150.0e3 * (1.0 + (8.0 * time).sin())
    }

    let roof = DofCombination::from(building(5).roof());
    let law = Coulomb::new(0.6).unwrap();
    let pulled_building =
        StructureWithForce { structure: building(5), along: roof.clone(), force: roof_force };
    let mut by_structure = on_half_plane(pulled_building).interface(law).build().unwrap();
    // Two loads, of which one is rounded otherwise.
    let mut by_builder = on_half_plane(building(5))
        .interface(law)
        .load(Load::new(roof.clone(), |time| 0.5 * roof_force(time)))
        .load(Load::new(0.5 * roof, roof_force))
        .build()
        .unwrap();
    let structure_run = by_structure.run(600, |_| {}).unwrap();
    let builder_run = by_builder.run(600, |_| {}).unwrap();
    assert!(structure_run.whole.uplifted_fraction.largest().value > 0.1, "{structure_run}");
    let expected = by_structure.state().displacement();
    let computed = by_builder.state().displacement();
    let max_magnitude = expected.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
    assert!(
        expected.iter().zip(computed).all(|(a, b)| (a - b).abs() < 1e-10 * max_magnitude),
        "{expected:?} {computed:?}"
    );
    assert!(structure_run.energy_error < 1e-9 && builder_run.energy_error < 1e-9);
    let expected_input = by_structure.state().energy_balance.input;
    let computed_input = by_builder.state().energy_balance.input;
    assert!((expected_input / computed_input - 1.0).abs() < 1e-10);
}

fn assert_near(computed: f64, expected: f64) {
    assert!((computed - expected).abs() < 1e-6 * BLOCK_WEIGHT, "{computed} {expected}");
}

/// Horizontal loads at t = 0 of any size have the resultants of statics.
#[test]
fn static_loads_are_carried_by_statics() {
    for (law, force) in [
        (Box::new(Coulomb::new(0.5).unwrap()) as Box<dyn InterfaceLaw>, 26.0),
        (Box::new(Coulomb::new(0.5).unwrap()), 0.3 * BLOCK_WEIGHT),
        (Box::new(Coulomb::uplift_only()), -0.2 * BLOCK_WEIGHT),
        (Box::new(Bonded), 0.4 * BLOCK_WEIGHT),
    ] {
        let height = 3.0;
        let load = Load::constant(block().horizontal_at(height), force);
        let downward_load = Load::constant(block().vertical_at(1.0), -1.0e5);
        let mut simulation =
            on_half_plane(block()).interface(law).load(load).load(downward_load).build().unwrap();
        let state = simulation.state();
        assert_near(state.base_shear, force);
        assert_near(state.normal_force, BLOCK_WEIGHT + 1.0e5);
        // On the soil, counter-clockwise about the middle of the base.
        let moment = -force * height - 1.0e5;
        assert_near(state.base_moment, moment);
        let static_state = state.clone();
        let run = simulation.run(100, |_| {}).unwrap();
        assert_near(run.whole.base_shear.magnitude(), force.abs());
        let displacement = simulation.state().displacement();
        let max_magnitude = displacement.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
        assert!(max_magnitude < 1e-9, "{max_magnitude:e} from {static_state:?}");
    }
}

/// Edge elements slide while a load is applied, and none exceeds its friction limit.
#[test]
fn elements_slide_while_a_load_is_applied() {
    let load = Load::constant(block().horizontal_at(0.5), 0.45 * BLOCK_WEIGHT);
    let simulation = on_half_plane(block())
        .interface(Coulomb::new(0.5).unwrap())
        .load(load)
        .build()
        .unwrap();
    let mut elements_at_limit = 0;
    for contact in &simulation.state().contact {
        assert!(contact.shear.abs() <= 0.5 * contact.pressure * (1.0 + 1e-9), "{contact:?}");
        if contact.shear.abs() >= 0.5 * contact.pressure * (1.0 - 1e-6) {
            elements_at_limit += 1;
        }
    }
    assert!(elements_at_limit > 0 && elements_at_limit < 8, "{elements_at_limit}");
}

/// Tables interpolate also between values whose difference overflows.
#[test]
fn tables_of_huge_values_stay_finite() {
    let load = Load::table(0, &[0.0, 1.0, 2.0], &[-1e308, 1e308, 0.0]).unwrap();
    let values = [0.0, 0.25, 0.5, 1.0, 1.5, 2.0].map(|time| load.value(time) / 1e308);
    assert_eq!(values, [-1.0, -0.5, 0.0, 1.0, 0.5, 0.0]);
}

/// Snap-back of a tower begins with the energy that its spring stores.
#[test]
fn a_released_load_leaves_its_energy() {
    let heavy_base = [Storey::new(3.0, 20.0e3, 4.0e6)];
    let building = ShearBuilding::new(8.0, 5.0e5, 4.0e6, &heavy_base).unwrap();
    let roof = DofCombination::from(building.roof());
    let force = 20.0e3;
    let mut simulation = on_half_plane(building)
        .interface(Bonded)
        .load(Load::released(roof.clone(), force))
        .build()
        .unwrap();
    let static_displacement = roof.value(simulation.static_displacement());
    let run = simulation.run(8000, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9);
    // At the end the roof has returned by F/k of the storey, and by the displacement of base and soil.
    let roof_displacement = roof.value(simulation.state().displacement());
    assert!(
        static_displacement > force / 4.0e6 && roof_displacement < -force / 4.0e6,
        "{static_displacement} {roof_displacement}"
    );
    // The storey stores half of the work of −F; the other half is radiated.
    let energy_balance = simulation.state().energy_balance;
    let stored = 0.5 * 4.0e6 * (force / 4.0e6_f64).powi(2);
    assert!((energy_balance.strain / stored - 1.0).abs() < 1e-2, "{energy_balance}");
    assert!(
        energy_balance.soil > stored && energy_balance.soil < 2.0 * -force * roof_displacement,
        "{energy_balance}"
    );
}

/// Every scheme applies a load that acts at t = 0 from the first step on.
///
/// A constant force pulls a block without weight off the ground: u = F t²/2 m.
#[test]
fn a_load_at_the_start_accelerates_in_full() {
    let force = 1.0e5;
    let mass = BLOCK_WEIGHT / STANDARD_GRAVITY;
    let schemes: [Box<dyn TimeScheme>; 4] = [
        Box::new(Midpoint),
        Box::new(DissipativeMidpoint::new(0.8).unwrap()),
        Box::new(Newmark::default()),
        Box::new(HhtAlpha::new(-0.1).unwrap()),
    ];
    for (index, scheme) in schemes.into_iter().enumerate() {
        let mut simulation = on_half_plane(block())
            .gravity(0.0)
            .interface(Coulomb::new(0.5).unwrap())
            .load(Load::constant(block().vertical_at(1.0), force))
            .scheme(scheme)
            .build()
            .unwrap();
        for _ in 0..20 {
            let state = simulation.step().unwrap();
            let expected = 0.5 * force / mass * state.time.powi(2);
            let computed = state.displacement()[1];
            assert!(
                (computed / expected - 1.0).abs() < 1e-9,
                "{index} {}: {computed:e} {expected:e}",
                state.time
            );
        }
    }
}

/// A storey released beyond its yield force unloads elastically; dissipated energy never decreases.
#[test]
fn hysteretic_storeys_start_from_their_static_state() {
    let roof = DofCombination::from(building(1).roof());
    let law = Bilinear::new(4.0e6, 10.0e3, 0.2).unwrap();
    let structure = building(1).with_law(0, law).unwrap();
    let mut simulation = on_half_plane(structure)
        .interface(Bonded)
        .load(Load::released(roof.clone(), 15.0e3))
        .build()
        .unwrap();
    let mut dissipated_energy = simulation.state().energy_balance.hysteresis;
    let run = simulation
        .run(400, |state| {
            let energy_balance = state.energy_balance;
            assert!(energy_balance.hysteresis >= dissipated_energy - 1e-9, "{energy_balance}");
            dissipated_energy = energy_balance.hysteresis;
        })
        .unwrap();
    assert!(run.energy_error < 1e-9);
    // On the elastic branch 15 kN less reduce the drift by at most 15/4 mm.
    let displacement = roof.value(simulation.state().displacement());
    assert!(displacement < 0.0 && displacement > -2.0 * 15.0e3 / 4.0e6, "{displacement}");
}

/// A dropped, tilted block under a harmonic load.
fn dropped_block(gravity: f64) -> Simulation {
    on_half_plane(block())
        .interface(Coulomb::new(0.5).unwrap())
        .gravity(gravity)
        .load(Load::new(block().horizontal_at(9.0), |t| 1.0e5 * (9.0 * t).sin()))
        .gravity_stage(GravityStage::Unloaded)
        .initial_displacement([0.0, 0.03, 0.01])
        .build()
        .unwrap()
}

/// Runs with loads and initial motion resume to the last bit; another weight is an error.
#[test]
fn runs_with_loads_and_initial_motion_resume() {
    let mut uninterrupted_simulation = dropped_block(STANDARD_GRAVITY);
    uninterrupted_simulation.run(77, |_| {}).unwrap();
    let checkpoint = uninterrupted_simulation.checkpoint().unwrap();
    uninterrupted_simulation.run(100, |_| {}).unwrap();
    let mut resumed_simulation = dropped_block(STANDARD_GRAVITY);
    resumed_simulation.resume(&checkpoint).unwrap();
    resumed_simulation.run(100, |_| {}).unwrap();
    assert_eq!(resumed_simulation.state(), uninterrupted_simulation.state());
    let error = dropped_block(1.62).resume(&checkpoint).unwrap_err();
    assert!(error.to_string().contains("static state"), "{error}");
}

/// A block under a constant load and a load with these values, both at its top.
fn block_under_two_loads(second_load: fn(f64) -> f64) -> Simulation {
    let top = block().horizontal_at(9.0);
    on_half_plane(block())
        .interface(Coulomb::new(0.5).unwrap())
        .load(Load::constant(top.clone(), 30.0e3))
        .load(Load::new(top, second_load))
        .build()
        .unwrap()
}

/// A load that is set before every step acts as the function with these values.
#[test]
fn a_load_that_is_set_acts_from_then_on() {
    fn push(time: f64) -> f64 {
        200.0e3 * (12.0 * time).sin()
    }

    let mut by_function = block_under_two_loads(push);
    let mut by_setting = block_under_two_loads(|_| 0.0);
    let start = by_setting.checkpoint().unwrap();
    for _ in 0..200 {
        let middle = by_function.state().time + 0.5 * by_function.time_step();
        by_setting.set_load(1, push(middle)).unwrap();
        by_function.step().unwrap();
        by_setting.step().unwrap();
    }
    assert_eq!(by_setting.state().displacement(), by_function.state().displacement());
    assert!(by_function.state().base_shear.abs() > 50.0e3);

    // A checkpoint and `None` restore the load's function.
    let mut simulation_with_function = block_under_two_loads(|_| 0.0);
    by_setting.resume(&start).unwrap();
    let mut unset = block_under_two_loads(|_| 0.0);
    unset.set_load(1, 1e6).unwrap();
    unset.set_load(1, None).unwrap();
    for simulation in [&mut by_setting, &mut unset, &mut simulation_with_function] {
        simulation.run(20, |_| {}).unwrap();
    }
    assert_eq!(by_setting.state().displacement(), simulation_with_function.state().displacement());
    assert_eq!(unset.state().displacement(), simulation_with_function.state().displacement());
    let unknown = simulation_with_function.set_load(2, 1.0).unwrap_err();
    assert!(matches!(unknown, Error::Index { index: 2, bound: 2, .. }), "{unknown}");
    assert!(matches!(
        simulation_with_function.set_load(0, f64::NAN),
        Err(Error::NotFinite { index: 0, .. })
    ));
}

/// A checkpoint contains the force that is set, also for another simulation.
#[test]
fn a_load_that_is_set_acts_after_a_checkpoint() {
    let mut pushed_simulation = block_under_two_loads(|_| 0.0);
    pushed_simulation.set_load(1, 100e3).unwrap();
    pushed_simulation.run(30, |_| {}).unwrap();
    let checkpoint = pushed_simulation.checkpoint().unwrap();
    let mut resumed_simulation = block_under_two_loads(|_| 0.0);
    resumed_simulation.resume(&checkpoint).unwrap();
    let mut with_changed_load = block_under_two_loads(|_| 0.0);
    with_changed_load.resume_changed(&checkpoint, &[Change::Load]).unwrap();
    for simulation in [&mut pushed_simulation, &mut resumed_simulation, &mut with_changed_load] {
        simulation.run(20, |_| {}).unwrap();
    }
    assert_eq!(resumed_simulation.state(), pushed_simulation.state());
    assert_ne!(with_changed_load.state().displacement(), pushed_simulation.state().displacement());
}
