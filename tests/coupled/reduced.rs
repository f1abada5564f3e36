//! GOAL: runs in reduced coordinates keep their tolerance, the energy balance and all results.
//! SCENE: damped towers of 1 092 degrees of freedom, bonded, uplifting and sliding, by all schemes; two towers; loads;
//! initial motion; structures that cannot be reduced.
//! REFERENCE: the run in degrees of freedom; the energy balance; a run without interruption.

use basemat::bem::ElasticGround;
use basemat::coupled::{
    Coordinates, DissipativeMidpoint, GravityStage, HhtAlpha, Load, Midpoint, Newmark, Probe,
    SimulationBuilder, State, Theta,
};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Bonded;
use basemat::motion::el_centro_1940;
use basemat::results::Quantity;
use basemat::structure::{
    DofCombination, FemModel, RayleighDamping, ShearBuilding, Storey, Structure, StructureGroup,
    Triplets,
};
use basemat::{Error, Simulation, Soil};

use basemat_problems::needed_from;
use basemat_problems::scenes::{Rider, SI_UNITS, apart, block, friction, scene, shake, states};

const RUN_STEPS: usize = 300;

fn damping() -> RayleighDamping {
    RayleighDamping::from_ratios([2.0, 20.0], [0.05; 2]).unwrap()
}

/// Tower over x of `columns` × `rows` elements without damping.
fn undamped_tower(x: std::ops::Range<f64>, columns: usize, rows: usize) -> FemModel {
    let material = Material::new(2e8, 0.2, 1500.0).unwrap();
    let mesh = Mesh::layered_block(x, columns, &[Layer::new(8.0, rows, material)]).unwrap();
    FemModel::on_base(mesh).unwrap()
}

fn tower() -> FemModel {
    undamped_tower(-2.0..2.0, 20, 25).with_rayleigh(damping())
}

fn reduced(tolerance: f64) -> Coordinates {
    Coordinates::Reduced { tolerance }
}

fn roof() -> DofCombination {
    DofCombination::from(tower().dofs() - 2)
}

fn run_states(builder: SimulationBuilder, coordinates: Coordinates) -> Vec<State> {
    states(&mut builder.coordinates(coordinates).build().unwrap(), RUN_STEPS)
}

/// Errors of base shear, of all displacements and of each probe; all energy balances must close.
fn errors(make_scene: impl Fn() -> SimulationBuilder, tolerance: f64) -> Vec<f64> {
    let reference = run_states(make_scene(), Coordinates::Physical);
    let computed = run_states(make_scene(), reduced(tolerance));
    assert_eq!(computed[0].displacement().len(), reference[0].displacement().len());
    assert!(computed.iter().all(|state| state.energy_balance.residual() < 1e-9));
    let mut errors = vec![
        apart(&reference, &computed, |s| vec![s.base_shear]),
        apart(&reference, &computed, |s| s.absolute_displacement().to_vec()),
    ];
    for k in 0..reference[0].probes.len() {
        errors.push(apart(&reference, &computed, |s| vec![s.probes[k]]));
    }
    println!("{tolerance:e}: {errors:?}, {} uplifted", reference[RUN_STEPS].uplifted_fraction);
    errors
}

fn assert_below(errors: &[f64], tolerance: f64) {
    assert!(errors.iter().all(|error| *error < tolerance), "{tolerance:e}: {errors:?}");
}

fn with_roof_probes(builder: SimulationBuilder) -> SimulationBuilder {
    let builder = builder.probe(Probe::displacement("roof", roof()));
    builder.probe(Probe::acceleration("acceleration", roof()))
}

fn bonded_tower() -> SimulationBuilder {
    with_roof_probes(scene(SI_UNITS, 0.6).structure(tower()).interface(Bonded))
}

