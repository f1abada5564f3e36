//! Runs of buildings in space: a slice beside the plane's building, turned scenes, storey forces.

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::{Probe, State};
use basemat::interface::Bonded;
use basemat::motion::{Record, Triaxial, el_centro_1940};
use basemat::structure::{
    Bilinear, DofCombination, PlanStorey, RigidBody, ShearBuilding, Storey, StoreyBuilding,
};

use super::cells::{BED_PROPERTIES, BedProperties, CrossingPulses, SpringCells};
use super::storeys::{
    MAT_SIDES, P_DELTA_GRAVITY, STOREY_DAMPING, STOREY_STIFFNESS, building, cells, march,
    storey_scale, swapped, turned,
};

/// Mass and inertia of the base of a building of the plane, and of a slice of it one metre deep.
const SLICE_BASE_MASS: f64 = 6.0e4;
const SLICE_BASE_INERTIA: f64 = 4.0e5;
const SLICE_STEPS: usize = 500;

fn slice_law() -> Bilinear {
    Bilinear::new(4.0e7, 3.0e4, 0.1).unwrap()
}

fn slice_record() -> Record {
    el_centro_1940().scaled(0.5).unwrap()
}

/// The building of the plane at the end of its run: P–Δ, dashpots, a storey that yields.
fn plane_building_state() -> State {
    let mut storey = Storey::new(3.0, 2.0e4, 4.0e7);
    storey.rotary_inertia = 1.0e5;
    storey.damping = 2.0e4;
    let building = ShearBuilding::new(8.0, SLICE_BASE_MASS, SLICE_BASE_INERTIA, &[storey; 3])
        .and_then(|building| building.with_p_delta(P_DELTA_GRAVITY)?.with_law(0, slice_law()))
        .unwrap();
    let springs = SpringGround::new(-4.0..4.0, 8, 3e7, 2e7).unwrap();
    let mut simulation = Simulation::builder(4e-3)
        .structure(building)
        .ground(springs.with_dashpots(6e5, 3e5).unwrap())
        .interface(Bonded)
        .motion(slice_record())
        .build()
        .unwrap();
    simulation.run(SLICE_STEPS, |_| {}).unwrap();
    simulation.state().clone()
}

/// The slice of that building that moves along x (0) or along y (1), at the end of its run.
fn slice_state(direction: usize) -> State {
    let outline = [[-4.0, -0.5], [4.0, -0.5], [4.0, 0.5], [-4.0, 0.5]]
        .map(|corner| swapped(corner, direction));
    let inertia = [
        [SLICE_BASE_INERTIA, 0.0, 0.0],
        [0.0, SLICE_BASE_INERTIA, 0.0],
        [0.0, 0.0, SLICE_BASE_INERTIA],
    ];
    let mat = RigidBody::from_mass(outline.to_vec(), SLICE_BASE_MASS, inertia, [0.0; 3]).unwrap();
    let storey = PlanStorey {
        inertia: [1.0e5; 3],
        damping: [2.0e4; 3],
        ..PlanStorey::new(3.0, 2.0e4, [1.0; 2], [4.0e7, 4.0e7, 1.0e8])
    };
    let building = StoreyBuilding::new(mat, &[storey; 3])
        .and_then(|building| {
            building.with_p_delta(P_DELTA_GRAVITY)?.with_law(0, direction, slice_law())
        })
        .unwrap();
    let along: Vec<f64> = (0..=8).map(|k| f64::from(k) - 4.0).collect();
    let across = [-0.5, 0.5];
    let bed = BedProperties { stiffness: [3e7, 2e7, 2e7], dashpot: [6e5, 3e5, 3e5] };
    let record = Some(slice_record());
    let simulation = if direction == 0 {
        let motion = Triaxial { x: record, ..Triaxial::default() };
        march(building, SpringCells::between(&along, &across, bed), motion, SLICE_STEPS)
    } else {
        let motion = Triaxial { y: record, ..Triaxial::default() };
        march(building, SpringCells::between(&across, &along, bed), motion, SLICE_STEPS)
    };
    simulation.state().clone()
}

