//! GOAL: hysteretic springs in a plane differ from two uniaxial ones, return errors for invalid states, and act on structures.
//! SCENE: a spring on the diagonal; saved states with one number changed; a block with springs of both kinds.
//! REFERENCE: closed forms, the errors, differences.

use std::f64::consts::SQRT_2;

use basemat::Error;
use basemat::structure::{
    Bilinear, BoucWen, Hysteresis, NonlinearForce, RigidBlock, Triplets, WithSprings,
};

use super::biaxial::{INITIAL_STIFFNESS, LawPair, YIELD_FORCE, bouc_wen, laws};

/// Two uniaxial sliders carry √2 times their friction on the diagonal, a coupled one carries its friction.
#[test]
fn two_sliders_along_the_axes_are_stronger_on_the_diagonal() {
    let law = Bilinear::new(INITIAL_STIFFNESS, YIELD_FORCE, 0.0).unwrap();
    let diagonal_force = law.response(0.1).force * SQRT_2;
    let force = law.coupled().response([0.1, 0.1]).force;
    assert!((force[0].hypot(force[1]) / YIELD_FORCE - 1.0).abs() < 1e-14);
    assert!((diagonal_force / YIELD_FORCE - SQRT_2).abs() < 1e-14);
}

#[test]
fn invalid_states_and_deformations_cause_no_panic() {
    for exponent in [1.0, 1.999, 10.0] {
        let law = BoucWen::new(1e7, 1e5, 0.1).and_then(|law| law.with_shape(exponent, 0.5));
        assert!(matches!(law.unwrap().coupled(), Err(Error::Input { .. })));
    }
    for LawPair { name, coupled: mut spring, .. } in laws() {
        spring.commit([0.02, -0.05]);
        let saved_variables = spring.save();
        let before = spring.response([0.03, 0.01]);
        for place in 0..saved_variables.len() {
            for invalid_value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut invalid_variables = saved_variables.clone();
                invalid_variables[place] = invalid_value;
                assert!(matches!(spring.restore(&invalid_variables), Err(Error::Checkpoint(_))), "{name}");
                assert_eq!(spring.response([0.03, 0.01]), before);
            }
        }
        let mut invalid_variables = saved_variables.clone();
        *invalid_variables.last_mut().unwrap() = -1.0;
        assert!(spring.restore(&invalid_variables).is_err() && spring.restore(&saved_variables[1..]).is_err());
        if saved_variables.len() == 5 {
            assert!(spring.restore(&[0.0, 0.0, 0.8, 0.7, 0.0]).is_err());
        }
        spring.commit([-0.04, 0.01]);
        assert_ne!(spring.response([0.03, 0.01]), before);
        spring.restore(&saved_variables).unwrap();
        assert_eq!(spring.response([0.03, 0.01]), before);
        for invalid_number in [f64::NAN, f64::INFINITY] {
            let force = spring.response([invalid_number, 0.0]).force;
            assert!(force.iter().any(|force| !force.is_finite()), "{name}: {force:?}");
            assert!(!spring.energy([0.1, invalid_number]).dissipated.is_finite(), "{name}");
        }
        let far_response = spring.response([1e300, -1e300]);
        assert!(!far_response.force[0].is_nan() && far_response.tangent.iter().flatten().all(|k| k.is_finite()));
    }
}

fn sprung_block() -> WithSprings {
    WithSprings::new(RigidBlock::new(2.0, 4.0, 2000.0).unwrap())
}

fn spring_force(structure: &WithSprings, u: [f64; 3]) -> [f64; 3] {
    let mut force = [0.0; 3];
    structure.force(&u, &mut force).unwrap();
    force
}

/// Springs of both kinds on the degrees of freedom of a block: force, tangent, energy and saved states.
#[test]
fn springs_of_both_kinds_act_on_their_degrees_of_freedom() {
    let uniaxial = Bilinear::new(INITIAL_STIFFNESS, YIELD_FORCE, 0.1).unwrap();
    let coupled_law = bouc_wen(0.05, 0.7).coupled().unwrap();
    let rows = [vec![(0, 1.0), (2, 3.0)], vec![(1, -2.0)]];
    let mut structure = sprung_block()
        .spring((2, 0.5), uniaxial.clone())
        .and_then(|structure| structure.biaxial_spring(rows, coupled_law.clone()))
        .unwrap();
    let u = [0.004, -0.006, 0.003];
    let along_rotation = uniaxial.response(0.5 * u[2]).force;
    let force = coupled_law.response([u[0] + 3.0 * u[2], -2.0 * u[1]]).force;
    let expected = [force[0], -2.0 * force[1], 0.5 * along_rotation + 3.0 * force[0]];
    assert_eq!(spring_force(&structure, u), expected);
    let mut matrix = Triplets::new(3);
    structure.tangent(&u, &mut matrix).unwrap();
    let mut tangent = [[0.0; 3]; 3];
    matrix.entries().iter().for_each(|&(i, j, value)| tangent[i][j] += value);
    for k in 0..3 {
        let [below, above] = [-1e-8, 1e-8].map(|by| {
            let mut shifted_displacement = u;
            shifted_displacement[k] += by;
            spring_force(&structure, shifted_displacement)
        });
        for i in 0..3 {
            let slope = (above[i] - below[i]) / 2e-8;
            assert!((tangent[i][k] - slope).abs() < 1e-5 * INITIAL_STIFFNESS, "{i} {k}: {slope}");
            assert_eq!(tangent[i][k], tangent[k][i]);
        }
    }
    structure.commit(&u);
    let saved_variables = structure.save().unwrap();
    let before = spring_force(&structure, [0.0; 3]);
    assert_eq!(saved_variables.len(), 2 + 5);
    let mut invalid_variables = saved_variables.clone();
    invalid_variables[5] = 2.0;
    invalid_variables[0] += 0.01;
    assert!(matches!(structure.restore(&invalid_variables), Err(Error::Checkpoint(_))));
    assert_eq!(spring_force(&structure, [0.0; 3]), before);
    structure.commit(&[0.0, 0.01, 0.02]);
    structure.restore(&saved_variables).unwrap();
    assert_eq!(spring_force(&structure, [0.0; 3]), before);
    let error_of_a_missing_dof = sprung_block().biaxial_spring([vec![(0, 1.0)], vec![(3, 1.0)]], coupled_law.clone());
    assert!(matches!(error_of_a_missing_dof, Err(Error::Index { index: 3, .. })));
    let error_of_an_invalid_factor = sprung_block().biaxial_spring([vec![(0, f64::NAN)], vec![(1, 1.0)]], coupled_law);
    assert!(matches!(error_of_an_invalid_factor, Err(Error::Input { .. })));
}
