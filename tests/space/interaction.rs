//! A storey on a square mat: its period on an elastic half-space, and held.

use std::f64::consts::TAU;

use basemat::Simulation;
use basemat::analyses::interaction;
use basemat::bem::layered::StripContact;
use basemat::bem::plan::{Plan, impedances_in_plan};
use basemat::bem::{ElasticGround, SpringGround};
use basemat::interface::Coulomb;
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::structure::{PlanStorey, RigidBody, StoreyBuilding};
use basemat::{Result, Soil, unobserved};

const SIDE: f64 = 8.0;
const HEIGHT: f64 = 12.0;
const MASS: f64 = 4.0e5;

/// A thin, light mat and a floor on columns of these two stiffnesses, whose own inertia is small.
fn building(stiffness: [f64; 2]) -> Result<StoreyBuilding> {
    let mat = RigidBody::cuboid([SIDE, SIDE, 0.1], 50.0)?;
    let twist = 20.0 * stiffness[0];
    let storey = PlanStorey::new(HEIGHT, MASS, [0.1, 0.1], [stiffness[0], stiffness[1], twist]);
    StoreyBuilding::new(mat, &[storey])
}

/// T̃/T by the static stiffnesses of the ground, which at these low frequencies are within some per cent of the dynamic
/// ones; the two axes by themselves.
#[test]
fn periods_on_a_half_space_are_those_of_its_static_stiffnesses() {
    let soil = Soil::from_shear_wave_speed(180.0, 0.33, 1900.0).unwrap();
    let stiffness = [0.8, 1.2].map(|period: f64| MASS * (TAU / period).powi(2));
    let scene = || {
        let building = building(stiffness)?;
        let record = el_centro_1940();
        Ok(Simulation::builder(0.02)
            .ground(ElasticGround::under(soil, &building, 6)?)
            .structure(building)
            .interface(Coulomb::new(0.6)?)
            .motion(Triaxial { x: Some(record.clone()), y: Some(record), up: None }))
    };
    let found = interaction(1.0, scene).unwrap();
    let half = 0.5 * SIDE;
    let mat = Plan::rectangle(-half..half, -half..half, 6).unwrap();
    let ground =
        impedances_in_plan(&soil.into(), &mat, &[0.0], StripContact::Bonded, &mut unobserved)
            .unwrap();
    let springs = ground[0].stiffnesses();
    for (k, axis) in ['x', 'y'].into_iter().enumerate() {
        let (mode, own) = (found.modes[k], stiffness[k]);
        let known =
            (1.0 + own / springs[k][k] + own * HEIGHT.powi(2) / springs[4 - k][4 - k]).sqrt();
        println!("{axis}: {:.4} for {known:.4}, {mode:?}", mode.period_ratio());
        assert_eq!(mode.axis, Some(axis));
        assert!(known > 1.03 && (mode.period_ratio() / known - 1.0).abs() < 0.02, "{mode:?}");
        assert!(mode.damping > 0.0 && mode.damping < 0.1, "{mode:?}");
    }
}

/// Springs in series, exactly, along both axes.
#[test]
fn periods_on_springs_in_plan_are_those_of_springs_in_series() {
    const CELLS: usize = 8;
    let stiffness = [0.8, 1.1].map(|period: f64| MASS * (TAU / period).powi(2));
    let bed = [2.0e7, 1.2e7, 0.9e7];
    let scene = || {
        let building = building(stiffness)?;
        let half = 0.5 * SIDE;
        let mat = Plan::rectangle(-half..half, -half..half, CELLS)?.without_overhang()?;
        Ok(Simulation::builder(0.01)
            .ground(SpringGround::in_plan(mat, bed)?)
            .structure(building)
            .interface(Coulomb::new(0.6)?)
            .motion(Triaxial { x: Some(el_centro_1940()), y: None, up: None }))
    };
    let found = interaction(1.0, scene).unwrap();
    let turning = bed[0] * SIDE.powi(4) / 12.0 * (1.0 - ((CELLS * CELLS) as f64).recip());
    for k in 0..2 {
        let (mode, own) = (found.modes[k], stiffness[k]);
        let along = bed[1 + k] * SIDE * SIDE;
        let known = (1.0 + own / along + own * HEIGHT.powi(2) / turning).sqrt();
        println!("{:.5} for {known:.5}", mode.period_ratio());
        assert!((mode.period_ratio() / known - 1.0).abs() < 1e-3, "{mode:?}");
    }
    let held = &found.on_fixed_base.whole;
    assert!(held.base_rotation.magnitude() < 1e-7 && held.twist.magnitude() < 1e-7);
}
