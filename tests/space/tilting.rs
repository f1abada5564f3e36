//! Slender bodies: placed upright with P–Δ, and pushed over onto their outermost cells.

use basemat::Simulation;
use basemat::Soil;
use basemat::bem::ElasticGround;
use basemat::bem::plan::Plan;
use basemat::coupled::Load;
use basemat::interface::Coulomb;
use basemat::motion::{STANDARD_GRAVITY, Triaxial};
use basemat::results::{Quantity, Run};
use basemat::soil::SoilProfile;
use basemat::structure::RigidBody;

/// A slender cylinder on concrete of this modulus over soil.
fn cylinder_on_concrete(modulus: f64, p_delta_gravity: f64) -> Simulation {
    let soil = Soil::from_shear_wave_speed(250.0, 1.0 / 3.0, 1900.0).unwrap();
    let concrete = Soil::new(modulus, 0.2, 2400.0).unwrap();
    let profile = SoilProfile::on_half_plane(soil).with_layer(concrete, 0.9).unwrap();
    let body = RigidBody::cylinder(1.7, 5.6, 3200.0).unwrap();
    let plan = Plan::disc([0.0; 2], 1.7, 8).unwrap();
    Simulation::builder(1e-3)
        .structure(body.with_p_delta(p_delta_gravity).unwrap())
        .ground(ElasticGround::in_plan(profile, plan).unwrap())
        .interface(Coulomb::new(0.3).unwrap())
        .motion(Triaxial::default())
        .expected_steps(2)
        .build()
        .unwrap()
}

/// GOAL: a slender body is placed upright, with or without P–Δ, and not balanced on its edge, which is an equilibrium too.
/// SCENE: slender cylinder on concrete over soil, where only the rim bears, from soft to stiff concrete.
/// REFERENCE: the same without P–Δ, which has no effect without rotations.
#[test]
fn a_slender_body_with_p_delta_is_placed_upright() {
    for modulus in [1e9, 4e9, 12.5e9] {
        let without_p_delta = cylinder_on_concrete(modulus, 0.0);
        let with_p_delta = cylinder_on_concrete(modulus, STANDARD_GRAVITY);
        let weight = without_p_delta.state().normal_force;
        for (a, b) in without_p_delta.state().contact.iter().zip(&with_p_delta.state().contact) {
            assert!((a.pressure - b.pressure).abs() < 1e-7 * weight, "{a:?} {b:?}");
            assert!((a.gap - b.gap).abs() < 1e-9, "{a:?} {b:?}");
        }
        let rotations = &with_p_delta.static_displacement()[3..5];
        assert!(rotations.iter().all(|angle| angle.abs() < 1e-9), "{rotations:?}");
    }
}

/// Run of a tall block that is pushed over along an axis.
fn run_pushed_over(axis: usize, cells: usize) -> Run {
    let soil = Soil::from_shear_wave_speed(200.0, 0.3, 1900.0).unwrap();
    let body = RigidBody::cuboid([6.0, 6.0, 12.0], 2000.0).unwrap();
    let row = body.displacement_at([0.0, 0.0, 12.0])[axis].clone();
    let ground = ElasticGround::under(soil, &body, cells).unwrap();
    let push = 0.28 * STANDARD_GRAVITY * body.total_mass();
    let mut simulation = Simulation::builder(0.01)
        .structure(body)
        .ground(ground)
        .interface(Coulomb::new(0.9).unwrap())
        .load(Load::new(row, move |time| push * (2.0 * time).min(1.0)))
        .build()
        .unwrap();
    simulation.run(100, |_| {}).unwrap()
}

/// A tall block that is pushed over, along x or along y, stands on its last row of 8 cells, 3.5 cells from the middle
/// of a base of 7.79 cells.
#[test]
fn blocks_stand_on_their_outermost_cells() {
    let safeties = [Quantity::OverturningSafety, Quantity::OverturningSafetyAcross];
    for axis in 0..2 {
        let run = run_pushed_over(axis, 8);
        let along_push = run.whole.peak(safeties[axis]).value;
        let across_push = run.whole.peak(safeties[1 - axis]).value;
        assert!((along_push - (8.0 - 0.21) / 7.0).abs() < 1e-6, "{axis}: {along_push}");
        assert!(across_push > 1e3, "{axis}: {across_push}");
        assert!(
            run.to_string()
                .contains("0.90 of the half width from the middle of the base at most"),
            "{run}"
        );
        assert_eq!(run.whole.ends, [-3.0, 3.0]);
        assert_eq!(run.whole.depth, [-3.0, 3.0]);
    }
    assert!(!run_pushed_over(0, 16).to_string().contains("16 elements"));
}
