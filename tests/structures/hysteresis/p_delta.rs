//! GOAL: P–Δ of isolated and yielding buildings.
//! SCENE: bearings under the weight above, a storey at its buckling load, columns that collapse.
//! REFERENCE: the potential energy of the weight, differentiated twice; typed errors.

use crate::structures::curvature;
use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::coupled::Probe;
use basemat::coupled::StepError;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::results::Run;
use basemat::structure::{
    Bilinear, FrictionPendulum, Hysteresis, IsolationLevel, LeadRubber, ShearBuilding, Storey,
    Structure, Triplets,
};
use basemat::{Error, Simulation, Soil};

const ISOLATION_LEVEL: IsolationLevel =
    IsolationLevel { height: 0.3, slab_mass: 30.0e3, slab_inertia: 2.5e5, damping: 0.0 };
const ISOLATED_WEIGHT: f64 = STANDARD_GRAVITY * 130.0e3;

fn building(gravity: f64) -> ShearBuilding {
    let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
    let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys).unwrap();
    building.with_p_delta(gravity).unwrap()
}

/// El Centro on soil, the base free to uplift and slide; the probe is the drift of the isolators.
fn shaken(gravity: f64, law: impl Hysteresis + 'static) -> Run {
    let structure = building(gravity).isolated(ISOLATION_LEVEL, law).unwrap();
    let drift = structure.drift(0).unwrap();
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    Simulation::builder(5e-3)
        .structure(structure)
        .ground(ElasticGround::new(soil, Strip::uniform(-5.0..5.0, 6).unwrap()).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .motion(el_centro_1940())
        .gravity(STANDARD_GRAVITY)
        .probe(Probe::displacement("drift", drift))
        .build()
        .unwrap()
        .run(2000, |_| {})
        .unwrap()
}

/// Largest drift of the isolators.
fn largest_drift(gravity: f64, law: impl Hysteresis + 'static) -> f64 {
    let run = shaken(gravity, law);
    assert!(run.energy_error < 1e-9);
    run.probe("drift").unwrap().magnitude()
}

/// The weight alone would give bearings 0.3 m high −4.2 MN/m; they have 0.6 MN/m after yielding.
#[test]
fn isolators_drift_as_they_do_without_p_delta() {
    let pendulum = FrictionPendulum::new(ISOLATED_WEIGHT, 2.0, 0.06).unwrap();
    let rubber = LeadRubber::from_strength(0.6e6, 0.05 * ISOLATED_WEIGHT).unwrap();
    let pairs = [
        [largest_drift(0.0, pendulum.clone()), largest_drift(STANDARD_GRAVITY, pendulum)],
        [largest_drift(0.0, rubber.clone()), largest_drift(STANDARD_GRAVITY, rubber)],
    ];
    for [without, with] in pairs {
        println!("{:.1} mm, with P–Δ {:.1} mm", 1e3 * without, 1e3 * with);
        assert!((0.03..0.2).contains(&without));
        assert!((with / without - 1.0).abs() < 0.1, "{without} {with}");
    }
}

/// Stiffness matrix of the isolated building.
fn isolated_stiffness(gravity: f64) -> [[f64; 9]; 9] {
    let law = Bilinear::new(1.0e6, 1.0e4, 0.1).unwrap();
    let isolated_building = building(gravity).isolated(ISOLATION_LEVEL, law).unwrap();
    let mut triplets = Triplets::new(9);
    isolated_building.stiffness(&mut triplets).unwrap();
    let mut matrix = [[0.0; 9]; 9];
    for &(i, j, value) in triplets.entries() {
        matrix[i][j] += value;
    }
    matrix
}

/// Potential energy of the weights on inextensible columns.
fn potential_energy(u: &[f64; 9]) -> f64 {
    let (sin, cos) = u[2].sin_cos();
    // The slider stands on the turned plane where the slab moves by u_3.
    let along = (u[3] - u[0] + ISOLATION_LEVEL.height * sin) / cos;
    let mut height = along * sin + ISOLATION_LEVEL.height * cos;
    let mut sum = 10.0 * ISOLATION_LEVEL.slab_mass * height;
    for floor in 4..9 {
        height += (9.0 - (u[floor] - u[floor - 1]).powi(2)).sqrt();
        sum += 10.0 * 20.0e3 * height;
    }
    sum
}

/// The height of the weights on a slider that moves along the plane of a base that turns, with
/// inextensible columns above, differentiated twice by differences.
#[test]
fn the_weight_on_isolators_has_the_curvature_of_its_potential() {
    let stiffness_with_p_delta = isolated_stiffness(10.0);
    let stiffness_without_p_delta = isolated_stiffness(0.0);
    for i in 0..9 {
        for j in 0..9 {
            let curvature = curvature(potential_energy, [i, j], 1e-3);
            let computed = stiffness_with_p_delta[i][j] - stiffness_without_p_delta[i][j];
            assert!((computed - curvature).abs() < 1e-5 * 1.3e6, "({i}, {j}): {computed} {curvature}");
        }
    }
}

fn two_storeys() -> ShearBuilding {
    let storeys = [Storey::new(3.0, 1000.0, 1.0e4), Storey::new(2.0, 1000.0, 1.0e6)];
    ShearBuilding::new(5.0, 1000.0, 1000.0, &storeys).unwrap()
}

/// The lower storey with a law of this initial stiffness, under its weight.
fn yielding_under_weight(stiffness: f64) -> basemat::Result<ShearBuilding> {
    let building = two_storeys().with_p_delta(10.0).unwrap();
    building.with_law(0, Bilinear::new(stiffness, 10.0, 0.5).unwrap())
}

/// A storey of k = W/h is at its buckling load.
#[test]
fn columns_that_would_buckle_are_errors() {
    // 2000 g/3 against 1e4: the lower storey buckles at 15 m/s².
    assert!(two_storeys().with_p_delta(14.999).is_ok());
    for gravity in [15.001, 1e3, 1e300, f64::MAX] {
        let result = two_storeys().with_p_delta(gravity);
        assert!(matches!(result, Err(Error::Input { value: 3.0, .. })), "{result:?}");
    }
    assert!(yielding_under_weight(6667.0).is_ok());
    assert!(matches!(yielding_under_weight(6666.0), Err(Error::Input { value: 3.0, .. })));
}

/// Columns that yield and hardly harden buckle under the weight above: an error at the end of
/// the run, not a drift of 10⁸⁰ m with a closed energy balance.
#[test]
fn a_collapse_ends_the_run() {
    let storeys = [Storey::new(3.0, 20.0e3, 4.0e6)];
    let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys).unwrap();
    let building = building.with_p_delta(10.0).unwrap();
    let building = building.with_law(0, Bilinear::new(4.0e6, 2.0e4, 1e-3).unwrap()).unwrap();
    let mut simulation = Simulation::builder(0.05)
        .structure(building)
        .ground(SpringGround::new(-5.0..5.0, 4, 1.0e9, 1.0e9).unwrap())
        .interface(Bonded)
        .motion(el_centro_1940())
        .rotation_limit(f64::INFINITY)
        .build()
        .unwrap();
    let Err(Error::Step { step, source, .. }) = simulation.run(2000, |_| {}) else {
        panic!("collapsed unnoticed");
    };
    assert!(matches!(source, StepError::Runaway { increment } if increment > 1e15), "{source}");
    assert_eq!(simulation.state().step + 1, step);
    assert!(step < 1000, "{step}");
}
