//! GOAL: every baseline treatment meets its conditions.
//! SCENE: El Centro, polynomial drifts, arbitrary records.
//! REFERENCE: end values, the quantity that is minimised, the record under the drift.

use basemat::Error;
use basemat::motion::{Baseline, Record, el_centro_1940};
use proptest::prelude::*;

use basemat_problems::assert_close;

/// Time between samples, s.
const TIME_STEP: f64 = 0.01;

fn el_centro() -> Record {
    el_centro_1940().resampled(TIME_STEP).unwrap()
}

/// El Centro after a treatment.
fn treated(baseline: Baseline) -> Record {
    el_centro().with_baseline(baseline).unwrap()
}

/// Integral of the square over time.
fn square_integral(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() * TIME_STEP
}

/// The record with a small power of the time, relative to its duration, added to the accelerations.
fn with_power_of_time(record: &Record, sign: f64, power: i32) -> Record {
    let end = record.duration();
    let accelerations = record
        .accelerations()
        .iter()
        .enumerate()
        .map(|(k, a)| a + sign * 1e-4 * (k as f64 * TIME_STEP / end).powi(power));
    Record::new(TIME_STEP, accelerations.collect()).unwrap()
}

/// GOAL: velocity polynomials leave no velocity at the end, and a higher degree fits better.
#[test]
fn velocity_polynomials_end_without_velocity() {
    assert_eq!(treated(Baseline::None), el_centro());
    let end = el_centro().duration();
    let mut lower_degree = f64::INFINITY;
    for degree in 1..=8 {
        let treated = treated(Baseline::VelocityPolynomial { degree });
        assert!(treated.at(end).velocity.abs() < 1e-13, "{degree}");
        let integral = square_integral(treated.velocities());
        assert!(integral <= lower_degree * (1.0 + 1e-9), "{degree}: {integral} {lower_degree}");
        lower_degree = integral;
    }
    let without_mean = treated(Baseline::RemoveMean);
    assert!(without_mean.at(end).velocity.abs() < 1e-13);
    let first_degree = treated(Baseline::VelocityPolynomial { degree: 1 });
    for (a, b) in without_mean.accelerations().iter().zip(first_degree.accelerations()) {
        assert_close("degree 1 is the mean", *a, *b, 1e-15, 0.0);
    }
}

/// GOAL: records from rest to rest have no velocity and displacement at their end and after it.
#[test]
fn rest_to_rest_ends_at_rest() {
    let record = el_centro();
    let end = record.duration();
    for degree in 3..=8 {
        let treated = treated(Baseline::RestToRest { degree });
        assert!(treated.at(end).velocity.abs() < 1e-13, "{degree}");
        assert!(treated.at(end).displacement.abs() < 1e-12, "{degree}");
        assert!(treated.at(end + 1000.0).displacement.abs() < 1e-10, "{degree}");
        assert_eq!(treated.accelerations()[0], record.accelerations()[0]);
    }
}

/// GOAL: Newmark's parabola and the displacement polynomial minimise velocity and displacement.
#[test]
fn baselines_minimise_velocity_or_displacement() {
    let record = el_centro();
    let parabola = treated(Baseline::NewmarkParabola);
    let minimum = square_integral(parabola.velocities());
    assert!(minimum < square_integral(record.velocities()));
    for power in 0..3 {
        for sign in [-1.0, 1.0] {
            let other = with_power_of_time(&parabola, sign, power);
            assert!(square_integral(other.velocities()) > minimum, "{power} {sign}");
        }
    }
    // The sextic leaves less displacement than the record and than the parabola.
    let sextic = treated(Baseline::DisplacementPolynomial { degree: 6 });
    let minimum = square_integral(sextic.displacements());
    assert!(minimum < square_integral(record.displacements()));
    assert!(minimum < square_integral(parabola.displacements()));
    for power in 0..5 {
        for sign in [-1.0, 1.0] {
            let other = with_power_of_time(&sextic, sign, power);
            assert!(square_integral(other.displacements()) > minimum, "{power} {sign}");
        }
    }
}

/// GOAL: a polynomial drift is removed entirely.
#[test]
fn baselines_remove_a_polynomial() {
    let count = 2001;
    let accelerations = (0..count).map(|k| {
        let time = f64::from(k) / f64::from(count - 1);
        0.3 - 0.8 * time + 0.9 * time.powi(2)
    });
    let drift = Record::new(TIME_STEP, accelerations.collect()).unwrap();
    for baseline in [
        Baseline::NewmarkParabola,
        Baseline::VelocityPolynomial { degree: 4 },
        Baseline::DisplacementPolynomial { degree: 6 },
    ] {
        let treated = drift.with_baseline(baseline).unwrap();
        let remainder = treated.peaks().acceleration;
        // The normal equations of twice integrated polynomials lose four digits.
        assert!(remainder < 1e-11, "{baseline:?}: {remainder:e}");
    }
}

/// GOAL: degrees out of range and records too short for them are errors.
#[test]
fn invalid_baselines_are_errors() {
    let record = el_centro_1940();
    for baseline in [
        Baseline::VelocityPolynomial { degree: 0 },
        Baseline::VelocityPolynomial { degree: 9 },
        Baseline::DisplacementPolynomial { degree: 1 },
        Baseline::DisplacementPolynomial { degree: usize::MAX },
        Baseline::RestToRest { degree: 2 },
        Baseline::RestToRest { degree: 9 },
    ] {
        assert!(matches!(record.with_baseline(baseline), Err(Error::Input { .. })), "{baseline:?}");
    }
    let short = Record::new(1.0, vec![1.0, 2.0, 3.0, 4.0]).unwrap();
    let error = short.with_baseline(Baseline::NewmarkParabola).unwrap_err();
    assert!(matches!(error, Error::Input { value: 4.0, .. }), "{error}");
    let silent = Record::new(1.0, vec![0.0; 9]).unwrap();
    assert_eq!(silent.with_baseline(Baseline::RestToRest { degree: 4 }).unwrap(), silent);
}

proptest! {
    /// GOAL: end conditions hold for arbitrary records.
    #[test]
    fn end_conditions_hold_for_any_record(values in prop::collection::vec(-10.0..10.0_f64, 12..200)) {
        let record = Record::new(0.02, values).unwrap();
        let end = record.duration();
        for degree in 1..=8 {
            let treated = record.with_baseline(Baseline::VelocityPolynomial { degree }).unwrap();
            prop_assert!(treated.at(end).velocity.abs() < 1e-11);
        }
        for degree in 3..=8 {
            let treated = record.with_baseline(Baseline::RestToRest { degree }).unwrap();
            prop_assert!(treated.at(end).velocity.abs() < 1e-11);
            prop_assert!(treated.at(end).displacement.abs() < 1e-11);
        }
    }
}
