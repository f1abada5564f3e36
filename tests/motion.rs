//! Ground-motion records: integration, peaks, baselines, free fields.

mod support;

use approx::assert_relative_eq;
use basemat::bem::full_plane::{IncidentField, VerticalWaves};
use basemat::motion::{
    AtRest, Baseline, FreeField, FreeFieldFn, Record, RickerDisplacement, STANDARD_GRAVITY,
    VerticalIncidence, el_centro_1940,
};
use basemat::{Error, RecordError, Soil};
use proptest::prelude::*;
use support::{close, table};

#[test]
fn bad_samples_and_steps_are_refused() {
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Record::new(step, vec![0.0; 3]), Err(Error::Input { .. })), "{step}");
        assert!(matches!(el_centro_1940().resampled(step), Err(Error::Input { .. })), "{step}");
        assert!(el_centro_1940().scaled_to_peak(step).is_err(), "{step}");
    }
    for sample in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(Record::new(1.0, vec![0.0, sample]), Err(Error::Input { .. })));
        assert!(el_centro_1940().scaled(sample).is_err());
    }
    assert!(matches!(Record::new(1e200, vec![1e200; 3]), Err(Error::Input { .. })));
    for count in 0..2 {
        let error = Record::new(1.0, vec![0.0; count]).unwrap_err();
        let reason = RecordError::TooShort { found: count, needed: 2 };
        assert_eq!(error, Error::Record { file: "samples".into(), line: 0, reason });
    }
    assert!(el_centro_1940().resampled(1e-9).is_err());
    assert!(Record::new(1.0, vec![0.0; 3]).unwrap().scaled_to_peak(1.0).is_err());
}

/// A constant acceleration gathers its intensity evenly, a ramp as the cube of time; El Centro's
/// values are those of an independent sum.
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
    close("PGA", record.peak_acceleration() / STANDARD_GRAVITY, peak, 1e-12, 0.0);
    close(
        "at its time",
        record.acceleration_at(peak_time).abs() / STANDARD_GRAVITY,
        peak,
        1e-12,
        0.0,
    );
    let at_samples = record.velocities().iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    close("PGV at the samples", at_samples, velocity, 5e-7, 0.0);
    close("v at the end", record.velocity_at(record.duration()), v_end, 5e-7, 0.0);
    close("u at the end", record.displacement_at(record.duration()), d_end, 5e-7, 0.0);
    close("Arias", record.arias_intensity(), arias, 5e-7, 0.0);
    // between the samples the peaks are at least as large, as a fine resampling finds too
    let fine = record.resampled(0.02 / 64.0).unwrap();
    let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    assert!(record.peak_velocity() >= at_samples);
    close("PGV", largest(fine.velocities()), record.peak_velocity(), 1e-6, 0.0);
    close("PGD", largest(fine.displacements()), record.peak_displacement(), 1e-8, 0.0);
    assert!(largest(fine.velocities()) <= record.peak_velocity() + 1e-14);
}

#[test]
fn peaks_between_samples() {
    // a = 1 − t on [0, 2]: v = t − t²/2 peaks at t = 1 with 1/2; u = t²/2 − t³/6 rises to 2/3
    let record = Record::new(2.0, vec![1.0, -1.0]).unwrap();
    assert_eq!(record.peak_velocity(), 0.5);
    assert_relative_eq!(record.peak_displacement(), 2.0 / 3.0, max_relative = 1e-15);
    // a = 1 − t on [0, 4]: v = 0 again at t = 2, u = 2/3 there and −8/3 at the end
    let record = Record::new(4.0, vec![1.0, -3.0]).unwrap();
    assert_relative_eq!(record.peak_displacement(), 8.0 / 3.0, max_relative = 1e-15);
    let record = Record::new(3.0, vec![1.0, -2.0]).unwrap();
    assert_relative_eq!(record.peak_displacement(), 2.0 / 3.0, max_relative = 1e-15);
}

