//! GOAL: integrals, peaks and intensities of a record, between and outside its samples.
//! SCENE: El Centro, ramps, any samples.
//! REFERENCE: values tabulated with the record, and exact integrals.

use approx::assert_relative_eq;
use basemat::Error;
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use proptest::prelude::*;

use basemat_problems::{close, table};

#[test]
fn bad_samples_and_steps_are_refused() {
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Record::new(step, vec![0.0; 3]), Err(Error::Input { .. })), "{step}");
        assert!(matches!(el_centro_1940().resampled(step), Err(Error::Input { .. })), "{step}");
        assert!(el_centro_1940().scaled_to_peak(step).is_err(), "{step}");
    }
    for sample in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(
            Record::new(1.0, vec![0.0, sample]),
            Err(Error::NotFinite { index: 1, .. })
        ));
        assert!(el_centro_1940().scaled(sample).is_err());
    }
    assert!(matches!(Record::new(1e200, vec![1e200; 3]), Err(Error::Input { .. })));
    for count in 0..2 {
        let error = Record::new(1.0, vec![0.0; count]).unwrap_err();
        let quantity = "samples of the record";
        assert_eq!(error, Error::Size { quantity, found: count, needed: 2 });
    }
    assert!(el_centro_1940().resampled(1e-9).is_err());
    assert!(Record::new(1.0, vec![0.0; 3]).unwrap().scaled_to_peak(1.0).is_err());
}

/// A constant acceleration gathers its intensity evenly, a ramp as the cube of time; El Centro's
/// values come from an independent sum.
#[test]
fn significant_times_are_where_the_intensity_is_reached() {
    let even = Record::new(0.5, vec![-3e-200; 41]).unwrap();
    let [from, to] = even.significant_times(0.05, 0.95).unwrap();
    assert!((from - 1.0).abs() < 1e-12 && (to - 19.0).abs() < 1e-12);
    let ramp = Record::new(1e-4, (0..=10_000).map(f64::from).collect()).unwrap();
    let [from, to] = ramp.significant_times(0.05, 0.95).unwrap();
    assert!((from - 0.05_f64.cbrt()).abs() < 1e-6 && (to - 0.95_f64.cbrt()).abs() < 1e-6);
    let [from, to] = el_centro_1940().significant_times(0.05, 0.95).unwrap();
    assert!((from - 1.668_760_52).abs() < 1e-8 && (to - 25.512_122_39).abs() < 1e-8);
    assert_eq!(el_centro_1940().significant_times(0.0, 1.0).unwrap()[0], 0.0);
    for [from, to] in [[-0.1, 0.5], [0.5, 0.4], [0.0, 1.1], [f64::NAN, 0.5], [0.1, f64::NAN]] {
        assert!(even.significant_times(from, to).is_err(), "{from} {to}");
    }
    assert!(Record::new(1.0, vec![0.0; 3]).unwrap().significant_times(0.05, 0.95).is_err());
}

/// GOAL: peaks, end values and Arias intensity of El Centro, as tabulated with the record.
#[test]
fn el_centro_1940_peaks() {
    let columns = ["npts", "dt", "dur", "pga_g", "t_pga", "pgv", "v_end", "d_end", "arias"];
    let [count, step, duration, peak, peak_time, velocity, v_end, d_end, arias] =
        table("summary_records.csv").row("file", "elcentro1940_NS_peknold_0319g.csv", columns);
    let record = el_centro_1940();
    assert_eq!(record.len() as f64, count);
    assert_eq!(record.time_step(), step);
    close("duration", record.duration(), duration, 1e-12, 0.0);
    close("PGA", record.peaks().acceleration / STANDARD_GRAVITY, peak, 1e-12, 0.0);
    close(
        "at its time",
        record.at(peak_time).acceleration.abs() / STANDARD_GRAVITY,
        peak,
        1e-12,
        0.0,
    );
    let at_samples = record.velocities().iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    close("PGV at the samples", at_samples, velocity, 5e-7, 0.0);
    close("v at the end", record.at(record.duration()).velocity, v_end, 5e-7, 0.0);
    close("u at the end", record.at(record.duration()).displacement, d_end, 5e-7, 0.0);
    close("Arias", record.arias_intensity(), arias, 5e-7, 0.0);
    // between the samples the peaks are at least as large, as a fine resampling finds too
    let fine = record.resampled(0.02 / 64.0).unwrap();
    let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    assert!(record.peaks().velocity >= at_samples);
    close("PGV", largest(fine.velocities()), record.peaks().velocity, 1e-6, 0.0);
    close("PGD", largest(fine.displacements()), record.peaks().displacement, 1e-8, 0.0);
    assert!(largest(fine.velocities()) <= record.peaks().velocity + 1e-14);
}

