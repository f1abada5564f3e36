//! GOAL: reduced coordinates keep their tolerance, the energy balance and all that is read off a run.
//! SCENE: damped towers of 1 092 degrees of freedom, bonded, uplifting and sliding, by all schemes; two towers; loads; a
//! start in motion; structures that cannot be reduced.
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
use basemat_problems::scenes::{Rider, SI, apart, block, friction, scene, shake, states};

const STEPS: usize = 300;

fn damping() -> RayleighDamping {
    RayleighDamping::from_ratios([2.0, 20.0], [0.05; 2]).unwrap()
}

/// Tower over x of `columns` × `rows` elements without damping.
fn bare(x: std::ops::Range<f64>, columns: usize, rows: usize) -> FemModel {
    let material = Material::new(2e8, 0.2, 1500.0).unwrap();
    let mesh = Mesh::layered_block(x, columns, &[Layer::new(8.0, rows, material)]).unwrap();
    FemModel::on_base(mesh).unwrap()
}

fn tower() -> FemModel {
    bare(-2.0..2.0, 20, 25).with_rayleigh(damping())
}

fn reduced(tolerance: f64) -> Coordinates {
    Coordinates::Reduced { tolerance }
}

fn roof() -> DofCombination {
    DofCombination::from(tower().dofs() - 2)
}

fn march(builder: SimulationBuilder, coordinates: Coordinates) -> Vec<State> {
    states(&mut builder.coordinates(coordinates).build().unwrap(), STEPS)
}

/// Errors of base shear, of all displacements and of each probe; all energy balances close.
fn errors(make: &dyn Fn() -> SimulationBuilder, tolerance: f64) -> Vec<f64> {
    let full = march(make(), Coordinates::Physical);
    let few = march(make(), reduced(tolerance));
    assert_eq!(few[0].displacement().len(), full[0].displacement().len());
    assert!(few.iter().all(|state| state.energy_balance.residual() < 1e-9));
    let mut errors = vec![
        apart(&full, &few, |s| vec![s.base_shear]),
        apart(&full, &few, |s| s.absolute_displacement().to_vec()),
    ];
    let probes = 0..full[0].probes.len();
    errors.extend(probes.map(|k| apart(&full, &few, |s| vec![s.probes[k]])));
    println!("{tolerance:e}: {errors:?}, {} uplifted", full[STEPS].uplifted_fraction);
    errors
}

fn within(errors: &[f64], tolerance: f64) {
    assert!(errors.iter().all(|error| *error < tolerance), "{tolerance:e}: {errors:?}");
}

fn probed(builder: SimulationBuilder) -> SimulationBuilder {
    let builder = builder.probe(Probe::displacement("roof", roof()));
    builder.probe(Probe::acceleration("acceleration", roof()))
}

#[test]
fn bonded_towers_keep_the_tolerance() {
    let make = || probed(scene(SI, 0.6).structure(tower()).interface(Bonded));
    let mut last = f64::INFINITY;
    for tolerance in [1e-3, 1e-5, 1e-8] {
        let errors = errors(&make, tolerance);
        within(&errors, tolerance);
        assert!(errors[3] < last, "{errors:?}");
        last = 0.3 * errors[3];
    }
    // Without a tolerance nothing is reduced.
    let few = || make().expected_steps(STEPS);
    assert_eq!(march(few(), Coordinates::Auto), march(few(), Coordinates::Physical));
}

#[test]
fn towers_that_uplift_and_slide_keep_it() {
    for coefficient in [0.3, f64::INFINITY] {
        let law = || friction(coefficient);
        let make = || probed(scene(SI, 1.0).structure(tower()).interface(law()));
        let states = march(make(), reduced(1e-6));
        let (uplift, slip) =
            (|s: &State| s.uplifted_fraction, |s: &State| s.value(Quantity::LargestSlip));
        let most = |of: &dyn Fn(&State) -> f64| states.iter().map(of).fold(0.0, f64::max);
        assert!(most(&uplift) > 0.2 || most(&slip) > 1e-3);
        within(&errors(&make, 1e-6), 1e-6);
    }
}

