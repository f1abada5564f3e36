//! GOAL: the shear building.
//! SCENE: uniform and uneven buildings.
//! REFERENCE: closed-form frequencies, Jacobi's method, free bodies, potential energy.

use crate::structures::curvature;
use basemat::Error;
use basemat::fem::{Direction, Layer, Material, Mesh};
use basemat::structure::{DofCombination, FemModel, ShearBuilding, Storey, Structure};
use basemat_problems::dense::{
    assert_symmetric, damping, eigenvalues, form, largest, mass, multiply, noise, row_value,
    stiffness, submatrix,
};
use std::f64::consts::{PI, TAU};

fn uneven() -> ShearBuilding {
    ShearBuilding::new(8.0, 2000.0, 5000.0, &uneven_storeys()).unwrap()
}

fn storey(height: f64, mass: f64, stiffness: f64, damping: f64) -> Storey {
    Storey { height, mass, rotary_inertia: 0.7 * mass, stiffness, damping }
}

fn uneven_storeys() -> [Storey; 3] {
    [
        storey(4.0, 900.0, 8.0e5, 2.0e3),
        storey(3.0, 700.0, 6.0e5, 0.0),
        storey(3.5, 400.0, 7.0e5, 1.0e3),
    ]
}

/// Unit rigid rotation about the middle of the base: a floor at height z moves by −z.
const UNIT_ROTATION: [f64; 6] = [0.0, 0.0, 1.0, -4.0, -7.0, -10.5];

/// `ω_j = 2 √(k/m) sin((2j−1)π/(2(2N+1)))`, fixed base.
#[test]
fn uniform_building_has_its_closed_form_frequencies() {
    let m = 20.0e3;
    let k = 40.0e6;
    let n = 5_u32;
    let building = ShearBuilding::new(10.0, 1.0e4, 1.0e4, &[Storey::new(3.0, m, k); 5]).unwrap();
    let floors: Vec<usize> = (3..8).collect();
    let computed = eigenvalues(
        &submatrix(&stiffness(&building), &floors),
        &submatrix(&mass(&building), &floors),
    );
    for (j, square) in (1..=n).zip(computed) {
        let angle = f64::from(2 * j - 1) * PI / f64::from(2 * (2 * n + 1));
        let expected = 2.0 * f64::sqrt(k / m) * angle.sin();
        assert!((square.sqrt() / expected - 1.0).abs() < 1e-12, "mode {j}");
    }
    let first = 2.0 * f64::sqrt(k / m) * (PI / 22.0).sin();
    assert!((TAU * building.fixed_base_frequency() / first - 1.0).abs() < 1e-12);
}

#[test]
fn first_frequency_of_an_uneven_building_is_that_of_jacobi() {
    let building = uneven();
    let computed = eigenvalues(
        &submatrix(&stiffness(&building), &[3, 4, 5]),
        &submatrix(&mass(&building), &[3, 4, 5]),
    );
    assert!((building.fixed_base_frequency() * TAU / computed[0].sqrt() - 1.0).abs() < 1e-9);
}

#[test]
fn rigid_motions_meet_no_force_and_all_the_mass() {
    let building = uneven().with_stiffness_damping(0.05).unwrap();
    for matrix in [stiffness(&building), damping(&building), mass(&building)] {
        assert_symmetric(&matrix);
    }
    let shift = [1.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    for motion in [shift, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0], UNIT_ROTATION] {
        assert!(largest(&multiply(&stiffness(&building), &motion)) < 1e-9);
        assert!(largest(&multiply(&damping(&building), &motion)) < 1e-9);
    }
    let inertia = 5000.0 + 0.7 * 2000.0 + 900.0 * 16.0 + 700.0 * 49.0 + 400.0 * 10.5 * 10.5;
    assert!((form(&UNIT_ROTATION, &mass(&building), &UNIT_ROTATION) / inertia - 1.0).abs() < 1e-14);
    let rise = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    for motion in [shift, rise] {
        assert!((form(&motion, &mass(&building), &motion) / 4000.0 - 1.0).abs() < 1e-14);
    }
}

/// Force on the floors from `storey` upwards = shear that they pass on to what is below.
#[test]
fn storey_shear_is_the_sum_of_the_forces_above() {
    let building_without_rotary = uneven().with_stiffness_damping(0.03).unwrap();
    for building in
        [building_without_rotary.clone(), building_without_rotary.with_p_delta(9.81).unwrap()]
    {
        let u = noise(6, 1);
        let v = noise(6, 2);
        let k = stiffness(&building);
        let c = damping(&building);
        let force: Vec<f64> =
            multiply(&k, &u).iter().zip(multiply(&c, &v)).map(|(a, b)| a + b).collect();
        for storey in 0..3 {
            let above: f64 = force[storey + 3..].iter().sum();
            let computed = building.shear(storey).unwrap().value(&u, &v, &[]);
            assert!((computed - above).abs() < 1e-9 * largest(&force), "{storey}");
        }
        // The force on the base is the opposite of the support's force.
        let base = building.shear(0).unwrap().value(&u, &v, &[]);
        assert!((base + force[0]).abs() < 1e-9 * largest(&force));
    }
    let drift = uneven().drift(1).unwrap();
    assert_eq!(row_value(&drift, &UNIT_ROTATION), 0.0);
    assert_eq!(row_value(&drift, &[0.0, 0.0, 0.0, 1.0, 3.0, 0.0]), 2.0);
}