#[test]
fn bonded_towers_keep_the_tolerance() {
    let mut previous_error = f64::INFINITY;
    for tolerance in [1e-3, 1e-5, 1e-8] {
        let errors = errors(bonded_tower, tolerance);
        assert_below(&errors, tolerance);
        assert!(errors[3] < previous_error, "{errors:?}");
        previous_error = 0.3 * errors[3];
    }
    // Without a tolerance nothing is reduced.
    let auto = run_states(bonded_tower().expected_steps(RUN_STEPS), Coordinates::Auto);
    let physical = run_states(bonded_tower().expected_steps(RUN_STEPS), Coordinates::Physical);
    assert_eq!(auto, physical);
}

/// A strongly shaken tower on friction.
fn tower_on_friction(coefficient: f64) -> SimulationBuilder {
    with_roof_probes(scene(SI_UNITS, 1.0).structure(tower()).interface(friction(coefficient)))
}

#[test]
fn towers_that_uplift_and_slide_keep_it() {
    for coefficient in [0.3, f64::INFINITY] {
        let mut largest_uplift = 0.0_f64;
        let mut largest_slip = 0.0_f64;
        for state in run_states(tower_on_friction(coefficient), reduced(1e-6)) {
            largest_uplift = largest_uplift.max(state.uplifted_fraction);
            largest_slip = largest_slip.max(state.value(Quantity::LargestSlip));
        }
        assert!(largest_uplift > 0.2 || largest_slip > 1e-3);
        assert_below(&errors(|| tower_on_friction(coefficient), 1e-6), 1e-6);
    }
}

#[test]
fn all_schemes_are_reduced() {
    let set_schemes: [fn(SimulationBuilder) -> SimulationBuilder; 5] = [
        |builder| builder.scheme(Midpoint),
        |builder| builder.scheme(Theta::new(0.7).unwrap()),
        |builder| builder.scheme(Newmark::new(0.6, 0.3025).unwrap()),
        |builder| builder.scheme(HhtAlpha::new(-0.1).unwrap()),
        |builder| builder.scheme(DissipativeMidpoint::default()),
    ];
    for set_scheme in set_schemes {
        let [reference, computed] = [Coordinates::Physical, reduced(1e-5)].map(|coordinates| {
            let builder = scene(SI_UNITS, 0.8).structure(tower()).interface(friction(0.4));
            let builder = with_roof_probes(builder).without_energy_balance();
            run_states(set_scheme(builder), coordinates)
        });
        assert_below(&[apart(&reference, &computed, |s| vec![s.base_shear])], 1e-5);
        assert_below(&[apart(&reference, &computed, |s| vec![s.probes[1]])], 1e-5);
    }
}

/// Irregular motion of the upper part of the tower.
fn initial_motion(amplitude: f64) -> Vec<f64> {
    let dofs = tower().dofs();
    let shape = (0..dofs).map(|i| if i > 500 { (i as f64).sin() } else { 0.0 });
    shape.map(|value| amplitude * value).collect()
}

/// A bonded tower with a harmonic and a released load, initial motion and a probe of a drift.
fn loaded_tower() -> SimulationBuilder {
    let dofs = tower().dofs();
    let harmonic = Load::new(DofCombination::from(dofs - 301), |t: f64| 2e4 * (20.0 * t).sin());
    let drift = DofCombination::from(dofs - 2) - DofCombination::from(dofs - 802);
    scene(SI_UNITS, 0.1)
        .structure(tower())
        .interface(Bonded)
        .load(harmonic)
        .load(Load::released(DofCombination::from(dofs - 2), 1e4))
        .initial_displacement(initial_motion(1e-4))
        .initial_velocity(initial_motion(1e-2))
        .probe(Probe::displacement("drift", drift))
}

#[test]
fn loads_motions_and_probes_are_in_the_basis() {
    assert_below(&errors(loaded_tower, 1e-6), 1e-6);
    let simulation = loaded_tower().coordinates(reduced(1e-6)).build().unwrap();
    for (computed, expected) in simulation.state().displacement().iter().zip(initial_motion(1e-4)) {
        assert!((computed - expected).abs() < 1e-12);
    }
    let dropped_tower = || loaded_tower().gravity_stage(GravityStage::Unloaded);
    assert_below(&errors(dropped_tower, 1e-6), 1e-6);
}

