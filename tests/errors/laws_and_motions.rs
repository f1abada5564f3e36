//! GOAL: interface laws, time schemes and ground motions refuse bad numbers.
//! SCENE: zero, negative and non-finite parameters.
//! REFERENCE: the fields of the error.

use basemat::Error;
use basemat::coupled::Theta;
use basemat::interface::{Coulomb, EarthPressure, UnilateralCondition};
use basemat::motion::{Baseline, Record, RickerDisplacement};
use basemat::soil::SoilStrength;

use super::{BAD, NEGATIVE, NOT_FINITE, error_with, refused};

#[test]
fn laws_and_schemes() {
    refused("friction", &[-0.1, f64::NAN, f64::NEG_INFINITY], Coulomb::new);
    let law = Coulomb::uplift_only();
    refused("tensile strength", &NEGATIVE, |x| law.with_tensile_strength(x));
    refused("gap below", &NEGATIVE, |closed_below| {
        law.with_unilateral_condition(UnilateralCondition::Velocity { closed_below })
    });
    refused("active pressure", &NEGATIVE, |x| EarthPressure::new(x, 1e4, 0.3));
    refused("passive pressure", &[1e3, 0.0, f64::NAN, f64::INFINITY], |x| {
        EarthPressure::new(1e3, x, 0.3)
    });
    refused("friction coefficient", &[-0.1, f64::NAN], |x| EarthPressure::new(1e3, 1e4, x));
    refused(
        "friction angle of the soil",
        &[-0.1, 30.0, f64::NAN, f64::INFINITY],
        SoilStrength::new,
    );
    let sand = SoilStrength::new(0.8).unwrap();
    refused("cohesion of the soil", &NEGATIVE, |x| sand.with_cohesion(x));
    // With 0.8 rad no plane wedge slides at the passive limit.
    refused("friction angle of the wall", &[-0.1, 0.81, 0.8, f64::NAN], |x| {
        sand.with_wall_friction(x)
    });
    refused("theta", &[0.0, 0.49, 1.01, f64::NAN], Theta::new);
}

#[test]
fn motions() {
    refused("time step of the record", &BAD, |x| Record::new(x, vec![0.0; 3]));
    for x in NOT_FINITE {
        let error = error_with("acceleration", Record::new(0.1, vec![0.0, x, 0.0]));
        assert!(matches!(error, Error::NotFinite { index: 1, .. }));
    }
    for few in [vec![], vec![1.0]] {
        assert!(matches!(
            error_with("samples", Record::new(0.1, few)),
            Error::Size { needed: 2, .. }
        ));
    }
    let record = Record::new(0.1, vec![0.0, 1.0, 0.0, -1.0]).unwrap();
    refused("new time step", &BAD, |x| record.resampled(x));
    refused("scale factor", &NOT_FINITE, |x| record.scaled(x));
    refused("wanted peak", &BAD, |x| record.scaled_to_peak(x));
    assert!(record.with_baseline(Baseline::VelocityPolynomial { degree: 0 }).is_err());
    assert!(record.with_baseline(Baseline::RestToRest { degree: 9 }).is_err());
    refused("amplitude", &NOT_FINITE, |x| RickerDisplacement::new(x, 0.1, 1.0));
    refused("width", &BAD, |x| RickerDisplacement::new(1.0, x, 1.0));
    refused("center", &[0.0, f64::NAN, f64::INFINITY], |x| RickerDisplacement::new(1.0, 0.1, x));
}
