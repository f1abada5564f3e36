//! GOAL: interface laws, time schemes and ground motions refuse bad numbers.
//! SCENE: zero, negative and non-finite parameters.
//! REFERENCE: the fields of the error.

use basemat::Error;
use basemat::coupled::Theta;
use basemat::interface::{Coulomb, EarthPressure, UnilateralCondition};
use basemat::motion::{Baseline, Record, RickerDisplacement};
use basemat::soil::SoilStrength;

use super::{NEGATIVE_OR_NOT_FINITE, NOT_FINITE, NOT_POSITIVE_FINITE, assert_refused, error_with};

#[test]
fn laws_and_schemes_refuse_bad_numbers() {
    assert_refused("friction", &[-0.1, f64::NAN, f64::NEG_INFINITY], Coulomb::new);
    let law = Coulomb::uplift_only();
    assert_refused("tensile strength", &NEGATIVE_OR_NOT_FINITE, |x| law.with_tensile_strength(x));
    assert_refused("gap below", &NEGATIVE_OR_NOT_FINITE, |closed_below| {
        law.with_unilateral_condition(UnilateralCondition::Velocity { closed_below })
    });
    assert_refused("active pressure", &NEGATIVE_OR_NOT_FINITE, |x| EarthPressure::new(x, 1e4, 0.3));
    assert_refused("passive pressure", &[1e3, 0.0, f64::NAN, f64::INFINITY], |x| {
        EarthPressure::new(1e3, x, 0.3)
    });
    assert_refused("friction coefficient", &[-0.1, f64::NAN], |x| EarthPressure::new(1e3, 1e4, x));
    assert_refused(
        "friction angle of the soil",
        &[-0.1, 30.0, f64::NAN, f64::INFINITY],
        SoilStrength::new,
    );
    let sand = SoilStrength::new(0.8).unwrap();
    assert_refused("cohesion of the soil", &NEGATIVE_OR_NOT_FINITE, |x| sand.with_cohesion(x));
    // With 0.8 rad no plane wedge slides at the passive limit.
    assert_refused("friction angle of the wall", &[-0.1, 0.81, 0.8, f64::NAN], |x| {
        sand.with_wall_friction(x)
    });
    assert_refused("theta", &[0.0, 0.49, 1.01, f64::NAN], Theta::new);
}

#[test]
fn motions_refuse_bad_numbers() {
    assert_refused("time step of the record", &NOT_POSITIVE_FINITE, |x| {
        Record::new(x, vec![0.0; 3])
    });
    for x in NOT_FINITE {
        let error = error_with("acceleration", Record::new(0.1, vec![0.0, x, 0.0]));
        assert!(matches!(error, Error::NotFinite { index: 1, .. }));
    }
    for samples in [vec![], vec![1.0]] {
        assert!(matches!(
            error_with("samples", Record::new(0.1, samples)),
            Error::Size { needed: 2, .. }
        ));
    }
    let record = Record::new(0.1, vec![0.0, 1.0, 0.0, -1.0]).unwrap();
    assert_refused("new time step", &NOT_POSITIVE_FINITE, |x| record.resampled(x));
    assert_refused("scale factor", &NOT_FINITE, |x| record.scaled(x));
    assert_refused("wanted peak", &NOT_POSITIVE_FINITE, |x| record.scaled_to_peak(x));
    assert!(record.with_baseline(Baseline::VelocityPolynomial { degree: 0 }).is_err());
    assert!(record.with_baseline(Baseline::RestToRest { degree: 9 }).is_err());
    assert_refused("amplitude", &NOT_FINITE, |x| RickerDisplacement::new(x, 0.1, 1.0));
    assert_refused("width", &NOT_POSITIVE_FINITE, |x| RickerDisplacement::new(1.0, x, 1.0));
    assert_refused("center", &[0.0, f64::NAN, f64::INFINITY], |x| {
        RickerDisplacement::new(1.0, 0.1, x)
    });
}
