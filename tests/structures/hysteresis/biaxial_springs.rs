//! GOAL: hysteretic springs in a plane differ from two uniaxial ones, refuse invalid states, and act on structures.
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
    let both = law.response(0.1).force * SQRT_2;
    let force = law.coupled().response([0.1, 0.1]).force;
    assert!((force[0].hypot(force[1]) / YIELD_FORCE - 1.0).abs() < 1e-14);
    assert!((both / YIELD_FORCE - SQRT_2).abs() < 1e-14);
}

#[test]
fn invalid_states_and_deformations_cause_no_panic() {
    for exponent in [1.0, 1.999, 10.0] {
        let law = BoucWen::new(1e7, 1e5, 0.1).and_then(|law| law.with_shape(exponent, 0.5));
        assert!(matches!(law.unwrap().coupled(), Err(Error::Input { .. })));
    }
    for LawPair { name, coupled: mut spring, .. } in laws() {
        spring.commit([0.02, -0.05]);
        let saved = spring.save();
        let before = spring.response([0.03, 0.01]);
        for place in 0..saved.len() {
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut wrong = saved.clone();
                wrong[place] = bad;
                assert!(matches!(spring.restore(&wrong), Err(Error::Checkpoint(_))), "{name}");
                assert_eq!(spring.response([0.03, 0.01]), before);
            }
        }
        let mut wrong = saved.clone();
        *wrong.last_mut().unwrap() = -1.0;
        assert!(spring.restore(&wrong).is_err() && spring.restore(&saved[1..]).is_err());
        if saved.len() == 5 {
            assert!(spring.restore(&[0.0, 0.0, 0.8, 0.7, 0.0]).is_err());
        }
        spring.commit([-0.04, 0.01]);
        assert_ne!(spring.response([0.03, 0.01]), before);
        spring.restore(&saved).unwrap();
        assert_eq!(spring.response([0.03, 0.01]), before);
        for wild in [f64::NAN, f64::INFINITY] {
            let force = spring.response([wild, 0.0]).force;
            assert!(force.iter().any(|force| !force.is_finite()), "{name}: {force:?}");
            assert!(!spring.energy([0.1, wild]).dissipated.is_finite(), "{name}");
        }
        let far = spring.response([1e300, -1e300]);
        assert!(!far.force[0].is_nan() && far.tangent.iter().flatten().all(|k| k.is_finite()));
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
    let coupled = bouc_wen(0.05, 0.7).coupled().unwrap();
    let rows = [vec![(0, 1.0), (2, 3.0)], vec![(1, -2.0)]];
    let mut structure = sprung_block()
        .spring((2, 0.5), uniaxial.clone())
        .and_then(|structure| structure.biaxial_spring(rows, coupled.clone()))
        .unwrap();
    let u = [0.004, -0.006, 0.003];
    let along_rotation = uniaxial.response(0.5 * u[2]).force;
    let force = coupled.response([u[0] + 3.0 * u[2], -2.0 * u[1]]).force;
    let expected = [force[0], -2.0 * force[1], 0.5 * along_rotation + 3.0 * force[0]];
    assert_eq!(spring_force(&structure, u), expected);
    let mut matrix = Triplets::new(3);
    structure.tangent(&u, &mut matrix).unwrap();
    let mut tangent = [[0.0; 3]; 3];
    matrix.entries().iter().for_each(|&(i, j, value)| tangent[i][j] += value);
    for k in 0..3 {
        let [below, above] = [-1e-8, 1e-8].map(|by| {
            let mut moved = u;
            moved[k] += by;
            spring_force(&structure, moved)
        });
        for i in 0..3 {
            let slope = (above[i] - below[i]) / 2e-8;
            assert!((tangent[i][k] - slope).abs() < 1e-5 * INITIAL_STIFFNESS, "{i} {k}: {slope}");
            assert_eq!(tangent[i][k], tangent[k][i]);
        }
    }
    structure.commit(&u);
    let saved = structure.save().unwrap();
    let before = spring_force(&structure, [0.0; 3]);
    assert_eq!(saved.len(), 2 + 5);
    let mut wrong = saved.clone();
    wrong[5] = 2.0;
    wrong[0] += 0.01;
    assert!(matches!(structure.restore(&wrong), Err(Error::Checkpoint(_))));
    assert_eq!(spring_force(&structure, [0.0; 3]), before);
    structure.commit(&[0.0, 0.01, 0.02]);
    structure.restore(&saved).unwrap();
    assert_eq!(spring_force(&structure, [0.0; 3]), before);
    let far = sprung_block().biaxial_spring([vec![(0, 1.0)], vec![(3, 1.0)]], coupled.clone());
    assert!(matches!(far, Err(Error::Index { index: 3, .. })));
    let wild = sprung_block().biaxial_spring([vec![(0, f64::NAN)], vec![(1, 1.0)]], coupled);
    assert!(matches!(wild, Err(Error::Input { .. })));
}
