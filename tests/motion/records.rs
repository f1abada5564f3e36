//! GOAL: integrals, peaks and intensities of a record are right, also between and outside its samples.
//! SCENE: El Centro, ramps, arbitrary samples.
//! REFERENCE: values tabulated with the record, and exact integrals.

use approx::assert_relative_eq;
use basemat::Error;
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use proptest::prelude::*;

use basemat_problems::dense::largest;
use basemat_problems::{assert_close, table};

/// GOAL: samples, time steps and factors out of range are errors.
#[test]
fn invalid_samples_and_steps_are_errors() {
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

/// Asserts the times between which 5 to 95 % of the intensity are reached.
#[track_caller]
fn assert_significant_times(record: &Record, from: f64, to: f64, tolerance: f64) {
    let times = record.significant_times(0.05, 0.95).unwrap();
    assert!((times[0] - from).abs() < tolerance && (times[1] - to).abs() < tolerance, "{times:?}");
}

/// GOAL: significant times of a constant, a ramp and El Centro are right.
/// REFERENCE: intensities that grow evenly and as the cube of time; an independent sum.
#[test]
fn significant_times_are_where_the_intensity_is_reached() {
    let constant = Record::new(0.5, vec![-3e-200; 41]).unwrap();
    assert_significant_times(&constant, 1.0, 19.0, 1e-12);
    let ramp = Record::new(1e-4, (0..=10_000).map(f64::from).collect()).unwrap();
    assert_significant_times(&ramp, 0.05_f64.cbrt(), 0.95_f64.cbrt(), 1e-6);
    assert_significant_times(&el_centro_1940(), 1.668_760_52, 25.512_122_39, 1e-8);
    assert_eq!(el_centro_1940().significant_times(0.0, 1.0).unwrap()[0], 0.0);
    for [from, to] in [[-0.1, 0.5], [0.5, 0.4], [0.0, 1.1], [f64::NAN, 0.5], [0.1, f64::NAN]] {
        assert!(constant.significant_times(from, to).is_err(), "{from} {to}");
    }
    assert!(Record::new(1.0, vec![0.0; 3]).unwrap().significant_times(0.05, 0.95).is_err());
}

/// GOAL: peaks, end values and Arias intensity of El Centro are those tabulated with the record.
#[test]
fn el_centro_1940_has_its_tabulated_peaks() {
    let columns = ["npts", "dt", "dur", "pga_g", "t_pga", "pgv", "v_end", "d_end", "arias"];
    let [count, step, duration, peak, peak_time, velocity, v_end, d_end, arias] =
        table("summary_records.csv").row("file", "elcentro1940_NS_peknold_0319g.csv", columns);
    let record = el_centro_1940();
    assert_eq!(record.len() as f64, count);
    assert_eq!(record.time_step(), step);
    assert_close("duration", record.duration(), duration, 1e-12, 0.0);
    assert_close("PGA", record.peaks().acceleration / STANDARD_GRAVITY, peak, 1e-12, 0.0);
    assert_close(
        "at its time",
        record.at(peak_time).acceleration.abs() / STANDARD_GRAVITY,
        peak,
        1e-12,
        0.0,
    );
    let peak_of_samples = largest(record.velocities());
    assert_close("PGV at the samples", peak_of_samples, velocity, 5e-7, 0.0);
    assert_close("v at the end", record.at(record.duration()).velocity, v_end, 5e-7, 0.0);
    assert_close("u at the end", record.at(record.duration()).displacement, d_end, 5e-7, 0.0);
    assert_close("Arias", record.arias_intensity(), arias, 5e-7, 0.0);
    // Between the samples the peaks are at least as large, and those of a fine resampling.
    let fine = record.resampled(0.02 / 64.0).unwrap();
    assert!(record.peaks().velocity >= peak_of_samples);
    assert_close("PGV", largest(fine.velocities()), record.peaks().velocity, 1e-6, 0.0);
    assert_close("PGD", largest(fine.displacements()), record.peaks().displacement, 1e-8, 0.0);
    assert!(largest(fine.velocities()) <= record.peaks().velocity + 1e-14);
}

/// GOAL: peaks of velocity and displacement between samples have their closed forms.
#[test]
fn peaks_between_samples_have_closed_forms() {
    // a = 1 − t on [0, 2]: v = t − t²/2 peaks at t = 1 with 1/2; u = t²/2 − t³/6 rises to 2/3.
    let record = Record::new(2.0, vec![1.0, -1.0]).unwrap();
    assert_eq!(record.peaks().velocity, 0.5);
    assert_relative_eq!(record.peaks().displacement, 2.0 / 3.0, max_relative = 1e-15);
    // a = 1 − t on [0, 4]: v = 0 again at t = 2, u = 2/3 there and −8/3 at the end.
    let record = Record::new(4.0, vec![1.0, -3.0]).unwrap();
    assert_relative_eq!(record.peaks().displacement, 8.0 / 3.0, max_relative = 1e-15);
    let record = Record::new(3.0, vec![1.0, -2.0]).unwrap();
    assert_relative_eq!(record.peaks().displacement, 2.0 / 3.0, max_relative = 1e-15);
}

/// GOAL: a record is at rest before its start and moves with constant velocity after its end.
#[test]
fn motion_outside_a_record_is_rest_or_constant_velocity() {
    let record = Record::new(1.0, vec![2.0, 2.0]).unwrap();
    for time in [-1.0, 0.0, f64::NEG_INFINITY, f64::NAN] {
        assert_eq!(record.at(time).velocity, 0.0);
        assert_eq!(record.at(time).displacement, 0.0);
    }
    assert_eq!([-1.0, 0.0, 1.0, 1.5].map(|t| record.at(t).acceleration), [0.0, 2.0, 2.0, 0.0]);
    assert_eq!(record.at(3.0).velocity, 2.0);
    assert_eq!(record.at(3.0).displacement, 5.0);
}

/// GOAL: resampling keeps the piecewise linear acceleration and its integrals.
#[test]
fn resampling_keeps_the_function() {
    let record = el_centro_1940();
    let fine = record.resampled(0.0025).unwrap();
    for k in 0..4000 {
        let time = f64::from(k) * 0.0077;
        assert_close("a", fine.at(time).acceleration, record.at(time).acceleration, 1e-11, 0.0);
        assert_close("v", fine.at(time).velocity, record.at(time).velocity, 1e-12, 0.0);
        assert_close("u", fine.at(time).displacement, record.at(time).displacement, 1e-12, 0.0);
    }
    assert_eq!(fine.resampled(0.02).unwrap().len(), record.len());
    // A time step that does not divide the duration ends after the record, at zero.
    let odd = Record::new(1.0, vec![3.0, 3.0]).unwrap().resampled(0.4).unwrap();
    assert_eq!(odd.accelerations(), [3.0, 3.0, 3.0, 0.0]);
}

fn samples() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-10.0..10.0_f64, 2..60)
}