#[test]
fn motion_outside_the_record() {
    let record = Record::new(1.0, vec![2.0, 2.0]).unwrap();
    for time in [-1.0, 0.0, f64::NEG_INFINITY, f64::NAN] {
        assert_eq!(record.velocity_at(time), 0.0);
        assert_eq!(record.displacement_at(time), 0.0);
    }
    assert_eq!([-1.0, 0.0, 1.0, 1.5].map(|t| record.acceleration_at(t)), [0.0, 2.0, 2.0, 0.0]);
    assert_eq!(record.velocity_at(3.0), 2.0);
    assert_eq!(record.displacement_at(3.0), 5.0);
}

#[test]
fn resampling_keeps_the_function() {
    let record = el_centro_1940();
    let fine = record.resampled(0.0025).unwrap();
    for k in 0..4000 {
        let time = f64::from(k) * 0.0077;
        close("a", fine.acceleration_at(time), record.acceleration_at(time), 1e-11, 0.0);
        close("v", fine.velocity_at(time), record.velocity_at(time), 1e-12, 0.0);
        close("u", fine.displacement_at(time), record.displacement_at(time), 1e-12, 0.0);
    }
    assert_eq!(fine.resampled(0.02).unwrap().len(), record.len());
    // a step that does not divide the duration ends after the record, at zero
    let odd = Record::new(1.0, vec![3.0, 3.0]).unwrap().resampled(0.4).unwrap();
    assert_eq!(odd.accelerations(), [3.0, 3.0, 3.0, 0.0]);
}

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
        assert!(treated.velocity_at(end).abs() < 1e-13, "{degree}");
        // a higher degree fits better
        let now = square(treated.velocities());
        assert!(now <= velocity_square * (1.0 + 1e-9), "{degree}: {now} {velocity_square}");
        velocity_square = now;
    }
    let mean = treat(Baseline::RemoveMean);
    assert!(mean.velocity_at(end).abs() < 1e-13);
    let first = treat(Baseline::VelocityPolynomial { degree: 1 });
    for (a, b) in mean.accelerations().iter().zip(first.accelerations()) {
        close("degree 1 is the mean", *a, *b, 1e-15, 0.0);
    }

    for degree in 3..=8 {
        let treated = treat(Baseline::RestToRest { degree });
        assert!(treated.velocity_at(end).abs() < 1e-13, "{degree}");
        assert!(treated.displacement_at(end).abs() < 1e-12, "{degree}");
        assert!(treated.displacement_at(end + 1000.0).abs() < 1e-10, "{degree}");
        assert_eq!(treated.accelerations()[0], record.accelerations()[0]);
    }

    // Newmark's parabola: any other parabola leaves more velocity
    let parabola = treat(Baseline::NewmarkParabola);
    let least = square(parabola.velocities());
    assert!(least < square(record.velocities()));
    for power in 0..3 {
        for sign in [-1.0, 1.0] {
            let shifted = parabola
                .accelerations()
                .iter()
                .enumerate()
                .map(|(k, a)| a + sign * 1e-4 * (k as f64 * 0.01 / end).powi(power));
            let other = Record::new(0.01, shifted.collect()).unwrap();
            assert!(square(other.velocities()) > least, "{power} {sign}");
        }
    }

    // sextic in displacement: leaves less displacement than the record and than the parabola
    let sextic = treat(Baseline::DisplacementPolynomial { degree: 6 });
    let least = square(sextic.displacements());
    assert!(least < square(record.displacements()) && least < square(parabola.displacements()));
    for power in 0..5 {
        for sign in [-1.0, 1.0] {
            let shifted = sextic
                .accelerations()
                .iter()
                .enumerate()
                .map(|(k, a)| a + sign * 1e-4 * (k as f64 * 0.01 / end).powi(power));
            let other = Record::new(0.01, shifted.collect()).unwrap();
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
        let left = treated.peak_acceleration();
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

#[test]
fn free_fields_agree_with_their_sources() {
    let record = el_centro_1940();
    let vertical = record.scaled(-0.5).unwrap().resampled(0.03).unwrap();
    let both = VerticalIncidence::new(record.clone()).with_vertical(vertical.clone());
    let only_vertical = VerticalIncidence::vertical(vertical.clone());
    let from = VerticalIncidence::from(record.clone());
    for k in -10..3000 {
        let time = f64::from(k) * 0.0123;
        let (u, w) = (record.displacement_at(time), vertical.displacement_at(time));
        assert_eq!(both.displacement(1e3, time), [u, w]);
        assert_eq!(only_vertical.displacement(0.0, time), [0.0, w]);
        assert_eq!(from.displacement(0.0, time), [u, 0.0]);
        assert_eq!(record.displacement(0.0, time), [u, 0.0]);
        assert_eq!(record.velocity(0.0, time), [record.velocity_at(time), 0.0]);
        let (u, w) = (record.velocity_at(time), vertical.velocity_at(time));
        assert_eq!(both.velocity(-1e3, time), [u, w]);
    }
    assert_eq!(AtRest.displacement(0.0, 1.0), [0.0; 2]);
    let always = FreeFieldFn::new(|_, _| [1.0, 1.0]).with_velocity(|_, _| [2.0, 2.0]);
    assert_eq!(always.displacement(0.0, 0.0), [0.0; 2]);
    assert_eq!(always.velocity(0.0, -1.0), [0.0; 2]);
    assert_eq!(always.velocity(0.0, 1e-9), [2.0; 2]);
}

/// GOAL: a velocity that nobody wrote is as good as the documentation says, late in time too.
/// REFERENCE: the closed form of a Ricker pulse of about 1.5 and 15 Hz.
#[test]
fn velocities_by_default_are_differences() {
    struct Bare(RickerDisplacement);
    impl FreeField for Bare {
        fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
            self.0.displacement(x, time)
        }
    }
    for (sigma, center) in [(0.15, 1.0), (0.015, 1.0), (0.015, 1.0e6)] {
        let pulse = RickerDisplacement::new(0.3, sigma, center).unwrap();
        let closure = FreeFieldFn::new(move |x, t| pulse.displacement(x, t));
        let mut largest = 0.0_f64;
        let mut worst = 0.0_f64;
        for k in -300..300 {
            let time = center + 0.013 * sigma * f64::from(k);
            let exact = pulse.velocity(0.0, time)[0];
            let found = Bare(pulse).velocity(0.0, time);
            assert_eq!(found, closure.velocity(0.0, time));
            assert_eq!(found[1], 0.0);
            largest = largest.max(exact.abs());
            worst = worst.max((found[0] - exact).abs());
        }
        // The largest third derivative is 8.4/σ² times the largest velocity; and rounding.
        let bound = (1e-5 / sigma).powi(2) * 8.5 / 6.0 * largest + 2.0 * 0.3 * 2e-11;
        println!("sigma {sigma}: {worst:e} m/s of {largest} m/s, bound {bound:e}");
        assert!(worst < bound);
        assert!(largest > 0.3 / sigma);
    }
    let ramp = FreeFieldFn::new(|_, t| [t, -2.0 * t]);
    for time in [0.0, -1.0, f64::NAN] {
        assert_eq!(ramp.velocity(0.0, time), [0.0; 2]);
    }
    for time in [1e-3, 1.0, 1e9, 1e15] {
        let found = ramp.velocity(0.0, time);
        assert!((found[0] - 1.0).abs() < 1e-9 && (found[1] + 2.0).abs() < 1e-9, "{found:?}");
    }
    assert!(format!("{ramp:?}").contains("exact_velocity: false"));
}

/// GOAL: stresses of waves from below do not need an exact velocity.
#[test]
fn stresses_of_waves_with_a_difference() {
    let soil = Soil::new(80.0e6, 0.25, 2000.0).unwrap();
    let pulse = RickerDisplacement::new(0.1, 0.1, 0.8).unwrap();
    let exact = VerticalWaves::new(soil, pulse, 20.0).unwrap();
    let closure = FreeFieldFn::new(move |x, t| pulse.displacement(x, t));
    let bare = VerticalWaves::new(soil, closure, 20.0).unwrap();
    let mut largest = 0.0_f64;
    for k in 0..200 {
        let (point, time) = ([0.0, 7.0], 0.01 * f64::from(k));
        let (a, b) = (exact.stress(point, time), bare.stress(point, time));
        largest = largest.max(a[2].abs());
        assert!((a[2] - b[2]).abs() < 1e-6 * 1.0e6, "{a:?} {b:?}");
    }
    assert!(largest > 1.0e5);
}

#[test]
fn ricker_velocity_is_the_derivative() {
    let pulse = RickerDisplacement::new(-0.3, 0.4, 2.0).unwrap();
    let turned = pulse.vertical();
    for k in 1..400 {
        let (time, h) = (f64::from(k) * 0.01 + 1e-3, 1e-5);
        let slope = (pulse.displacement(0.0, time + h)[0] - pulse.displacement(0.0, time - h)[0])
            / (2.0 * h);
        close("velocity", pulse.velocity(5.0, time)[0], slope, 1e-8, 0.0);
        assert_eq!(turned.displacement(0.0, time), [0.0, pulse.displacement(0.0, time)[0]]);
    }
    assert_eq!(pulse.displacement(0.0, 0.0), [0.0; 2]);
    assert_eq!(pulse.velocity(0.0, -3.0), [0.0; 2]);
    for (amplitude, sigma, center) in [
        (f64::NAN, 1.0, 5.0),
        (1.0, 0.0, 5.0),
        (1.0, -1.0, 5.0),
        (1.0, 1.0, 3.9),
        (1.0, 1.0, f64::NAN),
        (1.0, 1.0, f64::INFINITY),
    ] {
        assert!(RickerDisplacement::new(amplitude, sigma, center).is_err());
    }
}

fn samples() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-10.0..10.0_f64, 2..60)
}

