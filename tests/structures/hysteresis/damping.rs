//! GOAL: viscous damping of structures with hysteretic springs follows their initial stiffness.
//! SCENE: laws that never yield; one storey set in motion on rock.
//! REFERENCE: the linear building; the closed form of a damped rigid-plastic slide.

use basemat::Simulation;
use basemat::Soil;
use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::coupled::Probe;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::el_centro_1940;
use basemat::structure::{
    Bilinear, IsolationLevel, ModalDamping, ShearBuilding, Storey, Structure, StructureGroup,
    Triplets, WithSprings,
};
use std::f64::consts::PI;

const STOREY_STIFFNESS: f64 = 40.0e6;
const STOREY_COUNT: usize = 5;

fn linear_building(ratio: f64) -> ShearBuilding {
    let storeys =
        [Storey { damping: 1.0e4, ..Storey::new(3.0, 20.0e3, STOREY_STIFFNESS) }; STOREY_COUNT];
    let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys).unwrap();
    building.with_stiffness_damping(ratio).unwrap()
}

/// Gives storeys from `below` on laws of the columns' stiffness that never yield.
fn strong(building: ShearBuilding, below: usize) -> ShearBuilding {
    (below..below + STOREY_COUNT).fold(building, |building, storey| {
        building.with_law(storey, Bilinear::new(STOREY_STIFFNESS, 1e12, 0.1).unwrap()).unwrap()
    })
}

fn damping(structure: &dyn Structure) -> Vec<f64> {
    let n = structure.dofs();
    let mut entries = Triplets::new(n);
    structure.damping(&mut entries).unwrap();
    let mut matrix = vec![0.0; n * n];
    for &(i, j, value) in entries.entries() {
        matrix[i * n + j] += value;
    }
    matrix
}

/// Drifts of the lowest storey under El Centro.
fn drifts(structure: impl Structure + 'static) -> Vec<f64> {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    let drift = linear_building(0.05).drift(0).unwrap();
    let mut simulation = Simulation::builder(0.005)
        .structure(structure)
        .ground(ElasticGround::new(soil, Strip::uniform(-5.0..5.0, 8).unwrap()).unwrap())
        .interface(Coulomb::new(0.4).unwrap())
        .motion(el_centro_1940())
        .probe(Probe::displacement("drift", drift))
        .build()
        .unwrap();
    let mut drifts = Vec::new();
    simulation.run(2000, |state| drifts.push(state.probes[0])).unwrap();
    drifts
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

#[test]
fn columns_that_never_yield_are_linear() {
    let expected = drifts(linear_building(0.05));
    let computed = drifts(strong(linear_building(0.05), 0));
    let peak = largest(&expected);
    let errors: Vec<f64> = expected.iter().zip(&computed).map(|(a, b)| a - b).collect();
    let error = largest(&errors);
    println!("peak drift {:.3} mm, error with laws that never yield {:.1e}", 1e3 * peak, error / peak);
    assert!(error < 1e-11 * peak, "{error:e} of {peak}");
}

/// In all structures C is independent of the laws. Isolators do not
/// contribute to the damping of the building on them.
#[test]
fn laws_have_no_effect_on_the_damping_matrix() {
    let expected = damping(&linear_building(0.05));
    assert_eq!(damping(&strong(linear_building(0.05), 0)), expected);
    let drift = linear_building(0.05).drift(0).unwrap();
    let law = Bilinear::new(5.0e6, 2.0e4, 0.0).unwrap();
    let yielding_building = strong(linear_building(0.05), 0);
    let sprung_building = WithSprings::new(yielding_building).spring(drift, law).unwrap();
    assert_eq!(damping(&sprung_building), expected);
    let group = StructureGroup::new().with(sprung_building, 0.0).unwrap();
    assert_eq!(damping(&group), expected);

    // Modal damping belongs to the first tangent's modes, in addition to the structure's damping matrix.
    let modal = ModalDamping::new(&[0.03]).unwrap();
    let damped_linear_building = modal.on(linear_building(0.05)).unwrap();
    let damped_yielding_building = modal.on(strong(linear_building(0.05), 0)).unwrap();
    let max_magnitude = max_magnitude(&expected);
    for (a, b) in damping(&damped_linear_building).into_iter().zip(damping(&damped_yielding_building)) {
        assert!((a - b).abs() < 1e-9 * max_magnitude, "{a} {b}");
    }

    let level = IsolationLevel { height: 0.3, slab_mass: 3e4, slab_inertia: 2e5, damping: 7.0e3 };
    let stiff_bearing = Bilinear::new(1.0e9, 2.0e4, 0.0).unwrap();
    let isolated_building = linear_building(0.05).isolated(level, stiff_bearing).unwrap();
    let matrix = damping(&strong(isolated_building, 1));
    let n = STOREY_COUNT + 4;
    // The slab is degree of freedom 3: the bearings' dampers and the columns above act on it.
    assert_eq!(matrix[3], -level.damping);
    let column = -expected[3 * (STOREY_COUNT + 3) + 4];
    assert!(((matrix[3 * n + 3] - level.damping) / column - 1.0).abs() < 1e-14);
}

/// Dashpots between the floors give the same damping matrix, as the documentation says.
#[test]
fn dashpots_can_replace_stiffness_proportional_damping() {
    let ratio = 0.05;
    let linear_building_with_dashpots =
        ShearBuilding::new(10.0, 50.0e3, 4.0e5, &[Storey::new(3.0, 2e4, STOREY_STIFFNESS); 5]);
    let linear_building_with_dashpots = linear_building_with_dashpots.unwrap();
    let dashpot = ratio * STOREY_STIFFNESS / (PI * linear_building_with_dashpots.fixed_base_frequency());
    let storey = Storey { damping: dashpot, ..Storey::new(3.0, 2e4, STOREY_STIFFNESS) };
    let with_dashpots = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &[storey; 5]).unwrap();
    let expected = damping(&linear_building_with_dashpots.with_stiffness_damping(ratio).unwrap());
    for (found, expected) in damping(&with_dashpots).into_iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} {expected}");
    }
}

