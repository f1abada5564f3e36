//! GOAL: negative masses and stiffnesses are distinguished from rounding and from constraints.
//! SCENE: floors tied by a multiplier, masses of rounding size, unstable columns.
//! REFERENCE: the same structure without the constraint; typed errors.

use basemat::coupled::{Load, Newmark};
use basemat::structure::{BaseNode, DofCombination, MatrixModel, Triplets};
use basemat::{Error, Result};

use super::model::on_soil;

/// Lever of the floors over the base in m.
const FLOOR_HEIGHT: f64 = 5.0;

fn base_masses(order: usize) -> Triplets {
    let mut mass = Triplets::new(order);
    [1.0e5, 1.0e5, 4.0e5].into_iter().enumerate().for_each(|(i, m)| mass.add(i, i, m));
    mass
}

fn on_base(mass: Triplets, stiffness: Triplets) -> Result<MatrixModel> {
    MatrixModel::new(mass, stiffness, BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]))
}

/// Adds a column of stiffness `stiffness` from the base to the floor `dof`.
fn column(matrix: &mut Triplets, dof: usize, stiffness: f64) {
    matrix.add_outer([(dof, 1.0), (0, -1.0), (2, FLOOR_HEIGHT)], stiffness);
}

/// Two floors at one height, with a spring between them, and a multiplier of coefficient
/// `coefficient` that ties them.
fn tied(coefficient: f64, spring_stiffness: f64, columns: [f64; 2]) -> MatrixModel {
    let mut mass = base_masses(6);
    mass.add(3, 3, 1.0e4);
    mass.add(4, 4, 2.0e4);
    let mut stiffness = Triplets::new(6);
    column(&mut stiffness, 3, columns[0]);
    column(&mut stiffness, 4, columns[1]);
    stiffness.add_spring(3, 4, spring_stiffness);
    for (floor, sign) in [(3, 1.0), (4, -1.0)] {
        stiffness.add(5, floor, sign * coefficient);
        stiffness.add(floor, 5, sign * coefficient);
    }
    on_base(mass, stiffness).unwrap()
}

fn floor_displacements(model: MatrixModel) -> Vec<f64> {
    let mut simulation = on_soil(model).build().unwrap();
    let mut displacements = Vec::new();
    simulation
        .run(500, |state| displacements.push(state.absolute_displacement()[3]))
        .unwrap();
    displacements
}

/// A multiplier does not count as negative stiffness, whatever its coefficient, nor does a stiffness that the
/// multiplier keeps from acting: a spring between tied floors, or a column that the other outweighs.
#[test]
fn floors_tied_by_a_multiplier_move_as_one() {
    let mut mass = base_masses(4);
    mass.add(3, 3, 3.0e4);
    let mut stiffness = Triplets::new(4);
    column(&mut stiffness, 3, 7.0e6);
    let merged_displacements = floor_displacements(on_base(mass, stiffness).unwrap());
    let max_magnitude = merged_displacements.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    assert!(max_magnitude > 1e-3, "{max_magnitude}");
    for (coefficient, between, columns) in [
        (1.0e6, 0.0, [4.0e6, 3.0e6]),
        (1.0, 0.0, [4.0e6, 3.0e6]),
        (1.0e6, -1.0e8, [4.0e6, 3.0e6]),
        (1.0e6, 0.0, [-1.0e6, 8.0e6]),
    ] {
        let two = floor_displacements(tied(coefficient, between, columns));
        let error = two
            .iter()
            .zip(&merged_displacements)
            .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        assert!(error < 1e-9 * max_magnitude, "{coefficient:e} {between:e} {columns:?}: {error:e}");
    }
}

#[track_caller]
fn assert_indefinite(model: MatrixModel) {
    let error = on_soil(model).gravity(0.0).build().err();
    assert!(matches!(error, Some(Error::Indefinite { .. })), "{error:?}");
}

