//! GOAL: interface laws, time schemes, footings and ground motions return errors for bad numbers.
//! SCENE: zero, negative and non-finite parameters.
//! REFERENCE: the fields of the error.

use basemat::Error;
use basemat::coupled::Theta;
use basemat::interface::{Coulomb, EarthPressure, UnilateralCondition};
use basemat::motion::{Baseline, Record, RickerDisplacement};
use basemat::soil::{BearingFactors, FootingLoad, ShallowFooting, SoilStrength};

use super::{NEGATIVE_OR_NOT_FINITE, NOT_FINITE, NOT_POSITIVE_FINITE, assert_errors, error_with};

#[test]
fn laws_and_schemes_return_errors_for_invalid_numbers() {
    assert_errors("friction", &[-0.1, f64::NAN, f64::NEG_INFINITY], Coulomb::new);
    let law = Coulomb::uplift_only();
    assert_errors("tensile strength", &NEGATIVE_OR_NOT_FINITE, |x| law.with_tensile_strength(x));
    assert_errors("gap below", &NEGATIVE_OR_NOT_FINITE, |closed_below| {
        law.with_unilateral_condition(UnilateralCondition::Velocity { closed_below })
    });
    assert_errors("active pressure", &NEGATIVE_OR_NOT_FINITE, |x| EarthPressure::new(x, 1e4, 0.3));
    assert_errors("passive pressure", &[1e3, 0.0, f64::NAN, f64::INFINITY], |x| {
        EarthPressure::new(1e3, x, 0.3)
    });
    assert_errors("friction coefficient", &[-0.1, f64::NAN], |x| EarthPressure::new(1e3, 1e4, x));
    assert_errors(
        "friction angle of the soil",
        &[-0.1, 30.0, f64::NAN, f64::INFINITY],
        SoilStrength::new,
    );
    let sand = SoilStrength::new(0.8).unwrap();
    assert_errors("cohesion of the soil", &NEGATIVE_OR_NOT_FINITE, |x| sand.with_cohesion(x));
    // With 0.8 rad no plane wedge slides at the passive limit.
    assert_errors("friction angle of the wall", &[-0.1, 0.81, 0.8, f64::NAN], |x| {
        sand.with_wall_friction(x)
    });
    assert_errors("theta", &[0.0, 0.49, 1.01, f64::NAN], Theta::new);
}

#[test]
fn footings_return_errors_for_invalid_numbers() {
    assert_errors("side of a footing along x", &NOT_POSITIVE_FINITE, |x| {
        ShallowFooting::rectangle([x, 1.0])
    });
    assert_errors("side of a footing along y", &NOT_POSITIVE_FINITE, |x| {
        ShallowFooting::rectangle([1.0, x])
    });
    assert_errors("diameter", &NOT_POSITIVE_FINITE, ShallowFooting::circle);
    assert_errors("width of a strip", &NOT_POSITIVE_FINITE, ShallowFooting::strip);
    assert_errors("friction angle", &[-0.1, 1.6, f64::NAN], BearingFactors::new);
    assert_errors("factor of the unit weight", &[f64::INFINITY], |_| {
        BearingFactors::new(std::f64::consts::FRAC_PI_2.next_down())
    });
    let footing = ShallowFooting::rectangle([2.0, 3.0]).unwrap();
    assert_errors("pressure of the soil beside", &NEGATIVE_OR_NOT_FINITE, |x| {
        footing.with_surcharge(x)
    });
    assert_errors("eccentricity", &[1.0, -1.0, f64::NAN, f64::INFINITY], |x| {
        footing.with_eccentricity([x, 0.0])
    });
    let circle = ShallowFooting::circle(2.0).unwrap();
    assert_errors("eccentricity", &[0.1], |x| circle.with_eccentricity([0.0, x]));
    assert_errors("tilt of the base", &[-0.1, 0.8, f64::NAN], |x| footing.with_base_tilt(x));
    let load = FootingLoad { vertical: 1e5, horizontal: [0.0; 2] };
    assert_errors("vertical force", &NEGATIVE_OR_NOT_FINITE, |vertical| {
        footing.with_load(FootingLoad { vertical, ..load })
    });
    assert_errors("horizontal force", &NOT_FINITE, |x| {
        footing.with_load(FootingLoad { horizontal: [0.0, x], ..load })
    });
    let sand = SoilStrength::new(0.6).unwrap();
    assert_errors("unit weight", &NEGATIVE_OR_NOT_FINITE, |x| footing.drained_pressure(&sand, x));
    assert_errors("unit weight", &NEGATIVE_OR_NOT_FINITE, |x| footing.pressure_growth(&sand, x));
    assert_errors("friction angle of drained soil", &[0.0], |x| {
        footing.drained_pressure(&SoilStrength::new(x).unwrap(), 1e4)
    });
    // Weightless sand without a surcharge has no bearing pressure.
    assert_errors("bearing pressure", &[0.0], |x| footing.drained_pressure(&sand, x));
    assert_errors("horizontal force", &[1e5, 2e5], |x| {
        let pushed_footing =
            footing.with_load(FootingLoad { horizontal: [x, 0.0], ..load }).unwrap();
        pushed_footing.drained_pressure(&sand, 1e4)
    });
    assert_errors("undrained strength", &NOT_POSITIVE_FINITE, |x| footing.undrained_pressure(x));
    assert_errors("horizontal force", &[1e5], |x| {
        let pushed_footing =
            footing.with_load(FootingLoad { horizontal: [x, 0.0], ..load }).unwrap();
        pushed_footing.undrained_pressure(1e4)
    });
    let tilted_footing = footing.with_base_tilt(0.7).unwrap();
    assert_errors("tilt of the base", &[0.7], |_| {
        tilted_footing.drained_pressure(&SoilStrength::new(1.0).unwrap(), 1e4)
    });
    assert_errors("vertical force", &NOT_POSITIVE_FINITE, |x| footing.rocking_capacity(x, 1e5));
    assert_errors("bearing pressure", &NOT_POSITIVE_FINITE, |x| footing.rocking_capacity(1e5, x));
    assert_errors("vertical force", &[6.1e5], |x| footing.rocking_capacity(x, 1e5));
}

#[test]
fn motions_return_errors_for_invalid_numbers() {
    assert_errors("time step of the record", &NOT_POSITIVE_FINITE, |x| {
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
    assert_errors("new time step", &NOT_POSITIVE_FINITE, |x| record.resampled(x));
    assert_errors("scale factor", &NOT_FINITE, |x| record.scaled(x));
    assert_errors("peak acceleration of the scaled record", &NOT_POSITIVE_FINITE, |x| {
        record.scaled_to_peak(x)
    });
    assert!(record.with_baseline(Baseline::VelocityPolynomial { degree: 0 }).is_err());
    assert!(record.with_baseline(Baseline::RestToRest { degree: 9 }).is_err());
    assert_errors("amplitude", &NOT_FINITE, |x| RickerDisplacement::new(x, 0.1, 1.0));
    assert_errors("width", &NOT_POSITIVE_FINITE, |x| RickerDisplacement::new(1.0, x, 1.0));
    assert_errors("center", &[0.0, f64::NAN, f64::INFINITY], |x| {
        RickerDisplacement::new(1.0, 0.1, x)
    });
}