/// A slice one metre deep that moves along x, or along y, is the building of the plane.
#[test]
fn a_slice_is_the_building_of_the_plane() {
    let plane = plane_building_state();
    let u = plane.displacement();
    // Along x and about −y, along y and about x.
    for direction in [0, 1] {
        let slice = slice_state(direction);
        let v = slice.displacement();
        let rotation = [-v[4], v[3]][direction];
        let mut pairs = vec![(u[0], v[direction]), (u[2], rotation)];
        pairs.extend((0..3).map(|k| (u[3 + k], v[6 + 3 * k + direction])));
        for (plane, slice) in pairs {
            assert!(
                plane.abs() > 1e-6 && (plane - slice).abs() < 1e-9 * plane.abs(),
                "{plane} {slice}"
            );
        }
        let expected = plane.energy_balance.hysteresis;
        let computed = slice.energy_balance.hysteresis;
        assert!(expected > 0.0 && (computed / expected - 1.0).abs() < 1e-9);
    }
}

/// The building with a lowest storey that yields.
fn yielding_building(quarter_turns: usize) -> StoreyBuilding {
    let twist = Bilinear::new(STOREY_STIFFNESS[2], 4.0e5, 0.1).unwrap();
    let stiffness = swapped([STOREY_STIFFNESS[0], STOREY_STIFFNESS[1]], quarter_turns);
    let along = Bilinear::new(stiffness[0], 1.0e5, 0.1).unwrap();
    let across = Bilinear::new(stiffness[1], 1.0e5, 0.1).unwrap();
    building(quarter_turns)
        .with_law(0, StoreyBuilding::DIRECTION_ALONG, along)
        .and_then(|building| building.with_law(0, StoreyBuilding::DIRECTION_ACROSS, across))
        .and_then(|building| building.with_law(0, StoreyBuilding::DIRECTION_TWIST, twist))
        .unwrap()
}

/// The yielding building and its scene, after some quarter turns.
fn turned_scene(quarter_turns: usize) -> Simulation {
    let sides = swapped([MAT_SIDES[0], MAT_SIDES[1]], quarter_turns);
    let counts = swapped([4, 3], quarter_turns);
    let mut bed = BED_PROPERTIES;
    if quarter_turns % 2 == 1 {
        bed.stiffness.swap(1, 2);
        bed.dashpot.swap(1, 2);
    }
    let ground = SpringCells::under(sides, [0.0; 2], counts, bed);
    march(yielding_building(quarter_turns), ground, CrossingPulses { quarter_turns }, 300)
}

/// If a building and its scene are turned by 90 degrees, displacements turn with them, torsion and yielding in both
/// directions included.
#[test]
fn a_turned_building_turns_its_displacements() {
    let unturned_simulation = turned_scene(0);
    assert!(unturned_simulation.state().energy_balance.hysteresis > 0.0);
    let u = unturned_simulation.state().displacement();
    assert!(u.iter().all(|u| u.abs() > 1e-8), "{u:?}");
    for quarter_turns in 1..4 {
        let mut expected = u.to_vec();
        for first_dof in [0, 3, 6, 9, 12] {
            let vector = turned([u[first_dof], u[first_dof + 1]], quarter_turns);
            expected[first_dof..first_dof + 2].copy_from_slice(&vector);
        }
        let simulation = turned_scene(quarter_turns);
        for (computed, expected) in simulation.state().displacement().iter().zip(&expected) {
            assert!((computed - expected).abs() < 1e-11, "{quarter_turns}: {computed} {expected}");
        }
    }
}

/// Storey forces by inertia against stiffness times drift and dashpots in linear storeys, in the middle of a step.
#[test]
fn storey_forces_are_those_of_their_columns() {
    let building = building(0).with_p_delta(0.0).unwrap();
    let pulses = CrossingPulses { quarter_turns: 0 };
    let mut simulation = march(building.clone(), cells(), pulses, 200);
    let start = simulation.state().clone();
    let end = simulation.step().unwrap();
    for storey in 0..3 {
        let stiffness = STOREY_STIFFNESS.map(|stiffness| storey_scale(storey) * stiffness);
        let drifts: [DofCombination; 3] = building.drift(storey).unwrap();
        for (k, rows) in building.shear(storey).unwrap().iter().enumerate() {
            let computed = rows.value(&[], &[], end.acceleration());
            let drift = &drifts[k];
            let mean_drift =
                0.5 * (drift.value(start.displacement()) + drift.value(end.displacement()));
            let mean_rate = 0.5 * (drift.value(start.velocity()) + drift.value(end.velocity()));
            let expected = stiffness[k] * mean_drift + STOREY_DAMPING[k] * mean_rate;
            assert!(
                expected.abs() > 1e2 && (computed / expected - 1.0).abs() < 1e-7,
                "{computed} {expected}"
            );
            assert_eq!(Probe::section("cut", rows).unit, ["N", "N", "N·m"][k]);
        }
    }
}
