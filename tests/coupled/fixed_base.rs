//! GOAL: runs on a fixed base follow mechanics, and fix every node of the base.
//! SCENE: a shear building with dashpots on the half-plane; a flexible base on springs.
//! REFERENCE: Runge and Kutta's method on the storeys; displacements of the base.

use std::any::Any;

use basemat::Result;
use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::coupled::{Coordinates, Probe};
use basemat::interface::Bonded;
use basemat::motion::{Record, el_centro_1940};
use basemat::structure::{
    Base, BaseNode, DofCombination, ShearBuilding, Storey, Structure, Triplets,
};

use super::interaction::{BASE_WIDTH, half_plane};

const STOREY_COUNT: usize = 4;
const STOREY_MASSES: [f64; STOREY_COUNT] = [30.0e3, 28.0e3, 25.0e3, 20.0e3];
const STOREY_STIFFNESSES: [f64; STOREY_COUNT] = [60.0e6, 50.0e6, 45.0e6, 30.0e6];
/// Damping of each storey over its stiffness, s.
const DAMPING_TIME: f64 = 4e-3;

/// Displacements of the floors relative to the base, then their velocities.
type FloorMotion = [f64; 2 * STOREY_COUNT];

/// Force of a storey's columns and dashpots.
fn storey_force(motion: &FloorMotion, storey: usize) -> f64 {
    let (displacement_below, velocity_below) = if storey == 0 {
        (0.0, 0.0)
    } else {
        (motion[storey - 1], motion[STOREY_COUNT + storey - 1])
    };
    STOREY_STIFFNESSES[storey]
        * (motion[storey] - displacement_below
            + DAMPING_TIME * (motion[STOREY_COUNT + storey] - velocity_below))
}

/// Rate of the motion under this acceleration of the ground.
fn floor_rate(motion: &FloorMotion, ground_acceleration: f64) -> FloorMotion {
    let mut rate = [0.0; 2 * STOREY_COUNT];
    for k in 0..STOREY_COUNT {
        let force_above = if k + 1 < STOREY_COUNT { storey_force(motion, k + 1) } else { 0.0 };
        rate[k] = motion[STOREY_COUNT + k];
        rate[STOREY_COUNT + k] =
            (force_above - storey_force(motion, k)) / STOREY_MASSES[k] - ground_acceleration;
    }
    rate
}

fn advanced(motion: &FloorMotion, rate: &FloorMotion, interval: f64) -> FloorMotion {
    std::array::from_fn(|k| motion[k] + interval * rate[k])
}

/// One step by Runge and Kutta's method.
fn runge_kutta_step(motion: &FloorMotion, record: &Record, time: f64, step: f64) -> FloorMotion {
    let middle = record.at(time + 0.5 * step).acceleration;
    let k1 = floor_rate(motion, record.at(time).acceleration);
    let k2 = floor_rate(&advanced(motion, &k1, 0.5 * step), middle);
    let k3 = floor_rate(&advanced(motion, &k2, 0.5 * step), middle);
    let k4 = floor_rate(&advanced(motion, &k3, step), record.at(time + step).acceleration);
    std::array::from_fn(|k| motion[k] + step / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k]))
}

/// Drift and base shear of four storeys with dashpots on a fixed base.
#[test]
fn a_building_on_a_fixed_base_moves_as_by_runge_and_kutta() {
    let record = el_centro_1940().trimmed(0.0, 6.0).unwrap();
    let steps_per_sample = 40;
    let step = record.time_step() / f64::from(steps_per_sample);
    let mut motion = [0.0; 2 * STOREY_COUNT];
    let mut largest_drift = 0.0_f64;
    let mut largest_shear = 0.0_f64;
    for n in 0..300 * steps_per_sample {
        motion = runge_kutta_step(&motion, &record, f64::from(n) * step, step);
        largest_drift = largest_drift.max((motion[3] - motion[2]).abs());
        largest_shear = largest_shear.max(storey_force(&motion, 0).abs());
    }
    let storeys: Vec<_> = (0..STOREY_COUNT)
        .map(|k| Storey {
            damping: DAMPING_TIME * STOREY_STIFFNESSES[k],
            ..Storey::new(3.0, STOREY_MASSES[k], STOREY_STIFFNESSES[k])
        })
        .collect();
    let building = ShearBuilding::new(BASE_WIDTH, 1.0, 1e3, &storeys).unwrap();
    let probe = Probe::displacement("drift", building.drift(3).unwrap());
    let builder = half_plane(building, 0.0025, &record).probe(probe).on_fixed_base();
    let mut simulation = builder.build().unwrap();
    let run = simulation.run(2400, |_| {}).unwrap();
    let drift = run.probe("drift").unwrap().magnitude();
    let shear = run.whole.base_shear.magnitude();
    println!("{drift} {shear} for {largest_drift} {largest_shear}");
    assert!((drift / largest_drift - 1.0).abs() < 4e-3);
    assert!((shear / largest_shear - 1.0).abs() < 4e-3);
}

/// A mass on the middle one of three base nodes, between which the base is soft.
struct SoftBase;

impl Structure for SoftBase {
    fn dofs(&self) -> usize {
        8
    }

    fn base(&self) -> Base {
        [0, 1, 2].map(|k| BaseNode::free(2.0 * k as f64, 2 * k, 2 * k + 1)).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        (0..6).for_each(|dof| matrix.add(dof, dof, 100.0));
        (6..8).for_each(|dof| matrix.add(dof, dof, 50.0e3));
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        for dof in 0..4 {
            matrix.add_spring(dof, dof + 2, 1.0e6);
        }
        matrix.add_spring(2, 6, 20.0e6);
        matrix.add_spring(3, 7, 200.0e6);
        Ok(())
    }
}

/// The middle of the base is fixed, too, though two elements do not measure its displacement.
#[test]
fn a_soft_base_is_fixed_at_every_node() {
    let bottom = Probe::displacement("bottom", DofCombination::from(2));
    let middle = Probe::displacement("middle", DofCombination::from(3) - DofCombination::from(1));
    let mut simulation = Simulation::builder(0.005)
        .ground(SpringGround::under(&SoftBase, 2, 2e7, 1e7).unwrap())
        .structure(SoftBase)
        .interface(Bonded)
        .motion(el_centro_1940())
        .coordinates(Coordinates::Physical)
        .probes([bottom, middle, Probe::displacement("top", 6)])
        .on_fixed_base()
        .build()
        .unwrap();
    let initial = simulation.static_displacement();
    assert!((initial[3] - initial[1]).abs() < 1e-3 * 50.0e3 * 9.81 / 2.0e6, "{initial:?}");
    let run = simulation.run(1000, |_| {}).unwrap();
    let top = run.probe("top").unwrap().magnitude();
    assert!(top > 1e-3);
    for name in ["bottom", "middle"] {
        let displacement = run.probe(name).unwrap().magnitude();
        assert!(displacement < 1e-4 * top, "{name} moves by {displacement:e} of {top:e}");
    }
    // The structure is that of the builder, without what fixes the nodes.
    let structure: &dyn Any = simulation.structure();
    assert!(structure.is::<SoftBase>());
    let structure: Box<dyn Any> = simulation.into_structure();
    assert!(structure.is::<SoftBase>());
}
