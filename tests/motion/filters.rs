//! GOAL: filters have the gain of their formula and no phase; a high-pass leaves no drift.
//! SCENE: sines of 40 and 200 s, and an offset; corners and tapers out of range.
//! REFERENCE: the gain 1/(1 + (f_c/f)^2n); typed errors.

use basemat::Error;
use basemat::motion::Record;
use basemat_problems::dense::largest;

/// Time between samples, s.
const TIME_STEP: f64 = 0.01;

/// A sine of this angular frequency (rad/s).
fn sine(omega: f64, count: i32) -> Record {
    let samples = (0..count).map(|k| (omega * TIME_STEP * f64::from(k)).sin());
    Record::new(TIME_STEP, samples.collect()).unwrap()
}

/// Gain of a filter, by the ratio of corner and frequency that grows with its attenuation.
fn gain(ratio: f64, order: u32) -> f64 {
    1.0 / (1.0 + ratio.powi(2 * i32::try_from(order).unwrap()))
}

/// GOAL: the high-pass filter has the gain of its formula and no phase.
/// SCENE: sines of 200 s, corner 0.2 Hz; gains from the middle of the record.
#[test]
fn high_pass_has_the_gain_of_its_formula() {
    let corner = 0.2;
    for order in [1_u32, 2, 4, 8] {
        for frequency in [0.1, 0.2, 0.25, 0.5, 5.0] {
            let omega = 2.0 * std::f64::consts::PI * frequency;
            let record = sine(omega, 20_001);
            let filtered = record.high_pass(corner, order).unwrap();
            let gain = gain(corner / frequency, order);
            let padding = (filtered.duration() - record.duration()) / 2.0;
            for time in [80.0, 95.3, 110.0] {
                let expected = gain * (omega * time).sin();
                let computed = filtered.at(padding + time).acceleration;
                let error = (computed - expected).abs();
                assert!(error < 2e-3, "{order} {frequency}: {computed} {expected}");
            }
        }
    }
}

/// GOAL: the high-pass filter removes an offset and leaves no drift.
#[test]
fn high_pass_removes_an_offset() {
    let offset = Record::new(TIME_STEP, vec![1.0; 2001]).unwrap().tapered(2.0, 2.0).unwrap();
    let filtered = offset.high_pass(0.2, 2).unwrap();
    let final_velocity = filtered.at(filtered.duration()).velocity;
    assert!(final_velocity.abs() < 1e-3 * largest(filtered.velocities()));
}

/// GOAL: corners, orders and tapers out of range are errors.
#[test]
fn invalid_filters_are_errors() {
    let record = Record::new(TIME_STEP, vec![1.0; 2001]).unwrap().tapered(2.0, 2.0).unwrap();
    for corner in [0.0, -1.0, f64::NAN, f64::INFINITY, 50.0] {
        assert!(matches!(record.high_pass(corner, 2), Err(Error::Input { .. })), "{corner}");
    }
    assert!(matches!(record.high_pass(1e-12, 2), Err(Error::Memory(_))));
    assert!(record.high_pass(1.0, 0).is_err() && record.high_pass(1.0, 9).is_err());
    for taper in [-1.0, f64::NAN, f64::INFINITY, 20.1] {
        assert!(matches!(record.tapered(taper, 0.0), Err(Error::Input { .. })), "{taper}");
        assert!(matches!(record.tapered(0.0, taper), Err(Error::Input { .. })), "{taper}");
    }
    assert!(record.tapered(10.0, 10.5).is_err() && record.tapered(10.0, 10.0).is_ok());
    let record = Record::new(TIME_STEP, vec![1.0; 100]).unwrap();
    for corner in [0.0, -1.0, f64::NAN, 50.0] {
        assert!(matches!(record.low_pass(corner, 2), Err(Error::Input { .. })), "{corner}");
    }
    assert!(record.low_pass(1.0, 0).is_err() && record.low_pass(1.0, 9).is_err());
}

/// GOAL: the low-pass filter has the gain of its formula; with the high-pass filter it adds up to the record.
///
/// The gains are 1/(1 + r) and 1/(1 + 1/r), whose sum is 1.
#[test]
fn low_pass_has_the_gain_of_its_formula() {
    let corner = 4.0;
    for order in [1_u32, 4, 8] {
        for frequency in [1.0, 3.0, 4.0, 5.0, 16.0] {
            let omega = 2.0 * std::f64::consts::PI * frequency;
            let record = sine(omega, 4001);
            let low = record.low_pass(corner, order).unwrap();
            let gain = gain(frequency / corner, order);
            let padding = (low.duration() - record.duration()) / 2.0;
            for index in [1500, 1777, 2100] {
                let time = TIME_STEP * f64::from(index);
                let expected = gain * (omega * time).sin();
                let computed = low.at(padding + time).acceleration;
                let error = (computed - expected).abs();
                assert!(error < 1e-3, "{order} {frequency}: {computed} {expected}");
            }
            let high = record.high_pass(corner, order).unwrap();
            let sums = low.accelerations().iter().zip(high.accelerations()).map(|(a, b)| a + b);
            let padded = record.padded(padding, padding).unwrap();
            for (sum, sample) in sums.zip(padded.accelerations()) {
                assert!((sum - sample).abs() < 1e-13);
            }
        }
    }
}
