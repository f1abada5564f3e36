//! GOAL: filters have the gain of their formula and no phase; a high-pass leaves no drift.
//! SCENE: sines of 200 s, and an offset; corners and tapers out of range.
//! REFERENCE: the gain 1/(1 + (f_c/f)^2n); typed errors.

use basemat::Error;
use basemat::motion::Record;

/// GOAL: the high-pass filter has the gain of its formula, no phase, and leaves no drift.
/// CONFIG: sines of 200 s, corner 0.2 Hz; gains from the middle of the record.
#[test]
fn high_pass_has_the_gain_of_its_formula() {
    let (step, corner) = (0.01, 0.2);
    for order in [1_u32, 2, 4, 8] {
        for frequency in [0.1, 0.2, 0.25, 0.5, 5.0] {
            let omega = 2.0 * std::f64::consts::PI * frequency;
            let wave: Vec<f64> = (0..20_001).map(|k| (omega * step * f64::from(k)).sin()).collect();
            let record = Record::new(step, wave).unwrap();
            let filtered = record.high_pass(corner, order).unwrap();
            let gain = 1.0 / (1.0 + (corner / frequency).powi(2 * i32::try_from(order).unwrap()));
            let quiet = (filtered.duration() - record.duration()) / 2.0;
            for time in [80.0, 95.3, 110.0] {
                let wanted = gain * (omega * time).sin();
                let found = filtered.at(quiet + time).acceleration;
                assert!((found - wanted).abs() < 2e-3, "{order} {frequency}: {found} {wanted}");
            }
        }
    }
    // An offset goes, and the record ends at rest.
    let offset = Record::new(step, vec![1.0; 2001]).unwrap().tapered(2.0, 2.0).unwrap();
    let filtered = offset.high_pass(corner, 2).unwrap();
    let end = filtered.duration();
    let largest = filtered.velocities().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(filtered.at(end).velocity.abs() < 1e-3 * largest);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 50.0] {
        assert!(matches!(offset.high_pass(bad, 2), Err(Error::Input { .. })), "{bad}");
    }
    assert!(matches!(offset.high_pass(1e-12, 2), Err(Error::Memory(_))));
    assert!(offset.high_pass(1.0, 0).is_err() && offset.high_pass(1.0, 9).is_err());
    for bad in [-1.0, f64::NAN, f64::INFINITY, 20.1] {
        assert!(matches!(offset.tapered(bad, 0.0), Err(Error::Input { .. })), "{bad}");
        assert!(matches!(offset.tapered(0.0, bad), Err(Error::Input { .. })), "{bad}");
    }
    assert!(offset.tapered(10.0, 10.5).is_err() && offset.tapered(10.0, 10.0).is_ok());
}

/// The gains of both filters add up to one: 1/(1 + r) + 1/(1 + 1/r).
#[test]
fn low_pass_has_the_gain_of_its_formula() {
    let (step, corner) = (0.01, 4.0);
    for order in [1_u32, 4, 8] {
        for frequency in [1.0, 3.0, 4.0, 5.0, 16.0] {
            let omega = 2.0 * std::f64::consts::PI * frequency;
            let wave = (0..4001).map(|k| (omega * step * f64::from(k)).sin()).collect();
            let record = Record::new(step, wave).unwrap();
            let low = record.low_pass(corner, order).unwrap();
            let gain = 1.0 / (1.0 + (frequency / corner).powi(2 * i32::try_from(order).unwrap()));
            let quiet = (low.duration() - record.duration()) / 2.0;
            for index in [1500, 1777, 2100] {
                let time = step * f64::from(index);
                let wanted = gain * (omega * time).sin();
                let found = low.at(quiet + time).acceleration;
                assert!((found - wanted).abs() < 1e-3, "{order} {frequency}: {found} {wanted}");
            }
            let high = record.high_pass(corner, order).unwrap();
            let sums = low.accelerations().iter().zip(high.accelerations()).map(|(a, b)| a + b);
            let padded = record.padded(quiet, quiet).unwrap();
            for (sum, given) in sums.zip(padded.accelerations()) {
                assert!((sum - given).abs() < 1e-13);
            }
        }
    }
    let record = Record::new(step, vec![1.0; 100]).unwrap();
    for bad in [0.0, -1.0, f64::NAN, 50.0] {
        assert!(matches!(record.low_pass(bad, 2), Err(Error::Input { .. })), "{bad}");
    }
    assert!(record.low_pass(1.0, 0).is_err() && record.low_pass(1.0, 9).is_err());
}