/// Beside a multiplier negative stiffness is still an error, and so is a multiplier with a mass.
#[test]
fn negative_stiffness_beside_a_multiplier_is_an_error() {
    assert_indefinite(tied(1.0e6, 0.0, [-5.0e6, 4.0e6]));
    assert_indefinite(tied(1.0, 0.0, [-5.0e6, 4.0e6]));
    let mut mass = base_masses(5);
    mass.add(3, 3, 1.0e4);
    mass.add(4, 4, 1.0e-3);
    let mut stiffness = Triplets::new(5);
    column(&mut stiffness, 3, 4.0e6);
    stiffness.add(3, 4, 1.0e6);
    stiffness.add(4, 3, 1.0e6);
    assert_indefinite(on_base(mass, stiffness).unwrap());
}

/// A floor of mass 1e4 on the base, and on it a degree of freedom 4 with these masses.
fn appended(entries: &[(usize, usize, f64)]) -> Result<MatrixModel> {
    let mut mass = base_masses(5);
    mass.add(3, 3, 1.0e4);
    for &(row, column, value) in entries {
        mass.add(row, column, value);
        if row != column {
            mass.add(column, row, value);
        }
    }
    let mut stiffness = Triplets::new(5);
    column(&mut stiffness, 3, 4.0e6);
    stiffness.add_spring(3, 4, 1.0e6);
    on_base(mass, stiffness)
}

/// The rounding that a reduction or a file leaves on a massless degree of freedom has no effect on the motion.
#[test]
fn masses_of_rounding_have_no_effect() {
    let expected = floor_displacements(appended(&[]).unwrap());
    for rounding in [
        &[(4, 4, -1e-18)][..],
        &[(3, 4, 1e-13)],
        &[(4, 4, 1e-20), (0, 4, 1e-7)],
        &[(4, 4, -1e-12), (3, 4, -1e-9)],
    ] {
        let computed = floor_displacements(appended(rounding).unwrap());
        for (a, b) in computed.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-10, "{rounding:?}: {a} {b}");
        }
    }
}

/// The error names the invalid degree of freedom.
#[test]
fn masses_beyond_rounding_are_errors() {
    for (entries, diagonal) in [
        (&[(4, 4, -1000.0)][..], -1000.0),
        (&[(4, 4, -400.0)], -400.0),
        (&[(4, 4, -1e-6)], -1e-6),
        (&[(0, 4, 100.0)], 0.0),
        (&[(3, 4, 1.0)], 0.0),
        (&[(4, 4, 1.0), (3, 4, -101.0)], 1.0),
    ] {
        let result = appended(entries).unwrap_err();
        assert_eq!(result, Error::Indefinite { matrix: "mass matrix", row: 4, diagonal });
    }
}

/// Accelerations of the floors at the beginning, under a constant force on floor 3 from t = 0.
fn initial_accelerations(model: MatrixModel, force: f64) -> Result<Vec<f64>> {
    let simulation = on_soil(model)
        .gravity(0.0)
        .scheme(Newmark::default())
        .load(Load::constant(DofCombination::from(3), force))
        .build()?;
    Ok(simulation.state().acceleration()[3..].to_vec())
}

#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-9, "{found:e}");
}

/// Whether a scene with a force on a degree of freedom can be built.
fn build_with_force(dof: usize) -> Result<()> {
    let builder = on_soil(appended(&[]).unwrap()).gravity(0.0).scheme(Newmark::default());
    builder.load(Load::constant(DofCombination::from(dof), 1.0)).build().map(|_| ())
}

/// At t = 0 tied floors accelerate as one, and a massless degree of freedom follows its springs, also with a
/// mass of rounding; a force on it is an error.
#[test]
fn initial_accelerations_of_massless_dofs_follow_their_springs() {
    for coefficient in [1.0, 1.0e6, 1.0e9] {
        let computed =
            initial_accelerations(tied(coefficient, 0.0, [4.0e6, 3.0e6]), 6.0e4).unwrap();
        assert_near(computed[0], 2.0);
        assert_near(computed[1], 2.0);
    }
    for rounding in [&[][..], &[(4, 4, -1e-18)], &[(4, 4, 1e-20), (0, 4, 1e-7)]] {
        let computed = initial_accelerations(appended(rounding).unwrap(), 6.0e4).unwrap();
        assert_near(computed[0], 6.0);
        assert_near(computed[1], 6.0);
    }
    build_with_force(3).unwrap();
    let result = build_with_force(4).unwrap_err().to_string();
    assert!(result.contains("force at t = 0"), "{result}");
}
