//! GOAL: every baseline treatment keeps what it promises.
//! SCENE: El Centro, polynomial drifts, any record.
//! REFERENCE: end values, the quantity that is least, the record under the drift.

use basemat::Error;
use basemat::motion::{Baseline, Record, el_centro_1940};
use proptest::prelude::*;

use basemat_problems::close;

/// Every treatment of El Centro: what it promises at the end, and what it makes least.
#[test]
fn baselines_keep_their_promises() {
    let record = el_centro_1940().resampled(0.01).unwrap();
    let end = record.duration();
    let square = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>() * 0.01;
    let treat = |baseline| record.with_baseline(baseline).unwrap();
    assert_eq!(treat(Baseline::None), record);

    let mut velocity_square = f64::INFINITY;
    for degree in 1..=8 {
        let treated = treat(Baseline::VelocityPolynomial { degree });
        assert!(treated.at(end).velocity.abs() < 1e-13, "{degree}");
        // a higher degree fits better
        let now = square(treated.velocities());
        assert!(now <= velocity_square * (1.0 + 1e-9), "{degree}: {now} {velocity_square}");
        velocity_square = now;
    }
    let mean = treat(Baseline::RemoveMean);
    assert!(mean.at(end).velocity.abs() < 1e-13);
    let first = treat(Baseline::VelocityPolynomial { degree: 1 });
    for (a, b) in mean.accelerations().iter().zip(first.accelerations()) {
        close("degree 1 is the mean", *a, *b, 1e-15, 0.0);
    }

    for degree in 3..=8 {
        let treated = treat(Baseline::RestToRest { degree });
        assert!(treated.at(end).velocity.abs() < 1e-13, "{degree}");
        assert!(treated.at(end).displacement.abs() < 1e-12, "{degree}");
        assert!(treated.at(end + 1000.0).displacement.abs() < 1e-10, "{degree}");
        assert_eq!(treated.accelerations()[0], record.accelerations()[0]);
    }

    let shifted = |record: &Record, sign: f64, power: i32| {
        let add = |(k, a): (usize, &f64)| a + sign * 1e-4 * (k as f64 * 0.01 / end).powi(power);
        Record::new(0.01, record.accelerations().iter().enumerate().map(add).collect()).unwrap()
    };

    // Newmark's parabola: any other parabola leaves more velocity
    let parabola = treat(Baseline::NewmarkParabola);
    let least = square(parabola.velocities());
    assert!(least < square(record.velocities()));
    for power in 0..3 {
        for sign in [-1.0, 1.0] {
            let other = shifted(&parabola, sign, power);
            assert!(square(other.velocities()) > least, "{power} {sign}");
        }
    }

    // sextic in displacement: leaves less displacement than the record and than the parabola
    let sextic = treat(Baseline::DisplacementPolynomial { degree: 6 });
    let least = square(sextic.displacements());
    assert!(least < square(record.displacements()) && least < square(parabola.displacements()));
    for power in 0..5 {
        for sign in [-1.0, 1.0] {
            let other = shifted(&sextic, sign, power);
            assert!(square(other.displacements()) > least, "{power} {sign}");
        }
    }
}

/// A polynomial drift is removed entirely, and the record under it found again.
#[test]
fn baselines_remove_a_polynomial() {
    let count = 2001;
    let time = |k: i32| f64::from(k) / f64::from(count - 1);
    let drift = Record::new(
        0.01,
        (0..count).map(|k| 0.3 - 0.8 * time(k) + 0.9 * time(k).powi(2)).collect(),
    )
    .unwrap();
    for baseline in [
        Baseline::NewmarkParabola,
        Baseline::VelocityPolynomial { degree: 4 },
        Baseline::DisplacementPolynomial { degree: 6 },
    ] {
        let treated = drift.with_baseline(baseline).unwrap();
        let left = treated.peaks().acceleration;
        // the normal equations of twice integrated polynomials cost four digits
        assert!(left < 1e-11, "{baseline:?}: {left:e}");
    }
}

#[test]
fn bad_baselines_are_refused() {
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
    #[test]
    fn baselines_hold_for_any_record(values in prop::collection::vec(-10.0..10.0_f64, 12..200)) {
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