#[test]
fn damping_ratio_is_that_of_the_first_mode() {
    let damped_building = uneven().with_stiffness_damping(0.04).unwrap();
    let floors = [3, 4, 5];
    let k = stiffness(&damped_building);
    let c = damping(&damped_building);
    let extra = c[5][5] - damping(&uneven())[5][5];
    let omega = eigenvalues(&submatrix(&k, &floors), &submatrix(&mass(&damped_building), &floors))
        [0]
    .sqrt();
    assert!((extra / k[5][5] * omega / 2.0 - 0.04).abs() < 1e-10);
}

/// Potential energy of the weights on inextensible columns.
fn potential_energy(u: &[f64; 6]) -> f64 {
    let mut height = 0.0;
    let mut below = u[0];
    let mut sum = 0.0;
    for (storey, &floor) in uneven_storeys().iter().zip(&u[3..]) {
        height += (storey.height.powi(2) - (floor - below).powi(2)).sqrt();
        sum += 9.81 * storey.mass * height;
        below = floor;
    }
    sum
}

/// Weight times the height of floors on inextensible columns, differentiated twice by steps.
#[test]
fn p_delta_is_the_curvature_of_the_potential_energy() {
    let building = uneven().with_p_delta(9.81).unwrap();
    let with_p_delta = stiffness(&building);
    let without_p_delta = stiffness(&uneven());
    for i in 0..6 {
        for j in 0..6 {
            let curvature = curvature(potential_energy, [i, j], 1e-3);
            let computed = with_p_delta[i][j] - without_p_delta[i][j];
            assert!((computed - curvature).abs() < 0.02, "({i}, {j}): {computed} {curvature}");
        }
    }
    // Turning as a rigid body: −m g z for every floor.
    let moment = 9.81 * (900.0 * 4.0 + 700.0 * 7.0 + 400.0 * 10.5);
    assert!((form(&UNIT_ROTATION, &with_p_delta, &UNIT_ROTATION) / -moment - 1.0).abs() < 1e-10);
}

#[test]
fn building_stands_where_it_is_put() {
    let base = uneven().centered_at(20.0).unwrap().base();
    assert_eq!(base.nodes().map(|node| node.x).collect::<Vec<_>>(), [16.0, 24.0]);
    assert_eq!(uneven().total_mass(), 4000.0);
    assert_eq!(uneven().floor(2).unwrap(), 5);
}

/// The sum of the drifts, and a floor's motion minus the base's.
#[test]
fn sway_is_the_sum_of_the_drifts_below() {
    let building = uneven();
    let displacement = [0.3, -0.2, 0.05, 0.7, -0.4, 1.1];
    let mut drifts = 0.0;
    for (storey, height) in [4.0, 7.0, 10.5].into_iter().enumerate() {
        drifts += building.drift(storey).unwrap().value(&displacement);
        let sway = building.total_drift(storey).unwrap();
        assert!((sway.value(&displacement) - drifts).abs() < 1e-14, "{storey}");
        assert!(sway.value(&UNIT_ROTATION).abs() < 1e-14);
        let floor = DofCombination::from(building.floor(storey).unwrap());
        let by_base = floor.total_drift(&building, height).unwrap();
        assert!((by_base.value(&displacement) - drifts).abs() < 1e-14, "{storey}");
        let relative_drift = floor.relative_to_base(&building).unwrap().value(&displacement);
        assert!((relative_drift - (displacement[3 + storey] - 0.3)).abs() < 1e-14);
    }
    assert_eq!(building.roof(), building.floor(2).unwrap());
    assert!(building.total_drift(3).is_err());
}

/// A frame of finite elements that moves as a rigid body has no drift.
#[test]
fn rigid_motions_are_no_sway() {
    let material = Material::new(1e9, 0.3, 2000.0).unwrap();
    let mesh = Mesh::layered_block(1.0..5.0, 4, &[Layer::new(6.0, 5, material)]).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let corner = model.row(model.mesh().node_at(1.0, 6.0).unwrap(), Direction::X).unwrap();
    let sway = corner.total_drift(&model, 6.0).unwrap();
    for direction in [Direction::X, Direction::Y, Direction::Rotation] {
        let motion = model.rigid_motion(direction, [0.7, -0.3, 0.0]);
        assert!(sway.value(&motion).abs() < 1e-14, "{direction:?}");
    }
    // Relative to the base alone, a turn gives −6 m times it.
    let turn = model.rigid_motion(Direction::Rotation, [3.0, 0.0, 0.0]);
    let relative_drift = corner.relative_to_base(&model).unwrap().value(&turn);
    assert!((relative_drift + 6.0).abs() < 1e-14);
    for invalid_value in [f64::NAN, f64::INFINITY] {
        assert!(matches!(corner.total_drift(&model, invalid_value), Err(Error::Input { .. })));
    }
}