#[test]
fn all_schemes_are_reduced() {
    let schemes: [fn(SimulationBuilder) -> SimulationBuilder; 5] = [
        |builder| builder.scheme(Midpoint),
        |builder| builder.scheme(Theta::new(0.7).unwrap()),
        |builder| builder.scheme(Newmark::new(0.6, 0.3025).unwrap()),
        |builder| builder.scheme(HhtAlpha::new(-0.1).unwrap()),
        |builder| builder.scheme(DissipativeMidpoint::default()),
    ];
    for scheme in schemes {
        let make = || {
            let builder = scene(SI, 0.8).structure(tower()).interface(friction(0.4));
            scheme(probed(builder).without_energy_balance())
        };
        let full = march(make(), Coordinates::Physical);
        let few = march(make(), reduced(1e-5));
        within(&[apart(&full, &few, |s| vec![s.base_shear])], 1e-5);
        within(&[apart(&full, &few, |s| vec![s.probes[1]])], 1e-5);
    }
}

#[test]
fn loads_motions_and_probes_are_in_the_basis() {
    let n = tower().dofs();
    let push = |t: f64| 2e4 * (20.0 * t).sin();
    let drift = DofCombination::from(n - 2) - DofCombination::from(n - 802);
    let start: Vec<f64> = (0..n).map(|i| if i > 500 { (i as f64).sin() } else { 0.0 }).collect();
    let small = |scale: f64| start.iter().map(|x| scale * x).collect::<Vec<_>>();
    let make = || {
        let gradual = Load::new(DofCombination::from(n - 301), push);
        let builder = scene(SI, 0.1).structure(tower()).interface(Bonded);
        let builder = builder.load(gradual).load(Load::released(DofCombination::from(n - 2), 1e4));
        let builder = builder.initial_displacement(small(1e-4)).initial_velocity(small(1e-2));
        builder.probe(Probe::displacement("drift", drift.clone()))
    };
    within(&errors(&make, 1e-6), 1e-6);
    let few = make().coordinates(reduced(1e-6)).build().unwrap();
    for (x, given) in few.state().displacement().iter().zip(small(1e-4)) {
        assert!((x - given).abs() < 1e-12);
    }
    let drop = || make().gravity_stage(GravityStage::Unloaded);
    within(&errors(&drop, 1e-6), 1e-6);
}

/// Loads that jump: what probes read, accelerations and section forces as well, is within the tolerance of its
/// largest value.
#[test]
fn loads_that_jump_keep_it() {
    let lightly = RayleighDamping::from_ratios([2.0, 20.0], [0.02; 2]).unwrap();
    let tower = || bare(-2.0..2.0, 20, 25).with_rayleigh(lightly);
    let section = tower().section(3.84, 0.0).unwrap();
    let n = tower().dofs();
    let jump = |t: f64| if t > 0.05 { 1e5 } else { 0.0 };
    let square = |t: f64| if (10.0 * t) % 2.0 > 1.0 { 1e5 } else { 0.0 };
    let values: [fn(f64) -> f64; 2] = [jump, square];
    for (row, tolerance) in [(n - 2, 1e-5), (n - 802, 1e-3), (n - 802, 1e-7)] {
        for value in values {
            let make = || {
                let builder = scene(SI, 0.0).structure(tower()).interface(Bonded);
                builder
                    .load(Load::new(DofCombination::from(row), value))
                    .probe(Probe::velocity("roof's velocity", roof()))
                    .probe(Probe::acceleration("roof", roof()))
                    .probe(Probe::acceleration("below the load", DofCombination::from(row)))
                    .probe(Probe::section("shear", &section.shear))
                    .probe(Probe::section("compression", &section.compression))
                    .probe(Probe::section("moment", &section.moment))
            };
            within(&errors(&make, tolerance), tolerance);
        }
    }
}

#[test]
fn groups_are_reduced_together() {
    let towers = || {
        let softer = RayleighDamping::from_ratios([1.0, 10.0], [0.05; 2]).unwrap();
        let left = bare(-7.0..-3.0, 10, 20).with_rayleigh(damping());
        StructureGroup::new()
            .with(left, 0.0)
            .and_then(|group| group.with(bare(3.0..8.0, 12, 20).with_rayleigh(softer), 0.0))
            .unwrap()
    };
    let make = || {
        let ground = Soil::new(6e7, 0.3, 1900.0).unwrap();
        let ground = ElasticGround::under(ground, &towers(), 6).unwrap();
        let builder = Simulation::builder(2.5e-3).ground(ground).structure(towers());
        builder.motion(shake(SI, 0.3)).interface(Bonded)
    };
    within(&errors(&make, 1e-5), 1e-5);
}

