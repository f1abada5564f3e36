//! A storey on a square mat: its periods on a half-space, on springs and on a fixed base.

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

const MAT_SIDE: f64 = 8.0;
const FLOOR_HEIGHT: f64 = 12.0;
const FLOOR_MASS: f64 = 4.0e5;

/// A thin, light mat and a floor on columns of these two stiffnesses, with small rotary inertia.
fn building(stiffness: [f64; 2]) -> Result<StoreyBuilding> {
    let mat = RigidBody::cuboid([MAT_SIDE, MAT_SIDE, 0.1], 50.0)?;
    let twist_stiffness = 20.0 * stiffness[0];
    let stiffness = [stiffness[0], stiffness[1], twist_stiffness];
    let storey = PlanStorey::new(FLOOR_HEIGHT, FLOOR_MASS, [0.1, 0.1], stiffness);
    StoreyBuilding::new(mat, &[storey])
}

/// A square mat with this number of cells along each side.
fn mat_plan(cells: usize) -> Result<Plan> {
    let half = 0.5 * MAT_SIDE;
    Plan::rectangle(-half..half, -half..half, cells)
}

/// T̃/T by springs in series: columns, horizontal springs of the ground, its rocking springs.
fn series_period_ratio(columns: f64, horizontal: f64, rocking: f64) -> f64 {
    (1.0 + columns / horizontal + columns * FLOOR_HEIGHT.powi(2) / rocking).sqrt()
}

/// T̃/T by the static stiffnesses of the ground, for the two axes.
///
/// At these low frequencies the static stiffnesses are within some per cent of the dynamic ones.
#[test]
fn periods_on_a_half_space_are_those_of_its_static_stiffnesses() {
    let soil = Soil::from_shear_wave_speed(180.0, 0.33, 1900.0).unwrap();
    let stiffness = [0.8, 1.2].map(|period: f64| FLOOR_MASS * (TAU / period).powi(2));
    let computed = interaction(1.0, || {
        let building = building(stiffness)?;
        let record = el_centro_1940();
        Ok(Simulation::builder(0.02)
            .ground(ElasticGround::under(soil, &building, 6)?)
            .structure(building)
            .interface(Coulomb::new(0.6)?)
            .motion(Triaxial { x: Some(record.clone()), y: Some(record), up: None }))
    })
    .unwrap();
    let mat = mat_plan(6).unwrap();
    let ground =
        impedances_in_plan(&soil.into(), &mat, &[0.0], StripContact::Bonded, &mut unobserved)
            .unwrap();
    let springs = ground[0].stiffnesses();
    for (k, axis) in ['x', 'y'].into_iter().enumerate() {
        let mode = &computed.modes[k];
        let expected = series_period_ratio(stiffness[k], springs[k][k], springs[4 - k][4 - k]);
        println!("{axis}: {:.4} for {expected:.4}, {mode:?}", mode.period_ratio());
        assert_eq!(mode.axis, Some(axis));
        assert!(expected > 1.03 && (mode.period_ratio() / expected - 1.0).abs() < 0.02, "{mode:?}");
        assert!(mode.damping > 0.0 && mode.damping < 0.1, "{mode:?}");
    }
}

/// Springs in series, exactly, along both axes.
#[test]
fn periods_on_springs_in_plan_are_those_of_springs_in_series() {
    const CELLS_PER_SIDE: usize = 8;
    let stiffness = [0.8, 1.1].map(|period: f64| FLOOR_MASS * (TAU / period).powi(2));
    let bed_stiffness = [2.0e7, 1.2e7, 0.9e7];
    let computed = interaction(1.0, || {
        let building = building(stiffness)?;
        let mat = mat_plan(CELLS_PER_SIDE)?.without_overhang()?;
        Ok(Simulation::builder(0.01)
            .ground(SpringGround::in_plan(mat, bed_stiffness)?)
            .structure(building)
            .interface(Coulomb::new(0.6)?)
            .motion(Triaxial { x: Some(el_centro_1940()), y: None, up: None }))
    })
    .unwrap();
    let rocking = bed_stiffness[0] * MAT_SIDE.powi(4) / 12.0
        * (1.0 - ((CELLS_PER_SIDE * CELLS_PER_SIDE) as f64).recip());
    for k in 0..2 {
        let mode = &computed.modes[k];
        let horizontal = bed_stiffness[1 + k] * MAT_SIDE * MAT_SIDE;
        let expected = series_period_ratio(stiffness[k], horizontal, rocking);
        println!("{:.5} for {expected:.5}", mode.period_ratio());
        assert!((mode.period_ratio() / expected - 1.0).abs() < 1e-3, "{mode:?}");
    }
    let fixed_base = &computed.on_fixed_base.whole;
    assert!(fixed_base.base_rotation.magnitude() < 1e-7 && fixed_base.twist.magnitude() < 1e-7);
}