const FLOOR_MASS: f64 = 2.0e4;
const COLUMN_STIFFNESS: f64 = 2.0e6;
const YIELD_FORCE: f64 = 1.0e4;
const INITIAL_SPEED: f64 = 0.5;

/// Elastic drift of the floor at time t.
fn elastic_drift(ratio: f64, t: f64) -> f64 {
    let omega = f64::sqrt(COLUMN_STIFFNESS / FLOOR_MASS);
    let damped_frequency = omega * f64::sqrt(1.0 - ratio * ratio);
    INITIAL_SPEED / damped_frequency * (-ratio * omega * t).exp() * (damped_frequency * t).sin()
}

/// Largest drift of the floor, which yields.
fn sliding_drift(ratio: f64) -> f64 {
    let omega = f64::sqrt(COLUMN_STIFFNESS / FLOOR_MASS);
    let damped_frequency = omega * f64::sqrt(1.0 - ratio * ratio);
    let mut below = 0.0;
    let mut above = 0.5 / omega;
    assert!(elastic_drift(ratio, above) > YIELD_FORCE / COLUMN_STIFFNESS);
    for _ in 0..100 {
        let middle = 0.5 * (below + above);
        let yields = elastic_drift(ratio, middle) > YIELD_FORCE / COLUMN_STIFFNESS;
        *(if yields { &mut above } else { &mut below }) = middle;
    }
    let t = below;
    let swing = (damped_frequency * t).cos() - ratio * omega / damped_frequency * (damped_frequency * t).sin();
    let speed = INITIAL_SPEED * (-ratio * omega * t).exp() * swing;
    let c = 2.0 * ratio * omega * FLOOR_MASS;
    let slide = FLOOR_MASS / c * speed
        - FLOOR_MASS * YIELD_FORCE / (c * c) * (c * speed / YIELD_FORCE).ln_1p();
    YIELD_FORCE / COLUMN_STIFFNESS + slide
}

/// A floor of mass m starts with the speed v₀. Elastic: d = v₀/ω_d e^(−ζωt) sin ω_d t, up to
/// the drift F/k. From there m d̈ + c ḋ + F = 0 until it stands, (m/c) v₁ − (m F/c²) ln(1 + c v₁/F)
/// further on. Then the floor swings elastically about a drift that is F/k smaller.
#[test]
fn the_slide_of_a_yielding_storey_depends_on_its_damping() {
    let ratio = 0.1;
    let omega = f64::sqrt(COLUMN_STIFFNESS / FLOOR_MASS);
    let storey = Storey::new(3.0, FLOOR_MASS, COLUMN_STIFFNESS);
    let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &[storey]).unwrap();
    assert!((building.fixed_base_frequency() * 2.0 * PI / omega - 1.0).abs() < 1e-12);
    let building = building.with_stiffness_damping(ratio).unwrap();
    let law = Bilinear::new(COLUMN_STIFFNESS, YIELD_FORCE, 0.0).unwrap();
    let drift = building.drift(0).unwrap();
    let structure = building.with_law(0, law).unwrap();
    let mut simulation = Simulation::builder(2.0e-4)
        .structure(structure)
        // Springs stand for rock: the base does not move.
        .ground(SpringGround::new(-5.0..5.0, 2, 1e13, 1e13).unwrap())
        .interface(Bonded)
        .initial_velocity([0.0, 0.0, 0.0, INITIAL_SPEED])
        .probe(Probe::displacement("drift", drift))
        .build()
        .unwrap();
    let mut max_value = 0.0_f64;
    let mut previous_drift = 0.0;
    let run = simulation
        .run(50_000, |state| {
            previous_drift = state.probes[0];
            max_value = max_value.max(previous_drift);
        })
        .unwrap();
    let expected = sliding_drift(ratio);
    let undamped_drift = sliding_drift(1e-6);
    println!("peak {max_value:.6} m, {expected:.6} m expected, {undamped_drift:.6} m without damping");
    assert!((max_value / expected - 1.0).abs() < 1e-4, "{max_value} {expected}");
    let rest = expected - YIELD_FORCE / COLUMN_STIFFNESS;
    assert!((previous_drift / rest - 1.0).abs() < 2e-4, "{previous_drift} {rest}");
    assert!(undamped_drift > 1.3 * expected && run.energy_error < 1e-9);
}