#[test]
fn peaks_between_samples() {
    // a = 1 − t on [0, 2]: v = t − t²/2 peaks at t = 1 with 1/2; u = t²/2 − t³/6 rises to 2/3
    let record = Record::new(2.0, vec![1.0, -1.0]).unwrap();
    assert_eq!(record.peaks().velocity, 0.5);
    assert_relative_eq!(record.peaks().displacement, 2.0 / 3.0, max_relative = 1e-15);
    // a = 1 − t on [0, 4]: v = 0 again at t = 2, u = 2/3 there and −8/3 at the end
    let record = Record::new(4.0, vec![1.0, -3.0]).unwrap();
    assert_relative_eq!(record.peaks().displacement, 8.0 / 3.0, max_relative = 1e-15);
    let record = Record::new(3.0, vec![1.0, -2.0]).unwrap();
    assert_relative_eq!(record.peaks().displacement, 2.0 / 3.0, max_relative = 1e-15);
}

#[test]
fn motion_outside_the_record() {
    let record = Record::new(1.0, vec![2.0, 2.0]).unwrap();
    for time in [-1.0, 0.0, f64::NEG_INFINITY, f64::NAN] {
        assert_eq!(record.at(time).velocity, 0.0);
        assert_eq!(record.at(time).displacement, 0.0);
    }
    assert_eq!([-1.0, 0.0, 1.0, 1.5].map(|t| record.at(t).acceleration), [0.0, 2.0, 2.0, 0.0]);
    assert_eq!(record.at(3.0).velocity, 2.0);
    assert_eq!(record.at(3.0).displacement, 5.0);
}

#[test]
fn resampling_keeps_the_function() {
    let record = el_centro_1940();
    let fine = record.resampled(0.0025).unwrap();
    for k in 0..4000 {
        let time = f64::from(k) * 0.0077;
        close("a", fine.at(time).acceleration, record.at(time).acceleration, 1e-11, 0.0);
        close("v", fine.at(time).velocity, record.at(time).velocity, 1e-12, 0.0);
        close("u", fine.at(time).displacement, record.at(time).displacement, 1e-12, 0.0);
    }
    assert_eq!(fine.resampled(0.02).unwrap().len(), record.len());
    // a step that does not divide the duration ends after the record, at zero
    let odd = Record::new(1.0, vec![3.0, 3.0]).unwrap().resampled(0.4).unwrap();
    assert_eq!(odd.accelerations(), [3.0, 3.0, 3.0, 0.0]);
}

fn samples() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-10.0..10.0_f64, 2..60)
}

proptest! {
    /// The slope of the displacement is the velocity, and the slope of the velocity the
    /// acceleration.
    #[test]
    fn integrals_are_consistent(
        step in 0.01..1.0_f64,
        values in samples(),
        at in 0.0..1.2_f64,
    ) {
        let record = Record::new(step, values).unwrap();
        let time = at * record.duration();
        let h = 1e-3 * step;
        // central differences of a cubic are off by u''' h²/6, those across a corner by (Δa/Δt) h
        let slope = |f: &dyn Fn(f64) -> f64| (f(time + h) - f(time - h)) / (2.0 * h);
        let scale = 20.0 * record.duration().max(1.0);
        let v = slope(&|t| record.at(t).displacement);
        if time > h {
            prop_assert!((v - record.at(time).velocity).abs() < 20.0 * h + 1e-9 * scale);
            let corner = (time / step - (time / step).round()).abs() * step;
            if corner > h {
                let a = slope(&|t| record.at(t).velocity);
                prop_assert!((a - record.at(time).acceleration).abs() < 1e-8 * scale / step);
            }
        }
    }

    #[test]
    fn integration_is_linear(
        pairs in prop::collection::vec((-10.0..10.0_f64, -10.0..10.0_f64), 2..60),
        factor in -3.0..3.0_f64,
        at in -0.1..1.5_f64,
    ) {
        let new = |values: Vec<f64>| Record::new(0.1, values).unwrap();
        let first = new(pairs.iter().map(|p| p.0).collect());
        let second = new(pairs.iter().map(|p| p.1).collect());
        let sum = new(pairs.iter().map(|p| p.0 + factor * p.1).collect());
        let time = at * sum.duration();
        let motion = |r: &Record| {
            [r.at(time).acceleration, r.at(time).velocity, r.at(time).displacement]
        };
        let (a, b, c) = (motion(&first), motion(&second), motion(&sum));
        for k in 0..3 {
            prop_assert!((a[k] + factor * b[k] - c[k]).abs() < 1e-10);
        }
    }
}
