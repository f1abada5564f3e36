//! GOAL: invalid parameters and invalid saved states are typed errors that change nothing.
//! SCENE: one invalid number at a time.
//! REFERENCE: the error, and the structure as it was.

use basemat::coupled::CheckpointError;
use basemat::structure::{
    Bilinear, BoucWen, FrictionPendulum, Hysteresis, IsolationLevel, LeadRubber, NonlinearForce,
    RigidBlock, ShearBuilding, Storey, Structure, WithSprings,
};
use basemat::{Error, Result};

const INVALID_NUMBERS: [f64; 5] = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[expect(clippy::needless_pass_by_value, reason = "accepts results by value")]
fn is_input<T>(result: Result<T>) -> bool {
    matches!(result, Err(Error::Input { .. }))
}

#[test]
fn invalid_parameters_are_errors() {
    for invalid_value in INVALID_NUMBERS {
        assert!(is_input(Bilinear::new(invalid_value, 1.0, 0.1)));
        assert!(is_input(Bilinear::new(1.0, invalid_value, 0.1)));
        assert!(is_input(BoucWen::new(invalid_value, 1.0, 0.1)));
        assert!(is_input(BoucWen::new(1.0, invalid_value, 0.1)));
        assert!(is_input(FrictionPendulum::new(invalid_value, 1.0, 0.1)));
        assert!(is_input(FrictionPendulum::new(1.0, invalid_value, 0.1)));
        assert!(is_input(FrictionPendulum::new(1.0, 1.0, invalid_value)));
        let pendulum = FrictionPendulum::new(1.0, 1.0, 0.1).unwrap();
        assert!(is_input(pendulum.sliding_period(invalid_value)));
        assert!(is_input(pendulum.with_yield_displacement(invalid_value)));
        for k in 0..4 {
            let mut p = [0.4e6, 0.5, 0.2, 0.01];
            p[k] = invalid_value;
            assert!(is_input(LeadRubber::new(p[0], p[1], p[2], p[3])));
        }
        assert!(is_input(LeadRubber::from_strength(invalid_value, 1.0)));
        assert!(is_input(LeadRubber::from_strength(1.0, 1.0).unwrap().with_stiffness_ratio(invalid_value)));
    }
    for invalid_value in [-0.1, 1.0, 2.0, f64::NAN, f64::INFINITY] {
        assert!(is_input(Bilinear::new(1.0, 1.0, invalid_value)));
        assert!(is_input(BoucWen::new(1.0, 1.0, invalid_value)));
    }
    for (n, beta) in [(0.9, 0.5), (11.0, 0.5), (f64::NAN, 0.5), (2.0, 0.4), (2.0, 1.1)] {
        assert!(is_input(BoucWen::new(1.0, 1.0, 0.0).unwrap().with_shape(n, beta)));
    }
    // Products that leave the range of numbers
    assert!(is_input(Bilinear::new(1e-320, 1e-320, 1.0 - 1e-16)));
    assert!(is_input(BoucWen::new(1e300, 1e-300, 0.0)));
    assert!(is_input(FrictionPendulum::new(1e300, 1e-300, 0.1)));
    assert!(is_input(LeadRubber::from_strength(1e308, 1.0)));
}

fn building() -> ShearBuilding {
    let storeys = [Storey::new(3.0, 2e4, 4e7); 2];
    ShearBuilding::new(10.0, 5e4, 4e5, &storeys).unwrap()
}

fn law() -> Bilinear {
    Bilinear::new(4e7, 1e5, 0.05).unwrap()
}

#[test]
fn storeys_have_one_law_each() {
    let building_with_law = building().with_law(1, law()).unwrap();
    assert!(matches!(building_with_law.with_law(1, law()), Err(Error::Scene { .. })));
    let building_with_law = building().with_law(1, law()).unwrap();
    // The force of a law is not a weighted sum of displacements: its rows have the inertia above instead.
    let linear_shear = building_with_law.shear(0).unwrap();
    let law_shear = building_with_law.shear(1).unwrap();
    assert!(linear_shear.acceleration.is_empty() && law_shear.displacement.is_empty());
    assert_eq!(law_shear.acceleration[..], [(4, -2e4)]);
    let building_without_laws = building();
    assert!(building_without_laws.nonlinear().is_none());
    assert!(matches!(building_without_laws.shear(2), Err(Error::Index { .. })));
    assert!(matches!(building_without_laws.with_law(2, law()), Err(Error::Index { index: 2, bound: 2, .. })));
    let level = IsolationLevel { height: 0.3, slab_mass: 3e4, slab_inertia: 0.0, damping: 0.0 };
    for invalid_value in INVALID_NUMBERS {
        for level in [
            IsolationLevel { height: invalid_value, ..level },
            IsolationLevel { slab_mass: invalid_value, ..level },
            IsolationLevel { slab_inertia: invalid_value.min(-1.0), ..level },
            IsolationLevel { damping: if invalid_value == 0.0 { -1.0 } else { invalid_value }, ..level },
        ] {
            assert!(is_input(building().isolated(level, law())));
        }
    }
    let level_too_late = building().with_law(0, law()).unwrap().isolated(level, law());
    assert!(matches!(level_too_late, Err(Error::Scene { .. })));
    let isolated_building = building().isolated(level, law()).unwrap();
    assert_eq!(isolated_building.dofs(), 6);
    assert!(isolated_building.drift(2).is_ok() && isolated_building.drift(3).is_err());
}