/// A lightly damped tower under a load on one degree of freedom, with probes of all kinds.
fn tower_under_load(dof: usize, load: fn(f64) -> f64) -> SimulationBuilder {
    let light_damping = RayleighDamping::from_ratios([2.0, 20.0], [0.02; 2]).unwrap();
    let tower = undamped_tower(-2.0..2.0, 20, 25).with_rayleigh(light_damping);
    let section = tower.section(3.84, 0.0).unwrap();
    scene(SI_UNITS, 0.0)
        .structure(tower)
        .interface(Bonded)
        .load(Load::new(DofCombination::from(dof), load))
        .probe(Probe::velocity("roof's velocity", roof()))
        .probe(Probe::acceleration("roof", roof()))
        .probe(Probe::acceleration("below the load", DofCombination::from(dof)))
        .probe(Probe::section("shear", &section.shear))
        .probe(Probe::section("compression", &section.compression))
        .probe(Probe::section("moment", &section.moment))
}

/// Under loads that jump each probe is within the tolerance of its largest value.
///
/// So are accelerations and section forces.
#[test]
fn loads_that_jump_keep_it() {
    fn jump(time: f64) -> f64 {
        if time > 0.05 { 1e5 } else { 0.0 }
    }

    fn square_wave(time: f64) -> f64 {
        if (10.0 * time) % 2.0 > 1.0 { 1e5 } else { 0.0 }
    }

    let dofs = tower().dofs();
    for (dof, tolerance) in [(dofs - 2, 1e-5), (dofs - 802, 1e-3), (dofs - 802, 1e-7)] {
        for load in [jump, square_wave] {
            assert_below(&errors(|| tower_under_load(dof, load), tolerance), tolerance);
        }
    }
}

/// Two towers of different damping beside each other.
fn two_towers() -> StructureGroup {
    let softer_damping = RayleighDamping::from_ratios([1.0, 10.0], [0.05; 2]).unwrap();
    let left = undamped_tower(-7.0..-3.0, 10, 20).with_rayleigh(damping());
    let right = undamped_tower(3.0..8.0, 12, 20).with_rayleigh(softer_damping);
    StructureGroup::new().with(left, 0.0).unwrap().with(right, 0.0).unwrap()
}

fn two_towers_on_soil() -> SimulationBuilder {
    let soil = Soil::new(6e7, 0.3, 1900.0).unwrap();
    let ground = ElasticGround::under(soil, &two_towers(), 6).unwrap();
    let builder = Simulation::builder(2.5e-3).ground(ground).structure(two_towers());
    builder.motion(shake(SI_UNITS, 0.3)).interface(Bonded)
}

#[test]
fn groups_are_reduced_together() {
    assert_below(&errors(two_towers_on_soil, 1e-5), 1e-5);
}

fn sliding_tower(tolerance: f64) -> Simulation {
    let builder = scene(SI_UNITS, 0.8).structure(tower()).interface(friction(0.3));
    builder.coordinates(reduced(tolerance)).build().unwrap()
}

#[test]
fn runs_resume_to_the_bit() {
    let mut uninterrupted_simulation = sliding_tower(1e-5);
    uninterrupted_simulation.run(100, |_| {}).unwrap();
    let checkpoint = uninterrupted_simulation.checkpoint().unwrap();
    uninterrupted_simulation.run(100, |_| {}).unwrap();
    let mut resumed_simulation = sliding_tower(1e-5);
    resumed_simulation.resume(&checkpoint).unwrap();
    resumed_simulation.run(100, |_| {}).unwrap();
    assert_eq!(resumed_simulation.state(), uninterrupted_simulation.state());
    let result = sliding_tower(1e-8).resume(&checkpoint);
    assert!(matches!(result, Err(Error::Checkpoint(_))));
}

fn small_building() -> ShearBuilding {
    let storeys = [Storey::new(1.5, 3.0e3, 2.0e6); 4];
    ShearBuilding::new(4.0, 5e3, 1e4, &storeys).unwrap()
}