#[test]
fn runs_resume_to_the_bit() {
    let make = |tolerance| {
        let builder = scene(SI, 0.8).structure(tower()).interface(friction(0.3));
        builder.coordinates(reduced(tolerance)).build().unwrap()
    };
    let mut whole = make(1e-5);
    whole.run(100, |_| {}).unwrap();
    let saved = whole.checkpoint().unwrap();
    whole.run(100, |_| {}).unwrap();
    let mut other = make(1e-5);
    other.resume(&saved).unwrap();
    other.run(100, |_| {}).unwrap();
    assert_eq!(other.state(), whole.state());
    assert!(matches!(make(1e-8).resume(&saved), Err(Error::Checkpoint(_))));
}

/// A small structure is reduced to itself, undamped or not.
#[test]
fn small_structures_lose_nothing() {
    let storeys = [Storey::new(1.5, 3.0e3, 2.0e6); 4];
    let building = || ShearBuilding::new(4.0, 5e3, 1e4, &storeys).unwrap();
    let make = || scene(SI, 0.6).structure(building()).interface(friction(0.5));
    within(&errors(&make, 1e-6), 1e-8);
    let leaning = || building().with_p_delta(9.81).unwrap();
    let make = || scene(SI, 0.6).structure(leaning()).interface(friction(0.5));
    within(&errors(&make, 1e-6), 1e-8);
    let make = || scene(SI, 0.6).structure(block(SI)).interface(friction(0.3));
    within(&errors(&make, 1e-6), 1e-8);
}

/// Rayleigh damping leaves P–Δ out, and so couples the modes. Before, it was refused for that.
///
/// The coupling has no check of its own: accelerations may err by a little more than the tolerance.
#[test]
fn rayleigh_damping_with_p_delta_is_reduced() {
    let leaning = || tower().with_p_delta(9.81).unwrap();
    let bonded = || probed(scene(SI, 0.6).structure(leaning()).interface(Bonded));
    let errors = errors(&bonded, 1e-3);
    within(&errors[..3], 1e-4);
    within(&errors[3..], 1.2e-3);
}

#[test]
fn others_are_refused_by_name() {
    struct Dashpot(FemModel);
    impl Structure for Dashpot {
        needed_from!(0);
        fn damping(&self, matrix: &mut Triplets) -> basemat::Result<()> {
            self.0.damping(matrix)?;
            matrix.add_spring(0, 400, 1e4);
            Ok(())
        }
    }
    let refused = |builder: SimulationBuilder, tolerance: f64| {
        let builder = builder.interface(Bonded).motion(el_centro_1940());
        match builder.coordinates(reduced(tolerance)).build().map(|_| ()) {
            Err(error) => error,
            other => panic!("{other:?}"),
        }
    };
    let small = || scene(SI, 0.1);
    let cause = refused(small().structure(Rider { block: block(SI) }), 1e-6);
    let needed = "they need a linear structure";
    assert_eq!(cause, Error::Scene { quantity: "reduced coordinates", needed });
    let cause = refused(small().structure(Dashpot(tower())), 1e-6);
    let Error::Item { item, source } = &cause else { panic!("{cause}") };
    let Error::Input { quantity, value: coupling, .. } = **source else { panic!("{cause}") };
    assert!(item == "reduced coordinates" && quantity.contains("coupling of the modes"), "{cause}");
    assert!(coupling > 1e-10, "{cause}");
    let undamped = || bare(-2.0..2.0, 20, 25);
    let probe = Probe::acceleration("roof", roof());
    let cause = refused(small().structure(undamped()).probe(probe), 1e-3);
    assert!(matches!(cause, Error::Accuracy { reached, .. } if reached > 1e-3), "{cause}");
    let cause = refused(small().structure(tower()), 1e-15);
    let asked = |tolerance: f64| (tolerance / 1e-15 - 1.0).abs() < 1e-9;
    let vectors = |remedy: &str| remedy.split(' ').nth(1).unwrap().parse::<usize>().unwrap();
    assert!(
        matches!(&cause, Error::Accuracy { tolerance, reached, remedy, .. }
            if asked(*tolerance) && reached > tolerance && vectors(remedy) > 20),
        "{cause}"
    );
    for tolerance in [0.0, -1.0, 1.0, f64::NAN, f64::INFINITY] {
        let builder = small().structure(tower()).interface(Bonded);
        let error = builder.coordinates(reduced(tolerance)).build().map(|_| ()).unwrap_err();
        assert!(matches!(error, Error::Input { .. }), "{error}");
    }
}