fn sprung_block() -> WithSprings {
    WithSprings::new(RigidBlock::new(2.0, 4.0, 2000.0).unwrap())
}

#[test]
fn springs_need_dofs_that_exist() {
    assert!(sprung_block().nonlinear().is_none());
    assert!(matches!(sprung_block().spring(vec![(3, 1.0)], law()), Err(Error::Index { .. })));
    assert!(is_input(sprung_block().spring(vec![(0, f64::NAN)], law())));
}

#[test]
fn saved_states_that_are_not_finite_are_errors() {
    let laws: [Box<dyn Hysteresis>; 4] = [
        Box::new(law()),
        Box::new(LeadRubber::from_strength(1e6, 1e5).unwrap()),
        Box::new(FrictionPendulum::new(1e6, 2.0, 0.05).unwrap()),
        Box::new(BoucWen::new(1e7, 1e5, 0.1).unwrap()),
    ];
    for mut law in laws {
        law.commit(0.05);
        let saved_variables = law.save();
        let before = law.response(0.03);
        for place in 0..saved_variables.len() {
            for invalid_value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut invalid_variables = saved_variables.clone();
                invalid_variables[place] = invalid_value;
                let error = law.restore(&invalid_variables).unwrap_err();
                let expected = CheckpointError::Corrupt { quantity: "state of a hysteretic spring" };
                assert_eq!(error, Error::Checkpoint(expected), "{place}: {invalid_value}");
                assert_eq!(law.response(0.03), before);
            }
        }
        law.restore(&saved_variables).unwrap();
    }
}

fn spring_force(structure: &WithSprings) -> [f64; 5] {
    let mut force = [0.0; 5];
    structure.force(&[0.0, 0.0, 0.0, 0.015, 0.03], &mut force).unwrap();
    force
}

#[test]
fn saved_states_are_restored_or_change_nothing() {
    let bouc_wen = BoucWen::new(1e7, 1e5, 0.1).unwrap();
    let mut structure = WithSprings::new(building().with_law(0, law()).unwrap())
        .spring(vec![(3, 1.0), (0, -1.0)], bouc_wen.clone())
        .unwrap();
    let u = [0.0, 0.0, 0.0, 0.02, 0.03];
    structure.commit(&u);
    let saved_variables = structure.save().unwrap();
    let before = spring_force(&structure);
    assert_eq!(saved_variables.len(), 5);
    for (place, value) in [(1, 2.0), (2, -1.0), (4, -1.0)] {
        let mut invalid_variables = saved_variables.clone();
        invalid_variables[place] = value;
        assert!(matches!(structure.restore(&invalid_variables), Err(Error::Checkpoint(_))), "{place}");
        assert_eq!(spring_force(&structure), before);
    }
    for length in [0, 2, 3, 4, 6] {
        let mut invalid_variables = saved_variables.clone();
        invalid_variables.resize(length, 0.0);
        assert!(matches!(structure.restore(&invalid_variables), Err(Error::Checkpoint(_))), "{length}");
        assert_eq!(spring_force(&structure), before);
    }
    structure.commit(&[0.0, 0.0, 0.0, -0.04, -0.05]);
    assert_ne!(spring_force(&structure), before);
    structure.restore(&saved_variables).unwrap();
    assert_eq!(spring_force(&structure), before);
    // Slices that are too short count as zero beyond their ends.
    structure.force(&[0.0; 2], &mut [0.0; 2]).unwrap();
    structure.commit(&[]);
    // Out-of-range deformations give numbers that are not finite, and no panic.
    for invalid_number in [f64::NAN, f64::INFINITY, 1e300] {
        let _ = bouc_wen.response(invalid_number);
        let _ = bouc_wen.energy(invalid_number);
        let _ = law().response(invalid_number);
    }
}