/// A small structure keeps all its modes, undamped or not.
#[test]
fn small_structures_lose_nothing() {
    let building = || scene(SI_UNITS, 0.6).structure(small_building()).interface(friction(0.5));
    assert_below(&errors(building, 1e-6), 1e-8);
    let with_p_delta = || {
        let building = small_building().with_p_delta(9.81).unwrap();
        scene(SI_UNITS, 0.6).structure(building).interface(friction(0.5))
    };
    assert_below(&errors(with_p_delta, 1e-6), 1e-8);
    let rigid_block = || scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(friction(0.3));
    assert_below(&errors(rigid_block, 1e-6), 1e-8);
}

fn bonded_tower_with_p_delta() -> SimulationBuilder {
    let tower = tower().with_p_delta(9.81).unwrap();
    with_roof_probes(scene(SI_UNITS, 0.6).structure(tower).interface(Bonded))
}

/// Rayleigh damping without P–Δ couples the modes of a structure with P–Δ.
///
/// The reduction does not bound the coupling: accelerations may err by a little more than the tolerance.
#[test]
fn rayleigh_damping_with_p_delta_is_reduced() {
    let errors = errors(bonded_tower_with_p_delta, 1e-3);
    assert_below(&errors[..3], 1e-4);
    assert_below(&errors[3..], 1.2e-3);
}

/// A tower with a dashpot that couples its modes.
struct DampedTowerWithDashpot(FemModel);

impl Structure for DampedTowerWithDashpot {
    needed_from!(0);

    fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        self.0.damping(matrix)?;
        matrix.add_spring(0, 400, 1e4);
        Ok(())
    }
}

/// Error of this bonded scene in reduced coordinates.
fn error_of_reduction(builder: SimulationBuilder, tolerance: f64) -> Error {
    let builder = builder.interface(Bonded).motion(el_centro_1940());
    match builder.coordinates(reduced(tolerance)).build() {
        Err(error) => error,
        Ok(_) => panic!("the scene is reduced"),
    }
}

#[test]
fn structures_that_cannot_be_reduced_are_named() {
    let rider = scene(SI_UNITS, 0.1).structure(Rider { block: block(SI_UNITS) });
    let needed = "they need a linear structure";
    let nonlinear = Error::Scene { quantity: "reduced coordinates", needed };
    assert_eq!(error_of_reduction(rider, 1e-6), nonlinear);
    let with_dashpot = scene(SI_UNITS, 0.1).structure(DampedTowerWithDashpot(tower()));
    let error = error_of_reduction(with_dashpot, 1e-6);
    let Error::Item { item, source } = &error else { panic!("{error}") };
    let Error::Input { quantity, value: coupling, .. } = **source else {
        panic!("{error}")
    };
    assert!(item == "reduced coordinates" && quantity.contains("coupling of the modes"), "{error}");
    assert!(coupling > 1e-10, "{error}");
}

#[test]
fn tolerances_that_cannot_be_reached_are_errors() {
    let undamped_scene = scene(SI_UNITS, 0.1).structure(undamped_tower(-2.0..2.0, 20, 25));
    let error = error_of_reduction(undamped_scene.probe(Probe::acceleration("roof", roof())), 1e-3);
    assert!(matches!(error, Error::Accuracy { reached, .. } if reached > 1e-3), "{error}");
    let error = error_of_reduction(scene(SI_UNITS, 0.1).structure(tower()), 1e-15);
    let Error::Accuracy { tolerance, reached, remedy, .. } = &error else {
        panic!("{error}")
    };
    let vectors: usize = remedy.split(' ').nth(1).unwrap().parse().unwrap();
    assert!((tolerance / 1e-15 - 1.0).abs() < 1e-9 && reached > tolerance, "{error}");
    assert!(vectors > 20, "{error}");
    for tolerance in [0.0, -1.0, 1.0, f64::NAN, f64::INFINITY] {
        let builder = scene(SI_UNITS, 0.1).structure(tower()).interface(Bonded);
        let error = builder.coordinates(reduced(tolerance)).build().map(|_| ()).unwrap_err();
        assert!(matches!(error, Error::Input { .. }), "{error}");
    }
}