proptest! {
    /// The slope of the displacement is the velocity, and that of the velocity the acceleration.
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
        let v = slope(&|t| record.displacement_at(t));
        if time > h {
            prop_assert!((v - record.velocity_at(time)).abs() < 20.0 * h + 1e-9 * scale);
            let corner = (time / step - (time / step).round()).abs() * step;
            if corner > h {
                let a = slope(&|t| record.velocity_at(t));
                prop_assert!((a - record.acceleration_at(time)).abs() < 1e-8 * scale / step);
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
            [r.acceleration_at(time), r.velocity_at(time), r.displacement_at(time)]
        };
        let (a, b, c) = (motion(&first), motion(&second), motion(&sum));
        for k in 0..3 {
            prop_assert!((a[k] + factor * b[k] - c[k]).abs() < 1e-10);
        }
    }

    #[test]
    fn baselines_hold_for_any_record(values in prop::collection::vec(-10.0..10.0_f64, 12..200)) {
        let record = Record::new(0.02, values).unwrap();
        let end = record.duration();
        for degree in 1..=8 {
            let treated = record.with_baseline(Baseline::VelocityPolynomial { degree }).unwrap();
            prop_assert!(treated.velocity_at(end).abs() < 1e-11);
        }
        for degree in 3..=8 {
            let treated = record.with_baseline(Baseline::RestToRest { degree }).unwrap();
            prop_assert!(treated.velocity_at(end).abs() < 1e-11);
            prop_assert!(treated.displacement_at(end).abs() < 1e-11);
        }
    }
}

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
                let found = filtered.acceleration_at(quiet + time);
                assert!((found - wanted).abs() < 2e-3, "{order} {frequency}: {found} {wanted}");
            }
        }
    }
    // An offset goes, and the record ends at rest.
    let offset = Record::new(step, vec![1.0; 2001]).unwrap().tapered(2.0, 2.0).unwrap();
    let filtered = offset.high_pass(corner, 2).unwrap();
    let end = filtered.duration();
    let largest = filtered.velocities().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(filtered.velocity_at(end).abs() < 1e-3 * largest);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 50.0, 1e-12] {
        assert!(matches!(offset.high_pass(bad, 2), Err(Error::Input { .. })), "{bad}");
    }
    assert!(offset.high_pass(1.0, 0).is_err() && offset.high_pass(1.0, 9).is_err());
    for bad in [-1.0, f64::NAN, f64::INFINITY, 20.1] {
        assert!(matches!(offset.tapered(bad, 0.0), Err(Error::Input { .. })), "{bad}");
        assert!(matches!(offset.tapered(0.0, bad), Err(Error::Input { .. })), "{bad}");
    }
    assert!(offset.tapered(10.0, 10.5).is_err() && offset.tapered(10.0, 10.0).is_ok());
}