/// Acceleration, velocity and displacement of a record with samples every 0.1 s.
fn motion_at(samples: impl Iterator<Item = f64>, time: f64) -> [f64; 3] {
    let record = Record::new(0.1, samples.collect()).unwrap();
    let motion = record.at(time);
    [motion.acceleration, motion.velocity, motion.displacement]
}

proptest! {
    /// GOAL: the slope of the displacement is the velocity, and the slope of the velocity the acceleration.
    #[test]
    fn integrals_are_consistent(
        step in 0.01..1.0_f64,
        values in samples(),
        relative_time in 0.0..1.2_f64,
    ) {
        let record = Record::new(step, values).unwrap();
        let time = relative_time * record.duration();
        let h = 1e-3 * step;
        let before = record.at(time - h);
        let after = record.at(time + h);
        // Central differences of a cubic have the error u''' h²/6, those across a corner (Δa/Δt) h.
        let scale = 20.0 * record.duration().max(1.0);
        if time > h {
            let v = (after.displacement - before.displacement) / (2.0 * h);
            prop_assert!((v - record.at(time).velocity).abs() < 20.0 * h + 1e-9 * scale);
            let distance_to_corner = (time / step - (time / step).round()).abs() * step;
            if distance_to_corner > h {
                let a = (after.velocity - before.velocity) / (2.0 * h);
                prop_assert!((a - record.at(time).acceleration).abs() < 1e-8 * scale / step);
            }
        }
    }

    /// GOAL: the integrals of a sum are the sums of the integrals.
    #[test]
    fn integration_is_linear(
        pairs in prop::collection::vec((-10.0..10.0_f64, -10.0..10.0_f64), 2..60),
        factor in -3.0..3.0_f64,
        relative_time in -0.1..1.5_f64,
    ) {
        let sums: Vec<f64> = pairs.iter().map(|pair| pair.0 + factor * pair.1).collect();
        let time = relative_time * Record::new(0.1, sums.clone()).unwrap().duration();
        let first = motion_at(pairs.iter().map(|pair| pair.0), time);
        let second = motion_at(pairs.iter().map(|pair| pair.1), time);
        let sum = motion_at(sums.into_iter(), time);
        for k in 0..3 {
            prop_assert!((first[k] + factor * second[k] - sum[k]).abs() < 1e-10);
        }
    }
}
